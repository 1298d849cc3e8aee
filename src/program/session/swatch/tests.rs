//! Every preset paints, and the sheets of the documentation show the results. `UPDATE_GOLDEN=1`
//! paints the sheets again.

use super::*;
use crate::document::source::MaskSource;
use crate::io::maps;
use crate::io::recipe::{PresetGroup, load_preset, presets};
use crate::io::{Budget, UserFiles};
use crate::session::storage::maps_of;
use std::path::{Path, PathBuf};

#[test]
fn every_preset_leaves_a_mark_on_the_ball() {
    for preset in presets().map(current) {
        let image = render_swatch(&preset, 96).unwrap();
        // A retouching brush paints with its flow.
        let brush = Brush { opacity: 0.0, flow: 0.0, ..preset.brush.clone() };
        let bare = render_swatch(&BrushPreset { brush, ..preset.clone() }, 96).unwrap();
        let pairs = image.as_chunks::<4>().0.iter().zip(bare.as_chunks::<4>().0);
        let marked =
            pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 12)).count();
        assert!(marked > 60, "{}: {marked}", preset.key);
    }
}

#[test]
fn a_picture_of_no_size_or_of_far_too_much_is_none() {
    let preset = presets().next().unwrap();
    assert!(render_swatch(&preset, 0).is_none() && render_swatch(&preset, 5000).is_none());
}

/// Side of one picture of a sheet, px.
const CELL: u32 = 128;

fn in_package(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// A sample surface, its middle square as large as a cell.
fn sample(name: &str) -> Arc<Surface> {
    let map = |part: &str| in_package(&format!("sample_normals/{name}/{part}.png"));
    let mut source = maps_of(Some(&map("normal")), Some(&map("depth")));
    let file = map("mask").to_string_lossy().into_owned();
    source.mask = Some(MaskSource::File { file, channel: None, invert: false });
    let surface = maps::import(&source, &UserFiles::default(), &Budget::default()).unwrap().surface;
    Arc::new(surface.fitted(Size::new(CELL, CELL)).unwrap())
}

/// A preset as its file is now, so that a file can be changed and looked at without a build.
fn current(preset: BrushPreset) -> BrushPreset {
    load_preset(&in_package(&format!("brushes/{}.json", preset.key)), &Budget::default()).unwrap()
}

/// A group's presets side by side, on the ball and on two samples below each other.
fn sheet(group: PresetGroup, samples: &[Arc<Surface>]) -> image::RgbImage {
    let presets: Vec<BrushPreset> =
        presets().map(current).filter(|preset| preset.group == group).collect();
    let mut sheet =
        image::RgbImage::new(CELL * presets.len() as u32, CELL * (1 + samples.len() as u32));
    for (column, preset) in (0..).zip(&presets) {
        let on_samples =
            samples.iter().map(|surface| render_swatch_on(preset, surface.clone()).unwrap());
        for (row, pixels) in
            (0..).zip(std::iter::once(render_swatch(preset, CELL).unwrap()).chain(on_samples))
        {
            for (i, &[r, g, b, a]) in (0..).zip(pixels.as_chunks::<4>().0) {
                // Off the surface there is paper.
                let over = |c: u8| {
                    ((u32::from(c) * u32::from(a) + 0xf2 * (255 - u32::from(a))) / 255) as u8
                };
                sheet.put_pixel(
                    column * CELL + i % CELL,
                    row * CELL + i / CELL,
                    image::Rgb([r, g, b].map(over)),
                );
            }
        }
    }
    sheet
}

#[test]
fn the_sheets_of_the_documentation_show_what_the_presets_paint() {
    let samples = [sample("teapot"), sample("muse")];
    let page = std::fs::read_to_string(in_package("docs/BRUSHES.md")).unwrap_or_default();
    let mut weight = 0;
    for (group, name) in
        PresetGroup::ALL.into_iter().filter(|(group, _)| *group != PresetGroup::Imported)
    {
        let painted = sheet(group, &samples);
        let file = in_package(&format!("docs/brushes/{}.jpg", crate::io::brush::plain(name)));
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            let mut bytes = Vec::new();
            image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 72)
                .encode_image(&painted)
                .unwrap();
            std::fs::write(&file, bytes).unwrap();
        }
        let shown =
            image::open(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display())).to_rgb8();
        assert_eq!(shown.dimensions(), painted.dimensions(), "{name}");
        let difference: u64 =
            shown.iter().zip(painted.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        let mean = difference as f64 / painted.len() as f64;
        assert!(mean < 4.0, "{name}: the sheet differs from what is painted by {mean:.1} of 255");
        weight += std::fs::metadata(&file).unwrap().len();
        for preset in presets().filter(|preset| preset.group == group) {
            assert!(
                page.contains(&format!("`{}`", preset.key)),
                "docs/BRUSHES.md has no `{}`",
                preset.key
            );
            assert!(
                page.contains(&preset.about),
                "docs/BRUSHES.md does not say what `{}` is",
                preset.key
            );
        }
    }
    assert!(weight < 300 << 10, "the sheets weigh {weight} bytes together");
}
