//! Blurs that are the same everywhere: Gaussian, box, and along a direction. Floor 3. On
//! premultiplied encoded pixels, as other programs blur.

mod coarse;

pub(super) use coarse::CoarsePixels;

use super::window::{FilterSource, FilterWindow, transposed};
use super::{FilterKernel, FilterPlace};
use crate::math::Rect;
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use crate::raster::blur;

/// The same softness everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianBlur {
    /// Standard deviation, px.
    pub radius: f32,
}

impl Default for GaussianBlur {
    fn default() -> Self {
        Self { radius: 4.0 }
    }
}

/// The parameter that blurs share.
pub(super) const fn radius(hint: &'static str, most: f32, default: f32) -> NumberParameter {
    NumberParameter::whole(parameter_name("radius", "Radius", hint), 0.0, most, default)
        .decimals(1)
        .px()
}

impl Parameters for GaussianBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.number(radius("Standard deviation", 500.0, 4.0), &mut self.radius);
    }
}

impl FilterKernel for GaussianBlur {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        gaussian_reach(self.radius)
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        gaussian(source, place.out, self.radius)
    }
}

/// How far a Gaussian reads, px.
pub(super) fn gaussian_reach(sigma: f32) -> f32 {
    if sigma > 0.0 { kernel_reach(sigma) + 4.0 * (1 << coarseness(sigma)) as f32 } else { 0.0 }
}

/// How far its weights reach, px: 6e-5 of them lie beyond four standard deviations.
fn kernel_reach(sigma: f32) -> f32 {
    4.0 * sigma
}

/// How often a picture is halved before it is blurred: below 5 px not at all, then so that the
/// standard deviation is 2.5 to 5 coarse pixels.
fn coarseness(sigma: f32) -> u32 {
    let halvings = (sigma / 2.5).log2().floor();
    if halvings >= 1.0 { (halvings as u32).min(12) } else { 0 }
}

/// A Gaussian blur of part of a picture, whose border is repeated.
///
/// A wide one is computed on coarse pixels: sums under tents, blurred, and read by a cubic B-spline.
/// Variances add up, so that of the blur is what the two others leave.
pub(super) fn gaussian(source: &dyn FilterSource, out: Rect, sigma: f32) -> Vec<[f32; 4]> {
    if sigma.is_nan() || sigma <= 0.0 {
        return source.window(out).cropped(out);
    }
    let level = coarseness(sigma);
    let step = (1 << level) as f32;
    // What is blurred repeats its border, as the picture does: of coarse pixels, one that lies
    // beyond the picture.
    let known = source.bounds().grown(if level > 0 { 2 << level } else { 0 });
    let reads =
        out.grown((kernel_reach(sigma) + 2.0 * step).ceil() as i32).intersect(known).union(out);
    if level == 0 {
        let window = source.window(reads);
        let blurred = blur::gaussian_pixels(window.size(), window.pixels(), sigma);
        return FilterWindow::new(reads, blurred).cropped(out);
    }
    let spent = (step * step + 0.5) / 6.0 + step * step / 3.0;
    let left = ((sigma * sigma - spent) / (step * step)).max(0.0).sqrt();
    CoarsePixels::of(source, reads, level).blurred(left).read(out)
}

/// The mean of a square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxBlur {
    /// From the middle of the square to its side, px: it is 2 r + 1 pixels wide.
    pub radius: f32,
}

impl Default for BoxBlur {
    fn default() -> Self {
        Self { radius: 4.0 }
    }
}

impl Parameters for BoxBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let hint = "From the middle of the square to its side: it is 2 r + 1 pixels wide";
        v.number(radius(hint, 500.0, 4.0), &mut self.radius);
    }
}

impl FilterKernel for BoxBlur {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        if self.radius > 0.0 { self.radius.floor() + 1.0 } else { 0.0 }
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let out = place.out;
        if self.radius <= 0.0 {
            return source.window(out).cropped(out);
        }
        let line = BoxLine::new(self.radius);
        let window = source.window(out.grown(line.margin() as i32));
        let width = out.width();
        let mut rows = vec![[0.0; 4]; width * window.rect().height()];
        let lines = window.pixels().chunks_exact(window.rect().width().max(1));
        for (row, means) in lines.zip(rows.chunks_exact_mut(width.max(1))) {
            line.means(row, means);
        }
        line.means_down(&rows, width, out.height())
    }
}

/// A running mean of 2 r + 1 pixels; those at its ends count in part if r is not whole.
pub(super) struct BoxLine {
    whole: usize,
    part: f32,
    share: f32,
}

impl BoxLine {
    pub fn new(radius: f32) -> Self {
        let radius = radius.max(0.0).min(100_000.0);
        let whole = radius.floor();
        Self { whole: whole as usize, part: radius - whole, share: 1.0 / (2.0 * radius + 1.0) }
    }

    /// Pixels that are read before the first and behind the last.
    pub fn margin(&self) -> usize {
        self.whole + 1
    }

    /// The means of a row that has margins.
    pub fn means(&self, row: &[[f32; 4]], means: &mut [[f32; 4]]) {
        running_means(row, (self.whole, self.part, self.share), means);
    }

    /// The means of a row that has margins, so many pixels apart.
    pub fn means_apart(&self, row: &[[f32; 4]], apart: usize, means: &mut [[f32; 4]]) {
        running_means_apart(row, (self.whole, self.part, self.share), apart, means);
    }

    /// The means down columns: `rows` have margins above and beneath.
    fn means_down(&self, rows: &[[f32; 4]], width: usize, height: usize) -> Vec<[f32; 4]> {
        let row = |y: usize| rows[y * width..(y + 1) * width].as_flattened();
        let mut sums = vec![0.0; width * 4];
        (1..2 * self.whole + 2).for_each(|y| add_row(&mut sums, row(y)));
        let mut out = vec![[0.0; 4]; width * height];
        for (y, means) in out.chunks_exact_mut(width.max(1)).enumerate() {
            let (before, behind) = (row(y), row(y + 2 * self.whole + 2));
            let ends = [before, behind];
            put_means(&sums, ends, (self.part, self.share), means.as_flattened_mut());
            add_row(&mut sums, behind);
            take_row(&mut sums, row(y + 1));
        }
        out
    }
}

crate::widest! {
    /// `size`: whole pixels to a side, the part of the next one, and one by the width.
    fn running_means(row: &[[f32; 4]], size: (usize, f32, f32), means: &mut [[f32; 4]]) {
        let (whole, part, share) = size;
        let mut sum = [0.0; 4];
        for pixel in &row[1..2 * whole + 2] {
            for k in 0..4 {
                sum[k] += pixel[k];
            }
        }
        for (x, mean) in means.iter_mut().enumerate() {
            let (before, behind, first) = (row[x], row[x + 2 * whole + 2], row[x + 1]);
            for k in 0..4 {
                mean[k] = (sum[k] + part * (before[k] + behind[k])) * share;
                sum[k] += behind[k] - first[k];
            }
        }
    }

    /// The same, so many pixels apart.
    fn running_means_apart(
        row: &[[f32; 4]],
        size: (usize, f32, f32),
        apart: usize,
        means: &mut [[f32; 4]]
    ) {
        let (whole, part, share) = size;
        let mut sum = [0.0; 4];
        for pixel in &row[1..2 * whole + 2] {
            for k in 0..4 {
                sum[k] += pixel[k];
            }
        }
        let mut x = 0;
        for mean in means {
            let (before, behind) = (row[x], row[x + 2 * whole + 2]);
            for k in 0..4 {
                mean[k] = (sum[k] + part * (before[k] + behind[k])) * share;
            }
            let next = (x + apart).min(row.len() - 2 * whole - 3);
            let pairs = row[x + 1..=next].iter().zip(&row[x + 2 * whole + 2..]);
            for (first, behind) in pairs {
                for k in 0..4 {
                    sum[k] += behind[k] - first[k];
                }
            }
            x = next;
        }
    }

    fn add_row(sums: &mut [f32], row: &[f32]) {
        for (sum, v) in sums.iter_mut().zip(row) {
            *sum += v;
        }
    }

    fn take_row(sums: &mut [f32], row: &[f32]) {
        for (sum, v) in sums.iter_mut().zip(row) {
            *sum -= v;
        }
    }

    fn put_means(sums: &[f32], ends: [&[f32]; 2], size: (f32, f32), means: &mut [f32]) {
        let (part, share) = size;
        for (i, mean) in means.iter_mut().enumerate() {
            *mean = (sums[i] + part * (ends[0][i] + ends[1][i])) * share;
        }
    }
}

/// As if the picture or the camera had moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionBlur {
    /// Of the way, degrees counter-clockwise from the right.
    pub angle: f32,
    /// Of the way, px.
    pub length: f32,
}

impl Default for MotionBlur {
    fn default() -> Self {
        Self { angle: 0.0, length: 20.0 }
    }
}

impl Parameters for MotionBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let angle = parameter_name("angle", "Angle", "Degrees counter-clockwise from the right");
        v.number(NumberParameter::around(angle, 180.0).decimals(1), &mut self.angle);
        let length = parameter_name("length", "Length", "How far it moves");
        let length = NumberParameter::whole(length, 0.0, 1000.0, 20.0).decimals(1).px();
        v.number(length, &mut self.length);
    }
}

impl FilterKernel for MotionBlur {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        0.5 * self.length.max(0.0) + 3.0
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let out = place.out;
        if self.length <= 1.0 {
            return source.window(out).cropped(out);
        }
        let (sin, cos) = f64::from(self.angle).to_radians().sin_cos();
        let window = source.window(out.grown(self.reach(out, out).ceil() as i32));
        let length = f64::from(self.length);
        // Image axes: y down.
        if cos.abs() >= sin.abs() {
            return means_along(&window, out, -sin / cos, length * cos.abs());
        }
        let turned =
            means_along(&window.transposed(), transposed(out), -cos / sin, length * sin.abs());
        FilterWindow::new(transposed(out), turned).transposed().cropped(out)
    }
}

/// Means along lines y = t + slope · x, |slope| ≤ 1, over `extent` columns.
///
/// A line is read between rows, its running means are kept, and a pixel is read between two lines.
fn means_along(window: &FilterWindow, out: Rect, slope: f64, extent: f64) -> Vec<[f32; 4]> {
    let line = BoxLine::new(((extent.max(1.0) - 1.0) * 0.5) as f32);
    let margin = line.margin() as i32;
    let offset = |x: i32, y: i32| f64::from(y) - f64::from(x) * slope;
    let corners = [
        offset(out.x0, out.y0),
        offset(out.x1 - 1, out.y0),
        offset(out.x0, out.y1 - 1),
        offset(out.x1 - 1, out.y1 - 1),
    ];
    let first = corners.iter().copied().fold(f64::MAX, f64::min).floor() as i32;
    let last = corners.iter().copied().fold(f64::MIN, f64::max).floor() as i32 + 1;
    let width = out.width();
    let mut lines = vec![[0.0; 4]; width * (last - first + 1).max(0) as usize];
    let mut read = Vec::new();
    for (t, means) in (first..=last).zip(lines.chunks_exact_mut(width.max(1))) {
        let Some((from, to)) = columns_met(out, slope, t) else { continue };
        read.clear();
        read.extend((from - margin..to + margin).map(|x| {
            let y = f64::from(t) + f64::from(x) * slope;
            let part = (y - y.floor()) as f32;
            mix(window.at(x, y.floor() as i32), window.at(x, y.floor() as i32 + 1), part)
        }));
        line.means(&read, &mut means[(from - out.x0) as usize..(to - out.x0) as usize]);
    }
    let mut all = Vec::with_capacity(width * out.height());
    for y in out.y0..out.y1 {
        for x in out.x0..out.x1 {
            let t = offset(x, y);
            let (whole, column) = (t.floor(), (x - out.x0) as usize);
            let above = (whole as i32 - first) as usize * width + column;
            let beneath = (above + width).min(lines.len() - 1);
            all.push(mix(lines[above], lines[beneath], (t - whole) as f32));
        }
    }
    all
}

/// The columns in which a line is read by pixels of a rectangle: those it passes within a row.
fn columns_met(out: Rect, slope: f64, t: i32) -> Option<(i32, i32)> {
    let (low, high) = (f64::from(out.y0 - 2 - t), f64::from(out.y1 + 2 - t));
    let (from, to) = if slope.abs() < 1e-9 {
        (out.x0, out.x1)
    } else {
        let (a, b) = (low / slope, high / slope);
        let within = |v: f64| v.max(f64::from(out.x0)).min(f64::from(out.x1));
        (within(a.min(b)).floor() as i32, within(a.max(b)).ceil() as i32)
    };
    (from < to).then_some((from, to))
}

/// A share of the way from one pixel to another.
#[inline(always)]
pub(super) fn mix(a: [f32; 4], b: [f32; 4], share: f32) -> [f32; 4] {
    let mut mixed = a;
    for k in 0..4 {
        mixed[k] += share * (b[k] - a[k]);
    }
    mixed
}
