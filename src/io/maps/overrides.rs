//! The conventions that a document states for its maps. Floor 5.

use crate::document::source::{DepthConvention, NormalConvention, SurfaceSource};

/// The conventions that the document gives; what they leave open is detected.
pub struct ConventionOverrides {
    pub normal: NormalConvention,
    pub depth: DepthConvention,
}

impl ConventionOverrides {
    pub fn of(source: &SurfaceSource) -> Self {
        Self {
            normal: source.normal.as_ref().map(|m| m.convention.clone()).unwrap_or_default(),
            depth: source.depth.as_ref().map(|m| m.convention.clone()).unwrap_or_default(),
        }
    }
}
