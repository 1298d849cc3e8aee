//! What a frame of the window costs while the hand moves: α and an anchor of an image layer, and a
//! gradient's end dragged, at every size that the window may show them in; a brush's events until
//! their tiles are flattened; getting a large document ready for a drag. `cargo bench --bench
//! frame`. Peers: the target frame times, 16 ms for a drag and 8 ms for a brush; and a copy of the
//! picture.

mod timing;

use rilievo::document::{LayerTransform, Live, Mesh, MeshFrame, PixelLayer, TransformShape};
use rilievo::math::{PlaneMap, Vec2, vec2, vec3};
use rilievo::paint::{
    Adjust, Brush, Gradient, GradientStop, ImageFilter, PictureSource, PlacedImage, Placement,
};
use rilievo::raster::{Outside, Picture, Plane, Resampling, Tile, TileAt};
use rilievo::surface::Scene;
use rilievo::{
    Anchor, Bend, Color, Content, Document, Layer, Maps, Operator, Progress, Size, Surface,
    TileGrid, flatten,
};
use rilievo_engine::document::DocumentReducer;
use rilievo_engine::math::hash;
use rilievo_engine::paint::LiquifySettings;
use rilievo_program::tools::{PenSample, ToolContext, ToolKind, ToolSettings};
use std::sync::Arc;
use std::time::Instant;
use timing::{frames, on_wave, row};

const HD: Size = Size::new(1920, 1080);
const SQUARE: Size = Size::new(2048, 2048);
const LARGE: Size = Size::new(4096, 4096);
const D_N: Operator = Operator::Normal { alpha: 0.5, beta: 0.0, detail: 0.0 };

/// A ball as large as the canvas allows.
fn ball(size: Size) -> Scene {
    let (middle, radius) = (size.center(), 0.46 * size.width.min(size.height) as f32);
    let at = |x: usize, y: usize| (vec2(x as f32 + 0.5, y as f32 + 0.5) - middle) / radius;
    let normals = Plane::from_fn(size, |x, y| {
        let q = at(x, y);
        let z = (1.0 - q.length_squared()).max(0.0).sqrt();
        if z > 0.0 { vec3(q.x, -q.y, z) } else { vec3(0.0, 0.0, 1.0) }
    });
    let depth =
        Plane::from_fn(size, |x, y| 1.0 - (1.0 - at(x, y).length_squared()).max(0.0).sqrt());
    let maps = Maps { normals, depth, coverage: Plane::full(size, 255) };
    Scene { size, surface: Surface::new(maps).ok().map(Arc::new) }
}

fn photo(size: Size) -> PictureSource {
    let texel = |i: u32, j: u32| [i as u8, j as u8, (i ^ j) as u8, 255];
    let texels = (0..size.height).flat_map(|j| (0..size.width).map(move |i| texel(i, j))).collect();
    PictureSource::new(
        "xor".into(),
        Picture::srgb8(size, texels).expect("one texel a pixel"),
        Adjust::default(),
    )
}

fn image(source: &PictureSource, size: Size, alpha: f32, anchors: &[Vec2]) -> Content {
    Content::Image(Live::new(PlacedImage {
        source: source.clone(),
        placement: Placement::covering(size),
        outside: Outside::Mirror,
        bend: Bend {
            operator: Operator::Normal { alpha, beta: 0.0, detail: 0.0 },
            anchors: anchors.iter().map(|&at| Anchor::pin(at)).collect(),
            ..Bend::default()
        },
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    }))
}

/// A ramp of three colors to a point.
fn ramp(to: Vec2) -> Content {
    let stop = |t: f32, r: u8| GradientStop { t, color: Color { r, g: 90, b: 30, a: 255 } };
    Content::Gradient(Live::new(Gradient {
        from: vec2(400.0, 300.0),
        to,
        stops: vec![stop(0.0, 10), stop(0.4, 200), stop(1.0, 90)],
        operator: D_N,
        filter: ImageFilter::Antialias,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    }))
}

/// ms of each frame of a drag, as the window shows it, a pixel to `step` × `step` of the canvas.
fn drag(size: Size, step: u32, content: impl Fn(f32) -> Content) -> Vec<f64> {
    let ground = Layer::new("ground", Content::Fill(Color { r: 90, g: 90, b: 90, a: 255 }));
    let layers = vec![Arc::new(ground), Arc::new(Layer::new("photo", content(0.0)))];
    let document = Document { surface: ball(size).surface, layers, ..Document::empty(size) };
    let id = document.layers[1].id;
    let mut reduced = DocumentReducer::new(1.0 / step as f32);
    let progress = Progress::default();
    reduced.of(&document).expect("a surface that can be made small");
    let frame = |i: u32| {
        let next = document.with_layer(id, |layer| layer.content = content(i as f32 * 1e-3))?;
        let start = Instant::now();
        divan::black_box(flatten(&reduced.of(&next).ok()?, &progress));
        Some(start.elapsed().as_secs_f64() * 1e3)
    };
    (1..40).filter_map(frame).collect()
}

/// A photo as paint over a ground.
fn photo_painted(size: Size) -> Document {
    let texel = |i: u32, j: u32| [i as u8, j as u8, (i ^ j) as u8, 255];
    let rgba: Vec<u8> =
        (0..size.height).flat_map(|j| (0..size.width).flat_map(move |i| texel(i, j))).collect();
    let tiles =
        TileGrid::from_straight_rgba(&rgba, size.width as usize, size.height as usize, 0, 0);
    let ground = Layer::new("ground", Content::Fill(Color { r: 90, g: 90, b: 90, a: 255 }));
    let photo = Layer::new("photo", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }));
    Document { layers: vec![Arc::new(ground), Arc::new(photo)], ..Document::empty(size) }
}

/// ms from a frame's events (16 samples, 2 px apart) of liquify, 200 px wide, to its flattened
/// tiles.
fn liquified(document: &Document) -> Vec<f64> {
    let liquify = LiquifySettings { size: 200.0, ..LiquifySettings::default() };
    let tools = ToolSettings { liquify, ..ToolSettings::default() };
    let layer = Some(document.layers[1].id);
    let context = ToolContext { layer, ..ToolContext::new(document, &tools) };
    frames(ToolKind::Liquify, &context, |i| PenSample::at(vec2(300.0 + 2.0 * i as f32, 500.0)), 30)
}

/// ms of each frame of a drag of a layer's transform, a pixel to `step` × `step` of the canvas.
fn placed(document: &Document, step: u32, shape: impl Fn(f32) -> TransformShape) -> Vec<f64> {
    let (id, progress) = (document.layers[1].id, Progress::default());
    let mut reduced = DocumentReducer::new(1.0 / step as f32);
    reduced.of(document).expect("nothing that cannot be made small");
    let frame = |i: u32| {
        let transform = Some(LayerTransform { shape: shape(i as f32), filter: Resampling::Smooth });
        let next = document.with_layer(id, |layer| layer.transform = transform)?;
        let start = Instant::now();
        divan::black_box(flatten(&reduced.of(&next).ok()?, &progress));
        Some(start.elapsed().as_secs_f64() * 1e3)
    };
    (1..20).filter_map(frame).collect()
}

fn turned(t: f32) -> TransformShape {
    let map = PlaneMap::rotation(f64::from(t) * 0.3, HD.center());
    TransformShape::Matrix(map.coefficients().expect("a turn is affine"))
}

/// A point of 4 × 4 dragged.
fn meshed(t: f32) -> TransformShape {
    let even = Mesh::even(4, 4, MeshFrame::of(HD)).expect("4 × 4 is a mesh");
    let mut points = even.points().to_vec();
    points[5] += vec2(4.0 * t, 2.0 * t);
    TransformShape::Mesh(Arc::new(even.with_points(points).expect("points near the canvas")))
}

/// Half-transparent paint layers, every tile its own.
fn painted(size: Size, count: u32) -> Vec<Arc<Layer>> {
    let layer = |i: u32| {
        let mut tiles = TileGrid::default();
        tiles.reserve(size.rect());
        for (k, at) in TileAt::covering(size.rect()).enumerate() {
            let a = 64 + (hash::mix(i << 20 ^ k as u32) & 127) as u8;
            let bytes = [a / 2, a / 3, a, a].repeat(64 * 64);
            tiles.set(at, Tile::from_bytes(bytes).map(Arc::new));
        }
        let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles };
        Arc::new(Layer::new(format!("paint {i}"), Content::Pixels(pixels)))
    };
    (0..count).map(layer).collect()
}

/// ms from a frame's events (16 samples, 2 px apart) to its flattened tiles: D_n, radius 64.
fn strokes() -> Vec<f64> {
    let document = Document {
        surface: ball(SQUARE).surface,
        layers: painted(SQUARE, 10),
        ..Document::empty(SQUARE)
    };
    let brush = Brush { size: 128.0, ..Brush::default() };
    let tools = ToolSettings { operator: D_N, ..ToolSettings::with_brush(brush) };
    let layer = Some(document.layers[5].id);
    let context = ToolContext { layer, ..ToolContext::new(&document, &tools) };
    frames(ToolKind::Brush, &context, on_wave, 44)
}

/// ms to make 20 layers of 4096² small: all at once, and the longest of the parts that are made one
/// by one.
fn first_small(step: u32) -> [f64; 2] {
    let document = Document {
        surface: ball(LARGE).surface,
        layers: painted(LARGE, 20),
        ..Document::empty(LARGE)
    };
    let timed = |work: &mut dyn FnMut() -> bool| {
        let start = Instant::now();
        let more = divan::black_box(work());
        (start.elapsed().as_secs_f64() * 1e3, more)
    };
    let mut at_once = DocumentReducer::new(1.0 / step as f32);
    let all = timed(&mut || at_once.of(&document).is_ok()).0;
    let mut parts = DocumentReducer::new(1.0 / step as f32);
    let mut longest: f64 = 0.0;
    loop {
        let (ms, more) = timed(&mut || parts.prepare(&document));
        longest = longest.max(ms);
        if !more {
            return [all, longest];
        }
    }
}

fn main() {
    if std::env::args().any(|arg| arg == "--test" || arg == "--list") {
        return;
    }
    println!("ms a frame{:46} {:>8} {:>8} {:>8}", "", "least", "middle", "9 of 10");
    for size in [HD, SQUARE, LARGE] {
        let (source, middle) = (photo(HD), size.center());
        for step in [1, 2, 4, 8] {
            let alpha = |t: f32| image(&source, size, 0.4 + t, &[middle]);
            row(
                &format!("α of an image, {size}, one pixel in {step} × {step}"),
                drag(size, step, alpha),
            );
            if size == HD {
                let anchor = |t: f32| {
                    image(&source, size, 0.5, &[middle, middle + vec2(300.0 + 900.0 * t, 120.0)])
                };
                row(
                    &format!("an anchor of two, {size}, one pixel in {step} × {step}"),
                    drag(size, step, anchor),
                );
                let end = |t: f32| ramp(vec2(1500.0 + 300.0 * t, 800.0));
                row(
                    &format!("a gradient's end, {size}, one pixel in {step} × {step}"),
                    drag(size, step, end),
                );
            }
        }
    }
    let pixels = vec![[9_u8; 4]; HD.area()];
    let copy = || {
        let start = Instant::now();
        divan::black_box(divan::black_box(&pixels).clone());
        start.elapsed().as_secs_f64() * 1e3
    };
    row(&format!("a copy of {HD}"), (0..20).map(|_| copy()).collect());
    row("brush: D_n, radius 64, 2048² of 10 layers", strokes());
    let document = photo_painted(HD);
    row("liquify, 200 px wide, 1920 × 1080", liquified(&document));
    for step in [1, 2, 4, 8] {
        row(
            &format!("a point of a mesh, {HD}, one pixel in {step} × {step}"),
            placed(&document, step, meshed),
        );
        row(
            &format!("a turn by a matrix, {HD}, one pixel in {step} × {step}"),
            placed(&document, step, turned),
        );
    }
    for step in [2, 4, 8] {
        let [all, longest] = first_small(step);
        println!(
            "20 layers of 4096² made small, {step}: {all:.1} ms at once, {longest:.1} at most in parts"
        );
    }
}
