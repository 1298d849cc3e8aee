//! What knowing the shape costs: the curvature tensor of a map of 3840 × 2160, next to a copy of
//! the same bytes.
//!
//! And what unwrapping a map of 1024 × 1024 costs, and finding its lines and its hatching.
//!
//! `cargo bench --bench surface`. Figures are per map; divide by 8.29 million for ns per pixel.
//! `threads = 0` is all.

use divan::{Bencher, black_box, counter::ItemsCount};
use rilievo::math::{vec2, vec3};
use rilievo::raster::Plane;
use rilievo::surface::Deformation;
use rilievo::{Anchor, Bend, Maps, Operator, Size, Surface};
use rilievo_engine::paint::{FormDrawing, FormPattern};
use rilievo_engine::surface::deformation::DeformedRect;
use rilievo_engine::surface::form_lines::{LineKind, LineKinds, LineSettings};
use rilievo_engine::surface::hatching::{GuideLines, HatchSettings};
use rilievo_engine::surface::operator::UnwrapSettings;
use rilievo_engine::surface::scene::Scene;
use rilievo_engine::surface::unwrap::Unwrapping;
use std::sync::Arc;

fn main() {
    divan::main();
}

const SIZE: Size = Size::new(3840, 2160);

/// Balls before a wavy wall: three quarters of the tiles are whole, the others hold silhouettes.
fn balls_before_a_wall() -> Maps {
    let ball = |x: usize, y: usize| {
        let (cx, cy) = ((x % 960) as f32 - 480.0, (y % 1080) as f32 - 540.0);
        let z2 = 1.0 - (cx * cx + cy * cy) / (300.0 * 300.0);
        (z2 > 0.0).then(|| (vec3(cx, -cy, 300.0 * z2.sqrt()), 0.5 - 0.3 * z2.sqrt()))
    };
    let wall =
        |x: usize, y: usize| (vec3((x as f32 * 0.05).sin(), (y as f32 * 0.04).cos(), 2.0), 1.0);
    Maps {
        normals: Plane::from_fn(SIZE, |x, y| ball(x, y).unwrap_or_else(|| wall(x, y)).0),
        depth: Plane::from_fn(SIZE, |x, y| ball(x, y).unwrap_or_else(|| wall(x, y)).1),
        coverage: Plane::full(SIZE, 255),
    }
}

fn with_threads(threads: usize, work: impl FnOnce() + Send) {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("a thread pool")
        .install(work);
}

/// The peer: the three planes of normals read and three planes written.
#[divan::bench(sample_count = 10)]
fn copy_of_the_normals(bencher: Bencher) {
    let planes: [Vec<f32>; 3] = std::array::from_fn(|i| vec![i as f32; SIZE.area()]);
    bencher.counter(ItemsCount::new(SIZE.area())).bench_local(|| black_box(planes.clone()));
}

/// Arguments: threads, blur in px.
#[divan::bench(sample_count = 5, args = [(1, 0.0), (1, 2.0), (1, 6.0), (0, 2.0)])]
fn curvature(bencher: Bencher, (threads, blur_px): (usize, f32)) {
    // A fresh blur each time, by a hair, so that none is found kept.
    let surface = Surface::new(balls_before_a_wall()).expect("a surface");
    let mut hair = 0.0;
    bencher.counter(ItemsCount::new(SIZE.area())).bench_local(|| {
        hair -= 1e-5;
        with_threads(threads, || {
            black_box(surface.curvature((blur_px + hair).abs()));
        });
    });
}

const UNWRAPPED: Size = Size::new(1024, 1024);

/// A ball of bumps before a wavy wall.
fn ball_before_a_wall() -> Surface {
    let at = |x: usize, y: usize| {
        let (dx, dy) = (x as f32 - 512.0, y as f32 - 512.0);
        let z2 = 1.0 - (dx * dx + dy * dy) / (400.0 * 400.0);
        let (bump_x, bump_y) = (0.2 * (x as f32 * 0.11).sin(), 0.2 * (y as f32 * 0.13).cos());
        match z2 > 0.0 {
            true => {
                (vec3(dx / 400.0 + bump_x, -dy / 400.0 + bump_y, z2.sqrt()), 0.5 - 0.4 * z2.sqrt())
            }
            false => (vec3(bump_x, bump_y, 1.0), 1.0),
        }
    };
    let maps = Maps {
        normals: Plane::from_fn(UNWRAPPED, |x, y| at(x, y).0),
        depth: Plane::from_fn(UNWRAPPED, |x, y| at(x, y).1),
        coverage: Plane::full(UNWRAPPED, 255),
    };
    Surface::new(maps).expect("a surface")
}

/// D_s of a map solved from nothing. Arguments: threads.
#[divan::bench(sample_count = 5, sample_size = 1, args = [1, 2])]
fn unwrapping(bencher: Bencher, threads: usize) {
    let surface = ball_before_a_wall();
    let settings = UnwrapSettings { amount: 1.0, smooth_px: 0.0 };
    bencher.counter(ItemsCount::new(UNWRAPPED.area())).bench_local(|| {
        with_threads(threads, || drop(black_box(Unwrapping::new(&surface, settings))));
    });
}

/// D over the whole canvas by one thread after an anchor was moved, the surface being unwrapped.
/// Arguments: anchors.
#[divan::bench(sample_count = 9, sample_size = 1, args = [1, 3])]
fn unwrapped_under_a_moved_anchor(bencher: Bencher, anchors: usize) {
    let surface = ball_before_a_wall();
    let at = [vec2(512.5, 512.5), vec2(300.5, 400.5), vec2(700.5, 600.5)];
    let mut bend = Bend {
        operator: Operator::Surface { amount: 1.0, smooth: 0.0 },
        anchors: at[..anchors].iter().map(|&at| Anchor::pin(at)).collect(),
        ..Bend::default()
    };
    let mut deformed = DeformedRect::default();
    Deformation::new(Some(&surface), UNWRAPPED, &bend).fill(UNWRAPPED.rect(), &mut deformed);
    bencher.counter(ItemsCount::new(UNWRAPPED.area())).bench_local(|| {
        bend.anchors[0].at.x += 1.0;
        Deformation::new(Some(&surface), UNWRAPPED, &bend)
            .fill(UNWRAPPED.rect(), black_box(&mut deformed));
    });
}

/// The lines of a pen drawing, from nothing. Argument: threads.
#[divan::bench(sample_count = 5, args = [1, 2, 0])]
fn form_lines(bencher: Bencher, threads: usize) {
    bencher.with_inputs(ball_before_a_wall).bench_local_values(|surface| {
        with_threads(threads, || {
            black_box(surface.form_lines(&LineSettings::DEFAULT));
        });
        surface
    });
}

/// The same after the light moved: the edge of light is traced among them. Argument: threads.
#[divan::bench(sample_count = 5, args = [2])]
fn form_lines_under_a_moved_light(bencher: Bencher, threads: usize) {
    let (surface, mut turn) = (ball_before_a_wall(), 0.0f32);
    let kinds = LineKinds::PEN.with(LineKind::Light, true);
    bencher.bench_local(|| {
        turn += 0.01;
        let settings = LineSettings {
            kinds,
            light: vec3(turn.cos(), turn.sin(), 1.0),
            ..LineSettings::DEFAULT
        };
        with_threads(threads, || {
            black_box(surface.form_lines(&settings));
        });
    });
}

/// The same after σ moved: outlines, creases and borders stay. Argument: threads.
#[divan::bench(sample_count = 9, args = [2])]
fn form_lines_under_a_moved_sigma(bencher: Bencher, threads: usize) {
    let (surface, mut smooth) = (ball_before_a_wall(), 2.0f32);
    surface.form_lines(&LineSettings::DEFAULT);
    bencher.bench_local(|| {
        smooth += 0.01;
        let settings = LineSettings { smooth, ..LineSettings::DEFAULT };
        with_threads(threads, || {
            black_box(surface.form_lines(&settings));
        });
    });
}

/// The lines of crosshatching, from nothing. Argument: threads.
#[divan::bench(sample_count = 3, args = [1, 2])]
fn hatch_lines(bencher: Bencher, threads: usize) {
    bencher.with_inputs(ball_before_a_wall).bench_local_values(|surface| {
        with_threads(threads, || {
            black_box(surface.hatch_lines(&HatchSettings::DEFAULT, &GuideLines::none()));
        });
        surface
    });
}

/// The strokes of crosshatching after the light moved, without painting them. Argument: threads.
#[divan::bench(sample_count = 5, args = [2])]
fn hatching_under_a_moved_light(bencher: Bencher, threads: usize) {
    let (surface, mut turn) = (Arc::new(ball_before_a_wall()), 0.0f32);
    let scene = Scene { size: UNWRAPPED, surface: Some(surface) };
    bencher.bench_local(|| {
        turn += 0.01;
        let settings =
            HatchSettings { light: vec3(turn.cos(), turn.sin(), 1.0), ..HatchSettings::DEFAULT };
        with_threads(threads, || {
            let drawing = FormDrawing::new(FormPattern::Hatching(settings));
            black_box(drawing.strokes(&scene));
        });
    });
}
