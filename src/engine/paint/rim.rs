//! The rim of a stroke: the share of a pixel that its dabs may reach. Floor 3. Pure functions. Not
//! here: a dab's own profile (`profile`), how shares add up (`stroke_tile`).
//!
//! Dabs follow each other closely and their rims fall on the same pixels. If each covered a share
//! of such a pixel at random, a dozen of them would fill it, and lines would be wider by most of a
//! pixel on either side: much in a thin line, half as much in the same line drawn twice as large.
//! But what one dab leaves bare, the next one leaves bare too. So a pixel on the rim has two parts:
//! one that the stroke's dabs reach, and one that none reaches.
//!
//! The edge between them follows from how dabs add up along a straight stroke: at the depth x
//! inside the outer rim coverage reaches 1 − ∏ (1 − f P(r_i)). It counts as an edge as far as that
//! rises within less than a pixel.

use super::brush::{Brush, Tip};
use super::brush_options::Falloff;
use super::dynamics::Property;
use super::profile::RoundProfile;
use crate::memory::compute_once;
use std::sync::{Arc, Mutex};

/// Where a stroke of such dabs ends, in radii of the dab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rim {
    /// Distance from the dab's center at which the stroke's coverage has risen halfway.
    pub edge: f32,
    /// The width over which it rises.
    pub width: f32,
}

impl Rim {
    /// No edge: dabs reach whole pixels.
    pub const SOFT: Rim = Rim { edge: 1.0, width: f32::INFINITY };
    /// An edge counts fully up to a fifth of a pixel's width, and not at all from 1.2 on. This
    /// blend leaves the least error (15 of 255 at most over tips of 2 to 64 px, 5 in the mean;
    /// without shares 170 and 99).
    const SHARP: f32 = 1.2;

    /// The share of a pixel that the stroke may reach, in `[0, 1]`. `r`: distance from the center,
    /// `width`: the pixel's along the radius; in radii.
    #[inline(always)]
    pub fn share(self, r: f32, width: f32) -> f32 {
        let unit = |v: f32| {
            let v = if v > 0.0 { v } else { 0.0 };
            if v < 1.0 { v } else { 1.0 }
        };
        let sharp = unit(Self::SHARP - self.width / width);
        1.0 - sharp * (1.0 - unit((self.edge - r) / width + 0.5))
    }

    /// Nothing within this distance is on an edge, for pixels no wider than `width` radii.
    #[inline(always)]
    pub fn inner(self, width: f32) -> f32 {
        if self.width < Self::SHARP * width { self.edge } else { f32::INFINITY }
    }

    /// For pixels narrower than this, in radii, the share is 1 everywhere.
    pub fn soft_below(self) -> f32 {
        self.width / Self::SHARP
    }

    fn between(self, to: Rim, s: f32) -> Rim {
        // Never a mean with an infinite width: that is no edge.
        Rim {
            edge: self.edge + (to.edge - self.edge) * s,
            width: self.width + (to.width - self.width) * s,
        }
    }
}

/// Rims by the flow of dabs, at even steps from 0 to 1.
pub struct RimTable([Rim; STEPS + 1]);

const STEPS: usize = 10;
/// Depths at which coverage is computed, denser toward the rim, and positions along a stroke that
/// are added up.
const DEPTHS: usize = 40;
const PLACES: usize = 12;
/// Ratios of the coverage in the middle of the stroke that count as begun, halfway and done.
const RISEN: [f32; 3] = [0.2, 0.5, 0.8];

/// Cached rims: more than a painting uses.
const KEPT: usize = 64;
static MADE: Mutex<Vec<([u32; 4], Arc<RimTable>)>> = Mutex::new(Vec::new());

impl RimTable {
    /// `None` if the dabs of a stroke do not end along one line: scattered dabs, pictures, profiles
    /// of other programs (which then paint as they do there), and dabs that work on paint one by
    /// one.
    pub fn of(brush: &Brush) -> Option<Arc<Self>> {
        let is_square = match brush.tip {
            Tip::Round | Tip::Ellipse { .. } | Tip::Bristles(_) | Tip::Noise(_) => false,
            Tip::Square { .. } => true,
            Tip::Picture(_) | Tip::Hose(_) => return None,
        };
        let strays = [brush.scatter, brush.size_jitter, brush.offset.amount, brush.stylus.tremor];
        let driven = [
            Property::Hardness,
            Property::Softness,
            Property::Scatter,
            Property::SizeJitter,
            Property::Offset,
        ];
        let ends_elsewhere =
            strays.iter().any(|&v| v != 0.0) || driven.iter().any(|&p| brush.dynamics.is_driven(p));
        if ends_elsewhere || brush.falloff != Falloff::Smooth || brush.is_wet() {
            return None;
        }
        let unit = |v: f32| v.max(0.0).min(1.0);
        // Comparisons that NaN fails.
        let step = (2.0 * brush.spacing).max(0.02).min(4.0);
        let (hardness, softness) = (unit(brush.hardness), unit(brush.softness));
        let key = [u32::from(is_square), hardness.to_bits(), softness.to_bits(), step.to_bits()];
        Some(compute_once(&MADE, KEPT, key, || {
            Self::integrate(is_square, RoundProfile::new(hardness, softness), step)
        }))
    }

    /// `step`: between dabs, radii.
    fn integrate(is_square: bool, profile: RoundProfile, step: f32) -> Self {
        let outer = profile.outer_radius();
        let coverage = |r: f32| profile.mean(r, 0.0).max(0.0).min(0.9999);
        let depth = |j: usize| outer * (j as f32 / (DEPTHS - 1) as f32).powi(3);
        // The dabs that cover a point at this depth: their coverage there, and their number.
        let over = |j: usize| {
            let across = outer - depth(j);
            let along =
                if is_square { outer } else { (outer * outer - across * across).max(0.0).sqrt() };
            let at = |i: usize| {
                let t = along * (i as f32 + 0.5) / PLACES as f32;
                if is_square { coverage(across) * coverage(t) } else { coverage(across.hypot(t)) }
            };
            (
                std::array::from_fn::<f32, PLACES, _>(at),
                coverage(across),
                2.0 * along / (step * PLACES as f32),
            )
        };
        let over: Vec<_> = (0..DEPTHS).map(over).collect();
        let of_flow = |flow: f32| {
            let left = |p: f32| -(1.0 - flow * p).ln();
            // At least the one dab next to the point.
            let sum = |(at, beside, dabs): &([f32; PLACES], f32, f32)| {
                (dabs * at.iter().map(|&p| left(p)).sum::<f32>()).max(left(*beside))
            };
            let risen: Vec<f32> = over.iter().map(|over| 1.0 - (-sum(over)).exp()).collect();
            let top = risen.last().copied().unwrap_or(0.0);
            let [begun, half, done] = RISEN.map(|share| {
                let j = risen.iter().position(|&v| v >= share * top).unwrap_or(DEPTHS - 1).max(1);
                let (low, high) = (risen[j - 1], risen[j]);
                let s = if high > low {
                    ((share * top - low) / (high - low)).max(0.0).min(1.0)
                } else {
                    1.0
                };
                depth(j - 1) + (depth(j) - depth(j - 1)) * s
            });
            Rim { edge: outer - half, width: (done - begun).max(0.0) }
        };
        Self(std::array::from_fn(|i| of_flow((i as f32 / STEPS as f32).max(0.02))))
    }

    /// The rim of dabs of this flow, in `[0, 1]`.
    pub fn at(&self, flow: f32) -> Rim {
        let place = flow.max(0.0).min(1.0) * STEPS as f32;
        let below = (place as usize).min(STEPS - 1);
        self.0[below].between(self.0[below + 1], place - below as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The true coverage of a pixel of a straight stroke along x, and the one computed with shares;
    /// 255 is full.
    fn pixel(brush: &Brush, y: f32) -> (f32, f32) {
        let (radius, step) = (0.5 * brush.size, (brush.spacing * brush.size).max(0.1));
        let profile = RoundProfile::new(brush.hardness, brush.softness);
        let rim = RimTable::of(brush).unwrap().at(brush.flow);
        let dabs =
            || (0..).map(|i| -radius - 2.0 + step * i as f32).take_while(|x| *x < radius + 2.0);
        const SIDE: usize = 16;
        let place = |i: usize| (i as f32 + 0.5) / SIDE as f32 - 0.5;
        let point = |(dx, dy): (f32, f32)| {
            let left = |x: f32| {
                1.0 - brush.flow
                    * profile.mean((x - dx).hypot(y + dy) / radius, 0.0).max(0.0).min(1.0)
            };
            1.0 - dabs().map(left).product::<f32>()
        };
        let points = (0..SIDE * SIDE).map(|i| point((place(i % SIDE), place(i / SIDE))));
        let truth = points.sum::<f32>() / (SIDE * SIDE) as f32;
        let (mut a, mut reach) = (0.0, 0.0f32);
        for x in dabs() {
            let r = x.hypot(y) / radius;
            let (mean, share) =
                (profile.mean(r, 1.0 / (radius * radius)), rim.share(r, 1.0 / radius));
            crate::paint::stroke_tile::raise(
                &mut a,
                &mut reach,
                brush.flow * mean.min(share).max(0.0),
                share,
                1.0,
            );
        }
        (255.0 * truth, 255.0 * a)
    }

    #[test]
    fn a_line_ends_where_many_samples_say() {
        let brush = |size: f32, hardness: f32, flow: f32, spacing: f32| Brush {
            size,
            hardness,
            flow,
            spacing,
            ..Brush::default()
        };
        let (mut sum, mut n) = (0.0, 0);
        for brush in [
            brush(3.0, 0.95, 1.0, 0.04),
            brush(12.0, 0.85, 1.0, 0.04),
            brush(40.0, 0.95, 0.8, 0.05),
            brush(26.0, 0.9, 1.0, 0.025),
            brush(5.0, 0.6, 0.35, 0.12),
            brush(38.0, 0.85, 0.5, 0.08),
            brush(44.0, 0.7, 0.3, 0.06),
            brush(64.0, 0.97, 1.0, 0.08),
            brush(40.0, 0.95, 0.1, 0.05),
            brush(20.0, 0.0, 1.0, 0.1),
        ] {
            for i in 0..160 {
                let (truth, found) = pixel(&brush, brush.size * 0.5 - 2.0 + 0.025 * i as f32);
                assert!(
                    (truth - found).abs() < 18.0,
                    "{} px at {i}: {found}, not {truth}",
                    brush.size
                );
                if truth > 0.5 && truth < 254.5 {
                    (sum, n) = (sum + (truth - found).abs(), n + 1);
                }
            }
        }
        assert!(sum / (n as f32) < 4.0, "mean {}", sum / n as f32);
    }

    #[test]
    fn soft_and_faint_dabs_reach_whole_pixels() {
        for (hardness, flow) in [(0.0, 1.0), (0.5, 0.5), (0.95, 0.1)] {
            let brush = Brush { size: 40.0, hardness, flow, ..Brush::default() };
            let rim = RimTable::of(&brush).unwrap().at(flow);
            assert!(
                (0..60).all(|i| rim.share(i as f32 * 0.02, 0.05) == 1.0),
                "{hardness} {flow}: {rim:?}"
            );
        }
        assert_eq!((Rim::SOFT.share(0.99, 0.1), Rim::SOFT.share(f32::NAN, 0.0)), (1.0, 1.0));
    }

    #[test]
    fn what_strays_or_comes_from_elsewhere_has_no_edge() {
        let plain = Brush::default();
        assert!(RimTable::of(&plain).is_some());
        let wet = crate::paint::BrushMode::Smudge { length: 0.5 };
        for brush in [
            Brush { scatter: 0.5, ..plain.clone() },
            Brush { falloff: Falloff::Peaked, ..plain.clone() },
            Brush { mode: wet, ..plain.clone() },
        ] {
            assert!(RimTable::of(&brush).is_none());
        }
        let bad = Brush { hardness: f32::NAN, spacing: f32::NAN, flow: f32::NAN, ..plain };
        let rim = RimTable::of(&bad).unwrap().at(f32::NAN);
        assert!(rim.edge.is_finite() && rim.width >= 0.0);
    }
}
