//! Adjustments of a placed picture, which convey material: blur for gloss, colour for the base.
//! Floor 3.

/// Applied in this order: blur, exposure (linear light), then hue, saturation, brightness, contrast (encoded values).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adjust {
    /// Standard deviation of a Gaussian, in texels of the picture, `≥ 0`.
    pub blur: f32,
    /// Stops: linear light is multiplied by 2^exposure.
    pub exposure: f32,
    /// Rotation of the hue, degrees.
    pub hue: f32,
    /// Factor of the distance from grey, `≥ 0`; 1 leaves it.
    pub saturation: f32,
    /// Factor of the encoded value, `≥ 0`; 1 leaves it.
    pub brightness: f32,
    /// Factor of the distance from mid grey (0.5), `≥ 0`; 1 leaves it.
    pub contrast: f32,
}

impl Default for Adjust {
    fn default() -> Self {
        Self { blur: 0.0, exposure: 0.0, hue: 0.0, saturation: 1.0, brightness: 1.0, contrast: 1.0 }
    }
}
