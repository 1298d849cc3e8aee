//! Layers as they lie on the canvas, kept as long as nothing in them changes. Floor 4.

use super::Layer;
use super::content::{Content, Group, PixelLayer};
use super::map::LayerMap;
use super::mask::{LayerMask, MaskKind};
use super::warp::{LastWarp, LayerWarp, displaced_mask};
use crate::document::memory_use::MemoryCount;
use crate::raster::Plane;
use crate::raster::warp::warp_plane;
use std::sync::{Arc, Mutex, PoisonError};

impl LayerMap {
    /// A layer of which this is the map, as it lies on the canvas: content and mask taken there, no
    /// transform, no attachment.
    pub fn layer_on_canvas(&self, layer: &Arc<Layer>) -> Arc<Layer> {
        let seen = apply_map(layer, self);
        Arc::new(Layer { transform: None, liquify: None, on: None, ..Layer::clone(&seen) })
    }
}

/// A layer as it lies on the canvas: content and mask taken there. The layers of a group are taken
/// one by one.
pub(in crate::document) fn on_canvas(layer: &Arc<Layer>, map: &LayerMap) -> Arc<Layer> {
    apply_map(layer, &map.within(layer))
}

/// The same with the layer's own transform and attachment in the map.
pub(in crate::document) fn apply_map(layer: &Arc<Layer>, map: &LayerMap) -> Arc<Layer> {
    let layer = &without_ink(layer);
    let warp = LayerWarp::of(layer, map);
    if map.is_none() && warp.is_none() && !layer.content.has_attachments() {
        return layer.clone();
    }
    let (content, mask) = layer.cache.on_canvas.get(layer, map, warp.as_ref());
    Arc::new(Layer {
        content,
        mask,
        transform: None,
        liquify: None,
        on: None,
        ..Layer::clone(layer)
    })
}

/// A drawing as it is shown beneath its lines.
fn without_ink(layer: &Arc<Layer>) -> Arc<Layer> {
    let (Some(lifted), Content::Pixels(pixels)) = (&layer.lifted, &layer.content) else {
        return layer.clone();
    };
    let content = Content::Pixels(PixelLayer {
        tiles: lifted.visible_paint(&pixels.tiles),
        ..pixels.clone()
    });
    Arc::new(Layer { content, lifted: None, ..Layer::clone(layer) })
}

/// Visits the layers of a list with the map of each, groups opened, bottom first.
pub(in crate::document) fn each_with_map<'d>(
    layers: &'d [Arc<Layer>],
    around: &LayerMap,
    visit: &mut dyn FnMut(&'d Arc<Layer>, LayerMap),
) {
    for layer in layers {
        let map = around.within(layer);
        visit(layer, map);
        if let Content::Group(Group { layers, .. }) = &layer.content {
            each_with_map(layers, &map, visit);
        }
    }
}

/// The last results for a layer, shared by its versions.
#[derive(Clone, Default)]
pub struct CanvasCache {
    /// The newest last.
    entries: Arc<Mutex<Vec<CanvasEntry>>>,
}

#[derive(Clone)]
struct CanvasEntry {
    map: LayerMap,
    warp: Option<LayerWarp>,
    own: Content,
    own_mask: Option<LayerMask>,
    content: Content,
    mask: Option<LayerMask>,
}

impl CanvasCache {
    /// Counts what it holds, or drops it. What a layer has on the canvas as it has it by itself is
    /// the layer's own.
    pub(in crate::document) fn count(&self, count: &mut MemoryCount, keeps: bool) {
        if !count.is_new(&self.entries) {
            return;
        }
        let mut entries = self.lock();
        if !keeps {
            entries.clear();
        }
        for entry in entries.iter().filter(|entry| !entry.content.is_identical(&entry.own)) {
            count.add_copy(|count| entry.content.count(count, true));
        }
    }

    /// For the picture before an edit and the one after it.
    const KEPT: usize = 2;

    pub(in crate::document) fn get(
        &self,
        layer: &Layer,
        map: &LayerMap,
        warp: Option<&LayerWarp>,
    ) -> (Content, Option<LayerMask>) {
        let entries = self.lock().clone();
        if let Some(warp) = warp {
            return self.displace(layer, map, warp, &entries);
        }
        let entries: Vec<_> = entries.into_iter().filter(|entry| entry.warp.is_none()).collect();
        let mut alike = entries.iter().rev().filter(|entry| entry.map == *map);
        let same = alike.clone().find(|entry| entry.own.is_identical(&layer.content));
        let last = same.or_else(|| alike.next());
        let is_same_mask = |a: &Option<LayerMask>| match (a, &layer.mask) {
            (Some(a), Some(b)) => a.is_same(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let content = last.map_or_else(
            || layer.content.on_canvas(map, None),
            |last| layer.content.on_canvas(map, Some((&last.own, &last.content))),
        );
        let mask = match last.filter(|last| is_same_mask(&last.own_mask)) {
            Some(last) => last.mask.clone(),
            None if map.is_none() => layer.mask.clone(),
            None => layer.mask.as_ref().map(|mask| mask_on_canvas(mask, map)),
        };
        self.keep(CanvasEntry {
            map: *map,
            warp: None,
            own: layer.content.clone(),
            own_mask: layer.mask.clone(),
            content: content.clone(),
            mask: mask.clone(),
        });
        (content, mask)
    }

    /// The same for a displaced layer: its paint and its mask are displaced here, all else when it
    /// is composed.
    fn displace(
        &self,
        layer: &Layer,
        map: &LayerMap,
        warp: &LayerWarp,
        entries: &[CanvasEntry],
    ) -> (Content, Option<LayerMask>) {
        let alike = || {
            entries
                .iter()
                .rev()
                .filter(|entry| entry.map == *map && entry.own.is_identical(&layer.content))
        };
        let same = alike().find(|entry| entry.warp.as_ref() == Some(warp));
        let last = same.or_else(|| alike().next());
        let content = match (&layer.content, last) {
            (_, Some(same)) if same.warp.as_ref() == Some(warp) => same.content.clone(),
            (Content::Pixels(own), last) => {
                let last = last.and_then(|last| match (&last.own, &last.content) {
                    (Content::Pixels(own), Content::Pixels(seen)) => {
                        Some(LastWarp { own, seen, warp: last.warp.as_ref() })
                    }
                    _ => None,
                });
                Content::Pixels(own.displaced(map, warp, last))
            }
            (_, Some(last)) => last.content.clone(),
            (content, None) => match map.is_none() && !content.has_attachments() {
                true => content.clone(),
                false => content.on_canvas(map, None),
            },
        };
        let mask = layer.mask.as_ref().map(|mask| {
            let last = last.and_then(|last| {
                let (own, seen) = last.own_mask.as_ref().zip(last.mask.as_ref())?;
                own.is_same(mask).then_some(LastWarp { own, seen, warp: last.warp.as_ref() })
            });
            match last {
                Some(last) if last.warp == Some(warp) => last.seen.clone(),
                last => displaced_mask(mask, map, warp, last),
            }
        });
        self.keep(CanvasEntry {
            map: *map,
            warp: Some(warp.clone()),
            own: layer.content.clone(),
            own_mask: layer.mask.clone(),
            content: content.clone(),
            mask: mask.clone(),
        });
        (content, mask)
    }

    fn keep(&self, entry: CanvasEntry) {
        let mut entries = self.lock();
        entries.retain(|other| {
            !(other.map == entry.map
                && other.warp == entry.warp
                && other.own.is_identical(&entry.own))
        });
        entries.push(entry);
        let surplus = entries.len().saturating_sub(Self::KEPT);
        entries.drain(..surplus);
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<CanvasEntry>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn mask_on_canvas(mask: &LayerMask, map: &LayerMap) -> LayerMask {
    let MaskKind::File { file, coverage } = &mask.kind else { return mask.clone() };
    let coverage: Plane<u8> = warp_plane(coverage, map, map.filter);
    LayerMask {
        kind: MaskKind::File { file: file.clone(), coverage: Arc::new(coverage) },
        ..mask.clone()
    }
}

#[cfg(test)]
mod tests;
