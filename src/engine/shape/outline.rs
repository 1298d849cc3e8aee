//! Outlines: the area of one part of a drawing, as anti-aliased coverage, and where its rim lies
//! between pixels. Floor 3. Not here: where outlines come from in a document (layers, flats, paths)
//! (`document::parts`, `path`).

use crate::math::{Affine2, Rect, Size, Vec2, vec2};
use crate::raster::Plane;
use std::sync::Arc;

/// The least distance of the rim from the center of a pixel, px: a smaller one would make couplings
/// too stiff to solve.
const LEAST_CROSSING: f32 = 0.02;

/// Coverage of a part, with a margin of one empty pixel around it, so that every pixel inside has
/// four neighbors.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Canvas px of the plane's first pixel.
    corner: (i32, i32),
    coverage: Arc<Plane<u8>>,
    inside: Plane<bool>,
}

/// The rim in one pixel, as a straight line.
#[derive(Clone, Copy, Debug)]
pub struct RimLine {
    /// From the pixel's center to the rim, px, positive where the center is inside.
    pub distance: f32,
    /// Unit, out of the part.
    pub outward: Vec2,
}

impl Outline {
    /// Coverage (255 wholly inside) whose first pixel lies at `corner`, cut to what is covered.
    /// `None` if nothing is.
    pub fn new(corner: (i32, i32), coverage: &Plane<u8>) -> Option<Self> {
        let rows = (0..coverage.height()).filter(|y| coverage.row(*y).iter().any(|c| *c > 0));
        let mut bounds = Rect::EMPTY;
        for y in rows {
            let row = coverage.row(y);
            let (first, last) =
                (row.iter().position(|c| *c > 0)?, row.iter().rposition(|c| *c > 0)?);
            bounds = bounds.union(Rect::new(first as i32, y as i32, last as i32 + 1, y as i32 + 1));
        }
        if bounds.is_empty() {
            return None;
        }
        let (x0, y0) = (bounds.x0 - 1, bounds.y0 - 1);
        let size = Size::new(bounds.width() as u32 + 2, bounds.height() as u32 + 2);
        let cut =
            Plane::from_fn(size, |x, y| coverage.get(x as i32 + x0, y as i32 + y0).unwrap_or(0));
        // A hairline covers no pixel by half: then all pixels that it touches are inside.
        let least = if cut.values().iter().any(|c| *c >= 128) { 128 } else { 1 };
        let inside = cut.map(|c| c >= least);
        Some(Self {
            corner: (corner.0.saturating_add(x0), corner.1.saturating_add(y0)),
            coverage: cut.into(),
            inside,
        })
    }

    /// Canvas px of the first pixel of the planes.
    pub fn corner(&self) -> (i32, i32) {
        self.corner
    }

    /// Its size, px.
    pub fn size(&self) -> Size {
        self.coverage.size()
    }

    /// The pixels of the canvas that the planes hold.
    pub fn rect(&self) -> Rect {
        let (x, y) = self.corner;
        Rect::new(
            x,
            y,
            x.saturating_add(self.size().width as i32),
            y.saturating_add(self.size().height as i32),
        )
    }

    /// What it covers, one byte a pixel.
    pub fn coverage(&self) -> &Arc<Plane<u8>> {
        &self.coverage
    }

    /// Whether the center of a pixel is inside: these pixels are the unknowns of every equation
    /// here.
    pub fn inside_pixels(&self) -> &Plane<bool> {
        &self.inside
    }

    /// The same planes with some pixels made outside; a plane of another size removes none.
    pub fn without(&self, cut: &Plane<bool>) -> Self {
        if cut.size() != self.size() {
            return self.clone();
        }
        let coverage =
            Plane::from_fn(
                self.size(),
                |x, y| if cut.at(x, y) { 0 } else { self.coverage.at(x, y) },
            );
        let inside = Plane::from_fn(self.size(), |x, y| !cut.at(x, y) && self.inside.at(x, y));
        Self { corner: self.corner, coverage: coverage.into(), inside }
    }

    /// The same outline, moved.
    pub fn moved(&self, by: (i32, i32)) -> Self {
        let corner = (self.corner.0.saturating_add(by.0), self.corner.1.saturating_add(by.1));
        Self { corner, ..self.clone() }
    }

    /// The rim in a partly covered pixel: the straight line that leaves the pixel's coverage, at a
    /// right angle to the direction in which coverage falls. `None` where a pixel is covered wholly
    /// or not at all, or coverage does not fall.
    pub fn rim_line(&self, x: usize, y: usize) -> Option<RimLine> {
        let covered = self.coverage.at(x, y);
        if covered == 0 || covered == 255 {
            return None;
        }
        let at = |dx: i32, dy: i32| {
            f32::from(self.coverage.get(x as i32 + dx, y as i32 + dy).unwrap_or(0))
        };
        let side = |s: i32| at(s, -1) + 2.0 * at(s, 0) + at(s, 1);
        let end = |s: i32| at(-1, s) + 2.0 * at(0, s) + at(1, s);
        let outward = vec2(side(-1) - side(1), end(-1) - end(1)).try_normalize()?;
        let share = f32::from(covered) / 255.0;
        Some(RimLine { distance: distance_of_share(share, outward), outward })
    }

    /// Distance of the rim from the center of an inside pixel toward a neighbor outside, in
    /// `[0.02, 1]` px.
    ///
    /// Gibou et al. 2002 need this θ to place a rim between pixels. It is known from the partly
    /// covered pixel of the two; from both it is the mean, from neither halfway.
    pub fn crossing(&self, (x, y): (usize, usize), step: (i32, i32)) -> f32 {
        let along = |line: RimLine| {
            let across = if step.0 != 0 { line.outward.x } else { line.outward.y };
            line.distance / across.abs().max(0.05)
        };
        let other = ((x as i32 + step.0) as usize, (y as i32 + step.1) as usize);
        let near = self.rim_line(x, y).map(along);
        let far = self.rim_line(other.0, other.1).map(|line| 1.0 + along(line));
        let theta = match (near, far) {
            (Some(a), Some(b)) => 0.5 * (a + b),
            (Some(a), None) | (None, Some(a)) => a,
            (None, None) => 0.5,
        };
        theta.max(LEAST_CROSSING).min(1.0)
    }

    /// The outline as it is seen through a map of its plane; `None` where nothing of it is left, or
    /// the map flattens it, or its picture would have more than `most_px` pixels.
    ///
    /// Moves by whole pixels copy. Otherwise coverage is read between pixels, and its former
    /// steepness restored.
    pub fn transformed(&self, map: Affine2, most_px: usize) -> Option<Self> {
        if !map.is_finite() || map.matrix2.determinant().abs() < 1e-6 {
            return None;
        }
        let shift = map.translation;
        if map.matrix2 == crate::math::Mat2::IDENTITY && shift == shift.round() {
            return Some(self.moved((shift.x as i32, shift.y as i32)));
        }
        let rect = self.rect();
        let corners =
            [(rect.x0, rect.y0), (rect.x1, rect.y0), (rect.x0, rect.y1), (rect.x1, rect.y1)];
        let seen = corners.map(|(x, y)| map.transform_point2(vec2(x as f32, y as f32)));
        let low = seen.iter().fold(Vec2::MAX, |a, b| a.min(*b)).floor();
        let size = (seen.iter().fold(Vec2::MIN, |a, b| a.max(*b)).ceil() - low).max(Vec2::ONE);
        let area = f64::from(size.x) * f64::from(size.y);
        if area.is_nan() || area > most_px as f64 || low.abs().max_element() > 1e6 {
            return None;
        }
        let back = map.inverse();
        let steep = map.matrix2.determinant().abs().sqrt().max(1.0);
        let origin = vec2(self.corner.0 as f32, self.corner.1 as f32);
        // A new pixel that covers several old ones takes the mean of them.
        let taps = (1.0 / map.matrix2.determinant().abs().sqrt()).ceil().max(1.0).min(8.0) as usize;
        let coverage = Plane::from_fn(Size::new(size.x as u32, size.y as u32), |x, y| {
            let mut sum = 0.0;
            for k in 0..taps * taps {
                let (i, j) = ((k % taps) as f32 + 0.5, (k / taps) as f32 + 0.5);
                let p = low + vec2(x as f32 + i / taps as f32, y as f32 + j / taps as f32);
                sum += self.sample(back.transform_point2(p) - origin);
            }
            let share = sum / (taps * taps) as f32;
            ((((share - 0.5) * steep + 0.5) * 255.0).round()).max(0.0).min(255.0) as u8
        });
        Self::new((low.x as i32, low.y as i32), &coverage)
    }

    /// Coverage between the centers of pixels, `[0, 1]`; `p` in px of the plane.
    pub(super) fn sample(&self, p: Vec2) -> f32 {
        let q = p - 0.5;
        let (x, y) = (q.x.floor(), q.y.floor());
        let at = |dx: i32, dy: i32| {
            f32::from(self.coverage.get(x as i32 + dx, y as i32 + dy).unwrap_or(0))
        };
        let (fx, fy) = (q.x - x, q.y - y);
        let row = |dy: i32| at(0, dy) * (1.0 - fx) + at(1, dy) * fx;
        (row(0) * (1.0 - fy) + row(1) * fy) / 255.0
    }
}

/// How far inside a straight rim the center of a unit square is, if the rim leaves the share
/// `share` of it; px.
///
/// The area of a square within a half plane grows quadratically while the rim passes a corner,
/// linearly between corners; this is its inverse. `outward`: unit.
pub fn distance_of_share(share: f32, outward: Vec2) -> f32 {
    let (long, short) = (
        outward.x.abs().max(outward.y.abs()),
        outward.x.abs().min(outward.y.abs()).max(f32::MIN_POSITIVE),
    );
    let beyond = (share - 0.5).abs();
    let linear = beyond * long;
    let distance = if linear <= 0.5 * (long - short) {
        linear
    } else {
        0.5 * (long + short) - (2.0 * long * short * (0.5 - beyond).max(0.0)).sqrt()
    };
    if share < 0.5 { -distance } else { distance }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share of a unit square that lies on the inner side, by counting.
    fn counted(distance: f32, outward: Vec2) -> f32 {
        let n = 400;
        let point = |i: usize| (i as f32 + 0.5) / n as f32 - 0.5;
        let inside =
            (0..n * n).filter(|i| vec2(point(i % n), point(i / n)).dot(outward) < distance).count();
        inside as f32 / (n * n) as f32
    }

    #[test]
    fn a_share_gives_its_rim_back() {
        for turn in [0.0f32, 0.1, 0.5, std::f32::consts::FRAC_PI_4, 1.2, 2.0, 3.5] {
            let outward = Vec2::from_angle(turn);
            for distance in [-0.6f32, -0.3, 0.0, 0.2, 0.45] {
                let share = counted(distance, outward);
                if share > 0.01 && share < 0.99 {
                    let found = distance_of_share(share, outward);
                    assert!(
                        (found - distance).abs() < 0.01,
                        "{found} and not {distance} at {turn}"
                    );
                }
            }
        }
    }

    #[test]
    fn an_outline_is_cut_to_what_is_covered_with_an_empty_margin() {
        let coverage =
            Plane::from_fn(Size::new(9, 7), |x, y| u8::from(x == 4 && y > 2 && y < 5) * 200);
        let outline = Outline::new((10, 20), &coverage).unwrap();
        assert_eq!(outline.rect(), Rect::new(13, 22, 16, 26));
        assert_eq!(outline.inside_pixels().values().iter().filter(|i| **i).count(), 2);
        assert!(Outline::new((0, 0), &Plane::full(Size::new(3, 3), 0)).is_none());
        let hairline = Outline::new((0, 0), &Plane::full(Size::new(3, 1), 20)).unwrap();
        assert_eq!(hairline.inside_pixels().values().iter().filter(|i| **i).count(), 3);
    }

    #[test]
    fn whole_pixels_move_an_outline_as_it_is_and_a_turn_keeps_its_area() {
        let coverage =
            Plane::from_fn(Size::new(40, 30), |x, y| if x > 3 && y > 5 { 255 } else { 90 });
        let outline = Outline::new((0, 0), &coverage).unwrap();
        let moved =
            outline.transformed(Affine2::from_translation(vec2(7.0, -3.0)), 1 << 20).unwrap();
        assert_eq!(moved, outline.moved((7, -3)));
        let square = Outline::new((0, 0), &Plane::full(Size::new(40, 40), 255)).unwrap();
        let turned = square.transformed(Affine2::from_angle(0.6), 1 << 20).unwrap();
        let area =
            |o: &Outline| o.coverage().values().iter().map(|c| f64::from(*c)).sum::<f64>() / 255.0;
        assert!((area(&turned) / area(&square) - 1.0).abs() < 0.01, "{}", area(&turned));
        assert!(square.transformed(Affine2::from_scale(vec2(1.0, 0.0)), 1 << 20).is_none());
        assert!(square.transformed(Affine2::from_scale(vec2(1e4, 1e4)), 1 << 20).is_none());
    }
}
