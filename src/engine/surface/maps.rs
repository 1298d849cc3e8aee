//! Maps made from one of them alone, as a program has them in memory. Floor 2. Not here: files and
//! their conventions (`io::maps`), which know better what is background.

use super::Maps;
use super::differentiate::normals_from_depth;
use super::integrate::depth_from_normals;
use crate::math::Vec3;
use crate::raster::Plane;

impl Maps {
    /// Normals alone: their depth is the height field whose slopes match them best (MATH 1).
    ///
    /// * `normals`: camera space, +x right, +y up, +z to the viewer, any length; zero, NaN or
    ///   infinite where there is no surface.
    ///
    /// Solves an equation over the whole map: about a second for 4 million pixels. How far apart
    /// two pieces of surface are at a silhouette is not in their normals; each piece is centered on
    /// the same depth.
    pub fn from_normals(normals: Plane<Vec3>) -> Self {
        let unit = normals
            .updated(|_, _, n| if n.is_finite() { n.normalize_or_zero() } else { Vec3::ZERO });
        let inside = unit.map(|n| n != Vec3::ZERO);
        let depth = depth_from_normals(&unit, &inside).map(|found| found.depth);
        let depth = depth.unwrap_or_else(|| Plane::full(unit.size(), f32::NAN));
        Self { coverage: inside.map(|inside| if inside { 255 } else { 0 }), normals: unit, depth }
    }

    /// Depth alone: its normals are those of its slopes, which do not cross depth jumps.
    ///
    /// * `depth`: 0 near … 1 far; not finite where there is no surface.
    /// * `range_px`: how many pixels deep the range 0 … 1 is, `> 0`.
    pub fn from_depth(depth: Plane<f32>, range_px: f32) -> Self {
        let normals = normals_from_depth(&depth, range_px);
        let coverage = depth.map(|z| if z.is_finite() { 255 } else { 0 });
        Self { normals, depth, coverage }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec3};
    use crate::surface::{Surface, SurfaceError};

    const SIZE: Size = Size::new(64, 64);

    /// Height of a ball of radius 24, px.
    fn height(x: usize, y: usize) -> Option<f32> {
        let (dx, dy) = (x as f32 - 31.5, y as f32 - 31.5);
        let squared = 24.0 * 24.0 - dx * dx - dy * dy;
        (squared > 0.0).then(|| squared.sqrt())
    }

    fn normals() -> Plane<Vec3> {
        let normal =
            |x: usize, y: usize| height(x, y).map(|z| vec3(x as f32 - 31.5, 31.5 - y as f32, z));
        Plane::from_fn(SIZE, |x, y| normal(x, y).unwrap_or(Vec3::ZERO))
    }

    #[test]
    fn normals_alone_give_the_depth_of_a_ball() {
        let maps = Maps::from_normals(normals());
        assert_eq!((maps.coverage.at(2, 2), maps.coverage.at(32, 32)), (0, 255));
        assert!(!maps.depth.at(2, 2).is_finite());
        // From the middle halfway out the ball falls by 24 − √(24² − 12²) px.
        let rise = (24.0 - height(43, 31).unwrap()) / (24.0 - height(52, 31).unwrap());
        let found = maps.depth.at(43, 31) / maps.depth.at(52, 31);
        assert!((found - rise).abs() < 0.05, "{found}, not {rise}");
    }

    #[test]
    fn depth_alone_gives_the_normals_of_a_ball() {
        let depth = Plane::from_fn(SIZE, |x, y| height(x, y).map_or(f32::NAN, |z| 1.0 - z / 24.0));
        let maps = Maps::from_depth(depth, 24.0);
        let expected = normals().at(40, 22).normalize_or_zero();
        assert!(maps.normals.at(40, 22).distance(expected) < 0.02, "{}", maps.normals.at(40, 22));
        assert_eq!((maps.coverage.at(2, 2), maps.coverage.at(32, 32)), (0, 255));
    }

    #[test]
    fn maps_without_a_surface_are_refused_by_it() {
        let bad = [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY];
        for normal in bad {
            let maps = Maps::from_normals(Plane::full(Size::new(4, 3), normal));
            assert_eq!(Surface::new(maps).err(), Some(SurfaceError::Empty), "{normal}");
        }
        let maps = Maps::from_depth(Plane::full(Size::new(4, 3), f32::NAN), 10.0);
        assert_eq!(Surface::new(maps).err(), Some(SurfaceError::Empty));
    }
}
