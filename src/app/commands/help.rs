//! The Help menu.
//! Floor 7.

use super::{Command, Menu, always, line};
use crate::app::asked::WindowAsk;

const MENU: Menu = Menu::Help;

pub const COMMANDS: &[Command] = &[
    Command {
        name: "Open the sample",
        menu: MENU,
        keys: &[],
        hint: "A ball with everything on it, to try things out",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::OpenSample),
    },
    Command {
        name: "Keyboard shortcuts…",
        menu: MENU,
        keys: &[],
        hint: "Every command and its keys",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::Shortcuts),
    },
    line(MENU),
    Command {
        name: "About Rilievo…",
        menu: MENU,
        keys: &[],
        hint: "What this program is",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::About),
    },
];
