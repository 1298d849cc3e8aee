//! The tool that sets and moves assistants, and strokes that are drawn along them. Floor 5. Not
//! here: what an assistant's lines are (`document::assistants`).

mod along;

pub use along::{StrokeStart, press_along};

use super::snap::{SnapLines, SnapTargets};
use super::{GRAB_PT, Gesture, GestureStart, Outcome, PenSample, ToolContext};
use crate::document::symmetry::{AxisHandle, SymmetrySettings};
use crate::document::{Assistant, AssistantKind, Document};
use crate::math::Vec2;
use std::sync::Arc;

/// The handle within a distance in px of a point: the number of its assistant, and its own.
pub fn handle_at(assistants: &[Assistant], at: Vec2, near_px: f32) -> Option<(usize, usize)> {
    let all = assistants.iter().enumerate();
    let all = all.flat_map(|(i, one)| {
        one.points.iter().enumerate().map(move |(k, p)| (p.distance(at), (i, k)))
    });
    let near = all.filter(|(far, _)| *far <= near_px);
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, found)| found)
}

/// The pen comes down with the tool: a drag moves a handle or sets a new assistant, Alt removes
/// one.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let (document, near_px) = (context.document, GRAB_PT * context.px_per_pt);
    if !pen.place().is_finite() {
        return (None, Outcome::Idle);
    }
    let found = handle_at(&document.assistants, pen.place(), near_px);
    if pen.keys.alt {
        let Some((index, _)) = found else { return (None, Outcome::Idle) };
        let mut left = Vec::clone(&document.assistants);
        left.remove(index);
        return (None, commit(document, "Remove assistant", left));
    }
    if let Some((index, handle)) = found {
        let moving = Moving { index, handle: Some(handle), from: pen.place(), is_new: false };
        return begin(context, Vec::clone(&document.assistants), moving);
    }
    let symmetry = document.symmetry;
    let (at, px_per_pt) = (pen.place(), context.px_per_pt);
    let axes = symmetry.axes;
    if let Some(handle) = axes.handle_at(symmetry.kind, document.size, at, px_per_pt, near_px) {
        let moved = AxisGesture { document: document.clone(), handle, symmetry };
        return (Some(Box::new(moved)), Outcome::Idle);
    }
    if document.assistants.len() >= Assistant::MOST {
        return (
            None,
            Outcome::Refused("The document has the maximum number of assistants.".into()),
        );
    }
    let from = context.snap.point(pen.place()).at;
    let mut all = Vec::clone(&document.assistants);
    all.push(drag_out(context.tools.aids.assistant, from, from));
    let moving = Moving { index: all.len() - 1, handle: None, from, is_new: true };
    begin(context, all, moving)
}

/// A new assistant dragged from one point to another.
fn drag_out(kind: AssistantKind, from: Vec2, to: Vec2) -> Assistant {
    let (middle, across) = ((from + to) * 0.5, (to - from).perp());
    let points = match kind {
        AssistantKind::Line | AssistantKind::Parallel | AssistantKind::TwoPoint => vec![from, to],
        AssistantKind::Ellipse => vec![from, to, middle + across * 0.25],
        AssistantKind::OnePoint => vec![to],
        AssistantKind::ThreePoint => vec![from, to, middle + across],
    };
    Assistant { kind, points }
}

fn commit(document: &Document, label: &str, assistants: Vec<Assistant>) -> Outcome {
    let document = Document { assistants: Arc::new(assistants), ..document.clone() };
    Outcome::Commit { label: label.into(), document, select: None }
}

fn begin(context: &ToolContext, all: Vec<Assistant>, moving: Moving) -> GestureStart {
    let (document, snap) = (context.document.clone(), context.snap.clone());
    let slop_px = 2.0 * context.px_per_pt;
    let gesture = AssistantGesture {
        document,
        all,
        moving,
        snap,
        slop_px,
        has_moved: false,
        lines: SnapLines::default(),
    };
    (Some(Box::new(gesture)), Outcome::Idle)
}

struct Moving {
    index: usize,
    /// `None`: all of it is being placed.
    handle: Option<usize>,
    from: Vec2,
    is_new: bool,
}

struct AssistantGesture {
    document: Document,
    /// As they were when the pen came down, the new one among them.
    all: Vec<Assistant>,
    moving: Moving,
    snap: SnapTargets,
    slop_px: f32,
    has_moved: bool,
    lines: SnapLines,
}

impl AssistantGesture {
    fn with(&self) -> Document {
        Document { assistants: Arc::new(self.all.clone()), ..self.document.clone() }
    }
}

impl Gesture for AssistantGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last().filter(|pen| pen.place().is_finite()) else {
            return Outcome::Idle;
        };
        let found = self.snap.point(pen.place());
        self.lines = found.lines;
        self.has_moved |= found.at.distance(self.moving.from) > self.slop_px;
        let Some(one) = self.all.get_mut(self.moving.index) else { return Outcome::Idle };
        *one = match self.moving.handle {
            Some(handle) => one.with_handle(handle, found.at),
            None => drag_out(one.kind, self.moving.from, found.at),
        };
        Outcome::Preview(self.with())
    }

    fn release(&mut self) -> Outcome {
        let one = self.all.get(self.moving.index).map(|one| one.kind);
        // One vanishing point is set by a click.
        let is_set = self.has_moved || (self.moving.is_new && one == Some(AssistantKind::OnePoint));
        if !is_set || self.all.iter().any(|one| one.fits().is_err()) {
            return Outcome::Cancel;
        }
        let label = if self.moving.is_new { "Add assistant" } else { "Move assistant" };
        commit(&self.document, label, self.all.clone())
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}

/// The axes of symmetry, moved or turned.
struct AxisGesture {
    document: Document,
    handle: AxisHandle,
    symmetry: SymmetrySettings,
}

impl AxisGesture {
    fn with(&self) -> Document {
        Document { symmetry: self.symmetry, ..self.document.clone() }
    }
}

impl Gesture for AxisGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last().filter(|pen| pen.place().is_finite()) else {
            return Outcome::Idle;
        };
        let (canvas, steps) = (self.document.size, pen.keys.shift);
        self.symmetry.axes = self.symmetry.axes.dragged(self.handle, canvas, pen.place(), steps);
        Outcome::Preview(self.with())
    }

    fn release(&mut self) -> Outcome {
        if self.symmetry == self.document.symmetry {
            return Outcome::Cancel;
        }
        Outcome::Commit { label: "Move axes".into(), document: self.with(), select: None }
    }
}

#[cfg(test)]
mod tests;
