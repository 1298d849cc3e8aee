//! What the events of one frame become: actions on the view and samples of the pen.
//! Floor 7.

use crate::math::{Vec2, vec2};
use crate::session::actions::{PointerAction, ViewAction};
use crate::session::{Action, CanvasView, Session};
use crate::tools::PenSample;
use eframe::egui::{Modifiers, Pos2};

/// The input of one frame.
pub(super) struct FrameInput<'a> {
    pub session: &'a Session,
    /// The view after the actions so far.
    pub view: CanvasView,
    pub middle: Pos2,
    pub actions: &'a mut Vec<Action>,
    /// Samples not yet sent: those of a frame are sent together.
    pub pens: Vec<PenSample>,
}

impl FrameInput<'_> {
    fn about_view_center(&self, pos: Pos2) -> Vec2 {
        vec2(pos.x - self.middle.x, pos.y - self.middle.y)
    }

    pub fn on_canvas(&self, pos: Pos2) -> Vec2 {
        self.view.canvas_from_screen().transform_point2(self.about_view_center(pos))
    }

    pub fn view(&mut self, action: ViewAction) {
        self.actions.push(Action::View(action));
    }

    pub fn zoom(&mut self, factor: f32, about: Pos2) {
        if factor.is_finite() && factor > 0.0 && factor != 1.0 {
            let about = self.about_view_center(about);
            self.view = self.view.zoomed(factor, about);
            self.view(ViewAction::Zoom { factor, about });
        }
    }

    pub fn flush(&mut self) {
        let pens = std::mem::take(&mut self.pens);
        if !pens.is_empty() {
            self.actions.push(Action::Pointer(PointerAction::Drag { pens }));
        }
    }
}

/// The wheel zooms to the pointer; with Shift it pans sideways, with Alt up and down; a trackpad's
/// fingers pan.
pub(super) fn wheel(
    unit: eframe::egui::MouseWheelUnit,
    delta: eframe::egui::Vec2,
    keys: Modifiers,
    at: Pos2,
    listening: &mut FrameInput,
) {
    use eframe::egui::MouseWheelUnit::{Line, Page, Point};
    let points = match unit {
        Line => delta * 40.0,
        Page => delta * 400.0,
        Point => delta,
    };
    let is_trackpad = unit == Point && !keys.command;
    if is_trackpad {
        listening.view(ViewAction::Pan { by: vec2(points.x, points.y) });
    } else if keys.shift {
        listening.view(ViewAction::Pan { by: vec2(points.x + points.y, 0.0) });
    } else if keys.alt {
        listening.view(ViewAction::Pan { by: vec2(0.0, points.x + points.y) });
    } else {
        listening.zoom((points.y * 0.005).exp(), at);
    }
}
