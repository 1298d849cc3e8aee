//! The masks that a layer can have: a picture of coverage, or one derived from the surface.
//! Floor 4. Not here: what they cover (`mask`).

use crate::math::{Range, UNIT};
use crate::raster::Plane;
use crate::surface::region::SurfaceRegion;
use std::sync::Arc;

/// What a layer's coverage is multiplied by.
#[derive(Clone)]
pub struct LayerMask {
    pub kind: MaskKind,
    /// 1 − the mask.
    pub invert: bool,
    /// The layer is shown as if it had no mask.
    pub disabled: bool,
}

#[derive(Clone)]
pub enum MaskKind {
    /// A picture of the canvas's size: encoded luminance × alpha.
    File { file: String, coverage: Arc<Plane<u8>> },
    /// Found anew wherever the surface changes.
    Derived(DerivedMask),
}

/// A mask that follows the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DerivedMask {
    /// Schlick's approximation: f0 + (1 − f0)(1 − n_z)^power (SF fig. 12c).
    Fresnel { f0: f32, power: f32 },
    /// κ of MATH 4, 0 at `from`, 1 at `to`.
    Curvature { scale: f32, blur: f32, from: f32, to: f32 },
    /// z, 0 at `from`, 1 at `to`.
    Depth { from: f32, to: f32 },
    /// All that has something in common with a point of the surface.
    Region(SurfaceRegion),
}

impl LayerMask {
    /// An enabled mask that is not inverted.
    pub fn new(kind: impl Into<MaskKind>) -> Self {
        Self { kind: kind.into(), invert: false, disabled: false }
    }
    /// The mask that follows the surface, if it is one.
    pub fn derived(&self) -> Option<DerivedMask> {
        match self.kind {
            MaskKind::Derived(derived) => Some(derived),
            MaskKind::File { .. } => None,
        }
    }
    /// Whether both have the same coverage: the same picture by pointer, or the same numbers.
    pub(super) fn is_same(&self, other: &LayerMask) -> bool {
        let same_kind = match (&self.kind, &other.kind) {
            (MaskKind::File { coverage: a, .. }, MaskKind::File { coverage: b, .. }) => Arc::ptr_eq(a, b),
            (MaskKind::Derived(a), MaskKind::Derived(b)) => a == b,
            _ => false,
        };
        same_kind && self.invert == other.invert && self.disabled == other.disabled
    }
}

impl DerivedMask {
    pub const F0: Range = UNIT;
    pub const POWER: Range = 0.0..=64.0;
    /// Curvatures at which the mask is 0 or 1.
    pub const KAPPA: Range = -1.0..=1.0;
    /// Depths at which the mask is 0 or 1.
    pub const DEPTH: Range = UNIT;

    // The numbers of a mask that tells none.
    pub const PLAIN_F0: f32 = 0.04;
    pub const PLAIN_POWER: f32 = 5.0;
    pub const PLAIN_SCALE_PX: f32 = 4.0;
    pub const FRESNEL: Self = Self::Fresnel { f0: Self::PLAIN_F0, power: Self::PLAIN_POWER };
    pub const CURVATURE: Self = Self::Curvature { scale: Self::PLAIN_SCALE_PX, blur: 0.0, from: -1.0, to: 1.0 };
    pub const RAMP_OF_DEPTH: Self = Self::Depth { from: 0.0, to: 1.0 };
}

impl From<DerivedMask> for MaskKind {
    fn from(derived: DerivedMask) -> Self {
        MaskKind::Derived(derived)
    }
}
