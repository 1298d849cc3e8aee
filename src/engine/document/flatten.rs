//! Flattening: composes the layers of a document into one picture, tile by tile, in f32, quantized
//! once. Floor 4. Tiles are independent, so they are composed in parallel, and the bytes do not
//! depend on the number of threads.

pub mod singles;

use super::compose::Composer;
use super::far_side::FarTile;
use super::floats::{FloatTiles, Highlights};
use super::progress::in_parallel;
use super::{Content, Document, Group, Layer, LayerId, PreparedDocument, Progress, mask};
use crate::memory::fill_or_unwind;
use crate::raster::{PlanarTile, Tile, TileAt, TileGrid};
use std::sync::Arc;

/// Flattens the whole document; `None` if canceled.
pub fn flatten(document: &Document, progress: &Progress) -> Option<TileGrid> {
    let prepared = PreparedDocument::new(document, progress)?;
    prepared.flatten_tiles(&TileGrid::default(), &prepared.all_tiles(), progress)
}

/// Tiles in f32 that are held besides a picture that is composed in floats.
const FLOATS_AT_A_TIME: usize = 256;

/// Flattens the whole document without rounding to bytes: premultiplied, sRGB-encoded, row by row;
/// colors are above their alpha where `highlights` are kept. `None` if canceled.
pub fn flatten_to_floats(
    document: &Document,
    highlights: Highlights,
    progress: &Progress,
) -> Option<Vec<[f32; 4]>> {
    let prepared = PreparedDocument::new(document, progress)?;
    let tiles = prepared.all_tiles();
    let mut floats = FloatTiles::new(&prepared, highlights);
    let canvas = document.size.rect();
    let mut pixels = fill_or_unwind(document.size.area(), [0.0; 4]);
    for part in tiles.chunks(FLOATS_AT_A_TIME) {
        floats.render(&prepared, part, progress);
        prepared.filter_beneath(part, usize::MAX, Some(&floats), progress)?;
        let composed = in_parallel(part, progress, |at| prepared.compose_tile(at, Some(&floats)))?;
        for (at, tile) in part.iter().zip(composed) {
            let (rect, inside) = (at.rect(), at.rect().intersect(canvas));
            for (y, row) in (inside.y0..inside.y1).zip(tile.rows()) {
                let start = y as usize * canvas.width() + rect.x0 as usize;
                let onto = pixels.iter_mut().skip(start).take(inside.width());
                onto.enumerate().for_each(|(x, pixel)| *pixel = row.pixel(x));
            }
        }
    }
    Some(pixels)
}

/// Flattens the whole document to bytes that are rounded once, at the end: live layers are composed
/// in floats. As [`flatten`] where rounding them in between changes nothing by more than two
/// levels. `None` if canceled.
pub fn flatten_rounding_once(document: &Document, progress: &Progress) -> Option<TileGrid> {
    if !document.is_rounding_visible() {
        return flatten(document, progress);
    }
    let prepared = PreparedDocument::new(document, progress)?;
    flatten_in_floats(&prepared, document, progress, |at, floats| {
        prepared.compose_tile(at, Some(floats)).quantize().map(Arc::new)
    })
}

/// A tile at a time of what is composed in floats.
fn flatten_in_floats(
    prepared: &PreparedDocument,
    document: &Document,
    progress: &Progress,
    tile: impl Fn(TileAt, &FloatTiles) -> Option<Arc<Tile>> + Sync,
) -> Option<TileGrid> {
    let tiles = prepared.all_tiles();
    let mut floats = FloatTiles::new(prepared, Highlights::Clipped);
    let mut grid = TileGrid::for_rect(document.size.rect());
    for part in tiles.chunks(FLOATS_AT_A_TIME) {
        floats.render(prepared, part, progress);
        prepared.filter_beneath(part, usize::MAX, Some(&floats), progress)?;
        let composed = in_parallel(part, progress, |at| tile(at, &floats))?;
        part.iter().zip(composed).for_each(|(at, tile)| grid.set(*at, tile));
    }
    Some(grid)
}

/// Flattens the whole document to what a paint layer holds: composed without rounding live layers,
/// with 16 bits where it is soft ([`PlanarTile::to_tile_over`]), and where placed pictures of more than 8
/// are seen. `None` if canceled.
pub fn flatten_to_paint(document: &Document, progress: &Progress) -> Option<TileGrid> {
    render_to_paint(&PreparedDocument::new(document, progress)?, document, progress)
}

/// The same for what will be clipped to the surface: layers that are displaced show there what they
/// show when they are clipped themselves.
pub fn flatten_to_be_clipped(document: &Document, progress: &Progress) -> Option<TileGrid> {
    render_to_paint(&PreparedDocument::to_be_clipped(document, progress)?, document, progress)
}

fn render_to_paint(
    prepared: &PreparedDocument,
    document: &Document,
    progress: &Progress,
) -> Option<TileGrid> {
    // Tiles that are not soft are composed of bytes.
    prepared.filter_tiles(&prepared.all_tiles(), progress)?;
    flatten_in_floats(prepared, document, progress, |at, floats| prepared.paint_tile(at, floats))
}

/// Flattens one layer alone, shown or not, on transparency: its own opacity and mask, not those of
/// the groups around it. It sees the same surface as in the document. `None` if canceled or if
/// there is no such layer.
pub fn flatten_layer(document: &Document, id: LayerId, progress: &Progress) -> Option<TileGrid> {
    flatten_layers(document, &[id], progress)
}

/// As [`flatten_layer`], for some layers of one list composed with each other. A layer stays
/// clipped if its base is among them.
pub fn flatten_layers(
    document: &Document,
    ids: &[LayerId],
    progress: &Progress,
) -> Option<TileGrid> {
    flatten(&without_others(document, ids)?, progress)
}

/// The same with pixels on the surface's rim wholly covered: a mask of `Surface::shares` around it
/// cuts it to the same picture.
pub fn flatten_whole(
    document: &Document,
    ids: &[LayerId],
    progress: &Progress,
) -> Option<TileGrid> {
    let document = without_others(document, ids)?;
    let mut prepared = PreparedDocument::new(&document, progress)?;
    prepared.make_rims_whole();
    prepared.flatten_tiles(&TileGrid::default(), &prepared.all_tiles(), progress)
}

impl Document {
    /// With some layers of one list alone, shown or not, without the opacity and masks of the
    /// groups around them; `None` if there are none of them. They see the surface of this document,
    /// from which nothing is made again: it has no parts.
    pub fn with_only(&self, ids: &[LayerId]) -> Option<Document> {
        Some(Document {
            layers: isolate(&self.layers, ids, true)?,
            parts: Arc::default(),
            ..self.clone()
        })
    }
}

/// The same without the hidden ones, which parts may be made of: to be seen, not to be shaped
/// again.
fn without_others(document: &Document, ids: &[LayerId]) -> Option<Document> {
    Some(Document { layers: isolate(&document.layers, ids, false)?, ..document.clone() })
}

/// The layers with all hidden except some, or without those; `None` if none of the wanted ones is
/// among them.
fn isolate(layers: &[Arc<Layer>], ids: &[LayerId], keeps_hidden: bool) -> Option<Vec<Arc<Layer>>> {
    let (mut found, mut base_is_shown) = (false, false);
    let shown = layers.iter().filter_map(|layer| {
        let is_shown = ids.contains(&layer.id);
        let clip_below = layer.clip_below && base_is_shown;
        if !layer.clip_below && !layer.content.is_shaping_surface() {
            base_is_shown = is_shown;
        }
        if is_shown {
            found = true;
            return Some(Arc::new(Layer { visible: true, clip_below, ..Layer::clone(layer) }));
        }
        let inner =
            layer.content.group().and_then(|group| isolate(&group.layers, ids, keeps_hidden));
        if let Some(layers) = inner {
            found = true;
            let content = Content::Group(Group { layers, pass_through: true });
            let next = Layer {
                visible: true,
                opacity: 1.0,
                mask: None,
                clip_below,
                ..Layer::clone(layer)
            };
            return Some(Arc::new(Layer { content, ..next }));
        }
        let shapes = layer.content.is_shaping_surface();
        (shapes || keeps_hidden).then(|| {
            Arc::new(Layer { visible: layer.visible && shapes, clip_below, ..Layer::clone(layer) })
        })
    });
    let shown = shown.collect();
    found.then_some(shown)
}

impl PreparedDocument {
    /// Composes one tile; `None` where it is transparent.
    pub fn flatten_tile(&self, at: TileAt) -> Option<Arc<Tile>> {
        self.sole_tile(at).or_else(|| self.compose_tile(at, None).quantize().map(Arc::new))
    }

    /// The tile of the topmost layer where nothing else is seen: what composing would give, to the
    /// byte.
    fn sole_tile(&self, at: TileAt) -> Option<Arc<Tile>> {
        if self.contours.as_ref().is_some_and(|contours| contours.on(at).is_some()) {
            return None;
        }
        Composer { prepared: self, at, far: None, sought: None, floats: None }
            .only_tile(&self.stack)
    }

    /// Every tile is that of the one layer, a fill that nothing cuts: tiles can share their pixels.
    fn is_one_color(&self) -> bool {
        let [node] = &self.stack[..] else { return false };
        let is_whole = node.layer.mask.is_none() && mask::clip(node).is_none();
        let is_alone = node.clipped.is_empty()
            && node.warp.is_none()
            && node.effects.is_none()
            && self.contours.is_none();
        matches!(node.layer.content, Content::Fill(_)) && is_whole && is_alone
    }

    /// A tile as a paint layer holds it: as it shows, but with 16 bits where it is soft, or shows a
    /// picture that has them.
    fn paint_tile(&self, at: TileAt, floats: &FloatTiles) -> Option<Arc<Tile>> {
        let alone = self.sole_tile(at).filter(|tile| tile.is_16_bit());
        let was_16_bit = || {
            self.stack.iter().any(|node| node.has_16_bit_paint(at) || node.has_16_bit_picture(at))
        };
        let soft = || {
            self.compose_tile(at, Some(floats))
                .to_tile(was_16_bit())
                .filter(Tile::is_16_bit)
                .map(Arc::new)
        };
        alone.or_else(soft).or_else(|| self.flatten_tile(at))
    }

    fn compose_tile(&self, at: TileAt, floats: Option<&FloatTiles>) -> PlanarTile {
        // No adjustment is sought, so composing runs to its end.
        let composed = |far: Option<FarTile>| {
            let composer = Composer { prepared: self, at, far, sought: None, floats };
            let mut pixels = composer.blank();
            let _ = composer.stack(&self.stack, &mut pixels);
            pixels
        };
        self.with_far_side(at, floats, composed)
    }

    /// A tile as it is composed, with what the other sides of its contour pixels see.
    pub(super) fn with_far_side(
        &self,
        at: TileAt,
        floats: Option<&FloatTiles>,
        composed: impl Fn(Option<FarTile>) -> PlanarTile,
    ) -> PlanarTile {
        let mut pixels = composed(None);
        if let Some(contours) = self.contours.as_ref().and_then(|contours| contours.on(at)) {
            let far = FarTile::new(at, contours);
            let other = composed(Some(far));
            match self.whole_rims {
                false => {
                    far.mix_into(&other, &mut pixels, floats.map_or(1.0, FloatTiles::brightest))
                }
                true => far.take_surface_into(&other, &mut pixels),
            }
        }
        pixels
    }

    /// The picture with some of its tiles composed again; `None` if canceled.
    pub fn flatten_tiles(
        &self,
        old: &TileGrid,
        tiles: &[TileAt],
        progress: &Progress,
    ) -> Option<TileGrid> {
        self.filter_tiles(tiles, progress)?;
        let one = tiles.first().filter(|_| self.is_one_color()).map(|at| self.flatten_tile(*at));
        let tile = |at| one.clone().unwrap_or_else(|| self.flatten_tile(at));
        let composed = in_parallel(tiles, progress, tile)?;
        let mut grid = old.clone();
        grid.reserve(self.size.rect());
        tiles.iter().zip(composed).for_each(|(&at, tile)| grid.set(at, tile));
        Some(grid)
    }
}

#[cfg(test)]
mod tests;
