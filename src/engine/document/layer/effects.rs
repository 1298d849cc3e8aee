//! What the effects of a layer are computed from, and what was computed: tile by tile, when needed.
//! Floor 4. Not here: the effects themselves (`paint::effect`), composing them (`compose::effects`).

use super::content::{Changed, Content};
use super::map::LayerMap;
use super::mask::LayerMask;
use super::warp::LayerWarp;
use super::{Layer, Role};
use crate::document::memory_use::MemoryCount;
use crate::math::Rect;
use crate::memory::once;
use crate::paint::{EffectKind, EffectLight, EffectPlace, LayerEffect, Scene, effect::EffectTile};
use crate::raster::tile::TILE_AREA;
use crate::raster::{Matte, PlanarTile, TILE, TileAt};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// What a layer covers in a tile.
#[derive(Clone)]
pub(in crate::document) enum CoverTile {
    /// The same everywhere.
    Even(f32),
    /// Row by row, of 65535.
    Values(Arc<[u16]>),
}

impl CoverTile {
    /// The alpha of pixels.
    pub fn of(pixels: &PlanarTile) -> Self {
        let alphas = pixels.rows().iter().flat_map(|row| row.a);
        let values: Arc<[u16]> = alphas.map(|a| (a * 65535.0 + 0.5) as u16).collect();
        match values.first() {
            Some(first) if values.iter().all(|v| v == first) => {
                Self::Even(f32::from(*first) / 65535.0)
            }
            _ => Self::Values(values),
        }
    }

    fn held_bytes(&self) -> u64 {
        match self {
            Self::Even(_) => 0,
            Self::Values(values) => size_of_val::<[u16]>(values) as u64,
        }
    }

    /// Writes what lies in a rectangle of the canvas.
    fn write(&self, at: TileAt, matte: &mut Matte) {
        let (rect, inside) = (at.rect(), at.rect().intersect(matte.rect()));
        let left = matte.rect().x0;
        for y in inside.y0..inside.y1 {
            let row = &mut matte.row_mut(y)[(inside.x0 - left) as usize..][..inside.width()];
            match self {
                Self::Even(value) => row.fill(*value),
                Self::Values(values) => {
                    let start = (y - rect.y0) as usize * TILE + (inside.x0 - rect.x0) as usize;
                    let from = values.iter().skip(start);
                    row.iter_mut().zip(from).for_each(|(v, c)| *v = f32::from(*c) / 65535.0);
                }
            }
        }
    }

    /// The least rectangle around what is covered, canvas px.
    fn bounds(&self, at: TileAt) -> Rect {
        let rect = at.rect();
        match self {
            Self::Even(value) if *value > 0.0 => rect,
            Self::Even(_) => Rect::EMPTY,
            Self::Values(values) => {
                let covered = (0..TILE_AREA).filter(|i| values[*i] > 0);
                covered.fold(Rect::EMPTY, |all, i| {
                    let (x, y) = (rect.x0 + (i % TILE) as i32, rect.y0 + (i / TILE) as i32);
                    all.union(Rect::new(x, y, x + 1, y + 1))
                })
            }
        }
    }
}

/// One cell for each tile of a region.
struct EffectCells<T> {
    first: TileAt,
    cols: i32,
    cells: Vec<OnceLock<T>>,
}

impl<T: Clone> EffectCells<T> {
    fn new(region: Rect) -> Self {
        let mut tiles = TileAt::covering(region).peekable();
        let first = tiles.peek().copied().unwrap_or(TileAt::new(0, 0));
        let count = tiles.count();
        let cols = TileAt::covering(region).take_while(|at| at.row == first.row).count() as i32;
        Self { first, cols, cells: (0..count).map(|_| OnceLock::new()).collect() }
    }

    fn cell(&self, at: TileAt) -> Option<&OnceLock<T>> {
        let (col, row) = (at.col - self.first.col, at.row - self.first.row);
        let inside = col >= 0 && row >= 0 && col < self.cols;
        inside.then(|| self.cells.get((row * self.cols + col) as usize)).flatten()
    }

    /// The same region with what is known, but for some tiles.
    fn without(&self, changed: impl Fn(TileAt) -> bool) -> Self {
        let kept = |(i, cell): (usize, &OnceLock<T>)| {
            let next = OnceLock::new();
            let (col, row) = (i as i32 % self.cols.max(1), i as i32 / self.cols.max(1));
            let at = TileAt::new(self.first.col + col, self.first.row + row);
            if let Some(known) = cell.get().filter(|_| !changed(at)) {
                let _ = next.set(known.clone());
            }
            next
        };
        let cells = self.cells.iter().enumerate().map(kept).collect();
        Self { first: self.first, cols: self.cols, cells }
    }
}

/// The effects of a layer on the canvas, computed when needed.
pub struct EffectTiles {
    /// Those that are shown, in the order in which they are composed.
    pub effects: Vec<LayerEffect>,
    light: EffectLight,
    scene: Scene,
    region: Rect,
    covers: Arc<EffectCells<CoverTile>>,
    amounts: Vec<EffectCells<Arc<EffectTile>>>,
    filled: OnceLock<Rect>,
}

impl Layer {
    /// The effects that it shows, in the order in which they are composed; those of one kind as
    /// they are listed, the first on top.
    pub fn shown_effects(&self) -> Vec<LayerEffect> {
        if !matches!(self.content.role(), Role::Paints | Role::Groups(_)) {
            return Vec::new();
        }
        let shown = || self.effects.iter().rev().filter(|effect| effect.on);
        let of_kind = |(kind, _): &(EffectKind, &str)| {
            let kind = *kind;
            shown().filter(move |effect| effect.kind == kind).flat_map(LayerEffect::parts)
        };
        EffectKind::ALL.iter().flat_map(of_kind).collect()
    }

    /// How far its effects look, px; 0 without any.
    pub(in crate::document) fn effects_reach_px(&self, light: EffectLight, scene: &Scene) -> i32 {
        let depth = depth_px(scene);
        let shown = self.shown_effects();
        shown.iter().map(|effect| effect.reach_px(light, depth)).max().unwrap_or(0)
    }

    /// Effects lie on all that it covers, so that a change anywhere changes them everywhere.
    pub(in crate::document) fn has_aligned_effects(&self) -> bool {
        self.effects.iter().any(|effect| effect.on && effect.is_aligned())
    }
}

fn depth_px(scene: &Scene) -> f32 {
    scene.surface.as_ref().map_or(0.0, |surface| surface.depth_range_px())
}

impl EffectTiles {
    /// With what is known of an earlier version, but for what some changed tiles reach.
    fn with_known(mut self, known: &EffectTiles, changed: &[TileAt]) -> Self {
        if known.region != self.region {
            return self;
        }
        self.covers = match changed.is_empty() {
            true => known.covers.clone(),
            false => Arc::new(known.covers.without(|at| changed.contains(&at))),
        };
        let depth = depth_px(&self.scene);
        for (effect, amounts) in self.effects.iter().zip(&mut self.amounts) {
            let same = known.effects.iter().position(|known| known == effect);
            let same = same.filter(|_| known.light == self.light);
            if let Some(cells) = same.and_then(|i| known.amounts.get(i)) {
                let reach = effect.reach_px(self.light, depth);
                *amounts = cells.without(|at| {
                    let near = at.rect().grown(reach);
                    changed.iter().any(|changed| !changed.rect().intersect(near).is_empty())
                });
            }
        }
        self
    }

    /// The numbers of the effects of a place.
    pub fn at_place(&self, place: EffectPlace) -> impl Iterator<Item = usize> {
        let numbered = self.effects.iter().enumerate();
        numbered.filter(move |(_, effect)| effect.place() == place).map(|(i, _)| i)
    }

    /// How much of an effect each pixel of a tile gets.
    ///
    /// * `cover`: what the layer covers in a tile.
    pub fn amounts(
        &self,
        number: usize,
        at: TileAt,
        cover: &dyn Fn(TileAt) -> CoverTile,
    ) -> Arc<EffectTile> {
        let make = || {
            let Some(effect) = self.effects.get(number) else {
                return Arc::new(EffectTile::NOTHING);
            };
            let surface = self.scene.surface.as_deref();
            Arc::new(effect.tile(at, self.light, surface, &|rect| self.matte(rect, cover)))
        };
        match self.amounts.get(number).and_then(|cells| cells.cell(at)) {
            Some(cell) => once(cell, make).clone(),
            None => make(),
        }
    }

    fn matte(&self, rect: Rect, cover: &dyn Fn(TileAt) -> CoverTile) -> Matte {
        let mut matte = Matte::full(rect, 0.0);
        for at in TileAt::covering(rect) {
            self.cover_tile(at, cover).write(at, &mut matte);
        }
        matte
    }

    fn cover_tile(&self, at: TileAt, cover: &dyn Fn(TileAt) -> CoverTile) -> CoverTile {
        match self.covers.cell(at) {
            Some(cell) => once(cell, || cover(at)).clone(),
            None => cover(at),
        }
    }

    /// What ramps and pictures of an effect lie on: all that the layer covers, or the canvas.
    pub fn filled_rect(&self, number: usize, cover: &dyn Fn(TileAt) -> CoverTile) -> Rect {
        if !self.effects.get(number).is_some_and(LayerEffect::is_aligned) {
            return self.scene.size.rect();
        }
        let all = once(&self.filled, || {
            let tiles = TileAt::covering(self.region);
            let bounds = tiles.map(|at| self.cover_tile(at, cover).bounds(at));
            bounds.fold(Rect::EMPTY, Rect::union)
        });
        if all.is_empty() { self.scene.size.rect() } else { *all }
    }
}

/// The last effects of a layer, shared by its versions.
#[derive(Clone, Default)]
pub struct EffectCache {
    last: Arc<Mutex<Option<EffectEntry>>>,
}

#[derive(Clone)]
struct EffectEntry {
    content: Content,
    mask: Option<LayerMask>,
    clip_to_surface: bool,
    map: LayerMap,
    warp: Option<LayerWarp>,
    tiles: Arc<EffectTiles>,
}

impl EffectCache {
    /// Counts what it holds, or drops it.
    pub(in crate::document) fn count(&self, count: &mut MemoryCount, keeps: bool) {
        if !count.is_new(&self.last) {
            return;
        }
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if !keeps {
            *last = None;
        }
        let Some(entry) = &*last else { return };
        let covers = entry.tiles.covers.cells.iter().filter_map(OnceLock::get);
        count.add_kept(covers.map(CoverTile::held_bytes).sum());
        let amounts = entry.tiles.amounts.iter().flat_map(|amounts| &amounts.cells);
        count.add_kept(amounts.filter_map(OnceLock::get).map(|tile| tile.held_bytes()).sum());
    }

    /// The effects of a layer as it lies on the canvas, also where its fill is transparent; `None`
    /// if it shows neither. What its content did not change is kept.
    pub(in crate::document) fn tiles(
        &self,
        layer: &Layer,
        scene: &Scene,
        map: &LayerMap,
        warp: Option<&LayerWarp>,
        light: EffectLight,
    ) -> Option<Arc<EffectTiles>> {
        let effects = layer.shown_effects();
        let is_thinner =
            layer.fill_opacity < 1.0 && !matches!(layer.content.role(), Role::Adjusts(_));
        if effects.is_empty() && !is_thinner {
            return None;
        }
        let depth = depth_px(scene);
        let reach = effects.iter().map(|effect| effect.reach_px(light, depth)).max().unwrap_or(0);
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let last = last.filter(|entry| {
            entry.tiles.scene.is_same(scene)
                && entry.map == *map
                && entry.warp.as_ref() == warp
                && entry.clip_to_surface == layer.clip_to_surface
        });
        let changed = last.as_ref().and_then(|entry| Some((entry, entry.changed_tiles(layer)?)));
        let region = scene.size.rect().grown(reach);
        let next = EffectTiles {
            amounts: effects.iter().map(|_| EffectCells::new(scene.size.rect())).collect(),
            effects,
            light,
            scene: scene.clone(),
            region,
            covers: Arc::new(EffectCells::new(region)),
            filled: OnceLock::new(),
        };
        let tiles = match changed {
            Some((EffectEntry { tiles: known, .. }, changed)) => {
                if changed.is_empty() && known.effects == next.effects && known.light == light {
                    return Some(known.clone());
                }
                next.with_known(known, &changed)
            }
            None => next,
        };
        let tiles = Arc::new(tiles);
        let entry = EffectEntry {
            content: layer.content.clone(),
            mask: layer.mask.clone(),
            clip_to_surface: layer.clip_to_surface,
            map: *map,
            warp: warp.cloned(),
            tiles: tiles.clone(),
        };
        // What was known before is freed after the lock.
        let before = self.last.lock().unwrap_or_else(PoisonError::into_inner).replace(entry);
        drop(before);
        Some(tiles)
    }
}

impl EffectEntry {
    /// The tiles in which a newer version may cover something else; `None`: anywhere.
    fn changed_tiles(&self, layer: &Layer) -> Option<Vec<TileAt>> {
        let mut changed = match (&self.mask, &layer.mask) {
            (None, None) => Vec::new(),
            (Some(a), Some(b)) if a.is_same(b) => Vec::new(),
            (Some(a), Some(b)) => a.changed_tiles(b)?,
            _ => return None,
        };
        if let (Content::Group(a), Content::Group(b)) = (&self.content, &layer.content) {
            let same = a.layers.len() == b.layers.len()
                && a.layers.iter().zip(&b.layers).all(|(a, b)| Arc::ptr_eq(a, b));
            return same.then_some(changed);
        }
        if self.content.is_identical(&layer.content) {
            return Some(changed);
        }
        if self.content.kind_name() != layer.content.kind_name() {
            return None;
        }
        match layer.content.difference_from(&self.content, &|| self.tiles.scene.clone()) {
            Changed::Nowhere => {}
            Changed::Wholly => return None,
            Changed::Tiles(tiles) => changed.extend(tiles),
        }
        Some(changed)
    }
}
