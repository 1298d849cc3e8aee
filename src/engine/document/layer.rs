//! A layer: how it meets what lies beneath, and what it holds.
//! Floor 4.

use super::{cache::LayerCache, live::Live, mask::LayerMask, normals::NormalLayer};
use crate::math::{Range, UNIT, srgb::Color};
use crate::paint::{Gradient, PlacedImage, Stroke};
use crate::raster::{BlendMode, TileGrid};
use crate::shading::{RadianceScaling, Shading};
use std::sync::Arc;
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

/// What a layer holds. Live content keeps its parameters and, beside them, the tiles rendered from them.
#[derive(Clone)]
pub enum Content {
    Fill(Color),
    Pixels(PixelLayer),
    Image(Live<PlacedImage>),
    Gradient(Live<Gradient>),
    Strokes(Live<StrokeList>),
    Shading(Live<Shading>),
    RadianceScaling(RadianceScaling),
    Normals(NormalLayer),
    Group(Group),
}

impl Content {
    /// The kind of layer, as documents call it.
    pub fn kind_name(&self) -> &'static str {
        match self {
            Content::Fill(_) => "fill",
            Content::Pixels(_) => "pixels",
            Content::Image(_) => "image",
            Content::Gradient(_) => "gradient",
            Content::Strokes(_) => "strokes",
            Content::Shading(_) => "shading",
            Content::RadianceScaling(_) => "radiance-scaling",
            Content::Normals(_) => "normals",
            Content::Group(_) => "group",
        }
    }
}

/// A paint layer.
#[derive(Clone)]
pub struct PixelLayer {
    /// Where the pixels came from, if a file; empty for pixels painted here.
    pub file: String,
    pub x: i32,
    pub y: i32,
    /// On the canvas lattice, offset applied.
    pub tiles: TileGrid,
}

/// The strokes of a stroke layer, in the order they were painted. Shared, so that adding one copies pointers.
#[derive(Clone, Default)]
pub struct StrokeList {
    pub strokes: Vec<Arc<Stroke>>,
}

/// Layers flattened together before they meet what lies beneath.
#[derive(Clone, Default)]
pub struct Group {
    /// Bottom first.
    pub layers: Vec<Arc<Layer>>,
    /// Whether each layer blends with what lies beneath the group, as if the group did not exist.
    pub pass_through: bool,
}
