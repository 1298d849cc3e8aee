//! Files of the window's documents: handles what was opened or chosen, and proposes file names.
//! Floor 7.

use super::MainWindow;
use crate::advice::with_advice;
use crate::clipboard::PastedContent;
use crate::dialogs::{Dialog, import, losses, path, replace, shape};
use crate::document::SurfaceSource;
use crate::document::parts::drawing::DrawingTraits;
use crate::file_purpose::FilePurpose;
use crate::files;
use crate::io::Overwrite;
use crate::io::maps::ImportedSurface;
use crate::jobs::{JobKind, JobResult, PartResult, PastePlace, PictureUse, PinPosition, short};
use crate::math::Vec2;
use crate::raster::Picture;
use crate::session::Action;
use crate::session::PicturePart;
use crate::session::actions::pictures;
use crate::session::actions::placing::place;
use crate::session::actions::unwrapped;
use crate::session::actions::{ClipboardAction, FileAction, PasteTo, PastedPicture};
use crate::session::{Session, brushes, storage};
use eframe::egui;
use std::path::{Path, PathBuf};

/// What to do with maps.
type GiveMaps = fn(&mut Session, &SurfaceSource, ImportedSurface) -> crate::Result<()>;

impl MainWindow {
    pub(super) fn finish_jobs(&mut self, ctx: &egui::Context) {
        for done in self.results(ctx) {
            self.finish(ctx, done);
        }
    }

    fn finish(&mut self, ctx: &egui::Context, done: JobResult) {
        match done {
            JobResult::Several(several) => {
                several.into_iter().for_each(|done| self.finish(ctx, done))
            }
            JobResult::Opened(file, opened) => match *opened {
                Ok(opened) => {
                    self.recent_is(opened.open.file.clone());
                    let drawing = opened.drawing.filter(DrawingTraits::has_outline);
                    self.session.adopt(opened);
                    if let (Some(look), Some(open)) = (drawing, self.session.active()) {
                        self.dialogs
                            .push(Dialog::Shape(shape::ShapeDialog::of_picture(open, look)));
                    }
                    if let Some(file) = file {
                        self.did(|| Action::File(FileAction::Open { file }));
                    }
                    self.tell_notes();
                }
                Err(error) => self.messages.push(with_advice(&error)),
            },
            JobResult::IsDocument(file) => self.jobs.read_document(file),
            JobResult::IsPicture(file, use_of) => self.jobs.read_picture(file, use_of),
            JobResult::AreMaps(source) => {
                self.dialogs.push(Dialog::Import(Box::new(import::ImportDialog::of(*source))))
            }
            JobResult::Read(read) => {
                if let Some(import) = self.import() {
                    import.take(ctx, *read);
                }
            }
            JobResult::Chosen(purpose, Some(file)) => self.chosen(purpose, file),
            JobResult::Chosen(purpose, None) => {
                let folder = self.folder();
                let name = if purpose.is_saving() { self.proposed(purpose) } else { String::new() };
                let dialog = path::PathDialog::new(purpose, folder, &name, self.export.extension);
                self.dialogs.push(Dialog::Path(dialog));
            }
            JobResult::Lost(lost) => self.offer(lost),
            JobResult::Recovered(found) => self.take_recovered(*found),
            JobResult::Brushes(presets, notes) => {
                brushes::adopt(&mut self.session, presets);
                self.messages.extend(notes);
            }
            JobResult::Pictured(file, name, picture, PictureUse::Pasted(place)) => {
                self.pasted(PastedPicture { name, picture }, place);
                self.session.note_read(&file);
            }
            JobResult::Pictured(file, name, picture, PictureUse::Placed(at)) => {
                let at = self.pictured(&name, picture, at);
                self.session.note_read(&file);
                self.did(|| Action::File(FileAction::Place { file, at }));
            }
            JobResult::Flat(file, name, picture) => {
                unwrapped::place(&mut self.session, &name, picture);
                self.session.note_read(&file);
                self.did(|| Action::File(FileAction::ImportUnwrapped { file }));
            }
            JobResult::Unwrapped(key) => self.unwrapped(key),
            JobResult::Part(read) => {
                let PartResult { key, layer, part, file, read } = *read;
                if let Some(open) =
                    self.session.open_documents.iter_mut().find(|other| other.key == key)
                {
                    pictures::put(open, layer, read);
                    open.reads.push(file.clone());
                    self.did(|| Action::File(FileAction::Use { part, file }));
                }
            }
            JobResult::Saved(saving, stamp) => self.saved(ctx, *saving, stamp),
            JobResult::Loses(saving) => {
                self.dialogs.push(Dialog::Losses(losses::Losses::new(saving)))
            }
            JobResult::Exported(file, notes) => self.exported(&file, notes),
            JobResult::ExportedMaps(files) => {
                let folder = files.first().and_then(|file| file.parent()).unwrap_or(Path::new(""));
                let names: Vec<String> = files.iter().map(|file| short(file)).collect();
                self.jobs.say(format!("Exported {} to {}", names.join(", "), folder.display()));
            }
            JobResult::Refused(pending, reason) => {
                self.dialogs.push(Dialog::Replace(replace::Replace::new(pending, reason)));
            }
            JobResult::Edited(edited) => self.edited(*edited),
            JobResult::Shaped(shaped) => self.shaped(*shaped),
            JobResult::Declined(why) => self.messages.push(why.into()),
            JobResult::Looked(key, found) => {
                if let Some(open) =
                    self.session.open_documents.iter().find(|other| other.key == key)
                {
                    self.dialogs.push(Dialog::Shape(shape::ShapeDialog::of(open, found)));
                }
            }
            JobResult::Said(why) => self.jobs.say(why),
            JobResult::Pasted(PastedContent::Picture(picture), place) => {
                self.pasted(picture, place)
            }
            JobResult::Pasted(PastedContent::Files(files), place) => match place.to {
                PasteTo::Document => self.jobs.open(files, None),
                PasteTo::Paint | PasteTo::Image => {
                    self.take_files(files, PictureUse::Pasted(place))
                }
            },
            JobResult::PastedOwn(PastePlace { to, at }) => {
                self.apply(&Action::Clipboard(match to {
                    PasteTo::Paint => ClipboardAction::Paste {},
                    PasteTo::Image => ClipboardAction::PasteImage { at },
                    PasteTo::Document => ClipboardAction::PasteNew {},
                }))
            }
            JobResult::Copied(clipboard) => {
                self.clipboard = Some(clipboard);
                self.jobs.say("The picture is in the clipboard".into());
            }
            JobResult::Failed(error) => self.messages.push(with_advice(&error)),
            JobResult::Nothing => {}
        }
    }

    /// The user's own brushes are kept here from now on; existing ones are added to the list.
    pub fn keep_brushes_in(&mut self, folder: PathBuf) {
        self.session.brush_folder = Some(folder.clone());
        self.jobs.start("Reading brushes".into(), JobKind::Working, move |_| {
            let (presets, notes) = brushes::kept(&folder);
            JobResult::Brushes(presets, notes)
        });
    }

    /// Reads a picture for the selected layer.
    fn read_part(&mut self, part: PicturePart, file: PathBuf) {
        let Some((key, layer)) =
            self.session.active().and_then(|open| Some((open.key, open.selected?)))
        else {
            return;
        };
        self.jobs.start(format!("Reading {}", short(&file)), JobKind::Working, move |_| {
            match pictures::read(part, &file) {
                Ok(read) => JobResult::Part(Box::new(PartResult { key, layer, part, file, read })),
                Err(error) => JobResult::Failed(error),
            }
        });
    }

    /// A picture becomes a layer. It goes to the pointer's place once it was read: the system does
    /// not report positions of dragged files. Returns the position.
    pub(super) fn pictured(&mut self, name: &str, picture: Picture, at: PinPosition) -> Vec2 {
        let center = self.session.shown().map_or(Vec2::ZERO, |document| document.size.center());
        let at = self.canvas.under.filter(|_| at == PinPosition::Pointer).unwrap_or(center);
        place(&mut self.session, name, picture, at);
        at
    }

    /// A picture of another program is pasted.
    fn pasted(&mut self, picture: PastedPicture, PastePlace { to, at }: PastePlace) {
        self.apply(&Action::Clipboard(ClipboardAction::PastePicture { picture, to, at }));
    }

    /// A file was chosen in a dialog.
    pub(super) fn chosen(&mut self, purpose: FilePurpose, file: PathBuf) {
        match purpose {
            FilePurpose::Open => self.jobs.open(vec![file], None),
            FilePurpose::Place => {
                self.jobs.read_picture(file, PictureUse::Placed(PinPosition::Middle));
            }
            FilePurpose::ImportUnwrapped => self.import_unwrapped(file),
            FilePurpose::Brush => {
                self.apply(&Action::File(FileAction::ImportBrush { file }));
            }
            FilePurpose::Part(part) => self.read_part(part, file),
            FilePurpose::NormalMap | FilePurpose::DepthMap | FilePurpose::MaskMap => {
                if let Some(import) = self.import() {
                    import.take_file(purpose, file);
                }
            }
            FilePurpose::ExportMaps => self.export_maps_to(file),
            FilePurpose::Save | FilePurpose::Export | FilePurpose::ExportUnwrapped => {
                self.chosen_to_write(purpose, file);
            }
        }
    }

    /// A file was chosen to be written. Where it is there the dialog asked about it, unless it gets
    /// another name here. Gives the document in front maps, as another dialog asked.
    pub(super) fn take_maps(
        &mut self,
        (source, import): (SurfaceSource, ImportedSurface),
        give: GiveMaps,
    ) {
        let done = give(&mut self.session, &source, import);
        self.messages.extend(done.err().map(|error| with_advice(&error)));
        self.tell_notes();
    }

    fn chosen_to_write(&mut self, purpose: FilePurpose, file: PathBuf) {
        let named = purpose.named(file.clone(), self.export.extension);
        let was_asked = named == file && named.exists();
        let over = if was_asked { Overwrite::Anything } else { Overwrite::Nothing };
        if purpose == FilePurpose::Save {
            let then = self.after_saving.take();
            self.save_to(named, over, false, then);
        } else {
            self.export_to(named, over, purpose == FilePurpose::ExportUnwrapped);
        }
    }

    /// The import dialog, if it is open.
    pub(super) fn import(&mut self) -> Option<&mut import::ImportDialog> {
        self.dialogs.iter_mut().rev().find_map(|dialog| match dialog {
            Dialog::Import(import) => Some(&mut **import),
            _ => None,
        })
    }

    pub(super) fn ask_where(&mut self, purpose: FilePurpose) {
        let name = self.proposed(purpose);
        self.ask_for(purpose, &name);
    }

    pub(super) fn ask_for(&mut self, purpose: FilePurpose, name: &str) {
        files::request(&mut self.jobs, purpose, name, self.asks_itself);
    }

    /// The proposed name of a file.
    pub(super) fn proposed(&self, purpose: FilePurpose) -> String {
        let title = self.session.active().map_or_else(String::new, |open| open.title());
        let stem = storage::without_ending(&title);
        if purpose == FilePurpose::ExportUnwrapped {
            return format!("{stem}-unwrapped.png");
        }
        let extension = match purpose {
            FilePurpose::Export => self.export.extension,
            FilePurpose::ExportMaps if self.maps.options.is_exr => "exr",
            FilePurpose::ExportMaps => "png",
            _ => storage::SAVED[0],
        };
        // For several files the name of the first, so that the user sees what the names will be.
        let suffix = match purpose {
            FilePurpose::ExportMaps => self.maps.maps().first().map_or("", |map| map.name()),
            _ => "",
        };
        format!("{stem}{suffix}.{extension}")
    }

    /// The folder to begin in.
    pub(super) fn folder(&self) -> PathBuf {
        let beside = self.session.active().and_then(|open| open.file.as_deref()).or(self
            .settings
            .recent
            .first()
            .map(PathBuf::as_path));
        let folder =
            beside.and_then(Path::parent).filter(|folder| folder.is_dir()).map(Path::to_owned);
        folder.or_else(|| std::env::current_dir().ok()).unwrap_or_default()
    }

    pub(super) fn recent_is(&mut self, file: Option<PathBuf>) {
        if let Some(file) = file {
            // An absolute path, which is also valid in the next run.
            self.settings.recent_is(std::path::absolute(&file).unwrap_or(file));
        }
    }
}
