//! An ink layer: the ink of a drawing beneath, which stays as it was drawn, whatever light falls on
//! the rest of the drawing. Floor 4. Not here: lifting the ink (`shape::flats`), when that is
//! done (`ink_layers`).

use super::{CanvasScale, Changed, Content, FarScene, LayerKind, TileContent, VisibleArea};
use crate::document::layer::map::LayerMap;
use crate::document::layer::transform::LayerTransform;
use crate::document::memory_use::MemoryCount;
use crate::paint::Scene;
use crate::raster::{Lattice, TileAt, TileGrid};
use crate::shape::flats::lifted_ink::LiftedInk;
use std::sync::Arc;

/// The lines of a drawing, on top.
#[derive(Clone, Default)]
pub struct InkLayer {
    /// The name of the drawing: a paint layer, or a group of them.
    pub of: String,
    /// What follows from the drawing as it is; absent until it is made.
    pub shown: Option<Arc<ShownInk>>,
}

/// Lines where they lie on the canvas, and what they were made of.
pub struct ShownInk {
    pub sources: Vec<InkSource>,
    pub tiles: TileGrid,
}

/// Ink, and where it lies.
#[derive(Clone)]
pub struct InkSource {
    pub ink: Arc<LiftedInk>,
    pub map: LayerMap,
    /// What displaces it: its layer's mesh and liquify.
    pub transform: Option<LayerTransform>,
    pub liquify: Option<Arc<Lattice>>,
}

impl PartialEq for InkSource {
    fn eq(&self, other: &Self) -> bool {
        let liquify = |source: &Self| source.liquify.as_ref().map(Arc::as_ptr);
        Arc::ptr_eq(&self.ink, &other.ink)
            && self.map == other.map
            && self.transform == other.transform
            && liquify(self) == liquify(other)
    }
}

impl InkLayer {
    /// Of a drawing, by its name.
    pub fn of(drawing: impl Into<String>) -> Self {
        Self { of: drawing.into(), shown: None }
    }

    /// Whether both show the same for certain.
    pub(in crate::document) fn is_identical(&self, other: &Self) -> bool {
        self.shown.as_ref().map(Arc::as_ptr) == other.shown.as_ref().map(Arc::as_ptr)
    }

    /// Whether it shows anything.
    pub fn has_any(&self) -> bool {
        self.tiles().is_some_and(|tiles| !tiles.bounds().is_empty())
    }

    fn tiles(&self) -> Option<&TileGrid> {
        self.shown.as_ref().map(|shown| &shown.tiles)
    }
}

impl LayerKind for InkLayer {
    fn name(&self) -> &'static str {
        "ink"
    }

    fn label(&self) -> &'static str {
        "Ink"
    }

    fn count(&self, count: &mut MemoryCount, _keeps: bool) {
        for source in self.shown.iter().flat_map(|shown| &shown.sources) {
            count.add_tiles(&source.ink.flats);
            count.add_tiles(&source.ink.lines);
        }
        self.tiles().into_iter().for_each(|tiles| count.add_tiles(tiles));
    }

    fn render_tile(&self, _scene: &Scene, at: TileAt) -> TileContent {
        TileContent::of_tile(self.tiles().and_then(|tiles| tiles.tile(at)).cloned())
    }

    fn render_far_side_tile(&self, scene: &FarScene) -> TileContent {
        let tile = self.tiles().and_then(|tiles| tiles.tile(scene.tile.at));
        tile.map_or(TileContent::Nothing, |tile| {
            TileContent::Packed(Arc::new(scene.tile.same(tile)))
        })
    }

    fn scaled(&self, _scale: &CanvasScale) -> Content {
        // It follows the drawing.
        Content::Ink(Self::of(self.of.clone()))
    }

    fn is_tied_to_shape(&self) -> bool {
        false
    }

    fn visible_area(&self, _scene: Option<&Scene>) -> VisibleArea {
        VisibleArea::Tiles(
            self.tiles().into_iter().flat_map(|tiles| tiles.iter()).map(|(at, _)| at).collect(),
        )
    }

    fn difference_from(&self, old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        match old {
            Content::Ink(old) => {
                let none = TileGrid::default();
                let tiles = |lines: &Self| lines.tiles().unwrap_or(&none).clone();
                Changed::Tiles(tiles(old).changed_tiles(&tiles(self)))
            }
            _ => Changed::Wholly,
        }
    }
}
