//! How fast radiance scaling and materials are, beside a copy of the same pixels in the same run.
//!
//! `cargo bench --no-default-features --bench shading`. Figures are compared within one run only.

use divan::{Bencher, counter::ItemsCount};
use rayon::prelude::*;
use rilievo::math::{Size, vec3};
use rilievo::raster::{PlanarTile, Plane, TileAt, planar::Row};
use rilievo::shading::{RadianceScaling, radiance::Beneath};
use rilievo::surface::{Maps, Scene, Surface};
use std::sync::Arc;

fn main() {
    divan::main();
}

const SMALL: (u32, u32) = (1024, 768);
const LARGE: (u32, u32) = (3840, 2160);
/// Canvas and threads; 0 threads are all there are.
const RUNS: [((u32, u32), usize); 4] = [(SMALL, 1), (SMALL, 0), (LARGE, 1), (LARGE, 0)];
type Run = ((u32, u32), usize);

/// A bumpy surface over the whole canvas.
fn scene((width, height): (u32, u32)) -> Scene {
    let size = Size::new(width, height);
    let normals = Plane::from_fn(size, |x, y| {
        let (x, y) = (x as f32 * 0.05, y as f32 * 0.07);
        vec3(0.6 * x.sin(), 0.5 * (y + x * 0.3).cos(), 1.0)
    });
    let maps = Maps { normals, depth: Plane::filled(size, 0.5), coverage: Plane::filled(size, 255) };
    Scene { size, surface: Some(Arc::new(Surface::new(maps).expect("a whole surface"))) }
}

/// A painted composite: every tone, opaque.
fn composite(scene: &Scene) -> Vec<(TileAt, PlanarTile)> {
    let tone = |x: usize, y: usize, c: usize| ((x * (3 + c) + y * 5) % 256) as f32 / 255.0;
    let row = |y: usize| Row {
        rgb: std::array::from_fn(|c| std::array::from_fn(|x| tone(x, y, c))),
        a: [1.0; rilievo::raster::TILE],
    };
    let mut tile = PlanarTile::transparent();
    tile.rows_mut().iter_mut().enumerate().for_each(|(y, r)| *r = row(y));
    TileAt::covering(scene.size.rect()).map(|at| (at, tile.clone())).collect()
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
}

fn area(run: Run) -> ItemsCount {
    ItemsCount::new(run.0.0 as usize * run.0.1 as usize)
}

#[divan::bench(args = RUNS)]
fn radiance_scaling_layer(bencher: Bencher, run: Run) {
    let scene = scene(run.0);
    let tiles = composite(&scene);
    let layer = RadianceScaling::default();
    let beneath = Beneath { brightest: 1.0, gain: 1.0 };
    let pool = pool(run.1);
    // A fresh composite each time: one scaled again and again ends in numbers too small to be fast.
    bencher.counter(area(run)).with_inputs(|| tiles.clone()).bench_local_refs(|tiles| {
        pool.install(|| tiles.par_iter_mut().for_each(|(at, tile)| layer.apply_tile(&scene, *at, beneath, tile)));
    });
}

#[divan::bench(args = RUNS)]
fn copy_of_the_same_pixels(bencher: Bencher, run: Run) {
    let scene = scene(run.0);
    let from = composite(&scene);
    let mut to = from.clone();
    let pool = pool(run.1);
    bencher.counter(area(run)).bench_local(|| {
        pool.install(|| to.par_iter_mut().zip(&from).for_each(|(t, f)| t.1.rows_mut().copy_from_slice(f.1.rows())));
    });
}
