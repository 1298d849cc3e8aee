//! Layers of a picture by the size of their disks: each blurred where it is, laid over each other.
//! Floor 3.

use super::disk::{blurred, reach_px};
use crate::math::Rect;
use crate::paint::filter::window::FilterWindow;

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
pub fn blur_layers(window: &FilterWindow, disks: &[f32], most: f32, out: Rect) -> Vec<[f32; 4]> {
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
