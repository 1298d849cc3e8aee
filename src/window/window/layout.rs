//! The layout of the panels: next to the canvas, together in a window, or each in its own. Floor 7.
//! Not here: the panels themselves (`panels`).

use super::MainWindow;
use crate::panel_layout::PanelKind;
use crate::panel_layout::PanelSide;
use crate::panels;
use crate::requests::UiRequests;
use crate::theme::ACCENT;
use eframe::egui::{self, CentralPanel, Frame, Id, Margin, Panel, RichText, Ui};

/// The range of the panels' width, points.
const WIDTHS_PT: std::ops::RangeInclusive<f32> = 230.0..=460.0;

impl MainWindow {
    pub(super) fn lay_out(&mut self, ui: &mut Ui, requests: &mut UiRequests) {
        let bar = |ui: &Ui| Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(6, 3));
        let settings = &self.settings;
        // In full screen hidden panels leave nothing but the picture.
        let is_bare =
            settings.layout.is_hidden && ui.input(|i| i.viewport().fullscreen.unwrap_or(false));
        if !is_bare {
            Panel::top("menu")
                .frame(bar(ui))
                .show(ui, |ui| panels::menu::show(ui, &self.session, settings, requests));
        }
        if !self.settings.layout.is_hidden {
            // Always as tall as its two rows, so that nothing below it moves when its content
            // changes.
            let rows_pt = panels::options::ROWS * ui.spacing().interact_size.y
                + (panels::options::ROWS - 1.0) * ui.spacing().item_spacing.y;
            Panel::top("options")
                .exact_size(rows_pt + 6.0)
                .frame(bar(ui))
                .show(ui, |ui| panels::options::show(ui, &self.session, requests));
            let memory = (&mut self.memory, self.settings.kept_share);
            Panel::bottom("status").frame(bar(ui)).show(ui, |ui| {
                panels::status::show(ui, &self.session, &self.canvas, &self.jobs, memory, requests)
            });
            let keymap = &self.settings.keymap;
            let tools_pt = panels::tools::width_pt(ui) + 12.0;
            Panel::left("tools").exact_size(tools_pt).resizable(false).frame(bar(ui)).show(
                ui,
                |ui| {
                    panels::tools::show(ui, &self.session, keymap, requests);
                },
            );
            self.side(ui, requests);
            self.show_floating(ui.ctx(), requests);
        }
        if !self.session.open_documents.is_empty() && !is_bare {
            Panel::top("tabs")
                .frame(bar(ui))
                .show(ui, |ui| panels::menu::tabs(ui, &self.session, requests));
        }
        CentralPanel::no_frame().show(ui, |ui| {
            let area = ui.max_rect();
            self.canvas.show(ui, &self.session, &mut requests.actions);
            panels::text::type_on_canvas(ui, &self.session, requests);
            self.show_steps(ui);
            self.show_messages(ui.ctx(), area);
            show_hovered(ui, area, self.session.active().is_some());
        });
    }

    /// The panels that are together.
    fn side(&mut self, ui: &mut Ui, requests: &mut UiRequests) {
        let side = self.settings.layout.side;
        let beside = match side {
            PanelSide::Left => Panel::left("panels left"),
            PanelSide::Right => Panel::right("panels right"),
            PanelSide::Floating => {
                let window =
                    egui::Window::new("Panels").id(Id::unique("panels apart")).constrain(true);
                let corner = ui.max_rect().right_top() + egui::vec2(-310.0, 60.0);
                let window = window.default_pos(corner).min_size([230.0, 300.0]);
                let window = window.default_size([self.settings.layout.width_pt, 640.0]);
                return drop(window.show(ui.ctx(), |ui| self.together(ui, requests)));
            }
        };
        let beside = beside.default_size(self.settings.layout.width_pt).size_range(WIDTHS_PT);
        let shown = beside.show(ui, |ui| self.together(ui, requests));
        self.settings.layout.width_pt = shown.response.rect.width().round();
    }

    /// The panel in front above, the layers below.
    fn together(&mut self, ui: &mut Ui, requests: &mut UiRequests) {
        let floating = &self.settings.layout.floating;
        let strip: Vec<_> = PanelKind::ALL
            .into_iter()
            .filter(|(front, _)| !front.is_below() && !floating.contains(front))
            .collect();
        let front = match self.settings.layout.front {
            front if strip.iter().any(|(known, _)| *known == front) => Some(front),
            _ => strip.first().map(|(front, _)| *front),
        };
        let below: Vec<_> = PanelKind::ALL
            .into_iter()
            .filter(|(panel, _)| panel.is_below() && !floating.contains(panel))
            .collect();
        let has_below = !below.is_empty();
        if let Some(front) = front {
            if has_below {
                let above = Panel::top("front")
                    .resizable(true)
                    .default_size(372.0)
                    .size_range(140.0..=640.0);
                // Aligned on the left with the layers beneath.
                let above =
                    above.frame(Frame::new().inner_margin(Margin { bottom: 4, ..Margin::ZERO }));
                above.show(ui, |ui| self.fronted(ui, &strip, front, requests));
            } else {
                self.fronted(ui, &strip, front, requests);
            }
        }
        if has_below {
            CentralPanel::no_frame().show(ui, |ui| {
                ui.add_space(2.0);
                self.below(ui, &below, requests);
            });
        }
    }

    /// The layers or the shape.
    fn below(&mut self, ui: &mut Ui, strip: &[(PanelKind, &str)], requests: &mut UiRequests) {
        let known =
            strip.iter().find(|(panel, _)| *panel == self.settings.layout.below).or(strip.first());
        let Some(&(front, _)) = known else { return };
        self.settings.layout.below = self.tabs(ui, strip, front);
        let front = self.settings.layout.below;
        ui.add_space(2.0);
        self.panel(ui, front, requests);
    }

    /// The tabs of the panels that share the area, and the one in front.
    fn fronted(
        &mut self,
        ui: &mut Ui,
        strip: &[(PanelKind, &str)],
        front: PanelKind,
        requests: &mut UiRequests,
    ) {
        let front = self.tabs(ui, strip, front);
        self.settings.layout.front = front;
        ui.add_space(2.0);
        let area = egui::ScrollArea::vertical().id_salt("front").auto_shrink([false, false]);
        area.show(ui, |ui| self.panel(ui, front, requests));
    }

    /// The names of panels that share an area, and which of them is in front.
    fn tabs(
        &mut self,
        ui: &mut Ui,
        strip: &[(PanelKind, &str)],
        mut front: PanelKind,
    ) -> PanelKind {
        let mut gone = None;
        ui.horizontal_wrapped(|ui| {
            for &(choice, name) in strip {
                let open = ui.selectable_value(&mut front, choice, name);
                let open = open.on_hover_text("Right-click for a window of its own");
                open.context_menu(|ui| {
                    if ui.button("In a window of its own").clicked() {
                        gone = Some(choice);
                        ui.close();
                    }
                });
            }
        });
        self.settings.layout.floating.extend(gone);
        front
    }

    fn panel(&mut self, ui: &mut Ui, front: PanelKind, requests: &mut UiRequests) {
        match front {
            PanelKind::Color => panels::colors::show(ui, &self.session, requests),
            PanelKind::Brushes => {
                panels::brushes::show(ui, &self.session, &mut self.swatches, requests)
            }
            PanelKind::Properties => {
                panels::properties::show(ui, &self.session, &mut self.thumbnails.moods, requests)
            }
            PanelKind::Surface => panels::surface::show(ui, &self.session, requests),
            PanelKind::History => panels::history::show(ui, &self.session, requests),
            PanelKind::Navigator => {
                panels::navigator::show(ui, &self.session, &mut self.canvas, requests)
            }
            PanelKind::Layers => {
                panels::layers::show(ui, &self.session, &mut self.thumbnails, requests)
            }
            PanelKind::Shape => {
                panels::shape::show(ui, &self.session, &mut self.thumbnails.parts, requests)
            }
        }
    }

    /// The panels in windows of their own; closing one puts it back.
    fn show_floating(&mut self, ctx: &egui::Context, requests: &mut UiRequests) {
        for (i, front) in self.settings.layout.floating.clone().into_iter().enumerate() {
            let mut is_open = true;
            // Over the canvas, so that none covers its former place.
            let corner = ctx.content_rect().center()
                + egui::vec2(-160.0, -220.0)
                + egui::Vec2::splat(26.0 * i as f32);
            let window = egui::Window::new(front.name()).id(Id::unique(("panel", front.name())));
            let window = window
                .default_size([268.0, 340.0])
                .min_size([230.0, 160.0])
                .default_pos(corner)
                .open(&mut is_open);
            let area = |ui: &mut Ui| {
                let area =
                    egui::ScrollArea::vertical().id_salt(front.name()).auto_shrink([false, false]);
                area.show(ui, |ui| self.panel(ui, front, requests));
            };
            window.show(ctx, area);
            if !is_open {
                self.settings.layout.floating.retain(|other| *other != front);
            }
        }
    }

    /// Errors, over the top of the canvas, which does not move.
    fn show_messages(&mut self, ctx: &egui::Context, canvas: egui::Rect) {
        if self.messages.is_empty() {
            return;
        }
        let (mut read, mut all_read) = (None, false);
        let area = egui::Area::new(Id::unique("messages"))
            .order(egui::Order::Foreground)
            .fixed_pos(canvas.left_top());
        area.show(ctx, |ui| {
            Frame::popup(ui.style()).corner_radius(0).show(ui, |ui| {
                ui.set_width(canvas.width() - 14.0);
                let area = egui::ScrollArea::vertical().max_height(canvas.height() * 0.25);
                area.auto_shrink([false, true]).show(ui, |ui| {
                    for (i, message) in self.messages.iter().enumerate() {
                        ui.horizontal_wrapped(|ui| {
                            if ui.button("Dismiss").clicked() {
                                read = Some(i);
                            }
                            ui.label(RichText::new(message).color(ui.visuals().warn_fg_color));
                        });
                    }
                });
                all_read = self.messages.len() > 2 && ui.button("Dismiss all").clicked();
            });
        });
        read.map(|i| self.messages.remove(i));
        if all_read {
            self.messages.clear();
        }
    }
}

/// What will happen to files dragged over the window.
fn show_hovered(ui: &Ui, area: egui::Rect, has_document: bool) {
    if ui.input(|i| i.raw.hovered_files.is_empty()) {
        return;
    }
    let picture =
        if has_document { "a picture becomes a layer at the pointer" } else { "a picture opens" };
    let text = format!("Drop: {picture}, maps become a new document, a project opens");
    let painter = ui.painter_at(area);
    painter.rect_filled(area, 0.0, egui::Color32::from_black_alpha(90));
    painter.rect_stroke(
        area.shrink(6.0),
        6.0,
        egui::Stroke::new(2.0, ACCENT),
        egui::StrokeKind::Inside,
    );
    let font = egui::TextStyle::Heading.resolve(ui.style());
    painter.text(area.center(), egui::Align2::CENTER_CENTER, text, font, egui::Color32::WHITE);
}
