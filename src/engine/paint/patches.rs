//! Patches: the piece of the image plane under each pixel, from D differenced within one piece of surface.
//! Floor 3. Not here: averaging a picture over them (`raster::sampler`).

use crate::math::{Affine2, Rect};
use crate::raster::sampler::PatchRow;
use crate::surface::{Scene, Surface, deformation::DeformedRect, links};

/// The four neighbours a pixel is differenced with, in the order of [`PatchRow::edges`].
const SIDES: [(u8, i32, i32); 4] =
    [(links::LEFT, -1, 0), (links::RIGHT, 1, 0), (links::UP, 0, -1), (links::DOWN, 0, 1)];

/// The patches of a row of pixels, refilled row by row.
#[derive(Default)]
pub struct Patches {
    bits: Vec<u8>,
    edges: [[Vec<f32>; 2]; 4],
}

impl Patches {
    /// The patches of row `y` of `rect`.
    ///
    /// * `positions`: P⁻¹(D(q)) of `rect` grown by one pixel on every side, in texels.
    /// * `texels_from_canvas`: P⁻¹. Toward a neighbour that does not continue the surface the maps count as constant:
    ///   the edge lies where an unbent picture's would.
    pub fn row<'a>(
        &'a mut self,
        scene: &Scene,
        rect: Rect,
        y: i32,
        positions: &'a DeformedRect,
        texels_from_canvas: Affine2,
    ) -> PatchRow<'a> {
        let n = rect.width();
        let stride = n + 2;
        self.bits.resize(n, 0);
        match &scene.surface {
            Some(surface) => links_or_outside(surface, rect.x0, y, &mut self.bits),
            None => self.bits.fill(15),
        }
        let here = (y - rect.y0 + 1) as usize * stride + 1;
        for (edge, (bit, dx, dy)) in self.edges.iter_mut().zip(SIDES) {
            let there = here.wrapping_add_signed(dy as isize * stride as isize + dx as isize);
            let still = texels_from_canvas.matrix2.mul_vec2(crate::math::vec2(dx as f32, dy as f32)) * 0.5;
            for (axis, (plane, still)) in [(&positions.x, still.x), (&positions.y, still.y)].into_iter().enumerate() {
                edge[axis].resize(n, 0.0);
                half_edges(&plane[here..here + n], &plane[there..there + n], &self.bits, bit, still, &mut edge[axis]);
            }
        }
        let edges = self.edges.each_ref().map(|[x, y]| [&x[..], &y[..]]);
        PatchRow { x: &positions.x[here..here + n], y: &positions.y[here..here + n], edges }
    }
}

/// The links of a row's pixels. Off the surface D is smooth too: pixels there are linked to neighbours that are also
/// off it.
fn links_or_outside(surface: &Surface, x0: i32, y: i32, bits: &mut [u8]) {
    let (x1, map) = (x0 + bits.len() as i32, surface.size().rect());
    if map.contains(x0, y) && map.contains(x1 - 1, y) {
        let row = x0 as usize..x1 as usize;
        if surface.coverage_plane().row(y as usize)[row.clone()].iter().all(|&c| c > 0) {
            return bits.copy_from_slice(&surface.smooth_links_plane().row(y as usize)[row]);
        }
    }
    let covered = |x: i32, y: i32| surface.coverage_plane().get(x, y).is_some_and(|c| c > 0);
    for (x, bits) in (x0..).zip(bits) {
        *bits = if covered(x, y) {
            surface.smooth_links_plane().get(x, y).unwrap_or(0)
        } else {
            SIDES.iter().filter(|(_, dx, dy)| !covered(x + dx, y + dy)).fold(0, |bits, side| bits | side.0)
        };
    }
}

crate::widest! {
    /// Half-way to the neighbour where it is linked, `still` where it is not.
    fn half_edges(here: &[f32], there: &[f32], bits: &[u8], bit: u8, still: f32, out: &mut [f32]) {
        let n = out.len();
        let (here, there, bits) = (&here[..n], &there[..n], &bits[..n]);
        for k in 0..n {
            out[k] = if bits[k] & bit != 0 { (there[k] - here[k]) * 0.5 } else { still };
        }
    }
}
