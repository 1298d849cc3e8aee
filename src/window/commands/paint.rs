//! The Paint menu: the current brush, colours and operator.
//! Floor 7.

use super::row::{LINE, MenuCommand, always, key, row, shift};
use crate::operators::{self, OPERATORS};
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use eframe::egui::Key;

fn hand(requests: &mut UiRequests, action: HandAction) {
    requests.act(Action::Hand(action));
}
fn resize(session: &Session, requests: &mut UiRequests, factor: f32) {
    let size = session.brush.size;
    let to = if factor > 1.0 { (size * factor).max(size + 1.0) } else { (size * factor).min(size - 1.0) };
    hand(requests, HandAction::Size { to: to.round() });
}

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Larger brush",
        &[key(Key::CloseBracket)],
        "Or drag with the right button on the canvas",
        always,
        |session, requests| resize(session, requests, 1.2),
    ),
    row(
        "Smaller brush",
        &[key(Key::OpenBracket)],
        "Or drag with the right button on the canvas",
        always,
        |session, requests| resize(session, requests, 1.0 / 1.2),
    ),
    row("Harder brush", &[shift(Key::CloseBracket)], "A sharper rim", always, |session, requests| {
        hand(requests, HandAction::Hardness { to: session.brush.hardness + 0.1 })
    }),
    row("Softer brush", &[shift(Key::OpenBracket)], "A smoother rim", always, |session, requests| {
        hand(requests, HandAction::Hardness { to: session.brush.hardness - 0.1 })
    }),
    LINE,
    row("Swap colours", &[key(Key::X)], "Exchanges the first and the second colour", always, |_, requests| {
        hand(requests, HandAction::SwapColors {})
    }),
    row("Default colours", &[key(Key::D)], "Sets black and white", always, |_, requests| {
        hand(requests, HandAction::DefaultColors {})
    }),
    LINE,
    row("Operator: flat", &[key(Key::F1)], OPERATORS[0].2, always, |session, requests| {
        operators::give(session, requests, OPERATORS[0].1)
    })
    .ticked(|session, _| operators::has(session, OPERATORS[0].1)),
    row("Operator: texture", &[key(Key::F2)], OPERATORS[1].2, always, |session, requests| {
        operators::give(session, requests, OPERATORS[1].1)
    })
    .ticked(|session, _| operators::has(session, OPERATORS[1].1)),
    row("Operator: shading", &[key(Key::F3)], OPERATORS[2].2, always, |session, requests| {
        operators::give(session, requests, OPERATORS[2].1)
    })
    .ticked(|session, _| operators::has(session, OPERATORS[2].1)),
    row("Operator: reflection", &[key(Key::F4)], OPERATORS[3].2, always, |session, requests| {
        operators::give(session, requests, OPERATORS[3].1)
    })
    .ticked(|session, _| operators::has(session, OPERATORS[3].1)),
];
