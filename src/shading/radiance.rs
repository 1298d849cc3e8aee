//! Radiance scaling: brightens convex features where light is strong and darkens them where it is weak (RS eq. 2).
//! Floor 3.

/// The parameters of a radiance-scaling layer, an adjustment of what lies beneath it in its group.
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceScaling {
    /// Scaling-invariant reflectance, in (0, 1).
    pub alpha: f32,
    /// Magnitude, `≥ 0`.
    pub gamma: f32,
}
