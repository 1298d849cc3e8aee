//! The preferences: everything that is set once and kept from run to run, by page. Each change counts
//! at once. Floor 7. Not here: what there is (`preferences`), the file (`settings`).

mod colors;
mod files;
mod interface;
mod keys;
mod memory;
mod pen;

use super::{DialogAnswer, DialogContext, close, set_width};
use crate::language::tr;
use crate::preferences::{PreferencePage, Preferences};
use crate::widgets::{NumberField, check};
use eframe::egui::{Align, Layout, Ui, vec2};

/// The height of a page, points.
const PAGE_PT: f32 = 440.0;
const WIDTH_PT: f32 = 640.0;
const NAMES_PT: f32 = 92.0;

pub struct PreferencesDialog {
    page: PreferencePage,
    keys: keys::KeysPage,
    pen: pen::PenPage,
}

impl PreferencesDialog {
    pub fn at(page: PreferencePage) -> Self {
        Self { page, keys: keys::KeysPage::default(), pen: pen::PenPage::default() }
    }

    pub fn show(&mut self, ui: &mut Ui, context: &mut DialogContext) -> DialogAnswer {
        set_width(ui, WIDTH_PT);
        ui.heading(tr("Preferences"));
        let height = PAGE_PT.min((ui.ctx().content_rect().height() - 140.0).max(160.0));
        ui.allocate_ui_with_layout(
            vec2(WIDTH_PT, height),
            Layout::left_to_right(Align::Min),
            |ui| {
                ui.vertical(|ui| {
                    ui.set_width(NAMES_PT);
                    for (page, name) in PreferencePage::ALL {
                        ui.selectable_value(&mut self.page, page, tr(name));
                    }
                });
                ui.separator();
                ui.vertical(|ui| {
                    ui.set_min_height(height);
                    ui.set_max_width(ui.available_width());
                    self.page(ui, context);
                });
            },
        );
        close(ui)
    }

    fn page(&mut self, ui: &mut Ui, context: &mut DialogContext) {
        match self.page {
            PreferencePage::Interface => interface::show(ui, context),
            PreferencePage::Keys => self.keys.show(ui, &mut context.settings.keymap),
            PreferencePage::Pen => self.pen.show(ui, context),
            PreferencePage::Colors => colors::show(ui, context),
            PreferencePage::Files => files::show(ui, context),
            PreferencePage::Memory => memory::show(ui, context),
        }
    }
}

/// What is on or off, and the numbers, of one page.
fn rows(ui: &mut Ui, page: PreferencePage, all: &mut Preferences) {
    for flag in Preferences::FLAGS.iter().filter(|flag| flag.page == page) {
        if let Some(on) = check(ui, flag.label, flag.hint, (flag.get)(all)) {
            (flag.set)(all, on);
        }
    }
    for (_, number) in Preferences::NUMBERS.iter().filter(|(of, _)| *of == page) {
        let field = NumberField::new(number.label, number.range.clone(), number.hint).decimals(0);
        if let Some(changed) = field.row(ui, (number.get)(all)) {
            number.put(all, changed.to);
        }
    }
}
