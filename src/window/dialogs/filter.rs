//! Filters the paint of the chosen layers for good, shown while it is set. Floor 7.

use super::{DialogAnswer, buttons};
use crate::paint::PictureFilter;
use crate::panels::adjustment;
use crate::requests::UiRequests;
use crate::session::actions::LayerAction;
use crate::session::{Action, LayerPaths, Session};
use eframe::egui::Ui;

pub struct FilterDialog {
    filter: PictureFilter,
    layer: LayerPaths,
    is_begun: bool,
    is_done: bool,
}

impl FilterDialog {
    pub fn new(filter: PictureFilter, session: &Session) -> Self {
        Self { filter, layer: session.layer_paths(), is_begun: false, is_done: false }
    }

    pub fn show(&mut self, ui: &mut Ui, requests: &mut UiRequests) -> DialogAnswer {
        ui.set_width(300.0);
        ui.heading(self.filter.label());
        ui.weak("The paint of the selected layers, within the selection");
        let is_new = !std::mem::replace(&mut self.is_begun, true);
        if let Some(changed) = adjustment::show_filter(ui, &self.filter) {
            self.filter = changed.to;
            self.act(requests, false);
        } else if is_new {
            self.act(requests, false);
        }
        match buttons(ui, "Filter", true) {
            Some(true) => {
                self.is_done = true;
                self.act(requests, true);
                DialogAnswer::Close
            }
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }

    /// Shows the paint as it was, unless it was filtered.
    pub fn forget(&self, requests: &mut UiRequests) {
        if !self.is_done {
            requests.act(Action::Layer(LayerAction::Unadjust {}));
        }
    }

    fn act(&self, requests: &mut UiRequests, done: bool) {
        let (layer, filter) = (self.layer.clone(), self.filter.clone());
        requests.act(Action::Layer(LayerAction::Filter { layer, filter, done }));
    }
}
