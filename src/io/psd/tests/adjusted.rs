//! Adjustment layers in files, and how near they come to the pictures that Photoshop made of them.

use crate::Budget;
use crate::document::{Document, Progress, flatten};
use crate::psd::merged::Merged;
use crate::psd::parse::parse;
use crate::psd::tree::build_document;
use std::path::Path;

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

/// Prints a table of the Photoshop files in the folder `PSD_FOLDER`: how far what their layers show
/// is from the picture in the file.
#[test]
#[ignore = "needs a folder of files that Photoshop saved"]
fn layers_beside_the_pictures_in_the_files() {
    let folder = std::env::var("PSD_FOLDER").expect("PSD_FOLDER names a folder");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "psd"));
    files.sort();
    for file in files {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let bytes = std::fs::read(&file).unwrap();
        let budget = Budget::default();
        let mut parsed = parse(Path::new(&name), &bytes, &budget).unwrap();
        let mut notes = Vec::new();
        let (document, is_less) = build_document(&mut parsed, &budget, &mut notes);
        let Some(merged) = parsed.merged.take() else { continue };
        let (mean, p99, most) = differences(&document, &merged);
        let left = if is_less { notes.join("; ") } else { String::new() };
        println!("| {name} | {mean:.2} | {p99} | {most} | {left}");
    }
}
