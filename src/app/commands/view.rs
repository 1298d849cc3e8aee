//! The View menu.
//! Floor 7.

use super::{Command, Menu, always, ctrl, ctrl_shift, has_document, key, line};
use crate::app::asked::{Asked, WindowAsk};
use crate::app::panels::Front;
use crate::math::Vec2;
use crate::session::actions::ViewAction;
use crate::session::{Action, Session};
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

const MENU: Menu = Menu::View;

fn view(asked: &mut Asked, action: ViewAction) {
    asked.act(Action::View(action));
}
fn overlay(session: &Session, asked: &mut Asked, name: &str) {
    let is_on = session.overlay.as_deref() == Some(name);
    view(asked, ViewAction::Overlay { view: (!is_on).then(|| name.to_owned()) });
}
fn has_surface(session: &Session) -> bool {
    session.shown().is_some_and(|document| document.surface.is_some())
}
const STEP_RAD: f32 = std::f32::consts::PI / 12.0;

pub const COMMANDS: &[Command] = &[
    Command {
        name: "Zoom in",
        menu: MENU,
        keys: &[ctrl(Key::Plus), ctrl(Key::Equals), key(Key::Plus)],
        hint: "Or turn the wheel",
        can: has_document,
        run: |_, asked| view(asked, ViewAction::Zoom { factor: 1.25, about: Vec2::ZERO }),
    },
    Command {
        name: "Zoom out",
        menu: MENU,
        keys: &[ctrl(Key::Minus), key(Key::Minus)],
        hint: "Or turn the wheel",
        can: has_document,
        run: |_, asked| view(asked, ViewAction::Zoom { factor: 0.8, about: Vec2::ZERO }),
    },
    Command {
        name: "Fit canvas",
        menu: MENU,
        keys: &[ctrl(Key::Num0), key(Key::Num2)],
        hint: "The whole canvas in the window",
        can: has_document,
        run: |_, asked| asked.ask(WindowAsk::Scale(0.0)),
    },
    Command {
        name: "Actual pixels",
        menu: MENU,
        keys: &[ctrl(Key::Num1), key(Key::Num1)],
        hint: "A pixel of the canvas to a pixel of the screen",
        can: has_document,
        run: |_, asked| asked.ask(WindowAsk::Scale(1.0)),
    },
    line(MENU),
    Command {
        name: "Turn right",
        menu: MENU,
        keys: &[key(Key::Num6), ctrl(Key::CloseBracket)],
        hint: "The canvas by 15° clockwise; Shift and Space turn it with the mouse",
        can: has_document,
        run: |_, asked| view(asked, ViewAction::Turn { by_rad: STEP_RAD }),
    },
    Command {
        name: "Turn left",
        menu: MENU,
        keys: &[key(Key::Num4), ctrl(Key::OpenBracket)],
        hint: "The canvas by 15° counter-clockwise",
        can: has_document,
        run: |_, asked| view(asked, ViewAction::Turn { by_rad: -STEP_RAD }),
    },
    Command {
        name: "Upright",
        menu: MENU,
        keys: &[key(Key::Num5)],
        hint: "Turn the canvas back",
        can: has_document,
        run: |_, asked| view(asked, ViewAction::Upright {}),
    },
    Command {
        name: "Mirror view",
        menu: MENU,
        keys: &[key(Key::M)],
        hint: "See the picture mirrored, to check the drawing; the document stays as it is",
        can: has_document,
        run: |_, asked| view(asked, ViewAction::Mirror {}),
    },
    line(MENU),
    Command {
        name: "Show normals",
        menu: MENU,
        keys: &[KeyboardShortcut::new(Modifiers::ALT, Key::Num1)],
        hint: "The normals of the surface over the picture",
        can: has_surface,
        run: |session, asked| overlay(session, asked, "normals"),
    },
    Command {
        name: "Show depth",
        menu: MENU,
        keys: &[KeyboardShortcut::new(Modifiers::ALT, Key::Num2)],
        hint: "The depth of the surface over the picture",
        can: has_surface,
        run: |session, asked| overlay(session, asked, "depth"),
    },
    Command {
        name: "Show curvature",
        menu: MENU,
        keys: &[KeyboardShortcut::new(Modifiers::ALT, Key::Num3)],
        hint: "Convex blue, concave red",
        can: has_surface,
        run: |session, asked| overlay(session, asked, "curvature"),
    },
    Command {
        name: "Show anchor weights",
        menu: MENU,
        keys: &[KeyboardShortcut::new(Modifiers::ALT, Key::Num4)],
        hint: "How the anchors of the selected layer share the surface",
        can: has_surface,
        run: |session, asked| overlay(session, asked, "weights"),
    },
    Command {
        name: "Show lit ball",
        menu: MENU,
        keys: &[KeyboardShortcut::new(Modifiers::ALT, Key::Num5)],
        hint: "The surface and a ball under one light: if they agree, the maps are the right way round",
        can: has_surface,
        run: |session, asked| overlay(session, asked, "lit"),
    },
    line(MENU),
    Command {
        name: "Hide panels",
        menu: MENU,
        keys: &[key(Key::Tab)],
        hint: "Only the canvas, or all panels again",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::TogglePanels),
    },
    Command {
        name: "Panels on the other side",
        menu: MENU,
        keys: &[],
        hint: "To the left of the canvas, or to the right",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::OtherSide),
    },
    Command {
        name: "Panels in a window",
        menu: MENU,
        keys: &[],
        hint: "Apart from the canvas, to be moved about; or beside it again. A right-click on a panel's name takes one out",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::PanelsApart),
    },
    Command {
        name: "Layers in a window",
        menu: MENU,
        keys: &[],
        hint: "The layers alone, to be moved about; or beside the canvas again",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::Float(Front::Layers)),
    },
    Command {
        name: "Full screen",
        menu: MENU,
        keys: &[key(Key::F11)],
        hint: "Or back",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::FullScreen),
    },
    Command {
        name: "Light or dark",
        menu: MENU,
        keys: &[],
        hint: "The other of the two themes",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::ToggleTheme),
    },
    Command {
        name: "Command palette…",
        menu: MENU,
        keys: &[ctrl_shift(Key::P), ctrl(Key::K)],
        hint: "Find any command by its name",
        can: always,
        run: |_, asked| asked.ask(WindowAsk::Palette),
    },
    Command {
        name: "Next document",
        menu: MENU,
        keys: &[ctrl(Key::Tab), ctrl_shift(Key::CloseBracket)],
        hint: "The next tab",
        can: has_document,
        run: |session, asked| {
            let index = (session.current + 1) % session.tabs.len().max(1);
            asked.act(Action::File(crate::session::actions::FileAction::Tab { index }));
        },
    },
];
