//! Fitting a surface to a canvas of another size: another object under a finished painting, or a painting at another
//! scale. Floor 2. Values are averaged over what one new pixel covers, never across a depth jump or the mask's edge.

use super::{Maps, Surface, SurfaceError};
use crate::math::{Size, Vec2, Vec3, vec2};
use crate::raster::Plane;

impl Surface {
    /// The whole surface as large as `canvas` allows, its aspect kept, centred; what is left of the canvas has no
    /// surface.
    ///
    /// Fails where nothing is left of a surface thinner than the new pixels.
    pub fn fitted(&self, canvas: Size) -> Result<Surface, SurfaceError> {
        let (from, to) = (self.size(), canvas);
        let scale = (to.width as f32 / from.width as f32).min(to.height as f32 / from.height as f32);
        self.resampled(canvas, Vec2::splat(scale))
    }
    /// The surface at another resolution: the whole map over the whole canvas, a side that rounded taking the
    /// difference.
    pub fn stretched(&self, canvas: Size) -> Result<Surface, SurfaceError> {
        let (from, to) = (self.size(), canvas);
        let scale = vec2(to.width as f32 / from.width as f32, to.height as f32 / from.height as f32);
        self.resampled(canvas, scale)
    }
    /// Centred on each other, `scale` canvas px per map px.
    fn resampled(&self, canvas: Size, scale: Vec2) -> Result<Surface, SurfaceError> {
        let map_from_canvas = |q: Vec2| (q - canvas.center()) / scale + self.size().center();
        // A new pixel covers at least one old one: averaging over that box is then bilinear interpolation.
        let half = (scale.recip() * 0.5).max(Vec2::splat(0.5));
        let read =
            Plane::from_fn(canvas, |x, y| self.mean_over(map_from_canvas(vec2(x as f32 + 0.5, y as f32 + 0.5)), half));
        Surface::new(Maps {
            normals: read.map(|v| v.normal),
            depth: read.map(|v| v.depth),
            coverage: read.map(|v| v.coverage),
        })
        .map(|surface| surface.seen_by(self.eye().scaled(scale.x)))
    }
    /// The mean over the box of half sides `half` around a point of the map, cut at its border; beyond there is no
    /// surface.
    pub(super) fn mean_over(&self, center: Vec2, half: Vec2) -> MeanTexel {
        let border = vec2(self.size().width as f32, self.size().height as f32);
        if center.min_element() < 0.0 || center.x >= border.x || center.y >= border.y {
            return MeanTexel::default();
        }
        let (low, high) = ((center - half).max(Vec2::ZERO), (center + half).min(border));
        let (x0, x1) = (low.x.floor() as i32, high.x.ceil() as i32);
        let (y0, y1) = (low.y.floor() as i32, high.y.ceil() as i32);
        let covered = (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y))).filter_map(|(x, y)| {
            let side = |low: f32, high: f32, i: i32| (high.min(i as f32 + 1.0) - low.max(i as f32)).max(0.0);
            let area = side(low.x, high.x, x) * side(low.y, high.y, y);
            let coverage = self.coverage(x as usize, y as usize);
            (area > 0.0 && coverage > 0).then_some((x, y, area * f32::from(coverage)))
        });
        // The covered pixel nearest to the centre decides which piece of surface this is.
        let distance = |&(x, y, _): &(i32, i32, f32)| (vec2(x as f32 + 0.5, y as f32 + 0.5) - center).length_squared();
        let Some((rx, ry, _)) = covered.clone().min_by(|a, b| distance(a).total_cmp(&distance(b))) else {
            return MeanTexel::default();
        };
        let (mut normal, mut depth, mut joined, mut all) = (Vec3::ZERO, 0.0, 0.0, 0.0);
        for (x, y, weight) in covered {
            all += weight;
            if self.is_same_piece((rx, ry), (x, y)) {
                normal += weight * self.normal(x as usize, y as usize);
                depth += weight * self.depth(x as usize, y as usize);
                joined += weight;
            }
        }
        let area = (high - low).element_product();
        MeanTexel { normal, depth: depth / joined, coverage: (all / area).min(255.0).round() as u8 }
    }
    /// Whether two pixels near each other lie on one smooth piece: the step in depth is no larger than the steeper of
    /// the two slopes implies, plus a tolerance of a pixel and a half for coarse depth (as in `links`).
    fn is_same_piece(&self, a: (i32, i32), b: (i32, i32)) -> bool {
        let at = |(x, y): (i32, i32)| {
            let (x, y) = (x as usize, y as usize);
            let steepness = self.nbar(x, y).length() / self.normal(x, y).z.max(0.05);
            (self.depth(x, y) * self.depth_range_px(), steepness)
        };
        let ((za, sa), (zb, sb)) = (at(a), at(b));
        let distance = ((a.0 - b.0) as f32).hypot((a.1 - b.1) as f32);
        (za - zb).abs() <= 1.5 + 1.5 * sa.max(sb) * distance
    }
}

/// What a new pixel reads; no surface by default.
#[derive(Clone, Copy)]
pub(super) struct MeanTexel {
    pub normal: Vec3,
    pub depth: f32,
    pub coverage: u8,
}

impl Default for MeanTexel {
    fn default() -> Self {
        Self { normal: Vec3::ZERO, depth: f32::NAN, coverage: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;

    /// A plate tilted to the right over the left half, before a far wall over the right half.
    fn plate_and_wall(size: Size) -> Surface {
        let left = |x: usize| x < size.width as usize / 2;
        Surface::new(Maps {
            normals: Plane::from_fn(size, |x, _| if left(x) { vec3(0.0, 0.6, 0.8) } else { Vec3::Z }),
            depth: Plane::from_fn(size, |x, _| if left(x) { 0.0 } else { 1.0 }),
            coverage: Plane::filled(size, 255),
        })
        .unwrap()
    }
    #[test]
    fn the_same_size_keeps_every_value() {
        let a = plate_and_wall(Size::new(8, 6));
        let b = a.fitted(a.size()).unwrap();
        assert_eq!(a.depth_plane(), b.depth_plane());
        assert_eq!(a.coverage_plane(), b.coverage_plane());
        for y in 0..6 {
            for x in 0..8 {
                assert!((a.normal(x, y) - b.normal(x, y)).length() < 1e-6);
            }
        }
    }
    #[test]
    fn a_wide_map_on_a_square_canvas_stands_centred_with_its_aspect() {
        let s = plate_and_wall(Size::new(8, 4)).fitted(Size::new(16, 16)).unwrap();
        assert_eq!((s.coverage(8, 3), s.coverage(8, 4), s.coverage(8, 11), s.coverage(8, 12)), (0, 255, 255, 0));
    }
    #[test]
    fn no_new_pixel_mixes_the_two_sides_of_a_depth_jump() {
        for size in [Size::new(7, 5), Size::new(30, 20)] {
            let s = plate_and_wall(Size::new(10, 8)).stretched(size).unwrap();
            for &z in s.depth_plane().values() {
                assert!(z == 0.0 || z == 1.0, "{z}");
            }
        }
    }
}
