//! The fill tool: a click fills the area connected to the pixel under the pen, on a paint layer.
//! Floor 5. Not here: finding the area (`paint::fill`).

use super::{GestureStart, Outcome, PenSample, ToolContext, closed};
use crate::document::{
    Content, Document, Layer, LayerId, LayerLock, LayerSlot, PixelLayer, PreparedDocument, Progress,
};
use crate::math::srgb::Color;
use crate::paint::fill::FilledArea;
use crate::raster::{
    CoverageGrid, CoverageTile, Mix, PlanarTile, TILE, Tile, TileAt, TileCoverage, TileGrid,
    TilePaint,
};
use rayon::prelude::*;
use std::sync::Arc;

/// The pen comes down: all is done at once. A selected layer that holds no pixels gets a paint
/// layer above it.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let selected = context.layer.and_then(|id| context.document.layer(id));
    let why = selected.and_then(|layer| match layer.content {
        Content::Pixels(_) => closed::unpaintable(context.document, layer),
        _ => closed::why_hidden_around(context.document, layer.id),
    });
    (
        None,
        why.map(|why| Outcome::Refused(why.into()))
            .or_else(|| fill(context, pen))
            .unwrap_or(Outcome::Idle),
    )
}

fn fill(context: &ToolContext, pen: PenSample) -> Option<Outcome> {
    let (document, id) = fillable(context)?;
    let layer = document.layer(id)?;
    let Content::Pixels(pixels) = &layer.content else { return None };
    let part = context.tools.fill.bounded.from(document.surface.as_ref(), pen.place());
    let filled = if context.tools.fill.layer_alone {
        context
            .tools
            .fill
            .from(pen.place(), document.size, &part, |at| pixels.tiles.tile(at).cloned())
    } else {
        let picture = PreparedDocument::new(context.document, &Progress::default())?;
        context.tools.fill.from(pen.place(), document.size, &part, |at| picture.flatten_tile(at))
    }?;
    let mix = Mix { atop: layer.lock == LayerLock::Alpha, ..Mix::default() };
    let tiles =
        fill_tiles(&pixels.tiles, &filled, document.active_coverage(), context.tools.color, mix);
    let next = PixelLayer { file: String::new(), tiles, ..pixels.clone() };
    let document = document.with_layer(id, |layer| layer.content = Content::Pixels(next))?;
    Some(Outcome::Commit { label: "Fill".into(), document, select: Some(id) })
}

/// The document with a paint layer to fill.
fn fillable(context: &ToolContext) -> Option<(Document, LayerId)> {
    let document = context.document;
    let selected = context.layer.and_then(|id| document.layer(id));
    if let Some(layer) = selected.filter(|layer| matches!(layer.content, Content::Pixels(_))) {
        return Some((document.clone(), layer.id));
    }
    let place = selected.and_then(|layer| document.place_of(layer.id)).map_or(
        LayerSlot::top_level(usize::MAX),
        |place| LayerSlot { index: place.index + 1, ..place },
    );
    let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles: TileGrid::default() };
    let layer = Layer::new(document.free_layer_name("Paint"), Content::Pixels(pixels));
    let id = layer.id;
    Some((document.with_inserted(layer, place)?, id))
}

/// The layer's pixels with a color over the filled area.
fn fill_tiles(
    base: &TileGrid,
    filled: &FilledArea,
    selected: Option<&CoverageGrid>,
    color: Color,
    mix: Mix,
) -> TileGrid {
    let tiles: Vec<TileAt> = TileAt::covering(filled.rect).collect();
    let one = |&at: &TileAt| match selected.map(|grid| grid.tile(at)) {
        // Nothing of the tile is selected.
        Some(None) => base.tile(at).cloned(),
        selected => tile(base.tile(at), at, (filled, selected.flatten()), color, mix),
    };
    let made: Vec<Option<Arc<Tile>>> = tiles.par_iter().map(one).collect();
    let mut grid = base.clone();
    grid.reserve(filled.rect);
    tiles.iter().zip(made).for_each(|(&at, tile)| grid.set(at, tile));
    grid
}

fn tile(
    base: Option<&Arc<Tile>>,
    at: TileAt,
    (filled, selected): (&FilledArea, Option<&Arc<CoverageTile>>),
    color: Color,
    mix: Mix,
) -> Option<Arc<Tile>> {
    let corner = at.rect();
    let covered = |x: usize, y: usize| filled.coverage(corner.x0 + x as i32, corner.y0 + y as i32);
    let coverage = TileCoverage::FULL.times(covered);
    let coverage = match selected.filter(|selected| !selected.is_whole()) {
        Some(selected) => coverage.times(|x, y| f32::from(selected.bytes()[y * TILE + x]) / 255.0),
        None => coverage,
    };
    if coverage.is_none() {
        return base.cloned();
    }
    let base = base.map(|tile| &**tile);
    let mut pixels = PlanarTile::of_tile(base);
    pixels.blend(mix, TilePaint::Solid(color.premultiplied()), &coverage);
    pixels.to_tile_over(base).map(Arc::new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec2, vec2};
    use crate::paint::Fill;
    use crate::surface::PaintLimit;
    use crate::tools::ToolSettings;

    const BLUE: Color = Color { r: 0, g: 0, b: 255, a: 255 };

    /// A red left half on a paint layer, over a blue fill.
    fn document() -> Document {
        let red: Vec<u8> = [255, 0, 0, 255].repeat(60 * 80);
        let tiles = TileGrid::from_straight_rgba(&red, 60, 80, 0, 0);
        let pixels = PixelLayer { file: "half.png".into(), x: 0, y: 0, tiles };
        let layers = vec![
            Arc::new(Layer::new("Ground", Content::Fill(BLUE))),
            Arc::new(Layer::new("Half", Content::Pixels(pixels))),
        ];
        Document { layers, ..Document::empty(Size::new(120, 80)) }
    }

    fn click(document: &Document, layer: usize, fill: Fill, at: Vec2) -> Option<Document> {
        let tools = ToolSettings { color: Color::WHITE, fill, ..ToolSettings::default() };
        let layer = Some(document.layers[layer].id);
        let context = ToolContext { layer, ..ToolContext::new(document, &tools) };
        match press(&context, PenSample::at(at)).1 {
            Outcome::Commit { document, .. } => Some(document),
            _ => None,
        }
    }

    fn pixel(document: &Document, layer: usize, x: i32, y: i32) -> [u8; 4] {
        let Content::Pixels(pixels) = &document.layers[layer].content else { panic!("paint") };
        pixels.tiles.pixel(x, y)
    }
    const SHARP: Fill = Fill {
        tolerance: 0.1,
        gap_px: 0.0,
        grow_px: 0.0,
        antialias: false,
        layer_alone: false,
        bounded: PaintLimit::Free,
    };

    #[test]
    fn what_the_picture_shows_tells_where_the_fill_ends() {
        let filled = click(&document(), 1, SHARP, vec2(90.0, 40.0)).unwrap();
        assert_eq!(
            [59, 60, 119].map(|x| pixel(&filled, 1, x, 79)),
            [[255, 0, 0, 255], [255; 4], [255; 4]]
        );
        let Content::Pixels(pixels) = &filled.layers[1].content else { panic!("paint") };
        assert!(pixels.file.is_empty(), "these are no longer the file's pixels");
    }

    #[test]
    fn a_layer_that_holds_no_pixels_gets_a_paint_layer_above_it() {
        let filled = click(&document(), 0, SHARP, vec2(10.0, 40.0)).unwrap();
        assert_eq!(filled.layers.len(), 3);
        assert_eq!((pixel(&filled, 1, 30, 30), pixel(&filled, 1, 90, 30)), ([255; 4], [0; 4]));
    }

    #[test]
    fn locked_alpha_fills_only_what_is_painted_and_a_locked_layer_nothing() {
        let document = document();
        let lock = |lock: LayerLock| {
            document.with_layer(document.layers[1].id, |layer| layer.lock = lock).unwrap()
        };
        let all = Fill { tolerance: 1.0, ..SHARP };
        let filled = click(&lock(LayerLock::Alpha), 1, all, vec2(10.0, 40.0)).unwrap();
        assert_eq!((pixel(&filled, 1, 30, 30), pixel(&filled, 1, 90, 30)), ([255; 4], [0; 4]));
        assert!(click(&lock(LayerLock::All), 1, all, vec2(10.0, 40.0)).is_none());
        let alone = Fill { layer_alone: true, ..SHARP };
        let filled = click(&document, 1, alone, vec2(90.0, 40.0)).unwrap();
        assert_eq!(pixel(&filled, 1, 60, 30), [255; 4], "beside the paint the layer is empty");
        assert!(click(&document, 1, alone, vec2(500.0, 40.0)).is_none());
    }
}
