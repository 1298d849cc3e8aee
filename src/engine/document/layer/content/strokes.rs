//! Strokes, kept live. Floor 4. Not here: their rendering (`paint::stroke`), edits of single
//! strokes (`document::strokes`).

use super::{
    CanvasScale, Changed, Content, FarScene, FarTile, LayerKind, NameFile, TileContent, VisibleArea,
};
use crate::Result;
use crate::document::layer::marks::{Done, Marks};
use crate::document::{LayerMap, Live, MemoryCount, Progress};
use crate::math::{PlaneMap, Vec2, vec2};
use crate::paint::{Scene, Selection, Stroke, StrokeSelection, stroke};
use crate::raster::warp::warp_plane_onto;
use crate::raster::{CoverageGrid, PlanarTile, TileAt};
use crate::surface::{Bend, Deformation};
use std::collections::HashMap;
use std::sync::Arc;

/// The strokes of a stroke layer, in the order they were painted. Shared, so that adding one copies
/// pointers.
#[derive(Clone, Default)]
pub struct StrokeList {
    /// The first one lies lowest.
    pub strokes: Vec<Arc<Stroke>>,
}

impl Marks for StrokeList {
    fn pixels(&self, scene: &Scene, at: TileAt) -> Option<PlanarTile> {
        stroke::render_pixels(&self.strokes, scene, at)
    }

    /// Strokes whose dabs are too many to be kept would be laid again for every tile.
    fn render_together(&self, scene: &Scene, tiles: &[TileAt], progress: &Progress, done: &Done) {
        let is_wanted = || !progress.is_canceled();
        let seen: Vec<TileAt> =
            tiles.iter().copied().filter(|&at| !scene.area(at).is_empty()).collect();
        if !seen.is_empty()
            && stroke::are_heavy(&self.strokes, &scene.front(), seen.len(), is_wanted) == Some(true)
        {
            // Once canceled, nothing is needed any more.
            let _ = stroke::render_many(&self.strokes, scene, &seen, is_wanted, done);
        }
    }
}

impl LayerKind for Live<StrokeList> {
    fn name(&self) -> &'static str {
        "strokes"
    }

    fn label(&self) -> &'static str {
        "Strokes"
    }

    fn render_tile(&self, scene: &Scene, at: TileAt) -> TileContent {
        TileContent::of_tile(
            self.tile(scene, at, || stroke::render_tile(&self.params().strokes, scene, at)),
        )
    }

    /// For strokes with too many dabs to cache, the tiles as well: tile by tile, each stroke would
    /// be laid again and again.
    fn render_far_side_tile(&self, scene: &FarScene) -> TileContent {
        self.far_side(scene, true, |scene, at| {
            stroke::render_tile(&self.params().strokes, scene, at)
        })
    }

    fn count(&self, count: &mut MemoryCount, keeps: bool) {
        self.count_rendered(count, keeps);
        self.params().strokes.iter().for_each(|stroke| count.add_stroke(stroke));
    }

    fn marks(&self) -> Option<&dyn Marks> {
        Some(self.params())
    }

    fn warm(&self, scene: &Scene, progress: &Progress) {
        for stroke in &self.params().strokes {
            let bend = Bend { operator: stroke.operator(), ..Bend::default() };
            Deformation::new(scene.surface.as_deref(), scene.size, &bend);
        }
        warm_strokes(self, &self.params().strokes, scene, progress);
    }

    fn warm_far_side(&self, far: &Scene, progress: &Progress) {
        warm_far_sides(self, &self.params().strokes, far, progress);
    }

    fn scaled(&self, scale: &CanvasScale) -> Content {
        self.with_each(|stroke| Arc::new(scale.stroke(stroke)))
    }

    fn moved(&self, by: Vec2) -> Option<Content> {
        Some(self.with_each(|stroke| Arc::new(stroke.moved(by))))
    }

    fn on_canvas(&self, map: &LayerMap, last: Option<(&Content, &Content)>) -> Option<Content> {
        // A stroke that was seen before is the very same one again, with its dabs.
        let seen: HashMap<*const Stroke, &Arc<Stroke>> = match last {
            Some((Content::Strokes(own), Content::Strokes(seen))) => {
                own.params().strokes.iter().map(Arc::as_ptr).zip(&seen.params().strokes).collect()
            }
            _ => HashMap::new(),
        };
        let mut selections = Vec::new();
        let mut on_canvas = |stroke: &Arc<Stroke>| match seen.get(&Arc::as_ptr(stroke)) {
            Some(seen) => Arc::clone(seen),
            None => {
                let own = stroke.attachment().map(|attachment| map.of_stroke(attachment));
                move_stroke(stroke, own.as_ref().unwrap_or(map), &mut selections)
            }
        };
        let strokes = self.params().strokes.iter().map(&mut on_canvas).collect();
        Some(Content::Strokes(Live::new(StrokeList { strokes })))
    }

    fn has_attachments(&self) -> bool {
        Live::has_attachments(self, |list| {
            list.strokes.iter().any(|stroke| stroke.attachment().is_some())
        })
    }

    fn without_paint(&self) -> Option<Content> {
        Some(Content::Strokes(Live::new(StrokeList::default())))
    }

    fn files(&self) -> Vec<&str> {
        let pictures = self.params().strokes.iter().flat_map(|stroke| stroke.brush().pictures());
        pictures.map(|source| source.file.as_str()).collect()
    }

    fn with_files(&self, name: &mut NameFile) -> Result<Option<Content>> {
        let mut renamed = |stroke: &Arc<Stroke>| {
            if stroke.brush().pictures().next().is_none() {
                return Ok(stroke.clone());
            }
            let brush = stroke.brush().with_pictures(|source| {
                let mut source = source.clone();
                source.file = name(&source.file, &source.picture)?;
                Ok::<_, crate::Error>(source)
            })?;
            Ok(Arc::new(stroke.with_brush(brush)))
        };
        let strokes = self.params().strokes.iter().map(&mut renamed).collect::<Result<_>>()?;
        Ok(Some(Content::Strokes(Live::new(StrokeList { strokes }))))
    }

    fn visible_area(&self, scene: Option<&Scene>) -> VisibleArea {
        let strokes = &self.params().strokes;
        match scene {
            Some(scene) => {
                VisibleArea::Rects(strokes.iter().map(|stroke| stroke.bounds(scene)).collect())
            }
            None if strokes.is_empty() => VisibleArea::Nowhere,
            // Bounds hold for one surface.
            None => VisibleArea::Canvas,
        }
    }

    /// Where both are rendered, their tiles show it.
    fn difference_from(&self, old: &Content, scene: &dyn Fn() -> Scene) -> Changed {
        let Content::Strokes(old) = old else { return Changed::Wholly };
        if self.ptr_eq(old) {
            return Changed::Nowhere;
        }
        let scene = scene();
        let (same, canvas) = (old.same_tiles(self, &scene), scene.size.rect());
        let differing = differing(&old.params().strokes, &self.params().strokes);
        let tiles =
            differing.flat_map(|stroke| TileAt::covering(stroke.bounds(&scene).intersect(canvas)));
        Changed::Tiles(tiles.filter(|&at| !same(at)).collect())
    }
}

/// Renders the tiles of strokes that are better rendered together.
pub(super) fn warm_strokes<T: Send + Sync>(
    live: &Live<T>,
    strokes: &[Arc<Stroke>],
    scene: &Scene,
    progress: &Progress,
) {
    let (missing, is_wanted) = (live.missing(scene), || !progress.is_canceled());
    if !missing.is_empty()
        && stroke::are_heavy(strokes, scene, missing.len(), is_wanted) == Some(true)
    {
        // Once canceled, they are rendered when needed.
        let _ = stroke::render_tiles(strokes, scene, &missing, is_wanted, |at, tile| {
            live.tile(scene, at, || tile);
        });
    }
}

/// The same behind contours.
pub(super) fn warm_far_sides<T: Send + Sync>(
    live: &Live<T>,
    strokes: &[Arc<Stroke>],
    far: &Scene,
    progress: &Progress,
) {
    let (front, is_wanted) = (far.front(), || !progress.is_canceled());
    let missing = live.missing_far_sides(&front);
    if missing.is_empty()
        || stroke::are_heavy(strokes, &front, missing.len(), is_wanted) != Some(true)
    {
        return;
    }
    let Some(surface) = &front.surface else { return };
    let _ = stroke::render_tiles(strokes, far, &missing, is_wanted, |at, tile| {
        let Some(contours) = surface.contours().on(at) else { return };
        live.set_far_side(
            &FarScene { tile: FarTile::new(at, contours), front: &front, far: Some(far) },
            tile,
        );
    });
}

impl Live<StrokeList> {
    fn with_each(&self, change: impl Fn(&Arc<Stroke>) -> Arc<Stroke>) -> Content {
        let strokes = self.params().strokes.iter().map(change).collect();
        Content::Strokes(Live::new(StrokeList { strokes }))
    }
}

/// Selections that were sampled under a map, by their addresses: those of the strokes, which live
/// on.
pub(in crate::document) type SeenSelections =
    Vec<(LayerMap, HashMap<*const Selection, Arc<Selection>>)>;

/// A stroke moved by a map; one that does not move is the very same.
pub(in crate::document) fn move_stroke(
    stroke: &Arc<Stroke>,
    map: &LayerMap,
    selections: &mut SeenSelections,
) -> Arc<Stroke> {
    if map.is_none() {
        return stroke.clone();
    }
    let mapped =
        stroke.mapped(&|p| map.plane.to_canvas(p), |p| map.length_at(p), |p| map.turn_at(p));
    let Some(own) = stroke.selection() else { return Arc::new(mapped) };
    let place = selections.iter().position(|(known, _)| known == map).unwrap_or_else(|| {
        selections.push((*map, HashMap::new()));
        selections.len() - 1
    });
    let selection = selections.get_mut(place).map(|(_, known)| place_selection(own, map, known));
    Arc::new(mapped.within(selection))
}

/// The selection of a stroke as it lies on the canvas, sampled once for all strokes that share it
/// unmoved.
fn place_selection(
    own: &StrokeSelection,
    map: &LayerMap,
    known: &mut HashMap<*const Selection, Arc<Selection>>,
) -> StrokeSelection {
    let warped = || {
        let (canvas, coverage) = (map.canvas(), own.coverage());
        // There may be some beyond the canvas of its own frame, too; a little more, so that it
        // ends.
        let rect = coverage.covered_rect().grown(2).intersect(map.plane.source_rect(canvas.rect()));
        if rect.is_empty() {
            return Arc::default();
        }
        let corner = PlaneMap::translation(vec2(rect.x0 as f32, rect.y0 as f32));
        let from_corner = map.after(&corner);
        let warped = warp_plane_onto(&coverage.to_plane(rect), &from_corner, map.filter, canvas);
        Arc::new(Selection::new(CoverageGrid::from_plane(&warped, 0, 0)))
    };
    StrokeSelection::new(match own.moved == Vec2::ZERO {
        true => known.entry(Arc::as_ptr(&own.selection)).or_insert_with(warped).clone(),
        false => warped(),
    })
}

/// Strokes are painted in order, so those between a common beginning and a common end may change
/// what they touch.
fn differing<'s>(
    old: &'s [Arc<Stroke>],
    new: &'s [Arc<Stroke>],
) -> impl Iterator<Item = &'s Arc<Stroke>> {
    let same = |(a, b): &(&Arc<Stroke>, &Arc<Stroke>)| Arc::ptr_eq(a, b);
    let start = old.iter().zip(new).take_while(same).count();
    let (old, new) = (&old[start..], &new[start..]);
    let end = old.iter().rev().zip(new.iter().rev()).take_while(same).count();
    old[..old.len() - end].iter().chain(&new[..new.len() - end])
}
