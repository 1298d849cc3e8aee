//! Color: a square of saturation and value next to a bar of hues, numbers, and the last ones used.
//! Floor 7.

use crate::math::srgb::Color;
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::theme::color32;
use crate::widgets::{NumberField, ValueChange, set_accessible_name, swatch};
use eframe::egui::{self, Color32, Id, Mesh, Rect, Sense, Shape, Stroke, TextEdit, Ui, pos2, vec2};

pub fn show(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    if let Some(changed) = picker(ui, "Current color", session.tools.color) {
        requests.act(Action::Hand(HandAction::Color { color: changed.to }));
    }
    let recent = session.recent_colors.iter().enumerate();
    swatches(
        ui,
        "Recent",
        recent.map(|(i, &color)| (format!("Recent color {}", i + 1), color)),
        requests,
    );
    let palette =
        PALETTE.iter().map(|&[r, g, b]| ("Palette".to_owned(), Color { r, g, b, a: 255 }));
    swatches(ui, "Palette", palette, requests);
}

/// The current color and the last ones, in one row: for panels that hide the picker.
pub fn strip(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    /// As many as a narrow panel has room for.
    const RECENT: usize = 8;
    ui.horizontal(|ui| {
        if let Some(changed) = button(ui, "Changes the current color", session.tools.color) {
            requests.act(Action::Hand(HandAction::Color { color: changed.to }));
        }
        ui.spacing_mut().item_spacing.x = 3.0;
        for (i, &color) in session.recent_colors.iter().take(RECENT).enumerate() {
            if swatch(ui, &format!("Paint with recent color {}", i + 1), color, vec2(18.0, 18.0))
                .clicked()
            {
                requests.act(Action::Hand(HandAction::Color { color }));
            }
        }
    });
}

/// Colors to select by a click.
fn swatches(
    ui: &mut Ui,
    name: &str,
    colors: impl ExactSizeIterator<Item = (String, Color)>,
    requests: &mut UiRequests,
) {
    if colors.len() == 0 {
        return;
    }
    ui.weak(name);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 3.0);
        for (label, color) in colors {
            if swatch(ui, &label, color, vec2(18.0, 18.0)).clicked() {
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

/// The picker; `label` names it for tests and keeps its hue while the color is gray.
pub fn picker(ui: &mut Ui, label: &str, color: Color) -> Option<ValueChange<Color>> {
    let kept = Id::unique(("hue", label.to_owned()));
    let mut now = hsv(color);
    if let Some((seen, hsv)) = ui.data(|data| data.get_temp::<(Color, [f32; 3])>(kept))
        && seen == color
    {
        now = hsv;
    }
    let mut out = None;
    let mut put = |ui: &Ui, hsv: [f32; 3], done: bool| {
        let to = srgb(hsv, color.a);
        ui.data_mut(|data| data.insert_temp(kept, (to, hsv)));
        out = Some(ValueChange { to, done });
    };
    let side = (ui.available_width() - 30.0).clamp(60.0, 190.0);
    ui.horizontal(|ui| {
        if let Some(changed) = square(ui, label, now, side) {
            put(ui, changed.to, changed.done);
        }
        if let Some(changed) = hues(ui, label, now, side) {
            put(ui, changed.to, changed.done);
        }
    });
    // The salt distinguishes the panel's picker from one in a popup.
    egui::Grid::new(("numbers", label)).num_columns(6).min_col_width(0.0).spacing([5.0, 4.0]).show(
        ui,
        |ui| {
            for (i, (letter, name, scale)) in
                [("H", "Hue", 360.0), ("S", "Saturation", 100.0), ("V", "Value", 100.0)]
                    .into_iter()
                    .enumerate()
            {
                ui.weak(letter);
                if let Some(changed) =
                    NumberField::new(name, 0.0..=scale, name).decimals(0).field(ui, now[i] * scale)
                {
                    let mut hsv = now;
                    hsv[i] = changed.to / scale;
                    let to = srgb(hsv, color.a);
                    ui.data_mut(|data| data.insert_temp(kept, (to, hsv)));
                    out = Some(ValueChange { to, done: changed.done });
                }
            }
            ui.end_row();
            let bytes = [color.r, color.g, color.b];
            for (i, (letter, name)) in
                [("R", "Red"), ("G", "Green"), ("B", "Blue")].into_iter().enumerate()
            {
                ui.weak(letter);
                if let Some(changed) = NumberField::new(name, 0.0..=255.0, name)
                    .decimals(0)
                    .field(ui, f32::from(bytes[i]))
                {
                    let mut next = bytes;
                    next[i] = changed.to as u8;
                    let [r, g, b] = next;
                    out =
                        Some(ValueChange { to: Color { r, g, b, a: color.a }, done: changed.done });
                }
            }
            ui.end_row();
        },
    );
    ui.horizontal(|ui| {
        ui.weak("Hex");
        if let Some(to) = hex(ui, color) {
            out = Some(ValueChange { to, done: true });
        }
    });
    out
}

/// Saturation to the right, value upward.
fn square(
    ui: &mut Ui,
    label: &str,
    [h, s, v]: [f32; 3],
    side: f32,
) -> Option<ValueChange<[f32; 3]>> {
    let (rect, response) = ui.allocate_exact_size(vec2(side, side * 0.62), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ColorWell, true, label));
    let mut mesh = Mesh::default();
    const CELLS: u32 = 8;
    for j in 0..=CELLS {
        for i in 0..=CELLS {
            let (x, y) = (i as f32 / CELLS as f32, j as f32 / CELLS as f32);
            mesh.colored_vertex(rect.lerp_inside(vec2(x, y)), color32(srgb([h, x, 1.0 - y], 255)));
        }
    }
    grid(&mut mesh, CELLS, CELLS);
    ui.painter().add(Shape::mesh(mesh));
    let at = rect.lerp_inside(vec2(s, 1.0 - v));
    ui.painter().circle_stroke(at, 5.0, Stroke::new(2.5, Color32::from_black_alpha(150)));
    ui.painter().circle_stroke(at, 5.0, Stroke::new(1.4, Color32::WHITE));
    picked(&response, rect).map(|changed| changed.map(|[x, y]| [h, x, 1.0 - y]))
}

/// The hues from top to bottom.
fn hues(ui: &mut Ui, label: &str, [h, s, v]: [f32; 3], side: f32) -> Option<ValueChange<[f32; 3]>> {
    let (rect, response) = ui.allocate_exact_size(vec2(18.0, side * 0.62), Sense::click_and_drag());
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Slider, true, format!("Hue of {label}"))
    });
    let mut mesh = Mesh::default();
    const CELLS: u32 = 24;
    for j in 0..=CELLS {
        let y = j as f32 / CELLS as f32;
        for x in [0.0, 1.0] {
            mesh.colored_vertex(rect.lerp_inside(vec2(x, y)), color32(srgb([y, 1.0, 1.0], 255)));
        }
    }
    grid(&mut mesh, 1, CELLS);
    ui.painter().add(Shape::mesh(mesh));
    let y = rect.top() + h * rect.height();
    let mark =
        Rect::from_min_max(pos2(rect.left() - 1.0, y - 2.5), pos2(rect.right() + 1.0, y + 2.5));
    ui.painter().rect_stroke(
        mark,
        2.0,
        Stroke::new(2.5, Color32::from_black_alpha(150)),
        egui::StrokeKind::Outside,
    );
    ui.painter().rect_stroke(
        mark,
        2.0,
        Stroke::new(1.4, Color32::WHITE),
        egui::StrokeKind::Outside,
    );
    picked(&response, rect).map(|changed| changed.map(|[_, y]| [y.min(0.9999), s, v]))
}

/// Triangles of a grid of colors.
fn grid(mesh: &mut Mesh, cols: u32, rows: u32) {
    for j in 0..rows {
        for i in 0..cols {
            let at = |i: u32, j: u32| j * (cols + 1) + i;
            mesh.add_triangle(at(i, j), at(i + 1, j), at(i, j + 1));
            mesh.add_triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
}

/// Where a rectangle was pressed or dragged, each side in `[0, 1]`.
fn picked(response: &egui::Response, rect: Rect) -> Option<ValueChange<[f32; 2]>> {
    let is_held =
        response.is_pointer_button_down_on() || response.clicked() || response.drag_stopped();
    let pos = response.interact_pointer_pos().filter(|_| is_held)?;
    let along = ((pos - rect.min) / rect.size()).clamp(vec2(0.0, 0.0), vec2(1.0, 1.0));
    Some(ValueChange {
        to: [along.x, along.y],
        done: response.drag_stopped() || response.clicked(),
    })
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
