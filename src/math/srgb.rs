//! The sRGB transfer curve (IEC 61966-2-1), colours as text, and the one quantisation to bytes.
//! Floor 0.

use std::sync::LazyLock;

/// Linear light of an sRGB-encoded value. Odd extension below 0; 1 maps to 1 and larger values stay larger.
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

static DECODE: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|i| decode(i as f32 / 255.0)));

/// Linear light of an sRGB byte.
pub fn decode_u8(encoded: u8) -> f32 {
    DECODE[encoded as usize]
}

/// Nearest byte of a value in `[0, 1]`; out of range clamps, NaN becomes 0. The only quantisation in the program.
#[inline(always)]
pub fn quantise(value: f32) -> u8 {
    // `max` first: NaN.max(0) is 0.
    (value.max(0.0).min(1.0) * 255.0 + 0.5) as u8
}

/// Rec. 709 luminance of a linear colour.
#[inline(always)]
pub fn luminance(r: f32, g: f32, b: f32) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// A colour as artists write it: straight alpha, sRGB-encoded bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Color {
    pub r: u8,
    pub g: u8,
    pub b: u8,
    pub a: u8,
}

impl Color {
    pub const BLACK: Color = Color { r: 0, g: 0, b: 0, a: 255 };
    pub const WHITE: Color = Color { r: 255, g: 255, b: 255, a: 255 };
    pub const TRANSPARENT: Color = Color { r: 0, g: 0, b: 0, a: 0 };

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
            assert_eq!(quantise(encode(decode_u8(b))), b);
        }
    }
    #[test]
    fn quantising_nan_gives_black_not_garbage() {
        assert_eq!(quantise(f32::NAN), 0);
        assert_eq!(quantise(7.0), 255);
    }
    #[test]
    fn colours_read_back_as_written() {
        for text in ["#c08060", "#01020304"] {
            assert_eq!(Color::parse(text).unwrap().to_string(), text);
        }
        assert_eq!(Color::parse("#12345"), None);
        assert_eq!(Color::parse("#ééé"), None);
    }
}
