//! The submenu Path of the Layer menu. Floor 7.

use super::row::{MenuCommand, row};
use crate::document::{Content, LayerId};
use crate::io::path_svg;
use crate::paint::LivePath;
use crate::raster::coverage::SelectionMode;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::PathAction;
use crate::session::{Action, LayerPath, Session};
use std::sync::Arc;

/// The path of the selected layer.
fn selected_path(session: &Session) -> Option<&Arc<LivePath>> {
    match &session.layer()?.content {
        Content::Image(live) => live.params().source.path(),
        _ => None,
    }
}

fn has_path(session: &Session) -> bool {
    selected_path(session).is_some()
}

fn has_figure(session: &Session) -> bool {
    selected_path(session).is_some_and(|path| path.figure().is_some())
}

fn has_selection(session: &Session) -> bool {
    session.active().is_some_and(|open| open.document().active_selection.is_some())
}

fn act(session: &Session, requests: &mut UiRequests, action: impl FnOnce(LayerPath) -> PathAction) {
    requests.actions.extend(session.layer_path().map(action).map(Action::Path));
}

/// The first of the selected layers that is of a kind.
fn selected_beside(session: &Session, is_it: fn(&Content) -> bool) -> Option<LayerPath> {
    let open = session.active()?;
    let document = open.document();
    let is_of_kind = |id: &LayerId| document.layer(*id).is_some_and(|l| is_it(&l.content));
    LayerPath::of(document, open.selected_layers().into_iter().find(is_of_kind)?)
}

/// The path and the text that are selected.
fn path_and_text(session: &Session) -> Option<(LayerPath, LayerPath)> {
    selected_beside(session, is_path).zip(selected_beside(session, is_text))
}

fn is_painted(content: &Content) -> bool {
    matches!(content, Content::Pixels(_) | Content::Strokes(_))
}

fn is_path(content: &Content) -> bool {
    matches!(content, Content::Image(live) if live.params().source.path().is_some())
}

fn is_text(content: &Content) -> bool {
    matches!(content, Content::Image(live) if live.params().source.text().is_some())
}

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Panels…",
        &[],
        "Divides the page, the selection or the selected path in panels of a comic, each a group \
         that is clipped to its frame",
        |session| session.active().is_some(),
        |_, requests| requests.request(WindowRequest::PanelsDialog),
    ),
    row(
        "Select path",
        &[],
        "Selects what lies inside of the path",
        has_path,
        |session, requests| {
            let how = SelectionMode::Replace;
            act(session, requests, |layer| PathAction::Select { layer, how });
        },
    ),
    row(
        "Path from selection",
        &[],
        "Draws a path around what is selected",
        has_selection,
        |_, requests| requests.act(Action::Path(PathAction::FromSelection {})),
    ),
    row(
        "Stroke path with brush",
        &[],
        "Paints along the path with the brush in hand: on the paint layer that is selected with it, or on strokes \
         above it",
        has_path,
        |session, requests| {
            let onto = selected_beside(session, is_painted);
            act(session, requests, |layer| PathAction::Stroke { layer, onto });
        },
    ),
    row(
        "Text along path",
        &[],
        "The text that is selected with the path runs along it",
        |session| path_and_text(session).is_some(),
        |session, requests| {
            let found = path_and_text(session);
            let action = found.map(|(layer, text)| PathAction::CarryText { layer, text });
            requests.actions.extend(action.map(Action::Path));
        },
    ),
    row(
        "Copy as SVG",
        &[],
        "Puts the path into the clipboard as SVG, for other programs",
        has_path,
        |session, requests| {
            let text = selected_path(session).map(|path| path_svg::write(path));
            if let Some(text) = text {
                requests.request(WindowRequest::CopyText(text));
            }
        },
    ),
    row(
        "Figure to nodes",
        &[],
        "The corners of the figure become nodes, which the path tool moves",
        has_figure,
        |session, requests| act(session, requests, |layer| PathAction::ToNodes { layer }),
    ),
];
