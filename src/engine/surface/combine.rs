//! Normal layers: detail normals combined onto a surface (SF fig. 12b–c). Depth, coverage and links
//! stay as they are. Floor 2. Here: the equation, and a map of detail read at any scale. Noise as
//! detail is in `grain`, its placement on the canvas in `document::normals`.

use crate::math::{Size, Vec2, Vec3, vec2};
use crate::raster::{Outside, Plane};
use std::sync::Arc;

/// Combines a detail normal with a base normal: the detail is rotated so that its z axis becomes
/// the base normal.
///
/// Reoriented normal mapping (Barré-Brisebois and Hill 2012): t = base + z, u = (−d_x, −d_y, d_z),
/// r = t (t·u) / t_z − u.
///
/// * `base`, `detail`: unit, y up, `base.z > −1`.
///
/// The result is a unit vector: the base where the detail is flat, the detail where the base is
/// flat. A result that would face away from the viewer is stopped at the silhouette.
pub fn reorient(base: Vec3, detail: Vec3) -> Vec3 {
    let t = base + Vec3::Z;
    let u = Vec3::new(-detail.x, -detail.y, detail.z);
    let r = (t * (t.dot(u) / t.z.max(1e-3)) - u).normalize_or(base);
    // Never less than the base itself where that leans away already.
    let least = base.z.min(GRAZING_NZ);
    if r.z >= least {
        return r;
    }
    let across = r.truncate().normalize_or(base.truncate().normalize_or(Vec2::X));
    (across * (1.0 - least * least).max(0.0).sqrt()).extend(least)
}

/// The least n_z of a combined normal.
const GRAZING_NZ: f32 = 0.02;

/// A detail normal with its slopes multiplied.
pub fn strengthened(detail: Vec3, strength: f32) -> Vec3 {
    // A detail normal beyond the horizon has no slope; it is tilted as far as possible.
    let upright = detail.z.max(0.02);
    Vec3::new(detail.x * strength, detail.y * strength, upright).normalize_or(Vec3::Z)
}

/// A tangent-space normal map with its mip levels: means of normals, so that detail too fine to be
/// seen flattens.
pub struct DetailMap {
    levels: Vec<Plane<Vec3>>,
}

impl DetailMap {
    /// `normals`: x right, y up, z out of the map; zero or not finite counts as flat.
    pub fn new(normals: Plane<Vec3>) -> Self {
        let unit = |n: Vec3| if n.is_finite() { n.normalize_or(Vec3::Z) } else { Vec3::Z };
        let mut levels = vec![normals.map(unit)];
        while let Some(next) = levels.last().and_then(halve) {
            levels.push(next);
        }
        Self { levels }
    }

    /// Its sides, px.
    pub fn size(&self) -> Size {
        self.levels[0].size()
    }

    /// The mean normal around a texel, not of unit length; `None` beyond a map that ends there.
    ///
    /// * `texel`: of the map, its corner (0, 0).
    /// * `texels_per_px`: how many one pixel of the canvas covers.
    pub fn at(&self, texel: Vec2, texels_per_px: f32, outside: Outside) -> Option<Vec3> {
        if !texel.is_finite() {
            return None;
        }
        let most = (self.levels.len() - 1) as f32;
        let level = texels_per_px.max(1.0).log2().min(most);
        let (fine, t) = (level as usize, level.fract());
        let near = self.bilinear(fine, texel, outside)?;
        let far = if t > 0.0 { self.bilinear(fine + 1, texel, outside) } else { None };
        Some(far.map_or(near, |far| near.lerp(far, t)))
    }

    fn bilinear(&self, level: usize, texel: Vec2, outside: Outside) -> Option<Vec3> {
        let plane = &self.levels[level];
        let (w, h) = (plane.width() as f32, plane.height() as f32);
        let full = self.size();
        let p = texel * vec2(w / full.width as f32, h / full.height as f32) - 0.5;
        let floor = p.floor();
        let t = p - floor;
        let (i, j) = (floor.x as i32, floor.y as i32);
        let there = |i: i32, j: i32| {
            let column = outside.index(i, plane.width() as i32)?;
            let row = outside.index(j, plane.height() as i32)?;
            let n = plane.at(column as usize, row as usize);
            // A mirrored detail tilts the other way.
            let mirrored =
                |at: i32, n: usize| outside == Outside::Mirror && at.div_euclid(n as i32) % 2 != 0;
            let sign = |is: bool| if is { -1.0 } else { 1.0 };
            Some(
                n * Vec3::new(
                    sign(mirrored(i, plane.width())),
                    sign(mirrored(j, plane.height())),
                    1.0,
                ),
            )
        };
        // Beyond the map's end the surface is as it was.
        let flat = |i, j| there(i, j).unwrap_or(Vec3::ZERO);
        let row = |j: i32| flat(i, j).lerp(flat(i + 1, j), t.x);
        let mean = row(j).lerp(row(j + 1), t.y);
        if outside != Outside::None {
            return Some(mean);
        }
        let edge = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
        if edge.iter().all(|&(i, j)| there(i, j).is_none()) {
            None
        } else {
            Some(mean.normalize_or(Vec3::Z))
        }
    }
}

fn halve(plane: &Plane<Vec3>) -> Option<Plane<Vec3>> {
    let Size { width, height } = plane.size();
    if width == 1 && height == 1 {
        return None;
    }
    Some(Plane::from_fn(Size::new(width.div_ceil(2), height.div_ceil(2)), |x, y| {
        let at = |dx, dy| plane.at_clamped((2 * x + dx) as i32, (2 * y + dy) as i32);
        (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4.0
    }))
}

impl super::Surface {
    /// The surface with its normals combined with detail. Depth, coverage and links are the same.
    ///
    /// `detail`: the detail normal (y up, any length) and how strongly it counts at a pixel; `None`
    /// leaves the base.
    pub fn combined(
        self: &Arc<Self>,
        detail: impl Fn(usize, usize) -> Option<(Vec3, f32)> + Sync,
    ) -> Self {
        let combined = |base: Vec3, x: usize, y: usize| match detail(x, y) {
            Some((detail, strength)) if strength > 0.0 => {
                reorient(base, strengthened(detail, strength))
            }
            _ => base,
        };
        let normals = Plane::from_fn(self.size(), |x, y| combined(self.normal(x, y), x, y));
        let canvas = self.size().rect();
        let of_far_side = self.far_side().map(|far| {
            Plane::from_fn(far.size(), |x, y| {
                let base = far.normal(x, y);
                let (x, y) = far.canvas_pixel(x as i32, y as i32);
                // The reading next to a pixel at the border lies beyond the canvas.
                combined(base, x.min(canvas.x1 - 1) as usize, y.min(canvas.y1 - 1) as usize)
            })
        });
        self.with_normals(&normals, of_far_side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;
    use crate::surface::{Maps, Surface};

    fn near(a: Vec3, b: Vec3) -> bool {
        (a - b).length() < 1e-5
    }

    #[test]
    fn flat_detail_keeps_the_base_and_a_flat_base_shows_the_detail() {
        let lean = vec3(0.4, -0.3, 0.8).normalize();
        assert!(near(reorient(lean, Vec3::Z), lean));
        assert!(near(reorient(Vec3::Z, lean), lean));
    }

    #[test]
    fn detail_keeps_its_angle_to_the_base() {
        let detail = vec3(0.3, 0.2, 0.9).normalize();
        for base in [vec3(0.5, 0.1, 0.8), vec3(-0.3, 0.6, 0.7), vec3(0.0, -0.6, 0.4)] {
            let base = base.normalize();
            let r = reorient(base, detail);
            assert!((r.length() - 1.0).abs() < 1e-5);
            assert!((r.dot(base) - detail.z).abs() < 1e-5, "{base}");
        }
        // The shortest rotation from z to a base that leans right leaves vertical tilt unchanged.
        let right = vec3(0.6, 0.0, 0.8);
        assert!((reorient(right, vec3(0.0, 0.28, 0.96)).y - 0.28).abs() < 1e-5);
    }

    #[test]
    fn nothing_turns_away_from_the_viewer() {
        let grazing = vec3(0.995, 0.0, 0.0999).normalize();
        let r = reorient(grazing, vec3(0.7, 0.0, 0.71).normalize());
        assert!(r.z >= 0.0199 && (r.length() - 1.0).abs() < 1e-5, "{r}");
        for base in [Vec3::NEG_Z, vec3(0.9, 0.0, -0.01)] {
            assert!(reorient(base, vec3(0.5, 0.5, 0.7)).is_finite());
        }
    }

    #[test]
    fn strength_multiplies_slopes() {
        let n = strengthened(vec3(0.3, -0.1, 0.9).normalize(), 3.0);
        assert!((n.x / n.z - 1.0).abs() < 1e-5 && (n.y / n.z + 1.0 / 3.0).abs() < 1e-5);
        assert_eq!(strengthened(n, 0.0), Vec3::Z);
    }

    fn slanted() -> DetailMap {
        DetailMap::new(Plane::from_fn(Size::new(8, 4), |x, _| {
            vec3(if x < 4 { 0.6 } else { -0.6 }, 0.0, 0.8)
        }))
    }

    #[test]
    fn detail_flattens_where_it_is_too_fine_to_be_seen() {
        let near = slanted().at(vec2(2.0, 2.0), 1.0, Outside::Repeat).unwrap();
        assert!((near.x - 0.6).abs() < 1e-5);
        let far = slanted().at(vec2(2.0, 2.0), 8.0, Outside::Repeat).unwrap();
        assert!(far.x.abs() < 1e-5 && far.z > 0.5, "{far}");
    }

    #[test]
    fn mirrored_detail_leans_the_other_way() {
        let at = |x: f32, outside| slanted().at(vec2(x, 2.0), 1.0, outside).map(|n| n.x);
        assert!((at(10.0, Outside::Repeat).unwrap() - 0.6).abs() < 1e-5);
        assert!(
            (at(10.0, Outside::Mirror).unwrap() - 0.6).abs() < 1e-5,
            "the second half, turned over"
        );
        assert!((at(-2.0, Outside::Mirror).unwrap() + 0.6).abs() < 1e-5);
        assert_eq!(at(20.0, Outside::None), None);
        assert_eq!(slanted().at(Vec2::NAN, f32::NAN, Outside::Repeat), None);
    }

    #[test]
    fn combining_changes_normals_alone() {
        let size = Size::new(20, 10);
        let depth = Plane::from_fn(size, |x, _| x as f32 / 19.0);
        let maps =
            Maps { normals: Plane::full(size, Vec3::Z), depth, coverage: Plane::full(size, 255) };
        let base = Arc::new(Surface::new(maps).unwrap());
        let lean = vec3(0.6, 0.0, 0.8);
        let next = base.combined(|x, _| (x >= 10).then_some((lean, 1.0)));
        assert!(near(next.normal(4, 3), Vec3::Z) && near(next.normal(14, 3), lean));
        assert_eq!(next.depth_plane(), base.depth_plane());
        assert_eq!(next.links_plane(), base.links_plane());
        assert!(
            Arc::ptr_eq(&next.occlusion(9.0), &base.occlusion(9.0)),
            "occlusion is told by depth"
        );
    }
}
