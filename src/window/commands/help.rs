//! The Help menu.
//! Floor 7.

use super::row::{LINE, MenuCommand, always, key, row};
use crate::preferences::PreferencePage;
use crate::requests::WindowRequest;
use crate::sample::TOUR_SAMPLE;
use eframe::egui::Key;

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Open the sample",
        &[],
        "A ball with everything on it, to try things out",
        always,
        |_, requests| requests.request(WindowRequest::OpenSample(0)),
    ),
    row(
        "Take the tour",
        &[],
        "Six steps from a flat drawing to a finished picture",
        always,
        |_, requests| requests.request(WindowRequest::OpenSample(TOUR_SAMPLE)),
    ),
    row("Keyboard shortcuts…", &[], "Every command and its keys", always, |_, requests| {
        requests.request(WindowRequest::Preferences(PreferencePage::Keys))
    }),
    row(
        "Open the menus",
        &[key(Key::F10)],
        "For the keyboard: arrows go through them, Enter chooses, Escape leaves them",
        always,
        |_, requests| requests.request(WindowRequest::Menus),
    ),
    LINE,
    row("What's new…", &[], "What this version brought", always, |_, requests| {
        requests.request(WindowRequest::News)
    }),
    row("About Rilievo…", &[], "About this program", always, |_, requests| {
        requests.request(WindowRequest::About)
    }),
];
