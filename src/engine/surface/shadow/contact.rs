//! Contact shade: where the surroundings stand higher, at several sizes, and where they lie lower.
//! Floor 2. It depends on depth alone.
//!
//! With G_σ h the heights blurred by σ: what stands higher is Σ_σ max(0, G_σ h − h)/σ. What lies
//! lower is the same of h − G_σ h at the larger sizes, halved, and the share of the page within
//! the third size. Wide blurs are taken of smaller maps.

use super::ShareMap;
use crate::math::{Size, fast};
use crate::raster::{Plane, blur};
use crate::surface::Surface;
use crate::surface::cache::HeapSize;
use crate::surface::contours::FarSide;
use rayon::prelude::*;
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

/// Heights blurred, in a smaller map.
struct Blurred {
    sigma_px: f32,
    /// Pixels of the map to one of the smaller one, along a side.
    step: usize,
    map: Plane<f32>,
}

impl Blurred {
    /// How much of the page there is nearby.
    fn page(surface: &Surface, sigma_px: f32) -> Self {
        let page = surface.coverage_plane().map(|c| 1.0 - f32::from(c) / 255.0);
        let step = step_of(sigma_px);
        Self { sigma_px, step, map: blur::gaussian(&smaller(&page, step), sigma_px / step as f32) }
    }

    /// G_σ h of every pixel of a row.
    fn row(&self, y: usize, row: &mut [f32], between: &mut Vec<f32>) {
        let step = self.step as f32;
        let place = |at: usize, count: usize| {
            let v = ((at as f32 + 0.5) / step - 0.5).max(0.0);
            let first = (v as usize).min(count - 1);
            (first, (first + 1).min(count - 1), v - first as f32)
        };
        let (above, below, down) = place(y, self.map.height());
        let (above, below) = (self.map.row(above), self.map.row(below));
        between.clear();
        between.extend(above.iter().zip(below).map(|(a, b)| a + (b - a) * down));
        for (x, value) in row.iter_mut().enumerate() {
            let (left, right, along) = place(x, between.len());
            *value = between[left] + (between[right] - between[left]) * along;
        }
    }
}

/// The step of the smaller map for a blur.
fn step_of(sigma_px: f32) -> usize {
    1 << ((sigma_px / FINE_PX).log2().max(0.0) as u32).min(6)
}

/// The mean of each `step` × `step` pixels; fewer at the border.
fn smaller(map: &Plane<f32>, step: usize) -> Plane<f32> {
    let side = |n: usize| n.div_ceil(step) as u32;
    Plane::from_fn(Size::new(side(map.width()), side(map.height())), |x, y| {
        let (x1, y1) = (((x + 1) * step).min(map.width()), ((y + 1) * step).min(map.height()));
        let rows = (y * step..y1).map(|y| map.row(y)[x * step..x1].iter().sum::<f32>());
        rows.sum::<f32>() / ((x1 - x * step) * (y1 - y * step)) as f32
    })
}

impl ContactShade {
    pub(super) fn of(surface: &Surface, largest_px: f32) -> Self {
        let heights = surface.heights();
        let (map, page) =
            (&heights.upright.whole, Blurred::page(surface, SIZES[LARGE] * largest_px));
        let mut by_step: Vec<(usize, Plane<f32>)> = Vec::new();
        let blurred: Vec<Blurred> = SIZES
            .iter()
            .map(|share| {
                let sigma_px = (share * largest_px).max(0.5);
                let step = step_of(sigma_px);
                if step == 1 {
                    return Blurred { sigma_px, step, map: blur::gaussian(map, sigma_px) };
                }
                let (known, from) =
                    by_step.last().map_or((1, map), |(known, plane)| (*known, plane));
                let coarse = if known == step { from.clone() } else { smaller(from, step / known) };
                let blurred = blur::gaussian(&coarse, sigma_px / step as f32);
                by_step.push((step, coarse));
                Blurred { sigma_px, step, map: blurred }
            })
            .collect();
        let width = map.width().max(1);
        let (mut higher, mut lower) =
            (Plane::filled(map.size(), 0.0), Plane::filled(map.size(), 0.0));
        let rows =
            higher.values_mut().par_chunks_mut(width).zip(lower.values_mut().par_chunks_mut(width));
        rows.enumerate().for_each_init(
            || (vec![0.0; width], Vec::new()),
            |(row, between), (y, (higher, lower))| {
                for (i, size) in blurred.iter().enumerate() {
                    size.row(y, row, between);
                    let lower = if i < LARGE { None } else { Some(&mut *lower) };
                    add(map.row(y), row, 1.0 / size.sigma_px, higher, lower);
                }
                page.row(y, row, between);
                lower.iter_mut().zip(row).for_each(|(sum, page)| *sum += *page);
            },
        );
        let shares = |plane: Plane<f32>| ShareMap::from_plane(plane.map(|v| v.min(MOST)), MOST);
        Self { higher: shares(higher), lower: shares(lower) }
    }
}

fn add(h: &[f32], blurred: &[f32], per_px: f32, higher: &mut [f32], lower: Option<&mut [f32]>) {
    for ((sum, h), blurred) in higher.iter_mut().zip(h).zip(blurred) {
        *sum += fast::max(blurred - h, 0.0) * per_px;
    }
    for ((sum, h), blurred) in lower.into_iter().flatten().zip(h).zip(blurred) {
        *sum += 0.5 * fast::max(h - blurred, 0.0) * per_px;
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
