//! Buttons that show an icon and have a name.
//! Floor 7.

use super::Icon;
use crate::language::tr;
use eframe::egui::{self, Rect, Response, Sense, StrokeKind, Ui, Vec2};

/// The side of an icon's button, screen points.
pub const BUTTON_PT: f32 = 24.0;

/// A button with an icon and, for screen readers, tests and the tooltip, a name.
pub fn icon_button(ui: &mut Ui, icon: Icon, label: &str, on: bool) -> Response {
    add_sized_button(ui, icon, label, on, BUTTON_PT)
}

/// A button that is on most of the time, so that only its icon says so.
pub fn quiet_button(ui: &mut Ui, icon: Icon, label: &str, on: bool, side_pt: f32) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(side_pt), Sense::click());
    let enabled = ui.is_enabled();
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, enabled, on, tr(label)));
    if ui.is_rect_visible(rect) {
        let look = ui.style().interact(&response);
        if response.hovered() || response.has_focus() {
            ui.painter().rect_filled(rect.shrink(0.5), look.corner_radius, look.weak_bg_fill);
        }
        let color = if on { look.text_color() } else { ui.visuals().weak_text_color() };
        let side = icon.grid().min(0.74 * side_pt);
        icon.draw(ui.painter(), Rect::from_center_size(rect.center(), Vec2::splat(side)), color);
    }
    response
}

pub fn add_sized_button(ui: &mut Ui, icon: Icon, label: &str, on: bool, side_pt: f32) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(side_pt), Sense::click());
    let enabled = ui.is_enabled();
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, enabled, on, tr(label)));
    if ui.is_rect_visible(rect) {
        let look = ui.style().interact_selectable(&response, on);
        if on || response.hovered() || response.has_focus() {
            ui.painter().rect(
                rect.shrink(0.5),
                look.corner_radius,
                look.weak_bg_fill,
                look.bg_stroke,
                StrokeKind::Inside,
            );
        }
        let inner =
            Rect::from_center_size(rect.center(), Vec2::splat(icon.grid()).min(rect.size() * 0.74));
        icon.draw(ui.painter(), inner, look.text_color());
    }
    response
}
