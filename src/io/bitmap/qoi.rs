//! QOI, the “Quite OK Image” format: runs, differences and a table of 64 recent colors, by its
//! specification of 2022 (qoiformat.org). Floor 5.

use super::{Bitmap, room, weight};
use crate::{Budget, Error, Result};
use image::{DynamicImage, ImageBuffer, metadata::Orientation};
use std::path::Path;

const HEADER: usize = 14;

/// Decodes a QOI file. Fails where it ends before its last pixel.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Bitmap> {
    let short = || Error::decode(file, "the QOI data is cut short");
    let header = bytes.first_chunk::<HEADER>().ok_or_else(short)?;
    let side = |i: usize| u32::from_be_bytes([0, 1, 2, 3].map(|k| header[i + k]));
    let size = budget.size(file, side(4).into(), side(8).into())?;
    let area = size.area();
    weight::plausible(file, size, area as u64 * 32, bytes.len())?;
    room(file, size, area as u64 * 4, budget)?;
    let pixels = pixels(&bytes[HEADER..], area).ok_or_else(short)?;
    let (width, height) = (size.width, size.height);
    let image = match header[12] {
        3 => {
            let rgb = pixels.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect();
            ImageBuffer::from_raw(width, height, rgb).map(DynamicImage::ImageRgb8)
        }
        4 => ImageBuffer::from_raw(width, height, pixels.into_flattened())
            .map(DynamicImage::ImageRgba8),
        channels => {
            let reason = format!("the QOI header promises {channels} channels; it may have 3 or 4");
            return Err(Error::decode(file, reason));
        }
    };
    let image = image.ok_or_else(short)?;
    let orientation = Orientation::NoTransforms;
    Ok(Bitmap { image, icc: None, orientation, format: "QOI", warning: None })
}

fn pixels(data: &[u8], area: usize) -> Option<Vec<[u8; 4]>> {
    let mut bytes = data.iter().copied();
    let mut recent = [[0u8; 4]; 64];
    let mut last = [0, 0, 0, 255];
    let mut out: Vec<[u8; 4]> = Vec::with_capacity(area);
    while out.len() < area {
        let tag = bytes.next()?;
        let low = tag & 63;
        let mut run = 1;
        let [r, g, b, a] = last;
        last = match tag {
            0xfe => [bytes.next()?, bytes.next()?, bytes.next()?, a],
            0xff => [bytes.next()?, bytes.next()?, bytes.next()?, bytes.next()?],
            _ => match tag >> 6 {
                0 => recent[usize::from(low)],
                1 => {
                    let by = |c: u8, shift: u8| c.wrapping_add(low >> shift & 3).wrapping_sub(2);
                    [by(r, 4), by(g, 2), by(b, 0), a]
                }
                2 => {
                    let (green, rest) = (low.wrapping_sub(32), bytes.next()?);
                    let by = |c: u8, d: u8| c.wrapping_add(green).wrapping_add(d).wrapping_sub(8);
                    [by(r, rest >> 4), g.wrapping_add(green), by(b, rest & 15), a]
                }
                _ => {
                    run = usize::from(low) + 1;
                    last
                }
            },
        };
        let [r, g, b, a] = last.map(usize::from);
        recent[(r * 3 + g * 5 + b * 7 + a * 11) % 64] = last;
        out.extend(std::iter::repeat_n(last, run.min(area - out.len())));
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(width: u32, channels: u8, data: &[u8]) -> Vec<u8> {
        let sides = [width.to_be_bytes(), 1u32.to_be_bytes()].concat();
        [b"qoif", &sides[..], &[channels, 0], data, &[0, 0, 0, 0, 0, 0, 0, 1]].concat()
    }

    #[test]
    fn every_kind_of_chunk_is_read() {
        // A color; one up in red and one down in blue; green + 5 with red + 8 and blue + 2;
        // a run of two; the first color from the table; one with alpha.
        let index = (10 * 3 + 20 * 5 + 30 * 7 + 255 * 11) % 64;
        let data = [
            &[0xfe, 10, 20, 30][..],
            &[0x40 | 3 << 4 | 2 << 2 | 1],
            &[0x80 | 37, 11 << 4 | 5],
            &[0xc1],
            &[index as u8],
            &[0xff, 1, 2, 3, 4],
        ];
        let bytes = file(7, 4, &data.concat());
        let read = super::super::decode(Path::new("a.qoi"), &bytes, &Budget::default()).unwrap();
        let expected = [
            [10, 20, 30, 255],
            [11, 20, 29, 255],
            [19, 25, 31, 255],
            [19, 25, 31, 255],
            [19, 25, 31, 255],
            [10, 20, 30, 255],
            [1, 2, 3, 4],
        ];
        assert_eq!(read.image.into_rgba8().into_raw(), expected.concat());
    }

    #[test]
    fn a_cut_file_and_a_header_without_pixels_get_a_sentence() {
        let said = |bytes: &[u8]| decode(Path::new("a.qoi"), bytes, &Budget::default()).err();
        assert!(said(&file(30_000, 4, &[0xc1])).unwrap().to_string().contains("cut short"));
        let mut wide = file(60_000, 4, &[0xc1]);
        wide[8..12].copy_from_slice(&1500u32.to_be_bytes());
        assert!(said(&wide).is_some());
        assert!(said(&file(1, 9, &[0xc1])).unwrap().to_string().contains("9 channels"));
    }
}
