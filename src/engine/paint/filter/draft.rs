//! Drafts of filters that soften, for a moment while the user drags: the picture is filtered at half
//! the size and enlarged. Floor 3. Not here: when a layer is shown as a draft (`document`).
//!
//! What half the size cannot hold, the detail of single pixels, is taken from the picture itself where
//! the filter leaves it: near the center of a turn, or in focus. So a picture hardly moves when its
//! draft appears and when the whole filter follows. A pixel of half the size is the mean of 2 × 2,
//! which lie at even places of the picture, so that all blocks have the same ones.

use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::Rect;

/// A filter that softens so much that its draft is made at half the size.
pub(in crate::paint) trait SoftKernel: FilterKernel {
    /// How much of the finest detail it leaves at each pixel of a place, row by row: from 0 for none,
    /// to 1 where it changes nothing.
    fn detail_left(&self, place: &FilterPlace, bounds: Rect) -> Vec<f32>;

    /// The filter at half the size, as quickly as a draft may be.
    fn apply_as_draft(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        self.apply(place, source)
    }
}

/// How much of its own detail is left in a pixel by the mean of so many, in `[0, 1]`: of the mean of
/// eight, nothing that would be seen.
pub(super) fn detail_of_mean(pixels: f32) -> f32 {
    const NONE: f32 = 1.0 / 8.0;
    ((1.0 / pixels.max(1.0) - NONE) / (1.0 - NONE)).max(0.0)
}

/// What a draft reads for the pixels of a rectangle.
///
/// * `halved`: the filter, its lengths for half the size.
pub(super) fn reads(halved: &dyn SoftKernel, out: Rect, bounds: Rect) -> Vec<Rect> {
    let small = halved.reads(small_part(out, bounds), half(bounds));
    small.into_iter().map(double).chain([out]).collect()
}

/// The pixels of a rectangle, filtered at half the size, row by row.
///
/// * `halved`: as of [`reads`].
pub(super) fn apply(
    halved: &dyn SoftKernel,
    place: &FilterPlace,
    source: &dyn FilterSource,
) -> Vec<[f32; 4]> {
    let (out, part) = (place.out, small_part(place.out, source.bounds()));
    let small = HalvedSource { bounds: half(source.bounds()), source };
    let small_place = FilterPlace { out: part, canvas_px: 2 * place.canvas_px, ..*place };
    let mut pixels = halved.apply_as_draft(&small_place, &small);
    let left = halved.detail_left(&small_place, small.bounds);
    let mut all = vec![[0.0; 4]; out.width() * out.height()];
    // Rows of the small part that have detail.
    let width = part.width().max(1);
    let has_detail = |row: &[f32]| row.iter().any(|share| *share > 0.0);
    let first = left.chunks_exact(width).position(has_detail);
    let last = left.chunks_exact(width).rposition(has_detail);
    let Some((first, last)) = first.zip(last) else {
        enlarge_pixels(&pixels, part, out, &mut all);
        return all;
    };
    let (top, bottom) = (part.y0 + first as i32, part.y0 + last as i32 + 1);
    let detailed = Rect { y0: top, y1: bottom, ..part };
    let own = first * width..(last + 1) * width;
    take_shares(small.window(detailed).pixels(), &left[own.clone()], &mut pixels[own]);
    enlarge_pixels(&pixels, part, out, &mut all);
    let seen = Rect { y0: 2 * top - 1, y1: 2 * bottom + 1, ..out }.intersect(out);
    let mut shares = vec![0.0; seen.width() * seen.height()];
    enlarge_shares(&left, part, seen, &mut shares);
    let start = (seen.y0 - out.y0) as usize * out.width();
    let changed = &mut all[start..start + shares.len()];
    add_shares(source.window(seen).pixels(), &shares, changed);
    all
}

/// The pixels of half the size that a rectangle touches.
fn half(rect: Rect) -> Rect {
    let down = |v: i32| v.div_euclid(2);
    Rect::new(down(rect.x0), down(rect.y0), down(rect.x1 + 1), down(rect.y1 + 1))
}

/// The pixels of a rectangle of half the size.
fn double(rect: Rect) -> Rect {
    Rect::new(2 * rect.x0, 2 * rect.y0, 2 * rect.x1, 2 * rect.y1)
}

/// The pixels of half the size between which those of a rectangle lie.
fn small_part(out: Rect, bounds: Rect) -> Rect {
    half(out).grown(1).intersect(half(bounds))
}

/// A picture at half the size.
struct HalvedSource<'a> {
    source: &'a dyn FilterSource,
    bounds: Rect,
}

impl FilterSource for HalvedSource<'_> {
    fn bounds(&self) -> Rect {
        self.bounds
    }

    /// Some rows at a time, which fit into the processor's cache.
    fn window(&self, rect: Rect) -> FilterWindow {
        const ROWS: usize = 8;
        let width = rect.width().max(1);
        let mut means = vec![[0.0; 4]; rect.width() * rect.height()];
        for (i, rows) in means.chunks_mut(ROWS * width).enumerate() {
            let top = rect.y0 + (i * ROWS) as i32;
            let part = Rect { y0: top, y1: top + (rows.len() / width) as i32, ..rect };
            let fine = self.source.window(double(part));
            let pairs = fine.pixels().chunks_exact(4 * width);
            for (row, pair) in rows.chunks_exact_mut(width).zip(pairs) {
                let (upper, lower) = pair.split_at(2 * width);
                average_pairs(upper, lower, row);
            }
        }
        FilterWindow::new(rect, means)
    }
}

crate::widest! {
    /// The means of 2 × 2 pixels.
    fn average_pairs(upper: &[[f32; 4]], lower: &[[f32; 4]], means: &mut [[f32; 4]]) {
        let pairs = upper.chunks_exact(2).zip(lower.chunks_exact(2));
        for (mean, (upper, lower)) in means.iter_mut().zip(pairs) {
            for k in 0..4 {
                mean[k] = 0.25 * ((upper[0][k] + upper[1][k]) + (lower[0][k] + lower[1][k]));
            }
        }
    }

    /// Takes away a share of each pixel of a picture.
    fn take_shares(picture: &[[f32; 4]], shares: &[f32], pixels: &mut [[f32; 4]]) {
        for ((pixel, own), share) in pixels.iter_mut().zip(picture).zip(shares) {
            for k in 0..4 {
                pixel[k] -= share * own[k];
            }
        }
    }

    /// Adds a share of each pixel of a picture.
    fn add_shares(picture: &[[f32; 4]], shares: &[f32], pixels: &mut [[f32; 4]]) {
        for ((pixel, own), share) in pixels.iter_mut().zip(picture).zip(shares) {
            for k in 0..4 {
                pixel[k] += share * own[k];
            }
        }
    }

    fn enlarge_pixels(small: &[[f32; 4]], part: Rect, out: Rect, all: &mut [[f32; 4]]) {
        enlarge(small, part, out, all);
    }

    fn enlarge_shares(small: &[f32], part: Rect, out: Rect, all: &mut [f32]) {
        enlarge(small.as_chunks::<1>().0, part, out, all.as_chunks_mut::<1>().0);
    }
}

/// The pixels of a rectangle between those of half the size, bilinear.
///
/// * `small`: of the rectangle `part` of half the size, whose border is repeated.
#[inline(always)]
fn enlarge<const N: usize>(small: &[[f32; N]], part: Rect, out: Rect, all: &mut [[f32; N]]) {
    const NEAR: f32 = 0.75;
    const FAR: f32 = 0.25;
    let width = part.width();
    if width == 0 || out.is_empty() {
        return;
    }
    let (mut between, mut line) = (vec![[0.0; N]; width + 2], vec![[0.0; N]; 2 * width]);
    let left = (out.x0 - 2 * part.x0) as usize;
    for (y, to) in (out.y0..out.y1).zip(all.chunks_exact_mut(out.width())) {
        let near = y.div_euclid(2);
        let far = if y.rem_euclid(2) == 0 { near - 1 } else { near + 1 };
        let rows = [near, far].map(|y| {
            let row = (y.max(part.y0).min(part.y1 - 1) - part.y0) as usize;
            &small[row * width..(row + 1) * width]
        });
        for ((value, near), far) in between[1..=width].iter_mut().zip(rows[0]).zip(rows[1]) {
            for k in 0..N {
                value[k] = NEAR * near[k] + FAR * far[k];
            }
        }
        (between[0], between[width + 1]) = (between[1], between[width]);
        for (pair, around) in line.chunks_exact_mut(2).zip(between.windows(3)) {
            for k in 0..N {
                pair[0][k] = NEAR * around[1][k] + FAR * around[0][k];
                pair[1][k] = NEAR * around[1][k] + FAR * around[2][k];
            }
        }
        to.copy_from_slice(&line[left..left + out.width()]);
    }
}
