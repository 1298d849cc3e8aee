//! What a surface says about a pixel, its planes, and what is cached of it.
//! Floor 2.

use super::pyramid::MapPyramids;
use super::*;

impl Surface {
    /// The pixels that two sides see.
    pub fn contours(&self) -> &Arc<Contours> {
        &self.contours
    }

    /// How much of each pixel the surface covers: as the maps say, and on a rim that they left hard
    /// as its contour says.
    pub fn shares(&self) -> Plane<u8> {
        let mut shares = self.coverage.clone();
        for pixel in self.contours.pixels() {
            let (x, y) = (pixel.x as usize, pixel.y as usize);
            match (pixel.is_own_on_surface(), pixel.is_other_on_surface()) {
                (true, false) => shares.set(x, y, quantize(pixel.share)),
                (false, true) => shares.set(x, y, quantize(1.0 - pixel.share)),
                _ => (),
            }
        }
        shares
    }

    /// What this is the far side of, if it is one: its pixels are readings of other sides, not
    /// pixels of the canvas.
    pub fn as_far_side(&self) -> Option<&FarSide> {
        self.far_side_of.as_ref()
    }

    pub(in crate::surface) fn far_normals(&self) -> Option<&Plane<Vec3>> {
        self.far_normals.as_ref()
    }

    /// Of its maps, px.
    pub fn size(&self) -> Size {
        self.size
    }

    /// n̄ at a pixel, image axes (y down), length ≤ 1.
    #[inline(always)]
    pub fn nbar(&self, x: usize, y: usize) -> Vec2 {
        vec2(self.nbar_x.at(x, y), self.nbar_y.at(x, y))
    }

    /// The unit normal, camera space (y up).
    #[inline(always)]
    pub fn normal(&self, x: usize, y: usize) -> Vec3 {
        vec3(self.nbar_x.at(x, y), -self.nbar_y.at(x, y), self.nz.at(x, y))
    }

    /// z at a pixel, 0 near … 1 far.
    #[inline(always)]
    pub fn depth(&self, x: usize, y: usize) -> f32 {
        self.depth.at(x, y)
    }

    /// Coverage at a pixel, 0 … 255.
    #[inline(always)]
    pub fn coverage(&self, x: usize, y: usize) -> u8 {
        self.coverage.at(x, y)
    }

    /// n̄_x, n̄_y (image axes) and n_z as planes, for loops over rows.
    pub fn normal_planes(&self) -> [&Plane<f32>; 3] {
        [&self.nbar_x, &self.nbar_y, &self.nz]
    }

    /// z of each pixel: 0 near … 1 far.
    pub fn depth_plane(&self) -> &Plane<f32> {
        &self.depth
    }

    /// How much of each pixel is covered: 255 wholly.
    pub fn coverage_plane(&self) -> &Plane<u8> {
        &self.coverage
    }

    /// Whether it was made of the same maps, to the bit.
    pub fn has_same_maps(&self, other: &Self) -> bool {
        self.size() == other.size()
            && self.depth_range_px() == other.depth_range_px()
            && self.normal_planes() == other.normal_planes()
            && self.depth_plane() == other.depth_plane()
            && self.coverage_plane() == other.coverage_plane()
    }

    /// For each pixel, which of its four neighbors continue the same surface: bits of [`links`].
    pub fn links_plane(&self) -> &Plane<u8> {
        &self.links
    }

    /// The same without links across creases: for what is differenced to see how it changes within
    /// a pixel.
    pub fn smooth_links_plane(&self) -> &Plane<u8> {
        self.smooth_links.as_deref().unwrap_or(&self.links)
    }

    /// Z: how many pixels deep the range 0 … 1 of depth is, estimated from how depth and normals
    /// agree.
    pub fn depth_range_px(&self) -> f32 {
        self.depth_range_px
    }

    /// Which part each pixel shows, from 1 on, where the surface was made of parts.
    pub fn parts_plane(&self) -> Option<&Plane<u32>> {
        self.parts.as_deref()
    }

    /// Min–max pyramids of the maps, for `support`.
    pub(in crate::surface) fn bounds(&self) -> &MapPyramids {
        &self.bounds
    }

    /// The surface without the detail that was combined onto it.
    pub(in crate::surface) fn base(&self) -> &Surface {
        self.base.as_deref().unwrap_or(self)
    }
}
