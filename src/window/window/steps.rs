//! The three hints of the first start, shown over the canvas until they are completed or dismissed.
//! Floor 7.

use super::MainWindow;
use crate::document::Content;
use crate::session::Session;
use crate::surface::Operator;
use eframe::egui::{Align2, Area, Frame, Id, RichText, Ui, vec2};

/// Each step, how to do it, and whether it is done.
type HintStep = (&'static str, &'static str, fn(&Session) -> bool);

const STEPS: [HintStep; 3] = [
    (
        "Drop a photo on the shape",
        "It bends over it like a reflection. Or File, Place image…",
        has_image,
    ),
    ("Paint highlights", "Brush (B), Gloss (F3): strokes follow the form", has_bent_stroke),
    (
        "Move what you made",
        "Anchors (A) move the photo along the surface, Move (V) a stroke",
        has_moved,
    ),
];

fn has_any(session: &Session, is: impl Fn(&Content) -> bool) -> bool {
    session
        .shown_document()
        .is_some_and(|document| document.walk().iter().any(|(_, layer)| is(&layer.content)))
}

fn has_image(session: &Session) -> bool {
    has_any(session, |content| matches!(content, Content::Image(_)))
}

fn has_bent_stroke(session: &Session) -> bool {
    let bent = |stroke: &crate::paint::Stroke| stroke.operator() != Operator::None;
    has_any(
        session,
        |content| matches!(content, Content::Strokes(live) if live.params().strokes.iter().any(|s| bent(s))),
    )
}

fn has_moved(session: &Session) -> bool {
    let moves = ["Move anchor", "Add anchor", "Move stroke", "Move layer"];
    session
        .active()
        .is_some_and(|open| open.history.past_names().any(|label| moves.contains(&label)))
}

impl MainWindow {
    /// Shows them until all are completed or they are dismissed.
    pub(super) fn show_steps(&mut self, ui: &mut Ui) {
        let is_over = self.settings.is_hint_done
            || self.session.active().is_none_or(|open| open.document().surface.is_none());
        if is_over || !self.is_first_start {
            return;
        }
        // A step done once in any document is done.
        for (was_done, (_, _, is_done)) in self.steps_done.iter_mut().zip(STEPS) {
            *was_done |= is_done(&self.session);
        }
        let done = self.steps_done;
        let corner = ui.max_rect().left_top() + vec2(14.0, 14.0);
        let area = Area::new(Id::unique("first steps")).fixed_pos(corner).pivot(Align2::LEFT_TOP);
        area.show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_width(230.0);
                ui.label(RichText::new("Three steps").strong());
                for (i, ((name, how, _), is_done)) in STEPS.iter().zip(done).enumerate() {
                    let name = RichText::new(format!("{}  {name}", i + 1));
                    ui.label(if is_done { name.weak().strikethrough() } else { name.strong() });
                    if !is_done {
                        ui.label(RichText::new(*how).small().weak());
                    }
                }
                let put_away = if done == [true; 3] { "Done" } else { "Not now" };
                if ui.button(put_away).clicked() {
                    self.settings.is_hint_done = true;
                }
            });
        });
    }
}
