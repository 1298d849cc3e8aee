//! The clipboard of a browser's page.
//! Floor 7.

use super::PastedContent;
use crate::io::{Budget, export, picture, platform};
use crate::math::Size;
use crate::raster::TileGrid;
use crate::session::actions::PastedPicture;
use crate::{Error, Result};
use std::path::Path;

/// What was put there stays by itself.
pub struct Clipboard;

/// The picture that was pasted last, or is in the clipboard; fails if there is none. The browser
/// may ask the user.
pub fn read_clipboard() -> Result<PastedContent> {
    let answer = platform::ask("pasted picture", "", &[]);
    let Some(name) = answer.text else {
        return Err(Error::invalid("clipboard", "contents", "no picture that the browser gives"));
    };
    let picture = picture::decode(Path::new(&name), &answer.bytes, &Budget::of_this_machine())?;
    Ok(PastedContent::Picture(PastedPicture { name, picture }))
}

/// Puts a picture of straight RGBA into the clipboard.
pub fn put(size: Size, rgba: &[u8]) -> Result<Clipboard> {
    let (file, pixels) = (
        Path::new("clipboard.png"),
        TileGrid::from_straight_rgba(rgba, size.width as usize, size.height as usize, 0, 0),
    );
    let options = export::ExportOptions::default();
    let png = export::encode(file, export::ExportFormat::Png, &pixels, size, &options)?;
    platform::tell("copied picture", "", &png);
    Ok(Clipboard)
}

/// The page gives texts as they are pasted, without being asked.
pub fn text() -> Option<String> {
    None
}

/// Puts a text into the clipboard.
pub fn put_text(text: String) -> Option<Clipboard> {
    platform::tell("copied text", &text, &[]);
    Some(Clipboard)
}
