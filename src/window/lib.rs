//! Floor 7: the window. Panels are functions that read the session and request actions; the actions
//! are performed once per frame. Not here: pixels and equations.

#![cfg_attr(not(test), warn(missing_docs))]

mod advice;
mod brush_shelf;
mod canvas;
mod clipboard;
mod commands;
mod dialogs;
mod event_loop;
mod export_memory;
mod file_pictures;
mod file_purpose;
mod files;
mod harmony;
mod icons;
mod jobs;
mod keymap;
mod keys;
mod look_pictures;
mod messages;
mod mood_pictures;
mod operators;
mod panel_layout;
mod panels;
mod part_pictures;
mod pen;
mod pending;
mod preferences;
mod program_icon;
mod recovery;
mod render_thread;
mod requests;
mod sample;
mod sample_pictures;
mod saving;
mod settings;
mod swatches;
mod theme;
mod thumbnails;
mod typed_range;
mod usage;
mod widgets;
mod window;

pub use clipboard::PastedContent;
pub use window::MainWindow;

// The lower floors, under their own names.
use rilievo_engine::{
    Error, Remedy, Result, document, math, memory, paint, raster, shading, shape, surface,
};
use rilievo_io as io;
use rilievo_program::{session, tools};

use eframe::egui;
use std::cell::Cell;
use std::path::PathBuf;
use std::rc::Rc;

/// Opens the window with these files, or with the sample if there are none; returns when it is
/// closed.
///
/// Fails with a sentence if there is no display.
pub fn run(files: Vec<PathBuf>) -> Result<()> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("Rilievo")
        .with_app_id("rilievo")
        .with_inner_size([1280.0, 820.0])
        .with_min_inner_size([720.0, 480.0])
        .with_drag_and_drop(true);
    let viewport = match program_icon::program_icon() {
        Some(icon) => viewport.with_icon(icon),
        None => viewport,
    };
    // Clipboard shortcuts arrive as keys: see `clipboard`. Nothing is drawn in more than eight
    // bits, so there is nothing to dither, and dithering takes time at every pixel of every frame.
    let options = eframe::NativeOptions {
        viewport,
        clipboard_shortcuts: false,
        dithering: false,
        ..Default::default()
    };
    let (tablet, is_open) = (pen::SharedTablet::default(), Rc::new(Cell::new(false)));
    let (pen, opened) = (tablet.clone(), is_open.clone());
    let start =
        move |cc: &eframe::CreationContext<'_>| -> std::result::Result<Box<dyn eframe::App>, _> {
            opened.set(true);
            theme::install(&cc.egui_ctx);
            let mut window = MainWindow::remembering(&cc.egui_ctx, settings::file());
            window.draw_on(pen);
            if let Some(folder) = crate::io::recovery::folder() {
                window.keep_recovery_in(folder);
            }
            if let Some(folder) = settings::brushes() {
                window.keep_brushes_in(folder);
            }
            if let Some(folder) = settings::palettes() {
                window.keep_palettes_in(folder);
            }
            window.begin(files);
            Ok(Box::new(window))
        };
    let wrong = match event_loop::run(options, tablet, Box::new(start)) {
        Ok(()) if is_open.get() => return Ok(()),
        // The windowing library does not report the reason.
        Ok(()) => "the display has no OpenGL to draw with".to_owned(),
        Err(error) => error.to_string(),
    };
    // Only the reason, without the library's context.
    let wrong = wrong.rsplit(": ").next().unwrap_or(&wrong).trim_end_matches(['.', ')']);
    let reason =
        format!("no window can be opened here ({wrong}); “rilievo render” paints without one");
    Err(Error::unsupported_file("display", reason))
}
