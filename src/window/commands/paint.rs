//! The Paint menu: what is in hand.
//! Floor 7.

use super::{Command, LINE, always, key, row, shift};
use crate::asked::Asked;
use crate::panels::options;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::surface::Operator;
use eframe::egui::Key;

/// The operators as the tool bar offers them, each with the numbers it begins with.
pub const OPERATORS: [(&str, Operator, &str); 4] = [
    ("Flat", Operator::None, "Marks lie on the canvas as they are"),
    ("Texture", Operator::Depth { gamma: 1.0 }, "Marks follow the depth, like a print on the surface"),
    (
        "Shading",
        Operator::Normal { alpha: 0.5, beta: 1.5, detail: 0.0 },
        "Marks follow the normals, like shading and highlights: mirror for α above 0, glass below",
    ),
    (
        "Reflection",
        Operator::Reflection { alpha: 1.0, detail: 0.0 },
        "Marks follow the mirrored view, like an image in polished metal",
    ),
];

fn hand(asked: &mut Asked, action: HandAction) {
    asked.act(Action::Hand(action));
}
fn resize(session: &Session, asked: &mut Asked, factor: f32) {
    let size = session.brush.size;
    let to = if factor > 1.0 { (size * factor).max(size + 1.0) } else { (size * factor).min(size - 1.0) };
    hand(asked, HandAction::Size { to: to.round() });
}

pub const COMMANDS: &[Command] = &[
    row(
        "Larger brush",
        &[key(Key::CloseBracket)],
        "Or drag with the right button on the canvas",
        always,
        |session, asked| resize(session, asked, 1.2),
    ),
    row(
        "Smaller brush",
        &[key(Key::OpenBracket)],
        "Or drag with the right button on the canvas",
        always,
        |session, asked| resize(session, asked, 1.0 / 1.2),
    ),
    row("Harder brush", &[shift(Key::CloseBracket)], "A sharper rim", always, |session, asked| {
        hand(asked, HandAction::Hardness { to: session.brush.hardness + 0.1 })
    }),
    row("Softer brush", &[shift(Key::OpenBracket)], "A smoother rim", always, |session, asked| {
        hand(asked, HandAction::Hardness { to: session.brush.hardness - 0.1 })
    }),
    LINE,
    row("Swap colours", &[key(Key::X)], "The second colour to the front", always, |_, asked| {
        hand(asked, HandAction::SwapColors {})
    }),
    row("Default colours", &[key(Key::D)], "Black in front of white", always, |_, asked| {
        hand(asked, HandAction::DefaultColors {})
    }),
    LINE,
    row("Operator: flat", &[key(Key::F1)], OPERATORS[0].2, always, |session, asked| {
        options::give(session, asked, OPERATORS[0].1)
    })
    .ticked(|session, _| options::has(session, OPERATORS[0].1)),
    row("Operator: texture", &[key(Key::F2)], OPERATORS[1].2, always, |session, asked| {
        options::give(session, asked, OPERATORS[1].1)
    })
    .ticked(|session, _| options::has(session, OPERATORS[1].1)),
    row("Operator: shading", &[key(Key::F3)], OPERATORS[2].2, always, |session, asked| {
        options::give(session, asked, OPERATORS[2].1)
    })
    .ticked(|session, _| options::has(session, OPERATORS[2].1)),
    row("Operator: reflection", &[key(Key::F4)], OPERATORS[3].2, always, |session, asked| {
        options::give(session, asked, OPERATORS[3].1)
    })
    .ticked(|session, _| options::has(session, OPERATORS[3].1)),
];
