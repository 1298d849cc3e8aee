//! The command palette: every command, tool, panel and setting by a few letters of its name, or of
//! its name in other programs. Floor 7.

mod find;

use super::{DialogAnswer, set_width};
use crate::keymap::{KeyTarget, Keymap, key_text};
use crate::language::tr;
use crate::panel_layout::PanelKind;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::tr;
use crate::widgets::{list, set_accessible_name};
use eframe::egui::{Button, Key, TextEdit, Ui};
use find::PaletteEntry;

#[derive(Default)]
pub struct CommandPalette {
    typed: String,
    /// The index among what fits.
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
        set_width(ui, 420.0);
        let field = ui.add(
            TextEdit::singleline(&mut self.typed)
                .hint_text(tr("Command, tool or setting"))
                .desired_width(f32::INFINITY),
        );
        set_accessible_name(&field, tr("Command"));
        field.request_focus();
        if field.changed() {
            self.at = 0;
        }
        let found = find::find_entries(&self.typed, |entry| can_be_done(entry, session));
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
            ui.weak(tr!("Nothing found for “{typed}”", typed = self.typed.trim()));
        }
        list(ui, 360.0).auto_shrink([false, true]).show(ui, |ui| {
            for (i, entry) in found.iter().enumerate() {
                let response = row(ui, session, keymap, *entry, i == self.at);
                if (up || down) && i == self.at {
                    response.scroll_to_me(None);
                }
                if response.on_hover_text(tr(entry.hint())).clicked() {
                    chosen = Some(*entry);
                }
            }
        });
        let Some(entry) = chosen else { return DialogAnswer::Open };
        run(entry, session, requests);
        DialogAnswer::Close
    }
}

fn row(
    ui: &mut Ui,
    session: &Session,
    keymap: &Keymap,
    entry: PaletteEntry,
    is_next: bool,
) -> eframe::egui::Response {
    let keys = match entry {
        PaletteEntry::Command(command) => keymap.first(command),
        PaletteEntry::Tool(tool) => keymap.of(KeyTarget::Tool(tool)).first().copied(),
        PaletteEntry::Panel(_) | PaletteEntry::Setting(..) => None,
    };
    let keys = keys.map(|keys| key_text(ui.ctx(), keys)).unwrap_or_default();
    let beside = [tr(entry.kind()), &keys].join("  ");
    let button = Button::selectable(is_next, tr(entry.name())).shortcut_text(beside.trim());
    ui.add_enabled(can_be_done(entry, session), button.min_size([400.0, 0.0].into()))
}

/// Whether it can be done now.
fn can_be_done(entry: PaletteEntry, session: &Session) -> bool {
    match entry {
        PaletteEntry::Command(command) => (command.can)(session),
        PaletteEntry::Tool(_) | PaletteEntry::Panel(_) | PaletteEntry::Setting(..) => true,
    }
}

fn run(entry: PaletteEntry, session: &Session, requests: &mut UiRequests) {
    match entry {
        PaletteEntry::Command(command) if (command.can)(session) => {
            (command.run)(session, requests)
        }
        PaletteEntry::Command(command) => {
            requests.request(WindowRequest::Say(command.refusal(session)))
        }
        PaletteEntry::Tool(tool) => requests.act(Action::Hand(HandAction::Tool { tool })),
        PaletteEntry::Panel(panel) => requests.request(WindowRequest::ShowPanel(panel)),
        PaletteEntry::Setting(..) => {
            requests.request(WindowRequest::EditBrush);
            requests.request(WindowRequest::ShowPanel(PanelKind::Brushes));
        }
    }
}
