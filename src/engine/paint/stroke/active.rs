//! Active strokes: samples go in, and the tiles that they change come out. Each dab is placed and
//! painted once, over what the stroke has painted so far; only the end of the curve, which the next
//! sample may change, is painted again. Floor 3. Not here: the pen (`tools`).

use super::dabs::{StrokeDabs, TOGETHER, for_each_tile_of};
use super::{Sample, Stroke, StrokeCache, render_pixels};
use crate::math::{Rect, Vec2, parallel, srgb::Color};
use crate::paint::brush::Brush;
use crate::paint::brush::dual_brush::DualSettings;
use crate::paint::dab::{DabScratch, PlacedDab};
use crate::paint::dab_walker::{Dab, DabWalker};
use crate::paint::grain::GrainTile;
use crate::paint::scene::Scene;
use crate::paint::selection::StrokeSelection;
use crate::paint::stroke_tile::{StrokeBlend, StrokeTile};
use crate::raster::{PlanarTile, Tile, TileAt, TileGrid};
use crate::surface::Operator;
use crate::surface::objects::CanvasPart;
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
/// vary in color), 16 for one that a second tip touches, and 64 more if there are strokes below.
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
    first: ActiveTip,
    /// Of a dual brush.
    second: Option<(DualSettings, ActiveTip)>,
    bounds: Rect,
}

/// The dabs of one tip of an active stroke.
struct ActiveTip {
    walker: DabWalker,
    /// The settled dabs.
    stroke_dabs: StrokeDabs,
    /// Where the last tail was shown.
    tail: Vec<TileAt>,
}

/// A tile under active strokes.
struct ActiveTile {
    /// The strokes below, once they were painted.
    beneath: Option<PlanarTile>,
    /// Of each active stroke.
    strokes: Vec<StrokeOnTile>,
    /// Whether the first tip of a stroke may have touched it: a second tip alone shows nothing.
    is_reached: bool,
    /// What was shown last, if there was paint of theirs.
    shown: Option<Option<Arc<Tile>>>,
}

/// What an active stroke has on a tile, of each tip.
#[derive(Default)]
struct StrokeOnTile {
    first: TipOnTile,
    second: TipOnTile,
}

/// What one tip has painted on a tile.
#[derive(Default)]
struct TipOnTile {
    /// Its settled dabs.
    stroke_tile: Option<StrokeTile>,
    /// What its grain leaves of each pixel.
    grain: Option<Arc<GrainTile>>,
}

/// What a batch of samples adds to one tip of a stroke.
#[derive(Default)]
struct NewDabs<'s> {
    dabs: Vec<PlacedDab<'s>>,
    /// The number of them that no later sample changes.
    settled: usize,
    /// Those that may touch a tile, in order.
    tiles: BTreeMap<TileAt, Vec<usize>>,
}

/// The same for both tips.
struct NewDabsOfBoth<'s> {
    first: NewDabs<'s>,
    second: NewDabs<'s>,
}

impl ActiveTip {
    /// Places the dabs that the samples settle, and the tail behind them.
    fn take<'s>(&mut self, samples: &[Sample], scene: &'s Scene) -> NewDabs<'s> {
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
        let placed: Vec<_> =
            parallel::map(dabs.chunks(TOGETHER), place).into_iter().flatten().collect();
        self.tail.clear();
        let mut fresh =
            NewDabs { dabs: Vec::with_capacity(placed.len()), settled, tiles: BTreeMap::new() };
        for (i, (placed, tiles)) in placed.into_iter().enumerate() {
            for &at in &tiles {
                fresh.tiles.entry(at).or_default().push(i);
            }
            match i < settled {
                true => self.stroke_dabs.push(dabs[i], &tiles),
                false => self.tail.extend(tiles),
            }
            fresh.dabs.push(placed);
        }
        fresh
    }

    /// The stroke tile to be shown: with the tail. Settled dabs are added to the tip's own for
    /// good. `None` where there is no paint.
    fn compose_shown(
        &self,
        fresh: &NewDabs,
        at: TileAt,
        TipOnTile { stroke_tile, grain }: &mut TipOnTile,
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

    /// All dabs, as if the stroke ended here.
    fn finish(mut self, scene: &Scene) -> StrokeDabs {
        self.stroke_dabs.lay(&self.walker.tail(), scene);
        self.stroke_dabs
    }
}

impl ActiveStroke {
    fn new(stroke: &Stroke, scene: &Scene) -> Self {
        let Stroke { brush, operator, color, selection, .. } = stroke;
        let walker = DabWalker::new(brush, *operator, *color, scene);
        let second = brush.second().map(|(second, settings)| {
            let walker = walker.beside(&second);
            let stroke_dabs = StrokeDabs::empty_of_second(&second, scene);
            (settings, ActiveTip { walker, stroke_dabs, tail: Vec::new() })
        });
        let stroke_dabs = StrokeDabs::empty(brush, scene);
        Self {
            brush: brush.clone(),
            operator: *operator,
            color: *color,
            samples: Vec::new(),
            selection: selection.clone(),
            first: ActiveTip { walker, stroke_dabs, tail: Vec::new() },
            second,
            bounds: Rect::EMPTY,
        }
    }

    /// Places the dabs that the samples settle, and the tails behind them.
    fn take<'s>(&mut self, samples: &[Sample], scene: &'s Scene) -> NewDabsOfBoth<'s> {
        self.samples.extend_from_slice(samples);
        self.first.stroke_dabs.begin(&self.brush, &self.samples);
        let first = self.first.take(samples, scene);
        self.bounds = first.tiles.keys().fold(self.bounds, |all, at| all.union(at.rect()));
        let second = self.second.as_mut().map(|(_, second)| second.take(samples, scene));
        NewDabsOfBoth { first, second: second.unwrap_or_default() }
    }

    /// Where the last tails were shown.
    fn tails(&self) -> impl Iterator<Item = TileAt> {
        let second = self.second.iter().flat_map(|(_, second)| &second.tail);
        self.first.tail.iter().chain(second).copied()
    }

    /// The stroke tile to be shown: with the tails, both tips together. `None` where there is no
    /// paint.
    fn compose_shown(
        &self,
        fresh: &NewDabsOfBoth,
        at: TileAt,
        StrokeOnTile { first, second }: &mut StrokeOnTile,
        scratch: &mut DabScratch,
    ) -> Option<StrokeTile> {
        let shown = self.first.compose_shown(&fresh.first, at, first, scratch);
        let Some((settings, tip)) = &self.second else { return shown };
        // Settled dabs count where the first tip may come later.
        let met = tip.compose_shown(&fresh.second, at, second, scratch);
        let mut shown = shown?;
        shown.combine(&met.unwrap_or_else(StrokeTile::one_color), settings);
        Some(shown)
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
    fn finish(self, scene: &Scene) -> Stroke {
        let Self { brush, operator, color, samples, selection, first, second, .. } = self;
        let stroke_dabs = first.finish(scene);
        let stroke_dabs = match second {
            Some((settings, second)) => stroke_dabs.with_second(settings, second.finish(scene)),
            None => stroke_dabs,
        };
        let mut found = StrokeCache::default();
        found.keep(&Arc::new(stroke_dabs));
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
        let mut changed: Vec<TileAt> = strokes.iter().flat_map(ActiveStroke::tails).collect();
        let none = Vec::new();
        let samples = samples.iter().chain(std::iter::repeat(&none));
        let fresh: Vec<NewDabsOfBoth> = strokes
            .iter_mut()
            .zip(samples)
            .map(|(stroke, samples)| stroke.take(samples, scene))
            .collect();
        let touched = |NewDabsOfBoth { first, second }: &NewDabsOfBoth| -> Vec<TileAt> {
            first.tiles.keys().chain(second.tiles.keys()).copied().collect()
        };
        changed.extend(fresh.iter().flat_map(touched));
        changed.sort_unstable();
        changed.dedup();
        let dry = || ActiveTile {
            beneath: None,
            strokes: strokes.iter().map(|_| StrokeOnTile::default()).collect(),
            is_reached: false,
            shown: None,
        };
        let mut active_tiles: Vec<_> =
            changed.iter().map(|at| (*at, tiles.remove(at).unwrap_or_else(dry))).collect();
        // Bent dabs may touch many tiles, and cover pixels of few. Behind contours a stroke layer may
        // have paint where its tile has none.
        let shows_all = matches!(backdrop, Backdrop::Strokes(_));
        let paint = |scratch: &mut DabScratch, (at, tile): &mut (TileAt, ActiveTile)| {
            tile.is_reached |= fresh.iter().any(|fresh| fresh.first.tiles.contains_key(at));
            let mut shown = Vec::with_capacity(strokes.len());
            for ((stroke, fresh), cached) in strokes.iter().zip(&fresh).zip(&mut tile.strokes) {
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
            let may_show = is_painted || (shows_all && tile.is_reached);
            if !may_show && before.is_none() {
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
        let painted = parallel::map_with(&mut active_tiles, DabScratch::default, paint);
        let painted = painted.into_iter().flatten().collect();
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
