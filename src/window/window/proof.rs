//! The picture as it will be printed. Floor 7. Not here: what becomes of its colors (`io::proof`).

use super::MainWindow;
use crate::advice::with_advice;
use crate::file_purpose::FilePurpose;
use crate::io::proof::{self, ProofTable};
use crate::session::Action;
use crate::session::actions::ViewAction;
use std::path::PathBuf;
use std::sync::Arc;

impl MainWindow {
    /// Shows the picture as it will be printed with a profile, which is remembered.
    pub(super) fn proof_with(&mut self, file: PathBuf) {
        let read = crate::io::files::read_file(&file, proof::LARGEST_BYTES);
        match read.and_then(|icc| ProofTable::read(&file, &icc)) {
            Ok(table) => {
                self.canvas.proof = Some(Arc::new(table));
                self.settings.proof = Some(file);
                self.apply(&Action::View(ViewAction::Proof { on: true }));
            }
            Err(error) => self.messages.push(with_advice(&error)),
        }
    }

    /// Shows the picture as it will be printed, with the last profile, or one that is asked for; or in
    /// its own colors again.
    pub(super) fn toggle_proof(&mut self) {
        match (&self.canvas.proof, &self.settings.proof) {
            (None, None) => self.ask_for(FilePurpose::ColorProfile, ""),
            (None, Some(file)) => self.proof_with(file.clone()),
            (Some(_), _) => {
                let on = !self.session.shows_proof;
                self.apply(&Action::View(ViewAction::Proof { on }));
            }
        }
    }
}
