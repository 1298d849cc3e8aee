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
    /// Blur of the footprint, `[0, 1]`: a rougher, less glossy mark. Its rim moves out by this share of the radius.
    pub softness: f32,
    pub tip: Tip,
    pub dynamics: Dynamics,
}

/// What a dab looks like before it is bent.
#[derive(Clone)]
pub enum Tip {
    Round,
    /// A picture whose longer side is the diameter. Opaque and grey throughout, it is coverage, white covering wholly;
    /// any other is a stamp in its own colours.
    Picture(PictureSource),
}

/// How the pen drives a dab: one row a property.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    pub size: Drive,
    pub flow: Drive,
}

/// How one property follows the pen.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Drive {
    /// Share of the value that pressure scales, `[0, 1]`: 0 ignores the pen, 1 vanishes with it.
    pub pressure: f32,
}

impl Drive {
    /// The factor of the property at a pressure in `[0, 1]`.
    pub fn factor(self, pressure: f32) -> f32 {
        1.0 - self.pressure * (1.0 - pressure)
    }
}

impl Default for Dynamics {
    /// A lighter hand paints fainter, not thinner.
    fn default() -> Self {
        Self { size: Drive { pressure: 0.0 }, flow: Drive { pressure: 1.0 } }
    }
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
            dynamics: Dynamics::default(),
        }
    }
}
