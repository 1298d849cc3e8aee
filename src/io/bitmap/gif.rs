//! The first frame of a GIF, by the specification of GIF89a. Floor 5. LZW is `weezl`'s.

use super::{Bitmap, room, weight};
use crate::{Budget, Error, Result};
use image::{DynamicImage, ImageBuffer, metadata::Orientation};
use std::path::Path;
use weezl::{BitOrder, LzwStatus, decode::Configuration};

/// Where a frame lies, and what it is made of.
struct GifFrame {
    /// Left, top, width, height.
    place: [usize; 4],
    palette: Vec<u8>,
    is_interlaced: bool,
    /// The palette index that is transparent.
    clear: Option<u8>,
    least_bits: u8,
    data: Vec<u8>,
    has_others_after: bool,
}

/// Decodes the first frame on a transparent canvas. Where its data is cut short, the rest stays
/// transparent, with a warning.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Bitmap> {
    let damaged = || Error::decode(file, "the GIF data is damaged or cut short");
    let side = |at: usize| number(bytes, at).map(|side| side as u64);
    let [width, height] = [side(6), side(8)].map(|side| side.ok_or_else(damaged));
    let frame = first_frame(bytes).ok_or_else(damaged)?;
    let [x, y, w, h] = frame.place;
    // Some programs write a canvas of no size.
    let (width, height) = (width?.max((x + w) as u64), height?.max((y + h) as u64));
    let size = budget.size(file, width, height)?;
    let area = size.area();
    weight::plausible(file, size, area as u64 * 8, bytes.len())?;
    room(file, size, area as u64 * 6, budget)?;
    let mut indices = vec![0; w * h];
    let bits = frame.least_bits;
    if !(1..=8).contains(&bits) {
        return Err(damaged());
    }
    let mut decoder = Configuration::new(BitOrder::Lsb, bits).build();
    let (mut read, mut filled) = (0, 0);
    while filled < indices.len() {
        let step = decoder.decode_bytes(&frame.data[read..], &mut indices[filled..]);
        (read, filled) = (read + step.consumed_in, filled + step.consumed_out);
        if !matches!(step.status, Ok(LzwStatus::Ok)) {
            break;
        }
    }
    let mut pixels = vec![[0u8; 4]; area];
    for (row, line) in rows(h, frame.is_interlaced).zip(indices[..filled].chunks(w.max(1))) {
        for (i, &index) in line.iter().enumerate() {
            let color = frame.palette.as_chunks::<3>().0.get(usize::from(index));
            if let (Some(&[r, g, b]), true) = (color, frame.clear != Some(index)) {
                pixels[(y + row) * size.width as usize + x + i] = [r, g, b, 255];
            }
        }
    }
    let warning = match (filled < w * h, frame.has_others_after) {
        (true, _) => Some("the GIF is cut short; what is missing is transparent"),
        (_, true) => Some("it is an animation; this is its first frame"),
        _ => None,
    };
    let image = ImageBuffer::from_raw(size.width, size.height, pixels.into_flattened());
    let image = image.map(DynamicImage::ImageRgba8).ok_or_else(damaged)?;
    let orientation = Orientation::NoTransforms;
    Ok(Bitmap { image, icc: None, orientation, format: "GIF", warning })
}

fn number(bytes: &[u8], at: usize) -> Option<usize> {
    Some(usize::from(u16::from_le_bytes([*bytes.get(at)?, *bytes.get(at + 1)?])))
}

/// The rows of a frame in the order in which they are stored.
fn rows(height: usize, is_interlaced: bool) -> impl Iterator<Item = usize> {
    let passes: &[(usize, usize)] =
        if is_interlaced { &[(0, 8), (4, 8), (2, 4), (1, 2)] } else { &[(0, 1)] };
    passes.iter().flat_map(move |&(first, step)| (first..height).step_by(step))
}

/// The length of a palette, if the flags say that there is one.
fn palette_bytes(flags: u8) -> usize {
    if flags & 0x80 == 0 { 0 } else { 3 << ((flags & 7) + 1) }
}

fn first_frame(bytes: &[u8]) -> Option<GifFrame> {
    let flags = *bytes.get(10)?;
    let mut at = 13 + palette_bytes(flags);
    let common = bytes.get(13..at)?;
    let mut clear = None;
    loop {
        match *bytes.get(at)? {
            0x21 => {
                let is_control = *bytes.get(at + 1)? == 0xf9;
                if is_control && *bytes.get(at + 3)? & 1 == 1 {
                    clear = bytes.get(at + 6).copied();
                }
                at = blocks(bytes, at + 2, &mut Vec::new())?;
            }
            0x2c => break,
            _ => return None,
        }
    }
    let place = [1, 3, 5, 7].map(|i| number(bytes, at + i).unwrap_or(0));
    let flags = *bytes.get(at + 9)?;
    let own = at + 10..at + 10 + palette_bytes(flags);
    let palette = if own.is_empty() { common } else { bytes.get(own.clone())? }.to_vec();
    let (least_bits, mut data) = (*bytes.get(own.end)?, Vec::new());
    let end = blocks(bytes, own.end + 1, &mut data);
    let has_others_after = end.is_some_and(|end| has_frame(bytes, end));
    let is_interlaced = flags & 0x40 != 0;
    Some(GifFrame { place, palette, is_interlaced, clear, least_bits, data, has_others_after })
}

/// Whether another frame follows.
fn has_frame(bytes: &[u8], mut at: usize) -> bool {
    while bytes.get(at) == Some(&0x21) {
        let Some(end) = blocks(bytes, at + 2, &mut Vec::new()) else { return false };
        at = end;
    }
    bytes.get(at) == Some(&0x2c)
}

/// Gathers blocks of up to 255 bytes; where they end, or `None` if the file does so before.
fn blocks(bytes: &[u8], mut at: usize, out: &mut Vec<u8>) -> Option<usize> {
    loop {
        let length = usize::from(*bytes.get(at)?);
        let end = (at + 1 + length).min(bytes.len());
        out.extend(&bytes[at + 1..end]);
        at = at + 1 + length;
        if length == 0 {
            return Some(at);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A canvas of 4 × 3 with a frame of 2 × 2 at (1, 1), of which color 2 is transparent.
    fn gif(frames: usize) -> Vec<u8> {
        let palette = [9, 8, 7, 200, 100, 50, 1, 1, 1, 0, 0, 0];
        let data = weezl::encode::Encoder::new(BitOrder::Lsb, 2).encode(&[0, 1, 2, 1]).unwrap();
        let control = [0x21, 0xf9, 4, 1, 0, 0, 2, 0];
        let place = [0x2c, 1, 0, 1, 0, 2, 0, 2, 0, 0, 2, data.len() as u8];
        let frame = [&control[..], &place, &data, &[0]].concat().repeat(frames);
        [b"GIF89a\x04\0\x03\0\x81\0\0", &palette[..], &frame, b";"].concat()
    }

    fn read(bytes: &[u8]) -> Result<Bitmap> {
        super::super::decode(Path::new("a.gif"), bytes, &Budget::default())
    }

    #[test]
    fn the_first_frame_lies_in_its_place_and_what_is_clear_stays_clear() {
        let image = read(&gif(1)).unwrap().image.into_rgba8();
        assert_eq!(image.dimensions(), (4, 3));
        let at = |x, y| image.get_pixel(x, y).0;
        assert_eq!([at(1, 1), at(2, 1)], [[9, 8, 7, 255], [200, 100, 50, 255]]);
        assert_eq!([at(1, 2), at(2, 2), at(0, 0)], [[0; 4], [200, 100, 50, 255], [0; 4]]);
    }

    #[test]
    fn an_animation_and_a_cut_file_are_said_to_be_such() {
        let warned = |bytes: &[u8]| read(bytes).unwrap().warning.unwrap_or_default();
        assert_eq!(warned(&gif(1)), "");
        assert!(warned(&gif(3)).contains("an animation"));
        let whole = gif(1);
        let cut = whole.len() - 4;
        assert!(warned(&whole[..cut]).contains("cut short"), "{:?}", warned(&whole[..cut]));
        for length in 6..whole.len() {
            let _ = read(&whole[..length]);
        }
        assert!(read(&whole[..20]).err().unwrap().to_string().contains("damaged or cut short"));
    }

    #[test]
    fn interlaced_rows_come_in_four_passes() {
        assert_eq!(rows(9, true).collect::<Vec<_>>(), [0, 8, 4, 2, 6, 1, 3, 5, 7]);
    }
}
