//! The brush: strokes of dabs, flat and bent, in ns per covered pixel on one thread, beside libmypaint's flat dabs.
//! `cargo bench --bench brush`; quote ratios from one run, never times from another day.
//!
//! A stroke's cost is all of it: its dabs found, what they reach, their coverage, laid on the tiles and quantised. The peer
//! (benches/peers/libmypaint_dabs.c) is built with `cc` where libmypaint's headers are; else it is skipped, aloud.

use rilievo::math::{Size, Vec2, srgb::Color, vec2, vec3};
use rilievo::paint::{Brush, Sample, Stroke, stroke};
use rilievo::raster::{Plane, Tile, TileAt};
use rilievo::surface::{Maps, Operator, Scene, Surface};
use std::process::Command;
use std::sync::{Arc, LazyLock};
use std::time::Instant;

const SIZE: Size = Size::new(2048, 2048);
const DABS: usize = 128;
const RADII: [f32; 3] = [32.0, 64.0, 128.0];

const OPERATORS: [(&str, Operator); 4] = [
    ("flat", Operator::None),
    ("D_n", Operator::Normal { alpha: 0.5, beta: 1.5, detail: 0.0 }),
    ("D_p", Operator::Depth { gamma: 1.0 }),
    ("D_r", Operator::Reflection { alpha: 0.5, detail: 0.0 }),
];

/// A ball that nearly fills the canvas, with bumps.
static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let at = |x: usize, y: usize| (vec2(x as f32, y as f32) + 0.5 - SIZE.center()) / 1000.0;
    let height = |p: Vec2| (1.0 - p.length_squared()).max(0.0).sqrt();
    let normals = Plane::from_fn(SIZE, |x, y| {
        let p = at(x, y);
        vec3(p.x + 0.05 * (40.0 * p.y).sin(), -p.y + 0.05 * (30.0 * p.x).cos(), height(p).max(0.01))
    });
    let depth = Plane::from_fn(SIZE, |x, y| 1.0 - height(at(x, y)));
    let coverage = Plane::from_fn(SIZE, |x, y| if at(x, y).length() < 1.0 { 255 } else { 0 });
    Scene { size: SIZE, surface: Surface::new(Maps { normals, depth, coverage }).ok().map(Arc::new) }
});

/// Where the `i`th dab stands: 14 px further along a circle of 700 px.
fn on_circle(i: f32) -> Sample {
    Sample::at(SIZE.center() + 700.0 * Vec2::from_angle(0.02 * i))
}

/// A fresh stroke: nothing is found yet.
fn circle(operator: Operator, radius: f32) -> Arc<Stroke> {
    let samples = (0..=8 * (DABS - 1)).map(|i| on_circle(i as f32 / 8.0)).collect();
    let spacing = 14.0 / (2.0 * radius);
    let brush = Brush { size: 2.0 * radius, spacing, flow: 0.4, hardness: 0.5, ..Brush::default() };
    Arc::new(Stroke::new(brush, operator, Color { r: 230, g: 128, b: 26, a: 255 }, samples))
}

fn paint(stroke: Arc<Stroke>) -> Vec<Option<Tile>> {
    let tiles = TileAt::covering(stroke.bounds(&SCENE)).filter(|&at| stroke.touches(&SCENE, at));
    let strokes = [stroke.clone()];
    tiles.map(|at| stroke::render_tile(&strokes, &SCENE, at)).collect()
}

/// Pixels that the dabs of a stroke cover, dab by dab.
fn covered_px(operator: Operator, radius: f32) -> usize {
    let dab = |i| {
        let brush = Brush { size: 2.0 * radius, ..Brush::default() };
        let tiles = paint(Arc::new(Stroke::new(brush, operator, Color::WHITE, vec![on_circle(i as f32)])));
        let bytes = tiles.iter().flatten().flat_map(|tile| tile.bytes().chunks_exact(4));
        bytes.filter(|p| p[3] > 0).count()
    };
    (0..DABS).map(dab).sum()
}

#[divan::bench(args = OPERATORS.map(|o| o.0), consts = [32, 64, 128], sample_count = 15, sample_size = 1)]
fn stroke_of_dabs<const RADIUS: usize>(bencher: divan::Bencher, operator: &str) {
    let (_, operator) = OPERATORS.into_iter().find(|o| o.0 == operator).expect("an operator of the table");
    let bencher = bencher.counter(divan::counter::ItemsCount::new(covered_px(operator, RADIUS as f32)));
    bencher.with_inputs(|| circle(operator, RADIUS as f32)).bench_local_values(paint);
}

/// ns per covered pixel: the best of the strokes, which other programs disturbed least.
fn ns_per_px(operator: Operator, radius: f32) -> f64 {
    let covered = covered_px(operator, radius) as f64;
    let time = |_| {
        let stroke = circle(operator, radius);
        let start = Instant::now();
        divan::black_box(paint(stroke));
        start.elapsed().as_secs_f64() * 1e9 / covered
    };
    (0..15).map(time).fold(f64::INFINITY, f64::min)
}

/// ns per covered pixel of libmypaint's dabs, by radius; `None` where it cannot be built.
fn peer() -> Option<Vec<f64>> {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/peers/libmypaint_dabs.c");
    let program = std::env::temp_dir().join(format!("libmypaint_dabs_{}", std::process::id()));
    let flags = Command::new("pkg-config").args(["--cflags", "--libs", "libmypaint"]).output().ok()?;
    let flags = String::from_utf8_lossy(&flags.stdout).into_owned();
    let mut cc = Command::new("cc");
    cc.args(["-O2", source, "-o"]).arg(&program).args(flags.split_whitespace()).arg("-lm");
    let is_built = cc.output().ok()?.status.success();
    let run = is_built.then(|| Command::new(&program).args(RADII.map(|r| r.to_string())).output());
    let _ = std::fs::remove_file(&program);
    let run = run?.ok()?;
    let ns: Vec<f64> = String::from_utf8_lossy(&run.stdout).lines().filter_map(|n| n.parse().ok()).collect();
    (ns.len() == RADII.len()).then_some(ns)
}

fn main() {
    LazyLock::force(&SCENE);
    divan::main();
    if std::env::args().any(|arg| arg == "--test" || arg == "--list") {
        return;
    }
    let peer = peer();
    println!("\nns per covered pixel, one thread        r = 32     r = 64    r = 128   (ratio to the peer's)");
    match &peer {
        Some(ns) => println!("{:32} {:10.2} {:10.2} {:10.2}", "libmypaint, flat", ns[0], ns[1], ns[2]),
        None => println!("libmypaint: skipped, cc with libmypaint's headers is not here"),
    }
    for (name, operator) in OPERATORS {
        let ns = RADII.map(|radius| ns_per_px(operator, radius));
        let ratios = peer.as_ref().map_or(String::new(), |peer| {
            let ratios: Vec<String> = ns.iter().zip(peer).map(|(a, b)| format!("{:.2}", a / b)).collect();
            ratios.join("  ")
        });
        println!("{name:32} {:10.2} {:10.2} {:10.2}   {ratios}", ns[0], ns[1], ns[2]);
    }
}
