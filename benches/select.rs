//! What selecting costs: wands, tolerances being dragged, outlines, and what a selection adds to a
//! brush's frame. On two threads.
//!
//! `cargo bench --bench select`. The aims: a wand over 4096² in 150 ms, a dragged tolerance of the
//! surface wand at 1920 × 1080 in 16 ms, outlines of 4096² in 1 ms a frame, a brush's frame with
//! all of the canvas selected within 10 % of one without a selection.

use divan::Bencher;
use rilievo::math::{Rect, Vec2, vec2, vec3};
use rilievo::paint::{
    ActiveStrokes, Backdrop, Brush, Fill, Sample, Selection, Stroke, StrokeSelection,
};
use rilievo::raster::{CoverageGrid, Plane, TileAt};
use rilievo::surface::{CanvasPart, RegionKind, Scene, SurfaceRegion};
use rilievo::{Color, Maps, Operator, Size, Surface, TileGrid};
use rilievo_engine::math::hash;
use rilievo_engine::raster::coverage::{contour, edges, shapes};
use rilievo_engine::surface::region::RegionField;
use std::sync::{Arc, LazyLock};

const LARGE: Size = Size::new(4096, 4096);
const SCREEN: Size = Size::new(1920, 1080);

fn main() {
    divan::main();
}

static POOL: LazyLock<rayon::ThreadPool> = LazyLock::new(|| {
    rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a thread pool")
});

/// Blots of two grays, grown together into one large region with many islands.
static PICTURE: LazyLock<TileGrid> = LazyLock::new(|| {
    let side = LARGE.width as usize;
    let is_island = |x: usize, y: usize| hash::unit(3, (x / 24) as u32, (y / 24) as u32) < 0.3;
    let gray = |i: usize| if is_island(i % side, i / side) { 40 } else { 200 };
    let rgba: Vec<u8> = (0..LARGE.area()).flat_map(|i| [gray(i), gray(i), gray(i), 255]).collect();
    TileGrid::from_straight_rgba(&rgba, side, side, 0, 0)
});

/// A ball that fills most of the screen.
static BALL: LazyLock<Arc<Surface>> = LazyLock::new(|| {
    let normal = |x: usize, y: usize| {
        let p = (vec2(x as f32 + 0.5, y as f32 + 0.5) - SCREEN.center()) / 520.0;
        let z2 = 1.0 - p.length_squared();
        (z2 > 0.0).then(|| vec3(p.x, -p.y, z2.sqrt()))
    };
    let normals = Plane::from_fn(SCREEN, |x, y| normal(x, y).unwrap_or(vec3(0.0, 0.0, 1.0)));
    let depth = Plane::from_fn(SCREEN, |x, y| normal(x, y).map_or(1.0, |n| 0.5 * (1.0 - n.z)));
    Arc::new(
        Surface::new(Maps { normals, depth, coverage: Plane::full(SCREEN, 255) }).expect("maps"),
    )
});

#[divan::bench(args = [false, true])]
fn wand_4096(bencher: Bencher, everywhere: bool) {
    LazyLock::force(&PICTURE);
    let fill = Fill { grow_px: 0.0, ..Fill::default() };
    let start = (0..4096)
        .map(|x| vec2(x as f32, 2000.0))
        .find(|at| PICTURE.pixel(at.x as i32, 2000)[0] == 200);
    let start = start.unwrap_or(Vec2::ZERO);
    let read = |at: TileAt| PICTURE.tile(at).cloned();
    bencher.bench(|| {
        POOL.install(|| fill.find_coverage(start, LARGE, &CanvasPart::Whole, everywhere, read))
    });
}

#[divan::bench]
fn surface_wand_pressed_1080(bencher: Bencher) {
    LazyLock::force(&BALL);
    bencher
        .bench(|| POOL.install(|| RegionField::new(&BALL, RegionKind::Direction, SCREEN.center())));
}

#[divan::bench(args = [false, true])]
fn surface_wand_dragged_1080(bencher: Bencher, joined: bool) {
    let field =
        RegionField::new(&BALL, RegionKind::Direction, SCREEN.center()).expect("on the ball");
    let told = SurfaceRegion {
        tolerance: 50.0,
        contiguous: joined,
        ..SurfaceRegion::new(RegionKind::Direction, SCREEN.center())
    };
    bencher.bench(|| POOL.install(|| field.region(&told)));
}

/// An outline through every tile.
static BLOTS: LazyLock<CoverageGrid> = LazyLock::new(|| {
    let fill = Fill { grow_px: 0.0, ..Fill::default() };
    let read = |at: TileAt| PICTURE.tile(at).cloned();
    fill.find_coverage(vec2(1.0, 1.0), LARGE, &CanvasPart::Whole, true, read).unwrap_or_default()
});

/// All tiles, seen whole in a window of a thousand points, none of them cached yet.
#[divan::bench]
fn outline_found_4096(bencher: Bencher) {
    LazyLock::force(&BLOTS);
    bencher.bench(|| {
        contour::tiles(&BLOTS).map(|at| contour::runs(&BLOTS, at, 2).len()).sum::<usize>()
    });
}

#[divan::bench(args = [10.0, 100.0])]
fn feathered_1080(bencher: Bencher, sigma_px: f32) {
    let disc = shapes::ellipse(vec2(500.0, 100.0), vec2(1400.0, 1000.0), SCREEN.rect());
    bencher.bench(|| POOL.install(|| edges::feathered(&disc, sigma_px, SCREEN.rect())));
}

#[divan::bench(args = [10.0, 100.0])]
fn grown_1080(bencher: Bencher, px: f32) {
    let disc = shapes::ellipse(vec2(500.0, 100.0), vec2(1400.0, 1000.0), SCREEN.rect());
    bencher.bench(|| POOL.install(|| edges::grown(&disc, px, SCREEN.rect())));
}

/// A frame of sixteen samples of a brush of radius 64: free, with all of the canvas selected, and
/// along a soft edge.
#[divan::bench(args = ["free", "all", "soft edge"])]
fn brush_frame(bencher: Bencher, selected: &str) {
    let scene = Scene { size: LARGE, surface: None };
    let grid = match selected {
        "free" => None,
        "all" => Some(CoverageGrid::full(LARGE.rect())),
        _ => Some(edges::feathered(
            &CoverageGrid::full(Rect::new(0, 0, 4096, 2000)),
            40.0,
            LARGE.rect(),
        )),
    };
    let own = grid.map(|grid| StrokeSelection::new(Arc::new(Selection::new(grid))));
    let brush = Brush { size: 128.0, ..Brush::default() };
    let like = Stroke::new(brush, Operator::None, Color::BLACK, Vec::new()).within(own);
    let samples = |frame: usize| -> Vec<Sample> {
        let at = |i: usize| vec2(300.0 + 8.0 * (16 * frame + i) as f32, 2000.0);
        (0..16).map(|i| Sample::at(at(i))).collect()
    };
    let begun = || {
        let mut strokes = ActiveStrokes::new(
            std::slice::from_ref(&like),
            Backdrop::Pixels(PICTURE.clone()),
            &scene,
        );
        strokes.draw(&[samples(0)]);
        strokes
    };
    bencher
        .with_inputs(begun)
        .bench_local_values(|mut strokes| POOL.install(|| strokes.draw(&[samples(1)]).len()));
}
