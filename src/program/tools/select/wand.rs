//! The wand: all pixels of a color like the one under the pen, joined to it or everywhere; a drag
//! to the right or the left changes the tolerance. Floor 5. Not here: finding the region
//! (`paint::fill`).

use super::{adjust, combine_selections, drag_tolerance};
use crate::document::{Content, Document, PreparedDocument, Progress};
use crate::math::{Rect, Vec2};
use crate::paint::{Fill, Selection};
use crate::raster::coverage::SelectionMode;
use crate::raster::{Tile, TileAt, TileGrid};
use crate::surface::objects::CanvasPart;
use crate::tools::{Gesture, GestureStart, Outcome, PenSample, SelectSettings, ToolContext};
use std::sync::{Arc, OnceLock};

pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let (settings, document) = (context.tools.select, context.document);
    let at = pen.place().floor().as_ivec2();
    if !pen.place().is_finite() || !document.size.rect().contains(at.x, at.y) {
        return (
            None,
            Outcome::Refused(
                "Click on the canvas: the wand selects what is like the pixel you click.".into(),
            ),
        );
    }
    let picture = match layer_alone(context) {
        Some(tiles) if settings.wand.layer_alone => WandSource::Layer(tiles),
        _ => match PreparedDocument::new(document, &Progress::default()) {
            Some(prepared) => WandSource::new(prepared, document.size.rect()),
            None => return (None, Outcome::Idle),
        },
    };
    let mut gesture = WandGesture {
        how: settings.how(pen.keys),
        part: settings.wand.bounded.from(document.surface.as_ref(), pen.place()),
        document: document.clone(),
        picture,
        from: pen.place(),
        begun: settings,
        settings,
        px_per_pt: context.px_per_pt,
        shown: None,
    };
    let outcome = gesture.drag(&[pen]);
    (Some(Box::new(gesture)), outcome)
}

fn layer_alone(context: &ToolContext) -> Option<TileGrid> {
    match &context.document.layer(context.layer?)?.content {
        Content::Pixels(pixels) => Some(pixels.tiles.clone()),
        _ => None,
    }
}

/// What the wand reads; each tile is flattened once, however the tolerance changes.
enum WandSource {
    Layer(TileGrid),
    Whole { prepared: Box<PreparedDocument>, columns: i32, tiles: Vec<OnceLock<Option<Arc<Tile>>>> },
}

impl WandSource {
    fn new(prepared: PreparedDocument, canvas: Rect) -> Self {
        let tiles: Vec<_> = TileAt::covering(canvas).map(|_| OnceLock::new()).collect();
        let columns = TileAt::of_pixel(canvas.x1 - 1, 0).col + 1;
        Self::Whole { prepared: Box::new(prepared), columns, tiles }
    }

    fn tile(&self, at: TileAt) -> Option<Arc<Tile>> {
        match self {
            WandSource::Layer(tiles) => tiles.tile(at).cloned(),
            WandSource::Whole { prepared, columns, tiles } => {
                let cell = tiles.get((at.row * columns + at.col) as usize)?;
                crate::memory::once(cell, || prepared.flatten_tile(at)).clone()
            }
        }
    }
}

struct WandGesture {
    document: Document,
    how: SelectionMode,
    part: CanvasPart,
    picture: WandSource,
    from: Vec2,
    begun: SelectSettings,
    /// With the tolerance of the drag so far.
    settings: SelectSettings,
    px_per_pt: f32,
    /// The last selection, and its tolerance.
    shown: Option<(f32, Document)>,
}

impl WandGesture {
    fn select_found(&mut self) -> Option<Document> {
        let tolerance = self.settings.wand.tolerance;
        if let Some((_, document)) = self.shown.as_ref().filter(|(known, _)| *known == tolerance) {
            return Some(document.clone());
        }
        let (fill, size): (Fill, _) = (self.settings.wand, self.document.size);
        let read = |at: TileAt| self.picture.tile(at);
        let coverage =
            fill.find_coverage(self.from, size, &self.part, !self.settings.joined, read)?;
        let document = combine_selections(&self.document, Selection::new(coverage), self.how);
        self.shown = Some((tolerance, document.clone()));
        Some(document)
    }

    fn outcome(&mut self, is_done: bool) -> Outcome {
        let select = self.settings;
        self.select_found().map_or(Outcome::Cancel, |document| adjust(document, select, is_done))
    }
}

impl Gesture for WandGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let by_px = pen.place().x - self.from.x;
        let range = SelectSettings::TOLERANCE;
        self.settings.wand.tolerance =
            drag_tolerance(self.begun.wand.tolerance, by_px, self.px_per_pt, &range);
        self.outcome(false)
    }

    fn release(&mut self) -> Outcome {
        self.outcome(true)
    }
}
