//! Rows and items side by side on all threads. Floor 0.
//!
//! Of `rayon`'s functions every closure gets copies of its own, some fifty with the closure in most of
//! them, which were a third of the engine for the compiler. Here all callers share them. Not for single
//! pixels: each item takes some forty bytes more and a lock.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Pieces of the work for each thread, so that one that is done early finds another piece.
const PIECES: usize = 8;

/// Calls a function for every row, with its number.
///
/// * `width`: values of a row, at least 1; the last row may be shorter.
/// * `least`: rows that are sooner done than handed to another thread.
pub fn for_each_row<T: Send>(
    values: &mut [T],
    width: usize,
    least: usize,
    each: impl Fn(usize, &mut [T]) + Sync,
) {
    let piece = piece_of(values.len().div_ceil(width), least);
    halve_rows(values, 0, (width, piece), &each);
}

/// Calls a function for every item.
///
/// * `least`: items that are sooner done than handed to another thread.
pub fn for_each<T: Send>(
    items: impl IntoIterator<Item = T>,
    least: usize,
    each: impl Fn(T) + Sync,
) {
    for_each_with(items, least, || (), |(), item| each(item));
}

/// Calls a function for every item, with what `init` makes for each piece of the work, such as buffers.
///
/// * `least`: items that are sooner done than handed to another thread.
pub fn for_each_with<T: Send, B>(
    items: impl IntoIterator<Item = T>,
    least: usize,
    init: impl Fn() -> B + Sync,
    each: impl Fn(&mut B, T) + Sync,
) {
    let items: Vec<Mutex<Option<T>>> =
        items.into_iter().map(|item| Mutex::new(Some(item))).collect();
    let piece = piece_of(items.len(), least);
    halve(0..items.len(), piece, &|range| {
        let mut with = init();
        for item in &items[range] {
            let item = item.lock().unwrap_or_else(PoisonError::into_inner).take();
            item.into_iter().for_each(|item| each(&mut with, item));
        }
    });
}

/// What a function makes of each of the numbers below `count`, in their order.
///
/// * `least`: numbers that are sooner done than handed to another thread.
pub fn collect<T: Send>(count: usize, least: usize, make: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let made: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    halve(0..count, piece_of(count, least), &|range| {
        range.for_each(|i| *made[i].lock().unwrap_or_else(PoisonError::into_inner) = Some(make(i)));
    });
    let made =
        made.into_iter().map(|made| made.into_inner().unwrap_or_else(PoisonError::into_inner));
    made.flatten().collect()
}

/// What a function makes of each item, in their order.
pub fn map<T: Send, U: Send>(
    items: impl IntoIterator<Item = T>,
    make: impl Fn(T) -> U + Sync,
) -> Vec<U> {
    map_with(items, || (), |(), item| make(item))
}

/// What a function makes of each item, in their order, with what `init` makes for each piece of the
/// work, such as buffers.
pub fn map_with<T: Send, U: Send, B>(
    items: impl IntoIterator<Item = T>,
    init: impl Fn() -> B + Sync,
    make: impl Fn(&mut B, T) -> U + Sync,
) -> Vec<U> {
    let items: Vec<T> = items.into_iter().collect();
    let mut made: Vec<Option<U>> = Vec::with_capacity(items.len());
    made.resize_with(items.len(), || None);
    let both = items.into_iter().zip(&mut made);
    for_each_with(both, 1, init, |with, (item, made)| *made = Some(make(with, item)));
    made.into_iter().flatten().collect()
}

/// Items that one thread does without looking for another that would help.
fn piece_of(count: usize, least: usize) -> usize {
    (count / (PIECES * rayon::current_num_threads())).max(least).max(1)
}

/// A range of items: a piece at once, more in two halves.
fn halve(range: Range<usize>, piece: usize, work: &(dyn Fn(Range<usize>) + Sync)) {
    if range.len() <= piece {
        return work(range);
    }
    let middle = range.start + range.len() / 2;
    rayon::join(
        || halve(range.start..middle, piece, work),
        || halve(middle..range.end, piece, work),
    );
}

/// Rows from the number `first`: those of a piece one after the other, more in two halves.
fn halve_rows<T: Send>(
    values: &mut [T],
    first: usize,
    (width, piece): (usize, usize),
    each: &(dyn Fn(usize, &mut [T]) + Sync),
) {
    let rows = values.len().div_ceil(width);
    if rows <= piece {
        (first..).zip(values.chunks_mut(width)).for_each(|(y, row)| each(y, row));
        return;
    }
    let (upper, lower) = values.split_at_mut(rows / 2 * width);
    rayon::join(
        || halve_rows(upper, first, (width, piece), each),
        || halve_rows(lower, first + rows / 2, (width, piece), each),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_called_once_with_its_number() {
        for (count, width, least) in [(0, 3, 1), (1, 3, 1), (7, 3, 1), (1000, 1, 1), (999, 10, 40)]
        {
            let mut values = vec![0; count];
            for_each_row(&mut values, width, least, |y, row| {
                row.iter_mut().for_each(|value| *value += 1 + y);
            });
            let expected: Vec<usize> = (0..count).map(|i| 1 + i / width).collect();
            assert_eq!(values, expected, "{count} values in rows of {width}");
        }
    }

    #[test]
    fn every_item_is_called_once_and_keeps_its_place() {
        for count in [0, 1, 2, 1000] {
            let squares: Vec<usize> = (0..count).map(|i| i * i).collect();
            assert_eq!(collect(count, 3, |i| i * i), squares);
            assert_eq!(map(0..count, |i| i * i), squares);
            let mut items: Vec<usize> = (0..count).collect();
            for_each(&mut items, 1, |item| *item *= *item);
            assert_eq!(items, squares);
        }
    }

    #[test]
    fn what_is_made_for_a_piece_is_handed_from_item_to_item() {
        let counts = map_with(
            0..1000,
            || 0,
            |count, _| {
                *count += 1;
                *count
            },
        );
        let pieces = counts.iter().filter(|count| **count == 1).count();
        assert!((1..1000).contains(&pieces), "{pieces}");
        assert!(counts.windows(2).all(|pair| pair[1] == 1 || pair[1] == pair[0] + 1));
    }

    #[test]
    fn a_panic_comes_back_to_the_caller() {
        let fails = || for_each(0..100, 1, |i| assert_ne!(i, 50));
        assert!(std::panic::catch_unwind(fails).is_err());
    }
}
