//! The dabs of a stroke on a canvas, and which of them may touch which tile.
//! Floor 3.

use super::Stroke;
use crate::math::Rect;
use crate::paint::brush::Brush;
use crate::paint::dab::{DabScratch, PlacedDab};
use crate::paint::dab_walker::{self, Dab};
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
    varies_in_color: bool,
    dabs: Vec<Dab>,
    tiles: HashMap<TileAt, Vec<Range<u32>>>,
}

/// Dabs this near in the stroke's order share a run even if those between them miss the tile.
const RUN_GAP: u32 = 8;
/// Dabs that are placed at a time.
pub(in crate::paint) const TOGETHER: usize = 32;
/// The most runs per tile: after that the last one grows. This bounds the memory of a hostile
/// stroke.
const MAX_RUNS: usize = 1024;

impl StrokeDabs {
    /// No dabs yet.
    pub fn empty(brush: &Brush, scene: &Scene) -> Self {
        Self {
            scene: scene.clone(),
            tip: PreparedTip::of(brush),
            grain: None,
            varies_in_color: tint::has_varied_color(brush),
            dabs: Vec::new(),
            tiles: HashMap::new(),
        }
    }

    pub fn of(stroke: &Stroke, scene: &Scene) -> Self {
        let mut stroke_dabs = Self::empty(&stroke.brush, scene);
        stroke_dabs.begin(&stroke.brush, &stroke.samples);
        let dabs =
            dab_walker::dabs(&stroke.brush, stroke.operator, stroke.color, &stroke.samples, scene);
        stroke_dabs.dabs.reserve_exact(dabs.len());
        dabs.chunks(TOGETHER).for_each(|dabs| stroke_dabs.lay(dabs, scene));
        stroke_dabs
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
        (self.dabs.capacity() * size_of::<Dab>()
            + runs * size_of::<Range<u32>>()
            + tiles
            + size_of::<Self>()) as u64
    }

    /// The tiles it touches, without its dabs.
    pub fn support(&self) -> TileReach {
        TileReach::new(self.scene.clone(), self.dabs.len(), self.tiles.keys().copied())
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

    /// The number of dabs.
    #[cfg(test)]
    pub fn dabs(&self) -> usize {
        self.dabs.len()
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
        let has_colors = self.varies_in_color || self.tip.has_own_colors();
        let tile = if has_colors { StrokeTile::colors() } else { StrokeTile::one_color() };
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
