//! The brush tool: a stroke is a list of dabs, each a footprint bent around its own center (SF sec.
//! 5.2, fig. 7). Floor 3. Not here: dabs from samples (`dab_walker`), one dab on a tile (`dab`).

mod active;
pub(super) mod dabs;
mod many;

pub use active::{ActiveStrokes, Backdrop};
pub use many::{are_heavy, render_many, render_tiles};

use super::attachment::StrokeAttachment;
use super::brush::Brush;
use super::dab::DabScratch;
use super::dab_walker;
use super::sample::Sample;
use super::scene::Scene;
use super::selection::StrokeSelection;
use super::stroke_tile::StrokeBlend;
use crate::math::{Rect, Vec2, srgb::Color};
use crate::memory::{CacheReservation, DABS};
use crate::raster::{PlanarTile, Tile, TileAt};
use crate::surface::Operator;
use crate::surface::objects::CanvasPart;
use dabs::{StrokeDabs, TileReach};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// One stroke of a stroke layer. It is never changed, so the tiles it touches are cached with it,
/// and so are its dabs as long as those of all strokes stay below a limit.
#[derive(Clone)]
pub struct Stroke {
    brush: Brush,
    operator: Operator,
    color: Color,
    samples: Vec<Sample>,
    /// Where it may paint; absent: everywhere.
    selection: Option<StrokeSelection>,
    /// Its attachment, if it differs from its layer's.
    attachment: Option<Arc<StrokeAttachment>>,
    found: Arc<Mutex<StrokeCache>>,
}

/// What was computed for a stroke on a canvas.
#[derive(Default)]
struct StrokeCache {
    stroke_dabs: Option<(Arc<StrokeDabs>, CacheReservation)>,
    support: Option<Arc<TileReach>>,
    /// Bounds that were known before the dabs: active strokes know theirs.
    bounds: Option<(Scene, Rect)>,
}

impl Stroke {
    /// The most samples of a stroke: over an hour of a pen that is read 240 times a second.
    pub const MOST_SAMPLES: usize = 1_000_000;

    /// The stroke of a brush along the samples of a pen, each dab bent by an operator around its
    /// own center.
    pub fn new(brush: Brush, operator: Operator, color: Color, samples: Vec<Sample>) -> Self {
        Self {
            brush,
            operator,
            color,
            samples,
            selection: None,
            attachment: None,
            found: Arc::default(),
        }
    }

    /// The same stroke within a selection, or within none.
    pub fn within(self, selection: Option<StrokeSelection>) -> Self {
        Self { selection, ..self }
    }

    /// The same stroke with the same appearance, on another attachment.
    pub fn on(self, attachment: Option<Arc<StrokeAttachment>>) -> Self {
        Self { attachment, ..self }
    }

    /// A copy on an attachment in another position.
    pub fn with_moved_attachment(&self, attachment: Arc<StrokeAttachment>) -> Self {
        Self { attachment: Some(attachment), ..self.clone() }
    }

    /// Its own attachment, if that differs from its layer's.
    pub fn attachment(&self) -> Option<&Arc<StrokeAttachment>> {
        self.attachment.as_ref()
    }

    /// The brush that it was painted with.
    pub fn brush(&self) -> &Brush {
        &self.brush
    }

    /// How its dabs are bent.
    pub fn operator(&self) -> Operator {
        self.operator
    }

    /// The color of one-color tips; for a stamp only its alpha counts.
    pub fn color(&self) -> Color {
        self.color
    }

    /// The path of the pen.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The selection that it was painted in.
    pub fn selection(&self) -> Option<&StrokeSelection> {
        self.selection.as_ref()
    }

    /// The pixels that the stroke can touch on a canvas, in whole tiles; never fewer.
    pub fn bounds(&self, scene: &Scene) -> Rect {
        let known = self
            .lock_cache()
            .bounds
            .as_ref()
            .filter(|(on, _)| on.is_same(scene))
            .map(|(_, bounds)| *bounds);
        known.unwrap_or_else(|| self.support(scene).bounds()).intersect(scene.size.rect())
    }

    /// Whether the stroke may paint on a tile.
    pub fn can_touch(&self, scene: &Scene, at: TileAt) -> bool {
        self.support(scene).can_touch(at)
    }

    /// The tiles of a canvas that the stroke touches, computed once.
    fn support(&self, scene: &Scene) -> Arc<TileReach> {
        if let Some(support) = self.known_support(scene) {
            return support;
        }
        let stroke_dabs = self.stroke_dabs(scene);
        self.known_support(scene).unwrap_or_else(|| Arc::new(stroke_dabs.support()))
    }

    /// The stroke's dabs on a canvas, computed again if they were not cached.
    fn stroke_dabs(&self, scene: &Scene) -> Arc<StrokeDabs> {
        if let Some((stroke_dabs, _)) = self
            .lock_cache()
            .stroke_dabs
            .as_ref()
            .filter(|(stroke_dabs, _)| stroke_dabs.is_on(scene))
        {
            return stroke_dabs.clone();
        }
        // Without the lock: two threads may both compute them; the results are equal.
        let stroke_dabs = Arc::new(StrokeDabs::of(self, scene));
        self.lock_cache().keep(&stroke_dabs);
        stroke_dabs
    }

    /// Where it lies, if that is known already.
    fn known_support(&self, scene: &Scene) -> Option<Arc<TileReach>> {
        self.lock_cache().support.clone().filter(|support| support.is_on(scene))
    }

    /// Roughly the most dabs it can have, without placing them: at the densest possible spacing.
    fn most_dabs(&self, scene: &Scene) -> usize {
        if let Some(support) = self.known_support(scene) {
            return support.dabs;
        }
        let ways = self.samples.windows(2).map(|pair| pair[0].at.distance(pair[1].at));
        let way_px: f32 = ways.filter(|way| way.is_finite()).sum();
        let secs = self.samples.last().map_or(0.0, |last| last.time_secs)
            - self.samples.first().map_or(0.0, |s| s.time_secs);
        let second = self.brush.second();
        dab_walker::most_dabs(&self.brush, way_px, secs).saturating_add(
            second.map_or(0, |(second, _)| dab_walker::most_dabs(&second, way_px, secs)),
        )
    }

    /// Whether its dabs on a canvas are cached.
    fn is_laid(&self, scene: &Scene) -> bool {
        self.lock_cache()
            .stroke_dabs
            .as_ref()
            .is_some_and(|(stroke_dabs, _)| stroke_dabs.is_on(scene))
    }

    fn lock_cache(&self) -> MutexGuard<'_, StrokeCache> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl StrokeCache {
    /// Caches the tiles of a stroke, and its dabs if there is room.
    fn keep(&mut self, stroke_dabs: &Arc<StrokeDabs>) {
        // Releases what it held before it reserves again.
        self.stroke_dabs = None;
        self.support = Some(Arc::new(stroke_dabs.support()));
        self.stroke_dabs =
            DABS.reserve(stroke_dabs.bytes()).map(|kept| (stroke_dabs.clone(), kept));
    }
}

impl Stroke {
    /// Paints the stroke with the given dabs over a tile. Flow applies per dab; opacity caps the
    /// whole stroke.
    fn paint(
        &self,
        stroke_dabs: &StrokeDabs,
        scene: &Scene,
        at: TileAt,
        pixels: &mut PlanarTile,
        scratch: &mut DabScratch,
    ) {
        let selected = match &self.selection {
            None => None,
            // Where nothing is selected nothing is painted.
            Some(selection) => match selection.tile(at) {
                None => return,
                tile => tile,
            },
        };
        let mut stroke_tile = stroke_dabs.paint_tile(scene, at, scratch);
        match scene.as_far_side() {
            None => {
                stroke_tile.limit_to(&self.part(scene), at);
                if let Some(selected) = selected {
                    stroke_tile.select(&selected);
                }
            }
            Some(far) => {
                let part = self.part(&scene.front());
                stroke_tile.limit_far_side(&part, selected.as_deref(), far, at);
            }
        }
        stroke_tile.blend_over(pixels, at, self.manner());
    }

    /// The part of the canvas that the stroke may touch.
    fn part(&self, scene: &Scene) -> CanvasPart {
        let start = self.samples.first().map_or(Vec2::ZERO, |sample| sample.at);
        self.brush.bounded.from(scene.surface.as_ref(), start)
    }

    fn manner(&self) -> StrokeBlend {
        StrokeBlend::of(&self.brush, self.color)
    }
}

/// One tile of a stroke layer, the first stroke lowest. `None` if it is transparent.
///
/// Each stroke accumulates in f32; the tile is quantized once.
pub fn render_tile(strokes: &[Arc<Stroke>], scene: &Scene, at: TileAt) -> Option<Tile> {
    render_pixels(strokes, scene, at)?.quantize()
}

/// The same before it is quantized; `None` if no stroke touches the tile.
pub fn render_pixels(strokes: &[Arc<Stroke>], scene: &Scene, at: TileAt) -> Option<PlanarTile> {
    let front = scene.front();
    let mut here = strokes.iter().filter(|s| s.can_touch(&front, at)).peekable();
    here.peek()?;
    let (mut pixels, mut scratch) = (PlanarTile::transparent(), DabScratch::default());
    here.for_each(|stroke| {
        stroke.paint(&stroke.stroke_dabs(&front), scene, at, &mut pixels, &mut scratch)
    });
    Some(pixels)
}

#[cfg(test)]
mod tests;
