//! The window on a desktop. Floor 7. Its event loop is `event_loop`.

use crate::pen::SharedTablet;
use crate::running::{self, RunningWindow, Turn};
use crate::{Error, MainWindow, Result, event_loop, program_icon};
use eframe::egui;
use std::cell::{Cell, OnceCell};
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::mpsc::channel;

/// Opens the window with these files, or with the start screen if there are none, and returns when it
/// is closed. A running window takes the files instead, unless a new one is wanted.
///
/// Fails with a sentence if there is no display.
pub fn run(files: Vec<PathBuf>, is_new: bool) -> Result<()> {
    let place = running::place();
    let turn = place.as_deref().map(Turn::wait);
    let is_taken = |place: &PathBuf| running::try_hand_over(place, &files);
    if !is_new && place.as_ref().is_some_and(is_taken) {
        return Ok(());
    }
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
    let (tablet, is_open) = (SharedTablet::default(), Rc::new(Cell::new(false)));
    let (pen, is_opened) = (tablet.clone(), is_open.clone());
    let (asked, received) = channel();
    let (opened_by_desktop, drawn) = (asked.clone(), Rc::new(OnceCell::new()));
    let ctx = drawn.clone();
    let open = move |files| {
        // The window is there for as long as anything is opened in it.
        let _ = opened_by_desktop.send(files);
        ctx.get().into_iter().for_each(egui::Context::request_repaint);
    };
    // It lives as long as the window.
    let running = Rc::new(Cell::new(None));
    let listener = running.clone();
    let start =
        move |cc: &eframe::CreationContext<'_>| -> std::result::Result<Box<dyn eframe::App>, _> {
            is_opened.set(true);
            let mut window = MainWindow::of_user(&cc.egui_ctx, pen, files);
            window.open_what_comes(received);
            let _ = drawn.set(cc.egui_ctx.clone());
            // Without it every start opens a window of its own.
            let ctx = cc.egui_ctx.clone();
            let listen = |place| RunningWindow::listen(place, asked, move || ctx.request_repaint());
            listener.set(place.and_then(|place| listen(place).ok()));
            drop(turn);
            Ok(Box::new(window))
        };
    let wrong = match event_loop::run(options, tablet, open, Box::new(start)) {
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
