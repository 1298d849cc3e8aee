//! The surface: normals, depth and coverage in the one convention of the program, whole and finite everywhere.
//! Floor 2. Not here: files and their conventions (`io::maps`).

use super::region::SurfaceRegion;
use super::{
    cache::RecentCache,
    contours::{self, ContourMaps, Contours, Found, SheetOf},
    creases,
    curvature::{Curvature, Kappa, Rims},
    grow::{self, KnownNearest},
    links,
    objects::Objects,
    pyramid::MapPyramids,
    through::Origin,
    unwrap::{NearView, PlaneLayout, PlaneSprings, PlaneYield, Unwrapping, YieldKey},
    view::Eye,
};
use crate::math::{Size, Vec2, Vec3, srgb::quantise, vec2, vec3};
use crate::raster::{CoverageGrid, Plane};
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// What a surface is made from. At least one of normals and depth must be there; the importer derives the other.
pub struct Maps {
    /// Camera space: +x right, +y **up**, +z to the viewer. Zero, NaN or infinite where there is no surface; any
    /// length.
    pub normals: Plane<Vec3>,
    /// 0 near … 1 far over the surface; not finite where there is none.
    pub depth: Plane<f32>,
    /// Coverage by the surface, 255 wholly covered.
    pub coverage: Plane<u8>,
}

/// Why maps do not make a surface.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    #[error("the maps differ in size: normals {normals}, {other} {size}")]
    SizesDiffer { normals: Size, other: &'static str, size: Size },
    #[error("there is no surface at all: every pixel is background")]
    Empty,
    #[error("a surface cannot be seen in a perspective")]
    Perspective,
}

/// A picture of an object's shape. Every value is finite; where coverage is 0, the nearest surface values are repeated,
/// so that filters may read across the silhouette.
pub struct Surface {
    size: Size,
    /// n̄ = (n_x, −n_y): image axes, y down.
    nbar_x: Plane<f32>,
    nbar_y: Plane<f32>,
    nz: Plane<f32>,
    depth: Plane<f32>,
    coverage: Plane<u8>,
    /// From where it was seen.
    pub(super) eye: Eye,
    /// Which neighbours belong to the same piece of surface (`links`).
    links: Plane<u8>,
    /// The same without those across creases; absent where there are none.
    pub(super) smooth_links: Option<Arc<Plane<u8>>>,
    depth_range_px: f32,
    /// By blur.
    curvatures: RecentCache<u32, Curvature>,
    /// Where curvature is continued.
    rims: RecentCache<(), Rims>,
    /// By the scales that are weighed.
    kappas: RecentCache<Vec<[u32; 3]>, Kappa>,
    /// The surface that detail was combined onto, if any; what depends on depth alone is computed there.
    base: Option<Arc<Surface>>,
    /// By radius.
    occlusions: RecentCache<u32, Plane<f32>>,
    regions: RecentCache<SurfaceRegion, CoverageGrid>,
    /// By amount and blur.
    unwrappings: RecentCache<[u32; 2], Unwrapping>,
    plane_layouts: RecentCache<[u32; 2], Option<Arc<PlaneLayout>>>,
    pub(super) plane_yields: RecentCache<YieldKey, PlaneYield>,
    pub(super) plane_springs: RecentCache<[u32; 2], PlaneSprings>,
    pub(super) near_view: OnceLock<Option<NearView>>,
    bounds: MapPyramids,
    objects: OnceLock<Objects>,
    /// Which part each pixel shows, where the surface was made of parts; their objects are these.
    pub(super) parts: Option<Arc<Plane<u32>>>,
    /// The pixels that two populations see.
    pub(super) contours: Arc<Contours>,
    /// What the other populations read.
    sheets: RecentCache<(), Surface>,
    /// Their normals, where detail was combined onto them.
    sheet_normals: Option<Plane<Vec3>>,
    /// The surface that this one is the sheet of, if it is one.
    sheet_of: Option<SheetOf>,
    /// What this one was seen through a map of, if it was.
    pub(super) origin: Option<Origin>,
}

/// n̄_x, n̄_y and n_z of normals. These are given back from their end on as they are taken apart, so that both never
/// stand whole beside each other.
fn apart(normals: Plane<Vec3>) -> [Plane<f32>; 3] {
    const AT_A_TIME: usize = 1 << 22;
    let size = normals.size();
    let mut planes = [(); 3].map(|()| Plane::filled(size, 0.0));
    let mut left = normals.into_values();
    while !left.is_empty() {
        let start = (left.len() - 1) / AT_A_TIME * AT_A_TIME;
        let [x, y, z] = planes.each_mut().map(|plane| plane.values_mut()[start..].par_iter_mut());
        left[start..].par_iter().zip(x).zip(y).zip(z).for_each(|(((n, x), y), z)| {
            let n = n.normalize_or(Vec3::Z);
            (*x, *y, *z) = (n.x, -n.y, n.z);
        });
        left.truncate(start);
        left.shrink_to_fit();
    }
    planes
}

impl Surface {
    /// Normalises the normals, drops what is not finite, grows the valid values outward and finds the depth jumps.
    pub fn new(maps: Maps) -> Result<Self, SurfaceError> {
        Self::with_depth_range(maps, None)
    }
    /// The same of maps whose depth range is known, px.
    pub(super) fn with_depth_range(maps: Maps, range_px: Option<f32>) -> Result<Self, SurfaceError> {
        Self::made(maps, range_px, &mut KnownNearest::default())
    }
    fn made(maps: Maps, range_px: Option<f32>, known: &mut KnownNearest) -> Result<Self, SurfaceError> {
        let Maps { mut normals, mut depth, mut coverage } = maps;
        let size = normals.size();
        for (other, s) in [("depth", depth.size()), ("mask", coverage.size())] {
            if s != size {
                return Err(SurfaceError::SizesDiffer { normals: size, other, size: s });
            }
        }
        let valid = Plane::from_fn(size, |x, y| {
            let n = normals.at(x, y);
            coverage.at(x, y) > 0 && depth.at(x, y).is_finite() && n.is_finite() && n.length() > 1e-6
        });
        // A partly covered pixel at the rim without a normal takes its neighbour's; further inside it is a hole.
        grow::punch_holes(&mut coverage, &valid);
        if valid.values().iter().any(|valid| !valid) {
            let nearest = known.take(&valid).ok_or(SurfaceError::Empty)?;
            grow::fill(&mut normals, &nearest);
            grow::fill(&mut depth, &nearest);
            known.keep(&valid, nearest);
        }
        let depth = depth.updated(|_, _, z| z.clamp(0.0, 1.0));
        let [nbar_x, nbar_y, nz] = apart(normals);
        let estimated = || links::depth_range_px(&nbar_x, &nbar_y, &nz, &depth, &coverage);
        let depth_range_px = range_px.unwrap_or_else(estimated);
        let links = links::find(&nbar_x, &nbar_y, &nz, &depth, &coverage, depth_range_px);
        let mut surface = Self::of_planes([nbar_x, nbar_y, nz, depth], [coverage, links], depth_range_px);
        surface.find_contours(&valid);
        Ok(surface)
    }
    /// n̄_x, n̄_y, n_z and depth; coverage and links.
    pub(super) fn of_planes(reading: [Plane<f32>; 4], bytes: [Plane<u8>; 2], depth_range_px: f32) -> Self {
        let ([nbar_x, nbar_y, nz, depth], [coverage, links]) = (reading, bytes);
        Self {
            size: nz.size(),
            nbar_x,
            nbar_y,
            nz,
            depth,
            coverage,
            eye: Eye::Afar,
            links,
            smooth_links: None,
            depth_range_px,
            curvatures: RecentCache::default(),
            rims: RecentCache::default(),
            kappas: RecentCache::default(),
            base: None,
            occlusions: RecentCache::default(),
            regions: RecentCache::default(),
            unwrappings: RecentCache::default(),
            plane_layouts: RecentCache::default(),
            plane_yields: RecentCache::default(),
            plane_springs: RecentCache::default(),
            near_view: OnceLock::new(),
            bounds: MapPyramids::default(),
            objects: OnceLock::new(),
            parts: None,
            contours: Arc::default(),
            sheets: RecentCache::default(),
            sheet_normals: None,
            sheet_of: None,
            origin: None,
        }
    }
    /// A surface made of parts, whose objects are known: no depth jump is needed to tell them apart.
    ///
    /// * `parts`: for each pixel which part it shows, from 1 on; 0 where there is none.
    /// * `piece_of`: for each part the piece of surface that it belongs to: parts grown into one share it. One that is
    ///   not listed is a piece of its own.
    /// * `known`: of the surface made before, so that the same need not be found again.
    pub fn with_parts(
        maps: Maps,
        parts: Plane<u32>,
        piece_of: &[u32],
        known: &mut KnownNearest,
    ) -> Result<Self, SurfaceError> {
        let mut surface = Self::made(maps, None, known)?;
        if parts.size() != surface.size {
            return Err(SurfaceError::SizesDiffer { normals: surface.size, other: "parts", size: parts.size() });
        }
        links::cut(&mut surface.links, |x, y| {
            let part = parts.at(x, y);
            piece_of.get(part as usize).copied().unwrap_or(part)
        });
        surface.parts = Some(Arc::new(parts));
        surface.find_creases();
        // Where parts touch without a jump there are contours, too.
        surface.contours = Arc::new(surface.with_contour_maps(None, contours::find).contours);
        Ok(surface)
    }
    /// Finds the contours, and puts readings of one side where the maps hold some of neither.
    fn find_contours(&mut self, valid: &Plane<bool>) {
        self.find_creases();
        let Found { contours, amended } = self.with_contour_maps(Some(valid), contours::find);
        self.contours = Arc::new(contours);
        let mut moved = false;
        for (i, reading) in amended {
            let z = &mut self.depth.values_mut()[i];
            moved |= (*z - reading.depth).abs() * self.depth_range_px > 1.0;
            *z = reading.depth;
            let normal = [&mut self.nbar_x, &mut self.nbar_y, &mut self.nz].map(|plane| &mut plane.values_mut()[i]);
            normal.into_iter().zip([reading.nbar.x, reading.nbar.y, reading.nz]).for_each(|(to, from)| *to = from);
        }
        if moved {
            let [nx, ny, nz] = [&self.nbar_x, &self.nbar_y, &self.nz];
            self.links = links::find(nx, ny, nz, &self.depth, &self.coverage, self.depth_range_px);
            self.find_creases();
        }
    }
    fn find_creases(&mut self) {
        self.smooth_links = creases::smooth_links(&self.links, [&self.nbar_x, &self.nbar_y]).map(Arc::new);
    }
    /// Calls with the maps that contours are found in. `valid`: where the maps told something, if it is known.
    pub(super) fn with_contour_maps<T>(&self, valid: Option<&Plane<bool>>, with: impl FnOnce(&ContourMaps) -> T) -> T {
        let Self { size, nbar_x, nbar_y, depth, coverage, links: all_links, .. } = self;
        let links = self.smooth_links_plane();
        with(&ContourMaps { size: *size, nbar: [nbar_x, nbar_y], depth, coverage, links, all_links, valid })
    }
    /// The sheet of a surface from its planes.
    pub(super) fn sheet_of_planes(&self, reading: [Plane<f32>; 4], bytes: [Plane<u8>; 2], of: SheetOf) -> Self {
        Self { eye: self.eye, sheet_of: Some(of), ..Self::of_planes(reading, bytes, self.depth_range_px) }
    }
    /// The same surface with other unit normals (y up), one for each pixel, and for each of its sheet; what depends on
    /// depth alone is shared.
    pub(super) fn with_normals(self: &Arc<Self>, normals: &Plane<Vec3>, of_sheet: Option<Plane<Vec3>>) -> Self {
        let reading = [normals.map(|n| n.x), normals.map(|n| -n.y), normals.map(|n| n.z), self.depth.clone()];
        Self {
            base: Some(self.base.as_ref().unwrap_or(self).clone()),
            eye: self.eye,
            contours: self.contours.clone(),
            smooth_links: self.smooth_links.clone(),
            parts: self.parts.clone(),
            sheet_normals: of_sheet,
            ..Self::of_planes(reading, [self.coverage.clone(), self.links.clone()], self.depth_range_px)
        }
    }
    /// The pixels that two populations see.
    pub fn contours(&self) -> &Arc<Contours> {
        &self.contours
    }
    /// How much of each pixel the surface covers: as the maps say, and on a rim that they left hard as its contour
    /// says.
    pub fn shares(&self) -> Plane<u8> {
        let mut shares = self.coverage.clone();
        for pixel in self.contours.pixels() {
            let (x, y) = (pixel.x as usize, pixel.y as usize);
            match (self.coverage.at(x, y) > 0, pixel.sees_surface()) {
                (true, false) => shares.set(x, y, quantise(pixel.share)),
                (false, true) => shares.set(x, y, quantise(1.0 - pixel.share)),
                _ => (),
            }
        }
        shares
    }
    /// What this is the sheet of: its pixels are readings of other populations, not pixels of the canvas.
    pub fn sheet_of(&self) -> Option<&SheetOf> {
        self.sheet_of.as_ref()
    }
    pub(super) fn sheets(&self) -> &RecentCache<(), Surface> {
        &self.sheets
    }
    pub(super) fn sheet_normals(&self) -> Option<&Plane<Vec3>> {
        self.sheet_normals.as_ref()
    }
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
    pub fn depth_plane(&self) -> &Plane<f32> {
        &self.depth
    }
    pub fn coverage_plane(&self) -> &Plane<u8> {
        &self.coverage
    }
    /// For each pixel, which of its four neighbours continue the same surface: bits of [`links`].
    pub fn links_plane(&self) -> &Plane<u8> {
        &self.links
    }
    /// The same without links across creases: for what is differenced to tell how it changes within a pixel.
    pub fn smooth_links_plane(&self) -> &Plane<u8> {
        self.smooth_links.as_deref().unwrap_or(&self.links)
    }
    /// Z: how many pixels deep the range 0 … 1 of depth is, estimated from how depth and normals agree.
    pub fn depth_range_px(&self) -> f32 {
        self.depth_range_px
    }
    /// Which part each pixel shows, from 1 on, where the surface was made of parts.
    pub fn parts_plane(&self) -> Option<&Plane<u32>> {
        self.parts.as_deref()
    }
    /// Min–max pyramids of the maps, for `support`.
    pub(super) fn bounds(&self) -> &MapPyramids {
        &self.bounds
    }
    pub(super) fn curvatures(&self) -> &RecentCache<u32, Curvature> {
        &self.curvatures
    }
    pub(super) fn rims_cell(&self) -> &RecentCache<(), Rims> {
        &self.rims
    }
    pub(super) fn kappas(&self) -> &RecentCache<Vec<[u32; 3]>, Kappa> {
        &self.kappas
    }
    /// The surface without the detail that was combined onto it.
    pub(super) fn base(&self) -> &Surface {
        self.base.as_deref().unwrap_or(self)
    }
    /// Computed by the calling thread alone: see `pyramid`.
    pub(super) fn objects_cell(&self) -> &OnceLock<Objects> {
        &self.objects
    }
    pub(super) fn regions(&self) -> &RecentCache<SurfaceRegion, CoverageGrid> {
        &self.regions
    }
    pub(super) fn unwrappings(&self) -> &RecentCache<[u32; 2], Unwrapping> {
        &self.unwrappings
    }
    pub(super) fn plane_layouts(&self) -> &RecentCache<[u32; 2], Option<Arc<PlaneLayout>>> {
        &self.plane_layouts
    }
    pub(super) fn occlusions(&self) -> &RecentCache<u32, Plane<f32>> {
        &self.occlusions
    }
    /// The covered pixels whose centres lie around a point of the map, and their bilinear shares, which add up to 1;
    /// none where none is covered.
    pub fn around(&self, q: Vec2) -> impl Iterator<Item = (usize, usize, f32)> + use<> {
        let corner = (q - 0.5).floor();
        let part = q - 0.5 - corner;
        let pixel = |dx: f32, dy: f32| {
            let (x, y) = self.pixel_of(corner + vec2(dx, dy));
            let share = (if dx > 0.0 { part.x } else { 1.0 - part.x }) * if dy > 0.0 { part.y } else { 1.0 - part.y };
            (x, y, if self.coverage(x, y) > 0 { share } else { 0.0 })
        };
        let pixels = [pixel(0.0, 0.0), pixel(1.0, 0.0), pixel(0.0, 1.0), pixel(1.0, 1.0)];
        let sum: f32 = pixels.iter().map(|(.., share)| share).sum();
        pixels.into_iter().filter(|(.., share)| *share > 0.0).map(move |(x, y, share)| (x, y, share / sum))
    }
    /// The pixel that holds a canvas point, clamped into the map.
    pub fn pixel_of(&self, q: Vec2) -> (usize, usize) {
        let clamp = |v: f32, n: u32| (v.max(0.0) as usize).min(n as usize - 1);
        (clamp(q.x, self.size.width), clamp(q.y, self.size.height))
    }
}
