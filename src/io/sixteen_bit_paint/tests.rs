//! Pictures of more than 8 bits as paint: opened, saved, exported, and short of memory.

use super::*;
use crate::document::Progress;
use crate::export::{ExportOptions, OutputFile};
use crate::exr::encode_channels;
use crate::math::{Size, hash, srgb};
use crate::project::sample::{smoothly_painted, tiles16};
use crate::raster::TileGrid;
use crate::{OpenedDocument, Overwrite, Terms, open, save};
use image::{DynamicImage, ImageBuffer, ImageFormat, Rgb, Rgba};
use std::io::Cursor;

const STEPS: u32 = 4096;

/// The value of a step.
fn step(i: u32) -> u16 {
    (i * 65535 / (STEPS - 1)) as u16
}

fn encode(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    image.write_to(&mut out, format).unwrap();
    out.into_inner()
}

/// A ramp whose steps a byte cannot tell apart, rising in red and falling in green.
fn ramp() -> DynamicImage {
    let pixel = |x: u32, _| Rgba([step(x), step(STEPS - 1 - x), 0, 65535]);
    DynamicImage::ImageRgba16(ImageBuffer::from_fn(STEPS, 3, pixel))
}

fn linear_ramp() -> Vec<f32> {
    (0..STEPS * 3).map(|i| srgb::decode(f32::from(step(i % STEPS)) / 65535.0)).collect()
}

fn pixels(document: &Document, layer: usize) -> &TileGrid {
    match &document.layers[layer].content {
        Content::Pixels(pixels) => &pixels.tiles,
        _ => panic!("a paint layer"),
    }
}

/// The reds of the upper row, as a picture of 16 bits that is exported.
fn export_reds(document: &Document, file: &Path) -> Vec<u16> {
    let options = ExportOptions { bits: Some(16), ..ExportOptions::default() };
    let target = OutputFile::new(file, Terms::from(Overwrite::Forced)).unwrap();
    target.write_document(document, &options, &Budget::default(), &Progress::default()).unwrap();
    let image = image::open(file).unwrap().to_rgba16();
    image.pixels().take(image.width() as usize).map(|pixel| pixel.0[0]).collect()
}

#[track_caller]
fn assert_ramp(found: &[u16], what: &str) {
    assert_eq!(found.len(), STEPS as usize, "{what}");
    let apart = (0..STEPS).map(|i| found[i as usize].abs_diff(step(i))).max();
    assert!(apart <= Some(1), "{what}: {apart:?}");
}

#[test]
fn a_ramp_of_4096_steps_is_the_same_in_every_format_and_in_a_project() {
    let folder = tempfile::tempdir().unwrap();
    let dark = vec![0.0; (STEPS * 3) as usize];
    let light = encode_channels(
        Path::new("a.exr"),
        Size::new(STEPS, 3),
        vec![("R", linear_ramp()), ("G", dark.clone()), ("B", dark)],
    );
    let floats = linear_ramp().into_iter().flat_map(|v| [v, 0.0, 0.0]).collect();
    let floats = ImageBuffer::<Rgb<f32>, _>::from_raw(STEPS, 3, floats).unwrap();
    let files = [
        ("a.png", encode(&ramp(), ImageFormat::Png)),
        ("a.tif", encode(&ramp(), ImageFormat::Tiff)),
        ("f.tif", encode(&DynamicImage::ImageRgb32F(floats), ImageFormat::Tiff)),
        ("a.exr", light.unwrap()),
    ];
    for (name, bytes) in files {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        let opened = open(&file, &Budget::default()).unwrap();
        assert_eq!((opened.notes, opened.is_whole), (vec![], true), "{name}");
        assert_ramp(&export_reds(&opened.document, &folder.path().join("out.png")), name);
        let project = folder.path().join("saved.ora");
        save(&opened.document, &project, Overwrite::Forced, &Progress::default()).unwrap().unwrap();
        let again = open(&project, &Budget::default()).unwrap();
        let rect = opened.document.size.rect();
        let bits = |document| pixels(document, 0).to_straight16(rect);
        assert!(bits(&again.document) == bits(&opened.document), "{name} in a project");
    }
}

#[test]
fn a_picture_of_8_bits_takes_no_more_than_its_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let value = |x: u32, y: u32| hash::mix(x * 131 + y).to_le_bytes();
    let picture = image::RgbaImage::from_fn(200, 130, |x, y| Rgba(value(x, y)));
    let wanted = TileGrid::from_straight_rgba(picture.as_raw(), 200, 130, 0, 0);
    let file = folder.path().join("a.png");
    std::fs::write(&file, encode(&DynamicImage::ImageRgba8(picture), ImageFormat::Png)).unwrap();
    let opened = open(&file, &Budget::default()).unwrap().document;
    let (found, rect) = (pixels(&opened, 0), wanted.bounds());
    assert!(found.to_straight_rgba(rect) == wanted.to_straight_rgba(rect));
    assert_eq!(found.bytes(), wanted.bytes());
    // Values in 16 bits that bytes hold too.
    let opaque =
        ImageBuffer::from_fn(200, 130, |x, y| Rgb([257 * (x as u16), 257 * (y as u16), 0]));
    let file = folder.path().join("c.png");
    std::fs::write(&file, encode(&DynamicImage::ImageRgb16(opaque), ImageFormat::Png)).unwrap();
    assert_eq!(tiles16(&open(&file, &Budget::default()).unwrap().document), [0]);
}

/// Files of 512 × 512 pixels of noise, whose 16 bits take 3.1 MB and whose bytes take 1.0 MB.
fn noise() -> Vec<(&'static str, Vec<u8>)> {
    let value = |x: u32, y: u32, c: u32| (hash::unit(x, y, c) * 65536.0) as u16;
    let noise = ImageBuffer::from_fn(512, 512, |x, y| {
        Rgb([value(x, y, 0), value(x, y, 1), value(x, y, 2)])
    });
    let noise = DynamicImage::ImageRgb16(noise);
    let channel = |c: u32| (0..512 * 512).map(|i| hash::unit(i, c, 5)).collect::<Vec<f32>>();
    let light = |names: [[&'static str; 3]; 2], several: usize| {
        let names = names.into_iter().take(several).flatten();
        let channels = names.zip(0..).map(|(name, c)| (name, channel(c))).collect();
        encode_channels(Path::new("a.exr"), Size::new(512, 512), channels).unwrap()
    };
    let names = [["R", "G", "B"], ["b.R", "b.G", "b.B"]];
    vec![
        ("a.png", encode(&noise, ImageFormat::Png)),
        ("a.tif", encode(&noise, ImageFormat::Tiff)),
        ("a.exr", light(names, 1)),
        ("two.exr", light(names, 2)),
    ]
}

#[test]
fn what_does_not_fit_in_16_bits_is_read_with_8_and_a_note_says_so() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in noise() {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        let OpenedDocument { document: whole, notes, is_whole, .. } =
            open(&file, &Budget::default()).unwrap();
        assert!(is_whole && notes.iter().all(|note| !note.contains("memory")), "{name}: {notes:?}");
        let held: usize = (0..whole.layers.len()).map(|i| pixels(&whole, i).bytes()).sum();
        assert!(held > 3_140_000 * whole.layers.len(), "{name}: {held} bytes");
        // TIFFs are decoded as a whole first.
        let decoded = if name.ends_with("tif") { 1_200_000 } else { 0 };
        for free in [held as u64 - 1 + decoded, held as u64 + 1_000_000 + decoded / 4] {
            let little = Budget { memory_bytes: free, ..Budget::default() };
            let opened =
                open(&file, &little).unwrap_or_else(|e| panic!("{name}, {free} bytes: {e}"));
            assert_eq!(opened.notes.last().map(String::as_str), Some(NOTE), "{name}, {free} bytes");
            assert!(!opened.is_whole);
            for i in 0..whole.layers.len() {
                let (found, wanted) = (pixels(&opened.document, i), pixels(&whole, i));
                assert!(!found.is_16_bit_in(found.bounds()), "{name}");
                assert!(
                    wanted.iter().all(|(at, tile)| found.tile(at).unwrap().bytes() == tile.bytes()),
                    "{name}"
                );
            }
        }
        let less = Budget { memory_bytes: 700_000, ..Budget::default() };
        let said = open(&file, &less).err().unwrap();
        assert_eq!(said.remedy(), Some(Remedy::MoreMemory), "{name}: {said}");
    }
}

#[test]
fn a_project_whose_16_bits_do_not_fit_opens_with_8_and_is_not_whole() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("soft.ora");
    let document = smoothly_painted();
    save(&document, &file, Overwrite::Nothing, &Progress::default()).unwrap().unwrap();
    let mut held = MemoryCount::default();
    held.add(&document, true);
    // Too little to flatten it, and too little to hold it.
    for free in [held.sum_up().total(), held.sum_up().total() / 2] {
        let opened = open(&file, &Budget { memory_bytes: free, ..Budget::default() }).unwrap();
        assert_eq!(
            (opened.notes.as_slice(), opened.is_whole),
            (&[NOTE.to_owned()][..], false),
            "{free} bytes"
        );
        assert_eq!(tiles16(&opened.document), [0; 4], "{free} bytes");
        for (layer, was) in opened.document.layers.iter().zip(&document.layers) {
            if let (Content::Pixels(now), Content::Pixels(was)) = (&layer.content, &was.content) {
                let rect = was.tiles.bounds().union(now.tiles.bounds());
                assert!(
                    now.tiles.to_straight_rgba(rect) == was.tiles.to_straight_rgba(rect),
                    "{free} bytes"
                );
            }
        }
    }
    let kept = open(&file, &Budget::default()).unwrap();
    assert_eq!((tiles16(&kept.document), kept.is_whole), (tiles16(&document), true));
}
