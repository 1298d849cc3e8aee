//! Grows valid values outward: finds the nearest surface pixel of every pixel.
//! Floor 2.

use crate::raster::Plane;

/// For each pixel the index of a nearest valid pixel (itself where valid); `None` where nothing is valid.
///
/// Two sweeps that pass the nearest candidate on (Danielsson's 8-neighbour scheme: exact but for rare ties within a
/// pixel).
pub fn nearest(valid: &Plane<bool>) -> Option<Plane<u32>> {
    const NONE: u32 = u32::MAX;
    let size = valid.size();
    let (w, h) = (valid.width(), valid.height());
    let mut near = Plane::filled(size, NONE);
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

/// Gives every pixel the value of its nearest valid one, in place: valid pixels are their own.
pub fn fill<T: Copy>(values: &mut Plane<T>, nearest: &Plane<u32>) {
    for i in 0..nearest.values().len() {
        values.values_mut()[i] = values.values()[nearest.values()[i] as usize];
    }
}

/// Removes the coverage of pixels without valid values, except within two pixels of a valid one at a partly covered
/// rim.
pub fn punch_holes(coverage: &mut Plane<u8>, valid: &Plane<bool>) {
    let near_valid = |x: usize, y: usize| {
        (-2..=2).any(|dy| (-2..=2).any(|dx| valid.get(x as i32 + dx, y as i32 + dy).unwrap_or(false)))
    };
    for y in 0..valid.height() {
        for x in 0..valid.width() {
            let c = coverage.at(x, y);
            if c > 0 && !valid.at(x, y) && !(c < 255 && near_valid(x, y)) {
                coverage.set(x, y, 0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    #[test]
    fn the_nearest_valid_pixel_wins() {
        let size = Size::new(9, 7);
        let seeds = [(1usize, 1usize), (7, 5)];
        let valid = Plane::from_fn(size, |x, y| seeds.contains(&(x, y)));
        let near = nearest(&valid).unwrap();
        assert_eq!(near.at(0, 0), 10);
        assert_eq!(near.at(8, 6), 5 * 9 + 7);
        assert!(nearest(&Plane::filled(size, false)).is_none());
    }
}
