//! What is to be saved or exported, while it waits for a job or for an answer. Floor 7. Not here:
//! doing it (`saving`), asking (`dialogs`).

use crate::document::Document;
use crate::document::view::UnwrapOptions;
use crate::io::export::shape::{ShapeMap, ShapeOptions};
use crate::io::save::EncodedDocument;
use crate::io::{Overwrite, Terms};
use crate::session::ExportSettings;
use std::path::{Path, PathBuf};

/// A document that is to be saved.
pub struct Saving {
    /// Its open document, by its key.
    pub key: usize,
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
    /// Of the open document.
    pub key: usize,
    pub document: Document,
    pub file: PathBuf,
    pub settings: ExportSettings,
    /// As it lies on the unwrapped surface.
    pub unwrapped: Option<UnwrapOptions>,
    pub terms: Terms,
}

/// Maps of a shape that are to be exported.
pub struct ExportingMaps {
    pub document: Document,
    /// The beginning of their names.
    pub file: PathBuf,
    pub maps: Vec<ShapeMap>,
    pub options: ShapeOptions,
    pub terms: Terms,
}

/// What follows a question about unsaved work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AfterUnsaved {
    Close(usize),
    Quit,
}

/// What waits for an answer.
pub enum Pending {
    Save(Box<Saving>),
    Export(Box<Exporting>),
    Maps(Box<ExportingMaps>),
}

impl Pending {
    pub fn file(&self) -> &Path {
        match self {
            Pending::Save(saving) => &saving.file,
            Pending::Export(exporting) => &exporting.file,
            Pending::Maps(exporting) => &exporting.file,
        }
    }

    /// The user confirmed.
    pub fn forced(mut self) -> Self {
        match &mut self {
            Pending::Save(saving) => saving.terms.over = Overwrite::Forced,
            Pending::Export(exporting) => exporting.terms.over = Overwrite::Forced,
            Pending::Maps(exporting) => exporting.terms.over = Overwrite::Forced,
        }
        self
    }
}
