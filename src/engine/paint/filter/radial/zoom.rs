//! As if the camera came nearer: means along rays. Floor 3.

use super::polar::{KnownDirections, PolarLines, PolarPart, ray_step, read_lines};
use super::{
    BlurCenter, SoftKernel, count_kept, detail_by_distance, farthest, step_between, window_around,
};
use crate::math::{Rect, Vec2, vec2};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use crate::paint::filter::blur::mix;
use crate::paint::filter::{FilterKernel, FilterPlace, FilterSource, FilterWindow};

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

    fn as_soft(&self) -> Option<&dyn SoftKernel> {
        Some(self)
    }
}

impl SoftKernel for ZoomBlur {
    fn detail_left(&self, place: &FilterPlace, bounds: Rect) -> Vec<f32> {
        detail_by_distance(place, self.center.at(bounds), self.amount / 100.0)
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

crate::widest! {
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
