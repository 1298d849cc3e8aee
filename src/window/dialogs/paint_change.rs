//! Adjusts or filters the paint of the selected layers for good, shown while it is set. Floor 7.

use super::{DialogAnswer, buttons, set_width};
use crate::file_purpose::FilePurpose;
use crate::language::tr;
use crate::paint::ColorAdjustment;
use crate::panels::adjustment;
use crate::requests::{PaintChange, UiRequests, WindowRequest};
use crate::session::actions::LayerAction;
use crate::session::{Action, LayerPaths, Session};
use eframe::egui::Ui;

impl PaintChange {
    fn label(&self) -> &'static str {
        match self {
            Self::Adjust(adjustment) => adjustment.label(),
            Self::Filter(filter) => filter.label(),
        }
    }

    /// What the button says that does it.
    /// Shows what it is set by; with what it became.
    fn show(&self, ui: &mut Ui, requests: &mut UiRequests) -> Option<Self> {
        match self {
            Self::Adjust(adjustment) => {
                let answer = adjustment::show(ui, adjustment, None);
                if answer.asks_for_table {
                    requests.request(WindowRequest::Choose(FilePurpose::ColorTable));
                }
                Some(Self::Adjust(answer.changed?.to))
            }
            Self::Filter(filter) => Some(Self::Filter(adjustment::show_filter(ui, filter)?.to)),
        }
    }
}

pub struct PaintChangeDialog {
    change: PaintChange,
    layer: LayerPaths,
    is_begun: bool,
    is_done: bool,
}

impl PaintChangeDialog {
    pub fn new(change: PaintChange, session: &Session) -> Self {
        Self { change, layer: session.layer_paths(), is_begun: false, is_done: false }
    }

    pub fn show(&mut self, ui: &mut Ui, requests: &mut UiRequests) -> DialogAnswer {
        set_width(ui, 300.0);
        ui.heading(tr(self.change.label()));
        ui.weak(tr("The paint of the selected layers, within the selection"));
        let is_new = !std::mem::replace(&mut self.is_begun, true);
        let changed = self.change.show(ui, requests);
        if changed.is_some() || is_new {
            self.change = changed.unwrap_or_else(|| self.change.clone());
            self.act(requests, false);
        }
        match buttons(ui, "Apply", true) {
            Some(true) => {
                self.is_done = true;
                self.act(requests, true);
                DialogAnswer::Close
            }
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }

    /// Shows the paint as it was, unless it was changed for good.
    pub fn forget(&self, requests: &mut UiRequests) {
        if !self.is_done {
            requests.act(Action::Layer(LayerAction::Unadjust {}));
        }
    }

    /// Whether a table that is read now is for it.
    pub fn can_take_table(&self) -> bool {
        matches!(self.change, PaintChange::Adjust(_))
    }

    /// With a table that was read.
    pub fn take_table(&mut self, adjustment: ColorAdjustment) {
        self.change = PaintChange::Adjust(adjustment);
        self.is_begun = false;
    }

    fn act(&self, requests: &mut UiRequests, done: bool) {
        let layer = self.layer.clone();
        requests.act(Action::Layer(match self.change.clone() {
            PaintChange::Adjust(adjustment) => LayerAction::Adjust { layer, adjustment, done },
            PaintChange::Filter(filter) => LayerAction::Filter { layer, filter, done },
        }));
    }
}
