//! Normals stored in world space: the rotation that brings them into the camera's. Floor 5. The
//! user or the file gives it; otherwise the best fit to depth or silhouette is used.

use super::samples;
use crate::math::{Mat3, Vec2, Vec3, vec3};
use crate::raster::Plane;

/// A rotation (or a reflection) and how well it fits: the mean cosine between turned and expected
/// normals.
#[derive(Clone, Copy, Debug)]
pub struct FittedRotation {
    pub matrix: Mat3,
    pub fit: f32,
}

/// Rows of a matrix in JSON as a matrix for column vectors.
pub fn from_rows(rows: [[f32; 3]; 3]) -> Mat3 {
    Mat3::from_cols_array_2d(&rows).transpose()
}

/// The rows of a matrix, as in JSON.
pub fn to_rows(matrix: Mat3) -> [[f32; 3]; 3] {
    matrix.transpose().to_cols_array_2d()
}

/// The rotation part of an EXR's `worldToCamera`.
///
/// Stored for row vectors (translation in the last row); some writers store it for column vectors
/// (in the last column). Renderers disagree on whether their camera looks along +z or −z: `None`
/// where the matrix is no rotation; the caller tries both signs of z.
pub fn from_attribute(m: [f32; 16]) -> Option<Mat3> {
    let rows = [[m[0], m[1], m[2]], [m[4], m[5], m[6]], [m[8], m[9], m[10]]];
    let for_columns = [m[3], m[7], m[11]].iter().any(|v| v.abs() > 1e-6);
    let matrix = if for_columns { from_rows(rows) } else { from_rows(rows).transpose() };
    orthonormal(matrix)
}

/// The matrix without scale; `None` if it is not a rotation or reflection.
pub fn orthonormal(matrix: Mat3) -> Option<Mat3> {
    let scale = matrix.determinant().abs().cbrt();
    let unit = matrix * (1.0 / scale);
    let off = unit * unit.transpose() - Mat3::IDENTITY;
    let worst = off.to_cols_array().iter().fold(0.0f32, |w, v| w.max(v.abs()));
    (scale > 1e-6 && worst < 0.02).then_some(unit)
}

/// The share of normals that face away from the viewer after a rotation.
pub fn share_away(matrix: Mat3, normals: &[Vec3]) -> f32 {
    normals.iter().filter(|n| (matrix * **n).z < -0.02).count() as f32 / normals.len().max(1) as f32
}

/// How well the free rotation, and the best exchange of axes, fit a depth map.
#[derive(Clone, Copy, Debug)]
pub struct WorldAlignment {
    pub free: FittedRotation,
    /// Fit of the best order and signs of axes.
    pub axes_fit: f32,
}

impl WorldAlignment {
    /// Whether the normals are in world space: a rotation fits clearly better than an exchange of
    /// axes.
    pub fn is_turned(&self) -> bool {
        let (free, axes) = (1.0 - self.free.fit, 1.0 - self.axes_fit);
        axes > 1.5 * free + 0.004
    }
}

/// Finds the rotation from depth: slopes of depth, at the scale that fits best, give camera-space
/// normals.
///
/// `depth` grows away from the viewer, in any unit.
pub fn from_depth(
    vectors: &Plane<Vec3>,
    depth: &Plane<f32>,
    at: &[usize],
) -> Option<WorldAlignment> {
    let w = vectors.width();
    let mut pairs: Vec<(Vec3, Vec2)> = at
        .iter()
        .filter_map(|&i| {
            Some((vectors.values()[i].try_normalize()?, samples::slope(depth, i % w, i / w, 1)?))
        })
        .collect();
    if pairs.len() < 64 {
        return None;
    }
    pairs.sort_by(|a, b| a.1.length_squared().total_cmp(&b.1.length_squared()));
    let typical = pairs[pairs.len() / 2].1.length();
    pairs.truncate(pairs.len() - pairs.len() / 50);
    if typical <= 0.0 {
        return None;
    }
    let fit = |tilt: f32| {
        let scale = tilt / typical;
        let turned = |s: &Vec2| vec3(s.x * scale, -s.y * scale, 1.0).normalize_or_zero();
        correlation_matrix(pairs.iter().map(|(n, s)| (*n, turned(s))))
    };
    // The median surface is tilted by anything from 6° to 80°; then finer around the best.
    let coarse: Vec<f32> = (0..20).map(|k| 0.1 * 1.26f32.powi(k)).collect();
    let best = |tilts: &[f32], score: &dyn Fn(&[[f64; 3]; 3]) -> f32| {
        tilts.iter().map(|&t| (t, score(&fit(t)))).max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let refined = |score: &dyn Fn(&[[f64; 3]; 3]) -> f32| {
        let (tilt, _) = best(&coarse, score)?;
        let fine: Vec<f32> = (-6..=6).map(|k| tilt * 1.035f32.powi(k)).collect();
        best(&fine, score)
    };
    let (tilt, _) = refined(&|s| rotation_of(s).fit)?;
    let (_, axes_fit) = refined(&axes_fit)?;
    Some(WorldAlignment { free: rotation_of(&fit(tilt)), axes_fit })
}

/// The best mean cosine that exchanging and negating axes reaches.
fn axes_fit(s: &[[f64; 3]; 3]) -> f32 {
    let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let sum = |o: &[usize; 3]| (0..3).map(|k| s[o[k]][k].abs()).sum::<f64>();
    orders.iter().map(sum).fold(0.0, f64::max) as f32
}

/// Finds the rotation from the silhouette: there, normals lie in the picture plane and point
/// outward.
pub fn from_rim(vectors: &Plane<Vec3>, inside: &Plane<bool>) -> Option<FittedRotation> {
    let rim = samples::rim(inside);
    let pairs: Vec<(Vec3, Vec3)> = rim
        .iter()
        .filter_map(|&(i, d)| Some((vectors.values()[i].try_normalize()?, d.extend(0.0))))
        .collect();
    (pairs.len() >= 24).then(|| best_fit(pairs.iter().copied()))
}

/// The rotation that turns the first of each pair best onto the second.
pub fn best_fit(pairs: impl Iterator<Item = (Vec3, Vec3)>) -> FittedRotation {
    rotation_of(&correlation_matrix(pairs))
}

/// Mean of from · toᵀ.
fn correlation_matrix(pairs: impl Iterator<Item = (Vec3, Vec3)>) -> [[f64; 3]; 3] {
    let mut s = [[0.0f64; 3]; 3];
    let mut count = 0.0f64;
    for (from, to) in pairs {
        for (i, row) in s.iter_mut().enumerate() {
            for (j, v) in row.iter_mut().enumerate() {
                *v += f64::from(from[i]) * f64::from(to[j]);
            }
        }
        count += 1.0;
    }
    s.map(|row| row.map(|v| v / count.max(1.0)))
}

/// Horn (1987): the largest eigenvector of a 4 × 4 matrix of the correlations is the rotation's
/// quaternion.
fn rotation_of(s: &[[f64; 3]; 3]) -> FittedRotation {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = *s;
    let n = [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, -xx + yy - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, -xx - yy + zz],
    ];
    let (value, [w, x, y, z]) = largest_eigenvector(n);
    let q = glam::Quat::from_xyzw(x as f32, y as f32, z as f32, w as f32);
    FittedRotation { matrix: Mat3::from_quat(q.normalize()), fit: value as f32 }
}

/// The largest eigenvalue of a symmetric matrix and its eigenvector, by Jacobi's rotations.
fn largest_eigenvector(mut a: [[f64; 4]; 4]) -> (f64, [f64; 4]) {
    let mut v = [[0.0f64; 4]; 4];
    (0..4).for_each(|i| v[i][i] = 1.0);
    for _ in 0..24 {
        for p in 0..3 {
            for q in p + 1..4 {
                if a[p][q].abs() < 1e-300 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for row in &mut a {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                let (upper, lower) = (a[p], a[q]);
                a[p] = std::array::from_fn(|k| c * upper[k] - s * lower[k]);
                a[q] = std::array::from_fn(|k| s * upper[k] + c * lower[k]);
                for row in &mut v {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
            }
        }
    }
    let best = (0..4).max_by(|&i, &j| a[i][i].total_cmp(&a[j][j])).unwrap_or(0);
    (a[best][best], std::array::from_fn(|k| v[k][best]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rotation_between_two_sets_of_directions_is_found() {
        let truth = Mat3::from_rotation_y(1.9) * Mat3::from_rotation_x(-0.7);
        let directions =
            (0..40).map(|i| vec3((i as f32).sin(), (i as f32 * 2.3).cos(), 0.4).normalize());
        let found = best_fit(directions.map(|d| (d, truth * d)));
        assert!((found.fit - 1.0).abs() < 1e-5);
        assert!(
            (found.matrix * vec3(0.3, -0.5, 0.8) - truth * vec3(0.3, -0.5, 0.8)).length() < 1e-5
        );
    }

    #[test]
    fn a_matrix_is_read_for_row_and_for_column_vectors() {
        let r = to_rows(Mat3::from_rotation_z(0.4));
        let columns = [
            r[0][0], r[0][1], r[0][2], 5.0, r[1][0], r[1][1], r[1][2], 6.0, r[2][0], r[2][1],
            r[2][2], 7.0,
        ];
        let mut m = [0.0; 16];
        m[..12].copy_from_slice(&columns);
        m[15] = 1.0;
        let rows = std::array::from_fn(|i| m[i % 4 * 4 + i / 4]);
        for stored in [m, rows] {
            let d = from_attribute(stored).unwrap() - Mat3::from_rotation_z(0.4);
            assert!(d.to_cols_array().iter().all(|v| v.abs() < 1e-5));
        }
        assert!(from_attribute([1.0; 16]).is_none());
    }
}
