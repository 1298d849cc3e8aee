//! Color: a square of saturation and value next to a bar of hues, or a wheel of hues around it; the
//! last colors used, numbers and a palette. Floor 7. `wheel` draws the areas.

mod wheel;

use crate::icons::{Icon, icon_button};
use crate::math::srgb::Color;
use crate::panel_layout::{ColorView, PanelKind};
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::widgets::{NumberField, ValueChange, check, set_accessible_name, swatch};
use eframe::egui::{
    self, Id, Popup, PopupCloseBehavior, Sense, Stroke, StrokeKind, TextEdit, Ui, Vec2, vec2,
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
    let mut changed = area(ui, LABEL, color, size, view.is_wheel);
    row(ui, session, view, requests);
    if view.has_numbers {
        changed = numbers(ui, LABEL, color).or(changed);
        palette(ui, requests);
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
        if other.on_hover_text("Click to paint with it (X)").clicked() {
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
            if swatch(ui, &format!("Recent color {}", i + 1), color, size).clicked() {
                requests.act(Action::Hand(HandAction::Color { color }));
            }
        }
        menu(ui, view, requests);
    });
}

/// What the panel shows, and where.
fn menu(ui: &mut Ui, view: &mut ColorView, requests: &mut UiRequests) {
    let dots = icon_button(ui, Icon::Dots, "Color", false)
        .on_hover_text("Wheel, numbers and palette, window of its own");
    let stays = PopupCloseBehavior::CloseOnClickOutside;
    Popup::menu(&dots).close_behavior(stays).show(|ui| {
        let hint = "A wheel of hues around the square";
        view.is_wheel = check(ui, "Wheel", hint, view.is_wheel).unwrap_or(view.is_wheel);
        let hint = "Hue, saturation, value, red, green, blue, hex, and a palette";
        let numbers = check(ui, "Numbers and palette", hint, view.has_numbers);
        view.has_numbers = numbers.unwrap_or(view.has_numbers);
        if ui.button("In a window of its own, or back").clicked() {
            requests.request(WindowRequest::Float(PanelKind::Color));
            ui.close();
        }
    });
}

/// Colors to select by a click.
fn palette(ui: &mut Ui, requests: &mut UiRequests) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(GAP_PT, GAP_PT);
        for [r, g, b] in PALETTE {
            let color = Color { r, g, b, a: 255 };
            if swatch(ui, "Palette", color, vec2(SWATCH_PT, SWATCH_PT)).clicked() {
                requests.act(Action::Hand(HandAction::Color { color }));
            }
        }
    });
}

/// Grays and earths, then a few clear hues: a start, not a choice.
const PALETTE: [[u8; 3]; 14] = [
    [0, 0, 0],
    [64, 64, 64],
    [128, 128, 128],
    [192, 192, 192],
    [255, 255, 255],
    [92, 58, 38],
    [176, 120, 78],
    [232, 196, 150],
    [190, 40, 40],
    [236, 150, 40],
    [244, 214, 84],
    [76, 150, 84],
    [56, 116, 190],
    [120, 72, 156],
];

/// The color of a hue, a saturation and a value, each in `[0, 1]`, of the encoded numbers.
fn srgb([h, s, v]: [f32; 3], a: u8) -> Color {
    let channel = |offset: f32| {
        let t = ((h + offset).rem_euclid(1.0) * 6.0 - 3.0).abs() - 1.0;
        crate::math::srgb::quantize(v * (1.0 - s + s * t.clamp(0.0, 1.0)))
    };
    Color { r: channel(0.0), g: channel(2.0 / 3.0), b: channel(1.0 / 3.0), a }
}

/// The inverse of [`srgb`]; a gray has hue 0.
fn hsv(color: Color) -> [f32; 3] {
    let [r, g, b, _] = color.to_f32();
    let (high, low) = (r.max(g).max(b), r.min(g).min(b));
    let span = high - low;
    let hue = match span {
        0.0 => 0.0,
        _ if high == r => ((g - b) / span).rem_euclid(6.0),
        _ if high == g => (b - r) / span + 2.0,
        _ => (r - g) / span + 4.0,
    };
    [hue / 6.0, if high > 0.0 { span / high } else { 0.0 }, high]
}

/// The hue, saturation and value of a color; `label` keeps the hue while the color is gray.
fn known_hsv(ui: &Ui, label: &str, color: Color) -> [f32; 3] {
    let kept = ui.data(|data| data.get_temp::<(Color, [f32; 3])>(hue_id(label)));
    kept.filter(|(seen, _)| *seen == color).map_or_else(|| hsv(color), |(_, hsv)| hsv)
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
    let changed = area(ui, label, color, vec2(width, (0.55 * width).max(60.0)), false);
    numbers(ui, label, color).or(changed)
}

/// The area where a color is chosen by eye.
fn area(
    ui: &mut Ui,
    label: &str,
    color: Color,
    size: Vec2,
    is_wheel: bool,
) -> Option<ValueChange<Color>> {
    let now = known_hsv(ui, label, color);
    let changed = match is_wheel {
        true => wheel::wheel(ui, label, now, size),
        false => wheel::square_and_bar(ui, label, now, size),
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
        ui.weak("Hex");
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
    set_accessible_name(&response, "Hex color");
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_color_survives_hue_saturation_and_value() {
        for r in (0..=255).step_by(15) {
            for g in (0..=255).step_by(15) {
                for b in (0..=255).step_by(15) {
                    let color = Color { r: r as u8, g: g as u8, b: b as u8, a: 255 };
                    assert_eq!(srgb(hsv(color), 255), color);
                }
            }
        }
    }
}
