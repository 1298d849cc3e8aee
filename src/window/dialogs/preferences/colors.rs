//! The page of colors: how they are taken from the canvas. Floor 7.

use super::rows;
use crate::dialogs::DialogContext;
use crate::language::tr;
use crate::preferences::{PickKeys, PreferencePage};
use crate::widgets::{choice_row, title};
use eframe::egui::Ui;

pub fn show(ui: &mut Ui, context: &mut DialogContext) {
    let preferences = &mut context.settings.preferences;
    title(ui, "Taking a color");
    if let Some(keys) = choice_row(ui, "Hold", preferences.pick_keys, &PickKeys::LABELS) {
        preferences.pick_keys = keys;
    }
    ui.weak(tr("While it is held, brush and gradient take a color from the picture. Some window managers keep Alt."));
    rows(ui, PreferencePage::Colors, preferences);
}
