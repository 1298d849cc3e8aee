//! Signed distances: primitives, smooth combinators, rotations. Negative inside.
//! Not here: objects made of them (`shapes`), curved tubes (`tube`), tracing (`render`).

use glam::{DMat3, DVec2, DVec3};

/// A point or vector of the model space: +x right, +y up, +z to the viewer.
pub fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Rotation that takes camera space to an object turned by `yaw` (about y), then tipped by `pitch`
/// (about x) toward the viewer, then rolled (about z). Degrees.
pub fn object_from_camera(yaw: f64, pitch: f64, roll: f64) -> DMat3 {
    let turned = DMat3::from_rotation_z(roll.to_radians())
        * DMat3::from_rotation_x(pitch.to_radians())
        * DMat3::from_rotation_y(yaw.to_radians());
    turned.transpose()
}

/// Smooth step from 0 at `a` to 1 at `b`, twice differentiable.
pub fn smooth_step(a: f64, b: f64, x: f64) -> f64 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Union blended over the width `k`.
///
/// The cubic blend keeps curvature continuous: the quadratic one shows as a crease in reflections.
pub fn smooth_min(a: f64, b: f64, k: f64) -> f64 {
    let h = (1.0 - (a - b).abs() / k).max(0.0);
    a.min(b) - h * h * h * k / 6.0
}

/// Intersection blended over the width `k`.
pub fn smooth_max(a: f64, b: f64, k: f64) -> f64 {
    -smooth_min(-a, -b, k)
}

/// `a` with `b` carved out, the rim rounded over the width `k`.
pub fn carve(a: f64, b: f64, k: f64) -> f64 {
    smooth_max(a, -b, k)
}

/// Sphere of radius `r` about the origin.
pub fn sphere(p: DVec3, r: f64) -> f64 {
    p.length() - r
}

/// Ellipsoid of semi-axes `r` about the origin. First-order distance: exact on the surface.
pub fn ellipsoid(p: DVec3, r: DVec3) -> f64 {
    let k0 = (p / r).length();
    let k1 = (p / (r * r)).length();
    if k1 < 1e-9 { -r.min_element() } else { k0 * (k0 - 1.0) / k1 }
}

/// Capsule from `a` to `b` whose radius goes linearly from `ra` to `rb`.
pub fn capsule(p: DVec3, a: DVec3, b: DVec3, ra: f64, rb: f64) -> f64 {
    let ab = b - a;
    let t = ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    (p - a - ab * t).length() - (ra + (rb - ra) * t)
}

/// Torus about the y axis: ring radius `ring`, tube radius `tube`.
pub fn torus(p: DVec3, ring: f64, tube: f64) -> f64 {
    DVec2::new(DVec2::new(p.x, p.z).length() - ring, p.y).length() - tube
}

/// Box of half sizes `half` with edges rounded by `round`.
pub fn rounded_box(p: DVec3, half: DVec3, round: f64) -> f64 {
    let q = p.abs() - half + DVec3::splat(round);
    q.max(DVec3::ZERO).length() + q.max_element().min(0.0) - round
}

/// Cylinder about the y axis, edges rounded by `round`.
pub fn cylinder(p: DVec3, radius: f64, half_height: f64, round: f64) -> f64 {
    let radial = DVec2::new(p.x, p.z).length();
    let q = DVec2::new(radial - radius + round, p.y.abs() - half_height + round);
    q.max(DVec2::ZERO).length() + q.max_element().min(0.0) - round
}

/// Distance in the plane to a segment.
pub fn segment2(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let ab = b - a;
    let t = ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    (p - a - ab * t).length()
}
