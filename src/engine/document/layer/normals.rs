//! What a normal layer holds: detail, and where it lies. Floor 4. Not here: combining it with the
//! surface (`document::normals`).

use super::mask::LayerMask;
use crate::document::conventions::NormalConvention;
use crate::math::{PlaneMap, Range};
use crate::paint::{PictureSource, Placement};
use crate::raster::Outside;
use crate::surface::{DetailMap, NoiseRelief};
use std::sync::Arc;

/// Detail combined with the surface: layers above it in its group see the combined normals. The
/// layer's opacity and mask weight its strength; its blend mode has no effect.
#[derive(Clone)]
pub struct NormalLayer {
    /// Where the detail comes from.
    pub source: DetailSource,
    /// Where it lies on the canvas.
    pub placement: Placement,
    /// What is beyond its picture.
    pub outside: Outside,
    /// Multiplies the detail's slopes, `≥ 0`; 1 is the map as it is.
    pub strength: f32,
    /// Where the frame of `placement` is on the canvas.
    pub frame: PlaneMap,
}

impl NormalLayer {
    /// Its range.
    pub const STRENGTH: Range = 0.0..=100.0;
}

/// Where detail comes from.
#[derive(Clone)]
pub enum DetailSource {
    /// A tangent-space normal map.
    Map {
        /// The picture, with the name of its file.
        picture: PictureSource,
        /// What its numbers mean; detected where it is not given.
        convention: NormalConvention,
        /// As it was read.
        map: Arc<DetailMap>,
    },
    /// A noisy relief. The placement turns and scales it about its center.
    Grain(NoiseRelief),
}

impl PartialEq for NormalLayer {
    /// Whether both have the same detail, by pointer.
    fn eq(&self, other: &Self) -> bool {
        let same_source = match (&self.source, &other.source) {
            (DetailSource::Map { map: a, .. }, DetailSource::Map { map: b, .. }) => {
                Arc::ptr_eq(a, b)
            }
            (DetailSource::Grain(a), DetailSource::Grain(b)) => a == b,
            _ => false,
        };
        same_source
            && self.placement == other.placement
            && self.outside == other.outside
            && self.strength == other.strength
            && self.frame == other.frame
    }
}

/// All that a combined surface depends on besides the surface beneath.
#[derive(Clone)]
pub struct Combination {
    pub(in crate::document) normals: NormalLayer,
    pub(in crate::document) opacity: f32,
    pub(in crate::document) mask: Option<LayerMask>,
}

impl PartialEq for Combination {
    fn eq(&self, other: &Self) -> bool {
        let same_mask = match (&self.mask, &other.mask) {
            (None, None) => true,
            (Some(a), Some(b)) => a.is_same(b),
            _ => false,
        };
        self.normals == other.normals && self.opacity == other.opacity && same_mask
    }
}
