//! The options of the transform tool: its commands, how pixels are sampled, and its gizmo in
//! numbers. Floor 7.

use crate::commands::TRANSFORMS;
use crate::document::LayerLock;
use crate::language::tr;
use crate::math::Vec2;
use crate::raster::Resampling;
use crate::requests::UiRequests;
use crate::session::actions::{HandAction, LayerAction, PartAction};
use crate::session::{Action, Property, Session};
use crate::tools::gizmo::TransformTarget;
use crate::tools::transform::{GizmoNumbers, PIVOTS};
use crate::tr;
use crate::widgets::{choice, choice_row, more, number, set_accessible_name};
use eframe::egui::{Button, Ui};
use std::ops::RangeInclusive;

/// What is transformed, the gizmo in numbers, and a mesh; the rest is behind *More*.
pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    target(ui, session, requests);
    gizmo(ui, session, requests);
    if let Some(apply) = TRANSFORMS.first() {
        let button = ui.add_enabled((apply.can)(session), Button::new(tr("Apply")));
        set_accessible_name(&button, tr(apply.name));
        if button.on_hover_text(tr!("{hint} (Enter)", hint = tr(apply.hint))).clicked() {
            (apply.run)(session, requests);
        }
    }
    meshes(ui, session, requests);
    more(ui, |ui| ways(ui, session, requests));
}

/// Layers, or the shape.
fn target(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    if session.shown_document().is_some_and(|document| document.surface.is_some())
        && let Some(target) = choice(
            ui,
            "What is transformed",
            session.tools.transform.target,
            &TransformTarget::LABELS,
        )
    {
        requests.act(Action::Hand(HandAction::TransformTarget { carried: target }));
    }
}

/// Sampling, pivot, and the other commands.
fn ways(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    if let Some(open) = session.active() {
        let selected = open.outermost_selected();
        let transforms =
            selected.iter().filter_map(|id| open.document().layer(*id)?.transform.as_ref());
        if let Some(transform) = transforms.last()
            && let Some(filter) = choice_row(ui, "Pixels", transform.filter, &Resampling::ALL)
        {
            let (layer, to) = (session.layer_paths(), Property::Sampled { filter });
            requests.act(Action::Layer(LayerAction::Set { layer, to, done: true }));
        }
        if let Some(gizmo) = open.gizmo(session.tools.transform.target) {
            pivot(ui, gizmo.pivot_share, requests);
        }
    }
    ui.separator();
    for command in TRANSFORMS.iter().skip(1) {
        if command.is_line() {
            ui.separator();
            continue;
        }
        let entry =
            ui.add_enabled((command.can)(session), Button::new(tr(command.name)).frame(false));
        if entry.on_hover_text(tr(command.hint)).clicked() {
            (command.run)(session, requests);
            ui.close();
        }
    }
}

/// The place about which sides and angles change.
fn pivot(ui: &mut Ui, now: Vec2, requests: &mut UiRequests) {
    let choices = PIVOTS.map(|(share, name)| (Some(share), name));
    let known = PIVOTS.iter().map(|(share, _)| *share).find(|share| *share == now);
    let mut all: Vec<(Option<Vec2>, &str)> = choices.into();
    all.extend(known.is_none().then_some((None, "set by hand")));
    if let Some(Some(at)) = choice_row(ui, "Pivot", known, &all) {
        requests.act(Action::Layer(LayerAction::Pivot { at }));
    }
}

/// A mesh over the layer, by the number of points along a side.
fn meshes(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let Some(layer) = session.layer().filter(|layer| layer.lock != LayerLock::All) else { return };
    let now = layer
        .transform
        .as_ref()
        .and_then(|own| own.mesh())
        .map(|mesh| [mesh.columns(), mesh.rows()]);
    let known = match now {
        Some([columns, rows]) => tr!("Mesh {columns} × {rows}", columns, rows),
        None => tr("Mesh").to_owned(),
    };
    let menu = ui.menu_button(known, |ui| {
        for side in [2, 3, 4, 5, 6, 8, 12] {
            if ui
                .selectable_label(now == Some([side, side]), tr!("{side} × {side} points", side))
                .clicked()
            {
                let layer = session.layer_paths();
                requests.act(Action::Layer(LayerAction::Mesh { layer, columns: side, rows: side }));
                ui.close();
            }
        }
    });
    let hint = "Lays a grid over the layer: drag its points; Shift selects several. Enter applies \
                it";
    menu.response.on_hover_text(tr(hint));
}

/// The gizmo in numbers; sides and angles change about the pivot.
fn gizmo(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let Some(open) = session.active() else { return };
    let of_shape = session.tools.transform.target == TransformTarget::Shape
        && open.document().surface.is_some();
    let locked = |id| open.document().layer(id).is_none_or(|layer| layer.lock == LayerLock::All);
    let selected = open.outermost_selected();
    if selected.is_empty() && !of_shape {
        return drop(ui.weak(tr("Select layers to move, scale and turn them")));
    }
    if !of_shape && selected.iter().any(|id| locked(*id)) {
        return drop(ui.weak(tr("Locked layers cannot be transformed")));
    }
    let (Some(gizmo), Some(before)) = (
        open.gizmo(session.tools.transform.target),
        open.gizmo_before(session.tools.transform.target),
    ) else {
        return drop(ui.weak(tr("There is nothing on this layer to transform")));
    };
    let (Some(was), Some(before)) = (GizmoNumbers::of(&gizmo), GizmoNumbers::of(&before)) else {
        return drop(ui.weak(tr(
            "In perspective: drag the corners with Ctrl, or remove the transform to type numbers",
        )));
    };
    let Some(edited) = numbers(ui, was) else { return };
    let to =
        if edited.keeps_pivot { edited.to.align_pivot(gizmo.pivot_share, &was) } else { edited.to };
    let layer = session.layer_paths();
    if let Some(by) = to.map_from(&before) {
        let done = edited.done;
        requests.act(match of_shape {
            true => Action::Part(PartAction::TakeAlong { by, done }),
            false => Action::Layer(LayerAction::TakeAlong { layer, by, done }),
        });
    }
}

/// Typed or dragged numbers.
struct EditedNumbers {
    to: GizmoNumbers,
    /// They change about the pivot.
    keeps_pivot: bool,
    done: bool,
}

fn numbers(ui: &mut Ui, was: GizmoNumbers) -> Option<EditedNumbers> {
    let mut to = was;
    let (mut moved, mut changed, mut done) = (false, false, false);
    let mut edit =
        |ui: &mut Ui, name: &str, value: &mut f64, range: RangeInclusive<f64>, suffix: &str| {
            // The share of a side follows it, without a name of its own for screen readers.
            let is_share = suffix == " %";
            if !is_share {
                ui.label(tr(name));
            }
            let field = number(value).range(range).max_decimals(2).speed(0.5).suffix(suffix);
            let response = ui.add(field);
            set_accessible_name(&response, tr(name));
            done |= response.changed() && !response.dragged() || response.drag_stopped();
            response.changed() || response.drag_stopped()
        };
    moved |= edit(ui, "X", &mut to.at.x, GizmoNumbers::SIDE, " px");
    moved |= edit(ui, "Y", &mut to.at.y, GizmoNumbers::SIDE, " px");
    ui.add_space(4.0);
    let mut percent = [100.0 * to.width / to.own.x, 100.0 * to.height / to.own.y];
    changed |= edit(ui, "Width", &mut to.width, GizmoNumbers::SIDE, " px");
    if edit(ui, "Width in %", &mut percent[0], -10_000.0..=10_000.0, " %") {
        (to.width, changed) = (percent[0] * to.own.x / 100.0, true);
    }
    changed |= edit(ui, "Height", &mut to.height, GizmoNumbers::SIDE, " px");
    if edit(ui, "Height in %", &mut percent[1], -10_000.0..=10_000.0, " %") {
        (to.height, changed) = (percent[1] * to.own.y / 100.0, true);
    }
    ui.add_space(4.0);
    changed |= edit(ui, "Angle", &mut to.angle, -360.0..=360.0, "°");
    changed |= edit(ui, "Skew", &mut to.skew, GizmoNumbers::SKEW, "°");
    (moved || changed).then_some(EditedNumbers { to, keeps_pivot: changed, done })
}
