//! How fast radiance scaling and materials are, next to a copy of the same pixels in the same run.
//!
//! `cargo bench --no-default-features --bench shading`. Figures are compared within one run only.

use divan::{Bencher, counter::ItemsCount};
use rayon::prelude::*;
use rilievo::document::{LayerId, Live, PreparedDocument, diff};
use rilievo::math::{Vec3, vec3};
use rilievo::raster::{Picture, PlanarTile, Plane, TileAt};
use rilievo::shading::{
    Environment, Light, LightKind, LitSphere, Model, RadianceScaling, Reference, Scaling, Shading,
};
use rilievo::surface::Scene;
use rilievo::{Content, Document, Layer, Maps, Progress, Size, Surface, TileGrid};
use rilievo_engine::document::DocumentReducer;
use rilievo_engine::raster::planar::PixelRow;
use rilievo_engine::shading::radiance::BackdropStats;
use rilievo_engine::surface::chunks::ChunkSettings;
use rilievo_engine::surface::shadow::{LampPlace, ShadowLamp};
use rilievo_io::recipe::LiveLook;
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
    let maps = Maps { normals, depth: Plane::full(size, 0.5), coverage: Plane::full(size, 255) };
    Scene { size, surface: Some(Arc::new(Surface::new(maps).expect("a whole surface"))) }
}

/// A painted composite: every tone, opaque.
fn composite(scene: &Scene) -> Vec<(TileAt, PlanarTile)> {
    let tone = |x: usize, y: usize, c: usize| ((x * (3 + c) + y * 5) % 256) as f32 / 255.0;
    let row = |y: usize| PixelRow {
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
    let beneath = BackdropStats { brightest: 1.0, gain: 1.0 };
    let pool = pool(run.1);
    // A fresh composite each time: one scaled again and again ends in numbers too small to be fast.
    bencher.counter(area(run)).with_inputs(|| tiles.clone()).bench_local_refs(|tiles| {
        pool.install(|| {
            tiles.par_iter_mut().for_each(|(at, tile)| layer.apply_tile(&scene, *at, beneath, tile))
        });
    });
}

/// Occlusion of a whole map, radius 48 px: once for each surface and radius, then kept.
#[divan::bench(args = RUNS, sample_count = 3, sample_size = 1)]
fn ambient_occlusion(bencher: Bencher, run: Run) {
    let pool = pool(run.1);
    bencher.counter(area(run)).with_inputs(|| scene(run.0)).bench_local_refs(|scene| {
        pool.install(|| scene.surface.as_deref().map(|surface| surface.occlusion(48.0)))
    });
}

/// The places of a painted ball: once for each surface and size, then kept.
#[divan::bench(args = RUNS, sample_count = 5, sample_size = 1)]
fn places_of_a_painted_ball(bencher: Bencher, run: Run) {
    let pool = pool(run.1);
    let settings = ChunkSettings { ball_px: 512.0, chunk_px: 64.0, follow: 0.0, seam_px: 1.0 };
    bencher.counter(area(run)).with_inputs(|| scene(run.0)).bench_local_refs(|scene| {
        pool.install(|| scene.surface.as_deref().map(|surface| surface.ball_places(&settings)))
    });
}

/// A figure whose ball was painted on: its places are kept.
#[divan::bench(args = RUNS)]
fn figure_of_a_repainted_ball(bencher: Bencher, run: Run) {
    let (scene, pool) = (scene(run.0), pool(run.1));
    let mut shading = Shading::new(Model::LitSphere);
    shading.strokes.on = true;
    shading.warm(&scene);
    let tiles: Vec<TileAt> = TileAt::covering(scene.size.rect()).collect();
    bencher.counter(area(run)).bench_local(|| {
        pool.install(|| {
            tiles.par_iter().for_each(|at| drop(divan::black_box(shading.render_tile(&scene, *at))))
        });
    });
}

/// A dab of an eighth of its ball's width, to the tiles that show it: found, and rendered again; 1080p,
/// two threads.
#[divan::bench(sample_count = 20)]
fn figure_after_a_dab_on_its_ball(bencher: Bencher) {
    const SIDE: u32 = 512;
    let (scene, pool) = (balls(HD), pool(2));
    let painted = |dab: Option<(f32, f32)>| {
        let texel = |i: u32| {
            let (x, y) = ((i % SIDE) as f32, (i / SIDE) as f32);
            let is_dab = dab.is_some_and(|(u, v)| (x - u).hypot(y - v) < SIDE as f32 / 16.0);
            if is_dab { [200, 40, 30, 255] } else { [(x / 2.0) as u8, (y / 2.0) as u8, 90, 255] }
        };
        let texels = (0..SIDE * SIDE).map(texel).collect();
        let picture = Picture::srgb8(Size::new(SIDE, SIDE), texels).expect("a picture");
        let mut shading = Shading::new(Model::LitSphere);
        shading.strokes.on = true;
        shading.with_ball(false, LitSphere::new("ball.png".into(), picture))
    };
    let (before, mut turn) = (painted(None), 0.0f32);
    before.warm(&scene);
    let next = || {
        turn += 0.7;
        painted(Some((256.0 + 120.0 * turn.cos(), 256.0 + 120.0 * turn.sin())))
    };
    bencher.with_inputs(next).bench_local_values(|after| {
        pool.install(|| {
            let tiles = after.repainted_tiles(&before, &scene).expect("a dab changes some tiles");
            after.warm(&scene);
            tiles.par_iter().for_each(|at| {
                drop(divan::black_box(after.render_tile(&scene, *at)));
            });
        });
        after
    });
}

/// A document's picture in the list of looks, as large as that is, its surface new each time.
/// Argument: the look.
#[divan::bench(args = ["oil-sketch", "watercolor", "ink", "engraving", "comic"], sample_count = 5)]
fn thumbnail_of_a_look(bencher: Bencher, key: &str) {
    let look = LiveLook::of_key(key).expect("a look");
    bencher.with_inputs(|| scene((1024, 1024))).bench_local_values(|scene| {
        let document = Document { surface: scene.surface, ..Document::empty(scene.size) };
        let small = DocumentReducer::new(0.125).of(&document).expect("a small document");
        let dressed = look.on(&small).expect("a dressed document");
        rilievo::flatten(&dressed, &Progress::default())
    });
}

#[divan::bench(args = RUNS)]
fn copy_of_the_same_pixels(bencher: Bencher, run: Run) {
    let scene = scene(run.0);
    let from = composite(&scene);
    let mut to = from.clone();
    let pool = pool(run.1);
    bencher.counter(area(run)).bench_local(|| {
        pool.install(|| {
            to.par_iter_mut()
                .zip(&from)
                .for_each(|(t, f)| t.1.rows_mut().copy_from_slice(f.1.rows()))
        });
    });
}

/// As flattening does it: each tile is in the cache already. Next to it, the copy that puts it
/// there.
#[divan::bench(args = RUNS)]
fn radiance_scaling_of_tiles_in_the_cache(bencher: Bencher, run: Run) {
    let scene = scene(run.0);
    let layer = RadianceScaling::default();
    let beneath = BackdropStats { brightest: 1.0, gain: 1.0 };
    in_cache(bencher, run, |at, tile| layer.apply_tile(&scene, at, beneath, tile));
}

#[divan::bench(args = RUNS)]
fn copy_of_tiles_in_the_cache(bencher: Bencher, run: Run) {
    in_cache(bencher, run, |_, _| ());
}

/// One tile of the composite is copied for each of the canvas, then worked on.
fn in_cache(bencher: Bencher, run: Run, work: impl Fn(TileAt, &mut PlanarTile) + Sync) {
    let scene = scene(run.0);
    let tiles = composite(&scene);
    let template = &tiles[0].1;
    let ats: Vec<TileAt> = tiles.iter().map(|(at, _)| *at).collect();
    let pool = pool(run.1);
    let each = |own: &mut PlanarTile, at: &TileAt| {
        own.rows_mut().copy_from_slice(template.rows());
        work(*at, own);
        divan::black_box(own);
    };
    bencher.counter(area(run)).bench_local(|| {
        pool.install(|| ats.par_iter().for_each_init(PlanarTile::transparent, each))
    });
}

/// One light, its two terms and the ambient one scaled.
fn lit(model: Model) -> Shading {
    let mut shading = Shading::new(model);
    for term in [&mut shading.ambient, &mut shading.diffuse, &mut shading.specular] {
        term.scaling = Scaling::new(0.2, 1.0);
    }
    shading
}

#[divan::bench(args = RUNS)]
fn phong_with_one_light(bencher: Bencher, run: Run) {
    material(bencher, run, Model::Phong);
}

#[divan::bench(args = [Model::Toon, Model::SubLambertian, Model::Ashikhmin, Model::LitSphere])]
fn other_models(bencher: Bencher, model: Model) {
    material(bencher, (SMALL, 1), model);
}

/// Models under an environment, next to one look-up of it per pixel.
#[divan::bench(args = [Model::Mirror, Model::Refraction, Model::DiffuseEnvironment, Model::Ashikhmin])]
fn under_an_environment(bencher: Bencher, model: Model) {
    let shading = Shading { environment: Some(studio()), ..lit(model) };
    rendered(bencher, (SMALL, 1), &shading);
}

/// The same with inter-reflection, on balls that lie on a plate; 0 bounces are none.
#[divan::bench(args = [(Model::Mirror, 0), (Model::Mirror, 1), (Model::Mirror, 4), (Model::Refraction, 1),
    (Model::Ashikhmin, 0), (Model::Ashikhmin, 1)])]
fn inter_reflection(bencher: Bencher, (model, bounces): (Model, u32)) {
    let shading = Shading { environment: Some(studio()), bounces, ..lit(model) };
    rendered_on(bencher, (SMALL, 1), &balls(SMALL), &shading);
}

/// What rays are marched through: once for each surface, then kept.
#[divan::bench(sample_count = 10, sample_size = 1)]
fn what_rays_are_marched_through(bencher: Bencher) {
    let pool = pool(1);
    bencher
        .counter(area((SMALL, 1)))
        .with_inputs(|| balls(SMALL))
        .bench_local_refs(|scene| pool.install(|| scene.surface.as_deref().map(Surface::ray_map)));
}

/// Balls in rows on a plate that is seen aslant.
fn balls((width, height): (u32, u32)) -> Scene {
    const RADIUS: f32 = 40.0;
    let (size, tilt) = (Size::new(width, height), vec3(0.0, 0.6, 0.8));
    // The height toward the viewer and the normal; the plate rises by ¾ px a px down the picture.
    let at = |x: usize, y: usize| {
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        let (dx, dy) = (x.rem_euclid(128.0) - 64.0, y.rem_euclid(128.0) - 64.0);
        let plate = 0.75 * y;
        let under_root = RADIUS * RADIUS - dx * dx - dy * dy;
        let top = 0.75 * (y - dy) + 45.0 + under_root.max(0.0).sqrt();
        match under_root > 0.0 && top > plate {
            true => (top, vec3(dx, -dy, under_root.sqrt()) / RADIUS),
            false => (plate, tilt),
        }
    };
    let highest = 0.75 * height as f32 + 100.0;
    let maps = Maps {
        normals: Plane::from_fn(size, |x, y| at(x, y).1),
        depth: Plane::from_fn(size, |x, y| 1.0 - at(x, y).0 / highest),
        coverage: Plane::full(size, 255),
    };
    Scene { size, surface: Some(Arc::new(Surface::new(maps).expect("a whole surface"))) }
}

/// The mean over each pixel's footprint about the direction that it mirrors, from mip levels;
/// directions are given.
#[divan::bench]
fn one_look_up_of_the_environment(bencher: Bencher) {
    let (scene, light) = (scene(SMALL), studio().environment_light());
    let surface = scene.surface.as_deref().expect("a surface");
    let mirrored = |x: u32, y: u32| {
        let n = surface.normal(x as usize, y as usize);
        n * (2.0 * n.z) - vec3(0.0, 0.0, 1.0)
    };
    let (width, height) = (SMALL.0 - 1, SMALL.1 - 1);
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let rays: Vec<[Vec3; 3]> = pixels
        .map(|(x, y)| {
            let ray = mirrored(x, y);
            [ray, mirrored(x + 1, y) - ray, mirrored(x, y + 1) - ray]
        })
        .collect();
    let pool = pool(1);
    bencher.counter(ItemsCount::new(rays.len())).bench_local(|| {
        pool.install(|| {
            rays.iter().map(|[ray, dx, dy]| light.mean_over_pixel(*ray, *dx, *dy)).sum::<Vec3>()
        })
    });
}

/// A latitude-longitude map with two lamps.
fn studio() -> Environment {
    let (width, height) = (2048usize, 1024usize);
    let texel = |i: usize| {
        let (x, y) = (i % width, i / width);
        let lamp = if (x / 128 + 3 * (y / 128)) % 7 == 0 { 4.0 } else { 0.1 };
        [lamp, 0.8 * lamp + 0.001 * (x % 64) as f32, 0.6 * lamp, 1.0]
    };
    let size = Size::new(width as u32, height as u32);
    let picture = Picture::linear(size, (0..width * height).map(texel).collect())
        .expect("a texel for each pixel");
    Environment::new("studio".into(), picture)
}

fn material(bencher: Bencher, run: Run, model: Model) {
    rendered(bencher, run, &lit(model));
}

fn rendered(bencher: Bencher, run: Run, shading: &Shading) {
    rendered_on(bencher, run, &scene(run.0), shading);
}

fn rendered_on(bencher: Bencher, run: Run, scene: &Scene, shading: &Shading) {
    shading.warm(scene);
    let ats: Vec<TileAt> = TileAt::covering(scene.size.rect()).collect();
    let pool = pool(run.1);
    bencher.counter(area(run)).bench_local(|| {
        pool.install(|| {
            ats.par_iter().for_each(|&at| drop(divan::black_box(shading.render_tile(scene, at))))
        });
    });
}

const HD: (u32, u32) = (1920, 1080);

/// A document of one color under the painter's light.
fn painted(scene: &Scene, angle: f32) -> Document {
    let mut shading = Shading::new(Model::Painter);
    shading.painter.beneath = true;
    let kind = LightKind::Directional { direction: vec3(angle.cos(), angle.sin(), 0.75) };
    shading.lights = vec![Light { kind, ..Light::default() }];
    let layers = [
        Layer::new("flat", Content::Fill(rilievo::Color::rgb(200, 120, 60))),
        Layer::new("light", Content::Shading(Live::new(shading))),
    ];
    let layers = layers.map(Arc::new).into();
    Document { surface: scene.surface.clone(), layers, ..Document::empty(scene.size) }
}

/// The painter's light on 1080p with balls, two threads: the whole picture from nothing, with a lamp
/// that moved, and the same while it is dragged: with all pixels, and at half the size, as the window
/// shows it where all pixels take longer than a frame.
#[divan::bench(
    args = ["from nothing", "another lamp", "dragged", "dragged at half the size"],
    sample_count = 20,
    sample_size = 1
)]
fn painters_light(bencher: Bencher, what: &str) {
    let (pool, mut step) = (pool(2), 0u32);
    let kept = balls(HD);
    let mut reducer = match what {
        "dragged" => Some(DocumentReducer::new(1.0)),
        "dragged at half the size" => Some(DocumentReducer::new(0.5)),
        _ => None,
    };
    let mut draw = |scene: &Scene, angle: f32| {
        let mut document = painted(scene, angle);
        if let Some(reducer) = &mut reducer {
            document = reducer.of(&document).expect("a small document");
        }
        pool.install(|| rilievo::flatten(&document, &Progress::default())).expect("not canceled")
    };
    draw(&kept, 0.1);
    bencher
        .counter(area((HD, 2)))
        .with_inputs(|| if what == "from nothing" { balls(HD) } else { kept.clone() })
        .bench_local_values(|scene| {
            step += 1;
            draw(&scene, 0.2 + 0.05 * step as f32)
        });
}

/// The shadow of one lamp on the same; with four rays as while it is dragged.
#[divan::bench(args = [4, 16, 32], sample_count = 20, sample_size = 1)]
fn shadow_of_a_lamp(bencher: Bencher, rays: u32) {
    let (pool, scene, mut step) = (pool(2), balls(HD), 0u32);
    let surface = scene.surface.as_deref().expect("a surface");
    bencher.counter(area((HD, 2))).bench_local(|| {
        step += 1;
        let angle = 0.05 * step as f32;
        let place = LampPlace::Afar(vec3(angle.cos(), angle.sin(), 0.75));
        let lamp = ShadowLamp { place, radius: 0.13, reach_px: 220.0, rays, is_coarse: rays == 4 };
        pool.install(|| surface.shadow(&lamp, 1))
    });
}

/// What is dragged.
const DRAGS: [&str; 4] =
    ["gamma of the layer", "gamma of the layer, mean kept", "a light, Y* set", "a light, Y* auto"];

/// The time between a drag's event and the new picture: the new document, what differs, and those
/// tiles; on two threads.
#[divan::bench(args = DRAGS)]
fn drag_on_1024_by_768(bencher: Bencher, what: &str) {
    let pool = pool(2);
    let mut document = lit_document(what);
    let mut shown =
        pool.install(|| rilievo::flatten(&document, &Progress::default())).expect("not canceled");
    let mut step = 0;
    bencher.counter(area((SMALL, 2))).bench_local(|| {
        step += 1;
        let next = dragged(&document, what, (step % 7) as f32 / 7.0);
        shown = pool.install(|| redrawn(&document, &next, &shown));
        document = next;
    });
}

fn redrawn(old: &Document, new: &Document, shown: &TileGrid) -> TileGrid {
    let changed: Vec<TileAt> = diff(old, new).into_iter().collect();
    let prepared = PreparedDocument::new(new, &Progress::default()).expect("not canceled");
    prepared.flatten_tiles(shown, &changed, &Progress::default()).expect("not canceled")
}

/// A lit surface with radiance scaling over it.
fn lit_document(what: &str) -> Document {
    let scene = scene(SMALL);
    let reference = if what.ends_with("set") { Reference::Value(0.8) } else { Reference::Auto };
    let scaling = RadianceScaling {
        reference,
        keep_mean: what.ends_with("kept"),
        ..RadianceScaling::default()
    };
    let layers = [
        Layer::new("lit", Content::Shading(Live::new(lit(Model::Phong)))),
        Layer::new("relief", Content::RadianceScaling(scaling)),
    ];
    Document {
        surface: scene.surface,
        layers: layers.map(Arc::new).into(),
        ..Document::empty(scene.size)
    }
}

fn dragged(document: &Document, what: &str, t: f32) -> Document {
    let id = |index: usize| -> LayerId { document.layers[index].id };
    let edited = if what.starts_with("gamma") {
        document.with_layer(id(1), |layer| {
            if let Content::RadianceScaling(scaling) = &mut layer.content {
                scaling.scaling = Scaling::new(0.2, 0.5 + t);
            }
        })
    } else {
        document.with_layer(id(0), |layer| {
            let mut shading = lit(Model::Phong);
            let kind = LightKind::Directional { direction: vec3(t - 0.5, 0.4, 0.7) };
            shading.lights = vec![Light { kind, ..Light::default() }];
            layer.content = Content::Shading(Live::new(shading));
        })
    };
    edited.expect("the layer is there")
}
