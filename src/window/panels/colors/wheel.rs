//! Where a color is chosen by eye: a square of saturation and value, with a bar of hues beside it or
//! a wheel of hues around it. Floor 7.

use super::srgb;
use crate::harmony::Harmony;
use crate::language::tr;
use crate::theme::color32;
use crate::tr;
use crate::widgets::ValueChange;
use eframe::egui::{
    self, Color32, Mesh, Painter, Pos2, Rect, Response, Role, Sense, Shape, Stroke, StrokeKind, Ui,
    Vec2, WidgetInfo, pos2, vec2,
};

/// The width of the bar of hues, and the gap before it, points.
const BAR_PT: f32 = 18.0;
const GAP_PT: f32 = 6.0;
/// The inner radius of the ring of hues, as a share of the outer one.
const RING: f32 = 0.82;
/// Half the side of the square within the ring, as a share of the ring's inner radius.
const WITHIN: f32 = 0.68;

/// Hue, saturation and value, each in `[0, 1]`.
type Hsv = [f32; 3];

/// Saturation to the right, value upward; the hues from top to bottom beside it.
pub fn square_and_bar(ui: &mut Ui, label: &str, now: Hsv, size: Vec2) -> Option<ValueChange<Hsv>> {
    let [h, s, v] = now;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP_PT;
        let side = vec2((size.x - BAR_PT - GAP_PT).max(40.0), size.y);
        let (rect, response) = ui.allocate_exact_size(side, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::ColorWell, true, tr(label)));
        draw_square(ui.painter(), rect, now);
        let chosen = pick(&response, rect).map(|c| c.map(|[x, y]| [h, x, 1.0 - y]));
        let (bar, response) = ui.allocate_exact_size(vec2(BAR_PT, size.y), Sense::click_and_drag());
        response.widget_info(|| {
            let name = tr!("Hue of {name}", name = tr(label));
            WidgetInfo::labeled(Role::Slider, true, name)
        });
        draw_bar(ui.painter(), bar, h);
        chosen.or(pick(&response, bar).map(|c| c.map(|[_, y]| [y.min(0.9999), s, v])))
    })
    .inner
}

/// The hues around a square of saturation and value; those that go with the current one are marked.
pub fn wheel(
    ui: &mut Ui,
    label: &str,
    now: Hsv,
    size: Vec2,
    harmony: Harmony,
) -> Option<ValueChange<Hsv>> {
    let [h, s, v] = now;
    let radius = 0.5 * size.x.min(size.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::ColorWell, true, tr(label)));
    let (center, painter) = (rect.center(), ui.painter());
    draw_ring(painter, center, radius);
    let middle = 0.5 * (1.0 + RING) * radius;
    let thick = 0.5 * (1.0 - RING) * radius;
    ring_mark(painter, center + at_hue(h) * middle, thick);
    for turn in harmony.turns() {
        ring_mark(painter, center + at_hue(h + turn) * middle, 0.55 * thick);
    }
    let square = Rect::from_center_size(center, Vec2::splat(2.0 * WITHIN * RING * radius));
    draw_square(painter, square, now);
    let at = response.interact_pointer_pos()?;
    // What was pressed first is held until it is let go.
    let kept = response.id.with("on the ring");
    let is_begun = ui.input(|input| input.pointer.primary_pressed());
    let on_ring = match is_begun {
        true => (at - center).length() > RING * radius,
        false => ui.data(|data| data.get_temp::<bool>(kept)).unwrap_or_default(),
    };
    ui.data_mut(|data| data.insert_temp(kept, on_ring));
    if on_ring {
        let by = at - center;
        let turned = by.x.atan2(-by.y) / std::f32::consts::TAU;
        let held = pick(&response, rect)?;
        let hue = turned.rem_euclid(1.0);
        let hue = if is_begun { nearest_mark(hue, h, harmony) } else { hue };
        return Some(held.map(|_| [hue.min(0.9999), s, v]));
    }
    pick(&response, square).map(|c| c.map(|[x, y]| [h, x, 1.0 - y]))
}

/// The hue of a mark that was pressed, else the hue itself.
fn nearest_mark(hue: f32, current: f32, harmony: Harmony) -> f32 {
    /// Turns from a mark that still hit it.
    const NEAR: f32 = 0.015;
    let mut marks = harmony.turns().iter().map(|turn| (current + turn).rem_euclid(1.0));
    let off = |mark: f32| (mark - hue + 0.5).rem_euclid(1.0) - 0.5;
    marks.find(|mark| off(*mark).abs() < NEAR).unwrap_or(hue)
}

/// The direction of a hue: red at the top, clockwise.
fn at_hue(h: f32) -> Vec2 {
    let turned = h * std::f32::consts::TAU;
    vec2(turned.sin(), -turned.cos())
}

fn draw_square(painter: &Painter, rect: Rect, [h, s, v]: Hsv) {
    const CELLS: u32 = 8;
    let mut mesh = Mesh::default();
    for j in 0..=CELLS {
        for i in 0..=CELLS {
            let (x, y) = (i as f32 / CELLS as f32, j as f32 / CELLS as f32);
            mesh.colored_vertex(rect.lerp_inside(vec2(x, y)), color32(srgb([h, x, 1.0 - y], 255)));
        }
    }
    grid(&mut mesh, CELLS, CELLS);
    painter.add(Shape::mesh(mesh));
    ring_mark(painter, rect.lerp_inside(vec2(s, 1.0 - v)), 5.0);
}

/// A ring that is seen on any color.
fn ring_mark(painter: &Painter, at: Pos2, radius: f32) {
    painter.circle_stroke(at, radius, Stroke::new(2.5, Color32::from_black_alpha(150)));
    painter.circle_stroke(at, radius, Stroke::new(1.4, Color32::WHITE));
}

fn draw_bar(painter: &Painter, rect: Rect, h: f32) {
    const CELLS: u32 = 24;
    let mut mesh = Mesh::default();
    for j in 0..=CELLS {
        let y = j as f32 / CELLS as f32;
        for x in [0.0, 1.0] {
            mesh.colored_vertex(rect.lerp_inside(vec2(x, y)), color32(srgb([y, 1.0, 1.0], 255)));
        }
    }
    grid(&mut mesh, 1, CELLS);
    painter.add(Shape::mesh(mesh));
    let y = rect.top() + h * rect.height();
    let mark =
        Rect::from_min_max(pos2(rect.left() - 1.0, y - 2.5), pos2(rect.right() + 1.0, y + 2.5));
    let outside = StrokeKind::Outside;
    painter.rect_stroke(mark, 2.0, Stroke::new(2.5, Color32::from_black_alpha(150)), outside);
    painter.rect_stroke(mark, 2.0, Stroke::new(1.4, Color32::WHITE), outside);
}

fn draw_ring(painter: &Painter, center: Pos2, radius: f32) {
    const CELLS: u32 = 96;
    let mut mesh = Mesh::default();
    for j in 0..=CELLS {
        let h = j as f32 / CELLS as f32;
        for share in [RING, 1.0] {
            let color = color32(srgb([h, 1.0, 1.0], 255));
            mesh.colored_vertex(center + at_hue(h) * radius * share, color);
        }
    }
    grid(&mut mesh, 1, CELLS);
    painter.add(Shape::mesh(mesh));
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
fn pick(response: &Response, rect: Rect) -> Option<ValueChange<[f32; 2]>> {
    let is_held =
        response.is_pointer_button_down_on() || response.clicked() || response.drag_stopped();
    let pos = response.interact_pointer_pos().filter(|_| is_held)?;
    let along = ((pos - rect.min) / rect.size()).clamp(egui::Vec2::ZERO, vec2(1.0, 1.0));
    Some(ValueChange {
        to: [along.x, along.y],
        done: response.drag_stopped() || response.clicked(),
    })
}
