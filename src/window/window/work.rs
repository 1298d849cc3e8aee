//! Long work of the window: saving, exporting, flattening edits. It is started here, and `files` handles the results.
//! Floor 7.

use super::MainWindow;
use crate::clipboard;
use crate::document::flatten;
use crate::files::FilePurpose;
use crate::io::export::ExportOptions;
use crate::jobs::{EditResult, JobKind, JobResult, SaveResult, short};
use crate::session::actions::{LayerAction, files};
use crate::session::{Action, storage};
use crate::widgets::bar;
use eframe::egui::{self, Modal};
use std::path::PathBuf;

impl MainWindow {
    /// Saves the document in front to its file, or asks where to.
    pub(super) fn save(&mut self) {
        match self.session.active().and_then(|tab| tab.file.clone()).filter(|file| storage::is_document(file)) {
            Some(file) => self.save_to(file),
            None => self.ask_where(FilePurpose::Save),
        }
    }
    pub(super) fn save_to(&mut self, file: PathBuf) {
        self.session.drop_gesture();
        let Some(tab) = self.session.active() else { return };
        let (key, document) = (tab.key, tab.document().clone());
        let stamp = tab.stamp.filter(|_| tab.file.as_ref() == Some(&file));
        self.jobs.start(format!("Saving {}", short(&file)), JobKind::Working, move |progress| {
            let stamp = storage::save(&file, &document, stamp, progress);
            JobResult::Saved(Box::new(SaveResult { tab: key, file, document, stamp }))
        });
    }
    pub(super) fn saved(&mut self, ctx: &egui::Context, saved: SaveResult) {
        let SaveResult { tab, file, document, stamp } = saved;
        let then = self.after_saving.take();
        match stamp {
            Ok(Some(stamp)) => {
                if let Some(tab) = self.session.open_documents.iter_mut().find(|other| other.key == tab) {
                    tab.mark_saved(document, file.clone(), stamp);
                }
                self.jobs.say(format!("Saved {}", file.display()));
                self.recent_is(Some(file));
                if let Some(then) = then {
                    self.proceed(ctx, then, false);
                }
            }
            Ok(None) => {}
            Err(error) => self.messages.push(error.to_string()),
        }
    }
    pub(super) fn export_to(&mut self, file: PathBuf) {
        let Some(document) = self.session.active().map(|tab| tab.document().clone()) else { return };
        let options = ExportOptions {
            background: self.export.background,
            quality: self.export.quality,
            ..ExportOptions::default()
        };
        self.jobs.start(format!("Exporting {}", short(&file)), JobKind::Working, move |progress| {
            match files::export(&document, &file, &options, progress) {
                Ok(()) if progress.is_cancelled() => JobResult::Nothing,
                Ok(()) => JobResult::Said(format!("Exported {}", file.display())),
                Err(error) => JobResult::Failed(error),
            }
        });
    }
    pub(super) fn copy_merged(&mut self) {
        let Some(document) = self.session.shown().cloned() else { return };
        self.jobs.start("Copying the picture".into(), JobKind::Working, move |progress| {
            let Some(tiles) = flatten(&document, progress) else { return JobResult::Nothing };
            match clipboard::put(document.size, &tiles.to_straight_rgba(document.size.rect())) {
                Ok(clipboard) => JobResult::Copied(clipboard),
                Err(error) => JobResult::Failed(error),
            }
        });
    }
    pub(super) fn paste(&mut self) {
        self.jobs.start("Pasting".into(), JobKind::Working, |_| match clipboard::pasted() {
            Ok(pasted) => JobResult::Pasted(pasted),
            Err(error) => JobResult::Failed(error),
        });
    }
    /// Whether an action takes long, and was begun on a thread instead.
    pub(super) fn begin_edit(&mut self, action: &Action) -> bool {
        let Action::Layer(action) = action else { return false };
        let Some(name) = action.takes_long() else { return false };
        self.session.drop_gesture();
        let Some(tab) = self.session.active_mut() else { return true };
        tab.forget_preview();
        let (key, from, action) = (tab.key, tab.document().clone(), LayerAction::clone(action));
        self.jobs.start(name.into(), JobKind::Editing, move |progress| match action.flattened(&from, progress) {
            Some(edit) => JobResult::Edited(Box::new(EditResult { tab: key, action, from, edit })),
            None => JobResult::Nothing,
        });
        true
    }
    pub(super) fn edited(&mut self, edited: EditResult) {
        let EditResult { tab, action, from, edit } = edited;
        let Some(tab) = self.session.open_documents.iter_mut().find(|other| other.key == tab) else { return };
        // No other edits are possible meanwhile; an edit that happened anyway must not be lost.
        if crate::session::is_same(tab.document(), &from) {
            tab.take(edit);
            self.did(|| Action::Layer(action));
        }
    }
    /// Shows the edit that blocks others, once it takes long.
    pub(super) fn show_editing(&self, ctx: &egui::Context) {
        let Some(job) = self.jobs.editing() else { return };
        ctx.request_repaint_after(std::time::Duration::from_millis(60));
        if !job.is_long() {
            return;
        }
        Modal::new(egui::Id::unique("editing")).show(ctx, |ui| {
            ui.set_width(280.0);
            ui.heading(&job.name);
            bar(ui, job.share(), 280.0);
            if ui.button("Cancel").clicked() {
                job.progress.cancel();
            }
        });
    }
}
