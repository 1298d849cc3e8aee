//! Patterns: grays from formulas, for tips and for grain. Floor 3. They are the same bytes every
//! time; none is drawn by hand or shipped as a file.

use crate::math::{Size, Vec2, hash, noise, vec2};
use crate::raster::Plane;
use std::f32::consts::{PI, TAU};

crate::named! {
    /// A pattern that repeats, for grain.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum Pattern {
        /// The tooth of a rough paper: noise of several octaves.
        #[default]
        Paper = "paper",
        /// Threads over and under each other.
        Weave = "weave",
        /// Rows of overlapping scales, each lighter toward its rim.
        Scales = "scales",
        /// Parallel lines, soft across: levels set their width.
        Lines = "lines",
        /// Dots in a square grid: levels set their size.
        Dots = "dots",
    }
}

impl Pattern {
    /// Features along the side of the square that repeats.
    pub const CELLS: u32 = 16;
    /// Side of that square, texels: least and most.
    pub const SIDES: [u32; 2] = [512, 2048];

    /// The side that has a texel for every pixel if features are this large, so that a pattern is
    /// as sharp on a large canvas as on a small one.
    pub fn side_of(feature_px: f32) -> u32 {
        let [least, most] = Self::SIDES;
        // Comparisons that NaN fails.
        let sides = std::iter::successors(Some(least), |side| Some(2 * side));
        sides
            .take_while(|side| *side <= most)
            .find(|side| *side as f32 >= Self::CELLS as f32 * feature_px)
            .unwrap_or(if feature_px > 0.0 { most } else { least })
    }

    /// Grays in `[0, 1]`; opposite sides meet. In paper every gray covers the same area, so that a
    /// level is a share of the area.
    ///
    /// `side`: texels, see [`Pattern::side_of`].
    pub fn plane(self, seed: u32, side: u32) -> Plane<f32> {
        let (cells, texels) = (Self::CELLS as f32, side as f32);
        let side = Size::new(side, side);
        let at = |x: usize, y: usize| (vec2(x as f32, y as f32) + 0.5) / texels;
        let raw = Plane::from_fn(side, |x, y| match self {
            Pattern::Paper => noise::octaves(at(x, y), Self::CELLS, 4, 0.6, seed),
            Pattern::Weave => weave(at(x, y) * cells, seed),
            Pattern::Scales => scales(at(x, y) * cells),
            Pattern::Lines => line(at(x, y) * cells, seed),
            Pattern::Dots => {
                1.0 - ((at(x, y) * cells).fract_gl() - 0.5).length() * std::f32::consts::SQRT_2
            }
        });
        if self == Pattern::Paper { equalize(&raw) } else { raw.map(|v| v.max(0.0).min(1.0)) }
    }
}

/// Threads a cell wide: those along x and along y lie above in turn.
fn weave(p: Vec2, seed: u32) -> f32 {
    let (cell, within) = (p.floor(), p.fract_gl() - 0.5);
    let is_over = (cell.x + cell.y).rem_euclid(2.0) < 1.0;
    let (across, along) = if is_over { (within.y, within.x) } else { (within.x, within.y) };
    // A thread's round back, dipping where it goes under the next; each thread a little different,
    // its fibres fine lines.
    let back = (1.0 - (across / 0.46).powi(2)).max(0.0).sqrt();
    let dip = (PI * along).cos().max(0.0).powf(0.6);
    let thread = if is_over { vec2(0.0, cell.y) } else { vec2(1.0, cell.x) };
    let own = hash::unit(seed, thread.x as u32, thread.y as u32);
    let fibre = 0.5 + 0.5 * (TAU * 4.0 * across + TAU * along).sin();
    back * (0.25 + 0.75 * dip) * (0.78 + 0.14 * own + 0.08 * fibre)
}

/// Rows half a cell high, every other shifted by half a cell: each scale is a disc that covers the
/// ones above it.
fn scales(p: Vec2) -> f32 {
    let row = (p.y * 2.0).floor();
    // The lower rows lie below: of the discs over a point the topmost belongs to the highest row.
    for above in (0..3).rev() {
        let row = row - above as f32;
        let shift = if row.rem_euclid(2.0) < 1.0 { 0.5 } else { 0.0 };
        let center = vec2((p.x - shift).floor() + shift + 0.5, row * 0.5);
        let r = (p - center).length() / 0.56;
        if r < 1.0 && p.y >= center.y {
            // Dark where it emerges from under its neighbor, bright toward the rim, with a thin
            // dark edge.
            let rim = smoothstep(1.0, 0.9, r);
            return rim * (0.25 + 0.75 * smoothstep(0.2, 0.85, r));
        }
    }
    0.0
}

/// A triangle wave across y, its lines wavering a little.
fn line(p: Vec2, seed: u32) -> f32 {
    let sway = noise::gradient(p * vec2(0.25, 0.5), Pattern::CELLS / 4, seed) * 0.12;
    1.0 - (2.0 * (p.y + sway).rem_euclid(1.0) - 1.0).abs()
}

/// From 0 at `from` to 1 at `to`, which may be the lower one.
fn smoothstep(from: f32, to: f32, v: f32) -> f32 {
    let t = ((v - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Each value by its rank: all grays take the same area.
fn equalize(plane: &Plane<f32>) -> Plane<f32> {
    let mut order: Vec<u32> = (0..plane.values().len() as u32).collect();
    order.sort_by(|&a, &b| plane.values()[a as usize].total_cmp(&plane.values()[b as usize]));
    let per_rank = 1.0 / order.len().max(1) as f32;
    let mut out = Plane::full(plane.size(), 0.0);
    for (rank, at) in order.into_iter().enumerate() {
        out.values_mut()[at as usize] = (rank as f32 + 0.5) * per_rank;
    }
    out
}

/// The ends of a brush's hairs, spread over the disc that touches the square's sides: grays in `[0,
/// 1]`.
///
/// * `count`: number of hairs, `≥ 1`.
/// * `side`: of the square, texels.
pub fn bristles(count: u32, seed: u32, side: u32) -> Plane<f32> {
    let size = Size::new(side.max(1), side.max(1));
    let mut plane = Plane::full(size, 0.0);
    let half = 0.5 * size.longer_side();
    let count = count.max(1);
    for i in 0..count {
        let chance = |what: u32| hash::unit(seed, i, what);
        // A sunflower's seeds, each moved a little: even, without rows.
        let r = ((i as f32 + 0.2 + 0.6 * chance(0)) / count as f32).sqrt();
        let (sin, cos) = (i as f32 * GOLDEN_ANGLE + 0.5 * chance(1)).sin_cos();
        let radius = (0.55 + 0.65 * chance(2)) / (count as f32).sqrt();
        // Entirely within the disc.
        let center = vec2(cos, sin) * r * (1.0 - radius).max(0.0);
        hair(&mut plane, center * half + half, radius * half, 0.35 + 0.65 * chance(3));
    }
    plane
}

/// The angle between one seed of a sunflower and the next.
const GOLDEN_ANGLE: f32 = 2.399_963_2;

/// Draws one hair's end over the others: round and soft; the denser one shows.
fn hair(plane: &mut Plane<f32>, center: Vec2, radius: f32, density: f32) {
    let (low, high) = ((center - radius).floor().max(Vec2::ZERO), (center + radius).ceil());
    for y in low.y as usize..(high.y as usize).min(plane.height()) {
        for x in low.x as usize..(high.x as usize).min(plane.width()) {
            let r = (vec2(x as f32, y as f32) + 0.5 - center).length() / radius;
            let value = density * smoothstep(1.0, 0.45, r);
            if value > plane.at(x, y) {
                plane.set(x, y, value);
            }
        }
    }
}

/// Specks that cover a share of a square: grays in `[0, 1]`, mostly 0 and 1.
///
/// * `cells`: specks along a side, `≥ 1`.
/// * `density`: the share covered, `[0, 1]`.
pub fn specks(cells: u32, density: f32, seed: u32, side: u32) -> Plane<f32> {
    let size = Size::new(side.max(1), side.max(1));
    let per_side = 1.0 / size.longer_side();
    let raw = Plane::from_fn(size, |x, y| {
        noise::octaves((vec2(x as f32, y as f32) + 0.5) * per_side, cells.max(1), 3, 0.5, seed)
    });
    let bare = 1.0 - density;
    equalize(&raw).map(|v| smoothstep(bare - 0.08, bare + 0.08, v))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pattern_is_made_of_grays_light_and_dark_and_repeats_without_seams() {
        for (pattern, name) in Pattern::ALL {
            let plane = pattern.plane(3, Pattern::SIDES[0]);
            let (low, high) =
                plane.values().iter().fold((1.0f32, 0.0f32), |(a, b), &v| (a.min(v), b.max(v)));
            assert!(
                (0.0..0.3).contains(&low) && (0.7..=1.0).contains(&high),
                "{name}: {low} to {high}"
            );
            // Neighbors differ as much across the seam as elsewhere.
            let last = Pattern::SIDES[0] as usize - 1;
            let jump = |a: usize, b: usize| {
                (0..=last)
                    .map(|i| {
                        (plane.at(a, i) - plane.at(b, i)).abs()
                            + (plane.at(i, a) - plane.at(i, b)).abs()
                    })
                    .sum()
            };
            let (seam, within): (f32, f32) =
                (jump(0, last), jump(31, 32).max(jump(32, 33)).max(jump(95, 96)));
            assert!(seam <= 1.5 * within + 2.0, "{name}: {seam} at the seam, {within} within");
        }
    }

    #[test]
    fn a_finer_plane_is_the_same_pattern() {
        assert_eq!(
            [2.0, 32.0, 32.1, 100.0, 1e9, f32::NAN, -1.0].map(Pattern::side_of),
            [512, 512, 1024, 2048, 2048, 512, 512]
        );
        for (pattern, name) in Pattern::ALL {
            let (coarse, fine) = (pattern.plane(5, 512), pattern.plane(5, 1024));
            let mean = |x: usize, y: usize| {
                [(0, 0), (1, 0), (0, 1), (1, 1)]
                    .iter()
                    .map(|(i, j)| fine.at(2 * x + i, 2 * y + j))
                    .sum::<f32>()
                    / 4.0
            };
            let apart = (0..512 * 512)
                .map(|i| (coarse.at(i % 512, i / 512) - mean(i % 512, i / 512)).abs());
            let mean = apart.sum::<f32>() / (512.0 * 512.0);
            // Edges within a pattern are not averaged over texels.
            assert!(mean < 0.04, "{name}: {mean}");
        }
    }

    #[test]
    fn every_gray_of_paper_takes_the_same_area() {
        let plane = Pattern::Paper.plane(0, Pattern::SIDES[0]);
        for level in [0.1f32, 0.4, 0.8] {
            let below = plane.values().iter().filter(|v| **v < level).count() as f32
                / plane.values().len() as f32;
            assert!((below - level).abs() < 0.001, "{below} below {level}");
        }
    }

    #[test]
    fn bristles_lie_within_the_disc_and_more_of_them_are_finer() {
        let covered = |count: u32| {
            let plane = bristles(count, 1, 128);
            for y in 0..128 {
                for x in 0..128 {
                    let r = (vec2(x as f32, y as f32) + 0.5 - 64.0).length();
                    assert!(r <= 65.0 || plane.at(x, y) == 0.0, "({x}, {y}) of {count}");
                }
            }
            plane.values().iter().filter(|v| **v > 0.1).count()
        };
        let edges = |count: u32| {
            let plane = bristles(count, 1, 128);
            let rows = (0..128).flat_map(|y| (1..128).map(move |x| (x, y)));
            rows.filter(|&(x, y)| (plane.at(x, y) > 0.2) != (plane.at(x - 1, y) > 0.2)).count()
        };
        assert!(covered(12) > 2000 && covered(80) > 2000);
        assert!(edges(80) > edges(12));
        assert_eq!(bristles(40, 9, 64).values(), bristles(40, 9, 64).values());
    }

    #[test]
    fn specks_cover_their_share() {
        for density in [0.2f32, 0.5, 0.8] {
            let plane = specks(12, density, 4, 128);
            let mean = plane.values().iter().sum::<f32>() / plane.values().len() as f32;
            assert!((mean - density).abs() < 0.02, "{mean} for {density}");
        }
    }
}
