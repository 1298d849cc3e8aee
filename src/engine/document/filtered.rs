//! Paint filtered for good, within the selection. Floor 4. Not here: filter layers
//! (`layer::content`), what filters do (`paint::filter`).

use super::{Content, Document, LayerId, LayerLock, PixelLayer};
use crate::math::{Rect, parallel};
use crate::paint::LiveFilter;
use crate::paint::filter::{FilterPlace, FilterSource, FilterWindow};
use crate::raster::{PlanarTile, TILE, TileAt, TileCoverage, TileGrid};
use std::sync::Arc;

/// The paint of a layer; beyond `bounds` its border is repeated.
struct PaintSource<'a> {
    tiles: &'a TileGrid,
    bounds: Rect,
}

impl FilterSource for PaintSource<'_> {
    fn bounds(&self) -> Rect {
        self.bounds
    }

    fn window(&self, rect: Rect) -> FilterWindow {
        let mut window =
            FilterWindow::gather(rect, self.bounds, |x, y, row| self.tiles.copy_row(x, y, row));
        // Grids count in levels.
        window.pixels_mut().as_flattened_mut().iter_mut().for_each(|v| *v /= 255.0);
        window
    }
}

impl Document {
    /// With the paint of a layer filtered, within the selection if there is one. Paint that ends at
    /// the canvas's edge is taken to continue beyond it. `None` for a layer that is no paint layer,
    /// or is locked.
    pub fn with_paint_filtered(&self, layer: LayerId, by: &LiveFilter) -> Option<Document> {
        let own = self.layer(layer).filter(|layer| layer.lock != LayerLock::All)?;
        let Content::Pixels(_) = own.content else { return None };
        // A selection lies on the canvas, as do the places that a filter depends on.
        let shown = self.with_transform_applied(layer)?;
        let own = shown.layer(layer).filter(|layer| !layer.is_warped())?;
        let Content::Pixels(pixels) = &own.content else { return None };
        let scene = shown.scene_of(layer).unwrap_or_else(|| shown.scene());
        by.warm(&scene);
        let keeps_alpha = own.lock == LayerLock::Alpha;
        let bounds = painted_rect(&pixels.tiles, self.size.rect());
        let source = PaintSource { tiles: &pixels.tiles, bounds };
        let selected = self.active_coverage();
        let wanted = selected.map_or(bounds, |selected| selected.covered_rect());
        let blocks = by.blocks(wanted, bounds);
        let of_block = |block: &Rect| {
            let place = FilterPlace::new(&scene, *block, 1.0);
            let filtered = by.apply(&place, &source);
            let tile = |at: TileAt| (at, filtered_tile(&pixels.tiles, &filtered, at, keeps_alpha));
            TileAt::covering(*block).map(tile).collect::<Vec<_>>()
        };
        let made = parallel::map(&blocks, of_block).into_iter().flatten();
        let mut tiles: TileGrid = pixels.tiles.clone();
        tiles.reserve(bounds);
        for (at, after) in made {
            let old = pixels.tiles.tile(at);
            let next = match selected.map(|selected| selected.tile(at)) {
                Some(None) => continue,
                None => after,
                Some(Some(covered)) if covered.is_whole() => after,
                Some(Some(covered)) => {
                    let bytes = covered.bytes();
                    let share = |x: usize, y: usize| f32::from(bytes[y * TILE + x]) / 255.0;
                    let mut mixed = PlanarTile::of_tile(old.map(|tile| &**tile));
                    mixed.mix_toward(&after, &TileCoverage::FULL.times(share));
                    mixed
                }
            };
            tiles.set(at, next.to_tile_over(old.map(|tile| &**tile)).map(Arc::new));
        }
        let next = PixelLayer { file: String::new(), tiles, ..pixels.clone() };
        shown.with_layer(layer, |layer| layer.content = Content::Pixels(next))
    }
}

/// The canvas with what is painted beyond it.
fn painted_rect(tiles: &TileGrid, canvas: Rect) -> Rect {
    let mut painted = canvas;
    for (at, tile) in tiles.iter().filter(|(at, _)| at.rect().intersect(canvas) != at.rect()) {
        let corner = at.rect();
        for i in (0..TILE * TILE).filter(|i| tile.is_painted(*i)) {
            let (x, y) = (corner.x0 + (i % TILE) as i32, corner.y0 + (i / TILE) as i32);
            painted = painted.union(Rect::new(x, y, x + 1, y + 1));
        }
    }
    painted
}

/// A tile of filtered paint; beyond what was filtered it stays.
fn filtered_tile(
    tiles: &TileGrid,
    filtered: &FilterWindow,
    at: TileAt,
    keeps_alpha: bool,
) -> PlanarTile {
    let (corner, inside) = (at.rect(), at.rect().intersect(filtered.rect()));
    let mut pixels = PlanarTile::of_tile(tiles.tile(at).map(|tile| &**tile));
    for y in inside.y0..inside.y1 {
        let row = &mut pixels.rows_mut()[(y - corner.y0) as usize];
        for x in inside.x0..inside.x1 {
            let place = (x - corner.x0) as usize;
            let mut pixel = filtered.at(x, y);
            if keeps_alpha {
                let old = row.pixel(place);
                let share = if pixel[3] > 0.0 { old[3] / pixel[3] } else { 0.0 };
                pixel = if share > 0.0 { pixel.map(|v| v * share) } else { old };
            }
            row.set(place, pixel);
        }
    }
    pixels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Layer, Progress, flatten};
    use crate::math::Size;
    use crate::paint::filter::{GaussianBlur, WrappedOffset};
    use crate::paint::{PictureFilter, Selection};
    use crate::raster::CoverageGrid;

    const SIZE: Size = Size::new(160, 70);

    /// Red paint on the left half.
    fn painted() -> Document {
        let rgba = [200, 0, 0, 255].repeat(80 * 70);
        let tiles = TileGrid::from_straight_rgba(&rgba, 80, 70, 0, 0);
        Document { layers: vec![Arc::new(Layer::new("paint", tiles))], ..Document::empty(SIZE) }
    }

    fn pixel(document: &Document, x: i32, y: i32) -> [u8; 4] {
        flatten(document, &Progress::default()).unwrap().pixel(x, y)
    }

    fn blur() -> LiveFilter {
        LiveFilter::new(PictureFilter::GaussianBlur(GaussianBlur { radius: 5.0 }))
    }

    #[test]
    fn paint_is_filtered_within_the_selection_and_stays_whole_at_the_canvas_edge() {
        let document = painted();
        let id = document.layers[0].id;
        let whole = document.with_paint_filtered(id, &blur()).unwrap();
        assert_eq!(pixel(&whole, 3, 0), [200, 0, 0, 255]);
        let [r, _, _, a] = pixel(&whole, 82, 30);
        assert!((70..110).contains(&a) && r.abs_diff((f32::from(a) * 200.0 / 255.0) as u8) <= 1);
        let upper = CoverageGrid::full(Rect::new(0, 0, 160, 35));
        let selected = document.with_selection(Some(Selection::new(upper)));
        let part = selected.with_paint_filtered(id, &blur()).unwrap();
        assert_eq!(pixel(&part, 82, 20), pixel(&whole, 82, 20));
        assert_eq!(pixel(&part, 82, 50), [0; 4]);
        // What it is filtered to is what a filter layer shows of it.
        let mut live = document.clone();
        live.layers.push(Arc::new(Layer::new("blur", blur().params().clone())));
        assert_eq!(pixel(&live, 82, 30), pixel(&whole, 82, 30));
    }

    #[test]
    fn locks_hold() {
        let document = painted();
        let id = document.layers[0].id;
        let lock = |lock| document.with_layer(id, |layer| layer.lock = lock).unwrap();
        assert!(lock(LayerLock::All).with_paint_filtered(id, &blur()).is_none());
        let kept = lock(LayerLock::Alpha).with_paint_filtered(id, &blur()).unwrap();
        assert_eq!((pixel(&kept, 79, 30), pixel(&kept, 80, 30)), ([200, 0, 0, 255], [0; 4]));
    }

    #[test]
    fn a_shift_brings_paint_where_there_was_none() {
        let document = painted();
        let shift = LiveFilter::new(PictureFilter::WrappedOffset(WrappedOffset::default()));
        let shifted = document.with_paint_filtered(document.layers[0].id, &shift).unwrap();
        assert_eq!((pixel(&shifted, 20, 9)[3], pixel(&shifted, 120, 9)[0]), (0, 200));
    }
}
