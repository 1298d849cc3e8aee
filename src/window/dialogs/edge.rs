//! Asks by how much to change the edge of the selection. Floor 7.

use super::{DialogAnswer, buttons, set_width};
use crate::language::tr;
use crate::requests::UiRequests;
use crate::session::Action;
use crate::session::actions::{EdgeChange, SelectionAction};
use crate::tr;
use crate::widgets::{begin_with, number};
use eframe::egui::Ui;

pub struct EdgeDialog {
    change: EdgeChange,
    px: f32,
}

impl EdgeDialog {
    pub fn new(change: EdgeChange) -> Self {
        Self { change, px: 5.0 }
    }

    pub fn show(&mut self, ui: &mut Ui, requests: &mut UiRequests) -> DialogAnswer {
        set_width(ui, 300.0);
        ui.heading(tr(self.change.label()));
        ui.weak(tr(self.change.hint()));
        ui.horizontal(|ui| {
            let label = ui.label(tr("Pixels"));
            let range = self.change.range();
            let px = number(&mut self.px).range(range).speed(0.1).suffix(" px");
            begin_with(&ui.add(px).labelled_by(label.id));
        });
        match buttons(ui, "Change", true) {
            Some(true) => {
                requests.act(Action::Selection(SelectionAction::Change {
                    change: self.change,
                    px: self.px,
                }));
                DialogAnswer::Close
            }
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }
}

/// Asks for a name to keep the selection by, and shows the kept ones.
#[derive(Default)]
pub struct KeepDialog {
    name: String,
    is_begun: bool,
}

impl KeepDialog {
    pub fn show(
        &mut self,
        ui: &mut Ui,
        kept: &[String],
        requests: &mut UiRequests,
    ) -> DialogAnswer {
        set_width(ui, 320.0);
        ui.heading(tr("Keep selection"));
        ui.weak(tr(
            "Saved under a name with the document. If the name is taken, its selection is \
             replaced.",
        ));
        ui.horizontal(|ui| {
            let label = ui.label(tr("Name of selection"));
            let field = ui.text_edit_singleline(&mut self.name).labelled_by(label.id);
            if !std::mem::replace(&mut self.is_begun, true) {
                field.request_focus();
            }
        });
        for name in kept {
            ui.horizontal(|ui| {
                ui.label(name);
                if ui.small_button(tr!("Forget {name}", name)).clicked() {
                    requests.act(Action::Selection(SelectionAction::Forget { name: name.clone() }));
                }
            });
        }
        match buttons(ui, "Keep", !self.name.trim().is_empty()) {
            Some(true) => {
                let name = self.name.trim().to_owned();
                requests.act(Action::Selection(SelectionAction::Keep { name }));
                DialogAnswer::Close
            }
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }
}
