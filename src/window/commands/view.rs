//! The View menu.
//! Floor 7.

use super::{Command, LINE, always, ctrl, ctrl_alt, ctrl_shift, has_document, key, row};
use crate::asked::{Asked, WindowAsk};
use crate::math::Vec2;
use crate::panels::Front;
use crate::session::actions::ViewAction;
use crate::session::{Action, Session};
use crate::settings::Side;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

fn view(asked: &mut Asked, action: ViewAction) {
    asked.act(Action::View(action));
}
fn overlay(session: &Session, asked: &mut Asked, name: &str) {
    view(asked, ViewAction::Overlay { view: (!is_over(session, name)).then(|| name.to_owned()) });
}
fn is_over(session: &Session, name: &str) -> bool {
    session.overlay.as_deref() == Some(name)
}
fn has_surface(session: &Session) -> bool {
    session.shown().is_some_and(|document| document.surface.is_some())
}
const fn alt(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::ALT, key)
}
const STEP_RAD: f32 = std::f32::consts::PI / 12.0;

pub const COMMANDS: &[Command] = &[
    row(
        "Zoom in",
        &[ctrl(Key::Plus), ctrl(Key::Equals), key(Key::Plus)],
        "Or turn the wheel",
        has_document,
        |_, asked| view(asked, ViewAction::Zoom { factor: 1.25, about: Vec2::ZERO }),
    ),
    row("Zoom out", &[ctrl(Key::Minus), key(Key::Minus)], "Or turn the wheel", has_document, |_, asked| {
        view(asked, ViewAction::Zoom { factor: 0.8, about: Vec2::ZERO })
    }),
    row(
        "Fit canvas",
        &[ctrl(Key::Num0), key(Key::Num2)],
        "The whole canvas in the window",
        has_document,
        |_, asked| asked.ask(WindowAsk::Scale(0.0)),
    ),
    row(
        "Actual pixels",
        &[ctrl(Key::Num1), key(Key::Num1)],
        "A pixel of the canvas to a pixel of the screen",
        has_document,
        |_, asked| asked.ask(WindowAsk::Scale(1.0)),
    ),
    LINE,
    row(
        "Turn right",
        &[key(Key::Num6), ctrl(Key::CloseBracket)],
        "The canvas by 15° clockwise; Shift and Space turn it with the mouse",
        has_document,
        |_, asked| view(asked, ViewAction::Turn { by_rad: STEP_RAD }),
    ),
    row(
        "Turn left",
        &[key(Key::Num4), ctrl(Key::OpenBracket)],
        "The canvas by 15° counter-clockwise",
        has_document,
        |_, asked| view(asked, ViewAction::Turn { by_rad: -STEP_RAD }),
    ),
    row("Upright", &[key(Key::Num5)], "Turn the canvas back", has_document, |_, asked| {
        view(asked, ViewAction::Upright {})
    }),
    row(
        "Mirror view",
        &[key(Key::M)],
        "See the picture mirrored, to check the drawing; the document stays as it is",
        has_document,
        |_, asked| view(asked, ViewAction::Mirror {}),
    )
    .ticked(|session, _| session.tab().is_some_and(|tab| tab.view.is_some_and(|view| view.mirrored))),
    LINE,
    row(
        "Show normals",
        &[alt(Key::Num1)],
        "The normals of the surface over the picture",
        has_surface,
        |session, asked| overlay(session, asked, "normals"),
    )
    .ticked(|session, _| is_over(session, "normals")),
    row("Show depth", &[alt(Key::Num2)], "The depth of the surface over the picture", has_surface, |session, asked| {
        overlay(session, asked, "depth")
    })
    .ticked(|session, _| is_over(session, "depth")),
    row("Show curvature", &[alt(Key::Num3)], "Convex blue, concave red", has_surface, |session, asked| {
        overlay(session, asked, "curvature")
    })
    .ticked(|session, _| is_over(session, "curvature")),
    row(
        "Show anchor weights",
        &[alt(Key::Num4)],
        "How the anchors of the selected layer share the surface",
        has_surface,
        |session, asked| overlay(session, asked, "weights"),
    )
    .ticked(|session, _| is_over(session, "weights")),
    row(
        "Show lit ball",
        &[alt(Key::Num5)],
        "The surface and a ball under one light: if they agree, the maps are the right way round",
        has_surface,
        |session, asked| overlay(session, asked, "lit"),
    )
    .ticked(|session, _| is_over(session, "lit")),
    LINE,
    row("Hide panels", &[key(Key::Tab)], "Only the canvas, or all panels again", always, |_, asked| {
        asked.ask(WindowAsk::TogglePanels)
    })
    .ticked(|_, settings| settings.layout.is_hidden),
    row("Panels on the other side", &[], "To the left of the canvas, or to the right", always, |_, asked| {
        asked.ask(WindowAsk::OtherSide)
    }),
    row(
        "Panels in a window",
        &[],
        "Apart from the canvas, to be moved about; or beside it again. A right-click on a panel's name takes one out",
        always,
        |_, asked| asked.ask(WindowAsk::PanelsApart),
    )
    .ticked(|_, settings| settings.layout.side == Side::Apart),
    row(
        "Layers in a window",
        &[],
        "The layers alone, to be moved about; or beside the canvas again",
        always,
        |_, asked| asked.ask(WindowAsk::Float(Front::Layers)),
    )
    .ticked(|_, settings| settings.layout.apart.contains(&Front::Layers)),
    row("Full screen", &[key(Key::F11)], "Or back", always, |_, asked| asked.ask(WindowAsk::FullScreen)),
    row(
        "Larger interface",
        &[ctrl_alt(Key::Plus), ctrl_alt(Key::Equals)],
        "Menus, panels and text, not the picture",
        always,
        |_, asked| asked.ask(WindowAsk::ResizeInterface { is_larger: true }),
    ),
    row("Smaller interface", &[ctrl_alt(Key::Minus)], "Menus, panels and text, not the picture", always, |_, asked| {
        asked.ask(WindowAsk::ResizeInterface { is_larger: false })
    }),
    row("Light or dark", &[], "The other of the two themes", always, |_, asked| asked.ask(WindowAsk::ToggleTheme)),
    row(
        "Command palette…",
        &[ctrl_shift(Key::P), ctrl(Key::K)],
        "Find any command by its name",
        always,
        |_, asked| asked.ask(WindowAsk::Palette),
    ),
    row(
        "Next document",
        &[ctrl(Key::Tab), ctrl_shift(Key::CloseBracket)],
        "The next tab",
        has_document,
        |session, asked| {
            let index = (session.current + 1) % session.tabs.len().max(1);
            asked.act(Action::File(crate::session::actions::FileAction::Tab { index }));
        },
    ),
];
