//! The options bar above the canvas: the operator with its sliders, and the options of the current
//! tool. Floor 7.

use super::{assistants, brush_mode, crop, fill, liquify, select, shaping, transform};
use crate::operators::{
    OPERATORS, OfferedOperator, OperatorOwner, give, has_operator, hint_of, set, whose,
};
use crate::paint::Brush;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::surface::Operator;
use crate::tools::{Symmetry, ToolKind};
use crate::widgets::{NumberField, ValueChange, check_box};
use eframe::egui::scroll_area::ScrollBarVisibility;
use eframe::egui::{Button, RichText, ScrollArea, Ui};

/// Rows of the bar: how marks bend, and the options of the tool. Both are always shown.
pub const ROWS: f32 = 2.0;

pub fn show(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    row(ui, "operator", |ui| bending(ui, session, requests));
    row(ui, "tool", |ui| of_tool(ui, session, requests));
}

/// One row, which a narrow window scrolls sideways.
fn row(ui: &mut Ui, name: &str, show: impl FnOnce(&mut Ui)) {
    // A plain wheel scrolls it: nothing here goes up or down.
    ui.style_mut().always_scroll_the_only_direction = true;
    let area = ScrollArea::horizontal()
        .id_salt(name)
        .scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden);
    area.show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.set_min_height(ui.spacing().interact_size.y);
            show(ui);
        })
    });
}

/// The operator and its numbers.
fn bending(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    if session.tool == ToolKind::Fill {
        return drop(ui.weak("Fills are not bent: they color the pixels that they cover"));
    }
    if session.tool.is_shape_tool() {
        return drop(ui.weak(
            "The shape is what everything bends over: parts, nearest first, are in the panel Shape",
        ));
    }
    if session.tool == ToolKind::Transform {
        return transform::ways(ui, session, requests);
    }
    if session.tool == ToolKind::Crop {
        return drop(ui.weak("Everything moves with the canvas; paint beyond it is kept"));
    }
    if session.tool.is_selection_tool() {
        return drop(
            ui.weak("Selections limit where you can paint: every brush, fill, gradient and eraser respects them"),
        );
    }
    let (whose, operator) = whose(session);
    let about = match whose {
        OperatorOwner::Hand => "New marks",
        OperatorOwner::Layer(_) => "Selected layer",
    };
    ui.label(RichText::new(about).weak());
    for OfferedOperator { label, begins, hint } in OPERATORS {
        let is_on = has_operator(session, begins);
        if ui.add(Button::selectable(is_on, label)).on_hover_text(hint).clicked() && !is_on {
            give(session, requests, begins);
        }
    }
    ui.add_space(6.0);
    if let Some(changed) = numbers(ui, operator) {
        set(requests, &whose, changed);
    }
    let has_surface = session.shown_document().is_none_or(|document| document.surface.is_some());
    if !has_surface && operator != Operator::None {
        ui.colored_label(ui.visuals().warn_fg_color, "No surface here: marks stay flat");
        let hint = "Makes a shape from what the drawing covers, so that marks bend over it and \
                    light falls on it";
        if ui.button("Give it a shape…").on_hover_text(hint).clicked() {
            requests.request(WindowRequest::ShapeDialog);
        }
    }
}

/// The options of the current tool.
fn of_tool(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    match session.tool {
        ToolKind::Fill => fill::options(ui, session.tools.fill, requests),
        ToolKind::Brush | ToolKind::Eraser => {
            brush(ui, session, requests);
            symmetry(ui, session, requests);
            let mut by_speed = session.tools.presses_by_speed;
            let hint = "A mouse, or a finger without pressure, presses less when it moves faster";
            if check_box(ui, &mut by_speed, "Pressure from speed").on_hover_text(hint).changed() {
                requests.act(Action::Hand(HandAction::PressBySpeed { on: by_speed }));
            }
        }
        tool if tool.is_selection_tool() => select::options(ui, session, requests),
        tool if tool.is_shape_tool() => shaping::options(ui, session, requests),
        ToolKind::Transform => transform::options(ui, session, requests),
        ToolKind::Liquify => {
            liquify::options(ui, session, requests);
            symmetry(ui, session, requests);
        }
        ToolKind::Assistants => assistants::options(ui, session, requests),
        ToolKind::Crop => crop::options(ui, session, requests),
        tool => drop(ui.weak(tool.hint())),
    }
}

/// How strokes repeat, as a menu.
fn symmetry(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    const CHOICES: [(Symmetry, &str); 8] = [
        (Symmetry::None, "No symmetry"),
        (Symmetry::Vertical, "Left and right"),
        (Symmetry::Horizontal, "Above and below"),
        (Symmetry::Both, "All four"),
        (Symmetry::Radial(3), "3 times round"),
        (Symmetry::Radial(5), "5 times round"),
        (Symmetry::Radial(6), "6 times round"),
        (Symmetry::Radial(8), "8 times round"),
    ];
    let known = CHOICES
        .iter()
        .find(|(choice, _)| *choice == session.tools.symmetry.kind)
        .map(|(_, label)| *label);
    let menu = ui.menu_button(known.unwrap_or("Symmetry"), |ui| {
        for (choice, label) in CHOICES {
            if ui.selectable_label(choice == session.tools.symmetry.kind, label).clicked() {
                requests.act(Action::Hand(HandAction::Symmetry { symmetry: choice }));
                ui.close();
            }
        }
    });
    let hint = "Repeats every stroke about an axis or a point, which the tool Assistants moves; each copy bends at its \
                own place";
    menu.response.on_hover_text(hint);
}

/// The live sliders of an operator, in a bar.
fn numbers(ui: &mut Ui, operator: Operator) -> Option<ValueChange<Operator>> {
    numbers_by(operator, |number, value| number.inline(ui, value, 96.0))
}

/// The same, one below the other.
pub fn number_rows(ui: &mut Ui, operator: Operator) -> Option<ValueChange<Operator>> {
    numbers_by(operator, |number, value| number.row(ui, value))
}

fn numbers_by(
    operator: Operator,
    mut show: impl FnMut(NumberField<'static>, f32) -> Option<ValueChange<f32>>,
) -> Option<ValueChange<Operator>> {
    let mut changed = None;
    for (number, value) in operator.numbers() {
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
    let mut push = |action: Option<HandAction>| requests.actions.extend(action.map(Action::Hand));
    let size = NumberField::new(
        "Size",
        Brush::HAND_SIZE,
        "Diameter of a dab ([ and ], or drag with the right button)",
    )
    .px();
    push(size.inline(ui, brush.size, 90.0).map(|c| HandAction::Size { to: c.to }));
    let opacity = NumberField::new("Opacity", 0.0..=1.0, "Of the whole stroke");
    push(opacity.inline(ui, brush.opacity, 60.0).map(|c| HandAction::Opacity { to: c.to }));
    let hardness = NumberField::new(
        "Hardness",
        0.0..=1.0,
        "How much of the dab is fully covered (Shift with [ and ])",
    );
    push(hardness.inline(ui, brush.hardness, 60.0).map(|c| HandAction::Hardness { to: c.to }));
    if session.tool == ToolKind::Brush {
        brush_mode::options(ui, session, requests);
    }
}
