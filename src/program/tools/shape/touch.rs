//! The touch tool: a click or a drag gives the part under the pen a direction there; touches are
//! moved by dragging and removed with Alt. Floor 5. Not here: how they spread (`shape::touches`).

use super::{free_id, inverse_direction, on_canvas_direction};
use crate::document::Document;
use crate::document::parts::{Part, PartKind};
use crate::math::{COORDINATE, Vec2, Vec3, vec3};
use crate::shape::Touch;
use crate::surface::operator::MapValues;
use crate::tools::{
    GRAB_PT, Gesture, GestureStart, Outcome, PenSample, ShapeSettings, ToolContext,
};
use std::sync::Arc;

/// A touch with its place on the canvas.
#[derive(Clone, Debug, PartialEq)]
pub struct StandingTouch {
    /// The part that holds it, and its place there.
    pub part: String,
    /// Its number among the touches of the part.
    pub index: usize,
    /// Canvas px.
    pub at: Vec2,
    /// Unit, camera space (y up).
    pub normal: Vec3,
}

/// The visible touches of a document.
pub fn touches(document: &Document) -> Vec<StandingTouch> {
    let of = |part: &Arc<Part>| {
        let PartKind::Touches { on, touches } = &part.kind else { return Vec::new() };
        let Some(base) = document.parts.part(on).filter(|base| base.visible && part.visible) else {
            return Vec::new();
        };
        let standing = |(index, touch): (usize, &Touch)| StandingTouch {
            part: part.id.clone(),
            index,
            at: base.matrix.transform_point2(touch.at),
            normal: on_canvas_direction(touch.normal, base.matrix),
        };
        touches.iter().enumerate().map(standing).collect()
    };
    document.parts.list.iter().flat_map(of).collect()
}

/// The touch near a canvas point.
fn touch_at(document: &Document, at: Vec2, grab_px: f32) -> Option<StandingTouch> {
    let all = touches(document).into_iter().map(|touch| (touch.at.distance(at), touch));
    let near = all.filter(|(distance, _)| *distance <= grab_px);
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, touch)| touch)
}

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let (document, at) = (context.document, pen.place());
    let found = touch_at(document, at, GRAB_PT * context.px_per_pt);
    if pen.keys.alt {
        return (
            None,
            found.map_or_else(
                || take_direction(document, at),
                |touch| remove_touch(document, &touch),
            ),
        );
    }
    if let Some(touch) = found {
        let Some(part) = document.parts.part(&touch.part).cloned() else {
            return (None, Outcome::Idle);
        };
        let moving =
            MovingTouch { document: document.clone(), part, index: touch.index, moved: None };
        return (Some(Box::new(moving)), Outcome::Idle);
    }
    let Some(base) = document.part_at(at) else {
        let why = "There is no part under the pen to touch. Make some (Layer, Give it a shape…).";
        return (None, Outcome::Refused(why.into()));
    };
    let settings = context.tools.shape;
    let (part, is_new) = layer_on(
        document,
        &base,
        |kind| matches!(kind, PartKind::Touches { .. }),
        || ("Touches", PartKind::Touches { on: base.id.clone(), touches: Vec::new() }),
    );
    let scale = super::length_of(base.matrix);
    let made = Touch {
        at,
        radius: (settings.radius / scale).max(*Touch::RADIUS.start()).min(*Touch::RADIUS.end()),
        normal: inverse_direction(settings.normal, base.matrix),
        reach: (settings.reach / scale).max(0.0).min(*Touch::REACH.end()),
    };
    // A drag places them far enough apart that each counts.
    let apart_px = (2.0 * settings.radius).max(GRAB_PT * context.px_per_pt);
    let mut gesture =
        TouchGesture { document: document.clone(), base, part, is_new, made, apart_px, last: None };
    let outcome = gesture.drag(&[pen]);
    (Some(Box::new(gesture)), outcome)
}

/// The nearest part of a kind that lies on another, or a new one; and whether it is new.
pub(super) fn layer_on(
    document: &Document,
    base: &Part,
    is: impl Fn(&PartKind) -> bool,
    new: impl FnOnce() -> (&'static str, PartKind),
) -> (Part, bool) {
    let known = document
        .parts
        .list
        .iter()
        .rev()
        .find(|part| part.visible && part.on() == Some(base.id.as_str()) && is(&part.kind));
    match known {
        Some(part) => (Part::clone(part), false),
        None => {
            let (name, kind) = new();
            (Part { name: name.into(), ..Part::new(free_id(document), kind) }, true)
        }
    }
}

/// The direction of the surface at a point.
fn take_direction(document: &Document, at: Vec2) -> Outcome {
    let Some(surface) = &document.surface else {
        return Outcome::Refused("There is no surface to take the direction from.".into());
    };
    match surface.values_at(at) {
        None => {
            Outcome::Refused("There is no surface under the pen to take a direction from.".into())
        }
        Some(MapValues { nbar, nz, .. }) => {
            let normal = vec3(nbar.x, -nbar.y, nz);
            Outcome::set(move |tools| {
                tools.shape = ShapeSettings { normal, ..tools.shape }.clamp_to_ranges();
            })
        }
    }
}

fn remove_touch(document: &Document, touch: &StandingTouch) -> Outcome {
    let Some(part) = document.parts.part(&touch.part) else { return Outcome::Idle };
    let mut next = Part::clone(part);
    if let PartKind::Touches { touches, .. } = &mut next.kind
        && touch.index < touches.len()
    {
        touches.remove(touch.index);
    }
    Outcome::Commit {
        label: "Remove touch".into(),
        document: document.with_part(next),
        select: None,
    }
}

/// Touches being placed.
struct TouchGesture {
    document: Document,
    /// The part that is touched.
    base: Arc<Part>,
    /// The one that holds the touches.
    part: Part,
    is_new: bool,
    /// The properties of each; `at` is the last one's.
    made: Touch,
    apart_px: f32,
    /// The place of the last one, canvas px.
    last: Option<Vec2>,
}

impl TouchGesture {
    fn with(&self, is_done: bool) -> Document {
        super::with_worked(&self.document, &self.part, self.is_new, is_done)
    }
}

impl Gesture for TouchGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let mut is_changed = false;
        let back = self.base.matrix.inverse();
        for at in pens.iter().map(PenSample::place).filter(|at| at.is_finite()) {
            let is_near = self.last.is_some_and(|last| last.distance(at) < self.apart_px);
            let PartKind::Touches { touches, .. } = &mut self.part.kind else { continue };
            if is_near || touches.len() >= Touch::MOST {
                continue;
            }
            let own = back.transform_point2(at);
            if COORDINATE.contains(&own.x) && COORDINATE.contains(&own.y) {
                touches.push(Touch { at: own, ..self.made });
                (self.last, is_changed) = (Some(at), true);
            }
        }
        if is_changed { Outcome::Preview(self.with(false)) } else { Outcome::Idle }
    }

    fn release(&mut self) -> Outcome {
        match self.last {
            Some(_) => {
                Outcome::Commit { label: "Touch".into(), document: self.with(true), select: None }
            }
            None => Outcome::Cancel,
        }
    }
}

/// A touch being moved.
struct MovingTouch {
    document: Document,
    part: Arc<Part>,
    index: usize,
    moved: Option<Part>,
}

impl Gesture for MovingTouch {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(at) = pens.last().map(PenSample::place) else { return Outcome::Idle };
        let base = self.part.on().and_then(|on| self.document.parts.part(on));
        let Some(own) = base.map(|base| base.matrix.inverse().transform_point2(at)) else {
            return Outcome::Idle;
        };
        let mut next = Part::clone(&self.part);
        let PartKind::Touches { touches, .. } = &mut next.kind else { return Outcome::Idle };
        let Some(touch) = touches.get_mut(self.index) else { return Outcome::Idle };
        if !COORDINATE.contains(&own.x) || !COORDINATE.contains(&own.y) {
            return Outcome::Idle;
        }
        touch.at = own;
        self.moved = Some(next.clone());
        Outcome::Preview(self.document.with_part_ahead(next))
    }

    fn release(&mut self) -> Outcome {
        match self.moved.take() {
            Some(part) => {
                let document = self.document.with_part(part);
                Outcome::Commit { label: "Move touch".into(), document, select: None }
            }
            None => Outcome::Cancel,
        }
    }
}
