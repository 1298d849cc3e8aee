//! The brush and the eraser: the pen's samples become one stroke, live on a stroke layer, pixels on
//! a paint layer. Floor 5. Not here: dabs and tiles (`paint`).

mod erase;
mod stroke;

pub use erase::is_on;

use super::closed;
use super::purpose::StrokePurpose;
use super::retouch::{self, ActiveWork};
use super::{Gesture, GestureStart, Outcome, PenSample, ToolContext};
use crate::document::symmetry::SymmetryImage;
use crate::document::{
    Content, Document, Layer, LayerId, LayerLock, LayerSlot, Live, OutlineSource, Part, PixelLayer,
    StrokeList,
};
use crate::math::{Vec2, hash, srgb::Color};
use crate::paint::{
    ActiveStrokes, Backdrop, Brush, BrushMode, Sample, Scene, StabilizedPen, Stroke,
};
use crate::raster::TileAt;
use crate::surface::{Operator, PaintLimit, Surface};
use erase::EraseStrokesGesture;
use std::sync::Arc;
use stroke::{StrokeGesture, StrokeTarget};

/// The pen comes down with the brush. A selected layer that cannot hold strokes gets a stroke layer
/// above it.
pub fn press(context: &ToolContext, pen: PenSample, purpose: StrokePurpose) -> GestureStart {
    if let Some(refused) = retouch::refuse_press(context, pen, purpose) {
        return (None, refused);
    }
    let (document, id) = match paintable(context, purpose) {
        Ok(found) => found,
        Err(why) => return (None, why.map_or(Outcome::Idle, |why| Outcome::Refused(why.into()))),
    };
    let Some(layer) = document.layer(id) else { return (None, Outcome::Idle) };
    if let (Content::Strokes(list), StrokePurpose::Erase, true) =
        (&layer.content, purpose, pen.keys.ctrl)
    {
        return begin(EraseStrokesGesture::new(context.document, id, list), pen);
    }
    let scene = document.scene_of(id).unwrap_or_else(|| document.scene());
    let Some((target, backdrop)) = find_target(&layer.content, &scene) else {
        return (None, Outcome::Idle);
    };
    let is_eraser = purpose == StrokePurpose::Erase;
    let brush = brush_in_hand(context, &document, layer, pen, is_eraser);
    let color =
        if is_eraser { Color { a: 255, ..context.tools.color } } else { context.tools.color };
    let images = document.symmetry.images(document.size);
    let like = |image: &SymmetryImage| {
        Stroke::new(image.brush(&brush), context.tools.operator, color, Vec::new())
            .within(context.document.stroke_selection())
    };
    let strokes: Vec<Stroke> = images.iter().map(like).collect();
    let work = retouch::begin_stroke(context, &images, pen, layer, &strokes, &scene);
    let painting = StrokeGesture {
        lead: straight_lead(context, pen),
        active: Some(work.unwrap_or_else(|| {
            ActiveWork::Strokes(ActiveStrokes::new(&strokes, backdrop, &scene))
        })),
        stabilized: StabilizedPen::of_brush(&brush, context.tools.operator, &scene),
        room: Some(Stroke::MOST_SAMPLES),
        label: if is_eraser { "Erase" } else { name_of(&brush, context.tools.operator) },
        document,
        layer: id,
        scene,
        target,
        images,
    };
    begin(painting, pen)
}

/// What a stroke on such content changes, and what lies beneath it; `None` if it takes no strokes.
fn find_target(content: &Content, scene: &Scene) -> Option<(StrokeTarget, Backdrop)> {
    Some(match content {
        Content::Strokes(list) => {
            let strokes = list.params().strokes.clone();
            // The tiles of an empty layer are known.
            let blank = TileAt::covering(scene.size.rect())
                .filter(|_| strokes.is_empty())
                .map(|at| (at, None));
            let shown = list.with_tiles(list.params().clone(), scene, blank);
            (StrokeTarget::Strokes { beneath: strokes.clone(), shown }, Backdrop::Strokes(strokes))
        }
        Content::Pixels(pixels) => {
            let mut shown = pixels.tiles.clone();
            shown.reserve(scene.size.rect());
            let base = PixelLayer { file: String::new(), ..pixels.clone() };
            (StrokeTarget::Pixels { base, shown }, Backdrop::Pixels(pixels.tiles.clone()))
        }
        _ => return None,
    })
}

/// The brush as the layer, the place and the eraser make it.
fn brush_in_hand(
    context: &ToolContext,
    document: &Document,
    layer: &Layer,
    pen: PenSample,
    is_eraser: bool,
) -> Brush {
    let mut brush = context.tools.brush.clone();
    if !context.tools.crosses_parts && is_begun_on_part(document, layer, pen.place()) {
        brush.bounded = PaintLimit::Object;
    }
    if is_eraser {
        brush.mode = BrushMode::Paint;
    }
    brush.erases |= is_eraser;
    brush.keeps_alpha |= layer.lock == LayerLock::Alpha;
    if brush.is_random() {
        // The same samples give the same seed, so a repeated stroke is identical.
        brush.seed = hash::mix(pen.place().x.to_bits() ^ hash::mix(pen.place().y.to_bits()));
    }
    brush
}

/// With Shift a straight line from where the last stroke ended, with the pressure of this sample.
fn straight_lead(context: &ToolContext, pen: PenSample) -> Vec<Sample> {
    let start = context.last_end.filter(|_| pen.keys.shift).into_iter();
    let line = start.flat_map(|last| (0..8).map(move |i| last.lerp(pen.place(), i as f32 / 8.0)));
    line.map(|at| Sample { at, ..pen.sample }).collect()
}

/// What a stroke is called in the history: what it does to the paint, or how it is bent.
fn name_of(brush: &Brush, operator: Operator) -> &'static str {
    match (brush.mode, operator) {
        (BrushMode::Smudge { .. }, _) => "Smudge",
        (BrushMode::Blur { .. }, _) => "Blur",
        (BrushMode::Clone { .. }, _) => "Clone",
        (BrushMode::Paint, _) if brush.erases => "Erase",
        (BrushMode::Paint, Operator::None) => "Brush stroke",
        (BrushMode::Paint, Operator::Normal { .. }) => "Gloss highlight",
        (BrushMode::Paint, Operator::Reflection { .. }) => "Mirrored stroke",
        (BrushMode::Paint, Operator::Depth { .. } | Operator::Surface { .. }) => "Wrapped stroke",
    }
}

/// Whether a mark on a layer begins on a part, and is no drawing from which parts have outlines:
/// on that a mark may go beyond them, to change them.
fn is_begun_on_part(document: &Document, layer: &Layer, at: Vec2) -> bool {
    let is_outline = |part: &Arc<Part>| match part.outline() {
        Some(OutlineSource::Layer { layer: of, .. }) => *of == layer.name,
        _ => false,
    };
    let is_drawing = document.parts.list.iter().any(is_outline);
    let pixel = at.floor().as_ivec2();
    let has_part = |surface: &Arc<Surface>| surface.objects().at(pixel.x, pixel.y).is_some();
    !document.parts.is_empty() && !is_drawing && document.surface.as_ref().is_some_and(has_part)
}

fn begin(mut gesture: impl Gesture + 'static, pen: PenSample) -> GestureStart {
    let outcome = gesture.drag(&[pen]);
    (Some(Box::new(gesture)), outcome)
}

/// The document with a layer that can take a stroke; or why the selected layer cannot be painted
/// on; `None` if there is nothing to erase.
fn paintable(
    context: &ToolContext,
    purpose: StrokePurpose,
) -> Result<(Document, LayerId), Option<String>> {
    let document = context.document;
    let selected = context.layer.and_then(|id| document.layer(id));
    if let Some(layer) = selected {
        let holds = match &layer.content {
            Content::Strokes(list) => {
                purpose == StrokePurpose::Paint || !list.params().strokes.is_empty()
            }
            content => matches!(content, Content::Pixels(_)),
        };
        let why = match holds {
            true => closed::unpaintable(document, layer),
            // A stroke gets a layer of its own, next to it.
            false => {
                closed::why_locked(layer).or_else(|| closed::why_hidden_around(document, layer.id))
            }
        };
        match why {
            Some(why) => return Err(Some(why)),
            None if holds => return Ok((document.clone(), layer.id)),
            None => {}
        }
    }
    if purpose == StrokePurpose::Erase {
        return Err(None);
    }
    let place = selected.and_then(|layer| document.place_of(layer.id)).map_or(
        LayerSlot::top_level(usize::MAX),
        |place| LayerSlot { index: place.index + 1, ..place },
    );
    let layer = Layer::new(
        document.free_layer_name("Strokes"),
        Content::Strokes(Live::new(StrokeList::default())),
    );
    let id = layer.id;
    Ok((document.with_inserted(layer, place).ok_or(None)?, id))
}

#[cfg(test)]
mod tests;
