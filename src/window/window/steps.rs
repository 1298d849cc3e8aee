//! The steps of a tour, shown over the canvas until they are done or put away. Floor 7. Not here:
//! what they are (`tour`).

use super::MainWindow;
use crate::language::tr;
use crate::requests::UiRequests;
use crate::tour::{self, Tour, TourStep};
use eframe::egui::{Align2, Area, Frame, Id, RichText, TextStyle, Ui, vec2};

const WIDTH_PT: f32 = 250.0;

/// A tour, and which of its steps were done.
pub(super) struct TourProgress {
    tour: &'static Tour,
    done: Vec<bool>,
    /// The document that it began in.
    document: usize,
}

impl TourProgress {
    /// The first step that is not done.
    fn next(&self) -> Option<usize> {
        self.done.iter().position(|is_done| !is_done)
    }
}

impl MainWindow {
    /// Begins a tour in the document in front; the hints on a shape only until they were put away once.
    pub(super) fn begin_tour(&mut self, tour: &'static Tour) {
        let is_known = std::ptr::eq(tour, &tour::ON_A_SHAPE) && self.settings.is_hint_done;
        let Some(open) = self.session.active().filter(|_| !is_known) else { return };
        let done = vec![false; tour.steps.len()];
        self.steps = Some(TourProgress { tour, done, document: open.key });
    }

    /// Shows the steps while their document is in front.
    pub(super) fn show_steps(&mut self, ui: &mut Ui, requests: &mut UiRequests) {
        let key = self.session.active().map(|open| open.key);
        let Some(progress) = self.steps.as_mut().filter(|steps| Some(steps.document) == key) else {
            return;
        };
        // A step that was done once stays done.
        for (was_done, step) in progress.done.iter_mut().zip(progress.tour.steps) {
            *was_done = *was_done || (step.is_done)(&self.session);
        }
        let next = progress.next();
        let mut is_put_away = false;
        let corner = ui.max_rect().left_top() + vec2(14.0, 14.0);
        let area = Area::new(Id::unique("first steps")).fixed_pos(corner).pivot(Align2::LEFT_TOP);
        area.show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_width(WIDTH_PT);
                ui.label(RichText::new(tr(progress.tour.title)).strong());
                for (i, (step, is_done)) in
                    progress.tour.steps.iter().zip(&progress.done).enumerate()
                {
                    name(ui, i, step, *is_done);
                    if next == Some(i) {
                        how(ui, step);
                    }
                }
                ui.add_space(4.0);
                ui.horizontal(|ui| {
                    let show = next.and_then(|i| progress.tour.steps[i].show);
                    if show.is_some() && ui.button(tr("Show me")).clicked() {
                        show.into_iter().for_each(|show| show(&self.session, requests));
                    }
                    is_put_away = ui
                        .button(if next.is_none() { tr("Done") } else { tr("Not now") })
                        .clicked();
                });
            });
        });
        if is_put_away {
            self.settings.is_hint_done = true;
            self.steps = None;
        }
    }
}

/// As high for every step, so that the buttons stay where they are.
fn how(ui: &mut Ui, step: &TourStep) {
    ui.scope(|ui| {
        let line_pt = ui.text_style_height(&TextStyle::Small);
        ui.set_min_height(3.0 * line_pt);
        ui.label(RichText::new(tr(step.how)).small());
    });
}

fn name(ui: &mut Ui, index: usize, step: &TourStep, is_done: bool) {
    let name = RichText::new(format!("{}  {}", index + 1, tr(step.name)));
    ui.label(if is_done { name.weak().strikethrough() } else { name.strong() });
}
