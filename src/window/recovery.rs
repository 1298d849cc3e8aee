//! Recovery in the window: the open documents have logs, and what an accident left is offered at the start.
//! Floor 7. Logs are `session::autosave`'s; everything that reads one happens on another thread.

use super::Window;
use super::dialogs::{Dialog, recovery};
use super::jobs::{Done, While};
use crate::document::Progress;
use crate::io::recovery::Session as Lost;
use crate::session::Autosave;
use crate::session::autosave::Found;
use crate::{Error, Result};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

impl Window {
    /// Keeps recovery logs in a folder, and offers what accidents left there.
    pub fn keep_recovery_in(&mut self, folder: PathBuf) {
        let autosave = Autosave::new(folder);
        let lost = autosave.lost();
        self.session.autosave = Some(autosave);
        // Whatever is in that folder, the window opens.
        let look = move || catch_unwind(AssertUnwindSafe(|| lost.list())).unwrap_or_default();
        self.jobs.start("Looking for unsaved drawings".into(), While::Working, move |_: &Progress| Done::Lost(look()));
    }
    pub(super) fn offer(&mut self, lost: Vec<Lost>) {
        if !lost.is_empty() {
            self.dialogs.push(Dialog::Recovery(recovery::Recovery::new(lost)));
        }
    }
    pub(super) fn recover(&mut self, lost: Vec<Lost>) {
        self.close_empty_offer();
        for one in lost {
            let Some(autosave) = &self.session.autosave else { return };
            let (bring, title) = (autosave.lost(), one.title.clone());
            self.jobs.start(format!("Recovering {title}"), While::Working, move |_: &Progress| {
                let found = catch_unwind(AssertUnwindSafe(|| bring.bring_back(one)));
                Done::Recovered(Box::new(found.unwrap_or_else(|_| Err(broken(&title)))))
            });
        }
    }
    pub(super) fn take_recovered(&mut self, found: Result<Found>) {
        match found {
            Ok(Found { tab, recovery }) => {
                if let (Some(autosave), Some(recovery)) = (&mut self.session.autosave, recovery) {
                    autosave.adopt(&tab, recovery);
                }
                self.session.add_tab(tab);
            }
            Err(error) => self.messages.push(error.to_string()),
        }
    }
    pub(super) fn delete(&mut self, lost: Lost) {
        self.close_empty_offer();
        if let Err(error) = lost.discard() {
            self.messages.push(error.to_string());
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

fn broken(title: &str) -> Error {
    Error::decode(
        title,
        "its recovery log is broken in a way that this program does not expect; it was left where it is",
    )
}
