//! Filters of neighboring pixels and of places: the median, squares of one color, edges, and the
//! picture shifted. Floor 3. On premultiplied encoded pixels.

use super::blur::radius;
use super::sharpen::{amount, color_under_alpha, straight};
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::{Rect, srgb::quantize};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};

/// The middle value of the pixels around, which removes specks and keeps edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MedianFilter {
    /// From the middle of the square to its side, px.
    pub radius: f32,
}

impl Default for MedianFilter {
    fn default() -> Self {
        Self { radius: 2.0 }
    }
}

impl Parameters for MedianFilter {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.number(radius("Of the square whose middle value is taken", 64.0, 2.0), &mut self.radius);
    }
}

impl MedianFilter {
    fn side(&self) -> i32 {
        self.radius.round().max(0.0).min(1024.0) as i32
    }
}

impl FilterKernel for MedianFilter {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        self.side() as f32
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let (out, reach) = (place.out, self.side());
        let window = source.window(out.grown(reach));
        let mut all = window.cropped(out);
        if reach > 0 {
            let mut bytes = vec![0; window.pixels().len() * 4];
            quantize_all(window.pixels().as_flattened(), &mut bytes);
            let widths = (window.rect().width(), out.width(), out.height());
            let side = 2 * reach as usize + 1;
            let mut medians = vec![0; all.len() * 4];
            match reach {
                ..=FEW => few_medians(&bytes, widths, side, &mut medians),
                _ => (0..4).for_each(|k| many_medians(&bytes, k, widths, side, &mut medians)),
            }
            take_medians(&medians, all.as_flattened_mut());
        }
        all
    }
}

/// From here on a histogram costs less than comparing.
const FEW: i32 = 6;

/// The medians of squares of pixels of four bytes: bit by bit, the largest value that more than half
/// of a square reaches. At most 15 pixels to a side.
///
/// * `widths`: of a row of pixels, of a row of medians, and how many rows of these there are.
fn few_medians(bytes: &[u8], widths: (usize, usize, usize), side: usize, all: &mut [u8]) {
    let (width, across, _) = widths;
    let (mut tried, mut counts) = (vec![0u8; across * 4], vec![0u8; across * 4]);
    for (y, medians) in all.chunks_exact_mut((across * 4).max(1)).enumerate() {
        for bit in (0..8).rev() {
            tried.iter_mut().zip(&*medians).for_each(|(tried, known)| *tried = known | 1 << bit);
            counts.fill(0);
            for row in bytes[y * width * 4..].chunks(width * 4).take(side) {
                (0..side).for_each(|x| count_reaching(&row[x * 4..], &tried, &mut counts));
            }
            keep_bit(&counts, ((side * side / 2) as u8, 1 << bit), medians);
        }
    }
}

crate::widest! {
    fn quantize_all(values: &[f32], bytes: &mut [u8]) {
        for (byte, value) in bytes.iter_mut().zip(values) {
            *byte = quantize(*value);
        }
    }

    /// What is the median already stays as it is.
    fn take_medians(medians: &[u8], values: &mut [f32]) {
        for (value, median) in values.iter_mut().zip(medians) {
            let is_median = quantize(*value) == *median;
            *value = if is_median { *value } else { f32::from(*median) / 255.0 };
        }
    }

    fn count_reaching(values: &[u8], least: &[u8], counts: &mut [u8]) {
        for ((count, value), least) in counts.iter_mut().zip(values).zip(least) {
            *count += u8::from(value >= least);
        }
    }

    /// `known`: half of the pixels, and the bit that was tried.
    fn keep_bit(counts: &[u8], known: (u8, u8), medians: &mut [u8]) {
        let (half, bit) = known;
        for (median, count) in medians.iter_mut().zip(counts) {
            *median |= if *count > half { bit } else { 0 };
        }
    }
}

/// The same for large squares: a histogram moves along each row, and only the columns that enter
/// and leave it are counted (Huang et al. 1979).
fn many_medians(
    bytes: &[u8],
    channel: usize,
    widths: (usize, usize, usize),
    side: usize,
    all: &mut [u8],
) {
    let (width, across, _) = widths;
    let half = (side * side / 2) as u32;
    let column =
        |row: usize, x: usize| (row..row + side).map(move |y| (y * width + x) * 4 + channel);
    for (row, medians) in all.chunks_exact_mut((across * 4).max(1)).enumerate() {
        let mut counts = [0u32; 256];
        for x in 0..side {
            column(row, x).for_each(|i| counts[usize::from(bytes[i])] += 1);
        }
        // How many are below the median.
        let (mut median, mut below) = (0usize, 0u32);
        for (x, found) in medians.iter_mut().skip(channel).step_by(4).enumerate() {
            if x > 0 {
                for (left, entered) in column(row, x - 1).zip(column(row, x + side - 1)) {
                    let (left, entered) = (usize::from(bytes[left]), usize::from(bytes[entered]));
                    counts[left] -= 1;
                    counts[entered] += 1;
                    below -= u32::from(left < median);
                    below += u32::from(entered < median);
                }
            }
            while below > half {
                median -= 1;
                below -= counts[median];
            }
            while below + counts[median] <= half {
                below += counts[median];
                median += 1;
            }
            *found = median as u8;
        }
    }
}

/// Squares of one color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixelate {
    /// Their side, px.
    pub size: f32,
}

impl Default for Pixelate {
    fn default() -> Self {
        Self { size: 8.0 }
    }
}

impl Parameters for Pixelate {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let size = parameter_name("size", "Size", "The side of a square");
        v.number(NumberParameter::whole(size, 1.0, 1000.0, 8.0).px(), &mut self.size);
    }
}

impl Pixelate {
    fn cells(&self, low: i32, high: i32) -> (i32, i32) {
        let size = self.size.max(1.0);
        ((low as f32 / size).floor() as i32, (high as f32 / size).ceil() as i32)
    }

    /// The first pixel of a square.
    fn start(&self, cell: i32) -> i32 {
        (cell as f32 * self.size.max(1.0)).ceil() as i32
    }
}

impl FilterKernel for Pixelate {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        self.size.max(1.0).ceil()
    }

    /// Squares are counted from the picture's upper left corner.
    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let (out, bounds) = (place.out, source.bounds());
        let mut all = vec![[0.0; 4]; out.width() * out.height()];
        let (left, right) = self.cells(out.x0 - bounds.x0, out.x1 - bounds.x0);
        let (top, bottom) = self.cells(out.y0 - bounds.y0, out.y1 - bounds.y0);
        for j in top..bottom {
            let y = |cell| self.start(cell) + bounds.y0;
            let x = |cell| self.start(cell) + bounds.x0;
            let strip = Rect::new(x(left), y(j), x(right), y(j + 1)).intersect(bounds);
            let window = source.window(strip);
            for i in left..right {
                let cell = Rect::new(x(i), y(j), x(i + 1), y(j + 1)).intersect(bounds);
                let mean = mean_of(&window, cell);
                let shown = cell.intersect(out);
                for y in shown.y0..shown.y1 {
                    let row = (y - out.y0) as usize * out.width();
                    let from = row + (shown.x0 - out.x0) as usize;
                    all[from..from + shown.width()].fill(mean);
                }
            }
        }
        all
    }
}

fn mean_of(window: &FilterWindow, cell: Rect) -> [f32; 4] {
    let pixels = window.cropped(cell);
    let mut sum = [0.0; 4];
    for pixel in &pixels {
        (0..4).for_each(|k| sum[k] += pixel[k]);
    }
    let share = 1.0 / pixels.len().max(1) as f32;
    sum.map(|v| v * share)
}

/// Edges as light on dark, or dark on light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeFilter {
    /// Percent.
    pub amount: f32,
    /// Of each channel by itself, and not of the brightness.
    pub colored: bool,
    /// Dark on light.
    pub inverted: bool,
}

impl Default for EdgeFilter {
    fn default() -> Self {
        Self { amount: 100.0, colored: true, inverted: false }
    }
}

impl Parameters for EdgeFilter {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.number(amount("How bright edges are, percent", 500.0, 100.0), &mut self.amount);
        let colored = parameter_name("colored", "Colored", "Edges of each channel by itself");
        v.flag(colored, true, &mut self.colored);
        v.flag(
            parameter_name("inverted", "Dark lines", "Dark on light"),
            false,
            &mut self.inverted,
        );
    }
}

impl FilterKernel for EdgeFilter {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        1.0
    }

    /// The length of Sobel's gradient, a quarter of its weights, so that a step from black to white
    /// is white; of straight colors, alpha stays.
    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let mut window = source.window(place.out.grown(1));
        for pixel in window.pixels_mut() {
            let mut color = straight(*pixel);
            if !self.colored {
                color = [0.3 * color[0] + 0.59 * color[1] + 0.11 * color[2]; 3];
            }
            *pixel = [color[0], color[1], color[2], pixel[3]];
        }
        let share = 0.25 * self.amount / 100.0;
        let out = place.out;
        let mut all = Vec::with_capacity(out.width() * out.height());
        for y in out.y0..out.y1 {
            let rows = [-1, 0, 1].map(|dy| window.row(y + dy));
            put_edges(rows, share, self.inverted, &mut all);
        }
        all
    }
}

crate::widest! {
    /// `rows`: the one above, its own and the one beneath, a pixel longer at both ends.
    fn put_edges(rows: [&[[f32; 4]]; 3], share: f32, is_inverted: bool, out: &mut Vec<[f32; 4]>) {
        let [above, own, beneath] = rows.map(|row| row.windows(3));
        for ((a, b), c) in above.zip(own).zip(beneath) {
            let mut edges = [0.0; 4];
            for k in 0..4 {
                let across = a[2][k] - a[0][k] + 2.0 * (b[2][k] - b[0][k]) + c[2][k] - c[0][k];
                let down = c[0][k] - a[0][k] + 2.0 * (c[1][k] - a[1][k]) + c[2][k] - a[2][k];
                let found = ((across * across + down * down).sqrt() * share).min(1.0);
                edges[k] = if is_inverted { 1.0 - found } else { found };
            }
            out.push(color_under_alpha([edges[0], edges[1], edges[2]], b[1][3]));
        }
    }
}

/// The picture shifted; what leaves it on one side enters it on the other, so that the seams of a
/// tile can be painted over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrappedOffset {
    /// To the right, percent of the width.
    pub right: f32,
    /// Down, percent of the height.
    pub down: f32,
}

impl Default for WrappedOffset {
    fn default() -> Self {
        Self { right: 50.0, down: 50.0 }
    }
}

impl Parameters for WrappedOffset {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let number = |name| NumberParameter {
            default: 50.0,
            ..NumberParameter::around(name, 100.0).decimals(2)
        };
        let right = parameter_name("right", "Right", "Percent of the width");
        v.number(number(right), &mut self.right);
        v.number(number(parameter_name("down", "Down", "Percent of the height")), &mut self.down);
    }
}

impl WrappedOffset {
    /// Whole px.
    fn shift(&self, bounds: Rect) -> (i32, i32) {
        let px = |percent: f32, side: usize| (percent / 100.0 * side as f32).round() as i32;
        (px(self.right, bounds.width()), px(self.down, bounds.height()))
    }

    /// Where the parts of a rectangle are read, and where they go.
    fn parts(&self, out: Rect, bounds: Rect) -> Vec<(Rect, (i32, i32))> {
        let (dx, dy) = self.shift(bounds);
        let (w, h) = (bounds.width() as i32, bounds.height() as i32);
        let mut parts = Vec::new();
        for (by_x, by_y) in [-1, 0, 1].into_iter().flat_map(|i| [-1, 0, 1].map(|j| (i, j))) {
            let (x, y) = (dx + by_x * w, dy + by_y * h);
            let read = out.intersect(bounds).moved(-x, -y).intersect(bounds);
            if !read.is_empty() {
                parts.push((read, (x, y)));
            }
        }
        parts
    }
}

impl FilterKernel for WrappedOffset {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        0.0
    }

    fn reads(&self, out: Rect, bounds: Rect) -> Vec<Rect> {
        self.parts(out, bounds).into_iter().map(|(read, _)| read).collect()
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let out = place.out;
        let mut all = vec![[0.0; 4]; out.width() * out.height()];
        for (read, (dx, dy)) in self.parts(out, source.bounds()) {
            let window = source.window(read);
            for y in read.y0..read.y1 {
                let row = (y + dy - out.y0) as usize * out.width();
                let from = row + (read.x0 + dx - out.x0) as usize;
                all[from..from + read.width()].copy_from_slice(window.row(y));
            }
        }
        all
    }
}
