//! The dabs of a stroke on a canvas, and which of them may touch which tile.
//! Floor 3.

use super::Stroke;
use crate::math::Rect;
use crate::paint::brush::{Brush, Tip};
use crate::paint::dab::{DabScratch, PlacedDab, round_extent};
use crate::paint::laying::{self, Dab};
use crate::paint::scene::Scene;
use crate::paint::stamp::{Stamp, Stamps};
use crate::paint::tint;
use crate::paint::wash::Wash;
use crate::raster::TileAt;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// A stroke's dabs, and which of them may touch which tile of a canvas.
pub(in crate::paint) struct Laid {
    scene: Scene,
    tip: LaidTip,
    varies_in_color: bool,
    dabs: Vec<Dab>,
    tiles: HashMap<TileAt, Vec<Range<u32>>>,
}

/// A brush's tip, made ready.
#[derive(Clone)]
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
    fn brings_colors(&self) -> bool {
        matches!(self, Self::Stamp(stamp) if stamp.is_colored)
    }
}

/// Dabs this near in the stroke's order share a run even if those between them miss the tile.
const RUN_GAP: u32 = 8;
/// Runs a tile: beyond, the last one grows. Bounds what a hostile stroke takes.
const MAX_RUNS: usize = 1024;

impl Laid {
    /// No dabs yet.
    pub fn empty(brush: &Brush, scene: &Scene) -> Self {
        Self {
            scene: scene.clone(),
            tip: LaidTip::of(brush),
            varies_in_color: tint::varies(brush),
            dabs: Vec::new(),
            tiles: HashMap::new(),
        }
    }
    pub fn of(stroke: &Stroke, scene: &Scene) -> Self {
        let mut laid = Self::empty(&stroke.brush, scene);
        for dab in laying::dabs(&stroke.brush, stroke.operator, stroke.color, &stroke.samples, scene) {
            let tiles = tiles_of(&laid.place(dab, scene));
            laid.push(dab, &tiles);
        }
        laid
    }
    /// Adds a dab that may touch these tiles.
    pub fn push(&mut self, dab: Dab, tiles: &[TileAt]) {
        let i = self.dabs.len() as u32;
        self.dabs.push(dab);
        for &at in tiles {
            let runs = self.tiles.entry(at).or_default();
            let is_full = runs.len() >= MAX_RUNS;
            match runs.last_mut() {
                Some(run) if is_full || i - run.end <= RUN_GAP => run.end = i + 1,
                _ => runs.push(i..i + 1),
            }
        }
    }
    pub fn is_on(&self, scene: &Scene) -> bool {
        self.scene.is_same(scene)
    }
    pub fn touches(&self, at: TileAt) -> bool {
        self.tiles.contains_key(&at)
    }
    /// Whole tiles.
    pub fn bounds(&self) -> Rect {
        self.tiles.keys().fold(Rect::EMPTY, |r, at| r.union(at.rect()))
    }
    /// The dabs that may touch a tile, in their order.
    pub fn on_tile(&self, at: TileAt) -> impl Iterator<Item = &Dab> {
        let runs = self.tiles.get(&at).into_iter().flatten();
        runs.flat_map(|run| &self.dabs[run.start as usize..run.end as usize])
    }
    pub fn place<'s>(&self, dab: Dab, scene: &'s Scene) -> PlacedDab<'s> {
        let extent = match &self.tip {
            LaidTip::Round => round_extent(&dab),
            LaidTip::Stamp(stamp) => stamp.extent(&dab),
        };
        PlacedDab::new(dab, scene, extent)
    }
    /// What the stroke's dabs add up in, dry.
    pub fn wash(&self) -> Wash {
        if self.varies_in_color || self.tip.brings_colors() { Wash::colors() } else { Wash::one_color() }
    }
    /// Adds a dab to a tile.
    pub fn add(&self, dab: &PlacedDab, at: TileAt, wash: &mut Wash, scratch: &mut DabScratch) {
        match &self.tip {
            LaidTip::Round => dab.add_round(at, wash, scratch),
            LaidTip::Stamp(stamp) => dab.add_stamp(stamp, at, wash, scratch),
        }
    }
}

/// The tiles that a dab may touch.
pub(in crate::paint) fn tiles_of(dab: &PlacedDab) -> Vec<TileAt> {
    let mut tiles = Vec::new();
    dab.reach().for_each_tile(|at| tiles.push(at));
    tiles
}
