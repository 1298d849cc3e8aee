//! Where the panels stand.
//! Floor 7.

use super::{Front, Window};
use crate::app::asked::Asked;
use crate::app::panels;
use eframe::egui::{self, CentralPanel, Frame, Margin, Panel, RichText, Ui};

impl Window {
    pub(super) fn lay_out(&mut self, ui: &mut Ui, asked: &mut Asked) {
        let bar = |ui: &Ui| Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(6, 3));
        Panel::top("menu").frame(bar(ui)).show(ui, |ui| panels::menu::show(ui, &self.session, &self.recent, asked));
        if !self.panels_hidden {
            Panel::top("options").frame(bar(ui)).show(ui, |ui| panels::options::show(ui, &self.session, asked));
            Panel::bottom("status")
                .frame(bar(ui))
                .show(ui, |ui| panels::status::show(ui, &self.session, &self.canvas, asked));
            Panel::left("tools").exact_size(44.0).resizable(false).frame(bar(ui)).show(ui, |ui| {
                panels::tools::show(ui, &self.session, asked);
            });
            Panel::right("panels").default_size(268.0).size_range(230.0..=460.0).show(ui, |ui| self.side(ui, asked));
        }
        if !self.session.tabs.is_empty() {
            Panel::top("tabs").frame(bar(ui)).show(ui, |ui| panels::menu::tabs(ui, &self.session, asked));
        }
        self.show_messages(ui);
        CentralPanel::no_frame().show(ui, |ui| self.canvas.show(ui, &self.session, &mut asked.actions));
    }
    /// The panels at the right: one of those above, the layers below.
    pub(super) fn side(&mut self, ui: &mut Ui, asked: &mut Asked) {
        Panel::top("front").resizable(true).default_size(330.0).size_range(140.0..=640.0).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                for (front, name) in Front::ALL {
                    ui.selectable_value(&mut self.front, front, name);
                }
            });
            ui.add_space(2.0);
            egui::ScrollArea::vertical().id_salt("front").auto_shrink([false, false]).show(ui, |ui| match self.front {
                Front::Color => panels::colors::show(ui, &self.session, asked),
                Front::Brushes => panels::brushes::show(ui, &self.session, &mut self.swatches, asked),
                Front::Properties => panels::properties::show(ui, &self.session, asked),
                Front::Surface => panels::surface::show(ui, &self.session, asked),
                Front::History => panels::history::show(ui, &self.session, asked),
                Front::Navigator => panels::navigator::show(ui, &self.session, &mut self.canvas, asked),
            });
        });
        CentralPanel::no_frame().show(ui, |ui| {
            ui.add_space(4.0);
            panels::layers::show(ui, &self.session, &mut self.thumbnails, asked);
        });
    }
    pub(super) fn show_messages(&mut self, ui: &mut Ui) {
        if self.messages.is_empty() {
            return;
        }
        let mut read = None;
        Panel::top("messages").show(ui, |ui| {
            for (i, message) in self.messages.iter().enumerate() {
                ui.horizontal_wrapped(|ui| {
                    if ui.button("Dismiss").clicked() {
                        read = Some(i);
                    }
                    ui.label(RichText::new(message).color(ui.visuals().warn_fg_color));
                });
            }
        });
        if let Some(i) = read {
            self.messages.remove(i);
        }
    }
}
