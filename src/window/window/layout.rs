//! The layout of the panels: next to the canvas, together in a window, or each in its own. Floor 7.
//! Not here: the panels themselves (`panels`).

use super::{MainWindow, drawer};
use crate::jobs::JobKind;
use crate::keys;
use crate::language::tr;
use crate::panel_layout::PanelKind;
use crate::panel_layout::PanelSide;
use crate::panels;
use crate::panels::start::StartPictures;
use crate::requests::UiRequests;
use crate::theme::ACCENT;
use crate::tr;
use crate::widgets::{tab, tab_width_pt};
use eframe::egui::{
    self, CentralPanel, Frame, Id, Margin, Panel, Ui, ViewportBuilder, ViewportId, WindowLevel,
};

/// The height that the layers take at first, if there is room: more than six of them.
const LAYERS_PT: f32 = 384.0;
/// The least height of the brushes at first, and the share of the panels that they take in a window
/// that is taller than wide, as a tablet's: two rows of them.
const BRUSHES_PT: f32 = 104.0;
const UPRIGHT_BRUSHES: f32 = 0.4;
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
            let by_alt = settings.preferences.alt_opens_menus && self.dialogs.is_empty();
            self.menu.keys.listen(ui, by_alt);
            let menu = &mut self.menu;
            Panel::top("menu")
                .frame(bar(ui))
                .show(ui, |ui| panels::menu::show(ui, &self.session, settings, menu, requests));
        }
        if !self.settings.layout.is_hidden {
            // Always as tall, so that nothing below it moves when its content changes.
            Panel::top("options")
                .exact_size(panels::options::HEIGHT_PT + 6.0)
                .frame(bar(ui))
                .show(ui, |ui| panels::options::show(ui, &self.session, requests));
            let details = self.settings.has_details.then_some(&mut self.memory);
            let memory = (details, self.settings.kept_share);
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
            if !drawer::is_narrow(ui.ctx()) {
                self.side(ui, requests);
            }
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
            // What was asked for comes soon.
            let is_coming = self.jobs.under_way.iter().any(|job| job.kind == JobKind::Working);
            if self.session.open_documents.is_empty() && !is_coming {
                let about = (&*self.settings.recent, &self.settings.keymap);
                let pictures =
                    StartPictures { files: &mut self.menu.pictures, samples: &mut self.samples };
                panels::start::show(ui, area, about, pictures, requests);
            }
            self.show_references(ui.ctx(), area, requests);
            panels::text::type_on_canvas(ui, &self.session, requests);
            if drawer::is_narrow(ui.ctx()) && !self.settings.layout.is_hidden {
                self.show_drawer(ui, requests);
            }
            self.show_steps(ui, requests);
            self.messages.show(ui.ctx(), area);
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
                let size_pt = [self.settings.layout.width_pt, 640.0];
                let place = ui.max_rect().right_top() + egui::vec2(-310.0, 60.0);
                let apart = ApartWindow {
                    name: "Panels",
                    size_pt,
                    place,
                    is_enabled: self.dialogs.is_empty(),
                };
                let mut is_open = true;
                apart.show(ui.ctx(), &mut is_open, |ui, is_own| {
                    self.show_panels(ui, requests);
                    self.hear_keys_apart(ui, is_own, requests);
                });
                if !is_open {
                    self.settings.layout.side = PanelSide::Right;
                }
                return;
            }
        };
        let beside = beside.default_size(self.settings.layout.width_pt).size_range(WIDTHS_PT);
        let shown = beside.show(ui, |ui| self.show_panels(ui, requests));
        self.settings.layout.width_pt = shown.response.rect.width().round();
    }

    /// The color, the panel in front, the layers below.
    pub(super) fn show_panels(&mut self, ui: &mut Ui, requests: &mut UiRequests) {
        let floating = &self.settings.layout.floating;
        let shown = |is_below: bool| -> Vec<_> {
            let among = PanelKind::ALL.into_iter();
            let among = among.filter(|(panel, _)| panel.is_tab() && panel.is_below() == is_below);
            among.filter(|(panel, _)| !floating.contains(panel)).collect()
        };
        let (strip, below) = (shown(false), shown(true));
        let has_color = !floating.contains(&PanelKind::Color);
        let height_pt = ui.available_height();
        if has_color {
            ui.add_space(7.0);
            // Never so large that brushes and layers have no room.
            let area_pt = (0.4 * height_pt - 186.0).max(58.0).min(190.0);
            panels::colors::show_area(
                ui,
                &self.session,
                &mut self.settings.color,
                area_pt,
                requests,
            );
            ui.separator();
        }
        let front = match self.settings.layout.front {
            front if strip.iter().any(|(known, _)| *known == front) => Some(front),
            _ => strip.first().map(|(front, _)| *front),
        };
        let has_below = !below.is_empty();
        if let Some(front) = front {
            if has_below {
                let left_pt = ui.available_height();
                // Brushes leave room for the layers; properties and lists are longer.
                let window = ui.ctx().content_rect();
                let least_pt = match window.height() > window.width() {
                    true => (UPRIGHT_BRUSHES * left_pt).max(BRUSHES_PT),
                    false => BRUSHES_PT,
                };
                let (front_pt, of) = match front {
                    PanelKind::Brushes => ((left_pt - LAYERS_PT).max(least_pt), "brushes"),
                    _ => (0.56 * left_pt, "properties"),
                };
                // Each height of the window has divisions of its own.
                let above = Panel::top(Id::unique((of, (height_pt / 24.0) as i32)))
                    .resizable(true)
                    .default_size(front_pt)
                    .size_range(100.0..=(left_pt - 120.0).max(101.0));
                // Aligned on the left with the layers beneath.
                let above =
                    above.frame(Frame::new().inner_margin(Margin { bottom: 4, ..Margin::ZERO }));
                above.show(ui, |ui| self.show_front(ui, &strip, front, requests));
            } else {
                self.show_front(ui, &strip, front, requests);
            }
        }
        if has_below {
            CentralPanel::no_frame().show(ui, |ui| {
                ui.add_space(2.0);
                self.show_lower_panels(ui, &below, requests);
            });
        }
    }

    /// The layers or the shape.
    fn show_lower_panels(
        &mut self,
        ui: &mut Ui,
        strip: &[(PanelKind, &str)],
        requests: &mut UiRequests,
    ) {
        let known =
            strip.iter().find(|(panel, _)| *panel == self.settings.layout.below).or(strip.first());
        let Some(&(front, _)) = known else { return };
        self.settings.layout.below = self.tabs(ui, strip, front);
        let front = self.settings.layout.below;
        ui.add_space(2.0);
        self.panel(ui, front, requests);
    }

    /// The tabs of the panels that share the area, and the one in front.
    fn show_front(
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

    /// The names of panels that share an area, and which of them is in front. In one row: without
    /// room for all names, only the one in front shows its own.
    fn tabs(
        &mut self,
        ui: &mut Ui,
        strip: &[(PanelKind, &str)],
        mut front: PanelKind,
    ) -> PanelKind {
        let mut gone = None;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            let room_pt = ui.available_width();
            let needed = |has_icon| -> f32 {
                strip.iter().map(|(_, name)| tab_width_pt(ui, has_icon, tr(name))).sum()
            };
            let (fits_icons, fits) = (needed(true) <= room_pt, needed(false) <= room_pt);
            for &(choice, name) in strip {
                let name = tr(name);
                let is_on = choice == front;
                let icon = Some(choice.icon()).filter(|_| fits_icons || !fits);
                let open = tab(ui, icon, name, fits || is_on, is_on);
                if open.clicked() {
                    front = choice;
                }
                let open =
                    open.on_hover_text(tr!("{name}\nRight-click for a window of its own", name));
                open.context_menu(|ui| {
                    if ui.button(tr("In a window of its own")).clicked() {
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
            PanelKind::Color => {
                panels::colors::show(ui, &self.session, &mut self.settings.color, requests)
            }
            PanelKind::Brushes => {
                let shown = (&mut self.swatches, &mut self.settings.shelf);
                panels::brushes::show(ui, &self.session, shown, requests)
            }
            PanelKind::Palettes => panels::palettes::show(ui, &self.session, requests),
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
            // Over the canvas, so that none covers its former place.
            let place = ctx.content_rect().center()
                + egui::vec2(-160.0, -220.0)
                + egui::Vec2::splat(26.0 * i as f32);
            let apart = ApartWindow {
                name: front.name(),
                size_pt: [268.0, 340.0],
                place,
                is_enabled: self.dialogs.is_empty(),
            };
            let mut is_open = true;
            apart.show(ctx, &mut is_open, |ui, is_own| {
                let area =
                    egui::ScrollArea::vertical().id_salt(front.name()).auto_shrink([false, false]);
                area.show(ui, |ui| self.panel(ui, front, requests));
                self.hear_keys_apart(ui, is_own, requests);
            });
            if !is_open {
                self.settings.layout.floating.retain(|other| *other != front);
            }
        }
    }

    /// The keys of commands and tools count in the system's windows of panels, too.
    fn hear_keys_apart(&self, ui: &Ui, is_own: bool, requests: &mut UiRequests) {
        if is_own && self.is_free_for_keys() {
            keys::listen(ui.ctx(), &self.session, &self.settings.keymap, requests);
        }
    }
}

/// A window of its own for panels.
struct ApartWindow {
    name: &'static str,
    size_pt: [f32; 2],
    /// Where it opens in this window, if the system has no others.
    place: egui::Pos2,
    /// Behind a dialog it is not.
    is_enabled: bool,
}

impl ApartWindow {
    const LEAST_PT: [f32; 2] = [230.0, 160.0];

    /// Shows it as a window of the system, which goes to another screen, or else over the canvas;
    /// `add` is told whether it is the system's. Closing it clears `is_open`.
    fn show(self, ctx: &egui::Context, is_open: &mut bool, mut add: impl FnMut(&mut Ui, bool)) {
        let ApartWindow { name, size_pt, place, is_enabled } = self;
        if ctx.embed_viewports() {
            let window =
                egui::Window::new(tr(name)).id(Id::unique(("panel", name))).constrain(true);
            let window = window.default_size(size_pt).min_size(Self::LEAST_PT).default_pos(place);
            window.open(is_open).show(ctx, |ui| add(ui, false));
            return;
        }
        // Above the picture, and beneath other programs while they are used.
        let is_used = ctx.input(|i| i.raw.viewports.values().any(|one| one.focused == Some(true)));
        let level = if is_used { WindowLevel::AlwaysOnTop } else { WindowLevel::Normal };
        let builder = ViewportBuilder::default()
            .with_title(tr(name))
            .with_inner_size(size_pt)
            .with_min_inner_size(Self::LEAST_PT)
            .with_minimize_button(false)
            .with_taskbar(false)
            .with_window_level(level);
        ctx.show_viewport_immediate(ViewportId::from_hash_of(("panel", name)), builder, |ui, _| {
            CentralPanel::default().show(ui, |ui| {
                if !is_enabled {
                    ui.disable();
                }
                add(ui, true);
            });
            *is_open &= !ui.input(|i| i.viewport().close_requested());
        });
    }
}

/// What will happen to files dragged over the window.
fn show_hovered(ui: &Ui, area: egui::Rect, has_document: bool) {
    if ui.input(|i| i.raw.hovered_files.is_empty()) {
        return;
    }
    let text = match has_document {
        true => tr(
            "Drop: a picture becomes a layer at the pointer, maps become a new document, a project opens",
        ),
        false => tr("Drop: a picture opens, maps become a new document, a project opens"),
    };
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
