//! The Help menu.
//! Floor 7.

use super::row::{LINE, MenuCommand, always, row};
use crate::requests::WindowRequest;

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Open the sample",
        &[],
        "A ball with everything on it, to try things out",
        always,
        |_, requests| requests.request(WindowRequest::OpenSample(0)),
    ),
    row("Keyboard shortcuts…", &[], "Every command and its keys", always, |_, requests| {
        requests.request(WindowRequest::Shortcuts)
    }),
    LINE,
    row("About Rilievo…", &[], "About this program", always, |_, requests| {
        requests.request(WindowRequest::About)
    }),
];
