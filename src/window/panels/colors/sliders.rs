//! Lightness, chroma and hue (OKLCH) as three bars. Each shows the colors that it leads to; where
//! the document's colors end, the bar is dim, and a line is drawn. Floor 7.

use crate::language::tr;
use crate::math::oklch::{self, MOST_CHROMA};
use crate::math::srgb::{Color, quantize};
use crate::theme::color32;
use crate::tr;
use crate::widgets::{NumberField, ValueChange};
use eframe::egui::{
    Id, Mesh, Rect, Role, Sense, Shape, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, pos2, vec2,
};

/// The height of a bar, points.
const BAR_PT: f32 = 16.0;
/// The width of the number beside it.
const NUMBER_PT: f32 = 46.0;

/// Lightness, chroma, and hue in turns.
type Lch = [f32; 3];

/// A row: its letter, its name, the greatest value, and what that is in the number beside it.
struct SliderRow {
    letter: &'static str,
    name: &'static str,
    most: f32,
    shown: f32,
}

const ROWS: [SliderRow; 3] = [
    SliderRow { letter: "L", name: "Lightness", most: 1.0, shown: 100.0 },
    SliderRow { letter: "C", name: "Chroma", most: MOST_CHROMA, shown: 100.0 * MOST_CHROMA },
    SliderRow { letter: "H", name: "OKLCH hue", most: 1.0, shown: 360.0 },
];

/// The bars; `label` keeps what was set while the color is what it led to.
pub fn sliders(ui: &mut Ui, label: &str, color: Color) -> Option<ValueChange<Color>> {
    let now = known_lch(ui, label, color);
    let mut out = None;
    for (i, row) in ROWS.iter().enumerate() {
        let changed = ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 5.0;
            ui.add_sized(vec2(11.0, BAR_PT), eframe::egui::Label::new(row.letter));
            let bar = bar(ui, row, i, now);
            let field = NumberField::new(row.name, 0.0..=row.shown, row.name).decimals(0);
            let scale = row.shown / row.most;
            let typed = ui
                .scope(|ui| {
                    ui.set_width(NUMBER_PT);
                    field.field(ui, now[i] * scale)
                })
                .inner;
            typed.map(|typed| typed.map(|v| v / scale)).or(bar)
        });
        if let Some(changed) = changed.inner {
            let mut lch = now;
            lch[i] = changed.to;
            out = Some(changed.map(|_| put(ui, label, lch, color.a)));
        }
    }
    out
}

fn lch_id(label: &str) -> Id {
    Id::unique(("lightness, chroma, hue", label.to_owned()))
}

/// What was set last, if it led to this color; so a gray keeps its hue, and a color that sRGB lacks
/// its chroma.
fn known_lch(ui: &Ui, label: &str, color: Color) -> Lch {
    let kept = ui.data(|data| data.get_temp::<(Color, Lch)>(lch_id(label)));
    let [r, g, b, _] = color.to_f32();
    kept.filter(|(seen, _)| *seen == color)
        .map_or_else(|| oklch::from_srgb([r, g, b]), |(_, lch)| lch)
}

/// The color of what was set, which is remembered.
fn put(ui: &Ui, label: &str, lch: Lch, a: u8) -> Color {
    let color = Color { a, ..color_of(lch) };
    ui.data_mut(|data| data.insert_temp(lch_id(label), (color, lch)));
    color
}

/// The nearest color of less chroma that sRGB has.
fn color_of(lch: Lch) -> Color {
    let [r, g, b] = oklch::to_srgb(oklch::clip_chroma(lch)).map(quantize);
    Color::rgb(r, g, b)
}

/// One bar.
fn bar(ui: &mut Ui, row: &SliderRow, i: usize, now: Lch) -> Option<ValueChange<f32>> {
    let width = (ui.available_width() - NUMBER_PT - 8.0).max(40.0);
    let (rect, response) = ui.allocate_exact_size(vec2(width, BAR_PT), Sense::click_and_drag());
    let name = tr!("{name} of the color", name = tr(row.name));
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, name.clone()));
    if ui.is_rect_visible(rect) {
        draw(ui, rect, |share| {
            let mut lch = now;
            lch[i] = share * row.most;
            lch
        });
        let x = rect.left() + (now[i] / row.most).min(1.0) * rect.width();
        let mark = Rect::from_center_size(pos2(x, rect.center().y), vec2(5.0, BAR_PT + 2.0));
        let rim = Stroke::new(2.5, eframe::egui::Color32::from_black_alpha(150));
        ui.painter().rect_stroke(mark, 2.0, rim, StrokeKind::Outside);
        let light = Stroke::new(1.4, eframe::egui::Color32::WHITE);
        ui.painter().rect_stroke(mark, 2.0, light, StrokeKind::Outside);
    }
    let is_held =
        response.is_pointer_button_down_on() || response.clicked() || response.drag_stopped();
    let at = response.interact_pointer_pos().filter(|_| is_held)?;
    let share = ((at - rect.min) / rect.size()).clamp(Vec2::ZERO, vec2(1.0, 1.0)).x;
    let done = response.drag_stopped() || response.clicked();
    // A whole turn is none.
    let most = if row.name == ROWS[2].name { 0.9999 } else { row.most };
    Some(ValueChange { to: (share * row.most).min(most), done })
}

/// The colors along a bar.
fn draw(ui: &Ui, rect: Rect, at: impl Fn(f32) -> Lch) {
    const CELLS: u32 = 96;
    /// What is left of colors that sRGB lacks.
    const DIM: f32 = 0.22;
    let mut mesh = Mesh::default();
    let mut edges = Vec::new();
    let mut was_in = None;
    for cell in 0..CELLS {
        let lch = at((cell as f32 + 0.5) / CELLS as f32);
        let is_in = oklch::is_in_srgb(lch);
        let x = |step: u32| rect.left() + rect.width() * step as f32 / CELLS as f32;
        if was_in.is_some_and(|was| was != is_in) {
            edges.push(x(cell));
        }
        was_in = Some(is_in);
        let color = color32(color_of(lch));
        let color = if is_in { color } else { color.gamma_multiply(DIM) };
        let part = Rect::from_min_max(pos2(x(cell), rect.top()), pos2(x(cell + 1), rect.bottom()));
        mesh.add_colored_rect(part, color);
    }
    ui.painter().add(Shape::mesh(mesh));
    let line = Stroke::new(1.0, ui.visuals().strong_text_color());
    for x in edges {
        ui.painter().vline(x, rect.y_range(), line);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_color_beyond_srgb_becomes_the_nearest_of_its_lightness_and_hue() {
        let color = color_of([0.6, MOST_CHROMA, 0.4]);
        let [r, g, b, _] = color.to_f32();
        let [lightness, chroma, hue] = oklch::from_srgb([r, g, b]);
        assert!((lightness - 0.6).abs() < 0.01 && (hue - 0.4).abs() < 0.01, "{color}");
        assert!(chroma < MOST_CHROMA - 0.05);
    }
}
