//! The eraser with Ctrl on a stroke layer: it removes whole strokes. Floor 5.

use crate::document::{Content, Document, LayerId, Live, StrokeList};
use crate::math::Vec2;
use crate::paint::{Stroke, Tip};
use crate::tools::{Gesture, Outcome, PenSample};

/// The eraser with Ctrl on a stroke layer: it removes every stroke that it touches.
pub(super) struct EraseStrokesGesture {
    document: Document,
    layer: LayerId,
    list: Live<StrokeList>,
    gone: Vec<usize>,
}

impl EraseStrokesGesture {
    /// None of the layer's strokes is gone yet.
    pub fn new(document: &Document, layer: LayerId, list: &Live<StrokeList>) -> Self {
        EraseStrokesGesture {
            document: document.clone(),
            layer,
            list: list.clone(),
            gone: Vec::new(),
        }
    }

    fn erase(&self) -> Option<Document> {
        let kept = |i: &usize| !self.gone.contains(i);
        let strokes = &self.list.params().strokes;
        let left = (0..strokes.len()).filter(kept).map(|i| strokes[i].clone()).collect();
        let list = Live::new(StrokeList { strokes: left });
        self.document.with_layer(self.layer, |layer| layer.content = Content::Strokes(list))
    }
}

impl Gesture for EraseStrokesGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let strokes = &self.list.params().strokes;
        for pen in pens {
            let touched = (0..strokes.len())
                .rev()
                .find(|i| !self.gone.contains(i) && is_on(&strokes[*i], pen.place()));
            self.gone.extend(touched);
        }
        if self.gone.is_empty() {
            return Outcome::Idle;
        }
        self.erase().map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        match self.erase() {
            Some(document) if !self.gone.is_empty() => {
                let label = if self.gone.len() == 1 { "Delete stroke" } else { "Delete strokes" };
                Outcome::Commit { label: label.into(), document, select: None }
            }
            _ => Outcome::Cancel,
        }
    }
}

/// Whether the pen is on a stroke: within its radius of the line through its samples.
pub fn is_on(stroke: &Stroke, at: Vec2) -> bool {
    let radius = (0.5 * stroke.brush().size).max(4.0);
    let round = matches!(stroke.brush().tip, Tip::Round);
    let radius = if round { radius } else { 0.8 * radius };
    let samples = stroke.samples();
    let near = |a: Vec2, b: Vec2| {
        let along = b - a;
        let t = if along.length_squared() > 0.0 {
            (at - a).dot(along) / along.length_squared()
        } else {
            0.0
        };
        at.distance(a + along * t.clamp(0.0, 1.0)) <= radius
    };
    match samples {
        [one] => near(one.at, one.at),
        _ => samples.windows(2).any(|pair| near(pair[0].at, pair[1].at)),
    }
}
