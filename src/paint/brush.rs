//! A brush: the footprint of one dab and how dabs follow each other.
//! Floor 3.

use super::image::PictureSource;

/// The settings of a brush. Lengths are canvas px, ratios plain numbers.
#[derive(Clone)]
pub struct Brush {
    /// Diameter of a dab, px, `> 0`.
    pub size: f32,
    /// Share of the radius that is fully covered, `[0, 1]`; beyond it coverage falls off to 0 at the rim.
    pub hardness: f32,
    /// Opacity of the whole stroke, `[0, 1]`.
    pub opacity: f32,
    /// Coverage that one dab adds, `[0, 1]`.
    pub flow: f32,
    /// Distance between dabs, a ratio of the diameter, `> 0`.
    pub spacing: f32,
    /// Counter-clockwise as seen, degrees.
    pub rotation: f32,
    /// Blur of the footprint, `[0, 1]`: a rougher, less glossy mark.
    pub softness: f32,
    pub tip: Tip,
}

/// What a dab looks like before it is bent.
#[derive(Clone)]
pub enum Tip {
    Round,
    /// A picture: an opaque grey one is coverage (white covers… see `stroke`), one with alpha a coloured stamp.
    Picture(PictureSource),
}

impl Default for Brush {
    fn default() -> Self {
        Self {
            size: 80.0,
            hardness: 0.5,
            opacity: 1.0,
            flow: 1.0,
            spacing: 0.1,
            rotation: 0.0,
            softness: 0.0,
            tip: Tip::Round,
        }
    }
}
