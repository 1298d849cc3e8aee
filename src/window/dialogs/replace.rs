//! “Replace?”, asked before a file is overwritten. Floor 7.

use super::{DialogAnswer, buttons, set_width};
use crate::jobs::short;
use crate::language::tr_message;
use crate::pending::Pending;
use crate::tr;
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
        ui.heading(tr!("Replace “{file}”?", file = name));
        ui.label(format!("{}: {}.", pending.file().display(), tr_message(&self.reason)));
        if matches!(pending, Pending::Save(_)) {
            ui.weak(tr!("Its present content is kept as “{file}~”.", file = name));
        }
        match buttons(ui, "Replace", true) {
            Some(true) => self.pending.take().map_or(DialogAnswer::Close, DialogAnswer::Replace),
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }
}
