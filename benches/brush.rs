//! The brush: strokes of dabs, flat and bent, in ns per covered pixel on one thread, next to
//! libmypaint's flat dabs. `cargo bench --bench brush`; quote ratios from one run, never times from
//! another day.
//!
//! Then what a painter feels: a frame's worth of events on a large document, from the pen to the
//! flattened tiles, as the stroke grows; and moving one of a thousand strokes.
//!
//! The cost of a stroke includes finding its dabs and their reach, computing coverage, painting the
//! tiles and quantizing. The peer (benches/peers/libmypaint_dabs.c) is built with `cc` if
//! libmypaint's headers are installed; otherwise a message says that it is skipped.

use rilievo::document::{Live, PixelLayer, PreparedDocument, StrokeList, diff};
use rilievo::math::{Vec2, vec2, vec3};
use rilievo::paint::{Brush, Sample, Stroke};
use rilievo::raster::{Plane, Tile, TileAt};
use rilievo::surface::Scene;
use rilievo::{Color, Content, Document, Layer, Maps, Operator, Progress, Size, Surface, TileGrid};
use rilievo_engine::math::hash;
use rilievo_engine::paint::stroke;
use rilievo_program::tools::{self, Outcome, PenSample, ToolContext, ToolKind, ToolSettings};
use std::process::Command;
use std::sync::{Arc, LazyLock};
use std::time::Instant;

const SIZE: Size = Size::new(2048, 2048);
const DABS: usize = 128;
/// Inking is most strokes: small brushes first.
const RADII: [f32; 6] = [4.0, 8.0, 12.0, 32.0, 64.0, 128.0];

/// Distance between dabs, px: a fifth of the radius for small brushes, as in real brushes.
fn step_px(radius: f32) -> f32 {
    if radius < 32.0 { 0.2 * radius } else { 14.0 }
}

const OPERATORS: [(&str, Operator); 5] = [
    ("flat", Operator::None),
    ("D_n", Operator::Normal { alpha: 0.5, beta: 1.5, detail: 0.0 }),
    ("D_p", Operator::Depth { gamma: 1.0 }),
    ("D_r", Operator::Reflection { alpha: 0.5, detail: 0.0 }),
    ("D_s", Operator::Surface { amount: 1.0, smooth: 0.0 }),
];

/// A ball that nearly fills the canvas, with bumps.
static SCENE: LazyLock<Scene> = LazyLock::new(|| ball(SIZE));

fn ball(size: Size) -> Scene {
    let radius = 1000.0 / 2048.0 * size.width as f32;
    let at = |x: usize, y: usize| (vec2(x as f32, y as f32) + 0.5 - size.center()) / radius;
    let height = |p: Vec2| (1.0 - p.length_squared()).max(0.0).sqrt();
    let normals = Plane::from_fn(size, |x, y| {
        let p = at(x, y);
        vec3(p.x + 0.05 * (40.0 * p.y).sin(), -p.y + 0.05 * (30.0 * p.x).cos(), height(p).max(0.01))
    });
    let depth = Plane::from_fn(size, |x, y| 1.0 - height(at(x, y)));
    let coverage = Plane::from_fn(size, |x, y| if at(x, y).length() < 1.0 { 255 } else { 0 });
    Scene { size, surface: Surface::new(Maps { normals, depth, coverage }).ok().map(Arc::new) }
}

/// Position of the `i`th dab of a radius: a step further along a circle of 700 px.
fn on_circle(i: f32, radius: f32) -> Sample {
    Sample::at(SIZE.center() + 700.0 * Vec2::from_angle(step_px(radius) / 700.0 * i))
}

/// A new stroke: no dab is found yet.
fn circle(operator: Operator, radius: f32) -> Arc<Stroke> {
    // A pen reports every few px.
    let samples_px = if radius < 32.0 { 6.0 } else { 1.75 };
    let per_dab = step_px(radius) / samples_px;
    let samples = (0..=(per_dab * (DABS - 1) as f32) as usize)
        .map(|i| on_circle(i as f32 / per_dab, radius))
        .collect();
    let spacing = step_px(radius) / (2.0 * radius);
    let brush = Brush { size: 2.0 * radius, spacing, flow: 0.4, hardness: 0.5, ..Brush::default() };
    Arc::new(Stroke::new(brush, operator, Color { r: 230, g: 128, b: 26, a: 255 }, samples))
}

fn paint(stroke: Arc<Stroke>) -> Vec<Option<Tile>> {
    let tiles = TileAt::covering(stroke.bounds(&SCENE)).filter(|&at| stroke.can_touch(&SCENE, at));
    let strokes = [stroke.clone()];
    tiles.map(|at| stroke::render_tile(&strokes, &SCENE, at)).collect()
}

/// Pixels that the dabs of a stroke cover, dab by dab.
fn covered_px(operator: Operator, radius: f32) -> usize {
    let dab = |i| {
        let brush = Brush { size: 2.0 * radius, ..Brush::default() };
        let tiles = paint(Arc::new(Stroke::new(
            brush,
            operator,
            Color::WHITE,
            vec![on_circle(i as f32, radius)],
        )));
        let bytes = tiles.iter().flatten().flat_map(|tile| tile.bytes().chunks_exact(4));
        bytes.filter(|p| p[3] > 0).count()
    };
    (0..DABS).map(dab).sum()
}

#[divan::bench(args = OPERATORS.map(|o| o.0), consts = [32, 64, 128], sample_count = 15, sample_size = 1)]
fn stroke_of_dabs<const RADIUS: usize>(bencher: divan::Bencher, operator: &str) {
    let (_, operator) =
        OPERATORS.into_iter().find(|o| o.0 == operator).expect("an operator of the table");
    let bencher =
        bencher.counter(divan::counter::ItemsCount::new(covered_px(operator, RADIUS as f32)));
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
    let flags =
        Command::new("pkg-config").args(["--cflags", "--libs", "libmypaint"]).output().ok()?;
    let flags = String::from_utf8_lossy(&flags.stdout).into_owned();
    let mut cc = Command::new("cc");
    cc.args(["-O2", source, "-o"]).arg(&program).args(flags.split_whitespace()).arg("-lm");
    let is_built = cc.output().ok()?.status.success();
    let run = is_built.then(|| Command::new(&program).args(RADII.map(|r| r.to_string())).output());
    let _ = std::fs::remove_file(&program);
    let run = run?.ok()?;
    let ns: Vec<f64> =
        String::from_utf8_lossy(&run.stdout).lines().filter_map(|n| n.parse().ok()).collect();
    (ns.len() == RADII.len()).then_some(ns)
}

fn main() {
    LazyLock::force(&SCENE);
    divan::main();
    if std::env::args().any(|arg| arg == "--test" || arg == "--list") {
        return;
    }
    let peer = peer();
    let columns = |values: &[f64]| values.iter().map(|v| format!("{v:8.2}")).collect::<String>();
    println!("\nns per covered pixel, one thread, by radius, and ratios to the peer's");
    println!("{:24}{}", "", RADII.map(|r| format!("{r:8}")).concat());
    match &peer {
        Some(ns) => println!("{:24}{}", "libmypaint, flat", columns(ns)),
        None => println!("libmypaint: skipped, cc with libmypaint's headers is not here"),
    }
    for (name, operator) in OPERATORS {
        let ns = RADII.map(|radius| ns_per_px(operator, radius));
        let ratios =
            peer.as_ref().map(|peer| ns.iter().zip(peer).map(|(a, b)| a / b).collect::<Vec<f64>>());
        println!("{name:24}{}   {}", columns(&ns), columns(&ratios.unwrap_or_default()));
    }
    frames();
    one_of_a_thousand();
}

/// The same ball on a large canvas.
const LARGE: Size = Size::new(4096, 4096);
static LARGE_SCENE: LazyLock<Scene> = LazyLock::new(|| ball(LARGE));

/// Rows of tiles that the layers of the large document are painted in: where the strokes go.
const BAND: std::ops::Range<i32> = 26..38;

/// Twenty half-transparent paint layers, every tile its own.
fn layers() -> Document {
    let layer = |i: u32| {
        let mut tiles = TileGrid::default();
        tiles.reserve(LARGE.rect());
        for (row, col) in BAND.flat_map(|row| (0..64).map(move |col| (row, col))) {
            let tile = |p: u32| {
                let a = 64
                    + (hash::mix(p ^ i << 12 ^ (row as u32) << 20 ^ (col as u32) << 26) & 127)
                        as u8;
                [a / 2, a / 3, a, a]
            };
            let bytes = (0..64 * 64).flat_map(tile).collect();
            tiles.set(TileAt::new(col, row), Tile::from_bytes(bytes).map(Arc::new));
        }
        let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles };
        Arc::new(Layer::new(format!("paint {i}"), Content::Pixels(pixels)))
    };
    Document {
        surface: LARGE_SCENE.surface.clone(),
        layers: (0..20).map(layer).collect(),
        ..Document::empty(LARGE)
    }
}

/// Samples a frame at 1,000 a second, and how far apart the hand puts them at 2,000 px a second.
const FRAME: usize = 16;
const HAND_PX: f32 = 2.0;

/// The `i`th sample of a wavy line through the band.
fn on_wave(i: usize) -> PenSample {
    let x = 200.0 + HAND_PX * i as f32;
    let sample = Sample {
        time_secs: i as f32 / 1000.0,
        ..Sample::at(vec2(x, 2048.0 + 120.0 * (x / 150.0).sin()))
    };
    PenSample { sample, ..PenSample::at(Vec2::ZERO) }
}

/// ms from a frame's events to its flattened tiles: painted, found, made ready, flattened.
fn frame_times(document: &Document, layer: usize, operator: Operator) -> Vec<[f64; 4]> {
    let brush = Brush { size: 128.0, ..Brush::default() };
    let tools = ToolSettings { operator, ..ToolSettings::with_brush(brush) };
    let layer = Some(document.layers[layer].id);
    let context = ToolContext { layer, ..ToolContext::new(document, &tools) };
    let (gesture, _) = tools::press(ToolKind::Brush, &context, on_wave(0));
    let mut gesture = gesture.expect("the layer takes paint");
    let progress = Progress::default();
    let picture = PreparedDocument::new(document, &progress).expect("nobody cancels");
    let mut picture = picture
        .flatten_tiles(&TileGrid::default(), &picture.all_tiles(), &progress)
        .expect("nobody cancels");
    let mut shown = document.clone();
    let frame = |frame: usize| {
        let pens: Vec<PenSample> = (1..=FRAME).map(|i| on_wave(frame * FRAME + i)).collect();
        let start = Instant::now();
        let Outcome::Preview(next) = gesture.drag(&pens) else { return None };
        let painted = start.elapsed();
        let tiles: Vec<TileAt> = diff(&shown, &next).into_iter().collect();
        let found = start.elapsed();
        let prepared = PreparedDocument::new(&next, &progress)?;
        let ready = start.elapsed();
        picture = prepared.flatten_tiles(&picture, &tiles, &progress)?;
        let flattened = start.elapsed();
        shown = next;
        let steps = [painted, found - painted, ready - found, flattened - ready];
        Some(steps.map(|step| step.as_secs_f64() * 1e3))
    };
    (0..100).map_while(frame).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn frames() {
    println!(
        "\nms a frame of 16 samples, radius 64, 4096² of 20 layers   painted  found  ready  flattened  in all   \
         9 of 10 within   first and last fifth"
    );
    let mut document = layers();
    let strokes = Layer::new("strokes", Content::Strokes(Live::new(StrokeList::default())));
    document.layers[19] = Arc::new(strokes);
    for (name, layer, operator) in [
        ("flat, paint layer", 10, Operator::None),
        ("D_n, paint layer", 10, OPERATORS[1].1),
        ("D_n, stroke layer", 19, OPERATORS[1].1),
    ] {
        let times = frame_times(&document, layer, operator);
        let step = |i: usize| median(times.iter().map(|steps| steps[i]).collect());
        let mut all: Vec<f64> = times.iter().map(|steps| steps.iter().sum()).collect();
        let fifth = all.len() / 5;
        let (first, last) =
            (median(all[..fifth].to_vec()), median(all[all.len() - fifth..].to_vec()));
        all.sort_by(f64::total_cmp);
        let (middle, most) = (all[all.len() / 2], all[all.len() * 9 / 10]);
        println!(
            "{name:56} {:8.2} {:6.2} {:6.2} {:10.2} {middle:7.2} {most:16.2} {first:13.2} {last:6.2}",
            step(0),
            step(1),
            step(2),
            step(3)
        );
    }
}

/// A stroke layer of a thousand strokes, one of which is moved: how much is painted again, and how
/// long it takes.
fn one_of_a_thousand() {
    let random = |i, j| hash::unit(7, i, j);
    let stroke = |i: u32, by: Vec2| {
        let start = vec2(3900.0 * random(i, 0), 3900.0 * random(i, 1)) + by;
        let samples = (0..5)
            .map(|j| Sample::at(start + 40.0 * Vec2::from_angle(6.0 * random(i, 2)) * j as f32))
            .collect();
        Arc::new(Stroke::new(
            Brush { size: 48.0, ..Brush::default() },
            OPERATORS[1].1,
            Color::BLACK,
            samples,
        ))
    };
    let list = StrokeList { strokes: (0..1000).map(|i| stroke(i, Vec2::ZERO)).collect() };
    let layer = Layer::new("strokes", Content::Strokes(Live::new(list)));
    let id = layer.id;
    let document = Document {
        surface: LARGE_SCENE.surface.clone(),
        layers: vec![Arc::new(layer)],
        ..Document::empty(LARGE)
    };
    let progress = Progress::default();
    let start = Instant::now();
    let prepared = PreparedDocument::new(&document, &progress).expect("nobody cancels");
    let picture = prepared
        .flatten_tiles(&TileGrid::default(), &prepared.all_tiles(), &progress)
        .expect("nobody cancels");
    let whole = start.elapsed().as_secs_f64() * 1e3;
    let move_one = |i: u32| {
        let moved = stroke(i, vec2(20.0, 10.0));
        let start = Instant::now();
        let next = document.with_strokes(id, |strokes| {
            *strokes.get_mut(i as usize)? = moved.clone();
            Some(())
        })?;
        let tiles: Vec<TileAt> = diff(&document, &next).into_iter().collect();
        let prepared = PreparedDocument::new(&next, &progress)?;
        divan::black_box(prepared.flatten_tiles(&picture, &tiles, &progress)?);
        Some((start.elapsed().as_secs_f64() * 1e3, tiles.len() as f64))
    };
    let moved: Vec<(f64, f64)> = (0..50).filter_map(|i| move_one(i * 17)).collect();
    let (ms, tiles) =
        (median(moved.iter().map(|m| m.0).collect()), median(moved.iter().map(|m| m.1).collect()));
    println!(
        "\na thousand strokes on 4096²: {whole:.0} ms for all; one moved: {ms:.2} ms, {tiles:.0} of 4096 tiles"
    );
}
