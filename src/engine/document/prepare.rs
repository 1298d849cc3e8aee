//! Prepares a document for flattening: finds the visible layers, what each is clipped to, and the
//! surface that each sees. Floor 4. Done once before the tiles. Not here: composing one tile
//! (`compose`).

use super::filter_stage::{FilterStage, StoredTiles};
use super::frames;
use super::layer::effects::EffectTiles;
use super::layer::on_canvas::on_canvas;
use super::layer::warp::WarpTiles;
use super::{
    Content, DerivedMask, Document, Group, Layer, LayerMap, LayerMask, LayerWarp, Progress, Role,
    normals,
};
use crate::math::Size;
use crate::paint::{EffectLight, Scene};
use crate::raster::{CoverageGrid, TileAt};
use crate::shading::radiance::BackdropStats;
use crate::surface::{Contours, Curvature};
use std::ops::Range;
use std::sync::Arc;

/// Everything that flattening needs from a document, resolved. It holds the layers, so the document
/// may be dropped or edited.
pub struct PreparedDocument {
    pub(super) size: Size,
    /// Bottom first.
    pub(super) stack: Vec<PreparedLayer>,
    /// The pixels that two sides see.
    pub(super) contours: Option<Arc<Contours>>,
    /// The surface's rim counts as wholly covered; else every pixel is mixed from what it shows.
    pub(super) whole_rims: bool,
    /// Measurements of the composite beneath each adjustment, in the order they apply.
    pub(super) beneath: Vec<BackdropStats>,
    /// The adjustments that are filters, in that order.
    pub(super) filters: Vec<FilterStage>,
}

/// A visible layer in its place.
pub(super) struct PreparedLayer {
    pub layer: Arc<Layer>,
    /// The canvas and surface that the layer sees.
    pub scene: Scene,
    /// For a mask derived from it.
    pub curvature: Option<Arc<Curvature>>,
    /// What it sees behind contours.
    pub far: Option<Scene>,
    pub far_curvature: Option<Arc<Curvature>>,
    /// What it shows, if it is a live layer or a group that is displaced.
    pub warp: Option<Arc<WarpTiles>>,
    /// What its effects add, if it shows some.
    pub effects: Option<Arc<EffectTiles>>,
    /// For the frame of a group: what it leaves of the layers beneath it there.
    pub frame: Option<Arc<CoverageGrid>>,
    /// For a group: its layers, bottom first.
    pub children: Vec<PreparedLayer>,
    /// The run of layers clipped to this one, bottom first.
    pub clipped: Vec<PreparedLayer>,
    /// The adjustments in this node: itself, its children, its clipped layers.
    pub adjustments: Range<usize>,
}

/// A layer that adjusts what lies beneath, and all it depends on.
pub(super) struct AdjustmentLayer {
    pub layer: Arc<Layer>,
    pub scene: Scene,
    /// Every layer beneath it in its scope (a pass-through group belongs to the scope around it).
    pub beneath: Vec<Arc<Layer>>,
    /// What takes the frames of the groups around it to the canvas.
    pub map: LayerMap,
}

impl AdjustmentLayer {
    /// For a filter, with what is known of what lies beneath it.
    fn stage(&self, index: usize) -> Option<FilterStage> {
        let filter = self.layer.content.filter()?.clone();
        let key = (self.layer.clip_below, self.map);
        let fresh = || Some(Arc::<StoredTiles>::default());
        let known = self.layer.cache.beneath.get(&self.scene, &self.beneath, &key, fresh);
        let beneath = [known.unwrap_or_default(), Arc::default()];
        let made = Default::default();
        Some(FilterStage { index, filter, scene: self.scene.clone(), beneath, made })
    }
}

impl PreparedDocument {
    /// Resolves the layers and measures what adjustments refer to; `None` if canceled meanwhile.
    pub fn new(document: &Document, progress: &Progress) -> Option<Self> {
        Self::with_cut(document, false, progress)
    }

    /// The same for what will be clipped to the surface later.
    pub(super) fn to_be_clipped(document: &Document, progress: &Progress) -> Option<Self> {
        Self::with_cut(document, true, progress)
    }

    fn with_cut(document: &Document, will_be_cut: bool, progress: &Progress) -> Option<Self> {
        let light = document.effect_light;
        let mut builder = StackBuilder { adjustments: Vec::new(), light, will_be_cut, progress };
        let scope = Scope { beneath: Beneath::NOTHING, map: LayerMap::none(document.size) };
        let stack = builder.nodes(&document.layers, &mut document.scene(), scope);
        let contours = document.surface.as_ref().map(|surface| surface.contours().clone());
        let stages = builder.adjustments.iter().enumerate();
        let filters = stages.filter_map(|(index, layer)| layer.stage(index)).collect();
        let mut prepared = Self {
            size: document.size,
            stack,
            contours,
            whole_rims: false,
            beneath: Vec::new(),
            filters,
        };
        for adjustment in builder.adjustments {
            // Each may depend on those beneath it, which are already measured.
            let beneath = prepared.measure(&adjustment, progress)?;
            prepared.beneath.push(beneath);
        }
        Some(prepared)
    }

    /// The surface's rim counts as wholly covered from now on.
    pub(super) fn make_rims_whole(&mut self) {
        self.whole_rims = true;
        // What is known was composed otherwise.
        self.filters.iter_mut().for_each(|stage| {
            (stage.beneath, stage.made) = Default::default();
        });
    }

    /// Every tile of the canvas, row by row.
    pub fn all_tiles(&self) -> Vec<TileAt> {
        TileAt::covering(self.size.rect()).collect()
    }
}

/// The surroundings of a list of layers.
#[derive(Clone, Copy)]
struct Scope<'a> {
    /// The layers beneath it that it blends with.
    beneath: Beneath<'a>,
    /// What takes the frames of the groups around it to the canvas.
    map: LayerMap,
}

/// Some layers of a list, and what lies beneath that list. Few layers need it, so it is gathered
/// only for them: gathered for each layer, the cost would grow with the square of the layers.
#[derive(Clone, Copy)]
struct Beneath<'a> {
    around: Option<&'a Beneath<'a>>,
    layers: &'a [Arc<Layer>],
}

impl Beneath<'_> {
    const NOTHING: Self = Self { around: None, layers: &[] };

    /// The lowest first.
    fn layers(&self) -> Vec<Arc<Layer>> {
        let mut all = self.around.map_or(Vec::new(), Beneath::layers);
        all.extend_from_slice(self.layers);
        all
    }
}

struct StackBuilder<'a> {
    adjustments: Vec<AdjustmentLayer>,
    /// Of effects without a light of their own.
    light: EffectLight,
    /// The surface will cut what is composed.
    will_be_cut: bool,
    progress: &'a Progress,
}

/// What a clipped layer would be clipped to.
enum ClipBase {
    /// Nothing is beneath: clipped layers paint nothing.
    Nothing,
    /// Hidden, and its clipped layers with it.
    Hidden,
    /// The last node.
    Shown,
}

impl StackBuilder<'_> {
    /// `scene` is what the first layer sees and is updated to what layers above see.
    fn nodes(
        &mut self,
        layers: &[Arc<Layer>],
        scene: &mut Scene,
        scope: Scope,
    ) -> Vec<PreparedLayer> {
        let mut nodes: Vec<PreparedLayer> = Vec::new();
        let mut base = ClipBase::Nothing;
        for (i, layer) in layers.iter().enumerate() {
            if layer.content.is_shaping_surface() {
                // It paints nothing, so it is no base and does not separate a base from its clipped
                // layers.
                if layer.visible {
                    *scene = normals::scene_above(layer, &scope.map, scene);
                }
                continue;
            }
            if !layer.clip_below {
                base = if layer.visible { ClipBase::Shown } else { ClipBase::Hidden };
            }
            if !layer.visible || !matches!(base, ClipBase::Shown) {
                continue;
            }
            let beneath = Beneath { around: Some(&scope.beneath), layers: &layers[..i] };
            let node = self.node(layer, scene, Scope { beneath, ..scope });
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

    fn node(&mut self, layer: &Arc<Layer>, scene: &mut Scene, scope: Scope) -> PreparedLayer {
        let within = Scope { map: scope.map.within(layer), ..scope };
        let warp = LayerWarp::of(layer, &within.map).filter(|_| is_composed_first(layer));
        let frame = frames::inside(layer, &scope.map, scene);
        let layer = &on_canvas(layer, &scope.map);
        let first = self.adjustments.len();
        let visible_scene = scene.clone();
        let children = match layer.content.role() {
            Role::Groups(group) => self.children(group, scene, within, warp.is_some()),
            _ => Vec::new(),
        };
        layer.content.warm(&visible_scene, self.progress);
        let far = visible_scene.far_side();
        if let Some(far) = &far {
            layer.content.warm_far_side(far, self.progress);
        }
        if let Role::Adjusts(_) = layer.content.role() {
            let (layer, beneath) = (layer.clone(), scope.beneath.layers());
            let (scene, map) = (visible_scene.clone(), scope.map);
            self.adjustments.push(AdjustmentLayer { layer, scene, beneath, map });
        }
        if let (Some(DerivedMask::Region(region)), Some(surface)) =
            (layer.mask.as_ref().and_then(LayerMask::derived_mask), &visible_scene.surface)
        {
            surface.region(&region);
        }
        let effects = layer.cache.effects.tiles(
            layer,
            &visible_scene,
            &within.map,
            warp.as_ref(),
            self.light,
        );
        let curvature_on = |scene: &Scene| layer.mask.as_ref()?.curvature_on(scene);
        PreparedLayer {
            curvature: curvature_on(&visible_scene),
            far_curvature: far.as_ref().and_then(curvature_on),
            far,
            warp: warp.map(|warp| {
                let shown = (&layer.content, &within.map);
                let is_cut = (self.will_be_cut || layer.clip_to_surface) && layer.can_be_cut();
                layer.cache.warped.tiles(&visible_scene, shown, warp, is_cut)
            }),
            effects,
            frame,
            layer: layer.clone(),
            scene: visible_scene,
            children,
            clipped: Vec::new(),
            adjustments: first..self.adjustments.len(),
        }
    }

    /// * `isolated`: the layers have nothing beneath the group, whatever it says.
    fn children(
        &mut self,
        group: &Group,
        scene: &mut Scene,
        scope: Scope,
        isolated: bool,
    ) -> Vec<PreparedLayer> {
        if group.pass_through && !isolated {
            return self.nodes(&group.layers, scene, scope);
        }
        self.nodes(&group.layers, &mut scene.clone(), Scope { beneath: Beneath::NOTHING, ..scope })
    }
}

/// Whether a displaced layer is composed undisplaced and then sampled: paint is sampled directly,
/// and one color is the same everywhere.
fn is_composed_first(layer: &Layer) -> bool {
    layer.content.can_be_warped() && !matches!(layer.content, Content::Pixels(_) | Content::Fill(_))
}
