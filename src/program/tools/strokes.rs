//! The stroke tool: selects strokes of a stroke layer on the canvas and moves them along the
//! surface. Floor 5. The session keeps the selection. Not here: the edits (`document::strokes`).

use super::{DocumentChoice, Gesture, GestureStart, Outcome, PenSample, ToolContext, closed};
use crate::document::{Content, Document, LayerId};
use crate::math::Vec2;
use crate::paint::picking;

/// The pen comes down: on a stroke it selects it (with Shift it toggles it), off all strokes it
/// deselects them.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let nothing = (None, Outcome::Idle);
    let Some(layer) = context.layer.and_then(|id| context.document.layer(id)) else {
        return nothing;
    };
    if !matches!(layer.content, Content::Strokes(_)) {
        return nothing;
    }
    if let Some(why) = closed::why_locked(layer) {
        return (None, Outcome::Refused(why.into()));
    }
    let strokes = context.document.strokes(layer.id);
    let scene = context.document.scene_of(layer.id).unwrap_or_else(|| context.document.scene());
    let Some(hit) = picking::topmost_at(strokes, &scene, pen.place()) else {
        let kept = if pen.keys.shift { context.strokes.to_vec() } else { Vec::new() };
        return (None, Outcome::Choose(DocumentChoice::Strokes(kept)));
    };
    let was_selected = context.strokes.contains(&hit);
    let selected: Vec<usize> = match (pen.keys.shift, was_selected) {
        (true, true) => context.strokes.iter().copied().filter(|&index| index != hit).collect(),
        (true, false) => context.strokes.iter().copied().chain([hit]).collect(),
        (false, true) => context.strokes.to_vec(),
        (false, false) => vec![hit],
    };
    let moving = MoveStrokesGesture {
        document: context.document.clone(),
        layer: layer.id,
        selected: selected.clone(),
        from: pen.place(),
        by: Vec2::ZERO,
        slop_px: SLOP_PT * context.px_per_pt,
        moves: false,
    };
    (Some(Box::new(moving)), Outcome::Choose(DocumentChoice::Strokes(selected)))
}

/// Movements smaller than this are ignored, screen points: a hand trembles while it selects.
const SLOP_PT: f32 = 3.0;

struct MoveStrokesGesture {
    document: Document,
    layer: LayerId,
    selected: Vec<usize>,
    from: Vec2,
    by: Vec2,
    slop_px: f32,
    moves: bool,
}

impl MoveStrokesGesture {
    fn with(&self) -> Option<Document> {
        self.document.with_moved_strokes(self.layer, &self.selected, self.by)
    }
}

impl Gesture for MoveStrokesGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        self.by = pen.place() - self.from;
        self.moves |= self.by.length() > self.slop_px;
        if self.moves { self.with().map_or(Outcome::Idle, Outcome::Preview) } else { Outcome::Idle }
    }

    fn release(&mut self) -> Outcome {
        match self.with().filter(|_| self.moves) {
            Some(document) => {
                let label = if self.selected.len() == 1 { "Move stroke" } else { "Move strokes" };
                Outcome::Commit { label: label.into(), document, select: None }
            }
            None => Outcome::Cancel,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Layer, Live, StrokeList};
    use crate::math::{Size, srgb::Color, vec2};
    use crate::paint::{Brush, Sample, Stroke};
    use crate::surface::Operator;
    use crate::tools::ModifierKeys;
    use crate::tools::ToolSettings;
    use std::sync::Arc;

    /// Lines at y = 20, 60 and 100.
    fn document() -> Document {
        let line = |y: f32| {
            let samples = [vec2(10.0, y), vec2(190.0, y)].map(Sample::at).to_vec();
            Arc::new(Stroke::new(
                Brush { size: 12.0, ..Brush::default() },
                Operator::None,
                Color::BLACK,
                samples,
            ))
        };
        let list = StrokeList { strokes: [20.0, 60.0, 100.0].map(line).to_vec() };
        let layers = vec![Arc::new(Layer::new("Lines", Content::Strokes(Live::new(list))))];
        Document { layers, ..Document::empty(Size::new(200, 150)) }
    }

    /// The selection after a press, and the result of the drag.
    fn dragged(
        strokes: &[usize],
        shift: bool,
        from: Vec2,
        to: Vec2,
    ) -> (Option<Vec<usize>>, Option<Vec<f32>>) {
        let (document, tools) = (document(), ToolSettings::default());
        let layer = Some(document.layers[0].id);
        let context = ToolContext { layer, strokes, ..ToolContext::new(&document, &tools) };
        let keys = ModifierKeys { shift, ..ModifierKeys::default() };
        let (gesture, begun) = press(&context, PenSample { keys, ..PenSample::at(from) });
        let selected = match begun {
            Outcome::Choose(DocumentChoice::Strokes(selected)) => Some(selected),
            _ => None,
        };
        let moved = gesture.and_then(|mut gesture| {
            gesture.drag(&[PenSample { keys, ..PenSample::at(to) }]);
            match gesture.release() {
                Outcome::Commit { document, .. } => {
                    let strokes = document.strokes(document.layers[0].id);
                    Some(strokes.iter().map(|stroke| stroke.samples()[0].at.y).collect())
                }
                _ => None,
            }
        });
        (selected, moved)
    }

    #[test]
    fn a_stroke_that_is_taken_hold_of_is_selected_and_moved_alone() {
        let (selected, moved) = dragged(&[2], false, vec2(50.0, 61.0), vec2(50.0, 71.5));
        assert_eq!((selected, moved), (Some(vec![1]), Some(vec![20.0, 70.5, 100.0])));
    }

    #[test]
    fn strokes_selected_together_move_together() {
        let (selected, moved) = dragged(&[0, 2], false, vec2(50.0, 100.0), vec2(50.0, 110.0));
        assert_eq!((selected, moved), (Some(vec![0, 2]), Some(vec![30.0, 60.0, 110.0])));
    }

    #[test]
    fn shift_selects_more_or_fewer_and_a_click_beside_all_lets_go() {
        let still = |strokes: &[usize], shift: bool, at: Vec2| dragged(strokes, shift, at, at);
        assert_eq!(still(&[0], true, vec2(50.0, 60.0)), (Some(vec![0, 1]), None));
        assert_eq!(still(&[0, 1], true, vec2(50.0, 60.0)), (Some(vec![0]), None));
        assert_eq!(still(&[0, 1], false, vec2(50.0, 140.0)), (Some(vec![]), None));
        assert_eq!(still(&[0, 1], true, vec2(50.0, 140.0)), (Some(vec![0, 1]), None));
    }

    #[test]
    fn a_trembling_hand_moves_nothing() {
        assert_eq!(dragged(&[], false, vec2(50.0, 60.0), vec2(51.0, 62.0)).1, None);
    }
}
