//! An hour of painting at 240 Hz on one stroke layer of 1920 × 1080: 864,000 readings of a pen with
//! pressure, tilt and time, in strokes of one and a half seconds. Saved (encoded, read back,
//! compared, on the disk) and opened, and how large the file is.
//!
//! The layer is rendered beforehand, as in the window, where it was painted. `cargo bench --bench
//! pen`.

use divan::Bencher;
use rilievo::document::{Live, StrokeList};
use rilievo::math::vec2;
use rilievo::paint::{Brush, Sample, Stroke};
use rilievo::{
    Budget, Color, Content, Document, Layer, Operator, Overwrite, Progress, Size, flatten, open,
    save,
};
use rilievo_engine::math::hash;
use std::sync::{Arc, LazyLock};

const RATE: usize = 240;
const SAMPLES: usize = 3600 * RATE;
const A_STROKE: usize = 360;
const SIZE: Size = Size::new(1920, 1080);

fn main() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("hour.ora");
    save(&HOUR, &file, Overwrite::Anything, &Progress::default()).expect("a saved drawing");
    let bytes = std::fs::metadata(&file).expect("a file").len();
    println!("{SAMPLES} readings of the pen, {:.1} MB of file", bytes as f64 / 1e6);
    divan::main();
}

/// Even, in -0.5 … 0.5.
fn noise(i: usize, column: u32) -> f32 {
    hash::unit(column, i as u32, 7) - 0.5
}

/// A hatch: an arc over a part of the canvas, the pressure rising and falling, the hand trembling
/// and the clock too.
fn stroke(number: usize) -> Arc<Stroke> {
    let middle =
        vec2(200.0 + 1520.0 * (noise(number, 1) + 0.5), 150.0 + 780.0 * (noise(number, 2) + 0.5));
    let (turn, reach) = (6.3 * noise(number, 3), 60.0 + 160.0 * (noise(number, 4) + 0.5));
    let one = |i: usize| {
        let (t, n) = (i as f32 / RATE as f32, number * A_STROKE + i);
        let along = i as f32 / A_STROKE as f32;
        let angle = turn + 1.8 * along * along;
        let at =
            middle + reach * vec2(angle.cos(), angle.sin()) + 0.4 * vec2(noise(n, 5), noise(n, 6));
        // A tablet reports one of 8192 levels, and tilt in whole degrees.
        let pressure = (8191.0 * (0.7 * (3.1 * along).sin() + 0.02 * noise(n, 7)).clamp(0.0, 1.0))
            .round()
            / 8191.0;
        let tilt = vec2((32.0 + 9.0 * along).round(), (-20.0 + 6.0 * (4.0 * along).sin()).round());
        Sample { at, pressure, tilt, time_secs: t + 0.0005 * (noise(n, 8) + 0.5) }.normalized()
    };
    let brush = Brush { size: 6.0 + (number / 40 % 5) as f32, ..Brush::default() };
    let color = Color { r: (number * 37) as u8, g: (number * 11) as u8, b: 90, a: 255 };
    Arc::new(Stroke::new(brush, Operator::None, color, (0..A_STROKE).map(one).collect()))
}

static HOUR: LazyLock<Document> = LazyLock::new(|| {
    let strokes = (0..SAMPLES / A_STROKE).map(stroke).collect();
    let layers =
        vec![Arc::new(Layer::new("Ink", Content::Strokes(Live::new(StrokeList { strokes }))))];
    let document = Document { layers, ..Document::empty(SIZE) };
    flatten(&document, &Progress::default()).expect("a picture");
    document
});

/// The layer as it is after an edit: its picture for other programs is encoded again.
fn edited() -> Document {
    HOUR.with_layer(HOUR.layers[0].id, |layer| layer.opacity = 0.9).expect("the layer")
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn save_an_hour(bencher: Bencher) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("hour.ora");
    let saved = |document: &mut Document| {
        save(document, &file, Overwrite::Anything, &Progress::default()).expect("saved")
    };
    bencher.with_inputs(edited).bench_local_refs(saved);
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn open_an_hour(bencher: Bencher) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("hour.ora");
    save(&HOUR, &file, Overwrite::Anything, &Progress::default()).expect("saved");
    bencher.bench_local(|| open(&file, &Budget::default()).expect("a drawing"));
}
