//! The tool bar, and the two current colours.
//! Floor 7.

use crate::icons::{Icon, icon_button, sized_button};
use crate::keymap::{KeyTarget, Keymap, shown};
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::tools::{ToolKind, ToolRow};
use crate::widgets::swatch;
use eframe::egui::{Ui, vec2};

pub fn show(ui: &mut Ui, session: &Session, keymap: &Keymap, requests: &mut UiRequests) {
    ui.vertical_centered(|ui| {
        ui.add_space(2.0);
        const TOOLS: &[ToolRow] = &ToolKind::ALL;
        for row in TOOLS {
            let response = sized_button(ui, Icon::Tool(row.kind), row.label, session.tool == row.kind, 32.0);
            let keys = keymap
                .of(KeyTarget::Tool(row))
                .first()
                .map_or_else(String::new, |&keys| format!(" ({})", shown(ui.ctx(), keys)));
            if response.on_hover_text(format!("{}{keys}\n{}", row.label, row.hint)).clicked() {
                requests.act(Action::Hand(HandAction::Tool { tool: row.kind }));
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
