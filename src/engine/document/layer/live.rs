//! Live content: parameters together with the tiles rendered from them, valid until a parameter
//! changes. Floor 4. Not here: rendering marks (`paint`, `shading`).

use super::tile_content::TileContent;
use crate::document::far_side::{FarPixels, FarScene};
use crate::document::memory_use::MemoryCount;
use crate::math::Rect;
use crate::memory::once;
use crate::paint::Scene;
use crate::raster::{Tile, TileAt};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Parameters with their rendered tiles. A clone shares both, so undo renders nothing again.
#[derive(Clone)]
pub struct Live<T> {
    params: Arc<T>,
    rendered: Arc<RenderedTiles>,
    /// Whether marks of it have attachments of their own, once computed.
    has_attachments: Arc<OnceLock<bool>>,
    /// The box around what is painted, on the scene it was last computed for.
    painted_box: Arc<Mutex<Option<(Scene, Rect)>>>,
}

/// The tiles of one scene; replaced when the layer is rendered on another canvas or surface.
#[derive(Default)]
struct RenderedTiles {
    current: Mutex<Option<(Scene, Arc<TileCells>)>>,
}

/// One cell for each tile of the canvas, filled on first use.
struct TileCells {
    cols: i32,
    rows: i32,
    cells: Vec<OnceLock<Option<Arc<Tile>>>>,
    /// What the other sides of contour pixels see.
    far: Vec<OnceLock<FarPixels>>,
}

impl TileCells {
    fn for_scene(scene: &Scene) -> Self {
        let side = |n: u32| n.div_ceil(crate::raster::TILE as u32) as i32;
        let (cols, rows) = (side(scene.size.width), side(scene.size.height));
        // Only where there are contours.
        let contours = scene.surface.as_ref().filter(|surface| !surface.contours().is_empty());
        let far = contours.map_or(0, |_| cols * rows);
        Self {
            cols,
            rows,
            cells: (0..cols * rows).map(|_| OnceLock::new()).collect(),
            far: (0..far).map(|_| OnceLock::new()).collect(),
        }
    }

    fn index(&self, at: TileAt) -> Option<usize> {
        let inside = (0..self.cols).contains(&at.col) && (0..self.rows).contains(&at.row);
        inside.then_some((at.row * self.cols + at.col) as usize)
    }

    fn cell(&self, at: TileAt) -> Option<&OnceLock<Option<Arc<Tile>>>> {
        self.cells.get(self.index(at)?)
    }

    fn far_cell(&self, at: TileAt) -> Option<&OnceLock<FarPixels>> {
        self.far.get(self.index(at)?)
    }
}

impl<T> Live<T> {
    /// Parameters of which nothing is rendered yet.
    pub fn new(params: T) -> Self {
        Self {
            params: Arc::new(params),
            rendered: Arc::default(),
            has_attachments: Arc::default(),
            painted_box: Arc::default(),
        }
    }

    /// What the tiles are rendered from.
    pub fn params(&self) -> &T {
        &self.params
    }

    /// What was once found about the parameters is kept.
    pub(in crate::document) fn has_attachments(&self, sought: impl FnOnce(&T) -> bool) -> bool {
        *self.has_attachments.get_or_init(|| sought(&self.params))
    }

    /// The box around what is painted on a scene, computed once.
    pub(in crate::document) fn painted_box(
        &self,
        scene: &Scene,
        seek: impl FnOnce() -> Rect,
    ) -> Rect {
        let lock = || self.painted_box.lock().unwrap_or_else(PoisonError::into_inner);
        let known =
            lock().as_ref().filter(|(on, _)| on.is_same(scene)).map(|(_, painted)| *painted);
        known.unwrap_or_else(|| {
            // Without the lock: seeking lays strokes, and other threads take part in that.
            let painted = seek();
            *lock() = Some((scene.clone(), painted));
            painted
        })
    }

    /// New parameters that change only some tiles: the rendered tiles for which `keeps` is true are
    /// taken over.
    pub fn with(&self, params: T, keeps: impl Fn(TileAt) -> bool) -> Self {
        let next = Self::new(params);
        let current = self.lock().clone();
        if let Some((scene, old)) = current {
            let cells = TileCells::for_scene(&scene);
            for at in TileAt::covering(scene.size.rect()).filter(|&at| keeps(at)) {
                if let (Some(from), Some(to)) =
                    (old.cell(at).and_then(OnceLock::get), cells.cell(at))
                {
                    let _ = to.set(from.clone());
                }
                if let (Some(from), Some(to)) =
                    (old.far_cell(at).and_then(OnceLock::get), cells.far_cell(at))
                {
                    let _ = to.set(from.clone());
                }
            }
            *next.lock() = Some((scene, Arc::new(cells)));
        }
        next
    }

    /// New parameters whose tiles differ from these only in `tiles`, which are rendered already.
    /// Behind contours they count as the same until they are [`Live::settled`].
    ///
    /// * `scene`: what the layer sees. If it is not the rendered one, nothing is taken over.
    pub fn with_tiles(
        &self,
        params: T,
        scene: &Scene,
        tiles: impl IntoIterator<Item = (TileAt, Option<Arc<Tile>>)>,
    ) -> Self {
        let (old, cells) = (self.cells(scene), TileCells::for_scene(scene));
        for (at, tile) in tiles {
            cells.cell(at).map(|cell| cell.set(tile));
            cells.far_cell(at).map(|cell| cell.set(FarPixels::Same));
        }
        for (to, from) in cells.far.iter().zip(&old.far) {
            if let (None, Some(far)) = (to.get(), from.get()) {
                let _ = to.set(far.clone());
            }
        }
        for (to, from) in cells.cells.iter().zip(&old.cells) {
            if let (None, Some(tile)) = (to.get(), from.get()) {
                let _ = to.set(tile.clone());
            }
        }
        let next = Self::new(params);
        *next.lock() = Some((scene.clone(), Arc::new(cells)));
        next
    }

    /// The same, to be rendered behind contours where it only counted as the same.
    pub fn settled(&self) -> Self {
        let (params, has_attachments, painted_box) =
            (self.params.clone(), self.has_attachments.clone(), self.painted_box.clone());
        let next = Self { params, rendered: Arc::default(), has_attachments, painted_box };
        if let Some((scene, old)) = self.lock().clone() {
            let mut cells = TileCells::for_scene(&scene);
            cells.cells.clone_from(&old.cells);
            let known = |cell: &OnceLock<FarPixels>| match cell.get() {
                Some(FarPixels::Packed(packed)) => FarPixels::Packed(packed.clone()).into(),
                _ => OnceLock::new(),
            };
            cells.far = old.far.iter().map(known).collect();
            *next.lock() = Some((scene, Arc::new(cells)));
        }
        next
    }

    /// Whether a tile is known to look the same in both on this scene: rendered, and with the very
    /// same pixels.
    pub fn same_tiles(&self, other: &Self, scene: &Scene) -> impl Fn(TileAt) -> bool {
        let rendered = |live: &Self| {
            let current = live.lock();
            current.as_ref().filter(|(on, _)| on.is_same(scene)).map(|(_, cells)| cells.clone())
        };
        let both = rendered(self).zip(rendered(other));
        move |at| {
            let tile = |cells: &TileCells| {
                cells.cell(at)?.get().map(|tile| tile.as_ref().map(Arc::as_ptr))
            };
            let (Some(a), Some(b)) =
                (both.as_ref().map(|both| &both.0), both.as_ref().map(|both| &both.1))
            else {
                return false;
            };
            let far = |cells: &TileCells| cells.far_cell(at).and_then(OnceLock::get).cloned();
            let is_same_far_side = match (far(a), far(b)) {
                (Some(a), Some(b)) => a.is_same(&b),
                // Both are yet to be rendered, or one only counts as the same as its tile.
                (a, b) => {
                    !matches!((a, b), (Some(FarPixels::Same), None) | (None, Some(FarPixels::Same)))
                }
            };
            is_same_far_side && tile(a).is_some_and(|tile_a| Some(tile_a) == tile(b))
        }
    }

    /// A tile of the layer on a scene, rendered by `render` if it is not cached.
    pub fn tile(
        &self,
        scene: &Scene,
        at: TileAt,
        render: impl FnOnce() -> Option<Tile>,
    ) -> Option<Arc<Tile>> {
        let cells = self.cells(scene);
        once(cells.cell(at)?, || render().map(Arc::new)).clone()
    }

    /// The layer as the other sides of a tile's contour pixels see it, rendered by `render`
    /// if it is not cached.
    ///
    /// * `stays`: where they see no surface the tile's own pixels stay; else there are none.
    pub(in crate::document) fn far_side(
        &self,
        scene: &FarScene,
        stays: bool,
        render: impl Fn(&Scene, TileAt) -> Option<Tile>,
    ) -> TileContent {
        let (far_tile, cells) = (scene.tile, self.cells(scene.front));
        let own = || self.tile(scene.front, far_tile.at, || render(scene.front, far_tile.at));
        let Some(cell) = cells.far_cell(far_tile.at) else { return TileContent::Nothing };
        let packed = || {
            let on_far_side = scene.far.and_then(|far| render(far, far_tile.at));
            let bare = if stays && far_tile.has_bare() { own() } else { None };
            FarPixels::Packed(Arc::new(far_tile.pack(on_far_side.as_ref(), bare.as_deref())))
        };
        match once(cell, packed) {
            FarPixels::Packed(packed) => TileContent::Packed(packed.clone()),
            FarPixels::Same => own().map_or(TileContent::Nothing, |tile| {
                TileContent::Packed(Arc::new(far_tile.same(&tile)))
            }),
        }
    }

    /// Takes in what was rendered behind the contours of a tile.
    pub(in crate::document) fn set_far_side(&self, scene: &FarScene, on_far_side: Option<Tile>) {
        let bare =
            if scene.tile.has_bare() { self.render_tile(scene.front, scene.tile.at) } else { None };
        let packed =
            FarPixels::Packed(Arc::new(scene.tile.pack(on_far_side.as_ref(), bare.as_deref())));
        self.cells(scene.front).far_cell(scene.tile.at).map(|cell| cell.set(packed));
    }

    fn render_tile(&self, scene: &Scene, at: TileAt) -> Option<Arc<Tile>> {
        self.cells(scene).cell(at)?.get().cloned().flatten()
    }

    /// The tiles of the canvas that were not rendered behind their contours, of those with a
    /// surface there.
    pub fn missing_far_sides(&self, scene: &Scene) -> Vec<TileAt> {
        let (cells, contours) =
            (self.cells(scene), scene.surface.as_ref().map(|surface| surface.contours().clone()));
        let is_missing = |at: &TileAt| cells.far_cell(*at).is_some_and(|cell| cell.get().is_none());
        contours.map_or(Vec::new(), |contours| contours.seen_tiles().filter(is_missing).collect())
    }

    /// The tiles of the canvas that were not rendered on a scene, row by row.
    pub fn missing(&self, scene: &Scene) -> Vec<TileAt> {
        let cells = self.cells(scene);
        let is_missing = |at: &TileAt| cells.cell(*at).is_some_and(|cell| cell.get().is_none());
        TileAt::covering(scene.size.rect()).filter(is_missing).collect()
    }

    /// Counts the rendered tiles, unless they were; `keeps`: otherwise they are freed.
    pub(in crate::document) fn count_rendered(&self, count: &mut MemoryCount, keeps: bool) {
        if !count.is_new(&self.rendered) {
            return;
        }
        let mut current = self.lock();
        if !keeps {
            *current = None;
        }
        let Some((_, cells)) = &*current else { return };
        for tile in cells.cells.iter().filter_map(OnceLock::get).flatten() {
            if count.is_new(tile) {
                count.add_kept(tile.held_bytes());
            }
        }
        for far in cells.far.iter().filter_map(OnceLock::get) {
            if let FarPixels::Packed(packed) = far
                && count.is_new(packed)
            {
                count.add_kept(packed.held_bytes());
            }
        }
    }

    /// Both are the same value with the same rendered tiles.
    pub fn ptr_eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.params, &other.params)
    }

    fn cells(&self, scene: &Scene) -> Arc<TileCells> {
        let mut current = self.lock();
        match &*current {
            Some((s, cells)) if s.is_same(scene) => cells.clone(),
            _ => {
                let cells = Arc::new(TileCells::for_scene(scene));
                *current = Some((scene.clone(), cells.clone()));
                cells
            }
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Option<(Scene, Arc<TileCells>)>> {
        self.rendered.current.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    #[test]
    fn a_tile_is_rendered_once_and_kept_through_clones() {
        let scene = Scene { size: Size::new(100, 100), surface: None };
        let live = Live::new(3);
        let at = TileAt::new(1, 0);
        let blank = || Tile::from_bytes(vec![255; 64 * 64 * 4]);
        let first = live.tile(&scene, at, blank).unwrap();
        let again = live.clone().tile(&scene, at, || unreachable!()).unwrap();
        assert!(Arc::ptr_eq(&first, &again));
        assert!(
            live.tile(&scene, TileAt::new(2, 0), blank).is_none(),
            "beyond the canvas there are no tiles"
        );
    }

    #[test]
    fn tiles_that_come_rendered_are_taken_and_the_others_stay() {
        let scene = Scene { size: Size::new(128, 64), surface: None };
        let blank = || Tile::from_bytes(vec![255; 64 * 64 * 4]);
        let (left, right) = (TileAt::new(0, 0), TileAt::new(1, 0));
        let live = Live::new(1);
        live.tile(&scene, left, blank);
        live.tile(&scene, right, blank);
        let next = live.with_tiles(2, &scene, [(right, None), (TileAt::new(9, 9), None)]);
        let same = next.same_tiles(&live, &scene);
        assert!(same(left) && !same(right) && !same(TileAt::new(9, 9)));
        assert!(next.tile(&scene, right, || unreachable!()).is_none());
        let elsewhere = Scene { size: Size::new(128, 65), surface: None };
        assert!(!next.same_tiles(&live, &elsewhere)(left), "on another canvas nothing is known");
    }

    #[test]
    fn new_parameters_keep_the_tiles_they_do_not_touch() {
        let scene = Scene { size: Size::new(128, 64), surface: None };
        let live = Live::new(1);
        let blank = || Tile::from_bytes(vec![255; 64 * 64 * 4]);
        let (left, right) = (TileAt::new(0, 0), TileAt::new(1, 0));
        let kept = live.tile(&scene, left, blank).unwrap();
        live.tile(&scene, right, blank);
        let next = live.with(2, |at| at == left);
        assert!(Arc::ptr_eq(&kept, &next.tile(&scene, left, || unreachable!()).unwrap()));
        assert!(next.tile(&scene, right, || None).is_none());
    }
}
