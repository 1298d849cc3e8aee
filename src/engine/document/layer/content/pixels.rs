//! A paint layer: pixels, and where they came from.
//! Floor 4.

use super::{CanvasScale, Changed, Content, FarScene, LayerKind, TileContent, VisibleArea};
use crate::document::{LayerMap, MemoryCount};
use crate::math::{Rect, Vec2, vec2};
use crate::paint::Scene;
use crate::raster::warp::{PixelMap, warp_tiles};
use crate::raster::{TileAt, TileGrid};
use std::sync::Arc;

/// A paint layer.
#[derive(Clone, Default)]
pub struct PixelLayer {
    /// Where the pixels came from, if a file; empty for pixels painted here.
    pub file: String,
    /// Canvas column of the first column of the file.
    pub x: i32,
    /// Canvas row of the first row of the file.
    pub y: i32,
    /// On the canvas lattice, offset applied.
    pub tiles: TileGrid,
}

impl PixelLayer {
    /// All of it, moved by a map, also beyond the canvas by up to the canvas's length.
    pub(in crate::document) fn transformed(&self, map: &LayerMap) -> Self {
        if map.is_none() {
            return self.clone();
        }
        let canvas = map.canvas();
        let Rect { x0, y0, x1, y1 } = self.tiles.bounds();
        let corner = |x: i32, y: i32| map.plane.to_canvas(vec2(x as f32, y as f32));
        let corners: Option<Vec<Vec2>> = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
            .map(|(x, y)| corner(x, y))
            .into_iter()
            .collect();
        // What crosses the horizon has no bounds.
        let around = corners.map_or(canvas.rect(), |corners| {
            let low = corners.iter().copied().fold(Vec2::INFINITY, Vec2::min).floor();
            let high = corners.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max).ceil();
            Rect::new(low.x as i32, low.y as i32, high.x as i32, high.y as i32).grown(2)
        });
        let room = canvas.rect().grown(canvas.longer_side() as i32);
        let wanted: Vec<TileAt> = TileAt::covering(around.intersect(room)).collect();
        Self { tiles: warp_tiles(&self.tiles, map, map.filter, &wanted), ..self.clone() }
    }
}

impl LayerKind for PixelLayer {
    fn name(&self) -> &'static str {
        "pixels"
    }

    fn label(&self) -> &'static str {
        "Paint"
    }

    fn count(&self, count: &mut MemoryCount, _keeps: bool) {
        count.add_tiles(&self.tiles);
    }

    fn render_tile(&self, _scene: &Scene, at: TileAt) -> TileContent {
        TileContent::of_tile(self.tiles.tile(at).cloned())
    }

    fn render_far_side_tile(&self, scene: &FarScene) -> TileContent {
        let tile = self.tiles.tile(scene.tile.at);
        tile.map_or(TileContent::Nothing, |tile| {
            TileContent::Packed(Arc::new(scene.tile.same(tile)))
        })
    }

    fn scaled(&self, scale: &CanvasScale) -> Content {
        let corner = vec2(self.x as f32, self.y as f32) * scale.per_axis;
        let (x, y) = (corner.x.round() as i32, corner.y.round() as i32);
        Content::Pixels(PixelLayer {
            file: self.file.clone(),
            x,
            y,
            tiles: scale.grid(&self.tiles),
        })
    }

    fn moved(&self, by: Vec2) -> Option<Content> {
        Some(Content::Pixels(PixelLayer {
            x: self.x.saturating_add(by.x as i32),
            y: self.y.saturating_add(by.y as i32),
            tiles: self.tiles.translated(by.x as i32, by.y as i32),
            file: self.file.clone(),
        }))
    }

    fn on_canvas(&self, map: &LayerMap, last: Option<(&Content, &Content)>) -> Option<Content> {
        let canvas = map.canvas();
        let all = || TileAt::covering(canvas.rect());
        let tiles = match last {
            Some((Content::Pixels(own), Content::Pixels(seen))) => {
                let changed = own.tiles.changed_tiles(&self.tiles);
                let shows = |at: &TileAt| {
                    let source = map.source_rect(at.rect());
                    changed.iter().any(|changed| !changed.rect().intersect(source).is_empty())
                };
                let wanted: Vec<TileAt> = all().filter(shows).collect();
                let anew = warp_tiles(&self.tiles, map, map.filter, &wanted);
                let mut tiles = seen.tiles.clone();
                wanted.into_iter().for_each(|at| tiles.set(at, anew.tile(at).cloned()));
                tiles
            }
            _ => warp_tiles(&self.tiles, map, map.filter, &all().collect::<Vec<_>>()),
        };
        Some(Content::Pixels(PixelLayer { tiles, ..self.clone() }))
    }

    fn without_paint(&self) -> Option<Content> {
        Some(Content::Pixels(PixelLayer::default()))
    }

    fn files(&self) -> Vec<&str> {
        vec![&self.file]
    }

    fn visible_area(&self, _scene: Option<&Scene>) -> VisibleArea {
        VisibleArea::Tiles(self.tiles.iter().map(|(at, _)| at).collect())
    }

    fn difference_from(&self, old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        match old {
            Content::Pixels(old) => Changed::Tiles(old.tiles.changed_tiles(&self.tiles)),
            _ => Changed::Wholly,
        }
    }
}
