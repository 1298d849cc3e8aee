//! Bilinear taps for whole rows: the fast twin of `bilinear`.
//! Floor 1. Two passes a span: positions to indices and fractions, several pixels an instruction; then the texels, one
//! pixel at a time with its four channels side by side.

use super::super::texture::{Level, Outside, Texture};
use super::{bilinear_in, mix};
use crate::math::{srgb::quantise, vec2};

/// Pixels in flight: the indices of a span stay in the first-level cache.
const SPAN: usize = 256;

/// Marks a pixel whose four texels do not lie together inside the picture.
const SEAM: u32 = u32::MAX;

/// The picture's premultiplied bytes at each position (`x`, `y`; texels), rounded: four for each of `out`.
pub fn bilinear_row(texture: &Texture, x: &[f32], y: &[f32], outside: Outside, out: &mut [u8]) {
    let level = &texture.levels()[0];
    let mut taps = Taps { index: [0; SPAN], column: [0; SPAN], tx: [0.0; SPAN], ty: [0.0; SPAN] };
    let spans = x.chunks(SPAN).zip(y.chunks(SPAN)).zip(out.chunks_mut(SPAN * 4));
    for ((x, y), out) in spans {
        find_taps(level, x, y, outside, &mut taps);
        gather(level, x, y, outside, &taps, out);
    }
}

/// Where the pixels of a span are looked up: index of the upper left texel ([`SEAM`] where there is none), fractions.
struct Taps {
    index: [u32; SPAN],
    column: [i32; SPAN],
    tx: [f32; SPAN],
    ty: [f32; SPAN],
}

crate::widest! {
    fn find_taps(level: &Level, x: &[f32], y: &[f32], outside: Outside, taps: &mut Taps) {
        let (w, h) = (level.size.width as i32, level.size.height as i32);
        let n = x.len().min(SPAN);
        if w < 2 || h < 2 {
            taps.index[..n].fill(SEAM);
            return;
        }
        let Taps { index, column, tx, ty } = taps;
        match outside {
            Outside::None => {
                axis(x, w, |c| c, column, tx);
                rows(y, h, |c| c, w, column, ty, index);
            }
            Outside::Clamp => {
                axis(x, w, |c| within(c, w), column, tx);
                rows(y, h, |c| within(c, h), w, column, ty, index);
            }
            Outside::Repeat => {
                axis(x, w, |c| repeated(c, w as f32), column, tx);
                rows(y, h, |c| repeated(c, h as f32), w, column, ty, index);
            }
            Outside::Mirror => {
                axis(x, w, |c| within(mirrored(c, w as f32), w), column, tx);
                rows(y, h, |c| within(mirrored(c, h as f32), h), w, column, ty, index);
            }
        }
    }
    fn gather(level: &Level, x: &[f32], y: &[f32], outside: Outside, taps: &Taps, out: &mut [u8]) {
        let (texels, w) = (&level.texels[..], level.size.width as usize);
        let pixels = taps.index.iter().zip(&taps.tx).zip(&taps.ty).zip(x.iter().zip(y)).zip(out.chunks_exact_mut(4));
        for ((((&index, &tx), &ty), (&x, &y)), out) in pixels {
            let first = index as usize;
            let pair = |at: usize| texels.get(at..)?.first_chunk::<2>();
            let color = match (pair(first), pair(first + w)) {
                (Some(top), Some(bottom)) => mix(*top, *bottom, tx, ty),
                _ => bilinear_in(level, vec2(x, y), outside),
            };
            for c in 0..4 {
                out[c] = quantise(color[c] * (1.0 / 255.0));
            }
        }
    }
}

/// Columns and fractions along x; −1 where the pair of texels does not lie inside.
#[inline(always)]
fn axis(x: &[f32], n: i32, fold: impl Fn(f32) -> f32, column: &mut [i32; SPAN], t: &mut [f32; SPAN]) {
    for ((&c, column), t) in x.iter().zip(column).zip(t) {
        (*column, *t) = first_of_pair(fold(c) - 0.5, n);
    }
}

/// Fractions along y, and both axes' indices put together.
#[inline(always)]
fn rows(
    y: &[f32],
    n: i32,
    fold: impl Fn(f32) -> f32,
    width: i32,
    column: &[i32; SPAN],
    t: &mut [f32; SPAN],
    index: &mut [u32; SPAN],
) {
    for (((&c, &column), t), index) in y.iter().zip(column).zip(t).zip(index) {
        let row;
        (row, *t) = first_of_pair(fold(c) - 0.5, n);
        *index = if (row | column) < 0 { SEAM } else { (row * width + column) as u32 };
    }
}

/// The texel at or before a position `u` (in texel centres) and how far beyond it `u` lies; −1 outside `[0, n − 1]`.
#[inline(always)]
fn first_of_pair(u: f32, n: i32) -> (i32, f32) {
    let last = (n - 1) as f32;
    let i = (u as i32).min(n - 2);
    let inside = u >= 0.0 && u <= last;
    (if inside { i } else { -1 }, u - i as f32)
}

/// Clamped so that both texels of the pair are the border's own.
#[inline(always)]
fn within(c: f32, n: i32) -> f32 {
    c.max(0.5).min(n as f32 - 0.5)
}

/// The position in `[0, n]` that a mirrored picture shows at `c`.
#[inline(always)]
fn mirrored(c: f32, n: f32) -> f32 {
    let period = 2.0 * n;
    let m = c - floor(c / period) * period;
    if m > n { period - m } else { m }
}

/// The position in `[0, n]` that a repeated picture shows at `c`.
#[inline(always)]
fn repeated(c: f32, n: f32) -> f32 {
    c - floor(c / n) * n
}

/// `f32::floor` for values within i32's range, in instructions that every x86-64 has.
#[inline(always)]
fn floor(v: f32) -> f32 {
    let toward_zero = v as i32 as f32;
    if toward_zero > v { toward_zero - 1.0 } else { toward_zero }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, hash};
    use crate::raster::Picture;

    fn noise(size: Size) -> Texture {
        let texel = |i| {
            let byte = |c| (hash::unit(1, i, c) * 256.0) as u8;
            [byte(0), byte(1), byte(2), byte(3)]
        };
        Texture::new(&Picture::srgb8(size, (0..size.area() as u32).map(texel).collect()).unwrap())
    }

    #[test]
    fn rows_equal_the_reference_inside_at_the_border_and_far_beyond() {
        for size in [Size::new(13, 9), Size::new(2, 2), Size::new(1, 5), Size::new(1, 1)] {
            let texture = noise(size);
            for outside in [Outside::None, Outside::Clamp, Outside::Repeat, Outside::Mirror] {
                let at = |i: u32, spread: f32| (hash::unit(2, i, 0) - 0.5) * spread;
                let spread = |i: u32| [12.0, 40.0, 40.0, 3000.0][i as usize % 4];
                let x: Vec<f32> = (0..2000).map(|i| at(i, spread(i)) + 6.0).collect();
                let y: Vec<f32> = (0..2000).map(|i| at(i + 5000, spread(i)) + 4.5).collect();
                let mut bytes = vec![0; 4 * x.len()];
                bilinear_row(&texture, &x, &y, outside, &mut bytes);
                for (i, pixel) in bytes.chunks_exact(4).enumerate() {
                    let reference = super::super::bilinear(&texture, vec2(x[i], y[i]), outside);
                    for c in 0..4 {
                        let difference = (f32::from(pixel[c]) - reference[c] * 255.0).abs();
                        assert!(difference <= 0.502, "{outside:?} {size} at {}, {}: {difference}", x[i], y[i]);
                    }
                }
            }
        }
    }
    #[test]
    fn texel_centres_give_the_texels_themselves() {
        let texture = noise(Size::new(300, 2));
        let x: Vec<f32> = (0..300).map(|i| i as f32 + 0.5).collect();
        let mut bytes = vec![0; 1200];
        for outside in [Outside::None, Outside::Clamp, Outside::Repeat, Outside::Mirror] {
            bilinear_row(&texture, &x, &[1.5; 300], outside, &mut bytes);
            assert_eq!(bytes, texture.levels()[0].texels[300..].as_flattened());
        }
    }
    #[test]
    fn positions_without_bound_read_something_without_panicking() {
        let texture = noise(Size::new(7, 5));
        let x = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 1e30, -1e30, 3e9];
        for outside in [Outside::None, Outside::Clamp, Outside::Repeat, Outside::Mirror] {
            bilinear_row(&texture, &x, &x, outside, &mut [0; 24]);
        }
    }
}
