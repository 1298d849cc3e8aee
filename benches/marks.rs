//! What other marks than the round brush cost: a frame of tips, grain and retouching brushes;
//! fills; ten thousand short strokes; the hundredth layer. `cargo bench --bench marks`. Peers: a
//! frame of 16 ms; the round brush in the same run.

mod timing;

use rilievo::document::{Live, PixelLayer, PreparedDocument, StrokeList};
use rilievo::math::{Vec2, vec2, vec3};
use rilievo::paint::{
    Adjust, Bristles, Brush, BrushGrain, BrushMode, DualBrush, DualSettings, Fill, Noise, Pickup,
    PictureSource, Sample, Stroke, Tip,
};
use rilievo::raster::{Picture, Plane, Tile, TileAt};
use rilievo::surface::{CanvasPart, Scene};
use rilievo::{
    Color, Content, Document, Layer, Maps, Operator, Progress, Size, Surface, TileGrid, flatten,
};
use rilievo_engine::math::hash;
use rilievo_program::session::actions::{Action, LayerAction, NewLayer};
use rilievo_program::session::{OpenDocument, Session};
use rilievo_program::tools::{ToolContext, ToolKind, ToolSettings};
use std::sync::Arc;
use std::time::Instant;
use timing::{on_wave, row};

const CANVAS: Size = Size::new(2048, 2048);
const LARGE: Size = Size::new(4096, 4096);
const D_N: Operator = Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 };

/// A ball that nearly fills the canvas; beyond it there is no surface.
fn ball(size: Size) -> Scene {
    let at = |x: usize, y: usize| {
        (vec2(x as f32 + 0.5, y as f32 + 0.5) - size.center()) / (0.48 * size.width as f32)
    };
    let height = |p: Vec2| (1.0 - p.length_squared()).max(0.0).sqrt();
    let normals = Plane::from_fn(size, |x, y| {
        let p = at(x, y);
        vec3(p.x, -p.y, height(p).max(0.01))
    });
    let depth = Plane::from_fn(size, |x, y| 1.0 - height(at(x, y)));
    let coverage = Plane::from_fn(size, |x, y| if at(x, y).length() < 1.0 { 255 } else { 0 });
    Scene { size, surface: Surface::new(Maps { normals, depth, coverage }).ok().map(Arc::new) }
}

/// Half-transparent paint layers, every tile its own.
fn painted(size: Size, count: u32) -> Vec<Arc<Layer>> {
    let layer = |i: u32| {
        let mut tiles = TileGrid::default();
        tiles.reserve(size.rect());
        for (k, at) in TileAt::covering(size.rect()).enumerate() {
            let pixel = |p: u32| {
                let a = 64 + (hash::mix(i << 26 ^ (k as u32) << 12 ^ p) & 127) as u8;
                [a / 2, a / 3, a, a]
            };
            tiles.set(at, Tile::from_bytes((0..64 * 64).flat_map(pixel).collect()).map(Arc::new));
        }
        let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles };
        Arc::new(Layer::new(format!("paint {i}"), Content::Pixels(pixels)))
    };
    (0..count).map(layer).collect()
}

/// Brushes by the property that is measured.
fn brushes() -> Vec<(&'static str, Brush)> {
    let round = Brush { size: 128.0, ..Brush::default() };
    let with = |tip: Tip| Brush { tip, ..round.clone() };
    let mode = |mode: BrushMode| Brush { mode, ..round.clone() };
    let texel = |i: u32, j: u32| [(i * 5) as u8, (j * 3) as u8, 90, (i ^ j) as u8];
    let texels = (0..200).flat_map(|j| (0..200).map(move |i| texel(i, j))).collect();
    let leaf = Picture::srgb8(Size::new(200, 200), texels).expect("one texel a pixel");
    vec![
        ("round", round.clone()),
        ("ellipse", with(Tip::Ellipse { ratio: 0.3 })),
        ("square", with(Tip::Square { ratio: 0.5 })),
        ("bristles", with(Tip::Bristles(Bristles::default()))),
        ("noise", with(Tip::Noise(Noise::default()))),
        ("picture", with(Tip::Picture(PictureSource::new("leaf".into(), leaf, Adjust::default())))),
        ("dual", Brush { dual: Some(Arc::new(DualBrush::default())), ..round.clone() }),
        ("dual, scattered", Brush { dual: Some(Arc::new(scattered())), ..round.clone() }),
        ("grain", Brush { grain: Some(BrushGrain::default()), ..round.clone() }),
        (
            "picks paint up",
            Brush { pickup: Pickup { amount: 0.5, length: 0.9, radius: 1.0 }, ..round.clone() },
        ),
        ("smudge", mode(BrushMode::Smudge { length: 0.7 })),
        ("blur", mode(BrushMode::Blur { width: 0.5 })),
        ("clone", mode(BrushMode::Clone { aligned: true, picture: false })),
    ]
}

/// Many small dabs beside the way, which the first tip shows where they are.
fn scattered() -> DualBrush {
    let settings = DualSettings { size: 0.2, spacing: 0.5, scatter: 1.0, ..DualSettings::DEFAULT };
    DualBrush { settings, ..DualBrush::default() }
}

/// ms from a frame's events (16 samples) to its flattened tiles.
fn frames(document: &Document, brush: &Brush, operator: Operator) -> Vec<f64> {
    let layer = Some(document.layers[5].id);
    let clone_offset = Some(vec2(-300.0, 40.0));
    let tools = ToolSettings { operator, ..ToolSettings::with_brush(brush.clone()) };
    let context = ToolContext { layer, clone_offset, ..ToolContext::new(document, &tools) };
    timing::frames(ToolKind::Brush, &context, on_wave, 40)
}

/// ms of some runs.
fn runs(count: usize, mut work: impl FnMut()) -> Vec<f64> {
    let run = |_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..count).map(run).collect()
}

/// A fill of a blank canvas, and of blots of two grays.
fn fills() {
    let side = LARGE.width as usize;
    let is_island = |x: usize, y: usize| hash::unit(3, (x / 24) as u32, (y / 24) as u32) < 0.3;
    let gray = |i: usize| if is_island(i % side, i / side) { 40 } else { 200 };
    let rgba: Vec<u8> = (0..LARGE.area()).flat_map(|i| [gray(i), gray(i), gray(i), 255]).collect();
    let blots = TileGrid::from_straight_rgba(&rgba, side, side, 0, 0);
    let start = (0..4096)
        .map(|x| vec2(x as f32, 2000.0))
        .find(|at| blots.pixel(at.x as i32, 2000)[0] == 200);
    let start = start.unwrap_or(Vec2::ZERO);
    for gap_px in [0.0, 4.0, 32.0] {
        let fill = Fill { gap_px, ..Fill::default() };
        for (name, picture) in [("blank", TileGrid::default()), ("blots", blots.clone())] {
            let read = |at: TileAt| picture.tile(at).cloned();
            let work = || drop(divan::black_box(fill.from(start, LARGE, &CanvasPart::Whole, read)));
            row(&format!("a fill of 4096², {name}, gaps of {gap_px} px closed"), runs(5, work));
        }
    }
}

/// Strokes of ten samples, brush 8, rendered for the first time.
fn many_strokes(
    surface: Option<Arc<Surface>>,
    count: u32,
    step_px: f32,
    operator: Operator,
) -> f64 {
    let random = |i: u32, j: u32| hash::unit(7, i, j);
    let size = CANVAS;
    let stroke = |i: u32| {
        let start = vec2(size.width as f32 * random(i, 0), size.height as f32 * random(i, 1));
        let way = step_px * Vec2::from_angle(std::f32::consts::TAU * random(i, 2));
        let samples = (0..10).map(|j| Sample::at(start + way * j as f32)).collect();
        Arc::new(Stroke::new(
            Brush { size: 8.0, ..Brush::default() },
            operator,
            Color::BLACK,
            samples,
        ))
    };
    let list = StrokeList { strokes: (0..count).map(stroke).collect() };
    let layer = Arc::new(Layer::new("strokes", Content::Strokes(Live::new(list))));
    let document = Document { surface, layers: vec![layer], ..Document::empty(size) };
    let start = Instant::now();
    divan::black_box(flatten(&document, &Progress::default()));
    start.elapsed().as_secs_f64()
}

/// µs to add a layer to a document that has so many, least of five.
fn added_layer(before: usize) -> f64 {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("new", Document::empty(CANVAS), None));
    let add = Action::Layer(LayerAction::Add { kind: NewLayer::Paint });
    let mut add = || {
        let start = Instant::now();
        add.apply(&mut session).expect("no file is touched");
        let document = session.shown_document().expect("one is open");
        divan::black_box(PreparedDocument::new(document, &Progress::default()));
        start.elapsed().as_secs_f64() * 1e6
    };
    for _ in 0..before {
        add();
    }
    (0..5).map(|_| add()).fold(f64::INFINITY, f64::min)
}

fn main() {
    if std::env::args().any(|arg| arg == "--test" || arg == "--list") {
        return;
    }
    println!(
        "ms a frame of 16 samples, 128 px, 2048² of ten layers    {:>8} {:>8} {:>8}",
        "least", "middle", "9 of 10"
    );
    let scene = ball(CANVAS);
    let document = Document {
        surface: scene.surface.clone(),
        layers: painted(CANVAS, 10),
        ..Document::empty(CANVAS)
    };
    for (name, brush) in brushes() {
        row(&format!("{name}, flat"), frames(&document, &brush, Operator::None));
        row(&format!("{name}, D_n"), frames(&document, &brush, D_N));
    }
    println!("\nms{:55} {:>8} {:>8} {:>8}", "", "least", "middle", "9 of 10");
    fills();
    println!();
    for (name, operator) in [("flat", Operator::None), ("D_n", D_N)] {
        let [short, long] = [(10_000, 6.0), (1_000, 200.0)].map(|(count, step_px)| {
            let run = |_| many_strokes(scene.surface.clone(), count, step_px, operator);
            (0..3).map(run).fold(f64::INFINITY, f64::min)
        });
        println!("{name}: 10,000 strokes of 54 px {short:.2} s, 1,000 of 1800 px {long:.2} s");
    }
    let added = [0, 99, 399].map(added_layer);
    println!(
        "a layer added and made ready, µs: the first {:.0}, the 100th {:.0}, the 400th {:.0}",
        added[0], added[1], added[2]
    );
}
