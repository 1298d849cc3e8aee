//! File extensions: those of documents and pictures, of saving and of exporting. Floor 6.

use crate::io::export::ExportFormat;
use std::path::{Path, PathBuf};

/// Extensions of the files that hold documents.
pub const DOCUMENTS: [&str; 10] =
    ["ora", "psd", "psb", "json", "kra", "krz", "ase", "aseprite", "clip", "procreate"];
/// Extensions of the files that documents are saved to, the first being this program's own.
pub const SAVED: [&str; 2] = ["ora", "psd"];
/// Extensions of the files that hold pictures.
pub const PICTURES: [&str; 19] = [
    "png", "jpg", "jpeg", "webp", "tif", "tiff", "bmp", "tga", "hdr", "exr", "gif", "qoi", "pnm",
    "pbm", "pgm", "ppm", "pam", "pfm", "svg",
];

/// The extension of files that hold actions.
pub const SCRIPTS: [&str; 1] = ["jsonl"];

/// Whether a file is a document by the ending of its name.
pub fn is_document(file: &Path) -> bool {
    has_extension(file, &DOCUMENTS)
}

/// Whether a file holds actions by the ending of its name.
pub fn is_script(file: &Path) -> bool {
    has_extension(file, &SCRIPTS)
}

/// Whether a document can be saved to a file of this name.
pub fn is_saved_to(file: &Path) -> bool {
    has_extension(file, &SAVED)
}

/// Whether a file of this name holds all of a document, for every program that opens it.
pub fn is_whole_document(file: &Path) -> bool {
    !has_extension(file, &SAVED[1..])
}

/// Extensions of the files that a picture is exported to, or the whole document for Photoshop.
pub fn export_extensions() -> impl Iterator<Item = &'static str> {
    ExportFormat::ALL.iter().map(|(_, extension)| *extension).chain([SAVED[1]])
}

pub(super) fn has_extension(file: &Path, extensions: &[&str]) -> bool {
    let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    extensions.contains(&extension.as_str())
}

/// The files of a folder that a document could be opened from, for a picker.
pub fn is_openable(file: &Path) -> bool {
    is_document(file) || is_script(file) || has_extension(file, &PICTURES)
}

/// With one of these extensions, else with this one: it is appended, because what follows a name's
/// last point may be part of the name.
pub fn with_document_extension(file: PathBuf, extension: &str, extensions: &[&str]) -> PathBuf {
    if has_extension(&file, extensions) { file } else { file.with_added_extension(extension) }
}

/// A name without the extension of a file that can be opened or written; unchanged if it has none.
pub fn without_ending(name: &str) -> &str {
    let known = |(stem, extension): &(&str, &str)| {
        let extension = extension.to_lowercase();
        !stem.is_empty() && DOCUMENTS.iter().chain(&PICTURES).any(|known| *known == extension)
    };
    name.rsplit_once('.').filter(known).map_or(name, |(stem, _)| stem)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_are_added_and_never_take_a_part_of_the_name() {
        let named = |name: &str| {
            with_document_extension(name.into(), "ora", &SAVED).to_string_lossy().into_owned()
        };
        for (name, file) in [
            ("robot v1.2", "robot v1.2.ora"),
            ("robot", "robot.ora"),
            ("robot.ora", "robot.ora"),
            ("ROBOT.ORA", "ROBOT.ORA"),
            ("s.psd", "s.psd"),
            ("photo.png", "photo.png.ora"),
            ("a/b.c/robot", "a/b.c/robot.ora"),
            (".hidden", ".hidden.ora"),
        ] {
            assert_eq!(named(name), file);
        }
        let extensions: Vec<&str> = export_extensions().collect();
        let exported = |name: &str| {
            with_document_extension(name.into(), "png", &extensions).to_string_lossy().into_owned()
        };
        assert_eq!(exported("final v1.2"), "final v1.2.png");
        assert_eq!((exported("a.jpg"), exported("a.psd")), ("a.jpg".into(), "a.psd".into()));
    }

    #[test]
    fn only_what_is_known_to_be_an_ending_is_taken_from_a_name() {
        for (name, stem) in [
            ("robot v1.2", "robot v1.2"),
            ("robot v1.2.ora", "robot v1.2"),
            ("photo.PNG", "photo"),
            ("Untitled 1", "Untitled 1"),
            (".png", ".png"),
        ] {
            assert_eq!(without_ending(name), stem);
        }
    }
}
