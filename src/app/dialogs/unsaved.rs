//! “Save changes?”, before anything is lost.
//! Floor 7.

use super::{Answer, Then};
use crate::session::Session;
use eframe::egui::Ui;

pub struct Unsaved {
    /// The tab with unsaved work.
    pub tab: usize,
    pub then: Then,
}

impl Unsaved {
    pub fn show(&self, ui: &mut Ui, session: &Session) -> Answer {
        ui.set_width(360.0);
        let title = session.tabs.get(self.tab).map_or_else(String::new, |tab| tab.title());
        ui.heading(format!("Save the changes to “{title}”?"));
        ui.label("What is not saved is lost when the document is closed.");
        ui.add_space(4.0);
        let mut answer = Answer::Open;
        ui.horizontal(|ui| {
            if ui.button("Save").clicked() {
                answer = Answer::SaveThen(self.then);
            }
            if ui.button("Do not save").clicked() {
                answer = Answer::Discard(self.then);
            }
            if ui.button("Cancel").clicked() {
                answer = Answer::Close;
            }
        });
        answer
    }
}
