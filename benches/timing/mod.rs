//! Shared by several benches: timing the frames of a gesture, and printing rows of a table.

use rilievo::document::{PreparedDocument, diff};
use rilievo::math::{Vec2, vec2};
use rilievo::paint::Sample;
use rilievo::raster::TileAt;
use rilievo::{Document, Progress, TileGrid};
use rilievo_program::tools::{self, Outcome, PenSample, ToolContext, ToolKind};
use std::time::Instant;

/// Samples of the pen in a frame.
const SAMPLES: usize = 16;

/// ms from the events of each frame of a gesture to its flattened tiles.
///
/// * `pen`: the gesture's `i`th sample; the first is where the pen comes down.
pub fn frames(
    tool: ToolKind,
    context: &ToolContext,
    pen: impl Fn(usize) -> PenSample,
    count: usize,
) -> Vec<f64> {
    let (gesture, _) = tools::press(tool, context, pen(0));
    let mut gesture = gesture.expect("the tool can begin");
    let progress = Progress::default();
    let mut shown: Document = context.document.clone();
    let all = PreparedDocument::new(&shown, &progress).expect("nobody cancels");
    let mut picture = all
        .flatten_tiles(&TileGrid::default(), &all.all_tiles(), &progress)
        .expect("nobody cancels");
    let frame = |frame: usize| {
        let pens: Vec<PenSample> = (1..=SAMPLES).map(|i| pen(frame * SAMPLES + i)).collect();
        let start = Instant::now();
        let Outcome::Preview(next) = gesture.drag(&pens) else { return None };
        let tiles: Vec<TileAt> = diff(&shown, &next).into_iter().collect();
        picture =
            PreparedDocument::new(&next, &progress)?.flatten_tiles(&picture, &tiles, &progress)?;
        shown = next;
        Some(start.elapsed().as_secs_f64() * 1e3)
    };
    (0..count).map_while(frame).collect()
}

/// The `i`th sample of a wavy line across 2048², 2 px further.
pub fn on_wave(i: usize) -> PenSample {
    let x = 260.0 + 2.0 * i as f32;
    let at = vec2(x, 1024.0 + 120.0 * (x / 150.0).sin());
    let sample = Sample { time_secs: i as f32 / 1000.0, ..Sample::at(at) };
    PenSample { sample, ..PenSample::at(Vec2::ZERO) }
}

/// Least, middle, and what nine of ten stay within.
pub fn row(name: &str, mut ms: Vec<f64>) {
    ms.sort_by(f64::total_cmp);
    let at = |share: f64| ms.get((ms.len() as f64 * share) as usize).copied().unwrap_or(f64::NAN);
    println!("{name:56} {:8.2} {:8.2} {:8.2}", at(0.0), at(0.5), at(0.9));
}
