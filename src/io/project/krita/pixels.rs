//! The pixels of Krita's layers and masks: tiles of 64 × 64, each channel's bytes one after the
//! other, as they are or packed by LZF. Floor 5.

use crate::math::{Rect, Size};
use crate::picture;
use crate::raster::{Plane, TileGrid};
use crate::{Budget, Error, Result};
use std::path::Path;

/// Sides of Krita's tiles that are read; it writes 64.
const SIDES: std::ops::RangeInclusive<usize> = 1..=256;

/// How the bytes of a pixel are to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelFormat {
    is_gray: bool,
    number: PixelNumber,
    is_linear: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PixelNumber {
    U8,
    U16,
    F16,
    F32,
}

impl PixelFormat {
    /// By Krita's names of the colors and the profile; `None` for others than RGB and gray.
    pub fn of(space: &str, profile: &str) -> Option<Self> {
        let (is_gray, rest) = match space.strip_prefix("RGBA") {
            Some(rest) => (false, rest),
            None => (true, space.strip_prefix("GRAYA")?),
        };
        let number = match rest {
            "" => PixelNumber::U8,
            "16" | "U16" => PixelNumber::U16,
            "F16" => PixelNumber::F16,
            "F32" => PixelNumber::F32,
            _ => return None,
        };
        let is_linear = profile.contains("g10") || profile.to_lowercase().contains("linear");
        Some(Self { is_gray, number, is_linear })
    }

    fn number_bytes(self) -> usize {
        match self.number {
            PixelNumber::U8 => 1,
            PixelNumber::U16 | PixelNumber::F16 => 2,
            PixelNumber::F32 => 4,
        }
    }

    fn channels(self) -> usize {
        if self.is_gray { 2 } else { 4 }
    }

    /// A channel of a pixel, in `[0, 1]` where it is an integer.
    fn value(self, pixel: &[u8], channel: usize) -> f32 {
        let at = channel * self.number_bytes();
        let pair = || [pixel[at], pixel[at + 1]];
        match self.number {
            PixelNumber::U8 => f32::from(pixel[at]) / 255.0,
            PixelNumber::U16 => f32::from(u16::from_le_bytes(pair())) / 65535.0,
            PixelNumber::F16 => half(u16::from_le_bytes(pair())),
            PixelNumber::F32 => {
                f32::from_le_bytes([pixel[at], pixel[at + 1], pixel[at + 2], pixel[at + 3]])
            }
        }
    }

    /// Straight RGBA. Integers are stored with blue first.
    fn rgba(self, pixel: &[u8]) -> [f32; 4] {
        let v = |channel: usize| self.value(pixel, channel);
        match (self.is_gray, self.number) {
            (true, _) => [v(0), v(0), v(0), v(1)],
            (false, PixelNumber::U8 | PixelNumber::U16) => [v(2), v(1), v(0), v(3)],
            (false, _) => [v(0), v(1), v(2), v(3)],
        }
    }
}

/// A float of 16 bits.
fn half(bits: u16) -> f32 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
    let size = match exponent {
        0 => fraction * 2f32.powi(-24),
        31 => f32::MAX,
        _ => (1.0 + fraction / 1024.0) * 2f32.powi(exponent - 15),
    };
    if bits >> 15 == 1 { -size } else { size }
}

/// A rectangle of stored pixels, row by row.
pub struct KritaPixels {
    rect: Rect,
    pixel_bytes: usize,
    bytes: Vec<u8>,
    /// What lies beyond the rectangle.
    plain: Vec<u8>,
}

/// A tile's place and its bytes as they are stored.
struct KritaTile<'a> {
    x: i32,
    y: i32,
    bytes: &'a [u8],
}

/// Reads an entry of tiles. What lies farther from the canvas than its longer side is left out.
///
/// * `plain`: the pixel where there are no tiles; empty where nothing says so.
/// * `offset`: where the layer is moved.
pub fn read(
    file: &Path,
    bytes: &[u8],
    plain: Vec<u8>,
    offset: [i32; 2],
    canvas: Size,
    budget: &Budget,
) -> Result<KritaPixels> {
    let damaged = || Error::decode(file, "its tiles are damaged");
    let (mut rest, mut sides, mut pixel_bytes) = (bytes, [64, 64], 0);
    let count = loop {
        let (name, value) = line(&mut rest).and_then(|l| l.split_once(' ')).ok_or_else(damaged)?;
        let value: usize = value.trim().parse().map_err(|_| damaged())?;
        match name {
            "TILEWIDTH" => sides[0] = value,
            "TILEHEIGHT" => sides[1] = value,
            "PIXELSIZE" => pixel_bytes = value,
            "DATA" => break value,
            _ => {}
        }
    };
    if !sides.iter().all(|side| SIDES.contains(side)) || !(1..=16).contains(&pixel_bytes) {
        return Err(damaged());
    }
    let plain = if plain.len() == pixel_bytes { plain } else { vec![0; pixel_bytes] };
    let mut tiles = Vec::new();
    for _ in 0..count {
        // Files that were cut short keep the tiles that are there.
        let Some(tile) = read_packed_tile(&mut rest, offset) else { break };
        tiles.push(tile);
    }
    let of = |tile: &KritaTile| {
        let end = |at: i32, side: usize| at.saturating_add(side as i32);
        Rect::new(tile.x, tile.y, end(tile.x, sides[0]), end(tile.y, sides[1]))
    };
    let near = canvas.rect().grown(canvas.longer_side() as i32);
    let is_near = |tile: &&KritaTile| !of(tile).intersect(near).is_empty();
    let start = if plain.iter().any(|byte| *byte != 0) { canvas.rect() } else { Rect::EMPTY };
    let rect = tiles.iter().filter(is_near).fold(start, |all, tile| all.union(of(tile)));
    let area = rect.width() as u64 * rect.height() as u64;
    // Each tile has a place of its own: more would be read again and again.
    if tiles.iter().filter(is_near).count() as u64 > area / (sides[0] * sides[1]) as u64 {
        return Err(damaged());
    }
    // Stored, as floats, and as tiles.
    let asked = area.saturating_mul(pixel_bytes as u64 + 16 + budget.paint_bytes());
    budget.room(file, "a layer", asked)?;
    let mut out: Vec<u8> =
        plain.iter().copied().cycle().take(area as usize * pixel_bytes).collect();
    let plane = sides[0] * sides[1];
    for tile in tiles.iter().filter(is_near) {
        let stored = unpack(tile.bytes, plane * pixel_bytes).ok_or_else(damaged)?;
        for row in 0..sides[1] {
            let y = (tile.y + row as i32 - rect.y0) as usize;
            let first = (y * rect.width() + (tile.x - rect.x0) as usize) * pixel_bytes;
            let line = &mut out[first..first + sides[0] * pixel_bytes];
            for (x, pixel) in line.chunks_exact_mut(pixel_bytes).enumerate() {
                for (c, byte) in pixel.iter_mut().enumerate() {
                    *byte = stored[c * plane + row * sides[0] + x];
                }
            }
        }
    }
    Ok(KritaPixels { rect, pixel_bytes, bytes: out, plain })
}

fn line<'a>(rest: &mut &'a [u8]) -> Option<&'a str> {
    let end = rest.iter().take(200).position(|byte| *byte == b'\n')?;
    let line = std::str::from_utf8(&rest[..end]).ok()?;
    *rest = &rest[end + 1..];
    Some(line)
}

/// A line such as `64,-128,LZF,915`, and as many bytes.
fn read_packed_tile<'a>(rest: &mut &'a [u8], offset: [i32; 2]) -> Option<KritaTile<'a>> {
    let mut words = line(rest)?.split(',');
    let mut number = || words.next()?.trim().parse::<i32>().ok();
    let (x, y) = (number()?.checked_add(offset[0])?, number()?.checked_add(offset[1])?);
    words.next()?;
    let length: usize = words.next()?.trim().parse().ok()?;
    let (bytes, after) = rest.split_at_checked(length)?;
    *rest = after;
    Some(KritaTile { x, y, bytes })
}

/// A tile's bytes: after a 1 packed by LZF, else as they are.
fn unpack(packed: &[u8], length: usize) -> Option<Vec<u8>> {
    let (&kind, data) = packed.split_first()?;
    let out = if kind == 1 { lzf(data, length)? } else { data.get(..length)?.to_vec() };
    (out.len() == length).then_some(out)
}

/// LZF: runs of bytes, and copies of what came up to 8 KB before. `None` where it is damaged or
/// longer than `most`.
fn lzf(data: &[u8], most: usize) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    let mut bytes = data.iter().copied();
    while let Some(control) = bytes.next() {
        let control = usize::from(control);
        if control < 32 {
            for _ in 0..=control {
                out.push(bytes.next()?);
            }
        } else {
            let mut length = control >> 5;
            if length == 7 {
                length += usize::from(bytes.next()?);
            }
            let back = (control & 31) << 8 | usize::from(bytes.next()?);
            let from = out.len().checked_sub(back + 1)?;
            for i in from..from + length + 2 {
                out.push(out[i]);
            }
        }
        if out.len() > most {
            return None;
        }
    }
    Some(out)
}

impl KritaPixels {
    pub fn area(&self) -> usize {
        self.rect.width() * self.rect.height()
    }

    pub fn corner(&self) -> (i32, i32) {
        (self.rect.x0, self.rect.y0)
    }

    /// The tiles of a paint layer; `None` where pixels are not as wide as the format has them.
    pub fn tiles(&self, format: PixelFormat, icc: Option<&[u8]>) -> Option<TileGrid> {
        if self.pixel_bytes != format.channels() * format.number_bytes() {
            return None;
        }
        let (w, h) = (self.rect.width(), self.rect.height());
        let (x, y) = self.corner();
        let size = Size::new(w as u32, h as u32);
        let texels = self.bytes.chunks_exact(self.pixel_bytes).map(|pixel| format.rgba(pixel));
        let scaled = |v: f32, most: f32| (v.max(0.0).min(1.0) * most).round();
        Some(match format.number {
            _ if w == 0 => TileGrid::default(),
            PixelNumber::U8 => {
                let bytes = texels.flat_map(|t| t.map(|v| scaled(v, 255.0) as u8)).collect();
                let bytes = match icc {
                    Some(icc) => picture::to_srgb(size, bytes, format.is_gray, icc),
                    None => bytes,
                };
                TileGrid::from_straight_rgba(&bytes, w, h, x, y)
            }
            _ if format.is_linear => TileGrid::from_light(&texels.collect::<Vec<_>>(), w, h, x, y),
            _ => {
                let pixels16 = texels.map(|t| t.map(|v| scaled(v, 65535.0) as u16)).collect();
                let pixels16 = match icc {
                    Some(icc) => picture::to_srgb16(size, pixels16, format.is_gray, icc),
                    None => pixels16,
                };
                TileGrid::from_straight16(&pixels16, w, h, x, y)
            }
        })
    }

    /// The coverage of a mask over the canvas: its first byte.
    pub fn coverage(&self, canvas: Size) -> Plane<u8> {
        Plane::from_fn(canvas, |x, y| {
            let (x, y) = (x as i32, y as i32);
            if x < self.rect.x0 || y < self.rect.y0 || x >= self.rect.x1 || y >= self.rect.y1 {
                return self.plain[0];
            }
            let row = (y - self.rect.y0) as usize * self.rect.width();
            self.bytes[(row + (x - self.rect.x0) as usize) * self.pixel_bytes]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lzf_has_runs_and_copies() {
        // “abc”, five from three before, “d”.
        let data = [2, b'a', b'b', b'c', 3 << 5, 2, 0, b'd'];
        assert_eq!(lzf(&data, 100).unwrap(), b"abcabcabd");
        // A copy of 7 + 2 + 2 bytes of the one before.
        assert_eq!(lzf(&[0, 9, 7 << 5, 2, 0], 100).unwrap(), [9; 12]);
        assert!(lzf(&data, 8).is_none() && lzf(&[32, 5], 100).is_none());
    }

    #[test]
    fn halves_are_read_as_floats() {
        assert_eq!([0x3c00, 0xc000, 0x3555, 1].map(half)[..2], [1.0, -2.0]);
        assert!((half(0x3555) - 1.0 / 3.0).abs() < 1e-3 && half(1) > 0.0);
    }
}
