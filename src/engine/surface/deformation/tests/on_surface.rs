//! D by the unwrapped surface: dabs, anchors and pieces in the planes of objects.

use super::*;
use std::sync::LazyLock;

const ON_SURFACE: Operator = Operator::Surface { amount: 1.0, smooth: 0.0 };

/// A cylinder of radius 60 px about a vertical axis, and before its left half a plate that floats
/// 15 px higher.
fn cylinder_and_plate() -> Surface {
    surface(|q| {
        let x = q.x - 80.0;
        let h = (3600.0 - x * x).max(0.0).sqrt();
        let plate = (20.0..50.0).contains(&q.x) && (20.0..50.0).contains(&q.y);
        if plate {
            Some((78.0, Vec2::ZERO))
        } else {
            (x.abs() < 55.0).then(|| (h, vec2(-x / h, 0.0)))
        }
    })
}

/// Arc length on that cylinder from its middle.
fn arc(x: f32) -> f32 {
    60.0 * ((x - 80.0) / 60.0).asin()
}

#[test]
fn a_dab_on_the_surface_measures_along_it_and_stays_on_its_object() {
    let surface = cylinder_and_plate();
    let at = vec2(105.2, 80.7);
    let d = Deformation::of_dab(Some(&surface), SIZE, ON_SURFACE, at);
    for (x, y) in [(105, 80), (120, 80), (90, 95), (128, 60)] {
        let truth = vec2(arc(x as f32 + 0.5) - arc(at.x), y as f32 + 0.5 - at.y);
        let found = d.at(x, y) - at;
        assert!(
            found.distance(truth) < 0.01 * truth.length() + 0.05,
            "({x}, {y}): {found} and {truth}"
        );
    }
    assert!(d.at(30, 30).distance(at) > 1e5, "the plate is another object");
    let grain = Deformation::of_pattern(Some(&surface), SIZE, ON_SURFACE, at);
    assert!(
        grain.at(30, 30).distance(vec2(30.5, 30.5)) < 1.0,
        "a pattern lies on it too, in its own plane"
    );
    assert_eq!(grain.at(105, 80), d.at(105, 80));
}

#[test]
fn an_anchor_moves_the_plane_of_its_object_and_two_turn_it() {
    let surface = cylinder_and_plate();
    let laid = |anchors: &[Anchor]| {
        let bend = Bend { operator: ON_SURFACE, anchors: anchors.to_vec(), ..Bend::default() };
        Deformation::new(Some(&surface), SIZE, &bend)
    };
    let (none, one) =
        (laid(&[]), laid(&[Anchor { at: vec2(90.5, 90.5), source: vec2(70.0, 60.0) }]));
    assert!(!none.is_identity());
    let by = one.at(90, 90) - none.at(90, 90);
    assert!(one.at(90, 90).distance(vec2(70.0, 60.0)) < 1e-3);
    assert!((one.at(120, 70) - none.at(120, 70)).distance(by) < 1e-3, "all of the cylinder");
    assert_eq!(one.at(30, 30), none.at(30, 30), "and nothing of the plate");
    // Two anchors whose sources lie turned by a right angle, as far apart as the points are on the
    // surface.
    let (a, b) = (none.at(70, 60), none.at(100, 60));
    let pins = [(70.5, a), (100.5, a + (b - a).perp())]
        .map(|(x, source)| Anchor { at: vec2(x, 60.5), source });
    let two = laid(&pins);
    assert!(
        (two.at(85, 100) - a).distance((none.at(85, 100) - a).perp()) < 0.05,
        "the plane has turned as one"
    );
}

#[test]
fn a_piece_has_its_picture_turned_moved_and_scaled_alone() {
    let surface = cylinder_and_plate();
    let still = vec![
        Anchor { at: vec2(70.5, 60.5), source: vec2(60.0, 61.0) },
        Anchor::pin(vec2(100.5, 62.5)),
    ];
    let piece = PlanePiece {
        moved: vec2(4.0, -7.0),
        scale: 2.0,
        rotation: 90.0,
        ..PlanePiece::at(vec2(90.5, 80.5))
    };
    let before = Bend { operator: ON_SURFACE, anchors: still, ..Bend::default() };
    let after = Bend { pieces: vec![PlanePiece::at(vec2(30.5, 30.5)), piece], ..before.clone() };
    let [d, e] = [&before, &after].map(|bend| Deformation::new(Some(&surface), SIZE, bend));
    let middle = d.at(90, 80);
    for (x, y) in [(90, 80), (120, 40), (64, 110)] {
        // A quarter turn counter-clockwise takes what lies to the right to above: it is looked up
        // clockwise.
        let away = d.at(x, y) - middle - piece.moved;
        let found = e.at(x, y);
        assert!(found.distance(middle + 0.5 * vec2(-away.y, away.x)) < 2e-3, "({x}, {y}): {found}");
        assert!(
            (e.jacobian(x, y).determinant() / d.jacobian(x, y).determinant() - 0.25).abs() < 1e-3
        );
    }
    assert_eq!(d.at(30, 30), e.at(30, 30), "the plate");
    let (mut filled, rect) = (DeformedRect::default(), Rect::new(20, 20, 140, 115));
    e.fill(rect, &mut filled);
    for (x, y) in (20..115).flat_map(|y| (20..140).map(move |x| (x, y))) {
        let i = (y - 20) as usize * 120 + (x - 20) as usize;
        assert!(vec2(filled.x[i], filled.y[i]).distance(e.at(x, y)) < 1e-3, "({x}, {y})");
    }
}

#[test]
fn a_gradient_on_the_surface_runs_evenly_along_it() {
    let surface = cylinder_and_plate();
    let anchors = vec![Anchor::pin(vec2(80.5, 100.5)), Anchor::pin(vec2(130.5, 100.5))];
    let bend = Bend { operator: ON_SURFACE, anchors, weights: Weights::Segment, ..Bend::default() };
    let d = Deformation::new(Some(&surface), SIZE, &bend);
    for x in [90, 100, 110, 120, 128] {
        let share = (arc(x as f32 + 0.5) - arc(80.5)) / (arc(130.5) - arc(80.5));
        let found = (d.at(x, 100).x - 80.5) / 50.0;
        assert!((found - share).abs() < 0.01, "at {x}: {found} and {share}");
    }
}

proptest! {
    #[test]
    fn a_ramp_on_a_piece_is_turned_moved_and_scaled_about_what_the_piece_shows(
        (x, y, moved_x, moved_y) in (62i32..130, 22i32..118, -40.0f32..40.0, -40.0f32..40.0),
        (scale, rotation) in (0.1f32..8.0, -180.0f32..180.0),
    ) {
        static UNWRAPPED_ONCE: LazyLock<Surface> = LazyLock::new(cylinder_and_plate);
        let surface = &*UNWRAPPED_ONCE;
        let at = vec2(x as f32, y as f32) + 0.5;
        let piece = PlanePiece { at, moved: vec2(moved_x, moved_y), scale, rotation };
        let anchors = vec![Anchor::pin(vec2(70.5, 60.5)), Anchor::pin(vec2(130.5, 90.5))];
        let before = Bend { operator: ON_SURFACE, anchors, weights: Weights::Segment, ..Bend::default() };
        let after = Bend { pieces: vec![piece], ..before.clone() };
        let [d, e] = [&before, &after].map(|bend| Deformation::new(Some(surface), SIZE, bend));
        let look = piece.picture_from_plane(d.at(x, y));
        for (x, y) in [(64, 30), (100, 60), (130, 110)] {
            let (wanted, found) = (look.transform_point2(d.at(x, y)), e.at(x, y));
            let off = found.distance(wanted);
            prop_assert!(off < 2e-3 * (1.0 + 1.0 / scale), "({}, {}): {} px off", x, y, off);
        }
        prop_assert_eq!(d.at(30, 30), e.at(30, 30), "the plate");
    }
}

#[test]
fn anchors_anywhere_leave_the_surface_finite() {
    let (surface, huge) = (cylinder_and_plate(), vec2(f32::MAX, -1e30));
    for at in [vec2(-50.0, 40.0), huge, vec2(f32::NAN, 1.0), vec2(90.5, 60.5)] {
        let anchors =
            vec![Anchor::pin(vec2(90.5, 60.5)), Anchor { at, source: huge }, Anchor::pin(at)];
        for weights in
            [Weights::Shepard { power: 2.0 }, Weights::Shepard { power: 0.3 }, Weights::Segment]
        {
            let bend =
                Bend { operator: ON_SURFACE, anchors: anchors.clone(), weights, ..Bend::default() };
            let d = Deformation::new(Some(&surface), SIZE, &bend);
            assert!(
                [(90, 60), (30, 30), (2, 2)].iter().all(|&(x, y)| d.at(x, y).is_finite()),
                "{at} {weights:?}"
            );
        }
        assert!(Deformation::of_dab(Some(&surface), SIZE, ON_SURFACE, at).at(90, 60).is_finite());
    }
}

proptest! {
    #[test]
    fn d_is_finite_whatever_the_parameters(
        alpha in prop::num::f32::ANY,
        beta in prop::num::f32::ANY,
        power in prop::num::f32::ANY,
        x in prop::num::f32::ANY,
        y in prop::num::f32::ANY,
    ) {
        let surface = sphere();
        let anchors = vec![Anchor { at: vec2(x, 50.5), source: vec2(3.0, y) }, Anchor::pin(vec2(80.5, 60.5))];
        for operator in [
            Operator::Depth { gamma: beta },
            Operator::Normal { alpha, beta, detail: beta },
            Operator::Reflection { alpha, detail: alpha },
        ] {
            for weights in [Weights::Shepard { power: 2.0 }, Weights::Shepard { power }, Weights::Segment] {
                let bend = Bend { operator, anchors: anchors.clone(), weights, ..Bend::default() };
                let deformation = Deformation::new(Some(&surface), SIZE, &bend);
                let mut filled = DeformedRect::default();
                deformation.fill(Rect::new(60, 50, 90, 52), &mut filled);
                prop_assert!(filled.x.iter().chain(&filled.y).all(|v| v.is_finite()), "{bend:?}");
                prop_assert!(deformation.at(80, 60).is_finite() && deformation.jacobian(80, 60).is_finite());
            }
        }
    }
}
