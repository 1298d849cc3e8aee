//! A new document: an empty canvas, or one on an object's maps.
//! Floor 7.

use super::{Answer, buttons};
use crate::asked::{Asked, WindowAsk};
use crate::math::srgb::Color;
use crate::session::Action;
use crate::session::actions::FileAction;
use eframe::egui::{DragValue, Ui};

pub struct New {
    width: u32,
    height: u32,
    background: Background,
}

#[derive(Clone, Copy, PartialEq)]
enum Background {
    White,
    Dark,
    Transparent,
}

impl Default for New {
    fn default() -> Self {
        Self { width: 1024, height: 1024, background: Background::White }
    }
}

impl New {
    pub fn show(&mut self, ui: &mut Ui, asked: &mut Asked) -> Answer {
        ui.set_width(340.0);
        ui.heading("New document");
        ui.label("To paint on an object, begin with its normal map, depth map or both. Or begin with a picture.");
        let mut begins = None;
        ui.horizontal(|ui| {
            if ui.button("From maps…").clicked() {
                begins = Some(WindowAsk::OpenMapsDialog);
            }
            if ui.button("From a picture…").on_hover_text("As large as the picture, which is its first layer").clicked()
            {
                begins = Some(WindowAsk::OpenDialog);
            }
        });
        if let Some(begins) = begins {
            return Answer::Ask(begins);
        }
        ui.separator();
        ui.label("An empty canvas");
        ui.horizontal(|ui| {
            let label = ui.label("Width");
            ui.add(DragValue::new(&mut self.width).range(1..=16384).suffix(" px")).labelled_by(label.id);
            let label = ui.label("Height");
            ui.add(DragValue::new(&mut self.height).range(1..=16384).suffix(" px")).labelled_by(label.id);
        });
        ui.horizontal(|ui| {
            for (width, height) in [(1024, 1024), (1920, 1080), (2048, 2048), (4096, 4096)] {
                if ui.button(format!("{width} × {height}")).clicked() {
                    (self.width, self.height) = (width, height);
                }
            }
        });
        ui.horizontal(|ui| {
            ui.label("Background");
            for (choice, name) in
                [(Background::White, "White"), (Background::Dark, "Dark"), (Background::Transparent, "Transparent")]
            {
                ui.radio_value(&mut self.background, choice, name);
            }
        });
        match buttons(ui, "Create", true) {
            Some(true) => {
                let background = match self.background {
                    Background::White => Some(Color::WHITE),
                    Background::Dark => Some(Color { r: 0x26, g: 0x28, b: 0x2c, a: 255 }),
                    Background::Transparent => None,
                };
                asked.act(Action::File(FileAction::New { width: self.width, height: self.height, background }));
                Answer::Close
            }
            Some(false) => Answer::Close,
            None => Answer::Open,
        }
    }
}
