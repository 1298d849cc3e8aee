//! Guides, the grid and snapping: a menu within View.
//! Floor 7.

use super::row::{LINE, MenuCommand, always, ctrl, ctrl_alt, ctrl_shift, has_document, row};
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::GuideAction;
use crate::session::{Action, Session};
use crate::tools::snap::ViewAids;
use eframe::egui::Key;

/// Changes one of the settings.
fn set(session: &Session, requests: &mut UiRequests, change: impl FnOnce(&mut ViewAids)) {
    let mut aids = session.tools.aids;
    change(&mut aids);
    requests.act(Action::Guide(GuideAction::Aids { aids }));
}

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Rulers",
        &[ctrl(Key::R)],
        "Rulers along the edges of the view; drag guides out of them, and back to remove them",
        always,
        |session, requests| set(session, requests, |aids| aids.rulers ^= true),
    )
    .ticked(|session, _| session.tools.aids.rulers),
    row(
        "Show guides",
        &[ctrl(Key::Semicolon)],
        "Hidden guides are not snapped to",
        always,
        |session, requests| set(session, requests, |aids| aids.guides ^= true),
    )
    .ticked(|session, _| session.tools.aids.guides),
    row(
        "Lock guides",
        &[ctrl_alt(Key::Semicolon)],
        "Guides stay where they are",
        always,
        |session, requests| set(session, requests, |aids| aids.locked ^= true),
    )
    .ticked(|session, _| session.tools.aids.locked),
    row("Clear guides", &[], "Removes all guides", has_document, |_, requests| {
        requests.act(Action::Guide(GuideAction::Clear {}))
    }),
    LINE,
    row(
        "Show grid",
        &[ctrl_shift(Key::Quote)],
        "Lines at equal distances over the picture",
        always,
        |session, requests| set(session, requests, |aids| aids.grid_shown ^= true),
    )
    .ticked(|session, _| session.tools.aids.grid_shown),
    row(
        "Grid and snapping…",
        &[],
        "Spacing of the grid, and what you snap to",
        always,
        |_, requests| requests.request(WindowRequest::GridDialog),
    ),
    row(
        "Snap",
        &[ctrl_shift(Key::Semicolon)],
        "What you drag snaps to guides, the grid, edges and middles within eight points",
        always,
        |session, requests| set(session, requests, |aids| aids.snaps ^= true),
    )
    .ticked(|session, _| session.tools.aids.snaps),
    LINE,
    row(
        "Draw along assistants",
        &[ctrl_shift(Key::L)],
        "Strokes follow the lines of assistants",
        always,
        |session, requests| {
            set(session, requests, |aids| {
                aids.magnetism = if aids.magnetism > 0.0 { 0.0 } else { 1.0 }
            })
        },
    )
    .ticked(|session, _| session.tools.aids.magnetism > 0.0),
    row("Clear assistants", &[], "Removes all assistants", has_document, |_, requests| {
        requests.act(Action::Guide(GuideAction::Assistants { assistants: Vec::new() }))
    }),
];
