//! Hue, saturation and value of encoded colors, as painters' sliders show them.
//! Floor 0.

/// Hue in turns, saturation, value, each in `[0, 1]`, of a color whose channels are. A gray has
/// hue 0.
pub fn from_rgb([r, g, b]: [f32; 3]) -> [f32; 3] {
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let range = most - least;
    if range <= 0.0 {
        return [0.0, 0.0, most];
    }
    let sixths = if most == r {
        (g - b) / range
    } else if most == g {
        2.0 + (b - r) / range
    } else {
        4.0 + (r - g) / range
    };
    [(sixths / 6.0).rem_euclid(1.0), range / most, most]
}

/// The inverse; the hue may be any number of turns.
pub fn to_rgb([hue, saturation, value]: [f32; 3]) -> [f32; 3] {
    // Distance from each primary, in sixths of a turn.
    [5.0, 3.0, 1.0].map(|primary| {
        let k = (primary + 6.0 * hue).rem_euclid(6.0);
        value * (1.0 - saturation * k.min(4.0 - k).max(0.0).min(1.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::srgb::{Color, quantize};

    #[test]
    fn every_color_survives_hue_saturation_and_value() {
        for r in (0..=255).step_by(15) {
            for g in (0..=255).step_by(15) {
                for b in (0..=255).step_by(15) {
                    let color = Color::rgb(r as u8, g as u8, b as u8);
                    let [x, y, z, _] = color.to_f32();
                    let [r, g, b] = to_rgb(from_rgb([x, y, z])).map(quantize);
                    assert_eq!(Color::rgb(r, g, b), color);
                }
            }
        }
    }

    #[test]
    fn a_hue_is_a_share_of_a_turn_from_red() {
        assert_eq!(from_rgb([0.0, 0.5, 0.0]), [1.0 / 3.0, 1.0, 0.5]);
        assert_eq!(to_rgb([-1.0 / 3.0, 1.0, 1.0]), [0.0, 0.0, 1.0]);
        assert_eq!(from_rgb([0.25; 3]), [0.0, 0.0, 0.25]);
    }
}
