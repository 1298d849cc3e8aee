//! What a Photoshop file cannot hold, before a document is saved as one. Floor 7. Not here: what is
//! lost (`io::psd`).

use super::{DialogAnswer, buttons, set_width};
use crate::language::{tr, tr_message};
use crate::pending::Saving;
use crate::widgets::list;
use eframe::egui::Ui;

pub struct Losses {
    /// Absent once it was answered.
    saving: Option<Box<Saving>>,
}

impl Losses {
    pub fn new(saving: Box<Saving>) -> Self {
        Self { saving: Some(saving) }
    }

    pub fn show(&mut self, ui: &mut Ui) -> DialogAnswer {
        let Some(saving) = &self.saving else { return DialogAnswer::Close };
        set_width(ui, 420.0);
        ui.heading(tr("Save as a Photoshop file?"));
        ui.label(tr(
            "Other programs show live layers as pixels. A project (.ora) keeps everything.",
        ));
        ui.label(tr(
            "When you open it here again, everything is live, unless another program has \
                  saved the file.",
        ));
        let notes = saving.encoded.iter().flat_map(|encoded| &encoded.notes);
        list(ui, 160.0).show(ui, |ui| notes.for_each(|note| drop(ui.label(tr_message(note)))));
        match buttons(ui, "Save", true) {
            Some(true) => self.saving.take().map_or(DialogAnswer::Close, DialogAnswer::Lose),
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }
}
