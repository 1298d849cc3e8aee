//! The unwrapped surface: laid flat on a thread, shown once that is done, and pictures of it put
//! back. Floor 7.

use super::MainWindow;
use crate::document::Progress;
use crate::jobs::{JobKind, JobResult, short};
use crate::session::Action;
use crate::session::actions::placing::read_picture;
use crate::session::actions::{FileAction, ViewAction, unwrapped};
use crate::surface::Surface;
use crate::surface::operator::UnwrapSettings;
use crate::surface::unwrap::SOLVES;
use crate::tr;
use std::path::PathBuf;
use std::sync::Arc;

/// The name of the job.
const UNWRAPPING: &str = "Unwrapping the surface";

/// Reports the progress of unwrapping.
fn is_to_go_on(progress: &Progress) -> bool {
    if progress.read().1 == 0 {
        progress.add_total(SOLVES);
    }
    progress.step();
    !progress.is_canceled()
}

impl MainWindow {
    /// Shows the surface of the document in front unwrapped, at once if it is laid flat already.
    pub(super) fn unwrap_surface(&mut self) {
        let settings = self.session.unwrap_settings();
        let Some(open) = self.session.active() else { return };
        let (key, Some(surface)) = (open.key, open.document().surface.clone()) else { return };
        if surface.cached_plane_layout(settings).is_some() {
            return self.show_unwrapped(key);
        }
        self.jobs.start(UNWRAPPING.into(), JobKind::Working, move |progress| {
            let unwrapped = surface.unwrapping_with_progress(settings, &|| is_to_go_on(progress));
            match unwrapped.and_then(|_| surface.plane_layout(settings)) {
                Some(_) => JobResult::then(move |window: &mut Self, _| window.show_unwrapped(key)),
                None => JobResult::nothing(),
            }
        });
    }

    /// A surface was laid flat; if its document is still in front, it is shown so.
    pub(super) fn show_unwrapped(&mut self, key: usize) {
        if self.session.active().is_some_and(|front| front.key == key) {
            self.apply(&Action::View(ViewAction::Unwrapped { on: true }));
        }
    }

    /// Unwraps ahead, on a thread, what will be needed: the surface that is shown unwrapped, if it
    /// was replaced, and the one that the current brush prints on. The user does not wait for what
    /// is not needed yet.
    pub(super) fn unwrap_ahead(&mut self) {
        let Some(open) = self.session.active() else { return };
        let Some(surface) = open.document().surface.clone() else { return };
        let shown = open
            .unwrap_settings()
            .filter(|settings| surface.cached_plane_layout(*settings).is_none());
        let is_shown = shown.is_some();
        let printed = || {
            self.session
                .tools
                .operator
                .unwrapping()
                .filter(|settings| !surface.is_unwrapped(*settings))
        };
        let Some(settings) = shown.or_else(printed) else { return };
        if self.jobs.under_way.iter().any(|job| job.name == UNWRAPPING) {
            return;
        }
        let is_asked = |(asked, with): &(Arc<Surface>, UnwrapSettings)| {
            Arc::ptr_eq(asked, &surface) && *with == settings
        };
        if self.unwrapping.as_ref().is_some_and(is_asked) {
            // It was canceled.
            if is_shown {
                self.apply(&Action::View(ViewAction::Unwrapped { on: false }));
            }
            return;
        }
        self.unwrapping = Some((surface.clone(), settings));
        self.jobs.start(UNWRAPPING.into(), JobKind::Working, move |progress| {
            let unwrapped = surface.unwrapping_with_progress(settings, &|| is_to_go_on(progress));
            if is_shown && unwrapped.is_some() {
                surface.plane_layout(settings);
            }
            JobResult::nothing()
        });
    }

    /// Reads a picture of the surface laid flat.
    pub(super) fn import_unwrapped(&mut self, file: PathBuf) {
        let settings = self.session.unwrap_settings();
        let surface = self.session.active().and_then(|open| open.document().surface.clone());
        self.jobs.start(tr!("Reading {file}", file = short(&file)), JobKind::Working, move |_| {
            let read = read_picture(&file);
            if read.is_ok() {
                // The window must not wait for it.
                surface.and_then(|surface| surface.plane_layout(settings));
            }
            JobResult::of(read, |window: &mut Self, (name, picture)| {
                unwrapped::place(&mut window.session, &name, picture);
                window.session.note_read(&file);
                window.did(|| Action::File(FileAction::ImportUnwrapped { file }));
            })
        });
    }
}
