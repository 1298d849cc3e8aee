//! Rows of pixels averaged into rows of another scale: the inner loop of making layers small. Floor
//! 4.

use super::source_weights;
use crate::raster::TILE;
use std::ops::Range;

/// The old pixels under a run of at most [`TILE`] new ones along one axis, and their weights.
pub(super) struct AxisTaps {
    first: i32,
    end: i32,
    /// One after another for each new pixel: places counted from the first, and weights.
    taps: Vec<(u32, f32)>,
    /// Where the taps of each new pixel end.
    ends: Vec<u32>,
}

impl AxisTaps {
    /// `pixels`: the new ones; `scale`: new pixels per old one.
    pub fn new(pixels: Range<i32>, scale: f32) -> Self {
        let all: Vec<_> = pixels.map(|i| source_weights(i, scale)).collect();
        let first = all.iter().flatten().map(|tap| tap.0).min().unwrap_or(0);
        let end = all.iter().flatten().map(|tap| tap.0 + 1).max().unwrap_or(0);
        let (mut taps, mut ends) = (Vec::new(), Vec::new());
        for of_pixel in all {
            taps.extend(of_pixel.into_iter().map(|(i, weight)| ((i - first) as u32, weight)));
            ends.push(taps.len() as u32);
        }
        Self { first, end, taps, ends }
    }

    /// The first old pixel, and the one after the last.
    pub fn first(&self) -> i32 {
        self.first
    }

    pub fn end(&self) -> i32 {
        self.end
    }
}

crate::widest! {
    /// Adds a row of old pixels to the sums of the new ones. `row`: from the first old pixel on;
    /// `weight`: the row's.
    pub(super) fn add_row(columns: &AxisTaps, weight: f32, row: &[[f32; 4]], sums: &mut [[f32; 4]; TILE]) {
        let mut start = 0;
        for (sum, &end) in sums.iter_mut().zip(&columns.ends) {
            for &(i, tap) in &columns.taps[start..end as usize] {
                let (pixel, share) = (row[i as usize], tap * weight);
                for c in 0..4 {
                    sum[c] += share * pixel[c];
                }
            }
            start = end as usize;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_add_up_to_the_mean_of_what_each_new_pixel_covers() {
        for scale in [0.5, 0.25, 0.3, 1.0, 1.7] {
            let columns = AxisTaps::new(-64..0, scale);
            let value = |x: i32, c: usize| ((x * 37 + 11 * c as i32) & 255) as u8;
            let row: Vec<[f32; 4]> = (columns.first()..columns.end())
                .map(|x| std::array::from_fn(|c| f32::from(value(x, c))))
                .collect();
            let mut sums = [[1.0; 4]; TILE];
            add_row(&columns, 0.75, &row, &mut sums);
            for (x, sum) in (-64..0).zip(sums) {
                for (c, found) in sum.into_iter().enumerate() {
                    let mean = source_weights(x, scale)
                        .iter()
                        .fold(1.0, |s, (x, w)| s + w * 0.75 * f32::from(value(*x, c)));
                    assert_eq!(found, mean, "scale {scale}, {x}, {c}");
                }
            }
        }
    }
}
