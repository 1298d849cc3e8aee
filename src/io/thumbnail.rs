//! Small pictures of files, as file managers show them. Floor 5.

#![warn(missing_docs)]

use super::files::read_file;
use super::project::{self, SmallPicture};
use super::{Budget, open};
use crate::document::{Progress, flatten};
use crate::profile_change::show_in_srgb;
use crate::raster::TileGrid;
use crate::{Error, Result};
use std::path::Path;

/// Sides that a file manager may ask for, px.
pub const SIDES_PX: std::ops::RangeInclusive<u32> = 16..=1024;

/// A small picture of any file that can be opened, its longer side at most `side_px`.
///
/// A project holds one of 256 pixels, which is used if that is enough: nothing is painted. Any
/// other file is opened and painted. Fails as [`open()`] does.
pub fn thumbnail(file: &Path, side_px: u32, budget: &Budget) -> Result<SmallPicture> {
    let bytes = read_file(file, budget.file_bytes)?;
    match project::stored_thumbnail(file, &bytes, side_px, budget) {
        Some(stored) => Ok(stored),
        None => paint(file, side_px, budget),
    }
}

/// The whole document, painted and made smaller.
fn paint(file: &Path, side_px: u32, budget: &Budget) -> Result<SmallPicture> {
    let document = open(file, budget)?.document;
    let size = document.size;
    // Nothing here cancels, so it is always painted.
    let whole = flatten(&document, &Progress::default());
    let shown = |tiles: TileGrid| {
        let mut rgba = tiles.to_straight_rgba(size.rect());
        show_in_srgb(&mut rgba, document.profile);
        rgba
    };
    whole
        .and_then(|tiles| SmallPicture::of(shown(tiles), size, side_px))
        .ok_or_else(|| Error::decode(file, "the picture has no pixels"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::sample;

    /// A project of 512 × 512 pixels, and what `change` made of its bytes, in a file.
    fn project(change: impl Fn(Vec<u8>) -> Vec<u8>) -> (tempfile::TempDir, std::path::PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("drawing.ora");
        let document = sample::everything(512);
        let bytes = project::write(&file, &document, &Progress::default()).unwrap().unwrap();
        std::fs::write(&file, change(bytes)).unwrap();
        (folder, file)
    }

    #[test]
    fn a_project_shows_the_picture_that_it_holds() {
        // Damaged documents cannot be painted: what is seen was stored.
        let damage = |mut bytes: Vec<u8>| {
            let name = b"rilievo/document.json";
            let places: Vec<usize> =
                (0..bytes.len() - name.len()).filter(|&i| bytes[i..].starts_with(name)).collect();
            for at in places {
                bytes[at..at + name.len()].fill(b'x');
            }
            bytes
        };
        let (_folder, file) = project(damage);
        let stored = thumbnail(&file, 256, &Budget::default()).unwrap();
        let (_other, whole) = project(|bytes| bytes);
        let same = thumbnail(&whole, 256, &Budget::default()).unwrap();
        assert_eq!(same.size, crate::math::Size::new(256, 256));
        assert!(stored.rgba == same.rgba, "the stored picture is not what is shown");
    }

    #[test]
    fn a_larger_one_is_painted() {
        let (_folder, file) = project(|bytes| bytes);
        let large = thumbnail(&file, 512, &Budget::default()).unwrap();
        let document = sample::everything(512);
        let painted = flatten(&document, &Progress::default()).unwrap();
        assert_eq!(large.size, document.size);
        assert!(large.rgba == painted.to_straight_rgba(document.size.rect()));
    }

    #[test]
    fn a_file_that_is_no_picture_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("letter.txt");
        std::fs::write(&file, "Dear reader").unwrap();
        let refusal = thumbnail(&file, 128, &Budget::default()).err().unwrap();
        assert!(refusal.to_string().contains("letter.txt"), "{refusal}");
    }
}
