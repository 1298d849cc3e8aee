//! The system's clipboard: pictures, and texts for text fields. Floor 7. The toolkit's own
//! clipboard is not built in, so its keys and texts are handled here. `system` asks the desktop,
//! `page` the browser.

#[cfg(target_family = "wasm")]
mod page;
#[cfg(not(target_family = "wasm"))]
mod system;
#[cfg(all(unix, not(target_os = "macos")))]
mod x11;

use crate::Result;
use crate::session::actions::PastedPicture;
use eframe::egui::{Context, Event, Key, Modifiers, OutputCommand};
#[cfg(target_family = "wasm")]
pub use page::{Clipboard, put, read_clipboard};
#[cfg(target_family = "wasm")]
use page::{put_text, text};
use std::path::PathBuf;
#[cfg(not(target_family = "wasm"))]
pub use system::{Clipboard, put, read_clipboard};
#[cfg(not(target_family = "wasm"))]
use system::{put_text, text};

/// The content of the clipboard to paste.
pub enum PastedContent {
    /// A picture that was copied in another program.
    Picture(PastedPicture),
    /// Copied in a file manager.
    Files(Vec<PathBuf>),
}

/// Reads the clipboard; called on a thread of its own.
pub type ClipboardSource = fn() -> Result<PastedContent>;

/// In text fields: turns the keys for cut, copy and paste into their events.
pub fn translate_keys(ctx: &Context, events: &mut [Event]) {
    if !ctx.egui_wants_keyboard_input() {
        return;
    }
    for event in events {
        let Event::Key {
            key,
            pressed: true,
            modifiers: Modifiers { command: true, shift: false, alt: false, .. },
            ..
        } = event
        else {
            continue;
        };
        let meant = match key {
            Key::C => Some(Event::Copy),
            Key::X => Some(Event::Cut),
            Key::V => text().map(Event::Paste),
            _ => None,
        };
        if let Some(meant) = meant {
            *event = meant;
        }
    }
}

/// Puts the text that a field copied into the clipboard; the returned value must be kept.
pub fn take_text(ctx: &Context) -> Option<Clipboard> {
    let mut copied = None;
    ctx.output_mut(|output| {
        output.commands.retain(|command| match command {
            OutputCommand::CopyText(text) => {
                copied = Some(text.clone());
                false
            }
            _ => true,
        });
    });
    put_text(copied?)
}
