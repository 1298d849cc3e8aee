//! The page of the pen: what it reports now, a place to try it, and how hard it has to be pressed.
//! Floor 7.

use super::rows;
use crate::dialogs::DialogContext;
use crate::language::{tr, tr_number};
use crate::paint::Curve;
use crate::panels::curve;
use crate::pen::{PenPhase, PenReport};
use crate::preferences::PreferencePage;
use crate::session::Action;
use crate::session::actions::HandAction;
use crate::tr;
use crate::widgets::{set_accessible_name, title};
use eframe::egui::{Grid, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

/// The line that presses most is this wide, points.
const WIDEST_PT: f32 = 14.0;
/// The most places of the trial that are kept.
const MOST_PLACES: usize = 4000;
/// What a pen needs on each system.
const ADVICE: &str = if cfg!(target_os = "windows") {
    "No pressure yet. Draw here with the pen. If this stays: switch Windows Ink on in the driver of the tablet."
} else if cfg!(target_os = "macos") {
    "No pressure yet. On macOS the pen is heard as a mouse; Pressure from speed thins quick lines."
} else {
    "No pressure yet. Draw here with the pen. If this stays: it is heard through X11 alone, so unset RILIEVO_WAYLAND; \
     xinput list should name the tablet."
};

/// What was drawn in the place to try the pen, and the last report.
#[derive(Default)]
pub struct PenPage {
    last: Option<PenReport>,
    has_pressure: bool,
    is_down: bool,
    /// Where the pen was, in the place to try it, and how hard it pressed; `None` between strokes.
    drawn: Vec<Option<(Pos2, f32)>>,
}

impl PenPage {
    pub fn show(&mut self, ui: &mut Ui, context: &mut DialogContext) {
        title(ui, "Try it");
        let pressure = context.settings.preferences.pressure.clone();
        self.trial(ui, context.pens, &pressure);
        self.readout(ui, &pressure);
        let preferences = &mut context.settings.preferences;
        ui.horizontal(|ui| {
            title(ui, "Pressure");
            let can = !preferences.is_pressed_as_reported();
            let reset = ui.add_enabled(can, eframe::egui::Button::new(tr("Reset")).small());
            set_accessible_name(&reset, tr("Reset the pressure"));
            if reset.on_hover_text(tr("As the pen reports it")).clicked() {
                preferences.reset_pressure();
            }
        });
        ui.weak(tr("To the right: how hard you press. Upward: what that counts as."));
        if let Some(changed) =
            curve::show(ui, "Curve of the pressure", &preferences.pressure, 112.0)
        {
            preferences.pressure = changed.to;
        }
        let before = preferences.presses_by_speed;
        rows(ui, PreferencePage::Pen, preferences);
        let on = preferences.presses_by_speed;
        if on != before {
            context.requests.act(Action::Hand(HandAction::PressBySpeed { on }));
        }
    }

    /// A place to draw in.
    fn trial(&mut self, ui: &mut Ui, pens: &[PenReport], pressure: &Curve) {
        let size = vec2(ui.available_width(), 92.0);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        set_accessible_name(&response, tr("Place to try the pen"));
        for report in pens {
            self.read_report(report, rect, pressure);
        }
        let visuals = ui.visuals();
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 4.0, visuals.extreme_bg_color);
        let color = visuals.strong_text_color();
        for pair in self.drawn.windows(2) {
            let [Some((from, _)), Some((to, pressed))] = pair else { continue };
            let place = |p: &Pos2| rect.min + p.to_vec2();
            let width = (WIDEST_PT * pressed).max(0.5);
            painter.line_segment([place(from), place(to)], Stroke::new(width, color));
            painter.add(Shape::circle_filled(place(to), 0.5 * width, color));
        }
        if self.drawn.is_empty() {
            let font = eframe::egui::TextStyle::Body.resolve(ui.style());
            let middle = eframe::egui::Align2::CENTER_CENTER;
            painter.text(rect.center(), middle, tr("Draw here"), font, visuals.weak_text_color());
        }
    }

    fn read_report(&mut self, report: &PenReport, rect: Rect, pressure: &Curve) {
        self.last = Some(*report);
        self.has_pressure |= report.pressure.is_some();
        let is_here = rect.contains(report.at);
        match report.phase {
            PenPhase::Down(_) if is_here => {
                if self.drawn.len() > MOST_PLACES {
                    self.drawn.clear();
                }
                self.is_down = true;
                self.drawn.push(None);
            }
            PenPhase::Up | PenPhase::Lost => self.is_down = false,
            _ => {}
        }
        if self.is_down && is_here && self.drawn.len() <= MOST_PLACES {
            let pressed = report.pressure.map_or(0.5, |pressed| pressure.at(pressed));
            let place = pos2(report.at.x - rect.left(), report.at.y - rect.top());
            self.drawn.push(Some((place, pressed)));
        }
    }

    /// What it reports now; without a pen, what can be done.
    fn readout(&self, ui: &mut Ui, pressure: &Curve) {
        if !self.has_pressure {
            return drop(ui.weak(tr(ADVICE)));
        }
        let Some(last) = self.last else { return };
        let pressed = last.pressure.unwrap_or(0.0);
        Grid::new("pen").num_columns(2).spacing([16.0, 2.0]).show(ui, |ui| {
            ui.label(tr("Pressure"));
            let number = |value: f32| tr_number(&format!("{value:.3}")).into_owned();
            let (pressure, painted) = (number(pressed), number(pressure.at(pressed)));
            ui.monospace(tr!("{pressure}, painted with as {painted}", pressure, painted));
            ui.end_row();
            ui.label(tr("Tilt"));
            let [right, down] = [last.tilt.0, last.tilt.1].map(|tilt| format!("{tilt:.0}"));
            ui.monospace(match last.is_eraser {
                true => tr!("{right}° right, {down}° down, the other end", right, down),
                false => tr!("{right}° right, {down}° down", right, down),
            });
            ui.end_row();
        });
    }
}
