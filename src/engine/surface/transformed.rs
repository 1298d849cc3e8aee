//! A surface seen through a map of the plane: turned, mirrored, scaled, cut, with its vectors.
//! Floor 2.
//!
//! What was made of the maps stays linked to them: a surface that is turned ten times is sampled
//! once.

use super::view::Eye;
use super::{Maps, Surface, SurfaceError, links, nearest_feature};
use crate::math::plane_map::PixelMove;
use crate::math::{Mat2, PlaneMap, Size, Vec2, Vec3, vec2, vec3};
use crate::raster::Plane;
use std::sync::Arc;

/// What a surface was made of.
#[derive(Clone)]
pub struct Origin {
    /// The surface before it was transformed.
    pub surface: Arc<Surface>,
    /// Canvas from the pixels of that surface; affine.
    pub map: PlaneMap,
}

impl Surface {
    /// What this surface was made of by [`Surface::transformed`] and [`Surface::onto`], the whole way;
    /// itself, if it was not.
    pub fn origin(self: &Arc<Self>) -> Origin {
        let own = || Origin { surface: self.clone(), map: PlaneMap::IDENTITY };
        self.origin.clone().unwrap_or_else(own)
    }

    /// The map by which [`Surface::fitted`] puts maps on a canvas: as large as it allows, centered.
    pub fn fit_map(maps: Size, canvas: Size) -> PlaneMap {
        let side = |of: u32, to: u32| f64::from(to) / f64::from(of);
        let scale = side(maps.width, canvas.width).min(side(maps.height, canvas.height));
        let shift = |of: u32, to: u32| 0.5 * (f64::from(to) - scale * f64::from(of));
        let (x, y) = (shift(maps.width, canvas.width), shift(maps.height, canvas.height));
        PlaneMap::affine([scale, 0.0, 0.0, scale, x, y]).unwrap_or_default()
    }

    /// Maps on a canvas: through a map, or fitted to it without one. Where either leaves every
    /// pixel in place, it is the very same surface.
    pub fn onto(
        self: &Arc<Self>,
        canvas: Size,
        map: Option<&PlaneMap>,
    ) -> Result<Arc<Surface>, SurfaceError> {
        let fit = Self::fit_map(self.size(), canvas);
        // To the last digit of what files hold, so that the same surface is read back.
        let map = map
            .map_or(Some(fit), |map| PlaneMap::affine(map.coefficients_as_written()?))
            .ok_or(SurfaceError::Perspective)?;
        let by = map.pixel_move_on(if self.size().area() > canvas.area() {
            self.size()
        } else {
            canvas
        });
        if by == Some(PixelMove::NONE) && canvas == self.size() {
            return Ok(self.clone());
        }
        let mut made = match by {
            Some(by) => self.moved(canvas, by)?,
            None if map.is_same_on(&fit, self.size()) => self.fitted(canvas)?,
            None => self.sampled(canvas, &map)?,
        };
        made.origin = Some(Origin { surface: self.clone(), map });
        Ok(Arc::new(made))
    }

    /// The surface where an affine map of the canvas takes it, on a canvas of another size.
    ///
    /// Slopes s = n̄ / n_z become s′ = k A^−T s, where A is the map's matrix and k = √|det A| the
    /// scale of depth: the normals of a turned map are those of the turned object. Moves of whole
    /// pixels, quarter turns and mirrors change no value; all else is sampled once, from what the
    /// surface was first made of. MATH 1.
    ///
    /// Fails where nothing of the surface is left, and for a perspective.
    pub fn transformed(
        self: &Arc<Self>,
        canvas: Size,
        map: &PlaneMap,
    ) -> Result<Arc<Surface>, SurfaceError> {
        let Origin { surface, map: own } = self.origin();
        surface.onto(canvas, Some(&own.then(map)))
    }

    /// Every pixel where a move of whole pixels takes it.
    fn moved(&self, canvas: Size, by: PixelMove) -> Result<Surface, SurfaceError> {
        let source = |x: usize, y: usize| {
            let (x, y) = by.source(x as i32, y as i32);
            self.size().rect().contains(x, y).then_some((x as usize, y as usize))
        };
        let held = Plane::from_fn(canvas, |x, y| source(x, y).is_some());
        let coverage =
            Plane::from_fn(canvas, |x, y| source(x, y).map_or(0, |(x, y)| self.coverage(x, y)));
        if coverage.values().iter().all(|&c| c == 0) {
            return Err(SurfaceError::Empty);
        }
        // Beyond the map its border goes on.
        let nearest =
            if held.values().contains(&false) { nearest_feature::nearest(&held) } else { None };
        let filled = |mut plane: Plane<f32>| {
            if let Some(nearest) = &nearest {
                nearest_feature::fill(&mut plane, nearest);
            }
            plane
        };
        let moved = |of: &(dyn Fn(usize, usize) -> f32 + Sync)| {
            filled(Plane::from_fn(canvas, |x, y| source(x, y).map_or(0.0, |(x, y)| of(x, y))))
        };
        let [nbar_x, nbar_y, nz] = self.normal_planes();
        let turned = |right: i32, down: i32| {
            // One of both is 0, the other one −1 or 1: −0 is none.
            moved(&move |x, y| right as f32 * nbar_x.at(x, y) + down as f32 * nbar_y.at(x, y) + 0.0)
        };
        let readings = [
            turned(by.right.0, by.down.0),
            turned(by.right.1, by.down.1),
            moved(&|x, y| nz.at(x, y)),
            moved(&|x, y| self.depth(x, y)),
        ];
        let moved_links = |links: &Plane<u8>| {
            Plane::from_fn(canvas, |x, y| {
                let is_inside = |dx, dy| canvas.rect().contains(x as i32 + dx, y as i32 + dy);
                source(x, y).map_or(0, |at| turned_links(links.at(at.0, at.1), by, is_inside))
            })
        };
        let linked = moved_links(self.links_plane());
        let mut next = Self::of_planes(readings, [coverage, linked], self.depth_range_px());
        next.smooth_links = self.smooth_links.as_deref().map(moved_links).map(Arc::new);
        next.contours = Arc::new(self.contours().moved(by, canvas));
        next.parts = self.parts_plane().map(|parts| {
            Arc::new(Plane::from_fn(canvas, |x, y| source(x, y).map_or(0, |(x, y)| parts.at(x, y))))
        });
        let matrix = Mat2::from_cols(as_vec(by.right), as_vec(by.down));
        Ok(next.with_eye(self.transformed_eye(canvas, 1.0, |p| matrix * p + as_vec(by.origin))))
    }

    /// Every pixel as the mean of what it shows.
    fn sampled(&self, canvas: Size, map: &PlaneMap) -> Result<Surface, SurfaceError> {
        let affine = map.as_affine().ok_or(SurfaceError::Perspective)?;
        let inverse = map.inverse().as_affine().ok_or(SurfaceError::Perspective)?;
        // A^−T of image axes, and how much a pixel shows along the map's axes.
        let (across, back) = (inverse.matrix2.transpose(), inverse.matrix2);
        let scale = affine.matrix2.determinant().abs().sqrt();
        let half = vec2(back.row(0).length(), back.row(1).length()) * 0.5;
        let read =
            self.texels(canvas, half, |q| map.from_canvas(q).map_or(Vec2::splat(-1.0), |(p, _)| p));
        let normals = read.map(|v| {
            let nbar = scale * (across * vec2(v.normal.x, -v.normal.y));
            vec3(nbar.x, -nbar.y, v.normal.z).normalize_or(Vec3::ZERO)
        });
        let maps =
            Maps { normals, depth: read.map(|v| v.depth), coverage: read.map(|v| v.coverage) };
        let mut made = Self::with_depth_range(maps, Some(self.depth_range_px() * scale))?;
        made.parts = self.parts_plane().map(|parts| {
            Arc::new(Plane::from_fn(canvas, |x, y| {
                let q = vec2(x as f32 + 0.5, y as f32 + 0.5);
                let at = map.from_canvas(q).map_or(Vec2::NEG_INFINITY, |(p, _)| p.floor());
                parts.get(at.x as i32, at.y as i32).unwrap_or(0)
            }))
        });
        let eye = self.transformed_eye(canvas, scale, |p| affine.transform_point2(p));
        Ok(made.with_eye(eye))
    }

    fn transformed_eye(&self, canvas: Size, scale: f32, map: impl Fn(Vec2) -> Vec2) -> Eye {
        self.eye().moved(scale, |beside| map(self.size().center() + beside) - canvas.center())
    }
}

fn as_vec((x, y): (i32, i32)) -> Vec2 {
    vec2(x as f32, y as f32)
}

/// Links of a pixel after a move; those to neighbors that are not there are gone.
fn turned_links(linked: u8, by: PixelMove, is_there: impl Fn(i32, i32) -> bool) -> u8 {
    const STEPS: [(u8, (i32, i32)); 4] = [
        (links::LEFT, (-1, 0)),
        (links::RIGHT, (1, 0)),
        (links::UP, (0, -1)),
        (links::DOWN, (0, 1)),
    ];
    let bit_of = |step: (i32, i32)| {
        STEPS.iter().find(|(_, other)| *other == step).map_or(0, |(bit, _)| *bit)
    };
    let turned =
        STEPS.iter().filter(|(bit, _)| linked & bit != 0).map(|(_, (dx, dy))| by.turned(*dx, *dy));
    turned.filter(|(dx, dy)| is_there(*dx, *dy)).fold(0, |set, step| set | bit_of(step))
}

#[cfg(test)]
mod tests;
