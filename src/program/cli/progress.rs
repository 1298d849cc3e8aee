//! The progress bar: drawn on a terminal, and only for work that takes more than a second.
//! Floor 7.

use crate::document::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Shorter work shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);
const REDRAW: Duration = Duration::from_millis(100);

/// Does the work and shows its progress.
pub fn run_with_progress<T>(work: impl FnOnce(&Progress) -> T) -> T {
    let progress = Progress::default();
    if !std::io::stderr().is_terminal() {
        return work(&progress);
    }
    let (over, is_over) = channel::<()>();
    std::thread::scope(|scope| {
        let watched = &progress;
        scope.spawn(move || {
            draw(watched, || is_over.recv_timeout(REDRAW) == Err(RecvTimeoutError::Timeout))
        });
        let result = work(&progress);
        // Dropping it wakes the drawing thread; a panic drops it, too.
        drop(over);
        result
    })
}

/// Redraws for as long as `goes_on`, which waits between two calls.
fn draw(progress: &Progress, goes_on: impl Fn() -> bool) {
    let began = Instant::now();
    let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden());
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {percent:>3} % {eta:>5}") {
        bar.set_style(style);
    }
    while goes_on() {
        if began.elapsed() > PATIENCE && bar.is_hidden() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        let (done, total) = progress.read();
        bar.set_length(total);
        bar.set_position(done);
    }
    bar.finish_and_clear();
}
