//! The View menu.
//! Floor 7.

use super::row::{
    LINE, MenuCommand, always, ctrl, ctrl_alt, ctrl_shift, has_document, has_surface, key, row,
    submenu,
};
use crate::file_purpose::FilePurpose;
use crate::math::Vec2;
use crate::panel_layout::PanelKind;
use crate::panel_layout::PanelSide;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::{FileAction, ViewAction};
use crate::session::{Action, Session};
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

fn view(requests: &mut UiRequests, action: ViewAction) {
    requests.act(Action::View(action));
}

fn overlay(session: &Session, requests: &mut UiRequests, name: &str) {
    view(
        requests,
        ViewAction::Overlay { view: (!is_over(session, name)).then(|| name.to_owned()) },
    );
}

fn is_over(session: &Session, name: &str) -> bool {
    session.overlay.as_deref() == Some(name)
}

/// Whether the document's file holds another picture of the same size.
fn has_saved_picture(session: &Session) -> bool {
    session
        .active()
        .is_some_and(|open| open.is_dirty() && open.saved_document().size == open.document().size)
}

fn is_unwrapped(session: &Session) -> bool {
    session.active().is_some_and(|open| open.unwrap_settings().is_some())
}

const fn alt(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::ALT, key)
}

/// Shows the document so many tabs to the right of the one in front, around the end.
fn show_neighbor(session: &Session, requests: &mut UiRequests, by: usize) {
    let index = (session.current + by) % session.open_documents.len().max(1);
    requests.act(Action::File(FileAction::Show { index }));
}
const STEP_RAD: f32 = std::f32::consts::PI / 12.0;

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Zoom in",
        &[ctrl(Key::Plus), ctrl(Key::Equals), key(Key::Plus)],
        "Or turn the wheel",
        has_document,
        |_, requests| view(requests, ViewAction::Zoom { factor: 1.25, about: Vec2::ZERO }),
    ),
    row(
        "Zoom out",
        &[ctrl(Key::Minus), key(Key::Minus)],
        "Or turn the wheel",
        has_document,
        |_, requests| view(requests, ViewAction::Zoom { factor: 0.8, about: Vec2::ZERO }),
    ),
    row(
        "Fit canvas",
        &[ctrl(Key::Num0), key(Key::Num2)],
        "The whole canvas in the window",
        has_document,
        |_, requests| requests.request(WindowRequest::Scale(0.0)),
    ),
    row(
        "Actual pixels",
        &[ctrl(Key::Num1), key(Key::Num1)],
        "One pixel of the canvas per pixel of the screen",
        has_document,
        |_, requests| requests.request(WindowRequest::Scale(1.0)),
    ),
    LINE,
    row(
        "Turn right",
        &[key(Key::Num6), ctrl(Key::CloseBracket)],
        "The canvas by 15° clockwise; Shift and Space turn it with the mouse",
        has_document,
        |_, requests| view(requests, ViewAction::Turn { by_rad: STEP_RAD }),
    ),
    row(
        "Turn left",
        &[key(Key::Num4), ctrl(Key::OpenBracket)],
        "The canvas by 15° counter-clockwise",
        has_document,
        |_, requests| view(requests, ViewAction::Turn { by_rad: -STEP_RAD }),
    ),
    row("Upright", &[key(Key::Num5)], "Turns the view back", has_document, |_, requests| {
        view(requests, ViewAction::Upright {})
    }),
    row(
        "Mirror view",
        &[key(Key::M)],
        "Mirrors the display to check the drawing; the document does not change",
        has_document,
        |_, requests| view(requests, ViewAction::Mirror {}),
    )
    .ticked(|session, _| {
        session.active().is_some_and(|open| open.view.is_some_and(|view| view.mirrored))
    }),
    row(
        "Show values",
        &[],
        "The picture in grays, to judge light and dark; the document does not change",
        has_document,
        |session, requests| view(requests, ViewAction::Values { on: !session.shows_values }),
    )
    .ticked(|session, _| session.shows_values),
    row(
        "Show as saved",
        &[],
        "The picture as its file holds it, to compare; again, or any edit, shows it as it is",
        has_saved_picture,
        |session, requests| view(requests, ViewAction::Saved { on: !session.shows_saved }),
    )
    .ticked(|session, _| session.shows_saved),
    LINE,
    submenu("Show the surface", SURFACE),
    row(
        "Unwrapped",
        &[alt(Key::Num9)],
        "Shows the surface laid flat, to paint on: a straight line here bends around the form",
        has_surface,
        |session, requests| match is_unwrapped(session) {
            true => view(requests, ViewAction::Unwrapped { on: false }),
            false => requests.request(WindowRequest::Unwrap),
        },
    )
    .ticked(|session, _| is_unwrapped(session)),
    submenu("Proof colors", PROOF),
    submenu("References", REFERENCES),
    submenu("Guides and grid", super::guides::COMMANDS),
    LINE,
    submenu("Panels", PANELS),
    row(
        "Hide panels",
        &[key(Key::Tab)],
        "Shows only the canvas (in full screen without the menus), or everything again",
        always,
        |_, requests| requests.request(WindowRequest::TogglePanels),
    )
    .ticked(|_, layout| layout.is_hidden),
    row("Full screen", &[key(Key::F11)], "Or back", always, |_, requests| {
        requests.request(WindowRequest::FullScreen)
    }),
    row(
        "Larger interface",
        &[ctrl_alt(Key::Plus), ctrl_alt(Key::Equals)],
        "Menus, panels and text, not the picture",
        always,
        |_, requests| requests.request(WindowRequest::ResizeInterface { is_larger: true }),
    ),
    row(
        "Smaller interface",
        &[ctrl_alt(Key::Minus)],
        "Menus, panels and text, not the picture",
        always,
        |_, requests| requests.request(WindowRequest::ResizeInterface { is_larger: false }),
    ),
    row(
        "Dark, gray or light",
        &[],
        "The next theme of the window; gray is for judging colors",
        always,
        |_, requests| requests.request(WindowRequest::NextLook),
    ),
    row(
        "Details in the status bar",
        &[],
        "The surface under the pointer, the memory in use and the time of the last redraw, or not",
        always,
        |_, requests| requests.request(WindowRequest::ToggleDetails),
    ),
    LINE,
    row(
        "Command palette…",
        &[ctrl_shift(Key::P), ctrl(Key::K)],
        "Finds any command, tool, panel or setting, also by its name in other programs",
        always,
        |_, requests| requests.request(WindowRequest::Palette),
    ),
    row(
        "Next document",
        &[ctrl(Key::Tab), ctrl_shift(Key::CloseBracket)],
        "The next tab",
        has_document,
        |session, requests| show_neighbor(session, requests, 1),
    ),
    row(
        "Previous document",
        &[ctrl_shift(Key::Tab)],
        "The tab before this one",
        has_document,
        |session, requests| {
            show_neighbor(session, requests, session.open_documents.len().saturating_sub(1))
        },
    ),
];

const SURFACE: &[MenuCommand] = &[
    row(
        "Show normals",
        &[alt(Key::Num1)],
        "The normals of the surface over the picture",
        has_surface,
        |session, requests| overlay(session, requests, "normals"),
    )
    .ticked(|session, _| is_over(session, "normals")),
    row(
        "Show depth",
        &[alt(Key::Num2)],
        "The depth of the surface over the picture",
        has_surface,
        |session, requests| overlay(session, requests, "depth"),
    )
    .ticked(|session, _| is_over(session, "depth")),
    row(
        "Show curvature",
        &[alt(Key::Num3)],
        "Convex blue, concave red",
        has_surface,
        |session, requests| overlay(session, requests, "curvature"),
    )
    .ticked(|session, _| is_over(session, "curvature")),
    row(
        "Show anchor weights",
        &[alt(Key::Num4)],
        "How the anchors of the selected layer share the surface",
        has_surface,
        |session, requests| overlay(session, requests, "weights"),
    )
    .ticked(|session, _| is_over(session, "weights")),
    row(
        "Show lit ball",
        &[alt(Key::Num5)],
        "The surface and a ball under one light: if they agree, the maps are read correctly",
        has_surface,
        |session, requests| overlay(session, requests, "lit"),
    )
    .ticked(|session, _| is_over(session, "lit")),
    row(
        "Show clay",
        &[alt(Key::Num6)],
        "The form alone, unpainted, in even light",
        has_surface,
        |session, requests| overlay(session, requests, "clay"),
    )
    .ticked(|session, _| is_over(session, "clay")),
    row(
        "Show contour lines",
        &[alt(Key::Num7)],
        "Lines of equal depth: where they are close the surface is steep",
        has_surface,
        |session, requests| overlay(session, requests, "contours"),
    )
    .ticked(|session, _| is_over(session, "contours")),
    row(
        "Wobble",
        &[alt(Key::Num8)],
        "The picture sways by its depth, as if you moved your head; any key or click stops it",
        has_surface,
        |_, requests| requests.request(WindowRequest::Wobble),
    ),
];

const PROOF: &[MenuCommand] = &[
    row(
        "Show proof",
        &[],
        "The picture as a press or another screen shows it, by its ICC profile; the document does not change",
        has_document,
        |_, requests| requests.request(WindowRequest::ToggleProof),
    )
    .ticked(|session, _| session.shows_proof),
    row(
        "Mark colors out of gamut",
        &[],
        "What the press or the screen cannot show is gray in the proof",
        has_document,
        |session, requests| view(requests, ViewAction::Gamut { on: !session.marks_gamut }),
    )
    .ticked(|session, _| session.marks_gamut),
    row("Proof profile…", &[], "Another ICC profile for the proof", has_document, |_, requests| {
        requests.request(WindowRequest::Choose(FilePurpose::ColorProfile))
    }),
];

const REFERENCES: &[MenuCommand] = &[
    row(
        "Pin a reference…",
        &[],
        "A picture over the canvas, to look at and to take colors from; it is not part of the document",
        always,
        |_, requests| requests.request(WindowRequest::Choose(FilePurpose::Reference)),
    ),
    row(
        "Paste as reference",
        &[],
        "What is in the clipboard, over the canvas; it is not part of the document",
        always,
        |_, requests| requests.request(WindowRequest::PasteReference),
    ),
    row("Show references", &[], "Shows or hides what is pinned", always, |_, requests| {
        requests.request(WindowRequest::ToggleReferences)
    })
    .ticked(|_, layout| !layout.hides_references),
    row("Remove references", &[], "Removes all that are pinned", always, |_, requests| {
        requests.request(WindowRequest::ClearReferences)
    }),
];

const PANELS: &[MenuCommand] = &[
    row("Panels on the other side", &[], "To the left of the canvas, or to the right", always, |_, requests| {
        requests.request(WindowRequest::OtherSide)
    }),
    row(
        "Panels in a window",
        &[],
        "Moves the panels to a window of their own, or back. A right-click on a panel's name detaches that panel",
        always,
        |_, requests| requests.request(WindowRequest::PanelsApart),
    )
    .ticked(|_, layout| layout.side == PanelSide::Floating),
    row("Layers in a window", &[], "Moves the layer list to a window of its own, or back", always, |_, requests| {
        requests.request(WindowRequest::Float(PanelKind::Layers))
    })
    .ticked(|_, layout| layout.floating.contains(&PanelKind::Layers)),
    row(
        "Second view",
        &[],
        "The picture once more in a window of its own, with a zoom of its own; again closes it",
        has_document,
        |_, requests| requests.request(WindowRequest::SecondView),
    ),
];
