//! The options of the transform tool: its commands as buttons, and how pixels are sampled.
//! Floor 7.

use crate::commands::TRANSFORMS;
use crate::document::LayerTransform;
use crate::raster::Resampling;
use crate::requests::UiRequests;
use crate::session::actions::LayerAction;
use crate::session::{Action, Property, Session};
use eframe::egui::{Button, Ui};

pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    for command in TRANSFORMS.iter().filter(|command| !command.is_line()) {
        let button = ui.add_enabled((command.can)(session), Button::new(command.name)).on_hover_text(command.hint);
        if button.clicked() {
            (command.run)(session, requests);
        }
    }
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

const FILTERS: [(Resampling, &str, &str); 3] = [
    (Resampling::Smooth, "Smooth", "Sampled without rings, a little soft"),
    (Resampling::Sharp, "Sharp", "Sampled sharp, with faint rings at hard edges"),
    (Resampling::Nearest, "Pixels", "The nearest pixel, for pixel art"),
];
