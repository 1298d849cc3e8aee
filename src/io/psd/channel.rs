//! One channel's values, row by row: plain, run lengths (PackBits), or ZIP with and without
//! prediction; as bytes, or as 16 bits. Floor 5.

use super::cursor::ByteCursor;
use crate::math::srgb;
use crate::raster::tile::sixteen_bit::{LEVEL, byte_of};
use flate2::read::DeflateDecoder;
use std::io::Read;

/// How a channel's values are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelLayout {
    pub width: usize,
    pub height: usize,
    /// 1, 8, 16 or 32.
    pub bits: u16,
    /// Colors, not coverage: with 32 bits they are linear light.
    pub is_color: bool,
    /// Row lengths take four bytes instead of two.
    pub large: bool,
}

impl ChannelLayout {
    fn row_bytes(self) -> usize {
        (self.width * usize::from(self.bits)).div_ceil(8)
    }

    fn bytes(self) -> usize {
        self.row_bytes() * self.height
    }
}

/// What the values of a channel are read as.
pub trait ChannelValue: Copy + Default {
    /// Fully covered, or brightest.
    const WHOLE: Self;
    /// From values of the depth that the layout says, rounded.
    fn all_of(stored: &[u8], shape: ChannelLayout) -> Vec<Self>;
    /// The nearest byte.
    fn byte(self) -> u8;
}

impl ChannelValue for u8 {
    const WHOLE: Self = u8::MAX;
    fn all_of(stored: &[u8], shape: ChannelLayout) -> Vec<Self> {
        to_bytes(stored, shape)
    }

    fn byte(self) -> u8 {
        self
    }
}

impl ChannelValue for u16 {
    const WHOLE: Self = u16::MAX;
    fn all_of(stored: &[u8], shape: ChannelLayout) -> Vec<Self> {
        match shape.bits {
            16 => stored.as_chunks().0.iter().map(|v| u16::from_be_bytes(*v)).collect(),
            32 => stored
                .as_chunks()
                .0
                .iter()
                .map(|v| srgb::quantize16(encode_float(*v, shape)))
                .collect(),
            _ => to_bytes(stored, shape).into_iter().map(|v| u16::from(v) * LEVEL).collect(),
        }
    }

    fn byte(self) -> u8 {
        byte_of(self)
    }
}

/// A float as stored; of colors, linear light, which is clipped to white and encoded.
fn encode_float(stored: [u8; 4], shape: ChannelLayout) -> f32 {
    let value = f32::from_be_bytes(stored);
    if shape.is_color { srgb::encode(value.max(0.0).min(1.0)) } else { value }
}

/// The values of a channel: its compression, then its data. `None` where the data is damaged, or
/// too short to hold what the shape promises.
pub fn decode<T: ChannelValue>(data: &mut ByteCursor, shape: ChannelLayout) -> Option<Vec<T>> {
    let compression = data.u16()?;
    decode_as(data, shape, compression)
}

/// As [`decode`], for data whose compression is already known; leaves the cursor after the channel.
pub fn decode_as<T: ChannelValue>(
    data: &mut ByteCursor,
    shape: ChannelLayout,
    compression: u16,
) -> Option<Vec<T>> {
    match compression {
        0 => Some(T::all_of(data.take(shape.bytes())?, shape)),
        1 => {
            let lengths = row_lengths(data, shape, shape.height)?;
            unpack_rows(data, shape, &lengths)
        }
        2 | 3 => {
            let mut values = inflate(data.rest(), shape.bytes())?;
            data.take(data.rest().len())?;
            if compression == 3 {
                undo_prediction(&mut values, shape);
            }
            Some(T::all_of(&values, shape))
        }
        _ => None,
    }
}

/// Several channels in one zlib stream, as in a merged picture; `shape` is that of each, all of one
/// size.
pub fn inflate_planes<T: ChannelValue>(
    zlib: &[u8],
    count: usize,
    shape: impl Fn(usize) -> ChannelLayout,
    is_predicted: bool,
) -> Option<Vec<Vec<T>>> {
    let bytes = shape(0).bytes();
    let mut values = inflate(zlib, bytes.checked_mul(count)?)?;
    if is_predicted {
        undo_prediction(&mut values, shape(0));
    }
    Some(
        values
            .chunks_exact(bytes.max(1))
            .enumerate()
            .map(|(c, plane)| T::all_of(plane, shape(c)))
            .collect(),
    )
}

/// How long each packed row is.
pub fn row_lengths(data: &mut ByteCursor, shape: ChannelLayout, rows: usize) -> Option<Vec<usize>> {
    // The table must be complete before memory is allocated for it.
    let width = if shape.large { 4 } else { 2 };
    let mut table = ByteCursor::new(data.take(rows.checked_mul(width)?)?);
    (0..rows)
        .map(|_| if shape.large { table.length(false) } else { table.u16().map(usize::from) })
        .collect()
}

/// Rows of run lengths.
pub fn unpack_rows<T: ChannelValue>(
    data: &mut ByteCursor,
    shape: ChannelLayout,
    lengths: &[usize],
) -> Option<Vec<T>> {
    let packed: usize = lengths.iter().sum();
    // Two bytes hold at most 128.
    if shape.bytes() / 64 > packed + shape.height {
        return None;
    }
    let mut values = Vec::with_capacity(shape.bytes());
    for length in lengths {
        unpack(data.take(*length)?, shape.row_bytes(), &mut values)?;
    }
    Some(T::all_of(&values, shape))
}

/// One row of PackBits; `None` where it holds fewer than `wanted` bytes. What runs beyond them is
/// cut off: some programs write such rows.
fn unpack(mut packed: &[u8], wanted: usize, out: &mut Vec<u8>) -> Option<()> {
    let end = out.len() + wanted;
    while out.len() < end {
        let (&head, rest) = packed.split_first()?;
        match head {
            0..=127 => {
                let (plain, rest) = rest.split_at_checked(usize::from(head) + 1)?;
                out.extend(plain);
                packed = rest;
            }
            128 => packed = rest,
            _ => {
                let (&value, rest) = rest.split_first()?;
                out.resize(out.len() + 257 - usize::from(head), value);
                packed = rest;
            }
        }
    }
    out.truncate(end);
    Some(())
}

/// PackBits: runs of three and more as runs, the rest plain.
pub fn pack(row: &[u8], out: &mut Vec<u8>) {
    let run_at = |i: usize| row[i..].iter().take(128).take_while(|&&v| v == row[i]).count();
    let mut i = 0;
    while i < row.len() {
        let run = run_at(i);
        if run >= 3 {
            out.extend([(257 - run) as u8, row[i]]);
            i += run;
            continue;
        }
        let start = i;
        while i < row.len() && i - start < 128 && run_at(i) < 3 {
            i += 1;
        }
        out.push((i - start - 1) as u8);
        out.extend(&row[start..i]);
    }
}

/// Inflates a zlib stream to exactly `wanted` bytes. Its header and checksum are not read: a
/// damaged channel shows, and is still better than none.
fn inflate(zlib: &[u8], wanted: usize) -> Option<Vec<u8>> {
    // DEFLATE reaches 1032 : 1.
    if wanted / 1100 > zlib.len() {
        return None;
    }
    let mut values = Vec::new();
    DeflateDecoder::new(zlib.get(2..)?).take(wanted as u64).read_to_end(&mut values).ok()?;
    (values.len() == wanted).then_some(values)
}

/// Each value was stored as what it differs by from its left neighbor. Of floats all first bytes
/// come first, then all second ones, and it is the bytes that differ.
fn undo_prediction(values: &mut [u8], shape: ChannelLayout) {
    for row in values.chunks_exact_mut(shape.row_bytes().max(1)) {
        if shape.bits == 16 {
            for i in (2..row.len()).step_by(2) {
                let value = |at: usize| u16::from_be_bytes([row[at], row[at + 1]]);
                let sum = value(i).wrapping_add(value(i - 2)).to_be_bytes();
                row[i..i + 2].copy_from_slice(&sum);
            }
            continue;
        }
        for i in 1..row.len() {
            row[i] = row[i].wrapping_add(row[i - 1]);
        }
        if shape.bits == 32 {
            let planes = row.to_vec();
            row.iter_mut()
                .enumerate()
                .for_each(|(i, byte)| *byte = planes[i % 4 * shape.width + i / 4]);
        }
    }
}

/// Values of any depth as bytes, rounded. A bit is a drop of ink.
fn to_bytes(values: &[u8], shape: ChannelLayout) -> Vec<u8> {
    match shape.bits {
        1 => {
            let bit =
                |row: &[u8], x: usize| if row[x / 8] >> (7 - x % 8) & 1 == 0 { 255 } else { 0 };
            let rows = values.chunks_exact(shape.row_bytes().max(1));
            rows.flat_map(|row| (0..shape.width).map(move |x| bit(row, x))).collect()
        }
        16 => values.as_chunks().0.iter().map(|v| byte_of(u16::from_be_bytes(*v))).collect(),
        32 => {
            values.as_chunks().0.iter().map(|v| srgb::quantize(encode_float(*v, shape))).collect()
        }
        _ => values.to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash;

    fn shape(width: usize, height: usize, bits: u16) -> ChannelLayout {
        ChannelLayout { width, height, bits, is_color: true, large: false }
    }

    #[test]
    fn packed_rows_come_back() {
        for n in 0..300 {
            for grain in [1, 2, 5, 40] {
                let row: Vec<u8> = (0..n).map(|i| hash::mix(i / grain) as u8 % 3).collect();
                let (mut packed, mut back) = (Vec::new(), Vec::new());
                pack(&row, &mut packed);
                unpack(&packed, row.len(), &mut back).unwrap();
                assert_eq!(back, row);
                assert!(packed.len() <= row.len() + row.len() / 128 + 1);
            }
        }
    }

    #[test]
    fn sixteen_bits_with_prediction_come_back_whole_and_rounded() {
        let values: [u16; 4] = [0, 257 * 100, 257 * 100 + 129, 65535];
        let mut bytes: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
        for i in (2..bytes.len()).step_by(2).rev() {
            let value = |at: usize| u16::from_be_bytes([bytes[at], bytes[at + 1]]);
            let difference = value(i).wrapping_sub(value(i - 2)).to_be_bytes();
            bytes[i..i + 2].copy_from_slice(&difference);
        }
        // A zlib stream of one stored block.
        let mut zlib = vec![0x78, 1, 1, 8, 0, 0xf7, 0xff];
        zlib.extend(&bytes);
        let data = [&[0, 3][..], &zlib].concat();
        let decoded: Vec<u8> = decode(&mut ByteCursor::new(&data), shape(4, 1, 16)).unwrap();
        assert_eq!(decoded, [0, 100, 101, 255]);
        assert_eq!(decode::<u16>(&mut ByteCursor::new(&data), shape(4, 1, 16)).unwrap(), values);
    }

    #[test]
    fn damaged_rows_are_refused_before_room_is_made_for_them() {
        let mut out = Vec::new();
        assert_eq!(unpack(&[5, 1, 2], 6, &mut out), None);
        unpack(&[129, 7], 3, &mut out).unwrap();
        assert_eq!(out[out.len() - 3..], [7; 3], "a run beyond the row");
        let huge =
            ChannelLayout { width: 300_000, height: 300_000, bits: 8, is_color: true, large: true };
        for compression in 0..5 {
            assert_eq!(decode_as::<u16>(&mut ByteCursor::new(&[0; 100]), huge, compression), None);
        }
    }
}
