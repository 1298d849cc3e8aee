//! The engine on 4K maps: an image layer bent by D_n, computed *and* sampled, on one thread and on
//! all, next to OpenCV's `remap`, which gets the finished map. `cargo bench --bench engine`; quote
//! ratios from one run, never times from another day.

use rayon::prelude::*;
use rilievo::document::Live;
use rilievo::math::{vec2, vec3};
use rilievo::paint::{Adjust, ImageFilter, PictureSource, PlacedImage, Placement};
use rilievo::raster::{Outside, Picture, Plane, Tile, TileAt};
use rilievo::surface::Scene;
use rilievo::{
    Anchor, Bend, Content, Document, Layer, Maps, Operator, Progress, Size, Surface, flatten,
};
use rilievo_engine::document::DocumentReducer;
use std::process::Command;
use std::sync::{Arc, LazyLock};
use std::time::Instant;

const SIZE: Size = Size::new(3840, 2160);

/// Bumps all over: n̄ = 0.3 (cos x/97 sin y/131, sin x/89 cos y/113), the same as in
/// `peers/remap.py`.
static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let normals = Plane::from_fn(SIZE, |x, y| {
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        let nbar =
            vec2((x / 97.0).cos() * (y / 131.0).sin(), (x / 89.0).sin() * (y / 113.0).cos()) * 0.3;
        vec3(nbar.x, -nbar.y, (1.0 - nbar.length_squared()).sqrt())
    });
    let maps = Maps { normals, depth: Plane::full(SIZE, 0.5), coverage: Plane::full(SIZE, 255) };
    Scene { size: SIZE, surface: Surface::new(maps).ok().map(Arc::new) }
});

static SOURCE: LazyLock<PictureSource> = LazyLock::new(|| {
    let texel = |i: u32, j: u32| [i as u8, j as u8, (i ^ j) as u8, 255];
    let texels = (0..SIZE.height).flat_map(|j| (0..SIZE.width).map(move |i| texel(i, j))).collect();
    PictureSource::new(
        "xor".into(),
        Picture::srgb8(SIZE, texels).expect("one texel a pixel"),
        Adjust::default(),
    )
});

fn image(operator: Operator, filter: ImageFilter, anchors: usize) -> PlacedImage {
    let at = [vec2(1920.5, 1080.5), vec2(700.5, 500.5), vec2(3000.5, 1700.5)];
    let anchors = at[..anchors].iter().map(|&at| Anchor::pin(at)).collect();
    PlacedImage {
        source: SOURCE.clone(),
        placement: Placement::covering(SIZE),
        outside: Outside::Mirror,
        bend: Bend { operator, anchors, ..Bend::default() },
        filter,
        frame: Default::default(),
    }
}

const D_S: Operator = Operator::Surface { amount: 1.0, smooth: 0.0 };
const D_N: Operator = Operator::Normal { alpha: 0.5, beta: 0.0, detail: 0.0 };

/// Name, operator, filter, number of anchors.
const CASES: [(&str, Operator, ImageFilter, usize); 9] = [
    ("D_n bilinear", D_N, ImageFilter::Bilinear, 1),
    ("D_n antialias", D_N, ImageFilter::Antialias, 1),
    ("D_n bilinear, 3 anchors", D_N, ImageFilter::Bilinear, 3),
    ("D_n antialias, 3 anchors", D_N, ImageFilter::Antialias, 3),
    ("D_p bilinear", Operator::Depth { gamma: 1.0 }, ImageFilter::Bilinear, 1),
    ("D_r bilinear", Operator::Reflection { alpha: 0.5, detail: 0.0 }, ImageFilter::Bilinear, 1),
    ("D_s bilinear", D_S, ImageFilter::Bilinear, 1),
    ("D_s bilinear, 3 anchors", D_S, ImageFilter::Bilinear, 3),
    ("unbent", Operator::None, ImageFilter::Bilinear, 1),
];

fn render(image: &PlacedImage) -> Vec<Option<Tile>> {
    let tiles: Vec<TileAt> = TileAt::covering(SIZE.rect()).collect();
    tiles.par_iter().map(|&at| image.render_tile(&SCENE, at)).collect()
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool of threads")
}

#[divan::bench(args = CASES.map(|case| case.0), sample_count = 9, sample_size = 1)]
fn one_thread(bencher: divan::Bencher, case: &str) {
    bench(bencher, case, 1);
}

#[divan::bench(args = CASES.map(|case| case.0), sample_count = 9, sample_size = 1)]
fn all_threads(bencher: divan::Bencher, case: &str) {
    bench(bencher, case, 0);
}

fn bench(bencher: divan::Bencher, case: &str, threads: usize) {
    let (_, operator, filter, anchors) =
        CASES.into_iter().find(|c| c.0 == case).expect("a case of the table");
    let (image, pool) = (image(operator, filter, anchors), pool(threads));
    let bencher = bencher.counter(divan::counter::ItemsCount::new(SIZE.area()));
    bencher.bench_local(|| pool.install(|| render(&image)));
}

/// A picture whose α is dragged, as the window shows it: every pixel, or every second, fourth or
/// eighth per side.
#[divan::bench(args = [1, 2, 4, 8], sample_count = 9, sample_size = 1)]
fn dragged(bencher: divan::Bencher, step: u32) {
    let content = |alpha: f32| {
        let operator = Operator::Normal { alpha, beta: 0.0, detail: 0.0 };
        Content::Image(Live::new(image(operator, ImageFilter::Antialias, 1)))
    };
    let layers = vec![Arc::new(Layer::new("picture", content(0.5)))];
    let document = Document { surface: SCENE.surface.clone(), layers, ..Document::empty(SIZE) };
    let id = document.layers[0].id;
    let mut reduced = DocumentReducer::new(1.0 / step as f32);
    // The surface is made small once for all of a drag.
    reduced.of(&document).expect("a surface that can be made small");
    let mut alpha = 0.5;
    bencher.bench_local(|| {
        alpha += 1e-3;
        let next = document
            .with_layer(id, |layer| layer.content = content(alpha))
            .expect("it has that layer");
        flatten(&reduced.of(&next).expect("a surface that can be made small"), &Progress::default())
    });
}

/// ns per pixel: the median of five renderings.
fn ns_per_px(image: &PlacedImage, pool: &rayon::ThreadPool) -> f64 {
    let mut ns: Vec<f64> = (0..5)
        .map(|_| {
            let start = Instant::now();
            divan::black_box(pool.install(|| render(image)));
            start.elapsed().as_secs_f64() * 1e9 / SIZE.area() as f64
        })
        .collect();
    ns.sort_by(f64::total_cmp);
    ns[2]
}

/// ns per pixel of OpenCV's remap, on one thread and on all; `None`, with a message, if there is no
/// Python with cv2.
fn peer() -> Option<[f64; 2]> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/peers/remap.py");
    let size = [SIZE.width.to_string(), SIZE.height.to_string()];
    let run = Command::new("/usr/bin/env").arg("python3").arg(script).args(size).output().ok()?;
    let text = String::from_utf8_lossy(&run.stdout);
    let ns: Vec<f64> = text.split_whitespace().filter_map(|n| n.parse().ok()).collect();
    ns.try_into().ok()
}

fn main() {
    divan::main();
    if std::env::args().any(|arg| arg == "--test" || arg == "--list") {
        return;
    }
    let pools = [pool(1), pool(0)];
    let peer = peer();
    println!("\nns per pixel, {SIZE}      one thread   all threads   of peer's one");
    match peer {
        Some([one, all]) => println!("{:28} {one:10.2} {all:13.2}", "cv2.remap, map ready"),
        None => println!("cv2.remap: skipped, python3 with cv2 and numpy is not here"),
    }
    for (name, operator, filter, anchors) in CASES {
        let image = image(operator, filter, anchors);
        let [one, all] = [&pools[0], &pools[1]].map(|pool| ns_per_px(&image, pool));
        let ratio = peer.map_or(String::from("–"), |p| format!("{:.2}", one / p[0]));
        println!("{name:28} {one:10.2} {all:13.2} {ratio:>15}");
    }
}
