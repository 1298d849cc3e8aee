//! The options of the transform tool: its commands as buttons, and how pixels are sampled.
//! Floor 7.

use crate::commands::TRANSFORMS;
use crate::document::{LayerLock, LayerTransform};
use crate::raster::Resampling;
use crate::requests::UiRequests;
use crate::session::actions::LayerAction;
use crate::session::{Action, Property, Session};
use crate::tools::transform::{FrameNumbers, TransformFrame};
use eframe::egui::{Button, DragValue, Ui};
use std::ops::RangeInclusive;

pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    for command in TRANSFORMS.iter().filter(|command| !command.is_line()) {
        let button = ui.add_enabled((command.can)(session), Button::new(command.name)).on_hover_text(command.hint);
        if button.clicked() {
            (command.run)(session, requests);
        }
    }
    numbers(ui, session, requests);
    let Some((transform, layer)) = session.layer().and_then(|layer| layer.transform).zip(session.layer_path()) else {
        return;
    };
    ui.add_space(6.0);
    for (filter, label, hint) in FILTERS {
        let is_on = transform.filter == filter;
        if ui.add(Button::selectable(is_on, label)).on_hover_text(hint).clicked() && !is_on {
            let to = Property::Transformed { transform: Some(LayerTransform { filter, ..transform }) };
            requests.act(Action::Layer(LayerAction::Set { layer: layer.clone().into(), to, done: true }));
        }
    }
}

/// The frame in numbers; sides and angles change about its middle.
fn numbers(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let is_one = session.active().is_some_and(|tab| !tab.has_several());
    let Some((document, layer)) = session.shown().zip(session.layer()).filter(|_| is_one) else { return };
    let frame = TransformFrame::of(document, layer.id);
    let Some(was) = frame.as_ref().and_then(FrameNumbers::of).filter(|_| layer.lock != LayerLock::All) else { return };
    let mut to = was;
    let (mut moved, mut changed, mut done) = (false, false, false);
    let mut number = |ui: &mut Ui, name: &str, value: &mut f64, range: RangeInclusive<f64>, suffix: &str| {
        let label = ui.label(name);
        let field = DragValue::new(value).range(range).max_decimals(2).speed(0.5).suffix(suffix);
        let response = ui.add(field).labelled_by(label.id);
        done |= response.changed() && !response.dragged() || response.drag_stopped();
        response.changed() || response.drag_stopped()
    };
    ui.add_space(6.0);
    moved |= number(ui, "X", &mut to.at.x, FrameNumbers::SIDE, " px");
    moved |= number(ui, "Y", &mut to.at.y, FrameNumbers::SIDE, " px");
    changed |= number(ui, "Width", &mut to.width, 0.01..=*FrameNumbers::SIDE.end(), " px");
    let mut percent = [100.0 * to.width / to.own.x, 100.0 * to.height / to.own.y];
    if number(ui, "Width in %", &mut percent[0], 0.01..=10_000.0, " %") {
        (to.width, changed) = (percent[0] * to.own.x / 100.0, true);
    }
    changed |= number(ui, "Height", &mut to.height, FrameNumbers::SIDE, " px");
    if number(ui, "Height in %", &mut percent[1], -10_000.0..=10_000.0, " %") {
        (to.height, changed) = (percent[1] * to.own.y / 100.0, true);
    }
    changed |= number(ui, "Angle", &mut to.angle, -360.0..=360.0, "°");
    changed |= number(ui, "Skew", &mut to.skew, FrameNumbers::SKEW, "°");
    if !(moved || changed) {
        return;
    }
    let to = if changed { to.about_middle_of(&was) } else { to };
    if let (Some(transform), Some(layer)) = (to.transform(document, layer.id), session.layer_path()) {
        let to = Property::Transformed { transform };
        requests.act(Action::Layer(LayerAction::Set { layer: layer.into(), to, done }));
    }
}

const FILTERS: [(Resampling, &str, &str); 3] = [
    (Resampling::Smooth, "Smooth", "Sampled without rings, a little soft"),
    (Resampling::Sharp, "Sharp", "Sampled sharp, with faint rings at hard edges"),
    (Resampling::Nearest, "Pixels", "The nearest pixel, for pixel art"),
];
