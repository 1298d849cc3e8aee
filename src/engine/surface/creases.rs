//! Creases: where the surface goes on but its direction turns within a pixel, as at an edge of a
//! cube. Nothing that changes smoothly over a surface is differenced across one. Floor 2.

use super::links;
use crate::math::{Vec2, parallel, vec2};
use crate::raster::Plane;
use std::collections::HashSet;

/// A step of n̄ of at least this length turns at a crease where it is this many times as long as
/// the steps before and after it, and these are short: detail of a pixel or two is no crease. One
/// that touches such a step is one from the second row on. n̄ changes steadily up to a smooth
/// silhouette, where n_z falls ever faster.
const CERTAIN: Sharpness = Sharpness { least: 0.3, times: 4.0 };
const LIKELY: Sharpness = Sharpness { least: 0.12, times: 2.5 };
/// The longest that the steps before and after may be.
const MOST_BESIDE: f32 = 0.1;
/// A renderer may have mixed both sides in a pixel: the way over it is at most this much longer
/// than past it.
const DETOUR: f32 = 1.15;
/// Fewer steps side by side are noise.
const LEAST_STEPS: usize = 6;

#[derive(Clone, Copy)]
struct Sharpness {
    least: f32,
    times: f32,
}

impl Sharpness {
    fn is_met(self, step: f32, beside: f32) -> bool {
        step >= self.least && beside <= MOST_BESIDE && step >= self.times * beside
    }
}

/// The links without those across creases; `None` where there are no creases.
///
/// * `nbar`: n̄_x, n̄_y.
pub fn smooth_links(links: &Plane<u8>, nbar: [&Plane<f32>; 2]) -> Option<Plane<u8>> {
    let maps = NormalSteps { links, nbar };
    let mut steps = Plane::full(links.size(), 0u8);
    let width = links.width().max(1);
    parallel::for_each_row(steps.values_mut(), width, 1, |y, row| maps.flags_of_row(y, row));
    keep_chains(&mut steps, links);
    maps.close_corners(&mut steps);
    if steps.values().iter().all(|&flags| flags & ANY_CREASE == 0) {
        return None;
    }
    let is_crease = |x: usize, y: usize, axis: Axis| steps.at(x, y) >> axis.shift() & CREASE != 0;
    Some(Plane::from_fn(links.size(), |x, y| {
        let mut linked = links.at(x, y);
        let mut cut = |bit: u8, is: bool| linked &= if is { !bit } else { u8::MAX };
        cut(links::RIGHT, is_crease(x, y, Axis::Across));
        cut(links::DOWN, is_crease(x, y, Axis::Down));
        cut(links::LEFT, x > 0 && is_crease(x.saturating_sub(1), y, Axis::Across));
        cut(links::UP, y > 0 && is_crease(x, y.saturating_sub(1), Axis::Down));
        linked
    }))
}

/// Flags of the step from a pixel to its right neighbor; those of the step to the pixel below
/// follow.
const CREASE: u8 = 1;
const LIKELY_CREASE: u8 = 2;
const ANY_CREASE: u8 = CREASE | CREASE << 2;
const ANY: u8 = 15;

#[derive(Clone, Copy, PartialEq)]
enum Axis {
    Across,
    Down,
}

impl Axis {
    fn shift(self) -> u8 {
        if self == Axis::Across { 0 } else { 2 }
    }
}

/// Turns likely creases into creases where they touch one, over the eight neighbors of a pixel,
/// and drops what is too short, unless it closes a gap in the line of a jump: that fades where two
/// bodies run into each other.
fn keep_chains(steps: &mut Plane<u8>, links: &Plane<u8>) {
    let width = steps.width();
    let at = |i: usize| ((i % width) as i32, (i / width) as i32);
    let mut seeds: Vec<usize> =
        (0..steps.values().len()).filter(|&i| steps.values()[i] != 0).collect();
    let mut seen = HashSet::new();
    while let Some(seed) = seeds.pop() {
        if !seen.insert(seed) {
            continue;
        }
        let (mut chain, mut next) = (vec![seed], 0);
        while next < chain.len() {
            let (x, y) = at(chain[next]);
            for (x, y) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy))) {
                let is_step = steps.get(x, y).is_some_and(|flags| flags & ANY != 0);
                if is_step && seen.insert(y as usize * width + x as usize) {
                    chain.push(y as usize * width + x as usize);
                }
            }
            next += 1;
        }
        let is_certain = chain.iter().any(|&i| steps.values()[i] & ANY_CREASE != 0);
        let ends = || -> HashSet<(i32, i32)> {
            let corners = chain.iter().flat_map(|&i| corners_of(at(i), steps.values()[i]));
            corners.filter(|corner| is_at_jump(links, *corner)).collect()
        };
        let is_kept = is_certain && chain.len() >= LEAST_STEPS || ends().len() >= 2;
        for i in chain {
            let flags = &mut steps.values_mut()[i];
            *flags = if is_kept { (*flags | *flags >> 1) & ANY_CREASE } else { 0 };
        }
    }
}

/// The corners of pixels at which the flagged sides of a pixel end.
fn corners_of((x, y): (i32, i32), flags: u8) -> impl Iterator<Item = (i32, i32)> {
    let ends = |axis: Axis, from: (i32, i32)| {
        let is_flagged = flags >> axis.shift() & (CREASE | LIKELY_CREASE) != 0;
        is_flagged.then_some([from, (x + 1, y + 1)]).into_iter().flatten()
    };
    ends(Axis::Across, (x + 1, y)).chain(ends(Axis::Down, (x, y + 1)))
}

/// Whether a jump ends at a corner of pixels, or passes it.
fn is_at_jump(links: &Plane<u8>, (x, y): (i32, i32)) -> bool {
    let linked = |x: i32, y: i32| links.get(x, y).unwrap_or(0);
    let is_jump = |here: (i32, i32), link: u8, there: (i32, i32)| {
        let (here, there) = (linked(here.0, here.1), linked(there.0, there.1));
        here != 0 && there != 0 && here & link == 0
    };
    is_jump((x - 1, y - 1), links::RIGHT, (x, y - 1))
        || is_jump((x - 1, y), links::RIGHT, (x, y))
        || is_jump((x - 1, y - 1), links::DOWN, (x - 1, y))
        || is_jump((x, y - 1), links::DOWN, (x, y))
}

/// Whether the step after a pixel is cut.
fn is_cut(steps: &Plane<u8>, (x, y): (usize, usize), axis: Axis) -> bool {
    steps.at(x, y) >> axis.shift() & CREASE != 0
}

/// Whether a crease ends at a corner of pixels, or passes it.
fn is_at_crease(steps: &Plane<u8>, (x, y): (i32, i32)) -> bool {
    let is_cut = |x: i32, y: i32, axis: Axis| {
        steps.get(x, y).is_some_and(|flags| flags >> axis.shift() & CREASE != 0)
    };
    is_cut(x - 1, y - 1, Axis::Across)
        || is_cut(x - 1, y, Axis::Across)
        || is_cut(x - 1, y - 1, Axis::Down)
        || is_cut(x, y - 1, Axis::Down)
}

/// What a step from one pixel to the next is judged by.
struct NormalSteps<'m> {
    links: &'m Plane<u8>,
    nbar: [&'m Plane<f32>; 2],
}

crate::widest! {
    /// Which steps of n̄ from pixels to those after them may be as long as a likely crease's: the
    /// others certainly are not.
    fn may_turn(from: [&[f32]; 2], to: [&[f32]; 2], out: &mut [u8]) {
        let n = out.len();
        let ([ax, ay], [bx, by]) = (from.map(|row| &row[..n]), to.map(|row| &row[..n]));
        for x in 0..n {
            let (dx, dy) = (bx[x] - ax[x], by[x] - ay[x]);
            // A little less, so that rounding hides none.
            out[x] = u8::from(dx * dx + dy * dy > 0.99 * LIKELY.least * LIKELY.least);
        }
    }
}

impl NormalSteps<'_> {
    /// Cuts what turns as far as a crease between the ends of two: where three and more sides meet
    /// in a corner, no step has even ones before and after it.
    fn close_corners(&self, steps: &mut Plane<u8>) {
        let width = steps.width();
        let flagged = (0..steps.values().len()).filter(|&i| steps.values()[i] != 0);
        let around = |i: usize| {
            let (x, y) = ((i % width) as i32, (i / width) as i32);
            (-1..=1).flat_map(move |dy| (-1..=1).map(move |dx| (x + dx, y + dy)))
        };
        let mut near: Vec<(i32, i32)> = flagged.flat_map(around).collect();
        near.sort_unstable();
        near.dedup();
        let mut closed = Vec::new();
        for (x, y) in near.into_iter().filter(|&(x, y)| steps.get(x, y).is_some()) {
            let at = (x as usize, y as usize);
            for (axis, start) in [(Axis::Across, (x + 1, y)), (Axis::Down, (x, y + 1))] {
                let turns = |next| self.nbar(at).distance(self.nbar(next)) >= CERTAIN.least;
                if !is_cut(steps, at, axis)
                    && [start, (x + 1, y + 1)].into_iter().all(|end| is_at_crease(steps, end))
                    && self.pixel_after(at, axis).is_some_and(turns)
                {
                    closed.push((at, CREASE << axis.shift()));
                }
            }
        }
        for ((x, y), flag) in closed {
            steps.set(x, y, steps.at(x, y) | flag);
        }
    }

    /// The flags of the steps after the pixels of a row.
    fn flags_of_row(&self, y: usize, row: &mut [u8]) {
        let w = row.len();
        let nbar = |y: usize| self.nbar.map(|plane| plane.row(y));
        let mut may = vec![0; w];
        let judge = |axis: Axis, may: &[u8], row: &mut [u8]| {
            for x in (0..may.len()).filter(|&x| may[x] != 0) {
                row[x] |= self.flags((x, y), axis) << axis.shift();
            }
        };
        may_turn(nbar(y), nbar(y).map(|row| &row[1..]), &mut may[..w - 1]);
        judge(Axis::Across, &may[..w - 1], row);
        if y + 1 < self.links.height() {
            may_turn(nbar(y), nbar(y + 1), &mut may);
            judge(Axis::Down, &may, row);
        }
    }

    fn nbar(&self, (x, y): (usize, usize)) -> Vec2 {
        vec2(self.nbar[0].at(x, y), self.nbar[1].at(x, y))
    }

    fn pixel_after(&self, (x, y): (usize, usize), axis: Axis) -> Option<(usize, usize)> {
        let bit = if axis == Axis::Across { links::RIGHT } else { links::DOWN };
        let next = if axis == Axis::Across { (x + 1, y) } else { (x, y + 1) };
        (self.links.at(x, y) & bit != 0).then_some(next)
    }

    fn pixel_before(&self, (x, y): (usize, usize), axis: Axis) -> Option<(usize, usize)> {
        let bit = if axis == Axis::Across { links::LEFT } else { links::UP };
        let last =
            if axis == Axis::Across { (x.wrapping_sub(1), y) } else { (x, y.wrapping_sub(1)) };
        (self.links.at(x, y) & bit != 0).then_some(last)
    }

    /// Whether the step after a pixel crosses a crease, or is likely to.
    fn flags(&self, at: (usize, usize), axis: Axis) -> u8 {
        let Some(next) = self.pixel_after(at, axis) else { return 0 };
        let (here, there) = (self.nbar(at), self.nbar(next));
        let step = here.distance(there);
        // Half of a mixed step may be shorter than the whole.
        if step < LIKELY.least {
            return 0;
        }
        let before = self.pixel_before(at, axis).map(|at| (at, self.nbar(at)));
        let after = self.pixel_after(next, axis).map(|at| (at, self.nbar(at)));
        let sharp = |step: f32, beside: [Option<f32>; 2]| {
            let longest = beside.into_iter().flatten().reduce(f32::max);
            match longest {
                Some(beside) if CERTAIN.is_met(step, beside) => CREASE,
                Some(beside) if LIKELY.is_met(step, beside) => LIKELY_CREASE,
                _ => 0,
            }
        };
        let alone =
            sharp(step, [before.map(|b| b.1.distance(here)), after.map(|a| a.1.distance(there))]);
        // Over a mixed pixel at the step's end, or at its start: its longer half is where the
        // crease is.
        let over = |from: Vec2, mixed: Vec2, to: Vec2, beside: [Option<f32>; 2]| {
            let (whole, halves) = (from.distance(to), [from.distance(mixed), mixed.distance(to)]);
            let is_between = halves[0] + halves[1] < DETOUR * whole;
            if is_between && step >= halves[0].max(halves[1]) { sharp(whole, beside) } else { 0 }
        };
        let from_before = before.map(|b| b.1.distance(here));
        let ahead = after.map_or(0, |(at, nbar)| {
            let beyond = self.pixel_after(at, axis).map(|at| self.nbar(at).distance(nbar));
            over(here, there, nbar, [from_before, beyond])
        });
        let behind = before.map_or(0, |(at, nbar)| {
            let earlier = self.pixel_before(at, axis).map(|at| self.nbar(at).distance(nbar));
            over(nbar, here, there, [earlier, after.map(|a| a.1.distance(there))])
        });
        let all = alone | ahead | behind;
        if all & CREASE != 0 { CREASE } else { all }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec3, vec3};

    const SIZE: Size = Size::new(40, 30);

    /// The columns and rows of the right steps that are cut.
    fn cut(normal: impl Fn(usize, usize) -> Vec3 + Sync) -> Vec<(usize, usize)> {
        cut_beside(|_, _| false, normal)
    }

    /// The same, with jumps after some pixels.
    fn cut_beside(
        jumps: impl Fn(usize, usize) -> bool + Sync,
        normal: impl Fn(usize, usize) -> Vec3 + Sync,
    ) -> Vec<(usize, usize)> {
        let all = Plane::from_fn(SIZE, |x, y| {
            let side = |bit: u8, is: bool| if is { bit } else { 0 };
            let (left, right) = (x > 0 && !jumps(x - 1, y), x < 39 && !jumps(x, y));
            side(links::LEFT, left)
                | side(links::RIGHT, right)
                | side(links::UP, y > 0)
                | side(links::DOWN, y < 29)
        });
        let of = |axis: usize| Plane::from_fn(SIZE, |x, y| normal(x, y).normalize()[axis]);
        let [x, y] = [of(0), of(1)];
        let Some(smooth) = smooth_links(&all, [&x, &y]) else { return Vec::new() };
        let at = (0..30).flat_map(|y| (0..40).map(move |x| (x, y)));
        at.filter(|&(x, y)| all.at(x, y) & links::RIGHT != smooth.at(x, y) & links::RIGHT).collect()
    }

    #[test]
    fn rows_are_judged_as_each_of_their_steps() {
        let value = |seed: u32| {
            Plane::from_fn(SIZE, move |x, y| {
                let (x, y) = (x as u32 / 3, y as u32 / 4);
                0.5 * crate::math::hash::unit(seed, x, y)
                    + if (x + y) % 3 == 0 { 0.12 } else { 0.0 }
            })
        };
        let (links, nx, ny) = (Plane::full(SIZE, 15u8), value(1), value(2));
        let links = links.updated(|x, y, all| {
            let off = |bit: u8, is: bool| if is { bit } else { 0 };
            all & !(off(links::LEFT, x == 0)
                | off(links::RIGHT, x == 39)
                | off(links::UP, y == 0)
                | off(links::DOWN, y == 29))
        });
        let maps = NormalSteps { links: &links, nbar: [&nx, &ny] };
        let mut seen = 0;
        for y in 0..30 {
            let mut row = [0; 40];
            maps.flags_of_row(y, &mut row);
            for (x, found) in row.into_iter().enumerate() {
                let flags = maps.flags((x, y), Axis::Across)
                    | maps.flags((x, y), Axis::Down) << Axis::Down.shift();
                assert_eq!(found, flags, "{x} {y}");
                seen += u32::from(flags != 0);
            }
        }
        assert!(seen > 50, "{seen}");
    }

    #[test]
    fn a_roof_is_cut_at_its_ridge_alone() {
        let roof = |x: usize, _| vec3(if x < 20 { -0.5 } else { 0.5 }, 0.0, 1.0);
        assert_eq!(cut(roof), (0..30).map(|y| (19, y)).collect::<Vec<_>>());
    }

    #[test]
    fn a_gap_in_the_line_of_a_jump_is_cut_however_slight_the_turn() {
        let roof = |x: usize, _: usize| vec3(if x < 20 { -0.08 } else { 0.08 }, 0.0, 1.0);
        let broken = |x: usize, y: usize| x == 19 && !(10..12).contains(&y);
        assert_eq!(cut_beside(broken, roof), [(19, 10), (19, 11)]);
        let ending = |x: usize, y: usize| x == 19 && y < 10;
        assert_eq!(cut_beside(ending, roof), [], "nothing so slight goes on beyond the jump");
    }

    #[test]
    fn a_ridge_that_a_renderer_mixed_in_a_pixel_is_cut_at_its_longer_half() {
        let roof = |x: usize, _| vec3([-0.5, -0.2, 0.5][(x + 1).clamp(19, 21) - 19], 0.0, 1.0);
        assert_eq!(cut(roof), (0..30).map(|y| (19, y)).collect::<Vec<_>>());
    }

    #[test]
    fn creases_that_meet_are_cut_up_to_their_corner() {
        let pyramid = |x: usize, y: usize| {
            let p = vec2(x as f32 - 19.2, y as f32 - 14.7).rotate(Vec2::from_angle(0.3));
            let across = p.x.abs() > p.y.abs();
            vec3(
                if across { p.x.signum() } else { 0.0 },
                if across { 0.0 } else { p.y.signum() },
                1.6,
            )
        };
        let turns = |&(x, y): &(usize, usize)| pyramid(x, y) != pyramid(x + 1, y);
        let at = (0..30).flat_map(|y| (0..39).map(move |x| (x, y)));
        assert_eq!(cut(pyramid), at.filter(turns).collect::<Vec<_>>());
    }

    #[test]
    fn round_bodies_and_noise_have_no_creases() {
        let ball = |x: usize, y: usize| {
            let p = vec2(x as f32 - 19.5, y as f32 - 14.5) / 24.0;
            p.extend((1.0 - p.length_squared()).max(1e-4).sqrt())
        };
        assert_eq!(cut(ball), []);
        let noise = |x: usize, y: usize| {
            let wave = |k: f32| (x as f32 * 12.9898 * k + y as f32 * 78.233).sin() * 43_758.547;
            vec3(wave(1.0).fract() * 0.6, wave(2.0).fract() * 0.6, 1.0)
        };
        assert!(cut(noise).len() < 12, "{:?}", cut(noise));
    }
}
