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

use super::{Gesture, GestureStart, ModifierKeys, Outcome, PenSample, ToolContext, ToolKind};
use crate::document::Document;
use crate::math::{Range, Vec2};
use crate::paint::{Fill, Selection};
use crate::raster::coverage::{CoverageGrid, SelectionMode};
use crate::surface::region::{RegionKind, SurfaceRegion};

/// Screen points that the pen moves for the whole range of a tolerance.
const TOLERANCE_PT: f32 = 500.0;
/// Movements smaller than this are those of a click, screen points.
const SLOP_PT: f32 = 3.0;

/// The settings of the selection tools.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelectSettings {
    /// How a new selection is combined with the present one, unless a key says otherwise.
    pub combine: SelectionMode,
    /// The wand: its region is that of a fill.
    pub wand: Fill,
    /// The wand takes only what is joined to the pixel.
    pub joined: bool,
    /// The surface wand: its point is that of the pen.
    pub region: SurfaceRegion,
}

impl Default for SelectSettings {
    fn default() -> Self {
        Self {
            combine: SelectionMode::Replace,
            wand: Fill { grow_px: 0.0, ..Fill::default() },
            joined: true,
            region: SurfaceRegion::new(RegionKind::Direction, Vec2::ZERO),
        }
    }
}

impl SelectSettings {
    /// The tolerance of the wand.
    pub const TOLERANCE: Range = crate::math::UNIT;

    /// With another kind of region, which begins with its own tolerance.
    pub fn with_kind(self, kind: RegionKind) -> Self {
        Self { region: SurfaceRegion { kind, tolerance: kind.tolerance(), ..self.region }, ..self }
    }

    /// How a selection is combined with the present one: Shift adds, Alt subtracts, both intersect.
    pub fn how(&self, keys: ModifierKeys) -> SelectionMode {
        match (keys.shift, keys.alt) {
            (true, true) => SelectionMode::Intersect,
            (true, false) => SelectionMode::Add,
            (false, true) => SelectionMode::TakeAway,
            (false, false) => self.combine,
        }
    }
}

/// The pen comes down with one of the selection tools.
pub fn press(kind: ToolKind, context: &ToolContext, pen: PenSample) -> GestureStart {
    match kind {
        ToolKind::SelectRectangle | ToolKind::SelectEllipse if is_grabbing(context, pen) => {
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
pub fn select_closed_lasso(
    document: &Document,
    points: &[Vec2],
    settings: &SelectSettings,
) -> Option<Document> {
    (points.len() >= 3).then(|| lasso::select_inside(document, points, settings.combine))
}

/// Whether the pen grabs the present selection: it comes down within it, and would replace it.
fn is_grabbing(context: &ToolContext, pen: PenSample) -> bool {
    let at = pen.place().floor().as_ivec2();
    let document = context.document;
    // A drag within a selection of the whole canvas makes a new rectangle.
    let is_all = |grid: &CoverageGrid| grid.area_px() >= document.size.area() as f64;
    let is_in =
        document.active_coverage().is_some_and(|grid| grid.at(at.x, at.y) >= 128 && !is_all(grid));
    is_in && pen.place().is_finite() && context.tools.select.how(pen.keys) == SelectionMode::Replace
}

/// The tolerance that a drag to the right or the left sets.
fn drag_tolerance(from: f32, by_px: f32, px_per_pt: f32, range: &Range) -> f32 {
    let span = range.end() - range.start();
    crate::math::range::clamp_to_range(
        from + by_px / px_per_pt.max(1e-6) * span / TOLERANCE_PT,
        range,
    )
}

fn begin(mut gesture: impl Gesture + 'static, pen: PenSample) -> GestureStart {
    let outcome = gesture.drag(&[pen]);
    (Some(Box::new(gesture)), outcome)
}

fn step(document: Document) -> Outcome {
    Outcome::Commit { label: "Select".into(), document, select: None }
}

/// A selection made with settings that the pen changed: a preview, or a finished step.
fn adjust(document: Document, select: SelectSettings, is_done: bool) -> Outcome {
    let outcome = if is_done { step(document) } else { Outcome::Preview(document) };
    outcome.with_settings(move |tools| tools.select = select)
}

fn combine_selections(document: &Document, new: Selection, how: SelectionMode) -> Document {
    document.with_combined(new, how)
}
