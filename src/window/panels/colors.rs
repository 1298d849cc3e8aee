//! Color: a square of saturation and value next to a bar of hues, or a wheel of hues around it; the
//! last colors used, those that go with the current one, bars of lightness, chroma and hue, numbers
//! and a palette. Floor 7. `wheel` draws the areas.

mod sliders;
mod wheel;

use crate::harmony::Harmony;
use crate::icons::{Icon, icon_button};
use crate::language::tr;
use crate::math::hsv;
use crate::math::srgb::{Color, quantize};
use crate::panel_layout::{ColorView, PanelKind};
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::tr;
use crate::widgets::{NumberField, ValueChange, check, set_accessible_name, swatch};
use eframe::egui::{
    self, Button, Id, Popup, PopupCloseBehavior, Sense, Stroke, StrokeKind, TextEdit, Ui, Vec2,
    vec2,
};

/// Sides of a swatch of the row, points, and the gap between two.
const SWATCH_PT: f32 = 18.0;
const GAP_PT: f32 = 3.0;

/// The panel where it has a window of its own.
pub fn show(ui: &mut Ui, session: &Session, view: &mut ColorView, requests: &mut UiRequests) {
    let area_pt = (0.8 * ui.available_width()).max(80.0).min(260.0);
    show_area(ui, session, view, area_pt, requests);
}

/// The part that is always in sight: the area, so many points high, and the last colors in a row
/// that never moves.
pub fn show_area(
    ui: &mut Ui,
    session: &Session,
    view: &mut ColorView,
    area_pt: f32,
    requests: &mut UiRequests,
) {
    const LABEL: &str = "Current color";
    let color = session.tools.color;
    let size = vec2(ui.available_width(), area_pt);
    let look = if view.is_wheel { AreaLook::Wheel(view.harmony) } else { AreaLook::Square };
    let mut changed = area(ui, LABEL, color, size, look);
    row(ui, session, view, requests);
    companions(ui, LABEL, color, view.harmony, requests);
    if view.has_sliders {
        changed = sliders::sliders(ui, LABEL, color).or(changed);
    }
    if view.has_numbers {
        changed = numbers(ui, LABEL, color).or(changed);
        palette(ui, session, requests);
    }
    if let Some(changed) = changed {
        requests.act(Action::Hand(HandAction::Color { color: changed.to }));
    }
}

/// Both colors, the last ones, and a menu. Places that hold no color yet are empty.
fn row(ui: &mut Ui, session: &Session, view: &mut ColorView, requests: &mut UiRequests) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP_PT;
        swatch(ui, "Paint color", session.tools.color, vec2(1.6 * SWATCH_PT, SWATCH_PT));
        let other =
            swatch(ui, "Other color", session.tools.second_color, vec2(SWATCH_PT, SWATCH_PT));
        if other.on_hover_text(tr("Click to paint with it (X)")).clicked() {
            requests.act(Action::Hand(HandAction::SwapColors {}));
        }
        ui.add_space(7.0);
        let room_pt = ui.available_width() - crate::icons::BUTTON_PT - 2.0;
        let places = (room_pt / (SWATCH_PT + GAP_PT)).max(0.0) as usize;
        for i in 0..places {
            let size = vec2(SWATCH_PT, SWATCH_PT);
            let Some(&color) = session.recent_colors.get(i) else {
                let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
                let line = Stroke::new(1.0, ui.visuals().widgets.inactive.weak_bg_fill);
                ui.painter().rect_stroke(rect, 3.0, line, StrokeKind::Inside);
                continue;
            };
            if swatch(ui, &tr!("Recent color {number}", number = i + 1), color, size).clicked() {
                requests.act(Action::Hand(HandAction::Color { color }));
            }
        }
        menu(ui, view, requests);
    });
}

/// The colors that go with the current one.
fn companions(ui: &mut Ui, label: &str, color: Color, harmony: Harmony, requests: &mut UiRequests) {
    if harmony == Harmony::None {
        return;
    }
    let now = known_hsv(ui, label, color);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP_PT;
        ui.weak(tr(harmony.label()));
        for (other, i) in harmony.colors(now).zip(1..) {
            let size = vec2(1.6 * SWATCH_PT, SWATCH_PT);
            if swatch(ui, &tr!("Harmony {number}", number = i), other, size).clicked() {
                requests.act(Action::Hand(HandAction::Color { color: other }));
            }
        }
    });
}

/// What the panel shows, and where.
fn menu(ui: &mut Ui, view: &mut ColorView, requests: &mut UiRequests) {
    let dots = icon_button(ui, Icon::Dots, "Color", false)
        .on_hover_text(tr("Wheel, sliders, harmony, numbers and palette, window of its own"));
    let stays = PopupCloseBehavior::CloseOnClickOutside;
    Popup::menu(&dots).close_behavior(stays).show(|ui| {
        let hint = "A wheel of hues around the square";
        view.is_wheel = check(ui, "Wheel", hint, view.is_wheel).unwrap_or(view.is_wheel);
        let hint = "Lightness, chroma and hue of OKLCH, with the edge of sRGB";
        let sliders = check(ui, "Lightness, chroma, hue", hint, view.has_sliders);
        view.has_sliders = sliders.unwrap_or(view.has_sliders);
        let hint = "Hue, saturation, value, red, green, blue, hex, and a palette";
        let numbers = check(ui, "Numbers and palette", hint, view.has_numbers);
        view.has_numbers = numbers.unwrap_or(view.has_numbers);
        ui.menu_button(tr("Harmony"), |ui| {
            for (harmony, label) in Harmony::LABELS {
                let row = Button::selectable(view.harmony == harmony, tr(label));
                if ui.add(row).on_hover_text(tr(harmony.hint())).clicked() {
                    view.harmony = harmony;
                    ui.close();
                }
            }
        });
        if ui.button(tr("In a window of its own, or back")).clicked() {
            requests.request(WindowRequest::Float(PanelKind::Color));
            ui.close();
        }
    });
}

/// Colors to select by a click: those of the palette that is shown, as far as there is room.
fn palette(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    /// Larger palettes have a panel of their own.
    const MOST: usize = 48;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(GAP_PT, GAP_PT);
        for named in session.choice_of_colors().colors.iter().take(MOST) {
            let label = if named.name.is_empty() { "Palette" } else { &named.name };
            if swatch(ui, label, named.color, vec2(SWATCH_PT, SWATCH_PT)).clicked() {
                requests.act(Action::Hand(HandAction::Color { color: named.color }));
            }
        }
    });
}

/// The color of a hue, a saturation and a value, each in `[0, 1]`, of the encoded numbers.
fn srgb(color: [f32; 3], a: u8) -> Color {
    let [r, g, b] = hsv::to_rgb(color).map(quantize);
    Color { r, g, b, a }
}

/// The inverse of [`srgb`]; a gray has hue 0.
fn hsv_of(color: Color) -> [f32; 3] {
    let [r, g, b, _] = color.to_f32();
    hsv::from_rgb([r, g, b])
}

/// The hue, saturation and value of a color; `label` keeps the hue while the color is gray.
fn known_hsv(ui: &Ui, label: &str, color: Color) -> [f32; 3] {
    let kept = ui.data(|data| data.get_temp::<(Color, [f32; 3])>(hue_id(label)));
    kept.filter(|(seen, _)| *seen == color).map_or_else(|| hsv_of(color), |(_, hsv)| hsv)
}

fn hue_id(label: &str) -> Id {
    Id::unique(("hue", label.to_owned()))
}

/// The color of a hue, a saturation and a value, which are remembered.
fn put(ui: &Ui, label: &str, hsv: [f32; 3], a: u8, done: bool) -> ValueChange<Color> {
    let to = srgb(hsv, a);
    ui.data_mut(|data| data.insert_temp(hue_id(label), (to, hsv)));
    ValueChange { to, done }
}

/// The picker with its numbers; `label` names it for tests.
pub fn picker(ui: &mut Ui, label: &str, color: Color) -> Option<ValueChange<Color>> {
    let width = ui.available_width().min(240.0);
    let size = vec2(width, (0.55 * width).max(60.0));
    let changed = area(ui, label, color, size, AreaLook::Square);
    numbers(ui, label, color).or(changed)
}

/// How the area looks.
#[derive(Clone, Copy)]
enum AreaLook {
    Square,
    Wheel(Harmony),
}

/// The area where a color is chosen by eye.
fn area(
    ui: &mut Ui,
    label: &str,
    color: Color,
    size: Vec2,
    look: AreaLook,
) -> Option<ValueChange<Color>> {
    let now = known_hsv(ui, label, color);
    let changed = match look {
        AreaLook::Wheel(harmony) => wheel::wheel(ui, label, now, size, harmony),
        AreaLook::Square => wheel::square_and_bar(ui, label, now, size),
    };
    changed.map(|changed| put(ui, label, changed.to, color.a, changed.done))
}

/// Hue, saturation, value, red, green, blue, and hex.
fn numbers(ui: &mut Ui, label: &str, color: Color) -> Option<ValueChange<Color>> {
    let now = known_hsv(ui, label, color);
    let mut out = None;
    // The salt distinguishes the panel's picker from one in a popup.
    let grid = egui::Grid::new(("numbers", label)).num_columns(6).min_col_width(0.0);
    grid.spacing([5.0, 4.0]).show(ui, |ui| {
        let rows = [("H", "Hue", 360.0), ("S", "Saturation", 100.0), ("V", "Value", 100.0)];
        for (i, (letter, name, scale)) in rows.into_iter().enumerate() {
            ui.weak(letter);
            let field = NumberField::new(name, 0.0..=scale, name).decimals(0);
            if let Some(changed) = field.field(ui, now[i] * scale) {
                let mut hsv = now;
                hsv[i] = changed.to / scale;
                out = Some(put(ui, label, hsv, color.a, changed.done));
            }
        }
        ui.end_row();
        let bytes = [color.r, color.g, color.b];
        for (i, (letter, name)) in
            [("R", "Red"), ("G", "Green"), ("B", "Blue")].into_iter().enumerate()
        {
            ui.weak(letter);
            let field = NumberField::new(name, 0.0..=255.0, name).decimals(0);
            if let Some(changed) = field.field(ui, f32::from(bytes[i])) {
                let mut next = bytes;
                next[i] = changed.to as u8;
                let [r, g, b] = next;
                out = Some(ValueChange { to: Color { r, g, b, a: color.a }, done: changed.done });
            }
        }
        ui.end_row();
    });
    ui.horizontal(|ui| {
        ui.weak(tr("Hex"));
        if let Some(to) = hex(ui, color) {
            out = Some(ValueChange { to, done: true });
        }
    });
    out
}

/// `#rrggbb`, read when the field is left.
fn hex(ui: &mut Ui, color: Color) -> Option<Color> {
    let id = Id::unique("hex color");
    let shown = Color { a: 255, ..color }.to_string();
    let mut text = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| shown.clone());
    let response = ui.add(TextEdit::singleline(&mut text).desired_width(74.0).char_limit(9));
    set_accessible_name(&response, tr("Hex color"));
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, text));
        return None;
    }
    ui.data_mut(|data| data.remove::<String>(id));
    let typed = if text.starts_with('#') { text } else { format!("#{text}") };
    let to = Color::parse(typed.trim()).filter(|_| response.lost_focus() && typed != shown)?;
    Some(Color { a: color.a, ..to })
}

/// A swatch that opens a picker.
pub fn button(ui: &mut Ui, label: &str, color: Color) -> Option<ValueChange<Color>> {
    let response = swatch(ui, label, color, vec2(44.0, 19.0));
    let mut out = None;
    egui::Popup::menu(&response)
        .close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            ui.set_width(220.0);
            out = picker(ui, label, color);
        });
    out
}
