//! Memory limits for files of rows of numbers, before their pixels are decoded: how much their own
//! bits could hold, and what a PNG keeps besides its pixels. Floor 5.

use crate::math::Size;
use crate::{Error, Result};
use std::path::Path;

/// Refuses headers that promise more than the bytes that follow could hold.
///
/// * `bits`: total of all samples, as wide as the file stores them, before compression.
///
/// DEFLATE reaches 1032 : 1, LZW about 2500 : 1, one bit of fax a whole row.
pub fn plausible(file: &Path, size: Size, bits: u64, file_bytes: usize) -> Result<()> {
    const GRANTED: u64 = 8 << 20;
    if bits > GRANTED && bits / 8 / 4096 > file_bytes as u64 {
        let reason =
            format!("the header promises {size} pixels, far more than {file_bytes} bytes can hold");
        return Err(Error::decode(file, reason));
    }
    Ok(())
}

/// Bits of a pixel as a PNG stores it, by its header; `None` if that is incomplete.
pub fn png_pixel_bits(bytes: &[u8]) -> Option<u64> {
    let samples = match bytes.get(25)? {
        0 | 3 => 1,
        2 => 3,
        4 => 2,
        6 => 4,
        _ => return None,
    };
    Some(samples * u64::from(*bytes.get(24)?))
}

/// A PNG says that it has a color profile.
pub fn has_png_profile(bytes: &[u8]) -> bool {
    chunk_before_pixels(bytes, b"iCCP").is_some()
}

/// What a PNG says of its colors by code points (ITU-T H.273): primaries, transfer, matrix, range.
pub fn png_cicp(bytes: &[u8]) -> Option<[u8; 4]> {
    let at = chunk_before_pixels(bytes, b"cICP")?;
    bytes.get(at..)?.first_chunk().copied()
}

/// Where the content of a chunk begins that a PNG has before its pixels.
fn chunk_before_pixels(bytes: &[u8], wanted: &[u8; 4]) -> Option<usize> {
    let mut at = 8;
    while let Some(head) = bytes.get(at..).and_then(<[u8]>::first_chunk::<8>) {
        let ([a, b, c, d], kind) = ([head[0], head[1], head[2], head[3]], &head[4..]);
        match kind {
            kind if kind == wanted => return Some(at + 8),
            b"IDAT" => return None,
            _ => {
                at = at.saturating_add(u32::from_be_bytes([a, b, c, d]) as usize).saturating_add(12)
            }
        }
    }
    None
}
