//! Hue, saturation and lightness of encoded colors, and luminosity as blend modes use it.
//! Floor 3.

/// Luminosity of an encoded color (W3C Compositing and Blending, `Lum`).
#[inline(always)]
pub fn luminosity([r, g, b]: [f32; 3]) -> f32 {
    0.3 * r + 0.59 * g + 0.11 * b
}

/// The least and the greatest channel.
#[inline(always)]
pub fn extent([r, g, b]: [f32; 3]) -> (f32, f32) {
    (r.min(g).min(b), r.max(g).max(b))
}

/// The hue in sixths of a turn, `[0, 6)`; 0 for grays.
#[inline(always)]
pub fn hue(rgb: [f32; 3]) -> f32 {
    let [r, g, b] = rgb;
    let (low, high) = extent(rgb);
    let chroma = high - low;
    if chroma <= 1e-6 {
        return 0.0;
    }
    let sixth = if high == r {
        (g - b) / chroma
    } else if high == g {
        2.0 + (b - r) / chroma
    } else {
        4.0 + (r - g) / chroma
    };
    if sixth < 0.0 { sixth + 6.0 } else { sixth }
}

/// Hue in sixths of a turn, saturation and lightness of the double cone.
#[inline(always)]
pub fn of_rgb(rgb: [f32; 3]) -> [f32; 3] {
    let (low, high) = extent(rgb);
    let lightness = 0.5 * (low + high);
    let room = 1.0 - (2.0 * lightness - 1.0).abs();
    let saturation = if room > 1e-6 { (high - low) / room } else { 0.0 };
    [hue(rgb), saturation, lightness]
}

/// The color of a hue, saturation and lightness; the hue in sixths of a turn, of any size.
#[inline(always)]
pub fn to_rgb([hue, saturation, lightness]: [f32; 3]) -> [f32; 3] {
    let chroma = (1.0 - (2.0 * lightness - 1.0).abs()) * saturation;
    // Each channel is a trapezoid of the hue, a third of a turn apart.
    [0.0, 4.0, 2.0].map(|turn| {
        let at = (hue + turn).rem_euclid(6.0);
        let share = ((at - 3.0).abs() - 1.0).max(0.0).min(1.0);
        lightness + chroma * (share - 0.5)
    })
}

/// A color given a luminosity, drawn toward gray where it would leave `[0, 1]` (`SetLum`).
#[inline(always)]
pub fn with_luminosity(rgb: [f32; 3], to: f32) -> [f32; 3] {
    let by = to - luminosity(rgb);
    let moved = rgb.map(|v| v + by);
    let (low, high) = extent(moved);
    let mut shrink = 1.0;
    if low < 0.0 {
        shrink = to / (to - low).max(1e-6);
    }
    if high > 1.0 {
        shrink = f32::min(shrink, (1.0 - to) / (high - to).max(1e-6));
    }
    moved.map(|v| to + (v - to) * shrink)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_come_back_from_hue_saturation_and_lightness() {
        for i in 0..512 {
            let rgb = [i % 8, i / 8 % 8, i / 64].map(|v| v as f32 / 7.0);
            let back = to_rgb(of_rgb(rgb));
            assert!((0..3).all(|c| (back[c] - rgb[c]).abs() < 1e-5), "{rgb:?} {back:?}");
        }
    }

    #[test]
    fn a_luminosity_is_reached_within_the_cube() {
        for i in 0..512 {
            let rgb = [i % 8, i / 8 % 8, i / 64].map(|v| v as f32 / 7.0);
            for to in [0.0, 0.2, 0.77, 1.0] {
                let set = with_luminosity(rgb, to);
                assert!((luminosity(set) - to).abs() < 1e-4, "{rgb:?} {to} {set:?}");
                assert!(set.iter().all(|v| (-1e-5..=1.00001).contains(v)), "{set:?}");
            }
        }
    }
}
