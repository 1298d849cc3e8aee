//! Closing documents, quitting, and dropped files.
//! Floor 7.

use super::MainWindow;
use crate::dialogs::{Dialog, unsaved};
use crate::jobs::{PictureUse, PinPosition};
use crate::pending::AfterUnsaved;
use crate::session::Action;
use crate::session::actions::FileAction;
use eframe::egui::{self, ViewportCommand};
use std::path::PathBuf;
use std::sync::mpsc::Receiver;

impl MainWindow {
    pub(super) fn close(&mut self, ctx: &egui::Context, index: usize) {
        if self.session.open_documents.get(index).is_some_and(|open| open.is_dirty()) {
            self.session.current = index;
            self.dialogs.push(Dialog::Unsaved(unsaved::UnsavedDialog {
                index,
                then: AfterUnsaved::Close(index),
            }));
        } else {
            self.proceed(ctx, AfterUnsaved::Close(index), false);
        }
    }

    /// After the question about unsaved work. `discarding`: the changes of the document are discarded.
    pub(super) fn proceed(&mut self, ctx: &egui::Context, then: AfterUnsaved, discarding: bool) {
        match then {
            AfterUnsaved::Close(index) => self.apply(&Action::File(FileAction::Close { index })),
            AfterUnsaved::Quit => {
                if discarding {
                    self.session.close_document(self.session.current);
                }
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    /// The window is about to close: it stays open while there is unsaved work.
    pub(super) fn guard_leaving(&mut self, ctx: &egui::Context) {
        if self.leaving || !ctx.input(|i| i.viewport().close_requested()) {
            return;
        }
        match self.session.open_documents.iter().position(|open| open.is_dirty()) {
            Some(index) => {
                ctx.send_viewport_cmd(ViewportCommand::CancelClose);
                self.session.current = index;
                self.dialogs.push(Dialog::Unsaved(unsaved::UnsavedDialog {
                    index,
                    then: AfterUnsaved::Quit,
                }));
            }
            None => self.leaving = true,
        }
    }

    /// Files dropped on the window: pictures go where they were dropped, all else is opened.
    pub(super) fn take_dropped(&mut self, ctx: &egui::Context) {
        let dropped: Vec<_> = ctx
            .input(|i| i.raw.dropped_files.iter().map(|file| file.path().to_path_buf()).collect());
        if !dropped.is_empty() {
            self.take_files(dropped, PictureUse::Placed(PinPosition::Pointer));
        }
    }

    /// From now on opens files that come from elsewhere, and comes in front each time.
    pub fn open_what_comes(&mut self, files: Receiver<Vec<PathBuf>>) {
        self.other_starts = Some(files);
    }

    /// Opens the files that other starts of the program named.
    pub(super) fn take_other_starts(&mut self, ctx: &egui::Context) {
        while let Some(Ok(files)) = self.other_starts.as_ref().map(Receiver::try_recv) {
            ctx.send_viewport_cmd(ViewportCommand::Minimized(false));
            ctx.send_viewport_cmd(ViewportCommand::Focus);
            self.begin(files);
        }
    }

    /// Opens files; pictures become layers of the document in front, if there is one.
    pub(super) fn take_files(&mut self, files: Vec<PathBuf>, use_of: PictureUse) {
        self.open_files(files, self.session.active().map(|_| use_of));
    }
}
