//! GIMP's patterns: a picture that repeats. Floor 5.

use crate::Budget;
use crate::psd::cursor::ByteCursor;
use crate::raster::Picture;
use crate::{Error, Result};
use std::path::Path;

const MAGIC: [u8; 4] = *b"GPAT";

pub fn is_pat(bytes: &[u8]) -> bool {
    bytes.get(20..24) == Some(&MAGIC)
}

/// Reads a pattern of gray or color, with or without alpha.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Picture> {
    let cut = || Error::decode(file, "the pattern is cut short");
    let mut cursor = ByteCursor::new(bytes);
    let mut number = || cursor.u32().ok_or_else(cut);
    let [header, version, width, height, channels] =
        [number()?, number()?, number()?, number()?, number()?];
    if cursor.key().ok_or_else(cut)? != MAGIC {
        return Err(Error::decode(file, "it does not begin like a GIMP pattern"));
    }
    if version != 1 || !(1..=4).contains(&channels) {
        let reason = format!("a GIMP pattern of version {version} with {channels} bytes a pixel");
        return Err(Error::unsupported_file(file, reason));
    }
    let size = budget.size(file, u64::from(width), u64::from(height))?;
    // The rest of the header is the name.
    (header as usize).checked_sub(24).and_then(|n| cursor.take(n)).ok_or_else(cut)?;
    let texels = cursor.take(size.area() * channels as usize).ok_or_else(cut)?;
    let texels = match channels {
        1 => texels.iter().map(|&v| [v, v, v, 255]).collect(),
        2 => texels.as_chunks().0.iter().map(|&[v, a]| [v, v, v, a]).collect(),
        3 => texels.as_chunks().0.iter().map(|&[r, g, b]| [r, g, b, 255]).collect(),
        _ => texels.as_chunks().0.to_vec(),
    };
    Picture::srgb8(size, texels).ok_or_else(cut)
}
