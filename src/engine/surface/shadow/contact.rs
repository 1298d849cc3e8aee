//! Contact shade: where the surroundings stand higher, at several sizes, and where they lie lower.
//! Floor 2. It depends on depth alone.
//!
//! With G_σ h the heights blurred by σ: what stands higher is Σ_σ max(0, G_σ h − h)/σ. What lies
//! lower is the same of h − G_σ h at the larger sizes, halved, and the share of the page within
//! the third size. Wide blurs are taken of smaller maps.

use super::ShareMap;
use super::heights::halve;
use crate::math::{Size, fast, parallel};
use crate::raster::{Plane, blur};
use crate::surface::Surface;
use crate::surface::cache::HeapSize;
use crate::surface::contours::FarSide;
use std::sync::Arc;

/// The sizes, as shares of the largest.
const SIZES: [f32; 4] = [4.0 / 45.0, 9.0 / 45.0, 20.0 / 45.0, 1.0];
/// Those from which on surroundings count that lie lower: small parts on others do not stand out.
const LARGE: usize = 2;
/// Sums above this are cut off.
const MOST: f32 = 16.0;
/// A blur in px of the smaller map that it is taken of, at least.
const FINE_PX: f32 = 2.0;

/// How the surroundings of each pixel stand to it.
pub struct ContactShade {
    /// Σ max(0, G_σ h − h)/σ.
    pub higher: ShareMap,
    /// ½ Σ max(0, h − G_σ h)/σ over the larger sizes, and the share of the page nearby.
    pub lower: ShareMap,
}

impl HeapSize for ContactShade {
    fn heap_bytes(&self) -> u64 {
        self.higher.heap_bytes() + self.lower.heap_bytes()
    }
}

/// A map blurred, of its own size or half of it.
struct Blurred {
    sigma_px: f32,
    is_half: bool,
    map: Plane<f32>,
}

impl Blurred {
    /// Of a map that is `step` times as small as the whole one.
    fn of(map: &Plane<f32>, step: usize, sigma_px: f32, half: Size) -> Self {
        let blurred = blur::gaussian(map, sigma_px / step as f32);
        let map = if step > 2 { enlarge(&blurred, step / 2, half) } else { blurred };
        Self { sigma_px, is_half: step > 1, map }
    }

    /// The blurred map at every pixel of a row.
    fn row(&self, y: usize, row: &mut [f32], between: &mut Vec<f32>) {
        if !self.is_half {
            return row.copy_from_slice(self.map.row(y));
        }
        let (above, below, down) = place(y, 2, self.map.height());
        between.clear();
        let rows = self.map.row(above).iter().zip(self.map.row(below));
        between.extend(rows.map(|(a, b)| a + (b - a) * down));
        enlarge_row(between, row);
    }
}

/// The pixels before and after pixel `at` of a map, in one `step` times as small, and the share of
/// the second.
fn place(at: usize, step: usize, count: usize) -> (usize, usize, f32) {
    let v = ((at as f32 + 0.5) / step as f32 - 0.5).max(0.0);
    let first = (v as usize).min(count - 1);
    (first, (first + 1).min(count - 1), v - first as f32)
}

/// A map `step` times as large, up to a size.
fn enlarge(map: &Plane<f32>, step: usize, size: Size) -> Plane<f32> {
    let columns: Vec<(usize, usize, f32)> =
        (0..size.width as usize).map(|x| place(x, step, map.width())).collect();
    let (mut large, width) = (Plane::full(size, 0.0), size.width.max(1) as usize);
    parallel::for_each_with(
        large.values_mut().chunks_mut(width).enumerate(),
        1,
        Vec::new,
        |between, (y, row)| {
            let (above, below, down) = place(y, step, map.height());
            between.clear();
            let rows = map.row(above).iter().zip(map.row(below));
            between.extend(rows.map(|(a, b)| a + (b - a) * down));
            for (value, (left, right, along)) in row.iter_mut().zip(&columns) {
                *value = between[*left] + (between[*right] - between[*left]) * along;
            }
        },
    );
    large
}

/// The step of the smaller map for a blur.
fn step_of(sigma_px: f32) -> usize {
    1 << ((sigma_px / FINE_PX).log2().max(0.0) as u32).min(6)
}

impl ContactShade {
    pub(super) fn of(surface: &Surface, largest_px: f32) -> Self {
        let heights = surface.heights();
        let map = &heights.upright;
        let sigmas = SIZES.map(|share| (share * largest_px).max(0.5));
        let steps = sigmas.map(step_of);
        let page_of = || {
            let page = halve_page(surface);
            let smaller = Halves::of(&page, steps[LARGE].max(2) / 2);
            Blurred::of(smaller.last(&page), steps[LARGE].max(2), sigmas[LARGE], page.size())
        };
        let (page, blurred) = rayon::join(page_of, || {
            let halves = Halves::of(&map.half, steps[3] / 2);
            let of = |i: usize| {
                let from =
                    if steps[i] == 1 { &map.whole } else { halves.at(&map.half, steps[i] / 2) };
                Blurred::of(from, steps[i], sigmas[i], map.half.size())
            };
            [0, 1, 2, 3].map(of)
        });
        Self::sum(&map.whole, &blurred, &page)
    }

    fn sum(map: &Plane<f32>, blurred: &[Blurred; 4], page: &Blurred) -> Self {
        let width = map.width().max(1);
        let (mut higher, mut lower) = (Plane::full(map.size(), 0), Plane::full(map.size(), 0));
        let rows = higher.values_mut().chunks_mut(width).zip(lower.values_mut().chunks_mut(width));
        parallel::for_each_with(
            rows.enumerate(),
            1,
            || (std::array::from_fn(|_| vec![0.0; width]), Vec::new()),
            |([row, up, down], between), (y, (higher, lower))| {
                up.fill(0.0);
                page.row(y, down, between);
                for (i, size) in blurred.iter().enumerate() {
                    size.row(y, row, between);
                    let per_px = 1.0 / size.sigma_px;
                    add_higher(map.row(y), row, per_px, up);
                    if i >= LARGE {
                        add_lower(map.row(y), row, 0.5 * per_px, down);
                    }
                }
                round(up, higher);
                round(down, lower);
            },
        );
        Self {
            higher: ShareMap::from_steps(higher, MOST),
            lower: ShareMap::from_steps(lower, MOST),
        }
    }
}

/// A map at a half, a quarter … of its size.
struct Halves(Vec<Plane<f32>>);

impl Halves {
    /// Down to a `step`-th.
    fn of(map: &Plane<f32>, step: usize) -> Self {
        let mut halves: Vec<Plane<f32>> = Vec::new();
        for _ in 0..step.max(1).ilog2() {
            halves.push(halve(halves.last().unwrap_or(map)));
        }
        Self(halves)
    }

    /// The one that is `step` times as small as `map`, which it is made of.
    fn at<'a>(&'a self, map: &'a Plane<f32>, step: usize) -> &'a Plane<f32> {
        (step.max(1).ilog2() as usize).checked_sub(1).map_or(map, |i| &self.0[i])
    }

    fn last<'a>(&'a self, map: &'a Plane<f32>) -> &'a Plane<f32> {
        self.0.last().unwrap_or(map)
    }
}

/// The share of the page in each two by two pixels.
fn halve_page(surface: &Surface) -> Plane<f32> {
    let coverage = surface.coverage_plane();
    let side = |n: usize| n.div_ceil(2).max(1) as u32;
    let mut page = Plane::full(Size::new(side(coverage.width()), side(coverage.height())), 1.0);
    let width = page.width();
    parallel::for_each_row(page.values_mut(), width, 1, |y, row| {
        let last = coverage.height().saturating_sub(1);
        let rows = [2 * y, 2 * y + 1].map(|y| coverage.row(y.min(last)));
        let pairs = rows[0].chunks(2).zip(rows[1].chunks(2));
        for (page, (above, below)) in row.iter_mut().zip(pairs) {
            let sum = |pair: &[u8]| u32::from(pair[0]) + u32::from(pair[pair.len() - 1]);
            *page = 1.0 - (sum(above) + sum(below)) as f32 * (1.0 / 1020.0);
        }
    });
    page
}

crate::widest! {
    /// A row twice as long, linear between pixel centers.
    fn enlarge_row(half: &[f32], row: &mut [f32]) {
        let last = half.len().saturating_sub(1);
        let (pairs, rest) = row.as_chunks_mut::<2>();
        for (i, pair) in pairs.iter_mut().enumerate().take(1) {
            *pair = [half[0], 0.75 * half[0] + 0.25 * half[(i + 1).min(last)]];
        }
        let inner = last.saturating_sub(1).min(pairs.len().saturating_sub(1));
        if let (Some(pairs), [left @ .., _, _], [_, own @ .., _], [_, _, right @ ..]) =
            (pairs.get_mut(1..=inner), half, half, half)
        {
            for (pair, ((left, own), right)) in pairs.iter_mut().zip(left.iter().zip(own).zip(right)) {
                *pair = [0.25 * left + 0.75 * own, 0.75 * own + 0.25 * right];
            }
        }
        for (i, pair) in pairs.iter_mut().enumerate().skip(inner + 1) {
            let own = half[i.min(last)];
            *pair = [0.25 * half[i.saturating_sub(1)] + 0.75 * own, 0.75 * own + 0.25 * half[(i + 1).min(last)]];
        }
        if let [value] = rest {
            *value = 0.25 * half[last.saturating_sub(1)] + 0.75 * half[last];
        }
    }

    fn add_higher(h: &[f32], blurred: &[f32], per_px: f32, sum: &mut [f32]) {
        for ((sum, h), blurred) in sum.iter_mut().zip(h).zip(blurred) {
            *sum += fast::max(blurred - h, 0.0) * per_px;
        }
    }

    fn add_lower(h: &[f32], blurred: &[f32], per_px: f32, sum: &mut [f32]) {
        for ((sum, h), blurred) in sum.iter_mut().zip(h).zip(blurred) {
            *sum += fast::max(h - blurred, 0.0) * per_px;
        }
    }

    /// To steps of a `MOST` / 65535th.
    fn round(values: &[f32], steps: &mut [u16]) {
        for (step, v) in steps.iter_mut().zip(values) {
            *step = fast::whole(fast::min(*v, MOST) * (65535.0 / MOST)) as u16;
        }
    }
}

impl Surface {
    /// How the surroundings of each pixel stand to it, up to a size in px. Cached; call it once
    /// before going parallel. For a far side it is that of the other sides' pixels nearby.
    pub fn contact(&self, largest_px: f32) -> Arc<ContactShade> {
        const KEPT: usize = 2;
        let key = largest_px.to_bits();
        let base = self.base();
        let on_far_side = |far: &FarSide, front: Option<&Surface>| {
            let of = front.map(|front| front.contact(largest_px));
            let mean = |map: fn(&ContactShade) -> &ShareMap| {
                let read = |x: usize, y: usize| of.as_ref().map_or(0.0, |of| map(of).at(x, y));
                let plane = far.map(self.size(), |pixel| pixel.other_mean(read));
                ShareMap::from_plane(plane, MOST)
            };
            ContactShade { higher: mean(|of| &of.higher), lower: mean(|of| &of.lower) }
        };
        base.derived.contacts.get_or_compute(key, KEPT, |_| {
            self.on_either_side(|| ContactShade::of(base, largest_px), on_far_side)
        })
    }
}
