//! The move tool: moves a layer, or one stroke of a stroke layer, on the canvas.
//! Floor 5.

use super::{Gesture, GestureStart, Outcome, PenSample, ToolContext};
use crate::document::{Content, Document, Layer, LayerId, LayerLock};
use crate::math::Vec2;
use crate::paint::picking;

pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let layer = context.layer.and_then(|id| context.document.layer(id)).filter(|layer| layer.lock != LayerLock::All);
    let Some(layer) = layer else { return (None, Outcome::Idle) };
    let stroke = match &layer.content {
        Content::Strokes(live) if !pen.keys.shift => {
            let strokes = &live.params().strokes;
            let scene = context.document.scene_of(layer.id).unwrap_or_else(|| context.document.scene());
            picking::topmost_at(strokes, &scene, pen.place())
        }
        _ => None,
    };
    let (document, id) = (context.document.clone(), layer.id);
    (Some(Box::new(MoveGesture { document, layer: id, stroke, from: pen.place(), by: Vec2::ZERO })), Outcome::Idle)
}

struct MoveGesture {
    document: Document,
    layer: LayerId,
    /// One stroke alone.
    stroke: Option<usize>,
    from: Vec2,
    by: Vec2,
}

impl MoveGesture {
    fn with(&self) -> Option<Document> {
        match self.stroke {
            Some(index) => self.document.with_moved_strokes(self.layer, &[index], self.by),
            None => self.document.with_layer(self.layer, |layer| *layer = moved(layer, self.by)),
        }
    }
}

impl Gesture for MoveGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        // Whole pixels, so that paint is not resampled.
        self.by = (pen.place() - self.from).round();
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }
    fn release(&mut self) -> Outcome {
        match self.with() {
            Some(document) if self.by != Vec2::ZERO => {
                let label = if self.stroke.is_some() { "Move stroke" } else { "Move layer" };
                Outcome::Commit { label: label.into(), document, select: None }
            }
            _ => Outcome::Cancel,
        }
    }
}

/// The layer with its content moved; `by` in whole pixels. Content that covers the whole canvas stays as it is.
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
    use std::sync::Arc;

    fn dragged(document: &Document, from: Vec2, to: Vec2) -> Document {
        let (brush, layer) = (Brush::default(), Some(document.layers[0].id));
        let context = ToolContext { layer, ..ToolContext::new(document, &brush) };
        let mut gesture = press(&context, PenSample::at(from)).0.unwrap();
        gesture.drag(&[PenSample::at(to)]);
        match gesture.release() {
            Outcome::Commit { document, .. } => document,
            _ => panic!("moved"),
        }
    }
    fn one(content: Content) -> Document {
        Document { layers: vec![Arc::new(Layer::new("one", content))], ..Document::empty(Size::new(100, 100)) }
    }

    #[test]
    fn paint_moves_by_whole_pixels() {
        let tiles = TileGrid::from_straight_rgba(&[7, 8, 9, 255], 1, 1, 10, 20);
        let document = one(Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }));
        let moved = dragged(&document, vec2(5.0, 5.0), vec2(67.6, -3.2));
        let Content::Pixels(pixels) = &moved.layers[0].content else { panic!("paint") };
        assert_eq!((pixels.tiles.pixel(73, 12), pixels.tiles.pixel(10, 20)), ([7, 8, 9, 255], [0; 4]));
    }
    #[test]
    fn a_stroke_under_the_pen_moves_alone() {
        let stroke = |y: f32| {
            let samples = [vec2(10.0, y), vec2(90.0, y)].map(Sample::at).to_vec();
            Arc::new(Stroke::new(Brush { size: 6.0, ..Brush::default() }, Operator::None, Color::BLACK, samples))
        };
        let document = one(Content::Strokes(Live::new(StrokeList { strokes: vec![stroke(20.0), stroke(60.0)] })));
        let moved = dragged(&document, vec2(50.0, 21.0), vec2(50.0, 31.0));
        let Content::Strokes(live) = &moved.layers[0].content else { panic!("strokes") };
        let tops: Vec<f32> = live.params().strokes.iter().map(|stroke| stroke.samples()[0].at.y).collect();
        assert_eq!(tops, [30.0, 60.0]);
    }
}
