//! Saves and exports what is pending, and reports the result. Run as jobs. Floor 7. Nothing is
//! replaced without asking. Not here: writing (`io::replace`), the questions (`dialogs`).

use crate::document::Progress;
use crate::io::fs::Disk;
use crate::io::replace::{FileStamp, check};
use crate::io::save::encode;
use crate::jobs::JobResult;
use crate::pending::{Exporting, ExportingMaps, Pending, Saving};
use crate::session::actions::files::{export, export_maps};
use crate::session::actions::unwrapped;
use crate::{Error, Result};

impl ExportingMaps {
    pub fn run(self) -> JobResult {
        match export_maps(&self.document, &self.file, &self.maps, self.options, &self.terms) {
            Ok(files) => JobResult::ExportedMaps(files),
            Err(error) => refused(error, || Pending::Maps(Box::new(self))),
        }
    }
}

/// How far a save came.
enum SaveStep {
    Saved(FileStamp),
    /// The user must be told first what is lost.
    Loses,
    GivenUp,
}

impl Saving {
    pub fn run(mut self, progress: &Progress) -> JobResult {
        match self.attempt(progress) {
            Ok(SaveStep::Saved(stamp)) => JobResult::Saved(Box::new(self), stamp),
            Ok(SaveStep::Loses) => JobResult::Loses(Box::new(self)),
            Ok(SaveStep::GivenUp) => JobResult::Nothing,
            Err(error) => refused(error, || Pending::Save(Box::new(self))),
        }
    }

    fn attempt(&mut self, progress: &Progress) -> Result<SaveStep> {
        // Checked before the work of making the bytes.
        check(&Disk, &self.file, &self.terms)?;
        let encoded = match self.encoded.take() {
            Some(encoded) => Some(encoded),
            None => encode(&self.document, &self.file, progress)?,
        };
        let Some(encoded) = encoded else { return Ok(SaveStep::GivenUp) };
        let encoded = self.encoded.insert(encoded);
        if !self.knows_losses {
            return Ok(SaveStep::Loses);
        }
        let saved = encoded.save(&self.file, &self.terms, progress)?;
        Ok(saved.map_or(SaveStep::GivenUp, |saved| SaveStep::Saved(saved.stamp)))
    }
}

impl Exporting {
    pub fn run(self, progress: &Progress) -> JobResult {
        let terms = self.terms.clone();
        let written = match self.unwrapped {
            Some(options) => {
                unwrapped::export(&self.document, &self.file, options, terms, progress)
                    .map(|()| Vec::new())
            }
            None => export(&self.document, &self.file, &self.options, terms, progress),
        };
        match written {
            Ok(_) if progress.is_cancelled() => JobResult::Nothing,
            Ok(notes) => JobResult::Exported(self.file, notes),
            Err(error) => refused(error, || Pending::Export(Box::new(self))),
        }
    }
}

/// What the user may overrule is asked; all else is an error.
fn refused(error: Error, pending: impl FnOnce() -> Pending) -> JobResult {
    match error {
        Error::Changed { reason, .. } => JobResult::Refused(pending(), reason),
        error => JobResult::Failed(error),
    }
}
