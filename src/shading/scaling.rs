//! The scaling function σ: how much reflected light is raised or lowered on a feature (RS sec. 4, MATH 5).
//! Floor 3. Not here: which curvature (`features`), which reflectance (`radiance`, `material`).

/// How a term is scaled: the scaling-invariant point and the magnitude.
///
/// RS names the separate strength of convex and concave features as future work; with both equal it is the paper's γ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaling {
    /// α in (0, 1): light of this reflectance is left alone; on a convex feature brighter light rises, dimmer light falls.
    pub alpha: f32,
    /// γ on convex features (κ > 0), `≥ 0`.
    pub gamma_convex: f32,
    /// γ on concave features (κ < 0), `≥ 0`.
    pub gamma_concave: f32,
}

impl Scaling {
    /// The paper's α where nothing is said: convexities are mostly brightened (RS fig. 3).
    pub const ALPHA: f32 = 0.2;
    /// Leaves every term alone.
    pub const NONE: Scaling = Scaling::new(Self::ALPHA, 0.0);

    /// The same magnitude on convex and concave features.
    pub const fn new(alpha: f32, gamma: f32) -> Self {
        Self { alpha, gamma_convex: gamma, gamma_concave: gamma }
    }
    /// σ is 1 everywhere.
    pub fn is_none(&self) -> bool {
        self.gamma_convex == 0.0 && self.gamma_concave == 0.0
    }
}

/// The reflectance that counts as 1: Y*.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Reference {
    /// The largest luminance there is over the surface (or in the environment, or on the lit sphere).
    #[default]
    Auto,
    /// Luminance in linear light, `> 0`.
    Value(f32),
}
