//! Adjusts the paint of the selected layers for good, shown while it is set. Floor 7.

use super::{DialogAnswer, buttons};
use crate::file_purpose::FilePurpose;
use crate::paint::ColorAdjustment;
use crate::panels::adjustment;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::LayerAction;
use crate::session::{Action, LayerPaths, Session};
use eframe::egui::Ui;

pub struct AdjustDialog {
    pub adjustment: ColorAdjustment,
    layer: LayerPaths,
    is_begun: bool,
    is_done: bool,
}

impl AdjustDialog {
    pub fn new(adjustment: ColorAdjustment, session: &Session) -> Self {
        Self { adjustment, layer: session.layer_paths(), is_begun: false, is_done: false }
    }

    pub fn show(&mut self, ui: &mut Ui, requests: &mut UiRequests) -> DialogAnswer {
        ui.set_width(300.0);
        ui.heading(self.adjustment.label());
        ui.weak("The paint of the selected layers, within the selection");
        let answer = adjustment::show(ui, &self.adjustment, None);
        if answer.asks_for_table {
            requests.request(WindowRequest::Choose(FilePurpose::ColorTable));
        }
        let is_new = !std::mem::replace(&mut self.is_begun, true);
        if let Some(changed) = answer.changed {
            self.adjustment = changed.to;
            self.act(requests, false);
        } else if is_new {
            self.act(requests, false);
        }
        match buttons(ui, "Adjust", true) {
            Some(true) => {
                self.is_done = true;
                self.act(requests, true);
                DialogAnswer::Close
            }
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }

    /// Shows the paint as it was, unless it was adjusted.
    pub fn forget(&self, requests: &mut UiRequests) {
        if !self.is_done {
            requests.act(Action::Layer(LayerAction::Unadjust {}));
        }
    }

    /// With a table that was read.
    pub fn take_table(&mut self, adjustment: ColorAdjustment) {
        self.adjustment = adjustment;
        self.is_begun = false;
    }

    fn act(&self, requests: &mut UiRequests, done: bool) {
        let (layer, adjustment) = (self.layer.clone(), self.adjustment.clone());
        requests.act(Action::Layer(LayerAction::Adjust { layer, adjustment, done }));
    }
}
