//! Floor 4: the document is a value. It is cheap to clone and never changed while shared: an edit
//! is a new document, undo is a list of them, and what differs by pointer must be redrawn.

mod adjusted;
mod apply_transform;
pub mod assistants;
mod attachments;
pub mod canvas_change;
mod colors;
mod compose;
pub mod conventions;
mod count_memory;
pub mod cut;
pub mod diff;
pub mod edit;
mod far_side;
mod filter_stage;
mod filtered;
mod filters;
mod fit;
pub mod flatten;
mod floats;
mod form_sources;
mod frame_box;
mod frames;
pub mod guides;
mod histogram;
pub mod history;
mod ink_layers;
mod layer;
pub mod mask;
mod measure;
mod memory_use;
pub mod normals;
pub mod parts;
mod prepare;
pub mod progress;
mod same;
pub mod scale;
mod scenes;
pub mod selections;
mod several;
pub mod source;
mod strokes;
pub mod symmetry;
pub mod view;
mod weight;

pub use crate::paint::{Attachment, StrokeAttachment};
pub use assistants::{Assistant, AssistantKind};
pub use canvas_change::CanvasChange;
pub use colors::ColorMap;
pub use diff::diff;
pub use edit::LayerSlot;
pub use flatten::singles::SingleLayers;
pub use flatten::{
    flatten, flatten_layer, flatten_layers, flatten_rounding_once, flatten_to_be_clipped,
    flatten_to_floats, flatten_to_paint, flatten_whole,
};
pub use floats::Highlights;
pub use frame_box::FrameBox;
pub use guides::Guides;
pub use histogram::Histogram;
pub use history::{EditLabel, History, LabeledLayer};
pub use layer::{
    AdjustedPlace, Adjustment, BackdropMeter, Content, DerivedMask, DetailSource, EncodedPixels,
    Group, InkLayer, Layer, LayerCache, LayerId, LayerLabel, LayerLock, LayerMap, LayerMask,
    LayerTransform, LayerWarp, Live, MaskKind, Mesh, MeshFrame, NormalLayer, PixelLayer,
    PreviewKind, Reach, Role, StrokeList, TransformShape,
};
pub use memory_use::{MemoryCount, MemoryUse};
pub use parts::{Inflation, OutlineSource, Part, PartKind, Parts};
pub use prepare::PreparedDocument;
pub use progress::Progress;
pub use scale::{DocumentReducer, ReducedSurface, SurfaceReduction};
pub use selections::{NamedSelection, SelectionList};
pub use source::SurfaceSource;
pub use symmetry::{Symmetry, SymmetrySettings};

use crate::math::{ColorProfile, Size};
use crate::paint::{ColorPalette, EffectLight, Scene, Selection};
use crate::{raster::Asset, surface::Surface};
use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

/// A picture being painted: the canvas, its surface, and the layers, bottom first.
#[derive(Clone)]
pub struct Document {
    /// The canvas, px.
    pub size: Size,
    /// The colors that its numbers mean.
    pub profile: ColorProfile,
    /// What is painted on; absent: a flat canvas.
    pub surface: Option<Arc<Surface>>,
    /// The maps that the surface was made from; absent if there is no surface or it came from no
    /// file.
    pub surface_source: Option<Arc<SurfaceSource>>,
    /// The files that `surface_source` names, by their names, where they are known.
    pub surface_files: Arc<BTreeMap<String, Asset>>,
    /// The parts that the surface is made of, with the maps beneath them.
    pub parts: Arc<Parts>,
    /// The bottom one first.
    pub layers: Vec<Arc<Layer>>,
    /// Those kept by name; each name occurs once.
    pub selections: Vec<NamedSelection>,
    /// What marks may change; absent: everything. Never empty.
    pub active_selection: Option<Arc<Selection>>,
    /// Lines that what is dragged snaps to; not part of the picture.
    pub guides: Arc<Guides>,
    /// The light of effects that have none of their own.
    pub effect_light: EffectLight,
    /// What strokes are drawn along; not part of the picture.
    pub assistants: Arc<Vec<Assistant>>,
    /// How new strokes repeat; not part of the picture.
    pub symmetry: SymmetrySettings,
    /// Colors to paint it with; not part of the picture.
    pub palette: Arc<ColorPalette>,
}

impl Document {
    /// A canvas without layers or surface.
    pub fn empty(size: Size) -> Self {
        Self {
            size,
            profile: ColorProfile::default(),
            surface: None,
            surface_source: None,
            surface_files: Arc::default(),
            parts: Arc::default(),
            layers: Vec::new(),
            selections: Vec::new(),
            active_selection: None,
            guides: Arc::default(),
            effect_light: EffectLight::default(),
            assistants: Arc::default(),
            symmetry: SymmetrySettings::default(),
            palette: Arc::default(),
        }
    }

    /// A canvas of a surface's own size, without layers, to paint on that surface.
    pub fn over(surface: impl Into<Arc<Surface>>) -> Self {
        let surface = surface.into();
        Self { surface: Some(surface.clone()), ..Self::empty(surface.size()) }
    }

    /// With one more layer, on top.
    pub fn with_top(mut self, layer: impl Into<Arc<Layer>>) -> Self {
        self.layers.push(layer.into());
        self
    }

    /// The canvas as the bottom layer sees it.
    pub fn scene(&self) -> Scene {
        Scene { size: self.size, surface: self.surface.clone() }
    }

    /// Where the frame of a layer lies: its own transform and those of the groups around it. `None`
    /// if there is no such layer.
    pub fn map_of(&self, id: LayerId) -> Option<LayerMap> {
        let mut found = None;
        layer::on_canvas::each_with_map(
            &self.layers,
            &LayerMap::none(self.size),
            &mut |layer, map| {
                found = found.or((layer.id == id).then_some(map));
            },
        );
        found
    }

    /// The layers whose frames are not the canvas.
    pub fn moved_layers(&self) -> HashSet<LayerId> {
        let mut moved = HashSet::new();
        layer::on_canvas::each_with_map(
            &self.layers,
            &LayerMap::none(self.size),
            &mut |layer, map| {
                moved.extend((!map.is_none()).then_some(layer.id));
            },
        );
        moved
    }

    /// A layer by its name, groups opened, the topmost of several.
    pub fn layer_named(&self, name: &str) -> Option<&Arc<Layer>> {
        fn find<'a>(layers: &'a [Arc<Layer>], name: &str) -> Option<&'a Arc<Layer>> {
            layers.iter().rev().find_map(|layer| match layer.content.group() {
                _ if layer.name == name => Some(layer),
                Some(group) => find(&group.layers, name),
                None => None,
            })
        }
        find(&self.layers, name)
    }

    /// A name that no layer has: “Strokes”, “Strokes 2”, …
    pub fn free_layer_name(&self, base: &str) -> String {
        // Looked up once: a search of the document for each number would cost the square of the
        // layers.
        let layers = self.walk();
        let taken: HashSet<&str> = layers.iter().map(|(_, layer)| layer.name.as_str()).collect();
        let mut name = base.to_owned();
        for i in 2.. {
            if !taken.contains(name.as_str()) {
                break;
            }
            name = format!("{base} {i}");
        }
        name
    }

    /// Every layer, groups opened, bottom first, with its path such as `layers[2].layers[0]`.
    pub fn walk(&self) -> Vec<(String, &Arc<Layer>)> {
        fn visit<'a>(
            prefix: &str,
            layers: &'a [Arc<Layer>],
            out: &mut Vec<(String, &'a Arc<Layer>)>,
        ) {
            for (i, layer) in layers.iter().enumerate() {
                let path = format!("{prefix}layers[{i}]");
                if let Some(group) = layer.content.group() {
                    visit(&format!("{path}."), &group.layers, out);
                }
                out.push((path, layer));
            }
        }
        let mut out = Vec::new();
        visit("", &self.layers, &mut out);
        out
    }
}
