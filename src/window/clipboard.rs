//! The system's clipboard: pictures, and texts for text fields. Floor 7. The toolkit's own
//! clipboard is not built in, so its keys and texts are handled here.

#[cfg(all(unix, not(target_os = "macos")))]
mod x11;

use crate::io::{Budget, picture};
use crate::math::Size;
use crate::raster::Picture;
use crate::session::actions::PastedPicture;
use crate::{Error, Result};
pub use arboard::Clipboard;
use arboard::ImageData;
use eframe::egui::{Context, Event, Key, Modifiers, OutputCommand};
use std::path::{Path, PathBuf};

/// The content of the clipboard to paste.
pub enum PastedContent {
    /// A picture that was copied in another program.
    Picture(PastedPicture),
    /// Copied in a file manager.
    Files(Vec<PathBuf>),
}

/// Reads the clipboard; called on a thread of its own.
pub type ClipboardSource = fn() -> Result<PastedContent>;

fn open() -> Result<Clipboard> {
    Clipboard::new().map_err(|error| Error::unsupported_file("clipboard", error))
}

/// The picture or the files in the clipboard; fails if there are none. It takes as long as the
/// program that owns them needs.
pub fn read_clipboard() -> Result<PastedContent> {
    if let Some((name, bytes)) = read_offer(Budget::of_this_machine().file_bytes)? {
        let picture = picture::decode(Path::new(&name), &bytes, &Budget::of_this_machine())?;
        return Ok(PastedContent::Picture(PastedPicture { name, picture }));
    }
    let mut clipboard = open()?;
    if let Ok(image) = clipboard.get_image() {
        let size = Size::new(image.width as u32, image.height as u32);
        let picture = Picture::srgb8(size, image.bytes.as_chunks::<4>().0.to_vec());
        let picture = picture
            .ok_or_else(|| Error::unsupported_file("clipboard", "its picture is damaged"))?;
        return Ok(PastedContent::Picture(PastedPicture { name: "Pasted.png".into(), picture }));
    }
    let files = clipboard.get().file_list().ok().filter(|files| !files.is_empty());
    files
        .map(PastedContent::Files)
        .ok_or_else(|| Error::invalid("clipboard", "contents", "neither a picture nor files"))
}

/// A picture as the file that another program offers, with a name for it, where the system has
/// such.
#[cfg(all(unix, not(target_os = "macos")))]
fn read_offer(most_bytes: u64) -> Result<Option<(String, Vec<u8>)>> {
    Ok(x11::picture(most_bytes)?.map(|(ending, bytes)| (format!("Pasted.{ending}"), bytes)))
}

#[cfg(not(all(unix, not(target_os = "macos"))))]
fn read_offer(_most_bytes: u64) -> Result<Option<(String, Vec<u8>)>> {
    Ok(None)
}

/// Puts a picture of straight RGBA into the clipboard. It stays there as long as the returned value
/// is kept.
pub fn put(size: Size, rgba: &[u8]) -> Result<Clipboard> {
    let mut clipboard = open()?;
    let image =
        ImageData { width: size.width as usize, height: size.height as usize, bytes: rgba.into() };
    clipboard.set_image(image).map_err(|error| Error::unsupported_file("clipboard", error))?;
    Ok(clipboard)
}

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
            Key::V => open().and_then(|mut clipboard| text(&mut clipboard)).ok().map(Event::Paste),
            _ => None,
        };
        if let Some(meant) = meant {
            *event = meant;
        }
    }
}

fn text(clipboard: &mut Clipboard) -> Result<String> {
    clipboard.get_text().map_err(|error| Error::unsupported_file("clipboard", error))
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
    let (text, mut clipboard) = (copied?, open().ok()?);
    clipboard.set_text(text).ok()?;
    Some(clipboard)
}
