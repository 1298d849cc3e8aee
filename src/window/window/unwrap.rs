//! The unwrapped surface: laid flat on a thread, shown once that is done, and pictures of it brought back.
//! Floor 7.

use super::MainWindow;
use crate::jobs::{JobKind, JobResult, short};
use crate::session::Action;
use crate::session::actions::ViewAction;
use crate::session::actions::files::read_picture;
use std::path::PathBuf;
use std::sync::Arc;

impl MainWindow {
    /// Shows the surface of the document in front unwrapped, at once where it is laid flat already.
    pub(super) fn unwrap_surface(&mut self) {
        let settings = self.session.unwrap_settings();
        let Some(tab) = self.session.active() else { return };
        let (key, Some(surface)) = (tab.key, tab.document().surface.clone()) else { return };
        if surface.known_plane_layout(settings).is_some() {
            return self.unwrapped(key);
        }
        self.jobs.start("Unwrapping the surface".into(), JobKind::Working, move |_| {
            surface.plane_layout(settings);
            JobResult::Unwrapped(key)
        });
    }
    /// A surface was laid flat; if its tab is still in front, it is shown so.
    pub(super) fn unwrapped(&mut self, tab: usize) {
        if self.session.active().is_some_and(|front| front.key == tab) {
            self.apply(&Action::View(ViewAction::Unwrapped { on: true }));
        }
    }
    /// Where the surface that is shown unwrapped is another one by now, it is laid flat anew, once.
    pub(super) fn keep_unwrapped(&mut self) {
        let Some(tab) = self.session.active() else { return };
        let (Some(settings), Some(surface)) = (tab.unwrapped(), tab.document().surface.clone()) else { return };
        let is_asked = self.unwrapping.as_ref().is_some_and(|asked| Arc::ptr_eq(asked, &surface));
        if is_asked || surface.known_plane_layout(settings).is_some() {
            return;
        }
        self.unwrapping = Some(surface.clone());
        self.jobs.start("Unwrapping the surface".into(), JobKind::Working, move |_| {
            surface.plane_layout(settings);
            JobResult::Nothing
        });
    }
    /// Reads a picture of the surface laid flat.
    pub(super) fn import_unwrapped(&mut self, file: PathBuf) {
        let settings = self.session.unwrap_settings();
        let surface = self.session.active().and_then(|tab| tab.document().surface.clone());
        self.jobs.start(format!("Reading {}", short(&file)), JobKind::Working, move |_| match read_picture(&file) {
            Ok((name, picture)) => {
                // The window must not wait for it.
                surface.and_then(|surface| surface.plane_layout(settings));
                JobResult::Flat(file, name, picture)
            }
            Err(error) => JobResult::Failed(error),
        });
    }
}
