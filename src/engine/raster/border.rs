//! The border of a picture, and what is joined to it. Floor 1.

use super::Plane;
use crate::math::Size;

/// Indices of the outermost pixels.
pub fn outermost(size: Size) -> Vec<usize> {
    let (w, h) = (size.width as usize, size.height as usize);
    if w < 3 || h < 3 {
        return (0..w * h).collect();
    }
    let rows = (0..w).chain((h - 1) * w..h * w);
    rows.chain((1..h - 1).flat_map(|y| [y * w, y * w + w - 1])).collect()
}

/// The pixels that are joined to the border over four neighbors, through pixels that `is` accepts by
/// their index.
pub fn connected_to_border(size: Size, is: impl Fn(usize) -> bool) -> Plane<bool> {
    let (w, h) = (size.width as usize, size.height as usize);
    let mut found = Plane::full(size, false);
    // No file has more pixels than 32 bits count.
    let mut front: Vec<u32> =
        outermost(size).into_iter().filter(|&i| is(i)).map(|i| i as u32).collect();
    front.iter().for_each(|&i| found.values_mut()[i as usize] = true);
    // Ring after ring, so that only two rings are in memory.
    while !front.is_empty() {
        let mut next = Vec::new();
        let mut visit = |j: usize| {
            if !found.values()[j] && is(j) {
                found.values_mut()[j] = true;
                next.push(j as u32);
            }
        };
        for i in front.into_iter().map(|i| i as usize) {
            let (x, y) = (i % w, i / w);
            if x > 0 {
                visit(i - 1);
            }
            if x + 1 < w {
                visit(i + 1);
            }
            if y > 0 {
                visit(i - w);
            }
            if y + 1 < h {
                visit(i + w);
            }
        }
        front = next;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_to_the_border_is_found_and_what_is_enclosed_is_not() {
        let rows = ["..#..", ".###.", ".#.#.", ".###.", "....."];
        let size = Size::new(5, 5);
        let is_open = |i: usize| rows[i / 5].as_bytes()[i % 5] == b'.';
        let found = connected_to_border(size, is_open);
        let expected = Plane::from_fn(size, |x, y| is_open(y * 5 + x) && (x, y) != (2, 2));
        assert!(found == expected);
    }

    #[test]
    fn the_outermost_pixels_are_those_of_the_first_and_last_rows_and_columns() {
        for (w, h) in [(1, 1), (2, 5), (5, 2), (3, 3), (6, 4)] {
            let mut found = outermost(Size::new(w, h));
            found.sort_unstable();
            let is_outer = |i: &usize| {
                let (x, y) = (*i as u32 % w, *i as u32 / w);
                x == 0 || y == 0 || x + 1 == w || y + 1 == h
            };
            assert_eq!(found, (0..(w * h) as usize).filter(is_outer).collect::<Vec<_>>());
        }
    }
}
