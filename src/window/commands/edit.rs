//! The Edit menu.
//! Floor 7.

use super::row::{
    LINE, MenuCommand, always, ctrl, ctrl_alt, ctrl_shift, has_document, has_layer, key, row,
    submenu,
};
use crate::preferences::PreferencePage;
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
        |session| session.active().is_some_and(|open| open.history.undo_label().is_some()),
        |_, requests| requests.act(Action::Edit(EditAction::Undo {})),
    ),
    row(
        "Redo",
        &[ctrl_shift(Key::Z), ctrl(Key::Y)],
        "Redo the last undone step",
        |session| session.active().is_some_and(|open| open.history.redo_name().is_some()),
        |_, requests| requests.act(Action::Edit(EditAction::Redo {})),
    ),
    LINE,
    row(
        "Cut",
        &[ctrl(Key::X)],
        "Removes the selected area from the layer and copies it",
        has_document,
        |_, requests| requests.act(Action::Clipboard(ClipboardAction::Cut {})),
    ),
    row(
        "Copy",
        &[ctrl(Key::C)],
        "Copies the selected area of the layer; strokes stay strokes",
        has_document,
        |_, requests| requests.act(Action::Clipboard(ClipboardAction::Copy { merged: false })),
    ),
    row(
        "Copy merged picture",
        &[ctrl_shift(Key::C)],
        "Copies everything visible in the selected area",
        has_document,
        |_, requests| requests.act(Action::Clipboard(ClipboardAction::Copy { merged: true })),
    ),
    row(
        "Paste",
        &[ctrl(Key::V)],
        "Pastes what was copied in place, as a layer; a picture from another program as paint, at \
         its own size, at the pointer",
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
        "Makes a document of what was copied, in its size",
        always,
        |_, requests| requests.request(WindowRequest::Paste(PasteTo::Document)),
    ),
    LINE,
    row(
        "Free transform",
        &[ctrl(Key::T)],
        "A frame around the selected layers and groups: move, scale, turn, skew and distort them, \
         live",
        has_layer,
        |_, requests| requests.act(Action::Hand(HandAction::Tool { tool: ToolKind::Transform })),
    ),
    submenu("Transform layer", super::transform::COMMANDS),
    row(
        "Clear layer",
        &[key(Key::Delete)],
        "Removes the paint or strokes of the selected layers in the selected area; without a \
         selection, all of them",
        has_document,
        |session, requests| {
            requests.act(Action::Layer(LayerAction::Clear { layer: session.layer_paths() }))
        },
    ),
    LINE,
    row(
        "Preferences…",
        &[ctrl(Key::Comma)],
        "Everything that is set once: the interface, keys, the pen, colors, files, memory",
        always,
        |_, requests| requests.request(WindowRequest::Preferences(PreferencePage::default())),
    ),
];
