//! Pins references: files, or what is in the clipboard. Floor 7. Not here: how they are shown
//! (`references`).

use super::MainWindow;
use crate::clipboard::PastedContent;
use crate::document::Progress;
use crate::io::fs::Disk;
use crate::io::picture;
use crate::io::platform::{SystemTime, UNIX_EPOCH, files};
use crate::io::replace::{Overwrite, replace};
use crate::jobs::{JobKind, JobResult};
use crate::language::tr;
use crate::requests::UiRequests;
use crate::tools::ToolKind;
use crate::{Error, Result};
use eframe::egui;
use std::path::{Path, PathBuf};

impl MainWindow {
    /// References that are pasted are kept as files in this folder from now on.
    pub fn keep_references_in(&mut self, folder: PathBuf) {
        self.reference_folder = Some(folder);
    }

    /// Shows a file over the canvas.
    pub(super) fn pin_reference(&mut self, file: PathBuf) {
        self.settings.layout.hides_references = false;
        self.settings.references.pin(file);
    }

    /// Shows what is in the clipboard over the canvas: its files, or its picture.
    pub(super) fn paste_reference(&mut self) {
        let (read, folder) = (self.clipboard_source, self.reference_folder.clone());
        self.jobs.start(tr("Pasting").into(), JobKind::Working, move |_| {
            let files = read().and_then(|pasted| files_of(pasted, folder.as_deref()));
            JobResult::of(files, |window: &mut Self, files: Vec<PathBuf>| {
                files.into_iter().for_each(|file| window.pin_reference(file));
            })
        });
    }

    /// The pictures over the canvas, while a document is open that they are looked at for.
    pub(super) fn show_references(
        &mut self,
        ctx: &egui::Context,
        area: egui::Rect,
        requests: &mut UiRequests,
    ) {
        if self.settings.layout.hides_references || self.session.active().is_none() {
            return;
        }
        let keys = ctx.input(|input| input.modifiers);
        let is_picking = self.settings.preferences.pick_keys.are_held(keys)
            || self.session.tool == ToolKind::Eyedropper;
        let pins = &mut self.settings.references;
        self.references.show(ctx, area, pins, is_picking, requests);
    }
}

/// The files in the clipboard, or a new one with its picture.
fn files_of(pasted: PastedContent, folder: Option<&Path>) -> Result<Vec<PathBuf>> {
    let pasted = match pasted {
        PastedContent::Files(files) => return Ok(files),
        PastedContent::Picture(pasted) => pasted,
    };
    let nowhere = || Error::invalid("clipboard", "picture", "there is no folder to keep it in");
    let folder = folder.ok_or_else(nowhere)?;
    let (bytes, extension) = picture::encode(Path::new("clipboard"), &pasted.picture)?;
    files::create_dir_all(folder).map_err(|error| Error::io(folder, error))?;
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_micros();
    let file = folder.join(format!("pasted-{now:016x}.{extension}"));
    replace(&Disk, &file, bytes.bytes(), &Overwrite::Nothing.into(), &Progress::default())?;
    Ok(vec![file])
}
