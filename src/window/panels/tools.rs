//! The tool bar, and the two current colours.
//! Floor 7.

use crate::icons::{Icon, icon_button, sized_button};
use crate::keymap::{KeyTarget, Keymap, shown};
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::tools::ToolKind;
use crate::widgets::swatch;
use eframe::egui::{Ui, vec2};

/// Sides of a tool's button, points.
const LARGEST_PT: f32 = 32.0;
const SMALLEST_PT: f32 = 20.0;
/// What the colours beneath the tools take, points.
const COLOURS_PT: f32 = 124.0;

pub fn show(ui: &mut Ui, session: &Session, keymap: &Keymap, requests: &mut UiRequests) {
    ui.vertical_centered(|ui| {
        ui.add_space(2.0);
        // In a low window they are smaller, so that all of them and the colours stay in sight.
        let each = (ui.clip_rect().height() - COLOURS_PT) / ToolKind::ALL.len() as f32 - ui.spacing().item_spacing.y;
        let side = each.max(SMALLEST_PT).min(LARGEST_PT);
        for (tool, _) in ToolKind::ALL {
            let response = sized_button(ui, Icon::Tool(tool), tool.label(), session.tool == tool, side);
            let keys = keymap
                .of(KeyTarget::Tool(tool))
                .first()
                .map_or_else(String::new, |&keys| format!(" ({})", shown(ui.ctx(), keys)));
            if response.on_hover_text(format!("{}{keys}\n{}", tool.label(), tool.hint())).clicked() {
                requests.act(Action::Hand(HandAction::Tool { tool }));
            }
        }
        ui.add_space(8.0);
        swatch(ui, "First colour", session.color, vec2(32.0, 26.0));
        if swatch(ui, "Second colour", session.second_color, vec2(32.0, 16.0)).clicked() {
            requests.act(Action::Hand(HandAction::SwapColors {}));
        }
        if icon_button(ui, Icon::Swap, "Swap colours", false).on_hover_text("Swap colours (X)").clicked() {
            requests.act(Action::Hand(HandAction::SwapColors {}));
        }
        if icon_button(ui, Icon::Reset, "Default colours", false).on_hover_text("Black and white (D)").clicked() {
            requests.act(Action::Hand(HandAction::DefaultColors {}));
        }
    });
}
