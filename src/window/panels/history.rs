//! The history: every step by what was done to which layer; a click goes to it. Floor 7.

use crate::document::{EditLabel, LabeledLayer};
use crate::language::{tr, tr_message};
use crate::requests::UiRequests;
use crate::session::actions::EditAction;
use crate::session::{Action, Session};
use crate::tr;
use eframe::egui::{self, Button, RichText, Ui};

/// What a step did, and to which layer, in the language of the window.
fn step_text(label: &EditLabel) -> String {
    let step = tr_message(&label.name);
    match &label.layer {
        Some(LabeledLayer::Changed(layer)) if !label.name.ends_with("layer") => {
            tr!("{step} on “{layer}”", step, layer)
        }
        Some(LabeledLayer::Changed(layer) | LabeledLayer::Listed(layer)) => {
            tr!("{step} “{layer}”", step, layer)
        }
        None => step.into_owned(),
    }
}

pub fn show(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let Some(open) = session.active() else {
        ui.weak(tr("No document is open."));
        return;
    };
    let done = open.history.past_names().len() as i32;
    let opened = std::iter::once((tr("Opened").to_owned(), -done));
    let past = open
        .history
        .past_labels()
        .enumerate()
        .map(|(i, label)| (step_text(label), i as i32 + 1 - done));
    let future =
        open.history.future_labels().enumerate().map(|(i, label)| (step_text(label), i as i32 + 1));
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
