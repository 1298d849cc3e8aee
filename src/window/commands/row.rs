//! One row of the menus: a command with its keys, and the short functions that rows are written
//! with. Floor 7.

use crate::document::Content;
use crate::language::tr;
use crate::panel_layout::PanelLayout;
use crate::requests::UiRequests;
use crate::session::Session;
use crate::tr;
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
    pub is_on: Option<fn(&Session, &PanelLayout) -> bool>,
    /// The commands of a menu within the menu; empty for a command. Those have none within.
    pub within: &'static [MenuCommand],
}

/// A command: name, keys, hint, when it is available, what it does.
pub const fn row(
    name: &'static str,
    keys: &'static [KeyboardShortcut],
    hint: &'static str,
    can: fn(&Session) -> bool,
    run: fn(&Session, &mut UiRequests),
) -> MenuCommand {
    MenuCommand { name, keys, hint, can, run, is_on: None, within: &[] }
}

/// A menu within a menu.
pub const fn submenu(name: &'static str, within: &'static [MenuCommand]) -> MenuCommand {
    MenuCommand { within, ..row(name, &[], "", always, |_, _| {}) }
}

impl MenuCommand {
    /// Shows a tick in the menu while this is true.
    pub const fn ticked(self, is_on: fn(&Session, &PanelLayout) -> bool) -> Self {
        Self { is_on: Some(is_on), ..self }
    }

    /// Why it cannot be done now, in the language of the window; its hint says what it would do.
    pub fn refusal(&self, session: &Session) -> String {
        let command = tr(self.name).trim_end_matches('…');
        match (session.active(), session.layer()) {
            (None, _) => tr!("{command}: there is no document.", command),
            (_, None) => tr!("{command}: no layer is selected.", command),
            _ => tr!("{command}: there is nothing here to apply it to.", command),
        }
    }

    pub const fn is_line(&self) -> bool {
        self.name.is_empty()
    }

    pub const fn is_menu(&self) -> bool {
        !self.within.is_empty()
    }

    /// Itself, or the commands within it.
    pub fn commands(&'static self) -> &'static [MenuCommand] {
        if self.is_menu() { self.within } else { std::slice::from_ref(self) }
    }
}

/// A separator between two commands of a menu.
pub const LINE: MenuCommand = row("", &[], "", always, |_, _| {});

pub const fn key(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

pub const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

pub const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}

pub const fn ctrl_alt(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::ALT), key)
}

pub const fn ctrl_alt_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::ALT).plus(Modifiers::SHIFT), key)
}

pub const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

pub fn always(_: &Session) -> bool {
    true
}

pub fn has_document(session: &Session) -> bool {
    session.active().is_some()
}

pub fn has_surface(session: &Session) -> bool {
    session.shown_document().is_some_and(|document| document.surface.is_some())
}

pub fn has_layer(session: &Session) -> bool {
    session.layer().is_some()
}

/// Whether the active layer is painted on.
pub fn has_paint(session: &Session) -> bool {
    session.layer().is_some_and(|layer| matches!(layer.content, Content::Pixels(_)))
}
