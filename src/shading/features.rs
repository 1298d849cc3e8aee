//! Which features of the surface are enhanced: the scales of curvature, their weights and their direction (RS sec. 4).
//! Floor 3. Curvature itself is the surface's.

/// The mapping from the curvature tensor to κ.
#[derive(Clone, Debug, PartialEq)]
pub struct Features {
    /// At least one; κ is their weighted mean.
    pub scales: Vec<FeatureScale>,
    /// λ in `[−1, 1]`: 0 is isotropic, 1 the curvature along the light, −1 across it.
    pub lambda: f32,
}

/// One scale of curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureScale {
    /// s: curvature is multiplied by it before it saturates, px, `≥ 0`.
    pub curvature_scale_px: f32,
    /// Standard deviation of the Gaussian that the normals are blurred with first, px, `≥ 0`.
    pub blur_px: f32,
    /// `≥ 0`; only the ratio between scales counts.
    pub weight: f32,
}

impl Default for FeatureScale {
    fn default() -> Self {
        Self { curvature_scale_px: 4.0, blur_px: 0.0, weight: 1.0 }
    }
}

impl Default for Features {
    fn default() -> Self {
        Self { scales: vec![FeatureScale::default()], lambda: 0.0 }
    }
}
