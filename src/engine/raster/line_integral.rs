//! Line-integral convolution: noise smeared along a field of directions, so that the eye sees its
//! lines (Cabral and Leedom 1993). Floor 1. Not here: what the directions mean (`surface::flow`).

use super::{Plane, blur};
use crate::math::{Size, Vec2, hash, vec2};

/// How the lines look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineStyle {
    /// Size of the noise's grains, px, `≥ 1`.
    pub grain_px: f32,
    /// Length of a line to either side, px.
    pub reach_px: f32,
}

impl LineStyle {
    /// Grains large enough to be visible at the size of a picture, and lines fifteen grains long.
    pub fn for_size(size: Size) -> Self {
        let grain_px = (size.longer_side() / 1024.0).max(1.0).min(2.5);
        Self { grain_px, reach_px: 15.0 * grain_px }
    }
}

/// Share of the gray range that one standard deviation takes: strong, and few values clipped.
const CONTRAST: f32 = 0.22;

/// Smears noise along `direction`; values in `[0, 1]` around a mean of ½.
///
/// * `direction`: unit vectors, image axes; their signs do not matter; zero where there is none.
/// * `passes`: whether a line may continue from one pixel to another that touches it at a side or a
///   corner.
pub fn smear_noise(
    direction: &Plane<Vec2>,
    lines: LineStyle,
    passes: impl Fn((usize, usize), (usize, usize)) -> bool + Sync,
) -> Plane<f32> {
    let size = direction.size();
    let noise = noise(size, lines.grain_px);
    let window = hann(lines.reach_px);
    let smeared = Plane::from_fn(size, |x, y| {
        let mut sum = NoiseSum::default();
        sum.add(window[0], noise.at(x, y));
        for sign in [1.0, -1.0] {
            trace(direction, (x, y), sign, &window[1..], &passes, |w, (x, y)| {
                sum.add(w, noise.at(x, y))
            });
        }
        sum.of_unit_variance()
    });
    let deviation = rms(&smeared).max(1e-6);
    smeared.map(|v| (0.5 + CONTRAST * v / deviation).max(0.0).min(1.0))
}

/// Follows the line through a pixel in steps of one pixel, one weight a step, until it leaves the
/// field.
fn trace(
    direction: &Plane<Vec2>,
    start: (usize, usize),
    sign: f32,
    weights: &[f32],
    passes: impl Fn((usize, usize), (usize, usize)) -> bool,
    mut visit: impl FnMut(f32, (usize, usize)),
) {
    let mut here = start;
    let mut at = vec2(start.0 as f32, start.1 as f32) + 0.5;
    let mut heading = direction.at(here.0, here.1) * sign;
    for &w in weights {
        let along = direction.at(here.0, here.1);
        // A direction has no sign: the line keeps its heading.
        heading = if along.dot(heading) < 0.0 { -along } else { along };
        if heading == Vec2::ZERO {
            return;
        }
        at += heading;
        let inside = at.x >= 0.0
            && at.y >= 0.0
            && direction.size().rect().contains(at.x as i32, at.y as i32);
        if !inside {
            return;
        }
        let next = (at.x as usize, at.y as usize);
        if next != here && !passes(here, next) {
            return;
        }
        here = next;
        visit(w, here);
    }
}

/// A weighted sum of noise that knows its own variance.
#[derive(Default)]
struct NoiseSum {
    value: f32,
    squares: f32,
}

impl NoiseSum {
    fn add(&mut self, weight: f32, noise: f32) {
        self.value += weight * noise;
        self.squares += weight * weight;
    }

    /// The sum of independent values of unit variance, scaled to unit variance again: short lines
    /// have no more contrast than long ones.
    fn of_unit_variance(&self) -> f32 {
        self.value / self.squares.sqrt()
    }
}

/// White noise of mean 0 and about unit variance, blurred to grains.
fn noise(size: Size, grain_px: f32) -> Plane<f32> {
    let white = Plane::from_fn(size, |x, y| hash::unit(0x4c49_4331, x as u32, y as u32) - 0.5);
    let grains = blur::gaussian(&white, 0.5 * (grain_px - 1.0).max(0.0).min(64.0));
    let deviation = rms(&grains).max(1e-6);
    grains.map(|v| v / deviation)
}

/// Weights at 0, 1, … pixels from the middle of a line, falling smoothly to 0 at its end.
fn hann(reach_px: f32) -> Vec<f32> {
    let n = reach_px.max(1.0).min(1000.0) as usize;
    (0..=n).map(|k| 0.5 + 0.5 * (std::f32::consts::PI * k as f32 / (n + 1) as f32).cos()).collect()
}

/// Root of the mean square, summed in order.
fn rms(plane: &Plane<f32>) -> f32 {
    let sum: f64 = plane.values().iter().map(|&v| f64::from(v) * f64::from(v)).sum();
    (sum / plane.values().len().max(1) as f64).sqrt() as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean_change(plane: &Plane<f32>, dx: usize, dy: usize) -> f32 {
        let (w, h) = (plane.width() - dx, plane.height() - dy);
        let changes = (0..h).flat_map(|y| (0..w).map(move |x| (x, y)));
        changes.map(|(x, y)| (plane.at(x + dx, y + dy) - plane.at(x, y)).abs()).sum::<f32>()
            / (w * h) as f32
    }
    const LINES: LineStyle = LineStyle { grain_px: 1.0, reach_px: 12.0 };

    #[test]
    fn gray_changes_little_along_a_line_and_much_across() {
        let field = Plane::full(Size::new(80, 60), vec2(0.6, 0.8));
        let lines = smear_noise(&field, LINES, |_, _| true);
        assert!(mean_change(&lines, 3, 4) < 0.5 * mean_change(&lines, 4, 3));
    }

    #[test]
    fn the_sign_of_a_direction_does_not_matter() {
        let size = Size::new(40, 40);
        let steady = smear_noise(&Plane::full(size, Vec2::X), LINES, |_, _| true);
        let flipping =
            Plane::from_fn(size, |x, y| if (x + y) % 2 == 0 { Vec2::X } else { -Vec2::X });
        assert!(
            smear_noise(&flipping, LINES, |_, _| true)
                .values()
                .iter()
                .zip(steady.values())
                .all(|(a, b)| (a - b).abs() < 1e-5)
        );
    }

    #[test]
    fn no_line_crosses_what_it_may_not_pass() {
        // What lies right of the wall must not change what lies left of it, up to the common
        // contrast.
        let size = Size::new(40, 20);
        let wall = |(a, _): (usize, usize), (b, _): (usize, usize)| (a < 20) == (b < 20);
        let right = |d: Vec2| Plane::from_fn(size, move |x, _| if x < 20 { Vec2::X } else { d });
        let (a, b) =
            (smear_noise(&right(Vec2::X), LINES, wall), smear_noise(&right(Vec2::Y), LINES, wall));
        let shade = |p: &Plane<f32>, x: usize| (p.at(x, 10) - 0.5) / (p.at(3, 10) - 0.5);
        assert!((0..20).all(|x| (shade(&a, x) - shade(&b, x)).abs() < 1e-3));
    }

    #[test]
    fn the_noise_fills_the_grays_without_clipping_much() {
        let lines = smear_noise(&Plane::full(Size::new(128, 128), Vec2::X), LINES, |_, _| true);
        let clipped = lines.values().iter().filter(|&&v| v <= 0.0 || v >= 1.0).count();
        assert!(clipped < 128 * 128 / 20, "{clipped}");
        assert!(lines.values().iter().any(|&v| v < 0.2) && lines.values().iter().any(|&v| v > 0.8));
    }
}
