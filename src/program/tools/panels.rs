//! The panel tool: a drag across a comic's panels cuts them, with a gutter between; or it draws a
//! new one. Floor 5. Not here: their layers (`layers`).

pub mod layers;

use super::snap::{SnapLines, SnapTargets};
use super::{DocumentChoice, Gesture, GestureStart, Outcome, PenSample, ToolContext};
use crate::document::{Document, LayerId, LayerSlot};
use crate::math::{Vec2, vec2};
use crate::paint::{Figure, PanelDrag, PanelSettings};

/// A pen that moves less than this, screen points, clicks.
const SLOP_PT: f32 = 3.0;

/// The steps of a cut's direction with Shift, radians.
const STEP: f32 = std::f32::consts::PI / 12.0;

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let from = context.snap.point(pen.place()).at;
    let gesture = PanelGesture {
        document: context.document.clone(),
        settings: context.tools.panels.clamp_to_ranges(),
        slot: layers::slot_for_panel(context.document, context.layer),
        pen: pen.place(),
        from,
        ends: [from; 2],
        is_dragged: false,
        slop_px: SLOP_PT * context.px_per_pt,
        snap: context.snap.clone(),
        lines: SnapLines::default(),
    };
    (Some(Box::new(gesture)), Outcome::Idle)
}

struct PanelGesture {
    /// Before the gesture.
    document: Document,
    settings: PanelSettings,
    /// Where a new panel is put.
    slot: LayerSlot,
    /// Where the pen came down, and what it snapped to there, canvas px.
    pen: Vec2,
    from: Vec2,
    /// Of the cut; opposite corners of the new panel.
    ends: [Vec2; 2],
    is_dragged: bool,
    slop_px: f32,
    snap: SnapTargets,
    lines: SnapLines,
}

impl PanelGesture {
    /// The document once the pen is lifted, how the step is called, and what is selected then.
    fn finish(&self) -> Option<(Document, String, Option<LayerId>)> {
        match self.settings.drag {
            PanelDrag::Cut => {
                let (document, count) =
                    layers::with_cut(&self.document, &self.settings, self.ends)?;
                let label = if count > 1 { "Cut panels" } else { "Cut panel" };
                Some((document, label.into(), None))
            }
            PanelDrag::Draw => {
                let [from, to] = self.ends;
                let (from, to) = (from.min(to), from.max(to));
                if (to - from).min_element() < self.slop_px.max(2.0) {
                    return None;
                }
                let shapes = vec![Figure { from, to, ..Figure::DEFAULT }.into()];
                let (document, drawing) =
                    layers::with_panels(&self.document, shapes, self.slot, &self.settings)?;
                Some((document, "Panel".into(), Some(drawing)))
            }
        }
    }

    fn set_end(&mut self, at: Vec2, pen: &PenSample) {
        let (shift, alt) = (pen.keys.shift, pen.keys.alt);
        self.ends = match self.settings.drag {
            PanelDrag::Cut if shift => [self.from, snap_to_steps(self.from, at)],
            PanelDrag::Cut => [self.from, at],
            PanelDrag::Draw => {
                let box_of = Figure::DEFAULT.between(self.from, at, shift, alt);
                [box_of.from, box_of.to]
            }
        };
    }
}

impl Gesture for PanelGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last().filter(|pen| pen.place().is_finite()) else {
            return Outcome::Idle;
        };
        self.is_dragged |= pen.place().distance(self.pen) > self.slop_px;
        if !self.is_dragged {
            return Outcome::Idle;
        }
        let found = self.snap.point(pen.place());
        self.lines = found.lines;
        self.set_end(found.at, pen);
        let shown = self.finish().map(|(document, ..)| document);
        Outcome::Preview(shown.unwrap_or_else(|| self.document.clone()))
    }

    fn release(&mut self) -> Outcome {
        if !self.is_dragged {
            let panels = layers::find_panels(&self.document);
            let clicked =
                panels.iter().rev().find(|panel| panel.is_open && panel.has_inside(self.pen));
            return clicked.map_or(Outcome::Cancel, |panel| {
                Outcome::Choose(DocumentChoice::Layer(panel.frame))
            });
        }
        match (self.finish(), self.settings.drag) {
            (Some((document, label, select)), _) => Outcome::Commit { label, document, select },
            (None, PanelDrag::Draw) => Outcome::Cancel,
            (None, PanelDrag::Cut) => Outcome::Refused(
                "No panel was cut. Drag across a panel that is shown and not locked.".into(),
            ),
        }
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}

/// The end of a line in the nearest direction of steps of 15°; level and upright ones are exact.
fn snap_to_steps(from: Vec2, to: Vec2) -> Vec2 {
    let turn = ((to - from).to_angle() / STEP).round() * STEP;
    let exact = |v: f32| if v.abs() < 1e-5 { 0.0 } else { v };
    let along = Vec2::from_angle(turn);
    from + vec2(exact(along.x), exact(along.y)) * from.distance(to)
}

#[cfg(test)]
mod tests;
