//! The submenu Path of the Layer menu. Floor 7.

use super::row::{MenuCommand, row};
use crate::document::Content;
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

/// The paint or stroke layer that is selected beside the path.
fn painted_beside(session: &Session) -> Option<LayerPath> {
    let open = session.active()?;
    let document = open.document();
    let holds_strokes = |id: &crate::document::LayerId| {
        let layer = document.layer(*id);
        layer.is_some_and(|l| matches!(l.content, Content::Pixels(_) | Content::Strokes(_)))
    };
    let found = open.selected_layers().into_iter().find(holds_strokes)?;
    LayerPath::of(document, found)
}

pub const COMMANDS: &[MenuCommand] = &[
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
            let onto = painted_beside(session);
            act(session, requests, |layer| PathAction::Stroke { layer, onto });
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
