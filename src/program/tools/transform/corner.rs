//! A corner of a quadrilateral under the pen: the quadrilateral stays convex. Floor 5. Pure
//! functions.

use crate::math::DVec2;

/// The least distance of a corner from where the quadrilateral would turn concave, as a share of
/// its size.
const MARGIN: f64 = 0.02;

/// The point nearest to `at` with which a quadrilateral is convex, its other corners staying. It
/// moves no farther than `at` does, so a corner that is dragged along the border glides there.
///
/// * `corners`: of a convex quadrilateral, in order.
/// * `corner`: the number of the one that moves.
pub fn clamp_to_convex(corners: [DVec2; 4], corner: usize, at: DVec2) -> DVec2 {
    let [before, opposite, after] = [3, 2, 1].map(|i| corners[(corner + i) % 4]);
    let size = (after - before)
        .length()
        .max((opposite - before).length())
        .max((opposite - after).length());
    // Beyond the diagonal, and between the two sides that meet in the opposite corner.
    let around = if (after - before).perp_dot(opposite - before) >= 0.0 { -1.0 } else { 1.0 };
    let border = |from: DVec2, to: DVec2| {
        let normal = (to - from).perp().normalize_or_zero() * around;
        (normal, normal.dot(from) + MARGIN * size)
    };
    let borders = [border(before, after), border(before, opposite), border(opposite, after)];
    let is_in =
        |p: DVec2| borders.iter().all(|(normal, least)| normal.dot(p) >= least - 1e-9 * size);
    if is_in(at) || !at.is_finite() {
        return if at.is_finite() { at } else { corners[corner % 4] };
    }
    let onto = borders.iter().map(|(normal, least)| at + *normal * (least - normal.dot(at)));
    let meets = [(0, 1), (1, 2), (2, 0)].into_iter().filter_map(|(i, j)| {
        let ((a, c), (b, d)) = (borders[i], borders[j]);
        let det = a.perp_dot(b);
        (det.abs() > 1e-12).then(|| DVec2::new(c * b.y - d * a.y, d * a.x - c * b.x) / det)
    });
    let candidates = onto.chain(meets).filter(|p| p.is_finite() && is_in(*p));
    let nearest =
        candidates.min_by(|a, b| a.distance_squared(at).total_cmp(&b.distance_squared(at)));
    nearest.unwrap_or(corners[corner % 4])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::PlaneMap;
    use proptest::prelude::*;

    const SQUARE: [DVec2; 4] = [
        DVec2::new(0.0, 0.0),
        DVec2::new(100.0, 0.0),
        DVec2::new(100.0, 80.0),
        DVec2::new(0.0, 80.0),
    ];

    #[test]
    fn a_corner_goes_where_it_may_and_stays_at_the_border_elsewhere() {
        let to = |x: f64, y: f64| clamp_to_convex(SQUARE, 2, DVec2::new(x, y));
        assert_eq!(to(140.0, 60.0), DVec2::new(140.0, 60.0));
        let past = to(-50.0, 40.0);
        assert!(past.x > 0.0 && past.distance(DVec2::new(-50.0, 40.0)) < 100.0, "{past}");
        let across = to(10.0, 10.0);
        assert!(across.x / 100.0 + across.y / 80.0 > 1.0, "beyond the diagonal: {across}");
        assert_eq!(to(f64::NAN, 1.0), SQUARE[2]);
    }

    proptest! {
        #[test]
        fn whatever_the_pen_does_the_quadrilateral_is_a_perspective_and_moves_no_farther_than_the_pen(
            corner in 0usize..4, mirrored: bool,
            a in prop::array::uniform2(-400.0f64..400.0), b in prop::array::uniform2(-400.0f64..400.0),
        ) {
            let corners = if mirrored { SQUARE.map(|p| DVec2::new(-p.x, p.y)) } else { SQUARE };
            let [a, b] = [a, b].map(DVec2::from_array);
            let [at, other] = [a, b].map(|p| clamp_to_convex(corners, corner, p));
            let mut moved = corners;
            moved[corner] = at;
            prop_assert!(PlaneMap::rect_to_quad(DVec2::ZERO, DVec2::ONE, moved).is_some(), "{at}");
            prop_assert!(at.distance(other) <= a.distance(b) + 1e-6, "{at} and {other}");
        }
    }
}
