//! The liquify tool: strokes that displace what the selected layer or group shows. The layer itself
//! stays as it is. Floor 5. Not here: what a dab does (`paint::liquify`).

use super::{Gesture, GestureStart, Outcome, PenSample, ToolContext, closed};
use crate::document::symmetry::SymmetryImage;
use crate::document::{Content, Document, LayerId};
use crate::paint::{LiquifySettings, LiquifyStroke, LiquifyTool};
use crate::raster::Lattice;
use std::sync::Arc;

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let document = context.document;
    let Some(layer) = context.layer.and_then(|id| document.layer(id)) else {
        return (None, Outcome::Refused("Select a layer or a group to liquify.".into()));
    };
    if let Some(why) = closed::unpaintable(document, layer) {
        return (None, Outcome::Refused(why.into()));
    }
    let why = match &layer.content {
        Content::Fill(_) => Some("A layer of one color looks the same when it is displaced."),
        content if !content.can_be_warped() => {
            Some("This layer shows nothing of its own that could be displaced.")
        }
        _ => None,
    };
    let map = document.map_of(layer.id);
    let (Some(map), None) = (map, why) else {
        return (None, why.map_or(Outcome::Idle, |why| Outcome::Refused(why.into())));
    };
    // Ctrl reverses what a tool does, Shift smooths.
    let tool = match context.tools.liquify.tool {
        _ if pen.keys.shift => LiquifyTool::Smooth,
        LiquifyTool::Grow if pen.keys.ctrl => LiquifyTool::Shrink,
        LiquifyTool::Shrink if pen.keys.ctrl => LiquifyTool::Grow,
        LiquifyTool::TwirlLeft if pen.keys.ctrl => LiquifyTool::TwirlRight,
        LiquifyTool::TwirlRight if pen.keys.ctrl => LiquifyTool::TwirlLeft,
        _ if pen.keys.ctrl => LiquifyTool::Restore,
        tool => tool,
    };
    let settings = LiquifySettings { tool, ..context.tools.liquify };
    let selection = document.active_selection.as_ref().map(|selection| selection.coverage.clone());
    let of_image = |image: SymmetryImage| {
        let tool = if image.is_mirrored() { tool.mirrored() } else { tool };
        let (settings, at) = (LiquifySettings { tool, ..settings }, image.sample(&pen.sample).at);
        (
            image,
            LiquifyStroke::new(
                settings,
                document.scene(),
                selection.clone(),
                map.map_outside_own(),
                at,
            ),
        )
    };
    let images = document.symmetry.images(document.size);
    let strokes: Vec<(SymmetryImage, LiquifyStroke)> = images.into_iter().map(of_image).collect();
    let old = layer.liquify.clone();
    let mut lattice = old.as_deref().cloned().unwrap_or_default();
    strokes.iter().for_each(|(_, stroke)| stroke.begin(&mut lattice, pen.sample.pressure));
    let gesture =
        LiquifyGesture { document: document.clone(), layer: layer.id, old, lattice, strokes };
    let outcome = gesture.preview();
    (Some(Box::new(gesture)), outcome)
}

struct LiquifyGesture {
    document: Document,
    layer: LayerId,
    old: Option<Arc<Lattice>>,
    lattice: Lattice,
    /// The stroke, then its mirror images.
    strokes: Vec<(SymmetryImage, LiquifyStroke)>,
}

impl LiquifyGesture {
    fn with(&self) -> Option<Document> {
        let next = (!self.lattice.is_empty()).then(|| Arc::new(self.lattice.clone()));
        self.document.with_layer(self.layer, |layer| layer.liquify = next)
    }

    fn preview(&self) -> Outcome {
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }
}

impl Gesture for LiquifyGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        for pen in pens {
            for (image, stroke) in &mut self.strokes {
                stroke.draw_to(
                    &mut self.lattice,
                    image.sample(&pen.sample).at,
                    pen.sample.pressure,
                );
            }
        }
        self.preview()
    }

    fn release(&mut self) -> Outcome {
        let is_same = match &self.old {
            Some(old) => **old == self.lattice,
            None => self.lattice.is_empty(),
        };
        match self.with().filter(|_| !is_same) {
            Some(document) => Outcome::Commit { label: "Liquify".into(), document, select: None },
            None => Outcome::Cancel,
        }
    }
}

#[cfg(test)]
mod tests;
