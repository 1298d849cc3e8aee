//! Warps of layers: what a layer shows, seen through its mesh and its liquify. Floor 4.
//!
//! Both are one displacement backward, evaluated a tile at a time: a pixel of the canvas shows what
//! the layer would show elsewhere. Paint and masks are sampled once through it and their
//! transforms. Live layers and groups are composed undisplaced, both sides of a contour pixel
//! mixed, and seen through it; what was composed is kept while only the displacement changes. Tiles
//! that show themselves are composed as if there were no warp.

mod cache;

pub(in crate::document) use cache::{WarpCache, WarpTiles};

use super::content::PixelLayer;
use super::map::LayerMap;
use super::mask::{LayerMask, MaskKind};
use super::transform::TransformShape;
use super::transform::mesh::Mesh;
use super::{Layer, LayerId};
use crate::document::Document;
use crate::math::{Mat2, PlaneMap, Rect, Size, Vec2, parallel, vec2};
use crate::raster::warp::{PixelMap, TileMap, TilePoints, warp_block, warp_tile};
use crate::raster::{Lattice, Plane, Resampling, TileAt, TileGrid};
use rayon::prelude::*;
use std::sync::Arc;

/// The displacement of a layer by its mesh and its liquify.
#[derive(Clone)]
pub struct LayerWarp {
    canvas: Size,
    /// What takes the list that holds the layer to the canvas.
    outside: PlaneMap,
    /// Backward.
    mesh: Option<Arc<Lattice>>,
    liquify: Option<Arc<Lattice>>,
    /// How pixels are sampled through it.
    pub filter: Resampling,
}

impl PartialEq for LayerWarp {
    fn eq(&self, other: &Self) -> bool {
        let same = |a: &Option<Arc<Lattice>>, b: &Option<Arc<Lattice>>| match (a, b) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        (self.canvas, self.outside, self.filter) == (other.canvas, other.outside, other.filter)
            && same(&self.mesh, &other.mesh)
            && same(&self.liquify, &other.liquify)
    }
}

impl Layer {
    /// A mesh or liquify displaces it.
    pub fn is_warped(&self) -> bool {
        self.liquify.is_some() || self.mesh_warp().is_some()
    }

    /// Its mesh, unless that is a matrix.
    fn mesh_warp(&self) -> Option<&Arc<Mesh>> {
        match self.transform.as_ref().map(|transform| &transform.shape) {
            Some(TransformShape::Mesh(mesh)) if mesh.as_affine().is_none() => Some(mesh),
            _ => None,
        }
    }
}

impl Document {
    /// What displaces the list that holds a layer: the warps of the groups around it, the outermost
    /// first.
    pub fn warps_around(&self, id: LayerId) -> Vec<LayerWarp> {
        let group = self.place_of(id).and_then(|place| place.group);
        group.map_or_else(Vec::new, |group| self.warps_of(group))
    }

    /// What displaces a layer: the warps of the groups around it, the outermost first, and its own.
    pub fn warps_of(&self, id: LayerId) -> Vec<LayerWarp> {
        let own =
            self.layer(id).zip(self.map_of(id)).and_then(|(layer, map)| LayerWarp::of(layer, &map));
        self.warps_around(id).into_iter().chain(own).collect()
    }
}

impl LayerWarp {
    /// For a layer with its map; `None` where nothing displaces it.
    pub(in crate::document) fn of(layer: &Layer, map: &LayerMap) -> Option<Self> {
        let (mesh, liquify) =
            (layer.mesh_warp(), layer.liquify.clone().filter(|lattice| !lattice.is_empty()));
        if mesh.is_none() && liquify.is_none() {
            return None;
        }
        // What stays in place must look as it did, so the cubic must pass through the pixels, which
        // Mitchell's does not.
        let is_kept = mesh.is_none()
            && map.pixel_move().is_some()
            && !matches!(map.filter, Resampling::Linear | Resampling::Nearest);
        let filter = if is_kept { Resampling::Sharp } else { map.filter };
        let mesh = mesh.map(|mesh| mesh.backward(map.canvas()));
        Some(Self { canvas: map.canvas(), outside: map.map_outside_own(), mesh, liquify, filter })
    }

    /// What a mesh takes from beyond the canvas is nothing; liquify continues the picture's border.
    pub(in crate::document) fn has_continued_border(&self) -> bool {
        self.mesh.is_none()
    }

    /// Which point of the unwarped layer shows at each pixel of a tile, seen through one more map;
    /// `None` where the tile shows itself.
    ///
    /// * `own`: what takes the layer's frame to the canvas; the identity for what is composed on
    ///   the canvas.
    pub(in crate::document) fn tile_map(&self, at: TileAt, own: &PlaneMap) -> Option<TileMap> {
        let rect = at.rect();
        let middle = |k: usize| {
            let (x, y) = (k % rect.width(), k / rect.width());
            vec2((rect.x0 + x as i32) as f32 + 0.5, (rect.y0 + y as i32) as f32 + 0.5)
        };
        let nowhere = (Vec2::splat(-1e6), Mat2::IDENTITY);
        let mut points = if self.outside == PlaneMap::IDENTITY {
            self.on_list(at)?
        } else {
            let shown = self.outside.source_rect(rect);
            let is_still = |of: &Option<Arc<Lattice>>| {
                of.as_ref().is_none_or(|lattice| {
                    lattice.blocks().all(|(b, _)| {
                        b.rect()
                            .grown(2 * crate::raster::lattice::CELL as i32)
                            .intersect(shown)
                            .is_empty()
                    })
                })
            };
            if is_still(&self.mesh) && is_still(&self.liquify) {
                return None;
            }
            let point = |k: usize| {
                let (q, first) = self.outside.from_canvas(middle(k))?;
                let (p, inner) = self.displaced_point(q);
                let last = self.outside.stretch_at(p)?;
                Some((self.outside.to_canvas(p)?, last * inner * first))
            };
            let mut points = TilePoints::new(rect.width() * rect.height());
            (0..points.len()).for_each(|k| points.set(k, point(k).unwrap_or(nowhere)));
            points
        };
        if *own != PlaneMap::IDENTITY {
            for k in 0..points.len() {
                let (p, jacobian) = points.at(k);
                let through = own.from_canvas(p).map(|(at, inner)| (at, inner * jacobian));
                points.set(k, through.unwrap_or(nowhere));
            }
        }
        Some(TileMap::new(rect, points))
    }

    /// The same for a list that is the canvas, along rows.
    fn on_list(&self, at: TileAt) -> Option<TilePoints> {
        let on_tile =
            |of: &Option<Arc<Lattice>>| of.as_ref().and_then(|lattice| lattice.on_tile(at));
        let Some(mut points) = on_tile(&self.liquify) else { return on_tile(&self.mesh) };
        if let Some(mesh) = &self.mesh {
            for k in 0..points.len() {
                let (q, jacobian) = points.at(k);
                let v = mesh.at(q);
                points.set(k, (q + v.by, (Mat2::IDENTITY + v.jacobian) * jacobian));
            }
        }
        Some(points)
    }

    /// The point that shows at a point of the list, and its derivative.
    fn displaced_point(&self, q: Vec2) -> (Vec2, Mat2) {
        let (mut p, mut jacobian) = (q, Mat2::IDENTITY);
        for lattice in [&self.liquify, &self.mesh].into_iter().flatten() {
            let u = lattice.at(p);
            (p, jacobian) = (p + u.by, (Mat2::IDENTITY + u.jacobian) * jacobian);
        }
        (p, jacobian)
    }

    /// The point of the unwarped layer that shows at a point of the canvas.
    pub fn source_of(&self, q: Vec2) -> Vec2 {
        let source = self
            .outside
            .from_canvas(q)
            .and_then(|(q, _)| self.outside.to_canvas(self.displaced_point(q).0));
        source.unwrap_or(q)
    }

    /// The tiles that show some of the unwarped layer's tiles.
    pub(in crate::document) fn showing(&self, source: &[TileAt]) -> Vec<TileAt> {
        if source.is_empty() {
            return Vec::new();
        }
        let around = source.iter().map(|at| at.rect()).reduce(Rect::union).unwrap_or(Rect::EMPTY);
        let shows = |at: &TileAt| match self.tile_map(*at, &PlaneMap::IDENTITY) {
            None => source.contains(at),
            Some(map) => {
                let shown = self.rect_within_border(map.source_rect(at.rect()));
                let meets = |from: &TileAt| !from.rect().intersect(shown).is_empty();
                !around.intersect(shown).is_empty() && source.iter().any(meets)
            }
        };
        let all: Vec<TileAt> = TileAt::covering(self.canvas.rect()).collect();
        all.into_par_iter().filter(shows).collect()
    }

    /// What is read for a rectangle: where the border is continued, the border.
    fn rect_within_border(&self, rect: Rect) -> Rect {
        if !self.has_continued_border() {
            return rect;
        }
        let (w, h) = (self.canvas.width as i32, self.canvas.height as i32);
        let (x0, y0) = (rect.x0.clamp(0, w - 1), rect.y0.clamp(0, h - 1));
        Rect::new(x0, y0, rect.x1.clamp(x0 + 1, w), rect.y1.clamp(y0 + 1, h))
    }

    /// The tiles in which two displacements of one layer may differ; `None`: anywhere.
    pub(in crate::document) fn changed_tiles(
        old: Option<&Self>,
        new: Option<&Self>,
    ) -> Option<Vec<TileAt>> {
        let any = old.or(new)?;
        let alike = |a: &Self| {
            a.mesh.is_none() && a.outside == PlaneMap::IDENTITY && a.canvas == any.canvas
        };
        if ![old, new].into_iter().flatten().all(alike) {
            return None;
        }
        let lattice =
            |warp: Option<&Self>| warp.and_then(|warp| warp.liquify.clone()).unwrap_or_default();
        let canvas = any.canvas.rect();
        let is_seen = |at: &TileAt| !at.rect().intersect(canvas).is_empty();
        Some(lattice(old).changed_tiles(&lattice(new)).into_iter().filter(is_seen).collect())
    }
}

/// The known result for a layer's paint or mask under another displacement.
pub(in crate::document) struct LastWarp<'l, T> {
    pub own: &'l T,
    pub seen: &'l T,
    pub warp: Option<&'l LayerWarp>,
}

impl PixelLayer {
    /// Its pixels on the canvas, sampled once through its map and its displacement.
    pub(in crate::document) fn displaced(
        &self,
        map: &LayerMap,
        warp: &LayerWarp,
        last: Option<LastWarp<Self>>,
    ) -> Self {
        let mut tiles = TileGrid::default();
        let canvas = map.canvas().rect();
        let mut wanted: Vec<TileAt> = TileAt::covering(canvas).collect();
        if let Some(last) = last
            && let Some(other) = LayerWarp::changed_tiles(last.warp, Some(warp))
        {
            let changed = last.own.tiles.changed_tiles(&self.tiles);
            if changed.is_empty() {
                wanted = other;
                tiles = last.seen.tiles.clone();
            }
        }
        let one = |at: &TileAt| match warp.tile_map(*at, &map.plane) {
            Some(moved) => warp_tile(&self.tiles, &moved, warp.filter, *at),
            None => warp_tile(&self.tiles, map, map.filter, *at),
        };
        let seen: Vec<_> = parallel::map(&wanted, one);
        tiles.reserve(canvas);
        wanted.into_iter().zip(seen).for_each(|(at, tile)| tiles.set(at, tile));
        Self { tiles, ..self.clone() }
    }
}

/// A mask's picture on the canvas, sampled once through the layer's map and displacement.
pub(in crate::document) fn displaced_mask(
    mask: &LayerMask,
    map: &LayerMap,
    warp: &LayerWarp,
    last: Option<LastWarp<LayerMask>>,
) -> LayerMask {
    let MaskKind::File { file, coverage } = &mask.kind else { return mask.clone() };
    let canvas = coverage.size().rect();
    let mut wanted: Vec<TileAt> = TileAt::covering(canvas).collect();
    let mut out: Plane<u8> = Plane::full(coverage.size(), 0);
    if let Some(last) = last
        && let MaskKind::File { coverage: seen, .. } = &last.seen.kind
        && let Some(other) = LayerWarp::changed_tiles(last.warp, Some(warp))
        && seen.size() == coverage.size()
    {
        (wanted, out) = (other, Plane::clone(seen));
    }
    let one = |at: &TileAt| {
        let rect = at.rect().intersect(canvas);
        match warp.tile_map(*at, &map.plane) {
            Some(moved) => warp_block(coverage, &moved, warp.filter, rect),
            None => warp_block(coverage, map, map.filter, rect),
        }
    };
    let values: Vec<Vec<(i32, i32, u8)>> = parallel::map(&wanted, one);
    values.into_iter().flatten().for_each(|(x, y, value)| out.set(x as usize, y as usize, value));
    LayerMask {
        kind: MaskKind::File { file: file.clone(), coverage: Arc::new(out) },
        ..mask.clone()
    }
}

impl Document {
    /// The displacement of a layer; `None` where nothing displaces it, or there is no such layer.
    pub fn warp_of(&self, id: LayerId) -> Option<LayerWarp> {
        LayerWarp::of(self.layer(id)?, &self.map_of(id)?)
    }
}

#[cfg(test)]
mod tests;
