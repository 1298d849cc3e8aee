//! The page of the interface: its theme and size, the menus, and where panels are. Floor 7.

use super::rows;
use crate::dialogs::DialogContext;
use crate::panel_layout::{PanelSide, SIDES};
use crate::preferences::PreferencePage;
use crate::requests::WindowRequest;
use crate::theme::{Look, SCALES};
use crate::widgets::{check, choice_row, title};
use eframe::egui::Ui;

pub fn show(ui: &mut Ui, context: &mut DialogContext) {
    title(ui, "Look");
    let settings = &mut *context.settings;
    if let Some(look) = choice_row(ui, "Theme", settings.look, &Look::ALL) {
        settings.look = look;
        look.show(ui.ctx());
    }
    ui.weak("Gray is for judging colors.");
    let now = ui.ctx().zoom_factor();
    let names = SCALES.map(|scale| format!("{:.0} %", scale * 100.0));
    let sizes: Vec<(f32, &str)> =
        SCALES.into_iter().zip(names.iter().map(String::as_str)).collect();
    if let Some(scale) = choice_row(ui, "Size", now, &sizes) {
        context.requests.request(WindowRequest::ScaleInterface(scale));
    }
    title(ui, "Panels");
    let sides: Vec<(PanelSide, &str)> = SIDES
        .into_iter()
        .map(|(side, name)| match side {
            PanelSide::Floating => (side, "in a window"),
            _ => (side, name),
        })
        .collect();
    if let Some(side) = choice_row(ui, "Place", settings.layout.side, &sides) {
        settings.layout.side = side;
    }
    title(ui, "Menus and controls");
    let hint = "The normal and depth under the pointer, the memory of the document, and the time of the last redraw";
    if let Some(on) = check(ui, "Details in the status bar", hint, settings.has_details) {
        settings.has_details = on;
    }
    rows(ui, PreferencePage::Interface, &mut settings.preferences);
}
