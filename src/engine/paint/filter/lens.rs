//! Out of focus: each point becomes a disk, as large as its depth says. Floor 3. In linear light,
//! premultiplied, as in a camera.
//!
//! The picture is divided into layers by the size of their disks; each is blurred with its own, and
//! they are laid over each other, the farthest first. So what is sharp keeps its edge before a
//! soft background, and a soft foreground spreads over what is behind it.

use super::blur::CoarsePixels;
use super::sharpen::straight;
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::{Rect, srgb};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};

/// The blur of a lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensBlur {
    /// Of the largest disk, px.
    pub radius: f32,
    /// The depth that is sharp, percent from near to far.
    pub focus: f32,
    /// How much of the depth is sharp, percent.
    pub range: f32,
    /// Disks as large as the depth says; else all are the largest.
    pub by_depth: bool,
    /// How much brighter what is bright becomes before it spreads, percent.
    pub highlights: f32,
    /// What counts as bright, levels of 255.
    pub threshold: f32,
}

impl Default for LensBlur {
    fn default() -> Self {
        Self {
            radius: 12.0,
            focus: 0.0,
            range: 10.0,
            by_depth: true,
            highlights: 0.0,
            threshold: 230.0,
        }
    }
}

impl Parameters for LensBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let radius = parameter_name("radius", "Aperture", "Radius of the largest disk");
        let radius = NumberParameter::whole(radius, 0.0, 200.0, 12.0).decimals(1).px();
        v.number(radius, &mut self.radius);
        let hint = "As large as the depth of the surface says; without it all is out of focus";
        v.flag(parameter_name("by_depth", "By depth", hint), true, &mut self.by_depth);
        let percent = |name, default| NumberParameter::whole(name, 0.0, 100.0, default).decimals(1);
        let focus = parameter_name("focus", "Focus", "The depth that is sharp: 0 near, 100 far");
        v.number(percent(focus, 0.0), &mut self.focus);
        let range = parameter_name("range", "Range", "How much of the depth is sharp");
        v.number(percent(range, 10.0), &mut self.range);
        let bright =
            parameter_name("highlights", "Highlights", "How bright the disks of lights are");
        v.number(NumberParameter::whole(bright, 0.0, 1000.0, 0.0), &mut self.highlights);
        let threshold = parameter_name("threshold", "Threshold", "What counts as a light");
        v.number(NumberParameter::whole(threshold, 0.0, 255.0, 230.0), &mut self.threshold);
    }
}

impl LensBlur {
    /// The radius of a disk, px: below 0 it is nearer than the focus. `depth`: 0 near … 1 far.
    fn disk(&self, depth: f32) -> f32 {
        let (focus, range) = (self.focus / 100.0, self.range / 100.0);
        let off = depth - focus;
        let beyond = (off.abs() - 0.5 * range).max(0.0);
        let most = focus.max(1.0 - focus).max(1e-3);
        (self.radius * beyond / most).min(self.radius).copysign(off)
    }

    fn depth_of(&self, place: &FilterPlace, x: i32, y: i32) -> f32 {
        let Some(surface) = place.scene.surface.as_deref() else { return 1.0 };
        // Off the surface all is as far as can be.
        match surface.coverage_plane().get(x, y) {
            Some(coverage) if coverage > 0 => surface.depth_plane().at_clamped(x, y),
            _ => 1.0,
        }
    }

    /// A pixel in linear light, lights brighter.
    #[inline(always)]
    fn brighten(&self, pixel: [f32; 4]) -> [f32; 4] {
        let color = straight(pixel);
        let luma = 0.3 * color[0] + 0.59 * color[1] + 0.11 * color[2];
        let dark = (self.threshold / 255.0).min(0.999);
        let t = ((luma - dark) / (1.0 - dark)).max(0.0).min(1.0);
        let share = pixel[3] * (1.0 + self.highlights / 100.0 * t * t * (3.0 - 2.0 * t));
        let decode = |v: f32| srgb::decode_fast(v.max(0.0)) * share;
        [decode(color[0]), decode(color[1]), decode(color[2]), pixel[3]]
    }
}

crate::widest! {
    fn brighten_all(lens: &LensBlur, pixels: &mut [[f32; 4]]) {
        for pixel in pixels {
            *pixel = lens.brighten(*pixel);
        }
    }

    fn encode_all(pixels: &mut [[f32; 4]]) {
        for part in pixels.chunks_mut(64) {
            let mut most = 0.0f32;
            for pixel in part.iter() {
                let [r, g, b] = straight(*pixel);
                most = most.max(r).max(g).max(b);
            }
            if most > WHITE {
                for pixel in part {
                    *pixel = encode_pixel(*pixel);
                }
            } else {
                for pixel in part {
                    let [r, g, b] = straight(*pixel);
                    let a = pixel[3];
                    *pixel = [encode_dark(r) * a, encode_dark(g) * a, encode_dark(b) * a, a];
                }
            }
        }
    }
}

/// What is no brighter is white but for rounding.
const WHITE: f32 = 1.0001;

/// What is no brighter than white, encoded.
#[inline(always)]
fn encode_dark(v: f32) -> f32 {
    srgb::encode_fast(v.max(0.0).min(1.0))
}

/// Encoded again; light beyond white stays.
#[inline(always)]
fn encode_pixel(pixel: [f32; 4]) -> [f32; 4] {
    let encode = |v: f32| if v <= WHITE { encode_dark(v) } else { srgb::encode(v) };
    let [r, g, b] = straight(pixel);
    [encode(r) * pixel[3], encode(g) * pixel[3], encode(b) * pixel[3], pixel[3]]
}

impl FilterKernel for LensBlur {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        reach_px(self.radius.max(0.0)) as f32
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let out = place.out;
        if self.radius < 0.5 {
            return source.window(out).cropped(out);
        }
        let reach = self.reach(out, out).ceil() as i32;
        let mut window = source.window(out.grown(reach));
        brighten_all(self, window.pixels_mut());
        let is_flat = !self.by_depth || place.scene.surface.is_none();
        if is_flat {
            let mut blurred = blurred(&window, out, self.radius);
            encode_all(&mut blurred);
            return blurred;
        }
        let bounds = source.bounds();
        let mut disks = Vec::with_capacity(window.pixels().len());
        for y in window.rect().y0..window.rect().y1 {
            let y = y.max(bounds.y0).min(bounds.y1 - 1);
            disks.extend((window.rect().x0..window.rect().x1).map(|x| {
                let x = x.max(bounds.x0).min(bounds.x1 - 1);
                self.disk(self.depth_of(place, x, y))
            }));
        }
        let mut blurred = blur_layers(&window, &disks, self.radius, out);
        encode_all(&mut blurred);
        blurred
    }
}

/// The radii of the disks of layers, the farthest first: close together where they are small.
fn radii(most: f32) -> Vec<f32> {
    let mut far = vec![0.0];
    let mut next: f32 = 1.0;
    while next < most {
        far.push(next);
        next = (next * 1.35).max(next + 1.0);
    }
    far.push(most);
    let near = far[1..].iter().map(|v| -v);
    far.iter().rev().copied().chain(near).collect()
}

/// Layers blurred by their own disks, over each other.
fn blur_layers(window: &FilterWindow, disks: &[f32], most: f32, out: Rect) -> Vec<[f32; 4]> {
    let radii = radii(most);
    let layers = LensLayers::of(disks, window.rect(), &radii);
    // Of an opaque picture a layer's alpha is its share.
    let is_opaque = are_opaque(window.pixels());
    let mut sums = vec![[0.0f32; 4]; out.width() * out.height()];
    let mut covered = vec![0.0f32; sums.len()];
    for (i, &radius) in radii.iter().enumerate() {
        // A layer is blurred where it reaches, from where it is.
        let reach = reach_px(radius.abs());
        let part = layers.seen_rect(i).grown(reach).intersect(out);
        if part.is_empty() {
            continue;
        }
        let around = part.grown(reach).intersect(window.rect());
        let weighed = FilterWindow::new(around, layers.weigh(i, window, around));
        let colors = blurred(&weighed, part, radius.abs());
        let alphas = (!is_opaque).then(|| {
            let whole = vec![[1.0; 4]; window.pixels().len()];
            let whole = FilterWindow::new(window.rect(), whole);
            let weighed = FilterWindow::new(around, layers.weigh(i, &whole, around));
            blurred(&weighed, part, radius.abs())
        });
        let alphas = alphas.as_ref().unwrap_or(&colors);
        let rows = colors.chunks_exact(part.width()).zip(alphas.chunks_exact(part.width()));
        for (y, (colors, alphas)) in (part.y0..part.y1).zip(rows) {
            let first = (y - out.y0) as usize * out.width() + (part.x0 - out.x0) as usize;
            let row = first..first + part.width();
            lay_over(colors, alphas, (&mut sums[row.clone()], &mut covered[row]));
        }
    }
    divide(&mut sums, &covered);
    sums
}

/// Where the pixels of a picture lie among layers.
struct LensLayers {
    rect: Rect,
    /// By the numbers of layers: 1.25 is a quarter of the way from the layer 1 to 2, and belongs to
    /// both.
    places: Vec<f32>,
    /// The least and the greatest one of squares.
    squares: Vec<(f32, f32)>,
}

/// The side of these squares, px.
const SQUARE: usize = 16;

impl LensLayers {
    /// * `disks`: the radii at the pixels of a rectangle. `radii`: of the layers.
    fn of(disks: &[f32], rect: Rect, radii: &[f32]) -> Self {
        let mut places = vec![0.0f32; disks.len()];
        for pair in radii.windows(2) {
            add_places(disks, (pair[0], 1.0 / (pair[1] - pair[0])), &mut places);
        }
        let width = rect.width();
        let across = width.div_ceil(SQUARE);
        let none = (f32::INFINITY, f32::NEG_INFINITY);
        let mut squares = vec![none; across * rect.height().div_ceil(SQUARE)];
        for (y, row) in places.chunks_exact(width.max(1)).enumerate() {
            for (x, part) in row.chunks(SQUARE).enumerate() {
                let (low, high) = &mut squares[y / SQUARE * across + x];
                for place in part {
                    (*low, *high) = (low.min(*place), high.max(*place));
                }
            }
        }
        Self { rect, places, squares }
    }

    /// A rectangle around the pixels that belong to a layer.
    fn seen_rect(&self, layer: usize) -> Rect {
        let across = self.rect.width().div_ceil(SQUARE).max(1);
        let is_seen =
            |(low, high): (f32, f32)| low < layer as f32 + 1.0 && high > layer as f32 - 1.0;
        let seen = self.squares.iter().enumerate().filter(|(_, square)| is_seen(**square));
        seen.fold(Rect::EMPTY, |all, (i, _)| {
            let (x, y) = ((i % across * SQUARE) as i32, (i / across * SQUARE) as i32);
            let corner = (self.rect.x0 + x, self.rect.y0 + y);
            let side = SQUARE as i32;
            all.union(Rect::new(corner.0, corner.1, corner.0 + side, corner.1 + side))
        })
    }

    /// What a layer has of the pixels of a rectangle within the window that the disks are of.
    fn weigh(&self, layer: usize, window: &FilterWindow, rect: Rect) -> Vec<[f32; 4]> {
        let mut all = vec![[0.0; 4]; rect.width() * rect.height()];
        for (y, weighed) in (rect.y0..rect.y1).zip(all.chunks_exact_mut(rect.width().max(1))) {
            let first = (rect.x0 - self.rect.x0) as usize;
            let place = (y - self.rect.y0) as usize * self.rect.width() + first;
            let places = &self.places[place..place + rect.width()];
            let pixels = &window.row(y)[first..first + rect.width()];
            weigh_row(pixels, places, layer as f32, weighed);
        }
        all
    }
}

/// How far a disk reaches as it is laid here, px.
fn reach_px(radius: f32) -> i32 {
    radius.ceil() as i32 + 2 + 4 * (1 << coarseness(radius))
}

crate::widest! {
    /// Adds how far each disk is from one radius to the next.
    ///
    /// * `step`: the first radius, and one by the difference.
    fn add_places(disks: &[f32], step: (f32, f32), places: &mut [f32]) {
        for (place, disk) in places.iter_mut().zip(disks) {
            *place += ((disk - step.0) * step.1).max(0.0).min(1.0);
        }
    }

    fn are_opaque(pixels: &[[f32; 4]]) -> bool {
        let mut least = 1.0f32;
        for pixel in pixels {
            least = least.min(pixel[3]);
        }
        least == 1.0
    }

    /// `places`: of the pixels among the layers.
    fn weigh_row(pixels: &[[f32; 4]], places: &[f32], layer: f32, weighed: &mut [[f32; 4]]) {
        for ((weighed, pixel), place) in weighed.iter_mut().zip(pixels).zip(places) {
            let share = (1.0 - (place - layer).abs()).max(0.0);
            for k in 0..4 {
                weighed[k] = share * pixel[k];
            }
        }
    }

    fn divide(sums: &mut [[f32; 4]], covered: &[f32]) {
        for (sum, covered) in sums.iter_mut().zip(covered) {
            let per = 1.0 / covered.max(1e-4);
            for value in sum {
                *value *= per;
            }
        }
    }

    /// Lays a layer over those that are farther: of these it covers its share.
    ///
    /// * `shares`: in the last channel.
    /// * `beneath`: their colors, and how much they cover.
    fn lay_over(
        colors: &[[f32; 4]],
        shares: &[[f32; 4]],
        beneath: (&mut [[f32; 4]], &mut [f32])
    ) {
        let (sums, covered) = beneath;
        let layer = colors.iter().zip(shares);
        for ((sum, covered), (color, share)) in sums.iter_mut().zip(covered).zip(layer) {
            let left = 1.0 - share[3].max(0.0).min(1.0);
            for k in 0..4 {
                sum[k] = color[k] + left * sum[k];
            }
            *covered = share[3] + left * *covered;
        }
    }
}

/// How often a picture is halved before a disk is laid on it: so that it is 3 to 6 coarse pixels.
fn coarseness(radius: f32) -> u32 {
    if radius > 6.0 { (radius / 3.0).log2().floor() as u32 } else { 0 }
}

/// The means of disks.
fn blurred(window: &FilterWindow, out: Rect, radius: f32) -> Vec<[f32; 4]> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash;

    /// How much of each pixel belongs to a layer: those between two layers to both.
    fn layer_shares(disks: &[f32], [farther, own, nearer]: [Option<f32>; 3]) -> Vec<f32> {
        let own = own.unwrap();
        let per = |next: Option<f32>| next.map_or(0.0, |next| 1.0 / (next - own));
        let (toward_farther, toward_nearer) = (per(farther), per(nearer));
        let share = |disk: f32| {
            let away = disk - own;
            let away = if away >= 0.0 { away * toward_farther } else { away * toward_nearer };
            (1.0 - away).max(0.0).min(1.0)
        };
        disks.iter().map(|disk| share(*disk)).collect()
    }

    /// Every layer over all of the picture, as the text says.
    fn blur_whole_layers(
        window: &FilterWindow,
        disks: &[f32],
        most: f32,
        out: Rect,
    ) -> Vec<[f32; 4]> {
        let radii = radii(most);
        let mut sums = vec![[0.0f32; 4]; out.width() * out.height()];
        let mut covered = vec![0.0f32; sums.len()];
        for (i, &radius) in radii.iter().enumerate() {
            let (farther, nearer) = (i.checked_sub(1).map(|i| radii[i]), radii.get(i + 1).copied());
            let shares = layer_shares(disks, [farther, Some(radius), nearer]);
            let of_layer = |value: fn([f32; 4]) -> [f32; 4]| {
                let pixels = window.pixels().iter().zip(&shares);
                let weighed = pixels.map(|(p, share)| value(*p).map(|v| v * share)).collect();
                blurred(&FilterWindow::new(window.rect(), weighed), out, radius.abs())
            };
            let (colors, alphas) = (of_layer(|pixel| pixel), of_layer(|_| [1.0; 4]));
            for (i, (color, alpha)) in colors.iter().zip(&alphas).enumerate() {
                let left = 1.0 - alpha[3].max(0.0).min(1.0);
                (0..4).for_each(|k| sums[i][k] = color[k] + left * sums[i][k]);
                covered[i] = alpha[3] + left * covered[i];
            }
        }
        let whole = |(sum, covered): ([f32; 4], f32)| sum.map(|v| v / covered.max(1e-4));
        sums.into_iter().zip(covered).map(whole).collect()
    }

    #[test]
    fn layers_that_are_blurred_where_they_are_give_the_picture_of_whole_ones() {
        let out = Rect::new(0, 0, 120, 100);
        for (most, is_opaque) in [(3.0, true), (9.0, false), (14.0, true)] {
            let rect = out.grown(reach_px(most));
            let places = (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (x, y)));
            let (mut pixels, mut disks) = (Vec::new(), Vec::new());
            for (x, y) in places {
                let unit = |c: u32| hash::unit(c, x as u32, y as u32);
                let a = if is_opaque { 1.0 } else { unit(3) };
                pixels.push([unit(0) * a, unit(1) * a, unit(2) * a, a]);
                // Sharp on the left, a slope, and a near post.
                let slope = (x as f32 - 40.0).max(0.0) / 80.0;
                let disk = if (70..80).contains(&x) { -0.8 * most } else { slope.min(1.0) * most };
                disks.push(disk);
            }
            let window = FilterWindow::new(rect, pixels);
            let found = blur_layers(&window, &disks, most, out);
            let whole = blur_whole_layers(&window, &disks, most, out);
            let both = found.as_flattened().iter().zip(whole.as_flattened());
            let off = both.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(off < 1e-4, "{most} px: {off}");
        }
    }
}
