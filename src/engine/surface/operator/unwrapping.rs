//! What the operator by the unwrapped surface needs of an unwrapping (MATH 8).
//! Floor 2. Not here: the unwrapping itself (`unwrap`).

use crate::math::Size;

/// What an unwrapping depends on besides the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnwrapSettings {
    /// a of MATH 8, `[0, 2]`.
    pub amount: f32,
    /// Standard deviation of the blur of the normals beforehand, px.
    pub smooth_px: f32,
}

impl UnwrapSettings {
    /// What wires around a form follow.
    pub(in crate::surface) const OF_WIRES: Self = Self { amount: 1.0, smooth_px: 2.0 };

    /// Within what a surface can be unwrapped with; what is no number counts as 0.
    pub(in crate::surface) fn clamp_to_ranges(self, size: Size) -> Self {
        Self {
            amount: self.amount.max(0.0).min(2.0),
            smooth_px: self.smooth_px.max(0.0).min(size.longer_side()),
        }
    }

    pub(in crate::surface) fn key(self) -> [u32; 2] {
        [self.amount.to_bits(), self.smooth_px.to_bits()]
    }
}
