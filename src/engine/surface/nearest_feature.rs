//! Grows valid values outward: finds the nearest surface pixel of every pixel.
//! Floor 2.

use crate::math::parallel;
use crate::raster::Plane;

/// A pixel, column and row; [`NONE`] where none is known. Sides of maps are shorter than this
/// holds.
type Place = [u16; 2];
const NONE: Place = [u16::MAX; 2];

/// The nearest place known so far to a pixel, and its squared distance.
struct Nearest {
    at: Place,
    place: Place,
    squared: i64,
}

impl Nearest {
    fn of(at: Place, place: Place) -> Self {
        Self { at, place, squared: Self::square_distance(at, place) }
    }

    fn square_distance(at: Place, place: Place) -> i64 {
        let (dx, dy) =
            (i64::from(at[0]) - i64::from(place[0]), i64::from(at[1]) - i64::from(place[1]));
        if place == NONE { i64::MAX } else { dx * dx + dy * dy }
    }

    /// The nearer of the two; if equal, the one that was known first.
    fn or(self, place: Place) -> Self {
        let squared = Self::square_distance(self.at, place);
        if squared < self.squared { Self { place, squared, ..self } } else { self }
    }
}

/// For each pixel the index of a nearest valid pixel (itself where valid); `None` where nothing is
/// valid.
///
/// Two sweeps that pass the nearest candidate on (Danielsson's 8-neighbor scheme: exact but for
/// rare ties within a pixel). Sides are at most 65,534 px; for longer ones the result is `None`.
pub fn nearest(valid: &Plane<bool>) -> Option<Plane<u32>> {
    let (w, h) = (valid.width(), valid.height());
    let own = |x: usize, y: usize| [x as u16, y as u16];
    let index = |place: Place| u32::from(place[1]) * w as u32 + u32::from(place[0]);
    if w.max(h) >= usize::from(u16::MAX) {
        return None;
    }
    if valid.values().iter().all(|&v| v) {
        return Some(Plane::from_fn(valid.size(), |x, y| index(own(x, y))));
    }
    let mut near =
        Plane::from_fn(valid.size(), |x, y| if valid.at(x, y) { own(x, y) } else { NONE });
    let beyond = vec![NONE; w];
    for y in 0..h {
        let (above, here) = near.values_mut().split_at_mut(y * w);
        let above = if y == 0 { &beyond[..] } else { &above[(y - 1) * w..] };
        sweep_right(&mut here[..w], above, y);
        for x in (0..w.saturating_sub(1)).rev() {
            here[x] = Nearest::of(own(x, y), here[x]).or(here[x + 1]).place;
        }
    }
    for y in (0..h).rev() {
        let (here, below) = near.values_mut().split_at_mut((y + 1) * w);
        let (here, below) =
            (&mut here[y * w..], if y + 1 == h { &beyond[..] } else { &below[..w] });
        sweep_left(here, below, y);
        for x in 1..w {
            here[x] = Nearest::of(own(x, y), here[x]).or(here[x - 1]).place;
        }
    }
    near.values().iter().all(|&place| place != NONE).then(|| near.map(index))
}

/// The nearest valid pixels that were found last: maps made one after another are mostly valid in
/// the same ones.
#[derive(Default)]
pub struct NearestCache(Option<(Plane<bool>, Plane<u32>)>);

impl NearestCache {
    /// Nothing is kept for larger maps: it takes 5 bytes a pixel.
    const MOST_PX: usize = 1 << 22;

    /// Like [`nearest`], but takes what was kept if it is for the same pixels.
    pub fn take(&mut self, valid: &Plane<bool>) -> Option<Plane<u32>> {
        match self.0.take() {
            Some((known, nearest)) if known == *valid => Some(nearest),
            _ => nearest(valid),
        }
    }

    /// Keeps it for the next map.
    pub fn keep(&mut self, valid: &Plane<bool>, nearest: Plane<u32>) {
        self.0 = (valid.size().area() <= Self::MOST_PX).then(|| (valid.clone(), nearest));
    }
}

/// Takes in what is known in the row above and on the left.
fn sweep_right(here: &mut [Place], above: &[Place], y: usize) {
    for x in 0..here.len() {
        let at = [x as u16, y as u16];
        if here[x] == at {
            continue;
        }
        let mut best = Nearest::of(at, here[x]);
        best = if x > 0 { best.or(here[x - 1]) } else { best };
        best = best.or(above[x]);
        best = if x > 0 { best.or(above[x - 1]) } else { best };
        here[x] = if x + 1 < above.len() { best.or(above[x + 1]) } else { best }.place;
    }
}

/// Takes in what is known in the row below and on the right.
fn sweep_left(here: &mut [Place], below: &[Place], y: usize) {
    for x in (0..here.len()).rev() {
        let at = [x as u16, y as u16];
        if here[x] == at {
            continue;
        }
        let mut best = Nearest::of(at, here[x]);
        best = if x + 1 < here.len() { best.or(here[x + 1]) } else { best };
        best = best.or(below[x]);
        best = if x > 0 { best.or(below[x - 1]) } else { best };
        here[x] = if x + 1 < below.len() { best.or(below[x + 1]) } else { best }.place;
    }
}

/// Gives every pixel the value of its nearest valid one, in place: valid pixels are their own.
pub fn fill<T: Copy>(values: &mut Plane<T>, nearest: &Plane<u32>) {
    for i in 0..nearest.values().len() {
        values.values_mut()[i] = values.values()[nearest.values()[i] as usize];
    }
}

/// Removes the coverage of pixels without valid values, except within two pixels of a valid one at
/// a partly covered rim.
pub fn punch_holes(coverage: &mut Plane<u8>, valid: &Plane<bool>) {
    let near_valid = |x: usize, y: usize| {
        (-2..=2)
            .any(|dy| (-2..=2).any(|dx| valid.get(x as i32 + dx, y as i32 + dy).unwrap_or(false)))
    };
    let width = valid.width().max(1);
    parallel::for_each_row(coverage.values_mut(), width, 1, |y, row| {
        for (x, (c, valid)) in row.iter_mut().zip(valid.row(y)).enumerate() {
            if *c > 0 && !valid && !(*c < 255 && near_valid(x, y)) {
                *c = 0;
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, hash};

    #[test]
    fn the_nearest_valid_pixel_wins() {
        let size = Size::new(9, 7);
        let seeds = [(1usize, 1usize), (7, 5)];
        let valid = Plane::from_fn(size, |x, y| seeds.contains(&(x, y)));
        let near = nearest(&valid).unwrap();
        assert_eq!(near.at(0, 0), 10);
        assert_eq!(near.at(8, 6), 5 * 9 + 7);
        assert!(nearest(&Plane::full(size, false)).is_none());
    }

    #[test]
    fn what_is_known_of_a_map_is_given_back_for_the_same_one_alone() {
        let valid = |seed: u32| {
            Plane::from_fn(Size::new(30, 20), move |x, y| {
                hash::unit(seed, x as u32, y as u32) < 0.1
            })
        };
        let mut known = NearestCache::default();
        for seed in [1, 1, 2, 1] {
            let found = known.take(&valid(seed)).unwrap();
            assert!(found == nearest(&valid(seed)).unwrap(), "{seed}");
            known.keep(&valid(seed), found);
        }
        let marked = Plane::full(Size::new(30, 20), 7);
        known.keep(&valid(1), marked.clone());
        assert!(known.take(&valid(1)) == Some(marked), "it is not sought again");
        assert!(known.take(&Plane::full(Size::new(3, 2), false)).is_none());
    }

    /// The same sweeps pixel by pixel.
    fn nearest_as_told(valid: &Plane<bool>) -> Option<Plane<u32>> {
        const NONE: u32 = u32::MAX;
        let size = valid.size();
        let (w, h) = (valid.width(), valid.height());
        let mut near = Plane::full(size, NONE);
        for (i, &v) in valid.values().iter().enumerate() {
            if v {
                near.values_mut()[i] = i as u32;
            }
        }
        if valid.values().iter().all(|&v| v) {
            return Some(near);
        }
        let distance = |x: usize, y: usize, i: u32| {
            let (dx, dy) = (x as i64 - i64::from(i) % w as i64, y as i64 - i64::from(i) / w as i64);
            if i == NONE { i64::MAX } else { dx * dx + dy * dy }
        };
        let mut relax = |x: usize, y: usize, from: &[(i32, i32)]| {
            let mut best = near.at(x, y);
            for &(dx, dy) in from {
                if let Some(candidate) = near.get(x as i32 + dx, y as i32 + dy)
                    && distance(x, y, candidate) < distance(x, y, best)
                {
                    best = candidate;
                }
            }
            near.set(x, y, best);
        };
        for y in 0..h {
            (0..w).for_each(|x| relax(x, y, &[(-1, 0), (0, -1), (-1, -1), (1, -1)]));
            (0..w).rev().for_each(|x| relax(x, y, &[(1, 0)]));
        }
        for y in (0..h).rev() {
            (0..w).rev().for_each(|x| relax(x, y, &[(1, 0), (0, 1), (-1, 1), (1, 1)]));
            (0..w).for_each(|x| relax(x, y, &[(-1, 0)]));
        }
        near.values().iter().all(|&i| i != NONE).then_some(near)
    }

    #[test]
    fn sweeps_by_rows_find_what_sweeps_by_pixels_find() {
        for (k, size) in [Size::new(1, 1), Size::new(1, 9), Size::new(13, 1), Size::new(64, 47)]
            .into_iter()
            .enumerate()
        {
            for share in [0.0, 0.003, 0.05, 0.5, 1.0] {
                let valid =
                    Plane::from_fn(size, |x, y| hash::unit(k as u32, x as u32, y as u32) < share);
                assert!(nearest(&valid) == nearest_as_told(&valid), "{size} {share}");
            }
        }
    }
}
