//! Pictures compared with stored ones: the largest difference and where it is, a picture of the
//! fault, and how to accept it.

use image::{Rgba, RgbaImage};
use std::fs;
use std::path::{Path, PathBuf};

/// What a fault ends with.
pub const HOW_TO_ACCEPT: &str = "Look at the pictures named above (found, expected, difference). \
                                 If the change is meant, accept it: UPDATE_GOLDEN=1 cargo test --test program goldens";

/// Columns between the parts of a fault's picture.
pub const GAP: u32 = 4;
/// How much brighter the picture of a difference is than the difference.
const AMPLIFIED: u8 = 8;

/// How far two pictures are apart, in steps of a byte of premultiplied color: transparent pixels
/// are all equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    pub largest: u8,
    /// A pixel that differs so much, the first in reading order.
    pub at: (u32, u32),
    /// How many differ by more than the tolerance.
    pub pixels: usize,
}

impl Difference {
    /// Of two pictures of the same size.
    pub fn of(a: &RgbaImage, b: &RgbaImage, tolerance: u8) -> Self {
        assert_eq!(a.dimensions(), b.dimensions());
        let mut difference = Difference { largest: 0, at: (0, 0), pixels: 0 };
        for ((x, y, p), q) in a.enumerate_pixels().zip(b.pixels()) {
            let apart = apart(*p, *q).into_iter().max().unwrap_or(0);
            difference.pixels += usize::from(apart > tolerance);
            if apart > difference.largest {
                (difference.largest, difference.at) = (apart, (x, y));
            }
        }
        difference
    }
}

/// Of each channel.
fn apart(p: Rgba<u8>, q: Rgba<u8>) -> [u8; 4] {
    let (p, q) = (premultiplied(p), premultiplied(q));
    std::array::from_fn(|c| p[c].abs_diff(q[c]))
}

fn premultiplied(Rgba([r, g, b, a]): Rgba<u8>) -> [u8; 4] {
    let by_alpha = |v: u8| ((u32::from(v) * u32::from(a) + 127) / 255) as u8;
    [by_alpha(r), by_alpha(g), by_alpha(b), a]
}

/// Where a reference picture is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// `folder/name` of the file.
    pub file: String,
    /// A square of a sheet, counted row by row: which one, and how wide squares are.
    tile: Option<(u32, u32)>,
}

/// Squares in a row of a sheet.
const COLUMNS: u32 = 7;

impl Place {
    /// A file of its own.
    pub fn alone(name: &str) -> Self {
        Self { file: name.to_owned(), tile: None }
    }

    /// A square of a sheet, from 0.
    pub fn tile(sheet: &str, index: u32, side: u32) -> Self {
        Self { file: sheet.to_owned(), tile: Some((index, side)) }
    }

    /// Whether it is a square of a sheet.
    pub fn is_tile(&self) -> bool {
        self.tile.is_some()
    }

    fn path(&self, references: &Path) -> PathBuf {
        references.join(format!("{}.png", self.file))
    }

    /// The upper left corner of a square.
    fn corner(index: u32, side: u32) -> (u32, u32) {
        (index % COLUMNS * side, index / COLUMNS * side)
    }

    /// Stores a picture here; of a sheet the other squares stay.
    fn put(&self, references: &Path, picture: &RgbaImage) {
        let path = self.path(references);
        let Some((index, side)) = self.tile else { return save(&path, picture) };
        let (x, y) = Self::corner(index, side);
        let known = read(&path).unwrap_or_default();
        let mut sheet = RgbaImage::new(COLUMNS * side, known.height().max(y + side));
        image::imageops::replace(&mut sheet, &known, 0, 0);
        image::imageops::replace(&mut sheet, picture, x.into(), y.into());
        save(&path, &sheet);
    }
}

/// Where references are, where faults are shown, and whether differences are accepted.
pub struct Found<'a> {
    pub references: &'a Path,
    pub faults: &'a Path,
    pub accept: bool,
}

/// Compares a picture with the one that is stored for it; `UPDATE_GOLDEN=1` stores it where they
/// differ.
pub fn check(
    references: &Path,
    name: &str,
    place: &Place,
    found: &RgbaImage,
    tolerance: u8,
) -> Result<(), String> {
    let faults = faults();
    let accept = std::env::var_os("UPDATE_GOLDEN").is_some_and(|value| value == "1");
    Found { references, faults: &faults, accept }.check(name, place, found, tolerance)
}

/// The folder that faults are shown in, below `target`.
pub fn faults() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("goldens")
}

impl Found<'_> {
    /// * `name`: of the case, for messages and the picture of its fault.
    pub fn check(
        &self,
        name: &str,
        place: &Place,
        found: &RgbaImage,
        tolerance: u8,
    ) -> Result<(), String> {
        let fault = match stored(self.references, place) {
            Err(missing) => format!("{name}: {missing}"),
            Ok(expected) if expected.dimensions() != found.dimensions() => {
                format!("{name}: {:?} pixels, not {:?}", found.dimensions(), expected.dimensions())
            }
            Ok(expected) => {
                let Difference { largest, at, pixels } =
                    Difference::of(found, &expected, tolerance);
                if largest <= tolerance {
                    return Ok(());
                }
                let shown = self.faults.join(format!("{name}.png"));
                save(&shown, &side_by_side(found, &expected));
                let plural = if pixels == 1 { "pixel differs" } else { "pixels differ" };
                let place = format!("by up to {largest} at {at:?}; {tolerance} is allowed");
                format!("{name}: {pixels} {plural}, {place}; see {}", shown.display())
            }
        };
        if self.accept {
            place.put(self.references, found);
            println!("accepted: {fault}");
            return Ok(());
        }
        Err(fault)
    }
}

/// A stored picture, or a sentence.
pub fn stored(references: &Path, place: &Place) -> Result<RgbaImage, String> {
    let path = place.path(references);
    let picture = read(&path)?;
    let Some((index, side)) = place.tile else { return Ok(picture) };
    let (x, y) = Place::corner(index, side);
    if x + side > picture.width() || y + side > picture.height() {
        return Err(format!("{}: has no square {index}", path.display()));
    }
    Ok(image::imageops::crop_imm(&picture, x, y, side, side).to_image())
}

fn read(path: &Path) -> Result<RgbaImage, String> {
    image::open(path)
        .map(|picture| picture.to_rgba8())
        .map_err(|e| format!("{}: {e}", path.display()))
}

fn save(path: &Path, picture: &RgbaImage) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    picture.save(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

/// Found, expected, and the difference made plain.
fn side_by_side(found: &RgbaImage, expected: &RgbaImage) -> RgbaImage {
    let (width, height) = found.dimensions();
    let mut shown = RgbaImage::new(3 * width + 2 * GAP, height);
    for ((x, y, &p), &q) in found.enumerate_pixels().zip(expected.pixels()) {
        let [r, g, b, a] = apart(p, q).map(|v| v.saturating_mul(AMPLIFIED));
        shown.put_pixel(x, y, p);
        shown.put_pixel(x + width + GAP, y, q);
        shown.put_pixel(x + 2 * (width + GAP), y, Rgba([r.max(a), g.max(a), b.max(a), 255]));
    }
    shown
}

/// The picture moved by whole pixels; its edge is repeated.
pub fn moved(picture: &RgbaImage, dx: i32, dy: i32) -> RgbaImage {
    let (width, height) = picture.dimensions();
    let from = |v: u32, by: i32, n: u32| (v as i32 - by).clamp(0, n as i32 - 1) as u32;
    RgbaImage::from_fn(width, height, |x, y| {
        *picture.get_pixel(from(x, dx, width), from(y, dy, height))
    })
}
