//! What a shape costs: inflating an outline of 1 Mpx from nothing and after an edit, and a frame of
//! each slider.
//!
//! `cargo bench --bench shape`. Two threads, as the aims assume: 100 ms from nothing, 50 ms after
//! an edit, 16 ms for a slider's frame, a touch or a sculpting dab. The times of a document include
//! everything that follows an event except painting: in full, as when the pen rests, and in the
//! coarse pixels shown during a drag.

use divan::{Bencher, black_box};
use rilievo::math::{Vec2, vec2, vec3};
use rilievo::raster::Plane;
use rilievo::shape::{
    Combine, Inflation, OutlineSource, Part, PartKind, SculptStroke, SculptTool, Touch,
};
use rilievo::{Document, Size};
use rilievo_engine::document::DocumentReducer;
use rilievo_engine::shape::inflate::inflate;
use rilievo_engine::shape::{Form, Outline, OutlineRim, Relief, Roundness, tube};

fn main() {
    divan::main();
}

/// A creature of five limbs on 1 Mpx; `longer` px are added to one of them.
fn creature(longer: f32) -> Outline {
    Outline::of_path(&way_around(1220.0, longer), 1 << 26).expect("an outline")
}

/// Its outline on a square canvas.
fn way_around(side: f32, longer: f32) -> Vec<Vec2> {
    let at = |i: usize| {
        let angle = std::f32::consts::TAU * i as f32 / 6000.0;
        let reach = 0.34 + 0.09 * (5.0 * angle).sin() + 0.05 * (3.0 * angle + 1.0).cos();
        let limb = longer * (-((angle - 1.6) / 0.05).powi(2)).exp();
        Vec2::from_angle(angle) * (reach * side + limb) + 0.5 * side
    };
    (0..6000).map(at).collect()
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
    let start = Plane::from_fn(after.size(), |x, y| {
        known.get(x as i32 + shift.0, y as i32 + shift.1).unwrap_or(0.0)
    });
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
    let (u, rim) = (inflate(&outline, None, None), OutlineRim::silhouette(&outline));
    bencher.bench_local(|| pool.install(|| black_box(Form::of_squares(&outline, &u, &rim, ROUND))));
}

/// A frame of the slider from pillow to tube.
#[divan::bench(sample_count = 20)]
fn profile_dragged(bencher: Bencher) {
    let (outline, pool) = (creature(0.0), two_threads());
    let (u, h, rim) = (
        inflate(&outline, None, None),
        tube::tube(&outline, None, None),
        OutlineRim::silhouette(&outline),
    );
    let frame = || Form::of_squares(&outline, &tube::blend(&u, &h, 0.4), &rim, ROUND);
    bencher.bench_local(|| pool.install(|| black_box(frame())));
}

/// The cost of turning a part into heights of the surface.
#[divan::bench(sample_count = 10)]
fn combined(bencher: Bencher) {
    let (outline, pool) = (creature(0.0), two_threads());
    let (u, rim) = (inflate(&outline, None, None), OutlineRim::silhouette(&outline));
    let form = Form::of_squares(&outline, &u, &rim, ROUND);
    let one = || {
        let mut relief = Relief::empty(Size::new(1220, 1220));
        relief.add(&form, Combine::Over, 1);
        relief
    };
    bencher.bench_local(|| pool.install(|| black_box(one())));
}

/// The creature as a document's part, puffed so much.
fn puffed(side: f32, puff: f32) -> Part {
    let outline = OutlineSource::Path(way_around(side, 0.0));
    Part::new(
        "a",
        PartKind::Inflate { outline, inflation: Inflation { puff, ..Inflation::default() } },
    )
}

fn document(side: u32) -> Document {
    Document::empty(Size::new(side, side)).with_part(puffed(side as f32, 1.0))
}

/// Frames in which one part of a document is another one each time, whole or in pixels of four.
fn frames(
    bencher: Bencher,
    document: &Document,
    is_draft: bool,
    part: impl Fn(usize) -> Part + Sync,
) {
    let (pool, mut reduced, mut frame) = (two_threads(), DocumentReducer::new(0.25), 0);
    pool.install(|| reduced.of(&document.with_part_ahead(part(0))).expect("a small document"));
    bencher.bench_local(|| {
        frame += 1;
        let dragged = document.with_part_ahead(part(frame));
        pool.install(|| match is_draft {
            true => reduced.of(&dragged).expect("a small document"),
            false => dragged.reshaped(),
        })
    });
}

#[divan::bench(args = [false, true], sample_count = 20)]
fn slider_of_a_document(bencher: Bencher, is_draft: bool) {
    frames(bencher, &document(1220), is_draft, |i| puffed(1220.0, 0.5 + 0.001 * i as f32));
}

/// A stroke that grows by a sample, of radius 40.
#[divan::bench(args = [false, true], sample_count = 20)]
fn sculpting_at_2048(bencher: Bencher, is_draft: bool) {
    let stroke = |n: usize| {
        let samples = (0..n + 20).map(|i| (vec2(700.0 + 4.0 * i as f32, 1024.0), 1.0)).collect();
        let stroke = SculptStroke {
            tool: SculptTool::Raise,
            size: 80.0,
            hardness: 0.3,
            strength: 1.0,
            samples,
        };
        Part::new("s", PartKind::Sculpt { on: "a".into(), strokes: vec![stroke] })
    };
    frames(bencher, &document(2048).with_part(stroke(0)), is_draft, stroke);
}

/// One more of ten touches.
#[divan::bench(args = [false, true], sample_count = 10)]
fn touching_at_2048(bencher: Bencher, is_draft: bool) {
    let touches = |n: usize| {
        let touch = |i: usize| Touch {
            at: vec2(800.0 + 30.0 * i as f32, 1000.0),
            radius: 8.0,
            normal: vec3(-0.4, 0.5, 0.768),
            reach: 0.0,
        };
        Part::new(
            "t",
            PartKind::Touches { on: "a".into(), touches: (0..10 + n).map(touch).collect() },
        )
    };
    frames(bencher, &document(2048).with_part(touches(0)), is_draft, touches);
}
