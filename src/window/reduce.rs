//! Large pictures reduced to small ones, quickly. Floor 7. Not here: what is painted small at once
//! (`thumbnails`).

use crate::math::{Rect, Size};
use eframe::egui::{Color32, ColorImage};

/// Pixels that are read of each square, along a side: lines that lie close together become the gray
/// that they make, and a picture of 4096 × 4096 pixels takes no more than one of 800 × 800.
const MOST_SAMPLES: u32 = 4;

/// How a large picture is reduced: each pixel of the small one is the mean of a square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reduction {
    size: Size,
    /// The side of a square, px.
    step: u32,
}

impl Reduction {
    /// The longer side of the small picture has as many px as are asked for at most.
    pub fn new(size: Size, longest_px: u32) -> Self {
        Self { size, step: size.width.max(size.height).div_ceil(longest_px.max(1)).max(1) }
    }

    /// The small picture. `at`: a pixel of the large one, its color premultiplied by its alpha.
    pub fn reduce(self, at: impl Fn(i32, i32) -> [u8; 4]) -> ColorImage {
        let [width, height] =
            [self.size.width, self.size.height].map(|side| side.div_ceil(self.step) as usize);
        let mut image = ColorImage::filled([width, height], Color32::TRANSPARENT);
        self.update(&mut image, self.size.rect(), at);
        image
    }

    /// Makes the small picture again where the large one has changed, in a rectangle of its px.
    pub fn update(self, image: &mut ColorImage, changed: Rect, at: impl Fn(i32, i32) -> [u8; 4]) {
        let changed = changed.intersect(self.size.rect());
        if changed.is_empty() {
            return;
        }
        let first = |px: i32| px as u32 / self.step;
        let end = |px: i32| (px as u32).div_ceil(self.step);
        for y in first(changed.y0)..end(changed.y1) {
            for x in first(changed.x0)..end(changed.x1) {
                image[(x as usize, y as usize)] = self.mean(x, y, &at);
            }
        }
    }

    /// The mean of a square's samples.
    fn mean(self, x: u32, y: u32, at: impl Fn(i32, i32) -> [u8; 4]) -> Color32 {
        let samples = self.step.min(MOST_SAMPLES);
        let count = samples * samples;
        // Each sample of a square has a row and a column of its own, as far as there are as many: on
        // a regular grid all of them could fall between stripes.
        let place = |square: u32, sample: u32, other: u32| {
            square * self.step + (2 * (sample * samples + other) + 1) * self.step / (2 * count)
        };
        let mut sums = [0_u32; 4];
        for (j, i) in (0..samples).flat_map(|j| (0..samples).map(move |i| (j, i))) {
            let x = place(x, i, j).min(self.size.width - 1);
            let y = place(y, j, i).min(self.size.height - 1);
            let pixel = at(x as i32, y as i32);
            sums.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += u32::from(value));
        }
        let [r, g, b, a] = sums.map(|sum| ((sum + count / 2) / count) as u8);
        Color32::from_rgba_premultiplied(r, g, b, a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reduce(size: Size, longest: u32, at: impl Fn(i32, i32) -> [u8; 4]) -> ColorImage {
        Reduction::new(size, longest).reduce(at)
    }

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
    fn a_changed_part_alone_is_made_again() {
        let (before, after) = (|_: i32, _: i32| [9; 4], |x: i32, y: i32| [(x ^ y) as u8; 4]);
        for (side, longest) in [(640, 200), (4096, 200), (100, 200)] {
            let reduction = Reduction::new(size(side, side), longest);
            let changed = Rect::new(64, 32, 96, 5000);
            let is_in = |x: i32, y: i32| (64..96).contains(&x) && y >= 32;
            let mixed = |x: i32, y: i32| if is_in(x, y) { after(x, y) } else { before(x, y) };
            let mut image = reduction.reduce(before);
            reduction.update(&mut image, changed, mixed);
            assert_eq!(image.pixels, reduction.reduce(mixed).pixels, "{side}");
            reduction.update(&mut image, Rect::new(-50, -50, 0, 0), after);
            assert_eq!(image.pixels, reduction.reduce(mixed).pixels, "{side}");
        }
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
