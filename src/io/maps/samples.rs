//! The pixels by which conventions are detected: inside the surface, evenly spread, few enough to
//! be fast. Floor 5.

use crate::math::{Vec2, vec2};
use crate::raster::Plane;
use rayon::prelude::*;

/// The approximate number of pixels that are read.
const ENOUGH: usize = 60_000;

/// Indices of pixels where `inside` holds, evenly thinned.
pub fn spread(inside: &Plane<bool>) -> Vec<usize> {
    pick_evenly(inside.values().len(), ENOUGH, |i| inside.values()[i])
}

/// About `enough` of the numbers below `n` that `is` accepts, evenly thinned. Calls `is` twice for
/// each instead of storing them all.
pub fn pick_evenly(n: usize, enough: usize, is: impl Fn(usize) -> bool + Sync) -> Vec<usize> {
    let count = (0..n).into_par_iter().filter(|&i| is(i)).count();
    (0..n).filter(|&i| is(i)).step_by(count.div_ceil(enough).max(1)).collect()
}

/// Pixels at the rim of the surface with the direction in which it ends there: x right, y **up**,
/// length 1.
///
/// The picture's own border is no rim.
pub fn rim(inside: &Plane<bool>) -> Vec<(usize, Vec2)> {
    let (w, h) = (inside.width(), inside.height());
    let ends_toward = |x: usize, y: usize| {
        let is = |dx: i32, dy: i32| inside.at_clamped(x as i32 + dx, y as i32 + dy);
        let outside = (-2..=2)
            .flat_map(|dy| (-2..=2).map(move |dx| (dx, dy)))
            .filter(|&(dx, dy)| !is(dx, dy));
        let away: Vec2 = outside.map(|(dx, dy)| vec2(dx as f32, -dy as f32)).sum();
        (away.length() > 2.0).then(|| (y * w + x, away.normalize_or_zero()))
    };
    let of_row = |y: usize| {
        let [above, here, below] = [y - 1, y, y + 1].map(|y| inside.row(y));
        let is_rim = move |x: &usize| {
            let x = *x;
            here[x] && !(here[x - 1] && here[x + 1] && above[x] && below[x])
        };
        (2..w.saturating_sub(2))
            .filter(is_rim)
            .filter_map(|x| ends_toward(x, y))
            .collect::<Vec<_>>()
    };
    let out: Vec<(usize, Vec2)> =
        (2..h.saturating_sub(2)).into_par_iter().flat_map_iter(of_row).collect();
    let step = out.len().div_ceil(ENOUGH / 4).max(1);
    out.into_iter().step_by(step).collect()
}

/// Slopes of a depth plane at a pixel: change to the right and **downward** over two pixels,
/// halved. `None` at the edge of the surface and where the two sides disagree as they do at a jump.
pub fn slope(depth: &Plane<f32>, x: usize, y: usize, reach: usize) -> Option<Vec2> {
    let (x, y, r) = (x as i32, y as i32, reach as i32);
    let at = |dx: i32, dy: i32| depth.get(x + dx, y + dy).filter(|v| v.is_finite());
    let here = at(0, 0)?;
    let one = |before: f32, after: f32| {
        let (left, right) = (here - before, after - here);
        let jump =
            (right - left).abs() > 3.0 * left.abs().min(right.abs()) + 1e-4 * (1.0 + here.abs());
        (!jump || (left - right).abs() < 1e-5).then_some((left + right) * 0.5 / reach as f32)
    };
    Some(vec2(one(at(-r, 0)?, at(r, 0)?)?, one(at(0, -r)?, at(0, r)?)?))
}
