//! The sRGB transfer curve (IEC 61966-2-1), colors as text, and the one quantization to bytes.
//! Floor 0.

#![warn(missing_docs)]

use std::sync::LazyLock;

/// Linear light of an sRGB-encoded value. Odd extension below 0; 1 maps to 1 and larger values stay
/// larger.
pub fn decode(encoded: f32) -> f32 {
    let v = encoded.abs();
    let lin = if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
    lin.copysign(encoded)
}

/// sRGB-encoded value of linear light; the inverse of [`decode`].
pub fn encode(linear: f32) -> f32 {
    let v = linear.abs();
    let enc = if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    enc.copysign(linear)
}

/// [`decode`] for `[0, 1]` in a few multiplications: relative error below 4e-4.
#[inline(always)]
pub fn decode_fast(v: f32) -> f32 {
    let power = 8.832_52e-4
        + v * (0.033_923_87
            + v * (0.507_539_6 + v * (0.710_421_1 + v * (-0.369_025_63 + v * 0.116_626_06))));
    if v <= 0.04045 { v * (1.0 / 12.92) } else { power }
}

/// Luminance in linear light of an encoded color in `[0, 1]`: error below 3e-4 + 0.4 % of it, for
/// weighing light rather than for showing it.
#[inline(always)]
pub fn luminance_fast(r: f32, g: f32, b: f32) -> f32 {
    // Through 0 and without the foot: close enough, and one expression for all values.
    let decode =
        |v: f32| v * (0.051_504_187 + v * (0.436_915_07 + v * (0.752_211_9 - v * 0.244_300_74)));
    luminance(decode(r), decode(g), decode(b))
}

/// [`encode`] for `[0, 1]` by a square root: error below 0.05/255.
#[inline(always)]
pub fn encode_fast(linear: f32) -> f32 {
    // In the root the curve is nearly straight. Pairs of terms, so that no step waits for all
    // before it.
    let root = linear.sqrt();
    let squared = root * root;
    let low = (-0.042_232_01 + root * 1.575_272) + squared * (-1.899_483 + root * 3.898_457_3);
    let high = (-5.003_188 + root * 3.418_699) + squared * -0.947_674_1;
    let power = low + (squared * squared) * high;
    if linear <= 0.003_130_8 { linear * 12.92 } else { power }
}

/// `encode(factor · decode(v))` without leaving the encoded value, for `v` in `[0, 1]`: error below
/// 0.25/255.
///
/// Above the linear foot the curve is a power, so a factor of the light is a factor of v + 0.055:
/// its 5/12th power. The rest is for values that lie on the foot or cross its end.
///
/// * `root`: factor^(5/12), handed in because the three channels share it.
#[inline(always)]
pub fn scale_encoded(v: f32, factor: f32, root: f32) -> f32 {
    const FOOT: f32 = 0.04045;
    // The foot's value on the power curve, 1.055 (v / 12.92)^(5/12), where a bright factor can lift
    // it above the foot.
    let lifted = v.sqrt();
    let lifted = 0.004_918_89 + lifted * (0.517_012_9 - lifted * 0.336_299);
    let on_power = (if v <= FOOT { lifted } else { v + 0.055 }) * root;
    // And back down: 12.92 (w / 1.055)^2.4.
    let lowered = on_power * (-0.018_413_93 + on_power * (2.904_785 + on_power * 18.169_653));
    let above = if on_power <= FOOT + 0.055 { lowered } else { on_power - 0.055 };
    let straight = v * factor;
    if v <= FOOT && straight <= FOOT { straight } else { above }
}

/// [`scale_encoded`] for factors between e⁻² and e², in fewer steps and without a root: error below
/// 0.1/255.
///
/// The curve's power, and its inverse, are a straight line plus their deviation from it on the
/// foot.
#[inline(always)]
pub fn scale_encoded_gently(v: f32, factor: f32, root: f32) -> f32 {
    const FOOT: f32 = 0.04045;
    const FOOT_ON_POWER: f32 = FOOT + 0.055;
    let below = super::fast::min(v - FOOT, 0.0);
    let bend =
        (-0.090_288_29 - 23.222_44 * below) + (below * below) * (-935.455_8 - 22_506.5 * below);
    let on_power = (v + 0.055 + below * bend) * root;
    let below = super::fast::min(on_power - FOOT_ON_POWER, 0.0);
    let above = on_power - 0.055 + below * (0.001_357_515_7 + below * 6.569_081);
    // Values that stay on the foot are scaled directly.
    let straight = v * factor;
    if super::fast::max(v, straight) <= FOOT { straight } else { above }
}

static DECODE: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| decode(i as f32 / 255.0)));

/// Linear light of an sRGB byte.
#[inline(always)]
pub fn decode_u8(encoded: u8) -> f32 {
    DECODE[encoded as usize]
}

/// Nearest byte of a value in `[0, 1]`; out of range clamps, NaN becomes 0. The only quantization
/// to bytes.
#[inline(always)]
pub fn quantize(value: f32) -> u8 {
    // `max` first: for NaN and 0 it is 0.
    let scaled = super::fast::min(super::fast::max(value, 0.0), 1.0) * 255.0 + 0.5;
    // SAFETY: in [0.5, 255.5] by the line above.
    unsafe { super::simd::truncate(scaled) as u8 }
}

/// The same to 16 bits.
#[inline(always)]
pub fn quantize16(value: f32) -> u16 {
    let scaled = super::fast::min(super::fast::max(value, 0.0), 1.0) * 65535.0 + 0.5;
    // SAFETY: in [0.5, 65535.5] by the line above: at this size a float still holds halves.
    unsafe { super::simd::truncate(scaled) as u16 }
}

/// Rec. 709 luminance of a linear color.
#[inline(always)]
pub fn luminance(r: f32, g: f32, b: f32) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// A color as artists write it: straight alpha, sRGB-encoded bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Color {
    /// Red.
    pub r: u8,
    /// Green.
    pub g: u8,
    /// Blue.
    pub b: u8,
    /// Alpha: 255 is opaque.
    pub a: u8,
}

impl Color {
    /// Opaque black.
    pub const BLACK: Color = Color { r: 0, g: 0, b: 0, a: 255 };
    /// Opaque white.
    pub const WHITE: Color = Color { r: 255, g: 255, b: 255, a: 255 };
    /// Fully transparent.
    pub const TRANSPARENT: Color = Color { r: 0, g: 0, b: 0, a: 0 };

    /// An opaque color of sRGB-encoded bytes.
    pub const fn rgb(r: u8, g: u8, b: u8) -> Self {
        Self { r, g, b, a: 255 }
    }

    /// Reads `#rrggbb` or `#rrggbbaa`.
    pub fn parse(text: &str) -> Option<Color> {
        let hex = text.strip_prefix('#')?;
        if !hex.bytes().all(|b| b.is_ascii_hexdigit()) {
            return None;
        }
        let byte = |i: usize| u8::from_str_radix(hex.get(i..i + 2)?, 16).ok();
        match hex.len() {
            6 => Some(Color { r: byte(0)?, g: byte(2)?, b: byte(4)?, a: 255 }),
            8 => Some(Color { r: byte(0)?, g: byte(2)?, b: byte(4)?, a: byte(6)? }),
            _ => None,
        }
    }

    /// Straight alpha, encoded, each in `[0, 1]`.
    pub fn to_f32(self) -> [f32; 4] {
        [self.r, self.g, self.b, self.a].map(|v| f32::from(v) / 255.0)
    }

    /// Premultiplied, encoded, each in `[0, 1]`.
    pub fn premultiplied(self) -> [f32; 4] {
        let [r, g, b, a] = self.to_f32();
        [r * a, g * a, b * a, a]
    }

    /// Linear light, straight, alpha dropped.
    pub fn linear(self) -> [f32; 3] {
        [self.r, self.g, self.b].map(decode_u8)
    }
}

impl std::fmt::Display for Color {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.r, self.g, self.b)?;
        if self.a != 255 {
            write!(f, "{:02x}", self.a)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_decode_and_encode() {
        for b in 0..=255u8 {
            assert_eq!(quantize(encode(decode_u8(b))), b);
        }
    }

    #[test]
    fn the_fast_curves_stay_within_a_quarter_byte() {
        for i in 0..=100_000 {
            let v = i as f32 / 100_000.0;
            assert!((decode_fast(v) - decode(v)).abs() <= 4e-4 * decode(v), "{v}");
            assert!((encode_fast(v) - encode(v)).abs() < 0.05 / 255.0, "{v}");
        }
    }

    #[test]
    fn the_fast_luminance_is_close_enough_to_weigh_light() {
        for i in 0..=1000 {
            let v = i as f32 / 1000.0;
            let exact = luminance(decode(v), decode(v * v), decode(1.0 - v));
            assert!((luminance_fast(v, v * v, 1.0 - v) - exact).abs() < 3e-4 + 4e-3 * exact, "{v}");
        }
    }

    #[test]
    fn scaling_an_encoded_value_is_scaling_its_light() {
        for factor in [0.05f32, 0.3, 0.7, 1.0, 1.3, 2.7, 7.0, 20.0] {
            for i in 0..=10_000 {
                let v = i as f32 / 10_000.0;
                let light = encode(factor * decode(v));
                let found = scale_encoded(v, factor, factor.powf(5.0 / 12.0));
                let error = (found - light).abs().min((found.min(1.0) - light.min(1.0)).abs());
                assert!(error < 0.25 / 255.0, "{v} × {factor}: {found}, not {light}");
            }
        }
        for i in 0..=40 {
            let factor = (i as f32 * 0.1 - 2.0).exp();
            for i in 0..=10_000 {
                let v = i as f32 / 10_000.0;
                let light = encode(factor * decode(v)).min(1.0);
                let found = scale_encoded_gently(v, factor, factor.powf(5.0 / 12.0)).min(1.0);
                assert!(
                    (found - light).abs() < 0.1 / 255.0,
                    "{v} × {factor}: {found}, not {light}"
                );
            }
        }
    }

    #[test]
    fn quantizing_nan_gives_black_not_garbage() {
        assert_eq!(quantize(f32::NAN), 0);
        assert_eq!(quantize(7.0), 255);
    }

    #[test]
    fn values_of_16_bits_are_their_own() {
        assert!((0..=u16::MAX).all(|v| quantize16(f32::from(v) / 65535.0) == v));
        assert_eq!([f32::NAN, -1.0, 7.0].map(quantize16), [0, 0, 65535]);
    }

    #[test]
    fn colors_read_back_as_written() {
        for text in ["#c08060", "#01020304"] {
            assert_eq!(Color::parse(text).unwrap().to_string(), text);
        }
        assert_eq!(Color::parse("#12345"), None);
        assert_eq!(Color::parse("#ééé"), None);
    }
}
