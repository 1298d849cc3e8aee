//! Finds the background of maps: the value that fills the outside of the surface, and the values
//! that renderers write there. Floor 5.

use super::stored::StoredMap;
use crate::math::Vec3;
use crate::raster::{Plane, border};
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
            let all = border::outermost(size);
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

/// Whether two numbers are equal up to lossy compression.
fn is_same_number(a: f32, b: f32, lossy: bool) -> bool {
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
        let mut holds = Plane::full(stored.size, true);
        for (channel, number) in stored.channels.iter().zip(texel) {
            channel.keep_where(&mut holds, |v| is_same_number(v, number, stored.lossy));
        }
        Some(Self { texel, holds })
    }
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
