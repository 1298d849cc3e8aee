//! The brush tool: a stroke is a list of dabs, each a footprint bent around its own centre (SF sec. 5.2, fig. 7).
//! Floor 3. Not here: dabs from samples (`laying`), one dab on a tile (`dab`).

use super::brush::{Brush, Tip};
use super::dab::{DabScratch, PlacedDab, round_extent};
use super::laying::{self, Dab};
use super::scene::Scene;
use super::stamp::{Stamp, Stamps};
use super::tint;
use super::wash::{Manner, Wash};
use crate::math::{Rect, Vec2, srgb::Color};
use crate::raster::{PlanarTile, Tile, TileAt};
use crate::surface::Operator;
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
    tip: LaidTip,
    dabs: Vec<Dab>,
    tiles: HashMap<TileAt, Vec<Range<u32>>>,
}

/// A brush's tip, made ready.
enum LaidTip {
    Round,
    Stamp(Arc<Stamp>),
}

impl LaidTip {
    fn of(brush: &Brush) -> Self {
        match &brush.tip {
            Tip::Round => Self::Round,
            Tip::Picture(source) => Self::Stamp(Stamps::of(source, brush.softness.max(0.0).min(1.0))),
        }
    }
    fn place<'s>(&self, dab: Dab, scene: &'s Scene) -> PlacedDab<'s> {
        let extent = match self {
            Self::Round => round_extent(&dab),
            Self::Stamp(stamp) => stamp.extent(&dab),
        };
        PlacedDab::new(dab, scene, extent)
    }
    fn brings_colors(&self) -> bool {
        matches!(self, Self::Stamp(stamp) if stamp.is_colored)
    }
}

/// Dabs this near in the stroke's order share a run even if those between them miss the tile.
const RUN_GAP: u32 = 8;
/// Runs a tile: beyond, the last one grows. Bounds what a hostile stroke takes.
const MAX_RUNS: usize = 1024;

impl Laid {
    fn new(stroke: &Stroke, scene: &Scene) -> Self {
        let tip = LaidTip::of(&stroke.brush);
        let dabs = laying::dabs(&stroke.brush, stroke.operator, stroke.color, &stroke.samples, scene);
        let mut tiles: HashMap<TileAt, Vec<Range<u32>>> = HashMap::new();
        for (i, dab) in (0..).zip(&dabs) {
            tip.place(*dab, scene).reach().for_each_tile(|at| {
                let runs = tiles.entry(at).or_default();
                let is_full = runs.len() >= MAX_RUNS;
                match runs.last_mut() {
                    Some(run) if is_full || i - run.end <= RUN_GAP => run.end = i + 1,
                    _ => runs.push(i..i + 1),
                }
            });
        }
        Self { scene: scene.clone(), tip, dabs, tiles }
    }
    /// The dabs that may touch a tile, in their order.
    fn on_tile(&self, at: TileAt) -> impl Iterator<Item = &Dab> {
        let runs = self.tiles.get(&at).into_iter().flatten();
        runs.flat_map(|run| &self.dabs[run.start as usize..run.end as usize])
    }
}

impl Stroke {
    /// Paints the stroke over a tile in flight. Flow is per dab; opacity caps the whole.
    fn paint(&self, scene: &Scene, at: TileAt, pixels: &mut PlanarTile, scratch: &mut DabScratch) {
        let laid = self.laid(scene);
        let brings_colors = laid.tip.brings_colors() || tint::varies(&self.brush);
        let mut wash = if brings_colors { Wash::colors() } else { Wash::one_color() };
        for dab in laid.on_tile(at) {
            let placed = laid.tip.place(*dab, scene);
            match &laid.tip {
                LaidTip::Round => placed.add_round(at, &mut wash, scratch),
                LaidTip::Stamp(stamp) => placed.add_stamp(stamp, at, &mut wash, scratch),
            }
        }
        let Brush { opacity, blend, erases, keeps_alpha, .. } = self.brush;
        let opacity = opacity.max(0.0).min(1.0);
        wash.lay_over(pixels, Manner { color: self.color, opacity, mode: blend, erases, keeps_alpha });
    }
}

/// One tile of a stroke layer, the first stroke lowest. `None` where it is transparent.
///
/// Each stroke accumulates in f32; the tile is quantised once.
pub fn render_tile(strokes: &[Arc<Stroke>], scene: &Scene, at: TileAt) -> Option<Tile> {
    let mut here = strokes.iter().filter(|s| s.touches(scene, at)).peekable();
    here.peek()?;
    let (mut pixels, mut scratch) = (PlanarTile::transparent(), DabScratch::default());
    here.for_each(|stroke| stroke.paint(scene, at, &mut pixels, &mut scratch));
    pixels.quantised()
}

#[cfg(test)]
mod tests;
