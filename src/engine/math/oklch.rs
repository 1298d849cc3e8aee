//! OKLab by lightness, chroma and hue, and where sRGB ends in it. Floor 0.

use super::{oklab, srgb};
use std::f32::consts::TAU;

/// The greatest chroma of sRGB, a magenta's, with some room: sliders end here.
pub const MOST_CHROMA: f32 = 0.33;
/// What rounding to a byte hides, of the encoded value.
const HALF: f32 = 0.5 / 255.0;
/// Halvings of an interval of chroma: far below what a byte resolves.
const STEPS: usize = 16;

/// Lightness in `[0, 1]`, chroma from 0, hue in turns of an encoded color. A gray has hue 0.
pub fn from_srgb(rgb: [f32; 3]) -> [f32; 3] {
    /// The chroma that rounding leaves to a gray.
    const GRAY: f32 = 1e-4;
    let [lightness, a, b] = oklab::from_linear(rgb.map(srgb::decode));
    let chroma = a.hypot(b);
    if chroma < GRAY {
        return [lightness, 0.0, 0.0];
    }
    [lightness, chroma, (b.atan2(a) / TAU).rem_euclid(1.0)]
}

/// The inverse; outside `[0, 1]` where sRGB lacks the color.
pub fn to_srgb([lightness, chroma, hue]: [f32; 3]) -> [f32; 3] {
    let (sin, cos) = (hue * TAU).sin_cos();
    oklab::to_linear([lightness, chroma * cos, chroma * sin]).map(srgb::encode)
}

/// Whether sRGB has the color.
pub fn is_in_srgb(lch: [f32; 3]) -> bool {
    to_srgb(lch).iter().all(|v| (-HALF..=1.0 + HALF).contains(v))
}

/// The color itself if sRGB has it, else the one of the same lightness and hue with the most chroma
/// that sRGB has.
pub fn clip_chroma(lch: [f32; 3]) -> [f32; 3] {
    let [lightness, chroma, hue] = lch;
    if is_in_srgb(lch) {
        return lch;
    }
    let (mut low, mut high) = (0.0, chroma);
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if is_in_srgb([lightness, middle, hue]) { low = middle } else { high = middle }
    }
    [lightness, low, hue]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_color_survives_lightness_chroma_and_hue() {
        for r in (0..=255).step_by(17) {
            for g in (0..=255).step_by(17) {
                for b in (0..=255).step_by(17) {
                    let rgb = [r, g, b].map(|v| v as f32 / 255.0);
                    let lch = from_srgb(rgb);
                    assert!(lch[1] < MOST_CHROMA && is_in_srgb(lch), "{rgb:?} {lch:?}");
                    assert_eq!(to_srgb(lch).map(srgb::quantize), [r as u8, g as u8, b as u8]);
                }
            }
        }
    }

    #[test]
    fn what_srgb_lacks_keeps_lightness_and_hue_and_lies_on_its_edge() {
        for hue in [0.0, 0.2, 0.45, 0.8] {
            for lightness in [0.2, 0.5, 0.9] {
                let clipped = clip_chroma([lightness, MOST_CHROMA, hue]);
                assert_eq!((clipped[0], clipped[2]), (lightness, hue));
                assert!(is_in_srgb(clipped), "{clipped:?}");
                assert!(!is_in_srgb([lightness, clipped[1] + 0.002, hue]), "{clipped:?}");
            }
        }
        assert_eq!(clip_chroma([0.6, 0.05, 0.3]), [0.6, 0.05, 0.3], "sRGB has it");
        assert_eq!(clip_chroma([2.0, 0.1, 0.3])[1], 0.0, "brighter than white");
    }
}
