//! Files on their way to the disk: what is saved or exported, and what it comes to. Run as jobs.
//! Floor 7. Writing is `io::replace`'s; the questions on the way are `dialogs`', for nothing is replaced unasked.

use crate::dialogs::AfterUnsaved;
use crate::document::view::UnwrapOptions;
use crate::document::{Document, Progress};
use crate::io::export::ExportOptions;
use crate::io::export::shape::{ShapeMap, ShapeOptions};
use crate::io::fs::Disk;
use crate::io::replace::{FileStamp, check};
use crate::io::save::{EncodedDocument, encode};
use crate::io::{Overwrite, Terms};
use crate::jobs::JobResult;
use crate::session::actions::files::{export, export_maps};
use crate::session::actions::unwrapped;
use crate::{Error, Result};
use std::path::{Path, PathBuf};

/// A document that is to be saved.
pub struct Saving {
    /// Its tab, by its key.
    pub tab: usize,
    pub file: PathBuf,
    /// What the file will hold.
    pub document: Document,
    pub terms: Terms,
    /// The user knows what the format cannot hold, or it holds everything.
    pub knows_losses: bool,
    /// What is to be done once it is saved.
    pub then: Option<AfterUnsaved>,
    /// Its bytes, once they are made.
    pub encoded: Option<EncodedDocument>,
}

/// A picture, or a document for another program, that is to be exported.
pub struct Exporting {
    pub document: Document,
    pub file: PathBuf,
    pub options: ExportOptions,
    /// As it lies on the unwrapped surface.
    pub unwrapped: Option<UnwrapOptions>,
    pub terms: Terms,
}

/// Maps of a shape that are to be exported.
pub struct ExportingMaps {
    pub document: Document,
    /// What their names begin with.
    pub file: PathBuf,
    pub maps: Vec<ShapeMap>,
    pub options: ShapeOptions,
    pub terms: Terms,
}

impl ExportingMaps {
    pub fn run(self) -> JobResult {
        match export_maps(&self.document, &self.file, &self.maps, self.options, &self.terms) {
            Ok(files) => JobResult::ExportedMaps(files),
            Err(error) => refused(error, || Pending::Maps(Box::new(self))),
        }
    }
}

/// What waits for an answer.
pub enum Pending {
    Save(Box<Saving>),
    Export(Box<Exporting>),
    Maps(Box<ExportingMaps>),
}

/// How far a save came.
enum Step {
    Saved(FileStamp),
    /// The user has to be told first what is lost.
    Loses,
    GivenUp,
}

impl Saving {
    pub fn run(mut self, progress: &Progress) -> JobResult {
        match self.attempt(progress) {
            Ok(Step::Saved(stamp)) => JobResult::Saved(Box::new(self), stamp),
            Ok(Step::Loses) => JobResult::Loses(Box::new(self)),
            Ok(Step::GivenUp) => JobResult::Nothing,
            Err(error) => refused(error, || Pending::Save(Box::new(self))),
        }
    }
    fn attempt(&mut self, progress: &Progress) -> Result<Step> {
        // Before the work that it takes to make the bytes.
        check(&Disk, &self.file, &self.terms)?;
        let encoded = match self.encoded.take() {
            Some(encoded) => Some(encoded),
            None => encode(&self.document, &self.file, progress)?,
        };
        let Some(encoded) = encoded else { return Ok(Step::GivenUp) };
        let encoded = self.encoded.insert(encoded);
        if !self.knows_losses {
            return Ok(Step::Loses);
        }
        let saved = encoded.save(&self.file, &self.terms, progress)?;
        Ok(saved.map_or(Step::GivenUp, |saved| Step::Saved(saved.stamp)))
    }
}

impl Exporting {
    pub fn run(self, progress: &Progress) -> JobResult {
        let terms = self.terms.clone();
        let written = match self.unwrapped {
            Some(options) => {
                unwrapped::export(&self.document, &self.file, options, terms, progress).map(|()| Vec::new())
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

/// What the user may overrule is asked; all else is told.
fn refused(error: Error, pending: impl FnOnce() -> Pending) -> JobResult {
    match error {
        Error::Changed { reason, .. } => JobResult::Refused(pending(), reason),
        error => JobResult::Failed(error),
    }
}

impl Pending {
    pub fn file(&self) -> &Path {
        match self {
            Pending::Save(saving) => &saving.file,
            Pending::Export(exporting) => &exporting.file,
            Pending::Maps(exporting) => &exporting.file,
        }
    }
    /// The user insists.
    pub fn forced(mut self) -> Self {
        match &mut self {
            Pending::Save(saving) => saving.terms.over = Overwrite::Forced,
            Pending::Export(exporting) => exporting.terms.over = Overwrite::Forced,
            Pending::Maps(exporting) => exporting.terms.over = Overwrite::Forced,
        }
        self
    }
}
