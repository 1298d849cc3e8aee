//! D on surfaces whose normals and depth are formulas.

use super::*;
use crate::math::{Vec3, vec3};
use crate::raster::Plane;
use crate::surface::Maps;
use crate::surface::plane_piece::PlanePiece;
use proptest::prelude::*;

const SIZE: Size = Size::new(160, 120);

/// A surface from its height over a point, its slope (∂h/∂x, ∂h/∂y; image axes) and whether it is there at all.
fn surface(height: impl Fn(Vec2) -> Option<(f32, Vec2)> + Sync) -> Surface {
    let at = |x: usize, y: usize| height(vec2(x as f32 + 0.5, y as f32 + 0.5));
    let normals = Plane::from_fn(SIZE, |x, y| {
        at(x, y).map_or(Vec3::ZERO, |(_, slope)| vec3(-slope.x, slope.y, 1.0).normalize_or_zero())
    });
    let depth = Plane::from_fn(SIZE, |x, y| at(x, y).map_or(1.0, |(h, _)| 1.0 - h / 80.0));
    let coverage = Plane::from_fn(SIZE, |x, y| if at(x, y).is_some() { 255 } else { 0 });
    Surface::new(Maps { normals, depth, coverage }).unwrap()
}

/// A ball of radius 70 px seen up to 0.9 of its rim.
fn sphere() -> Surface {
    surface(|q| {
        let d = q - vec2(80.0, 60.0);
        let h = (70.0f32.powi(2) - d.length_squared()).sqrt();
        (d.length() < 55.0).then(|| (h, -d / h))
    })
}

/// A bowl-shaped hill over the whole canvas.
fn paraboloid() -> Surface {
    surface(|q| {
        let d = q - vec2(90.0, 50.0);
        Some((80.0 - d.length_squared() / 250.0, -d / 125.0))
    })
}

const OPERATORS: [Operator; 8] = [
    Operator::Depth { gamma: 1.5 },
    Operator::Normal { alpha: 0.8, beta: 0.0, detail: 0.0 },
    Operator::Normal { alpha: 0.5, beta: 2.0, detail: 0.0 },
    Operator::Normal { alpha: -0.4, beta: 1.0, detail: 0.0 },
    Operator::Reflection { alpha: 0.7, detail: 0.0 },
    Operator::Normal { alpha: 0.4, beta: 1.0, detail: 1.5 },
    Operator::Reflection { alpha: 0.3, detail: 0.5 },
    Operator::Surface { amount: 1.0, smooth: 0.0 },
];

/// One anchor, three with one of them dragged, and the gradient's two.
fn bends(operator: Operator) -> [Bend; 4] {
    let dragged = Anchor { at: vec2(100.5, 80.5), source: vec2(90.0, 85.0) };
    let three = vec![Anchor::fixed(vec2(60.5, 40.5)), dragged, Anchor::fixed(vec2(45.0, 70.0))];
    let bend = |anchors: &[Anchor], weights| Bend { operator, anchors: anchors.to_vec(), weights, ..Bend::default() };
    [
        bend(&three[1..2], Weights::default()),
        bend(&three, Weights::default()),
        bend(&three, Weights::Shepard { power: 3.0 }),
        bend(&three[..2], Weights::Segment),
    ]
}

#[test]
fn an_anchor_shows_its_source_point() {
    for surface in [sphere(), paraboloid()] {
        for bend in OPERATORS.into_iter().flat_map(bends) {
            let deformation = Deformation::new(Some(&surface), SIZE, &bend);
            for anchor in bend.anchors.iter().filter(|a| a.at.fract() == Vec2::splat(0.5)) {
                let d = deformation.at(anchor.at.x as i32, anchor.at.y as i32);
                assert!((d - anchor.source).length() < 1e-4, "{bend:?}: {d}");
            }
        }
    }
}

#[test]
fn rows_hold_what_the_reference_says_inside_the_maps_and_beyond() {
    let rect = Rect::new(-7, -3, 171, 125);
    let mut filled = DeformedRect::default();
    for surface in [Some(sphere()), Some(paraboloid()), None] {
        for bend in OPERATORS.into_iter().chain([Operator::None]).flat_map(bends) {
            let deformation = Deformation::new(surface.as_ref(), SIZE, &bend);
            deformation.fill(rect, &mut filled);
            for (i, (&x, &y)) in filled.x.iter().zip(&filled.y).enumerate() {
                let (px, py) = (rect.x0 + (i % rect.width()) as i32, rect.y0 + (i / rect.width()) as i32);
                let reference = deformation.at(px, py);
                assert!((vec2(x, y) - reference).length() < 1e-4, "{bend:?} at {px}, {py}: {x}, {y} ≠ {reference}");
            }
        }
    }
}

#[test]
fn the_jacobian_is_the_derivative_of_d() {
    for surface in [sphere(), paraboloid()] {
        for bend in OPERATORS.into_iter().flat_map(bends) {
            let deformation = Deformation::new(Some(&surface), SIZE, &bend);
            for (x, y) in [(70, 50), (80, 90), (110, 45), (52, 61), (99, 70)] {
                let d = |dx, dy| deformation.at(x + dx, y + dy);
                let differenced = Mat2::from_cols((d(1, 0) - d(-1, 0)) * 0.5, (d(0, 1) - d(0, -1)) * 0.5);
                let jacobian = deformation.jacobian(x, y);
                let error = jacobian - differenced;
                let size = 1.0 + jacobian.x_axis.length() + jacobian.y_axis.length();
                let largest = error.x_axis.length().max(error.y_axis.length()) / size;
                assert!(largest < 4e-3, "{bend:?} at {x}, {y}: {jacobian} ≠ {differenced}");
            }
        }
    }
}

#[test]
fn the_jacobian_does_not_look_across_the_mask_edge() {
    let surface = sphere();
    let bend = &bends(OPERATORS[1])[0];
    let deformation = Deformation::new(Some(&surface), SIZE, bend);
    // The last covered pixel of a row: beyond it stands the identity, 100 px away.
    let y = 60;
    let x = (80..SIZE.width as i32).rfind(|&x| surface.coverage(x as usize, y as usize) > 0).unwrap();
    let (edge, inside) = (deformation.jacobian(x, y), deformation.jacobian(x - 3, y));
    assert!((deformation.at(x + 1, y) - deformation.at(x, y)).length() > 20.0, "there is a jump to avoid");
    assert!((edge - inside).abs_diff_eq(Mat2::ZERO, 0.3), "{edge} ≠ {inside}");
}

#[test]
fn a_ball_reflects_the_whole_image_and_a_plane_none_of_it() {
    // n̄ = q/70 on the ball: with β = 0 and the anchor at its middle D is a scaling.
    let (ball, alpha) = (sphere(), 0.5);
    let operator = Operator::Normal { alpha, beta: 0.0, detail: 0.0 };
    let center = vec2(80.5, 60.5);
    let bend = Bend { operator, anchors: vec![Anchor::fixed(center)], ..Bend::default() };
    let d = Deformation::new(Some(&ball), SIZE, &bend).at(110, 60);
    // f_n(u) d = α u d (eq. 14 at β = 0), u = |d|, L = 160.
    let u = 30.0 / 70.0;
    assert!((d.x - (110.5 + 160.0 * alpha * u * u)).abs() < 0.01, "{d}");

    let plane = surface(|q| Some((q.x * 0.3, vec2(0.3, 0.0))));
    let d = Deformation::new(Some(&plane), SIZE, &bend).at(110, 60);
    assert!((d - vec2(110.5, 60.5)).length() < 1e-3, "{d}");
}

#[test]
fn detail_bends_more_where_the_surface_is_convex() {
    let surface = sphere();
    let bend = |detail| Bend {
        operator: Operator::Normal { alpha: 0.5, beta: 1.0, detail },
        anchors: vec![Anchor::fixed(vec2(80.5, 60.5))],
        ..Bend::default()
    };
    let offset = |detail| Deformation::new(Some(&surface), SIZE, &bend(detail)).at(90, 70) - vec2(90.5, 70.5);
    let kappa = surface.curvature(DETAIL_BLUR_PX).kappa(90, 70, DETAIL_SCALE_PX);
    assert!(kappa > 0.1, "a ball is convex: {kappa}");
    assert!((offset(2.0) - offset(0.0) * (1.0 + 2.0 * kappa)).length() < 1e-3);
}

#[test]
fn outside_the_surface_dragged_content_still_moves() {
    let surface = sphere();
    let bend = &bends(OPERATORS[0])[0];
    let d = Deformation::new(Some(&surface), SIZE, bend).at(2, 2);
    assert_eq!(d, vec2(2.5, 2.5) + (vec2(90.0, 85.0) - vec2(100.5, 80.5)));
}

#[test]
fn an_anchor_off_the_surface_reads_the_background_and_a_dab_the_nearest_rim() {
    let surface = sphere();
    let operator = Operator::Normal { alpha: 1.0, beta: 0.0, detail: 0.0 };
    let off = vec2(3.0, 60.0);
    let nbar = surface.nbar(100, 60);
    let bend = Bend { operator, anchors: vec![Anchor::fixed(off)], ..Bend::default() };
    // f_n is linear: the offset is L |d| d of the relative normal d, here n̄ itself.
    let d = Deformation::new(Some(&surface), SIZE, &bend).at(100, 60) - vec2(100.5, 60.5);
    assert!((d - 160.0 * nbar.length() * nbar).length() < 1e-2, "{d}");
    let rim = nbar - surface.nbar(3, 60);
    let d = Deformation::of_dab(Some(&surface), SIZE, operator, off).at(100, 60) - vec2(100.5, 60.5);
    assert!((d - 160.0 * rim.length() * rim).length() < 1e-2, "{d}");
}

#[test]
fn identity_is_known_without_looking_at_pixels() {
    let surface = sphere();
    let still = Bend { operator: OPERATORS[0], anchors: vec![Anchor::fixed(vec2(9.0, 9.0))], ..Bend::default() };
    assert!(!Deformation::new(Some(&surface), SIZE, &still).is_identity());
    assert!(Deformation::new(None, SIZE, &still).is_identity());
    let flat = Bend { operator: Operator::Depth { gamma: 0.0 }, ..still.clone() };
    assert!(Deformation::new(Some(&surface), SIZE, &flat).is_identity());
    assert!(!Deformation::new(None, SIZE, &bends(Operator::None)[0]).is_identity());
}

const ON_SURFACE: Operator = Operator::Surface { amount: 1.0, smooth: 0.0 };

/// A cylinder of radius 60 px about a vertical axis, and before its left half a plate that floats 15 px higher.
fn cylinder_and_plate() -> Surface {
    surface(|q| {
        let x = q.x - 80.0;
        let h = (3600.0 - x * x).max(0.0).sqrt();
        let plate = (20.0..50.0).contains(&q.x) && (20.0..50.0).contains(&q.y);
        if plate { Some((78.0, Vec2::ZERO)) } else { (x.abs() < 55.0).then(|| (h, vec2(-x / h, 0.0))) }
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
        assert!(found.distance(truth) < 0.01 * truth.length() + 0.05, "({x}, {y}): {found} and {truth}");
    }
    assert!(d.at(30, 30).distance(at) > 1e5, "the plate is another object");
    let grain = Deformation::of_pattern(Some(&surface), SIZE, ON_SURFACE, at);
    assert!(grain.at(30, 30).distance(vec2(30.5, 30.5)) < 1.0, "a pattern lies on it too, in its own plane");
    assert_eq!(grain.at(105, 80), d.at(105, 80));
}

#[test]
fn an_anchor_moves_the_plane_of_its_object_and_two_turn_it() {
    let surface = cylinder_and_plate();
    let laid = |anchors: &[Anchor]| {
        let bend = Bend { operator: ON_SURFACE, anchors: anchors.to_vec(), ..Bend::default() };
        Deformation::new(Some(&surface), SIZE, &bend)
    };
    let (none, one) = (laid(&[]), laid(&[Anchor { at: vec2(90.5, 90.5), source: vec2(70.0, 60.0) }]));
    assert!(!none.is_identity());
    let by = one.at(90, 90) - none.at(90, 90);
    assert!(one.at(90, 90).distance(vec2(70.0, 60.0)) < 1e-3);
    assert!((one.at(120, 70) - none.at(120, 70)).distance(by) < 1e-3, "all of the cylinder");
    assert_eq!(one.at(30, 30), none.at(30, 30), "and nothing of the plate");
    // Two anchors whose sources lie turned by a right angle, as far apart as the points are on the surface.
    let (a, b) = (none.at(70, 60), none.at(100, 60));
    let pins = [(70.5, a), (100.5, a + (b - a).perp())].map(|(x, source)| Anchor { at: vec2(x, 60.5), source });
    let two = laid(&pins);
    assert!((two.at(85, 100) - a).distance((none.at(85, 100) - a).perp()) < 0.05, "the plane has turned as one");
}

#[test]
fn a_piece_has_its_picture_turned_moved_and_scaled_alone() {
    let surface = cylinder_and_plate();
    let still = vec![Anchor { at: vec2(70.5, 60.5), source: vec2(60.0, 61.0) }, Anchor::fixed(vec2(100.5, 62.5))];
    let piece = PlanePiece { moved: vec2(4.0, -7.0), scale: 2.0, rotation: 90.0, ..PlanePiece::at(vec2(90.5, 80.5)) };
    let before = Bend { operator: ON_SURFACE, anchors: still, ..Bend::default() };
    let after = Bend { pieces: vec![PlanePiece::at(vec2(30.5, 30.5)), piece], ..before.clone() };
    let [d, e] = [&before, &after].map(|bend| Deformation::new(Some(&surface), SIZE, bend));
    let middle = d.at(90, 80);
    for (x, y) in [(90, 80), (120, 40), (64, 110)] {
        // A quarter turn counter-clockwise takes what lies to the right to above: it is looked up clockwise.
        let away = d.at(x, y) - middle - piece.moved;
        let found = e.at(x, y);
        assert!(found.distance(middle + 0.5 * vec2(-away.y, away.x)) < 2e-3, "({x}, {y}): {found}");
        assert!((e.jacobian(x, y).determinant() / d.jacobian(x, y).determinant() - 0.25).abs() < 1e-3);
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
    let anchors = vec![Anchor::fixed(vec2(80.5, 100.5)), Anchor::fixed(vec2(130.5, 100.5))];
    let bend = Bend { operator: ON_SURFACE, anchors, weights: Weights::Segment, ..Bend::default() };
    let d = Deformation::new(Some(&surface), SIZE, &bend);
    for x in [90, 100, 110, 120, 128] {
        let share = (arc(x as f32 + 0.5) - arc(80.5)) / (arc(130.5) - arc(80.5));
        let found = (d.at(x, 100).x - 80.5) / 50.0;
        assert!((found - share).abs() < 0.01, "at {x}: {found} and {share}");
    }
}

#[test]
fn anchors_anywhere_leave_the_surface_finite() {
    let (surface, huge) = (cylinder_and_plate(), vec2(f32::MAX, -1e30));
    for at in [vec2(-50.0, 40.0), huge, vec2(f32::NAN, 1.0), vec2(90.5, 60.5)] {
        let anchors = vec![Anchor::fixed(vec2(90.5, 60.5)), Anchor { at, source: huge }, Anchor::fixed(at)];
        for weights in [Weights::Shepard { power: 2.0 }, Weights::Shepard { power: 0.3 }, Weights::Segment] {
            let bend = Bend { operator: ON_SURFACE, anchors: anchors.clone(), weights, ..Bend::default() };
            let d = Deformation::new(Some(&surface), SIZE, &bend);
            assert!([(90, 60), (30, 30), (2, 2)].iter().all(|&(x, y)| d.at(x, y).is_finite()), "{at} {weights:?}");
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
        let anchors = vec![Anchor { at: vec2(x, 50.5), source: vec2(3.0, y) }, Anchor::fixed(vec2(80.5, 60.5))];
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
#[test]
fn counted_from_another_corner_a_moved_surface_gives_the_same_bits() {
    let (size, by) = (Size::new(90, 70), (17, 9));
    let at = |x: f32, y: f32| vec3((x * 0.11).sin() * 0.4, (y * 0.13).cos() * 0.3, 0.8).normalize();
    let surface = |shift: (i32, i32)| {
        let normals = Plane::from_fn(size, |x, y| at(x as f32 - shift.0 as f32, y as f32 - shift.1 as f32));
        let depth =
            Plane::from_fn(size, |x, y| (x as f32 - shift.0 as f32) * 0.01 + (y as f32 - shift.1 as f32) * 0.004);
        let mut depth = depth.map(|v| v.max(0.0).min(1.0));
        // The range stays the same.
        depth.set(0, 0, 0.0);
        depth.set(89, 69, 1.0);
        Surface::new(Maps { normals, depth, coverage: Plane::filled(size, 255) }).unwrap()
    };
    let bend = |shift: (i32, i32)| {
        let move_by = vec2(shift.0 as f32, shift.1 as f32);
        let pin = |x: f32, y: f32| Anchor { at: vec2(x, y) + move_by, source: vec2(x + 1.5, y) + move_by };
        Bend {
            operator: Operator::Normal { alpha: 0.37, beta: 1.3, detail: 0.0 },
            anchors: vec![pin(20.5, 30.25), pin(44.125, 18.5)],
            ..Bend::default()
        }
    };
    let (here, there) = (surface((0, 0)), surface(by));
    let (mut a, mut b) = (DeformedRect::default(), DeformedRect::default());
    Deformation::new(Some(&here), size, &bend((0, 0))).fill(Rect::new(5, 5, 60, 50), &mut a);
    let moved = Deformation::new(Some(&there), size, &bend(by)).about(by);
    moved.fill(Rect::new(5 + by.0, 5 + by.1, 60 + by.0, 50 + by.1), &mut b);
    assert!(a.x == b.x && a.y == b.y);
    assert!(
        moved.at(30 + by.0, 20 + by.1).distance(Deformation::new(Some(&here), size, &bend((0, 0))).at(30, 20)) < 1e-6
    );
}
