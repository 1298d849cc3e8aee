//! The history: every step by what was done to which layer; a click goes to it. Floor 7.

use crate::requests::UiRequests;
use crate::session::actions::EditAction;
use crate::session::{Action, Session, labels};
use eframe::egui::{self, Button, RichText, Ui};

pub fn show(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let Some(open) = session.active() else {
        ui.weak("No document is open.");
        return;
    };
    let done = open.history.past_names().len() as i32;
    let opened = std::iter::once(("Opened".to_owned(), -done));
    let past = open
        .history
        .past_labels()
        .enumerate()
        .map(|(i, label)| (labels::sentence(label), i as i32 + 1 - done));
    let future = open
        .history
        .future_labels()
        .enumerate()
        .map(|(i, label)| (labels::sentence(label), i as i32 + 1));
    egui::ScrollArea::vertical()
        .id_salt("history")
        .auto_shrink([false, false])
        .stick_to_bottom(true)
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            for (label, steps) in opened.chain(past).chain(future) {
                let text =
                    if steps > 0 { RichText::new(label).weak() } else { RichText::new(label) };
                let row = Button::selectable(steps == 0, text)
                    .min_size(egui::vec2(ui.available_width(), 0.0));
                if ui.add(row).clicked() && steps != 0 {
                    requests.act(Action::Edit(EditAction::Walk { steps }));
                }
            }
        });
}
