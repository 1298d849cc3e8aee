//! Adjustment layers in files, and how near they come to the pictures that Photoshop made of them.

use crate::document::{Document, Layer, Progress, flatten};
use crate::math::Size;
use crate::psd::merged::Merged;
use crate::psd::parse::parse;
use crate::psd::tree::build_document;
use crate::psd::{self, LayerRecord, compare};
use crate::{Budget, pixels};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Differences of the channels of two pictures on white, of 255: mean, at the 99th hundredth, most.
fn differences(document: &Document, merged: &Merged) -> (f64, i32, i32) {
    let size = document.size;
    let shown = flatten(document, &Progress::default()).unwrap().to_straight_rgba(size.rect());
    let on_white = |pixel: &[u8; 4]| {
        let a = i32::from(pixel[3]);
        [0, 1, 2].map(|c| (i32::from(pixel[c]) * a + 255 * (255 - a) + 127) / 255)
    };
    let pairs = shown.as_chunks::<4>().0.iter().zip(merged.pixels.rgba.as_chunks::<4>().0);
    let mut all: Vec<i32> = pairs
        .flat_map(|(a, b)| {
            let (a, b) = (on_white(a), on_white(b));
            [0, 1, 2].map(|c| (a[c] - b[c]).abs())
        })
        .collect();
    all.sort_unstable();
    let mean = all.iter().map(|v| f64::from(*v)).sum::<f64>() / all.len() as f64;
    (mean, all[all.len() * 99 / 100], all[all.len() - 1])
}

/// The Photoshop files of a folder, and of those in it.
fn files_of(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let extension = path.extension().map(|text| text.to_ascii_lowercase());
        if path.is_dir() {
            found.extend(files_of(&path));
        } else if extension.is_some_and(|text| text == "psd" || text == "psb") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// What opens of a file: its layers, or its own picture with the layers hidden beneath it.
fn name_shown(document: &Document) -> &'static str {
    let is_own = |layer: &Arc<Layer>| layer.visible && layer.name == compare::PICTURE;
    if document.layers.last().is_some_and(is_own) { "own picture" } else { "layers" }
}

fn write_picture(folder: &str, name: &str, rgba: &[u8], size: Size) {
    let file = Path::new(folder).join(name.replace(['/', ' '], "_"));
    let png = pixels::encode_texels(&file, rgba.as_chunks().0, size).unwrap();
    std::fs::write(file, png.bytes()).unwrap();
}

/// Prints a table of the Photoshop files in the folder `PSD_FOLDER`: what opens, how far what their
/// layers show is from the picture in the file, and the notes. If `PSD_PICTURES` names a folder,
/// both pictures are written there.
#[test]
#[ignore = "needs a folder of files that Photoshop saved"]
fn layers_beside_the_pictures_in_the_files() {
    let folder = std::env::var("PSD_FOLDER").expect("PSD_FOLDER names a folder");
    let pictures = std::env::var("PSD_PICTURES").ok();
    let only = std::env::var("PSD_ONLY").unwrap_or_default();
    let (mut counts, mut shapes) = (BTreeMap::new(), BTreeMap::new());
    for file in files_of(Path::new(&folder)) {
        let name = file.strip_prefix(&folder).unwrap_or(&file).to_string_lossy().into_owned();
        if !name.contains(&only) {
            continue;
        }
        let bytes = std::fs::read(&file).unwrap();
        let budget = Budget::default();
        let opened = match psd::read(Path::new(&name), &bytes, &budget) {
            Ok(opened) => opened,
            Err(error) => {
                *counts.entry("refused").or_insert(0) += 1;
                println!("| {name} | refused | | | | {error}");
                continue;
            }
        };
        let mut parsed = parse(Path::new(&name), &bytes, &budget).unwrap();
        let merged = parsed.merged.take().filter(|merged| merged.is_real);
        let has_layers = !parsed.records.is_empty();
        parsed.records.iter().for_each(|record| count_shape(record, &mut shapes));
        let (document, _) = build_document(&mut parsed, &budget, &mut Vec::new());
        let verdict = match &merged {
            _ if !has_layers => "no layers",
            None => "no picture",
            Some(merged) if compare::is_blank(&merged.pixels.rgba) => "blank picture",
            Some(_) => name_shown(&opened.document),
        };
        *counts.entry(verdict).or_insert(0) += 1;
        let Some(merged) = merged.filter(|_| has_layers) else {
            println!("| {name} | {verdict} | | | | {}", opened.notes.join("; "));
            continue;
        };
        let (mean, p99, most) = differences(&document, &merged);
        println!("| {name} | {verdict} | {mean:.2} | {p99} | {most} | {}", opened.notes.join("; "));
        if let Some(pictures) = &pictures {
            let size = document.size;
            let shown = flatten(&document, &Progress::default()).unwrap();
            write_picture(
                pictures,
                &format!("{name}.layers.png"),
                &shown.to_straight_rgba(size.rect()),
                size,
            );
            write_picture(pictures, &format!("{name}.merged.png"), &merged.pixels.rgba, size);
        }
    }
    println!("{counts:?}");
    println!("shapes: {shapes:#?}");
}

/// Counts a shape: whether it is a live path, and if not, why.
fn count_shape(record: &LayerRecord, shapes: &mut BTreeMap<&'static str, usize>) {
    let why = record.converted.iter().find(|what| what.starts_with("it is no live path"));
    if let Some(what) = record.path.as_ref().map(|_| "live paths").or(why.copied()) {
        *shapes.entry(what).or_default() += 1;
    }
}
