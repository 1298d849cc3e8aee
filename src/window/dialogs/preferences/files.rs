//! The page of files: dialogs, recent files, bookmarks, and where the program keeps things. Floor 7.

use super::rows;
use crate::dialogs::DialogContext;
use crate::language::tr;
use crate::preferences::PreferencePage;
use crate::settings;
use crate::tr;
use crate::widgets::{set_accessible_name, title};
use eframe::egui::{Grid, Ui};

pub fn show(ui: &mut Ui, context: &mut DialogContext) {
    let settings = &mut *context.settings;
    rows(ui, PreferencePage::Files, &mut settings.preferences);
    let can = !settings.recent.is_empty();
    if ui.add_enabled(can, eframe::egui::Button::new(tr("Clear recent files"))).clicked() {
        settings.recent.clear();
    }
    if !settings.bookmarks.is_empty() {
        title(ui, "Bookmarks");
        let mut gone = None;
        for (i, folder) in settings.bookmarks.iter().enumerate() {
            ui.horizontal(|ui| {
                let shown = folder.display().to_string();
                let remove = ui.small_button(tr("Remove"));
                set_accessible_name(&remove, &tr!("Remove the bookmark {folder}", folder = shown));
                if remove.clicked() {
                    gone = Some(i);
                }
                ui.label(shown);
            });
        }
        gone.map(|i| settings.bookmarks.remove(i));
    }
    title(ui, "Recovery");
    ui.label(tr("Every change of a document is recorded at once, and offered after a crash."));
    title(ui, "Where things are kept");
    let places = [
        ("Settings", settings::file()),
        ("Own brushes", settings::brushes()),
        ("Own palettes", settings::palettes()),
        ("Recovery", crate::io::recovery::folder()),
    ];
    Grid::new("places").num_columns(2).spacing([16.0, 4.0]).show(ui, |ui| {
        for (name, place) in places {
            ui.label(tr(name));
            match place {
                Some(place) => ui.weak(place.display().to_string()),
                None => ui.weak(tr("This system has no folder for them")),
            };
            ui.end_row();
        }
    });
}
