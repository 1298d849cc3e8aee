//! The color of one dab: the stroke's, turned round the wheel and jittered (HSV of the encoded
//! values). Floor 3.

use super::brush::Brush;
use super::dynamics::{DabInputs, Dynamics, Property};
use crate::math::{
    hash, hsv,
    srgb::{Color, quantize},
};

/// Whether dabs of this brush differ in color.
pub fn has_varied_color(brush: &Brush) -> bool {
    let jitter = brush.jitter;
    let jitters = [jitter.hue_degrees, jitter.saturation, jitter.value].iter().any(|&v| v > 0.0);
    let driven = [Property::Hue, Property::Saturation, Property::Value, Property::Lightness];
    jitters || driven.iter().any(|&property| brush.dynamics.is_driven(property))
}

/// The color of a dab; alpha stays the stroke's.
pub fn of(brush: &Brush, color: Color, inputs: &DabInputs) -> Color {
    let unit = |v: f32| v.max(0.0).min(1.0);
    let either_way = |channel: u32| 2.0 * hash::unit(inputs.seed, channel, 2) - 1.0;
    let (jitter, dynamics) = (brush.jitter, &brush.dynamics);
    let [h, s, v] = hsv_of(color);
    let turns = dynamics.turns(Property::Hue, inputs)
        + unit(jitter.hue_degrees / 180.0) * 0.5 * either_way(0);
    let s =
        dynamics.value(Property::Saturation, s, inputs) + unit(jitter.saturation) * either_way(1);
    let v = dynamics.value(Property::Value, v, inputs) + unit(jitter.value) * either_way(2);
    let [h, s, v] = [h + turns, unit(s), unit(v)];
    let lit = if dynamics.is_driven(Property::Lightness) {
        vary_lightness([h, s, v], dynamics, inputs)
    } else {
        [h, s, v]
    };
    let [r, g, b] = hsv::to_rgb(lit).map(quantize);
    Color { r, g, b, ..color }
}

/// The same color at the driven lightness (HSL), with the same HSL saturation.
fn vary_lightness([h, s, v]: [f32; 3], dynamics: &Dynamics, inputs: &DabInputs) -> [f32; 3] {
    let share = |part: f32, whole: f32| if whole > 0.0 { part / whole } else { 0.0 };
    let lightness = v * (1.0 - 0.5 * s);
    let saturation = share(v - lightness, lightness.min(1.0 - lightness));
    let to = dynamics.value(Property::Lightness, lightness, inputs).max(0.0).min(1.0);
    let value = to + saturation * to.min(1.0 - to);
    [h, share(2.0 * (value - to), value).min(1.0), value.min(1.0)]
}

/// Hue in turns, saturation, value: each in `[0, 1]`.
fn hsv_of(color: Color) -> [f32; 3] {
    let [r, g, b, _] = color.to_f32();
    hsv::from_rgb([r, g, b])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use crate::paint::{ColorJitter, Curve, Dynamics, Input};

    #[test]
    fn a_third_of_a_turn_makes_red_green() {
        let third = Curve::through(vec![crate::math::vec2(0.0, 1.0 / 3.0)]).unwrap();
        let brush = Brush {
            dynamics: Dynamics::none().with(Property::Hue, Input::Pressure, third),
            ..Brush::default()
        };
        let red = Color::parse("#ff000080").unwrap();
        assert_eq!(of(&brush, red, &DabInputs::default()).to_string(), "#00ff0080");
    }

    #[test]
    fn jitter_stays_within_its_bounds_and_reaches_far_into_them() {
        let brush = Brush {
            jitter: ColorJitter { hue_degrees: 36.0, saturation: 0.2, value: 0.1 },
            ..Brush::default()
        };
        let color = Color::parse("#804040").unwrap();
        let all: Vec<[f32; 3]> = (0..500)
            .map(|seed| hsv_of(of(&brush, color, &DabInputs { seed, ..DabInputs::default() })))
            .collect();
        for (c, (middle, reach)) in [(0.0, 0.1), (0.5, 0.2), (0.502, 0.1)].into_iter().enumerate() {
            let from_middle =
                |v: &[f32; 3]| if c == 0 { (v[0] + 0.5) % 1.0 - 0.5 } else { v[c] - middle };
            let farthest = all.iter().map(|v| from_middle(v).abs()).fold(0.0, f32::max);
            assert!(
                farthest > 0.9 * reach && farthest < 1.05 * reach + 0.01,
                "channel {c}: {farthest}"
            );
        }
    }

    #[test]
    fn lightness_goes_to_white_and_black_by_way_of_the_color() {
        let lit = |by: f32| {
            let added = Curve::additive(vec![vec2(0.0, by)]).unwrap();
            let dynamics = Dynamics::none().with(Property::Lightness, Input::Pressure, added);
            of(
                &Brush { dynamics, ..Brush::default() },
                Color::parse("#ff0000").unwrap(),
                &DabInputs::default(),
            )
            .to_string()
        };
        assert_eq!([0.5, 0.25, -0.25, -0.5].map(lit), ["#ffffff", "#ff8080", "#800000", "#000000"]);
        let gray = Curve::additive(vec![vec2(0.0, 0.2)]).unwrap();
        let dynamics = Dynamics::none().with(Property::Lightness, Input::Pressure, gray);
        let lit = of(&Brush { dynamics, ..Brush::default() }, Color::BLACK, &DabInputs::default());
        assert_eq!(lit.to_string(), "#333333");
    }
}
