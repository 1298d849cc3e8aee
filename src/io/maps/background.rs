//! Finds the background of maps: the value that fills the outside of the surface, and the values
//! that renderers write there. Floor 5.

use super::stored::StoredMap;
use crate::math::{Size, Vec3};
use crate::raster::Plane;
use std::collections::HashMap;

/// The one texel that fills the outside: outside the mask if there is one, else along the border.
/// `None` if no texel fills a third of it.
pub fn constant(stored: &StoredMap, coverage: Option<&Plane<u8>>) -> Option<[f32; 4]> {
    let size = stored.size;
    // A value that fills a third of the outside fills a third of evenly spread samples.
    let outside: Vec<usize> = match coverage {
        Some(c) => {
            let bare = c.values().iter().filter(|c| **c == 0).count();
            (0..size.area())
                .filter(|&i| c.values()[i] == 0)
                .step_by((bare / 50_000).max(1))
                .collect()
        }
        None => {
            let all = border(size);
            let step = (all.len() / 50_000).max(1);
            all.into_iter().step_by(step).collect()
        }
    };
    let mut counts: HashMap<[u32; 4], usize> = HashMap::new();
    for &i in &outside {
        // Adding 0 makes −0 and 0 one key.
        *counts.entry(stored.texel(i).map(|v| (v + 0.0).to_bits())).or_default() += 1;
    }
    let (texel, count) = counts.into_iter().max_by_key(|&(texel, count)| (count, texel))?;
    (count * 3 >= outside.len() && count > 1).then(|| texel.map(f32::from_bits))
}

/// Indices of the outermost pixels.
fn border(size: Size) -> Vec<usize> {
    let (w, h) = (size.width as usize, size.height as usize);
    if w < 3 || h < 3 {
        return (0..w * h).collect();
    }
    let rows = (0..w).chain((h - 1) * w..h * w);
    rows.chain((1..h - 1).flat_map(|y| [y * w, y * w + w - 1])).collect()
}

/// Whether two numbers are equal up to lossy compression.
fn same_number(a: f32, b: f32, lossy: bool) -> bool {
    let tolerance = if lossy { 0.024 } else { 0.0 };
    (a - b).abs() <= tolerance || (a.is_nan() && b.is_nan())
}

/// The constant that fills the outside of a map, and the pixels that hold it.
pub struct FilledEdge {
    pub texel: [f32; 4],
    pub holds: Plane<bool>,
}

impl FilledEdge {
    /// What [`constant`] finds, if anything.
    pub fn of(stored: &StoredMap, coverage: Option<&Plane<u8>>) -> Option<Self> {
        let texel = constant(stored, coverage)?;
        let mut holds = Plane::filled(stored.size, true);
        for (channel, number) in stored.channels.iter().zip(texel) {
            channel.keep_where(&mut holds, |v| same_number(v, number, stored.lossy));
        }
        Some(Self { texel, holds })
    }
}

/// Pixels joined to the border through pixels that `is` accepts (four neighbours).
pub fn joined_to_border(size: Size, is: impl Fn(usize) -> bool) -> Plane<bool> {
    let (w, h) = (size.width as usize, size.height as usize);
    let mut found = Plane::filled(size, false);
    // No file has more pixels than 32 bits count.
    let mut front: Vec<u32> =
        border(size).into_iter().filter(|&i| is(i)).map(|i| i as u32).collect();
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

/// Whether a decoded vector cannot be a normal: not finite, nearly zero, or far too long (black or
/// white read as biased).
pub fn is_degenerate(n: Vec3) -> bool {
    !n.is_finite() || n.length() < 0.15
}

/// Where the surface is, judged by the normals alone: not where they are degenerate or equal a
/// constant border that decodes to no unit vector.
///
/// Within a pixel of a zero-length background, lengths below 1 are coverage (averaged with zero) if
/// `unit` says that normals have length 1 elsewhere.
pub fn coverage_of_normals(
    vectors: &Plane<Vec3>,
    outside: impl Fn(usize) -> bool + Sync,
    unit: bool,
) -> Plane<u8> {
    let size = vectors.size();
    let w = size.width as usize;
    let bare = Plane::from_fn(size, |x, y| is_degenerate(vectors.at(x, y)) || outside(y * w + x));
    Plane::from_fn(size, |x, y| {
        if bare.at(x, y) {
            return 0;
        }
        let (x, y) = (x as i32, y as i32);
        let rim = (-1..=1).any(|dy| (-1..=1).any(|dx| bare.get(x + dx, y + dy).unwrap_or(false)));
        let length = vectors.at(x as usize, y as usize).length();
        if unit && rim && length < 0.97 { (length * 255.0).round().max(1.0) as u8 } else { 255 }
    })
}
