//! The radiance-scaling layer: enhances whatever was painted beneath it in its group (RS eq. 3, MATH 5).
//! Floor 3.

use super::{features::Features, scaling::Reference, scaling::Scaling};
use crate::math::{Vec3, vec3};

/// The parameters of a radiance-scaling layer, an adjustment of what lies beneath it in its group.
///
/// δ = Y / Y*, Y the luminance of the composite in linear light; the linear colour is multiplied by σ(κ, δ).
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceScaling {
    pub scaling: Scaling,
    pub features: Features,
    /// ℓ, toward the light, camera space (y up): the direction that λ refers to. Any length but 0.
    pub light: Vec3,
    /// Y*.
    pub reference: Reference,
    /// Multiply by one more factor, the same everywhere, so that the mean luminance over the surface stays: a strong γ
    /// then alters the material less (RS sec. 6.2).
    pub keep_mean: bool,
}

impl Default for RadianceScaling {
    fn default() -> Self {
        Self {
            scaling: Scaling::new(Scaling::ALPHA, 1.0),
            features: Features::default(),
            light: vec3(0.3, 0.5, 0.8),
            reference: Reference::Auto,
            keep_mean: false,
        }
    }
}
