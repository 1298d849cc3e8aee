//! The lasso, free and of straight sides in one: a drag draws freely and closes when the pen lifts,
//! a click sets a corner, after which clicks and drags continue until the first corner is clicked,
//! or Enter is pressed. Floor 5.

use super::{SLOP_PT, combine_selections, step};
use crate::document::Document;
use crate::math::Vec2;
use crate::paint::Selection;
use crate::raster::coverage::{SelectionMode, shapes};
use crate::tools::{GRAB_PT, Gesture, GestureStart, Outcome, PenSample, ToolContext};

/// The most corners of one lasso.
const MOST_CORNERS: usize = 100_000;

pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let at = pen.place();
    let mut points = context.tools.lasso.to_vec();
    let how = context.tools.select.how(pen.keys);
    let closes = points.len() >= 3 && points[0].distance(at) <= GRAB_PT * context.px_per_pt;
    if closes {
        return (None, step(select_inside(context.document, &points, how)));
    }
    let is_begun = !points.is_empty();
    points.push(at);
    let slop_px = SLOP_PT * context.px_per_pt;
    let gesture = LassoGesture {
        document: context.document.clone(),
        how,
        points,
        at,
        slop_px,
        is_begun,
        is_free: false,
    };
    (Some(Box::new(gesture)), Outcome::Idle)
}

/// The document with the inside of a closed line selected.
pub fn select_inside(document: &Document, points: &[Vec2], how: SelectionMode) -> Document {
    combine_selections(document, Selection::new(shapes::polygon(points, document.size.rect())), how)
}

struct LassoGesture {
    document: Document,
    how: SelectionMode,
    points: Vec<Vec2>,
    /// Where the pen came down.
    at: Vec2,
    slop_px: f32,
    /// Whether corners were set before.
    is_begun: bool,
    /// Whether the pen moved too far for a click.
    is_free: bool,
}

impl Gesture for LassoGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        self.is_free |= pens.iter().any(|pen| pen.place().distance(self.at) > self.slop_px);
        if !self.is_free {
            return Outcome::Idle;
        }
        let room = MOST_CORNERS.saturating_sub(self.points.len());
        self.points
            .extend(pens.iter().map(PenSample::place).filter(|at| at.is_finite()).take(room));
        match self.is_begun {
            true => corners(self.points.clone()),
            false => Outcome::Preview(select_inside(&self.document, &self.points, self.how)),
        }
    }

    fn release(&mut self) -> Outcome {
        if self.is_free && !self.is_begun {
            return step(select_inside(&self.document, &self.points, self.how));
        }
        corners(std::mem::take(&mut self.points))
    }
}

/// The corners of a lasso that goes on.
fn corners(points: Vec<Vec2>) -> Outcome {
    Outcome::Cancel.with_settings(move |tools| tools.lasso = points)
}
