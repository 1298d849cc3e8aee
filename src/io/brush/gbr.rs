//! GIMP's brushes, versions 1 to 3: a picture of coverage or of colors, a name, a spacing.
//! Floor 5.

use super::{ImportedBrush, TipNames, text_of};
use crate::Budget;
use crate::math::Size;
use crate::psd::cursor::ByteCursor;
use crate::raster::Picture;
use crate::{Error, Result};
use std::path::Path;

/// One brush of a file.
pub struct GbrBrush {
    pub name: String,
    pub picture: Picture,
    /// The picture is coverage, as opaque grays; else it has colors of its own.
    pub is_coverage: bool,
    /// As a share of the longer side; GIMP's own default if the file is older than spacings.
    pub spacing: f32,
}

const MAGIC: [u8; 4] = *b"GIMP";
/// A pattern that may follow a gray brush and gives it colors, from before brushes had their own.
const PATTERN: [u8; 4] = *b"GPAT";
const SPACING: f32 = 0.25;

pub fn is_gbr(bytes: &[u8]) -> bool {
    bytes.get(20..24) == Some(&MAGIC)
}

pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ImportedBrush> {
    let mut cursor = ByteCursor::new(bytes);
    let stamp = next(file, &mut cursor, budget)?;
    let mut tips = TipNames::default();
    let tip = tips.add(file, stamp.picture, &stamp.name);
    Ok(ImportedBrush::stamp(stamp.name, tip, stamp.spacing))
}

/// Reads the brush at the cursor, and moves the cursor behind it.
pub fn next(file: &Path, cursor: &mut ByteCursor, budget: &Budget) -> Result<GbrBrush> {
    let cut = || Error::decode(file, "the brush is cut short");
    let start = cursor.rest().len();
    let mut number = || cursor.u32().ok_or_else(cut);
    let [header, version, width, height, kind] =
        [number()?, number()?, number()?, number()?, number()?];
    let spacing = match version {
        1 => SPACING,
        2 | 3 => {
            if cursor.key().ok_or_else(cut)? != MAGIC {
                return Err(Error::decode(file, "it does not begin like a GIMP brush"));
            }
            // Per cent; the greatest spacing is ten times the size.
            cursor.u32().ok_or_else(cut)?.clamp(1, 1000) as f32 / 100.0
        }
        _ => {
            return Err(Error::unsupported_file(
                file,
                format!("version {version} of GIMP's brushes"),
            ));
        }
    };
    let size = budget.size(file, u64::from(width), u64::from(height))?;
    let name =
        (header as usize).checked_sub(start - cursor.rest().len()).and_then(|n| cursor.take(n));
    let name = text_of(name.ok_or_else(cut)?);
    let depth = GbrDepth::of(version, kind).ok_or_else(|| {
        Error::unsupported_file(
            file,
            format!("a GIMP brush of version {version} with {kind} bytes a pixel"),
        )
    })?;
    let texels = texels(cursor.take(size.area() * depth.bytes()).ok_or_else(cut)?, depth);
    let colors = read_pattern_colors(cursor, size, &texels);
    let is_coverage = depth != GbrDepth::Rgba && colors.is_none();
    let picture = Picture::srgb8(size, colors.unwrap_or(texels)).ok_or_else(cut)?;
    Ok(GbrBrush { name, picture, is_coverage, spacing })
}

/// How a pixel is stored.
#[derive(Clone, Copy, PartialEq)]
enum GbrDepth {
    /// A byte of coverage.
    Gray,
    /// Straight colors.
    Rgba,
    /// CinePaint's: the upper half of a 32-bit float.
    Half,
}

impl GbrDepth {
    fn of(version: u32, kind: u32) -> Option<Self> {
        match (version, kind) {
            (1 | 2, 1) => Some(GbrDepth::Gray),
            (1 | 2, 4) => Some(GbrDepth::Rgba),
            (3, 18) => Some(GbrDepth::Half),
            _ => None,
        }
    }

    fn bytes(self) -> usize {
        match self {
            GbrDepth::Gray => 1,
            GbrDepth::Half => 2,
            GbrDepth::Rgba => 4,
        }
    }
}

/// Coverage becomes an opaque gray, which is how tips distinguish it from colors.
fn texels(bytes: &[u8], depth: GbrDepth) -> Vec<[u8; 4]> {
    let gray = |v: u8| [v, v, v, 255];
    match depth {
        GbrDepth::Gray => bytes.iter().map(|&v| gray(v)).collect(),
        GbrDepth::Rgba => bytes.as_chunks().0.to_vec(),
        GbrDepth::Half => {
            let value = |&[high, low]: &[u8; 2]| f32::from_be_bytes([high, low, 0, 0]);
            let byte = |v: f32| (v.max(0.0).min(1.0) * 255.0 + 0.5) as u8;
            bytes.as_chunks().0.iter().map(|half| gray(byte(value(half)))).collect()
        }
    }
}

/// A gray brush in the colors of the pattern at the cursor, if a pattern of its size is there.
fn read_pattern_colors(
    cursor: &mut ByteCursor,
    size: Size,
    coverage: &[[u8; 4]],
) -> Option<Vec<[u8; 4]>> {
    let mut ahead = *cursor;
    let start = ahead.rest().len();
    let [header, _, width, height, channels] =
        [ahead.u32()?, ahead.u32()?, ahead.u32()?, ahead.u32()?, ahead.u32()?];
    if ahead.key()? != PATTERN || (width, height, channels) != (size.width, size.height, 3) {
        return None;
    }
    ahead.take((header as usize).checked_sub(start - ahead.rest().len())?)?;
    let colors = ahead.take(size.area() * 3)?;
    *cursor = ahead;
    let (colors, _) = colors.as_chunks::<3>();
    Some(colors.iter().zip(coverage).map(|(&[r, g, b], &[a, ..])| [r, g, b, a]).collect())
}
