//! A layer: how it meets what lies beneath, and what it holds.
//! Floor 4.

use super::{Content, LayerTransform, cache::LayerCache, mask::LayerMask};
use crate::math::{Range, UNIT};
use crate::raster::BlendMode;
use std::sync::atomic::{AtomicU64, Ordering};

/// The identity of a layer: it stays the same through every edit, as long as the program runs. Not stored in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LayerId(u64);

impl LayerId {
    /// An id that no layer has had.
    pub fn fresh() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// One layer of a document. Made with [`Layer::new`]; a clone is the same layer in another version.
#[derive(Clone)]
pub struct Layer {
    pub id: LayerId,
    pub name: String,
    pub visible: bool,
    /// `[0, 1]`.
    pub opacity: f32,
    pub blend: BlendMode,
    /// Blend linear light instead of encoded values.
    pub blend_linear: bool,
    /// Paint only where the nearest layer beneath that is not itself clipped has coverage.
    pub clip_below: bool,
    pub lock: LayerLock,
    pub mask: Option<LayerMask>,
    /// Paint nothing outside the surface.
    pub clip_to_surface: bool,
    /// Where the frame that content and mask lie in stands on the canvas; absent: it is the canvas.
    pub transform: Option<LayerTransform>,
    pub content: Content,
    /// Cached values of this layer; no part of the document's value.
    pub cache: LayerCache,
}

impl Layer {
    pub const OPACITY: Range = UNIT;
    /// Letters of a name that the hand gives; one that a file brings may be longer.
    pub const LONGEST_NAME: usize = 1_000;

    /// A visible, opaque, unmasked layer that blends normally, under a fresh id.
    pub fn new(name: impl Into<String>, content: Content) -> Self {
        Self {
            id: LayerId::fresh(),
            name: name.into(),
            visible: true,
            opacity: 1.0,
            blend: BlendMode::Normal,
            blend_linear: false,
            clip_below: false,
            lock: LayerLock::None,
            mask: None,
            clip_to_surface: true,
            transform: None,
            content,
            cache: LayerCache::default(),
        }
    }
}

/// What is protected from painting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LayerLock {
    #[default]
    None,
    Alpha,
    All,
}
