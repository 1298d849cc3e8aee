//! Everything in the menus: one row a command, with its keys. Menus, the keyboard, the palette and the list of shortcuts are
//! made from the same rows.
//! Floor 7.

mod edit;
mod file;
mod help;
mod layer;
mod paint;
mod shading;
mod view;

use super::asked::Asked;
use crate::session::Session;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

/// A command.
pub struct Command {
    /// As menus show it; `…` where a dialog follows.
    pub name: &'static str,
    pub menu: Menu,
    /// The first is shown.
    pub keys: &'static [KeyboardShortcut],
    /// What it does, in a sentence.
    pub hint: &'static str,
    pub can: fn(&Session) -> bool,
    pub run: fn(&Session, &mut Asked),
}

/// Where a command stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    File,
    Edit,
    Layer,
    /// Within the Layer menu.
    Shading,
    Paint,
    View,
    Help,
}

impl Menu {
    pub const ALL: [(Menu, &'static str); 6] = [
        (Menu::File, "File"),
        (Menu::Edit, "Edit"),
        (Menu::Layer, "Layer"),
        (Menu::Paint, "Paint"),
        (Menu::View, "View"),
        (Menu::Help, "Help"),
    ];
}

/// Every command, menu by menu. An empty name is a line between two.
pub fn all() -> impl Iterator<Item = &'static Command> {
    [
        file::COMMANDS,
        edit::COMMANDS,
        layer::COMMANDS,
        shading::COMMANDS,
        paint::COMMANDS,
        view::COMMANDS,
        help::COMMANDS,
    ]
    .into_iter()
    .flatten()
}

/// A command by its name.
pub fn named(name: &str) -> Option<&'static Command> {
    all().find(|command| command.name == name)
}

/// The operators as the tool bar offers them: name, what each begins with, what it is for.
pub fn operators() -> [(&'static str, crate::surface::Operator, &'static str); 4] {
    paint::OPERATORS
}

/// A line between two commands of a menu.
const fn line(menu: Menu) -> Command {
    Command { name: "", menu, keys: &[], hint: "", can: always, run: |_, _| {} }
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
const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

fn always(_: &Session) -> bool {
    true
}
fn has_document(session: &Session) -> bool {
    session.tab().is_some()
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
        for command in all().filter(|command| !command.name.is_empty()) {
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
