//! Asks how to export the unwrapped surface. Floor 7.

use super::{DialogAnswer, buttons, set_width};
use crate::document::Highlights;
use crate::document::view::UnwrapOptions;
use crate::language::tr;
use crate::requests::WindowRequest;
use crate::session::Session;
use crate::surface::operator::UnwrapSettings;
use crate::tr;
use crate::widgets::{check_box, radio};
use eframe::egui::Ui;

/// The choices, kept for the next time.
#[derive(Clone)]
pub struct UnwrappedDialog {
    pub scale: u32,
    pub is_16_bit: bool,
}

impl Default for UnwrappedDialog {
    fn default() -> Self {
        Self { scale: 2, is_16_bit: false }
    }
}

impl UnwrappedDialog {
    /// What was chosen, for a surface unwrapped with these settings.
    pub fn options(&self, settings: UnwrapSettings) -> UnwrapOptions {
        UnwrapOptions {
            scale: self.scale,
            settings,
            floats: self.is_16_bit.then_some(Highlights::Clipped),
        }
    }

    pub fn show(&mut self, ui: &mut Ui, session: &Session) -> DialogAnswer {
        set_width(ui, 320.0);
        ui.heading(tr("Export the unwrapped surface"));
        ui.weak(tr("Paint over it in another program and import it unwrapped: it returns to its place on the \
             surface."));
        for scale in UnwrapOptions::SCALE.filter(|scale| scale.is_power_of_two()) {
            let about = match scale {
                1 => "As large as on the surface".to_owned(),
                more => tr!(
                    "{count} pixels to one of the surface: keeps fine strokes sharp",
                    count = more
                ),
            };
            radio(ui, &mut self.scale, scale, about);
        }
        check_box(ui, &mut self.is_16_bit, "16 bits a channel");
        match buttons(ui, "Export…", session.shown_document().is_some()) {
            Some(true) => DialogAnswer::Ask(WindowRequest::ExportUnwrapped),
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }
}
