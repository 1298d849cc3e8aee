//! A project of 20 paint layers of 4096 × 4096: saved while a brush paints, and opened, next to
//! decoding only its PNGs on the same two threads in the same run.
//!
//! Read ratios, and for `brush_…` the slowest sample: the longest that the painter has to wait.
//! `cargo bench --bench project`.

use divan::Bencher;
use divan::counter::BytesCount;
use rilievo::document::PixelLayer;
use rilievo::{Budget, Content, Document, Layer, Progress, Size, TileGrid};
use rilievo_engine::math::hash;
use rilievo_io::project;
use rilievo_program::session::{Autosave, OpenDocument, Session};
use std::io::{Cursor, Read};
use std::path::Path;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};

const SIDE: usize = 4096;
const LAYERS: usize = 20;

fn main() {
    divan::main();
}

/// Straight RGBA in soft patches: smooth as paint is, grained as a brush is, with holes.
fn patches(seed: u32) -> Vec<u8> {
    let patch =
        |x: usize, y: usize, c: u32| hash::unit(seed * 4 + c, (x / 256) as u32, (y / 256) as u32);
    let grain = |i: usize| hash::mix(i as u32 ^ seed) as u8 & 7;
    let pixel = |i: usize| {
        let (x, y) = (i % SIDE, i / SIDE);
        let shade = (x + y) / 64;
        let color =
            [0, 1, 2].map(|c| (patch(x, y, c) * 180.0) as u8 + shade as u8 / 4 + grain(i / 2));
        let alpha = if patch(x, y, 3) < 0.3 { 0 } else { 255 - grain(i / 3) * 9 };
        if alpha == 0 { [0; 4] } else { [color[0], color[1], color[2], alpha] }
    };
    (0..SIDE * SIDE).flat_map(pixel).collect()
}

static GRIDS: LazyLock<Vec<TileGrid>> = LazyLock::new(|| {
    (0..LAYERS as u32)
        .map(|seed| TileGrid::from_straight_rgba(&patches(seed), SIDE, SIDE, 0, 0))
        .collect()
});

/// Layers that no file holds yet: nothing about them is cached.
fn document() -> Document {
    let layer = |(i, tiles): (usize, &TileGrid)| {
        let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles: tiles.clone() };
        Layer::new(format!("{i}"), Content::Pixels(pixels)).into()
    };
    let side = SIDE as u32;
    Document {
        layers: GRIDS.iter().enumerate().map(layer).collect(),
        ..Document::empty(Size::new(side, side))
    }
}

fn written(document: &Document) -> Vec<u8> {
    project::write(Path::new("a.ora"), document, &Progress::default())
        .expect("a project")
        .expect("not canceled")
}

static PROJECT: LazyLock<Vec<u8>> = LazyLock::new(|| written(&document()));

/// The layers' PNGs as the file holds them.
static PNGS: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| {
    let mut zip = zip::ZipArchive::new(Cursor::new(&PROJECT[..])).expect("a zip");
    let names: Vec<String> =
        zip.file_names().filter_map(|name| name.ok().map(|name| name.to_string())).collect();
    let entry = |name: &String| {
        let mut bytes = Vec::new();
        zip.by_name(name).expect("an entry").read_to_end(&mut bytes).expect("its bytes");
        bytes
    };
    names.iter().filter(|name| name.starts_with("data/")).map(entry).collect()
});

fn pixels() -> BytesCount {
    BytesCount::new(SIDE * SIDE * 4 * LAYERS)
}

fn two_threads() -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a thread pool")
}

#[divan::bench(sample_count = 3, sample_size = 1)]
fn decode_the_layers_pngs(bencher: Bencher) {
    use rayon::prelude::*;
    let (pool, pngs) = (two_threads(), &*PNGS);
    let decode = |png: &Vec<u8>| {
        let mut reader = png::Decoder::new(Cursor::new(png)).read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut pixels).expect("pixels");
        pixels[pixels.len() / 2]
    };
    bencher
        .counter(pixels())
        .bench_local(|| pool.install(|| pngs.par_iter().map(decode).collect::<Vec<u8>>()));
}

#[divan::bench(sample_count = 3, sample_size = 1)]
fn open_the_project(bencher: Bencher) {
    let (pool, bytes) = (two_threads(), &*PROJECT);
    let open = || {
        pool.install(|| {
            project::read(Path::new("a.ora"), bytes, &Budget::default()).map(|read| read.document)
        })
    };
    bencher.counter(pixels()).bench_local(open);
}

#[divan::bench(sample_count = 2, sample_size = 1)]
fn save_the_project_first(bencher: Bencher) {
    let pool = two_threads();
    bencher
        .counter(pixels())
        .with_inputs(document)
        .bench_local_refs(|document| pool.install(|| written(document)));
}

/// One layer of the 20 has changed.
#[divan::bench(sample_count = 2, sample_size = 1)]
fn save_the_project_again(bencher: Bencher) {
    let pool = two_threads();
    let saved = document();
    written(&saved);
    let edited = || {
        let id = saved.layers[3].id;
        let edit = |layer: &mut Layer| {
            if let Content::Pixels(pixels) = &mut layer.content {
                pixels.tiles = GRIDS[7].clone();
            }
        };
        saved.with_layer(id, edit).expect("the layer")
    };
    bencher
        .counter(pixels())
        .with_inputs(edited)
        .bench_local_refs(|document| pool.install(|| written(document)));
}

/// A session on the project that paints on its topmost layer; a pen held down.
fn painting() -> Session {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("bench", document(), None));
    replay(
        &mut session,
        r#"{"in":"pointer","do":"press","tool":"brush","pen":[300,300],"px_per_pt":1}"#,
    );
    session
}

fn replay(session: &mut Session, line: &str) {
    session.replay(Path::new("bench"), line).expect("an action");
}

/// The pen's events in one frame.
fn brush(bencher: Bencher, session: &mut Session) {
    let mut frame = 0u32;
    bencher.bench_local(|| {
        frame += 1;
        let [x, y] = [0, 1].map(|c| 300 + hash::mix(frame / 40 * 2 + c) % 3000 + frame % 40 * 5);
        replay(session, &format!(r#"{{"in":"pointer","do":"drag","pens":[[{x},{y}],[{},{y}]]}}"#, x + 6));
        if frame.is_multiple_of(40) {
            replay(session, r#"{"in":"pointer","do":"release"}"#);
            replay(
                session,
                &format!(r#"{{"in":"pointer","do":"press","tool":"brush","pen":[{x},{y}],"px_per_pt":1}}"#),
            );
        }
        session.keep();
    });
}

#[divan::bench(sample_count = 800, sample_size = 1)]
fn brush_alone(bencher: Bencher) {
    brush(bencher, &mut painting());
}

#[divan::bench(sample_count = 800, sample_size = 1)]
fn brush_while_saving(bencher: Bencher) {
    let mut session = painting();
    let over = AtomicBool::new(false);
    let folder = tempfile::tempdir().expect("a folder");
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !over.load(Ordering::Relaxed) {
                let file = folder.path().join("a.ora");
                let saved = rilievo::save(
                    &document(),
                    &file,
                    rilievo::Overwrite::Anything,
                    &Progress::default(),
                );
                saved.expect("a saved project");
            }
        });
        brush(bencher, &mut session);
        over.store(true, Ordering::Relaxed);
    });
}

/// With the recovery log, which records every stroke.
#[divan::bench(sample_count = 800, sample_size = 1)]
fn brush_with_recovery(bencher: Bencher) {
    let mut session = painting();
    let folder = tempfile::tempdir().expect("a folder");
    session.autosave = Some(Autosave::new(folder.path().into()));
    session.keep();
    brush(bencher, &mut session);
}
