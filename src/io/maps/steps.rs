//! The steps of 8 bits: the missing exact zero of normals, and staircases that make curvature
//! noisy. Floor 5.

use crate::math::{Vec3, vec3};
use crate::raster::Plane;

/// x and y below this (a byte has no exact 0: 127 and 128 are next to it) are 0 where a map is
/// flat.
const NEARLY_FLAT: f32 = 1.5 / 255.0;

/// Makes flat parts exactly flat: pixels all of whose neighbors within two pixels are nearly flat
/// too. Returns how many.
///
/// A dome's top is not flat: its normals leave the zero within two pixels.
pub fn snap_flat(normals: &mut Plane<Vec3>) -> usize {
    let flat = normals.map(|n| n.x.abs() < NEARLY_FLAT && n.y.abs() < NEARLY_FLAT && n.z > 0.5);
    let (w, h) = (flat.width(), flat.height());
    let whole = Plane::from_fn(flat.size(), |x, y| {
        flat.at(x, y)
            && (-2..=2).all(|dy| (-2..=2).all(|dx| flat.at_clamped(x as i32 + dx, y as i32 + dy)))
    });
    // A pixel next to a wholly flat one belongs to the flat part if it is nearly flat itself.
    let snapped = Plane::from_fn(flat.size(), |x, y| {
        flat.at(x, y)
            && (-2..=2).any(|dy| {
                (-2..=2).any(|dx| whole.get(x as i32 + dx, y as i32 + dy).unwrap_or(false))
            })
    });
    let mut count = 0;
    for y in 0..h {
        for x in 0..w {
            if snapped.at(x, y) {
                normals.set(x, y, vec3(0.0, 0.0, 1.0));
                count += 1;
            }
        }
    }
    count
}

/// Smooths a plane of quantized numbers: the flattest one whose every number still rounds to the
/// stored one, joining neighbors at most a step and a half apart, so that edges stay.
pub fn smooth(stored: &Plane<f32>, step: f32, inside: &Plane<bool>) -> Plane<f32> {
    // Steps as wide as this many pixels are smoothed; each pass reaches one pixel further.
    const PASSES: usize = 48;
    let mut now = stored.clone();
    for _ in 0..PASSES {
        now = Plane::from_fn(stored.size(), |x, y| {
            let own = stored.at(x, y);
            if !inside.at(x, y) || !own.is_finite() {
                return own;
            }
            let (mut sum, mut weight) = (now.at(x, y), 1.0f32);
            for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1)] {
                let (nx, ny) = (x as i32 + dx, y as i32 + dy);
                if inside.get(nx, ny) == Some(true)
                    && (stored.at_clamped(nx, ny) - own).abs() <= 1.5 * step
                {
                    sum += now.at_clamped(nx, ny);
                    weight += 1.0;
                }
            }
            (sum / weight).max(own - 0.5 * step).min(own + 0.5 * step)
        });
    }
    now
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    #[test]
    fn a_staircase_becomes_a_ramp_and_an_edge_stays() {
        let size = Size::new(64, 4);
        let ramp = |x: usize| x as f32 / 640.0 + if x >= 32 { 0.5 } else { 0.0 };
        let stored = Plane::from_fn(size, |x, _| (ramp(x) * 255.0).round() / 255.0);
        let smooth = smooth(&stored, 1.0 / 255.0, &Plane::full(size, true));
        let worst =
            |p: &Plane<f32>| (4..60).map(|x| (p.at(x, 1) - ramp(x)).abs()).fold(0.0, f32::max);
        assert!(
            worst(&smooth) <= 1.01 / 255.0 && worst(&stored) > 1.4 * mean_error(&smooth, ramp),
            "no better"
        );
        assert!(mean_error(&smooth, ramp) < 0.6 * mean_error(&stored, ramp));
        assert!(smooth.at(32, 1) - smooth.at(31, 1) > 0.49);
    }

    fn mean_error(p: &Plane<f32>, ramp: impl Fn(usize) -> f32) -> f32 {
        (0..64).map(|x| (p.at(x, 1) - ramp(x)).abs()).sum::<f32>() / 64.0
    }

    #[test]
    fn a_flat_part_becomes_exactly_flat_but_a_slope_does_not() {
        let byte = |v: f32| (v * 255.0).round() / 255.0 * 2.0 - 1.0;
        let mut normals = Plane::from_fn(Size::new(40, 12), |x, _| {
            let nx = (x as f32 - 20.0).max(0.0) * 0.02;
            vec3(byte(nx * 0.5 + 0.5), byte(0.5), 1.0)
        });
        assert!(snap_flat(&mut normals) > 0);
        assert_eq!(normals.at(5, 5), Vec3::Z);
        assert!(normals.at(30, 5).x > 0.15);
    }
}
