//! Drawn bodies: sweeps (balls along a pen's stroke, joined by round cones) and lathes (an outline
//! turned about an axis). Both give squared heights, of which `form` makes forms. Floor 3.

use super::Outline;
use crate::math::{Range, Size, Vec2, vec2};
use crate::raster::Plane;

/// A ball of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Canvas px.
    pub at: Vec2,
    /// px.
    pub radius: f32,
}

impl Ball {
    /// What a radius may be, px.
    pub const RADIUS: Range = 0.0..=4096.0;
    /// The most balls of one sweep.
    pub const MOST: usize = 4096;
}

/// The ball between two that reaches highest above a point: its place and radius.
///
/// g(t) = (r₀ + t Δr)² − |p − a − t e|² is greatest at t = (r₀ Δr + e·(p − a)) / (|e|² − Δr²):
/// round cones in closed form. If one ball contains the other, the larger ball.
pub fn highest_between(a: Ball, b: Ball, p: Vec2) -> Ball {
    let (e, dr) = (b.at - a.at, b.radius - a.radius);
    let bend = e.length_squared() - dr * dr;
    if bend <= 1e-6 {
        return if a.radius >= b.radius { a } else { b };
    }
    let t = ((a.radius * dr + e.dot(p - a.at)) / bend).max(0.0).min(1.0);
    Ball { at: a.at + t * e, radius: a.radius + t * dr }
}

/// The outline and squared height (px²) of balls along a line; `None` if there is nothing to see, a
/// number is not finite or the rectangle has more than `most_px` pixels.
pub fn sweep(balls: &[Ball], most_px: usize) -> Option<(Outline, Plane<f32>)> {
    let is_finite =
        |b: &Ball| b.at.is_finite() && b.at.abs().max_element() < 1e6 && b.radius.is_finite();
    if balls.is_empty() || !balls.iter().all(is_finite) {
        return None;
    }
    let low = balls.iter().fold(Vec2::MAX, |m, b| m.min(b.at - b.radius)).floor() - 1.0;
    let high = balls.iter().fold(Vec2::MIN, |m, b| m.max(b.at + b.radius)).ceil() + 1.0;
    let size = high - low;
    if f64::from(size.x) * f64::from(size.y) > most_px as f64 {
        return None;
    }
    let size = Size::new(size.x as u32, size.y as u32);
    let mut square = Plane::full(size, 0.0f32);
    let mut depth = Plane::full(size, f32::NEG_INFINITY);
    for (i, a) in balls.iter().enumerate() {
        let b = balls.get(i + 1).unwrap_or(a);
        if i > 0 && i + 1 == balls.len() {
            break;
        }
        // Only pixels that the two can reach are visited.
        let reach = a.radius.max(b.radius) + 1.0;
        let (from, to) = (a.at.min(b.at) - reach - low, a.at.max(b.at) + reach - low);
        for y in from.y.max(0.0) as usize..(to.y.ceil() as usize).min(size.height as usize) {
            for x in from.x.max(0.0) as usize..(to.x.ceil() as usize).min(size.width as usize) {
                let p = low + vec2(x as f32 + 0.5, y as f32 + 0.5);
                let ball = highest_between(*a, *b, p);
                let away = p.distance(ball.at);
                square.set(x, y, square.at(x, y).max(ball.radius * ball.radius - away * away));
                depth.set(x, y, depth.at(x, y).max(ball.radius - away));
            }
        }
    }
    let coverage = depth.map(|d| ((d + 0.5).max(0.0).min(1.0) * 255.0).round() as u8);
    let outline = Outline::new((low.x as i32, low.y as i32), &coverage)?;
    let shift = (outline.corner().0 - low.x as i32, outline.corner().1 - low.y as i32);
    let square = Plane::from_fn(outline.size(), |x, y| {
        square.get(x as i32 + shift.0, y as i32 + shift.1).unwrap_or(0.0)
    });
    Some((outline, square))
}

/// The squared height (px²) of an outline turned about an axis: z² = r(s)² − (d − c(s))², s along
/// the axis, r half of the outline's width there and c its middle.
///
/// `axis`: two points, canvas px; without one it is upright. Across each place of the axis, all
/// between the first and the last place inside counts.
pub fn turn_outline(outline: &Outline, axis: Option<[Vec2; 2]>) -> Plane<f32> {
    let size = outline.size();
    let corner = vec2(outline.corner().0 as f32, outline.corner().1 as f32);
    let extent = vec2(size.width as f32, size.height as f32);
    let upright = [vec2(extent.x * 0.5, 0.0), vec2(extent.x * 0.5, 1.0)];
    let [from, to] = axis.map_or(upright, |axis| axis.map(|p| p - corner));
    let along = (to - from).try_normalize().unwrap_or(Vec2::Y);
    let across = vec2(-along.y, along.x);
    let far = extent.length().ceil();
    let ends = [Vec2::ZERO, vec2(extent.x, 0.0), vec2(0.0, extent.y), extent]
        .map(|p| (p - from).dot(along));
    let first = ends.iter().copied().fold(f32::MAX, f32::min).floor();
    let count = (2.0 * far) as usize + 2;
    // The outline's two sides at every pixel along the axis.
    let sides: Vec<Option<(f32, f32)>> = (0..count)
        .map(|i| {
            let middle = from + (first + i as f32) * along;
            let shift = (extent * 0.5 - middle).dot(across);
            span_across(outline, middle, across, shift - far, shift + far)
        })
        .collect();
    let sides = smooth_sides(&sides);
    let inside = outline.inside_pixels();
    Plane::from_fn(size, |x, y| {
        if !inside.at(x, y) {
            return 0.0;
        }
        let p = vec2(x as f32 + 0.5, y as f32 + 0.5) - from;
        let (s, d) = (p.dot(along) - first, p.dot(across));
        let i = s.floor().max(0.0) as usize;
        let at = |i: usize| sides.get(i).copied().flatten();
        let (low, high) = match (at(i), at(i + 1)) {
            (Some(a), Some(b)) => {
                let t = s - i as f32;
                (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t)
            }
            (Some(a), None) | (None, Some(a)) => a,
            (None, None) => return 0.0,
        };
        let (radius, middle) = (0.5 * (high - low), 0.5 * (high + low));
        (radius * radius - (d - middle) * (d - middle)).max(0.0)
    })
}

/// How far along the axis sides are compared, px either way, and how far off a side read from
/// coverage may be: larger differences are drawn on purpose.
const SMOOTH_PX: usize = 5;
const READ_WITHIN_PX: f32 = 0.4;

/// Sides without their reading error of a tenth of a pixel, which would show as ripples in the
/// light: each is replaced by the value of the parabola nearest to those around it. Drawn steps are
/// kept.
fn smooth_sides(sides: &[Option<(f32, f32)>]) -> Vec<Option<(f32, f32)>> {
    let smooth = |i: usize| {
        let own = sides[i]?;
        let is_there = |i: &usize| sides.get(*i).is_some_and(Option::is_some);
        // As many on both sides, and fewer near the ends, where sides turn inward.
        let reach = (1..=2 * SMOOTH_PX)
            .take_while(|k| i.checked_sub(*k).is_some_and(|i| is_there(&i)) && is_there(&(i + k)));
        let reach = reach.count() / 2;
        let side = |of: fn((f32, f32)) -> f32| {
            let at = |i: usize| sides[i].map_or(0.0, of);
            let to = parabola(reach, |k| at(i.saturating_add_signed(k)));
            if (to - of(own)).abs() <= READ_WITHIN_PX { to } else { of(own) }
        };
        Some((side(|s| s.0), side(|s| s.1)))
    };
    (0..sides.len()).map(smooth).collect()
}

/// The middle value of the parabola that is nearest to the values from `-reach` to `reach`, by
/// least squares (Savitzky and Golay 1964).
fn parabola(reach: usize, value: impl Fn(isize) -> f32) -> f32 {
    if reach < 2 {
        return value(0);
    }
    let m = reach as f32;
    let whole = (2.0 * m + 3.0) * (2.0 * m + 1.0) * (2.0 * m - 1.0);
    let weight = |k: f32| 3.0 * (3.0 * m * m + 3.0 * m - 1.0 - 5.0 * k * k) / whole;
    let reach = reach as isize;
    (-reach..=reach).map(|k| weight(k as f32) * value(k)).sum()
}

/// The first and the last place along a line that are inside, to a fraction of a pixel.
fn span_across(
    outline: &Outline,
    from: Vec2,
    way: Vec2,
    low: f32,
    high: f32,
) -> Option<(f32, f32)> {
    const STEP: f32 = 0.5;
    let at = |d: f32| outline.sample(from + d * way) - 0.5;
    let steps = ((high - low) / STEP) as usize;
    let place = |i: usize| low + i as f32 * STEP;
    let first = (0..steps).find(|i| at(place(*i)) >= 0.0)?;
    let last = (0..steps).rev().find(|i| at(place(*i)) >= 0.0)?;
    let cross = |out: f32, inner: f32| {
        let (a, b) = (at(out), at(inner));
        if b > a { out + (inner - out) * (-a / (b - a)) } else { inner }
    };
    Some((cross(place(first) - STEP, place(first)), cross(place(last) + STEP, place(last))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::path::ellipse;

    #[test]
    fn a_sweep_is_as_high_as_the_highest_of_all_balls_between() {
        let (a, b) = (
            Ball { at: vec2(20.0, 30.0), radius: 12.0 },
            Ball { at: vec2(60.0, 40.0), radius: 5.0 },
        );
        for i in 0..200 {
            let p = vec2(5.0 + (i % 20) as f32 * 3.5, 15.0 + (i / 20) as f32 * 4.0);
            let height = |ball: Ball| ball.radius.powi(2) - p.distance_squared(ball.at);
            let best = (0..=2000).map(|k| {
                let t = k as f32 / 2000.0;
                height(Ball { at: a.at.lerp(b.at, t), radius: 12.0 - 7.0 * t })
            });
            let best = best.fold(f32::MIN, f32::max);
            let found = height(highest_between(a, b, p));
            assert!((found - best).abs() < 1e-2, "{found} and not {best} at {p}");
        }
        let (outline, square) = sweep(&[a, b], 1 << 16).unwrap();
        assert!((square.values().iter().fold(0.0f32, |m, v| m.max(*v)).sqrt() - 12.0).abs() < 0.05);
        assert_eq!(outline.size(), square.size());
        assert!(sweep(&[], 10).is_none());
        assert!(sweep(&[Ball { at: vec2(f32::NAN, 0.0), radius: 3.0 }], 1000).is_none());
        assert!(sweep(&[Ball { at: Vec2::ZERO, radius: 3000.0 }], 1000).is_none());
    }

    #[test]
    fn a_turned_vase_has_no_ripples() {
        let radius = |s: f32| 60.0 + 22.0 * (s / 37.0).sin();
        let side = |sign: f32| (0..=2400).map(move |i| (sign, 20.0 + 0.1 * i as f32));
        let at = |(sign, s): (f32, f32)| vec2(120.3 + sign * radius(s), s);
        let way: Vec<Vec2> = side(1.0)
            .map(at)
            .chain(side(-1.0).collect::<Vec<_>>().into_iter().rev().map(at))
            .collect();
        let outline = Outline::of_path(&way, 1 << 20).unwrap();
        let square = turn_outline(&outline, Some([vec2(120.3, 0.0), vec2(120.3, 1.0)]));
        let (left, top) = outline.corner();
        let height = |s: usize| square.at((120 - left) as usize, (s as i32 - top) as usize).sqrt();
        let (mut sum, mut most) = (0.0f32, 0.0f32);
        for s in 30..250 {
            let slope = 0.5 * (height(s + 1) - height(s - 1));
            let wanted = 22.0 / 37.0 * ((s as f32 + 0.5) / 37.0).cos();
            assert!((height(s) - radius(s as f32 + 0.5)).abs() < 0.15, "{} at {s}", height(s));
            (sum, most) = (sum + (slope - wanted).abs(), most.max((slope - wanted).abs()));
        }
        assert!(
            sum / 220.0 < 0.01 && most < 0.05,
            "slopes are off by {} in the mean, {most} at most",
            sum / 220.0
        );
    }

    #[test]
    fn a_step_that_is_drawn_stays() {
        let sides: Vec<Option<(f32, f32)>> =
            (0..60).map(|i| Some(if i < 30 { (-40.0, 40.0) } else { (-30.0, 30.0) })).collect();
        let smooth = smooth_sides(&sides);
        for (i, (was, now)) in sides.iter().zip(&smooth).enumerate() {
            let (was, now) = (was.unwrap(), now.unwrap());
            assert!(
                (was.0 - now.0).abs() <= READ_WITHIN_PX && (was.1 - now.1).abs() <= READ_WITHIN_PX,
                "{i}: {now:?}"
            );
        }
    }

    #[test]
    fn an_ellipse_turned_about_its_long_axis_is_an_ellipsoid() {
        let (a, b, turn) = (70.0f32, 30.0f32, 0.4f32);
        let center = vec2(80.4, 70.2);
        let outline = Outline::of_path(&ellipse(center, vec2(a, b), turn, 4000), 1 << 20).unwrap();
        let along = Vec2::from_angle(turn);
        let square = turn_outline(&outline, Some([center, center + along]));
        let corner = vec2(outline.corner().0 as f32, outline.corner().1 as f32);
        for (x, y) in (0..square.height()).flat_map(|y| (0..square.width()).map(move |x| (x, y))) {
            let from = corner + vec2(x as f32 + 0.5, y as f32 + 0.5) - center;
            let (s, d) = (from.dot(along), from.dot(vec2(-along.y, along.x)));
            let truth = b * b * (1.0 - (s / a).powi(2)) - d * d;
            if truth > 0.1 * b * b {
                let found = square.at(x, y).sqrt();
                assert!((found - truth.sqrt()).abs() < 0.4, "{found} and not {}", truth.sqrt());
            }
        }
    }
}
