//! Transforms of the selected layers: a menu within Edit, and the buttons of the transform tool.
//! Floor 7.

use super::row::{LINE, MenuCommand, has_layer, key, row};
use crate::math::PlaneMap;
use crate::requests::UiRequests;
use crate::session::actions::{LayerAction, PartAction};
use crate::session::{Action, LayerPaths, Property, Session};
use crate::tools::ToolKind;
use crate::tools::gizmo::TransformTarget;
use crate::tools::transform;
use eframe::egui::Key;

pub const REMOVE_LIQUIFY: &str = "Remove liquify";

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Apply transform",
        &[key(Key::Enter)],
        "Makes the transform permanent: pixels are resampled, strokes and placements get new \
         coordinates",
        is_transformed,
        |session, requests| {
            with_selected(session, requests, |layer| LayerAction::ApplyTransform { layer })
        },
    ),
    row(
        "Remove transform",
        &[],
        "Moves the layer back to where it was made",
        is_transformed,
        |session, requests| {
            with_selected(session, requests, |layer| {
                let to = Property::Transformed { transform: None };
                LayerAction::Set { layer, to, done: true }
            })
        },
    ),
    LINE,
    row(
        "Mirror left and right",
        &[],
        "Mirrors the selected layers about their middle",
        has_layer,
        |session, requests| mirror(session, requests, false),
    ),
    row(
        "Mirror up and down",
        &[],
        "Mirrors the selected layers about their middle",
        has_layer,
        |session, requests| mirror(session, requests, true),
    ),
    row(
        "Turn layer left",
        &[],
        "Turns the selected layers by a quarter, counter-clockwise",
        has_layer,
        |session, requests| turn(session, requests, 90.0),
    ),
    row(
        "Turn layer right",
        &[],
        "Turns the selected layers by a quarter, clockwise",
        has_layer,
        |session, requests| turn(session, requests, -90.0),
    ),
    LINE,
    row(
        REMOVE_LIQUIFY,
        &[],
        "Shows the layer as it was before it was liquified",
        is_liquified,
        |session, requests| {
            with_selected(session, requests, |layer| {
                let to = Property::Unliquified {};
                LayerAction::Set { layer, to, done: true }
            })
        },
    ),
];

/// There is a transform, and Enter neither closes a lasso nor crops.
fn is_transformed(session: &Session) -> bool {
    let Some(open) = session
        .active()
        .filter(|_| session.tools.lasso.is_empty() && session.tools.crop.area.is_none())
    else {
        return false;
    };
    // While a brush is current, Enter does not turn live layers into paint.
    let in_hand = matches!(session.tool, ToolKind::Transform | ToolKind::Liquify);
    let is_placed = |id| {
        let layer = open.document().layer(id);
        layer.is_some_and(|layer| layer.transform.is_some() || in_hand && layer.liquify.is_some())
    };
    open.selected_layers().into_iter().any(is_placed)
}

fn is_liquified(session: &Session) -> bool {
    let Some(open) = session.active() else { return false };
    let has_liquify = |id| open.document().layer(id).is_some_and(|layer| layer.liquify.is_some());
    open.selected_layers().into_iter().any(has_liquify)
}

fn mirror(session: &Session, requests: &mut UiRequests, upright: bool) {
    match shape_by(session, Some(transform::mirror(upright))) {
        Some(action) => requests.act(action),
        None => with_selected(session, requests, |layer| LayerAction::Mirror { layer, upright }),
    }
}

fn turn(session: &Session, requests: &mut UiRequests, degrees: f32) {
    match shape_by(session, transform::turn(degrees.into())) {
        Some(action) => requests.act(action),
        None => with_selected(session, requests, |layer| LayerAction::Turn { layer, degrees }),
    }
}

/// The shape mapped about its middle, while the transform tool moves it.
fn shape_by(session: &Session, map: Option<PlaneMap>) -> Option<Action> {
    let takes_shape = session.tool == ToolKind::Transform
        && session.tools.transform.target == TransformTarget::Shape;
    let open = session.active().filter(|_| takes_shape)?;
    let by = transform::matrix_about_shape(open.document(), map?)?;
    Some(Action::Part(PartAction::TakeAlong { by, done: true }))
}

fn with_selected(
    session: &Session,
    requests: &mut UiRequests,
    action: impl FnOnce(LayerPaths) -> LayerAction,
) {
    requests.act(Action::Layer(action(session.layer_paths())));
}
