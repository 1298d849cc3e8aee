//! From where a surface was seen: from afar, or from a point through a lens of some field of view.
//! Floor 2. Pure functions but for the surface's own pixels. Not here: files that state the field
//! of view (`io::maps`), what materials make of it (`shading`).

use super::Surface;
use super::contours::ContourPixel;
use crate::math::{Size, Vec2, Vec3, vec3};

/// The eye.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Eye {
    /// Infinitely far: every pixel is seen along e = (0, 0, 1).
    #[default]
    Afar,
    /// So many px of the map from the picture plane, before a point at this offset from the map's
    /// middle.
    At {
        /// The focal length.
        focal_px: f32,
        /// How far the middle of the canvas lies beside the axis.
        beside: Vec2,
    },
}

impl Eye {
    /// Of a camera whose picture is as wide as a map and spans this angle, degrees in (0, 180);
    /// else afar.
    ///
    /// MATH 1: `f = ½ w / tan ½ φ`.
    pub fn of_fov(degrees: Option<f32>, map: Size) -> Self {
        let focal_px = |degrees: f32| 0.5 * map.width as f32 / (0.5 * degrees.to_radians()).tan();
        match degrees.filter(|degrees| *degrees > 0.0 && *degrees < 180.0).map(focal_px) {
            Some(focal_px) if focal_px.is_finite() && focal_px > 0.0 => {
                Eye::At { focal_px, beside: Vec2::ZERO }
            }
            _ => Eye::Afar,
        }
    }

    /// On a map `factor` times as large.
    pub(super) fn scaled(self, factor: f32) -> Self {
        match self {
            Eye::Afar => Eye::Afar,
            Eye::At { focal_px, beside } => {
                Eye::At { focal_px: focal_px * factor, beside: beside * factor }
            }
        }
    }

    /// The eye of a map that another one became.
    ///
    /// * `factor`: how much longer lengths became.
    /// * `moved`: where a point relative to the old map's middle went, from the new one's, px.
    pub(super) fn moved(self, factor: f32, moved: impl Fn(Vec2) -> Vec2) -> Self {
        match self {
            Eye::Afar => Eye::Afar,
            Eye::At { focal_px, beside } => {
                Eye::At { focal_px: focal_px * factor, beside: moved(beside) }
            }
        }
    }

    /// v: the unit vector toward the eye from what is seen at a point; camera space (y up).
    ///
    /// MATH 1: `v = (−x, y, f) / |…|`, (x, y) from the point before the eye, y down. Afar it is e.
    ///
    /// * `from_middle`: map px.
    #[inline(always)]
    pub fn direction_to_eye(self, from_middle: Vec2) -> Vec3 {
        match self {
            Eye::Afar => Vec3::Z,
            Eye::At { focal_px, beside } => {
                let at = from_middle - beside;
                vec3(-at.x, at.y, focal_px).normalize_or(Vec3::Z)
            }
        }
    }
}

impl Surface {
    /// The same surface seen by another eye.
    pub fn with_eye(mut self, eye: Eye) -> Self {
        self.eye = eye;
        self.derived.perspective_view = Default::default();
        self.derived.ray_maps.clear();
        self
    }

    /// Where it is seen from.
    pub fn eye(&self) -> Eye {
        self.eye
    }

    /// v of a pixel: the unit vector toward the eye, camera space (y up).
    #[inline(always)]
    pub fn view(&self, x: usize, y: usize) -> Vec3 {
        let (at, size) = (self.canvas_pixel(x as i32, y as i32), self.canvas_size());
        self.eye.direction_to_eye(Vec2::new(at.0 as f32 + 0.5, at.1 as f32 + 0.5) - size.center())
    }

    /// n·v of a pixel: 1 faces the eye, 0 is seen edge-on.
    #[inline(always)]
    pub fn facing(&self, x: usize, y: usize) -> f32 {
        match self.eye {
            Eye::Afar => self.normal(x, y).z,
            Eye::At { .. } => self.normal(x, y).dot(self.view(x, y)),
        }
    }

    /// The same of a contour pixel, in the middle of what its own side sees (MATH 10).
    pub fn own_facing(&self, pixel: &ContourPixel) -> f32 {
        let (x, y) = (pixel.x as usize, pixel.y as usize);
        pixel.own_normal(self.normal(x, y)).dot(self.view(x, y))
    }
}

/// w in the frame of a view: turned by the least turn that takes the unit vector v to e = (0, 0,
/// 1), v_z > −1.
///
/// MATH 1: `w ↦ w − (w·s) / (1 + v_z) s + 2 (w·v) e`, s = v + e.
#[inline(always)]
pub fn in_view(v: Vec3, w: Vec3) -> Vec3 {
    let s = v + Vec3::Z;
    w - s * (w.dot(s) / (1.0 + v.z).max(1e-6)) + Vec3::Z * (2.0 * w.dot(v))
}

/// The inverse of [`in_view`].
#[inline(always)]
pub fn from_view(v: Vec3, w: Vec3) -> Vec3 {
    let s = v + Vec3::Z;
    w - s * (w.dot(s) / (1.0 + v.z).max(1e-6)) + v * (2.0 * w.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec2};
    use crate::raster::Plane;
    use crate::surface::Maps;

    #[test]
    fn views_open_as_wide_as_the_field_of_view() {
        let eye = Eye::of_fov(Some(90.0), Size::new(200, 100));
        assert!(
            (eye.direction_to_eye(vec2(100.0, 0.0)) - vec3(-1.0, 0.0, 1.0).normalize()).length()
                < 1e-6
        );
        assert!(
            (eye.direction_to_eye(vec2(0.0, 100.0)) - vec3(0.0, 1.0, 1.0).normalize()).length()
                < 1e-6,
            "y is down"
        );
        assert_eq!(eye.direction_to_eye(Vec2::ZERO), Vec3::Z);
        for none in [None, Some(0.0), Some(180.0), Some(f32::NAN), Some(-40.0)] {
            assert_eq!(Eye::of_fov(none, Size::new(200, 100)), Eye::Afar);
        }
        assert_eq!(Eye::Afar.direction_to_eye(vec2(70.0, 3.0)), Vec3::Z);
    }

    #[test]
    fn in_its_own_frame_a_view_is_straight_and_angles_stay() {
        let views =
            [vec3(0.3, -0.2, 0.9), vec3(-0.7, 0.1, 0.4), Vec3::Z].map(|v: Vec3| v.normalize());
        for v in views {
            assert!((in_view(v, v) - Vec3::Z).length() < 1e-6);
            for (a, b) in [(vec3(1.0, 2.0, 3.0), vec3(-1.0, 0.5, 0.2)), (Vec3::X, Vec3::Y)] {
                assert!((in_view(v, a).dot(in_view(v, b)) - a.dot(b)).abs() < 1e-5);
                assert!((from_view(v, in_view(v, a)) - a).length() < 1e-5);
            }
        }
        assert_eq!(in_view(Vec3::Z, vec3(0.25, -0.5, 0.75)), vec3(0.25, -0.5, 0.75));
    }

    #[test]
    fn a_surface_is_seen_as_before_at_another_size() {
        let size = Size::new(64, 48);
        let maps = Maps {
            normals: Plane::full(size, vec3(0.6, 0.0, 0.8)),
            depth: Plane::full(size, 0.5),
            coverage: Plane::full(size, 255),
        };
        let surface = Surface::new(maps).unwrap().with_eye(Eye::of_fov(Some(60.0), size));
        let double = surface.stretched(Size::new(128, 96)).unwrap();
        let between = 0.5 * (surface.view(10, 20) + surface.view(11, 20));
        assert!(
            (double.view(21, 40) - between).length() < 0.01,
            "{} {between}",
            double.view(21, 40)
        );
        assert!(
            (surface.facing(60, 20) - vec3(0.6, 0.0, 0.8).dot(surface.view(60, 20))).abs() < 1e-6
        );
    }

    #[test]
    fn points_are_read_between_the_covered_pixels_around_them() {
        let size = Size::new(8, 8);
        let maps = Maps {
            normals: Plane::full(size, Vec3::Z),
            depth: Plane::full(size, 0.5),
            coverage: Plane::from_fn(size, |x, _| if x < 4 { 255 } else { 0 }),
        };
        let surface = Surface::new(maps).unwrap();
        let shares: Vec<_> = surface.linked_pixels(vec2(2.75, 3.0)).collect();
        assert_eq!(shares, [(2, 2, 0.375), (3, 2, 0.125), (2, 3, 0.375), (3, 3, 0.125)]);
        assert_eq!(
            surface.linked_pixels(vec2(3.75, 3.5)).collect::<Vec<_>>(),
            [(3, 3, 1.0)],
            "what is bare does not count"
        );
        assert_eq!(surface.linked_pixels(vec2(7.0, 3.0)).count(), 0);
    }
}
