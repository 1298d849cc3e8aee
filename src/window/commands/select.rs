//! The Select menu. Its commands are always enabled: what cannot be done says why. Floor 7.

use super::row::{LINE, MenuCommand, always, ctrl, ctrl_shift, has_document, row};
use crate::raster::coverage::SelectionMode;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::{EdgeChange, SelectionAction};
use crate::session::{Action, LayerPath, Session};
use eframe::egui::Key;

fn act(requests: &mut UiRequests, action: SelectionAction) {
    requests.act(Action::Selection(action));
}

fn ask(requests: &mut UiRequests, change: EdgeChange) {
    requests.request(WindowRequest::EdgeDialog(change));
}

fn of_layer(
    session: &Session,
    requests: &mut UiRequests,
    action: impl FnOnce(LayerPath) -> SelectionAction,
) {
    if let Some(layer) = session.layer_path() {
        act(requests, action(layer));
    }
}

pub const COMMANDS: &[MenuCommand] = &[
    row("Select all", &[ctrl(Key::A)], "Selects the whole canvas", always, |_, requests| {
        act(requests, SelectionAction::All {})
    }),
    row(
        "Deselect",
        &[ctrl(Key::D), ctrl_shift(Key::A)],
        "Drops the selection: everything can be painted on",
        always,
        |_, requests| act(requests, SelectionAction::None {}),
    ),
    row(
        "Select again",
        &[ctrl_shift(Key::D)],
        "Restores the last selection that was dropped",
        always,
        |_, requests| act(requests, SelectionAction::Again {}),
    ),
    row("Invert selection", &[ctrl_shift(Key::I)], "Selects what is not selected", always, |_, requests| {
        act(requests, SelectionAction::Invert {})
    }),
    row(
        "Hide outline of selection",
        &[ctrl(Key::H)],
        "Hides the marching outline, or shows it again; the selection stays",
        always,
        |session, requests| act(requests, SelectionAction::Hide { on: !session.hides_selection }),
    )
    .ticked(|session, _| session.hides_selection),
    LINE,
    row("Grow selection…", &[], "Moves the edge outward", has_document, |_, r| ask(r, EdgeChange::Grow)),
    row("Shrink selection…", &[], "Moves the edge inward", has_document, |_, r| ask(r, EdgeChange::Shrink)),
    row("Border of selection…", &[], "Selects a band along the edge", has_document, |_, r| {
        ask(r, EdgeChange::Border)
    }),
    row("Feather selection…", &[], "Makes the edge soft", has_document, |_, r| ask(r, EdgeChange::Feather)),
    row("Smooth selection…", &[], "Rounds the corners of the edge", has_document, |_, r| ask(r, EdgeChange::Smooth)),
    LINE,
    row(
        "Select layer",
        &[],
        "Selects where the layer is opaque; Ctrl-click on its thumbnail does the same",
        has_document,
        |session, requests| {
            of_layer(session, requests, |layer| SelectionAction::Layer { layer, how: SelectionMode::Replace })
        },
    ),
    row("Select mask", &[], "Selects what the layer's mask shows", has_document, |session, requests| {
        of_layer(session, requests, |layer| SelectionAction::Mask { layer, how: SelectionMode::Replace })
    }),
    row(
        "Mask from selection",
        &[],
        "The layer shows only what is selected; a selection by the surface keeps following the surface",
        has_document,
        |session, requests| of_layer(session, requests, |layer| SelectionAction::ToMask { layer }),
    ),
    row(
        "Quick mask",
        &[],
        "The brush changes the selection: white selects, black and the eraser deselect; what is not selected is \
         shown in red",
        has_document,
        |session, requests| {
            let on = session.active().is_some_and(|open| !open.quick_mask);
            act(requests, SelectionAction::QuickMask { on });
        },
    )
    .ticked(|session, _| session.active().is_some_and(|open| open.quick_mask)),
    LINE,
    row(
        "Keep selection…",
        &[],
        "Saves the selection under a name, with the document",
        has_document,
        |_, requests| requests.request(WindowRequest::KeepDialog),
    ),
];
