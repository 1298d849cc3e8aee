//! Floor 2: the surface that is painted on, and how an image bends over it.
//!
//! [`Surface`] holds the maps in one convention (camera space, image axes for n̄, depth 0 near … 1
//! far); other conventions exist only inside the readers of files (`io::maps`). [`operator`] holds
//! the equations, [`anchor`] the points where an image is pinned, and [`deformation`] evaluates
//! them over tiles.

mod accessors;
pub mod anchor;
mod cache;
pub mod chunks;
pub mod combine;
pub mod contours;
mod creases;
pub mod curvature;
pub mod deformation;
mod deformed_rect;
mod derived;
pub mod differentiate;
pub mod fit;
pub mod flow;
pub mod form_lines;
pub mod grain;
pub mod hatching;
pub mod integrate;
mod line_ends;
pub mod links;
mod maps;
pub mod nearest_feature;
pub mod objects;
mod occlusion;
pub mod operator;
pub mod plane_piece;
mod points;
mod poisson;
mod pyramid;
pub mod ray;
pub mod reach;
pub mod region;
pub mod scene;
pub mod shadow;
pub mod support;
pub mod transformed;
pub mod unwrap;
pub mod view;

pub use anchor::{Anchor, Bend, Weights};
pub use combine::DetailMap;
pub use contours::{ContourPixel, Contours};
pub use curvature::Curvature;
pub use deformation::Deformation;
pub use flow::{FlowField, StructureTensor};
pub use grain::NoiseRelief;
pub use nearest_feature::NearestCache;
pub use objects::{Objects, PaintLimit};
pub use operator::Operator;
pub use reach::DabReach;
pub use scene::Scene;
pub use support::SupportBounds;

use crate::math::{Size, Vec2, Vec3, srgb::quantize, vec2, vec3};
use crate::raster::Plane;
use contours::{ContourMaps, FarSide, Found};
use derived::DerivedCaches;
use points::PointSource;
use pyramid::MapPyramids;
use rayon::prelude::*;
use std::sync::Arc;
use transformed::Origin;
use view::Eye;

/// What a surface is made from. At least one of normals and depth must be there; the importer
/// derives the other.
pub struct Maps {
    /// Camera space: +x right, +y **up**, +z to the viewer. Zero, NaN or infinite where there is no
    /// surface; any length.
    pub normals: Plane<Vec3>,
    /// 0 near … 1 far over the surface; not finite where there is none.
    pub depth: Plane<f32>,
    /// Coverage by the surface, 255 wholly covered.
    pub coverage: Plane<u8>,
}

/// Why maps do not make a surface.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// The maps are not of one size.
    #[allow(missing_docs, reason = "the fields are what the sentence names")]
    #[error("the maps differ in size: normals {normals}, {other} {size}")]
    SizesDiffer { normals: Size, other: &'static str, size: Size },
    /// No pixel shows a surface.
    #[error("there is no surface at all: every pixel is background")]
    Empty,
    /// A map in perspective was requested.
    #[error("a surface cannot be put in perspective")]
    Perspective,
}

/// A picture of an object's shape. Every value is finite; where coverage is 0, the nearest surface
/// values are repeated, so that filters may read across the silhouette.
pub struct Surface {
    size: Size,
    /// n̄ = (n_x, −n_y): image axes, y down.
    nbar_x: Plane<f32>,
    nbar_y: Plane<f32>,
    nz: Plane<f32>,
    depth: Plane<f32>,
    coverage: Plane<u8>,
    /// From where it was seen.
    eye: Eye,
    /// Which neighbors belong to the same piece of surface (`links`).
    links: Plane<u8>,
    /// The same without those across creases; absent where there are none.
    smooth_links: Option<Arc<Plane<u8>>>,
    depth_range_px: f32,
    /// Ranges of the maps in blocks.
    bounds: MapPyramids,
    derived: DerivedCaches,
    /// The surface that detail was combined onto, if any; what depends on depth alone is computed
    /// there.
    base: Option<Arc<Surface>>,
    /// Which part each pixel shows, where the surface was made of parts; their objects are these.
    parts: Option<Arc<Plane<u32>>>,
    /// The pixels that two sides see.
    contours: Arc<Contours>,
    /// Their normals, where detail was combined onto them.
    far_normals: Option<Plane<Vec3>>,
    /// The surface that this one is the far side of, if it is one.
    far_side_of: Option<FarSide>,
    /// What this one was seen through a map of, if it was.
    origin: Option<Origin>,
    /// Where its points are read, if not on itself.
    points: Option<PointSource>,
}

/// n̄_x, n̄_y and n_z of normals. These are freed from their end on as they are taken apart, so
/// that both are never whole in memory.
fn split_normals(normals: Plane<Vec3>) -> [Plane<f32>; 3] {
    const AT_A_TIME: usize = 1 << 22;
    let size = normals.size();
    let mut planes = [(); 3].map(|()| Plane::full(size, 0.0));
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
    /// Normalizes the normals, drops what is not finite, grows the valid values outward and finds
    /// the depth jumps.
    pub fn new(maps: Maps) -> Result<Self, SurfaceError> {
        Self::with_depth_range(maps, None)
    }

    /// The same of maps whose depth range is known, px.
    fn with_depth_range(maps: Maps, range_px: Option<f32>) -> Result<Self, SurfaceError> {
        Self::build(maps, range_px, &mut NearestCache::default())
    }

    fn build(
        maps: Maps,
        range_px: Option<f32>,
        known: &mut NearestCache,
    ) -> Result<Self, SurfaceError> {
        let Maps { mut normals, mut depth, mut coverage } = maps;
        let size = normals.size();
        for (other, s) in [("depth", depth.size()), ("mask", coverage.size())] {
            if s != size {
                return Err(SurfaceError::SizesDiffer { normals: size, other, size: s });
            }
        }
        let valid = Plane::from_fn(size, |x, y| {
            let n = normals.at(x, y);
            coverage.at(x, y) > 0
                && depth.at(x, y).is_finite()
                && n.is_finite()
                && n.length() > 1e-6
        });
        // A partly covered pixel at the rim without a normal takes its neighbor's; further inside
        // it is a hole.
        nearest_feature::punch_holes(&mut coverage, &valid);
        if valid.values().iter().any(|valid| !valid) {
            let nearest = known.take(&valid).ok_or(SurfaceError::Empty)?;
            nearest_feature::fill(&mut normals, &nearest);
            nearest_feature::fill(&mut depth, &nearest);
            known.keep(&valid, nearest);
        }
        let depth = depth.updated(|_, _, z| z.clamp(0.0, 1.0));
        let [nbar_x, nbar_y, nz] = split_normals(normals);
        let estimated = || links::depth_range_px(&nbar_x, &nbar_y, &nz, &depth, &coverage);
        let depth_range_px = range_px.unwrap_or_else(estimated);
        let links = links::find(&nbar_x, &nbar_y, &nz, &depth, &coverage, depth_range_px);
        let mut surface =
            Self::of_planes([nbar_x, nbar_y, nz, depth], [coverage, links], depth_range_px);
        surface.find_contours(&valid);
        Ok(surface)
    }

    /// n̄_x, n̄_y, n_z and depth; coverage and links.
    fn of_planes(reading: [Plane<f32>; 4], bytes: [Plane<u8>; 2], depth_range_px: f32) -> Self {
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
            bounds: MapPyramids::default(),
            derived: DerivedCaches::default(),
            base: None,
            parts: None,
            contours: Arc::default(),
            far_normals: None,
            far_side_of: None,
            origin: None,
            points: None,
        }
    }

    /// A surface made of parts, whose objects are known: no depth jump is needed to separate them.
    ///
    /// * `parts`: for each pixel which part it shows, from 1 on; 0 where there is none.
    /// * `piece_of`: for each part the piece of surface that it belongs to: parts grown into one
    ///   share it. One that is not listed is a piece of its own.
    /// * `known`: of the surface made before, so that the same need not be found again.
    pub fn with_parts(
        maps: Maps,
        parts: Plane<u32>,
        piece_of: &[u32],
        known: &mut NearestCache,
    ) -> Result<Self, SurfaceError> {
        let mut surface = Self::build(maps, None, known)?;
        if parts.size() != surface.size {
            return Err(SurfaceError::SizesDiffer {
                normals: surface.size,
                other: "parts",
                size: parts.size(),
            });
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
            let normal = [&mut self.nbar_x, &mut self.nbar_y, &mut self.nz]
                .map(|plane| &mut plane.values_mut()[i]);
            normal
                .into_iter()
                .zip([reading.nbar.x, reading.nbar.y, reading.nz])
                .for_each(|(to, from)| *to = from);
        }
        if moved {
            let [nx, ny, nz] = [&self.nbar_x, &self.nbar_y, &self.nz];
            self.links = links::find(nx, ny, nz, &self.depth, &self.coverage, self.depth_range_px);
            self.find_creases();
        }
    }

    fn find_creases(&mut self) {
        self.smooth_links =
            creases::smooth_links(&self.links, [&self.nbar_x, &self.nbar_y]).map(Arc::new);
    }

    /// Calls with the maps that contours are found in. `valid`: where the maps held values, if it
    /// is known.
    fn with_contour_maps<T>(
        &self,
        valid: Option<&Plane<bool>>,
        with: impl FnOnce(&ContourMaps) -> T,
    ) -> T {
        let Self { size, nbar_x, nbar_y, depth, coverage, links: all_links, .. } = self;
        let links = self.smooth_links_plane();
        with(&ContourMaps {
            size: *size,
            nbar: [nbar_x, nbar_y],
            depth,
            coverage,
            links,
            all_links,
            valid,
        })
    }

    /// The far side of a surface from its planes.
    fn far_side_of_planes(
        &self,
        reading: [Plane<f32>; 4],
        bytes: [Plane<u8>; 2],
        of: FarSide,
    ) -> Self {
        Self {
            eye: self.eye,
            far_side_of: Some(of),
            ..Self::of_planes(reading, bytes, self.depth_range_px)
        }
    }

    /// The same surface with other unit normals (y up), one for each pixel, and for each of its
    /// far side; what depends on depth alone is shared.
    fn with_normals(
        self: &Arc<Self>,
        normals: &Plane<Vec3>,
        of_far_side: Option<Plane<Vec3>>,
    ) -> Self {
        let reading =
            [normals.map(|n| n.x), normals.map(|n| -n.y), normals.map(|n| n.z), self.depth.clone()];
        Self {
            base: Some(self.base.as_ref().unwrap_or(self).clone()),
            eye: self.eye,
            contours: self.contours.clone(),
            smooth_links: self.smooth_links.clone(),
            parts: self.parts.clone(),
            far_normals: of_far_side,
            ..Self::of_planes(
                reading,
                [self.coverage.clone(), self.links.clone()],
                self.depth_range_px,
            )
        }
    }
}
