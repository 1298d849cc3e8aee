//! Pixels of 16 bits, which a tile holds in addition to its bytes where its paint is smooth:
//! premultiplied, 65535 is full. Floor 1. Each channel of a row is separate, so that loading a row
//! takes no shuffles.

use super::TILE;
use crate::math::srgb::quantize16;

/// One row of a tile: red, green, blue, each no greater than alpha, and alpha.
pub type Row16 = [[u16; TILE]; 4];

/// A row without paint.
pub const CLEAR_ROW: Row16 = [[0; TILE]; 4];

/// One level of 8 bits in 16 bits.
pub const LEVEL: u16 = 257;

/// This many pixels of a tile must be smooth for it to be kept in 16 bits. Edges of ink leave one
/// or two by chance.
const LEAST_SMOOTH: u32 = 8;

/// A value nearer to a byte than a sixteenth of a level counts as that byte: strokes leave such
/// residues.
const TRACE: u16 = LEVEL / 16;

/// A tile of transparent rows.
pub fn clear_rows() -> Box<[Row16]> {
    vec![CLEAR_ROW; TILE].into_boxed_slice()
}

/// The byte nearest to a value of 16 bits; there are no ties.
#[inline(always)]
pub fn byte_of(v: u16) -> u8 {
    // (v + 128) / 257 for every v, without a division (tested).
    ((u32::from(v) * 255 + 32895) >> 16) as u8
}

/// A pixel of a tile's rows.
#[inline(always)]
pub fn pixel_of(rows: &[Row16], x: usize, y: usize) -> [u16; 4] {
    rows.get(y).map_or([0; 4], |row| std::array::from_fn(|c| row[c].get(x).copied().unwrap_or(0)))
}

/// Puts a pixel into a row; colors above alpha are lowered to it.
#[inline(always)]
pub fn put(row: &mut Row16, x: usize, [r, g, b, a]: [u16; 4]) {
    for (channel, value) in row.iter_mut().zip([r.min(a), g.min(a), b.min(a), a]) {
        channel[x] = value;
    }
}

/// How far a value lies from the nearest one that a byte has.
#[inline(always)]
fn distance_from_byte(v: u16) -> u16 {
    // 256 high + low = 257 high + (low − high).
    let off = (v >> 8).abs_diff(v & 255);
    off.min(LEVEL - off)
}

crate::widest! {
    /// Rounds a premultiplied row of floats; colors above alpha are lowered to it.
    pub fn quantize_row(row: [&[f32; TILE]; 4], rows16: &mut Row16) {
        for (channel, rows16) in row.into_iter().zip(rows16.iter_mut()) {
            for x in 0..TILE {
                rows16[x] = quantize16(channel[x]);
            }
        }
        let [r, g, b, a] = rows16;
        for channel in [r, g, b] {
            for x in 0..TILE {
                channel[x] = channel[x].min(a[x]);
            }
        }
    }

    /// Rounds rows to bytes, four a pixel; whether bytes hold every value exactly.
    pub fn to_bytes(rows16: &[Row16], bytes: &mut [u8]) -> bool {
        let mut off = 0;
        for (row, bytes) in rows16.iter().zip(bytes.chunks_exact_mut(4 * TILE)) {
            // Whole pixels: bytes four apart are written one by one.
            let mut packed = [0u32; TILE];
            for (c, channel) in row.iter().enumerate() {
                for x in 0..TILE {
                    let byte = byte_of(channel[x]);
                    packed[x] |= u32::from(byte) << (8 * c);
                    off |= channel[x] ^ (u16::from(byte) * LEVEL);
                }
            }
            for (bytes, packed) in bytes.chunks_exact_mut(4).zip(packed) {
                bytes.copy_from_slice(&packed.to_le_bytes());
            }
        }
        off == 0
    }

    /// Bytes, four a pixel, in 16 bits.
    pub fn of_bytes(bytes: &[u8], rows16: &mut [Row16]) {
        for (bytes, row) in bytes.chunks_exact(4 * TILE).zip(rows16) {
            for (c, channel) in row.iter_mut().enumerate() {
                for x in 0..TILE {
                    channel[x] = u16::from(bytes[4 * x + c]) * LEVEL;
                }
            }
        }
    }

    /// For each pixel of a row whether it is smooth, 1 or 0: see [`is_smooth`].
    fn find_smooth(above: &Row16, row: &Row16, below: &Row16, smooth: &mut [u16; TILE]) {
        let (mut off, mut steps) = ([0u16; TILE], [0u16; TILE]);
        for c in 0..4 {
            // The border is repeated beyond the tile.
            let mut wide = [0u16; TILE + 2];
            wide[1..=TILE].copy_from_slice(&row[c]);
            (wide[0], wide[TILE + 1]) = (row[c][0], row[c][TILE - 1]);
            for x in 0..TILE {
                let v = wide[x + 1];
                off[x] = off[x].max(distance_from_byte(v));
                let beside = v.abs_diff(wide[x]).max(v.abs_diff(wide[x + 2]));
                let beyond = v.abs_diff(above[c][x]).max(v.abs_diff(below[c][x]));
                steps[x] = steps[x].max(beside.max(beyond));
            }
        }
        for x in 0..TILE {
            smooth[x] = u16::from(off[x] > TRACE) & u16::from(steps[x] < LEVEL);
        }
    }
}

/// Whether bytes would lose what was painted: some pixels are smooth. A pixel is smooth if bytes
/// cannot hold it, and all four neighbors differ by less than a level of 8 bits in every channel.
///
/// In smooth pixels rounding makes steps that are wider than a pixel, which show as bands, and
/// faint paint that builds up stroke by stroke is rounded away. At an edge, where neighbors are
/// levels apart, neither shows: so ink, including its rims, stays in bytes.
///
/// * `row`: puts a row in place, the top one first; each is requested once.
pub fn is_smooth(mut row: impl FnMut(usize, &mut Row16)) -> bool {
    // Three rows at a time, so that they stay in the first-level cache.
    let (mut window, mut count, mut smooth) = ([CLEAR_ROW; 3], 0u32, [0u16; TILE]);
    row(0, &mut window[0]);
    for y in 0..TILE {
        if y + 1 < TILE {
            row(y + 1, &mut window[(y + 1) % 3]);
        }
        let at = |y: usize| &window[y % 3];
        find_smooth(at(y.saturating_sub(1)), at(y), at((y + 1).min(TILE - 1)), &mut smooth);
        count += u32::from(smooth.iter().sum::<u16>());
        if count >= LEAST_SMOOTH {
            return true;
        }
    }
    false
}

/// Straight values of 16 bits to premultiplied ones, rounded to nearest.
#[inline(always)]
pub fn premultiplied([r, g, b, a]: [u16; 4]) -> [u16; 4] {
    // At most 65535² + 32767, which is below 2³².
    let times = |c: u16| ((u32::from(c) * u32::from(a) + 32767) / 65535) as u16;
    [times(r), times(g), times(b), a]
}

/// Premultiplied values to straight ones, rounded to nearest: [`premultiplied`] is the exact
/// inverse.
///
/// The straight value is at most ½ off, and less than that after multiplication by α / 65535 < 1.
#[inline(always)]
pub fn straight([r, g, b, a]: [u16; 4]) -> [u16; 4] {
    let (whole, half) = (u32::from(a.max(1)), u32::from(a / 2));
    let of = |c: u16| ((u32::from(c.min(a)) * 65535 + half) / whole) as u16;
    if a == 0 { [0; 4] } else { [of(r), of(g), of(b), a] }
}

#[cfg(test)]
mod tests {
    use super::super::TILE_AREA;
    use super::*;
    use crate::math::hash;

    /// [`is_smooth`], pixel by pixel.
    fn count_smooth(rows16: &[Row16]) -> usize {
        let at =
            |x: i32, y: i32| pixel_of(rows16, x.clamp(0, 63) as usize, y.clamp(0, 63) as usize);
        let is_smooth = |i: usize| {
            let (x, y) = ((i % TILE) as i32, (i / TILE) as i32);
            let near = |(dx, dy)| (0..4).all(|c| at(x, y)[c].abs_diff(at(x + dx, y + dy)[c]) < 257);
            at(x, y).iter().any(|v| (17..=240).contains(&(v % 257)))
                && [(-1, 0), (1, 0), (0, -1), (0, 1)].into_iter().all(near)
        };
        (0..TILE_AREA).filter(|&i| is_smooth(i)).count()
    }

    fn painted(value: impl Fn(usize, usize) -> [u16; 4]) -> Box<[Row16]> {
        let mut rows = clear_rows();
        (0..TILE_AREA).for_each(|i| put(&mut rows[i / TILE], i % TILE, value(i % TILE, i / TILE)));
        rows
    }

    #[test]
    fn every_value_has_its_nearest_byte() {
        for v in 0..=u16::MAX {
            assert_eq!(u32::from(byte_of(v)), (u32::from(v) + 128) / 257, "{v}");
            assert_eq!(distance_from_byte(v), v.abs_diff(u16::from(byte_of(v)) * 257), "{v}");
        }
    }

    #[test]
    fn premultiplied_values_come_back_as_they_were_from_straight_ones() {
        let check = |c: u16, a: u16| {
            let held = [c.min(a), 0, a, a];
            assert_eq!(premultiplied(straight(held)), held, "{c} of {a}");
        };
        for a in [0, 1, 2, 3, 255, 256, 257, 32767, 32768, 65533, 65534, 65535] {
            (0..=a).for_each(|c| check(c, a));
        }
        let random = |i: u32, j: u32| (hash::unit(i, j, 0) * 65536.0) as u16;
        (0..200_000).for_each(|i| check(random(i, 0), random(i, 1)));
    }

    #[test]
    fn what_is_smooth_is_what_the_definition_says() {
        let ramp = |per_px: usize| painted(|x, _| [0, 0, 0, (20_003 + x * per_px) as u16]);
        let dots = |n: usize| {
            painted(|x, y| if x % 9 == 4 && y == 5 && x / 9 < n { [0, 0, 0, 100] } else { [0; 4] })
        };
        let cases = [
            (clear_rows(), 0),
            (ramp(256), 4096),
            (ramp(258), 0),
            (painted(|_, _| [0, 257, 514, 65535]), 0),
            (painted(|_, _| [0, 0, 300, 65535]), 4096),
            (dots(7), 7),
            (
                painted(|x, y| {
                    if x < 30 && y < 30 { [65535; 4] } else { [(x * 700 + y) as u16, 0, 0, 65535] }
                }),
                0,
            ),
        ];
        for (i, (rows, smooth)) in cases.iter().enumerate() {
            assert_eq!(count_smooth(rows), *smooth, "case {i}");
            assert_eq!(
                is_smooth(|y, row| *row = rows[y]),
                count_smooth(rows) >= LEAST_SMOOTH as usize,
                "case {i}"
            );
        }
        for seed in 0..40u32 {
            let noise = painted(|x, y| {
                let gentle = (hash::unit(seed, x as u32 / 8, y as u32) * 600.0) as u16;
                [gentle / 2, gentle, 0, gentle.saturating_mul(1 + (seed as u16) % 3)]
            });
            assert_eq!(
                is_smooth(|y, row| *row = noise[y]),
                count_smooth(&noise) >= LEAST_SMOOTH as usize,
                "seed {seed}"
            );
        }
    }

    #[test]
    fn bytes_go_in_and_out_and_are_known_as_such() {
        let bytes: Vec<u8> = (0..TILE_AREA * 4).map(|i| (i * 37 % 256) as u8).collect();
        let (mut rows, mut back) = (clear_rows(), vec![0; TILE_AREA * 4]);
        of_bytes(&bytes, &mut rows);
        assert!(to_bytes(&rows, &mut back));
        assert!(back == bytes);
        rows[63][2][63] ^= 1;
        assert!(!to_bytes(&rows, &mut back));
    }

    #[test]
    fn floats_are_rounded_and_colors_lowered_to_alpha() {
        let [r, g, b, a] = [0.9, 0.25, f32::NAN, 0.5].map(|v| [v; TILE]);
        let mut rows16 = CLEAR_ROW;
        quantize_row([&r, &g, &b, &a], &mut rows16);
        assert_eq!(pixel_of(&[rows16], 9, 0), [32768, 16384, 0, 32768]);
    }
}
