//! The move tool: moves a layer, or one stroke of a stroke layer, on the canvas.
//! Floor 5.

use super::gizmo::TransformGizmo;
use super::snap::{SnapLines, SnapTargets};
use super::transform;
use super::{Gesture, GestureStart, Outcome, PenSample, ToolContext, closed};
use crate::document::{Content, Document, Layer, LayerId, LayerLock};
use crate::math::{PlaneMap, Vec2};
use crate::paint::picking;

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    if let several @ [_, _, ..] = context.selected_layers() {
        return press_several(context, several, pen);
    }
    let layer = context.layer.and_then(|id| context.document.layer(id));
    if let Some(why) = layer.and_then(|layer| closed::why_locked(layer)) {
        return (None, Outcome::Refused(why.into()));
    }
    let held =
        layer.and_then(|layer| target_at(context.document, layer, pen.place(), pen.keys.shift));
    let Some((layer, held)) = layer.zip(held) else { return (None, Outcome::Idle) };
    let stroke = match held {
        MoveTarget::Stroke(index) => Some(index),
        MoveTarget::Layer => None,
    };
    (Some(Box::new(MoveGesture::begin(context, vec![layer.id], stroke, pen))), Outcome::Idle)
}

/// Several layers are moved whole, whatever they hold.
fn press_several(context: &ToolContext, layers: &[LayerId], pen: PenSample) -> GestureStart {
    let document = context.document;
    if let Some(why) = layers.iter().find_map(|id| closed::why_locked(document.layer(*id)?)) {
        return (None, Outcome::Refused(why.into()));
    }
    (Some(Box::new(MoveGesture::begin(context, layers.to_vec(), None, pen))), Outcome::Idle)
}

/// What the tool grabs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MoveTarget {
    /// One stroke of the layer.
    Stroke(usize),
    /// The whole layer.
    Layer,
}

/// What a press at a canvas point would hold: the topmost stroke there, or the whole layer; nothing
/// if it is locked. `whole`: the layer in any case.
pub fn target_at(document: &Document, layer: &Layer, at: Vec2, whole: bool) -> Option<MoveTarget> {
    if layer.lock == LayerLock::All {
        return None;
    }
    let stroke = match &layer.content {
        Content::Strokes(_) if !whole => {
            let scene = document.scene_of(layer.id).unwrap_or_else(|| document.scene());
            picking::topmost_at(&document.strokes_on_canvas(layer.id), &scene, at)
        }
        _ => None,
    };
    Some(stroke.map_or(MoveTarget::Layer, MoveTarget::Stroke))
}

struct MoveGesture {
    document: Document,
    layers: Vec<LayerId>,
    /// One stroke, only if a single layer is selected.
    stroke: Option<usize>,
    from: Vec2,
    by: Vec2,
    /// The box around what is moved, if anything can snap.
    gizmo: Option<[Vec2; 2]>,
    snap: SnapTargets,
    lines: SnapLines,
}

impl MoveGesture {
    fn begin(
        context: &ToolContext,
        layers: Vec<LayerId>,
        stroke: Option<usize>,
        pen: PenSample,
    ) -> Self {
        let (document, snap) = (context.document.clone(), context.snap.clone());
        let snaps = stroke.is_none() && !snap.is_empty();
        let gizmo = snaps
            .then(|| TransformGizmo::around(&document, &layers))
            .flatten()
            .map(|gizmo| gizmo.bounds());
        let (from, by, lines) = (pen.place(), Vec2::ZERO, SnapLines::default());
        Self { document, layers, stroke, from, by, gizmo, snap, lines }
    }

    fn with(&self) -> Option<Document> {
        match (self.stroke, &self.layers[..]) {
            (Some(index), [layer]) => self.document.with_moved_strokes(*layer, &[index], self.by),
            (_, layers) => layers
                .iter()
                .try_fold(self.document.clone(), |next, id| with_moved(&next, *id, self.by)),
        }
    }
}

/// A document with a layer moved on the canvas; `by` in whole pixels.
fn with_moved(document: &Document, layer: LayerId, by: Vec2) -> Option<Document> {
    // If the layer's frame is not the canvas, the frame is moved.
    let is_warped = document.layer(layer).is_some_and(|layer| layer.is_warped());
    if is_warped || document.map_of(layer).is_some_and(|map| !map.is_none()) {
        return transform::mapped(document, layer, PlaneMap::translation(by));
    }
    document.with_layer(layer, |layer| *layer = moved(layer, by))
}

impl Gesture for MoveGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let mut by = pen.place() - self.from;
        if let Some([low, high]) = self.gizmo {
            let shift = self.snap.shift(low + by, high + by);
            (by, self.lines) = (by + shift.at, shift.lines);
        }
        // Whole pixels, so that paint is not resampled.
        self.by = by.round();
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        match self.with() {
            Some(document) if self.by != Vec2::ZERO => {
                let label = match (self.stroke, self.layers.len()) {
                    (Some(_), _) => "Move stroke",
                    (None, 1) => "Move layer",
                    (None, _) => "Move layers",
                };
                Outcome::Commit { label: label.into(), document, select: None }
            }
            _ => Outcome::Cancel,
        }
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}

/// The layer with its content moved; `by` in whole pixels. Content that covers the whole canvas
/// stays as it is.
pub fn moved(layer: &Layer, by: Vec2) -> Layer {
    Layer { content: layer.content.moved(by), ..layer.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Live, PixelLayer, StrokeList};
    use crate::math::{Size, srgb::Color, vec2};
    use crate::paint::{Brush, Sample, Stroke};
    use crate::raster::TileGrid;
    use crate::surface::Operator;
    use crate::tools::ToolSettings;
    use std::sync::Arc;

    fn dragged(document: &Document, from: Vec2, to: Vec2) -> Document {
        let (tools, layer) = (ToolSettings::default(), Some(document.layers[0].id));
        let context = ToolContext { layer, ..ToolContext::new(document, &tools) };
        let mut gesture = press(&context, PenSample::at(from)).0.unwrap();
        gesture.drag(&[PenSample::at(to)]);
        match gesture.release() {
            Outcome::Commit { document, .. } => document,
            _ => panic!("moved"),
        }
    }

    fn one(content: Content) -> Document {
        Document {
            layers: vec![Arc::new(Layer::new("one", content))],
            ..Document::empty(Size::new(100, 100))
        }
    }

    #[test]
    fn paint_moves_by_whole_pixels() {
        let tiles = TileGrid::from_straight_rgba(&[7, 8, 9, 255], 1, 1, 10, 20);
        let document = one(Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }));
        let moved = dragged(&document, vec2(5.0, 5.0), vec2(67.6, -3.2));
        let Content::Pixels(pixels) = &moved.layers[0].content else { panic!("paint") };
        assert_eq!(
            (pixels.tiles.pixel(73, 12), pixels.tiles.pixel(10, 20)),
            ([7, 8, 9, 255], [0; 4])
        );
    }

    #[test]
    fn a_stroke_under_the_pen_moves_alone() {
        let stroke = |y: f32| {
            let samples = [vec2(10.0, y), vec2(90.0, y)].map(Sample::at).to_vec();
            Arc::new(Stroke::new(
                Brush { size: 6.0, ..Brush::default() },
                Operator::None,
                Color::BLACK,
                samples,
            ))
        };
        let document = one(Content::Strokes(Live::new(StrokeList {
            strokes: vec![stroke(20.0), stroke(60.0)],
        })));
        let moved = dragged(&document, vec2(50.0, 21.0), vec2(50.0, 31.0));
        let Content::Strokes(live) = &moved.layers[0].content else { panic!("strokes") };
        let tops: Vec<f32> =
            live.params().strokes.iter().map(|stroke| stroke.samples()[0].at.y).collect();
        assert_eq!(tops, [30.0, 60.0]);
    }

    #[test]
    fn a_press_holds_the_stroke_under_it_or_the_layer_and_nothing_of_a_locked_one() {
        let stroke = |x: f32| {
            let brush = Brush { size: 10.0, ..Brush::default() };
            Arc::new(Stroke::new(
                brush,
                Operator::None,
                Color::BLACK,
                vec![Sample::at(vec2(x, 20.0))],
            ))
        };
        let list = StrokeList { strokes: vec![stroke(10.0), stroke(60.0)] };
        let layers = vec![Arc::new(Layer::new("ink", Content::Strokes(Live::new(list))))];
        let document = Document { layers, ..Document::empty(Size::new(80, 40)) };
        let layer = &document.layers[0];
        let at = |x: f32, whole| target_at(&document, layer, vec2(x, 20.0), whole);
        assert_eq!(
            [at(10.0, false), at(60.0, false)],
            [Some(MoveTarget::Stroke(0)), Some(MoveTarget::Stroke(1))]
        );
        assert_eq!([at(35.0, false), at(60.0, true)], [Some(MoveTarget::Layer); 2]);
        let locked = Layer { lock: LayerLock::All, ..Layer::clone(layer) };
        assert_eq!(target_at(&document, &locked, vec2(10.0, 20.0), false), None);
    }
}
