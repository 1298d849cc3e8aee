//! What a shape costs: inflating an outline of 1 Mpx from nothing and after an edit, and a frame of each slider.
//!
//! `cargo bench --bench shape`. Two threads, as the aims are told: 100 ms from nothing, 50 ms after an edit, 16 ms a
//! slider's frame.

use divan::{Bencher, black_box};
use rilievo_engine::math::{Size, Vec2};
use rilievo_engine::raster::Plane;
use rilievo_engine::shape::{Combine, Form, Outline, Relief, Rim, Roundness, inflate::inflate, tube};

fn main() {
    divan::main();
}

/// A creature of five limbs on 1 Mpx; `longer` px are added to one of them.
fn creature(longer: f32) -> Outline {
    let at = |i: usize| {
        let angle = std::f32::consts::TAU * i as f32 / 6000.0;
        let reach = 0.34 + 0.09 * (5.0 * angle).sin() + 0.05 * (3.0 * angle + 1.0).cos();
        let limb = longer * (-((angle - 1.6) / 0.05).powi(2)).exp();
        Vec2::from_angle(angle) * (reach * 1220.0 + limb) + 610.0
    };
    Outline::of_path(&(0..6000).map(at).collect::<Vec<_>>(), 1 << 26).expect("an outline")
}

fn two_threads() -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a thread pool")
}

const ROUND: Roundness = Roundness { puff: 0.8, rim_deg: 90.0 };

#[divan::bench(sample_count = 10)]
fn inflate_from_nothing(bencher: Bencher) {
    let (outline, pool) = (creature(0.0), two_threads());
    bencher.bench_local(|| pool.install(|| black_box(inflate(&outline, None, None))));
}

#[divan::bench(sample_count = 10)]
fn inflate_after_an_edit(bencher: Bencher) {
    let (before, after, pool) = (creature(0.0), creature(6.0), two_threads());
    let known = inflate(&before, None, None);
    let shift = (after.corner().0 - before.corner().0, after.corner().1 - before.corner().1);
    let start = Plane::from_fn(after.size(), |x, y| known.get(x as i32 + shift.0, y as i32 + shift.1).unwrap_or(0.0));
    bencher.bench_local(|| pool.install(|| black_box(inflate(&after, None, Some(&start)))));
}

#[divan::bench(sample_count = 10)]
fn tube_from_nothing(bencher: Bencher) {
    let (outline, pool) = (creature(0.0), two_threads());
    bencher.bench_local(|| pool.install(|| black_box(tube::tube(&outline, None, None))));
}

/// A frame of the sliders puff and rim: the field is known.
#[divan::bench(sample_count = 20)]
fn puff_dragged(bencher: Bencher) {
    let (outline, pool) = (creature(0.0), two_threads());
    let (u, rim) = (inflate(&outline, None, None), Rim::silhouette(&outline));
    bencher.bench_local(|| pool.install(|| black_box(Form::of_squares(&outline, &u, &rim, ROUND))));
}

/// A frame of the slider from pillow to tube.
#[divan::bench(sample_count = 20)]
fn profile_dragged(bencher: Bencher) {
    let (outline, pool) = (creature(0.0), two_threads());
    let (u, h, rim) = (inflate(&outline, None, None), tube::tube(&outline, None, None), Rim::silhouette(&outline));
    let frame = || Form::of_squares(&outline, &tube::blend(&u, &h, 0.4), &rim, ROUND);
    bencher.bench_local(|| pool.install(|| black_box(frame())));
}

/// What a part costs on its way into the surface's heights.
#[divan::bench(sample_count = 10)]
fn combined(bencher: Bencher) {
    let (outline, pool) = (creature(0.0), two_threads());
    let (u, rim) = (inflate(&outline, None, None), Rim::silhouette(&outline));
    let form = Form::of_squares(&outline, &u, &rim, ROUND);
    let one = || {
        let mut relief = Relief::empty(Size::new(1220, 1220));
        relief.add(&form, Combine::Over, 1);
        relief
    };
    bencher.bench_local(|| pool.install(|| black_box(one())));
}
