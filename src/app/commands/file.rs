//! The File menu.
//! Floor 7.

use super::{Command, Menu, always, ctrl, ctrl_shift, has_document, line};
use crate::app::asked::WindowAsk;
use eframe::egui::Key;

const MENU: Menu = Menu::File;

pub const COMMANDS: &[Command] = &[
    Command {
        name: "New…",
        menu: MENU,
        keys: &[ctrl(Key::N)],
        hint: "An empty canvas, or one on the normal and depth maps of an object",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::NewDialog),
    },
    Command {
        name: "Open…",
        menu: MENU,
        keys: &[ctrl(Key::O)],
        hint: "A project, a recipe, a normal or depth map, or a picture",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::OpenDialog),
    },
    Command {
        name: "Open maps…",
        menu: MENU,
        keys: &[ctrl_shift(Key::O)],
        hint: "A canvas on the normal and depth maps of an object, their conventions shown and corrected",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::OpenMapsDialog),
    },
    line(MENU),
    Command {
        name: "Save",
        menu: MENU,
        keys: &[ctrl(Key::S)],
        hint: "To the file it came from",
        can: has_document,
        run: |_, asked| asked.ask(WindowAsk::Save),
    },
    Command {
        name: "Save as…",
        menu: MENU,
        keys: &[ctrl_shift(Key::S)],
        hint: "To another file, which is its own from then on",
        can: has_document,
        run: |_, asked| asked.ask(WindowAsk::SaveAs),
    },
    Command {
        name: "Export…",
        menu: MENU,
        keys: &[ctrl(Key::E)],
        hint: "The finished picture as PNG, EXR, JPEG or WebP",
        can: has_document,
        run: |_, asked| asked.ask(WindowAsk::ExportDialog),
    },
    line(MENU),
    Command {
        name: "Place image…",
        menu: MENU,
        keys: &[ctrl_shift(Key::I)],
        hint: "A picture as a layer bent over the surface",
        can: has_document,
        run: |_, asked| asked.ask(WindowAsk::PlaceDialog),
    },
    line(MENU),
    Command {
        name: "Close",
        menu: MENU,
        keys: &[ctrl(Key::W)],
        hint: "This document; asks first if it holds unsaved work",
        can: has_document,
        run: |session, asked| asked.ask(WindowAsk::Close(session.current)),
    },
    Command {
        name: "Quit",
        menu: MENU,
        keys: &[ctrl(Key::Q)],
        hint: "Leave the program; asks first if there is unsaved work",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::Quit),
    },
];
