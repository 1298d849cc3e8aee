//! The tool bar, and the two current colors.
//! Floor 7.

use crate::icons::{Icon, add_sized_button};
use crate::keymap::{KeyTarget, Keymap, key_text};
use crate::language::tr;
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::tools::ToolKind;
use crate::widgets::swatch_at;
use eframe::egui::scroll_area::ScrollBarVisibility;
use eframe::egui::{
    Align, Frame, Layout, Panel, Rect, ScrollArea, Shape, Stroke, Ui, UiBuilder, Vec2, pos2, vec2,
};

/// The tools in groups, which lines divide: painting, selecting, layers, the shape, the view.
const GROUPS: [&[ToolKind]; 5] = {
    use ToolKind::*;
    [
        &[Brush, Eraser, Fill, Gradient, Eyedropper],
        &[SelectRectangle, SelectEllipse, Lasso, Wand, SurfaceWand],
        &[Move, Transform, Liquify, Strokes, Image, Text, Figure, Path, Panels, Anchors, Crop],
        &[Shape, Touch, Sculpt],
        &[Assistants, Hand, Zoom],
    ]
};
/// Sides of a tool's button, points.
const LARGEST_PT: f32 = 32.0;
const SMALLEST_PT: f32 = 18.0;
/// Of those in two columns.
const PAIRED_PT: f32 = 24.0;
/// Between two buttons, and between two groups.
const GAP_PT: f32 = 1.0;
const GROUP_GAP_PT: f32 = 6.0;
/// The height of the strip that shows that there are more tools, points.
const ARROW_STRIP_PT: f32 = 12.0;
/// The height of the colors beneath the tools, points.
const COLORS_PT: f32 = 54.0;

pub fn show(ui: &mut Ui, session: &Session, keymap: &Keymap, requests: &mut UiRequests) {
    let beneath = Panel::bottom("current colors")
        .resizable(false)
        .show_separator_line(false)
        .frame(Frame::NONE)
        .exact_size(COLORS_PT);
    beneath.show(ui, |ui| colors(ui, session, requests));
    // In a very low window tools scroll; the colors stay visible.
    let area = ScrollArea::vertical().scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden);
    let columns = if ui.available_width() > LARGEST_PT + 1.0 { 2 } else { 1 };
    let side = side_pt(ui.available_height(), columns).max(SMALLEST_PT);
    let row_pt = columns as f32 * side + (columns - 1) as f32 * GAP_PT;
    let beside_pt = (0.5 * (ui.available_width() - row_pt)).max(0.0);
    let shown = area.show(ui, |ui| {
        ui.spacing_mut().item_spacing = Vec2::splat(GAP_PT);
        for (i, group) in GROUPS.into_iter().enumerate() {
            if i > 0 {
                divide(ui);
            }
            for row in group.chunks(columns) {
                ui.horizontal(|ui| {
                    ui.add_space((beside_pt - GAP_PT).max(0.0));
                    row.iter()
                        .for_each(|tool| button(ui, session, keymap, (*tool, side), requests));
                });
            }
        }
    });
    let above = shown.state.clamped_offset().y;
    let below = shown.content_size.y - above - shown.inner_rect.height();
    mark_left_out(ui, shown.inner_rect, [above, below]);
}

/// Arrows at the ends beyond which there are more tools.
///
/// * `left_out`: how much is out of sight above and below, points.
fn mark_left_out(ui: &Ui, area: Rect, [above, below]: [f32; 2]) {
    let (middle, arrow) = (area.center().x, vec2(6.0, 4.0));
    let ends = [(above, area.top(), -1.0), (below, area.bottom(), 1.0)];
    for (_, end, way) in ends.into_iter().filter(|(left_out, ..)| *left_out > 1.0) {
        let strip = Rect::from_two_pos(
            pos2(area.left(), end),
            pos2(area.right(), end - way * ARROW_STRIP_PT),
        );
        ui.painter().rect_filled(strip, 0.0, ui.visuals().panel_fill);
        let base = end - way * (0.5 * (ARROW_STRIP_PT + arrow.y));
        let corners = vec![
            pos2(middle - arrow.x, base),
            pos2(middle + arrow.x, base),
            pos2(middle, base + way * arrow.y),
        ];
        let color = ui.visuals().strong_text_color();
        ui.painter().add(Shape::convex_polygon(corners, color, Stroke::NONE));
    }
}

/// A line between two groups.
fn divide(ui: &mut Ui) {
    let size = vec2(ui.available_width(), GROUP_GAP_PT - 2.0 * GAP_PT);
    let (_, rect) = ui.allocate_space(size);
    let line = ui.visuals().widgets.noninteractive.bg_stroke;
    ui.painter().hline(rect.shrink2(vec2(5.0, 0.0)).x_range(), rect.center().y, line);
}

/// The width of the bar inside its margins: in a low window tools are in two columns.
pub fn width_pt(ui: &Ui) -> f32 {
    let one = side_pt(ui.available_height() - COLORS_PT - 8.0, 1);
    if one < SMALLEST_PT { 2.0 * PAIRED_PT + GAP_PT } else { LARGEST_PT }
}

/// Sides of buttons that fill a height, points.
fn side_pt(height_pt: f32, columns: usize) -> f32 {
    let rows: usize = GROUPS.into_iter().map(|group| group.len().div_ceil(columns)).sum();
    let gaps_pt = rows as f32 * GAP_PT + (GROUPS.len() - 1) as f32 * GROUP_GAP_PT;
    let largest = if columns == 1 { LARGEST_PT } else { PAIRED_PT };
    ((height_pt - gaps_pt) / rows as f32).min(largest)
}

fn button(
    ui: &mut Ui,
    session: &Session,
    keymap: &Keymap,
    (tool, side): (ToolKind, f32),
    requests: &mut UiRequests,
) {
    let response = add_sized_button(ui, Icon::Tool(tool), tool.label(), session.tool == tool, side);
    let keys = keymap
        .of(KeyTarget::Tool(tool))
        .first()
        .map_or_else(String::new, |&keys| format!(" ({})", key_text(ui.ctx(), keys)));
    if response.on_hover_text(format!("{}{keys}\n{}", tr(tool.label()), tr(tool.hint()))).clicked()
    {
        requests.act(Action::Hand(HandAction::Tool { tool }));
    }
}

/// The first color over the second one, with the buttons of both at the free corners.
fn colors(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    const SWATCH_PT: f32 = 23.0;
    const BUTTON_PT: f32 = 15.0;
    const SIDE_PT: f32 = 38.0;
    let area = ui.available_rect_before_wrap();
    let low = pos2(area.center().x - 0.5 * SIDE_PT, area.bottom() - SIDE_PT - 4.0);
    let whole = Rect::from_min_size(low, Vec2::splat(SIDE_PT));
    let square = |at, side| Rect::from_min_size(at, Vec2::splat(side));
    let second = square(whole.max - Vec2::splat(SWATCH_PT), SWATCH_PT);
    let swap = HandAction::SwapColors {};
    if swatch_at(ui, "Second color", session.tools.second_color, second).clicked() {
        requests.act(Action::Hand(swap.clone()));
    }
    swatch_at(ui, "First color", session.tools.color, square(whole.min, SWATCH_PT));
    let corners = [
        (
            Icon::Swap,
            "Swap colors",
            "Swap colors (X)",
            swap,
            whole.right_top() - vec2(BUTTON_PT, 0.0),
        ),
        (
            Icon::Reset,
            "Default colors",
            "Black and white (D)",
            HandAction::DefaultColors {},
            whole.left_bottom() - vec2(0.0, BUTTON_PT),
        ),
    ];
    for (icon, label, hint, action, at) in corners {
        let layout = Layout::left_to_right(Align::Min);
        let mut corner =
            ui.new_child(UiBuilder::new().max_rect(square(at, BUTTON_PT)).layout(layout));
        if add_sized_button(&mut corner, icon, label, false, BUTTON_PT)
            .on_hover_text(tr(hint))
            .clicked()
        {
            requests.act(Action::Hand(action));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tool_stands_in_one_group() {
        for (tool, name) in ToolKind::ALL {
            let places = GROUPS.into_iter().flatten().filter(|other| **other == tool).count();
            assert_eq!(places, 1, "{name}");
        }
    }

    #[test]
    fn a_window_of_700_points_has_its_tools_in_one_column() {
        // What is left of it below the menus, the options and the tabs.
        let side = side_pt(700.0 - 26.0 - 33.0 - 26.0 - COLORS_PT - 14.0, 1);
        assert!(side >= SMALLEST_PT, "{side}");
    }
}
