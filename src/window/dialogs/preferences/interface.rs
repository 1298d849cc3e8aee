//! The page of the interface: its theme, language and size, the menus, and where panels are. Floor 7.

use super::rows;
use crate::dialogs::DialogContext;
use crate::fonts;
use crate::language::{Language, tr};
use crate::panel_layout::{PanelSide, SIDES};
use crate::preferences::PreferencePage;
use crate::requests::WindowRequest;
use crate::theme::{Look, SCALES};
use crate::widgets::{check, choice_row, name, set_accessible_name, title};
use eframe::egui::{Button, ComboBox, FontId, Ui};

pub fn show(ui: &mut Ui, context: &mut DialogContext) {
    title(ui, "Look");
    let settings = &mut *context.settings;
    if let Some(look) = choice_row(ui, "Theme", settings.look, &Look::ALL) {
        settings.look = look;
        look.show(ui.ctx());
    }
    ui.weak(tr("Gray is for judging colors."));
    language_row(ui, &mut settings.language);
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

/// The language of the window: the system's, or one by its own name.
fn language_row(ui: &mut Ui, language: &mut Option<Language>) {
    fonts::search_language_fonts(ui.ctx());
    ui.horizontal(|ui| {
        name(ui, "Language");
        ui.spacing_mut().combo_width = ui.available_width();
        let shown = language.map_or(tr("System"), |language| own_name(ui, language));
        let combo = ComboBox::from_id_salt("Language").selected_text(shown).show_ui(ui, |ui| {
            let hint = tr("The language of the system, if the window speaks it; else English");
            ui.selectable_value(language, None, tr("System")).on_hover_text(hint);
            for (choice, _) in Language::ALL {
                let button = Button::selectable(*language == Some(choice), own_name(ui, choice));
                let can = fonts::can_show(choice) == Some(true);
                let why = tr("No installed font has its letters. Noto Sans CJK has them");
                if ui.add_enabled(can, button).on_disabled_hover_text(why).clicked() {
                    *language = Some(choice);
                }
            }
        });
        set_accessible_name(&combo.response, tr("Language"));
    });
}

/// The name that a language has for itself; if it has letters that no font has, the English one.
fn own_name(ui: &Ui, language: Language) -> &'static str {
    let own = language.label();
    if ui.fonts_mut(|fonts| fonts.has_glyphs(&FontId::default(), own)) {
        return own;
    }
    match language {
        Language::Japanese => tr("Japanese"),
        Language::Chinese => tr("Chinese"),
        _ => own,
    }
}
