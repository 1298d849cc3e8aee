//! A part of a picture in distances and angles: which circles and rays meet it, their directions, and
//! pixels read between lines. Floor 3.

use crate::math::{DVec2, Rect, Vec2, fast, vec2};
use crate::paint::filter::blur::mix;
use std::f32::consts::{PI, TAU};
use std::ops::Range;

/// The angle between two rays that are at most a pixel apart at a distance from the center; a whole
/// circle has a whole number of them. Distances that are about the same have the same rays.
pub fn ray_step(distance: f32) -> f32 {
    let least = TAU * distance.max(8.0);
    // Four, five, six or seven times a power of two.
    let unit = (least.log2().floor() - 2.0).exp2();
    TAU / ((least / unit).ceil() * unit)
}

/// Unit, at multiples of an angle, image axes; those that were found last are known.
#[derive(Default)]
pub struct KnownDirections {
    step: f32,
    first: i32,
    known: Vec<Vec2>,
}

impl KnownDirections {
    pub fn at(&mut self, step: f32, rays: Range<i32>) -> &[Vec2] {
        let last = self.first + self.known.len() as i32;
        if step != self.step || rays.start < self.first || rays.end > last {
            // The next circle has some more.
            let more = rays.len() as i32 / 8 + 8;
            (self.step, self.first) = (step, rays.start - more);
            // Each is the one before, turned: in f64 the error stays below 1e-12.
            let step = f64::from(step);
            let (mut at, turned) =
                (DVec2::from_angle(f64::from(self.first) * step), DVec2::from_angle(step));
            self.known.clear();
            self.known.extend((self.first..rays.end + more).map(|_| {
                let now = at;
                at = turned.rotate(at);
                now.as_vec2()
            }));
        }
        let from = (rays.start - self.first) as usize;
        &self.known[from..from + rays.len()]
    }
}

/// A part of a picture, seen from a point.
pub struct PolarPart {
    center: Vec2,
    /// Distances of its nearest point and of its farthest, px.
    near: f32,
    pub far: f32,
    /// Angles are within half a turn of this one.
    middle: f32,
    /// How far it reaches from there to both sides, radians.
    pub span: f32,
    /// Its corners, from the center.
    low: Vec2,
    high: Vec2,
}

impl PolarPart {
    /// The pixels of a rectangle; `None` if there are none.
    pub fn new(out: Rect, center: Vec2) -> Option<Self> {
        if out.is_empty() {
            return None;
        }
        let corners = [(out.x0, out.y0), (out.x1, out.y0), (out.x0, out.y1), (out.x1, out.y1)]
            .map(|(x, y)| vec2(x as f32, y as f32) - center);
        let far = corners.iter().map(|c| c.length()).fold(0.0, f32::max);
        let nearest = vec2(
            center.x.max(out.x0 as f32).min(out.x1 as f32),
            center.y.max(out.y0 as f32).min(out.y1 as f32),
        );
        let near = (nearest - center).length();
        let middle = (corners[0] + corners[3]).to_angle();
        let away = |corner: &Vec2| angle_between(corner.to_angle(), middle).abs();
        let span = if near < 2.0 { PI } else { corners.iter().map(away).fold(0.0, f32::max) };
        Some(Self { center, near, far, middle, span, low: corners[0], high: corners[3] })
    }

    /// Whole radii of all of it, one beyond its own at each end.
    pub fn rings(&self) -> (i32, i32) {
        (self.near.floor() as i32 - 1, self.far.ceil() as i32 + 2)
    }

    /// The radii at which a ray passes it, grown by two pixels.
    pub fn rings_on_ray(&self, along: Vec2) -> (i32, i32) {
        // Where it enters and leaves between both sides, across and down.
        let steep = |v: f32| if v.abs() < 1e-9 { 1e-9 } else { v };
        let along = vec2(steep(along.x), steep(along.y));
        let [a, b] = [self.low - 2.0, self.high + 2.0].map(|corner| corner / along);
        let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
        let (first, last) = self.rings();
        // A ray that touches a corner is read around that.
        let enters = enters.max(first as f32).min(last as f32);
        let leaves = leaves.max(enters).min(last as f32);
        ((enters.floor() as i32 - 2).max(first), leaves.ceil() as i32 + 3)
    }

    /// Rays so far apart, within an angle to both sides of its middle, and one beyond each end.
    pub fn rays(&self, span: f32, step: f32) -> (i32, i32) {
        let [low, high] = [-span, span].map(|to| (self.middle + to) / step);
        (low.floor() as i32 - 1, high.ceil() as i32 + 2)
    }

    /// Those of a circle that meet it.
    pub fn rays_on_circle(&self, radius: f32, step: f32) -> (i32, i32) {
        // Where the circle crosses its sides, grown by two pixels.
        let (low, high) = (self.low - 2.0, self.high + 2.0);
        let is_inside = |p: Vec2| (low - 0.1).cmple(p).all() && p.cmple(high + 0.1).all();
        let mut reach: Option<(f32, f32)> = None;
        for (along, is_across) in [(low.x, true), (high.x, true), (low.y, false), (high.y, false)] {
            let other = radius * radius - along * along;
            if other < 0.0 {
                continue;
            }
            for other in [other.sqrt(), -other.sqrt()] {
                let at = if is_across { vec2(along, other) } else { vec2(other, along) };
                if is_inside(at) {
                    let angle = angle_between(at.to_angle(), self.middle);
                    let (least, most) = reach.unwrap_or((angle, angle));
                    reach = Some((least.min(angle), most.max(angle)));
                }
            }
        }
        // A circle that crosses none lies within it, or beside it, and one around the center may
        // pass behind it.
        let Some((least, most)) = reach.filter(|_| self.span < 0.5 * PI) else {
            return self.rays(self.span, step);
        };
        let (low, high) = ((self.middle + least) / step, (self.middle + most) / step);
        (low.floor() as i32 - 1, high.ceil() as i32 + 2)
    }

    /// The pixels of a rectangle, row by row, read square by square: the lines that cross a square
    /// fit into the processor's cache.
    pub fn read(&self, out: Rect, put: impl Fn(Rect, &mut Vec<[f32; 4]>)) -> Vec<[f32; 4]> {
        const SIDE: i32 = 64;
        let width = out.width();
        let mut all = vec![[0.0; 4]; width * out.height()];
        let mut square = Vec::new();
        for y in (out.y0..out.y1).step_by(SIDE as usize) {
            for x in (out.x0..out.x1).step_by(SIDE as usize) {
                let rect = Rect::new(x, y, x + SIDE, y + SIDE).intersect(out);
                square.clear();
                put(rect, &mut square);
                let first = (y - out.y0) as usize * width + (x - out.x0) as usize;
                let rows = all[first..].chunks_mut(width);
                for (row, pixels) in rows.zip(square.chunks_exact(rect.width())) {
                    row[..pixels.len()].copy_from_slice(pixels);
                }
            }
        }
        all
    }
}

/// From one angle to another, both of `[−π, π]`, within half a turn.
#[inline(always)]
fn angle_between(angle: f32, from: f32) -> f32 {
    let turn = angle - from;
    let turn = if turn > PI { turn - TAU } else { turn };
    if turn < -PI { turn + TAU } else { turn }
}

/// Where the means along a circle or a ray are.
struct PolarLine {
    /// The number of the first one among those of all lines.
    start: u32,
    /// The last but one of its own, counted from 0.
    last: f32,
    /// The place of the first one.
    first: f32,
    /// How many there are in a unit of places.
    per_unit: f32,
}

/// Lines side by side, two at least.
pub struct PolarLines {
    lines: Vec<PolarLine>,
    means: Vec<[f32; 4]>,
    /// The place of the first one.
    first: f32,
    /// How many there are in a unit of places.
    per_unit: f32,
}

impl PolarLines {
    pub fn new(first: f32, per_unit: f32) -> Self {
        Self { lines: Vec::new(), means: Vec::new(), first, per_unit }
    }

    /// Adds a line; its means, to be found.
    pub fn add(&mut self, first: f32, per_unit: f32, count: usize) -> &mut [[f32; 4]] {
        let start = self.means.len();
        let last = count as f32 - 2.0;
        self.lines.push(PolarLine { start: start as u32, last, first, per_unit });
        self.means.resize(start + count, [0.0; 4]);
        &mut self.means[start..]
    }

    /// Between two lines, and between two means of each.
    #[inline(always)]
    fn at(&self, across: f32, along: f32) -> [f32; 4] {
        let last = (self.lines.len() - 2) as f32;
        let at = (across * self.per_unit - self.first).max(0.0).min(last + 1.0);
        let whole = at.floor().min(last);
        let pair = &self.lines[whole as i32 as usize..][..2];
        mix(self.on(&pair[0], along), self.on(&pair[1], along), at - whole)
    }

    #[inline(always)]
    fn on(&self, line: &PolarLine, along: f32) -> [f32; 4] {
        let at = (along * line.per_unit - line.first).max(0.0).min(line.last + 1.0);
        let whole = at.floor().min(line.last);
        let pair = &self.means[line.start as usize + whole as i32 as usize..][..2];
        mix(pair[0], pair[1], at - whole)
    }
}

crate::widest! {
    /// The pixels of a rectangle, at most 64 wide, between circles or rays.
    pub fn read_lines(
        part: &PolarPart,
        lines: &PolarLines,
        are_circles: bool,
        out: Rect,
        all: &mut Vec<[f32; 4]>
    ) {
        let (mut radii, mut angles) = ([0.0f32; 64], [0.0f32; 64]);
        let width = out.width().min(64);
        for y in out.y0..out.y1 {
            let down = y as f32 + 0.5 - part.center.y;
            let first = out.x0 as f32 + 0.5 - part.center.x;
            place_row((first, down), part.middle, &mut radii, &mut angles);
            let places = radii[..width].iter().zip(&angles[..width]);
            if are_circles {
                for (r, angle) in places {
                    all.push(lines.at(*r, *angle));
                }
            } else {
                for (r, angle) in places {
                    all.push(lines.at(*angle, *r));
                }
            }
        }
    }
}

/// Distances and angles of the pixels of a row.
///
/// * `first`: the center of the first one, from the point.
/// * `middle`: the angle that others are within half a turn of.
#[inline(always)]
fn place_row(first: (f32, f32), middle: f32, radii: &mut [f32; 64], angles: &mut [f32; 64]) {
    let (across, down) = first;
    for (i, (radius, angle)) in radii.iter_mut().zip(angles).enumerate() {
        let x = across + i as f32;
        *radius = (x * x + down * down).sqrt();
        *angle = middle + angle_between(fast::atan2(down, x), middle);
    }
}
