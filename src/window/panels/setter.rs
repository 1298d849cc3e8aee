//! How the panels of one layer change it. Floor 7.

use super::words::translate_within;
use crate::file_purpose::FilePurpose;
use crate::language::tr;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::PicturePart;
use crate::session::actions::LayerAction;
use crate::session::{Action, LayerPath, Property};
use crate::tr;
use crate::widgets::{ValueChange, set_accessible_name};
use eframe::egui::Ui;

/// Pushes changes of one layer.
pub struct LayerSetter<'a> {
    pub layer: LayerPath,
    pub requests: &'a mut UiRequests,
}

impl LayerSetter<'_> {
    pub fn set(&mut self, to: Property, done: bool) {
        self.requests.act(Action::Layer(LayerAction::Set {
            layer: self.layer.clone().into(),
            to,
            done,
        }));
    }

    /// Does something else to the layer.
    pub fn act(&mut self, action: impl FnOnce(LayerPath) -> LayerAction) {
        self.requests.act(Action::Layer(action(self.layer.clone())));
    }

    /// A button that requests a picture for the layer.
    pub fn choose(&mut self, ui: &mut Ui, part: PicturePart, text: &str) {
        let response = ui.button(tr(text));
        let picture = translate_within(part.label());
        set_accessible_name(&response, &tr!("Choose {picture}", picture));
        if response.clicked() {
            self.requests.request(WindowRequest::Choose(FilePurpose::Part(part)));
        }
    }

    pub fn take(&mut self, changed: Option<ValueChange<Property>>) {
        if let Some(ValueChange { to, done }) = changed {
            self.set(to, done);
        }
    }
}
