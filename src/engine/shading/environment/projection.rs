//! How directions lie in a picture of the surroundings: latitude-longitude, angular, mirror ball.
//! Floor 3. Pure functions.

use crate::math::{Vec2, Vec3, fast, vec2, vec3};
use std::f32::consts::{PI, TAU};

crate::named! {
    /// How directions lie in the picture.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum Projection {
        /// u = atan2(e_x, −e_z) / 2π, v = acos(e_y) / π from the top.
        #[default]
        LatLong = "lat-long",
        /// The center is toward the viewer, the radius proportional to the angle from it, the rim
        /// directly away.
        Angular = "angular",
        /// A photographed mirror ball: the picture is the ball, seen orthographically.
        MirrorBall = "mirror-ball",
    }
}

impl Projection {
    /// Where in the picture a unit direction of its own space (y up) lies: `[0, 1]²`, from the left
    /// and the top.
    #[inline(always)]
    pub fn place(self, e: Vec3) -> Vec2 {
        match self {
            Projection::LatLong => lat_long_place(e.x, e.y, e.z),
            Projection::Angular => {
                // The whole rim is one direction, directly away from the viewer: any point of it is
                // right.
                let around = vec2(e.x, -e.y).normalize_or(Vec2::X);
                // atan2 keeps the digits that acos loses near the center and the rim.
                0.5 + 0.5 * around * (e.truncate().length().atan2(e.z) / PI)
            }
            Projection::MirrorBall => {
                // The ball's normal there lies half-way between the direction and the viewer's.
                let n = (e + Vec3::Z).normalize_or(Vec3::X);
                0.5 + 0.5 * vec2(n.x, -n.y)
            }
        }
    }

    /// The picture is a disc; beyond it there is nothing.
    pub fn is_disc(self) -> bool {
        self != Projection::LatLong
    }
}

/// Where a direction lies in a latitude-longitude map; one without direction, or NaN, at some place
/// within.
#[inline(always)]
pub fn lat_long_place(x: f32, y: f32, z: f32) -> Vec2 {
    let u = fast::atan2(x, -z) * (1.0 / TAU);
    // acos y, with the digits that it loses near the poles.
    let v = fast::atan2((x * x + z * z).sqrt(), y) * (1.0 / PI);
    let within = |t: f32| fast::min(fast::max(t, 0.0), 1.0);
    vec2(within(if u < 0.0 { u + 1.0 } else { u }), within(v))
}

/// The unit direction at (u, v) of a latitude-longitude map: the reverse of [`Projection::place`].
pub fn lat_long_direction(u: f32, v: f32) -> Vec3 {
    let ((sin_u, cos_u), (sin_v, cos_v)) = ((u * TAU).sin_cos(), (v * PI).sin_cos());
    vec3(sin_u * sin_v, cos_v, -cos_u * sin_v)
}

/// The `i`-th of `count` directions spread evenly over the sphere: a spiral of equal areas that
/// turns by the golden angle.
pub fn spread(i: usize, count: usize) -> Vec3 {
    const GOLDEN_TURN: f32 = 0.618_034;
    let y = 1.0 - (2.0 * i as f32 + 1.0) / count.max(1) as f32;
    let (sin, cos) = ((i as f32 * GOLDEN_TURN).fract() * TAU).sin_cos();
    let across = (1.0 - y * y).max(0.0).sqrt();
    vec3(across * sin, y, across * cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_at(found: Vec2, x: f32, y: f32) {
        assert!((found - vec2(x, y)).length() < 1e-5, "{found} is not ({x}, {y})");
    }

    #[test]
    fn directions_lie_where_the_documents_say() {
        assert_at(Projection::LatLong.place(Vec3::NEG_Z), 0.0, 0.5);
        assert_at(Projection::LatLong.place(Vec3::X), 0.25, 0.5);
        assert_at(Projection::LatLong.place(Vec3::Z), 0.5, 0.5);
        assert_at(Projection::LatLong.place(Vec3::NEG_X), 0.75, 0.5);
        assert!(Projection::LatLong.place(Vec3::Y).y < 1e-6, "up is the top");
        assert_at(Projection::Angular.place(Vec3::Z), 0.5, 0.5);
        assert_at(Projection::Angular.place(Vec3::Y), 0.5, 0.25);
        assert_at(Projection::Angular.place(Vec3::X), 0.75, 0.5);
        // A mirror ball shows what lies at the right (+x) where its normal is at 45°.
        assert_at(Projection::MirrorBall.place(Vec3::X), 0.5 + 0.5 * 0.5f32.sqrt(), 0.5);
        assert_at(Projection::MirrorBall.place(Vec3::Z), 0.5, 0.5);
    }

    #[test]
    fn places_and_directions_are_each_others_reverse() {
        for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.99, 0.97), (0.3, 0.04)] {
            assert_at(Projection::LatLong.place(lat_long_direction(u, v)), u, v);
        }
    }

    #[test]
    fn spread_directions_leave_no_hole() {
        let all: Vec<Vec3> = (0..500).map(|i| spread(i, 500)).collect();
        let mean = all.iter().sum::<Vec3>() / 500.0;
        assert!(mean.length() < 0.01, "{mean}");
        // Each covers a disc 0.18 across; no place is much farther than that from the nearest.
        for e in [Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, vec3(-0.6, 0.64, 0.48)] {
            assert!(all.iter().any(|d| (*d - e).length() < 0.12), "{e}");
        }
    }
}
