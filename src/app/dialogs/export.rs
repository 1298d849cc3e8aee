//! Export: format and what shows through, then where to.
//! Floor 7.

use super::{Answer, buttons};
use crate::app::asked::WindowAsk;
use crate::math::srgb::Color;
use crate::session::Session;
use eframe::egui::{Slider, Ui};

/// What was chosen, kept for the next time.
#[derive(Clone)]
pub struct Export {
    pub ending: &'static str,
    pub background: Option<Color>,
    pub quality: u8,
}

impl Default for Export {
    fn default() -> Self {
        Self { ending: "png", background: None, quality: 92 }
    }
}

const FORMATS: [(&str, &str); 4] = [
    ("png", "PNG: 8 bits, keeps transparency"),
    ("exr", "EXR: linear light, half floats"),
    ("jpg", "JPEG: small, opaque"),
    ("webp", "WebP: lossless, small"),
];

impl Export {
    pub fn show(&mut self, ui: &mut Ui, session: &Session) -> Answer {
        ui.set_width(320.0);
        ui.heading("Export the picture");
        if let Some(document) = session.shown() {
            ui.weak(format!("{} pixels", document.size));
        }
        for (ending, about) in FORMATS {
            ui.radio_value(&mut self.ending, ending, about);
        }
        let mut opaque = self.background.is_some() || self.ending == "jpg";
        ui.add_enabled_ui(self.ending != "jpg", |ui| ui.checkbox(&mut opaque, "Lay it on white"));
        self.background = opaque.then_some(Color::WHITE);
        ui.add_enabled_ui(self.ending == "jpg", |ui| {
            ui.add(Slider::new(&mut self.quality, 1..=100).text("Quality"));
        });
        match buttons(ui, "Export…", true) {
            Some(true) => Answer::Ask(WindowAsk::Export(self.ending)),
            Some(false) => Answer::Close,
            None => Answer::Open,
        }
    }
}
