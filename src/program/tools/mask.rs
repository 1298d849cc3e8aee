//! The brush and the eraser on a layer's mask: light colors show the layer, dark ones and the
//! eraser hide it. The strokes are those of the brush, on a temporary paint layer with the mask's
//! grays. Floor 5. Not here: the strokes (`brush`).

use super::brush;
use super::closed;
use super::purpose::StrokePurpose;
use super::{Gesture, GestureStart, Outcome, PenSample, ToolContext, ToolSettings};
use crate::document::{Content, Document, Layer, LayerId, LayerMask, MaskKind, PixelLayer};
use crate::math::srgb::{Color, luminance, quantize};
use crate::paint::Selection;
use crate::raster::{CoverageGrid, Plane, TILE, Tile, TileAt, TileGrid};
use std::collections::HashMap;
use std::sync::Arc;

/// The pen comes down. Nothing starts if the layer is locked or hidden, or has no paintable mask.
pub fn press(context: &ToolContext, pen: PenSample, purpose: StrokePurpose) -> GestureStart {
    let Some(layer) = context.layer.and_then(|id| context.document.layer(id)) else {
        return (None, Outcome::Idle);
    };
    if let Some(why) = closed::unpaintable(context.document, layer) {
        return (None, Outcome::Refused(why.into()));
    }
    let Some(LayerMask { kind: MaskKind::File { coverage, .. }, .. }) = &layer.mask else {
        return (None, Outcome::Idle);
    };
    // The strokes bend over what the layer itself sees: the surface with the detail beneath it.
    let surface = context
        .document
        .scene_of(layer.id)
        .map_or(context.document.surface.clone(), |scene| scene.surface);
    let active_selection = context.document.active_selection.clone();
    let sees = Document { surface, active_selection, ..Document::empty(context.document.size) };
    paint(context, (pen, purpose), MaskTarget::Layer(layer.id), coverage.clone(), sees)
}

/// The pen comes down on the selection itself: light colors select, dark ones and the eraser
/// deselect.
pub fn press_on_selection(
    context: &ToolContext,
    pen: PenSample,
    purpose: StrokePurpose,
) -> GestureStart {
    let size = context.document.size;
    let mask = match context.document.active_coverage() {
        Some(selected) => selected.to_plane(size.rect()),
        None => Plane::full(size, 255),
    };
    let sees = Document { surface: context.document.surface.clone(), ..Document::empty(size) };
    paint(context, (pen, purpose), MaskTarget::Selection, Arc::new(mask), sees)
}

/// Begins a stroke on a sheet of a mask's grays; `sees`: the document around the sheet.
fn paint(
    context: &ToolContext,
    (pen, purpose): (PenSample, StrokePurpose),
    target: MaskTarget,
    mask: Arc<Plane<u8>>,
    sees: Document,
) -> GestureStart {
    let Color { r, g, b, a } = context.tools.color;
    let [r, g, b] = [r, g, b].map(|v| f32::from(v) / 255.0);
    let gray = quantize(luminance(r, g, b));
    let shown = grays(&mask);
    let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles: shown.clone() };
    let sheet = Layer::new("mask", Content::Pixels(pixels));
    let color = Color { r: gray, g: gray, b: gray, a };
    let tools = ToolSettings { color, ..context.tools.clone() };
    let on_sheet = ToolContext {
        layer: Some(sheet.id),
        tools: &tools,
        document: &Document { layers: vec![Arc::new(sheet)], ..sees },
        ..*context
    };
    let (Some(stroke), first) = brush::press(&on_sheet, pen, purpose) else {
        return (None, Outcome::Idle);
    };
    let mut painting =
        MaskGesture { document: context.document.clone(), target, mask, shown, stroke };
    let outcome = painting.copy_to_mask(first);
    (Some(Box::new(painting)), outcome)
}

/// What is painted on.
#[derive(Clone, Copy)]
enum MaskTarget {
    Layer(LayerId),
    Selection,
}

/// A stroke being drawn.
struct MaskGesture {
    document: Document,
    target: MaskTarget,
    /// The mask with the stroke so far, and the tiles that hold the same.
    mask: Arc<Plane<u8>>,
    shown: TileGrid,
    /// On the sheet of grays.
    stroke: Box<dyn Gesture>,
}

impl MaskGesture {
    /// Copies what the brush did to the sheet into the mask.
    fn copy_to_mask(&mut self, outcome: Outcome) -> Outcome {
        match outcome {
            Outcome::Preview(sheet) => self.with(&sheet).map_or(Outcome::Idle, Outcome::Preview),
            Outcome::Commit { document: sheet, .. } => match self.with(&sheet) {
                Some(document) => {
                    let (label, select) = match self.target {
                        MaskTarget::Layer(layer) => ("Paint on mask", Some(layer)),
                        MaskTarget::Selection => ("Paint selection", None),
                    };
                    Outcome::Commit { label: label.into(), document, select }
                }
                None => Outcome::Cancel,
            },
            other => other,
        }
    }

    fn with(&mut self, sheet: &Document) -> Option<Document> {
        let Content::Pixels(pixels) = &sheet.layers.first()?.content else { return None };
        let mask = Arc::make_mut(&mut self.mask);
        for at in self.shown.changed_tiles(&pixels.tiles) {
            put(mask, at, pixels.tiles.tile(at).map(|tile| &**tile));
        }
        self.shown = pixels.tiles.clone();
        let now = self.mask.clone();
        let MaskTarget::Layer(layer) = self.target else {
            let selection = Selection::new(CoverageGrid::from_plane(&now, 0, 0));
            return Some(self.document.with_selection(Some(selection)));
        };
        self.document.with_layer(layer, |layer| {
            if let Some(LayerMask { kind: MaskKind::File { file, coverage }, .. }) = &mut layer.mask
            {
                // Painted pixels no longer match the file.
                file.clear();
                *coverage = now;
            }
        })
    }
}

impl Gesture for MaskGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let outcome = self.stroke.drag(pens);
        self.copy_to_mask(outcome)
    }

    fn release(&mut self) -> Outcome {
        let outcome = self.stroke.release();
        self.copy_to_mask(outcome)
    }
}

/// A mask as opaque grays; tiles of one gray are one tile.
fn grays(mask: &Plane<u8>) -> TileGrid {
    let canvas = mask.size().rect();
    let mut grid = TileGrid::for_rect(canvas);
    let mut plain: HashMap<u8, Option<Arc<Tile>>> = HashMap::new();
    for at in TileAt::covering(canvas) {
        let (rect, inside) = (at.rect(), at.rect().intersect(canvas));
        let columns = inside.x0 as usize..inside.x1 as usize;
        let first = mask.at(columns.start, inside.y0 as usize);
        let is_plain = (inside.y0..inside.y1)
            .all(|y| mask.row(y as usize)[columns.clone()].iter().all(|&v| v == first));
        let made = |gray: &dyn Fn(i32, i32) -> u8| {
            let place = |i: usize| (rect.x0 + (i % TILE) as i32, rect.y0 + (i / TILE) as i32);
            let pixel = |i: usize| {
                let (x, y) = place(i);
                let v = gray(x, y);
                [v, v, v, 255]
            };
            Tile::from_pixels((0..TILE * TILE).flat_map(pixel).collect()).map(Arc::new)
        };
        let tile = if is_plain {
            plain.entry(first).or_insert_with(|| made(&|_, _| first)).clone()
        } else {
            made(&|x, y| mask.at_clamped(x, y))
        };
        grid.set(at, tile);
    }
    grid
}

/// The grays of a tile back into the mask; what was erased is black.
fn put(mask: &mut Plane<u8>, at: TileAt, tile: Option<&Tile>) {
    let (rect, inside) = (at.rect(), at.rect().intersect(mask.size().rect()));
    for y in inside.y0..inside.y1 {
        let to = &mut mask.row_mut(y as usize)[inside.x0 as usize..inside.x1 as usize];
        let Some(tile) = tile else {
            to.fill(0);
            continue;
        };
        let from = (y - rect.y0) as usize * TILE;
        let row = &tile.bytes()[from * 4..(from + inside.width()) * 4];
        to.iter_mut().zip(row.chunks_exact(4)).for_each(|(to, pixel)| *to = pixel[0]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, Layer, Progress, diff, flatten};
    use crate::math::{Size, vec2};
    use crate::paint::Brush;

    fn masked(value: u8) -> Document {
        let size = Size::new(200, 130);
        let kind =
            MaskKind::File { file: "m.png".into(), coverage: Arc::new(Plane::full(size, value)) };
        let fill = Layer::new("fill", Content::Fill(Color { r: 200, g: 10, b: 10, a: 255 }));
        let layer = Layer { mask: Some(LayerMask::new(kind)), ..fill };
        Document { layers: vec![Arc::new(layer)], ..Document::empty(size) }
    }

    fn drawn(document: &Document, color: Color, purpose: StrokePurpose) -> Document {
        let brush = Brush { size: 20.0, hardness: 1.0, ..Brush::default() };
        let tools = ToolSettings { color, ..ToolSettings::with_brush(brush) };
        let layer = Some(document.layers[0].id);
        let context = ToolContext { layer, ..ToolContext::new(document, &tools) };
        let mut gesture = press(&context, PenSample::at(vec2(40.0, 40.0)), purpose).0.unwrap();
        gesture.drag(&[PenSample::at(vec2(90.0, 40.0))]);
        gesture.drag(&[PenSample::at(vec2(120.0, 40.0))]);
        match gesture.release() {
            Outcome::Commit { document, .. } => document,
            _ => panic!("kept"),
        }
    }

    fn alpha(document: &Document, x: i32, y: i32) -> u8 {
        flatten(document, &Progress::default()).unwrap().pixel(x, y)[3]
    }

    #[test]
    fn white_shows_the_layer_and_black_and_the_eraser_hide_it() {
        let hidden = masked(0);
        let shown = drawn(&hidden, Color::WHITE, StrokePurpose::Paint);
        assert_eq!((alpha(&shown, 80, 40), alpha(&shown, 80, 80)), (255, 0));
        let whole = masked(255);
        for (color, purpose) in
            [(Color::BLACK, StrokePurpose::Paint), (Color::WHITE, StrokePurpose::Erase)]
        {
            let cut = drawn(&whole, color, purpose);
            assert_eq!((alpha(&cut, 80, 40), alpha(&cut, 80, 80)), (0, 255));
        }
    }

    #[test]
    fn only_the_tiles_of_the_stroke_are_drawn_again() {
        let hidden = masked(0);
        let changed = diff(&hidden, &drawn(&hidden, Color::WHITE, StrokePurpose::Paint));
        let expected = [TileAt::new(0, 0), TileAt::new(1, 0), TileAt::new(2, 0)];
        assert!(
            !changed.is_empty() && changed.iter().all(|at| expected.contains(at)),
            "{changed:?}"
        );
    }

    #[test]
    fn a_layer_without_such_a_mask_takes_no_paint() {
        let mut document = masked(0);
        document.layers = vec![Arc::new(Layer { mask: None, ..Layer::clone(&document.layers[0]) })];
        let tools = ToolSettings::default();
        let layer = Some(document.layers[0].id);
        let context = ToolContext { layer, ..ToolContext::new(&document, &tools) };
        assert!(press(&context, PenSample::at(vec2(9.0, 9.0)), StrokePurpose::Paint).0.is_none());
    }
}
