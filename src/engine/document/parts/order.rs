//! The order of areas by depth, from who interrupts whose outline. Floor 4. Not here: which areas
//! there are (`flats`).

use crate::math::Size;
use crate::raster::Plane;
use crate::shape::flats::palette::NOTHING;

/// How far around a common border areas are compared, as a share of the longer side.
const LOOKED_AROUND: f32 = 0.02;
/// Areas are compared in a picture whose longer side is about this, px: the order is one of large
/// shapes.
const COMPARED_PX: f32 = 1024.0;
/// A border that is a smaller share of all that an area borders on is left over from mixed pixels.
const LEAST_BORDER: f32 = 0.05;

/// The numbers of areas, `0..n`, those in front last.
///
/// `labels`: the number of the area of each pixel, [`NOTHING`] or more where there is none.
///
/// An area that is all around another, so that nothing leads from that to the outside but over it,
/// lies behind it. What each pixel of another common border says about two areas is added up
/// (`in_front_by`). The clearest decisions count most: the next farthest is always the area that is
/// least in front of the remaining ones.
pub fn farthest_first(labels: &Plane<u16>, n: usize) -> Vec<usize> {
    let labels = smaller(labels);
    let radius = (LOOKED_AROUND * labels.size().longer_side()).max(2.0) as usize;
    let islands = islands(&borders(&labels, n), n);
    // in_front[a][b]: how clearly a lies in front of b.
    let mut in_front = vec![vec![0.0f64; n]; n];
    for Island { area, within, border_px } in &islands {
        in_front[*area][*within] = *border_px as f64;
        in_front[*within][*area] = -(*border_px as f64);
    }
    let is_known = |a: usize, b: usize| {
        islands.iter().any(|island| [(a, b), (b, a)].contains(&(island.area, island.within)))
    };
    for site in sites(&labels, radius, &islands, n) {
        let [a, b] = site.areas;
        if !is_known(a, b) {
            let clearly = f64::from(in_front_by(site.shares[0], site.shares[1]));
            in_front[a][b] += clearly;
            in_front[b][a] -= clearly;
        }
    }
    let mut left: Vec<usize> = (0..n).collect();
    let mut order = Vec::with_capacity(n);
    while !left.is_empty() {
        // What lies over an area says nothing about what the area lies over.
        let over = |a: usize| left.iter().map(|b| in_front[a][*b].max(0.0)).sum::<f64>();
        let first =
            (0..left.len()).min_by(|a, b| over(left[*a]).total_cmp(&over(left[*b]))).unwrap_or(0);
        order.push(left.remove(first));
    }
    order
}

/// Every few pixels of a large picture.
fn smaller(labels: &Plane<u16>) -> Plane<u16> {
    let each = ((labels.size().longer_side() / COMPARED_PX).round() as usize).max(1);
    let count = |px: usize| (px / each).max(1);
    let size = Size::new(count(labels.width()) as u32, count(labels.height()) as u32);
    let inside = |i: usize, px: usize| (i * each + each / 2).min(px - 1);
    Plane::from_fn(size, |x, y| labels.at(inside(x, labels.width()), inside(y, labels.height())))
}

/// px that each area has in common with each other, and, as number n, with none.
fn borders(labels: &Plane<u16>, n: usize) -> Vec<Vec<usize>> {
    let mut borders = vec![vec![0usize; n + 1]; n + 1];
    let of = |x: i32, y: i32| labels.get(x, y).map_or(n, |label| usize::from(label).min(n));
    for (x, y) in
        (-1..labels.height() as i32).flat_map(|y| (-1..labels.width() as i32).map(move |x| (x, y)))
    {
        for (x1, y1) in [(x + 1, y), (x, y + 1)] {
            let (a, b) = (of(x, y), of(x1, y1));
            if a != b {
                borders[a][b] += 1;
                borders[b][a] += 1;
            }
        }
    }
    borders
}

/// An area all around which another is.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Island {
    area: usize,
    within: usize,
    /// Of the area with all others.
    border_px: usize,
}

/// Which areas lie on which: every way to the outside, from area to area, leads over the other.
fn islands(borders: &[Vec<usize>], n: usize) -> Vec<Island> {
    let totals: Vec<usize> = borders.iter().map(|of| of.iter().sum()).collect();
    let meets = |a: usize, b: usize| {
        let least = LEAST_BORDER * totals[a].min(totals[b]) as f32;
        borders[a][b] > 0 && borders[a][b] as f32 >= least
    };
    let reached_without = |on: usize| {
        let mut reached = vec![false; n + 1];
        let mut ahead = vec![n];
        reached[n] = true;
        while let Some(a) = ahead.pop() {
            for b in (0..n).filter(|b| *b != on && meets(a, *b)) {
                if !std::mem::replace(&mut reached[b], true) {
                    ahead.push(b);
                }
            }
        }
        reached
    };
    let reached = reached_without(n);
    let mut islands = Vec::new();
    for within in (0..n).filter(|area| reached[*area]) {
        let free = reached_without(within);
        let inside = (0..n).filter(|area| *area != within && reached[*area] && !free[*area]);
        islands.extend(inside.map(|area| Island { area, within, border_px: totals[area] }));
    }
    islands
}

/// A pixel of a border, and the share that each of the two areas has around it.
struct BorderSite {
    at: [(usize, usize); 2],
    areas: [usize; 2],
    shares: [f32; 2],
}

/// All borders of areas of which neither lies on the other. What lies on an area counts as that.
fn sites(labels: &Plane<u16>, radius: usize, islands: &[Island], n: usize) -> Vec<BorderSite> {
    let mut sites = Vec::new();
    for (x, y) in (0..labels.height()).flat_map(|y| (0..labels.width()).map(move |x| (x, y))) {
        for (dx, dy) in [(1, 0), (0, 1), (2, 0), (0, 2)] {
            let (a, beside) = (labels.at(x, y), (x + dx, y + dy));
            let Some(b) = labels.get(beside.0 as i32, beside.1 as i32) else { continue };
            if a != b && a < NOTHING && b < NOTHING {
                let areas = [a, b].map(usize::from);
                sites.push(BorderSite { at: [(x, y), beside], areas, shares: [0.0; 2] });
            }
        }
    }
    for area in 0..n {
        if !sites.iter().any(|site| site.areas.contains(&area)) {
            continue;
        }
        let is_own = |label: u16| {
            usize::from(label) == area
                || islands.iter().any(|i| i.within == area && i.area == usize::from(label))
        };
        let own: Vec<bool> = (0..n as u16).map(is_own).collect();
        let around =
            share_around(labels, radius, |label| own.get(usize::from(label)) == Some(&true));
        for site in &mut sites {
            for side in (0..2).filter(|side| site.areas[*side] == area) {
                // Measured on the border itself: each of the two pixels lies on one side of it.
                let [(x0, y0), (x1, y1)] = site.at;
                site.shares[side] = 0.5 * (around.at(x0, y0) + around.at(x1, y1));
            }
        }
    }
    sites
}

/// How clearly an area lies in front of another at a pixel of their border, from their shares of
/// the neighborhood; below 0 it lies behind.
///
/// * With only the two, the one whose side bulges lies in front: it has the smaller share.
/// * Where a third meets them, the outline of the one in front continues, so that it has half of
///   the neighborhood; the others end at it. If that is the third, nothing is known about the two.
fn in_front_by(own: f32, other: f32) -> f32 {
    const ALONE: f32 = 0.98;
    const HALF: std::ops::RangeInclusive<f32> = 0.4..=0.6;
    if own + other >= ALONE {
        other - own
    } else if HALF.contains(&own.max(other)) {
        own - other
    } else {
        0.0
    }
}

/// The share of an area in a square around each pixel, `[0, 1]`: running sums along rows, then
/// columns.
fn share_around(labels: &Plane<u16>, radius: usize, is_own: impl Fn(u16) -> bool) -> Plane<f32> {
    let (w, h) = (labels.width(), labels.height());
    let window = |values: &dyn Fn(usize) -> f32, n: usize| -> Vec<f32> {
        let mut sums = vec![0.0f64; n + 1];
        (0..n).for_each(|i| sums[i + 1] = sums[i] + f64::from(values(i)));
        let side = (2 * radius + 1) as f64;
        (0..n)
            .map(|i| {
                ((sums[(i + radius + 1).min(n)] - sums[i.saturating_sub(radius)]) / side) as f32
            })
            .collect()
    };
    let mut rows = Plane::full(labels.size(), 0.0f32);
    for y in 0..h {
        rows.row_mut(y)
            .copy_from_slice(&window(&|x| f32::from(u8::from(is_own(labels.at(x, y)))), w));
    }
    let mut out = Plane::full(labels.size(), 0.0f32);
    for x in 0..w {
        window(&|y| rows.at(x, y), h).into_iter().enumerate().for_each(|(y, v)| out.set(x, y, v));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    /// Discs (middle and radius), the last in front of the others, as the visible area of each.
    fn seen(discs: &[([f32; 2], f32)], scale: f32) -> Plane<u16> {
        let size = Size::new((320.0 * scale) as u32, (400.0 * scale) as u32);
        let holds = |disc: &([f32; 2], f32), x: usize, y: usize| {
            vec2(x as f32 + 0.5, y as f32 + 0.5).distance(vec2(disc.0[0], disc.0[1]) * scale)
                < disc.1 * scale
        };
        let front = |x, y| discs.iter().rposition(|disc| holds(disc, x, y));
        Plane::from_fn(size, |x, y| front(x, y).map_or(NOTHING, |i| i as u16))
    }

    #[test]
    fn who_interrupts_the_outline_of_another_lies_in_front() {
        let (head, body, hand) =
            (([160.0, 120.0], 80.0), ([160.0, 260.0], 110.0), ([250.0, 200.0], 30.0));
        for scale in [0.5, 1.0, 2.0, 8.0] {
            assert_eq!(
                farthest_first(&seen(&[body, head], scale), 2),
                [0, 1],
                "the head over the body, {scale}"
            );
            assert_eq!(
                farthest_first(&seen(&[head, body], scale), 2),
                [0, 1],
                "the body over the head, {scale}"
            );
            assert_eq!(
                farthest_first(&seen(&[body, head, hand], scale), 3),
                [0, 1, 2],
                "a hand over both, {scale}"
            );
            assert_eq!(
                farthest_first(&seen(&[head, body, hand], scale), 3),
                [0, 1, 2],
                "and the other way, {scale}"
            );
        }
    }

    #[test]
    fn what_is_only_reached_over_another_area_lies_on_it() {
        // The pupil touches the eye and the face, the eye the pupil and the face.
        let (face, eye, pupil) =
            (([160.0, 200.0], 120.0), ([120.0, 160.0], 40.0), ([150.0, 170.0], 24.0));
        assert_eq!(farthest_first(&seen(&[face, eye, pupil], 1.0), 3), [0, 1, 2]);
        let on: Vec<(usize, usize)> = islands(&borders(&seen(&[face, eye, pupil], 1.0), 3), 3)
            .iter()
            .map(|island| (island.area, island.within))
            .collect();
        assert_eq!(on, [(1, 0), (2, 0)]);
    }
}
