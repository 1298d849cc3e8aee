//! The pixels by which conventions are detected: inside the surface, evenly spread, few enough to be fast.
//! Floor 5.

use crate::math::{Vec2, vec2};
use crate::raster::Plane;

/// The approximate number of pixels that are read.
const ENOUGH: usize = 60_000;

/// Indices of pixels where `inside` holds, evenly thinned.
pub fn spread(inside: &Plane<bool>) -> Vec<usize> {
    thinned(inside.values().len(), ENOUGH, |i| inside.values()[i])
}

/// Of the numbers below `n` that `is` accepts about `enough`, evenly thinned. Asks twice, rather than hold them all.
pub fn thinned(n: usize, enough: usize, is: impl Fn(usize) -> bool) -> Vec<usize> {
    let count = (0..n).filter(|&i| is(i)).count();
    (0..n).filter(|&i| is(i)).step_by(count.div_ceil(enough).max(1)).collect()
}

/// Pixels at the rim of the surface with the direction in which it ends there: x right, y **up**, length 1.
///
/// The picture's own border is no rim.
pub fn rim(inside: &Plane<bool>) -> Vec<(usize, Vec2)> {
    let (w, h) = (inside.width(), inside.height());
    let mut out = Vec::new();
    for y in 2..h.saturating_sub(2) {
        for x in 2..w.saturating_sub(2) {
            let is = |dx: i32, dy: i32| inside.clamped(x as i32 + dx, y as i32 + dy);
            if !is(0, 0) || (is(-1, 0) && is(1, 0) && is(0, -1) && is(0, 1)) {
                continue;
            }
            let mut away = vec2(0.0, 0.0);
            for dy in -2..=2 {
                for dx in -2..=2 {
                    if !is(dx, dy) {
                        away += vec2(dx as f32, -dy as f32);
                    }
                }
            }
            if away.length() > 2.0 {
                out.push((y * w + x, away.normalize_or_zero()));
            }
        }
    }
    let step = out.len().div_ceil(ENOUGH / 4).max(1);
    out.into_iter().step_by(step).collect()
}

/// Slopes of a depth plane at a pixel: change to the right and **downward** over two pixels, halved. `None` at the edge
/// of the surface and where the two sides disagree as they do at a jump.
pub fn slope(depth: &Plane<f32>, x: usize, y: usize, reach: usize) -> Option<Vec2> {
    let (x, y, r) = (x as i32, y as i32, reach as i32);
    let at = |dx: i32, dy: i32| depth.get(x + dx, y + dy).filter(|v| v.is_finite());
    let here = at(0, 0)?;
    let one = |before: f32, after: f32| {
        let (left, right) = (here - before, after - here);
        let jump = (right - left).abs() > 3.0 * left.abs().min(right.abs()) + 1e-4 * (1.0 + here.abs());
        (!jump || (left - right).abs() < 1e-5).then_some((left + right) * 0.5 / reach as f32)
    };
    Some(vec2(one(at(-r, 0)?, at(r, 0)?)?, one(at(0, -r)?, at(0, r)?)?))
}
