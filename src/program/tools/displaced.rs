//! Strokes on a layer that a mesh or liquify displaces: they go where the layer shows what is under
//! the pen, so that the paint appears there. Floor 5. Not here: the displacement itself
//! (`document::layer::warp`).

use super::purpose::{BrushTarget, StrokePurpose};
use super::snap::SnapLines;
use super::{Gesture, GestureStart, Outcome, PenSample, ToolContext, stroke_in_place};
use crate::document::{Content, LayerWarp};
use crate::math::Vec2;
use crate::paint::Sample;

/// The warps of what a stroke would change, the outermost group's first. A layer that holds no
/// strokes gets a layer above it, which only the groups around it displace.
pub fn warps(context: &ToolContext) -> Vec<LayerWarp> {
    let document = context.document;
    let Some(layer) = context.layer.and_then(|id| document.layer(id)) else { return Vec::new() };
    let holds_strokes = matches!(layer.content, Content::Strokes(_) | Content::Pixels(_));
    match context.target {
        BrushTarget::Selection => Vec::new(),
        BrushTarget::Layer if !holds_strokes => document.warps_around(layer.id),
        BrushTarget::Layer | BrushTarget::Mask => document.warps_of(layer.id),
    }
}

/// The brush or the eraser comes down on a displaced layer.
pub fn press(
    context: &ToolContext,
    pen: PenSample,
    warps: Vec<LayerWarp>,
    purpose: StrokePurpose,
) -> GestureStart {
    let undisplaced = Undisplaced(warps);
    let last_end = context.last_end.map(|at| undisplaced.point(at));
    let inner = ToolContext { last_end, ..*context };
    let (stroke, outcome) = stroke_in_place(&inner, undisplaced.pen(&pen), purpose);
    let end = pen.place();
    (
        stroke.map(|stroke| {
            Box::new(DisplacedStroke { undisplaced, stroke, end }) as Box<dyn Gesture>
        }),
        outcome,
    )
}

/// From the canvas to the layer as it would be without its warps.
struct Undisplaced(Vec<LayerWarp>);

impl Undisplaced {
    fn point(&self, on_canvas: Vec2) -> Vec2 {
        self.0.iter().fold(on_canvas, |at, warp| warp.source_of(at))
    }

    fn pen(&self, pen: &PenSample) -> PenSample {
        PenSample { sample: Sample { at: self.point(pen.place()), ..pen.sample }, ..*pen }
    }
}

struct DisplacedStroke {
    undisplaced: Undisplaced,
    stroke: Box<dyn Gesture>,
    /// Where the pen is, on the canvas.
    end: Vec2,
}

impl Gesture for DisplacedStroke {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        self.end = pens.last().map_or(self.end, PenSample::place);
        let pens: Vec<PenSample> = pens.iter().map(|pen| self.undisplaced.pen(pen)).collect();
        self.stroke.drag(&pens)
    }

    fn release(&mut self) -> Outcome {
        self.stroke.release()
    }

    fn snap_lines(&self) -> SnapLines {
        self.stroke.snap_lines()
    }

    fn end(&self) -> Option<Vec2> {
        Some(self.end)
    }
}
