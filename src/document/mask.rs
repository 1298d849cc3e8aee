//! A layer's mask: a picture of coverage, or one derived from the surface.
//! Floor 4.

use crate::raster::Plane;
use std::sync::Arc;

/// What a layer's coverage is multiplied by.
#[derive(Clone)]
pub struct LayerMask {
    pub kind: MaskKind,
    /// 1 − the mask.
    pub invert: bool,
}

#[derive(Clone)]
pub enum MaskKind {
    /// A picture of the canvas's size: encoded luminance × alpha.
    File { file: String, coverage: Arc<Plane<u8>> },
    /// Schlick's approximation: f0 + (1 − f0)(1 − n_z)^power (SF fig. 12c).
    Fresnel { f0: f32, power: f32 },
    /// κ of MATH 4, 0 at `from`, 1 at `to`.
    Curvature { scale: f32, blur: f32, from: f32, to: f32 },
    /// z, 0 at `from`, 1 at `to`.
    Depth { from: f32, to: f32 },
}
