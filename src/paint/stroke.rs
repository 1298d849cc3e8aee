//! The brush tool: a stroke is a list of dabs, each a footprint bent around its own centre (SF sec. 5.2, fig. 7).
//! Floor 3. Not here: dabs from samples (`path`), one dab on a tile (`dab`).

use super::brush::Brush;
use super::dab::{PlacedDab, round_extent};
use super::path::{self, Dab};
use super::scene::Scene;
use crate::math::{Rect, Vec2, srgb::Color};
use crate::raster::tile::{TILE_AREA, TileF32, transparent_f32};
use crate::raster::{Tile, TileAt};
use crate::surface::Operator;
use crate::surface::deformation::DeformedRect;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// One reading of the pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Canvas px.
    pub at: Vec2,
    /// `[0, 1]`.
    pub pressure: f32,
    /// Degrees from upright, right and down positive.
    pub tilt: Vec2,
    /// Since the stroke began.
    pub time_secs: f32,
}

impl Sample {
    /// A sample as a mouse gives it: full pressure, upright.
    pub fn at(at: Vec2) -> Self {
        Self { at, pressure: 1.0, tilt: Vec2::ZERO, time_secs: 0.0 }
    }
}

/// One stroke of a stroke layer. Never changed once made: the dabs found from it are kept beside it.
#[derive(Clone)]
pub struct Stroke {
    brush: Brush,
    operator: Operator,
    color: Color,
    samples: Vec<Sample>,
    laid: Arc<Mutex<Option<Arc<Laid>>>>,
}

impl Stroke {
    pub fn new(brush: Brush, operator: Operator, color: Color, samples: Vec<Sample>) -> Self {
        Self { brush, operator, color, samples, laid: Arc::default() }
    }
    pub fn brush(&self) -> &Brush {
        &self.brush
    }
    pub fn operator(&self) -> Operator {
        self.operator
    }
    /// The colour of one-colour tips; of a stamp only its alpha counts.
    pub fn color(&self) -> Color {
        self.color
    }
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }
    /// The pixels that the stroke can touch on a canvas, in whole tiles; never fewer.
    pub fn bounds(&self, scene: &Scene) -> Rect {
        let laid = self.laid(scene);
        laid.tiles.keys().fold(Rect::EMPTY, |r, at| r.union(at.rect())).intersect(scene.size.rect())
    }
    /// The stroke may paint on a tile.
    pub fn touches(&self, scene: &Scene, at: TileAt) -> bool {
        self.laid(scene).tiles.contains_key(&at)
    }
    /// The stroke's dabs on a canvas, found once.
    fn laid(&self, scene: &Scene) -> Arc<Laid> {
        let lock = || self.laid.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(laid) = lock().as_ref().filter(|laid| laid.scene.is_same(scene)) {
            return laid.clone();
        }
        // Unlocked: two threads may both find them, and find the same.
        let laid = Arc::new(Laid::new(self, scene));
        *lock() = Some(laid.clone());
        laid
    }
}

/// A stroke's dabs, and which of them may touch which tile of a canvas.
struct Laid {
    scene: Scene,
    dabs: Vec<Dab>,
    tiles: HashMap<TileAt, Vec<Range<u32>>>,
}

/// Dabs this near in the stroke's order share a run even if those between them miss the tile.
const RUN_GAP: u32 = 8;
/// Runs a tile: beyond, the last one grows. Bounds what a hostile stroke takes.
const MAX_RUNS: usize = 1024;

impl Laid {
    fn new(stroke: &Stroke, scene: &Scene) -> Self {
        let dabs = path::dabs(&stroke.brush, &stroke.samples);
        let mut tiles: HashMap<TileAt, Vec<Range<u32>>> = HashMap::new();
        for (i, dab) in (0..).zip(&dabs) {
            stroke.placed(*dab, scene).reach().for_each_tile(|at| {
                let runs = tiles.entry(at).or_default();
                let is_full = runs.len() >= MAX_RUNS;
                match runs.last_mut() {
                    Some(run) if is_full || i - run.end <= RUN_GAP => run.end = i + 1,
                    _ => runs.push(i..i + 1),
                }
            });
        }
        Self { scene: scene.clone(), dabs, tiles }
    }
    /// The dabs that may touch a tile, in their order.
    fn on_tile(&self, at: TileAt) -> impl Iterator<Item = &Dab> {
        let runs = self.tiles.get(&at).into_iter().flatten();
        runs.flat_map(|run| &self.dabs[run.start as usize..run.end as usize])
    }
}

impl Stroke {
    fn placed<'s>(&self, dab: Dab, scene: &'s Scene) -> PlacedDab<'s> {
        PlacedDab::new(dab, self.operator, scene, round_extent(&dab))
    }
    /// Paints the stroke over a tile in flight. Flow is per dab; opacity caps the whole.
    fn paint(&self, scene: &Scene, at: TileAt, pixels: &mut TileF32, scratch: &mut Scratch) {
        let laid = self.laid(scene);
        scratch.coverage.fill(0.0);
        for dab in laid.on_tile(at) {
            self.placed(*dab, scene).add_round(at, &mut scratch.coverage, &mut scratch.deformed);
        }
        let opacity = self.brush.opacity.max(0.0).min(1.0);
        compose(self.color.premultiplied().map(|c| c * opacity), &scratch.coverage, pixels);
    }
}

/// Buffers of a tile's strokes, used again and again.
struct Scratch {
    coverage: Box<[f32; TILE_AREA]>,
    deformed: DeformedRect,
}

/// One tile of a stroke layer, the first stroke lowest. `None` where it is transparent.
///
/// Each stroke accumulates in f32; the tile is quantised once.
pub fn render_tile(strokes: &[Arc<Stroke>], scene: &Scene, at: TileAt) -> Option<Tile> {
    let mut here = strokes.iter().filter(|s| s.touches(scene, at)).peekable();
    here.peek()?;
    let mut pixels = transparent_f32();
    let mut scratch = Scratch { coverage: Box::new([0.0; TILE_AREA]), deformed: DeformedRect::default() };
    here.for_each(|stroke| stroke.paint(scene, at, &mut pixels, &mut scratch));
    Tile::quantised(&pixels)
}

crate::widest! {
    /// Lays one premultiplied colour over pixels, as far as each is covered (source over).
    fn compose(color: [f32; 4], coverage: &[f32; TILE_AREA], pixels: &mut TileF32) {
        for (p, a) in pixels.iter_mut().zip(coverage) {
            let rest = 1.0 - color[3] * a;
            for c in 0..4 {
                p[c] = color[c] * a + p[c] * rest;
            }
        }
    }
}

#[cfg(test)]
mod tests;
