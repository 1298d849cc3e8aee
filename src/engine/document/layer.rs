//! A layer: how it is blended with what lies beneath, and what it holds. Floor 4. A layer holds
//! content, and the content of a group holds layers. So everything that a layer consists of is in
//! submodules of this one.

pub(super) mod adjustment;
pub(super) mod cache;
pub(super) mod content;
pub(super) mod effects;
mod live;
pub(super) mod map;
pub(super) mod marks;
pub(super) mod mask;
pub(super) mod normals;
pub(super) mod on_canvas;
pub(super) mod scale;
pub(super) mod tile_content;
pub(super) mod transform;
pub(super) mod warp;

pub use adjustment::{AdjustedPlace, Adjustment, BackdropMeter, Reach};
pub use cache::{EncodedPixels, LayerCache, PreviewKind};
pub use content::{Content, Group, InkLayer, PixelLayer, Role, StrokeList};
pub use live::Live;
pub use map::LayerMap;
pub use mask::{DerivedMask, LayerMask, MaskKind};
pub use normals::{DetailSource, NormalLayer};
pub use transform::mesh::{Mesh, MeshFrame};
pub use transform::{LayerTransform, TransformShape};
pub use warp::LayerWarp;

use crate::math::srgb::Color;
use crate::math::{PlaneMap, Range, Size, UNIT};
use crate::paint::{Attachment, LayerEffect};
use crate::raster::{BlendMode, Lattice};
use crate::shape::flats::lifted_ink::LiftedInk;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The identity of a layer: it stays the same through every edit, as long as the program runs. Not
/// stored in files.
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
    /// Its identity, kept through every edit.
    pub id: LayerId,
    /// As the list shows it.
    pub name: String,
    /// It is shown, and what is clipped to it.
    pub visible: bool,
    /// `[0, 1]`.
    pub opacity: f32,
    /// How its color is blended with what lies beneath.
    pub blend: BlendMode,
    /// Blend linear light instead of encoded values.
    pub blend_linear: bool,
    /// Paint only where the nearest layer beneath that is not itself clipped has coverage.
    pub clip_below: bool,
    /// What is protected from painting.
    pub lock: LayerLock,
    /// What its coverage is multiplied by; absent: nothing.
    pub mask: Option<LayerMask>,
    /// A color by which it is found in the list.
    pub label: LayerLabel,
    /// Shadows, glows and their like, the topmost of a kind first.
    pub effects: Arc<Vec<LayerEffect>>,
    /// The opacity of what it holds, not of its effects, `[0, 1]`.
    pub fill_opacity: f32,
    /// Paint nothing outside the surface.
    pub clip_to_surface: bool,
    /// Where the frame of content and mask lies on the canvas; absent: it is the canvas.
    pub transform: Option<LayerTransform>,
    /// A displacement backward at each point of the list that holds it, after its own transform;
    /// never empty.
    pub liquify: Option<Arc<Lattice>>,
    /// The part of the shape that carries it, after its own transform; absent: what carries the
    /// group around it, or the canvas.
    pub on: Option<Attachment>,
    /// What it holds.
    pub content: Content,
    /// Its ink, if an ink layer shows that; what is left is shown here. No part of the document's
    /// value: it follows from the content.
    pub lifted: Option<Arc<LiftedInk>>,
    /// Cached values of this layer; no part of the document's value.
    pub cache: LayerCache,
}

impl Layer {
    /// Whether the surface cuts what the layer shows, if it is to be clipped.
    pub(in crate::document) fn can_be_cut(&self) -> bool {
        let paints = matches!(self.content.role(), Role::Paints | Role::Shapes(_));
        paints && !self.content.is_shown_off_surface()
    }

    /// Whether another layer lies in it, at any depth.
    pub(in crate::document) fn has_layer_within(&self, id: LayerId) -> bool {
        let is_it = |layer: &Arc<Layer>| layer.id == id || layer.has_layer_within(id);
        self.content.group().is_some_and(|group| group.layers.iter().any(is_it))
    }

    /// What an opacity may be.
    pub const OPACITY: Range = UNIT;
    /// Letters of a name given in the window; one from a file may be longer.
    pub const LONGEST_NAME: usize = 1_000;

    /// A visible, opaque, unmasked layer that blends normally, under a fresh id.
    pub fn new(name: impl Into<String>, content: impl Into<Content>) -> Self {
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
            label: LayerLabel::None,
            effects: Arc::default(),
            fill_opacity: 1.0,
            clip_to_surface: true,
            transform: None,
            liquify: None,
            on: None,
            content: content.into(),
            lifted: None,
            cache: LayerCache::default(),
        }
    }

    /// Its liquify on a plane moved by a map; what lies far beyond the canvas is dropped.
    pub(super) fn transformed_liquify(&self, map: &PlaneMap, canvas: Size) -> Option<Arc<Lattice>> {
        let within = canvas.rect().grown(canvas.longer_side() as i32);
        let carried = self.liquify.as_ref()?.transformed(map, within);
        (!carried.is_empty()).then(|| Arc::new(carried))
    }
}

crate::named! {
    /// What is protected from painting.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum LayerLock {
        #[default]
        None = "none",
        Alpha = "alpha",
        All = "all",
    }
}

crate::named! {
    /// The color of a layer's label.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum LayerLabel {
        #[default]
        None = "none",
        Blue = "blue",
        Green = "green",
        Yellow = "yellow",
        Orange = "orange",
        Brown = "brown",
        Red = "red",
        Purple = "purple",
        Gray = "gray",
    }
}

impl LayerLabel {
    /// What it is shown as.
    pub fn color(self) -> Option<Color> {
        let rgb = match self {
            LayerLabel::None => return None,
            LayerLabel::Blue => [86, 160, 230],
            LayerLabel::Green => [120, 190, 70],
            LayerLabel::Yellow => [235, 215, 70],
            LayerLabel::Orange => [245, 160, 60],
            LayerLabel::Brown => [165, 110, 70],
            LayerLabel::Red => [228, 70, 66],
            LayerLabel::Purple => [175, 110, 205],
            LayerLabel::Gray => [130, 130, 130],
        };
        Some(Color { r: rgb[0], g: rgb[1], b: rgb[2], a: 255 })
    }
}
