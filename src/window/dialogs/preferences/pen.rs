//! The page of the pen: what it reports now, a place to try it, how hard it has to be pressed, and
//! what its buttons do. Floor 7.

use super::rows;
use crate::dialogs::DialogContext;
use crate::language::{tr, tr_number};
use crate::paint::Curve;
use crate::panels::curve;
use crate::pen::{PenPhase, PenReport};
use crate::preferences::{BarrelAction, PreferencePage, Preferences};
use crate::session::Action;
use crate::session::actions::HandAction;
use crate::tr;
use crate::widgets::{choice_row, set_accessible_name, title};
use eframe::egui::{
    Button, Grid, PointerButton, Pos2, ProgressBar, Rect, Sense, Shape, Stroke, Ui, pos2, vec2,
};

/// The line that presses most is this wide, points.
const WIDEST_PT: f32 = 14.0;
/// The most places of the trial that are kept.
const MOST_PLACES: usize = 4000;
const TRIAL_PT: f32 = 84.0;
/// What is read of the pen, and what to do without one, take the same room.
const READOUT_PT: f32 = 84.0;
const CURVE_PT: f32 = 112.0;
/// What a pen needs on each system.
const ADVICE: &str = if cfg!(target_os = "windows") {
    "No pen yet. Draw here with it. If this stays: switch Windows Ink on in the settings of the tablet's driver, \
     and start Rilievo again."
} else if cfg!(target_os = "macos") {
    "No pen yet. Draw here with it. If this stays: install the tablet's driver, and allow it under \
     Privacy & Security, Accessibility, in the settings of the system."
} else if cfg!(target_family = "wasm") {
    "No pen yet. Draw here with it. If this stays: the browser takes it for a mouse; try another one."
} else {
    "No pen yet. Draw here with it. If this stays: “libinput list-devices”, and on X11 “xinput list”, should name \
     the tablet."
};
/// Beside the choices of the buttons.
const BARREL_HINT: &str = "Over the canvas. Elsewhere the buttons click.";

/// What was drawn in the place to try the pen, and the last report.
#[derive(Default)]
pub struct PenPage {
    last: Option<PenReport>,
    has_pressure: bool,
    is_down: bool,
    /// The buttons that are held, the tip among them.
    held: Vec<PointerButton>,
    /// Where the pen was, in the place to try it, and how hard it pressed; `None` between strokes.
    drawn: Vec<Option<(Pos2, f32)>>,
}

impl PenPage {
    pub fn show(&mut self, ui: &mut Ui, context: &mut DialogContext) {
        ui.horizontal(|ui| {
            title(ui, "Try it");
            let can = !self.drawn.is_empty();
            if ui.add_enabled(can, Button::new(tr("Clear")).small()).clicked() {
                self.drawn.clear();
            }
        });
        let pressure = context.settings.preferences.pressure.clone();
        self.trial(ui, context.pens, &pressure);
        let size = vec2(ui.available_width(), READOUT_PT);
        ui.allocate_ui(size, |ui| {
            ui.set_min_size(size);
            self.readout(ui, &pressure);
        });
        let preferences = &mut context.settings.preferences;
        let before = preferences.presses_by_speed;
        ui.columns_const(|[left, right]| {
            show_pressure(left, preferences);
            show_barrel(right, preferences);
        });
        let on = preferences.presses_by_speed;
        if on != before {
            context.requests.act(Action::Hand(HandAction::PressBySpeed { on }));
        }
    }

    /// A place to draw in.
    fn trial(&mut self, ui: &mut Ui, pens: &[PenReport], pressure: &Curve) {
        let size = vec2(ui.available_width(), TRIAL_PT);
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
            PenPhase::Down(button) => self.held.push(button),
            PenPhase::Up(button) => self.held.retain(|held| *held != button),
            PenPhase::Lost => self.held.clear(),
            PenPhase::Move => {}
        }
        match report.phase {
            PenPhase::Down(PointerButton::Primary) if is_here => {
                if self.drawn.len() > MOST_PLACES {
                    self.drawn.clear();
                }
                self.is_down = true;
                self.drawn.push(None);
            }
            PenPhase::Up(PointerButton::Primary) | PenPhase::Lost => self.is_down = false,
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
        let Some(last) = self.last.filter(|_| self.has_pressure) else {
            return drop(ui.weak(tr(ADVICE)));
        };
        let pressed = last.pressure.unwrap_or(0.0);
        let counts = pressure.at(pressed);
        ui.horizontal(|ui| {
            show_tilt(ui, last.tilt);
            ui.vertical(|ui| {
                let bar = ui.add(ProgressBar::new(counts).desired_height(4.0));
                set_accessible_name(&bar, tr("Pressure that is painted with"));
                Grid::new("pen").num_columns(2).spacing([16.0, 0.0]).show(ui, |ui| {
                    let mut row = |name: &str, text: String| {
                        ui.label(tr(name));
                        ui.monospace(text);
                        ui.end_row();
                    };
                    let number = |value: f32| tr_number(&format!("{value:.3}")).into_owned();
                    let (pressure, painted) = (number(pressed), number(counts));
                    row(
                        "Pressure",
                        tr!("{pressure}, painted with as {painted}", pressure, painted),
                    );
                    let [right, down] = [last.tilt.0, last.tilt.1].map(|tilt| format!("{tilt:.0}"));
                    row("Tilt", tr!("{right}° right, {down}° down", right, down));
                    if let Some(twist) = last.twist {
                        row("Twist", format!("{twist:.0}°"));
                    }
                    row("Held", self.held_text(last.is_eraser));
                });
            });
        });
    }

    fn held_text(&self, is_eraser: bool) -> String {
        let mut held: Vec<_> = self.held.iter().map(|button| button_name(*button)).collect();
        if is_eraser {
            held.insert(0, tr("the other end"));
        }
        if held.is_empty() { tr("nothing").to_owned() } else { held.join(", ") }
    }
}

fn button_name(button: PointerButton) -> &'static str {
    match button {
        PointerButton::Primary => tr("tip"),
        PointerButton::Secondary => tr("right click"),
        PointerButton::Middle => tr("middle click"),
        PointerButton::Extra1 | PointerButton::Extra2 => tr("another button"),
    }
}

/// The pen seen from above: a line from its tip to where its end leans.
fn show_tilt(ui: &mut Ui, tilt: (f32, f32)) {
    let side = READOUT_PT - 12.0;
    let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::hover());
    set_accessible_name(&response, tr("Tilt of the pen"));
    let (visuals, painter) = (ui.visuals(), ui.painter());
    let radius = 0.5 * side;
    painter.circle_filled(rect.center(), radius, visuals.extreme_bg_color);
    let faint = Stroke::new(1.0, visuals.weak_text_color());
    painter.circle_stroke(rect.center(), 0.5 * radius, faint);
    // Flat on the tablet is the rim.
    let leans = vec2(tilt.0, tilt.1) / 90.0;
    let end = rect.center() + radius * leans / leans.length().max(1.0);
    let color = visuals.strong_text_color();
    painter.line_segment([rect.center(), end], Stroke::new(2.0, color));
    painter.circle_filled(end, 3.0, color);
}

/// From the pressure that is reported to the one that is painted with.
fn show_pressure(ui: &mut Ui, preferences: &mut Preferences) {
    ui.horizontal(|ui| {
        title(ui, "Pressure");
        let can = !preferences.is_pressed_as_reported();
        let reset = ui.add_enabled(can, Button::new(tr("Reset")).small());
        set_accessible_name(&reset, tr("Reset the pressure"));
        if reset.on_hover_text(tr("As the pen reports it")).clicked() {
            preferences.reset_pressure();
        }
    });
    let curve = curve::show(ui, "Curve of the pressure", &preferences.pressure, CURVE_PT);
    if let Some(changed) = curve {
        preferences.pressure = changed.to;
    }
    ui.weak(tr("To the right: how hard you press. Upward: what that counts as."));
    rows(ui, PreferencePage::Pen, preferences);
}

/// What the buttons on the barrel do.
fn show_barrel(ui: &mut Ui, preferences: &mut Preferences) {
    title(ui, "Buttons on the barrel");
    for barrel in Preferences::BARREL {
        let now = (barrel.get)(preferences);
        if let Some(to) = choice_row(ui, barrel.label, now, &BarrelAction::LABELS) {
            (barrel.set)(preferences, to);
        }
    }
    ui.weak(tr(BARREL_HINT));
}
