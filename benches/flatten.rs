//! Flattening 20 semi-transparent paint layers of 3840 × 2160, next to `tiny_skia::draw_pixmap` of
//! the same layers and a plain byte loop, in the same run; the price of each blend mode; and scenes
//! of few and of many contours.
//!
//! Read ratios, not times: `cargo bench --bench flatten`. Throughput counts pixels times layers, so
//! ns per pixel and layer is 1 / (Gitem/s).

use divan::{Bencher, counter::ItemsCount};
use rilievo::document::{DerivedMask, LayerMask, Live, PixelLayer, PreparedDocument};
use rilievo::math::{Vec3, vec2, vec3};
use rilievo::paint::{Gradient, GradientStop, ImageFilter};
use rilievo::raster::{Plane, Tile, TileAt};
use rilievo::shading::{Model, Shading};
use rilievo::{
    BlendMode, Color, Content, Document, Layer, Maps, Operator, Progress, Size, Surface, TileGrid,
};
use rilievo_engine::math::hash;
use std::sync::{Arc, LazyLock};
use tiny_skia::{Pixmap, PixmapPaint, Transform};

const SIZE: Size = Size::new(3840, 2160);
const LAYERS: usize = 20;

fn main() {
    divan::main();
}

/// Straight RGBA noise in soft patches, no pixel opaque.
fn patches(seed: u32) -> Vec<u8> {
    let (w, h) = (SIZE.width as usize, SIZE.height as usize);
    let byte =
        |x: usize, y: usize, c: u32| (hash::unit(seed * 4 + c, x as u32, y as u32) * 254.0) as u8;
    (0..w * h).flat_map(|i| [0, 1, 2, 3].map(|c| byte(i % w / 8, i / w / 8, c))).collect()
}

static GRIDS: LazyLock<Vec<TileGrid>> = LazyLock::new(|| {
    let grid = |seed| {
        TileGrid::from_straight_rgba(
            &patches(seed),
            SIZE.width as usize,
            SIZE.height as usize,
            0,
            0,
        )
    };
    (0..LAYERS as u32).map(grid).collect()
});

/// The same layers as whole pixmaps.
static PIXMAPS: LazyLock<Vec<Pixmap>> = LazyLock::new(|| {
    let pixmap = |grid: &TileGrid| {
        let mut pixmap = Pixmap::new(SIZE.width, SIZE.height)?;
        for (at, tile) in grid.iter() {
            let (x, y) = (at.rect().x0, at.rect().y0);
            let source =
                PixmapPaint { blend_mode: tiny_skia::BlendMode::Source, ..Default::default() };
            pixmap.draw_pixmap(x, y, tile.pixmap().as_ref(), &source, Transform::identity(), None);
        }
        Some(pixmap)
    };
    GRIDS.iter().filter_map(pixmap).collect()
});

fn document(count: usize, blend: BlendMode) -> Document {
    let layer = |(i, tiles): (usize, &TileGrid)| {
        let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles: tiles.clone() };
        let mut layer = Layer::new(format!("{i}"), Content::Pixels(pixels));
        layer.blend = if i == 0 { BlendMode::Normal } else { blend };
        Arc::new(layer)
    };
    Document {
        layers: GRIDS.iter().take(count).enumerate().map(layer).collect(),
        ..Document::empty(SIZE)
    }
}

fn pixels(layers: usize) -> ItemsCount {
    ItemsCount::new(SIZE.area() * layers)
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool")
}

fn flatten(bencher: Bencher, document: &Document, threads: usize) {
    let pool = pool(threads);
    let flatten = || pool.install(|| rilievo::flatten(document, &Progress::default()));
    bencher.counter(pixels(document.layers.len())).bench_local(flatten);
}

/// 0 is every core.
#[divan::bench(args = [1, 2, 0], sample_count = 7, sample_size = 1)]
fn flatten_20_layers(bencher: Bencher, threads: usize) {
    flatten(bencher, &document(LAYERS, BlendMode::Normal), threads);
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn tiny_skia_draw_pixmap_20_layers(bencher: Bencher) {
    let layers = &*PIXMAPS;
    let paint = PixmapPaint::default();
    bencher.counter(pixels(LAYERS)).bench_local(|| {
        let mut canvas = Pixmap::new(SIZE.width, SIZE.height)?;
        layers.iter().for_each(|p| {
            canvas.draw_pixmap(0, 0, p.as_ref(), &paint, Transform::identity(), None)
        });
        Some(canvas)
    });
}

#[divan::bench(sample_count = 7, sample_size = 1)]
fn byte_loop_20_layers(bencher: Bencher) {
    let layers = &*PIXMAPS;
    bencher.counter(pixels(LAYERS)).bench_local(|| {
        let mut canvas = vec![0u8; SIZE.area() * 4];
        layers.iter().for_each(|p| bytes_over(&mut canvas, p.data()));
        canvas
    });
}

rilievo_engine::widest! {
    /// Source-over in bytes, rounded after every layer: the least work there is, and the least
    /// precise.
    fn bytes_over(canvas: &mut [u8], layer: &[u8]) {
        for (d, s) in canvas.chunks_exact_mut(32).zip(layer.chunks_exact(32)) {
            for p in 0..8 {
                let rest = 255 - u32::from(s[p * 4 + 3]);
                for c in 0..4 {
                    let product = u32::from(d[p * 4 + c]) * rest + 128;
                    d[p * 4 + c] = s[p * 4 + c].saturating_add(((product + (product >> 8)) >> 8) as u8);
                }
            }
        }
    }
}

/// Ten layers of 2048², all of bytes or all of 16 bits.
#[divan::bench(args = ["bytes", "16 bits"], sample_count = 11, sample_size = 1)]
fn ten_layers(bencher: Bencher, depth: &str) {
    let (w, h) = (SCENE.width, SCENE.height);
    let value = |seed: u32, i: u32, c: u32| {
        (hash::unit(seed * 4 + c, i % w / 8, i / w / 8) * 65_000.0) as u16
    };
    let grid = |seed: u32| {
        let straight: Vec<[u16; 4]> =
            (0..w * h).map(|i| [0, 1, 2, 3].map(|c| value(seed, i, c))).collect();
        TileGrid::from_straight16(&straight, w as usize, h as usize, 0, 0)
    };
    let layer = |i: u32| {
        let tiles = in_bytes_if(depth == "bytes", grid(i));
        Arc::new(Layer::new(
            format!("{i}"),
            Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }),
        ))
    };
    flatten(
        bencher,
        &Document { layers: (0..10).map(layer).collect(), ..Document::empty(SCENE) },
        1,
    );
}

/// The same, rounded to bytes if requested.
fn in_bytes_if(rounded: bool, tiles: TileGrid) -> TileGrid {
    let mut out = tiles.clone();
    for (at, tile) in tiles.iter().filter(|_| rounded) {
        out.set(at, Tile::from_pixels(tile.bytes().to_vec()).map(Arc::new));
    }
    out
}

/// Two layers minus one: the price of a mode is that of its second layer.
#[divan::bench(args = BlendMode::ALL.map(|(_, name)| name), sample_count = 5, sample_size = 1)]
fn five_layers(bencher: Bencher, mode: &str) {
    flatten(bencher, &document(5, BlendMode::from_name(mode).unwrap_or_default()), 1);
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn five_layers_in_linear_light(bencher: Bencher) {
    let mut document = document(5, BlendMode::Normal);
    document.layers.iter_mut().for_each(|layer| Arc::make_mut(layer).blend_linear = true);
    flatten(bencher, &document, 1);
}

#[divan::bench(sample_count = 20)]
fn one_tile_of_20_layers(bencher: Bencher) {
    let prepared =
        PreparedDocument::new(&document(LAYERS, BlendMode::Normal), &Progress::default())
            .expect("not canceled");
    bencher
        .counter(ItemsCount::new(64 * 64 * LAYERS))
        .bench_local(|| prepared.flatten_tile(TileAt::new(3, 3)));
}

const SCENE: Size = Size::new(2048, 2048);

/// Balls in rows before a wall, each `side` px wide: their contours are seen by two sides.
/// One as wide as the canvas has few.
fn balls(side: f32) -> Arc<Surface> {
    let at = |x: usize, y: usize| {
        let center = |v: f32| ((v / side).floor() + 0.5) * side;
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        let p = vec2(x - center(x), y - center(y)) / (0.48 * side);
        let up = 1.0 - p.length_squared();
        if up > 0.0 { (vec3(p.x, -p.y, up.sqrt()), 0.5 - 0.4 * up.sqrt()) } else { (Vec3::Z, 1.0) }
    };
    let normals = Plane::from_fn(SCENE, |x, y| at(x, y).0);
    let depth = Plane::from_fn(SCENE, |x, y| at(x, y).1);
    let maps = Maps { normals, depth, coverage: Plane::full(SCENE, 255) };
    Arc::new(Surface::new(maps).expect("a surface"))
}

/// A material, a gradient and four fills, two of them masked.
fn painted(surface: &Arc<Surface>) -> Document {
    let stops = [(0.0, Color::BLACK), (1.0, Color::WHITE)]
        .map(|(t, color)| GradientStop { t, color })
        .to_vec();
    let operator = Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 };
    let (from, to) = (vec2(100.0, 100.0), vec2(1900.0, 1900.0));
    let gradient = Gradient {
        from,
        to,
        stops,
        operator,
        filter: ImageFilter::Antialias,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    };
    let contents = [
        Content::Shading(Live::new(Shading::new(Model::Phong))),
        Content::Gradient(Live::new(gradient)),
        Content::Fill(Color { r: 200, g: 40, b: 40, a: 128 }),
        Content::Fill(Color { r: 20, g: 140, b: 40, a: 128 }),
        Content::Fill(Color { r: 20, g: 40, b: 140, a: 128 }),
        Content::Fill(Color { r: 220, g: 210, b: 140, a: 128 }),
    ];
    let layer = |(i, content): (usize, Content)| {
        let mask = (i > 3).then(|| LayerMask::new(DerivedMask::Fresnel { f0: 0.1, power: 3.0 }));
        Arc::new(Layer { mask, ..Layer::new(format!("{i}"), content) })
    };
    let layers = contents.into_iter().enumerate().map(layer).collect();
    Document { surface: Some(surface.clone()), layers, ..Document::empty(SCENE) }
}

/// Sides of the balls: hardly any contour, some, many.
const BALLS: [f32; 3] = [2048.0, 128.0, 32.0];

/// The first time: live layers are rendered.
#[divan::bench(args = BALLS, sample_count = 5, sample_size = 1)]
fn balls_first(bencher: Bencher, side: f32) {
    let surface = balls(side);
    let flatten = |document: Document| rilievo::flatten(&document, &Progress::default());
    bencher
        .counter(ItemsCount::new(SCENE.area()))
        .with_inputs(|| painted(&surface))
        .bench_local_values(flatten);
}

/// Again: they are cached.
#[divan::bench(args = BALLS, sample_count = 7, sample_size = 1)]
fn balls_again(bencher: Bencher, side: f32) {
    let document = painted(&balls(side));
    rilievo::flatten(&document, &Progress::default());
    let flatten = || rilievo::flatten(&document, &Progress::default());
    bencher.counter(ItemsCount::new(SCENE.area())).bench_local(flatten);
}

/// A surface from its maps: what finding contours adds to it.
#[divan::bench(args = BALLS, sample_count = 5, sample_size = 1)]
fn surface_of_balls(bencher: Bencher, side: f32) {
    bencher.counter(ItemsCount::new(SCENE.area())).bench_local(|| balls(side));
}
