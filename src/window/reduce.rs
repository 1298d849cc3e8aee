//! Large pictures reduced to small ones, quickly. Floor 7. Not here: what is painted small at once
//! (`thumbnails`).

use crate::math::Size;
use eframe::egui::{Color32, ColorImage};

/// Pixels that are read of each square, along a side: lines that lie close together become the gray
/// that they make, and a picture of 4096 × 4096 pixels takes no more than one of 800 × 800.
const MOST_SAMPLES: u32 = 4;

/// A picture whose pixels are the means of squares of a larger one; the longer side has as many px
/// as are asked for at most. `at`: a pixel, with its color premultiplied by its alpha.
pub fn reduce(size: Size, longest_px: u32, at: impl Fn(i32, i32) -> [u8; 4]) -> ColorImage {
    let step = size.width.max(size.height).div_ceil(longest_px.max(1)).max(1);
    let [width, height] = [size.width, size.height].map(|side| side.div_ceil(step));
    let samples = step.min(MOST_SAMPLES);
    let count = samples * samples;
    // No two samples of a square share a row or a column, unless all of its pixels are read: regular
    // ones would fall between stripes.
    let place = |square: u32, sample: u32, other: u32| {
        square * step + (2 * (sample * samples + other) + 1) * step / (2 * count)
    };
    let mean = |x: u32, y: u32| {
        let mut sums = [0_u32; 4];
        for (j, i) in (0..samples).flat_map(|j| (0..samples).map(move |i| (j, i))) {
            let (x, y) = (place(x, i, j).min(size.width - 1), place(y, j, i).min(size.height - 1));
            let pixel = at(x as i32, y as i32);
            sums.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += u32::from(value));
        }
        let [r, g, b, a] = sums.map(|sum| ((sum + count / 2) / count) as u8);
        Color32::from_rgba_premultiplied(r, g, b, a)
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixels = pixels.map(|(x, y)| mean(x, y)).collect();
    ColorImage::new([width as usize, height as usize], pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(width: u32, height: u32) -> Size {
        Size { width, height }
    }

    #[test]
    fn stripes_become_the_gray_that_they_make() {
        let striped = |x: i32, _: i32| [[0, 0, 0, 255], [200, 200, 200, 255]][x as usize % 2];
        for (side, longest) in [(640, 200), (3200, 200), (4200, 200), (300, 80)] {
            let image = reduce(size(side, side), longest, striped);
            let away = image.pixels.iter().map(|pixel| pixel.r().abs_diff(100)).max().unwrap();
            assert!(away <= 25, "{side}: {away}");
        }
    }

    #[test]
    fn small_pictures_stay_as_they_are() {
        let at = |x: i32, y: i32| [x as u8, y as u8, 0, 255];
        let image = reduce(size(30, 20), 200, at);
        assert_eq!(image.size, [30, 20]);
        assert_eq!(image.pixels[30 * 7 + 11], Color32::from_rgba_premultiplied(11, 7, 0, 255));
    }

    #[test]
    fn the_longer_side_is_no_longer_and_every_place_is_inside() {
        for (width, height) in [(1, 1), (1, 5000), (401, 199), (4096, 4096)] {
            let within = |x: i32, y: i32| {
                assert!((0..width as i32).contains(&x) && (0..height as i32).contains(&y));
                [255; 4]
            };
            let image = reduce(size(width, height), 200, within);
            assert!(image.size.iter().all(|side| (1..=200).contains(side)), "{:?}", image.size);
            assert!(image.pixels.iter().all(|pixel| *pixel == Color32::WHITE));
        }
    }
}
