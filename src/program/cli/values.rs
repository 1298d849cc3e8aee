//! Values that several commands take: factors, bits and colors.
//! Floor 7.

use crate::math::srgb::Color;

pub fn bits(text: &str) -> std::result::Result<u8, String> {
    let bits = text.parse().ok().filter(|bits| [8, 16].contains(bits));
    bits.ok_or_else(|| "a channel has 8 or 16 bits".to_owned())
}

/// Bits of a picture; its format says which it may have.
pub fn depth(text: &str) -> std::result::Result<u8, String> {
    let bits = text.parse().ok().filter(|bits| [8, 16, 32].contains(bits));
    bits.ok_or_else(|| "a channel has 8, 16 or 32 bits".to_owned())
}

pub fn scale(text: &str) -> std::result::Result<f32, String> {
    let factor = text.parse().ok().filter(|f| (0.001..=100.0).contains(f));
    factor.ok_or_else(|| "a factor is a number between 0.001 and 100".to_owned())
}

pub fn color(text: &str) -> std::result::Result<Color, String> {
    Color::parse(text).ok_or_else(|| "a color is written #rrggbb or #rrggbbaa".to_owned())
}

pub fn share(text: &str) -> std::result::Result<f32, String> {
    let share = text.parse().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "a share is a number between 0 and 1".to_owned())
}
