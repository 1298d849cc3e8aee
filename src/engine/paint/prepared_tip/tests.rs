//! Strokes of every tip compared with their definitions, pixel by pixel, on a ball and on a flat
//! canvas.

use super::TipShape;
use crate::math::{Size, Vec2, srgb::Color, vec2};
use crate::paint::dab::shape;
use crate::paint::dab_walker::Dab;
use crate::paint::dynamics::{Curve, Dynamics, Input, Property};
use crate::paint::grain::{BrushGrain, GrainSource, GrainSpace, StrokeGrain};
use crate::paint::pattern::Pattern;
use crate::paint::profile::RoundProfile;
use crate::paint::rim::Rim;
use crate::paint::stroke::render_tile;
use crate::paint::test_scenes;
use crate::paint::tip::{Bristles, Hose, HoseRank, Noise, RankSelect};
use crate::paint::{Adjust, Brush, PictureSource, Sample, Scene, Stroke, Tip};
use crate::raster::{Picture, TILE, TileAt, TileGrid};
use crate::surface::{Deformation, Operator, links};
use std::sync::Arc;

const SIZE: Size = Size::new(140, 130);
const AT: Vec2 = vec2(66.0, 62.0);

fn ball() -> Scene {
    test_scenes::ball(SIZE, 58.0)
}

fn flat() -> Scene {
    Scene { size: SIZE, surface: None }
}

fn paint(brush: Brush, operator: Operator, samples: Vec<Sample>, scene: &Scene) -> TileGrid {
    let stroke = [Arc::new(Stroke::new(brush, operator, Color::WHITE, samples))];
    let mut grid = TileGrid::default();
    for at in TileAt::covering(SIZE.rect()) {
        grid.set(at, render_tile(&stroke, scene, at).map(Arc::new));
    }
    grid
}

fn dab(brush: &Brush, operator: Operator, scene: &Scene) -> TileGrid {
    paint(brush.clone(), operator, vec![Sample::at(AT)], scene)
}

fn pixels() -> impl Iterator<Item = (i32, i32)> {
    (0..SIZE.height as i32).flat_map(|y| (0..SIZE.width as i32).map(move |x| (x, y)))
}

fn alpha(grid: &TileGrid) -> Vec<u8> {
    pixels().map(|(x, y)| grid.pixel(x, y)[3]).collect()
}

/// A shape's coverage at a pixel by the definition, one pixel at a time.
fn coverage_by_definition(
    shape: TipShape,
    brush: &Brush,
    operator: Operator,
    scene: &Scene,
    (x, y): (i32, i32),
) -> f32 {
    let dab = Dab {
        rotation_rad: brush.rotation.to_radians(),
        hardness: brush.hardness,
        softness: brush.softness,
        ..Dab::plain(AT, 0.5 * brush.size)
    };
    let d = Deformation::of_dab(scene.surface.as_deref(), scene.size, operator, dab.at);
    let map = shape.tip_from_canvas(&dab);
    let at = |x: i32, y: i32| map.transform_point2(d.at(x, y));
    let linked =
        scene.surface.as_ref().map_or(0, |s| s.smooth_links_plane().at(x as usize, y as usize));
    let difference = |before: u8, after: u8, dx: i32, dy: i32, flat: Vec2| {
        let (l, r) = (i32::from(linked & before != 0), i32::from(linked & after != 0));
        match l + r {
            0 => flat,
            n => (at(x + r * dx, y + r * dy) - at(x - l * dx, y - l * dy)) / n as f32,
        }
    };
    let (x_axis, y_axis) = (map.matrix2.x_axis, map.matrix2.y_axis);
    let across = difference(links::LEFT, links::RIGHT, 1, 0, x_axis);
    let along = difference(links::UP, links::DOWN, 0, 1, y_axis);
    let of = match shape {
        TipShape::Ellipse { .. } => shape::ellipse,
        TipShape::Square { .. } => shape::square,
    };
    let p = at(x, y);
    let profile = RoundProfile::new(dab.hardness, dab.softness);
    of(&profile, Rim::SOFT, (p.x, p.y), across.into(), along.into()).0
}

#[test]
fn ellipses_and_squares_over_tile_borders_equal_their_definition_pixel_by_pixel() {
    let operators = [
        Operator::None,
        Operator::Depth { gamma: 1.5 },
        Operator::Normal { alpha: 0.5, beta: 1.0, detail: 0.0 },
    ];
    for operator in operators {
        for (tip, shape) in [
            (Tip::Ellipse { ratio: 0.3 }, TipShape::Ellipse { ratio: 0.3 }),
            (Tip::Square { ratio: 0.6 }, TipShape::Square { ratio: 0.6 }),
        ] {
            let brush = Brush {
                size: 46.0,
                hardness: 0.6,
                softness: 0.2,
                rotation: 25.0,
                tip,
                ..Brush::default()
            };
            let scene = ball();
            let grid = dab(&brush, operator, &scene);
            let mut touched = 0;
            for (x, y) in pixels() {
                let (a, b) = (
                    f32::from(grid.pixel(x, y)[3]),
                    255.0 * coverage_by_definition(shape, &brush, operator, &scene, (x, y)),
                );
                assert!(
                    (a - b).abs() <= 1.0,
                    "{shape:?} {operator:?} ({x}, {y}): {a}, by the definition {b}"
                );
                touched += i32::from(a > 0.0);
            }
            assert!(touched > 100);
        }
    }
}

#[test]
fn a_textured_tip_is_never_more_than_the_round_one_and_has_its_gaps() {
    let operator = Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 };
    for tip in [Tip::Bristles(Bristles::default()), Tip::Noise(Noise::default())] {
        let brush = Brush { size: 60.0, hardness: 0.8, tip, ..Brush::default() };
        let round = alpha(&dab(&Brush { tip: Tip::Round, ..brush.clone() }, operator, &ball()));
        let textured = alpha(&dab(&brush, operator, &ball()));
        assert!(textured.iter().zip(&round).all(|(t, r)| t <= r));
        let full = round.iter().filter(|a| **a > 250).count();
        let gaps = round.iter().zip(&textured).filter(|(r, t)| **r > 250 && **t < 60).count();
        let marks = textured.iter().filter(|a| **a > 150).count();
        assert!(gaps > full / 12 && marks > full / 12, "{gaps} gaps and {marks} marks of {full}");
    }
}

#[test]
fn grain_multiplies_each_dab() {
    let operator = Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 };
    let scene = ball();
    let source = GrainSource::Pattern { pattern: Pattern::Weave, seed: 1 };
    for lies in [GrainSpace::Canvas, GrainSpace::Surface { gamma: 1.2 }] {
        let grain = BrushGrain {
            source: source.clone(),
            size_px: 12.0,
            strength: 0.8,
            lies,
            ..BrushGrain::default()
        };
        for tip in [Tip::Round, Tip::Ellipse { ratio: 0.5 }, Tip::Bristles(Bristles::default())] {
            let plain = Brush { size: 70.0, tip, ..Brush::default() };
            let grained = Brush { grain: Some(grain.clone()), ..plain.clone() };
            let (without, with) = (dab(&plain, operator, &scene), dab(&grained, operator, &scene));
            let laid = StrokeGrain::new(&grain, AT);
            let tiles: Vec<_> =
                TileAt::covering(SIZE.rect()).map(|at| (at, laid.tile(&scene, at))).collect();
            for (x, y) in pixels() {
                let (_, tile) = tiles.iter().find(|(at, _)| at.rect().contains(x, y)).unwrap();
                let i = y as usize % TILE * TILE + x as usize % TILE;
                let factor = tile.dark[i] + (tile.light[i] - tile.dark[i]) * tile.share[i];
                let (a, b) = (f32::from(without.pixel(x, y)[3]), f32::from(with.pixel(x, y)[3]));
                assert!((a * factor - b).abs() <= 1.5, "({x}, {y}): {b} of {a} times {factor}");
            }
        }
    }
}

fn picture(side: u32, texel: [u8; 4]) -> PictureSource {
    let texels = vec![texel; (side * side) as usize];
    PictureSource::new(
        "p.png".into(),
        Picture::srgb8(Size::new(side, side), texels).unwrap(),
        Adjust::default(),
    )
}

#[test]
fn a_hose_stamps_its_pictures_in_turn_in_their_own_colors_and_sizes() {
    let pictures = vec![picture(32, [255, 0, 0, 255]), picture(16, [0, 0, 255, 255])];
    let hose = Hose::new(pictures, vec![HoseRank { count: 2, select: RankSelect::Incremental }]);
    let brush = Brush { size: 20.0, spacing: 1.5, tip: Tip::Hose(hose), ..Brush::default() };
    let samples = vec![Sample::at(vec2(20.0, 60.0)), Sample::at(vec2(115.0, 60.0))];
    let grid = paint(brush, Operator::None, samples, &flat());
    let (red, blue) = ([255, 0, 0, 255], [0, 0, 255, 255]);
    assert_eq!([20, 50, 80, 110].map(|x| grid.pixel(x, 60)), [red, blue, red, blue]);
    assert_eq!(grid.pixel(28, 60), red, "the first is 20 px wide");
    assert_eq!(grid.pixel(57, 60)[3], 0, "the second half as wide");
    let none = Hose::new(Vec::new(), Vec::new());
    let empty = dab(&Brush { tip: Tip::Hose(none), ..Brush::default() }, Operator::None, &flat());
    assert!(empty.iter().next().is_none());
}

#[test]
fn a_softness_that_follows_the_pen_blurs_every_tip_without_popping() {
    let tips = [
        Tip::Round,
        Tip::Square { ratio: 0.5 },
        Tip::Bristles(Bristles { count: 20, seed: 1 }),
        Tip::Picture(picture(32, [255; 4])),
    ];
    for tip in tips {
        let dynamics =
            Dynamics::none().with(Property::Softness, Input::Pressure, Curve::Share(1.0));
        let brush =
            Brush { size: 50.0, hardness: 0.9, softness: 1.0, tip, dynamics, ..Brush::default() };
        let at = |pressure: f32| {
            alpha(&paint(
                brush.clone(),
                Operator::None,
                vec![Sample { pressure, ..Sample::at(AT) }],
                &flat(),
            ))
        };
        let steps: Vec<Vec<u8>> = (0..=60).map(|i| at(0.002 + i as f32 * 0.016)).collect();
        for (i, pair) in steps.windows(2).enumerate() {
            let jump = pair[0].iter().zip(&pair[1]).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
            assert!(jump < 40, "step {i}: {jump}");
        }
        let spread = |alpha: &[u8]| alpha.iter().filter(|a| **a > 2).count();
        assert!(spread(&steps[60]) > spread(&steps[0]) + 300);
    }
}

#[test]
fn hostile_tips_paint_something_or_nothing_and_never_fail() {
    let nan = f32::NAN;
    let tips = [
        Tip::Ellipse { ratio: nan },
        Tip::Square { ratio: 0.0 },
        Tip::Bristles(Bristles { count: 0, seed: 0 }),
        Tip::Noise(Noise { cells: 0, density: nan, seed: u32::MAX }),
    ];
    for tip in tips {
        let grain = BrushGrain {
            size_px: nan,
            levels: [nan, nan],
            lies: GrainSpace::Surface { gamma: nan },
            ..BrushGrain::default()
        };
        let brush = Brush {
            size: 40.0,
            rotation: nan,
            softness: nan,
            tip,
            grain: Some(grain),
            ..Brush::default()
        };
        dab(&brush, Operator::Depth { gamma: nan }, &ball());
    }
}
