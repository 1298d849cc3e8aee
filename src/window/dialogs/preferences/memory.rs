//! The page of memory: what may be kept for speed, and how much can be undone. Floor 7.

use super::rows;
use crate::dialogs::DialogContext;
use crate::language::tr;
use crate::panels::status::cache_limit;
use crate::preferences::PreferencePage;
use eframe::egui::Ui;

pub fn show(ui: &mut Ui, context: &mut DialogContext) {
    cache_limit(ui, context.memory, context.settings.kept_share, context.requests);
    rows(ui, PreferencePage::Memory, &mut context.settings.preferences);
    ui.weak(tr("What each document takes is among the details in the status bar (Interface)."));
}
