//! Dual brushes compared with the formulas of their modes over both strokes, pixel by pixel.

use super::*;
use crate::paint::dab_walker::DabWalker;
use crate::paint::{
    Curve, DualBrush, DualMode, DualSettings, Input, Offset, StrokeFrame, StylusFilter,
};

fn with_second(brush: Brush, settings: DualSettings) -> Brush {
    let dual = DualBrush { settings, ..DualBrush::default() };
    Brush { dual: Some(Arc::new(dual)), ..brush }
}

/// The stroke's coverage from both tips', as the words of the modes say.
fn by_formula(mode: DualMode, a: f32, b: f32) -> f32 {
    let both = match mode {
        DualMode::Multiply => a * b,
        DualMode::Darken => a.min(b),
        DualMode::Overlay if a <= 0.5 => 2.0 * a * b,
        DualMode::Overlay => 1.0 - 2.0 * (1.0 - a) * (1.0 - b),
        DualMode::ColorDodge if a == 0.0 => 0.0,
        DualMode::ColorDodge => a / (1.0 - b),
        DualMode::ColorBurn if a == 1.0 => 1.0,
        DualMode::ColorBurn => 1.0 - (1.0 - a) / b,
        DualMode::LinearDodge => a + b,
        DualMode::LinearBurn => a + b - 1.0,
        DualMode::HardMix => f32::from(u8::from(a + b > 1.0)),
        DualMode::SoftHardMix => 3.0 * a - 2.0 * (1.0 - b),
        DualMode::Subtract => a - b,
    };
    if a > 0.0 { both.max(0.0).min(1.0) } else { 0.0 }
}

#[test]
fn a_dual_brush_is_the_first_stroke_met_by_the_second_pixel_by_pixel() {
    let operators = [Operator::None, Operator::Normal { alpha: 0.4, beta: 1.0, detail: 0.0 }];
    let plain = Brush {
        size: 34.0,
        hardness: 0.3,
        flow: 0.35,
        spacing: 0.3,
        opacity: 0.8,
        dynamics: Dynamics::none(),
        ..Brush::default()
    };
    let samples = line(vec2(42.0, 50.0), vec2(104.0, 86.0));
    let cases = operators.into_iter().flat_map(|op| DualMode::ALL.map(|(mode, _)| (op, mode)));
    for (operator, mode) in cases {
        let settings = DualSettings {
            size: 0.4,
            hardness: 0.4,
            opacity: 0.9,
            flow: 0.8,
            spacing: 1.1,
            mode,
            ..DualSettings::DEFAULT
        };
        let brush = with_second(plain.clone(), settings);
        let (second, _) = brush.second().unwrap();
        let whole = Brush { opacity: 1.0, ..plain.clone() };
        let [first, second] = [whole, second]
            .map(|brush| reference(&white(brush, operator, samples.clone()), &ball()));
        let grid = one(white(brush, operator, samples.clone()), &ball());
        let mut changed = 0;
        for (x, y) in (0..150).flat_map(|x| (0..140).map(move |y| (x, y))) {
            let (a, b) = (first.at(x, y), 0.9 * second.at(x, y));
            // What a byte's rounding of both makes of it: some modes are steep.
            let near = |v: f32| [v - 1.0 / 255.0, v + 1.0 / 255.0].map(|v| v.max(0.0).min(1.0));
            let corners = near(a).map(|a| near(b).map(|b| 0.8 * by_formula(mode, a, b)));
            let corners = corners.as_flattened();
            let least = 255.0 * corners.iter().fold(1.0f32, |least, v| least.min(*v));
            let most = 255.0 * corners.iter().fold(0.0f32, |most, v| most.max(*v));
            let alpha = f32::from(grid.pixel(x as i32, y as i32)[3]);
            assert!(
                (least - 1.0..=most + 1.0).contains(&alpha),
                "{mode:?} {operator:?} ({x}, {y}): {alpha} of {a} and {b}"
            );
            changed += i32::from((alpha - 204.0 * a).abs() > 8.0);
        }
        assert!(changed > 300, "{mode:?}: {changed}");
    }
}

#[test]
fn a_second_tip_acts_on_the_whole_stroke_and_not_on_each_dab() {
    let settings = DualSettings { size: 4.0, hardness: 1.0, opacity: 0.5, ..DualSettings::DEFAULT };
    let brush = Brush { size: 30.0, hardness: 1.0, flow: 0.3, spacing: 0.02, ..Brush::default() };
    let samples = line(vec2(40.0, 64.0), vec2(100.0, 64.0));
    let alpha =
        |brush: Brush| one(white(brush, Operator::None, samples.clone()), &flat()).pixel(70, 64)[3];
    assert_eq!(alpha(brush.clone()), 255, "many dabs of a faint flow");
    let halved = alpha(with_second(brush, settings));
    assert!((127..=128).contains(&halved), "{halved}");
}

#[test]
fn where_the_first_tip_leaves_nothing_no_second_one_paints() {
    for (mode, _) in DualMode::ALL {
        let settings = DualSettings { size: 12.0, hardness: 1.0, mode, ..DualSettings::DEFAULT };
        let brush = with_second(Brush { size: 20.0, hardness: 1.0, ..Brush::default() }, settings);
        let stroke = white(brush, Operator::None, line(vec2(40.0, 64.0), vec2(100.0, 64.0)));
        let bounds = stroke.bounds(&flat());
        let grid = one(stroke, &flat());
        assert_eq!([grid.pixel(70, 50), grid.pixel(70, 80)], [[0; 4]; 2], "{mode:?}");
        assert!(bounds.height() <= 128, "only the tiles of the first tip: {bounds:?}");
    }
}

#[test]
fn colors_of_the_first_tip_stay_and_its_coverage_alone_changes() {
    let red = Color::parse("#ff0000").unwrap();
    let settings = DualSettings { size: 4.0, opacity: 0.5, hardness: 1.0, ..DualSettings::DEFAULT };
    let jitter = ColorJitter { hue_degrees: 180.0, ..ColorJitter::default() };
    let brush = Brush { size: 20.0, hardness: 1.0, spacing: 2.0, jitter, ..Brush::default() };
    let samples = line(vec2(10.0, 60.0), vec2(130.0, 60.0));
    let paint =
        |brush: Brush| one(Stroke::new(brush, Operator::None, red, samples.clone()), &flat());
    let (plain, dual) = (paint(brush.clone()), paint(with_second(brush, settings)));
    let mut halved = 0;
    for x in 0..150 {
        let (before, after) = (plain.pixel(x, 60), dual.pixel(x, 60));
        let is_half = (0..4).all(|c| (2 * i32::from(after[c]) - i32::from(before[c])).abs() <= 2);
        assert!(is_half, "{x}: {before:?} became {after:?}");
        halved += i32::from(before[3] == 255);
    }
    assert!(halved > 40, "{halved}");
}

#[test]
fn a_mirrored_stroke_has_the_mirror_image_of_both_tips() {
    let mut dual = DualBrush {
        settings: DualSettings {
            size: 0.5,
            spacing: 0.6,
            scatter: 0.7,
            mode: DualMode::Subtract,
            ..DualSettings::DEFAULT
        },
        tip: Tip::Square { ratio: 0.3 },
        ..DualBrush::default()
    };
    dual.dynamics = dual.dynamics.with(Property::Rotation, Input::Random, Curve::Share(1.0));
    let brush = Brush { size: 40.0, seed: 7, dual: Some(Arc::new(dual)), ..Brush::default() };
    assert!(brush.is_random());
    let samples = line(vec2(30.0, 40.0), vec2(70.0, 90.0));
    let mirrored = samples.iter().map(|s| Sample { at: vec2(150.0 - s.at.x, s.at.y), ..*s });
    let facing = StrokeFrame { turn: 0.0, is_mirrored: true };
    let here = one(white(brush.clone(), Operator::None, samples.clone()), &flat());
    let there = Brush { facing, ..brush };
    let there = one(white(there, Operator::None, mirrored.collect()), &flat());
    let mut painted = 0;
    for (x, y) in (0..150).flat_map(|x| (0..140).map(move |y| (x, y))) {
        let (a, b) = (here.pixel(x, y)[3], there.pixel(149 - x, y)[3]);
        assert!(a.abs_diff(b) <= 2, "({x}, {y}): {a} and {b}");
        painted += i32::from(a > 0);
    }
    assert!(painted > 300, "{painted}");
}

#[test]
fn both_tips_follow_one_hand() {
    let first = Brush {
        size: 24.0,
        spacing: 0.5,
        offset: Offset { amount: 0.5, turn_degrees: 90.0, ..Offset::default() },
        stylus: StylusFilter { tremor: 0.4, ..StylusFilter::default() },
        seed: 9,
        ..Brush::default()
    };
    // As large, and as dense, so that each dab of one lies on one of the other.
    let settings = DualSettings { spacing: 0.5, ..DualSettings::DEFAULT };
    let half = DualSettings { size: 0.5, spacing: 1.0, ..DualSettings::DEFAULT };
    let samples = line(vec2(30.0, 40.0), vec2(110.0, 90.0));
    let walker = DabWalker::new(&first, Operator::None, Color::BLACK, &flat());
    let places = |walker: DabWalker| -> Vec<Vec2> {
        dab_walker::all_dabs(walker, &samples).into_iter().map(|dab| dab.at).collect()
    };
    let of_first = places(walker.clone());
    for settings in [settings, half] {
        let (second, _) = with_second(first.clone(), settings).second().unwrap();
        let of_second = places(walker.beside(&second));
        assert_eq!(of_second.len(), of_first.len());
        let far = of_first.iter().zip(&of_second).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(far < 0.01, "{far} px");
    }
    assert!(of_first.len() > 5);
}
