//! The Image menu: the canvas of the document, with everything on it.
//! Floor 7.

use super::row::{LINE, MenuCommand, ctrl_alt, has_document, row, submenu};
use crate::document::canvas_change::CanvasMirror;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::Action;
use crate::session::actions::CanvasAction;
use eframe::egui::Key;

fn act(requests: &mut UiRequests, action: CanvasAction) {
    requests.act(Action::Canvas(action));
}

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "Crop to selection",
        &[],
        "The canvas becomes the rectangle around all that is selected",
        has_document,
        |_, r| act(r, CanvasAction::CropToSelection {}),
    ),
    row("Trim canvas", &[], "Removes borders that hold no paint", has_document, |_, requests| {
        act(requests, CanvasAction::Trim {})
    }),
    row(
        "Canvas size…",
        &[ctrl_alt(Key::C)],
        "Moves the borders; the picture keeps its size",
        has_document,
        |_, requests| requests.request(WindowRequest::CanvasSizeDialog),
    ),
    row(
        "Image size…",
        &[],
        "Makes the whole picture larger or smaller; live layers stay sharp",
        has_document,
        |_, requests| requests.request(WindowRequest::ImageSizeDialog),
    ),
    row(
        "Profile…",
        &[],
        "Which colors the document's numbers mean: sRGB or Display P3",
        has_document,
        |_, requests| requests.request(WindowRequest::ProfileDialog),
    ),
    submenu("Adjust", super::adjustments::PAINT),
    submenu("Filter", super::filters::PAINT),
    LINE,
    row(
        "Turn canvas left",
        &[],
        "A quarter turn counter-clockwise, with everything on the canvas: the shape and its lights \
         too",
        has_document,
        |_, requests| act(requests, CanvasAction::Turn { degrees: 90.0 }),
    ),
    row(
        "Turn canvas right",
        &[],
        "A quarter turn clockwise, with everything on the canvas",
        has_document,
        |_, requests| act(requests, CanvasAction::Turn { degrees: -90.0 }),
    ),
    row(
        "Turn canvas upside down",
        &[],
        "A half turn, with everything on the canvas",
        has_document,
        |_, requests| act(requests, CanvasAction::Turn { degrees: 180.0 }),
    ),
    row(
        "Turn canvas…",
        &[],
        "By any angle; the canvas grows to hold it",
        has_document,
        |_, requests| requests.request(WindowRequest::TurnDialog),
    ),
    LINE,
    row(
        "Mirror canvas left and right",
        &[],
        "Mirrors the picture, not the view, with everything on the canvas",
        has_document,
        |_, requests| act(requests, CanvasAction::Mirror { mirror: CanvasMirror::LeftRight }),
    ),
    row(
        "Mirror canvas up and down",
        &[],
        "Mirrors the picture, with everything on the canvas",
        has_document,
        |_, requests| act(requests, CanvasAction::Mirror { mirror: CanvasMirror::UpDown }),
    ),
];
