//! A document made ready to be flattened: which layers show, what each is clipped to, which surface each sees.
//! Floor 4. Done once before the tiles; composing one tile is `compose`.

use super::{Content, Document, Group, Layer, MaskKind, NormalLayer, Progress};
use crate::math::Size;
use crate::paint::Scene;
use crate::shading::{RadianceScaling, Reference};
use crate::surface::Curvature;
use std::ops::Range;
use std::sync::Arc;

/// What of a document flattening needs, resolved. Holds the layers it needs, so the document may be dropped or edited.
pub struct Prepared {
    pub(super) size: Size,
    /// Bottom first.
    pub(super) stack: Vec<Node>,
    /// Y* of each adjustment, in the order they apply.
    pub(super) references: Vec<f32>,
}

/// A visible layer in its place.
pub(super) struct Node {
    pub layer: Arc<Layer>,
    /// The canvas and surface that the layer sees.
    pub scene: Scene,
    /// For a mask derived from it.
    pub curvature: Option<Arc<Curvature>>,
    /// Of a group, bottom first.
    pub children: Vec<Node>,
    /// The run of layers clipped to this one, bottom first.
    pub clipped: Vec<Node>,
    /// Which adjustments stand in this node: itself, its children, its clipped layers.
    pub adjustments: Range<usize>,
}

/// An adjustment and all it depends on.
struct Adjustment {
    layer: Arc<Layer>,
    scene: Scene,
    /// Every layer beneath it in its scope (a pass-through group belongs to the scope around it).
    beneath: Vec<Arc<Layer>>,
}

impl Prepared {
    /// Resolves the layers and measures what adjustments refer to; `None` if cancelled meanwhile.
    pub fn new(document: &Document, progress: &Progress) -> Option<Self> {
        let mut builder = Builder::default();
        let stack = builder.nodes(&document.layers, &mut document.scene(), &[]);
        let mut prepared = Self { size: document.size, stack, references: Vec::new() };
        for adjustment in builder.adjustments {
            // Each may depend on those beneath it, which are known by now.
            let reference = prepared.reference(&adjustment, progress)?;
            prepared.references.push(reference);
        }
        Some(prepared)
    }
    /// Y* of the next adjustment: its own figure, or the brightest luminance beneath it.
    fn reference(&self, adjustment: &Adjustment, progress: &Progress) -> Option<f32> {
        let Adjustment { layer, scene, beneath } = adjustment;
        if let Content::RadianceScaling(RadianceScaling { reference: Reference::Value(value), .. }) = layer.content {
            return Some(value);
        }
        layer.kept.measured(scene, beneath, || self.brightest_beneath(self.references.len(), progress))
    }
}

#[derive(Default)]
struct Builder {
    adjustments: Vec<Adjustment>,
}

/// What a clipped layer would be clipped to.
enum Base {
    /// Nothing stands beneath: clipped layers paint nothing.
    Nothing,
    /// Hidden, and its clipped layers with it.
    Hidden,
    /// The last node.
    Shown,
}

impl Builder {
    /// `scene` is what the first layer sees and becomes what stands above sees; `beneath` is the scope so far.
    fn nodes(&mut self, layers: &[Arc<Layer>], scene: &mut Scene, beneath: &[Arc<Layer>]) -> Vec<Node> {
        let mut nodes: Vec<Node> = Vec::new();
        let mut base = Base::Nothing;
        for (i, layer) in layers.iter().enumerate() {
            if let Content::Normals(normals) = &layer.content {
                // It paints nothing, so it neither is a base nor stands between a base and its clipped layers.
                if layer.visible {
                    *scene = scene_above(layer, normals, scene);
                }
                continue;
            }
            if !layer.clip_below {
                base = if layer.visible { Base::Shown } else { Base::Hidden };
            }
            if !layer.visible || !matches!(base, Base::Shown) {
                continue;
            }
            let node = self.node(layer, scene, &[beneath, &layers[..i]].concat());
            match nodes.last_mut() {
                Some(base) if layer.clip_below => {
                    base.adjustments.end = node.adjustments.end;
                    base.clipped.push(node);
                }
                _ => nodes.push(node),
            }
        }
        nodes
    }
    fn node(&mut self, layer: &Arc<Layer>, scene: &mut Scene, beneath: &[Arc<Layer>]) -> Node {
        let first = self.adjustments.len();
        let seen = scene.clone();
        let children = match &layer.content {
            Content::Group(group) => self.children(group, scene, beneath),
            _ => Vec::new(),
        };
        if let Content::RadianceScaling(_) = &layer.content {
            let (layer, beneath) = (layer.clone(), beneath.to_vec());
            self.adjustments.push(Adjustment { layer, scene: seen.clone(), beneath });
        }
        Node {
            curvature: curvature_of_mask(layer, &seen),
            layer: layer.clone(),
            scene: seen,
            children,
            clipped: Vec::new(),
            adjustments: first..self.adjustments.len(),
        }
    }
    fn children(&mut self, group: &Group, scene: &mut Scene, beneath: &[Arc<Layer>]) -> Vec<Node> {
        if group.pass_through {
            return self.nodes(&group.layers, scene, beneath);
        }
        self.nodes(&group.layers, &mut scene.clone(), &[])
    }
}

/// What the layers above a normal layer see.
fn scene_above(_layer: &Layer, _normals: &NormalLayer, beneath: &Scene) -> Scene {
    beneath.clone()
}

fn curvature_of_mask(layer: &Layer, scene: &Scene) -> Option<Arc<Curvature>> {
    match layer.mask.as_ref()?.kind {
        MaskKind::Curvature { blur, .. } => Some(scene.surface.as_ref()?.curvature(blur)),
        _ => None,
    }
}
