//! The File menu.
//! Floor 7.

use super::row::{
    LINE, MenuCommand, always, ctrl, ctrl_alt, ctrl_alt_shift, ctrl_shift, has_document,
    has_surface, row,
};
use crate::file_purpose::FilePurpose;
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
        "A canvas on the normal and depth maps of an object; check and correct their conventions \
         first",
        always,
        |_, requests| requests.request(WindowRequest::OpenMapsDialog),
    ),
    LINE,
    row(
        "Save",
        &[ctrl(Key::S)],
        "Saves to the file it was opened from",
        has_document,
        |_, requests| requests.request(WindowRequest::Save),
    ),
    row(
        "Save as…",
        &[ctrl_shift(Key::S)],
        "Saves to another file, which the document then belongs to",
        has_document,
        |_, requests| requests.request(WindowRequest::SaveAs),
    ),
    row(
        "Export…",
        &[ctrl_alt(Key::E)],
        "The finished picture as PNG, EXR, JPEG or WebP, or the layers for Photoshop",
        has_document,
        |_, requests| requests.request(WindowRequest::ExportDialog),
    ),
    row(
        "Export again",
        &[ctrl_alt_shift(Key::E)],
        "Replaces the file that the document was exported to last, in the same way",
        has_document,
        |_, requests| requests.request(WindowRequest::ExportAgain),
    ),
    row(
        "Export maps…",
        &[],
        "Normals, depth, height, mask and parts of the shape for engines and other programs, as PNG or EXR",
        has_document,
        |_, requests| requests.request(WindowRequest::ExportMapsDialog),
    ),
    row(
        "Export unwrapped…",
        &[],
        "The painting on the unwrapped surface, to paint a pattern over it in another program",
        has_surface,
        |_, requests| requests.request(WindowRequest::ExportUnwrappedDialog),
    ),
    row(
        "Export lines…",
        &[],
        "The lines of the form as paths of an SVG, for other programs",
        has_surface,
        |_, requests| requests.request(WindowRequest::ExportLines),
    ),
    LINE,
    row(
        "Place image…",
        &[ctrl_alt(Key::I)],
        "A picture as a layer bent over the surface",
        has_document,
        |_, requests| requests.request(WindowRequest::PlaceDialog),
    ),
    row(
        "Import unwrapped…",
        &[],
        "A picture of the unwrapped surface as a layer on the surface, placed as it was exported",
        has_surface,
        |_, requests| requests.request(WindowRequest::Choose(FilePurpose::ImportUnwrapped)),
    ),
    LINE,
    row(
        "Close",
        &[ctrl(Key::W)],
        "Closes this document; asks first if there are unsaved changes",
        has_document,
        |session, requests| requests.request(WindowRequest::Close(session.current)),
    ),
    row(
        "Quit",
        &[ctrl(Key::Q)],
        "Quits the program; asks first if there are unsaved changes",
        always,
        |_, requests| requests.request(WindowRequest::Quit),
    ),
];
