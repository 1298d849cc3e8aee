//! The clipboard of a desktop.
//! Floor 7.

use super::PastedContent;
use crate::io::{Budget, picture};
use crate::math::Size;
use crate::raster::Picture;
use crate::session::actions::PastedPicture;
use crate::{Error, Result};
pub use arboard::Clipboard;
use arboard::ImageData;
use std::path::Path;

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
    Ok(super::x11::picture(most_bytes)?.map(|(ending, bytes)| (format!("Pasted.{ending}"), bytes)))
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

/// The text in the clipboard.
pub fn text() -> Option<String> {
    open().ok()?.get_text().ok()
}

/// Puts a text into the clipboard; the returned value must be kept.
pub fn put_text(text: String) -> Option<Clipboard> {
    let mut clipboard = open().ok()?;
    clipboard.set_text(text).ok()?;
    Some(clipboard)
}
