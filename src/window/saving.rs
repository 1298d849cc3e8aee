//! Saves and exports what is pending, and reports the result. Run as jobs. Floor 7. Nothing is
//! replaced without asking. Not here: writing (`io::replace`), the questions (`dialogs`).

use crate::document::Progress;
use crate::io::fs::Disk;
use crate::io::replace::{FileStamp, check};
use crate::io::save::encode;
use crate::pending::{Exporting, ExportingMaps, Pending, Saving};
use crate::session::actions::files::{export, export_maps};
use crate::session::actions::unwrapped;
use crate::{Error, Result};
use std::path::PathBuf;

/// How saving or exporting ended.
pub enum WriteResult {
    Saved(Box<Saving>, FileStamp),
    /// It is not yet saved: the user must first know what the format cannot hold.
    Loses(Box<Saving>),
    /// With what the format cannot hold.
    Exported(Box<Exporting>, Vec<String>),
    ExportedMaps(Vec<PathBuf>),
    /// Something would be lost that the user was not asked about; why.
    Refused(Pending, String),
    Canceled,
    Failed(Error),
}

impl Pending {
    /// Writes it.
    pub fn run(self, progress: &Progress) -> WriteResult {
        match self {
            Pending::Save(saving) => saving.run(progress),
            Pending::Export(exporting) => exporting.run(progress),
            Pending::Maps(exporting) => exporting.run(),
        }
    }
}

impl ExportingMaps {
    fn run(self) -> WriteResult {
        match export_maps(&self.document, &self.file, &self.maps, self.options, &self.terms) {
            Ok(files) => WriteResult::ExportedMaps(files),
            Err(error) => refuse(error, || Pending::Maps(Box::new(self))),
        }
    }
}

/// How far a save came.
enum SaveStep {
    Saved(FileStamp),
    /// The user must be told first what is lost.
    Loses,
    Canceled,
}

impl Saving {
    fn run(mut self, progress: &Progress) -> WriteResult {
        match self.attempt(progress) {
            Ok(SaveStep::Saved(stamp)) => WriteResult::Saved(Box::new(self), stamp),
            Ok(SaveStep::Loses) => WriteResult::Loses(Box::new(self)),
            Ok(SaveStep::Canceled) => WriteResult::Canceled,
            Err(error) => refuse(error, || Pending::Save(Box::new(self))),
        }
    }

    fn attempt(&mut self, progress: &Progress) -> Result<SaveStep> {
        // Checked before the work of making the bytes.
        check(&Disk, &self.file, &self.terms)?;
        let encoded = match self.encoded.take() {
            Some(encoded) => Some(encoded),
            None => encode(&self.document, &self.file, progress)?,
        };
        let Some(encoded) = encoded else { return Ok(SaveStep::Canceled) };
        let encoded = self.encoded.insert(encoded);
        if !self.knows_losses {
            return Ok(SaveStep::Loses);
        }
        let saved = encoded.save(&self.file, &self.terms, progress)?;
        Ok(saved.map_or(SaveStep::Canceled, |saved| SaveStep::Saved(saved.stamp)))
    }
}

impl Exporting {
    fn run(self, progress: &Progress) -> WriteResult {
        let terms = self.terms.clone();
        let written = match self.unwrapped {
            Some(options) => {
                unwrapped::export(&self.document, &self.file, options, terms, progress)
                    .map(|()| Vec::new())
            }
            None => export(&self.document, &self.file, &self.settings, terms, progress),
        };
        match written {
            Ok(_) if progress.is_canceled() => WriteResult::Canceled,
            Ok(notes) => WriteResult::Exported(Box::new(self), notes),
            Err(error) => refuse(error, || Pending::Export(Box::new(self))),
        }
    }
}

/// What the user may overrule is asked; all else is an error.
fn refuse(error: Error, pending: impl FnOnce() -> Pending) -> WriteResult {
    match error {
        Error::Changed { reason, .. } => WriteResult::Refused(pending(), reason),
        error => WriteResult::Failed(error),
    }
}
