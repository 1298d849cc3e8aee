//! A few colors that stand for those of a picture. Floor 3.
//!
//! The pixels are counted in boxes of 32 steps a channel; the boxes' mean colors in OKLab are cut
//! in two, again and again, where they differ most (median cut by variance), and the parts are then
//! moved to the middle of what is nearest to each (k-means). Everything is counted in whole numbers
//! or folded in a fixed order, so the same picture always gives the same colors.

use crate::math::oklab;
use crate::math::srgb::{self, Color};

/// Bits of a channel that tell boxes apart.
const BITS: u32 = 5;
/// Rounds of moving parts to their middles; most pictures stand still after fewer.
const ROUNDS: usize = 12;

/// A box of colors that are nearly the same.
#[derive(Clone, Copy)]
struct ColorBox {
    lab: [f32; 3],
    /// How much of the picture it is.
    weight: f64,
}

/// Counts the colors of a picture, which is handed in part by part.
pub struct ColorCounter {
    /// Sums of the channels and of the opacity, for each box.
    sums: Vec<[u64; 4]>,
}

impl Default for ColorCounter {
    fn default() -> Self {
        Self { sums: vec![[0; 4]; 1 << (3 * BITS)] }
    }
}

impl ColorCounter {
    /// Counts straight RGBA pixels, each as much as it is opaque.
    pub fn add(&mut self, rgba: &[u8]) {
        let place = |v: u8| usize::from(v >> (8 - BITS));
        for [r, g, b, a] in rgba.as_chunks().0 {
            let sum = &mut self.sums[(place(*r) << (2 * BITS)) | (place(*g) << BITS) | place(*b)];
            let weight = u64::from(*a);
            for (sum, channel) in sum.iter_mut().zip([*r, *g, *b]) {
                *sum += u64::from(channel) * weight;
            }
            sum[3] += weight;
        }
    }

    /// At most `count` colors, from dark to light, that stand for all; fewer if there are no more.
    pub fn colors(&self, count: usize) -> Vec<Color> {
        let boxes = self.boxes();
        if boxes.is_empty() || count == 0 {
            return Vec::new();
        }
        let parts = cut(boxes.clone(), count);
        let mut centers: Vec<[f32; 3]> = parts.iter().map(|part| mean(part)).collect();
        for _ in 0..ROUNDS {
            let moved = means_of_nearest(&boxes, &centers);
            if moved == centers {
                break;
            }
            centers = moved;
        }
        centers.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let mut colors: Vec<Color> = centers.into_iter().map(to_color).collect();
        colors.dedup();
        colors
    }

    /// The boxes that hold something, in the order of their colors.
    fn boxes(&self) -> Vec<ColorBox> {
        let filled = self.sums.iter().filter(|sum| sum[3] > 0);
        let to_box = |[r, g, b, weight]: &[u64; 4]| {
            let mean = |sum: &u64| srgb::decode((*sum as f64 / *weight as f64 / 255.0) as f32);
            ColorBox { lab: oklab::from_linear([r, g, b].map(mean)), weight: *weight as f64 }
        };
        filled.map(to_box).collect()
    }
}

fn to_color(lab: [f32; 3]) -> Color {
    let [r, g, b] = oklab::to_linear(lab).map(|v| srgb::quantize(srgb::encode(v)));
    Color::rgb(r, g, b)
}

/// Cuts the boxes into at most `count` parts, always the part that varies most.
fn cut(boxes: Vec<ColorBox>, count: usize) -> Vec<Vec<ColorBox>> {
    let mut parts = vec![boxes];
    while parts.len() < count {
        let spreads = parts.iter().map(|part| widest_axis(part).1);
        // The first of several.
        let found = spreads
            .enumerate()
            .fold((0, 0.0), |best, (i, spread)| if spread > best.1 { (i, spread) } else { best });
        let (widest, spread) = found;
        if spread <= 0.0 {
            break;
        }
        let mut low = std::mem::take(&mut parts[widest]);
        let axis = widest_axis(&low).0;
        low.sort_by(|a, b| a.lab[axis].total_cmp(&b.lab[axis]));
        let middle = mean(&low)[axis];
        let at = low.partition_point(|b| b.lab[axis] <= middle).max(1).min(low.len() - 1);
        let high = low.split_off(at);
        parts[widest] = low;
        parts.push(high);
    }
    parts
}

/// The axis of OKLab along which a part varies most, and how much: its variance times its weight;
/// 0 for a single box.
fn widest_axis(part: &[ColorBox]) -> (usize, f64) {
    if part.len() < 2 {
        return (0, 0.0);
    }
    let middle = mean(part);
    let along = |axis: usize| -> f64 {
        part.iter().map(|b| f64::from(b.lab[axis] - middle[axis]).powi(2) * b.weight).sum()
    };
    let spreads = [along(0), along(1), along(2)];
    let axis = (0..3).fold(0, |best, axis| if spreads[axis] > spreads[best] { axis } else { best });
    (axis, spreads[axis])
}

fn mean(part: &[ColorBox]) -> [f32; 3] {
    let weight: f64 = part.iter().map(|b| b.weight).sum();
    [0, 1, 2].map(|axis| {
        let sum: f64 = part.iter().map(|b| f64::from(b.lab[axis]) * b.weight).sum();
        (sum / weight) as f32
    })
}

/// The middles of the boxes that are nearest to each center; a center without any stays.
fn means_of_nearest(boxes: &[ColorBox], centers: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut nearest: Vec<Vec<ColorBox>> = vec![Vec::new(); centers.len()];
    for known in boxes {
        let distance = |center: &[f32; 3]| -> f32 {
            center.iter().zip(known.lab).map(|(a, b)| (a - b) * (a - b)).sum()
        };
        let mut best = (0, f32::INFINITY);
        for (i, center) in centers.iter().enumerate() {
            let off = distance(center);
            if off < best.1 {
                best = (i, off);
            }
        }
        nearest[best.0].push(*known);
    }
    let middle = |(part, center): (&Vec<ColorBox>, &[f32; 3])| {
        if part.is_empty() { *center } else { mean(part) }
    };
    nearest.iter().zip(centers).map(middle).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixels of these colors, so many of each.
    fn pixels(of: &[([u8; 4], usize)]) -> Vec<u8> {
        of.iter().flat_map(|(color, count)| color.repeat(*count)).collect()
    }

    fn colors_of_pixels(rgba: &[u8], count: usize) -> Vec<Color> {
        let mut counter = ColorCounter::default();
        // In two parts, of whole pixels.
        let (first, second) = rgba.split_at(rgba.len() / 8 * 4);
        [first, second].into_iter().for_each(|part| counter.add(part));
        counter.colors(count)
    }

    #[test]
    fn a_few_flat_colors_are_found_as_they_are_from_dark_to_light() {
        let flat = [([250, 240, 90, 255], 7), ([20, 30, 60, 255], 900), ([190, 40, 40, 255], 31)];
        let found = colors_of_pixels(&pixels(&flat), 12);
        let said: Vec<String> = found.iter().map(Color::to_string).collect();
        assert_eq!(said, ["#141e3c", "#be2828", "#faf05a"]);
    }

    #[test]
    fn fewer_colors_than_there_are_stand_for_the_most_of_them() {
        let near = [([200, 30, 30, 255], 50), ([208, 34, 30, 255], 50), ([20, 60, 220, 255], 60)];
        let found = colors_of_pixels(&pixels(&near), 2);
        assert_eq!(found.len(), 2);
        let [blue, red] = [found[0], found[1]];
        assert!(blue.b > 210 && blue.r < 30, "{blue}");
        assert!((200..=208).contains(&red.r) && red.b < 40, "{red}");
    }

    #[test]
    fn what_is_transparent_does_not_count() {
        assert_eq!(colors_of_pixels(&pixels(&[([9, 200, 9, 0], 80)]), 4), []);
        let found = colors_of_pixels(&pixels(&[([9, 200, 9, 0], 80), ([9, 9, 9, 200], 1)]), 4);
        assert_eq!(found, [Color::rgb(9, 9, 9)]);
        assert_eq!(colors_of_pixels(&[], 4), []);
        assert_eq!(colors_of_pixels(&[1, 2, 3, 255], 0), []);
    }

    #[test]
    fn a_ramp_is_divided_evenly_and_the_order_of_its_pixels_does_not_matter() {
        let ramp: Vec<[u8; 4]> = (0..=255).map(|v| [v, v, v, 255]).collect();
        let forth = colors_of_pixels(&ramp.concat(), 5);
        let back: Vec<[u8; 4]> = ramp.iter().rev().copied().collect();
        assert_eq!(forth, colors_of_pixels(&back.concat(), 5));
        let lightness: Vec<f32> =
            forth.iter().map(|color| oklab::from_linear(color.linear())[0]).collect();
        let steps: Vec<f32> = lightness.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(steps.iter().all(|step| (0.12..0.28).contains(step)), "{lightness:?}");
    }
}
