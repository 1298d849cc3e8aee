//! Floor 7: the window. Panels are functions that see the session and ask for actions; once a frame the actions are done.
//! Nothing here knows pixels or equations.

mod asked;
mod canvas;
mod commands;
mod dialogs;
mod files;
mod icons;
mod jobs;
mod keymap;
mod keys;
mod painter;
mod panels;
mod pen;
mod recovery;
mod sample;
mod settings;
mod swatches;
mod theme;
mod thumbnails;
mod widgets;
mod window;

pub use window::Window;

use crate::{Error, Result};
use eframe::egui;
use std::path::PathBuf;

/// Opens the window with these files, or with the sample where there are none; returns when it is closed.
///
/// Fails with a sentence where there is no display.
pub fn run(files: Vec<PathBuf>) -> Result<()> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("Rilievo")
        .with_app_id("rilievo")
        .with_inner_size([1280.0, 820.0])
        .with_min_inner_size([720.0, 480.0])
        .with_drag_and_drop(true);
    let options = eframe::NativeOptions { viewport, ..Default::default() };
    let start = move |cc: &eframe::CreationContext<'_>| -> std::result::Result<Box<dyn eframe::App>, _> {
        theme::install(&cc.egui_ctx);
        let mut window = Window::remembering(&cc.egui_ctx, settings::file());
        if let Some(folder) = crate::io::recovery::folder() {
            window.keep_recovery_in(folder);
        }
        window.begin(files);
        Ok(Box::new(window))
    };
    eframe::run_native("rilievo", options, Box::new(start)).map_err(|error| {
        // Only what is wrong, not where the windowing library found it.
        let said = error.to_string();
        let wrong = said.rsplit(": ").next().unwrap_or(&said).trim_end_matches(['.', ')']);
        Error::unsupported(
            "display",
            format!("no window can be opened here ({wrong}); “rilievo render” paints without one"),
        )
    })
}
