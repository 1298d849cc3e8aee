//! Strokes compared with a scalar reference that evaluates the definition pixel by pixel over the
//! whole canvas.

mod dual;
mod stamps;

use super::*;
use crate::math::{Size, vec2};
use crate::paint::dab_walker::{self, Dab};
use crate::paint::profile::RoundProfile;
use crate::paint::test_scenes;
use crate::paint::{Adjust, ColorJitter, Dynamics, PictureSource, Property, Tip};
use crate::raster::{BlendMode, Picture, Plane, TileGrid};
use crate::surface::{Deformation, links};
use proptest::prelude::*;

const SIZE: Size = Size::new(150, 140);

/// A ball on its own canvas, with matching depth and normals.
fn ball() -> Scene {
    test_scenes::ball(SIZE, 62.0)
}

fn flat() -> Scene {
    Scene { size: SIZE, surface: None }
}

fn line(from: Vec2, to: Vec2) -> Vec<Sample> {
    (0..=10).map(|i| Sample::at(from.lerp(to, i as f32 / 10.0))).collect()
}

fn render(strokes: &[Arc<Stroke>], scene: &Scene) -> TileGrid {
    let mut grid = TileGrid::default();
    for at in TileAt::covering(scene.size.rect()) {
        grid.set(at, render_tile(strokes, scene, at).map(Arc::new));
    }
    grid
}

fn one(stroke: Stroke, scene: &Scene) -> TileGrid {
    render(&[Arc::new(stroke)], scene)
}

fn white(brush: Brush, operator: Operator, samples: Vec<Sample>) -> Stroke {
    Stroke::new(brush, operator, Color::WHITE, samples)
}

/// Coverage of a dab at a pixel: F(A⁻¹(D(q) − q_0)) averaged over the pixel, no more than the share
/// on the stroke's rim.
fn dab_at(dab: &Dab, operator: Operator, scene: &Scene, x: i32, y: i32) -> f32 {
    let d = Deformation::of_dab(scene.surface.as_deref(), scene.size, operator, dab.at);
    let from_center = d.at(x, y) - dab.at;
    let toward = from_center.normalize_or_zero();
    let linked =
        scene.surface.as_ref().map_or(0, |s| s.smooth_links_plane().at(x as usize, y as usize));
    let difference = |before: u8, after: u8, dx: i32, dy: i32, flat: Vec2| {
        let (l, r) = (i32::from(linked & before != 0), i32::from(linked & after != 0));
        match l + r {
            0 => flat,
            n => (d.at(x + r * dx, y + r * dy) - d.at(x - l * dx, y - l * dy)) / n as f32,
        }
    };
    let sides = [
        difference(links::LEFT, links::RIGHT, 1, 0, Vec2::X) / dab.radius,
        difference(links::UP, links::DOWN, 0, 1, Vec2::Y) / dab.radius,
    ];
    let width_squared = sides.iter().map(|side| side.dot(toward).powi(2)).sum::<f32>();
    let across_squared =
        sides.iter().map(|side| side.length_squared()).sum::<f32>() - width_squared;
    let r = from_center.length() / dab.radius;
    let mean =
        RoundProfile::new(dab.hardness, dab.softness).mean_over(r, width_squared, across_squared);
    dab.flow * mean.max(0.0).min(dab.rim.share(r, width_squared.sqrt()))
}

fn reference(stroke: &Stroke, scene: &Scene) -> Plane<f32> {
    let dabs =
        dab_walker::dabs(&stroke.brush, stroke.operator, stroke.color, &stroke.samples, scene);
    Plane::from_fn(scene.size, |x, y| {
        let through =
            dabs.iter().map(|dab| 1.0 - dab_at(dab, stroke.operator, scene, x as i32, y as i32));
        stroke.brush.opacity * (1.0 - through.product::<f32>())
    })
}

fn assert_matches(stroke: Stroke, scene: &Scene) {
    let expected = reference(&stroke, scene);
    let bounds = stroke.bounds(scene);
    let grid = one(stroke, scene);
    let mut touched = 0;
    for y in 0..SIZE.height as i32 {
        for x in 0..SIZE.width as i32 {
            let (a, b) =
                (f32::from(grid.pixel(x, y)[3]), 255.0 * expected.at(x as usize, y as usize));
            assert!((a - b).abs() <= 1.0, "({x}, {y}): {a}, by the definition {b}");
            assert!(a == 0.0 || bounds.contains(x, y), "({x}, {y}) lies outside the bounds");
            touched += i32::from(a > 0.0);
        }
    }
    assert!(touched > 50, "the stroke shows: {touched} pixels");
}

#[test]
fn a_bent_stroke_over_tile_borders_equals_its_definition_pixel_by_pixel() {
    let operators = [
        Operator::None,
        Operator::Depth { gamma: 1.5 },
        Operator::Normal { alpha: 0.6, beta: 1.0, detail: 0.0 },
        Operator::Normal { alpha: -0.3, beta: 0.0, detail: 0.0 },
        Operator::Reflection { alpha: 0.5, detail: 0.0 },
    ];
    for operator in operators {
        let brush =
            Brush { size: 30.0, hardness: 0.3, flow: 0.4, opacity: 0.8, ..Brush::default() };
        assert_matches(white(brush, operator, line(vec2(45.0, 50.0), vec2(95.0, 80.0))), &ball());
    }
}

#[test]
fn a_hard_flat_dab_covers_its_disc() {
    for radius in [0.4f32, 1.0, 3.3, 20.0] {
        let brush = Brush { size: 2.0 * radius, hardness: 1.0, ..Brush::default() };
        let grid = one(white(brush, Operator::None, vec![Sample::at(vec2(64.3, 63.8))]), &flat());
        let rgba = grid.to_straight_rgba(SIZE.rect());
        let area: f32 = rgba.chunks_exact(4).map(|p| f32::from(p[3]) / 255.0).sum();
        let disc = std::f32::consts::PI * radius * radius;
        assert!(
            (area / disc - 1.0).abs() < 0.2 / radius.max(1.0),
            "radius {radius}: {area} px for {disc}"
        );
    }
}

#[test]
fn flow_adds_up_dab_by_dab_and_opacity_caps_the_whole() {
    let center = vec2(64.5, 64.5);
    let alpha = |flow: f32, opacity: f32, n: usize| {
        // Dabs a hundredth of the diameter apart: practically at one point.
        let brush =
            Brush { size: 40.0, spacing: 0.0025, flow, opacity, hardness: 1.0, ..Brush::default() };
        let to = center + vec2(0.1 * (n - 1) as f32, 0.0);
        one(white(brush, Operator::None, vec![Sample::at(center), Sample::at(to)]), &flat())
            .pixel(64, 64)[3]
    };
    assert_eq!(alpha(0.3, 1.0, 1), 77);
    assert_eq!(alpha(0.3, 1.0, 2), 130, "1 − 0.7²");
    assert_eq!(alpha(0.3, 0.5, 2), 65);
    assert_eq!(alpha(0.05, 1.0, 150), 255, "a faint flow reaches full coverage");
    assert_eq!(alpha(0.9, 0.5, 30), 128);
}

#[test]
fn strokes_lie_over_one_another_in_order() {
    let dot = |color: &str| {
        let brush = Brush { size: 20.0, opacity: 0.5, hardness: 1.0, ..Brush::default() };
        Arc::new(Stroke::new(
            brush,
            Operator::None,
            Color::parse(color).unwrap(),
            vec![Sample::at(vec2(30.0, 30.0))],
        ))
    };
    let grid = render(&[dot("#ff0000"), dot("#0000ff")], &flat());
    assert_eq!(grid.pixel(30, 30), [64, 0, 128, 191]);
}

#[test]
fn one_sample_leaves_one_dab_and_none_leaves_nothing() {
    let brush = Brush { size: 20.0, flow: 0.5, hardness: 1.0, ..Brush::default() };
    let grid =
        one(white(brush.clone(), Operator::None, vec![Sample::at(vec2(64.0, 64.0))]), &flat());
    assert_eq!(grid.pixel(64, 64)[3], 128);
    assert!(one(white(brush.clone(), Operator::None, vec![]), &flat()).iter().next().is_none());
    let lost = vec![
        Sample::at(vec2(f32::NAN, 3.0)),
        Sample { pressure: f32::INFINITY, ..Sample::at(Vec2::ONE) },
    ];
    assert!(one(white(brush, Operator::None, lost), &flat()).iter().next().is_none());
}

#[test]
fn samples_that_are_not_numbers_change_no_pixel() {
    let operator = Operator::Normal { alpha: 0.5, beta: 1.0, detail: 0.0 };
    let good = line(vec2(40.0, 40.0), vec2(100.0, 90.0));
    let mut bad = good.clone();
    bad.insert(5, Sample::at(vec2(f32::NAN, 50.0)));
    bad.insert(2, Sample::at(vec2(1e30, f32::NEG_INFINITY)));
    bad.push(Sample { pressure: f32::NAN, ..Sample::at(vec2(120.0, 90.0)) });
    let (a, b) =
        [good, bad].map(|samples| one(white(Brush::default(), operator, samples), &ball())).into();
    assert_eq!(a.to_straight_rgba(SIZE.rect()), b.to_straight_rgba(SIZE.rect()));
}

#[test]
fn threads_do_not_change_a_byte() {
    use rayon::prelude::*;
    let operator = Operator::Depth { gamma: 2.0 };
    let strokes =
        [Arc::new(white(Brush::default(), operator, line(vec2(30.0, 30.0), vec2(120.0, 100.0))))];
    let scene = ball();
    let alone = render(&strokes, &scene);
    let fresh =
        [Arc::new(white(Brush::default(), operator, line(vec2(30.0, 30.0), vec2(120.0, 100.0))))];
    let tiles: Vec<TileAt> = TileAt::covering(SIZE.rect()).collect();
    let together: Vec<_> =
        tiles.par_iter().map(|&at| (at, render_tile(&fresh, &scene, at))).collect();
    for (at, tile) in together {
        assert_eq!(tile.as_ref().map(Tile::bytes), alone.tile(at).map(|t| t.bytes()));
    }
}

#[test]
fn another_surface_bends_the_same_stroke_anew() {
    let stroke = Arc::new(white(
        Brush { size: 30.0, ..Brush::default() },
        Operator::Normal { alpha: 1.0, beta: 1.0, detail: 0.0 },
        vec![Sample::at(vec2(60.0, 60.0))],
    ));
    let (on_ball, on_flat) =
        (render(std::slice::from_ref(&stroke), &ball()), render(&[stroke], &flat()));
    assert_ne!(on_ball.to_straight_rgba(SIZE.rect()), on_flat.to_straight_rgba(SIZE.rect()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn any_dab_on_a_ball_equals_its_definition(
        x in 0.0f32..150.0, y in 0.0f32..140.0, size in 6.0f32..60.0, hardness in 0.0f32..1.0, softness in 0.0f32..1.0,
        alpha in -1.0f32..1.0, beta in 0.0f32..3.0,
    ) {
        let brush = Brush { size, hardness, softness, ..Brush::default() };
        let operator = Operator::Normal { alpha, beta, detail: 0.0 };
        let stroke = white(brush, operator, vec![Sample::at(vec2(x, y))]);
        let (expected, grid) = (reference(&stroke, &ball()), one(stroke, &ball()));
        for y in 0..SIZE.height as usize {
            for x in 0..SIZE.width as usize {
                let a = f32::from(grid.pixel(x as i32, y as i32)[3]);
                prop_assert!((a - 255.0 * expected.at(x, y)).abs() <= 1.0, "({x}, {y}): {a}");
            }
        }
    }
}

/// A square of 60 px, opaque red, and over it a dot of a brush.
fn over_red(brush: Brush, color: &str) -> TileGrid {
    let red = Brush { size: 120.0, hardness: 1.0, ..Brush::default() };
    let dot = |brush, color: &str, at| {
        Arc::new(Stroke::new(
            brush,
            Operator::None,
            Color::parse(color).unwrap(),
            vec![Sample::at(at)],
        ))
    };
    let over = Brush { size: 40.0, hardness: 1.0, ..brush };
    render(&[dot(red, "#ff0000", vec2(60.0, 60.0)), dot(over, color, vec2(120.0, 60.0))], &flat())
}

#[test]
fn a_stroke_blends_with_what_is_beneath_it_in_its_layer() {
    let multiplied = over_red(Brush { blend: BlendMode::Multiply, ..Brush::default() }, "#8080ff");
    assert_eq!(multiplied.pixel(110, 60), [128, 0, 0, 255]);
    assert_eq!(multiplied.pixel(130, 60), [128, 128, 255, 255], "beneath is nothing");
}

#[test]
fn an_erasing_stroke_takes_away_and_one_that_keeps_alpha_paints_only_on_paint() {
    let erased = over_red(Brush { erases: true, opacity: 0.5, ..Brush::default() }, "#00ff00");
    assert_eq!((erased.pixel(110, 60), erased.pixel(130, 60)), ([128, 0, 0, 128], [0; 4]));
    let kept = over_red(Brush { keeps_alpha: true, ..Brush::default() }, "#00ff00");
    assert_eq!((kept.pixel(110, 60), kept.pixel(130, 60)), ([0, 255, 0, 255], [0; 4]));
}

#[test]
fn a_driven_opacity_is_a_ceiling_that_more_dabs_do_not_pass() {
    let dynamics = Dynamics::none().with_pressure(Property::Opacity, 1.0);
    let press = |pressure: f32, jitter: ColorJitter| {
        let brush = Brush {
            size: 30.0,
            flow: 0.5,
            spacing: 0.02,
            hardness: 1.0,
            jitter,
            dynamics: dynamics.clone(),
            ..Brush::default()
        };
        let samples = line(vec2(40.0, 60.0), vec2(100.0, 60.0))
            .into_iter()
            .map(|s| Sample { pressure, ..s })
            .collect();
        one(white(brush, Operator::None, samples), &flat()).pixel(70, 60)
    };
    let varied = ColorJitter { hue_degrees: 1.0, ..ColorJitter::default() };
    assert_eq!(press(0.5, ColorJitter::default()), [128; 4]);
    assert_eq!(press(0.5, varied), [128; 4], "white has no hue to vary");
    assert_eq!(press(1.0, varied), [255; 4]);
}

#[test]
fn every_dab_has_its_own_color_where_the_brush_varies_it() {
    let brush = Brush {
        size: 10.0,
        hardness: 1.0,
        spacing: 2.0,
        jitter: ColorJitter { hue_degrees: 180.0, ..ColorJitter::default() },
        ..Brush::default()
    };
    let stroke = Stroke::new(
        brush,
        Operator::None,
        Color::parse("#ff0000").unwrap(),
        line(vec2(10.0, 60.0), vec2(130.0, 60.0)),
    );
    let dabs =
        dab_walker::dabs(&stroke.brush, stroke.operator, stroke.color, &stroke.samples, &flat());
    let grid = one(stroke, &flat());
    let mut colors: Vec<[u8; 4]> = dabs
        .iter()
        .map(|dab| {
            let pixel = grid.pixel(dab.at.x as i32, dab.at.y as i32);
            assert_eq!(pixel, [dab.color.r, dab.color.g, dab.color.b, 255]);
            pixel
        })
        .collect();
    colors.dedup();
    assert!(colors.len() > 4, "{colors:?}");
}

/// D of a dab by MATH 2, written out again: q + L Σ …, or q + f_p (q − q_0), with the ball's own n̄
/// and z.
fn deform_by_math(operator: Operator, q: Vec2, anchor: Vec2) -> Option<Vec2> {
    let over = |q: Vec2| {
        // The pixel that holds q, as the maps do.
        let p = (q.floor() + 0.5 - SIZE.center()) / 62.0;
        let nz = (1.0 - p.length_squared()).max(0.0).sqrt().max(0.02);
        (p.length() < 1.0).then(|| {
            (p / (p.length_squared() + nz * nz).sqrt(), 1.0 - (1.0 - p.length_squared()).sqrt())
        })
    };
    let ((n, z), (n0, z0)) = (over(q)?, over(anchor)?);
    Some(match operator {
        Operator::Normal { alpha, beta, .. } => {
            let u = n.distance(n0);
            let f = alpha * u / ((-beta).exp() + u * (1.0 - (-beta).exp()));
            q + 150.0 * f * (n - n0)
        }
        Operator::Depth { gamma } => {
            let (u, e) = (z - z0, gamma.exp());
            q + 2.0 * u * (e - 1.0) / ((e + 1.0) - u * (e - 1.0)) * (q - anchor)
        }
        _ => q,
    })
}

#[test]
fn driven_dabs_on_a_ball_lie_where_math_puts_them() {
    let steeper = |property| {
        Dynamics::none().with(property, crate::paint::Input::Slope, crate::paint::Curve::Share(1.0))
    };
    for (operator, property) in [
        (Operator::Normal { alpha: 0.9, beta: 1.2, detail: 0.0 }, Property::Alpha),
        (Operator::Depth { gamma: 2.5 }, Property::Gamma),
    ] {
        let at = vec2(100.3, 50.7);
        let brush =
            Brush { size: 34.0, hardness: 1.0, dynamics: steeper(property), ..Brush::default() };
        let grid = one(white(brush, operator, vec![Sample::at(at)]), &ball());
        // 1 − n_z at the dab's pixel scales α and γ.
        let p = (at.floor() + 0.5 - SIZE.center()) / 62.0;
        let slope = 1.0 - (1.0 - p.length_squared()).sqrt();
        let driven = match operator {
            Operator::Normal { alpha, beta, detail } => {
                Operator::Normal { alpha: alpha * slope, beta, detail }
            }
            Operator::Depth { gamma } => Operator::Depth { gamma: gamma * slope },
            other => other,
        };
        let (mut inside, mut outside) = (0, 0);
        for (x, y) in
            (0..SIZE.height as i32).flat_map(|y| (0..SIZE.width as i32).map(move |x| (x, y)))
        {
            let q = vec2(x as f32 + 0.5, y as f32 + 0.5);
            // At the silhouette depth falls so steeply that a pixel spans more than the dab.
            let Some(d) =
                deform_by_math(driven, q, at).filter(|_| q.distance(SIZE.center()) < 58.0)
            else {
                continue;
            };
            let (distance, alpha) = (d.distance(at), grid.pixel(x, y)[3]);
            // Away from the rim, within what a pixel spans there.
            if distance < 14.0 {
                assert_eq!(alpha, 255, "{operator:?} ({x}, {y}): {distance}");
                inside += 1;
            } else if distance > 22.0 {
                assert_eq!(alpha, 0, "{operator:?} ({x}, {y}): {distance}");
                outside += 1;
            }
        }
        assert!(inside > 150 && outside > 1000, "{inside}, {outside}");
    }
}
