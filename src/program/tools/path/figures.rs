//! The figure tool: a drag draws a rectangle, ellipse, polygon, star, line or arrow; the selected
//! one has handles. Floor 5.

use super::HeldPath;
use crate::math::Vec2;
use crate::paint::{Figure, LivePath};
use crate::tools::snap::{SnapLines, SnapTargets};
use crate::tools::{Gesture, GestureStart, Outcome, PenSample, ToolContext};

/// A shorter drag draws nothing, screen points.
const SHORTEST_PT: f32 = 3.0;

/// What a drag does to a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FigureDrag {
    /// Draws it, from where the pen came down.
    Draw,
    /// Drags one of its handles.
    Handle(usize),
    /// Turns it about its middle.
    Turn,
    /// Moves it.
    Move,
}

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let at = pen.place();
    let held = match HeldPath::of_selected(context) {
        Ok(held) => held,
        Err(why) => return (None, Outcome::Refused(why.into())),
    };
    if let Some(held) = held
        && let Some(figure) = held.path.figure().copied()
        && let Some(drag) = drag_at(&held, &figure, pen, context.px_per_pt)
    {
        return begin(context, held, figure, drag, at);
    }
    let from = context.snap.point(at).at;
    let settings = context.tools.path.clamp_to_ranges();
    let figure = Figure { from, to: from, ..settings.figure };
    let path = settings.path(figure, [context.tools.color, context.tools.second_color]);
    begin(context, HeldPath::new(context, path), figure, FigureDrag::Draw, from)
}

/// What the pen grabs of the selected figure: a handle (Ctrl turns it), or its middle.
fn drag_at(held: &HeldPath, figure: &Figure, pen: PenSample, px_per_pt: f32) -> Option<FigureDrag> {
    let (at, within) = (held.to_path(pen.place()), held.reach(pen.place(), px_per_pt));
    let handles = figure.handles();
    let distance = |i: &usize| handles[*i].distance(at);
    let nearest = (0..handles.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let turns = pen.keys.ctrl && !figure.kind.is_along_line();
    match distance(&nearest) <= within {
        true if turns => Some(FigureDrag::Turn),
        true => Some(FigureDrag::Handle(nearest)),
        false => (figure.center().distance(at) <= within).then_some(FigureDrag::Move),
    }
}

fn begin(
    context: &ToolContext,
    held: HeldPath,
    figure: Figure,
    drag: FigureDrag,
    from: Vec2,
) -> GestureStart {
    let shortest_px = SHORTEST_PT * context.px_per_pt;
    let (snap, lines) = (context.snap.clone(), SnapLines::default());
    let from = held.to_path(from);
    let gesture =
        FigureGesture { held, old: figure, now: figure, drag, from, shortest_px, snap, lines };
    (Some(Box::new(gesture)), Outcome::Idle)
}

struct FigureGesture {
    held: HeldPath,
    /// Before the drag.
    old: Figure,
    now: Figure,
    drag: FigureDrag,
    /// Where the pen came down, px of the path's plane.
    from: Vec2,
    shortest_px: f32,
    snap: SnapTargets,
    lines: SnapLines,
}

impl FigureGesture {
    fn path(&self) -> LivePath {
        LivePath { geometry: self.now.into(), ..self.held.path.clone() }
    }

    fn label(&self) -> &'static str {
        match self.drag {
            FigureDrag::Draw => self.now.kind.label(),
            FigureDrag::Handle(_) => "Change figure",
            FigureDrag::Turn => "Turn figure",
            FigureDrag::Move => "Move figure",
        }
    }

    fn figure_at(&self, at: Vec2, pen: &PenSample) -> Figure {
        let (old, keys) = (&self.old, pen.keys);
        match self.drag {
            FigureDrag::Draw => old.between(self.from, at, keys.shift, keys.alt),
            FigureDrag::Handle(handle) => old.with_handle(handle, at, keys.shift),
            FigureDrag::Move if keys.shift => old.moved(at - self.from),
            FigureDrag::Move => old.moved_body(at - self.from),
            FigureDrag::Turn => {
                let turn = |p: Vec2| (p - old.center()).to_angle().to_degrees();
                // Counter-clockwise as seen is clockwise in y-down coordinates.
                let turned = old.rotation + turn(self.from) - turn(at);
                let step = if keys.shift { 15.0 } else { 0.0 };
                let turned = if step > 0.0 { (turned / step).round() * step } else { turned };
                old.turned((turned + 540.0).rem_euclid(360.0) - 180.0)
            }
        }
    }
}

impl Gesture for FigureGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last().filter(|pen| pen.place().is_finite()) else {
            return Outcome::Idle;
        };
        let snaps = !matches!(self.drag, FigureDrag::Turn);
        let found = if snaps { self.snap.point(pen.place()) } else { Default::default() };
        let at = if snaps { found.at } else { pen.place() };
        self.lines = found.lines;
        self.now = self.figure_at(self.held.to_path(at), pen);
        self.held.with(&self.path()).map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        let is_drawn = self.drag == FigureDrag::Draw;
        let is_short = self.now.from.distance(self.now.to) < self.shortest_px;
        if self.now == self.old || (is_drawn && is_short) {
            return Outcome::Cancel;
        }
        let Some(document) = self.held.with(&self.path()) else { return Outcome::Cancel };
        let select = is_drawn.then(|| self.held.id());
        Outcome::Commit { label: self.label().into(), document, select }
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}
