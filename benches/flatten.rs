//! Flattening 20 semi-transparent paint layers of 3840 × 2160, beside `tiny_skia::draw_pixmap` of the same layers and a
//! plain byte loop, in the same run; and the price of each blend mode.
//!
//! Read ratios, not times: `cargo bench --bench flatten`. Throughput counts pixels times layers, so ns per pixel and
//! layer is 1 / (Gitem/s).

use divan::{Bencher, counter::ItemsCount};
use rilievo_engine::document::{Content, Document, Layer, PixelLayer, PreparedDocument, Progress};
use rilievo_engine::math::{Size, hash};
use rilievo_engine::raster::{BlendMode, TileAt, TileGrid};
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
    let byte = |x: usize, y: usize, c: u32| (hash::unit(seed * 4 + c, x as u32, y as u32) * 254.0) as u8;
    (0..w * h).flat_map(|i| [0, 1, 2, 3].map(|c| byte(i % w / 8, i / w / 8, c))).collect()
}

static GRIDS: LazyLock<Vec<TileGrid>> = LazyLock::new(|| {
    let grid = |seed| TileGrid::from_straight_rgba(&patches(seed), SIZE.width as usize, SIZE.height as usize, 0, 0);
    (0..LAYERS as u32).map(grid).collect()
});

/// The same layers as whole pixmaps.
static PIXMAPS: LazyLock<Vec<Pixmap>> = LazyLock::new(|| {
    let pixmap = |grid: &TileGrid| {
        let mut pixmap = Pixmap::new(SIZE.width, SIZE.height)?;
        for (at, tile) in grid.iter() {
            let (x, y) = (at.rect().x0, at.rect().y0);
            let source = PixmapPaint { blend_mode: tiny_skia::BlendMode::Source, ..Default::default() };
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
    Document { layers: GRIDS.iter().take(count).enumerate().map(layer).collect(), ..Document::empty(SIZE) }
}
fn pixels(layers: usize) -> ItemsCount {
    ItemsCount::new(SIZE.area() * layers)
}
fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool")
}
fn flatten(bencher: Bencher, document: &Document, threads: usize) {
    let pool = pool(threads);
    let flatten = || pool.install(|| rilievo_engine::document::flatten(document, &Progress::default()));
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
        layers.iter().for_each(|p| canvas.draw_pixmap(0, 0, p.as_ref(), &paint, Transform::identity(), None));
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
    /// Source-over in bytes, rounded after every layer: the least work there is, and the least precise.
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

/// Two layers less one: the price of a mode is its second layer's.
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
        PreparedDocument::new(&document(LAYERS, BlendMode::Normal), &Progress::default()).expect("not cancelled");
    bencher.counter(ItemsCount::new(64 * 64 * LAYERS)).bench_local(|| prepared.flatten_tile(TileAt::new(3, 3)));
}
