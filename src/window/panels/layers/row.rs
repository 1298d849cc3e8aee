//! A layer's row: eye, thumbnails of the layer and its mask, name, and flags.
//! Floor 7.

use super::{color_of, drag, kind_icon, menu, set};
use crate::document::{Document, Layer, LayerId, LayerLock, MaskKind};
use crate::icons::{Icon, quiet_button};
use crate::language::tr;
use crate::raster::BlendMode;
use crate::requests::UiRequests;
use crate::session::actions::{LayerAction, SelectionAction};
use crate::session::selected_layers::range;
use crate::session::{Action, LayerPath, OpenDocument, Property, Session};
use crate::theme::{ACCENT, CHECKER, strengthen_hints};
use crate::thumbnails::Thumbnails;
use crate::tools::ModifierKeys;
use crate::tr;
use eframe::egui::{
    self, Color32, Id, Modifiers, Rect, Response, Sense, Stroke, StrokeKind, TextEdit, TextStyle,
    Ui, pos2, vec2,
};
use std::sync::Arc;

const ROW_PT: f32 = 42.0;
/// Sides of the pictures of a layer and of its mask.
const PICTURE_PT: f32 = 40.0;
const MASK_PT: f32 = 30.0;
/// Of the squares behind what is transparent.
const CHECKER_PT: f32 = 5.0;
const INDENT_PT: f32 = 14.0;
/// The width of the strip of a label's color.
const LABEL_PT: f32 = 4.0;

/// A layer in its place.
pub struct LayerRow<'a> {
    pub session: &'a Session,
    pub document: &'a Document,
    pub layer: &'a Arc<Layer>,
    pub path: LayerPath,
    /// Groups around it.
    pub depth: usize,
    /// All rows, the topmost first.
    pub listed: &'a [LayerId],
}

fn row_id(layer: LayerId) -> Id {
    Id::unique(("layer row", layer))
}

fn folded_id(layer: LayerId) -> Id {
    Id::unique(("folded", layer))
}

/// Whether the group is folded.
pub fn is_folded(ui: &Ui, layer: LayerId) -> bool {
    ui.data(|data| data.get_temp::<bool>(folded_id(layer)).unwrap_or(false))
}

impl LayerRow<'_> {
    pub fn show(&self, ui: &mut Ui, thumbnails: &mut Thumbnails, requests: &mut UiRequests) {
        let LayerRow { session, document, layer, path, depth, .. } = self;
        let Some(open) = session.active() else { return };
        let (_, rect) = ui.allocate_space(vec2(ui.available_width(), ROW_PT));
        let response = ui.interact(rect, row_id(layer.id), Sense::click_and_drag());
        let is_selected = open.is_selected(layer.id);
        let label = match is_selected {
            true => tr!("Layer {name}, selected", name = layer.name),
            false => tr!("Layer {name}", name = layer.name),
        };
        response.widget_info(|| {
            egui::WidgetInfo::selected(egui::Role::Button, true, is_selected, &label)
        });
        let fill = match (is_selected, response.hovered()) {
            (true, _) => ui.visuals().selection.bg_fill,
            (false, true) => ui.visuals().widgets.hovered.weak_bg_fill,
            _ => ui.visuals().faint_bg_color,
        };
        ui.painter().rect_filled(rect, 4.0, fill);
        if let Some(color) = color_of(layer.label) {
            ui.painter().rect_filled(rect.with_max_x(rect.left() + LABEL_PT), 2.0, color);
        }
        if open.has_several() && open.active_layer == Some(layer.id) {
            // The brush paints on this one.
            ui.painter().rect_stroke(rect, 4.0, Stroke::new(1.4, ACCENT), StrokeKind::Inside);
        }
        if response.has_focus() {
            ui.painter().rect_stroke(rect, 4.0, ui.visuals().selection.stroke, StrokeKind::Inside);
        }
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let mut inner = ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(layout));
        inner.spacing_mut().item_spacing.x = 3.0;
        if is_selected {
            strengthen_hints(&mut inner);
        }
        inner.add_space(2.0 + LABEL_PT + *depth as f32 * INDENT_PT);
        self.switches(&mut inner, requests);
        let thumbnail = picture(&mut inner, document, layer, thumbnails);
        self.mask(&mut inner, thumbnails, requests);
        name(&mut inner, session, layer, path, &response, requests);
        drag::show(ui, open, layer, &response, rect, requests);
        let keys = ui.input(|input| input.modifiers);
        let is_on_picture =
            response.interact_pointer_pos().is_some_and(|at| thumbnail.contains(at));
        if response.clicked() && keys.command && is_on_picture {
            let settings = session.tools.select;
            let how = settings.how(ModifierKeys { shift: keys.shift, ctrl: true, alt: keys.alt });
            requests.act(Action::Selection(SelectionAction::Layer { layer: path.clone(), how }));
        } else if response.clicked() && keys.command {
            self.choose(&open.toggle_selected(layer.id), None, requests);
        } else if response.clicked() {
            self.extend(open, layer.id, keys.shift, requests);
        }
        self.arrows(ui, open, &response, requests);
        response.context_menu(|ui| menu::show(ui, session, layer, path, requests));
    }

    fn choose(&self, ids: &[LayerId], anchor: Option<LayerId>, requests: &mut UiRequests) {
        requests
            .actions
            .extend(LayerAction::select_layers(self.document, ids, anchor).map(Action::Layer));
    }

    /// Selects a row, or all from it to the start of the range.
    fn extend(&self, open: &OpenDocument, to: LayerId, extends: bool, requests: &mut UiRequests) {
        let anchor = open.range_start().filter(|_| extends);
        let ids = anchor.map_or_else(|| vec![to], |anchor| range(self.listed, anchor, to));
        self.choose(&ids, anchor, requests);
    }

    /// Arrow keys in a row that has the focus move to the next one; with Shift they add it.
    fn arrows(&self, ui: &Ui, open: &OpenDocument, row: &Response, requests: &mut UiRequests) {
        if !row.has_focus() {
            return;
        }
        let filter = egui::EventFilter { vertical_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(row.id, filter));
        let pressed = |key| {
            ui.input_mut(|i| {
                i.consume_key(Modifiers::NONE, key) || i.consume_key(Modifiers::SHIFT, key)
            })
        };
        let extends = ui.input(|i| i.modifiers.shift);
        let here = self.listed.iter().position(|id| *id == self.layer.id);
        let to = match (pressed(egui::Key::ArrowUp), pressed(egui::Key::ArrowDown)) {
            (true, _) => here.and_then(|at| at.checked_sub(1)),
            (_, true) => here.map(|at| at + 1),
            _ => None,
        };
        if let Some(to) = to.and_then(|at| self.listed.get(at)) {
            self.extend(open, *to, extends, requests);
            ui.memory_mut(|memory| memory.request_focus(row_id(*to)));
        }
    }

    /// The eye, a group's fold, and the sign of being clipped.
    fn switches(&self, ui: &mut Ui, requests: &mut UiRequests) {
        let layer = self.layer;
        let eye = if layer.visible { Icon::Shown } else { Icon::Hidden };
        let eye =
            quiet_button(ui, eye, &tr!("Show {name}", name = layer.name), layer.visible, 22.0);
        if eye.on_hover_text(tr("Show or hide; with Alt this layer alone, or all again")).clicked()
        {
            if ui.input(|input| input.modifiers.alt) {
                requests.act(Action::Layer(LayerAction::Solo { layer: self.path.clone() }));
            } else {
                set(
                    requests,
                    &self.path.clone().into(),
                    Property::Visible { on: !layer.visible },
                    true,
                );
            }
        }
        if layer.content.group().is_some() {
            let is_folded = is_folded(ui, layer.id);
            let icon = if is_folded { Icon::Closed } else { Icon::Opened };
            if quiet_button(ui, icon, &tr!("Fold {name}", name = layer.name), true, 18.0).clicked()
            {
                ui.data_mut(|data| data.insert_temp(folded_id(layer.id), !is_folded));
            }
        }
        if layer.clip_below {
            let (at, _) = ui.allocate_exact_size(vec2(14.0, 14.0), Sense::hover());
            Icon::Clip.draw(ui.painter(), at, ui.visuals().text_color());
        }
    }

    /// The mask's thumbnail: a click selects it for painting, with Shift it disables the mask.
    fn mask(&self, ui: &mut Ui, thumbnails: &mut Thumbnails, requests: &mut UiRequests) {
        let Some(mask) = &self.layer.mask else { return };
        let is_on = self
            .session
            .active()
            .is_some_and(|open| open.on_mask && open.active_layer == Some(self.layer.id));
        let (rect, response) = ui.allocate_exact_size(vec2(MASK_PT, MASK_PT), Sense::click());
        let label = tr!("Mask of {name}", name = self.layer.name);
        response
            .widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_on, &label));
        ui.painter().rect_filled(rect, 3.0, Color32::from_gray(0x18));
        match thumbnails.of_mask(ui.ctx(), self.layer) {
            Some((texture, size)) => {
                let at = Rect::from_center_size(
                    rect.center(),
                    size * (rect.width() / size.x).min(rect.height() / size.y),
                );
                let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                ui.painter().image(texture, at, uv, Color32::WHITE);
            }
            None => Icon::Mask.draw(ui.painter(), rect.shrink(7.0), Color32::from_gray(0xe4)),
        }
        if mask.disabled {
            let cross = Stroke::new(2.0, ui.visuals().error_fg_color);
            ui.painter().line_segment([rect.left_top(), rect.right_bottom()], cross);
            ui.painter().line_segment([rect.left_bottom(), rect.right_top()], cross);
        }
        if is_on {
            ui.painter().rect_stroke(rect, 3.0, Stroke::new(2.0, ACCENT), StrokeKind::Outside);
        }
        let hint = "Click to paint on the mask; Shift-click to disable it";
        if !response.on_hover_text(tr(hint)).clicked() {
            return;
        }
        let is_picture = matches!(mask.kind, MaskKind::File { .. });
        let (layer, path) = (self.path.clone(), &self.path);
        if ui.input(|i| i.modifiers.shift) {
            set(requests, &path.into(), Property::MaskDisabled { on: !mask.disabled }, true);
        } else if is_picture {
            requests.act(Action::Layer(LayerAction::OnMask { layer, on: !is_on }));
        } else {
            requests.act(Action::Layer(LayerAction::Select { layer }));
        }
    }
}

/// The thumbnail, or the kind's icon until there is one; returns where it is.
fn picture(
    ui: &mut Ui,
    document: &Document,
    layer: &Arc<Layer>,
    thumbnails: &mut Thumbnails,
) -> Rect {
    let (rect, _) = ui.allocate_exact_size(vec2(PICTURE_PT, PICTURE_PT), Sense::hover());
    if let Some((texture, size)) = thumbnails.of(ui.ctx(), document, layer) {
        let scale = (rect.width() / size.x).min(rect.height() / size.y);
        let at = Rect::from_center_size(rect.center(), size * scale);
        let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        checker(ui, at);
        ui.painter().image(texture, at, uv, Color32::WHITE);
    } else {
        ui.painter().rect_filled(rect, 3.0, ui.visuals().extreme_bg_color);
        kind_icon(&layer.content).draw(ui.painter(), rect.shrink(11.0), ui.visuals().text_color());
    }
    rect
}

/// Squares behind what is transparent.
fn checker(ui: &Ui, rect: Rect) {
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    let [light, dark] = CHECKER;
    painter.rect_filled(rect, 0.0, light);
    let squares = |length: f32| (length / CHECKER_PT).ceil() as i32;
    for j in 0..squares(rect.height()) {
        for i in (j % 2..squares(rect.width())).step_by(2) {
            let at = rect.min + vec2(i as f32, j as f32) * CHECKER_PT;
            painter.rect_filled(Rect::from_min_size(at, vec2(CHECKER_PT, CHECKER_PT)), 0.0, dark);
        }
    }
}

/// The name, or a text field to change it.
fn name(
    ui: &mut Ui,
    session: &Session,
    layer: &Layer,
    path: &LayerPath,
    row: &Response,
    requests: &mut UiRequests,
) {
    let renaming = Id::unique("renaming layer");
    let typed = ui
        .data(|data| data.get_temp::<(LayerId, String)>(renaming))
        .filter(|(id, _)| *id == layer.id);
    if let Some((id, mut text)) = typed {
        let response =
            ui.add(TextEdit::singleline(&mut text).desired_width(ui.available_width() - 24.0));
        crate::widgets::set_accessible_name(&response, tr("Layer name"));
        if response.lost_focus() {
            ui.data_mut(|data| data.remove::<(LayerId, String)>(renaming));
            let is_kept =
                !ui.input(|i| i.key_pressed(egui::Key::Escape)) && !text.trim().is_empty();
            if is_kept && text != layer.name {
                set(requests, &path.into(), Property::Name { name: text.trim().to_owned() }, true);
            }
        } else {
            response.request_focus();
            ui.data_mut(|data| data.insert_temp(renaming, (id, text)));
        }
        return;
    }
    if row.double_clicked() {
        ui.data_mut(|data| data.insert_temp(renaming, (layer.id, layer.name.clone())));
    }
    let at = ui.available_rect_before_wrap();
    let is_alone = session.active().is_some_and(|open| open.solo == Some(layer.id));
    let badges = [
        (layer.lock == LayerLock::All, Icon::Lock),
        (layer.lock == LayerLock::Alpha, Icon::LockAlpha),
        (is_alone, Icon::Solo),
    ];
    let badges: Vec<Icon> =
        badges.into_iter().filter(|(on, _)| *on).map(|(_, icon)| icon).collect();
    let room = at.width() - 6.0 - 17.0 * badges.len() as f32;
    let strong = ui.visuals().strong_text_color();
    let color = if layer.visible { strong } else { ui.visuals().weak_text_color() };
    let galley = egui::WidgetText::from(egui::RichText::new(&layer.name).color(color)).into_galley(
        ui,
        Some(egui::TextWrapMode::Truncate),
        room.max(10.0),
        TextStyle::Body,
    );
    ui.painter().galley(pos2(at.left() + 4.0, at.top() + 4.0), galley, color);
    let mode = if layer.blend == BlendMode::Normal {
        String::new()
    } else {
        format!(" · {}", tr(layer.blend.label()))
    };
    let opacity = if layer.opacity < 1.0 {
        format!(" · {:.0} %", layer.opacity * 100.0)
    } else {
        String::new()
    };
    let about = format!("{}{mode}{opacity}", tr(layer.content.label()));
    let weak = ui.visuals().weak_text_color();
    let line = at.bottom() - 13.0;
    let mark = Rect::from_center_size(pos2(at.left() + 9.5, line), vec2(11.0, 11.0));
    kind_icon(&layer.content).draw(ui.painter(), mark, weak);
    let left = mark.right() + 4.0;
    let room = (at.right() - 17.0 * badges.len() as f32 - left).max(10.0);
    let about = egui::WidgetText::from(egui::RichText::new(about).color(weak));
    let about = about.into_galley(ui, Some(egui::TextWrapMode::Truncate), room, TextStyle::Small);
    ui.painter().galley(pos2(left, line - 0.5 * about.size().y), about, weak);
    for (i, icon) in badges.iter().enumerate() {
        let center = pos2(at.right() - 10.0 - 17.0 * i as f32, at.center().y);
        icon.draw(
            ui.painter(),
            Rect::from_center_size(center, vec2(13.0, 13.0)),
            ui.visuals().text_color(),
        );
    }
}
