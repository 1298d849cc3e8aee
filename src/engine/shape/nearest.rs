//! The distance of each pixel inside from the sub-pixel rim, and the direction inward. Floor 3.
//! Lower envelopes of parabolas (Felzenszwalb and Huttenlocher 2012), which `tube` uses as well.

use super::Outline;
use crate::math::{Size, Vec2, parallel, vec2};
use crate::raster::Plane;

/// Distances from the rim of an outline.
pub struct RimDistance {
    /// px, 0 outside.
    pub distance: Plane<f32>,
    /// The direction from the nearest place of the rim, unit; 0 outside.
    pub inward: Plane<Vec2>,
}

impl RimDistance {
    /// Exact to where the rim crosses the links between pixels, and near it to the line between
    /// those crossings.
    pub fn of(outline: &Outline) -> Self {
        let both = measure(outline, None, |distance, inward| (distance, inward));
        Self { distance: both.map(|v| v.0), inward: both.map(|v| v.1) }
    }
}

/// The distance as in [`RimDistance::of`], from the rim that is not toward pixels of `joined` (as
/// in `OutlineRim::with_joined_pixels`). If there is no such rim, no pixel is farther from it than
/// the plane is long.
pub fn silhouette_distance(outline: &Outline, joined: Option<&Plane<bool>>) -> Plane<f32> {
    measure(outline, joined, |distance, _| distance)
}

/// What is made of each pixel's distance and direction.
fn measure<T: Copy + Default + Send + Sync>(
    outline: &Outline,
    joined: Option<&Plane<bool>>,
    of: impl Fn(f32, Vec2) -> T + Sync,
) -> Plane<T> {
    let inside = outline.inside_pixels();
    let joined = joined.filter(|joined| joined.size() == outline.size());
    let crossings = |swapped: bool| nearest_crossings(outline, joined, swapped);
    let (upright, across) = rayon::join(|| crossings(false), || crossings(true));
    let farthest = outline.size().longer_side();
    Plane::from_fn(outline.size(), |x, y| {
        if !inside.at(x, y) {
            return of(0.0, Vec2::ZERO);
        }
        let here = vec2(x as f32, y as f32);
        let (a, b) = (upright.at(x, y), across.at(y, x));
        let b = vec2(b.y, b.x);
        let nearer = if here.distance_squared(b) < here.distance_squared(a) { b } else { a };
        let (distance, way) = distance_from_crossing(outline, here, nearer);
        if distance <= farthest { of(distance, way) } else { of(farthest, Vec2::ZERO) }
    })
}

/// Beyond this distance the line between crossings is no nearer than they are, to a fiftieth of a
/// pixel.
const FAR_PX: f32 = 8.0;

/// Distance and direction from a crossing of the rim, or from the straight rim through it if its
/// foot is near.
fn distance_from_crossing(outline: &Outline, here: Vec2, crossing: Vec2) -> (f32, Vec2) {
    let from = here - crossing;
    let plain = from.length();
    if plain < FAR_PX {
        let pixel = crossing.round();
        let corners = [pixel, crossing.floor(), crossing.ceil()];
        let line = corners
            .iter()
            .find_map(|p| outline.rim_line(p.x.max(0.0) as usize, p.y.max(0.0) as usize));
        if let Some(line) = line {
            let straight = -from.dot(line.outward);
            let beside = (from + straight * line.outward).length();
            if straight > 0.0 && beside < 0.75 {
                return (straight, -line.outward);
            }
        }
    }
    (plain, from.try_normalize().unwrap_or(Vec2::ZERO))
}

/// For each pixel the nearest crossing of the rim with a link up or down (`swapped`: left or right;
/// then the plane is the outline's mirrored at its diagonal). Points in px from the center of the
/// first pixel; far away where there is none.
fn nearest_crossings(
    outline: &Outline,
    joined: Option<&Plane<bool>>,
    swapped: bool,
) -> Plane<Vec2> {
    let size = outline.size();
    let size = if swapped { Size::new(size.height, size.width) } else { size };
    let (w, h) = (size.width as usize, size.height as usize);
    let inside = |x: usize, y: usize| {
        if swapped { outline.inside_pixels().at(y, x) } else { outline.inside_pixels().at(x, y) }
    };
    let is_free = |x: usize, y: usize| {
        joined.is_some_and(|joined| if swapped { joined.at(y, x) } else { joined.at(x, y) })
    };
    // Where the rim crosses the link from a pixel to the one beneath it.
    let crossing = |x: usize, y: usize| -> Option<f32> {
        let (a, b) = (inside(x, y), inside(x, y + 1));
        let theta = |y: usize, down: i32| {
            let (at, step) = if swapped { ((y, x), (down, 0)) } else { ((x, y), (0, down)) };
            outline.crossing(at, step)
        };
        match (a, b) {
            (true, false) if !is_free(x, y + 1) => Some(y as f32 + theta(y, 1)),
            (false, true) if !is_free(x, y) => Some((y + 1) as f32 - theta(y + 1, -1)),
            _ => None,
        }
    };
    const NOWHERE: f32 = -1e9;
    let mut column = Plane::full(size, NOWHERE);
    let mut last = vec![NOWHERE; w];
    for y in 0..h {
        for (x, last) in last.iter_mut().enumerate() {
            if y > 0
                && let Some(c) = crossing(x, y - 1)
            {
                *last = c;
            }
            column.set(x, y, *last);
        }
    }
    last.fill(NOWHERE);
    for y in (0..h).rev() {
        for (x, last) in last.iter_mut().enumerate() {
            if y + 1 < h
                && let Some(c) = crossing(x, y)
            {
                *last = c;
            }
            if (*last - y as f32).abs() < (column.at(x, y) - y as f32).abs() {
                column.set(x, y, *last);
            }
        }
    }
    let mut out = Plane::full(size, Vec2::splat(NOWHERE));
    parallel::for_each_row(out.values_mut(), w, 1, |y, row| {
        let beside = column.row(y);
        let cost: Vec<f64> = beside
            .iter()
            .map(|c| if *c == NOWHERE { f64::INFINITY } else { f64::from(*c - y as f32).powi(2) })
            .collect();
        lower_envelope(&cost, |q, v| row[q] = vec2(v as f32, beside[v]));
    });
    out
}

/// For each place q of a line the v with the least (q − v)² + f(v), passed to `found`; not called
/// where all f are infinite.
///
/// Felzenszwalb and Huttenlocher 2012: parabolas of the same shape cross once, so those that are
/// ever lowest are in order.
pub fn lower_envelope(f: &[f64], mut found: impl FnMut(usize, usize)) {
    let (mut lowest, mut from): (Vec<usize>, Vec<f64>) = (Vec::new(), Vec::new());
    for q in (0..f.len()).filter(|q| f[*q].is_finite()) {
        let key = |v: usize| f[v] + (v * v) as f64;
        let mut start = f64::NEG_INFINITY;
        while let (Some(&v), Some(&begun)) = (lowest.last(), from.last()) {
            start = (key(q) - key(v)) / (2.0 * (q - v) as f64);
            if start > begun {
                break;
            }
            lowest.pop();
            from.pop();
            start = f64::NEG_INFINITY;
        }
        lowest.push(q);
        from.push(start);
    }
    if lowest.is_empty() {
        return;
    }
    let mut k = 0;
    for q in 0..f.len() {
        while k + 1 < lowest.len() && from[k + 1] <= q as f64 {
            k += 1;
        }
        found(q, lowest[k]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash;
    use crate::shape::path::ellipse;

    #[test]
    fn the_envelope_is_the_least_of_all_parabolas() {
        for seed in 0..20 {
            let value = |i: usize| f64::from(hash::unit(seed, i as u32, 3)) * 200.0 - 100.0;
            let f: Vec<f64> =
                (0..50).map(|i| if i % 7 == 3 { f64::INFINITY } else { value(i) }).collect();
            let at = |q: usize, v: usize| (q as f64 - v as f64).powi(2) + f[v];
            let mut seen = 0;
            lower_envelope(&f, |q, v| {
                let least = (0..50).map(|v| at(q, v)).fold(f64::INFINITY, f64::min);
                assert!((at(q, v) - least).abs() < 1e-9, "{q}: {v}");
                seen += 1;
            });
            assert_eq!(seen, 50);
        }
        lower_envelope(&[f64::INFINITY; 4], |_, _| panic!("nothing is lowest"));
    }

    #[test]
    fn distances_in_a_disc_and_a_turned_strip_are_exact_to_a_hundredth() {
        let disc =
            Outline::of_path(&ellipse(vec2(60.3, 60.8), Vec2::splat(50.0), 0.0, 4000), 1 << 20)
                .unwrap();
        let found = RimDistance::of(&disc);
        let (mut worst, mut turned) = (0.0f32, 0.0f32);
        for (x, y) in (0..disc.inside_pixels().height())
            .flat_map(|y| (0..disc.inside_pixels().width()).map(move |x| (x, y)))
        {
            let from = vec2(
                x as f32 + 0.5 + disc.corner().0 as f32,
                y as f32 + 0.5 + disc.corner().1 as f32,
            ) - vec2(60.3, 60.8);
            if disc.inside_pixels().at(x, y) && from.length() > 5.0 {
                worst =
                    worst.max((found.distance.at(x, y) - (50.0 - from.length()).max(0.0)).abs());
                turned = turned.max((found.inward.at(x, y) + from.normalize()).length());
            }
        }
        assert!(worst < 0.06, "{worst} px off");
        assert!(turned < 0.1, "{turned} turned");
        let strip: Vec<Vec2> =
            [vec2(-90.0, -20.0), vec2(90.0, -20.0), vec2(90.0, 20.0), vec2(-90.0, 20.0)]
                .map(|p| Vec2::from_angle(0.5).rotate(p) + 100.0)
                .into();
        let outline = Outline::of_path(&strip, 1 << 20).unwrap();
        let found = RimDistance::of(&outline);
        for (x, y) in (0..outline.inside_pixels().height())
            .flat_map(|y| (0..outline.inside_pixels().width()).map(move |x| (x, y)))
        {
            let p = vec2(
                x as f32 + 0.5 + outline.corner().0 as f32,
                y as f32 + 0.5 + outline.corner().1 as f32,
            );
            let local = Vec2::from_angle(-0.5).rotate(p - 100.0);
            if outline.inside_pixels().at(x, y) && local.x.abs() < 60.0 {
                let off = found.distance.at(x, y) - (20.0 - local.y.abs());
                assert!(off.abs() < 0.06, "{off} at {local}");
            }
        }
    }
}
