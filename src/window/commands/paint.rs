//! The Paint menu: the current brush, colors and operator.
//! Floor 7.

use super::row::{LINE, MenuCommand, always, has_surface, key, row, shift};
use crate::document::Content;
use crate::operators;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::{HandAction, LayerAction};
use crate::session::{Action, Session};
use crate::shading::Model;
use crate::tools::ToolKind;
use eframe::egui::Key;

fn hand(requests: &mut UiRequests, action: HandAction) {
    requests.act(Action::Hand(action));
}

/// Whether the selected layer shows a painted ball.
fn has_ball(session: &Session) -> bool {
    session.layer().is_some_and(|layer| match &layer.content {
        Content::Shading(live) => live.params().model == Model::LitSphere,
        _ => false,
    })
}

fn resize(session: &Session, requests: &mut UiRequests, factor: f32) {
    let size = match session.tool {
        ToolKind::Sculpt => session.tools.shape.size,
        ToolKind::Liquify => session.tools.liquify.size,
        _ => session.tools.brush.size,
    };
    let to = if factor > 1.0 {
        (size * factor).max(size + 1.0)
    } else {
        (size * factor).min(size - 1.0)
    };
    hand(requests, HandAction::Size { to: to.round() });
}

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Looks…",
        &[],
        "Shows the shape as an oil sketch, in clay, in gold, as a comic, …",
        has_surface,
        |_, requests| requests.request(WindowRequest::LooksDialog),
    ),
    row(
        "Materials…",
        &[],
        "Makes a part leather, wood, glass, gold, …",
        has_surface,
        |_, requests| requests.request(WindowRequest::MaterialsDialog),
    ),
    row(
        "Paint the ball",
        &[],
        "Opens the ball of the layer as a drawing of its own; each stroke on it repaints the shape",
        has_ball,
        |session, requests| {
            let path = session.layer_path();
            let paint = |layer| LayerAction::PaintBall { layer, hollows: false };
            path.into_iter().for_each(|path| requests.act(Action::Layer(paint(path))));
        },
    ),
    LINE,
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
    row(
        "Harder brush",
        &[shift(Key::CloseBracket)],
        "A sharper rim",
        always,
        |session, requests| {
            hand(requests, HandAction::Hardness { to: session.tools.brush.hardness + 0.1 })
        },
    ),
    row(
        "Softer brush",
        &[shift(Key::OpenBracket)],
        "A smoother rim",
        always,
        |session, requests| {
            hand(requests, HandAction::Hardness { to: session.tools.brush.hardness - 0.1 })
        },
    ),
    LINE,
    row(
        "Swap colors",
        &[key(Key::X)],
        "Exchanges the first and the second color",
        always,
        |_, requests| hand(requests, HandAction::SwapColors {}),
    ),
    row("Default colors", &[key(Key::D)], "Sets black and white", always, |_, requests| {
        hand(requests, HandAction::DefaultColors {})
    }),
    LINE,
    row("Bend: flat", &[key(Key::F1)], operators::FLAT.hint, always, |session, requests| {
        operators::give(session, requests, operators::FLAT.begins)
    })
    .ticked(|session, _| operators::has_operator(session, operators::FLAT.begins)),
    row("Bend: wrap", &[key(Key::F2)], operators::TEXTURE.hint, always, |session, requests| {
        operators::give(session, requests, operators::TEXTURE.begins)
    })
    .ticked(|session, _| operators::has_operator(session, operators::TEXTURE.begins)),
    row("Bend: near and far", &[], operators::DEPTH_TEXTURE.hint, always, |session, requests| {
        operators::give(session, requests, operators::DEPTH_TEXTURE.begins)
    })
    .ticked(|session, _| operators::has_operator(session, operators::DEPTH_TEXTURE.begins)),
    row("Bend: gloss", &[key(Key::F3)], operators::SHADING.hint, always, |session, requests| {
        operators::give(session, requests, operators::SHADING.begins)
    })
    .ticked(|session, _| operators::has_operator(session, operators::SHADING.begins)),
    row(
        "Bend: true mirror",
        &[key(Key::F4)],
        operators::REFLECTION.hint,
        always,
        |session, requests| operators::give(session, requests, operators::REFLECTION.begins),
    )
    .ticked(|session, _| operators::has_operator(session, operators::REFLECTION.begins)),
];
