//! The Edit menu.
//! Floor 7.

use super::row::{LINE, MenuCommand, always, ctrl, ctrl_shift, has_document, has_layer, key, row};
use crate::document::Content;
use crate::requests::WindowRequest;
use crate::session::Action;
use crate::session::actions::{EditAction, HandAction, LayerAction};
use crate::tools::ToolKind;
use eframe::egui::Key;

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Undo",
        &[ctrl(Key::Z)],
        "Undo the last step",
        |session| session.active().is_some_and(|tab| tab.history.done().is_some()),
        |_, requests| requests.act(Action::Edit(EditAction::Undo {})),
    ),
    row(
        "Redo",
        &[ctrl_shift(Key::Z), ctrl(Key::Y)],
        "Redo the last undone step",
        |session| session.active().is_some_and(|tab| tab.history.undone().is_some()),
        |_, requests| requests.act(Action::Edit(EditAction::Redo {})),
    ),
    LINE,
    row(
        "Copy merged picture",
        &[ctrl_shift(Key::C)],
        "Copies the flattened picture to the clipboard",
        has_document,
        |_, requests| requests.request(WindowRequest::CopyMerged),
    ),
    row(
        "Paste picture",
        &[ctrl(Key::V)],
        "Pastes a picture from the clipboard as an image layer",
        always,
        |_, requests| requests.request(WindowRequest::Paste),
    ),
    LINE,
    row(
        "Move, scale and turn",
        &[ctrl(Key::T)],
        "Selects the image tool for an image layer (drag moves, Shift scales, Ctrl turns), else the move tool",
        has_layer,
        |session, requests| {
            let is_image = session.layer().is_some_and(|layer| matches!(layer.content, Content::Image(_)));
            let tool = if is_image { ToolKind::Image } else { ToolKind::Move };
            requests.act(Action::Hand(HandAction::Tool { tool }));
        },
    ),
    row(
        "Clear layer",
        &[key(Key::Delete)],
        "Removes the paint or the strokes of the selected layer",
        has_layer,
        |session, requests| {
            if let Some(layer) = session.layer_path() {
                requests.act(Action::Layer(LayerAction::Clear { layer }));
            }
        },
    ),
];
