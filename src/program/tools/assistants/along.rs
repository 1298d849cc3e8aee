//! Strokes along assistants: after the first screen points the path nearest to their direction is
//! chosen, and the whole stroke follows it. Floor 5.

use crate::document::assistants::AssistantPath;
use crate::math::Vec2;
use crate::paint::Sample;
use crate::tools::kept_context::KeptContext;
use crate::tools::{Gesture, GestureStart, Outcome, PenSample, ToolContext};

/// How far the pen goes until the path is chosen, screen points.
const CHOICE_PT: f32 = 8.0;
/// How near to a line or an ellipse a stroke must begin to be drawn along it, screen points.
const NEAR_PT: f32 = 24.0;

/// How a stroke begins.
pub type StrokeStart = fn(&ToolContext, PenSample) -> GestureStart;

/// The pen comes down: the stroke follows an assistant if there is one, else it begins at once.
pub fn press_along(context: &ToolContext, pen: PenSample, start: StrokeStart) -> GestureStart {
    let near_px = NEAR_PT * context.px_per_pt;
    let is_on = context.tools.aids.magnetism > 0.0 && pen.place().is_finite();
    let all = context.document.assistants.iter().filter(|_| is_on);
    let paths: Vec<AssistantPath> = all.flat_map(|one| one.paths(pen.place(), near_px)).collect();
    if paths.is_empty() {
        return start(context, pen);
    }
    let waiting = Waiting { kept: KeptContext::of(context), start, paths, pens: vec![pen] };
    let magnetism = context.tools.aids.magnetism;
    (
        Some(Box::new(AlongGesture {
            waiting: Some(waiting),
            path: None,
            magnetism,
            stroke: None,
            end: None,
        })),
        Outcome::Idle,
    )
}

/// A stroke that has not yet begun.
struct Waiting {
    kept: KeptContext,
    start: StrokeStart,
    paths: Vec<AssistantPath>,
    pens: Vec<PenSample>,
}

struct AlongGesture {
    waiting: Option<Waiting>,
    path: Option<AssistantPath>,
    magnetism: f32,
    stroke: Option<Box<dyn Gesture>>,
    /// Where it was drawn to.
    end: Option<Vec2>,
}

impl AlongGesture {
    fn place_pen(&self, pen: &PenSample) -> PenSample {
        let at = self.path.map_or(pen.place(), |path| {
            pen.place().lerp(path.nearest(pen.place()), self.magnetism)
        });
        PenSample { sample: Sample { at, ..pen.sample }, ..*pen }
    }

    /// Begins the stroke with all samples so far.
    fn begin(&mut self) -> Outcome {
        let Some(Waiting { kept, start, pens, .. }) = self.waiting.take() else {
            return Outcome::Idle;
        };
        let pens: Vec<PenSample> = pens.iter().map(|pen| self.place_pen(pen)).collect();
        self.end = pens.last().map(PenSample::place);
        let Some((first, rest)) = pens.split_first() else { return Outcome::Idle };
        let (stroke, outcome) = kept.lend(|context| start(context, *first));
        self.stroke = stroke;
        match &mut self.stroke {
            Some(stroke) if !rest.is_empty() => stroke.drag(rest),
            _ => outcome,
        }
    }
}

/// The path nearest to a stroke's direction.
fn nearest(paths: &[AssistantPath], from: Vec2, to: Vec2) -> Option<AssistantPath> {
    let leaning = |path: &AssistantPath| path.leaning(from, to);
    paths.iter().copied().min_by(|a, b| leaning(a).total_cmp(&leaning(b)))
}

impl Gesture for AlongGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        if self.stroke.is_some() {
            let pens: Vec<PenSample> = pens.iter().map(|pen| self.place_pen(pen)).collect();
            self.end = pens.last().map(PenSample::place).or(self.end);
            return self.stroke.as_mut().map_or(Outcome::Idle, |stroke| stroke.drag(&pens));
        }
        let Some(waiting) = &mut self.waiting else { return Outcome::Idle };
        waiting.pens.extend_from_slice(pens);
        let from = waiting.pens.first().map_or(Vec2::ZERO, PenSample::place);
        let reach_px = CHOICE_PT * waiting.kept.px_per_pt();
        let Some(to) = pens.iter().map(PenSample::place).find(|at| at.distance(from) >= reach_px)
        else {
            return Outcome::Idle;
        };
        self.path = nearest(&waiting.paths, from, to);
        self.begin()
    }

    fn release(&mut self) -> Outcome {
        // A dot follows nothing.
        let begun = self.begin();
        self.stroke.take().map_or(begun, |mut stroke| stroke.release())
    }

    fn end(&self) -> Option<Vec2> {
        self.end
    }
}
