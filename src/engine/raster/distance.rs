//! How far each pixel is from the nearest marked one, up to a limit.
//! Floor 1. Exact, between pixel centres (Meijster, Roerdink and Hesselink 2000: columns first, then along rows).

use super::Plane;
use rayon::prelude::*;

/// The farthest limit, px: its square fits the planes.
pub const FARTHEST: u16 = 200;

/// Squared distances to the nearest marked pixel (not 0), px²; `(limit + 1)²` where it is farther than `limit` px.
///
/// `limit`: at most [`FARTHEST`]; more counts as that. What lies beyond the plane is not marked.
pub fn squared(marked: &Plane<u8>, limit: u16) -> Plane<u16> {
    let limit = limit.min(FARTHEST);
    let far = limit + 1;
    let width = marked.width().max(1);
    let mut along_columns = marked.map(|m| if m != 0 { 0 } else { far });
    let rows = along_columns.values_mut();
    let height = rows.len() / width;
    for y in 1..height {
        let (before, row) = rows.split_at_mut(y * width);
        step(&before[(y - 1) * width..], &mut row[..width], far);
    }
    for y in (1..height).rev() {
        let (row, after) = rows.split_at_mut(y * width);
        step(&after[..width], &mut row[(y - 1) * width..], far);
    }
    along_columns.values_mut().par_chunks_mut(width).for_each(|row| {
        let squares: Vec<u16> = row.iter().map(|d| d * d).collect();
        row.copy_from_slice(&squares);
        for k in 1..=usize::from(limit).min(width - 1) {
            nearer(&squares[k..], &mut row[..width - k], (k * k) as u16);
            nearer(&squares[..width - k], &mut row[k..], (k * k) as u16);
        }
        row.iter_mut().filter(|d| **d > limit * limit).for_each(|d| *d = far * far);
    });
    along_columns
}

crate::widest! {
    /// A row is one further from what the row beside it is near to.
    fn step(beside: &[u16], row: &mut [u16], far: u16) {
        for (d, b) in row.iter_mut().zip(beside) {
            *d = (*d).min(b + 1).min(far);
        }
    }
    fn nearer(squares: &[u16], row: &mut [u16], more: u16) {
        for (d, s) in row.iter_mut().zip(squares) {
            *d = (*d).min(s.saturating_add(more));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, hash};

    #[test]
    fn distances_are_those_to_the_nearest_of_all_marks() {
        let size = Size::new(70, 45);
        for share in [0.002, 0.05, 0.9] {
            let marked = Plane::from_fn(size, |x, y| u8::from(hash::unit(7, x as u32, y as u32) < share));
            let found = squared(&marked, 12);
            let all = (0..45i32).flat_map(|y| (0..70i32).map(move |x| (x, y)));
            let marks: Vec<(i32, i32)> = all.clone().filter(|&(x, y)| marked.at(x as usize, y as usize) != 0).collect();
            for (x, y) in all {
                let nearest = marks.iter().map(|m| (m.0 - x).pow(2) + (m.1 - y).pow(2)).min().unwrap_or(i32::MAX);
                let expected = if nearest <= 144 { nearest } else { 169 };
                assert_eq!(i32::from(found.at(x as usize, y as usize)), expected, "({x}, {y})");
            }
        }
    }
    #[test]
    fn without_a_mark_everything_is_farther_than_the_limit() {
        let found = squared(&Plane::filled(Size::new(3, 2), 0), u16::MAX);
        assert!(found.values().iter().all(|&d| d == (FARTHEST + 1).pow(2)));
    }
}
