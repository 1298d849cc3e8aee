//! Evidence for the conventions of stored normals and depth: how well the slopes of the normals
//! agree with those of the depth; whether normals at the rim point outward; for which handedness
//! the normals are those of a height field (no curl). Each in [−1, 1]; priors decide the rest.
//! Floor 5. Not here: the decision (`orientation`).

use super::axes::AxisMapping;
use super::samples;
use crate::math::{Size, Vec2, Vec3, vec2};
use crate::raster::Plane;

/// Longer sides at which the curl is measured.
const SIDES_PX: [usize; 3] = [512, 256, 128];
/// Mean |n̄| at a rim: up to the first it is not the rim of a surface, from the second on it is.
const LEVEL_RIM: f32 = 0.2;
const LEANING_RIM: f32 = 0.5;

/// How well the unflipped axes of one order agree with what is known of the shape.
pub struct AxisEvidence {
    /// Slopes of normals against slopes of depth as stored, x and y (up).
    depth: Vec2,
    /// Outward at the rim, x and y.
    rim: Vec2,
    /// Positive where the axes as they are make a height field, negative where the mirrored ones
    /// do.
    handed: f32,
}

impl AxisEvidence {
    /// * `at`: pixels spread over the surface; `rim`: those where it ends, and to where.
    pub fn gather(
        vectors: &Plane<Vec3>,
        at: &[usize],
        rim: &[(usize, Vec2)],
        reduced: &[ReducedMap],
        depth: Option<&Plane<f32>>,
        axes: AxisMapping,
    ) -> Self {
        let w = vectors.width();
        let n = |i: usize| axes.apply(vectors.values()[i]);
        // Normals lean where a surface ends; flat parts of a texture also end, and are no evidence.
        let lean = rim.iter().map(|&(i, _)| n(i).truncate().length()).sum::<f32>()
            / rim.len().max(1) as f32;
        let counts = ((lean - LEVEL_RIM) / (LEANING_RIM - LEVEL_RIM)).max(0.0).min(1.0);
        let outward = |k: usize| {
            let (with, all) = rim.iter().fold((0.0f64, 1e-3f64), |(with, all), &(i, d)| {
                let product = f64::from(n(i)[k] * d[k]);
                (with + product, all + product.abs())
            });
            counts * (with / all) as f32 * (rim.len() as f32 / 40.0).min(1.0)
        };
        Self {
            depth: depth.map_or(Vec2::ZERO, |d| correlation(d, at, w, n)),
            rim: vec2(outward(0), outward(1)),
            handed: ReducedMap::handedness(reduced, axes),
        }
    }

    /// How likely these flips are, as a logarithm.
    pub fn score(&self, flip_x: bool, flip_y: bool, near_high: bool, has_depth: bool) -> f32 {
        let sign = |flip: bool| if flip { -1.0 } else { 1.0 };
        let (sx, sy, near) = (sign(flip_x), sign(flip_y), sign(near_high));
        let depth = near * (sx * self.depth.x + sy * self.depth.y);
        let rim = sx * self.rim.x + sy * self.rim.y;
        // Mirrored x is much rarer than y down, both together rarer still; far-is-high is the
        // commoner depth.
        let of = |is: bool, prior: f32| if is { prior } else { 0.0 };
        let prior = of(flip_x, -1.0) + of(flip_y, -0.1) + of(flip_x && flip_y, -0.6);
        let near_prior = of(near_high && has_depth, -0.15);
        2.5 * depth + 1.2 * rim + 2.0 * sx * sy * self.handed + prior + near_prior
    }
}

/// Correlation of the slopes from normals with the change of depth: (right, up). Depth that grows
/// away from the viewer correlates positively with n_x/n_z.
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

/// A map reduced to the size at which all textures are compared: fine noise and the steps of 8 bits
/// average out, and the same map in another size gives the same result.
pub struct ReducedMap {
    vectors: Plane<Vec3>,
    inside: Plane<bool>,
    at: Vec<usize>,
}

impl ReducedMap {
    /// The map reduced to each size that is smaller than its own, or unchanged where a size is not
    /// smaller.
    pub fn all(vectors: &Plane<Vec3>, inside: &Plane<bool>) -> Vec<Self> {
        let longer = vectors.width().max(vectors.height());
        let mut factors: Vec<usize> =
            SIDES_PX.iter().map(|side| longer.div_ceil(*side).max(1)).collect();
        factors.dedup();
        factors.into_iter().map(|factor| Self::new(vectors, inside, factor)).collect()
    }

    /// Means of `factor`² pixels that are all of the surface.
    fn new(vectors: &Plane<Vec3>, inside: &Plane<bool>, factor: usize) -> Self {
        let size = Size::new(
            (vectors.width() / factor).max(1) as u32,
            (vectors.height() / factor).max(1) as u32,
        );
        let block = move |x: usize, y: usize| {
            (0..factor * factor).map(move |i| (x * factor + i % factor, y * factor + i / factor))
        };
        let is_whole = |x: usize, y: usize| {
            block(x, y).all(|(x, y)| inside.get(x as i32, y as i32) == Some(true))
        };
        let inside = Plane::from_fn(size, is_whole);
        let vectors = Plane::from_fn(size, |x, y| {
            let sum: Vec3 = block(x, y).filter_map(|(x, y)| vectors.get(x as i32, y as i32)).sum();
            if inside.at(x, y) { sum.normalize_or_zero() } else { Vec3::ZERO }
        });
        let at = samples::spread(&inside);
        Self { vectors, inside, at }
    }

    /// The mean over the sizes, each of which must have enough evidence.
    fn handedness(all: &[Self], axes: AxisMapping) -> f32 {
        let votes: Vec<f32> = all.iter().filter_map(|map| map.compare_handedness(axes)).collect();
        votes.iter().sum::<f32>() / votes.len().max(1) as f32
    }

    /// Compares the curl of (n_x/n_z, n_y/n_z) with that of its mirror image: 1 if only the axes as
    /// they are fit a surface. `None` if too few pixels are evidence.
    fn compare_handedness(&self, axes: AxisMapping) -> Option<f32> {
        let w = self.vectors.width();
        let (mut plain, mut mirrored, mut count) = (0.0f64, 0.0f64, 0u32);
        for &i in &self.at {
            let (x, y) = ((i % w) as i32, (i / w) as i32);
            let near = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
            if !near.iter().all(|&(x, y)| self.inside.get(x, y) == Some(true)) {
                continue;
            }
            let slope = |(x, y): (i32, i32)| {
                let n = axes.apply(self.vectors.at(x as usize, y as usize));
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
        let is_flat = sum < 1e-9 * f64::from(count);
        (count >= 16).then(|| if is_flat { 0.0 } else { ((mirrored - plain) / sum) as f32 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The normals of waves of many lengths, y up.
    fn waves(side: u32, noise: f32) -> Plane<Vec3> {
        let slope = |x: f32, y: f32, k: f32| {
            let (u, v) = (k * (x + 0.3 * y), k * (0.7 * y - 0.4 * x));
            vec2(u.cos() - 0.4 * v.cos(), -(0.3 * u.cos() + 0.7 * v.cos())) * 0.3
        };
        let jitter = |x: usize, y: usize, c: u32| {
            noise * (crate::math::hash::unit(x as u32, y as u32, c) - 0.5)
        };
        Plane::from_fn(Size::new(side, side), |x, y| {
            let (u, v) = (x as f32 / side as f32, y as f32 / side as f32);
            let steep = [9.0, 23.0, 51.0].into_iter().map(|k| slope(u, v, k)).sum::<Vec2>();
            crate::math::vec3(-steep.x + jitter(x, y, 0), -steep.y + jitter(x, y, 1), 1.0)
                .normalize_or_zero()
        })
    }

    fn handedness_of(vectors: &Plane<Vec3>, flip_y: bool) -> f32 {
        let all = ReducedMap::all(vectors, &Plane::full(vectors.size(), true));
        ReducedMap::handedness(
            &all,
            AxisMapping { flip: [false, flip_y, false], ..AxisMapping::PLAIN },
        )
    }

    #[test]
    fn a_map_in_another_size_tells_the_same() {
        for side in [1024, 512, 300, 128] {
            let smooth = handedness_of(&waves(side, 0.0), false);
            assert!(smooth > 0.95, "{side}: {smooth}");
        }
        for side in [1024, 512] {
            // Noise on every pixel, such as steps and grain, has no preferred curl.
            let (plain, flipped) =
                (handedness_of(&waves(side, 0.2), false), handedness_of(&waves(side, 0.2), true));
            assert!(plain > 0.3 && flipped < -0.3, "{side}: {plain}, {flipped}");
        }
    }

    #[test]
    fn a_flat_rim_says_nothing_of_the_axes() {
        let size = Size::new(64, 64);
        let rim: Vec<(usize, Vec2)> = (0..64).map(|i| (i * 64, vec2(-1.0, 0.0))).collect();
        let of = |lean: f32| {
            let vectors = Plane::full(size, crate::math::vec3(-lean, 0.0, 1.0).normalize_or_zero());
            AxisEvidence::gather(&vectors, &[], &rim, &[], None, AxisMapping::PLAIN).rim.x
        };
        assert!(of(0.1) == 0.0 && of(2.0) > 0.9, "{} {}", of(0.1), of(2.0));
    }
}
