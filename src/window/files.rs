//! File dialogs: the system's own, or the window's if the system has none.
//! Floor 7.

use super::jobs::{JobKind, JobResult, Jobs};
use crate::session::PicturePart;
use crate::session::brushes::EXTENSIONS;
use crate::session::storage::{DOCUMENTS, PICTURES, SAVED, exported, with_document_extension};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What the file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePurpose {
    Open,
    Place,
    ImportUnwrapped,
    Brush,
    NormalMap,
    DepthMap,
    MaskMap,
    /// A picture of the selected layer.
    Part(PicturePart),
    Save,
    Export,
    /// Maps of the shape, whose names begin with this one.
    ExportMaps,
    ExportUnwrapped,
}

/// Endings of maps of the shape.
const MAPS: [&str; 2] = ["png", "exr"];

impl FilePurpose {
    /// What pictures of the unwrapped surface are written to.
    const FLAT: [&'static str; 4] = ["png", "tif", "tiff", "exr"];

    pub fn title(self) -> &'static str {
        match self {
            FilePurpose::Open => "Open",
            FilePurpose::Place => "Place an image",
            FilePurpose::ImportUnwrapped => "Import a picture of the surface laid flat",
            FilePurpose::Brush => "Import a brush",
            FilePurpose::NormalMap => "Normal map",
            FilePurpose::DepthMap => "Depth map",
            FilePurpose::MaskMap => "Mask",
            FilePurpose::Part(part) => part.label(),
            FilePurpose::Save => "Save as",
            FilePurpose::Export => "Export the picture",
            FilePurpose::ExportMaps => "Export maps of the shape",
            FilePurpose::ExportUnwrapped => "Export the surface laid flat",
        }
    }
    pub fn is_saving(self) -> bool {
        matches!(self, FilePurpose::Save | FilePurpose::Export | FilePurpose::ExportMaps | FilePurpose::ExportUnwrapped)
    }
    /// The extensions of files to choose from, with the name of each group.
    pub fn filters(self) -> Vec<(&'static str, Vec<&'static str>)> {
        let pictures = || PICTURES.to_vec();
        match self {
            FilePurpose::Open => vec![
                ("Everything that opens", [DOCUMENTS.to_vec(), pictures()].concat()),
                ("Documents", DOCUMENTS.to_vec()),
                ("Pictures and maps", pictures()),
            ],
            FilePurpose::Brush => vec![("Brushes", EXTENSIONS.to_vec())],
            FilePurpose::Place
            | FilePurpose::ImportUnwrapped
            | FilePurpose::NormalMap
            | FilePurpose::DepthMap
            | FilePurpose::MaskMap
            | FilePurpose::Part(_) => {
                vec![("Pictures", pictures())]
            }
            FilePurpose::Save => vec![("Documents", SAVED.to_vec())],
            FilePurpose::Export => vec![("Pictures", exported().collect())],
            FilePurpose::ExportMaps => vec![("Maps", MAPS.to_vec())],
            FilePurpose::ExportUnwrapped => vec![("Pictures", Self::FLAT.to_vec())],
        }
    }
    /// What a chosen file will be called. `extension`: of exports that have none.
    pub fn named(self, file: PathBuf, extension: &str) -> PathBuf {
        match self {
            FilePurpose::Save => with_document_extension(file, SAVED[0], &SAVED),
            FilePurpose::ExportMaps => with_document_extension(file, MAPS[0], &MAPS),
            FilePurpose::Export => with_document_extension(file, extension, &exported().collect::<Vec<_>>()),
            FilePurpose::ExportUnwrapped => with_document_extension(file, Self::FLAT[0], &Self::FLAT),
            _ => file,
        }
    }
}

/// A dialog that returns this soon without an answer was never shown, because there is no portal. Nobody cancels that
/// fast.
const NEVER_SHOWN: Duration = Duration::from_millis(500);

/// The result of the system's dialog.
pub enum FileAnswer {
    File(PathBuf),
    Cancelled,
    /// There is no such dialog here.
    Nowhere,
}

/// Asks with the system's dialog, on another thread. [`JobResult::Chosen`] with `None` means that there is none, or
/// that the window should show its own (`by_itself`).
pub fn request(jobs: &mut Jobs, purpose: FilePurpose, name: &str, by_itself: bool) {
    let name = name.to_owned();
    jobs.start(purpose.title().into(), JobKind::Asking, move |_| match answer(purpose, &name, by_itself) {
        FileAnswer::File(file) => JobResult::Chosen(purpose, Some(file)),
        FileAnswer::Cancelled => JobResult::Nothing,
        FileAnswer::Nowhere => JobResult::Chosen(purpose, None),
    });
}

fn answer(purpose: FilePurpose, name: &str, by_itself: bool) -> FileAnswer {
    if by_itself { FileAnswer::Nowhere } else { system_dialog(purpose, name) }
}

fn system_dialog(purpose: FilePurpose, name: &str) -> FileAnswer {
    // Except on Windows and macOS, the dialog is another program's, reached over the session bus.
    let is_own = cfg!(any(target_os = "windows", target_os = "macos"));
    if !is_own && std::env::var_os("DBUS_SESSION_BUS_ADDRESS").is_none() {
        return FileAnswer::Nowhere;
    }
    let mut dialog = rfd::FileDialog::new().set_title(purpose.title());
    for (label, extensions) in purpose.filters() {
        dialog = dialog.add_filter(label, &extensions);
    }
    let asked = Instant::now();
    let file = if purpose.is_saving() { dialog.set_file_name(name).save_file() } else { dialog.pick_file() };
    match file {
        Some(file) => FileAnswer::File(file),
        None if asked.elapsed() < NEVER_SHOWN => FileAnswer::Nowhere,
        None => FileAnswer::Cancelled,
    }
}
