//! The tool bar, and the two current colors.
//! Floor 7.

use crate::icons::{Icon, icon_button, sized_button};
use crate::keymap::{KeyTarget, Keymap, key_text};
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::tools::ToolKind;
use crate::widgets::swatch;
use eframe::egui::scroll_area::ScrollBarVisibility;
use eframe::egui::{Frame, Panel, ScrollArea, Ui, vec2};

/// Sides of a tool's button, points.
const LARGEST_PT: f32 = 32.0;
const SMALLEST_PT: f32 = 20.0;
/// Of those in two columns, and the gap between them.
const PAIRED_PT: f32 = 24.0;
const GAP_PT: f32 = 2.0;
/// The height of the colors beneath the tools, points.
const COLORS_PT: f32 = 124.0;

pub fn show(ui: &mut Ui, session: &Session, keymap: &Keymap, requests: &mut UiRequests) {
    let beneath = Panel::bottom("current colors")
        .resizable(false)
        .show_separator_line(false)
        .frame(Frame::NONE);
    beneath.show(ui, |ui| ui.vertical_centered(|ui| colors(ui, session, requests)));
    // In a very low window tools scroll; the colors stay visible.
    let area = ScrollArea::vertical().scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden);
    let columns = if ui.available_width() > LARGEST_PT + 1.0 { 2 } else { 1 };
    let side = side_pt(ui, ui.available_height(), columns).max(SMALLEST_PT);
    let beside_pt =
        0.5 * (ui.available_width() - columns as f32 * side - (columns - 1) as f32 * GAP_PT);
    area.show(ui, |ui| {
        for row in ToolKind::ALL.chunks(columns) {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = GAP_PT;
                ui.add_space((beside_pt - GAP_PT).max(0.0));
                row.iter()
                    .for_each(|(tool, _)| button(ui, session, keymap, (*tool, side), requests));
            });
        }
    });
}

/// The width of the bar inside its margins: in a low window tools are in two columns.
pub fn width_pt(ui: &Ui) -> f32 {
    let one = side_pt(ui, ui.available_height() - COLORS_PT, 1);
    if one < SMALLEST_PT { 2.0 * PAIRED_PT + GAP_PT } else { LARGEST_PT }
}

/// Sides of buttons that fill a height, points.
fn side_pt(ui: &Ui, height_pt: f32, columns: usize) -> f32 {
    let rows = ToolKind::ALL.len().div_ceil(columns) as f32;
    let largest = if columns == 1 { LARGEST_PT } else { PAIRED_PT };
    (height_pt / rows - ui.spacing().item_spacing.y).min(largest)
}

fn button(
    ui: &mut Ui,
    session: &Session,
    keymap: &Keymap,
    (tool, side): (ToolKind, f32),
    requests: &mut UiRequests,
) {
    let response = sized_button(ui, Icon::Tool(tool), tool.label(), session.tool == tool, side);
    let keys = keymap
        .of(KeyTarget::Tool(tool))
        .first()
        .map_or_else(String::new, |&keys| format!(" ({})", key_text(ui.ctx(), keys)));
    if response.on_hover_text(format!("{}{keys}\n{}", tool.label(), tool.hint())).clicked() {
        requests.act(Action::Hand(HandAction::Tool { tool }));
    }
}

fn colors(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    ui.add_space(4.0);
    swatch(ui, "First color", session.tools.color, vec2(32.0, 26.0));
    if swatch(ui, "Second color", session.tools.second_color, vec2(32.0, 16.0)).clicked() {
        requests.act(Action::Hand(HandAction::SwapColors {}));
    }
    if icon_button(ui, Icon::Swap, "Swap colors", false).on_hover_text("Swap colors (X)").clicked()
    {
        requests.act(Action::Hand(HandAction::SwapColors {}));
    }
    if icon_button(ui, Icon::Reset, "Default colors", false)
        .on_hover_text("Black and white (D)")
        .clicked()
    {
        requests.act(Action::Hand(HandAction::DefaultColors {}));
    }
}
