//! Renders and encodes the pictures of a plan, each once: an unchanged layer is taken from the
//! cache. Floor 5. Encoding is in `pixels`, composing in `document::flatten`.

use super::plan::{ItemContent, PlanItem};
use crate::Result;
use crate::document::{Content, Document, Layer, LayerId, Progress, SingleLayers};
use crate::document::{EncodedPixels, PreviewKind, flatten_layers, flatten_whole};
use crate::math::ColorProfile;
use crate::raster::{BlendMode, TileGrid};
use crate::{bitmap, pixels};
use rayon::prelude::*;
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::sync::Arc;

/// Work that may be canceled, or fail.
pub type Cancelable<T> = Result<Option<T>>;

/// The picture of each item that shows one, in the order [`pictures_of`] lists them; `None` if
/// canceled.
pub fn render(
    file: &Path,
    document: &Document,
    items: &[PlanItem],
    progress: &Progress,
) -> Cancelable<Vec<EncodedPixels>> {
    let (shown, seen) = (pictures_of(items), SeenLayers::of(document));
    let profile = document.profile;
    progress.add_total(shown.len() as u64);
    let one = |item: &&PlanItem| {
        let encoded = match &item.shows {
            ItemContent::Layer(layer) => {
                let has_some = !item.effects.is_empty() || item.fill_opacity < 1.0;
                let kind = PreviewKind {
                    masked: item.mask.is_none(),
                    whole_rim: item.whole_rim,
                    effects: !has_some && has_effects(layer),
                };
                render_preview(file, &seen, layer, kind, progress)?
            }
            ItemContent::Composed { document, layers } => {
                flatten_preview(document, layers, item.whole_rim, progress)
                    .map(|tiles| pixels::encode(file, &tiles, None, profile))
                    .transpose()?
            }
            ItemContent::Nothing(_) | ItemContent::Stack { .. } => {
                Some(pixels::encode(file, &TileGrid::default(), None, profile)?)
            }
        };
        progress.step();
        Ok(encoded)
    };
    let all: Result<Vec<Option<EncodedPixels>>> = shown.par_iter().map(one).collect();
    Ok(all?.into_iter().collect())
}

/// Every item that is a picture, bottom first, stacks opened.
pub fn pictures_of(items: &[PlanItem]) -> Vec<&PlanItem> {
    fn visit<'a>(items: &'a [PlanItem], out: &mut Vec<&'a PlanItem>) {
        for item in items {
            match &item.shows {
                ItemContent::Stack { items, .. } => visit(items, out),
                _ => out.push(item),
            }
        }
    }
    let mut out = Vec::new();
    visit(items, &mut out);
    out
}

/// What is asked about each layer of a document, found once for all of them.
struct SeenLayers<'d> {
    document: &'d Document,
    /// Those whose frames are not the canvas.
    moved: HashSet<LayerId>,
    /// What a layer's preview depends on besides the scene and the layer itself: normal layers, and
    /// groups that move those within.
    others: Vec<Arc<Layer>>,
    singles: SingleLayers<'d>,
}

impl<'d> SeenLayers<'d> {
    fn of(document: &'d Document) -> Self {
        let is_taken = |layer: &Layer| layer.transform.is_some() || layer.on.is_some();
        let takes_along = |layer: &Layer| is_taken(layer) && layer.content.group().is_some();
        let all = document.walk().into_iter().map(|(_, layer)| layer);
        let others = all
            .filter(|layer| layer.content.is_shaping_surface() || takes_along(layer))
            .cloned()
            .collect();
        let singles = SingleLayers::of(document);
        Self { document, moved: document.moved_layers(), others, singles }
    }

    fn layers_seen_by(&self, layer: &Arc<Layer>) -> Vec<Arc<Layer>> {
        std::iter::once(layer).chain(&self.others).cloned().collect()
    }

    /// A paint layer's pixels, where nothing hides any of them from other programs.
    fn bare<'a>(&self, layer: &'a Layer, masked: bool, effects: bool) -> Option<&'a TileGrid> {
        let is_moved = self.moved.contains(&layer.id);
        let has_surface = self.document.surface.is_some();
        let is_cut = effects
            || is_moved
            || (masked && layer.mask.is_some())
            || (has_surface && layer.clip_to_surface);
        match &layer.content {
            Content::Pixels(pixels) if !is_cut => Some(&pixels.tiles),
            _ => None,
        }
    }
}

/// The preview of a layer alone: wholly opaque, the surface's edge and its mask in its pixels, if
/// requested.
fn render_preview(
    file: &Path,
    seen: &SeenLayers,
    layer: &Arc<Layer>,
    kind: PreviewKind,
    progress: &Progress,
) -> Cancelable<EncodedPixels> {
    let document = seen.document;
    if let Some(tiles) = seen.bare(layer, kind.masked, kind.effects) {
        return pixels_of(file, document, layer, tiles).map(Some);
    }
    let render = || {
        let plain = seen.singles.isolate_layer(layer.id, |layer| {
            (layer.opacity, layer.blend, layer.blend_linear) = (1.0, BlendMode::Normal, false);
            layer.mask = layer.mask.take().filter(|_| kind.masked);
            if !kind.effects {
                (layer.effects, layer.fill_opacity) = (Arc::default(), 1.0);
            }
        });
        let tiles =
            plain.and_then(|plain| flatten_preview(&plain, &[layer.id], kind.whole_rim, progress));
        let encode =
            |tiles| pixels::encode(file, &tiles, Some(document.size.rect()), document.profile);
        tiles.map(encode).transpose()
    };
    let mut failed = None;
    let preview =
        layer.cache.preview.get(&document.scene(), &seen.layers_seen_by(layer), &kind, || {
            render().unwrap_or_else(|error| {
                failed = Some(error);
                None
            })
        });
    failed.map_or(Ok(preview), Err)
}

/// Some layers composed with each other.
fn flatten_preview(
    document: &Document,
    layers: &[LayerId],
    whole_rim: bool,
    progress: &Progress,
) -> Option<TileGrid> {
    if whole_rim {
        flatten_whole(document, layers, progress)
    } else {
        flatten_layers(document, layers, progress)
    }
}

/// Whether a layer looks otherwise than what it holds: it has effects, or its fill is transparent.
fn has_effects(layer: &Layer) -> bool {
    !layer.effects.is_empty() || layer.fill_opacity < 1.0
}

fn is_16_bit(tiles: &TileGrid) -> bool {
    tiles.is_16_bit_in(tiles.bounds())
}

/// Stores the pictures that were read with a document as the previews of its layers, so that saving
/// copies them.
pub fn cache_previews(document: &Document, previews: &BTreeMap<LayerId, EncodedPixels>) {
    let (scene, seen) = (document.scene(), SeenLayers::of(document));
    for (_, layer) in document.walk() {
        if let Some(encoded) = previews.get(&layer.id) {
            // Some formats have its effects in its picture, others beside it.
            if has_effects(layer) {
                continue;
            }
            // So has one whose pictures say other colors.
            let is_srgb = document.profile == ColorProfile::Srgb;
            if !is_srgb && !bitmap::has_png_profile(encoded.file.bytes()) {
                continue;
            }
            let bare = seen.bare(layer, true, false);
            // Another format rounded what it shows.
            if bare.is_some_and(|tiles| is_16_bit(tiles) != pixels::is_16_bit(encoded.file.bytes()))
            {
                continue;
            }
            let kind = PreviewKind { masked: true, whole_rim: false, effects: false };
            layer
                .cache
                .preview
                .get(&scene, &seen.layers_seen_by(layer), &kind, || Some(encoded.clone()));
            // Nothing hides any of its pixels, so they are its preview.
            if bare.is_some() {
                layer
                    .cache
                    .pixels
                    .get(&scene, std::slice::from_ref(layer), &(), || Some(encoded.clone()));
            }
        }
    }
}

/// All pixels of each paint layer, also those that a mask or the surface's edge hides.
pub fn encode_paint(file: &Path, document: &Document) -> Result<BTreeMap<LayerId, EncodedPixels>> {
    let layers: Vec<&Arc<Layer>> = document.walk().into_iter().map(|(_, layer)| layer).collect();
    let one = |layer: &&Arc<Layer>| {
        let Content::Pixels(pixels) = &layer.content else { return Ok(None) };
        Ok(Some((layer.id, pixels_of(file, document, layer, &pixels.tiles)?)))
    };
    let all: Result<Vec<_>> = layers.par_iter().map(one).collect();
    Ok(all?.into_iter().flatten().collect())
}

fn pixels_of(
    file: &Path,
    document: &Document,
    layer: &Arc<Layer>,
    tiles: &TileGrid,
) -> Result<EncodedPixels> {
    let mut failed = None;
    let encode = || pixels::encode(file, tiles, None, document.profile);
    let known = layer.cache.pixels.get(&document.scene(), std::slice::from_ref(layer), &(), || {
        encode().map_err(|error| failed = Some(error)).ok()
    });
    // Without a failure there is a value.
    failed.map_or_else(|| known.map_or_else(encode, Ok), Err)
}
