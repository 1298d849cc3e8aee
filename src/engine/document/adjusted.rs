//! Colors of paint adjusted for good, within the selection. Floor 4. Not here: adjustment layers
//! (`layer::content`), what adjustments do (`paint::adjustment`).

use super::{Content, Document, LayerId, LayerLock, PixelLayer};
use crate::math::parallel;
use crate::paint::LiveAdjustment;
use crate::raster::{CoverageTile, PlanarTile, TILE, Tile, TileCoverage, TileGrid};
use std::sync::Arc;

impl Document {
    /// With the paint of a layer adjusted, within the selection if there is one. `None` for a layer
    /// that is no paint layer, or is locked.
    pub fn with_paint_adjusted(&self, layer: LayerId, by: &LiveAdjustment) -> Option<Document> {
        let can = |document: &Document| {
            document.layer(layer).is_some_and(|layer| {
                layer.lock != LayerLock::All && matches!(layer.content, Content::Pixels(_))
            })
        };
        let selected = self.active_coverage().filter(|_| can(self));
        // A selection lies on the canvas, and so must the pixels.
        let shown = match selected {
            Some(_) => self.with_transform_applied(layer)?,
            None => self.clone(),
        };
        let Content::Pixels(pixels) = &shown.layer(layer).filter(|_| can(self))?.content else {
            return None;
        };
        if selected.is_some() && shown.layer(layer)?.is_warped() {
            return None;
        }
        by.warm();
        let all: Vec<_> = pixels
            .tiles
            .iter()
            .filter_map(|(at, tile)| match selected {
                Some(selected) => Some((at, tile, Some(selected.tile(at)?))),
                None => Some((at, tile, None)),
            })
            .collect();
        let made: Vec<_> = parallel::map(&all, |(at, tile, covered)| {
            (*at, adjusted(tile, covered.map(|c| &**c), by))
        });
        let mut tiles: TileGrid = pixels.tiles.clone();
        made.into_iter().for_each(|(at, tile)| tiles.set(at, tile));
        let next = PixelLayer { file: String::new(), tiles, ..pixels.clone() };
        shown.with_layer(layer, |layer| layer.content = Content::Pixels(next))
    }
}

/// A tile, adjusted as far as it is covered.
fn adjusted(
    tile: &Arc<Tile>,
    covered: Option<&CoverageTile>,
    by: &LiveAdjustment,
) -> Option<Arc<Tile>> {
    let before = PlanarTile::of_tile(Some(tile));
    let mut after = before.clone();
    by.apply(&mut after);
    if let Some(covered) = covered.filter(|covered| !covered.is_whole()) {
        let bytes = covered.bytes();
        let share = |x: usize, y: usize| f32::from(bytes[y * TILE + x]) / 255.0;
        let adjusted = std::mem::replace(&mut after, before);
        after.mix_toward(&adjusted, &TileCoverage::FULL.times(share));
    }
    after.to_tile(tile.is_16_bit()).map(Arc::new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Layer, Progress, flatten};
    use crate::math::{Rect, Size};
    use crate::paint::adjustment::Invert;
    use crate::paint::{ColorAdjustment, Selection};
    use crate::raster::CoverageGrid;

    const SIZE: Size = Size::new(100, 70);

    fn painted() -> Document {
        let rgba = [40, 90, 200, 255].repeat(SIZE.area());
        let tiles = TileGrid::from_straight_rgba(&rgba, 100, 70, 0, 0);
        let layers = vec![Arc::new(Layer::new("paint", tiles))];
        Document { layers, ..Document::empty(SIZE) }
    }

    fn pixel(document: &Document, x: i32, y: i32) -> [u8; 4] {
        flatten(document, &Progress::default()).unwrap().pixel(x, y)
    }

    #[test]
    fn paint_is_adjusted_within_the_selection_alone() {
        let document = painted();
        let invert = LiveAdjustment::new(ColorAdjustment::Invert(Invert));
        let id = document.layers[0].id;
        let whole = document.with_paint_adjusted(id, &invert).unwrap();
        assert_eq!(pixel(&whole, 3, 3), [215, 165, 55, 255]);
        let half = CoverageGrid::full(Rect::new(0, 0, 50, 70));
        let document = document.with_selection(Some(Selection::new(half)));
        let part = document.with_paint_adjusted(id, &invert).unwrap();
        assert_eq!(pixel(&part, 49, 30), [215, 165, 55, 255]);
        assert_eq!(pixel(&part, 50, 30), [40, 90, 200, 255]);
    }

    #[test]
    fn locked_layers_and_other_kinds_are_left_alone() {
        let document = painted();
        let invert = LiveAdjustment::new(ColorAdjustment::Invert(Invert));
        let id = document.layers[0].id;
        let locked = document.with_layer(id, |layer| layer.lock = LayerLock::All).unwrap();
        assert!(locked.with_paint_adjusted(id, &invert).is_none());
        let fill = crate::math::srgb::Color::WHITE;
        let filled = document.with_layer(id, |layer| layer.content = fill.into()).unwrap();
        assert!(filled.with_paint_adjusted(id, &invert).is_none());
    }
}
