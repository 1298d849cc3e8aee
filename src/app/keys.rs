//! The keyboard: commands by their keys, tools by their letters.
//! Floor 7.

use super::asked::Asked;
use super::commands;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::tools::ToolKind;
use eframe::egui::{Context, Event, Key, Modifiers};

/// Pushes what the keys of this frame ask for. Nothing while a text is being typed.
pub fn listen(ctx: &Context, session: &Session, asked: &mut Asked) {
    if ctx.egui_wants_keyboard_input() || session.is_drawing() {
        return;
    }
    // Those with more modifiers first: Ctrl+Shift+Z is not Ctrl+Z.
    let mut keyed: Vec<_> = commands::all().flat_map(|c| c.keys.iter().map(move |keys| (keys, c))).collect();
    keyed.sort_by_key(|(keys, _)| {
        let Modifiers { alt, shift, command, .. } = keys.modifiers;
        std::cmp::Reverse(u8::from(alt) + u8::from(shift) + u8::from(command))
    });
    for (keys, command) in keyed {
        if ctx.input_mut(|i| i.consume_shortcut(keys)) && (command.can)(session) {
            (command.run)(session, asked);
        }
    }
    for row in &ToolKind::ALL {
        let Some(letter) = Key::from_name(&row.key.to_string()) else { continue };
        if ctx.input_mut(|i| i.consume_key(Modifiers::NONE, letter)) {
            asked.act(Action::Hand(HandAction::Tool { tool: row.kind }));
        }
    }
    // The system turns these keys into events of their own.
    let pasted = ctx.input(|i| i.events.iter().any(|event| matches!(event, Event::Paste(_) | Event::PasteImage(_))));
    if pasted {
        asked.ask(super::asked::WindowAsk::Paste);
    }
}
