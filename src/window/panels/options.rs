//! The options bar above the canvas: one row with what the tool in hand needs, bending first; the
//! rest is behind *More*. Floor 7.

use super::{
    assistants, brush_mode, comic, crop, fill, gradient, liquify, path, select, shaping, transform,
};
use crate::document::Symmetry;
use crate::language::tr;
use crate::operators::{
    OPERATORS, OfferedOperator, OperatorOwner, give, has_operator, hint_of, set, whose,
};
use crate::paint::Brush;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::surface::Operator;
use crate::tools::ToolKind;
use crate::widgets::{NumberField, ValueChange, check, more, segment, segments, title};
use eframe::egui::scroll_area::ScrollBarVisibility;
use eframe::egui::{ScrollArea, Ui};

/// The height of the bar inside its margins, points.
pub const HEIGHT_PT: f32 = 24.0;
/// From this width of the window on, points, the hardness of the brush is in the bar.
const WIDE_PT: f32 = 1240.0;
/// Numbers of a bend in the bar; the others are behind *More*.
const NUMBERS: usize = 2;

/// The bar: one row, which a narrow window scrolls sideways.
pub fn show(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    // A plain wheel scrolls it: nothing here goes up or down.
    ui.style_mut().always_scroll_the_only_direction = true;
    let area = ScrollArea::horizontal().scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden);
    area.show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.set_min_height(HEIGHT_PT);
            if is_bending(session.tool) {
                bending(ui, session, requests);
                divide(ui);
            }
            of_tool(ui, session, requests);
        })
    });
}

/// A line between two groups of the bar, with air around it.
fn divide(ui: &mut Ui) {
    ui.add_space(3.0);
    ui.separator();
    ui.add_space(3.0);
}

/// Whether a tool makes or changes something that bends.
fn is_bending(tool: ToolKind) -> bool {
    use ToolKind::{Anchors, Brush, Eraser, Figure, Gradient, Image, Move, Path, Strokes, Text};
    matches!(
        tool,
        Brush | Eraser | Gradient | Image | Text | Anchors | Move | Strokes | Figure | Path
    )
}

/// The operator and its numbers.
fn bending(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let (whose, operator) = whose(session);
    if let OperatorOwner::Layer(_) = whose {
        ui.weak(tr("Selected layer"))
            .on_hover_text(tr("What you set here bends the selected layer"));
    }
    segments(ui, |ui| {
        for OfferedOperator { label, begins, hint } in OPERATORS {
            let is_on = has_operator(session, begins);
            if segment(ui, label, hint, is_on).clicked() && !is_on {
                give(session, requests, begins);
            }
        }
    });
    let has_surface = session.shown_document().is_none_or(|document| document.surface.is_some());
    if has_surface {
        if let Some(changed) = numbers(ui, operator) {
            set(requests, &whose, changed);
        }
    } else if operator != Operator::None {
        ui.colored_label(ui.visuals().warn_fg_color, tr("No surface here: marks stay flat"));
        let hint = "Makes a shape from what the drawing covers, so that marks bend over it and \
                    light falls on it";
        if ui.button(tr("Give it a shape…")).on_hover_text(tr(hint)).clicked() {
            requests.request(WindowRequest::ShapeDialog);
        }
    }
}

/// The options of the current tool.
fn of_tool(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    match session.tool {
        ToolKind::Fill => fill::options(ui, session.tools.fill, requests),
        ToolKind::Brush | ToolKind::Eraser => brush(ui, session, requests),
        tool if tool.is_selection_tool() => select::options(ui, session, requests),
        tool if tool.is_shape_tool() => shaping::options(ui, session, requests),
        ToolKind::Transform => transform::options(ui, session, requests),
        ToolKind::Liquify => {
            liquify::options(ui, session, requests);
            symmetry(ui, session, requests);
        }
        ToolKind::Gradient => gradient::options(ui, session, requests),
        ToolKind::Figure | ToolKind::Path => path::options(ui, session, requests),
        ToolKind::Panels => comic::options(ui, session, requests),
        ToolKind::Assistants => assistants::options(ui, session, requests),
        ToolKind::Crop => crop::options(ui, session, requests),
        tool => drop(ui.weak(tr(tool.hint()))),
    }
}

/// The choices of symmetry, with their names.
const SYMMETRIES: [(Symmetry, &str); 8] = [
    (Symmetry::None, "No symmetry"),
    (Symmetry::Vertical, "Left and right"),
    (Symmetry::Horizontal, "Above and below"),
    (Symmetry::Both, "All four"),
    (Symmetry::Radial(3), "3 times round"),
    (Symmetry::Radial(5), "5 times round"),
    (Symmetry::Radial(6), "6 times round"),
    (Symmetry::Radial(8), "8 times round"),
];
const SYMMETRY_HINT: &str = "Repeats every stroke about an axis or a point, which the tool \
                             Assistants moves; each copy bends at its own place";

/// How strokes repeat, as a menu.
fn symmetry(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let now = session.symmetry().kind;
    let known = SYMMETRIES.iter().find(|(choice, _)| *choice == now).map(|(_, label)| *label);
    let menu = ui.menu_button(tr(known.unwrap_or("Symmetry")), |ui| symmetries(ui, now, requests));
    menu.response.on_hover_text(tr(SYMMETRY_HINT));
}

fn symmetries(ui: &mut Ui, now: Symmetry, requests: &mut UiRequests) {
    for (choice, label) in SYMMETRIES {
        let row = ui.selectable_label(choice == now, tr(label)).on_hover_text(tr(SYMMETRY_HINT));
        if row.clicked() {
            requests.act(Action::Hand(HandAction::Symmetry { symmetry: choice }));
            ui.close();
        }
    }
}

/// The live sliders of an operator, in a bar.
fn numbers(ui: &mut Ui, operator: Operator) -> Option<ValueChange<Operator>> {
    numbers_by(operator, 0..NUMBERS, |number, value| number.inline(ui, value, 90.0))
}

/// The same, one below the other.
pub fn number_rows(ui: &mut Ui, operator: Operator) -> Option<ValueChange<Operator>> {
    numbers_by(operator, 0..usize::MAX, |number, value| number.row(ui, value))
}

/// Some of the numbers of an operator, by their places in its table.
fn numbers_by(
    operator: Operator,
    which: std::ops::Range<usize>,
    mut show: impl FnMut(NumberField<'static>, f32) -> Option<ValueChange<f32>>,
) -> Option<ValueChange<Operator>> {
    let mut changed = None;
    for (i, (number, value)) in operator.numbers().into_iter().enumerate() {
        if !which.contains(&i) {
            continue;
        }
        let field = NumberField::new(number.label, number.useful.clone(), hint_of(number.key));
        let field = if number.key == "smooth" { field.px() } else { field };
        if let Some(to) = show(field, value) {
            let with = |v: f32| operator.map(|other, old| if other == number { v } else { old });
            changed = Some(to.map(with));
        }
    }
    changed
}

fn brush(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let brush = &session.tools.brush;
    let is_wide = ui.ctx().content_rect().width() >= WIDE_PT;
    let mut push = |action: Option<HandAction>| requests.actions.extend(action.map(Action::Hand));
    let size = NumberField::new(
        "Size",
        Brush::HAND_SIZE,
        "Diameter of a dab ([ and ], or drag with the right button)",
    )
    .px();
    push(size.inline(ui, brush.size, 90.0).map(|c| HandAction::Size { to: c.to }));
    let opacity = NumberField::new("Opacity", 0.0..=1.0, "Of the whole stroke").share();
    push(opacity.inline(ui, brush.opacity, 60.0).map(|c| HandAction::Opacity { to: c.to }));
    if is_wide {
        push(
            hardness().inline(ui, brush.hardness, 60.0).map(|c| HandAction::Hardness { to: c.to }),
        );
    }
    if session.tool == ToolKind::Brush {
        brush_mode::options(ui, session, requests);
    }
    if session.symmetry().kind != Symmetry::None {
        symmetry(ui, session, requests);
    }
    more(ui, |ui| more_of_brush(ui, session, is_wide, requests));
}

fn hardness() -> NumberField<'static> {
    let hint = "How much of the dab is fully covered (Shift with [ and ])";
    NumberField::new("Hardness", 0.0..=1.0, hint).share()
}

fn more_of_brush(ui: &mut Ui, session: &Session, is_wide: bool, requests: &mut UiRequests) {
    if !is_wide {
        let changed = hardness().row(ui, session.tools.brush.hardness);
        requests.actions.extend(changed.map(|c| Action::Hand(HandAction::Hardness { to: c.to })));
    }
    let (whose, operator) = whose(session);
    if let Some(changed) =
        numbers_by(operator, NUMBERS..usize::MAX, |number, value| number.row(ui, value))
    {
        set(requests, &whose, changed);
    }
    if session.tool == ToolKind::Brush {
        title(ui, "Where it paints");
        brush_mode::limits(ui, session, requests);
    }
    title(ui, "Symmetry");
    ui.horizontal_wrapped(|ui| symmetries(ui, session.symmetry().kind, requests));
    title(ui, "Mouse and finger");
    let hint = "A mouse, or a finger without pressure, presses less when it moves faster";
    if let Some(on) = check(ui, "Pressure from speed", hint, session.tools.presses_by_speed) {
        requests.act(Action::Hand(HandAction::PressBySpeed { on }));
    }
}
