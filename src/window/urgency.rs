//! Which frames cannot wait. `egui` lays the window out once more after every frame that had events,
//! for what is seen a frame late. While something is drawn or dragged, that frame would hold up the
//! next motion of the pen for as long as the window takes to be drawn: it waits for a pause
//! (`event_loop`). A frame that shows a new picture does not. Floor 7.

use eframe::egui::Context;
use std::sync::atomic::{AtomicBool, Ordering};

/// A new picture waits for a frame.
static IS_URGENT: AtomicBool = AtomicBool::new(false);

/// Asks for a frame, from any thread, that does not wait for a pause.
pub fn request_repaint_now(ctx: &Context) {
    IS_URGENT.store(true, Ordering::SeqCst);
    ctx.request_repaint();
}

/// Whether such a frame was asked for since the last call.
#[cfg(not(target_family = "wasm"))]
pub fn try_take_urgency() -> bool {
    IS_URGENT.swap(false, Ordering::SeqCst)
}
