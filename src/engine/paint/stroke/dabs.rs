//! The dabs of a stroke on a canvas, and which of them may touch which tile.
//! Floor 3.

use super::Stroke;
use crate::math::Rect;
use crate::paint::brush::Brush;
use crate::paint::brush::dual_brush::DualSettings;
use crate::paint::dab::{DabScratch, PlacedDab};
use crate::paint::dab_walker::{self, Dab, DabWalker};
use crate::paint::grain::{GrainTile, StrokeGrain};
use crate::paint::prepared_tip::PreparedTip;
use crate::paint::sample::Sample;
use crate::paint::scene::Scene;
use crate::paint::stroke_tile::StrokeTile;
use crate::paint::tint;
use crate::raster::{TILE, TileAt};
use crate::surface::support::{self, SupportBounds};
use std::collections::HashMap;
use std::mem::size_of;
use std::ops::Range;
use std::sync::Arc;

/// A stroke's dabs, and which of them may touch which tile of a canvas.
pub(in crate::paint) struct StrokeDabs {
    scene: Scene,
    tip: PreparedTip,
    /// Set once the start of the stroke is known.
    grain: Option<StrokeGrain>,
    has_colors: bool,
    dabs: Vec<Dab>,
    tiles: HashMap<TileAt, Vec<Range<u32>>>,
    /// Of a dual brush, whose first tip alone says which tiles are touched.
    second: Option<Box<SecondDabs>>,
}

/// The dabs of a second tip, and how their coverage meets that of the first tip's.
struct SecondDabs {
    settings: DualSettings,
    dabs: StrokeDabs,
}

/// Dabs this near in the stroke's order share a run even if those between them miss the tile.
const RUN_GAP: u32 = 8;
/// Dabs that are placed at a time.
pub(in crate::paint) const TOGETHER: usize = 32;
/// The most runs per tile: after that the last one grows. This bounds the memory of a hostile
/// stroke.
const MAX_RUNS: usize = 1024;

impl StrokeDabs {
    /// No dabs yet, and no second tip.
    pub fn empty(brush: &Brush, scene: &Scene) -> Self {
        let tip = PreparedTip::of(brush);
        let has_colors = tint::has_varied_color(brush) || tip.has_own_colors();
        let (dabs, tiles) = (Vec::new(), HashMap::new());
        Self { scene: scene.clone(), tip, grain: None, has_colors, dabs, tiles, second: None }
    }

    /// The same for a second tip, which only covers.
    pub fn empty_of_second(brush: &Brush, scene: &Scene) -> Self {
        Self { has_colors: false, ..Self::empty(brush, scene) }
    }

    pub fn of(stroke: &Stroke, scene: &Scene) -> Self {
        let Stroke { brush, operator, color, samples, .. } = stroke;
        let walker = DabWalker::new(brush, *operator, *color, scene);
        let second = brush.second().map(|(second, settings)| {
            let mut dabs = Self::empty_of_second(&second, scene);
            dabs.lay_all(&second, walker.beside(&second), samples);
            (settings, dabs)
        });
        let mut stroke_dabs = Self::empty(brush, scene);
        stroke_dabs.lay_all(brush, walker, samples);
        match second {
            Some((settings, second)) => stroke_dabs.with_second(settings, second),
            None => stroke_dabs,
        }
    }

    /// All dabs of a stroke. `walker`: as it begins.
    fn lay_all(&mut self, brush: &Brush, walker: DabWalker, samples: &[Sample]) {
        self.begin(brush, samples);
        let (dabs, scene) = (dab_walker::all_dabs(walker, samples), self.scene.clone());
        self.dabs.reserve_exact(dabs.len());
        dabs.chunks(TOGETHER).for_each(|dabs| self.lay(dabs, &scene));
    }

    /// The same with a second tip's dabs along the same samples.
    pub fn with_second(self, settings: DualSettings, dabs: StrokeDabs) -> Self {
        Self { second: Some(Box::new(SecondDabs { settings, dabs })), ..self }
    }

    /// Adds successive dabs.
    pub fn lay(&mut self, dabs: &[Dab], scene: &Scene) {
        let placed: Vec<PlacedDab> = dabs.iter().map(|dab| self.place(*dab, scene)).collect();
        let first = self.dabs.len();
        self.dabs.extend_from_slice(dabs);
        for_each_tile_of(&placed, |i, at| self.touch((first + i) as u32, at));
    }

    /// The approximate memory it takes.
    pub fn bytes(&self) -> u64 {
        let runs: usize = self.tiles.values().map(Vec::capacity).sum();
        let tiles = self.tiles.capacity() * size_of::<(TileAt, Vec<Range<u32>>)>();
        let own = self.dabs.capacity() * size_of::<Dab>()
            + runs * size_of::<Range<u32>>()
            + tiles
            + size_of::<Self>();
        own as u64 + self.second.as_ref().map_or(0, |second| second.dabs.bytes())
    }

    /// The number of dabs of both tips.
    pub fn count(&self) -> usize {
        self.dabs.len() + self.second.as_ref().map_or(0, |second| second.dabs.count())
    }

    /// The tiles it touches, without its dabs.
    pub fn support(&self) -> TileReach {
        TileReach::new(self.scene.clone(), self.count(), self.tiles.keys().copied())
    }

    /// Anchors the grain, if any, at the start of the stroke; later samples do not change it.
    pub fn begin(&mut self, brush: &Brush, samples: &[Sample]) {
        let start = samples.iter().map(|sample| sample.at).find(|at| at.is_finite());
        let grain =
            brush.grain.as_ref().filter(|grain| grain.strength > 0.0 && self.grain.is_none());
        if let Some((grain, start)) = grain.zip(start) {
            self.grain = Some(StrokeGrain::new(grain, start));
        }
    }

    /// What the grain leaves of each pixel of a tile, or of what represents it on a far side.
    pub fn grain(&self, scene: &Scene, at: TileAt) -> Option<Arc<GrainTile>> {
        self.grain.as_ref().map(|grain| grain.tile(scene, at).into())
    }

    /// Adds a dab that may touch these tiles.
    pub fn push(&mut self, dab: Dab, tiles: &[TileAt]) {
        let i = self.dabs.len() as u32;
        self.dabs.push(dab);
        tiles.iter().for_each(|&at| self.touch(i, at));
    }

    /// The `i`th dab may touch a tile; for each tile dabs are added in order.
    fn touch(&mut self, i: u32, at: TileAt) {
        let runs = self.tiles.entry(at).or_default();
        let is_full = runs.len() >= MAX_RUNS;
        match runs.last_mut() {
            Some(run) if is_full || i - run.end <= RUN_GAP => run.end = i + 1,
            _ => runs.push(i..i + 1),
        }
    }

    pub fn is_on(&self, scene: &Scene) -> bool {
        self.scene.is_same(scene)
    }

    /// The tiles that they may touch, in no order; some may be beyond the canvas.
    pub fn tiles(&self) -> impl Iterator<Item = TileAt> {
        self.tiles.keys().copied()
    }

    /// The scene that they were laid on.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The dabs that may touch a tile, in order.
    pub fn on_tile(&self, at: TileAt) -> impl Iterator<Item = &Dab> {
        let runs = self.tiles.get(&at).into_iter().flatten();
        runs.flat_map(|run| &self.dabs[run.start as usize..run.end as usize])
    }

    pub fn place<'s>(&self, dab: Dab, scene: &'s Scene) -> PlacedDab<'s> {
        self.tip.place(dab, scene)
    }

    /// An empty stroke tile for the stroke's dabs. `grain`: the tile's.
    pub fn stroke_tile(&self, grain: Option<Arc<GrainTile>>) -> StrokeTile {
        let tile = if self.has_colors { StrokeTile::colors() } else { StrokeTile::one_color() };
        match grain {
            Some(grain) => tile.under(grain),
            None => tile,
        }
    }

    /// Adds a dab to a tile.
    pub fn add(
        &self,
        dab: &PlacedDab,
        at: TileAt,
        stroke_tile: &mut StrokeTile,
        scratch: &mut DabScratch,
    ) {
        self.tip.add(dab, at, stroke_tile, scratch);
    }

    /// The whole stroke on a tile, or on what represents one on a far side: that of the first tip,
    /// met by that of the second.
    pub fn paint_tile(&self, scene: &Scene, at: TileAt, scratch: &mut DabScratch) -> StrokeTile {
        let mut first = self.accumulate(scene, at, scratch);
        if let Some(second) = self.second.as_ref().filter(|_| !first.is_clear()) {
            first.combine(&second.dabs.accumulate(scene, at, scratch), &second.settings);
        }
        first
    }

    /// The dabs of this tip.
    fn accumulate(&self, scene: &Scene, at: TileAt, scratch: &mut DabScratch) -> StrokeTile {
        let mut stroke_tile = self.stroke_tile(self.grain(scene, at));
        let Some(far) = scene.as_far_side() else {
            for dab in self.on_tile(at) {
                self.add(&self.place(*dab, scene), at, &mut stroke_tile, scratch);
            }
            return stroke_tile;
        };
        // Which dabs are near is known for the canvas only.
        let front = scene.front();
        for dab in self.on_tile(at) {
            let near = far.blocks_under(at, &self.place(*dab, &front).support().blocks(at));
            let Some(blocks) = near else { continue };
            let placed = self.place(*dab, scene).on_blocks(blocks);
            self.add(&placed, at, &mut stroke_tile, scratch);
        }
        stroke_tile
    }
}

/// The tiles of a canvas that a stroke may touch, one bit each: kept when its dabs are not.
pub(in crate::paint) struct TileReach {
    scene: Scene,
    /// The number of dabs.
    pub dabs: usize,
    /// Whole tiles.
    bounds: Rect,
    /// Row by row over the bounds.
    bits: Box<[u64]>,
}

impl TileReach {
    pub fn new(scene: Scene, dabs: usize, tiles: impl Iterator<Item = TileAt> + Clone) -> Self {
        // No tile beyond the canvas is requested.
        let canvas = scene.size.rect();
        let tiles = tiles.filter(|at| !at.rect().intersect(canvas).is_empty());
        let bounds = tiles.clone().fold(Rect::EMPTY, |r, at| r.union(at.rect()));
        let mut bits = vec![0; (bounds.width() / TILE * (bounds.height() / TILE)).div_ceil(64)];
        let mut support = Self { scene, dabs, bounds, bits: Box::default() };
        for i in tiles.filter_map(|at| support.index(at)) {
            bits[i / 64] |= 1 << (i % 64);
        }
        support.bits = bits.into();
        support
    }

    fn index(&self, at: TileAt) -> Option<usize> {
        let corner = at.rect();
        let (x, y) = (corner.x0, corner.y0);
        let place = |v: i32, from: i32| (v - from) as usize / TILE;
        let inside = self.bounds.contains(x, y);
        inside.then(|| {
            place(y, self.bounds.y0) * (self.bounds.width() / TILE) + place(x, self.bounds.x0)
        })
    }

    pub fn is_on(&self, scene: &Scene) -> bool {
        self.scene.is_same(scene)
    }

    pub fn can_touch(&self, at: TileAt) -> bool {
        self.index(at)
            .and_then(|i| self.bits.get(i / 64).map(|word| word >> (i % 64) & 1 == 1))
            .unwrap_or(false)
    }

    /// Whole tiles of the canvas.
    pub fn bounds(&self) -> Rect {
        self.bounds
    }
}

/// Visits the tiles that each of some dabs may touch, with the dab's number; for each tile in
/// order.
pub(in crate::paint) fn for_each_tile_of(dabs: &[PlacedDab], visit: impl FnMut(usize, TileAt)) {
    let bounds: Vec<&SupportBounds> = dabs.iter().map(PlacedDab::support).collect();
    support::for_each_tile_of(&bounds, visit);
}

/// The tiles that a dab may touch.
pub(in crate::paint) fn tiles_of(dab: &PlacedDab) -> Vec<TileAt> {
    let mut tiles = Vec::new();
    dab.support().for_each_tile(|at| tiles.push(at));
    tiles
}
