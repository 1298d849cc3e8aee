//! Files of every format, damaged at random: never a panic, never an abort, never a changed layer count beyond the budget.
//! The same mutations every time. `RILIEVO_MUTATIONS=1000000 cargo test --release --test mutated` is the long run.

use rilievo::document::{Document, Progress};
use rilievo::io::{Budget, Files, open::Kind, picture, project, psd, recipe};
use rilievo::math::hash::mix;
use rilievo::{Error, Result};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Small ceilings, so that a damaged header asking for more is refused at once.
fn budget() -> Budget {
    Budget { area_px: 1 << 20, document_px: 1 << 22, side_px: 4096, ..Budget::default() }
}

struct One(Vec<u8>);

impl Files for One {
    fn read(&self, name: &str, _: &Budget) -> Result<Vec<u8>> {
        if name == "p.png" { Ok(self.0.clone()) } else { Err(Error::unsupported(name, "there is no such file")) }
    }
    fn path(&self, name: &str) -> PathBuf {
        name.into()
    }
}

fn document() -> Document {
    let mut png = std::io::Cursor::new(Vec::new());
    let pixel = |x: u32, y: u32| image::Rgba([mix(x * 31 + y) as u8, 90, x as u8 * 9, 255 - y as u8]);
    image::RgbaImage::from_fn(21, 17, pixel).write_to(&mut png, image::ImageFormat::Png).unwrap();
    let json = json!({ "canvas": { "width": 24, "height": 20 }, "layers": [
        { "name": "ground", "kind": "fill", "color": "#204060" },
        { "name": "paint", "kind": "pixels", "file": "p.png", "x": 3, "y": -2 },
        { "name": "photo", "kind": "image", "source": { "file": "p.png" }, "blend": "multiply" },
        { "name": "clip", "kind": "gradient", "clip_below": true, "opacity": 0.5 },
        { "name": "g", "kind": "group", "layers": [
            { "name": "line", "kind": "strokes", "strokes": [ { "brush": { "size": 5 }, "samples": [[2, 3], [15, 9]] } ] } ] } ] });
    let budget = Budget::default();
    let files = One(png.into_inner());
    let source = recipe::Source { file: Path::new("r.json"), files: &files, budget: &budget, onto: None };
    recipe::read(json.to_string().as_bytes(), source).unwrap()
}

/// A file of every format.
fn seeds() -> Vec<(&'static str, Vec<u8>)> {
    let document = document();
    let progress = Progress::default();
    let ora = project::write(Path::new("a.ora"), &document, &progress).unwrap().unwrap();
    let layered = psd::write(Path::new("a.psd"), &document, &progress).unwrap().unwrap().bytes;
    let image = image::RgbaImage::from_fn(19, 11, |x, y| image::Rgba([x as u8 * 13, y as u8 * 20, 7, 250]));
    let picture = |format| {
        let mut out = std::io::Cursor::new(Vec::new());
        let image = image::DynamicImage::ImageRgba8(image.clone());
        let image = if format == image::ImageFormat::Jpeg { image.to_rgb8().into() } else { image };
        image.write_to(&mut out, format).unwrap();
        out.into_inner()
    };
    use image::ImageFormat::{Bmp, Jpeg, Png, Tiff, WebP};
    vec![
        ("a.ora", ora),
        ("a.psd", layered),
        ("a.json", recipe::write(&document).to_string().into_bytes()),
        ("a.png", picture(Png)),
        ("a.jpg", picture(Jpeg)),
        ("a.webp", picture(WebP)),
        ("a.tif", picture(Tiff)),
        ("a.bmp", picture(Bmp)),
    ]
}

/// Flips, overwrites, inserts, removes or repeats a few parts.
fn mutated(bytes: &[u8], seed: u32) -> Vec<u8> {
    let mut out = bytes.to_vec();
    let mut state = seed;
    let mut next = |n: usize| {
        state = mix(state.wrapping_add(0x9e37));
        state as usize % n.max(1)
    };
    for _ in 0..1 + next(4) {
        let (at, length) = (next(out.len()), 1 + next(16));
        let end = (at + length).min(out.len());
        match next(7) {
            0 | 1 => out[at] ^= 1 << next(8),
            2 => out[at] = [0, 0xff, 0x7f, 0x80][next(4)],
            3 => out[at..end].fill(0xff),
            4 => drop(out.drain(at..end)),
            5 => {
                let again = out[at..end].to_vec();
                out.splice(at..at, again);
            }
            _ => out.truncate(at.max(8)),
        }
        if out.is_empty() {
            out.push(0);
        }
    }
    out
}

fn read(name: &str, bytes: &[u8], budget: &Budget) -> Result<()> {
    let file = Path::new(name);
    match Kind::of(bytes) {
        Kind::Project => project::read(file, bytes, budget).map(drop),
        Kind::Psd => psd::read(file, bytes, budget).map(drop),
        Kind::Recipe => {
            let source = recipe::Source { file, files: &One(Vec::new()), budget, onto: None };
            recipe::read(bytes, source).map(drop)
        }
        Kind::Picture => picture::decode(file, bytes, budget).map(drop),
    }
}

#[test]
fn damaged_files_of_every_format_are_read_or_refused_with_a_sentence() {
    let wanted = std::env::var("RILIEVO_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(4_000);
    let (seeds, budget) = (seeds(), budget());
    let mut refused = 0;
    for i in 0..wanted {
        let (name, bytes) = &seeds[i as usize % seeds.len()];
        let broken = mutated(bytes, i);
        let outcome = std::panic::catch_unwind(|| read(name, &broken, &budget));
        let outcome = outcome.unwrap_or_else(|_| panic!("mutation {i} of {name} panics"));
        if let Err(error) = outcome {
            let said = error.to_string();
            assert!(said.contains(name) || said.contains("p.png"), "mutation {i}: {said}");
            refused += 1;
        }
    }
    assert!(refused > wanted / 4, "the mutations do damage: {refused} of {wanted}");
}
