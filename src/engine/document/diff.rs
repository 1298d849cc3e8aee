//! What must be redrawn between two versions of a document: the tiles in which they may differ, found by comparing
//! pointers and parameters, never pixels. Floor 4. It is conservative: a tile that is not reported is the same; a
//! reported one may be.

use super::{Content, Document, Layer, LayerId, Live, StrokeList, mask};
use crate::math::Rect;
use crate::paint::{Scene, Stroke};
use crate::raster::TileAt;
use crate::shading::Reference;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The tiles of the canvas in which `new` may look different from `old`.
pub fn diff(old: &Document, new: &Document) -> BTreeSet<TileAt> {
    if !old.scene().is_same(&new.scene()) {
        return TileAt::covering(new.size.rect()).collect();
    }
    let mut diff =
        Diff { old: contexts(old), new: contexts(new), document: new, scene: new.scene(), changed: BTreeSet::new() };
    diff.stack(&old.layers, &new.layers, false);
    diff.changed
}

/// What the appearance of a layer depends on besides itself and its backdrop.
#[derive(Default, PartialEq)]
struct LayerContext {
    /// What it is clipped to, if it is clipped.
    base: Option<LayerId>,
    /// Whether a visible layer is clipped to it.
    is_base: bool,
    /// The normal layers that affect it. The pointers are only compared; both documents keep the layers alive
    /// meanwhile.
    normals: Vec<*const Layer>,
}

fn contexts(document: &Document) -> BTreeMap<LayerId, LayerContext> {
    let mut all = BTreeMap::new();
    survey(&document.layers, &mut Vec::new(), &mut all);
    all
}

fn survey(layers: &[Arc<Layer>], normals: &mut Vec<*const Layer>, all: &mut BTreeMap<LayerId, LayerContext>) {
    let (mut base, mut base_shows) = (None, false);
    for layer in layers {
        if let Content::Normals(_) = layer.content {
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
        if let Content::Group(group) = &layer.content {
            match group.pass_through && layer.visible && base_shows {
                true => survey(&group.layers, normals, all),
                false => survey(&group.layers, &mut normals.clone(), all),
            }
        }
        all.insert(layer.id, here);
    }
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
    /// Compares two versions of a list of layers; returns whether anything changed in it, or beneath it (`beneath`).
    fn stack(&mut self, old: &[Arc<Layer>], new: &[Arc<Layer>], beneath: bool) -> bool {
        let mut changed = beneath;
        let kept = |among: &[Arc<Layer>]| {
            let ids: BTreeSet<LayerId> = among.iter().map(|layer| layer.id).collect();
            move |layer: &&Arc<Layer>| ids.contains(&layer.id)
        };
        let (in_old, in_new) = (kept(old), kept(new));
        for removed in old.iter().filter(|layer| !in_new(layer)) {
            changed |= self.whole(removed);
        }
        let ranks: BTreeMap<LayerId, (usize, &Arc<Layer>)> =
            old.iter().filter(in_new).enumerate().map(|(rank, layer)| (layer.id, (rank, layer))).collect();
        let mut rank = 0;
        for layer in new {
            match ranks.get(&layer.id).filter(|_| in_old(&layer)) {
                None => changed |= self.whole(layer),
                // Of two layers that changed their order, one at least changed its rank.
                Some(&(before, old)) => {
                    changed |= if before == rank { self.layer(old, layer, changed) } else { self.both(old, layer) };
                    rank += 1;
                }
            }
        }
        changed
    }
    /// Compares two versions of a layer in its place; `beneath`: something beneath it in its scope changed.
    fn layer(&mut self, old: &Arc<Layer>, new: &Arc<Layer>, beneath: bool) -> bool {
        if !old.visible && !new.visible {
            return false;
        }
        if self.old.get(&old.id) != self.new.get(&new.id) || !looks_alike(old, new) {
            return self.both(old, new);
        }
        if let (Some(a), Some(b)) = (&old.mask, &new.mask)
            && !a.is_same(b)
        {
            // If a mask was painted on, only some of its tiles differ.
            let Some(tiles) = mask::changed_tiles(a, b) else { return self.both(old, new) };
            let unmasked = Arc::new(Layer { mask: old.mask.clone(), ..Layer::clone(new) });
            return self.tiles(tiles) | self.layer(old, &unmasked, beneath);
        }
        match (&old.content, &new.content) {
            (Content::RadianceScaling(a), Content::RadianceScaling(b)) => {
                let measures = b.keep_mean || b.reference == Reference::Auto;
                (a != b || (beneath && measures)) && self.both(old, new)
            }
            _ if Arc::ptr_eq(old, new) && !matches!(new.content, Content::Group(_)) => false,
            (Content::Fill(a), Content::Fill(b)) => a != b && self.both(old, new),
            (Content::Pixels(a), Content::Pixels(b)) => self.tiles(a.tiles.changed_tiles(&b.tiles)),
            (Content::Image(a), Content::Image(b)) => !a.ptr_eq(b) && self.both(old, new),
            (Content::Gradient(a), Content::Gradient(b)) => !a.ptr_eq(b) && self.both(old, new),
            (Content::Shading(a), Content::Shading(b)) => !a.ptr_eq(b) && self.both(old, new),
            (Content::Strokes(a), Content::Strokes(b)) => !a.ptr_eq(b) && self.drawn(new.id, a, b),
            // Children of an isolated group have a scope of their own.
            (Content::Group(a), Content::Group(b)) if a.pass_through == b.pass_through => {
                self.stack(&a.layers, &b.layers, beneath && b.pass_through)
            }
            _ => self.both(old, new),
        }
    }
    /// Two versions of a stroke layer on the same surface: where both are rendered, their tiles are compared.
    fn drawn(&mut self, layer: LayerId, old: &Live<StrokeList>, new: &Live<StrokeList>) -> bool {
        let seen = if self.sees_normals(layer) { self.document.scene_of(layer) } else { None };
        let scene = seen.unwrap_or_else(|| self.scene.clone());
        let (same, canvas) = (old.same_tiles(new, &scene), self.scene.size.rect());
        let differing = differing(&old.params().strokes, &new.params().strokes);
        let tiles = differing.flat_map(|stroke| TileAt::covering(stroke.bounds(&scene).intersect(canvas)));
        self.tiles(tiles.filter(|&at| !same(at)).collect())
    }
    fn stroke_bounds(&self, layer: LayerId, stroke: &Stroke) -> Rect {
        // Bounds are valid for one surface only, and normal layers replace it.
        if self.sees_normals(layer) { self.scene.size.rect() } else { stroke.bounds(&self.scene) }
    }
    fn sees_normals(&self, layer: LayerId) -> bool {
        [&self.old, &self.new].iter().any(|all| all.get(&layer).is_some_and(|s| !s.normals.is_empty()))
    }
    fn both(&mut self, old: &Layer, new: &Layer) -> bool {
        self.whole(old) | self.whole(new)
    }
    /// Reports every tile that a layer can touch; returns whether there is any.
    fn whole(&mut self, layer: &Layer) -> bool {
        if !layer.visible {
            return false;
        }
        match &layer.content {
            Content::Pixels(pixels) => {
                let tiles = pixels.tiles.iter().map(|(at, _)| at).collect();
                self.tiles(tiles)
            }
            Content::Strokes(live) => {
                let bounds: Vec<Rect> =
                    live.params().strokes.iter().map(|stroke| self.stroke_bounds(layer.id, stroke)).collect();
                bounds.into_iter().fold(false, |changed, rect| self.rect(rect) | changed)
            }
            Content::Group(group) => group.layers.iter().fold(false, |changed, layer| self.whole(layer) | changed),
            // Layers that see them have another context.
            Content::Normals(_) => false,
            Content::Fill(_)
            | Content::Image(_)
            | Content::Gradient(_)
            | Content::Shading(_)
            | Content::RadianceScaling(_) => self.rect(self.scene.size.rect()),
        }
    }
    fn rect(&mut self, rect: Rect) -> bool {
        let tiles = TileAt::covering(rect.intersect(self.scene.size.rect())).collect();
        self.tiles(tiles)
    }
    fn tiles(&mut self, tiles: Vec<TileAt>) -> bool {
        let canvas = self.scene.size.rect();
        let on_canvas = |at: &TileAt| !at.rect().intersect(canvas).is_empty();
        let tiles: Vec<TileAt> = tiles.into_iter().filter(on_canvas).collect();
        self.changed.extend(&tiles);
        !tiles.is_empty()
    }
}

/// Strokes are painted in order, so those between a common beginning and a common end may change what they touch.
fn differing<'s>(old: &'s [Arc<Stroke>], new: &'s [Arc<Stroke>]) -> impl Iterator<Item = &'s Arc<Stroke>> {
    let same = |(a, b): &(&Arc<Stroke>, &Arc<Stroke>)| Arc::ptr_eq(a, b);
    let start = old.iter().zip(new).take_while(same).count();
    let (old, new) = (&old[start..], &new[start..]);
    let end = old.iter().rev().zip(new.iter().rev()).take_while(same).count();
    old[..old.len() - end].iter().chain(&new[..new.len() - end])
}

/// Whether all but the content, the name, the lock and the mask's pixels is equal.
fn looks_alike(a: &Layer, b: &Layer) -> bool {
    a.visible == b.visible
        && a.opacity == b.opacity
        && a.blend == b.blend
        && a.blend_linear == b.blend_linear
        && a.clip_below == b.clip_below
        && a.clip_to_surface == b.clip_to_surface
        && a.mask.is_some() == b.mask.is_some()
}

#[cfg(test)]
mod tests;
