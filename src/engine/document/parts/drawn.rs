//! What a layer draws, as parts take their outlines from it, and all that it depends on. Floor 4.
//! Not here: the outlines in it (`outlines`).
//!
//! A paint layer draws its paint, whatever its mask and its opacity; any other what it shows alone.
//! Both are seen through the layer's transform and liquify and those of the groups around it, and
//! without any surface: that depends on the outlines.

use super::{Part, Parts};
use crate::document::layer::content::{Content, Group};
use crate::document::layer::map::LayerMap;
use crate::document::layer::transform::LayerTransform;
use crate::document::layer::warp::LayerWarp;
use crate::document::layer::{Layer, LayerCache};
use crate::document::selections::selecting;
use crate::document::{Document, LayerId, Progress, flatten_layer};
use crate::paint::{Scene, Selection, Stroke};
use crate::raster::tile::TILE_AREA;
use crate::raster::{Tile, TileAt, TileGrid};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A layer as outlines see it: what two have in common says whether they draw the same.
#[derive(Clone)]
pub struct DrawnLayer {
    layer: Arc<Layer>,
    /// To the canvas, or to where the part was made if that carries the layer.
    map: LayerMap,
    /// Only if something displaces it.
    warped: Option<Box<WarpedLayer>>,
    /// The maps beneath all parts, if its strokes have selections that follow the surface: they are
    /// found on these, since what they are on the surface of the parts depends on the outlines.
    maps: Option<Scene>,
}

/// A displaced layer.
#[derive(Clone)]
struct WarpedLayer {
    /// It alone, in the groups that it is in.
    alone: Document,
    /// The outermost first, its own last.
    warps: Vec<LayerWarp>,
}

impl DrawnLayer {
    /// A layer as a part sees it. `None` if it is not in the document.
    pub fn of(document: &Document, layer: &Arc<Layer>, part: &Part) -> Option<Self> {
        let map = document.map_of(layer.id)?;
        let attachment = document
            .attachment_of(layer.id)
            .and_then(|attachment| document.parts.body_of(&attachment.part));
        let body = document.parts.body_of(&part.id);
        let is_attached_alike =
            attachment.zip(body).is_some_and(|(attachment, body)| attachment.id == body.id);
        let map = if is_attached_alike { map.unattached() } else { map };
        let warped = document.is_displaced(layer.id).then(|| {
            let layers =
                isolate(&document.layers, layer.id, is_attached_alike).into_iter().collect();
            let alone = Document { layers, ..Document::empty(document.size) };
            Box::new(WarpedLayer { warps: alone.warps_of(layer.id), alone })
        });
        let maps = || Scene { size: document.size, surface: document.maps_surface().cloned() };
        Some(Self {
            layer: layer.clone(),
            map,
            warped,
            maps: has_surface_selections(layer).then(maps),
        })
    }

    pub(super) fn layer(&self) -> &Arc<Layer> {
        &self.layer
    }

    /// Whether a mesh or a liquify displaces it.
    pub(super) fn is_displaced(&self) -> bool {
        self.warped.is_some()
    }

    /// Where the layer's pixels are.
    pub fn map(&self) -> &LayerMap {
        &self.map
    }

    /// Whether both draw the same for certain: a name, and of paint a mask or an opacity, change
    /// nothing.
    pub fn is_same(&self, other: &Self) -> bool {
        let same_maps = match (&self.maps, &other.maps) {
            (Some(a), Some(b)) => a.is_same(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        same_maps
            && self.map == other.map
            && self.warps() == other.warps()
            && is_same_paint(&self.layer, &other.layer)
    }

    fn warps(&self) -> &[LayerWarp] {
        self.warped.as_ref().map_or(&[], |warped| &warped.warps)
    }

    /// The pixels, in tiles that hold some paint: where erased ones were does not show. The last
    /// ones are kept.
    pub fn pixels(&self, document: &Document) -> Option<TileGrid> {
        let kept = &document.parts.cache.drawn;
        kept.get(self).or_else(|| {
            let drawn = without_transparent_tiles(self.draw(document)?);
            kept.keep(self, &drawn);
            Some(drawn)
        })
    }

    fn draw(&self, document: &Document) -> Option<TileGrid> {
        if let Some(warped) = &self.warped {
            return self.flatten(warped.alone.clone());
        }
        let layer = match &self.layer.content {
            Content::Pixels(pixels) => return Some(pixels.transformed(&self.map).tiles),
            Content::Group(_) => {
                let transform =
                    LayerTransform::of_map(&self.map.plane, self.map.filter, document.size);
                Layer { on: None, transform, ..Layer::clone(&self.layer) }
            }
            _ => Layer::clone(&self.map.layer_on_canvas(&self.layer)),
        };
        self.flatten(Document { layers: vec![Arc::new(layer)], ..Document::empty(document.size) })
    }

    /// The layer as a document shows it that holds nothing else.
    fn flatten(&self, alone: Document) -> Option<TileGrid> {
        let found = |selection: &Arc<Selection>| {
            let next = self.maps.as_ref().and_then(|maps| selection.found_on(maps));
            next.map_or_else(|| selection.clone(), Arc::new)
        };
        let layers =
            alone.layers.iter().map(|layer| selecting(&with_its_ink(layer), &found)).collect();
        // Nobody cancels it.
        flatten_layer(&Document { layers, ..alone }, self.layer.id, &Progress::default())
    }
}

/// Without tiles that are wholly transparent: files have none.
fn without_transparent_tiles(mut tiles: TileGrid) -> TileGrid {
    let is_blank = |tile: &Tile| !(0..TILE_AREA).any(|i| tile.is_painted(i));
    let blank: Vec<TileAt> =
        tiles.iter().filter(|(_, tile)| is_blank(tile)).map(|(at, _)| at).collect();
    blank.into_iter().for_each(|at| tiles.set(at, None));
    tiles
}

/// With the ink on its drawings, whatever ink layer shows it: that follows from the drawings.
fn with_its_ink(layer: &Arc<Layer>) -> Arc<Layer> {
    let next = match &layer.content {
        Content::Group(group) => {
            let layers: Vec<_> = group.layers.iter().map(with_its_ink).collect();
            let is_same = layers.iter().zip(&group.layers).all(|(a, b)| Arc::ptr_eq(a, b));
            let content = Content::Group(Group { layers, ..group.clone() });
            (!is_same).then(|| Layer {
                content,
                cache: LayerCache::default(),
                ..Layer::clone(layer)
            })
        }
        _ => layer.lifted.as_ref().map(|_| Layer { lifted: None, ..Layer::clone(layer) }),
    };
    next.map_or_else(|| layer.clone(), Arc::new)
}

/// Whether two versions of a layer hold the same, but for what changes no outline.
pub fn is_same_paint(a: &Arc<Layer>, b: &Arc<Layer>) -> bool {
    match (&a.content, &b.content) {
        _ if Arc::ptr_eq(a, b) => true,
        (Content::Pixels(a), Content::Pixels(b)) => a.tiles.ptr_eq(&b.tiles),
        _ => false,
    }
}

impl Document {
    /// Whether its own mesh or liquify, or that of a group around it, displaces a layer.
    fn is_displaced(&self, id: LayerId) -> bool {
        fn find(layers: &[Arc<Layer>], id: LayerId, around: bool) -> Option<bool> {
            layers.iter().find_map(|layer| {
                let is_displaced = around || layer.is_warped();
                if layer.id == id {
                    return Some(is_displaced);
                }
                find(&layer.content.group()?.layers, id, is_displaced)
            })
        }
        find(&self.layers, id, false).unwrap_or(false)
    }
}

/// Whether strokes of a layer, or in it, were painted in selections by the surface.
fn has_surface_selections(layer: &Layer) -> bool {
    let is_of_surface =
        |stroke: &Arc<Stroke>| stroke.selection().is_some_and(|own| own.selection.made.is_some());
    match &layer.content {
        Content::Strokes(live) => live.params().strokes.iter().any(is_of_surface),
        Content::Group(group) => group.layers.iter().any(|layer| has_surface_selections(layer)),
        _ => false,
    }
}

/// A layer alone in the groups that it is in, which show nothing else of themselves; `None` if it
/// is not in this list.
///
/// * `is_attached_alike`: what is seen of it is where it would be if no part carried it.
fn isolate(layers: &[Arc<Layer>], id: LayerId, is_attached_alike: bool) -> Option<Arc<Layer>> {
    layers.iter().find_map(|layer| {
        let on = layer.on.clone().filter(|_| !is_attached_alike);
        let bare = || Layer {
            visible: true,
            opacity: 1.0,
            mask: None,
            clip_below: false,
            on: on.clone(),
            ..Layer::clone(layer)
        };
        if layer.id == id {
            let is_paint = matches!(layer.content, Content::Pixels(_));
            return Some(Arc::new(if is_paint {
                bare()
            } else {
                Layer { on: on.clone(), ..Layer::clone(layer) }
            }));
        }
        let inner = isolate(&layer.content.group()?.layers, id, is_attached_alike)?;
        let content = Content::Group(Group { layers: vec![inner], pass_through: true });
        // What is kept of the whole group is of no use.
        Some(Arc::new(Layer { content, cache: LayerCache::default(), ..bare() }))
    })
}

/// What layers drew, kept while outlines are found: many parts ask for one drawing.
#[derive(Default)]
pub struct LastDrawn(Mutex<Vec<(DrawnLayer, TileGrid)>>);

impl LastDrawn {
    /// More are not kept.
    const MOST: usize = 8;

    fn lock(&self) -> MutexGuard<'_, Vec<(DrawnLayer, TileGrid)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn get(&self, drawn: &DrawnLayer) -> Option<TileGrid> {
        self.lock().iter().find(|(known, _)| known.is_same(drawn)).map(|(_, tiles)| tiles.clone())
    }

    fn keep(&self, drawn: &DrawnLayer, tiles: &TileGrid) {
        let mut known = self.lock();
        if known.len() >= Self::MOST {
            known.remove(0);
        }
        known.push((drawn.clone(), tiles.clone()));
    }

    fn forget(&self) {
        self.lock().clear();
    }
}

impl Parts {
    /// Drops what was found while outlines were: it is large, and an edit of the drawing needs it
    /// anew.
    pub(super) fn forget_drawn(&self) {
        self.forget_flats();
        self.cache.drawn.forget();
    }
}

#[cfg(test)]
mod tests;
