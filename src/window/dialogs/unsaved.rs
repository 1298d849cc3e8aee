//! “Save changes?”, before anything is lost.
//! Floor 7.

use super::{DialogAnswer, buttons, set_width};
use crate::language::tr;
use crate::pending::AfterUnsaved;
use crate::session::Session;
use crate::titles::title_of;
use crate::tr;
use eframe::egui::Ui;

pub struct UnsavedDialog {
    /// The place of the open document with unsaved work.
    pub index: usize,
    pub then: AfterUnsaved,
}

impl UnsavedDialog {
    pub fn show(&self, ui: &mut Ui, session: &Session) -> DialogAnswer {
        set_width(ui, 360.0);
        let title = session.open_documents.get(self.index).map_or_else(String::new, title_of);
        ui.heading(tr!("Save the changes to “{title}”?", title));
        ui.label(tr("Unsaved changes are lost when the document is closed."));
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            match (ui.button(tr("Do not save")).clicked(), buttons(ui, "Save", true)) {
                (true, _) => DialogAnswer::Discard(self.then),
                (_, Some(true)) => DialogAnswer::SaveThen(self.then),
                (_, Some(false)) => DialogAnswer::Close,
                (_, None) => DialogAnswer::Open,
            }
        })
        .inner
    }
}
