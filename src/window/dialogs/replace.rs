//! “Replace?”, asked before a file is overwritten. Floor 7.

use super::{DialogAnswer, buttons, set_width};
use crate::jobs::short;
use crate::pending::Pending;
use eframe::egui::Ui;

pub struct Replace {
    /// Absent once it was answered.
    pending: Option<Pending>,
    /// Why it was not replaced without asking.
    reason: String,
}

impl Replace {
    pub fn new(pending: Pending, reason: String) -> Self {
        Self { pending: Some(pending), reason }
    }

    pub fn show(&mut self, ui: &mut Ui) -> DialogAnswer {
        let Some(pending) = &self.pending else { return DialogAnswer::Close };
        set_width(ui, 380.0);
        let name = short(pending.file());
        ui.heading(format!("Replace “{name}”?"));
        ui.label(format!("{}: {}.", pending.file().display(), self.reason));
        if matches!(pending, Pending::Save(_)) {
            ui.weak(format!("Its present content is kept as “{name}~”."));
        }
        match buttons(ui, "Replace", true) {
            Some(true) => self.pending.take().map_or(DialogAnswer::Close, DialogAnswer::Replace),
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }
}
