//! Transforms of the selected layer: a menu within Edit, and the buttons of the transform tool.
//! Floor 7.

use super::row::{LINE, MenuCommand, has_layer, key, row};
use crate::requests::UiRequests;
use crate::session::actions::LayerAction;
use crate::session::{Action, LayerPath, Property, Session};
use eframe::egui::Key;

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Apply transform",
        &[key(Key::Enter)],
        "The layer stays as it shows: its pixels are sampled for good, strokes and placements take new numbers",
        is_transformed,
        |session, requests| with_selected(session, requests, |layer| LayerAction::ApplyTransform { layer }),
    ),
    row("Remove transform", &[], "The layer goes back to where it was made", is_transformed, |session, requests| {
        with_selected(session, requests, |layer| {
            let to = Property::Transformed { transform: None };
            LayerAction::Set { layer, to, done: true }
        })
    }),
    LINE,
    row("Mirror left and right", &[], "Mirrors the selected layer about its middle", has_layer, |session, requests| {
        with_selected(session, requests, |layer| LayerAction::Mirror { layer, upright: false })
    }),
    row("Mirror up and down", &[], "Mirrors the selected layer about its middle", has_layer, |session, requests| {
        with_selected(session, requests, |layer| LayerAction::Mirror { layer, upright: true })
    }),
    row(
        "Turn layer left",
        &[],
        "Turns the selected layer by a quarter, counter-clockwise",
        has_layer,
        |session, requests| with_selected(session, requests, |layer| LayerAction::Turn { layer, degrees: 90.0 }),
    ),
    row("Turn layer right", &[], "Turns the selected layer by a quarter, clockwise", has_layer, |session, requests| {
        with_selected(session, requests, |layer| LayerAction::Turn { layer, degrees: -90.0 })
    }),
];

/// There is a transform, and Enter closes no lasso.
fn is_transformed(session: &Session) -> bool {
    session.lasso.is_empty() && session.layer().is_some_and(|layer| layer.transform.is_some())
}

fn with_selected(session: &Session, requests: &mut UiRequests, action: impl FnOnce(LayerPath) -> LayerAction) {
    if let Some(layer) = session.layer_path() {
        requests.act(Action::Layer(action(layer)));
    }
}
