//! Active strokes: samples go in, and the tiles that they change come out. Each dab is placed and
//! painted once, over what the stroke has painted so far; only the end of the curve, which the next
//! sample may change, is painted again. Floor 3. Not here: the pen (`tools`).

use super::dabs::{StrokeDabs, TOGETHER, for_each_tile_of};
use super::{Sample, Stroke, StrokeCache, render_pixels};
use crate::math::{Rect, Vec2, srgb::Color};
use crate::paint::brush::Brush;
use crate::paint::dab::{DabScratch, PlacedDab};
use crate::paint::dab_walker::{Dab, DabWalker};
use crate::paint::grain::GrainTile;
use crate::paint::scene::Scene;
use crate::paint::selection::StrokeSelection;
use crate::paint::stroke_tile::{StrokeBlend, StrokeTile};
use crate::raster::{PlanarTile, Tile, TileAt, TileGrid};
use crate::surface::Operator;
use crate::surface::objects::CanvasPart;
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex};

/// What active strokes are painted on.
pub enum Backdrop {
    /// A paint layer's pixels.
    Pixels(TileGrid),
    /// The strokes below in a stroke layer.
    Strokes(Vec<Arc<Stroke>>),
}

/// Strokes that are drawn together, the first lowest: one, or one and its mirror images.
///
/// Their pixels do not depend on how the samples are batched: they equal those of the finished
/// strokes painted at once. They take 16 KiB for every tile that a stroke touches (64 if its dabs
/// vary in color), and 64 more if there are strokes below.
pub struct ActiveStrokes {
    scene: Scene,
    backdrop: Backdrop,
    strokes: Vec<ActiveStroke>,
    tiles: HashMap<TileAt, ActiveTile>,
}

/// One active stroke.
struct ActiveStroke {
    brush: Brush,
    operator: Operator,
    color: Color,
    samples: Vec<Sample>,
    selection: Option<StrokeSelection>,
    walker: DabWalker,
    /// The settled dabs.
    stroke_dabs: StrokeDabs,
    /// Where the last tail was shown.
    tail: Vec<TileAt>,
    bounds: Rect,
}

/// A tile under active strokes.
struct ActiveTile {
    /// The strokes below, once they were painted.
    beneath: Option<PlanarTile>,
    /// The settled dabs of each active stroke.
    stroke_tiles: Vec<Option<StrokeTile>>,
    /// What their grains leave of each pixel.
    grains: Vec<Option<Arc<GrainTile>>>,
    /// What was shown last, if there was paint of theirs.
    shown: Option<Option<Arc<Tile>>>,
}

/// What a batch of samples adds to one stroke.
struct NewDabs<'s> {
    dabs: Vec<PlacedDab<'s>>,
    /// The number of them that no later sample changes.
    settled: usize,
    /// Those that may touch a tile, in order.
    tiles: BTreeMap<TileAt, Vec<usize>>,
}

impl ActiveStroke {
    fn new(stroke: &Stroke, scene: &Scene) -> Self {
        let Stroke { brush, operator, color, selection, .. } = stroke;
        Self {
            brush: brush.clone(),
            operator: *operator,
            color: *color,
            samples: Vec::new(),
            selection: selection.clone(),
            walker: DabWalker::new(brush, *operator, *color, scene),
            stroke_dabs: StrokeDabs::empty(brush, scene),
            tail: Vec::new(),
            bounds: Rect::EMPTY,
        }
    }

    /// Places the dabs that the samples settle, and the tail behind them.
    fn take<'s>(&mut self, samples: &[Sample], scene: &'s Scene) -> NewDabs<'s> {
        self.samples.extend_from_slice(samples);
        self.stroke_dabs.begin(&self.brush, &self.samples);
        let mut dabs = Vec::new();
        samples.iter().for_each(|sample| self.walker.push(sample, &mut dabs));
        let settled = dabs.len();
        dabs.extend(self.walker.tail());
        let stroke_dabs = &self.stroke_dabs;
        let place = |dabs: &[Dab]| {
            let placed: Vec<_> = dabs.iter().map(|dab| stroke_dabs.place(*dab, scene)).collect();
            let mut tiles = vec![Vec::new(); placed.len()];
            for_each_tile_of(&placed, |i, at| tiles[i].push(at));
            placed.into_iter().zip(tiles).collect::<Vec<_>>()
        };
        let placed: Vec<_> = dabs.par_chunks(TOGETHER).flat_map_iter(place).collect();
        self.tail.clear();
        let mut fresh =
            NewDabs { dabs: Vec::with_capacity(placed.len()), settled, tiles: BTreeMap::new() };
        for (i, (placed, tiles)) in placed.into_iter().enumerate() {
            for &at in &tiles {
                fresh.tiles.entry(at).or_default().push(i);
                self.bounds = self.bounds.union(at.rect());
            }
            match i < settled {
                true => self.stroke_dabs.push(dabs[i], &tiles),
                false => self.tail.extend(tiles),
            }
            fresh.dabs.push(placed);
        }
        fresh
    }

    /// The stroke tile to be shown: with the tail. Settled dabs are added to `stroke_tile` for
    /// good. `None` where there is no paint.
    fn compose_shown(
        &self,
        fresh: &NewDabs,
        at: TileAt,
        (stroke_tile, grain): (&mut Option<StrokeTile>, &mut Option<Arc<GrainTile>>),
        scratch: &mut DabScratch,
    ) -> Option<StrokeTile> {
        let here = fresh.tiles.get(&at).map_or(&[][..], Vec::as_slice);
        let (settled, tail) = here.split_at(here.partition_point(|&i| i < fresh.settled));
        if grain.is_none() && !here.is_empty() {
            *grain = self.stroke_dabs.grain(self.stroke_dabs.scene(), at);
        }
        let empty = || self.stroke_dabs.stroke_tile(grain.clone());
        let mut add = |dabs: &[usize], stroke_tile: &mut StrokeTile| {
            dabs.iter()
                .for_each(|&i| self.stroke_dabs.add(&fresh.dabs[i], at, stroke_tile, scratch));
        };
        if !settled.is_empty() {
            add(settled, stroke_tile.get_or_insert_with(empty));
            stroke_tile.take_if(|stroke_tile| stroke_tile.is_clear());
        }
        if tail.is_empty() {
            return stroke_tile.clone();
        }
        let mut shown = stroke_tile.clone().unwrap_or_else(empty);
        add(tail, &mut shown);
        Some(shown).filter(|shown| !shown.is_clear())
    }

    fn part(&self, scene: &Scene) -> CanvasPart {
        let start = self.samples.first().map_or(Vec2::ZERO, |sample| sample.at);
        self.brush.bounded.from(scene.surface.as_ref(), start)
    }

    /// The stroke as drawn so far.
    fn stroke(&self, scene: &Scene) -> Stroke {
        let found =
            StrokeCache { bounds: Some((scene.clone(), self.bounds)), ..StrokeCache::default() };
        let Self { brush, operator, color, samples, selection, .. } = self;
        let (brush, samples, selection) = (brush.clone(), samples.clone(), selection.clone());
        Stroke {
            brush,
            operator: *operator,
            color: *color,
            samples,
            selection,
            attachment: None,
            found: Arc::new(Mutex::new(found)),
        }
    }

    /// The finished stroke, its dabs known already.
    fn finish(mut self, scene: &Scene) -> Stroke {
        self.stroke_dabs.lay(&self.walker.tail(), scene);
        let mut found = StrokeCache::default();
        found.keep(&Arc::new(self.stroke_dabs));
        let Self { brush, operator, color, samples, selection, .. } = self;
        Stroke {
            brush,
            operator,
            color,
            samples,
            selection,
            attachment: None,
            found: Arc::new(Mutex::new(found)),
        }
    }
}

impl ActiveStrokes {
    /// Starts strokes with the settings of these; their samples are ignored.
    pub fn new(strokes: &[Stroke], backdrop: Backdrop, scene: &Scene) -> Self {
        let strokes = strokes.iter().map(|stroke| ActiveStroke::new(stroke, scene)).collect();
        Self { scene: scene.clone(), backdrop, strokes, tiles: HashMap::new() }
    }

    /// Takes the next samples of each stroke; returns the tiles of the layer that changed; of
    /// a stroke layer all that they may touch.
    pub fn draw(&mut self, samples: &[Vec<Sample>]) -> Vec<(TileAt, Option<Arc<Tile>>)> {
        let Self { scene, backdrop, strokes, tiles } = self;
        let mut changed: Vec<TileAt> =
            strokes.iter().flat_map(|stroke| stroke.tail.iter().copied()).collect();
        let none = Vec::new();
        let samples = samples.iter().chain(std::iter::repeat(&none));
        let fresh: Vec<NewDabs> = strokes
            .iter_mut()
            .zip(samples)
            .map(|(stroke, samples)| stroke.take(samples, scene))
            .collect();
        changed.extend(fresh.iter().flat_map(|fresh| fresh.tiles.keys()));
        changed.sort_unstable();
        changed.dedup();
        let dry = || ActiveTile {
            beneath: None,
            stroke_tiles: strokes.iter().map(|_| None).collect(),
            grains: strokes.iter().map(|_| None).collect(),
            shown: None,
        };
        let mut active_tiles: Vec<_> =
            changed.iter().map(|at| (*at, tiles.remove(at).unwrap_or_else(dry))).collect();
        // Bent dabs may touch many tiles, and cover pixels of few. Behind contours a stroke layer may
        // have paint where its tile has none.
        let shows_all = matches!(backdrop, Backdrop::Strokes(_));
        let paint = |scratch: &mut DabScratch, (at, tile): &mut (TileAt, ActiveTile)| {
            let cached = tile.stroke_tiles.iter_mut().zip(&mut tile.grains);
            let mut shown = Vec::with_capacity(strokes.len());
            for ((stroke, fresh), cached) in strokes.iter().zip(&fresh).zip(cached) {
                let selected = stroke.selection.as_ref().map(|selection| selection.tile(*at));
                if matches!(selected, Some(None)) {
                    continue;
                }
                let stroke_tile = stroke.compose_shown(fresh, *at, cached, scratch);
                shown.extend(
                    stroke_tile.map(|stroke_tile| (stroke, selected.flatten(), stroke_tile)),
                );
            }
            let before = tile.shown.take();
            let is_painted = !shown.is_empty();
            if !shows_all && !is_painted && before.is_none() {
                return None;
            }
            let mut pixels = backdrop.pixels(scene, *at, &mut tile.beneath);
            for (stroke, selected, mut stroke_tile) in shown {
                stroke_tile.limit_to(&stroke.part(scene), *at);
                if let Some(selected) = selected {
                    stroke_tile.select(&selected);
                }
                let blend = StrokeBlend::of(&stroke.brush, stroke.color);
                stroke_tile.blend_over(&mut pixels, *at, blend);
            }
            let pixels = backdrop.to_tile(*at, &pixels).map(Arc::new);
            tile.shown = is_painted.then(|| pixels.clone());
            let is_same = match (&before, &pixels) {
                (Some(Some(before)), Some(pixels)) => before.is_same(pixels),
                (Some(before), pixels) => before.is_none() && pixels.is_none(),
                (None, _) => false,
            };
            (shows_all || !is_same).then_some((*at, pixels))
        };
        let painted = active_tiles.par_iter_mut().map_init(DabScratch::default, paint);
        let painted = painted.flatten_iter().collect();
        tiles.extend(active_tiles);
        painted
    }

    /// The strokes as drawn so far. Their bounds are known; their dabs would be computed again.
    pub fn strokes(&self) -> Vec<Stroke> {
        self.strokes.iter().map(|stroke| stroke.stroke(&self.scene)).collect()
    }

    /// The finished strokes. Their dabs are known.
    pub fn finish(self) -> Vec<Stroke> {
        let Self { scene, strokes, .. } = self;
        strokes.into_iter().map(|stroke| stroke.finish(&scene)).collect()
    }
}

impl Backdrop {
    /// A painted tile as the layer holds it: paint as [`PlanarTile::to_tile`], what is rendered from
    /// strokes in bytes.
    fn to_tile(&self, at: TileAt, pixels: &PlanarTile) -> Option<Tile> {
        match self {
            Backdrop::Pixels(grid) => pixels.to_tile_over(grid.tile(at).map(|tile| &**tile)),
            Backdrop::Strokes(_) => pixels.quantize(),
        }
    }

    /// The pixels below a tile's active strokes, f32. `cached`: those of the strokes below, painted
    /// once.
    fn pixels(&self, scene: &Scene, at: TileAt, cached: &mut Option<PlanarTile>) -> PlanarTile {
        match self {
            Backdrop::Pixels(grid) => PlanarTile::of_tile(grid.tile(at).map(|tile| &**tile)),
            Backdrop::Strokes(strokes) if strokes.is_empty() => PlanarTile::transparent(),
            Backdrop::Strokes(strokes) => {
                let paint =
                    || render_pixels(strokes, scene, at).unwrap_or_else(PlanarTile::transparent);
                cached.get_or_insert_with(paint).clone()
            }
        }
    }
}

#[cfg(test)]
mod tests;
