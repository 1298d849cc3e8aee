//! What a lamp costs: plain, scaled by the relief, and warped by it (RS fig. 7).
//!
//! `cargo bench --no-default-features --bench lamps`. `layer_…` and `canvas_…` are shading layers as
//! the program draws them. `loop_…` are one loop over pixels and lamps, the same but for the method,
//! so that methods can be compared that the program does not have. One thread; its processor time
//! where the system tells it, so that other programs count less.

#[allow(dead_code, reason = "only the warp is measured")]
#[path = "../examples/light_warping.rs"]
mod light_warping;

use light_warping::{lambda, warp};
use rayon::prelude::*;
use rilievo::math::{Vec3, vec3};
use rilievo::raster::{Plane, TileAt};
use rilievo::shading::{Light, LightKind, Model, Scaling, Shading};
use rilievo::surface::{Curvature, Scene};
use rilievo::{Maps, Size, Surface};
use std::hint::black_box;
use std::sync::{Arc, LazyLock};
use std::time::Instant;

const SMALL: (u32, u32) = (1024, 768);
/// The canvas of the loops.
const TINY: (u32, u32) = (512, 384);
/// How many lamps are lit.
const LAMPS: [usize; 6] = [1, 50, 100, 150, 200, 250];
/// Canvases of about 1, 2, 4, 6 and 8 megapixels.
const SIZES: [(u32, u32); 5] = [SMALL, (1920, 1080), (2560, 1600), (3072, 2048), (3840, 2160)];
/// How often each is measured.
const TIMES: usize = 9;
const SCALED: Scaling = Scaling::new(0.2, 1.0);

fn main() {
    println!("ms, one thread{:42}    least   middle     most", "");
    let (small, tiny) = (scene(SMALL), scene(TINY));
    let curvature = surface(&tiny).curvature(1.5);
    let canvases = SIZES.map(scene);
    let mut works = Vec::new();
    for count in LAMPS {
        works.push(layer(format!("layer_plain/{count}"), &small, count, Scaling::NONE));
        works.push(layer(format!("layer_scaled/{count}"), &small, count, SCALED));
        works.extend(loops(surface(&tiny), &curvature, count));
    }
    for (size, scene) in SIZES.iter().zip(&canvases) {
        works.push(layer(format!("canvas_plain/{size:?}"), scene, 16, Scaling::NONE));
        works.push(layer(format!("canvas_scaled/{size:?}"), scene, 16, SCALED));
    }
    measure(&works);
}

/// What is measured, by its name.
type Work<'a> = (String, Box<dyn Fn() + Sync + 'a>);

fn surface(scene: &Scene) -> &Surface {
    scene.surface.as_deref().expect("a surface")
}

/// A bumpy surface over the whole canvas.
fn scene((width, height): (u32, u32)) -> Scene {
    let size = Size::new(width, height);
    let normals = Plane::from_fn(size, |x, y| {
        let (x, y) = (x as f32 * 0.05, y as f32 * 0.07);
        vec3(0.6 * x.sin(), 0.5 * (y + x * 0.3).cos(), 1.0)
    });
    let maps = Maps { normals, depth: Plane::full(size, 0.5), coverage: Plane::full(size, 255) };
    Scene { size, surface: Some(Arc::new(Surface::new(maps).expect("a whole surface"))) }
}

/// Directions spread over the side of the viewer.
fn lamps(count: usize) -> Vec<Vec3> {
    let lamp = |i: usize| {
        let (z, turn) = ((i as f32 + 0.5) / count as f32, 2.399_963 * i as f32);
        let radius = (1.0 - z * z).sqrt();
        vec3(radius * turn.cos(), radius * turn.sin(), z)
    };
    (0..count).map(lamp).collect()
}

/// Time that this thread has run, ms: on a processor, or by the clock.
fn thread_ms() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    // Brings the count up to date.
    std::thread::yield_now();
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let ns = counted.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    ns.map_or_else(|| START.elapsed().as_secs_f64() * 1e3, |ns| ns / 1e6)
}

/// Prints the table. All are measured in turn, and then again, so that what else goes on is spread
/// over them.
fn measure(works: &[Work]) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let timed = |(_, work): &Work| {
        let from = thread_ms();
        work();
        thread_ms() - from
    };
    let rounds: Vec<Vec<f64>> =
        pool.install(|| (0..TIMES).map(|_| works.iter().map(timed).collect()).collect());
    for (i, (name, _)) in works.iter().enumerate() {
        let mut ms: Vec<f64> = rounds.iter().map(|round| round[i]).collect();
        ms.sort_by(f64::total_cmp);
        println!("{name:56} {:8.2} {:8.2} {:8.2}", ms[0], ms[TIMES / 2], ms[TIMES - 1]);
    }
}

/// Ashikhmin's model under some lamps.
fn layer(name: String, scene: &Scene, count: usize, scaling: Scaling) -> Work<'_> {
    let mut shading = Shading::new(Model::Ashikhmin);
    let kinds = lamps(count).into_iter().map(|direction| LightKind::Directional { direction });
    shading.lights = kinds.map(|kind| Light { kind, ..Light::default() }).collect();
    (shading.diffuse.scaling, shading.specular.scaling) = (scaling, scaling);
    shading.warm(scene);
    let tiles: Vec<TileAt> = TileAt::covering(scene.size.rect()).collect();
    let draw = move || {
        tiles.par_iter().for_each(|at| drop(black_box(shading.render_tile(scene, *at))));
    };
    (name, Box::new(draw))
}

/// A matt and a glossy term under a lamp of some light, each times σ of what it reflects.
#[inline(always)]
fn terms(n: Vec3, l: Vec3, light: f32, sigma: impl Fn(f32) -> f32) -> f32 {
    let matt = n.dot(l).max(0.0);
    let shine = n.dot((l + Vec3::Z).normalize_or(Vec3::Z)).max(0.0).powi(32) * matt;
    light * (matt * sigma(matt) + shine * sigma(shine))
}

/// The same loop for three methods.
fn loops<'a>(surface: &'a Surface, curvature: &'a Curvature, count: usize) -> [Work<'a>; 3] {
    let plain = move |x: usize, y: usize| {
        let n = surface.normal(x, y);
        move |l| terms(n, l, 1.0, |_| 1.0)
    };
    let scaled = move |x: usize, y: usize| {
        let n = surface.normal(x, y);
        let exponential = SCALED.exponential(curvature.kappa(x, y, 9.0));
        move |l| terms(n, l, 1.0, |delta| SCALED.sigma_of(exponential, delta))
    };
    let warped = move |x: usize, y: usize| {
        let (n, (k_u, k_v, u)) = (surface.normal(x, y), curvature.principal(x, y));
        let bend = [k_u, k_v].map(|k| lambda(9.0, k));
        move |l| {
            let (seen, growth) = warp(l, u, bend);
            terms(n, seen, growth, |_| 1.0)
        }
    };
    [
        one_loop(format!("loop_plain/{count}"), surface, count, plain),
        one_loop(format!("loop_scaled/{count}"), surface, count, scaled),
        one_loop(format!("loop_warped/{count}"), surface, count, warped),
    ]
}

/// Every pixel under every lamp. `prepare` is asked once for a pixel, what it returns once for a
/// lamp.
fn one_loop<'a, T: Fn(Vec3) -> f32>(
    name: String,
    surface: &'a Surface,
    count: usize,
    prepare: impl Fn(usize, usize) -> T + Sync + 'a,
) -> Work<'a> {
    let lamps = lamps(count);
    let draw = move || {
        let pixel = |x: usize, y: usize| {
            let term = prepare(x, y);
            lamps.iter().map(|l| term(*l)).sum::<f32>()
        };
        drop(black_box(Plane::from_fn(surface.size(), pixel)));
    };
    (name, Box::new(draw))
}
