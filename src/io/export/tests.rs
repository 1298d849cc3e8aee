//! Files of pictures, read back.

use super::*;
use crate::{Overwrite, picture};

fn checker() -> (TileGrid, Size) {
    let size = Size::new(70, 3);
    let rgba: Vec<u8> = (0..size.area())
        .flat_map(|i| [(i * 7) as u8, (i * 3) as u8, 200, [255, 0][i % 2]])
        .collect();
    (TileGrid::from_straight_rgba(&rgba, 70, 3, 0, 0), size)
}

fn encode_sample(format: ExportFormat, options: ExportOptions) -> Result<Vec<u8>> {
    let (grid, size) = checker();
    encode(Path::new("out"), format, &grid, size, &options)
}

#[test]
fn lossless_formats_read_back_as_they_were() {
    let (grid, size) = checker();
    let straight = grid.to_straight_rgba(size.rect());
    for format in [ExportFormat::Png, ExportFormat::WebP] {
        let bytes = encode_sample(format, ExportOptions::default()).unwrap();
        let read = image::load_from_memory(&bytes).unwrap().to_rgba8();
        assert_eq!(read.as_raw(), &straight, "{format:?}");
    }
}

#[test]
fn an_exr_holds_linear_light() {
    let (grid, size) = checker();
    let bytes = encode_sample(ExportFormat::Exr, ExportOptions::default()).unwrap();
    let read = picture::decode(Path::new("out.exr"), &bytes, &Budget::default()).unwrap();
    let straight = grid.to_straight_rgba(size.rect());
    for (i, pixel) in straight.chunks_exact(4).enumerate().filter(|(_, p)| p[3] == 255) {
        let light = read.linear_at(i % 70, i / 70);
        assert!((light[0] - srgb::decode_u8(pixel[0])).abs() < 1e-3);
    }
}

#[test]
fn a_jpeg_of_a_transparent_picture_wants_a_background() {
    let error = encode_sample(ExportFormat::Jpeg, ExportOptions::default()).unwrap_err();
    assert_eq!(error.remedy(), Some(Remedy::Background), "{error}");
    let white = ExportOptions { background: Some(Color::WHITE), ..ExportOptions::default() };
    assert!(encode_sample(ExportFormat::Jpeg, white).is_ok());
}

#[test]
fn a_background_shows_through_by_as_much_as_is_missing() {
    let mut rgba = [200, 100, 0, 128, 1, 2, 3, 0, 9, 9, 9, 255];
    lay_on(&mut rgba, Color::WHITE);
    // 200 · 128/255 + 255 · 127/255 = 227.4
    assert_eq!(rgba, [227, 177, 127, 255, 255, 255, 255, 255, 9, 9, 9, 255]);
}

#[test]
fn a_target_is_replaced_whole_and_leaves_nothing_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.png");
    std::fs::write(&file, "old").unwrap();
    let said = OutputFile::new(&file, Terms::export(Overwrite::Nothing, Vec::new())).unwrap_err();
    assert!(matches!(said, Error::Changed { .. }), "{said}");
    OutputFile::new(&file, Terms::export(Overwrite::Forced, Vec::new()))
        .unwrap()
        .replace(b"new")
        .unwrap();
    assert_eq!(std::fs::read(&file).unwrap(), b"new");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_target_that_came_to_be_since_it_was_checked_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.png");
    let target = OutputFile::new(&file, Terms::export(Overwrite::Nothing, Vec::new())).unwrap();
    std::fs::write(&file, "somebody's").unwrap();
    assert!(matches!(target.replace(b"new"), Err(Error::Changed { .. })));
    assert_eq!(std::fs::read(&file).unwrap(), b"somebody's");
}

#[test]
fn names_that_ask_for_nothing_are_refused() {
    assert!(
        ExportFormat::of(Path::new("a.gif")).unwrap_err().to_string().contains(".png, .exr, .jpg")
    );
    let terms = || Terms::export(Overwrite::Forced, Vec::new());
    assert!(OutputFile::new(Path::new("a.gif"), terms()).is_err());
    let said = OutputFile::new(Path::new("no such folder/a.png"), terms()).unwrap_err().to_string();
    assert!(said.contains("there is no folder no such folder"), "{said}");
}
