//! Saving, closing and leaving, and what comes in by other doors: dropped files and the clipboard.
//! Floor 7.

use super::Window;
use crate::app::asked::{Asked, WindowAsk};
use crate::app::dialogs::{Dialog, Then, unsaved};
use crate::app::jobs::Where;
use crate::session::storage;
use eframe::egui::{self, ViewportCommand};

impl Window {
    pub(super) fn close(&mut self, ctx: &egui::Context, tab: usize) {
        if self.session.tabs.get(tab).is_some_and(|tab| tab.is_dirty()) {
            self.session.current = tab;
            self.dialogs.push(Dialog::Unsaved(unsaved::Unsaved { tab, then: Then::Close(tab) }));
        } else {
            self.proceed(ctx, Then::Close(tab), false);
        }
    }
    /// After the question about unsaved work. `discarding`: the tab asked about is given up.
    pub(super) fn proceed(&mut self, ctx: &egui::Context, then: Then, discarding: bool) {
        match then {
            Then::Close(tab) => self.session.close_tab(tab),
            Then::Quit => {
                if discarding {
                    self.session.close_tab(self.session.current);
                }
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }
    /// The window is about to be closed: not while there is unsaved work that nobody gave up.
    pub(super) fn guard_leaving(&mut self, ctx: &egui::Context) {
        if self.leaving || !ctx.input(|i| i.viewport().close_requested()) {
            return;
        }
        match self.session.tabs.iter().position(|tab| tab.is_dirty()) {
            Some(tab) => {
                ctx.send_viewport_cmd(ViewportCommand::CancelClose);
                self.session.current = tab;
                self.dialogs.push(Dialog::Unsaved(unsaved::Unsaved { tab, then: Then::Quit }));
            }
            None => self.leaving = true,
        }
    }
    /// Files dropped on the window: pictures go where they fall, all else is opened.
    pub(super) fn take_dropped(&mut self, ctx: &egui::Context, asked: &mut Asked) {
        let dropped = ctx.input(|i| i.raw.dropped_files.clone());
        for file in dropped {
            let path = file.path().to_path_buf();
            match storage::kind_of(&path) {
                Ok(storage::Kind::Picture) if self.session.tab().is_some() => {
                    self.read_picture(path, Where::Pointer);
                }
                Ok(_) => asked.ask(WindowAsk::Open(path)),
                Err(error) => self.messages.push(error.to_string()),
            }
        }
    }
    pub(super) fn paste(&mut self) {
        let pasted = arboard::Clipboard::new().and_then(|mut clipboard| clipboard.get_image());
        let Ok(image) = pasted else {
            return self.messages.push("There is no picture in the clipboard.".into());
        };
        let size = crate::math::Size::new(image.width as u32, image.height as u32);
        let texels = image.bytes.as_chunks::<4>().0.to_vec();
        if let Some(picture) = crate::raster::Picture::srgb8(size, texels) {
            self.pictured("pasted.png", picture, Where::Pointer);
        }
    }
}
