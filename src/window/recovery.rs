//! Recovery in the window: keeps logs of the open documents, and offers lost drawings at the start.
//! Floor 7. Another thread reads the logs. Not here: the logs (`session::autosave`).

use super::MainWindow;
use super::dialogs::{Dialog, recovery};
use super::jobs::{JobKind, JobResult};
use crate::Error;
use crate::advice::with_advice;
use crate::document::Progress;
use crate::io::recovery::LostSession;
use crate::language::tr;
use crate::session::Autosave;
use crate::session::autosave::RestoredDocument;
use crate::tr;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

impl MainWindow {
    /// Keeps recovery logs in a folder, and offers lost drawings from it.
    pub fn keep_recovery_in(&mut self, folder: PathBuf) {
        let autosave = Autosave::new(folder);
        let lost = autosave.find_lost_sessions();
        self.session.autosave = Some(autosave);
        // The window opens whatever is in that folder.
        let look = move || catch_unwind(AssertUnwindSafe(|| lost.list())).unwrap_or_default();
        self.jobs.start(
            tr("Looking for unsaved drawings").into(),
            JobKind::Working,
            move |_: &Progress| {
                let lost = look();
                JobResult::then(|window: &mut Self, _| window.offer(lost)).in_front()
            },
        );
    }

    fn offer(&mut self, lost: Vec<LostSession>) {
        if !lost.is_empty() {
            self.dialogs.push(Dialog::Recovery(recovery::RecoveryDialog::new(lost)));
        }
    }

    pub(super) fn recover(&mut self, lost: Vec<LostSession>) {
        self.close_empty_offer();
        for one in lost {
            let Some(autosave) = &self.session.autosave else { return };
            let (bring, title) = (autosave.find_lost_sessions(), one.title.clone());
            self.jobs.start(
                tr!("Recovering {title}", title),
                JobKind::Working,
                move |progress: &Progress| {
                    let found = catch_unwind(AssertUnwindSafe(|| bring.bring_back(one, progress)));
                    match found.unwrap_or_else(|_| Err(damaged_log_error(&title))).transpose() {
                        Some(found) => JobResult::of(found, Self::take_recovered).in_front(),
                        None => JobResult::nothing(),
                    }
                },
            );
        }
    }

    fn take_recovered(&mut self, found: RestoredDocument) {
        let RestoredDocument { open, recovery, tool } = found;
        if let (Some(autosave), Some(recovery)) = (&mut self.session.autosave, recovery) {
            autosave.adopt(&open, recovery);
        }
        self.session.add_document(open);
        self.session.tool = tool.unwrap_or(self.session.tool);
    }

    pub(super) fn delete(&mut self, lost: LostSession) {
        self.close_empty_offer();
        if let Err(error) = lost.discard() {
            self.messages.push(with_advice(&error));
        }
    }

    fn close_empty_offer(&mut self) {
        if let Some(Dialog::Recovery(recovery)) = self.dialogs.last()
            && recovery.is_empty()
        {
            self.dialogs.pop();
        }
    }
}

fn damaged_log_error(title: &str) -> Error {
    Error::decode(title, "its recovery log is damaged in an unexpected way; it was not deleted")
}
