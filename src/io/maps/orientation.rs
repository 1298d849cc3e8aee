//! Detects the orientation of the stored axes: flips of x, y and z, channel order and the polarity
//! of depth, judged together. Floor 5. What speaks for each is gathered in `evidence`.

use super::axes::AxisMapping;
use super::evidence::{AxisEvidence, ReducedMap};
use super::samples;
use crate::math::Vec3;
use crate::raster::Plane;

/// What is fixed in advance: by the user, or by the background of a depth map.
#[derive(Clone, Copy, Debug, Default)]
pub struct FixedAxes {
    pub order: Option<[usize; 3]>,
    pub flip: [Option<bool>; 3],
    /// The stored depth is nearer where it is higher.
    pub near_high: Option<bool>,
    /// Further evidence for `near_high`, −1 … 1.
    pub near_high_leaning: f32,
}

/// The best mapping and the confidence of each part.
#[derive(Clone, Copy, Debug)]
pub struct FoundAxes {
    pub axes: AxisMapping,
    pub near_high: bool,
    /// Confidence of the flips of x, y and z.
    pub confidence: [f32; 3],
    pub order_confidence: f32,
    pub near_confidence: f32,
}

/// Which stored components have one sign all over the surface: candidates for the one toward the
/// viewer.
pub fn one_sided(vectors: &[Vec3]) -> [bool; 3] {
    std::array::from_fn(|c| {
        let share = |s: f32| {
            vectors.iter().filter(|v| v[c] * s < -0.02).count() as f32 / vectors.len().max(1) as f32
        };
        let mean = vectors.iter().map(|v| v[c].abs()).sum::<f32>() / vectors.len().max(1) as f32;
        share(1.0).min(share(-1.0)) < 0.01 && mean > 0.15
    })
}

/// Weighs every order and flip. `vectors` are as stored, unit length; `depth` as stored, finite
/// over the surface.
pub fn find(
    vectors: &Plane<Vec3>,
    inside: &Plane<bool>,
    depth: Option<&Plane<f32>>,
    fixed: &FixedAxes,
) -> FoundAxes {
    let at: Vec<usize> = samples::spread(inside);
    let sampled: Vec<Vec3> = at.iter().map(|&i| vectors.values()[i]).collect();
    let sided = one_sided(&sampled);
    let orders = orders(fixed, sided);
    let rim = samples::rim(inside);
    let reduced = ReducedMap::all(vectors, inside);
    let mut tried: Vec<(f32, AxisMapping, bool)> = Vec::new();
    for order in orders {
        let mean_z = sampled.iter().map(|v| v[order[2]]).sum::<f32>();
        let flip_z = fixed.flip[2].unwrap_or(mean_z < 0.0);
        let axes = AxisMapping { order, flip: [false, false, flip_z] };
        let evidence = AxisEvidence::gather(vectors, &at, &rim, &reduced, depth, axes);
        for bits in 0..8u8 {
            let (flip_x, flip_y, near_high) = (bits & 1 != 0, bits & 2 != 0, bits & 4 != 0);
            let forbidden = fixed.flip[0].is_some_and(|f| f != flip_x)
                || fixed.flip[1].is_some_and(|f| f != flip_y)
                || fixed.near_high.is_some_and(|n| n != near_high);
            if !forbidden {
                let score = evidence.score(flip_x, flip_y, near_high, depth.is_some())
                    + if near_high { fixed.near_high_leaning } else { -fixed.near_high_leaning }
                    - if order == [0, 1, 2] { 0.0 } else { 0.4 };
                tried.push((
                    score,
                    AxisMapping { order, flip: [flip_x, flip_y, flip_z] },
                    near_high,
                ));
            }
        }
    }
    decide(&tried, &sampled)
}

/// The orders of channels worth trying: the plain one where blue can be z, else each channel that
/// can.
fn orders(fixed: &FixedAxes, sided: [bool; 3]) -> Vec<[usize; 3]> {
    if let Some(order) = fixed.order {
        return vec![order];
    }
    if sided[2] || !(sided[0] || sided[1]) {
        return vec![[0, 1, 2]];
    }
    let all = [[1, 2, 0], [2, 1, 0], [2, 0, 1], [0, 2, 1]];
    all.into_iter().filter(|order| sided[order[2]]).collect()
}

fn decide(tried: &[(f32, AxisMapping, bool)], sampled: &[Vec3]) -> FoundAxes {
    let plain = (0.0, AxisMapping::PLAIN, false);
    let best = *tried.iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or(&plain);
    // How much worse the best mapping with the other choice is.
    let sure = |other: &dyn Fn(&(f32, AxisMapping, bool)) -> bool| {
        let rival =
            tried.iter().filter(|t| other(t)).map(|t| t.0).fold(f32::NEG_INFINITY, f32::max);
        1.0 - (-1.5 * (best.0 - rival)).exp()
    };
    let z = best.1.order[2];
    let away = sampled.iter().filter(|v| (v[z] < 0.0) != best.1.flip[2]).count() as f32
        / sampled.len().max(1) as f32;
    FoundAxes {
        axes: best.1,
        near_high: best.2,
        confidence: [
            sure(&|t| t.1.flip[0] != best.1.flip[0]),
            sure(&|t| t.1.flip[1] != best.1.flip[1]),
            1.0 - 2.0 * away.min(0.5),
        ],
        order_confidence: if best.1.order == [0, 1, 2] {
            0.95
        } else {
            sure(&|t| t.1.order != best.1.order)
        },
        near_confidence: sure(&|t| t.2 != best.2),
    }
}
