//! As if the picture turned about a point: means along circles. Floor 3.

use super::polar::{KnownDirections, PolarLines, PolarPart, ray_step, read_lines};
use super::{
    BlurCenter, SoftKernel, count_kept, detail_by_distance, farthest, step_between, window_around,
};
use crate::math::{Rect, Vec2};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use crate::paint::filter::blur::{BoxLine, mix};
use crate::paint::filter::{FilterKernel, FilterPlace, FilterSource, FilterWindow};
use std::f32::consts::{PI, TAU};

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

    fn as_soft(&self) -> Option<&dyn SoftKernel> {
        Some(self)
    }
}

impl SoftKernel for SpinBlur {
    fn detail_left(&self, place: &FilterPlace, bounds: Rect) -> Vec<f32> {
        detail_by_distance(place, self.center.at(bounds), self.angle.to_radians().min(TAU))
    }
}

crate::widest! {
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
}
