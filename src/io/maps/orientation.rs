//! Detects the orientation of the stored axes: flips of x, y and z, channel order and the polarity of depth, judged
//! together. Floor 5.
//!
//! The evidence, each in [−1, 1]: how well the slopes of the normals agree with those of the depth; whether normals at
//! the rim point outward; for which handedness the normals are those of a height field (no curl). Priors decide what
//! the evidence leaves open.

use super::samples;
use crate::math::{Vec2, Vec3, vec2, vec3};
use crate::raster::Plane;

/// A way to turn stored vectors into camera space: component k is `sign[k]` · stored\[`order[k]`\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMapping {
    pub order: [usize; 3],
    /// Whether each component is negated.
    pub flip: [bool; 3],
}

impl AxisMapping {
    pub const PLAIN: AxisMapping = AxisMapping { order: [0, 1, 2], flip: [false; 3] };

    pub fn apply(&self, v: Vec3) -> Vec3 {
        let sign = |k: usize| if self.flip[k] { -1.0 } else { 1.0 };
        vec3(sign(0) * v[self.order[0]], sign(1) * v[self.order[1]], sign(2) * v[self.order[2]])
    }
}

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
    /// Of the flips of x, y and z.
    pub confidence: [f32; 3],
    pub order_confidence: f32,
    pub near_confidence: f32,
}

/// Which stored components have one sign all over the surface: candidates for the one toward the viewer.
pub fn one_sided(vectors: &[Vec3]) -> [bool; 3] {
    std::array::from_fn(|c| {
        let share = |s: f32| vectors.iter().filter(|v| v[c] * s < -0.02).count() as f32 / vectors.len().max(1) as f32;
        let mean = vectors.iter().map(|v| v[c].abs()).sum::<f32>() / vectors.len().max(1) as f32;
        share(1.0).min(share(-1.0)) < 0.01 && mean > 0.15
    })
}

/// Weighs every order and flip. `vectors` are as stored, unit length; `depth` as stored, finite over the surface.
pub fn find(vectors: &Plane<Vec3>, inside: &Plane<bool>, depth: Option<&Plane<f32>>, fixed: &FixedAxes) -> FoundAxes {
    let at: Vec<usize> = samples::spread(inside);
    let sampled: Vec<Vec3> = at.iter().map(|&i| vectors.values()[i]).collect();
    let sided = one_sided(&sampled);
    let orders = orders(fixed, sided);
    let rim = samples::rim(inside);
    let mut tried: Vec<(f32, AxisMapping, bool)> = Vec::new();
    for order in orders {
        let mean_z = sampled.iter().map(|v| v[order[2]]).sum::<f32>();
        let flip_z = fixed.flip[2].unwrap_or(mean_z < 0.0);
        let axes = AxisMapping { order, flip: [false, false, flip_z] };
        let evidence = AxisEvidence::gather(vectors, inside, &at, &rim, depth, axes);
        for bits in 0..8u8 {
            let (flip_x, flip_y, near_high) = (bits & 1 != 0, bits & 2 != 0, bits & 4 != 0);
            let forbidden = fixed.flip[0].is_some_and(|f| f != flip_x)
                || fixed.flip[1].is_some_and(|f| f != flip_y)
                || fixed.near_high.is_some_and(|n| n != near_high);
            if !forbidden {
                let score = evidence.score(flip_x, flip_y, near_high, depth.is_some())
                    + if near_high { fixed.near_high_leaning } else { -fixed.near_high_leaning }
                    - if order == [0, 1, 2] { 0.0 } else { 0.4 };
                tried.push((score, AxisMapping { order, flip: [flip_x, flip_y, flip_z] }, near_high));
            }
        }
    }
    decide(&tried, &sampled)
}

/// The orders of channels worth trying: the plain one where blue can be z, else each channel that can.
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
        let rival = tried.iter().filter(|t| other(t)).map(|t| t.0).fold(f32::NEG_INFINITY, f32::max);
        1.0 - (-1.5 * (best.0 - rival)).exp()
    };
    let z = best.1.order[2];
    let away = sampled.iter().filter(|v| (v[z] < 0.0) != best.1.flip[2]).count() as f32 / sampled.len().max(1) as f32;
    FoundAxes {
        axes: best.1,
        near_high: best.2,
        confidence: [
            sure(&|t| t.1.flip[0] != best.1.flip[0]),
            sure(&|t| t.1.flip[1] != best.1.flip[1]),
            1.0 - 2.0 * away.min(0.5),
        ],
        order_confidence: if best.1.order == [0, 1, 2] { 0.95 } else { sure(&|t| t.1.order != best.1.order) },
        near_confidence: sure(&|t| t.2 != best.2),
    }
}

/// How well the unflipped axes of one order agree with what is known of the shape.
struct AxisEvidence {
    /// Slopes of normals against slopes of depth as stored, x and y (up).
    depth: Vec2,
    /// Outward at the rim, x and y.
    rim: Vec2,
    /// Positive where the axes as they are make a height field, negative where the mirrored ones do.
    handed: f32,
}

impl AxisEvidence {
    fn gather(
        vectors: &Plane<Vec3>,
        inside: &Plane<bool>,
        at: &[usize],
        rim: &[(usize, Vec2)],
        depth: Option<&Plane<f32>>,
        axes: AxisMapping,
    ) -> Self {
        let w = vectors.width();
        let n = |i: usize| axes.apply(vectors.values()[i]);
        let outward = |k: usize| {
            let (with, all) = rim.iter().fold((0.0f64, 1e-3f64), |(with, all), &(i, d)| {
                let product = f64::from(n(i)[k] * d[k]);
                (with + product, all + product.abs())
            });
            (with / all) as f32 * (rim.len() as f32 / 40.0).min(1.0)
        };
        Self {
            depth: depth.map_or(Vec2::ZERO, |d| correlation(d, at, w, n)),
            rim: vec2(outward(0), outward(1)),
            handed: handedness(inside, at, w, n),
        }
    }
    fn score(&self, flip_x: bool, flip_y: bool, near_high: bool, has_depth: bool) -> f32 {
        let sign = |flip: bool| if flip { -1.0 } else { 1.0 };
        let (sx, sy, near) = (sign(flip_x), sign(flip_y), sign(near_high));
        let depth = near * (sx * self.depth.x + sy * self.depth.y);
        let rim = sx * self.rim.x + sy * self.rim.y;
        // Mirrored x is rarer than y down, and far-is-high the commoner depth.
        let prior = if flip_x { -0.35 } else { 0.0 } + if flip_y { -0.1 } else { 0.0 };
        let near_prior = if near_high && has_depth { -0.15 } else { 0.0 };
        2.5 * depth + 1.2 * rim + 1.5 * sx * sy * self.handed + prior + near_prior
    }
}

/// Correlation of the slopes told by normals with the change of depth: (right, up). Depth that grows away from the
/// viewer correlates positively with n_x/n_z.
fn correlation(depth: &Plane<f32>, at: &[usize], w: usize, n: impl Fn(usize) -> Vec3) -> Vec2 {
    let mut pairs: Vec<(Vec2, Vec2)> = at
        .iter()
        .filter_map(|&i| {
            let n = n(i);
            let steps = samples::slope(depth, i % w, i / w, 1)?;
            (n.z > 0.25).then(|| (vec2(n.x, n.y) / n.z, vec2(steps.x, -steps.y)))
        })
        .collect();
    if pairs.len() < 16 {
        return Vec2::ZERO;
    }
    // Jumps that slipped through would outweigh everything: the steepest twentieth is left out.
    pairs.sort_by(|a, b| a.1.length_squared().total_cmp(&b.1.length_squared()));
    pairs.truncate(pairs.len() - pairs.len() / 20);
    let pearson = |k: usize| {
        let (ab, aa, bb) = pairs.iter().fold((0.0, 1e-30, 1e-30), |(ab, aa, bb), (a, b)| {
            let (a, b) = (f64::from(a[k]), f64::from(b[k]));
            (ab + a * b, aa + a * a, bb + b * b)
        });
        (ab / (aa * bb).sqrt()) as f32
    };
    vec2(pearson(0), pearson(1))
}

/// Compares the curl of (n_x/n_z, n_y/n_z) with that of its mirror image: 1 where only the axes as they are fit a
/// surface.
fn handedness(inside: &Plane<bool>, at: &[usize], w: usize, n: impl Fn(usize) -> Vec3) -> f32 {
    let (mut plain, mut mirrored, mut count) = (0.0f64, 0.0f64, 0u32);
    for &i in at {
        let (x, y) = ((i % w) as i32, (i / w) as i32);
        let near = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
        if !near.iter().all(|&(x, y)| inside.get(x, y) == Some(true)) {
            continue;
        }
        let slope = |(x, y): (i32, i32)| {
            let n = n(y as usize * w + x as usize);
            (n.z > 0.2).then(|| vec2(n.x, n.y) / n.z)
        };
        let [Some(left), Some(right), Some(up), Some(down)] = near.map(slope) else { continue };
        let (q_x, p_y) = (right.y - left.y, up.x - down.x);
        // Creases and jumps are no evidence.
        if q_x.abs().max(p_y.abs()) < 1.0 {
            plain += f64::from((p_y - q_x).powi(2));
            mirrored += f64::from((p_y + q_x).powi(2));
            count += 1;
        }
    }
    let sum = plain + mirrored;
    if count < 16 || sum < 1e-9 * f64::from(count) { 0.0 } else { ((mirrored - plain) / sum) as f32 }
}
