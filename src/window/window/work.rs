//! Long work of the window: saving, exporting, flattening edits. It is started here. Not here:
//! opening files (`files`). Floor 7.

use super::MainWindow;
use crate::clipboard::{self, PastedContent};
use crate::dialogs::{Dialog, losses, replace, shape};
use crate::document::{Document, Progress};
use crate::file_purpose::FilePurpose;
use crate::io::replace::FileStamp;
use crate::io::{Budget, Overwrite, Terms};
use crate::jobs::{JobKind, JobResult, JobWindow, PastePlace, PictureUse, short};
use crate::language::tr;
use crate::math::Size;
use crate::pending::{AfterUnsaved, Exporting, ExportingMaps, Pending, Saving};
use crate::raster::Picture;
use crate::raster::picture::Texels;
use crate::saving::WriteResult;
use crate::session::actions::canvas::forget_places;
use crate::session::actions::parts::FirstShape;
use crate::session::actions::{ClipboardAction, PartAction, PasteTo};
use crate::session::{Action, Edit, ExportSettings, ExportedFile, storage};
use crate::tr;
use crate::widgets::bar;
use eframe::egui::{self, Modal};
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl MainWindow {
    /// Saves the document in front to its file, or asks where to. `then` is done once it is saved.
    pub(super) fn save(&mut self, then: Option<AfterUnsaved>) {
        match self
            .session
            .active()
            .and_then(|open| open.file.clone())
            .filter(|file| storage::is_saved_to(file))
        {
            Some(file) => {
                let knows_losses = self.session.active().is_some_and(|open| open.knows_losses);
                self.save_to(file, Overwrite::Nothing, knows_losses, then);
            }
            None => self.save_as(then),
        }
    }

    /// Asks where to.
    pub(super) fn save_as(&mut self, then: Option<AfterUnsaved>) {
        self.after_saving = then;
        self.ask_where(FilePurpose::Save);
    }

    /// `over`: what may be replaced, if that is not the document's own file.
    pub(super) fn save_to(
        &mut self,
        file: PathBuf,
        over: Overwrite,
        knows_losses: bool,
        then: Option<AfterUnsaved>,
    ) {
        self.session.drop_gesture();
        let Some(open) = self.session.active() else { return };
        let (key, document) = (open.key, open.document().clone());
        let knows_losses = knows_losses || storage::is_whole_document(&file);
        let terms = self.session.saving(&file, over);
        self.put(Pending::Save(Box::new(Saving {
            key,
            file,
            document,
            terms,
            knows_losses,
            then,
            encoded: None,
        })));
    }

    /// Writes it, on a thread.
    pub(super) fn put(&mut self, pending: Pending) {
        let name = short(pending.file());
        let name = match &pending {
            Pending::Save(_) => tr!("Saving {file}", file = name),
            Pending::Maps(_) => tr!("Exporting maps {file}", file = name),
            Pending::Export(_) => tr!("Exporting {file}", file = name),
        };
        self.jobs.start(name, JobKind::Working, move |progress| {
            let result = pending.run(progress);
            let is_saved = matches!(result, WriteResult::Saved(..));
            let done = JobResult::then(|window: &mut Self, ctx| window.finish_write(ctx, result));
            if is_saved { done.even_if_canceled() } else { done }
        });
    }

    fn finish_write(&mut self, ctx: &egui::Context, result: WriteResult) {
        match result {
            WriteResult::Saved(saving, stamp) => self.finish_save(ctx, *saving, stamp),
            WriteResult::Loses(saving) => {
                self.dialogs.push(Dialog::Losses(losses::Losses::new(saving)));
            }
            WriteResult::Exported(exporting, notes) => {
                self.jobs.say(tr!("Exported {file}", file = exporting.file.display()));
                self.messages.extend(notes);
                self.remember_export(*exporting);
            }
            WriteResult::ExportedMaps(files) => {
                let folder = files.first().and_then(|file| file.parent()).unwrap_or(Path::new(""));
                let names: Vec<String> = files.iter().map(|file| short(file)).collect();
                self.jobs.say(tr!(
                    "Exported {files} to {folder}",
                    files = names.join(", "),
                    folder = folder.display()
                ));
            }
            WriteResult::Refused(pending, reason) => {
                self.dialogs.push(Dialog::Replace(replace::Replace::new(pending, reason)));
            }
            WriteResult::Canceled => {}
            WriteResult::Failed(error) => self.show_error(&error),
        }
    }

    fn finish_save(&mut self, ctx: &egui::Context, saving: Saving, stamp: FileStamp) {
        let Saving { key, file, document, then, .. } = saving;
        if let Some(open) = self.session.open_documents.iter_mut().find(|other| other.key == key) {
            open.mark_saved(document, file.clone(), stamp);
            open.knows_losses = true;
        }
        self.jobs.say(tr!("Saved {file}", file = file.display()));
        self.recent_is(Some(file));
        if let Some(then) = then {
            self.proceed(ctx, then, false);
        }
    }

    /// `over`: what may be replaced. `is_flat`: as on the unwrapped surface.
    pub(super) fn export_to(&mut self, file: PathBuf, over: Overwrite, is_flat: bool) {
        let settings = self.export.settings_for(&file);
        self.export_as(file, over, settings, is_flat);
    }

    fn export_as(
        &mut self,
        file: PathBuf,
        over: Overwrite,
        settings: ExportSettings,
        is_flat: bool,
    ) {
        let Some(open) = self.session.active() else { return };
        let document = if is_flat { open.drawn_document() } else { open.document().clone() };
        let (key, terms) = (open.key, Terms::export(over, self.session.reads()));
        let unwrapped = is_flat.then(|| self.unwrapped.options(self.session.unwrap_settings()));
        self.put(Pending::Export(Box::new(Exporting {
            key,
            document,
            file,
            settings,
            unwrapped,
            terms,
        })));
    }

    /// What the document in front was exported to last, in this run or an earlier one.
    pub(super) fn last_export(&self) -> Option<ExportedFile> {
        let open = self.session.active()?;
        let stored = || self.settings.exports.of_document(open.file.as_deref()?).cloned();
        open.exported.clone().or_else(stored)
    }

    /// Writes that file again as it is now, or asks how.
    pub(super) fn export_again(&mut self) {
        match self.last_export() {
            Some(ExportedFile { file, settings }) => {
                self.export_as(file, Overwrite::Anything, settings, false);
            }
            None => self.ask_how_to_export(),
        }
    }

    /// The dialog, as the document was exported last.
    pub(super) fn ask_how_to_export(&mut self) {
        if let Some(last) = self.last_export() {
            self.export.take(&last);
        }
        self.dialogs.push(Dialog::Export(self.export.without_estimate()));
    }

    fn remember_export(&mut self, exporting: Exporting) {
        let Exporting { key, file, settings, unwrapped: None, .. } = exporting else { return };
        let exported = ExportedFile { file, settings };
        let mut documents = self.session.open_documents.iter_mut();
        if let Some(open) = documents.find(|open| open.key == key) {
            open.exported = Some(exported.clone());
            if let Some(document) = open.file.clone() {
                self.settings.exports.remember(document, exported);
            }
        }
    }

    /// Files whose names begin with this one.
    pub(super) fn export_maps_to(&mut self, file: PathBuf) {
        let Some(document) = self.session.active().map(|open| open.document().clone()) else {
            return;
        };
        let terms = Terms::export(Overwrite::Nothing, self.session.reads());
        let (maps, options) = (self.maps.maps(), self.maps.options);
        // The name was proposed, and perhaps kept, as that of the first.
        let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let first = maps.first().map_or("", |map| map.name());
        let stem = stem.strip_suffix(first).filter(|stem| !stem.is_empty()).unwrap_or(&stem);
        let file =
            file.with_file_name(format!("{stem}.{}", if options.is_exr { "exr" } else { "png" }));
        self.put(Pending::Maps(Box::new(ExportingMaps { document, file, maps, options, terms })));
    }

    /// Puts what was copied last into the system's clipboard, for other programs.
    pub(super) fn hand_out(&mut self) {
        let Some(copied) = self.session.copied.as_ref().filter(|copied| !copied.rect.is_empty())
        else {
            return;
        };
        if self.handed_out.as_ref().is_some_and(|known| Arc::ptr_eq(known, &copied.rgba)) {
            return;
        }
        let size = Size::new(copied.rect.width() as u32, copied.rect.height() as u32);
        let rgba = copied.rgba.clone();
        self.handed_out = Some(rgba.clone());
        // Without a clipboard it can still be pasted here.
        let put = move |_: &Progress| match clipboard::put(size, &rgba) {
            Ok(clipboard) => JobResult::then(|window: &mut Self, _| {
                window.clipboard = Some(clipboard);
                window.jobs.say(tr("The picture is in the clipboard").into());
            }),
            Err(_) => JobResult::nothing(),
        };
        self.jobs.start(tr("Copying").into(), JobKind::Working, put);
    }

    /// Pastes the system's picture, or what was copied here if that is the same, or there is none;
    /// at the pointer, if that is on the canvas.
    pub(super) fn paste(&mut self, to: PasteTo) {
        let own = self.session.copied.as_ref().map(|copied| copied.rgba.clone());
        let (place, read) = (PastePlace { to, at: self.canvas.under }, self.clipboard_source);
        let paste_own = move |window: &mut Self, _: &egui::Context| window.paste_own(place);
        self.jobs.start(tr("Pasting").into(), JobKind::Working, move |_| match (read(), own) {
            (Ok(PastedContent::Picture(pasted)), Some(own)) if is_own(&pasted.picture, &own) => {
                JobResult::then(paste_own)
            }
            (Ok(PastedContent::Picture(picture)), _) => {
                JobResult::then(move |window: &mut Self, _| window.paste_picture(picture, place))
            }
            (Ok(PastedContent::Files(files)), _) => {
                JobResult::then(move |window: &mut Self, _| match place.to {
                    PasteTo::Document => window.open_files(files, None),
                    PasteTo::Paint | PasteTo::Image => {
                        window.take_files(files, PictureUse::Pasted(place));
                    }
                })
            }
            (Err(_), Some(_)) => JobResult::then(paste_own),
            (Err(error), None) => JobResult::from_error(error),
        });
    }

    /// Pastes what was copied in this window.
    fn paste_own(&mut self, PastePlace { to, at }: PastePlace) {
        self.apply(&Action::Clipboard(match to {
            PasteTo::Paint => ClipboardAction::Paste {},
            PasteTo::Image => ClipboardAction::PasteImage { at },
            PasteTo::Document => ClipboardAction::PasteNew {},
        }));
    }

    /// Whether an action takes long and was therefore started on a thread.
    pub(super) fn begin_edit(&mut self, action: &Action) -> bool {
        if let Action::Part(action) = action {
            return self.begin_shape(action);
        }
        let takes_long = match action {
            Action::Layer(action) => action.takes_long(),
            Action::Canvas(action) => action.takes_long(),
            _ => None,
        };
        let Some(name) = takes_long else { return false };
        self.session.drop_gesture();
        let Some(open) = self.session.active_mut() else { return true };
        open.forget_preview();
        let refusal = match action {
            Action::Layer(action) => action.refusal(open.document()),
            _ => None,
        };
        if let Some(why) = refusal {
            self.session.say(why);
            return true;
        }
        let (key, from, action) = (open.key, open.document().clone(), action.clone());
        self.jobs.start(name.into(), JobKind::Editing, move |progress| {
            let edit = match &action {
                Action::Layer(action) => match action.no_room(&from, &Budget::of_this_machine()) {
                    None => action.perform_long(&from, progress).map(Ok),
                    no_room => no_room.map(Err),
                },
                Action::Canvas(action) => action.long_step(&from, progress),
                _ => None,
            };
            // What follows from it is made here, where it can be canceled, and not when the edit
            // is kept.
            let shaped = |edit: Edit| {
                Some(Edit { document: edit.document.reshaped_with_progress(progress)?, ..edit })
            };
            let edit = match edit {
                Some(Ok(edit)) => shaped(edit).map(Ok),
                other => other,
            };
            match edit {
                Some(Ok(edit)) => JobResult::then(move |window: &mut Self, _| {
                    window.finish_edit(key, action, &from, edit);
                }),
                Some(Err(why)) => JobResult::then(|window: &mut Self, _| window.jobs.say(why)),
                None => JobResult::nothing(),
            }
        });
        true
    }

    /// An edit of a document, by its key, that took long. `from`: what was edited.
    fn finish_edit(&mut self, key: usize, action: Action, from: &Document, edit: Edit) {
        let Some(open) = self.session.open_documents.iter_mut().find(|other| other.key == key)
        else {
            return;
        };
        // No other edits are possible meanwhile; an edit that happened anyway must not be lost.
        if crate::session::is_same(open.document(), from) {
            let note = edit.note;
            open.take(edit);
            if matches!(action, Action::Canvas(_)) {
                forget_places(open);
                self.session.tools.crop.area = None;
            }
            note.into_iter().for_each(|note| self.session.say(note));
            self.did(|| action);
        }
    }

    /// The same for parts.
    fn begin_shape(&mut self, action: &PartAction) -> bool {
        let Some(name) = action.takes_long() else { return false };
        self.session.drop_gesture();
        let Some(open) = self.session.active_mut() else { return true };
        open.forget_preview();
        let (key, from, action) = (open.key, open.document().clone(), action.clone());
        self.jobs.start(name.into(), JobKind::Editing, move |progress| {
            match action.perform_long(&from, progress) {
                Ok(Some(shape)) => JobResult::then(move |window: &mut Self, _| {
                    window.finish_shape(key, action, &from, shape);
                }),
                Ok(None) => JobResult::nothing(),
                Err(why) => JobResult::then(|window: &mut Self, _| window.messages.push(why)),
            }
        });
        true
    }

    /// Looks for the drawing that will get a shape; then a dialog asks which.
    pub(super) fn look_for_drawing(&mut self) {
        let Some(open) = self.session.active() else { return };
        let (key, document, active_layer) = (open.key, open.document().clone(), open.active_layer);
        let look = move |_: &Progress| {
            let found = shape::find_drawing(&document, active_layer);
            JobResult::then(move |window: &mut Self, _| {
                let all = &window.session.open_documents;
                if let Some(open) = all.iter().find(|other| other.key == key) {
                    window.dialogs.push(Dialog::Shape(shape::ShapeDialog::of(open, found)));
                }
            })
            .in_front()
        };
        self.jobs.start(tr("Looking at the drawing").into(), JobKind::Looking, look);
    }

    /// A drawing was given a shape. `from`: the document before.
    fn finish_shape(&mut self, key: usize, action: PartAction, from: &Document, shape: FirstShape) {
        let Some(open) = self.session.open_documents.iter_mut().find(|other| other.key == key)
        else {
            return;
        };
        // As for other long edits.
        if crate::session::is_same(open.document(), from) {
            shape.put(open);
            self.did(|| Action::Part(action));
        }
    }

    /// Shows the edit that blocks others once it takes long.
    pub(super) fn show_editing(&mut self, ctx: &egui::Context) {
        let Some(job) = self.jobs.editing() else { return };
        ctx.request_repaint_after(std::time::Duration::from_millis(60));
        if !job.is_long() {
            return;
        }
        let content = |ui: &mut egui::Ui| {
            ui.set_width(280.0);
            ui.heading(job.title());
            bar(ui, job.share(), 280.0);
            let escape = ui.input(|input| input.key_pressed(egui::Key::Escape));
            ui.button(tr("Cancel")).clicked() || (escape && !ctx.text_edit_focused())
        };
        // A modal would take the keyboard from what is being typed.
        let is_canceled = match ctx.text_edit_focused() {
            true => {
                let area = egui::Area::new(egui::Id::unique("editing while typing"));
                let area = area
                    .anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO)
                    .order(egui::Order::Foreground);
                area.show(ctx, |ui| egui::Frame::popup(ui.style()).show(ui, content).inner).inner
            }
            false => Modal::new(egui::Id::unique("editing")).show(ctx, content).inner,
        };
        if is_canceled {
            job.progress.cancel();
            self.forget_held();
        }
    }
}

/// Whether a picture is the one put there. Clipboards may lose the colors of transparent pixels.
fn is_own(picture: &Picture, rgba: &[u8]) -> bool {
    let Texels::Srgb8(texels) = &picture.texels else { return false };
    let same = |(a, b): (&[u8; 4], &[u8; 4])| a == b || (a[3] == 0 && b[3] == 0);
    texels.len() * 4 == rgba.len() && texels.iter().zip(rgba.as_chunks::<4>().0).all(same)
}
