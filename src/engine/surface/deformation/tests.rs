//! D on surfaces whose normals and depth are formulas.

mod on_surface;

use super::*;
use crate::math::{Vec3, vec3};
use crate::raster::Plane;
use crate::surface::Maps;
use crate::surface::plane_piece::PlanePiece;
use proptest::prelude::*;

const SIZE: Size = Size::new(160, 120);

/// A surface from its height over a point, its slope (∂h/∂x, ∂h/∂y; image axes) and whether it is
/// there at all.
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
    let three = vec![Anchor::pin(vec2(60.5, 40.5)), dragged, Anchor::pin(vec2(45.0, 70.0))];
    let bend = |anchors: &[Anchor], weights| Bend {
        operator,
        anchors: anchors.to_vec(),
        weights,
        ..Bend::default()
    };
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
                let (px, py) =
                    (rect.x0 + (i % rect.width()) as i32, rect.y0 + (i / rect.width()) as i32);
                let reference = deformation.at(px, py);
                assert!(
                    (vec2(x, y) - reference).length() < 1e-4,
                    "{bend:?} at {px}, {py}: {x}, {y} ≠ {reference}"
                );
            }
        }
    }
}

#[test]
fn short_rows_hold_the_same_bits_as_whole_ones() {
    let rects = [Rect::new(20, 10, 86, 76), Rect::new(40, 50, 47, 53), Rect::new(-3, 90, 30, 130)];
    for (operator, surface) in
        OPERATORS.iter().flat_map(|operator| [(*operator, sphere()), (*operator, paraboloid())])
    {
        let d = Deformation::of_dab(Some(&surface), SIZE, operator, vec2(61.3, 48.9));
        for rect in rects {
            let (mut whole, mut part) = (DeformedRect::default(), DeformedRect::default());
            d.fill(rect, &mut whole);
            let columns = |y: i32| rect.x0 + (y & 3)..rect.x1 - (y & 7);
            d.fill_spans(rect, columns, &mut part);
            let pixels = (rect.y0..rect.y1).flat_map(|y| columns(y).map(move |x| (x, y)));
            for (x, y) in pixels {
                let i = (y - rect.y0) as usize * rect.width() + (x - rect.x0) as usize;
                let bits = |d: &DeformedRect| (d.x[i].to_bits(), d.y[i].to_bits());
                assert_eq!(bits(&part), bits(&whole), "{operator:?} at ({x}, {y})");
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
                let differenced =
                    Mat2::from_cols((d(1, 0) - d(-1, 0)) * 0.5, (d(0, 1) - d(0, -1)) * 0.5);
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
    // The last covered pixel of a row: beyond it is the identity, 100 px away.
    let y = 60;
    let x =
        (80..SIZE.width as i32).rfind(|&x| surface.coverage(x as usize, y as usize) > 0).unwrap();
    let (edge, inside) = (deformation.jacobian(x, y), deformation.jacobian(x - 3, y));
    assert!(
        (deformation.at(x + 1, y) - deformation.at(x, y)).length() > 20.0,
        "there is a jump to avoid"
    );
    assert!((edge - inside).abs_diff_eq(Mat2::ZERO, 0.3), "{edge} ≠ {inside}");
}

#[test]
fn a_ball_reflects_the_whole_image_and_a_plane_none_of_it() {
    // n̄ = q/70 on the ball: with β = 0 and the anchor at its middle D is a scaling.
    let (ball, alpha) = (sphere(), 0.5);
    let operator = Operator::Normal { alpha, beta: 0.0, detail: 0.0 };
    let center = vec2(80.5, 60.5);
    let bend = Bend { operator, anchors: vec![Anchor::pin(center)], ..Bend::default() };
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
        anchors: vec![Anchor::pin(vec2(80.5, 60.5))],
        ..Bend::default()
    };
    let offset = |detail| {
        Deformation::new(Some(&surface), SIZE, &bend(detail)).at(90, 70) - vec2(90.5, 70.5)
    };
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
    let bend = Bend { operator, anchors: vec![Anchor::pin(off)], ..Bend::default() };
    // f_n is linear: the offset is L |d| d of the relative normal d, here n̄ itself.
    let d = Deformation::new(Some(&surface), SIZE, &bend).at(100, 60) - vec2(100.5, 60.5);
    assert!((d - 160.0 * nbar.length() * nbar).length() < 1e-2, "{d}");
    let rim = nbar - surface.nbar(3, 60);
    let d =
        Deformation::of_dab(Some(&surface), SIZE, operator, off).at(100, 60) - vec2(100.5, 60.5);
    assert!((d - 160.0 * rim.length() * rim).length() < 1e-2, "{d}");
}

#[test]
fn identity_is_known_without_looking_at_pixels() {
    let surface = sphere();
    let still = Bend {
        operator: OPERATORS[0],
        anchors: vec![Anchor::pin(vec2(9.0, 9.0))],
        ..Bend::default()
    };
    assert!(!Deformation::new(Some(&surface), SIZE, &still).is_identity());
    assert!(Deformation::new(None, SIZE, &still).is_identity());
    let flat = Bend { operator: Operator::Depth { gamma: 0.0 }, ..still.clone() };
    assert!(Deformation::new(Some(&surface), SIZE, &flat).is_identity());
    assert!(!Deformation::new(None, SIZE, &bends(Operator::None)[0]).is_identity());
}

#[test]
fn counted_from_another_corner_a_moved_surface_gives_the_same_bits() {
    let (size, by) = (Size::new(90, 70), (17, 9));
    let at = |x: f32, y: f32| vec3((x * 0.11).sin() * 0.4, (y * 0.13).cos() * 0.3, 0.8).normalize();
    let surface = |shift: (i32, i32)| {
        let normals =
            Plane::from_fn(size, |x, y| at(x as f32 - shift.0 as f32, y as f32 - shift.1 as f32));
        let depth = Plane::from_fn(size, |x, y| {
            (x as f32 - shift.0 as f32) * 0.01 + (y as f32 - shift.1 as f32) * 0.004
        });
        let mut depth = depth.map(|v| v.max(0.0).min(1.0));
        // The range stays the same.
        depth.set(0, 0, 0.0);
        depth.set(89, 69, 1.0);
        Surface::new(Maps { normals, depth, coverage: Plane::full(size, 255) }).unwrap()
    };
    let bend = |shift: (i32, i32)| {
        let move_by = vec2(shift.0 as f32, shift.1 as f32);
        let pin = |x: f32, y: f32| Anchor {
            at: vec2(x, y) + move_by,
            source: vec2(x + 1.5, y) + move_by,
        };
        Bend {
            operator: Operator::Normal { alpha: 0.37, beta: 1.3, detail: 0.0 },
            anchors: vec![pin(20.5, 30.25), pin(44.125, 18.5)],
            ..Bend::default()
        }
    };
    let (here, there) = (surface((0, 0)), surface(by));
    let (mut a, mut b) = (DeformedRect::default(), DeformedRect::default());
    Deformation::new(Some(&here), size, &bend((0, 0))).fill(Rect::new(5, 5, 60, 50), &mut a);
    let moved = Deformation::new(Some(&there), size, &bend(by)).with_origin(by);
    moved.fill(Rect::new(5 + by.0, 5 + by.1, 60 + by.0, 50 + by.1), &mut b);
    assert!(a.x == b.x && a.y == b.y);
    assert!(
        moved
            .at(30 + by.0, 20 + by.1)
            .distance(Deformation::new(Some(&here), size, &bend((0, 0))).at(30, 20))
            < 1e-6
    );
}
