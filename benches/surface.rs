//! What knowing the shape costs: the curvature tensor of a map of 3840 × 2160, beside a copy of the same bytes.
//!
//! `cargo bench --bench surface`. Figures are per map; divide by 8.29 million for ns per pixel. `threads = 0` is all.

use divan::{Bencher, black_box, counter::ItemsCount};
use rilievo_engine::math::{Size, vec3};
use rilievo_engine::raster::Plane;
use rilievo_engine::surface::{Maps, Surface};

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
    let wall = |x: usize, y: usize| (vec3((x as f32 * 0.05).sin(), (y as f32 * 0.04).cos(), 2.0), 1.0);
    Maps {
        normals: Plane::from_fn(SIZE, |x, y| ball(x, y).unwrap_or_else(|| wall(x, y)).0),
        depth: Plane::from_fn(SIZE, |x, y| ball(x, y).unwrap_or_else(|| wall(x, y)).1),
        coverage: Plane::filled(SIZE, 255),
    }
}

fn with_threads(threads: usize, work: impl FnOnce() + Send) {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool").install(work);
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
