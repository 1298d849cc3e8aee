//! The commands of the menus: one row per command, with its keys. Menus, keyboard, palette and the list of shortcuts
//! are made from the same rows. Floor 7.

mod edit;
mod file;
mod help;
mod layer;
mod paint;
mod shading;
mod view;

use super::requests::UiRequests;
use super::settings::Settings;
use crate::session::Session;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

/// A command.
pub struct MenuCommand {
    /// The label in menus; `…` where a dialog follows. An empty name is a separator.
    pub name: &'static str,
    /// The first is shown.
    pub keys: &'static [KeyboardShortcut],
    /// What it does, in a sentence.
    pub hint: &'static str,
    pub can: fn(&Session) -> bool,
    pub run: fn(&Session, &mut UiRequests),
    /// For a toggle: whether it is on.
    pub is_on: Option<fn(&Session, &Settings) -> bool>,
}

/// A command: name, keys, hint, when it is available, what it does.
const fn row(
    name: &'static str,
    keys: &'static [KeyboardShortcut],
    hint: &'static str,
    can: fn(&Session) -> bool,
    run: fn(&Session, &mut UiRequests),
) -> MenuCommand {
    MenuCommand { name, keys, hint, can, run, is_on: None }
}

impl MenuCommand {
    /// Shows a tick in the menu while this is true.
    const fn ticked(self, is_on: fn(&Session, &Settings) -> bool) -> Self {
        Self { is_on: Some(is_on), ..self }
    }
    pub const fn is_line(&self) -> bool {
        self.name.is_empty()
    }
}

/// A separator between two commands of a menu.
const LINE: MenuCommand = row("", &[], "", always, |_, _| {});

/// The menus and what is in them.
pub const MENUS: [(&str, &[MenuCommand]); 6] = [
    ("File", file::COMMANDS),
    ("Edit", edit::COMMANDS),
    ("Layer", layer::COMMANDS),
    ("Paint", paint::COMMANDS),
    ("View", view::COMMANDS),
    ("Help", help::COMMANDS),
];
/// A menu within Layer.
pub const SHADING: &[MenuCommand] = shading::COMMANDS;

/// Every command, menu by menu.
pub fn all() -> impl Iterator<Item = &'static MenuCommand> {
    const EVERY: [(&str, &[MenuCommand]); 6] = MENUS;
    let menus = EVERY.into_iter().flat_map(|(_, commands)| commands);
    menus.chain(SHADING).filter(|command| !command.is_line())
}

/// A command by its name.
pub fn named(name: &str) -> Option<&'static MenuCommand> {
    all().find(|command| command.name == name)
}

/// The operators of the options bar: name, default values, purpose.
pub fn operators() -> [(&'static str, crate::surface::Operator, &'static str); 4] {
    paint::OPERATORS
}

const fn key(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}
const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}
const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}
const fn ctrl_alt(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::ALT), key)
}
const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

fn always(_: &Session) -> bool {
    true
}
fn has_document(session: &Session) -> bool {
    session.active().is_some()
}
fn has_layer(session: &Session) -> bool {
    session.layer().is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    #[test]
    fn no_two_commands_share_a_key_or_a_name() {
        let (mut keys, mut names) = (HashMap::new(), HashMap::new());
        for command in all() {
            assert_eq!(names.insert(command.name, ()), None, "{} twice", command.name);
            assert!(!command.hint.is_empty(), "{} says nothing", command.name);
            for key in command.keys {
                assert_eq!(keys.insert(format!("{key:?}"), command.name), None, "{}", command.name);
            }
        }
        for tool in crate::tools::ToolKind::ALL {
            let letter = key(Key::from_name(&tool.key.to_string()).unwrap());
            assert_eq!(keys.insert(format!("{letter:?}"), tool.label), None, "{}", tool.label);
        }
    }
}
