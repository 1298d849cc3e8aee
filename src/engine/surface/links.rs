//! Links: which neighboring pixels belong to the same piece of surface, so that nothing is
//! differenced across a depth jump or the mask's edge. Floor 2.

use crate::math::fast::{max, min};
use crate::math::parallel;
use crate::raster::Plane;
use rayon::prelude::*;

/// The neighbor at the left (x − 1) continues this pixel's surface.
pub const LEFT: u8 = 1;
/// The neighbor at the right (x + 1).
pub const RIGHT: u8 = 2;
/// The neighbor above (y − 1).
pub const UP: u8 = 4;
/// The neighbor below (y + 1).
pub const DOWN: u8 = 8;

/// Whether a pixel, the one to its right and those below both are one piece.
pub fn is_one_piece(all: &Plane<u8>, x: usize, y: usize) -> bool {
    let here = all.at(x, y);
    here & RIGHT != 0
        && here & DOWN != 0
        && all.at(x + 1, y) & DOWN != 0
        && all.at(x, y + 1) & RIGHT != 0
}

/// Slope of the surface in pixels of depth per pixel, image axes, away from the viewer.
///
/// A surface z(x, y) with normal n recedes by n̄/n_z (depth grows where n̄ points).
fn slope(nbar: f32, nz: f32) -> f32 {
    nbar / nz.max(0.05)
}

/// Z in pixels: the median ratio between the slope of the normals and the step of the depth, over
/// gently sloped pixels. One canvas length where the maps do not allow an estimate.
pub fn depth_range_px(
    nbar_x: &Plane<f32>,
    nbar_y: &Plane<f32>,
    nz: &Plane<f32>,
    depth: &Plane<f32>,
    coverage: &Plane<u8>,
) -> f32 {
    let size = depth.size();
    // Every pixel of a small map, a spread sample of a large one: the median needs no more.
    let step = (size.area() / 250_000).max(1);
    let mut ratios: Vec<f32> = (0..size.area())
        .into_par_iter()
        .step_by(step)
        .filter_map(|i| {
            let (x, y) = (i % size.width as usize, i / size.width as usize);
            if x == 0 || y == 0 || x + 1 >= depth.width() || y + 1 >= depth.height() {
                return None;
            }
            let inside = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)]
                .iter()
                .all(|&(x, y)| coverage.at(x, y) == 255);
            let of_normals =
                length(slope(nbar_x.at(x, y), nz.at(x, y)), slope(nbar_y.at(x, y), nz.at(x, y)));
            let dx = (depth.at(x + 1, y) - depth.at(x - 1, y)) * 0.5;
            let dy = (depth.at(x, y + 1) - depth.at(x, y - 1)) * 0.5;
            let seen = length(dx, dy);
            (inside && (0.2..2.0).contains(&of_normals) && seen > 1e-6).then(|| of_normals / seen)
        })
        .collect();
    if ratios.len() < 16 {
        return size.longer_side();
    }
    let mid = ratios.len() / 2;
    *ratios.select_nth_unstable_by(mid, f32::total_cmp).1
}

/// √(x² + y²), as the standard library's `hypot` rounds it, without a call.
#[inline(always)]
fn length(x: f32, y: f32) -> f32 {
    (f64::from(x) * f64::from(x) + f64::from(y) * f64::from(y)).sqrt() as f32
}

/// Excess over the tolerance, as a ratio of it, from which a step is a jump on its own.
const CERTAIN: f32 = 1.0;
/// Excess from which a step next to a jump is a jump too: the contour of an occluder fades where it
/// nears what is behind it, and must not break into dots.
const LIKELY: f32 = 0.2;

/// Finds the links of every pixel.
pub fn find(
    nbar_x: &Plane<f32>,
    nbar_y: &Plane<f32>,
    nz: &Plane<f32>,
    depth: &Plane<f32>,
    coverage: &Plane<u8>,
    depth_range_px: f32,
) -> Plane<u8> {
    let maps = StepMaps { nbar: [nbar_x, nbar_y], nz, depth, coverage, depth_range_px };
    let mut jumps = Plane::full(depth.size(), 0u8);
    let width = depth.width().max(1);
    parallel::for_each_row(jumps.values_mut(), width, 1, |y, row| maps.jumps_of_row(y, row));
    spread(&mut jumps);
    Plane::from_fn(depth.size(), |x, y| {
        // A step is stored at its left or upper pixel.
        let joined = |at: Option<(usize, usize)>, axis: usize| {
            at.is_some_and(|at| {
                maps.are_covered(at, axis)
                    && jumps.at(at.0, at.1) >> (DOWNWARD * axis as u8) & JUMP == 0
            })
        };
        let bit = |bit: u8, is: bool| if is { bit } else { 0 };
        bit(LEFT, joined(x.checked_sub(1).map(|x| (x, y)), 0))
            | bit(RIGHT, joined(Some((x, y)), 0))
            | bit(UP, joined(y.checked_sub(1).map(|y| (x, y)), 1))
            | bit(DOWN, joined(Some((x, y)), 1))
    })
}

/// Which of the nine pixels around one, row by row, links join to it without crossing a contour;
/// itself too.
pub fn joined_neighbors(linked: &Plane<u8>, (x, y): (usize, usize)) -> [bool; 9] {
    let here = linked.at(x, y);
    if here == 15
        && (1..linked.width() - 1).contains(&x)
        && (1..linked.size().height as usize - 1).contains(&y)
    {
        let across = LEFT | RIGHT;
        let rows = [linked.at(x, y - 1), linked.at(x, y + 1)];
        if rows.iter().all(|bits| bits & across == across) {
            return [true; 9];
        }
    }
    let has = |dx: i32, dy: i32, bit: u8| {
        linked.get(x as i32 + dx, y as i32 + dy).is_some_and(|bits| bits & bit != 0)
    };
    let side = |dx: i32, dy: i32| match (dx, dy) {
        (-1, 0) => here & LEFT != 0,
        (1, 0) => here & RIGHT != 0,
        (_, -1) => here & UP != 0,
        _ => here & DOWN != 0,
    };
    std::array::from_fn(|i| {
        let (dx, dy) = (i as i32 % 3 - 1, i as i32 / 3 - 1);
        let across = if dx < 0 { LEFT } else { RIGHT };
        let down = if dy < 0 { UP } else { DOWN };
        match (dx, dy) {
            (0, 0) => true,
            (0, _) | (_, 0) => side(dx, dy),
            _ => side(dx, 0) && has(dx, 0, down) || side(0, dy) && has(0, dy, across),
        }
    })
}

/// Removes the links between pixels of different pieces.
pub fn cut(links: &mut Plane<u8>, piece: impl Fn(usize, usize) -> u32 + Sync) {
    let whole = std::mem::replace(links, Plane::full(links.size(), 0));
    let (w, h) = (whole.width(), whole.height());
    *links = whole.updated(|x, y, linked| {
        let here = piece(x, y);
        let other = |bit: u8, there: bool, at: (usize, usize)| {
            if there && piece(at.0, at.1) != here { bit } else { 0 }
        };
        linked
            & !(other(LEFT, x > 0, (x.wrapping_sub(1), y))
                | other(RIGHT, x + 1 < w, (x + 1, y))
                | other(UP, y > 0, (x, y.wrapping_sub(1)))
                | other(DOWN, y + 1 < h, (x, y + 1)))
    });
}

/// Flags of the step from a pixel to its right neighbor: it is a jump; it is one if it touches
/// another.
const JUMP: u8 = 1;
const LIKELY_JUMP: u8 = 2;
/// The same flags for the step to the pixel below, shifted by this many bits.
const DOWNWARD: u8 = 2;

/// Turns likely jumps into jumps where they touch one, over the eight neighbors of a pixel.
fn spread(jumps: &mut Plane<u8>) {
    const ANY_JUMP: u8 = JUMP | JUMP << DOWNWARD;
    const ANY_LIKELY: u8 = LIKELY_JUMP | LIKELY_JUMP << DOWNWARD;
    let width = jumps.width();
    let mut ends: Vec<usize> =
        (0..jumps.values().len()).filter(|&i| jumps.values()[i] & ANY_JUMP != 0).collect();
    while let Some(i) = ends.pop() {
        let (x, y) = ((i % width) as i32, (i / width) as i32);
        for (x, y) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy))) {
            let Some(bits) = jumps.get(x, y).filter(|bits| bits & ANY_LIKELY != 0) else {
                continue;
            };
            jumps.set(x as usize, y as usize, bits & !ANY_LIKELY | (bits & ANY_LIKELY) >> 1);
            ends.push(y as usize * width + x as usize);
        }
    }
}

/// What a step from one pixel to the next is judged by.
struct StepMaps<'a> {
    nbar: [&'a Plane<f32>; 2],
    nz: &'a Plane<f32>,
    depth: &'a Plane<f32>,
    coverage: &'a Plane<u8>,
    depth_range_px: f32,
}

crate::widest! {
    /// Which steps from pixels to those after them may exceed what normals say: the others
    /// certainly do not.
    ///
    /// * `ends`: of both pixels n̄ along the step, n_z and depth.
    fn may_jump(ends: [[&[f32]; 3]; 2], range_px: f32, out: &mut [u8]) {
        let n = out.len();
        let [[a, az, from], [b, bz, to]] = ends.map(|end| end.map(|row| &row[..n]));
        for x in 0..n {
            let (here, there) = (a[x] / max(az[x], 0.05), b[x] / max(bz[x], 0.05));
            let step = (to[x] - from[x]) * range_px;
            let beyond = max(min(here, there) - step, step - max(here, there));
            // A little less than the tolerance, so that rounding hides none.
            let least = 0.99 * LIKELY * (1.5 + 0.5 * max(here.abs(), there.abs()));
            out[x] = u8::from(beyond > least);
        }
    }
}

impl StepMaps<'_> {
    /// The jumps and likely jumps of the steps after the pixels of a row.
    fn jumps_of_row(&self, y: usize, row: &mut [u8]) {
        let w = row.len();
        let rows =
            |axis: usize, y: usize| [self.nbar[axis].row(y), self.nz.row(y), self.depth.row(y)];
        let mut may = vec![0; w];
        let judge = |axis: usize, may: &[u8], row: &mut [u8]| {
            for x in (0..may.len()).filter(|&x| may[x] != 0) {
                let flag = match self.excess((x, y), axis) {
                    excess if excess > CERTAIN => JUMP,
                    excess if excess > LIKELY => LIKELY_JUMP,
                    _ => 0,
                };
                row[x] |= flag << (DOWNWARD * axis as u8);
            }
        };
        let here = rows(0, y);
        may_jump([here, here.map(|row| &row[1..])], self.depth_range_px, &mut may[..w - 1]);
        judge(0, &may[..w - 1], row);
        if y + 1 < self.depth.height() {
            may_jump([rows(1, y), rows(1, y + 1)], self.depth_range_px, &mut may);
            judge(1, &may, row);
        }
    }

    /// The pixel after one, to the right (axis 0) or below (1).
    fn pixel_after(&self, (x, y): (usize, usize), axis: usize) -> Option<(usize, usize)> {
        let next = if axis == 0 { (x + 1, y) } else { (x, y + 1) };
        (next.0 < self.depth.width() && next.1 < self.depth.height()).then_some(next)
    }

    fn pixel_before(&self, (x, y): (usize, usize), axis: usize) -> Option<(usize, usize)> {
        if axis == 0 { Some((x.checked_sub(1)?, y)) } else { Some((x, y.checked_sub(1)?)) }
    }

    /// Both ends of the step after a pixel are on a surface.
    fn are_covered(&self, at: (usize, usize), axis: usize) -> bool {
        let covered = |(x, y): (usize, usize)| self.coverage.at(x, y) > 0;
        covered(at) && self.pixel_after(at, axis).is_some_and(covered)
    }

    /// The step of depth after a pixel, px; `None` where one of its ends is no surface.
    fn step(&self, at: (usize, usize), axis: usize) -> Option<f32> {
        let next = self.pixel_after(at, axis).filter(|_| self.are_covered(at, axis))?;
        Some((self.depth.at(next.0, next.1) - self.depth.at(at.0, at.1)) * self.depth_range_px)
    }

    fn slope(&self, (x, y): (usize, usize), axis: usize) -> f32 {
        slope(self.nbar[axis].at(x, y), self.nz.at(x, y))
    }

    /// How far the step after a pixel is from that of a smooth surface, as a ratio of the
    /// tolerance; 0 where it is one.
    ///
    /// Between two neighbors of a smooth surface the step lies between the slopes of their normals
    /// (the mean value theorem). Normals may have detail that the depth lacks, so the depth must
    /// also jump relative to the steps before and after. The tolerance is half a slope plus 1.5 px,
    /// for curvature and coarse depth.
    fn excess(&self, at: (usize, usize), axis: usize) -> f32 {
        let (Some(step), Some(next)) = (self.step(at, axis), self.pixel_after(at, axis)) else {
            return 0.0;
        };
        let (here, there) = (self.slope(at, axis), self.slope(next, axis));
        let by_normals =
            excess_beyond(step, here, there) / (1.5 + 0.5 * here.abs().max(there.abs()));
        if by_normals <= LIKELY {
            return 0.0;
        }
        let before = self.pixel_before(at, axis).and_then(|at| self.step(at, axis));
        let after = self.step(next, axis);
        let Some((before, after)) = before.or(after).zip(after.or(before)) else {
            return by_normals;
        };
        // The tolerance of the flatter side counts: the other may itself be a jump.
        by_normals
            .min(excess_beyond(step, before, after) / (1.5 + 0.5 * before.abs().min(after.abs())))
    }
}

/// How far a value lies outside of the range that two others span.
fn excess_beyond(value: f32, a: f32, b: f32) -> f32 {
    (a.min(b) - value).max(value - a.max(b)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec3, vec3};
    use crate::surface::{Maps, Surface};

    #[test]
    fn rows_are_judged_as_each_of_their_steps() {
        let size = Size::new(37, 23);
        let value = |seed: u32| {
            Plane::from_fn(size, move |x, y| {
                crate::math::hash::unit(seed, x as u32 / 4, y as u32 / 3)
            })
        };
        let [nx, ny, nz, depth] = [1, 2, 3, 4].map(value);
        let coverage = value(5).map(|v| if v < 0.9 { 255 } else { 0 });
        let maps = StepMaps {
            nbar: [&nx, &ny],
            nz: &nz,
            depth: &depth,
            coverage: &coverage,
            depth_range_px: 9.0,
        };
        let mut seen = 0;
        for y in 0..size.height as usize {
            let mut row = [0; 37];
            maps.jumps_of_row(y, &mut row);
            for (x, found) in row.into_iter().enumerate() {
                let flag = |axis: usize| match maps.excess((x, y), axis) {
                    excess if excess > CERTAIN => JUMP,
                    excess if excess > LIKELY => LIKELY_JUMP,
                    _ => 0,
                };
                assert_eq!(found, flag(0) | flag(1) << DOWNWARD, "{x} {y}");
                seen += u32::from(found != 0);
            }
        }
        assert!(seen > 50, "{seen}");
    }

    /// Maps of 60 × 40 pixels from a height in pixels and the normal that the map gives.
    fn surface(
        height: impl Fn(f32, f32) -> f32 + Sync,
        normal: impl Fn(f32, f32) -> Vec3 + Sync,
    ) -> Surface {
        let size = Size::new(60, 40);
        let at = |x: usize, y: usize| (x as f32 + 0.5, y as f32 + 0.5);
        let [low, high] = [f32::min, f32::max].map(|pick| {
            let all = (0..40).flat_map(|y| (0..60).map(move |x| (x, y)));
            all.map(|(x, y)| height(at(x, y).0, at(x, y).1)).reduce(pick).unwrap()
        });
        let depth =
            Plane::from_fn(size, |x, y| (high - height(at(x, y).0, at(x, y).1)) / (high - low));
        let normals = Plane::from_fn(size, |x, y| normal(at(x, y).0, at(x, y).1));
        Surface::new(Maps { normals, depth, coverage: Plane::full(size, 255) }).unwrap()
    }

    /// Rows of which the link from column 29 to column 30 is broken.
    fn broken_rows(surface: &Surface) -> Vec<usize> {
        (0..40).filter(|&y| surface.links_plane().at(29, y) & RIGHT == 0).collect()
    }

    #[test]
    fn detail_of_the_normals_that_the_depth_lacks_breaks_nothing() {
        let wavy = |x: f32, y: f32| vec3(0.9 * (x * 2.3).sin() - 0.5, 0.9 * (y * 1.9).cos(), 0.4);
        let surface = surface(|x, _| 0.5 * x, wavy);
        assert!((1..39).all(|y| (1..59).all(|x| surface.links_plane().at(x, y) == 15)));
    }

    #[test]
    fn a_jump_breaks_links_across_it_and_none_along_it() {
        let cliff = |x: f32, _: f32| 0.5 * x + if x < 30.0 { 0.0 } else { 20.0 };
        let surface = surface(cliff, |_, _| vec3(-0.5, 0.0, 1.0));
        assert_eq!(broken_rows(&surface).len(), 40);
        assert_eq!(surface.links_plane().at(29, 20), LEFT | UP | DOWN);
        assert_eq!(surface.links_plane().at(28, 20), 15);
    }

    #[test]
    fn a_jump_that_shrinks_goes_on_until_it_ends() {
        // From 12 px at the top to nothing at the bottom: below 1.75 px it is no jump by itself.
        let torn = |x: f32, y: f32| 0.5 * x + if x < 30.0 { 0.0 } else { 12.0 * (1.0 - y / 40.0) };
        let surface = surface(torn, |_, _| vec3(-0.5, 0.0, 1.0));
        let rows = broken_rows(&surface);
        assert_eq!(rows, (0..rows.len()).collect::<Vec<_>>(), "one piece, no beads");
        assert!((36..40).contains(&rows.len()), "{}", rows.len());
        // An equally small jump that touches no larger one counts as coarse depth.
        let low = |x: f32, _: f32| 0.5 * x + if x < 30.0 { 0.0 } else { 1.0 };
        assert!(broken_rows(&self::surface(low, |_, _| vec3(-0.5, 0.0, 1.0))).is_empty());
    }
}
