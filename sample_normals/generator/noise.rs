//! Deterministic noise: hashes, gradient noise, fractal sums and cells, each with an optional
//! period. Not here: what the noise is used for (`shapes`, `pictures`).

use glam::{DVec2, DVec3};

/// A 64-bit mix of three lattice coordinates and a seed; every bit of the result is usable.
fn mix(x: i64, y: i64, z: i64, seed: u64) -> u64 {
    let mut h = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15)
        ^ (x as u64).wrapping_mul(0xD6E8_FEB8_6659_FD93)
        ^ (y as u64).wrapping_mul(0xA076_1D64_78BD_642F).rotate_left(21)
        ^ (z as u64).wrapping_mul(0xE703_7ED1_A0B4_28DB).rotate_left(42);
    for _ in 0..2 {
        h ^= h >> 32;
        h = h.wrapping_mul(0xD6E8_FEB8_6659_FD93);
    }
    h ^ (h >> 32)
}

/// A uniform number in `[0, 1)` for a lattice point.
pub fn hash(x: i64, y: i64, seed: u64) -> f64 {
    (mix(x, y, 0, seed) >> 11) as f64 / (1u64 << 53) as f64
}

/// Two independent uniform numbers in `[0, 1)` for a lattice point.
pub fn hash2(x: i64, y: i64, seed: u64) -> DVec2 {
    DVec2::new(hash(x, y, seed), hash(x, y, seed ^ 0x5bd1_e995))
}

/// Quintic fade, twice differentiable at the lattice.
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Gradient noise in the plane, about `[−1, 1]`, zero at lattice points.
///
/// * `p`: position, in lattice cells.
/// * `period`: the noise repeats after this many cells along both axes; 0 never repeats.
pub fn noise2(p: DVec2, period: i64, seed: u64) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let (cx, cy) = (cell.x as i64, cell.y as i64);
    let wrap = |i: i64| if period > 0 { i.rem_euclid(period) } else { i };
    let corner = |dx: i64, dy: i64| {
        let angle = hash(wrap(cx + dx), wrap(cy + dy), seed) * std::f64::consts::TAU;
        DVec2::from_angle(angle).dot(f - DVec2::new(dx as f64, dy as f64))
    };
    let (u, v) = (fade(f.x), fade(f.y));
    let low = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * u;
    let high = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * u;
    (low + (high - low) * v) * 1.5
}

/// Gradient noise in space, about `[−1, 1]`.
pub fn noise3(p: DVec3, seed: u64) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let (u, v, w) = (fade(f.x), fade(f.y), fade(f.z));
    let mut sum = 0.0;
    for corner in 0..8_u32 {
        let d =
            DVec3::new(f64::from(corner & 1), f64::from(corner >> 1 & 1), f64::from(corner >> 2));
        let c = cell + d;
        let h = mix(c.x as i64, c.y as i64, c.z as i64, seed);
        let unit = |shift: u32| (h >> shift & 0xFFFF) as f64 / 32767.5 - 1.0;
        let gradient = DVec3::new(unit(0), unit(16), unit(32));
        let side = |t: f64, far: f64| if far > 0.5 { t } else { 1.0 - t };
        sum += side(u, d.x) * side(v, d.y) * side(w, d.z) * gradient.dot(f - d);
    }
    sum * 1.4
}

/// Fractal sum of `octaves` of [`noise2`], each twice as fine and half as strong; about `[−1, 1]`.
pub fn fbm2(p: DVec2, octaves: u32, period: i64, seed: u64) -> f64 {
    let mut sum = 0.0;
    let mut gain = 0.5;
    let mut scale = 1.0;
    for octave in 0..octaves {
        // Each octave is shifted so that their common zeros at lattice points do not coincide.
        let shift = if period > 0 { DVec2::ZERO } else { DVec2::splat(17.3 * f64::from(octave)) };
        sum += gain
            * noise2(p * scale + shift, (period as f64 * scale) as i64, seed + u64::from(octave));
        gain *= 0.5;
        scale *= 2.0;
    }
    sum
}

/// Fractal sum of `octaves` of [`noise3`]; about `[−1, 1]`.
pub fn fbm3(p: DVec3, octaves: u32, seed: u64) -> f64 {
    let mut sum = 0.0;
    let mut gain = 0.5;
    let mut scale = 1.0;
    for octave in 0..octaves {
        sum += gain
            * noise3(p * scale + DVec3::splat(11.7 * f64::from(octave)), seed + u64::from(octave));
        gain *= 0.5;
        scale *= 2.0;
    }
    sum
}

/// What a point sees of a cellular pattern.
pub struct Cell {
    /// Distance to the nearest seed point, in cells.
    pub nearest: f64,
    /// Uniform in `[0, 1)`, one number per cell.
    pub tag: f64,
}

/// Cellular (Voronoi) pattern with jittered seeds.
///
/// * `p`: position, in lattice cells.
/// * `period`: repeats after this many cells; 0 never repeats.
/// * `jitter`: how far seeds leave their cell's center, in `[0, 1]`.
pub fn cells(p: DVec2, period: i64, jitter: f64, seed: u64) -> Cell {
    let base = p.floor();
    let wrap = |i: i64| if period > 0 { i.rem_euclid(period) } else { i };
    let seed_at = |dx: i64, dy: i64| {
        let (x, y) = (base.x as i64 + dx, base.y as i64 + dy);
        let r = hash2(wrap(x), wrap(y), seed) - DVec2::splat(0.5);
        let at = DVec2::new(x as f64, y as f64) + DVec2::splat(0.5) + r * jitter;
        (at, hash(wrap(x), wrap(y), seed ^ 0xABCD))
    };
    let mut best = Cell { nearest: f64::INFINITY, tag: 0.0 };
    for (dx, dy) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))) {
        let (at, tag) = seed_at(dx, dy);
        let nearest = at.distance(p);
        if nearest < best.nearest {
            best = Cell { nearest, tag };
        }
    }
    best
}
