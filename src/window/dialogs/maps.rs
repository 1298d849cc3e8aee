//! Exports the shape as maps for engines and other programs: which, and how they are written.
//! Floor 7. Not here: the files (`io::export::shape`).

use super::{DialogAnswer, buttons, set_width};
use crate::io::export::shape::{ShapeMap, ShapeOptions};
use crate::language::tr;
use crate::requests::WindowRequest;
use crate::session::Session;
use crate::tr;
use crate::widgets::{check_box, radio};
use eframe::egui::Ui;

/// The choices, kept for the next time.
#[derive(Clone)]
pub struct MapsDialog {
    /// One for each map, in the order of the table.
    chosen: [bool; ShapeMap::ALL.len()],
    pub options: ShapeOptions,
}

impl Default for MapsDialog {
    fn default() -> Self {
        let options = ShapeOptions { is_directx: false, is_16_bit: true, is_exr: false };
        Self { chosen: [true; ShapeMap::ALL.len()], options }
    }
}

impl MapsDialog {
    /// The maps to write.
    pub fn maps(&self) -> Vec<ShapeMap> {
        ShapeMap::ALL
            .iter()
            .zip(self.chosen)
            .filter(|(_, on)| *on)
            .map(|((map, _), _)| *map)
            .collect()
    }

    pub fn show(&mut self, ui: &mut Ui, session: &Session) -> DialogAnswer {
        set_width(ui, 340.0);
        ui.heading(tr("Export maps of the shape"));
        let Some(surface) = session.shown_document().and_then(|document| document.surface.as_ref())
        else {
            ui.label(tr("This document has no shape. Make one (Layer, Give it a shape…)."));
            return super::close(ui);
        };
        ui.weak(tr!("{size} pixels; the coverage is kept as alpha", size = surface.size()));
        for ((map, suffix), on) in ShapeMap::ALL.into_iter().zip(&mut self.chosen) {
            check_box(ui, on, format!("{} ({suffix})", tr(label(map))));
        }
        let options = &mut self.options;
        ui.horizontal(|ui| {
            ui.label(tr("Green points"));
            radio(ui, &mut options.is_directx, false, "up (OpenGL)");
            radio(ui, &mut options.is_directx, true, "down (DirectX)");
        });
        ui.horizontal(|ui| {
            radio(ui, &mut options.is_exr, false, "PNG");
            radio(ui, &mut options.is_exr, true, "EXR of 32 bits");
        });
        ui.add_enabled_ui(!options.is_exr, |ui| {
            ui.horizontal(|ui| {
                radio(ui, &mut options.is_16_bit, true, "16 bits");
                radio(ui, &mut options.is_16_bit, false, "8 bits");
            });
        });
        match buttons(ui, "Export…", self.chosen.contains(&true)) {
            Some(true) => DialogAnswer::Ask(WindowRequest::ExportMaps),
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }
}

fn label(map: ShapeMap) -> &'static str {
    match map {
        ShapeMap::Normals => "Normals",
        ShapeMap::Depth => "Depth, near is dark",
        ShapeMap::Height => "Height, near is light",
        ShapeMap::Mask => "Mask",
        ShapeMap::Parts => "Number of the part, 16 bits",
    }
}
