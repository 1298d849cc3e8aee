//! A new document: an empty canvas, or one on an object's maps.
//! Floor 7.

use super::profile::profile_choice;
use super::{DialogAnswer, buttons, set_width};
use crate::language::tr;
use crate::math::ColorProfile;
use crate::math::srgb::Color;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::Action;
use crate::session::actions::FileAction;
use crate::widgets::{begin_with, number, radio};
use eframe::egui::Ui;

pub struct NewDialog {
    width: u32,
    height: u32,
    background: CanvasBackground,
    profile: ColorProfile,
}

#[derive(Clone, Copy, PartialEq)]
enum CanvasBackground {
    White,
    Dark,
    Transparent,
}

impl Default for NewDialog {
    fn default() -> Self {
        Self {
            width: 1024,
            height: 1024,
            background: CanvasBackground::White,
            profile: ColorProfile::Srgb,
        }
    }
}

impl NewDialog {
    pub fn show(&mut self, ui: &mut Ui, requests: &mut UiRequests) -> DialogAnswer {
        set_width(ui, 340.0);
        ui.heading(tr("New document"));
        ui.label(tr("To paint on an object, begin with its normal map, depth map or both. Or begin with a picture."));
        let mut begins = None;
        ui.horizontal(|ui| {
            if ui.button(tr("From maps…")).clicked() {
                begins = Some(WindowRequest::OpenMapsDialog);
            }
            if ui
                .button(tr("From a picture…"))
                .on_hover_text(tr("As large as the picture, which is its first layer"))
                .clicked()
            {
                begins = Some(WindowRequest::OpenDialog);
            }
        });
        if let Some(begins) = begins {
            return DialogAnswer::Ask(begins);
        }
        ui.separator();
        ui.label(tr("An empty canvas"));
        ui.horizontal(|ui| {
            let label = ui.label(tr("Width"));
            let width = number(&mut self.width).range(1..=16384).suffix(" px");
            begin_with(&ui.add(width).labelled_by(label.id));
            let label = ui.label(tr("Height"));
            ui.add(number(&mut self.height).range(1..=16384).suffix(" px")).labelled_by(label.id);
        });
        ui.horizontal(|ui| {
            for (width, height) in [(1024, 1024), (1920, 1080), (2048, 2048), (4096, 4096)] {
                if ui.button(format!("{width} × {height}")).clicked() {
                    (self.width, self.height) = (width, height);
                }
            }
        });
        ui.horizontal(|ui| {
            ui.label(tr("Background"));
            for (choice, name) in [
                (CanvasBackground::White, "White"),
                (CanvasBackground::Dark, "Dark"),
                (CanvasBackground::Transparent, "Transparent"),
            ] {
                radio(ui, &mut self.background, choice, name);
            }
        });
        ui.horizontal(|ui| {
            ui.label(tr("Color profile"));
            profile_choice(ui, &mut self.profile);
        });
        match buttons(ui, "Create", true) {
            Some(true) => {
                let background = match self.background {
                    CanvasBackground::White => Some(Color::WHITE),
                    CanvasBackground::Dark => Some(Color { r: 0x26, g: 0x28, b: 0x2c, a: 255 }),
                    CanvasBackground::Transparent => None,
                };
                requests.act(Action::File(FileAction::New {
                    width: self.width,
                    height: self.height,
                    background,
                    profile: Some(self.profile),
                }));
                DialogAnswer::Close
            }
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }
}
