//! Points between pixels: what anchors, the centers of dabs, brushes and the seeds of regions read
//! of a surface. Floor 2. Not here: the operators that use it (`deformation`).
//!
//! A point reads the piece of surface that it lies on: bilinearly from the pixels around it that
//! links join to the one that holds it. In the middle of a pixel that is what the pixel holds. A
//! surface of another size is read where the document's own is, so that a larger picture is pinned
//! like the original.

use super::operator::MapValues;
use super::{Surface, SurfaceError, links};
use crate::math::{Size, Vec2, vec2};
use std::ops::{Add, Mul};
use std::sync::Arc;

/// Where the points of a surface of another size than its document's are read.
pub(super) struct PointSource {
    /// Of the document's own size.
    surface: Arc<Surface>,
    /// Its px per px of the surface that has this source.
    scale: Vec2,
    /// Depths of both mean the same.
    has_same_depths: bool,
}

/// The pixels around a point, and the links that join each to the next one across and down.
struct AroundPoint {
    /// Upper left, upper right, lower left, lower right; at the border some are the same.
    pixels: [(usize, usize); 4],
    /// Bilinear.
    shares: [f32; 4],
}

impl Surface {
    /// The same surface for a document of another size, whose points are read on this one.
    pub fn scaled(self: &Arc<Self>, canvas: Size) -> Result<Arc<Surface>, SurfaceError> {
        let scaled = self.stretched(canvas)?;
        let points = PointSource { has_same_depths: true, ..PointSource::of(self, canvas) };
        Ok(Arc::new(Surface { points: Some(points), ..scaled }))
    }

    /// With the directions at points read on that of a document of another size, if there is one.
    pub(crate) fn pointing_on(self, document: Option<&Arc<Surface>>) -> Self {
        let points = document.map(|document| PointSource::of(document, self.size));
        Surface { points, ..self }
    }

    /// The surface on which points are read, and where a point of this one lies on it.
    pub fn read_at(&self, q: Vec2) -> (&Surface, Vec2) {
        match &self.points {
            Some(points) => points.surface.read_at(q * points.scale),
            None => (self, q),
        }
    }

    /// What the maps hold at a point; `None` off the surface.
    pub fn values_at(&self, q: Vec2) -> Option<MapValues> {
        let (surface, at) = self.read_at(q);
        (surface.is_on(at)).then(|| self.values_near(q))
    }

    /// The same; off the surface, what it holds nearest to the point: maps are grown outward.
    pub fn values_near(&self, q: Vec2) -> MapValues {
        let (surface, at) = self.read_at(q);
        let values = surface.interpolate_maps(at);
        let depth = match self.points.as_ref().is_none_or(|points| points.has_same_depths) {
            true => values.depth,
            false => self.interpolate(q, |x, y| self.depth(x, y)),
        };
        MapValues { depth, ..values }
    }

    /// The maps between the pixels of this surface itself.
    fn interpolate_maps(&self, q: Vec2) -> MapValues {
        let mut around = self.linked_pixels(q);
        let (x, y) = match (around.next(), around.next()) {
            (Some(_), Some(_)) => {
                let of = |x: usize, y: usize| self.normal(x, y).extend(self.depth(x, y));
                let (blended, nearest) = (self.interpolate(q, of), self.pixel_of(q));
                let normal = blended.truncate().normalize_or(self.normal(nearest.0, nearest.1));
                return MapValues {
                    depth: blended.w,
                    nbar: vec2(normal.x, -normal.y),
                    nz: normal.z,
                };
            }
            (Some((x, y, _)), None) => (x, y),
            (None, _) => self.pixel_of(q),
        };
        MapValues { depth: self.depth(x, y), nbar: self.nbar(x, y), nz: self.normal(x, y).z }
    }

    /// A value of each pixel between pixels: the mean over [`Surface::linked_pixels`]; where none is
    /// covered, at the pixel that holds the point.
    pub fn interpolate<T: Add<Output = T> + Mul<f32, Output = T>>(
        &self,
        q: Vec2,
        of: impl Fn(usize, usize) -> T,
    ) -> T {
        let parts = self.linked_pixels(q).map(|(x, y, share)| of(x, y) * share);
        parts.reduce(|sum, part| sum + part).unwrap_or_else(|| {
            let (x, y) = self.pixel_of(q);
            of(x, y)
        })
    }

    /// The pixels whose centers lie around a point of the map and which links join, without
    /// crossing a contour, to the one that holds it, or to the covered one nearest to it; and their
    /// bilinear shares, which add up to 1. None where none is covered.
    pub fn linked_pixels(&self, q: Vec2) -> impl Iterator<Item = (usize, usize, f32)> + use<> {
        let AroundPoint { pixels, mut shares } = AroundPoint::of(self, q);
        let covered = pixels.map(|(x, y)| self.coverage(x, y) > 0);
        // Of equal shares the last: a point between pixels is held by the one to its right and
        // below.
        let held = (0..4).filter(|i| covered[*i]).max_by(|a, b| shares[*a].total_cmp(&shares[*b]));
        let is_joined = held.map_or([false; 4], |held| self.joined_pixels(&pixels, held));
        shares
            .iter_mut()
            .zip(is_joined)
            .filter(|(_, joined)| !joined)
            .for_each(|(share, _)| *share = 0.0);
        let sum: f32 = shares.iter().sum();
        let parts = pixels.into_iter().zip(shares).filter(|(_, share)| *share > 0.0);
        parts.map(move |((x, y), share)| (x, y, share / sum))
    }

    /// Which of four pixels links join to one of them.
    fn joined_pixels(&self, pixels: &[(usize, usize); 4], held: usize) -> [bool; 4] {
        let link = |from: usize, to: usize| {
            let ((x, y), (u, v)) = (pixels[from], pixels[to]);
            let bit = match (u as i32 - x as i32, v as i32 - y as i32) {
                (0, 0) => return true,
                (1, 0) => links::RIGHT,
                (-1, 0) => links::LEFT,
                (0, 1) => links::DOWN,
                _ => links::UP,
            };
            self.smooth_links_plane().at(x, y) & bit != 0
        };
        // Numbered by bits: 1 across, 2 down.
        let (across, down, corner) = (held ^ 1, held ^ 2, held ^ 3);
        let mut joined = [false; 4];
        joined[held] = true;
        (joined[across], joined[down]) = (link(held, across), link(held, down));
        joined[corner] =
            joined[across] && link(across, corner) || joined[down] && link(down, corner);
        joined
    }

    /// Whether the pixel that holds a point is covered.
    pub fn is_on(&self, q: Vec2) -> bool {
        let (x, y) = (q.x.floor() as i32, q.y.floor() as i32);
        q.is_finite() && self.coverage_plane().get(x, y).is_some_and(|c| c > 0)
    }

    /// The pixel that holds a canvas point, clamped into the map.
    pub fn pixel_of(&self, q: Vec2) -> (usize, usize) {
        let clamp = |v: f32, n: u32| (v.max(0.0) as usize).min(n as usize - 1);
        (clamp(q.x, self.size().width), clamp(q.y, self.size().height))
    }
}

impl PointSource {
    fn of(document: &Arc<Surface>, canvas: Size) -> Self {
        let (from, to) = (document.size(), canvas);
        let scale =
            vec2(from.width as f32 / to.width as f32, from.height as f32 / to.height as f32);
        Self { surface: document.clone(), scale, has_same_depths: false }
    }
}

impl AroundPoint {
    fn of(surface: &Surface, q: Vec2) -> Self {
        let corner = (q - 0.5).floor();
        let part = q - 0.5 - corner;
        let side = |far: bool, part: f32| if far { part } else { 1.0 - part };
        let at = |i: usize| (i & 1 == 1, i & 2 == 2);
        let pixel = |i: usize| {
            let (right, below) = at(i);
            surface.pixel_of(corner + vec2(f32::from(right), f32::from(below)))
        };
        let share = |i: usize| side(at(i).0, part.x) * side(at(i).1, part.y);
        Self { pixels: std::array::from_fn(pixel), shares: std::array::from_fn(share) }
    }
}

#[cfg(test)]
mod tests;
