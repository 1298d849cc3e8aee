//! The Edit menu.
//! Floor 7.

use super::{Command, Menu, always, ctrl, ctrl_shift, has_document, has_layer, key, line};
use crate::app::asked::WindowAsk;
use crate::session::Action;
use crate::session::actions::{EditAction, LayerAction};
use eframe::egui::Key;

const MENU: Menu = Menu::Edit;

pub const COMMANDS: &[Command] = &[
    Command {
        name: "Undo",
        menu: MENU,
        keys: &[ctrl(Key::Z)],
        hint: "Take the last step back",
        can: |session| session.tab().is_some_and(|tab| tab.history.done().is_some()),
        run: |_, asked| asked.act(Action::Edit(EditAction::Undo {})),
    },
    Command {
        name: "Redo",
        menu: MENU,
        keys: &[ctrl_shift(Key::Z), ctrl(Key::Y)],
        hint: "Make the last undone step again",
        can: |session| session.tab().is_some_and(|tab| tab.history.undone().is_some()),
        run: |_, asked| asked.act(Action::Edit(EditAction::Redo {})),
    },
    line(MENU),
    Command {
        name: "Copy merged picture",
        menu: MENU,
        keys: &[ctrl_shift(Key::C)],
        hint: "The finished picture to the clipboard",
        can: has_document,
        run: |_, asked| asked.ask(WindowAsk::CopyMerged),
    },
    Command {
        name: "Paste picture",
        menu: MENU,
        keys: &[ctrl(Key::V)],
        hint: "A picture from the clipboard as an image layer",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::Paste),
    },
    Command {
        name: "Clear layer",
        menu: MENU,
        keys: &[key(Key::Delete)],
        hint: "Take the paint or the strokes out of the selected layer",
        can: has_layer,
        run: |session, asked| {
            if let Some(layer) = session.layer_path() {
                asked.act(Action::Layer(LayerAction::Clear { layer }));
            }
        },
    },
];
