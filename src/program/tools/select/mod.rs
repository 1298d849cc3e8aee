//! The selection tools: rectangle, ellipse, lasso, wand, and the wand of the surface. Each shows
//! its selection while the pen moves and keeps it when it lifts. Floor 5. Not here: what selections
//! are (`paint::selection`), combining them (`document::selections`), commands on the present
//! selection (`session::actions::selection`).

mod lasso;
mod shapes;
mod surface;
#[cfg(test)]
mod tests;
mod wand;

use super::{Gesture, GestureStart, Outcome, PenSample, SelectSettings, ToolContext, ToolKind};
use crate::document::Document;
use crate::math::{Range, Vec2};
use crate::paint::Selection;
use crate::raster::coverage::{CoverageGrid, SelectionMode};

/// Screen points that the pen moves for the whole range of a tolerance.
const TOLERANCE_PT: f32 = 500.0;
/// Movements smaller than this are those of a click, screen points.
const SLOP_PT: f32 = 3.0;

/// The pen comes down with one of the selection tools.
pub fn press(kind: ToolKind, context: &ToolContext, pen: PenSample) -> GestureStart {
    match kind {
        ToolKind::SelectRectangle | ToolKind::SelectEllipse if moves(context, pen) => {
            shapes::moving(context, pen)
        }
        ToolKind::SelectRectangle => shapes::press(context, pen, shapes::SelectionShape::Rectangle),
        ToolKind::SelectEllipse => shapes::press(context, pen, shapes::SelectionShape::Ellipse),
        ToolKind::Lasso => lasso::press(context, pen),
        ToolKind::Wand => wand::press(context, pen),
        ToolKind::SurfaceWand => surface::press(context, pen),
        _ => (None, Outcome::Idle),
    }
}

/// The selection of a lasso that is closed by a key.
pub fn closed(document: &Document, points: &[Vec2], settings: &SelectSettings) -> Option<Document> {
    (points.len() >= 3).then(|| lasso::selected(document, points, settings.combine))
}

/// Whether the pen grabs the present selection: it comes down within it, and would replace it.
fn moves(context: &ToolContext, pen: PenSample) -> bool {
    let at = pen.place().floor().as_ivec2();
    let document = context.document;
    // A drag within a selection of the whole canvas makes a new rectangle.
    let is_all = |grid: &CoverageGrid| grid.area_px() >= document.size.area() as f64;
    let is_in = document.selected().is_some_and(|grid| grid.at(at.x, at.y) >= 128 && !is_all(grid));
    is_in && pen.place().is_finite() && context.select.how(pen.keys) == SelectionMode::Replace
}

/// The tolerance that a drag to the right or the left sets.
fn dragged(from: f32, by_px: f32, px_per_pt: f32, range: &Range) -> f32 {
    let span = range.end() - range.start();
    crate::math::range::held(from + by_px / px_per_pt.max(1e-6) * span / TOLERANCE_PT, range)
}

fn begin(mut gesture: impl Gesture + 'static, pen: PenSample) -> GestureStart {
    let outcome = gesture.drag(&[pen]);
    (Some(Box::new(gesture)), outcome)
}

fn step(document: Document) -> Outcome {
    Outcome::Commit { label: "Select".into(), document, select: None }
}

fn combined(document: &Document, new: Selection, how: SelectionMode) -> Document {
    document.with_combined(new, how)
}
