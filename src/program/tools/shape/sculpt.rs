//! The sculpting tool: strokes that raise, lower and smooth the part under the pen; they stay
//! strokes. Floor 5. Not here: what a dab does (`shape::sculpt`).

use super::length_of;
use super::touch::layer_on;
use crate::document::Document;
use crate::document::parts::{Part, PartKind};
use crate::math::{Affine2, COORDINATE, Vec2};
use crate::shape::{SculptStroke, SculptTool};
use crate::tools::{
    Gesture, GestureStart, ModifierKeys, Outcome, PenSample, ShapeSettings, ToolContext,
};

/// Samples nearer than this add nothing, px.
const APART_PX: f32 = 0.5;

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let document = context.document;
    let Some(base) = document.part_at(pen.place()) else {
        let why = "There is no part under the pen to sculpt. Make some (Layer, Give it a shape…).";
        return (None, Outcome::Refused(why.into()));
    };
    let (mut part, is_new) = layer_on(
        document,
        &base,
        |kind| matches!(kind, PartKind::Sculpt { .. }),
        || ("Sculpt", PartKind::Sculpt { on: base.id.clone(), strokes: Vec::new() }),
    );
    if let PartKind::Sculpt { strokes, .. } = &mut part.kind {
        strokes.push(stroke(&context.tools.shape, pen.keys, base.matrix));
    }
    let back = base.matrix.inverse();
    let mut gesture = SculptGesture { document: document.clone(), part, is_new, back };
    let outcome = gesture.drag(&[pen]);
    (Some(Box::new(gesture)), outcome)
}

/// A stroke without samples, in the frame of the part that it lies on. Ctrl exchanges raising and
/// lowering, Shift smooths.
fn stroke(settings: &ShapeSettings, keys: ModifierKeys, matrix: Affine2) -> SculptStroke {
    let tool = match settings.tool {
        _ if keys.shift => SculptTool::Smooth,
        SculptTool::Raise if keys.ctrl => SculptTool::Lower,
        SculptTool::Lower if keys.ctrl => SculptTool::Raise,
        tool => tool,
    };
    let length = length_of(matrix);
    let (size, settings) = (settings.size / length, ShapeSettings { tool, ..*settings });
    let strength =
        if tool.is_by_height() { settings.strength() / length } else { settings.strength() };
    SculptStroke {
        tool,
        size: size.max(*SculptStroke::SIZE.start()).min(*SculptStroke::SIZE.end()),
        hardness: settings.hardness,
        strength: strength.max(0.0).min(*SculptStroke::STRENGTH.end()),
        samples: Vec::new(),
    }
}

struct SculptGesture {
    document: Document,
    /// The one that holds the strokes; the last is being drawn.
    part: Part,
    is_new: bool,
    /// From the canvas to the frame of the part beneath.
    back: Affine2,
}

impl SculptGesture {
    fn with(&self, is_done: bool) -> Document {
        super::with_worked(&self.document, &self.part, self.is_new, is_done)
    }

    fn samples(&mut self) -> Option<&mut Vec<(Vec2, f32)>> {
        let PartKind::Sculpt { strokes, .. } = &mut self.part.kind else { return None };
        strokes.last_mut().map(|stroke| &mut stroke.samples)
    }
}

impl Gesture for SculptGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let back = self.back;
        let Some(samples) = self.samples() else { return Outcome::Idle };
        let before = samples.len();
        for pen in pens {
            let (at, pressure) =
                (back.transform_point2(pen.place()), pen.sample.pressure.max(0.0).min(1.0));
            let is_new = samples.last().is_none_or(|last| last.0.distance(at) >= APART_PX);
            let is_allowed = COORDINATE.contains(&at.x) && COORDINATE.contains(&at.y);
            if is_new && is_allowed && samples.len() < SculptStroke::MOST / 4 {
                samples.push((at, pressure));
            }
        }
        if samples.len() > before { Outcome::Preview(self.with(false)) } else { Outcome::Idle }
    }

    fn release(&mut self) -> Outcome {
        match self.samples().is_some_and(|samples| !samples.is_empty()) {
            true => {
                Outcome::Commit { label: "Sculpt".into(), document: self.with(true), select: None }
            }
            false => Outcome::Cancel,
        }
    }
}
