//! The pictures that the cases name, made here and kept in memory.

use super::surfaces::SIZE;
use image::{Rgba, RgbaImage};
use rilievo::files::Files;
use rilievo::{Budget, Error, Result};
use std::collections::HashMap;
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::LazyLock;

/// What a recipe may name.
pub struct Pictures;

static FILES: LazyLock<HashMap<&str, Vec<u8>>> = LazyLock::new(|| {
    HashMap::from([
        ("tiles.png", png(40, 36, tiles)),
        ("sky.png", png(64, 32, sky)),
        ("sphere.png", png(48, 48, sphere)),
        ("leaf.png", png(32, 32, leaf)),
        ("dot.png", png(16, 16, dot)),
        ("mask.png", png(SIZE.width, SIZE.height, mask)),
    ])
});

impl Files for Pictures {
    fn read(&self, name: &str, _: &Budget) -> Result<Vec<u8>> {
        if name.starts_with("balls/") {
            let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("brushes").join(name);
            return std::fs::read(&path).map_err(|e| Error::io(name, e));
        }
        let missing = || Error::io(name, std::io::Error::from(std::io::ErrorKind::NotFound));
        FILES.get(name).cloned().ok_or_else(missing)
    }

    fn path(&self, name: &str) -> PathBuf {
        name.into()
    }
}

fn png(width: u32, height: u32, texel: fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let picture = RgbaImage::from_fn(width, height, |x, y| Rgba(texel(x, y)));
    picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Tiles of 5 px, no two rows or columns of them alike.
fn tiles(x: u32, y: u32) -> [u8; 4] {
    let (column, row) = ((x / 5) as u8, (y / 5) as u8);
    if (column + row).is_multiple_of(2) {
        [40 + 20 * column, 60 + 18 * row, 190, 255]
    } else {
        [240, 232 - 12 * row, 90 + 15 * column, 255]
    }
}

/// Bright above, dark below, a lamp at the right.
fn sky(x: u32, y: u32) -> [u8; 4] {
    let lamp = x.abs_diff(40) < 4 && y.abs_diff(10) < 3;
    let light = 255 - 6 * y as u8;
    if lamp {
        [255, 250, 220, 255]
    } else {
        [light - 40 + (x / 2) as u8, light, light.saturating_add(20), 255]
    }
}

/// Red to the right, green downward, a highlight at the upper left.
fn sphere(x: u32, y: u32) -> [u8; 4] {
    let (dx, dy) = (x as i32 - 15, y as i32 - 13);
    let light = (160 - 2 * (dx * dx + dy * dy)).max(0) as u8;
    [
        (40 + 3 * x as u8).saturating_add(light),
        (30 + 3 * y as u8).saturating_add(light),
        70 + light / 2,
        255,
    ]
}

/// A half disc with a notch, thinner to the right.
fn leaf(x: u32, y: u32) -> [u8; 4] {
    let (dx, dy) = (x as i32 - 16, y as i32 - 20);
    let inside = dx * dx + dy * dy < 190 && dy < 5 && !(dx.abs() < 3 && dy > -6);
    [30, 20, 10, if inside { 255 - 5 * x as u8 } else { 0 }]
}

/// A ring.
fn dot(x: u32, y: u32) -> [u8; 4] {
    let squared = (2 * x as i32 - 15).pow(2) + (2 * y as i32 - 15).pow(2);
    [0, 0, 0, if (60..200).contains(&squared) { 255 } else { 0 }]
}

/// Gray from left to right, with a hole.
fn mask(x: u32, y: u32) -> [u8; 4] {
    let gray = if x.abs_diff(50) < 9 && y.abs_diff(30) < 12 { 0 } else { 3 * x as u8 };
    [gray, gray, gray, 255]
}
