//! Readings of the pen as a text: columns of small differences.
//! Floor 5.
//!
//! The text is base64 (RFC 4648, no padding) of: how many readings there are, as a varint (LEB128);
//! then six columns (x, y, pressure, tilt x, tilt y, seconds), each a byte that says how it is
//! encoded, and its values:
//!
//! | byte | values |
//! |---|---|
//! | k, 0 … 24 | multiples of 2⁻ᵏ: the integers' differences, each a zigzag varint |
//! | 31 | any f32: its place in the order of all f32, encoded by the same differences |
//! | 32 more | differences of those differences, for even motion |
//! | 255 | one value for all: its four bytes, the lowest first |
//!
//! Each restores every f32 bit by bit. Readings of a pen are on a grid (`Sample::normalized`), so that
//! a step costs a byte or two; what was turned or calculated is not, and costs three or four.

use super::{COLUMNS, numbers, of_numbers};
use crate::base64;
use crate::paint::Sample;

/// The finest grid that is looked for: 2⁻²⁴.
const FINEST: u8 = 24;
const ANY_FLOAT: u8 = 31;
const TWICE: u8 = 32;
pub const CONSTANT: u8 = 255;

/// Readings as a text that gives back their very bits.
pub fn pack(samples: &[Sample]) -> String {
    let mut bytes = Vec::with_capacity(samples.len() * 10);
    put(&mut bytes, samples.len() as u64);
    for i in 0..COLUMNS {
        let column: Vec<f32> = samples.iter().map(|sample| numbers(sample)[i]).collect();
        put_column(&mut bytes, &column);
    }
    base64::encode(&bytes)
}

fn put_column(out: &mut Vec<u8>, column: &[f32]) {
    let first = column.first().copied().unwrap_or_default();
    if column.iter().all(|v| v.to_bits() == first.to_bits()) {
        out.push(CONSTANT);
        out.extend(first.to_le_bytes());
        return;
    }
    let grid = column.iter().try_fold(0, |finest: u8, v| Some(finest.max(grid_of(*v)?)));
    let (how, whole): (u8, Vec<i64>) = match grid {
        Some(k) => (k, column.iter().map(|v| (f64::from(*v) * scale(k)) as i64).collect()),
        None => (ANY_FLOAT, column.iter().map(|v| place(*v)).collect()),
    };
    let once: usize = steps(&whole, false).map(length).sum();
    let twice: usize = steps(&whole, true).map(length).sum();
    out.push(if twice < once { how | TWICE } else { how });
    steps(&whole, twice < once).for_each(|step| put(out, step));
}

/// The least k of which a value is a multiple of 2⁻ᵏ; `None` if there is none that can be encoded.
fn grid_of(v: f32) -> Option<u8> {
    const FARTHEST: f32 = 1e9;
    if v == 0.0 {
        // −0 has different bits.
        return v.is_sign_positive().then_some(0);
    }
    if v.abs() > FARTHEST || !v.is_normal() {
        return None;
    }
    let exponent = ((v.to_bits() >> 23) & 0xff) as i32 - 150;
    let mantissa = (v.to_bits() & 0x7f_ffff) | 0x80_0000;
    let k = -(exponent + mantissa.trailing_zeros() as i32);
    u8::try_from(k.max(0)).ok().filter(|k| *k <= FINEST)
}

fn scale(k: u8) -> f64 {
    f64::from(1u32 << k.min(FINEST))
}

/// Position of a float among all floats: the next float is one more.
fn place(v: f32) -> i64 {
    let bits = i64::from(v.to_bits());
    if v.is_sign_negative() { -(bits & 0x7fff_ffff) - 1 } else { bits }
}

fn float_at(place: i64) -> Option<f32> {
    let (sign, bits) = if place < 0 { (1 << 31, -(place + 1)) } else { (0, place) };
    u32::try_from(bits).ok().filter(|bits| *bits < 1 << 31).map(|bits| f32::from_bits(bits | sign))
}

/// The differences of whole numbers, or the differences of those, none below 0.
fn steps(whole: &[i64], twice: bool) -> impl Iterator<Item = u64> {
    let (mut last, mut pace) = (0i64, 0i64);
    whole.iter().map(move |&v| {
        let step = v.wrapping_sub(last);
        let stored = if twice { step.wrapping_sub(pace) } else { step };
        (last, pace) = (v, step);
        ((stored << 1) ^ (stored >> 63)) as u64
    })
}

/// Bytes of a varint.
fn length(v: u64) -> usize {
    (70 - (v | 1).leading_zeros() as usize) / 7
}

pub fn put(out: &mut Vec<u8>, mut v: u64) {
    while v >= 0x80 {
        out.push(v as u8 | 0x80);
        v >>= 7;
    }
    out.push(v as u8);
}

#[derive(Debug, PartialEq)]
pub enum Unreadable {
    TooMany,
    Damaged,
}

/// The readings of a text; their numbers may be any.
pub fn unpack(text: &str, most: usize) -> std::result::Result<Vec<Sample>, Unreadable> {
    let bytes = base64::decode(text).ok_or(Unreadable::Damaged)?;
    let mut rest = &bytes[..];
    let count = take(&mut rest).ok_or(Unreadable::Damaged)?;
    let count =
        usize::try_from(count).ok().filter(|count| *count <= most).ok_or(Unreadable::TooMany)?;
    let mut columns: [Vec<f32>; COLUMNS] = Default::default();
    for column in &mut columns {
        *column = take_column(&mut rest, count).ok_or(Unreadable::Damaged)?;
    }
    if !rest.is_empty() {
        return Err(Unreadable::Damaged);
    }
    Ok((0..count).map(|i| of_numbers(std::array::from_fn(|c| columns[c][i]))).collect())
}

fn take_column(rest: &mut &[u8], count: usize) -> Option<Vec<f32>> {
    let (&how, after) = rest.split_first()?;
    *rest = after;
    if how == CONSTANT {
        let (bytes, after) = rest.split_first_chunk()?;
        *rest = after;
        return Some(vec![f32::from_le_bytes(*bytes); count]);
    }
    let (k, twice) = (how & !TWICE, how & TWICE != 0);
    if k > FINEST && k != ANY_FLOAT {
        return None;
    }
    let (mut last, mut pace) = (0i64, 0i64);
    let mut one = || {
        let stored = take(rest)?;
        let stored = (stored >> 1) as i64 ^ -((stored & 1) as i64);
        pace = if twice { pace.wrapping_add(stored) } else { stored };
        last = last.wrapping_add(pace);
        if k == ANY_FLOAT { float_at(last) } else { Some((last as f64 / scale(k)) as f32) }
    };
    (0..count).map(|_| one()).collect()
}

fn take(rest: &mut &[u8]) -> Option<u64> {
    let mut v = 0;
    for shift in (0..64).step_by(7) {
        let (&byte, after) = rest.split_first()?;
        *rest = after;
        v |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(v);
        }
    }
    None
}
