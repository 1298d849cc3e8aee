//! The Help menu.
//! Floor 7.

use super::{Command, LINE, always, row};
use crate::asked::WindowAsk;

pub const COMMANDS: &[Command] = &[
    row("Open the sample", &[], "A ball with everything on it, to try things out", always, |_, asked| {
        asked.ask(WindowAsk::OpenSample)
    }),
    row("Keyboard shortcuts…", &[], "Every command and its keys", always, |_, asked| asked.ask(WindowAsk::Shortcuts)),
    LINE,
    row("About Rilievo…", &[], "What this program is", always, |_, asked| asked.ask(WindowAsk::About)),
];
