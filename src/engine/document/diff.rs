//! What must be redrawn between two versions of a document: the tiles in which they may differ,
//! found by comparing pointers and parameters, never pixels. Floor 4. It is conservative: a tile
//! that is not reported is the same; a reported one may differ.

use super::filter_stage::tiles_touched;
use super::layer::content::{Changed, VisibleArea};
use super::layer::on_canvas::on_canvas;
use super::{Content, Document, Layer, LayerId, LayerMap, LayerTransform, LayerWarp};
use crate::math::Rect;
use crate::paint::Scene;
use crate::raster::TileAt;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The tiles of the canvas in which `new` may look different from `old`.
pub fn diff(old: &Document, new: &Document) -> BTreeSet<TileAt> {
    if !old.scene().is_same(&new.scene()) || old.effect_light != new.effect_light {
        return TileAt::covering(new.size.rect()).collect();
    }
    let mut diff = Diff {
        old: contexts(old),
        new: contexts(new),
        document: new,
        scene: new.scene(),
        changed: BTreeSet::new(),
    };
    diff.compare_stacks(&old.layers, &new.layers, false);
    diff.changed
}

/// What the appearance of a layer depends on besides itself and its backdrop.
#[derive(Default, PartialEq)]
struct LayerContext {
    /// What it is clipped to, if it is clipped.
    base: Option<LayerId>,
    /// Whether a visible layer is clipped to it.
    is_base: bool,
    /// The normal layers that affect it. The pointers are only compared; both documents keep the
    /// layers alive meanwhile.
    normals: Vec<*const Layer>,
    /// What takes the frames of the groups around it to the canvas; absent where nothing does.
    around: Option<LayerMap>,
}

fn contexts(document: &Document) -> BTreeMap<LayerId, LayerContext> {
    let mut all = BTreeMap::new();
    survey(&document.layers, &mut Vec::new(), &mut all);
    place(&document.layers, &LayerMap::none(document.size), &mut all);
    all
}

/// Notes which layers are in transformed groups.
fn place(layers: &[Arc<Layer>], around: &LayerMap, all: &mut BTreeMap<LayerId, LayerContext>) {
    for layer in layers {
        if let Some(context) = all.get_mut(&layer.id).filter(|_| !around.is_still()) {
            context.around = Some(*around);
        }
        if let Some(group) = layer.content.group() {
            place(&group.layers, &around.within(layer), all);
        }
    }
}

fn survey(
    layers: &[Arc<Layer>],
    normals: &mut Vec<*const Layer>,
    all: &mut BTreeMap<LayerId, LayerContext>,
) {
    let (mut base, mut base_shows) = (None, false);
    for layer in layers {
        if layer.content.is_shaping_surface() {
            if layer.visible {
                normals.push(Arc::as_ptr(layer));
            }
            continue;
        }
        let mut here = LayerContext { normals: normals.clone(), ..LayerContext::default() };
        if layer.clip_below {
            here.base = base;
            if let Some(base) = base.and_then(|id| all.get_mut(&id)).filter(|_| layer.visible) {
                base.is_base = true;
            }
        } else {
            (base, base_shows) = (Some(layer.id), layer.visible);
        }
        if let Some(group) = layer.content.group() {
            match group.pass_through && layer.visible && base_shows {
                true => survey(&group.layers, normals, all),
                false => survey(&group.layers, &mut normals.clone(), all),
            }
        }
        all.insert(layer.id, here);
    }
}

/// Which of the two documents.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    Old,
    New,
}

struct Diff<'d> {
    old: BTreeMap<LayerId, LayerContext>,
    new: BTreeMap<LayerId, LayerContext>,
    /// The new one.
    document: &'d Document,
    scene: Scene,
    changed: BTreeSet<TileAt>,
}

impl Diff<'_> {
    /// Compares two versions of a list of layers; returns whether anything changed in it, or
    /// beneath it (`beneath`).
    fn compare_stacks(&mut self, old: &[Arc<Layer>], new: &[Arc<Layer>], beneath: bool) -> bool {
        let mut changed = beneath;
        let kept = |among: &[Arc<Layer>]| {
            let ids: BTreeSet<LayerId> = among.iter().map(|layer| layer.id).collect();
            move |layer: &&Arc<Layer>| ids.contains(&layer.id)
        };
        let (in_old, in_new) = (kept(old), kept(new));
        for removed in old.iter().filter(|layer| !in_new(layer)) {
            changed |= self.report_whole(removed, Version::Old);
        }
        let ranks: BTreeMap<LayerId, (usize, &Arc<Layer>)> = old
            .iter()
            .filter(in_new)
            .enumerate()
            .map(|(rank, layer)| (layer.id, (rank, layer)))
            .collect();
        let mut rank = 0;
        for layer in new {
            match ranks.get(&layer.id).filter(|_| in_old(&layer)) {
                None => changed |= self.report_whole(layer, Version::New),
                // If two layers changed their order, at least one changed its rank.
                Some(&(before, old)) => {
                    changed |= if before == rank {
                        self.compare_layers(old, layer, changed)
                    } else {
                        self.report_both(old, layer)
                    };
                    rank += 1;
                }
            }
        }
        changed
    }

    /// Compares two versions of a layer in its place; `beneath`: something beneath it in its scope
    /// changed.
    fn compare_layers(&mut self, old: &Arc<Layer>, new: &Arc<Layer>, beneath: bool) -> bool {
        if !old.visible && !new.visible {
            return false;
        }
        if self.old.get(&old.id) != self.new.get(&new.id) || !is_alike(old, new) {
            return self.report_both(old, new);
        }
        if !is_same_liquify(old, new) {
            let (was, is) = (self.warp(old, Version::Old), self.warp(new, Version::New));
            let Some(tiles) = LayerWarp::changed_tiles(was.as_ref(), is.as_ref()) else {
                return self.report_both(old, new);
            };
            let unmoved = Arc::new(Layer { liquify: old.liquify.clone(), ..Layer::clone(new) });
            let tiles = self.with_effect_reach(new, tiles);
            return self.report_tiles(tiles) | self.compare_layers(old, &unmoved, beneath);
        }
        if let (Some(a), Some(b)) = (&old.mask, &new.mask)
            && !a.is_same(b)
        {
            if self.is_off_canvas_frame(new) {
                return self.report_both(old, new);
            }
            // If a mask was painted on, only some of its tiles differ.
            let Some(tiles) = a.changed_tiles(b) else { return self.report_both(old, new) };
            let unmasked = Arc::new(Layer { mask: old.mask.clone(), ..Layer::clone(new) });
            let tiles = self.with_effect_reach(new, tiles);
            return self.report_tiles(tiles) | self.compare_layers(old, &unmasked, beneath);
        }
        if let (Some(a), Some(b)) = (old.content.group(), new.content.group())
            && a.pass_through == b.pass_through
        {
            // Children of an isolated group have a scope of their own.
            let beneath = beneath && b.pass_through && !new.is_warped();
            return self.report_displaced(new, Version::New, |diff| {
                diff.compare_stacks(&a.layers, &b.layers, beneath)
            });
        }
        if let Some(filter) = new.content.filter().filter(|_| beneath) {
            let touched = tiles_touched(filter, &self.changed, self.scene.size.rect());
            self.report_tiles(touched);
        }
        if beneath && new.content.is_composed_of_beneath() {
            return self.report_both(old, new);
        }
        if Arc::ptr_eq(old, new) {
            return false;
        }
        let (old_seen, new_seen) =
            (self.on_canvas(old, Version::Old), self.on_canvas(new, Version::New));
        match new_seen.content.difference_from(&old_seen.content, &|| self.common_scene(new.id)) {
            Changed::Nowhere => false,
            Changed::Wholly => self.report_both(old, new),
            // Paint was displaced when it was taken to the canvas.
            Changed::Tiles(tiles) if matches!(new.content, Content::Pixels(_)) => {
                let tiles = self.with_effect_reach(new, tiles);
                self.report_tiles(tiles)
            }
            Changed::Tiles(tiles) => {
                self.report_displaced(new, Version::New, |diff| diff.report_tiles(tiles))
            }
        }
    }

    fn warp(&self, layer: &Layer, version: Version) -> Option<LayerWarp> {
        let contexts = if version == Version::Old { &self.old } else { &self.new };
        let around = contexts.get(&layer.id).and_then(|context| context.around);
        LayerWarp::of(layer, &around.unwrap_or(LayerMap::none(self.document.size)).within(layer))
    }

    /// Reports where a layer shows what `report` reports of it undisplaced.
    fn report_displaced(
        &mut self,
        layer: &Layer,
        version: Version,
        report: impl FnOnce(&mut Self) -> bool,
    ) -> bool {
        let warp = self.warp(layer, version);
        if warp.is_none() && layer.effects.is_empty() {
            return report(self);
        }
        let before = std::mem::take(&mut self.changed);
        let is_any = report(self);
        let own = std::mem::replace(&mut self.changed, before);
        let own: Vec<TileAt> = own.into_iter().collect();
        let shown = warp.map_or_else(|| own.clone(), |warp| warp.showing(&own));
        let shown = self.with_effect_reach(layer, shown);
        self.report_tiles(shown) | is_any
    }

    /// Tiles of a layer, with those that its effects change with them.
    fn with_effect_reach(&self, layer: &Layer, tiles: Vec<TileAt>) -> Vec<TileAt> {
        if layer.effects.is_empty() || tiles.is_empty() {
            return tiles;
        }
        if layer.has_aligned_effects() {
            return TileAt::covering(self.scene.size.rect()).collect();
        }
        let reach = layer.effects_reach_px(self.document.effect_light, &self.scene);
        let near = tiles.iter().flat_map(|at| TileAt::covering(at.rect().grown(reach)));
        near.collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// What both versions of a layer see.
    fn common_scene(&self, layer: LayerId) -> Scene {
        let seen = if self.has_normals(layer) { self.document.scene_of(layer) } else { None };
        seen.unwrap_or_else(|| self.scene.clone())
    }

    fn has_normals(&self, layer: LayerId) -> bool {
        [&self.old, &self.new]
            .iter()
            .any(|all| all.get(&layer).is_some_and(|s| !s.normals.is_empty()))
    }

    /// A layer as it lies on the canvas in one of the documents.
    fn on_canvas(&self, layer: &Arc<Layer>, version: Version) -> Arc<Layer> {
        let contexts = if version == Version::Old { &self.old } else { &self.new };
        let around = contexts.get(&layer.id).and_then(|context| context.around);
        on_canvas(layer, &around.unwrap_or(LayerMap::none(self.document.size)))
    }

    /// Whether its own frame or that of a group around it is not the canvas.
    fn is_off_canvas_frame(&self, layer: &Layer) -> bool {
        let is_taken = self.new.get(&layer.id).is_some_and(|context| context.around.is_some());
        layer.transform.is_some() || layer.liquify.is_some() || layer.on.is_some() || is_taken
    }

    fn report_both(&mut self, old: &Arc<Layer>, new: &Arc<Layer>) -> bool {
        self.report_whole(old, Version::Old) | self.report_whole(new, Version::New)
    }

    /// Reports every tile that a layer can touch; returns whether there is any.
    fn report_whole(&mut self, layer: &Arc<Layer>, version: Version) -> bool {
        if !layer.visible {
            return false;
        }
        if let Some(group) = layer.content.group() {
            let all = |diff: &mut Self| {
                group
                    .layers
                    .iter()
                    .fold(false, |any, layer| diff.report_whole(layer, version) | any)
            };
            return self.report_displaced(layer, version, all);
        }
        if layer.is_warped() && !matches!(layer.content, Content::Pixels(_)) {
            let bare = Arc::new(Layer {
                liquify: None,
                transform: transform_without_mesh(layer),
                ..Layer::clone(layer)
            });
            return self.report_displaced(layer, version, |diff| diff.report_whole(&bare, version));
        }
        let layer = self.on_canvas(layer, version);
        let canvas = self.scene.size.rect();
        // Normal layers replace the canvas's surface.
        let touched =
            layer.content.visible_area(Some(&self.scene).filter(|_| !self.has_normals(layer.id)));
        let touched = match touched {
            VisibleArea::Nowhere => return false,
            VisibleArea::Canvas => return self.report_rect(canvas),
            VisibleArea::Rects(rects) if layer.effects.is_empty() => {
                return rects
                    .into_iter()
                    .fold(false, |changed, rect| self.report_rect(rect) | changed);
            }
            VisibleArea::Rects(rects) => rects.into_iter().flat_map(TileAt::covering).collect(),
            VisibleArea::Tiles(tiles) => tiles,
        };
        let tiles = self.with_effect_reach(&layer, touched);
        self.report_tiles(tiles)
    }

    fn report_rect(&mut self, rect: Rect) -> bool {
        let tiles = TileAt::covering(rect.intersect(self.scene.size.rect())).collect();
        self.report_tiles(tiles)
    }

    fn report_tiles(&mut self, tiles: Vec<TileAt>) -> bool {
        let canvas = self.scene.size.rect();
        let on_canvas = |at: &TileAt| !at.rect().intersect(canvas).is_empty();
        let tiles: Vec<TileAt> = tiles.into_iter().filter(on_canvas).collect();
        self.changed.extend(&tiles);
        !tiles.is_empty()
    }
}

/// The transform of a layer without its mesh.
fn transform_without_mesh(layer: &Layer) -> Option<LayerTransform> {
    layer.transform.clone().filter(|own| own.mesh().is_none_or(|mesh| mesh.as_affine().is_some()))
}

fn is_same_liquify(a: &Layer, b: &Layer) -> bool {
    match (&a.liquify, &b.liquify) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (a, b) => a.is_none() && b.is_none(),
    }
}

/// Whether all is equal except the content, the liquify, the name, the lock and the mask's pixels.
fn is_alike(a: &Layer, b: &Layer) -> bool {
    a.visible == b.visible
        && a.opacity == b.opacity
        && a.blend == b.blend
        && a.blend_linear == b.blend_linear
        && a.clip_below == b.clip_below
        && a.clip_to_surface == b.clip_to_surface
        && a.fill_opacity == b.fill_opacity
        && (Arc::ptr_eq(&a.effects, &b.effects) || a.effects == b.effects)
        && a.mask.is_some() == b.mask.is_some()
        && a.transform == b.transform
        && a.on == b.on
}

#[cfg(test)]
mod tests;
