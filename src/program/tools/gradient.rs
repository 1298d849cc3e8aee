//! The gradient tool: a drag paints a gradient into the paint layer, or creates a live one; the ends
//! of the selected live one are handles. Floor 5.

mod painted;

use super::snap::{SnapLines, SnapTargets};
use super::{BrushTarget, GRAB_PT, Gesture, GestureStart, Outcome, PenSample, ToolContext, closed};
use crate::document::{Content, Document, Layer, LayerId, LayerSlot, Live};
use crate::math::{Vec2, srgb::Color};
use crate::paint::{Gradient, RampColors, RampStyle};
use painted::PaintedGradient;

/// A shorter drag leaves no gradient, px.
const SHORTEST_PX: f32 = 2.0;

/// What new gradients are like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GradientSettings {
    /// They are live layers, and not painted into the selected paint layer.
    pub live: bool,
    /// How they run from where the pen comes down to where it is lifted.
    pub style: RampStyle,
    /// Their colors.
    pub colors: RampColors,
    /// Whether they run the other way.
    pub reverse: bool,
}

impl GradientSettings {
    /// A gradient from one point to another, px of the canvas.
    ///
    /// * `first`, `second`: the user's colors, of which some ramps are made.
    pub fn gradient(self, from: Vec2, to: Vec2, [first, second]: [Color; 2]) -> Gradient {
        let mut stops = self.colors.stops(first, second);
        if self.reverse {
            stops.iter_mut().for_each(|stop| stop.t = 1.0 - stop.t);
            stops.reverse();
        }
        Gradient { style: self.style, stops, ..Gradient::new(from, to, &[]) }
    }
}

/// Which end of a gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GradientEnd {
    /// The beginning.
    From,
    /// The end.
    To,
}

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let at = pen.place();
    let selected = context.layer.and_then(|id| context.document.layer(id));
    if let Some(layer) = selected
        && let Content::Gradient(live) = &layer.content
    {
        if let Some(why) = closed::why_locked(layer) {
            return (None, Outcome::Refused(why.into()));
        }
        let gradient = live.params().clone();
        let near = |end: Vec2| end.distance(at) <= GRAB_PT * context.px_per_pt;
        let end = [(GradientEnd::To, gradient.to), (GradientEnd::From, gradient.from)]
            .into_iter()
            .find(|(_, p)| near(*p));
        if let Some((end, _)) = end {
            return drag_end(context, layer.id, gradient, end);
        }
    }
    let from = context.snap.point(at).at;
    let tools = context.tools;
    let gradient = tools.gradient.gradient(from, from, [tools.color, tools.second_color]);
    let gradient = gradient.with_operator(tools.operator);
    let place = selected.and_then(|layer| context.document.place_of(layer.id));
    let (document, snap, lines) =
        (context.document.clone(), context.snap.clone(), SnapLines::default());
    let is_painted = !tools.gradient.live && context.target == BrushTarget::Layer;
    let paint = selected.filter(|layer| matches!(layer.content, Content::Pixels(_)) && is_painted);
    if let Some(layer) = paint {
        if let Some(why) = closed::unpaintable(context.document, layer) {
            return (None, Outcome::Refused(why.into()));
        }
        let painted = PaintedGradient { document, layer: layer.id, gradient, snap, lines };
        return (Some(Box::new(painted)), Outcome::Idle);
    }
    let laid = NewGradientGesture { document, place, gradient, layer: None, snap, lines };
    (Some(Box::new(laid)), Outcome::Idle)
}

/// A new gradient, from where the pen came down.
struct NewGradientGesture {
    document: Document,
    /// The slot above the selected layer.
    place: Option<LayerSlot>,
    gradient: Gradient,
    layer: Option<Layer>,
    snap: SnapTargets,
    lines: SnapLines,
}

impl NewGradientGesture {
    fn with(&mut self) -> Option<Document> {
        let name = self.document.free_layer_name("Gradient");
        let content = Content::Gradient(Live::new(self.gradient.clone()));
        let mask = self.document.selection_as_mask();
        let layer =
            self.layer.get_or_insert_with(|| Layer { mask, ..Layer::new(name, content.clone()) });
        layer.content = content;
        let place = self
            .place
            .map_or(LayerSlot::top_level(usize::MAX), |p| LayerSlot { index: p.index + 1, ..p });
        self.document.with_inserted(layer.clone(), place)
    }
}

/// Where a gradient that begins at a point ends under the pen, and what it snaps to: with Shift at a
/// multiple of 45° and to nothing.
fn end_at(snap: &SnapTargets, from: Vec2, pen: &PenSample) -> (Vec2, SnapLines) {
    if pen.keys.shift {
        return (snap_to_compass(from, pen.place()), SnapLines::default());
    }
    let found = snap.point(pen.place());
    (found.at, found.lines)
}

impl Gesture for NewGradientGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        (self.gradient.to, self.lines) = end_at(&self.snap, self.gradient.from, pen);
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        if self.gradient.from.distance(self.gradient.to) < SHORTEST_PX {
            return Outcome::Cancel;
        }
        let Some(document) = self.with() else { return Outcome::Cancel };
        Outcome::Commit {
            label: "Gradient".into(),
            document,
            select: self.layer.as_ref().map(|layer| layer.id),
        }
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}

/// The nearest of the eight directions of the compass.
fn snap_to_compass(from: Vec2, to: Vec2) -> Vec2 {
    let step = std::f32::consts::FRAC_PI_4;
    let turn = ((to - from).to_angle() / step).round() * step;
    from + Vec2::from_angle(turn) * from.distance(to)
}

/// Starts dragging one end of a gradient.
pub(super) fn drag_end(
    context: &ToolContext,
    layer: LayerId,
    gradient: Gradient,
    end: GradientEnd,
) -> GestureStart {
    let (document, snap, lines) =
        (context.document.clone(), context.snap.clone(), SnapLines::default());
    (
        Some(Box::new(GradientEndGesture {
            document,
            layer,
            gradient,
            end,
            moved: false,
            snap,
            lines,
        })),
        Outcome::Idle,
    )
}

/// One end of a gradient being dragged.
struct GradientEndGesture {
    document: Document,
    layer: LayerId,
    gradient: Gradient,
    end: GradientEnd,
    moved: bool,
    snap: SnapTargets,
    lines: SnapLines,
}

impl GradientEndGesture {
    fn with(&self) -> Option<Document> {
        let content = Content::Gradient(Live::new(self.gradient.clone()));
        self.document.with_layer(self.layer, |layer| layer.content = content)
    }
}

impl Gesture for GradientEndGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let fixed =
            if self.end == GradientEnd::From { self.gradient.to } else { self.gradient.from };
        let found = self.snap.point(pen.place());
        let (at, lines) = match pen.keys.shift {
            true => (snap_to_compass(fixed, pen.place()), SnapLines::default()),
            false => (found.at, found.lines),
        };
        self.lines = lines;
        match self.end {
            GradientEnd::From => self.gradient.from = at,
            GradientEnd::To => self.gradient.to = at,
        }
        self.moved = true;
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        match self.with() {
            Some(document) if self.moved => {
                Outcome::Commit { label: "Move gradient end".into(), document, select: None }
            }
            _ => Outcome::Cancel,
        }
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec2};
    use crate::tools::ToolSettings;

    #[test]
    fn a_drag_lays_a_gradient_and_a_second_one_moves_its_end() {
        let (empty, tools) = (Document::empty(Size::new(100, 100)), ToolSettings::default());
        let context = ToolContext::new(&empty, &tools);
        let drag = |context: &ToolContext, from: Vec2, to: Vec2| {
            let mut gesture = press(context, PenSample::at(from)).0.unwrap();
            gesture.drag(&[PenSample::at(to)]);
            gesture.release()
        };
        let Outcome::Commit { document, select, .. } =
            drag(&context, vec2(10.0, 10.0), vec2(80.0, 20.0))
        else {
            panic!("laid")
        };
        let context = ToolContext { document: &document, layer: select, ..context };
        let Outcome::Commit { document, .. } = drag(&context, vec2(82.0, 21.0), vec2(50.0, 90.0))
        else {
            panic!("moved")
        };
        let Content::Gradient(live) = &document.layers[0].content else { panic!("a gradient") };
        assert_eq!((live.params().from, live.params().to), (vec2(10.0, 10.0), vec2(50.0, 90.0)));
        assert!(
            matches!(drag(&context, vec2(40.0, 40.0), vec2(40.5, 40.0)), Outcome::Cancel),
            "a click lays nothing"
        );
    }
}
