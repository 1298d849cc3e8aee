//! Blurs around a point: along circles, and toward it. Floor 3. On premultiplied encoded pixels.
//!
//! A part of the picture is read on circles and rays around the point, a pixel apart; the means
//! along them are differences of running sums, and a pixel is read between two of them.

use super::blur::mix;
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::{Rect, Vec2, fast, vec2};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use std::f32::consts::{PI, TAU};

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
        2.0 * farthest(near, self.center.at(bounds)) * half.sin() + 2.0
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let turn = self.angle.to_radians().min(TAU);
        let center = self.center.at(source.bounds());
        let Some(rays) = PolarPart::new(place.out, center, turn, 0.0).filter(|_| turn > 0.0) else {
            return source.window(place.out).cropped(place.out);
        };
        let window = rays.window(self, place, source);
        let (width, from) = ((turn / rays.step).max(1.0), rays.rings.0);
        let circles: Vec<RunningSums> =
            (rays.rings.0..=rays.rings.1).map(|r| rays.circle(&window, r as f32)).collect();
        place.map(|x, y| {
            let (r, u) = rays.place(x, y);
            let mean = |i: usize| circles[i.min(circles.len() - 1)].mean(u, width);
            let (whole, ring) = (r.floor(), (r.floor() as i32 - from).max(0) as usize);
            mix(mean(ring), mean(ring + 1), r - whole)
        })
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
        half * farthest(near, self.center.at(bounds)) + 2.0
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let share = self.amount / 100.0;
        let center = self.center.at(source.bounds());
        let Some(rays) = PolarPart::new(place.out, center, 0.0, share).filter(|_| share > 0.0)
        else {
            return source.window(place.out).cropped(place.out);
        };
        let window = rays.window(self, place, source);
        let lines: Vec<RunningSums> =
            rays.directions.iter().map(|along| rays.ray(&window, *along)).collect();
        place.map(|x, y| {
            let (r, u) = rays.place(x, y);
            let width = (share * r).max(1.0);
            let along = r - rays.rings.0 as f32;
            let mean = |j: usize| lines[j.min(lines.len() - 1)].mean(along, width);
            let whole = u.floor().max(0.0);
            mix(mean(whole as usize), mean(whole as usize + 1), u - whole)
        })
    }
}

/// How far a rectangle reaches from a point, px.
fn farthest(rect: Rect, from: Vec2) -> f32 {
    let across = (rect.x0 as f32 - from.x).abs().max((rect.x1 as f32 - from.x).abs());
    across.hypot((rect.y0 as f32 - from.y).abs().max((rect.y1 as f32 - from.y).abs()))
}

/// The circles and rays around a point that pass a part of a picture.
struct PolarPart {
    center: Vec2,
    /// Radii of the first circle and the last, whole px.
    rings: (i32, i32),
    /// The angle between two rays, and that of the first one.
    step: f32,
    first: f32,
    /// Unit, one for each ray.
    directions: Vec<Vec2>,
    /// Angles are told from this one, within half a turn.
    middle: f32,
}

impl PolarPart {
    /// For the pixels of a rectangle; `None` if there are none.
    ///
    /// * `turn`: how much farther rays are read, radians.
    /// * `share`: how much farther circles are read, of their radius.
    fn new(out: Rect, center: Vec2, turn: f32, share: f32) -> Option<Self> {
        if out.is_empty() {
            return None;
        }
        let corners = [(out.x0, out.y0), (out.x1, out.y0), (out.x0, out.y1), (out.x1, out.y1)]
            .map(|(x, y)| vec2(x as f32, y as f32) - center);
        let far = corners.iter().map(|c| c.length()).fold(0.0, f32::max);
        let holds = vec2(
            center.x.max(out.x0 as f32).min(out.x1 as f32),
            center.y.max(out.y0 as f32).min(out.y1 as f32),
        );
        let near = (holds - center).length();
        // A pixel or less apart at the farthest one, and the same for parts that are about as far.
        let step = TAU / (TAU * far.max(8.0)).log2().ceil().exp2();
        let middle = (corners[0] + corners[3]).to_angle();
        let span = match near < 2.0 {
            true => PI,
            false => corners
                .iter()
                .map(|c| angle_between(c.to_angle(), middle).abs())
                .fold(0.0, f32::max),
        };
        let half = span + 0.5 * turn + 2.0 * step;
        let first = ((middle - half) / step).floor() * step;
        let count = (2.0 * half / step).ceil() as usize + 3;
        let direction = |ray: usize| Vec2::from_angle(first + ray as f32 * step);
        Some(Self {
            center,
            rings: (
                (near * (1.0 - 0.5 * share)).floor() as i32 - 1,
                (far * (1.0 + 0.5 * share)).ceil() as i32 + 1,
            ),
            step,
            first,
            directions: (0..count).map(direction).collect(),
            middle,
        })
    }

    /// What the kernel reads of the picture.
    fn window(
        &self,
        kernel: &dyn FilterKernel,
        place: &FilterPlace,
        source: &dyn FilterSource,
    ) -> FilterWindow {
        let reach = kernel.reach(place.out, source.bounds()).ceil() as i32;
        let reads = place.out.grown(reach).intersect(source.bounds().grown(1));
        source.window(if reads.is_empty() { place.out } else { reads })
    }

    fn circle(&self, window: &FilterWindow, radius: f32) -> RunningSums {
        RunningSums::of(self.directions.iter().map(|direction| {
            let at = self.center + radius * *direction;
            window.sample(at.x, at.y)
        }))
    }

    fn ray(&self, window: &FilterWindow, along: Vec2) -> RunningSums {
        RunningSums::of((self.rings.0..=self.rings.1).map(|radius| {
            let at = self.center + radius as f32 * along;
            window.sample(at.x, at.y)
        }))
    }

    /// The radius of a pixel's center, px, and its place among the rays.
    fn place(&self, x: i32, y: i32) -> (f32, f32) {
        let away = vec2(x as f32 + 0.5, y as f32 + 0.5) - self.center;
        let angle = fast::atan2(away.y, away.x);
        let angle = self.middle + angle_between(angle, self.middle);
        (away.length(), (angle - self.first) / self.step)
    }
}

/// From one angle to another, within half a turn.
fn angle_between(angle: f32, from: f32) -> f32 {
    let turn = angle - from;
    turn - TAU * (turn / TAU).round()
}

/// Sums of all readings up to each.
struct RunningSums(Vec<[f32; 4]>);

impl RunningSums {
    fn of(readings: impl Iterator<Item = [f32; 4]>) -> Self {
        let mut sum = [0.0; 4];
        let mut all = vec![sum];
        for reading in readings {
            (0..4).for_each(|k| sum[k] += reading[k]);
            all.push(sum);
        }
        Self(all)
    }

    /// The sum up to a place between readings; each is a step wide.
    fn sum_up_to(&self, at: f32) -> [f32; 4] {
        let at = (at + 0.5).max(0.0).min((self.0.len() - 1) as f32);
        let whole = (at as usize).min(self.0.len() - 2);
        mix(self.0[whole], self.0[whole + 1], at - whole as f32)
    }

    /// The mean of some readings around a place.
    fn mean(&self, middle: f32, width: f32) -> [f32; 4] {
        let (low, high) =
            (self.sum_up_to(middle - 0.5 * width), self.sum_up_to(middle + 0.5 * width));
        // Sums end at the last reading.
        let last = (self.0.len() - 1) as f32;
        let held = |v: f32| (v + 0.5).max(0.0).min(last);
        let width = held(middle + 0.5 * width) - held(middle - 0.5 * width);
        let per = 1.0 / width.max(1e-3);
        std::array::from_fn(|k| (high[k] - low[k]) * per)
    }
}
