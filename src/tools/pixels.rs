//! Strokes on paint layers: a stroke's tiles laid over, or taken out of, those of the layer.
//! Floor 5. Not here: what a stroke looks like (`paint::stroke`), layers (`brush`).

use crate::paint::{Scene, Stroke, stroke};
use crate::raster::{Coverage, Mix, Paint, PlanarTile, Tile, TileAt, TileGrid};
use rayon::prelude::*;
use std::sync::Arc;

/// What a stroke does to the pixels it covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    Over,
    /// Only where there is paint already, whose coverage stays.
    Atop,
    Erase,
}

/// The layer's pixels with a stroke on some of its tiles; elsewhere those of `shown`.
pub fn painted(
    base: &TileGrid,
    shown: &TileGrid,
    stroke: &Arc<Stroke>,
    scene: &Scene,
    effect: Effect,
    tiles: &[TileAt],
) -> TileGrid {
    let one = std::slice::from_ref(stroke);
    let made: Vec<_> =
        tiles.par_iter().map(|&at| tile(base.tile(at), stroke::render_tile(one, scene, at), effect)).collect();
    let mut grid = shown.clone();
    grid.reserve(scene.size.rect());
    tiles.iter().zip(made).for_each(|(&at, tile)| grid.set(at, tile));
    grid
}

fn tile(base: Option<&Arc<Tile>>, paint: Option<Tile>, effect: Effect) -> Option<Arc<Tile>> {
    let Some(paint) = paint else { return base.cloned() };
    match (base, effect) {
        (None, Effect::Over) => Some(Arc::new(paint)),
        (None, _) => None,
        (Some(base), Effect::Erase) => erased(base, &paint).map(Arc::new),
        (Some(base), _) => {
            let mut pixels = PlanarTile::transparent();
            let full = Coverage::uniform(1.0);
            pixels.blend(Mix::default(), Paint::Bytes(base), &full);
            pixels.blend(Mix { atop: effect == Effect::Atop, ..Mix::default() }, Paint::Bytes(&paint), &full);
            pixels.quantised().map(Arc::new)
        }
    }
}

/// Destination out: every channel times 1 − the stroke's alpha, rounded to nearest.
fn erased(base: &Tile, paint: &Tile) -> Option<Tile> {
    let mut bytes = base.bytes().to_vec();
    for (to, from) in bytes.chunks_exact_mut(4).zip(paint.bytes().chunks_exact(4)) {
        let left = 255 - u32::from(from[3]);
        for v in to {
            *v = ((u32::from(*v) * left + 127) / 255) as u8;
        }
    }
    Tile::from_pixels(bytes)
}
