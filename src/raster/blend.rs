//! Blend modes: how a layer's colour meets the colour beneath it (W3C Compositing and Blending Level 1).
//! Floor 1. One row of [`BlendMode::ALL`] and one golden a mode.

/// A blend mode; all but `Plus` are W3C's `B(cb, cs)` mixed source-over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum BlendMode {
    #[default]
    Normal,
    Multiply,
    Screen,
    Overlay,
    Darken,
    Lighten,
    ColorDodge,
    ColorBurn,
    HardLight,
    SoftLight,
    Difference,
    Exclusion,
    Hue,
    Saturation,
    Color,
    Luminosity,
    /// Sums the premultiplied values, clamped at 1.
    Plus,
}

impl BlendMode {
    /// Every mode with its name in documents.
    pub const ALL: [(BlendMode, &'static str); 17] = [
        (BlendMode::Normal, "normal"),
        (BlendMode::Multiply, "multiply"),
        (BlendMode::Screen, "screen"),
        (BlendMode::Overlay, "overlay"),
        (BlendMode::Darken, "darken"),
        (BlendMode::Lighten, "lighten"),
        (BlendMode::ColorDodge, "color-dodge"),
        (BlendMode::ColorBurn, "color-burn"),
        (BlendMode::HardLight, "hard-light"),
        (BlendMode::SoftLight, "soft-light"),
        (BlendMode::Difference, "difference"),
        (BlendMode::Exclusion, "exclusion"),
        (BlendMode::Hue, "hue"),
        (BlendMode::Saturation, "saturation"),
        (BlendMode::Color, "color"),
        (BlendMode::Luminosity, "luminosity"),
        (BlendMode::Plus, "plus"),
    ];
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(mode, _)| *mode == self).map_or("normal", |(_, name)| name)
    }
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, n)| *n == name).map(|(mode, _)| *mode)
    }
}
