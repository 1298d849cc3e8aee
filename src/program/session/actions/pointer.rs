//! The pen on the canvas, passed on to the current tool.
//! Floor 6.

use crate::document::{Content, Document, LayerId};
use crate::math::{Vec2, vec2};
use crate::paint::{BrushMode, Sample};
use crate::session::actions::layers::texts;
use crate::session::replay::{ReplayValue, actions, record};
use crate::session::{CloneSource, OpenDocument, Session};
use crate::surface::unwrap::PlaneLayout;
use crate::tools::assistants::StrokeStart;
use crate::tools::guides::GuideAt;
use crate::tools::path;
use crate::tools::snap::{SnapTargets, ViewAids};
use crate::tools::unwrapped;
use crate::tools::{
    self, BrushTarget, DocumentChoice, GRAB_PT, GestureStart, ModifierKeys, Outcome, PenSample,
    ToolContext, ToolKind,
};
use serde_json::Value;
use std::sync::Arc;

record!(ModifierKeys { shift, ctrl, alt });

/// [x, y, pressure, tilt x, tilt y, seconds] and the keys held.
impl ReplayValue for PenSample {
    fn to_value(&self) -> Value {
        let Sample { at, pressure, tilt, time_secs } = self.sample;
        let mut list = vec![at.x, at.y, pressure, tilt.x, tilt.y, time_secs].to_value();
        if let Some(list) = list.as_array_mut().filter(|_| self.keys != ModifierKeys::default()) {
            list.push(self.keys.to_value());
        }
        list
    }

    fn read(value: &Value) -> Result<Self, String> {
        let list = value.as_array().ok_or("must be a list of numbers")?;
        let number = |i: usize, unsaid: f32| list.get(i).map_or(Ok(unsaid), f32::read);
        let sample = Sample {
            at: vec2(number(0, 0.0)?, number(1, 0.0)?),
            pressure: number(2, 1.0)?.max(0.0).min(1.0),
            tilt: vec2(number(3, 0.0)?, number(4, 0.0)?),
            time_secs: number(5, 0.0)?,
        };
        Ok(PenSample {
            sample,
            keys: list.get(6).map_or(Ok(ModifierKeys::default()), ModifierKeys::read)?,
        })
    }
}

actions! {
    /// Canvas px; while the surface is seen unwrapped, px of its sheet.
    PointerAction {
        /// `tool`: a held key may select another than the current one. `px_per_pt`: canvas px per
        /// screen point.
        "press" Press { tool: ToolKind, pen: PenSample, px_per_pt: f32 }
        "drag" Drag { pens: Vec<PenSample> }
        "release" Release {}
        /// Drops the current gesture.
        "cancel" Cancel {}
    }
}

impl PointerAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        match self {
            PointerAction::Press { tool, pen, px_per_pt } => {
                press(session, *tool, *pen, *px_per_pt)
            }
            PointerAction::Drag { pens } => {
                let Some(gesture) = &mut session.gesture else { return };
                let outcome = gesture.drag(pens);
                let drawn = gesture.end();
                let drawn = drawn.or_else(|| on_canvas(session, pens.last()?.place()));
                session.last_pen = drawn.or(session.last_pen);
                take(session, outcome);
            }
            PointerAction::Release {} => {
                let Some(mut gesture) = session.gesture.take() else { return };
                let outcome = gesture.release();
                take(session, outcome);
            }
            PointerAction::Cancel {} => session.drop_gesture(),
        }
    }
}

fn press(session: &mut Session, tool: ToolKind, pen: PenSample, px_per_pt: f32) {
    session.drop_gesture();
    if let Some(open) = session.active_mut() {
        open.forget_preview();
    }
    if let Some(why) = why_refused(session, tool) {
        return session.notes.push(why);
    }
    if tool == ToolKind::Text {
        return texts::press(session, pen.place(), GRAB_PT * px_per_pt);
    }
    let place = on_canvas(session, pen.place());
    let clone_offset = begin_clone(session, tool, pen, place);
    let target = session.tools.transform.target;
    if let Some(open) = session.active_mut().filter(|_| tool == ToolKind::Transform) {
        open.hold_gizmo(target);
    }
    let Some(open) = session.active() else { return };
    let document = match works_in_place(tool, open) {
        Ok(document) => document,
        Err(why) => return session.notes.push(why.into()),
    };
    let (strokes, layers) = (open.selected_strokes(), open.outermost_selected());
    let is_line = is_straight_line(open, tool, pen);
    let snap = targets(session, &document, tool, &layers, is_line, px_per_pt);
    // Straight lines end where they snap.
    let at = if is_line { snap.point(pen.place()).at } else { pen.place() };
    let pen = PenSample { sample: Sample { at, ..pen.sample }, ..pen };
    if let Some(guide) = guide_under(session, &document, tool, pen, px_per_pt) {
        let aids = ViewAids { to_guides: false, ..session.tools.aids };
        let to = SnapTargets::of(&document, &aids, &[], px_per_pt);
        let start = tools::guides::hold(open.document(), guide, to);
        return begin(session, start);
    }
    let context = ToolContext {
        layer: open.active_layer,
        layers: &layers,
        strokes: &strokes,
        part: open.part.as_deref(),
        target: brush_target(open),
        px_per_pt,
        last_end: open.last_end,
        gizmo: open.gizmo_memory(),
        snap: &snap,
        clone_offset,
        ..ToolContext::new(&document, &session.tools)
    };
    let (gesture, outcome) = start(&context, tool, pen, open.layout(), is_line);
    (session.gesture, session.draws_stroke) = (gesture, stroke_start(tool).is_some());
    session.last_pen = place.or(session.last_pen);
    let takes_color =
        [ToolKind::Brush, ToolKind::Fill, ToolKind::Gradient, ToolKind::Figure, ToolKind::Path];
    if takes_color.contains(&tool) {
        session.remember_color();
    }
    take(session, outcome);
}

/// Why the tool does nothing in what is shown.
fn why_refused(session: &Session, tool: ToolKind) -> Option<String> {
    let open = session.active()?;
    if open.layout().is_some() && !unwrapped::is_for_unwrapped(tool) {
        let how =
            "This tool works in the picture: leave the unwrapped view (View, Unwrapped) to use it.";
        return Some(how.into());
    }
    let paints =
        matches!(tool, ToolKind::Brush | ToolKind::Eraser | ToolKind::Fill | ToolKind::Liquify);
    open.why_hidden_beside().filter(|_| paints && !open.quick_mask)
}

/// Where the clone brush takes its paint from, relative to the pen that comes down at `place`.
fn begin_clone(
    session: &mut Session,
    tool: ToolKind,
    pen: PenSample,
    place: Option<Vec2>,
) -> Option<Vec2> {
    let BrushMode::Clone { aligned, .. } = session.tools.brush.mode else { return None };
    let is_clone = tool == ToolKind::Brush && !pen.keys.alt;
    session.active_mut().filter(|_| is_clone)?.begin_clone(place?, aligned)
}

/// Shift draws a straight line from the last stroke's end. What it snaps to lies in the picture, so
/// there is none while the surface is seen unwrapped.
fn is_straight_line(open: &OpenDocument, tool: ToolKind, pen: PenSample) -> bool {
    let draws = matches!(tool, ToolKind::Brush | ToolKind::Eraser);
    draws && pen.keys.shift && open.last_end.is_some() && open.layout().is_none()
}

/// The gesture that the press begins, in the picture or on the unwrapped surface.
fn start(
    context: &ToolContext,
    tool: ToolKind,
    pen: PenSample,
    layout: Option<Arc<PlaneLayout>>,
    is_line: bool,
) -> GestureStart {
    match (layout, stroke_start(tool)) {
        (Some(layout), Some(start)) => unwrapped::paint(context, pen, layout, start),
        (Some(layout), None) => unwrapped::point(context, pen, layout, tool),
        // A line from the last stroke's end is straight already.
        (None, Some(start)) if is_line => start(context, pen),
        (None, Some(start)) => tools::assistants::press_along(context, pen, start),
        (None, None) => tools::press(tool, context, pen),
    }
}

/// What the pen snaps to with a tool; strokes snap if they are lines.
fn targets(
    session: &Session,
    document: &Document,
    tool: ToolKind,
    selected: &[LayerId],
    is_line: bool,
    px_per_pt: f32,
) -> SnapTargets {
    let moving = if matches!(tool, ToolKind::Move | ToolKind::Transform) { selected } else { &[] };
    match is_line || tool.is_snapping_tool() {
        true => SnapTargets::of(document, &session.tools.aids, moving, px_per_pt),
        false => SnapTargets::default(),
    }
}

/// What brush and eraser change.
fn brush_target(open: &OpenDocument) -> BrushTarget {
    match (open.quick_mask, open.on_mask) {
        (true, _) => BrushTarget::Selection,
        (false, true) => BrushTarget::Mask,
        (false, false) => BrushTarget::Layer,
    }
}

/// How a stroke of the tool begins, if it makes strokes.
fn stroke_start(tool: ToolKind) -> Option<StrokeStart> {
    Some(match tool {
        ToolKind::Brush => |c, pen| tools::press(ToolKind::Brush, c, pen),
        ToolKind::Eraser => |c, pen| tools::press(ToolKind::Eraser, c, pen),
        _ => return None,
    })
}

/// A gesture that was not begun by a press of the pen on the canvas.
pub(super) fn begin(session: &mut Session, (gesture, outcome): GestureStart) {
    (session.gesture, session.draws_stroke) = (gesture, false);
    take(session, outcome);
}

/// The guide that the move tool grabs.
fn guide_under(
    session: &Session,
    document: &Document,
    tool: ToolKind,
    pen: PenSample,
    px_per_pt: f32,
) -> Option<GuideAt> {
    let can = tool == ToolKind::Move && session.tools.aids.guides && !session.tools.aids.locked;
    let near_px = GUIDE_PT * px_per_pt;
    can.then(|| tools::guides::guide_at(&document.guides, pen.place(), near_px)).flatten()
}

/// How near to a guide the move tool grabs it, screen points.
const GUIDE_PT: f32 = 4.0;

/// The canvas point under the pen, which may be on the sheet of the unwrapped surface; `None` off
/// its pieces.
fn on_canvas(session: &Session, pen: Vec2) -> Option<Vec2> {
    let open = session.active()?;
    match (open.layout(), &open.document().surface) {
        (Some(layout), Some(surface)) => Some(layout.canvas_at(surface, pen)?.at),
        _ => Some(pen),
    }
}

/// The document for a tool that works on the selected layer where it shows: with the layer's
/// transform applied.
fn works_in_place(tool: ToolKind, open: &OpenDocument) -> Result<Document, &'static str> {
    let document = open.document();
    let is_moved_whole = tool == ToolKind::Move
        && (open.has_several()
            || open
                .active_layer
                .and_then(|id| document.layer(id))
                .is_some_and(|layer| !matches!(layer.content, Content::Strokes(_))));
    let looks_only = is_moved_whole
        || tool.is_shape_tool()
        || tool.is_selection_tool()
        || matches!(
            tool,
            ToolKind::Eyedropper
                | ToolKind::Hand
                | ToolKind::Zoom
                | ToolKind::Transform
                | ToolKind::Liquify
                | ToolKind::Crop
                | ToolKind::Assistants
                | ToolKind::Panels
        );
    let active = open.active_layer.and_then(|id| document.layer(id));
    let is_on_path = active.is_some_and(|layer| path::of_layer(layer).is_some());
    let draws_new = matches!(tool, ToolKind::Figure | ToolKind::Path) && !is_on_path;
    let Some(layer) = open.active_layer.filter(|_| !looks_only && !draws_new) else {
        return Ok(document.clone());
    };
    let Some(applied) = document.with_transform_applied(layer) else { return Ok(document.clone()) };
    let is_in_place = applied.map_of(layer).is_none_or(|map| map.is_none());
    let is_group = applied.layer(layer).is_some_and(|layer| layer.content.group().is_some());
    let is_warped = applied.layer(layer).is_some_and(|layer| layer.is_warped());
    // Strokes go where the layer shows what is under the pen.
    let is_stroke = matches!(tool, ToolKind::Brush | ToolKind::Eraser);
    if is_in_place && (!is_warped || is_stroke) || is_group {
        return Ok(applied);
    }
    if is_warped {
        return Err(
            "A mesh or liquify displaces the layer. Apply or remove it (Edit, Transform layer) to \
             work on the layer.",
        );
    }
    Err("The layer is skewed by its transform. Apply or remove the transform (Edit, Transform \
         layer) to work on the layer.")
}

fn take(session: &mut Session, outcome: Outcome) {
    let outcome = outcome.apply_settings(&mut session.tools);
    let stroke_end = session.last_pen.filter(|_| session.draws_stroke);
    let Some(open) = session.active_mut() else { return };
    match outcome {
        Outcome::Idle | Outcome::Settings(..) => {}
        Outcome::Preview(document) => open.show("", document),
        Outcome::Commit { label, document, select } => {
            if open.commit(label, document) {
                open.active_layer = select.or(open.active_layer);
                open.last_end = stroke_end.or(open.last_end);
            }
            session.tools.lasso.clear();
        }
        Outcome::Choose(choice) => choose(session, choice),
        Outcome::Refused(why) => {
            open.forget_preview();
            session.notes.push(why.into_owned());
        }
        Outcome::Cancel => open.forget_preview(),
    }
}

fn choose(session: &mut Session, choice: DocumentChoice) {
    let target = session.tools.transform.target;
    let Some(open) = session.active_mut() else { return };
    match choice {
        DocumentChoice::Layer(id) => {
            open.forget_preview();
            open.active_layer = Some(id);
        }
        DocumentChoice::Strokes(strokes) => {
            if let Some(layer) = open.active_layer {
                open.select_strokes(layer, strokes);
            }
        }
        DocumentChoice::Part(part) => open.part = Some(part),
        DocumentChoice::Pivot(share) => open.set_pivot(target, share),
        DocumentChoice::CloneSource(at) => {
            open.clone_source = Some(CloneSource { at, offset: None });
        }
    }
}
