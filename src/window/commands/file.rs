//! The File menu.
//! Floor 7.

use super::row::{LINE, MenuCommand, always, ctrl, ctrl_shift, has_document, row};
use crate::requests::WindowRequest;
use eframe::egui::Key;

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "New…",
        &[ctrl(Key::N)],
        "An empty canvas, or one on the normal and depth maps of an object",
        always,
        |_, requests| requests.request(WindowRequest::NewDialog),
    ),
    row(
        "Open…",
        &[ctrl(Key::O)],
        "A project, a recipe, a normal or depth map, or a picture",
        always,
        |_, requests| requests.request(WindowRequest::OpenDialog),
    ),
    row(
        "Open maps…",
        &[ctrl_shift(Key::O)],
        "A canvas on the normal and depth maps of an object, their conventions shown and corrected",
        always,
        |_, requests| requests.request(WindowRequest::OpenMapsDialog),
    ),
    LINE,
    row("Save", &[ctrl(Key::S)], "To the file it came from", has_document, |_, requests| {
        requests.request(WindowRequest::Save)
    }),
    row(
        "Save as…",
        &[ctrl_shift(Key::S)],
        "To another file, which is its own from then on",
        has_document,
        |_, requests| requests.request(WindowRequest::SaveAs),
    ),
    row(
        "Export…",
        &[ctrl(Key::E)],
        "The finished picture as PNG, EXR, JPEG or WebP, or the layers for Photoshop",
        has_document,
        |_, requests| requests.request(WindowRequest::ExportDialog),
    ),
    LINE,
    row(
        "Place image…",
        &[ctrl_shift(Key::I)],
        "A picture as a layer bent over the surface",
        has_document,
        |_, requests| requests.request(WindowRequest::PlaceDialog),
    ),
    LINE,
    row(
        "Close",
        &[ctrl(Key::W)],
        "This document; asks first if it holds unsaved work",
        has_document,
        |session, requests| requests.request(WindowRequest::Close(session.current)),
    ),
    row("Quit", &[ctrl(Key::Q)], "Leave the program; asks first if there is unsaved work", always, |_, requests| {
        requests.request(WindowRequest::Quit)
    }),
];
