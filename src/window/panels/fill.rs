//! The options of the fill tool.
//! Floor 7.

use crate::paint::Fill;
use crate::paint::fill::{FARTHEST_GROWTH_PX, WIDEST_GAP_PX};
use crate::requests::UiRequests;
use crate::session::Action;
use crate::session::actions::HandAction;
use crate::surface::PaintLimit;
use crate::widgets::{NumberField, check, choice};
use eframe::egui::Ui;

/// The paint limits, with their labels.
pub const BOUNDS: [(PaintLimit, &str); 3] = [
    (PaintLimit::Free, "anywhere"),
    (PaintLimit::Surface, "on the surface"),
    (PaintLimit::Object, "connected"),
];

/// In a bar.
pub fn options(ui: &mut Ui, fill: Fill, requests: &mut UiRequests) {
    let mut push = |to: Option<Fill>| {
        requests.actions.extend(to.map(|fill| Action::Hand(HandAction::Fill { fill })))
    };
    let tolerance = NumberField::new(
        "Tolerance",
        0.0..=1.0,
        "How different a color may be from the one you click",
    );
    push(tolerance.inline(ui, fill.tolerance, 60.0).map(|c| Fill { tolerance: c.to, ..fill }));
    let gap = NumberField::new(
        "Close gaps",
        0.0..=WIDEST_GAP_PX,
        "Gaps in the border up to this wide are closed",
    );
    push(gap.pixels().inline(ui, fill.gap_px, 60.0).map(|c| Fill { gap_px: c.to, ..fill }));
    let grow = NumberField::new(
        "Grow",
        -FARTHEST_GROWTH_PX..=FARTHEST_GROWTH_PX,
        "Extends the fill under the softened edge of a line",
    );
    push(grow.pixels().inline(ui, fill.grow_px, 60.0).map(|c| Fill { grow_px: c.to, ..fill }));
    let hint = "Smooth the edge of the fill";
    push(
        check(ui, "Smooth edge", hint, fill.antialias).map(|antialias| Fill { antialias, ..fill }),
    );
    let hint = "Reads the selected layer alone, not the whole picture";
    push(
        check(ui, "This layer only", hint, fill.layer_alone)
            .map(|layer_alone| Fill { layer_alone, ..fill }),
    );
    push(choice(ui, "Fill limit", fill.bounded, &BOUNDS).map(|bounded| Fill { bounded, ..fill }));
}
