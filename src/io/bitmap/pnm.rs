//! Netpbm's pictures: bits, gray and RGB as text or bytes (P1 to P6), PAM with alpha (P7), and the
//! floats of PFM. Floor 5.

use super::{Bitmap, room, weight};
use crate::math::Size;
use crate::{Budget, Error, Result};
use image::{DynamicImage, ImageBuffer, metadata::Orientation};
use std::path::Path;

/// What the header of a file says.
struct PnmHeader {
    size: [u64; 2],
    channels: usize,
    /// The value of white.
    most: u32,
    /// Where the samples begin.
    at: usize,
}

/// Decodes the first picture of a file. Fails where samples are missing.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Bitmap> {
    let kind = bytes.get(1).copied().unwrap_or(0);
    let header = if kind == b'7' { pam_header(bytes) } else { header(bytes, kind) };
    let header = header
        .filter(|header| (1..=4).contains(&header.channels) && (1..=65535).contains(&header.most))
        .ok_or_else(|| Error::decode(file, "the header of the PNM file is damaged"))?;
    let size = budget.size(file, header.size[0], header.size[1])?;
    let values = size.area() as u64 * header.channels as u64;
    weight::plausible(file, size, values, bytes.len())?;
    room(file, size, values * if header.is_float(kind) { 8 } else { 4 }, budget)?;
    let data = bytes.get(header.at..).unwrap_or_default();
    let image = match kind {
        b'f' | b'F' => floats(data, size, header.channels, has_little_floats(bytes)),
        b'1' => text_bits(data, size.area()).and_then(|values| image(size, 1, 255, values)),
        b'4' => {
            let values = bits(data, size);
            values.and_then(|values| image(size, 1, 255, values))
        }
        b'2' | b'3' => {
            let values = numbers(data, values as usize);
            values.and_then(|values| image(size, header.channels, header.most, values))
        }
        _ => {
            let values = samples(data, values as usize, header.most);
            values.and_then(|values| image(size, header.channels, header.most, values))
        }
    };
    let image = image.ok_or_else(|| Error::decode(file, "the PNM data is cut short or damaged"))?;
    let orientation = Orientation::NoTransforms;
    Ok(Bitmap { image, icc: None, orientation, format: "PNM", warning: None })
}

impl PnmHeader {
    fn is_float(&self, kind: u8) -> bool {
        matches!(kind, b'f' | b'F')
    }
}

/// The next word, and where it ends; texts from `#` to the end of their line are left out.
fn word(bytes: &[u8], mut at: usize) -> Option<(&[u8], usize)> {
    loop {
        match bytes.get(at)? {
            b'#' => at += bytes[at..].iter().position(|&byte| byte == b'\n')?,
            byte if byte.is_ascii_whitespace() => at += 1,
            _ => break,
        }
    }
    let is_end = |byte: &u8| byte.is_ascii_whitespace() || *byte == b'#';
    let end = bytes[at..].iter().position(is_end).map_or(bytes.len(), |length| at + length);
    Some((&bytes[at..end], end))
}

fn number(bytes: &[u8], at: usize) -> Option<(u64, usize)> {
    let (digits, end) = word(bytes, at)?;
    Some((std::str::from_utf8(digits).ok()?.parse().ok()?, end))
}

fn header(bytes: &[u8], kind: u8) -> Option<PnmHeader> {
    let (width, at) = number(bytes, 2)?;
    let (height, at) = number(bytes, at)?;
    let (most, at) = match kind {
        b'1' | b'4' => (255, at),
        b'f' | b'F' => (1, word(bytes, at)?.1),
        _ => number(bytes, at)?,
    };
    let channels = if matches!(kind, b'3' | b'6' | b'F') { 3 } else { 1 };
    Some(PnmHeader { size: [width, height], channels, most: most.try_into().ok()?, at: at + 1 })
}

/// Lines of a name and a value, up to `ENDHDR`.
fn pam_header(bytes: &[u8]) -> Option<PnmHeader> {
    let mut header = PnmHeader { size: [0; 2], channels: 0, most: 0, at: 2 };
    loop {
        let (name, end) = word(bytes, header.at)?;
        header.at = end;
        if name == b"ENDHDR" {
            header.at += 1;
            return Some(header);
        }
        if name == b"TUPLTYPE" {
            header.at = word(bytes, end)?.1;
            continue;
        }
        let (value, end) = number(bytes, end)?;
        header.at = end;
        match name {
            b"WIDTH" => header.size[0] = value,
            b"HEIGHT" => header.size[1] = value,
            b"DEPTH" => header.channels = value.try_into().ok()?,
            b"MAXVAL" => header.most = value.try_into().ok()?,
            _ => return None,
        }
    }
}

/// A PFM's scale is negative where its floats begin with their low byte.
fn has_little_floats(bytes: &[u8]) -> bool {
    let scale = || {
        let at = number(bytes, 2)?.1;
        word(bytes, number(bytes, at)?.1)
    };
    scale().is_some_and(|(scale, _)| scale.starts_with(b"-"))
}

/// Bits as the digits 0 and 1, black being 1.
fn text_bits(data: &[u8], area: usize) -> Option<Vec<u16>> {
    let bits = data.iter().filter(|byte| matches!(byte, b'0' | b'1'));
    let values: Vec<u16> = bits.take(area).map(|bit| if *bit == b'1' { 0 } else { 255 }).collect();
    (values.len() == area).then_some(values)
}

/// Bits of rows that are filled up to a byte, black being 1.
fn bits(data: &[u8], size: Size) -> Option<Vec<u16>> {
    let width = size.width as usize;
    let rows = data.get(..width.div_ceil(8) * size.height as usize)?;
    let value = |row: &[u8], x: usize| if row[x / 8] >> (7 - x % 8) & 1 == 1 { 0 } else { 255 };
    Some(rows.chunks(width.div_ceil(8)).flat_map(|row| (0..width).map(|x| value(row, x))).collect())
}

fn numbers(data: &[u8], count: usize) -> Option<Vec<u16>> {
    let (mut at, mut values) = (0, Vec::new());
    for _ in 0..count {
        let (value, end) = number(data, at)?;
        values.push(value.try_into().ok()?);
        at = end;
    }
    Some(values)
}

fn samples(data: &[u8], count: usize, most: u32) -> Option<Vec<u16>> {
    Some(match most {
        ..256 => data.get(..count)?.iter().map(|&byte| byte.into()).collect(),
        _ => data.get(..count * 2)?.as_chunks().0.iter().map(|b| u16::from_be_bytes(*b)).collect(),
    })
}

/// Samples of `0..=most` as bytes, or as 16 bits where they have more than 8.
fn image(size: Size, channels: usize, most: u32, values: Vec<u16>) -> Option<DynamicImage> {
    let scaled = |white: u32| move |v: u16| (u32::from(v).min(most) * white + most / 2) / most;
    let (w, h) = (size.width, size.height);
    if most > 255 {
        let v = values.into_iter().map(scaled(65535)).map(|v| v as u16).collect();
        return match channels {
            1 => ImageBuffer::from_raw(w, h, v).map(DynamicImage::ImageLuma16),
            2 => ImageBuffer::from_raw(w, h, v).map(DynamicImage::ImageLumaA16),
            3 => ImageBuffer::from_raw(w, h, v).map(DynamicImage::ImageRgb16),
            _ => ImageBuffer::from_raw(w, h, v).map(DynamicImage::ImageRgba16),
        };
    }
    let v = values.into_iter().map(scaled(255)).map(|v| v as u8).collect();
    match channels {
        1 => ImageBuffer::from_raw(w, h, v).map(DynamicImage::ImageLuma8),
        2 => ImageBuffer::from_raw(w, h, v).map(DynamicImage::ImageLumaA8),
        3 => ImageBuffer::from_raw(w, h, v).map(DynamicImage::ImageRgb8),
        _ => ImageBuffer::from_raw(w, h, v).map(DynamicImage::ImageRgba8),
    }
}

/// Linear light, the lowest row first.
fn floats(data: &[u8], size: Size, channels: usize, is_little: bool) -> Option<DynamicImage> {
    let row = size.width as usize * channels * 4;
    let rows = data.get(..row * size.height as usize)?;
    let value =
        |b: &[u8; 4]| if is_little { f32::from_le_bytes(*b) } else { f32::from_be_bytes(*b) };
    let values = rows.chunks(row).rev().flat_map(|row| row.as_chunks().0.iter().map(value));
    let rgb = values.flat_map(|v| std::iter::repeat_n(v, if channels == 1 { 3 } else { 1 }));
    ImageBuffer::from_raw(size.width, size.height, rgb.collect()).map(DynamicImage::ImageRgb32F)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> DynamicImage {
        super::super::decode(Path::new("a.pnm"), bytes, &Budget::default()).unwrap().image
    }

    #[test]
    fn every_kind_of_netpbm_is_read() {
        assert_eq!(read(b"P1\n# by hand\n3 1\n1 01").into_luma8().into_raw(), [0, 255, 0]);
        assert_eq!(read(b"P2 2 1 15\n0 15").into_luma8().into_raw(), [0, 255]);
        assert_eq!(read(b"P3 1 1 # red\n255 255 0 7").into_rgb8().into_raw(), [255, 0, 7]);
        assert_eq!(read(b"P4 9 1\n\x80\x00").into_luma8().into_raw()[..2], [0, 255]);
        assert_eq!(read(b"P5 2 1 255\n\x10\x20").into_luma8().into_raw(), [16, 32]);
        assert_eq!(read(b"P6 1 1 255\n\x01\x02\x03").into_rgb8().into_raw(), [1, 2, 3]);
        assert_eq!(read(b"P5 1 1 65535\n\x12\x34").into_luma16().into_raw(), [0x1234]);
        let pam =
            b"P7\nWIDTH 1\nHEIGHT 1\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n\x01\x02\x03\x04";
        assert_eq!(read(pam).into_rgba8().into_raw(), [1, 2, 3, 4]);
    }

    #[test]
    fn the_floats_of_a_pfm_begin_with_the_lowest_row() {
        let pfm = [b"Pf\n1 2\n-1.0\n", &0.5f32.to_le_bytes()[..], &2f32.to_le_bytes()].concat();
        assert_eq!(read(&pfm).into_rgb32f().into_raw(), [2.0, 2.0, 2.0, 0.5, 0.5, 0.5]);
        let pfm = [b"Pf\n1 2\n1.0\n", &0.5f32.to_be_bytes()[..], &2f32.to_be_bytes()].concat();
        assert_eq!(read(&pfm).into_rgb32f().into_raw(), [2.0, 2.0, 2.0, 0.5, 0.5, 0.5]);
    }

    #[test]
    fn what_is_cut_short_gets_a_sentence() {
        let files: [&[u8]; 6] = [
            b"P5 16000 16000 255\n1",
            b"P6 2 2 255\n123",
            b"P2 2 1 255\n7",
            b"P5 2",
            b"P7\nWIDTH 2\n",
            b"P5 1 1 0\n1",
        ];
        for bytes in files {
            let said = decode(Path::new("a.pnm"), bytes, &Budget::default()).err().unwrap();
            assert!(said.to_string().starts_with("a.pnm: cannot be read"), "{said}");
        }
    }
}
