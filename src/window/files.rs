//! Asking for a file: the system's own dialog, or one of the window where the system has none.
//! Floor 7.

use super::jobs::{Done, Jobs, While};
use crate::io::export::Format;
use crate::session::actions::pictures::Part;
use crate::session::brushes::ENDINGS;
use crate::session::storage::{DOCUMENTS, PICTURES};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What the file is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    Open,
    Place,
    Brush,
    NormalMap,
    DepthMap,
    MaskMap,
    /// A picture that the selected layer is made of.
    Part(Part),
    Save,
    Export,
}

impl Purpose {
    pub fn title(self) -> &'static str {
        match self {
            Purpose::Open => "Open",
            Purpose::Place => "Place an image",
            Purpose::Brush => "Import a brush",
            Purpose::NormalMap => "Normal map",
            Purpose::DepthMap => "Depth map",
            Purpose::MaskMap => "Mask",
            Purpose::Part(part) => part.title(),
            Purpose::Save => "Save as",
            Purpose::Export => "Export the picture",
        }
    }
    pub fn is_saving(self) -> bool {
        matches!(self, Purpose::Save | Purpose::Export)
    }
    /// The endings of files to choose from, each with what they are called together.
    pub fn filters(self) -> Vec<(&'static str, Vec<&'static str>)> {
        let pictures = || PICTURES.to_vec();
        match self {
            Purpose::Open => vec![
                ("Everything that opens", [DOCUMENTS.to_vec(), pictures()].concat()),
                ("Documents", DOCUMENTS.to_vec()),
                ("Pictures and maps", pictures()),
            ],
            Purpose::Brush => vec![("Brushes", ENDINGS.to_vec())],
            Purpose::Place | Purpose::NormalMap | Purpose::DepthMap | Purpose::MaskMap | Purpose::Part(_) => {
                vec![("Pictures", pictures())]
            }
            Purpose::Save => vec![("Documents", DOCUMENTS.to_vec())],
            Purpose::Export => vec![("Pictures", Format::ALL.iter().map(|(_, ending)| *ending).collect())],
        }
    }
}

/// A dialog that comes back this soon without an answer was never shown: there is no portal. Nobody cancels as fast.
const NEVER_SHOWN: Duration = Duration::from_millis(500);

/// What the system's dialog came to.
pub enum Answer {
    File(PathBuf),
    Cancelled,
    /// There is no such dialog here.
    Nowhere,
}

/// Asks with the system's dialog, on another thread. [`Done::Chosen`] with `None` means that there is none, or that the window
/// is to ask `by_itself`.
pub fn ask(jobs: &mut Jobs, purpose: Purpose, name: &str, by_itself: bool) {
    let name = name.to_owned();
    jobs.start(purpose.title().into(), While::Asking, move |_| match answer(purpose, &name, by_itself) {
        Answer::File(file) => Done::Chosen(purpose, Some(file)),
        Answer::Cancelled => Done::Nothing,
        Answer::Nowhere => Done::Chosen(purpose, None),
    });
}

fn answer(purpose: Purpose, name: &str, by_itself: bool) -> Answer {
    if by_itself { Answer::Nowhere } else { system_dialog(purpose, name) }
}

fn system_dialog(purpose: Purpose, name: &str) -> Answer {
    // Elsewhere than on Windows and macOS the dialog is another program's, reached over the session's bus.
    let is_own = cfg!(any(target_os = "windows", target_os = "macos"));
    if !is_own && std::env::var_os("DBUS_SESSION_BUS_ADDRESS").is_none() {
        return Answer::Nowhere;
    }
    let mut dialog = rfd::FileDialog::new().set_title(purpose.title());
    for (label, endings) in purpose.filters() {
        dialog = dialog.add_filter(label, &endings);
    }
    let asked = Instant::now();
    let file = if purpose.is_saving() { dialog.set_file_name(name).save_file() } else { dialog.pick_file() };
    match file {
        Some(file) => Answer::File(file),
        None if asked.elapsed() < NEVER_SHOWN => Answer::Nowhere,
        None => Answer::Cancelled,
    }
}
