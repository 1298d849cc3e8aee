//! Asks for the color profile of the document. Floor 7. Not here: what becomes of its colors
//! (`io::profile_change`).

use super::{DialogAnswer, buttons, set_width};
use crate::io::profile_change::ProfileChange;
use crate::language::tr;
use crate::math::ColorProfile;
use crate::requests::UiRequests;
use crate::session::Action;
use crate::session::actions::CanvasAction;
use crate::tr;
use crate::widgets::radio;
use eframe::egui::Ui;

pub struct ProfileDialog {
    from: ColorProfile,
    to: ColorProfile,
    change: ProfileChange,
}

impl ProfileDialog {
    /// For a document in a profile: the other one is chosen.
    pub fn of(from: ColorProfile) -> Self {
        let other = ColorProfile::ALL.iter().find(|(known, _)| *known != from);
        let to = other.map_or(from, |(other, _)| *other);
        Self { from, to, change: ProfileChange::Convert }
    }

    pub fn show(&mut self, ui: &mut Ui, requests: &mut UiRequests) -> DialogAnswer {
        set_width(ui, 360.0);
        ui.heading(tr("Color profile"));
        let profile = self.from.label();
        ui.weak(tr!("The document's numbers mean colors of {profile} now.", profile));
        ui.horizontal(|ui| profile_choice(ui, &mut self.to));
        for (change, label) in ProfileChange::LABELS {
            radio(ui, &mut self.change, change, label);
            ui.weak(tr(change.hint()));
        }
        match buttons(ui, "Change", self.to != self.from) {
            Some(true) => {
                let (profile, change) = (self.to, self.change);
                requests.act(Action::Canvas(CanvasAction::Profile { profile, change }));
                DialogAnswer::Close
            }
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }
}

/// A choice of a profile.
pub fn profile_choice(ui: &mut Ui, profile: &mut ColorProfile) {
    for (choice, label) in ColorProfile::LABELS {
        radio(ui, profile, choice, label).on_hover_text(choice.hint());
    }
}
