//! Blurs around a point: along circles, and toward it. Floor 3. On premultiplied encoded pixels.
//!
//! A part of the picture is read on circles and rays around the point, at most a pixel apart; the
//! means along them are running sums, and a pixel is read between two of them. Circles and rays lie
//! where they would for the whole picture.

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
        let half = (0.25 * self.angle.to_radians()).max(0.0).min(0.5 * PI);
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
        let mut points = Vec::new();
        let mut read = Vec::new();
        let circle = |radius: i32| {
            let step = ray_step(radius as f32);
            let line = BoxLine::new(0.5 * ((turn / step).max(1.0) - 1.0));
            let (from, to) = part.rays_on_circle(radius as f32, step);
            let margin = line.margin() as i32;
            points.clear();
            let directions = directions(step, from - margin..to + margin);
            points.extend(directions.map(|along| center + radius as f32 * along));
            read_points(&window, &points, &mut read);
            let mut means = vec![[0.0; 4]; (to - from) as usize];
            line.means(&read, &mut means);
            PolarLine { first: from as f32, per_unit: 1.0 / step, means }
        };
        let circles: Vec<PolarLine> = (first..last).map(circle).collect();
        let circles = PolarLines { lines: &circles, first: first as f32, per_unit: 1.0 };
        part.read(place.out, |square, all| read_circles(&part, &circles, square, all))
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
        let half = 0.5 * (self.amount / 100.0).max(0.0);
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
        let mut points = Vec::new();
        let (mut read, mut sums) = (Vec::new(), Vec::new());
        let ray = |along: Vec2| {
            let (first, last) = part.rings_on_ray(along);
            let [near, far] = [(first, 1.0 - 0.5 * share), (last, 1.0 + 0.5 * share)]
                .map(|(radius, factor)| radius as f32 * factor);
            let (near, far) = (near.floor() as i32 - 1, far.ceil() as i32 + 1);
            points.clear();
            points.extend((near..far).map(|radius| center + radius as f32 * along));
            read_points(&window, &points, &mut read);
            sum_up(&read, &mut sums);
            let mut means = Vec::with_capacity((last - first) as usize);
            zoom_means(&sums, (near, first, last), share, &mut means);
            PolarLine { first: first as f32, per_unit: 1.0, means }
        };
        let rays: Vec<PolarLine> = directions(step, from..to).map(ray).collect();
        let rays = PolarLines { lines: &rays, first: from as f32, per_unit: 1.0 / step };
        part.read(place.out, |square, all| read_rays(&part, &rays, square, all))
    }
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

/// Unit, at multiples of an angle, image axes.
fn directions(step: f32, rays: Range<i32>) -> impl Iterator<Item = Vec2> {
    // Each is the one before, turned: in f64 the error stays below 1e-12.
    let step = f64::from(step);
    let (mut at, turned) =
        (DVec2::from_angle(f64::from(rays.start) * step), DVec2::from_angle(step));
    rays.map(move |_| {
        let now = at;
        at = turned.rotate(at);
        now.as_vec2()
    })
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

    /// The distance of a pixel's center, px, and its angle.
    #[inline(always)]
    fn place(&self, x: i32, y: i32) -> (f32, f32) {
        let away = vec2(x as f32 + 0.5, y as f32 + 0.5) - self.center;
        let angle = fast::atan2(away.y, away.x);
        (away.length(), self.middle + angle_between(angle, self.middle))
    }
}

/// From one angle to another, both of `[−π, π]`, within half a turn.
#[inline(always)]
fn angle_between(angle: f32, from: f32) -> f32 {
    let turn = angle - from;
    if turn > PI {
        turn - TAU
    } else if turn < -PI {
        turn + TAU
    } else {
        turn
    }
}

/// The means along a circle or a ray.
struct PolarLine {
    /// The place of the first one.
    first: f32,
    /// How many there are in a unit of places.
    per_unit: f32,
    means: Vec<[f32; 4]>,
}

impl PolarLine {
    #[inline(always)]
    fn at(&self, place: f32) -> [f32; 4] {
        let last = self.means.len() - 2;
        let at = (place * self.per_unit - self.first).max(0.0);
        let whole = (at as usize).min(last);
        mix(self.means[whole], self.means[whole + 1], at - whole as f32)
    }
}

/// Lines side by side, two at least.
struct PolarLines<'a> {
    lines: &'a [PolarLine],
    /// The place of the first one.
    first: f32,
    /// How many there are in a unit of places.
    per_unit: f32,
}

impl PolarLines<'_> {
    /// Between two of them.
    #[inline(always)]
    fn at(&self, across: f32, along: f32) -> [f32; 4] {
        let at = (across * self.per_unit - self.first).max(0.0);
        let whole = (at as usize).min(self.lines.len() - 2);
        let (low, high) = (&self.lines[whole], &self.lines[whole + 1]);
        mix(low.at(along), high.at(along), at - whole as f32)
    }
}

crate::widest! {
    /// The pixels of a rectangle between circles.
    fn read_circles(part: &PolarPart, circles: &PolarLines, out: Rect, all: &mut Vec<[f32; 4]>) {
        for y in out.y0..out.y1 {
            for x in out.x0..out.x1 {
                let (r, angle) = part.place(x, y);
                all.push(circles.at(r, angle));
            }
        }
    }

    /// The pixels of a rectangle between rays.
    fn read_rays(part: &PolarPart, rays: &PolarLines, out: Rect, all: &mut Vec<[f32; 4]>) {
        for y in out.y0..out.y1 {
            for x in out.x0..out.x1 {
                let (r, angle) = part.place(x, y);
                all.push(rays.at(angle, r));
            }
        }
    }

    /// A picture at some points.
    fn read_points(window: &FilterWindow, points: &[Vec2], read: &mut Vec<[f32; 4]>) {
        read.clear();
        for at in points {
            read.push(window.sample(at.x, at.y));
        }
    }

    /// The means along a ray at whole radii, each as wide as a share of its radius.
    ///
    /// * `radii`: of the first sum, and of the means.
    fn zoom_means(sums: &[[f32; 4]], radii: (i32, i32, i32), share: f32, means: &mut Vec<[f32; 4]>) {
        let (near, first, last) = radii;
        for radius in first..last {
            let width = (share * radius as f32).max(1.0);
            means.push(mean_between(sums, (radius - near) as f32, width));
        }
    }

    /// The sums of all values before each.
    fn sum_up(values: &[[f32; 4]], sums: &mut Vec<[f32; 4]>) {
        sums.clear();
        let mut sum = [0.0; 4];
        sums.push(sum);
        for value in values {
            for k in 0..4 {
                sum[k] += value[k];
            }
            sums.push(sum);
        }
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
