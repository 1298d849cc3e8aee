//! The command palette: every command by a few letters of its name.
//! Floor 7.

use super::DialogAnswer;
use crate::commands::{self, MenuCommand};
use crate::keymap::{Keymap, shown};
use crate::requests::{UiRequests, WindowRequest};
use crate::session::Session;
use crate::widgets::{list, named};
use eframe::egui::{Button, Key, TextEdit, Ui};

#[derive(Default)]
pub struct CommandPalette {
    typed: String,
    /// The index among the matching commands.
    at: usize,
}

impl CommandPalette {
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        keymap: &Keymap,
        requests: &mut UiRequests,
    ) -> DialogAnswer {
        ui.set_width(420.0);
        let field = ui.add(
            TextEdit::singleline(&mut self.typed)
                .hint_text("Type a command")
                .desired_width(f32::INFINITY),
        );
        named(&field, "Command");
        field.request_focus();
        if field.changed() {
            self.at = 0;
        }
        let mut found: Vec<&'static MenuCommand> =
            commands::all().filter(|command| matches(command.name, &self.typed)).collect();
        // Commands that begin with it come first; otherwise in the order of the menus.
        let typed = self.typed.trim().to_lowercase();
        found.sort_by_key(|command| !command.name.to_lowercase().starts_with(&typed));
        let (up, down, enter) = ui.input(|i| {
            (i.key_pressed(Key::ArrowUp), i.key_pressed(Key::ArrowDown), i.key_pressed(Key::Enter))
        });
        if down {
            self.at += 1;
        }
        if up {
            self.at = self.at.saturating_sub(1);
        }
        self.at = self.at.min(found.len().saturating_sub(1));
        let mut chosen = enter.then(|| found.get(self.at)).flatten().copied();
        if found.is_empty() {
            ui.weak(format!("No command is called “{}”", self.typed.trim()));
        }
        list(ui, 360.0).auto_shrink([false, true]).show(ui, |ui| {
            for (i, command) in found.iter().enumerate() {
                let mut button = Button::selectable(i == self.at, command.name);
                if let Some(keys) = keymap.first(command) {
                    button = button.shortcut_text(shown(ui.ctx(), keys));
                }
                let response =
                    ui.add_enabled((command.can)(session), button.min_size([400.0, 0.0].into()));
                if (up || down) && i == self.at {
                    response.scroll_to_me(None);
                }
                if response.on_hover_text(command.hint).clicked() {
                    chosen = Some(command);
                }
            }
        });
        match chosen {
            Some(command) if (command.can)(session) => {
                (command.run)(session, requests);
                DialogAnswer::Close
            }
            Some(command) => {
                requests.request(WindowRequest::Say(command.refusal(session)));
                DialogAnswer::Close
            }
            None => DialogAnswer::Open,
        }
    }
}

/// Whether every typed word is in the name.
fn matches(name: &str, typed: &str) -> bool {
    let name = name.to_lowercase();
    typed.to_lowercase().split_whitespace().all(|word| name.contains(word))
}
