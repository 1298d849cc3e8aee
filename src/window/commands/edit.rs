//! The Edit menu.
//! Floor 7.

use super::row::{
    LINE, MenuCommand, always, ctrl, ctrl_alt, ctrl_shift, has_document, has_layer, key, row,
};
use crate::requests::WindowRequest;
use crate::session::Action;
use crate::session::actions::{ClipboardAction, EditAction, HandAction, LayerAction, PasteTo};
use crate::tools::ToolKind;
use eframe::egui::Key;

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Undo",
        &[ctrl(Key::Z)],
        "Undo the last step",
        |session| session.active().is_some_and(|open| open.history.done().is_some()),
        |_, requests| requests.act(Action::Edit(EditAction::Undo {})),
    ),
    row(
        "Redo",
        &[ctrl_shift(Key::Z), ctrl(Key::Y)],
        "Redo the last undone step",
        |session| session.active().is_some_and(|open| open.history.undone().is_some()),
        |_, requests| requests.act(Action::Edit(EditAction::Redo {})),
    ),
    LINE,
    row(
        "Cut",
        &[ctrl(Key::X)],
        "Takes what is selected out of the layer, to be pasted",
        always,
        |_, requests| requests.act(Action::Clipboard(ClipboardAction::Cut {})),
    ),
    row(
        "Copy",
        &[ctrl(Key::C)],
        "Copies what is selected of the layer; strokes stay strokes",
        always,
        |_, requests| requests.act(Action::Clipboard(ClipboardAction::Copy { merged: false })),
    ),
    row(
        "Copy merged picture",
        &[ctrl_shift(Key::C)],
        "Copies all that shows where you selected",
        always,
        |_, requests| requests.act(Action::Clipboard(ClipboardAction::Copy { merged: true })),
    ),
    row(
        "Paste",
        &[ctrl(Key::V)],
        "Pastes what was copied where it was, as a layer; a picture of another program as paint, at its own size, at \
         the pointer",
        always,
        |_, requests| requests.request(WindowRequest::Paste(PasteTo::Paint)),
    ),
    row(
        "Paste as image layer",
        &[ctrl_alt(Key::V)],
        "Pastes a picture as a live layer, bent over the surface and pinned at the pointer",
        always,
        |_, requests| requests.request(WindowRequest::Paste(PasteTo::Image)),
    ),
    row(
        "Paste as new document",
        &[ctrl_shift(Key::V)],
        "A document as large as what was copied, which is its layer",
        always,
        |_, requests| requests.request(WindowRequest::Paste(PasteTo::Document)),
    ),
    LINE,
    row(
        "Transform",
        &[ctrl(Key::T)],
        "A frame around the chosen layers and groups: move, scale, turn, skew and distort it, live",
        has_layer,
        |_, requests| requests.act(Action::Hand(HandAction::Tool { tool: ToolKind::Transform })),
    ),
    row(
        "Clear layer",
        &[key(Key::Delete)],
        "Removes the paint or the strokes of the chosen layers where you selected; without a selection all of them",
        has_document,
        |session, requests| {
            requests.act(Action::Layer(LayerAction::Clear { layer: session.layer_paths() }))
        },
    ),
];
