//! The keyboard: commands and tools by their keys. Floor 7. Not here: which keys they have
//! (`keymap`).

use super::commands::MenuCommand;
use super::keymap::{KeyTarget, Keymap};
use super::requests::{UiRequests, WindowRequest};
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use eframe::egui::{Context, Event, Key, KeyboardShortcut, Modifiers};

/// Requests what the keys of this frame mean; nothing while text is being typed.
pub fn listen(ctx: &Context, session: &Session, keymap: &Keymap, requests: &mut UiRequests) {
    if ctx.egui_wants_keyboard_input() || session.is_drawing() {
        return;
    }
    let is_pressed = |event: &Event| matches!(event, Event::Key { pressed: true, .. });
    if ctx.input(|i| i.events.iter().any(is_pressed)) {
        // Those with more modifiers first: Ctrl+Shift+Z is not Ctrl+Z.
        let mut all: Vec<(KeyboardShortcut, KeyTarget)> = KeyTarget::all()
            .flat_map(|keyed| keymap.of(keyed).into_iter().map(move |keys| (keys, keyed)))
            .collect();
        all.sort_by_key(|(keys, _)| {
            let Modifiers { alt, shift, command, .. } = keys.modifiers;
            std::cmp::Reverse(u8::from(alt) + u8::from(shift) + u8::from(command))
        });
        for &(keys, keyed) in &all {
            // A key without effect is left to others: Enter also closes a lasso.
            let can = |command: &MenuCommand| (command.can)(session);
            if matches!(keyed, KeyTarget::Command(command) if !can(command))
                || !ctx.input_mut(|i| i.consume_shortcut(&keys))
            {
                continue;
            }
            match keyed {
                KeyTarget::Command(command) => (command.run)(session, requests),
                KeyTarget::Tool(tool) => requests.act(Action::Hand(HandAction::Tool { tool })),
            }
        }
        // A key that nothing took says why nothing happens; Enter and Escape apply to whatever is
        // under way.
        let silent = |keys: &KeyboardShortcut| matches!(keys.logical_key, Key::Enter | Key::Escape);
        for (keys, keyed) in all.iter().filter(|(keys, _)| !silent(keys)) {
            if let KeyTarget::Command(command) = keyed
                && !(command.can)(session)
                && ctx.input_mut(|i| i.consume_shortcut(keys))
            {
                requests.request(WindowRequest::Say(command.refusal(session)));
            }
        }
    }
}
