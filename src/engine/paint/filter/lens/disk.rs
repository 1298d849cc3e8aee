//! Means of disks, on coarse pixels if they are large. Floor 3.

use crate::math::Rect;
use crate::paint::filter::blur::CoarsePixels;
use crate::paint::filter::window::FilterWindow;

/// How far a disk reaches as it is laid here, px.
pub fn reach_px(radius: f32) -> i32 {
    radius.ceil() as i32 + 2 + 4 * (1 << coarseness(radius))
}

/// How often a picture is halved before a disk is laid on it: so that it is 3 to 6 coarse pixels.
fn coarseness(radius: f32) -> u32 {
    if radius > 6.0 { (radius / 3.0).log2().floor() as u32 } else { 0 }
}

/// The means of disks.
pub fn blurred(window: &FilterWindow, out: Rect, radius: f32) -> Vec<[f32; 4]> {
    if radius < 0.5 {
        return window.cropped(out);
    }
    let level = coarseness(radius);
    if level == 0 {
        return disk_means(window, out, radius);
    }
    let side = 1 << level;
    let around = out.grown(3 * side);
    let coarse = CoarsePixels::of(window, window.rect(), level);
    let squares = coarse.as_window();
    let down = |v: i32| v.div_euclid(side);
    let wanted =
        Rect::new(down(around.x0), down(around.y0), down(around.x1) + 1, down(around.y1) + 1)
            .intersect(squares.rect());
    let means = disk_means(&squares, wanted, radius / side as f32);
    CoarsePixels::new(level, wanted, means).read(out)
}

/// The means of disks, row by row of each: a row of a disk is a difference of running sums.
fn disk_means(window: &FilterWindow, out: Rect, radius: f32) -> Vec<[f32; 4]> {
    let rows = (radius.ceil() as i32).max(0);
    // Half the width of a row, in the mean over its height.
    let half = |dy: i32| {
        let at = |part: f32| (radius * radius - (dy as f32 + part).powi(2)).max(0.0).sqrt();
        [-0.375, -0.125, 0.125, 0.375].map(at).iter().sum::<f32>() / 4.0
    };
    let halves: Vec<f32> = (-rows..=rows).map(half).collect();
    let area: f32 = halves.iter().map(|half| 2.0 * half).sum();
    let margin = rows + 1;
    let sums = RowSums::of(window, out, margin);
    let mut all = vec![[0.0; 4]; out.width() * out.height()];
    for (y, line) in (out.y0..out.y1).zip(all.chunks_exact_mut(out.width().max(1))) {
        for (dy, half) in (-rows..=rows).zip(&halves).filter(|(_, half)| **half > 0.0) {
            let row = sums.row(y + dy);
            add_spans(row, (margin as f32, *half, 1.0 / area), line);
        }
    }
    all
}

/// Sums of the pixels of each row up to each.
struct RowSums {
    top: i32,
    width: usize,
    sums: Vec<[f32; 4]>,
}

impl RowSums {
    /// Of the rows of a rectangle and so many around it.
    fn of(window: &FilterWindow, out: Rect, margin: i32) -> Self {
        let rect = out.grown(margin);
        let width = rect.width() + 1;
        let mut sums = Vec::with_capacity(width * rect.height());
        for y in rect.y0..rect.y1 {
            let mut sum = [0.0; 4];
            sums.push(sum);
            for x in rect.x0..rect.x1 {
                let pixel = window.at(x, y);
                (0..4).for_each(|k| sum[k] += pixel[k]);
                sums.push(sum);
            }
        }
        Self { top: rect.y0, width, sums }
    }

    fn row(&self, y: i32) -> &[[f32; 4]] {
        let at = (y - self.top) as usize * self.width;
        &self.sums[at..at + self.width]
    }
}

crate::widest! {
    /// Adds to each pixel a span of a row around it.
    ///
    /// * `span`: sums before the first pixel's own, half of the span's width, and its weight.
    fn add_spans(sums: &[[f32; 4]], span: (f32, f32, f32), line: &mut [[f32; 4]]) {
        let (margin, half, weight) = span;
        let (low, high) = (margin + 0.5 - half, margin + 0.5 + half);
        let (i, j) = (low as usize, high as usize);
        let (s, t) = (weight * (low - i as f32), weight * (high - j as f32));
        let (from, to) = (weight - s, weight - t);
        let count = line.len();
        // Four numbers a pixel, all alike.
        let part = |from: usize| sums[from..from + count].as_flattened();
        let (below, next_below) = (part(i), part(i + 1));
        let (above, next_above) = (part(j), part(j + 1));
        let ends = below.iter().zip(next_below).zip(above.iter().zip(next_above));
        for (pixel, ((a, b), (c, d))) in line.as_flattened_mut().iter_mut().zip(ends) {
            *pixel += (to * c + t * d) - (from * a + s * b);
        }
    }
}
