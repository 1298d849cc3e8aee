//! Files of the window's documents: what was opened or chosen, and what a file is proposed to be called.
//! Floor 7.

use super::Window;
use crate::app::dialogs::{Dialog, import, path};
use crate::app::files::{self, Purpose};
use crate::app::jobs::Done;
use crate::math::Vec2;
use crate::session::actions::FileAction;
use crate::session::{Action, storage};
use eframe::egui;
use std::path::{Path, PathBuf};

impl Window {
    pub(super) fn finish_jobs(&mut self, ctx: &egui::Context) {
        for done in self.jobs.finished() {
            match done {
                Done::Opened(opened) => match *opened {
                    Ok(opened) => {
                        self.recent_is(opened.tab.file.clone());
                        self.session.adopt(opened);
                        self.messages.append(&mut self.session.notes);
                    }
                    Err(error) => self.messages.push(error.to_string()),
                },
                Done::IsMap(file) => {
                    let import = import::Import::of(Some(&file));
                    self.dialogs.push(Dialog::Import(Box::new(import)));
                }
                Done::Read(found) => {
                    if let Some(import) = self.import() {
                        import.take(ctx, *found);
                    }
                }
                Done::Chosen(purpose, Some(file)) => self.chosen(purpose, file),
                Done::Chosen(purpose, None) => {
                    let folder = self.folder();
                    let name = if purpose.is_saving() { self.proposed(purpose) } else { String::new() };
                    self.dialogs.push(Dialog::Path(path::PathDialog::new(purpose, folder, &name)));
                }
                Done::Cancelled => {}
            }
        }
    }
    /// A file was chosen in a dialog.
    pub(super) fn chosen(&mut self, purpose: Purpose, file: PathBuf) {
        match purpose {
            Purpose::Open => self.jobs.open(file),
            Purpose::Place => {
                let at = self.session.shown().map_or(Vec2::ZERO, |document| document.size.center());
                self.apply(&Action::File(FileAction::Place { file, at }));
            }
            Purpose::NormalMap | Purpose::DepthMap | Purpose::MaskMap => {
                if let Some(import) = self.import() {
                    import.take_file(purpose, file);
                }
            }
            Purpose::Save => {
                let file = storage::with_ending(file);
                if self.apply(&Action::File(FileAction::Save { file: file.clone() })) {
                    self.recent_is(Some(file));
                }
            }
            Purpose::Export => {
                let file =
                    if file.extension().is_some() { file } else { file.with_added_extension(self.export.ending) };
                let (background, quality) = (self.export.background, self.export.quality);
                self.apply(&Action::File(FileAction::Export { file, background, quality }));
            }
        }
    }
    /// The import dialog, where it is open.
    pub(super) fn import(&mut self) -> Option<&mut import::Import> {
        self.dialogs.iter_mut().rev().find_map(|dialog| match dialog {
            Dialog::Import(import) => Some(&mut **import),
            _ => None,
        })
    }
    pub(super) fn ask_where(&mut self, purpose: Purpose) {
        let name = self.proposed(purpose);
        files::ask(&mut self.jobs, purpose, &name);
    }
    /// The name a file is proposed to have.
    pub(super) fn proposed(&self, purpose: Purpose) -> String {
        let title = self.session.tab().map_or_else(String::new, |tab| tab.title());
        let ending = if purpose == Purpose::Export { self.export.ending } else { storage::DOCUMENTS[0] };
        Path::new(&title).with_extension(ending).to_string_lossy().into_owned()
    }
    /// The folder to begin in.
    pub(super) fn folder(&self) -> PathBuf {
        let beside =
            self.session.tab().and_then(|tab| tab.file.as_deref()).or(self.recent.first().map(PathBuf::as_path));
        let folder = beside.and_then(Path::parent).filter(|folder| folder.is_dir()).map(Path::to_owned);
        folder.or_else(|| std::env::current_dir().ok()).unwrap_or_default()
    }
    pub(super) fn recent_is(&mut self, file: Option<PathBuf>) {
        let Some(file) = file else { return };
        self.recent.retain(|known| *known != file);
        self.recent.insert(0, file);
        self.recent.truncate(12);
    }
}
