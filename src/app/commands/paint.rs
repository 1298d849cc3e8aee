//! The Paint menu: what is in hand.
//! Floor 7.

use super::{Command, Menu, always, key, line, shift};
use crate::app::asked::Asked;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::surface::Operator;
use eframe::egui::Key;

const MENU: Menu = Menu::Paint;

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
    Command {
        name: "Larger brush",
        menu: MENU,
        keys: &[key(Key::CloseBracket)],
        hint: "Or drag with the right button on the canvas",
        can: always,
        run: |session, asked| resize(session, asked, 1.2),
    },
    Command {
        name: "Smaller brush",
        menu: MENU,
        keys: &[key(Key::OpenBracket)],
        hint: "Or drag with the right button on the canvas",
        can: always,
        run: |session, asked| resize(session, asked, 1.0 / 1.2),
    },
    Command {
        name: "Harder brush",
        menu: MENU,
        keys: &[shift(Key::CloseBracket)],
        hint: "A sharper rim",
        can: always,
        run: |session, asked| hand(asked, HandAction::Hardness { to: session.brush.hardness + 0.1 }),
    },
    Command {
        name: "Softer brush",
        menu: MENU,
        keys: &[shift(Key::OpenBracket)],
        hint: "A smoother rim",
        can: always,
        run: |session, asked| hand(asked, HandAction::Hardness { to: session.brush.hardness - 0.1 }),
    },
    line(MENU),
    Command {
        name: "Swap colours",
        menu: MENU,
        keys: &[key(Key::X)],
        hint: "The second colour to the front",
        can: always,
        run: |_, asked| hand(asked, HandAction::SwapColors {}),
    },
    Command {
        name: "Default colours",
        menu: MENU,
        keys: &[key(Key::D)],
        hint: "Black in front of white",
        can: always,
        run: |_, asked| hand(asked, HandAction::DefaultColors {}),
    },
    line(MENU),
    Command {
        name: "Operator: flat",
        menu: MENU,
        keys: &[key(Key::F1)],
        hint: OPERATORS[0].2,
        can: always,
        run: |_, asked| hand(asked, HandAction::Operator { operator: OPERATORS[0].1 }),
    },
    Command {
        name: "Operator: texture",
        menu: MENU,
        keys: &[key(Key::F2)],
        hint: OPERATORS[1].2,
        can: always,
        run: |_, asked| hand(asked, HandAction::Operator { operator: OPERATORS[1].1 }),
    },
    Command {
        name: "Operator: shading",
        menu: MENU,
        keys: &[key(Key::F3)],
        hint: OPERATORS[2].2,
        can: always,
        run: |_, asked| hand(asked, HandAction::Operator { operator: OPERATORS[2].1 }),
    },
    Command {
        name: "Operator: reflection",
        menu: MENU,
        keys: &[key(Key::F4)],
        hint: OPERATORS[3].2,
        can: always,
        run: |_, asked| hand(asked, HandAction::Operator { operator: OPERATORS[3].1 }),
    },
];
