//! The options of the selection tools.
//! Floor 7.

use super::fill::BOUNDS;
use crate::language::tr;
use crate::paint::Fill;
use crate::paint::fill::{FARTHEST_GROWTH_PX, WIDEST_GAP_PX};
use crate::raster::coverage::SelectionMode;
use crate::requests::UiRequests;
use crate::session::actions::SelectionAction;
use crate::session::{Action, Session};
use crate::surface::region::{RegionKind, SurfaceRegion};
use crate::tools::{SelectSettings, ToolKind};
use crate::widgets::{NumberField, check, choice};
use eframe::egui::{Button, Ui};

/// How a new selection is combined with the last, with labels and hints.
const WAYS: [(SelectionMode, &str, &str); 4] = [
    (SelectionMode::Replace, "New", "A new selection replaces the last one"),
    (SelectionMode::Add, "Add", "A new selection is added to the last one (Shift)"),
    (SelectionMode::TakeAway, "Subtract", "A new selection is subtracted from the last one (Alt)"),
    (SelectionMode::Intersect, "Intersect", "Only what is in both stays selected (Shift with Alt)"),
];

/// The kinds of region, with their labels.
pub const KINDS: [(RegionKind, &str); 6] = [
    (RegionKind::Direction, "faces the same way"),
    (RegionKind::Depth, "lies as deep"),
    (RegionKind::Curvature, "bends alike"),
    (RegionKind::Object, "is of one object"),
    (RegionKind::Shine, "would shine with it"),
    (RegionKind::Flow, "flows along it"),
];

pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let select = session.tools.select;
    let mut push = |to: Option<SelectSettings>| {
        requests
            .actions
            .extend(to.map(|select| Action::Selection(SelectionAction::Settings { select })));
    };
    for (way, label, hint) in WAYS {
        let button = Button::selectable(select.combine == way, tr(label));
        if ui.add(button).on_hover_text(tr(hint)).clicked() {
            push(Some(SelectSettings { combine: way, ..select }));
        }
    }
    ui.add_space(6.0);
    match session.tool {
        ToolKind::Wand => push(wand(ui, select)),
        ToolKind::SurfaceWand => push(region(ui, select.region, select)),
        _ => drop(ui.weak(tr(session.tool.hint()))),
    }
}

fn wand(ui: &mut Ui, select: SelectSettings) -> Option<SelectSettings> {
    let mut to = None;
    let fill = select.wand;
    let mut set =
        |wand: Option<Fill>| to = wand.map(|wand| SelectSettings { wand, ..select }).or(to);
    let hint = "How different a color may be from the one you click; a drag to the right or left changes it too";
    let tolerance = NumberField::new("Tolerance", SelectSettings::TOLERANCE, hint);
    set(tolerance.inline(ui, fill.tolerance, 60.0).map(|c| Fill { tolerance: c.to, ..fill }));
    let gap = NumberField::new(
        "Close gaps",
        0.0..=WIDEST_GAP_PX,
        "Gaps in the border up to this wide are closed",
    );
    set(gap.pixels().inline(ui, fill.gap_px, 60.0).map(|c| Fill { gap_px: c.to, ..fill }));
    let grow = NumberField::new(
        "Grow",
        -FARTHEST_GROWTH_PX..=FARTHEST_GROWTH_PX,
        "Moves the edge outward or inward",
    );
    set(grow.pixels().inline(ui, fill.grow_px, 60.0).map(|c| Fill { grow_px: c.to, ..fill }));
    let hint = "Reads the selected layer alone, not the whole picture";
    set(check(ui, "This layer only", hint, fill.layer_alone)
        .map(|layer_alone| Fill { layer_alone, ..fill }));
    set(choice(ui, "Wand limit", fill.bounded, &BOUNDS).map(|bounded| Fill { bounded, ..fill }));
    let joined = check(
        ui,
        "Joined",
        "Only what is connected to the pixel; otherwise its color everywhere",
        select.joined,
    );
    joined.map(|joined| SelectSettings { joined, ..select }).or(to)
}

fn region(ui: &mut Ui, region: SurfaceRegion, select: SelectSettings) -> Option<SelectSettings> {
    let kind = choice(ui, "Select what", region.kind, &KINDS).map(|kind| select.with_kind(kind));
    let mut to = None;
    let mut set = |region: Option<SurfaceRegion>| {
        to = region.map(|region| SelectSettings { region, ..select }).or(to)
    };
    if region.kind != RegionKind::Object {
        set(tolerance(region)
            .inline(ui, region.tolerance, 90.0)
            .map(|c| SurfaceRegion { tolerance: c.to, ..region }));
        set(softness()
            .inline(ui, region.softness, 60.0)
            .map(|c| SurfaceRegion { softness: c.to, ..region }));
        let hint = "Only what is connected to the point; depth jumps separate pieces";
        set(check(ui, "Joined", hint, region.contiguous)
            .map(|contiguous| SurfaceRegion { contiguous, ..region }));
    }
    kind.or(to)
}

/// The tolerance of a region, in its own unit.
pub fn tolerance(region: SurfaceRegion) -> NumberField<'static> {
    let hint = "How different the surface may be from the point; a drag to the right or left changes it too";
    let field = NumberField::new("Tolerance", region.kind.tolerances(), hint);
    match region.kind {
        RegionKind::Direction | RegionKind::Shine | RegionKind::Flow => field.degrees(),
        RegionKind::Depth | RegionKind::Curvature | RegionKind::Object => field,
    }
}

/// The softness of a region's edge.
pub fn softness() -> NumberField<'static> {
    NumberField::new(
        "Softness",
        SurfaceRegion::SOFTNESS,
        "How soft the edge is, as a share of the tolerance",
    )
}
