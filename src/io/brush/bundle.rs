//! Krita's bundles: a zip of presets, tips, patterns and other things. Floor 5. Reads every preset
//! with the tips and patterns of the bundle; of a bundle without presets, the tips.

use super::beside::{BundleFiles, ResourceKind};
use super::kpp::{self, KppPictures};
use super::{ImportedBrush, abr, gbr, gih, myb, text_of};
use crate::project::Archive;
use crate::{Budget, Error, Files, Result};
use std::collections::BTreeMap;
use std::path::Path;

/// The first entry, which is not packed, says what the zip is.
const MIME: &str = "mimetypeapplication/x-krita-resourcebundle";
const MIME_AT: usize = 30;
const PRESETS: &str = "paintoppresets";
/// More presets than any known bundle has.
const MOST: usize = 4096;
/// Names in one note.
const MOST_NAMED: usize = 6;

/// Whether a file is a bundle, by its first bytes.
pub fn is_bundle(bytes: &[u8]) -> bool {
    Archive::is_zip(bytes)
        && bytes.get(MIME_AT..MIME_AT + MIME.len()).is_some_and(|found| found == MIME.as_bytes())
}

/// Reads all brushes of a bundle, by the names of their files. The notes of the first say which were
/// left out.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Vec<ImportedBrush>> {
    if !Archive::is_zip(bytes) {
        return Err(Error::decode(file, "it is no bundle of Krita, which is a zip file"));
    }
    let archive = Archive::open(file, bytes, budget)?;
    let files = BundleFiles(&archive);
    let mut reading = BundleReader {
        archive: &archive,
        budget,
        pictures: KppPictures::new(file, &files, budget),
        brushes: Vec::new(),
        left_out: BTreeMap::new(),
    };
    reading.read_folder(PRESETS, &["kpp", "myb"]);
    if reading.brushes.is_empty() && reading.left_out.is_empty() {
        reading.read_folder(ResourceKind::Tip.folder(), &["gbr", "gih", "abr", "png", "svg"]);
    }
    let BundleReader { mut brushes, left_out, .. } = reading;
    let mut notes = left_out.iter().map(|(reason, names)| left_out_note(reason, names));
    match brushes.first_mut() {
        Some(first) => first.notes.extend(notes),
        None => {
            let reason = notes.next().unwrap_or_else(|| "it is a bundle without brushes".into());
            return Err(Error::unsupported_file(file, reason));
        }
    }
    Ok(brushes)
}

/// A bundle being read.
struct BundleReader<'a> {
    archive: &'a Archive<'a>,
    budget: &'a Budget,
    pictures: KppPictures<'a>,
    brushes: Vec<ImportedBrush>,
    /// Names of files, by why they were left out.
    left_out: BTreeMap<String, Vec<String>>,
}

impl BundleReader<'_> {
    /// Reads the files of a folder that have one of these endings.
    fn read_folder(&mut self, folder: &str, endings: &[&str]) {
        let archive = self.archive;
        for entry in archive.names() {
            let name = entry.strip_prefix(folder).and_then(|rest| rest.strip_prefix('/'));
            let Some((name, (_, ending))) =
                name.and_then(|name| Some((name, name.rsplit_once('.')?)))
            else {
                continue;
            };
            let ending = ending.to_lowercase();
            if !endings.contains(&ending.as_str()) {
                continue;
            }
            let read = match self.brushes.len() < MOST {
                true => self.read_entry(entry, name, &ending),
                false => Err(Error::too_large(entry, format!("a bundle may have {MOST} brushes"))),
            };
            match read {
                Ok(brushes) => self.brushes.extend(brushes),
                Err(error) => {
                    self.left_out
                        .entry(reason_of(error))
                        .or_default()
                        .push(text_of(name.as_bytes()));
                }
            }
        }
    }

    fn read_entry(&mut self, entry: &str, name: &str, ending: &str) -> Result<Vec<ImportedBrush>> {
        let bytes = self.archive.bytes(entry, self.budget.file_bytes)?;
        let path = self.archive.path(entry);
        let one = match ending {
            "abr" => return abr::read(&path, &bytes, self.budget),
            "kpp" => kpp::read_preset(&path, &bytes, &mut self.pictures),
            "myb" => myb::read(&path, &bytes, self.budget),
            "gbr" => gbr::read(&path, &bytes, self.budget),
            "gih" => gih::read(&path, &bytes, self.budget),
            _ => kpp::read_tip(&path, name, &mut self.pictures),
        };
        one.map(|brush| vec![brush])
    }
}

/// What a sentence says after the name of the file.
fn reason_of(error: Error) -> String {
    match error {
        Error::Decode { reason, .. }
        | Error::Unsupported { reason, .. }
        | Error::TooLarge { reason, .. } => reason,
        other => other.to_string(),
    }
}

fn left_out_note(reason: &str, names: &[String]) -> String {
    let first = names.iter().take(MOST_NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
    let more = match names.len().saturating_sub(MOST_NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{} of the bundle left out, {first}{more}: {reason}", names.len())
}

#[cfg(test)]
mod tests;
