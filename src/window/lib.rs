//! Floor 7: the window. Panels are functions that read the session and request actions; the actions
//! are performed once per frame. Not here: pixels and equations.

#![cfg_attr(not(test), warn(missing_docs))]

mod advice;
mod brush_shelf;
mod canvas;
mod clipboard;
mod commands;
#[cfg(not(target_family = "wasm"))]
mod desktop;
mod dialogs;
#[cfg(not(target_family = "wasm"))]
mod event_loop;
mod export_memory;
mod file_pictures;
mod file_purpose;
mod files;
mod fonts;
mod harmony;
mod icons;
mod jobs;
mod keymap;
mod keys;
mod look_pictures;
mod messages;
mod mood_pictures;
#[cfg(not(target_family = "wasm"))]
mod opened_files;
mod operators;
mod panel_layout;
mod panels;
mod part_pictures;
mod pen;
mod pending;
mod preferences;
#[cfg(not(target_family = "wasm"))]
mod program_icon;
mod recovery;
mod reduce;
mod references;
mod render_thread;
mod requests;
#[cfg(not(target_family = "wasm"))]
mod running;
mod sample;
mod sample_pictures;
mod saving;
mod settings;
mod swatches;
mod theme;
mod thumbnails;
mod titles;
mod tour;
mod typed_range;
mod urgency;
mod usage;
mod widgets;
mod window;

pub use clipboard::PastedContent;
#[cfg(not(target_family = "wasm"))]
pub use desktop::run;
pub use pen::{AxisMeaning, PenAxes, PenAxis, PenState, SharedTablet};
pub use window::MainWindow;

// The lower floors, under their own names.
use rilievo_engine::{
    Error, Remedy, Result, document, math, memory, paint, raster, shading, shape, surface,
};
use rilievo_io as io;
use rilievo_program::{language, session, tools, tr};
