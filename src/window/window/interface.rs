//! The look of the window: dark, gray or light, its language, and the size of its controls. Floor 7. Not here: the
//! colors (`theme`).

use super::MainWindow;
use crate::dialogs::Dialog;
use crate::fonts::find_language_font;
use crate::language::{Language, set_language};
use crate::session::Action;
use crate::session::actions::ViewAction;
use crate::theme::SCALES;
use eframe::egui;

/// An unscaled screen of this many points in height is probably dense.
const DENSE_PT: f32 = 1800.0;

impl MainWindow {
    /// The stored look, or one that fits the screen.
    pub(super) fn apply_first_scale(&mut self, ctx: &egui::Context) {
        if std::mem::replace(&mut self.has_first_scale, true) {
            return;
        }
        let screen = ctx.input(|i| i.viewport().monitor_size);
        let fitting = if screen.is_some_and(|size| size.y >= DENSE_PT) { 1.5 } else { 1.0 };
        self.show_at(ctx, self.settings.scale.unwrap_or(fitting));
    }

    /// Speaks the language that the user chose, or else the system's, if its letters can be shown.
    pub(super) fn follow_language(&mut self, ctx: &egui::Context) {
        let wanted = self.settings.language.or(self.system_language).unwrap_or_default();
        let can = !wanted.is_written_in_han() || find_language_font(wanted).is_some();
        let language = if can { wanted } else { Language::default() };
        set_language(language);
        let has_list = matches!(self.dialogs.last(), Some(Dialog::Preferences(_)));
        self.fonts.follow(ctx, language, has_list);
    }

    pub(super) fn show_next_look(&mut self, ctx: &egui::Context) {
        self.settings.look = self.settings.look.next();
        self.settings.look.show(ctx);
    }

    /// Selects and stores the next larger or smaller size.
    pub(super) fn resize_interface(&mut self, ctx: &egui::Context, is_larger: bool) {
        let now = ctx.zoom_factor();
        let next = if is_larger {
            SCALES.into_iter().find(|&scale| scale > now + 0.01)
        } else {
            SCALES.into_iter().rev().find(|&scale| scale < now - 0.01)
        };
        if let Some(next) = next {
            self.scale_interface(ctx, next);
        }
    }

    /// Selects and stores a size.
    pub(super) fn scale_interface(&mut self, ctx: &egui::Context, scale: f32) {
        self.settings.scale = Some(scale);
        self.show_at(ctx, scale);
    }

    /// The picture keeps its size on screen: only the controls change.
    fn show_at(&mut self, ctx: &egui::Context, scale: f32) {
        let kept = ctx.zoom_factor() / scale;
        ctx.set_zoom_factor(scale);
        for view in self.session.open_documents.iter_mut().filter_map(|open| open.view.as_mut()) {
            view.zoom *= kept;
        }
    }

    /// 0 fits the canvas; 1 is one pixel of the screen per pixel of the canvas.
    pub(super) fn scale(&mut self, ctx: &egui::Context, scale: f32) {
        let action = if scale > 0.0 {
            ViewAction::ZoomTo { zoom: scale / ctx.pixels_per_point() }
        } else {
            ViewAction::Fit { window_pt: self.canvas.area_pt }
        };
        self.apply(&Action::View(action));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::language;

    #[test]
    fn the_window_speaks_the_language_of_the_settings_and_english_without_one() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("settings.json");
        let cases = [("de", Language::German), ("xx", Language::English), ("", Language::English)];
        for (code, wanted) in cases {
            std::fs::write(&file, format!("{{\"language\": \"{code}\"}}")).unwrap();
            let window = MainWindow::remembering(&egui::Context::default(), Some(file.clone()));
            assert_eq!(language(), wanted, "{code}");
            assert_eq!(window.settings.language.is_some(), code == "de");
        }
        // The user's choice counts before the system's.
        let ctx = egui::Context::default();
        let mut window = MainWindow::new(&ctx);
        window.system_language = Some(Language::French);
        window.follow_language(&ctx);
        assert_eq!(language(), Language::French);
        window.settings.language = Some(Language::Spanish);
        window.follow_language(&ctx);
        assert_eq!(language(), Language::Spanish);
        MainWindow::new(&ctx);
        assert_eq!(language(), Language::English, "a window without settings");
    }
}
