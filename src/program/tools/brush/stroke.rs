//! A stroke between the pen coming down and lifting, and its mirror images: live on a stroke layer,
//! pixels on a paint layer. Floor 5.

use crate::document::symmetry::SymmetryImage;
use crate::document::{Content, Document, LayerId, Live, PixelLayer, StrokeList};
use crate::paint::{Sample, Scene, StabilizedPen, Stroke};
use crate::raster::{Tile, TileAt, TileGrid};
use crate::tools::retouch::ActiveWork;
use crate::tools::{Gesture, Outcome, PenSample};
use std::sync::Arc;

/// Where the strokes go.
pub(super) enum StrokeTarget {
    Strokes { beneath: Vec<Arc<Stroke>>, shown: Live<StrokeList> },
    Pixels { base: PixelLayer, shown: TileGrid },
}

/// A stroke being drawn, and its mirror images.
pub(super) struct StrokeGesture {
    /// The document before the stroke, with the layer that takes the stroke.
    pub document: Document,
    pub layer: LayerId,
    /// What the layer sees.
    pub scene: Scene,
    pub target: StrokeTarget,
    /// `None` once it is finished.
    pub active: Option<ActiveWork>,
    pub images: Vec<SymmetryImage>,
    pub stabilized: StabilizedPen,
    /// Samples before the pen's first.
    pub lead: Vec<Sample>,
    /// How many more a stroke may have; `None` once the user was told that there are none.
    pub room: Option<usize>,
    pub label: &'static str,
}

impl StrokeGesture {
    /// Continues the drawing with more samples; returns the tiles that changed.
    fn draw(&mut self, mut samples: Vec<Sample>) -> Vec<(TileAt, Option<Arc<Tile>>)> {
        let Some(active) = &mut self.active else { return Vec::new() };
        // What files cannot hold is not drawn.
        samples.truncate(self.room.unwrap_or_default());
        self.room = self.room.map(|room| room - samples.len());
        let of_image = |image: &SymmetryImage| {
            samples.iter().map(|sample| image.sample(sample).normalized()).collect()
        };
        let samples: Vec<Vec<Sample>> = self.images.iter().map(of_image).collect();
        let tiles = active.draw(&samples);
        if let StrokeTarget::Pixels { shown, .. } = &mut self.target {
            tiles.iter().for_each(|(at, tile)| shown.set(*at, tile.clone()));
        }
        tiles
    }

    /// The document with the strokes, of which these tiles changed.
    fn with(
        &mut self,
        strokes: Vec<Stroke>,
        tiles: Vec<(TileAt, Option<Arc<Tile>>)>,
    ) -> Option<Document> {
        let content = match &mut self.target {
            StrokeTarget::Strokes { beneath, shown } => {
                let strokes =
                    beneath.iter().cloned().chain(strokes.into_iter().map(Arc::new)).collect();
                *shown = shown.with_tiles(StrokeList { strokes }, &self.scene, tiles);
                Content::Strokes(shown.clone())
            }
            // Painted pixels no longer match the file.
            StrokeTarget::Pixels { base, shown } => {
                Content::Pixels(PixelLayer { tiles: shown.clone(), ..base.clone() })
            }
        };
        self.document.with_layer(self.layer, |layer| layer.content = content)
    }
}

impl Gesture for StrokeGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        match self.room {
            Some(0) => {
                self.room = None;
                return Outcome::Refused(
                    "A stroke cannot be longer. Lift the pen to begin another.".into(),
                );
            }
            None => return Outcome::Idle,
            Some(_) => {}
        }
        let mut samples = std::mem::take(&mut self.lead);
        samples.extend(pens.iter().filter_map(|pen| self.stabilized.push(pen.sample)));
        let tiles = self.draw(samples);
        let strokes = self.active.as_ref().map_or(Vec::new(), ActiveWork::strokes);
        self.with(strokes, tiles).map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        let rest = self.stabilized.finish().into_iter().collect();
        let tiles = self.draw(rest);
        let strokes = self.active.take().map_or(Vec::new(), ActiveWork::finish);
        let Some(mut document) = self.with(strokes, tiles) else { return Outcome::Cancel };
        if let StrokeTarget::Strokes { shown, .. } = &self.target {
            // Behind contours strokes are rendered once they are finished.
            let content = Content::Strokes(shown.settled());
            document = document
                .with_layer(self.layer, |layer| layer.content = content)
                .unwrap_or(document);
        }
        Outcome::Commit { label: self.label.into(), document, select: Some(self.layer) }
    }
}
