//! The distance of each pixel from the nearest marked one, up to a limit. Floor 1. Exact, between
//! pixel centers (Meijster, Roerdink and Hesselink 2000: columns first, then along rows).

use super::Plane;
use crate::math::parallel;

/// The farthest limit, px: its square fits the planes.
pub const FARTHEST: u16 = 200;

/// Squared distances to the nearest marked pixel (not 0), px²; `(limit + 1)²` where it is farther
/// than `limit` px.
///
/// `limit`: at most [`FARTHEST`]; more counts as that. Nothing beyond the plane is marked.
pub fn squared_distances(marked: &Plane<u8>, limit: u16) -> Plane<u16> {
    let limit = limit.min(FARTHEST);
    let (width, height) = (marked.width().max(1), marked.height());
    // Bands of rows, each with enough rows around it that no nearer mark lies beyond.
    let around = usize::from(limit);
    let band = (2 * around).max(LEAST_BAND);
    let mut out = Plane::full(marked.size(), 0u16);
    parallel::for_each_with(
        out.values_mut().chunks_mut(band * width).enumerate(),
        1,
        Vec::new,
        |columns, (i, out)| {
            let (first, rows) = (i * band, out.len() / width);
            let from = first.saturating_sub(around);
            let to = (first + rows + around).min(height);
            fill_columns(&marked.values()[from * width..to * width], width, limit + 1, columns);
            let own = &columns[(first - from) * width..][..out.len()];
            for (row, own) in out.chunks_exact_mut(width).zip(own.chunks_exact(width)) {
                fill_row(own, limit, row);
            }
        },
    );
    out
}

/// Rows of a band at least.
const LEAST_BAND: usize = 64;

/// Distances down and up the columns of some rows, at most `far`.
fn fill_columns(marked: &[u8], width: usize, far: u16, columns: &mut Vec<u16>) {
    columns.clear();
    columns.extend(marked.iter().map(|&m| if m != 0 { 0 } else { far }));
    let height = columns.len() / width;
    for y in 1..height {
        let (before, row) = columns.split_at_mut(y * width);
        step(&before[(y - 1) * width..], &mut row[..width], far);
    }
    for y in (1..height).rev() {
        let (row, after) = columns.split_at_mut(y * width);
        step(&after[..width], &mut row[(y - 1) * width..], far);
    }
}

/// Squared distances along a row of distances along columns.
fn fill_row(columns: &[u16], limit: u16, row: &mut [u16]) {
    let far = limit + 1;
    let (least, most) =
        columns.iter().fold((far, 0), |(least, most), &d| (least.min(d), most.max(d)));
    if least == far || most == 0 {
        return row.fill(least * least);
    }
    let squares: Vec<u16> = columns.iter().map(|d| d * d).collect();
    row.copy_from_slice(&squares);
    let width = row.len();
    for k in 1..=usize::from(limit).min(width - 1) {
        nearer(&squares[k..], &mut row[..width - k], (k * k) as u16);
        nearer(&squares[..width - k], &mut row[k..], (k * k) as u16);
    }
    row.iter_mut().filter(|d| **d > limit * limit).for_each(|d| *d = far * far);
}

crate::widest! {
    /// A row is one farther from a mark than the adjacent row.
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
        // Several bands.
        let size = Size::new(70, 145);
        for share in [0.0005, 0.05, 0.9] {
            let marked =
                Plane::from_fn(size, |x, y| u8::from(hash::unit(7, x as u32, y as u32) < share));
            let found = squared_distances(&marked, 12);
            let all = (0..145i32).flat_map(|y| (0..70i32).map(move |x| (x, y)));
            let marks: Vec<(i32, i32)> =
                all.clone().filter(|&(x, y)| marked.at(x as usize, y as usize) != 0).collect();
            for (x, y) in all {
                let nearest = marks
                    .iter()
                    .map(|m| (m.0 - x).pow(2) + (m.1 - y).pow(2))
                    .min()
                    .unwrap_or(i32::MAX);
                let expected = if nearest <= 144 { nearest } else { 169 };
                assert_eq!(i32::from(found.at(x as usize, y as usize)), expected, "({x}, {y})");
            }
        }
    }

    #[test]
    fn without_a_mark_everything_is_farther_than_the_limit() {
        let found = squared_distances(&Plane::full(Size::new(3, 2), 0), u16::MAX);
        assert!(found.values().iter().all(|&d| d == (FARTHEST + 1).pow(2)));
    }
}
