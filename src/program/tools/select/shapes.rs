//! Rectangles and ellipses dragged from corner to corner, and the outline of a selection moved.
//! Floor 5.

use super::{SLOP_PT, begin, combine_selections, step};
use crate::document::Document;
use crate::math::{Rect, Vec2};
use crate::paint::Selection;
use crate::raster::CoverageGrid;
use crate::raster::coverage::{SelectionMode, shapes};
use crate::tools::snap::{SnapLines, SnapTargets};
use crate::tools::{Gesture, GestureStart, Outcome, PenSample, ToolContext};

#[derive(Clone, Copy, PartialEq)]
pub enum SelectionShape {
    Rectangle,
    Ellipse,
}

pub fn press(context: &ToolContext, pen: PenSample, shape: SelectionShape) -> GestureStart {
    let (document, how) = (context.document.clone(), context.tools.select.how(pen.keys));
    let slop_px = SLOP_PT * context.px_per_pt;
    let (snap, lines) = (context.snap.clone(), SnapLines::default());
    let from = snap.point(pen.place()).at;
    (
        Some(Box::new(ShapeGesture { document, shape, how, from, to: from, slop_px, snap, lines })),
        Outcome::Idle,
    )
}

struct ShapeGesture {
    document: Document,
    shape: SelectionShape,
    how: SelectionMode,
    from: Vec2,
    to: Vec2,
    slop_px: f32,
    snap: SnapTargets,
    lines: SnapLines,
}

impl ShapeGesture {
    /// Whether the pen went far enough for a shape.
    fn is_drawn(&self) -> bool {
        (self.to - self.from).abs().max_element() > self.slop_px
    }

    fn with(&self) -> Document {
        let canvas = self.document.size.rect();
        let coverage = match self.shape {
            // Along whole pixels, as shown.
            SelectionShape::Rectangle => {
                shapes::rectangle(self.from.round(), self.to.round(), canvas)
            }
            SelectionShape::Ellipse => shapes::ellipse(self.from, self.to, canvas),
        };
        combine_selections(&self.document, Selection::new(coverage), self.how)
    }
}

impl Gesture for ShapeGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let found = self.snap.point(pen.place());
        self.lines = found.lines;
        let by = found.at - self.from;
        // With Ctrl the width equals the height.
        let even = Vec2::splat(by.abs().max_element()).copysign(by);
        self.to = self.from + if pen.keys.ctrl { even } else { by };
        if self.is_drawn() { Outcome::Preview(self.with()) } else { Outcome::Idle }
    }

    fn release(&mut self) -> Outcome {
        if self.is_drawn() {
            return step(self.with());
        }
        // A click outside the selection drops it, which can be undone.
        match self.how == SelectionMode::Replace && self.document.active_selection.is_some() {
            true => Outcome::Commit {
                label: "Deselect".into(),
                document: self.document.with_selection(None),
                select: None,
            },
            false => Outcome::Cancel,
        }
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}

/// Grabs the selection; its pixels stay.
pub fn moving(context: &ToolContext, pen: PenSample) -> GestureStart {
    let (snap, lines) = (context.snap.clone(), SnapLines::default());
    begin(
        MoveOutline {
            document: context.document.clone(),
            from: pen.place(),
            by: Vec2::ZERO,
            snap,
            lines,
        },
        pen,
    )
}

struct MoveOutline {
    document: Document,
    from: Vec2,
    by: Vec2,
    snap: SnapTargets,
    lines: SnapLines,
}

impl MoveOutline {
    fn with(&self) -> Option<Document> {
        let coverage = self.document.active_coverage()?.shifted(self.by.x as i32, self.by.y as i32);
        Some(self.document.with_selection(Some(Selection::new(coverage))))
    }
}

impl Gesture for MoveOutline {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let by = |v: f32| crate::math::range::clamp_to_range(v, &crate::math::COORDINATE).round();
        let mut moved = pen.place() - self.from;
        if let Some(Rect { x0, y0, x1, y1 }) =
            self.document.active_coverage().map(CoverageGrid::covered_rect)
        {
            let corner = |x: i32, y: i32| Vec2::new(x as f32, y as f32) + moved;
            let shift = self.snap.shift(corner(x0, y0), corner(x1, y1));
            (moved, self.lines) = (moved + shift.at, shift.lines);
        }
        self.by = Vec2::new(by(moved.x), by(moved.y));
        self.with().filter(|_| self.by != Vec2::ZERO).map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        match self.with().filter(|_| self.by != Vec2::ZERO) {
            Some(document) => {
                Outcome::Commit { label: "Move selection".into(), document, select: None }
            }
            None => Outcome::Cancel,
        }
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}
