//! Files of the window's documents: what was opened or chosen, and what a file is proposed to be called.
//! Floor 7.

use super::Window;
use crate::clipboard::Pasted;
use crate::dialogs::{Dialog, import, path};
use crate::files::{self, Purpose};
use crate::jobs::{Done, PartRead, Where, While, short};
use crate::math::Vec2;
use crate::raster::Picture;
use crate::session::Action;
use crate::session::actions::FileAction;
use crate::session::actions::files::place;
use crate::session::actions::pictures::{self, Part};
use crate::session::{brushes, storage};
use eframe::egui;
use std::path::{Path, PathBuf};

impl Window {
    pub(super) fn finish_jobs(&mut self, ctx: &egui::Context) {
        for done in self.jobs.finished() {
            self.finish(ctx, done);
        }
    }
    fn finish(&mut self, ctx: &egui::Context, done: Done) {
        match done {
            Done::Several(several) => several.into_iter().for_each(|done| self.finish(ctx, done)),
            Done::Opened(file, opened) => match *opened {
                Ok(opened) => {
                    self.recent_is(opened.tab.file.clone());
                    self.session.adopt(opened);
                    if let Some(file) = file {
                        self.did(|| Action::File(FileAction::Open { file }));
                    }
                    self.messages.append(&mut self.session.notes);
                }
                Err(error) => self.messages.push(error.to_string()),
            },
            Done::IsDocument(file) => self.jobs.read_document(file),
            Done::IsPicture(file, at) => self.jobs.read_picture(file, at),
            Done::AreMaps(source) => self.dialogs.push(Dialog::Import(Box::new(import::Import::of(*source)))),
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
            Done::Lost(lost) => self.offer(lost),
            Done::Recovered(found) => self.take_recovered(*found),
            Done::Brushes(presets, notes) => {
                brushes::adopt(&mut self.session, presets);
                self.messages.extend(notes);
            }
            Done::Pictured(file, name, picture, at) => {
                let at = self.pictured(&name, picture, at);
                self.did(|| Action::File(FileAction::Place { file, at }));
            }
            Done::Part(read) => {
                let PartRead { tab, layer, part, file, read } = *read;
                if let Some(tab) = self.session.tabs.iter_mut().find(|other| other.key == tab) {
                    pictures::put(tab, layer, read);
                    self.did(|| Action::File(FileAction::Use { part, file }));
                }
            }
            Done::Saved(saved) => self.saved(ctx, *saved),
            Done::Edited(edited) => self.edited(*edited),
            Done::Pasted(Pasted::Picture(picture)) => drop(self.pictured("pasted.png", picture, Where::Pointer)),
            Done::Pasted(Pasted::Files(files)) => self.take_files(files),
            Done::Copied(clipboard) => {
                self.clipboard = Some(clipboard);
                self.jobs.say("The picture is in the clipboard".into());
            }
            Done::Said(sentence) => self.jobs.say(sentence),
            Done::Failed(error) => self.messages.push(error.to_string()),
            Done::Nothing => {}
        }
    }
    /// The user's own brushes are kept here from now on; those that are there join the list.
    pub fn keep_brushes_in(&mut self, folder: PathBuf) {
        self.session.brush_folder = Some(folder.clone());
        self.jobs.start("Reading brushes".into(), While::Working, move |_| {
            let (presets, notes) = brushes::kept(&folder);
            Done::Brushes(presets, notes)
        });
    }
    /// Reads a picture that the selected layer is to be made of.
    fn read_part(&mut self, part: Part, file: PathBuf) {
        let Some((tab, layer)) = self.session.tab().and_then(|tab| Some((tab.key, tab.selected?))) else { return };
        self.jobs.start(format!("Reading {}", short(&file)), While::Working, move |_| {
            match pictures::read(part, &file) {
                Ok(read) => Done::Part(Box::new(PartRead { tab, layer, part, file, read })),
                Err(error) => Done::Failed(error),
            }
        });
    }
    /// A picture becomes a layer. Where it fell is where the pointer is once it was read: while files are dragged the system
    /// tells nobody where they are. Returns the place.
    pub(super) fn pictured(&mut self, name: &str, picture: Picture, at: Where) -> Vec2 {
        let center = self.session.shown().map_or(Vec2::ZERO, |document| document.size.center());
        let at = self.canvas.under.filter(|_| at == Where::Pointer).unwrap_or(center);
        place(&mut self.session, name, picture, at);
        at
    }
    /// A file was chosen in a dialog.
    pub(super) fn chosen(&mut self, purpose: Purpose, file: PathBuf) {
        match purpose {
            Purpose::Open => self.jobs.open(vec![file], None),
            Purpose::Place => {
                self.jobs.read_picture(file, Where::Middle);
            }
            Purpose::Brush => {
                self.apply(&Action::File(FileAction::ImportBrush { file }));
            }
            Purpose::Part(part) => self.read_part(part, file),
            Purpose::NormalMap | Purpose::DepthMap | Purpose::MaskMap => {
                if let Some(import) = self.import() {
                    import.take_file(purpose, file);
                }
            }
            Purpose::Save => self.save_to(storage::with_ending(file)),
            Purpose::Export => {
                let file =
                    if file.extension().is_some() { file } else { file.with_added_extension(self.export.ending) };
                self.export_to(file);
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
        self.ask_for(purpose, &name);
    }
    pub(super) fn ask_for(&mut self, purpose: Purpose, name: &str) {
        files::ask(&mut self.jobs, purpose, name, self.asks_itself);
    }
    /// The name a file is proposed to have.
    pub(super) fn proposed(&self, purpose: Purpose) -> String {
        let title = self.session.tab().map_or_else(String::new, |tab| tab.title());
        let ending = if purpose == Purpose::Export { self.export.ending } else { storage::DOCUMENTS[0] };
        Path::new(&title).with_extension(ending).to_string_lossy().into_owned()
    }
    /// The folder to begin in.
    pub(super) fn folder(&self) -> PathBuf {
        let beside = self.session.tab().and_then(|tab| tab.file.as_deref()).or(self
            .settings
            .recent
            .first()
            .map(PathBuf::as_path));
        let folder = beside.and_then(Path::parent).filter(|folder| folder.is_dir()).map(Path::to_owned);
        folder.or_else(|| std::env::current_dir().ok()).unwrap_or_default()
    }
    pub(super) fn recent_is(&mut self, file: Option<PathBuf>) {
        if let Some(file) = file {
            // As it is found from anywhere, on the next run too.
            self.settings.recent_is(std::path::absolute(&file).unwrap_or(file));
        }
    }
}
