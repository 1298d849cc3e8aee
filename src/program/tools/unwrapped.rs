//! Painting flat: the pen on the unwrapped sheet is mapped to the canvas, so that a straight line
//! drawn flat lies bent on the form. Floor 5. The tools know nothing of this. Not here: the sheet
//! (`surface::unwrap`).

pub mod pieces;

use super::assistants::StrokeStart;
use super::kept_context::KeptContext;
use super::{Gesture, GestureStart, Outcome, PenSample, ToolContext, ToolKind, ToolSettings};
use crate::document::{Document, LayerId};
use crate::math::{Vec2, srgb::Color};
use crate::paint::{Brush, DistanceMetric, Sample, StabilizedPen, Stabilizer};
use crate::surface::Surface;
use crate::surface::unwrap::{CanvasPlace, PlaneLayout};
use std::sync::Arc;

/// The longest step between two points of a stroke that are looked up, px of the sheet.
const STEP_PX: f32 = 3.0;
/// The most of them between two samples: a pen that jumps leaves a coarser line.
const MOST_STEPS: f32 = 4096.0;
/// Two steps farther apart on the canvas are on two sides of an edge: the stroke is cut there.
const CUT_PX: f32 = 6.0 * STEP_PX;

/// Whether a tool works on the sheet; others need what they hold to lie as in the picture.
pub fn is_for_unwrapped(tool: ToolKind) -> bool {
    use ToolKind::{Brush, Eraser, Eyedropper, Fill, Hand, SurfaceWand, Wand, Zoom};
    is_moving_pieces(tool)
        || matches!(tool, Brush | Eraser | Eyedropper | Fill | Hand | SurfaceWand | Wand | Zoom)
}

/// Whether a tool moves, scales and turns what the selected layer shows on one piece of the sheet.
pub fn is_moving_pieces(tool: ToolKind) -> bool {
    matches!(tool, ToolKind::Image | ToolKind::Gradient)
}

/// The pen comes down on the sheet with a brush: strokes are stabilized and spaced there, painted
/// with the operator that unwrapped it, and cut where they leave a piece. All of them are one step.
///
/// `pen` is on the sheet; the context's points are on the canvas.
pub fn paint(
    context: &ToolContext,
    pen: PenSample,
    layout: Arc<PlaneLayout>,
    start: StrokeStart,
) -> GestureStart {
    let Some(surface) = context.document.surface.clone() else { return (None, Outcome::Idle) };
    let brush = Brush {
        stabilizer: Stabilizer::None,
        spacing_on: DistanceMetric::Surface,
        ..context.tools.brush.clone()
    };
    // The line that Shift draws is drawn on the sheet.
    let operator = layout.bend().operator;
    let tools = ToolSettings { brush, operator, ..context.tools.clone() };
    let hand = ToolContext { tools: &tools, last_end: None, ..*context };
    let sheet = Sheet { layout, surface };
    let lead = context
        .last_end
        .filter(|_| pen.keys.shift)
        .and_then(|at| sheet.layout.sheet_at(&sheet.surface, at));
    let mut stroke = FlatStroke {
        sheet,
        document: context.document.clone(),
        layer: context.layer,
        hand: KeptContext::of(&hand),
        start,
        stabilized: StabilizedPen::new(context.tools.brush.stabilizer),
        last: None,
        active: None,
        is_refused: false,
        run: Vec::new(),
        kept: None,
        said: None,
    };
    if let Some(at) = lead {
        stroke.go(PenSample { sample: Sample { at, ..pen.sample }, ..pen });
    }
    let outcome = stroke.drag(&[pen]);
    (Some(Box::new(stroke)), outcome)
}

/// The pen comes down on the sheet with a tool that is not a brush: it gets the points of the
/// canvas under the pen.
pub fn point(
    context: &ToolContext,
    pen: PenSample,
    layout: Arc<PlaneLayout>,
    tool: ToolKind,
) -> GestureStart {
    let Some(surface) = context.document.surface.clone() else { return (None, Outcome::Idle) };
    if is_moving_pieces(tool) {
        return pieces::press(context, pen, &layout);
    }
    let sheet = Sheet { layout, surface };
    let Some((pen, _)) = sheet.map_sample(pen) else { return (None, Outcome::Idle) };
    let (gesture, outcome) = super::press(tool, context, pen);
    let led = |tool| Box::new(LedGesture { sheet, tool }) as Box<dyn Gesture>;
    (gesture.map(led), outcome)
}

/// The sheet that the pen is on.
struct Sheet {
    layout: Arc<PlaneLayout>,
    surface: Arc<Surface>,
}

impl Sheet {
    /// The sample on the canvas, and the object there; the pen leans as it does on the sheet.
    fn map_sample(&self, pen: PenSample) -> Option<(PenSample, u32)> {
        let CanvasPlace { at, object, turn } = self.layout.canvas_at(&self.surface, pen.place())?;
        let sample = Sample { at, tilt: turn.transpose() * pen.sample.tilt, ..pen.sample };
        Some((PenSample { sample, ..pen }, object))
    }
}

/// A tool that is used through the sheet.
struct LedGesture {
    sheet: Sheet,
    tool: Box<dyn Gesture>,
}

impl Gesture for LedGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let led: Vec<PenSample> =
            pens.iter().filter_map(|pen| Some(self.sheet.map_sample(*pen)?.0)).collect();
        if led.is_empty() { Outcome::Idle } else { self.tool.drag(&led) }
    }

    fn release(&mut self) -> Outcome {
        self.tool.release()
    }

    fn picked_color(&self) -> Option<Color> {
        self.tool.picked_color()
    }
}

/// A stroke on the sheet, as one stroke of the brush for each piece that it crosses.
struct FlatStroke {
    sheet: Sheet,
    /// With the strokes that are finished.
    document: Document,
    layer: Option<LayerId>,
    /// What the brush works with, except those two.
    hand: KeptContext,
    start: StrokeStart,
    stabilized: StabilizedPen,
    /// The last sample on the sheet.
    last: Option<PenSample>,
    /// The stroke on the canvas, the object that it is on, and its last place.
    active: Option<(Box<dyn Gesture>, u32, Vec2)>,
    /// Nothing can be painted: it is not tried again.
    is_refused: bool,
    /// Samples not yet passed to it.
    run: Vec<PenSample>,
    /// The name of the finished ones.
    kept: Option<String>,
    /// What the brush returned besides pictures.
    said: Option<Outcome>,
}

impl FlatStroke {
    /// Continues to a sample on the sheet, in steps short enough to follow the form.
    fn go(&mut self, pen: PenSample) {
        let Some(last) = self.last.replace(pen) else { return self.step(pen) };
        let steps =
            (last.place().distance(pen.place()) / STEP_PX).ceil().max(1.0).min(MOST_STEPS) as usize;
        for step in 1..=steps {
            let t = step as f32 / steps as f32;
            let (a, b) = (last.sample, pen.sample);
            let sample = Sample {
                at: a.at.lerp(b.at, t),
                pressure: a.pressure + t * (b.pressure - a.pressure),
                tilt: a.tilt.lerp(b.tilt, t),
                time_secs: a.time_secs + t * (b.time_secs - a.time_secs),
            };
            self.step(PenSample { sample: if step == steps { b } else { sample }, ..pen });
        }
    }

    fn step(&mut self, pen: PenSample) {
        let Some((led, object)) = self.sheet.map_sample(pen).filter(|_| !self.is_refused) else {
            return self.cut();
        };
        let goes_on = self
            .active
            .as_ref()
            .is_some_and(|(_, on, at)| *on == object && at.distance(led.place()) < CUT_PX);
        if goes_on {
            self.run.push(led);
        } else {
            self.cut();
            let (document, layer, start) = (&self.document, self.layer, self.start);
            let (gesture, outcome) =
                self.hand.lend(|hand| start(&ToolContext { document, layer, ..*hand }, led));
            if !matches!(outcome, Outcome::Preview(_) | Outcome::Idle) {
                self.said = Some(outcome);
            }
            self.is_refused = gesture.is_none();
            self.active = gesture.map(|gesture| (gesture, object, led.place()));
        }
        if let Some((_, _, at)) = &mut self.active {
            *at = led.place();
        }
    }

    /// Passes on the samples so far; returns what shows then.
    fn flush(&mut self) -> Option<Outcome> {
        let run = std::mem::take(&mut self.run);
        let (gesture, ..) = self.active.as_mut()?;
        Some(gesture.drag(&run))
    }

    /// Finishes the stroke on the canvas.
    fn cut(&mut self) {
        self.flush();
        let Some((mut gesture, ..)) = self.active.take() else { return };
        match gesture.release() {
            Outcome::Commit { label, document, select } => {
                (self.document, self.layer) = (document, select.or(self.layer));
                self.kept.get_or_insert(label);
            }
            Outcome::Cancel | Outcome::Idle | Outcome::Preview(_) => {}
            other => self.said = Some(other),
        }
    }
}

impl Gesture for FlatStroke {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        for pen in pens {
            if let Some(sample) = self.stabilized.push(pen.sample) {
                self.go(PenSample { sample, ..*pen });
            }
        }
        let shown = self.flush();
        match (self.said.take(), shown, &self.kept) {
            (Some(said), ..) => said,
            (None, Some(shown), _) => shown,
            (None, None, Some(_)) => Outcome::Preview(self.document.clone()),
            (None, None, None) => Outcome::Idle,
        }
    }

    fn release(&mut self) -> Outcome {
        if let Some((sample, last)) = self.stabilized.finish().zip(self.last) {
            self.go(PenSample { sample, ..last });
        }
        self.cut();
        match (self.kept.take(), self.said.take()) {
            (Some(label), _) => {
                Outcome::Commit { label, document: self.document.clone(), select: self.layer }
            }
            (None, Some(said)) => said,
            (None, None) => Outcome::Cancel,
        }
    }
}

#[cfg(test)]
mod tests;
