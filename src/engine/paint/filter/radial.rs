//! Blurs around a point: along circles, and toward it. Floor 3. On premultiplied encoded pixels.
//!
//! A part of the picture is read on circles and rays around the point, at most a pixel apart; the
//! means along them are running sums, and a pixel is read between two of them. Means of many readings
//! hardly differ from one to the next, so only some of them are kept. Circles and rays lie where they
//! would for the whole picture.

use super::blur::{BoxLine, mix};
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::{DVec2, Rect, Vec2, fast, vec2};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use std::f32::consts::{PI, TAU};
use std::ops::Range;

/// A point of a picture, percent of its width and height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlurCenter {
    /// From the left.
    pub x: f32,
    /// From the top.
    pub y: f32,
}

impl Default for BlurCenter {
    fn default() -> Self {
        Self { x: 50.0, y: 50.0 }
    }
}

impl BlurCenter {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let number = |name| NumberParameter::whole(name, -100.0, 200.0, 50.0).decimals(1);
        let x = parameter_name("x", "Center across", "Percent of the width, from the left");
        v.number(number(x), &mut self.x);
        let y = parameter_name("y", "Center down", "Percent of the height, from the top");
        v.number(number(y), &mut self.y);
    }

    /// In px.
    fn at(&self, bounds: Rect) -> Vec2 {
        let share = vec2(self.x, self.y) / 100.0;
        let size = vec2(bounds.width() as f32, bounds.height() as f32);
        vec2(bounds.x0 as f32, bounds.y0 as f32) + share * size
    }
}

/// As if the picture turned about a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinBlur {
    /// How far it turns, degrees.
    pub angle: f32,
    /// What it turns about.
    pub center: BlurCenter,
}

impl Default for SpinBlur {
    fn default() -> Self {
        Self { angle: 10.0, center: BlurCenter::default() }
    }
}

impl Parameters for SpinBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let angle = parameter_name("angle", "Angle", "How far it turns, degrees");
        let angle = NumberParameter::whole(angle, 0.0, 360.0, 10.0).decimals(1);
        v.number(angle, &mut self.angle);
        self.center.visit(v);
    }
}

impl FilterKernel for SpinBlur {
    fn reach(&self, near: Rect, bounds: Rect) -> f32 {
        // The chord of half of the turn, and of a sixteenth of it that the last mean may be farther.
        let half = (0.2813 * self.angle.to_radians()).max(0.0).min(0.5 * PI);
        2.0 * farthest(near, self.center.at(bounds)) * half.sin() + 4.0
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let turn = self.angle.to_radians().min(TAU);
        let center = self.center.at(source.bounds());
        let Some(part) = PolarPart::new(place.out, center).filter(|_| turn > 0.0) else {
            return source.window(place.out).cropped(place.out);
        };
        let window = window_around(self, place, source);
        let (first, last) = part.rings();
        let mut directions = KnownDirections::default();
        let mut read = Vec::new();
        let mut circles = PolarLines::new(first as f32, 1.0);
        for radius in first..last {
            let step = ray_step(radius as f32);
            let count = (turn / step).max(1.0);
            let line = BoxLine::new(0.5 * (count - 1.0));
            let apart = step_between(count);
            let (from, to) = part.rays_on_circle(radius as f32, step);
            let kept = count_kept(to - from, apart);
            let margin = line.margin() as i32;
            let readings = from - margin..from + (kept as i32 - 1) * apart as i32 + 1 + margin;
            read.resize(readings.len(), [0.0; 4]);
            let along = directions.at(step, readings);
            read_circle(&window, center, radius as f32, along, &mut read);
            let per_unit = 1.0 / (step * apart as f32);
            let means = circles.add(from as f32 / apart as f32, per_unit, kept);
            line.means_apart(&read, apart, means);
        }
        part.read(place.out, |square, all| read_lines(&part, &circles, true, square, all))
    }
}

/// As if the camera came nearer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZoomBlur {
    /// How much, percent of the distance from the center.
    pub amount: f32,
    /// What it nears.
    pub center: BlurCenter,
}

impl Default for ZoomBlur {
    fn default() -> Self {
        Self { amount: 20.0, center: BlurCenter::default() }
    }
}

impl Parameters for ZoomBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let hint = "Length of the way, percent of the distance from the center";
        let amount =
            NumberParameter::whole(parameter_name("amount", "Amount", hint), 0.0, 100.0, 20.0);
        v.number(amount, &mut self.amount);
        self.center.visit(v);
    }
}

impl FilterKernel for ZoomBlur {
    fn reach(&self, near: Rect, bounds: Rect) -> f32 {
        // The last mean may be a sixteenth of the way farther out.
        let half = 0.6 * (self.amount / 100.0).max(0.0);
        half * farthest(near, self.center.at(bounds)) + 4.0
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let share = self.amount / 100.0;
        let center = self.center.at(source.bounds());
        let Some(part) = PolarPart::new(place.out, center).filter(|_| share > 0.0) else {
            return source.window(place.out).cropped(place.out);
        };
        let window = window_around(self, place, source);
        let step = ray_step(part.far);
        let (from, to) = part.rays(part.span, step);
        let (mut directions, mut read, mut sums) =
            (KnownDirections::default(), Vec::new(), Vec::new());
        let mut rays = PolarLines::new(from as f32, 1.0 / step);
        for along in directions.at(step, from..to) {
            let (first, last) = part.rings_on_ray(*along);
            let ray = RayColumns::new(center, *along);
            let (from, to) = (ray.column(first as f32), ray.column(last as f32) + 1);
            let apart = step_between(share * ray.along(from));
            let kept = count_kept(to - from, apart);
            let to = from + (kept as i32 - 1) * apart as i32 + 1;
            let near = (ray.along(from) * (1.0 - 0.5 * share)).floor() as i32 - 2;
            let far = (ray.along(to) * (1.0 + 0.5 * share)).ceil() as i32 + 2;
            read.resize((far - near).max(0) as usize, [0.0; 4]);
            read_ray(&window, &ray, near, &mut read);
            sum_up(&read, &mut sums);
            let means = rays.add(ray.along(from) / apart as f32, ray.per_px / apart as f32, kept);
            let width = (share, ray.along(0));
            zoom_means(&sums, (near, from, apart as i32), width, means);
        }
        part.read(place.out, |square, all| read_lines(&part, &rays, false, square, all))
    }
}

/// A ray that is read in the columns of pixels that it passes, or in the rows if it is steep: between
/// two pixels of each.
struct RayColumns {
    /// It passes more columns than rows.
    is_level: bool,
    /// Columns in a px of it.
    per_px: f32,
    /// How far the first column is from the center, columns, in `[0, 1)`.
    offset: f32,
    /// The first column, and 1 or −1 to the next.
    first: i32,
    toward: i32,
    /// Where it is in the first column, and how much farther in the next, pixels.
    across: f32,
    slope: f32,
}

impl RayColumns {
    fn new(center: Vec2, along: Vec2) -> Self {
        let is_level = along.x.abs() >= along.y.abs();
        let turned = |v: Vec2| if is_level { v } else { vec2(v.y, v.x) };
        let (center, along) = (turned(center), turned(along));
        let toward = if along.x < 0.0 { -1 } else { 1 };
        let sign = toward as f32;
        let offset = (sign * (0.5 - center.x)).rem_euclid(1.0);
        let (per_px, slope) = (along.x.abs(), along.y / along.x.abs());
        Self {
            is_level,
            per_px,
            offset,
            first: (center.x + sign * offset - 0.5).round() as i32,
            toward,
            across: center.y + slope * offset - 0.5,
            slope,
        }
    }

    /// How far a column is from the center, columns.
    fn along(&self, column: i32) -> f32 {
        column as f32 + self.offset
    }

    /// The column before a distance from the center, px.
    fn column(&self, radius: f32) -> i32 {
        (radius * self.per_px - self.offset).floor() as i32
    }
}

/// How far apart the means of so many readings are kept: a sixteenth of them changes little.
fn step_between(readings: f32) -> usize {
    (readings / 16.0).max(1.0).min(1e4) as usize
}

/// How many are kept of so many means, two at least; the last one is no farther in than these.
fn count_kept(means: i32, apart: usize) -> usize {
    (means.max(1) as usize - 1).div_ceil(apart).max(1) + 1
}

/// How far a rectangle reaches from a point, px.
fn farthest(rect: Rect, from: Vec2) -> f32 {
    let across = (rect.x0 as f32 - from.x).abs().max((rect.x1 as f32 - from.x).abs());
    across.hypot((rect.y0 as f32 - from.y).abs().max((rect.y1 as f32 - from.y).abs()))
}

/// What a kernel reads of a picture.
fn window_around(
    kernel: &dyn FilterKernel,
    place: &FilterPlace,
    source: &dyn FilterSource,
) -> FilterWindow {
    let reach = kernel.reach(place.out, source.bounds()).ceil() as i32;
    let reads = place.out.grown(reach).intersect(source.bounds().grown(1));
    source.window(if reads.is_empty() { place.out } else { reads })
}

/// The angle between two rays that are at most a pixel apart at a distance from the center; a whole
/// circle has a whole number of them. Distances that are about the same have the same rays.
fn ray_step(distance: f32) -> f32 {
    let least = TAU * distance.max(8.0);
    // Four, five, six or seven times a power of two.
    let unit = (least.log2().floor() - 2.0).exp2();
    TAU / ((least / unit).ceil() * unit)
}

/// Unit, at multiples of an angle, image axes; those that were found last are known.
#[derive(Default)]
struct KnownDirections {
    step: f32,
    first: i32,
    known: Vec<Vec2>,
}

impl KnownDirections {
    fn at(&mut self, step: f32, rays: Range<i32>) -> &[Vec2] {
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
struct PolarPart {
    center: Vec2,
    /// Distances of its nearest point and of its farthest, px.
    near: f32,
    far: f32,
    /// Angles are within half a turn of this one.
    middle: f32,
    /// How far it reaches from there to both sides, radians.
    span: f32,
    /// Its corners, from the center.
    low: Vec2,
    high: Vec2,
}

impl PolarPart {
    /// The pixels of a rectangle; `None` if there are none.
    fn new(out: Rect, center: Vec2) -> Option<Self> {
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
    fn rings(&self) -> (i32, i32) {
        (self.near.floor() as i32 - 1, self.far.ceil() as i32 + 2)
    }

    /// The radii at which a ray passes it, grown by two pixels.
    fn rings_on_ray(&self, along: Vec2) -> (i32, i32) {
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
    fn rays(&self, span: f32, step: f32) -> (i32, i32) {
        let [low, high] = [-span, span].map(|to| (self.middle + to) / step);
        (low.floor() as i32 - 1, high.ceil() as i32 + 2)
    }

    /// Those of a circle that meet it.
    fn rays_on_circle(&self, radius: f32, step: f32) -> (i32, i32) {
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
    fn read(&self, out: Rect, put: impl Fn(Rect, &mut Vec<[f32; 4]>)) -> Vec<[f32; 4]> {
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
struct PolarLines {
    lines: Vec<PolarLine>,
    means: Vec<[f32; 4]>,
    /// The place of the first one.
    first: f32,
    /// How many there are in a unit of places.
    per_unit: f32,
}

impl PolarLines {
    fn new(first: f32, per_unit: f32) -> Self {
        Self { lines: Vec::new(), means: Vec::new(), first, per_unit }
    }

    /// Adds a line; its means, to be found.
    fn add(&mut self, first: f32, per_unit: f32, count: usize) -> &mut [[f32; 4]] {
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
    fn read_lines(
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

    /// A picture on a circle.
    fn read_circle(
        window: &FilterWindow,
        center: Vec2,
        radius: f32,
        along: &[Vec2],
        read: &mut [[f32; 4]]
    ) {
        const SIDE: usize = 64;
        let (rect, pixels) = (window.rect(), window.pixels());
        let width = rect.width();
        if width < 2 || rect.height() < 2 {
            for (value, along) in read.iter_mut().zip(along) {
                *value = window.sample(center.x + radius * along.x, center.y + radius * along.y);
            }
            return;
        }
        // Beyond the window its border is repeated.
        let (right, bottom) = ((width - 1) as f32, (rect.height() - 1) as f32);
        let (left, top) = (rect.x0 as f32 + 0.5 - center.x, rect.y0 as f32 + 0.5 - center.y);
        let (mut firsts, mut shares) = ([0u32; SIDE], [[0.0f32; 2]; SIDE]);
        for (values, along) in read.chunks_mut(SIDE).zip(along.chunks(SIDE)) {
            let places = firsts.iter_mut().zip(&mut shares);
            for ((first, share), along) in places.zip(along) {
                let x = (radius * along.x - left).max(0.0).min(right);
                let y = (radius * along.y - top).max(0.0).min(bottom);
                let (i, j) = (x.floor().min(right - 1.0), y.floor().min(bottom - 1.0));
                *share = [x - i, y - j];
                *first = j as u32 * width as u32 + i as u32;
            }
            for (value, (first, [fx, fy])) in values.iter_mut().zip(firsts.iter().zip(&shares)) {
                let first = *first as usize;
                let (upper, lower) = (&pixels[first..first + 2], &pixels[first + width..][..2]);
                *value = mix(mix(upper[0], upper[1], *fx), mix(lower[0], lower[1], *fx), *fy);
            }
        }
    }

    /// A picture on a ray, from a column on.
    fn read_ray(window: &FilterWindow, ray: &RayColumns, from: i32, read: &mut [[f32; 4]]) {
        let (rect, pixels) = (window.rect(), window.pixels());
        let width = rect.width();
        // The first column and row, the last ones, and the way to the next pixel along and across.
        let (corner, last, steps) = match ray.is_level {
            true => ((rect.x0, rect.y0), (rect.x1 - 1 - rect.x0, rect.y1 - 1 - rect.y0), (1, width)),
            false => ((rect.y0, rect.x0), (rect.y1 - 1 - rect.y0, rect.x1 - 1 - rect.x0), (width, 1)),
        };
        let (first, across) = (ray.first - corner.0, ray.across - corner.1 as f32);
        let most = last.1 as f32;
        let before_last = (most - 1.0).max(0.0);
        let next = if last.1 > 0 { steps.1 } else { 0 };
        for (i, value) in read.iter_mut().enumerate() {
            let column = from + i as i32;
            let x = (first + ray.toward * column).max(0).min(last.0) as usize;
            let y = (across + ray.slope * column as f32).max(0.0).min(most);
            let whole = y.floor().min(before_last);
            let at = x * steps.0 + whole as usize * steps.1;
            *value = mix(pixels[at], pixels[at + next], y - whole);
        }
    }

    /// The means along a ray, each as wide as a share of its distance.
    ///
    /// * `columns`: of the first sum, of the first mean, and from one mean to the next.
    /// * `width`: the share, and how far the first column of the ray is from the center.
    fn zoom_means(
        sums: &[[f32; 4]],
        columns: (i32, i32, i32),
        width: (f32, f32),
        means: &mut [[f32; 4]]
    ) {
        let ((near, first, apart), (share, offset)) = (columns, width);
        for (i, mean) in means.iter_mut().enumerate() {
            let column = first + i as i32 * apart;
            let width = (share * (column as f32 + offset)).max(1.0);
            *mean = mean_between(sums, (column - near) as f32, width);
        }
    }

    /// The sums of all values before each.
    fn sum_up(values: &[[f32; 4]], sums: &mut Vec<[f32; 4]>) {
        sums.resize(values.len() + 1, [0.0; 4]);
        let mut sum = [0.0; 4];
        sums[0] = sum;
        for (total, value) in sums[1..].iter_mut().zip(values) {
            for k in 0..4 {
                sum[k] += value[k];
            }
            *total = sum;
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

/// The mean of some values around a place; they end at the last one.
#[inline(always)]
fn mean_between(sums: &[[f32; 4]], middle: f32, width: f32) -> [f32; 4] {
    let last = (sums.len() - 1) as f32;
    let hold = |v: f32| (v + 0.5).max(0.0).min(last);
    let (low, high) = (hold(middle - 0.5 * width), hold(middle + 0.5 * width));
    let sum_up_to = |at: f32| {
        let whole = (at as usize).min(sums.len() - 2);
        mix(sums[whole], sums[whole + 1], at - whole as f32)
    };
    let (before, behind) = (sum_up_to(low), sum_up_to(high));
    let per = 1.0 / (high - low).max(1e-3);
    let mut mean = [0.0; 4];
    for k in 0..4 {
        mean[k] = (behind[k] - before[k]) * per;
    }
    mean
}
