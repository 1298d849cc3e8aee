//! The layers, the topmost first: seen, locked, clipped, renamed, dragged.
//! Floor 7.

use crate::app::asked::Asked;
use crate::app::icons::{Icon, icon_button, sized_button};
use crate::app::theme::ACCENT;
use crate::app::thumbnails::Thumbnails;
use crate::app::widgets::{Number, choice, sentence};
use crate::document::{Content, Document, Group, Layer, LayerId, Lock};
use crate::raster::BlendMode;
use crate::session::actions::{LayerAction, NewLayer};
use crate::session::{Action, LayerPath, Property, Session};
use eframe::egui::{self, Align2, Color32, Id, Rect, Response, Sense, Stroke, TextEdit, TextStyle, Ui, pos2, vec2};
use std::sync::Arc;

const ROW_PT: f32 = 38.0;
const INDENT_PT: f32 = 14.0;

pub fn kind_icon(content: &Content) -> (Icon, &'static str) {
    match content {
        Content::Fill(_) => (Icon::Fill, "Fill"),
        Content::Pixels(_) => (Icon::Pixels, "Paint"),
        Content::Image(_) => (Icon::Image, "Image"),
        Content::Gradient(_) => (Icon::Gradient, "Gradient"),
        Content::Strokes(_) => (Icon::Strokes, "Strokes"),
        Content::Shading(_) => (Icon::Shading, "Shading"),
        Content::RadianceScaling(_) => (Icon::Scaling, "Radiance scaling"),
        Content::Normals(_) => (Icon::Normals, "Normals"),
        Content::Group(_) => (Icon::Group, "Group"),
    }
}

fn set(asked: &mut Asked, layer: &LayerPath, to: Property, done: bool) {
    asked.act(Action::Layer(LayerAction::Set { layer: layer.clone(), to, done }));
}

pub fn show(ui: &mut Ui, session: &Session, thumbnails: &mut Thumbnails, asked: &mut Asked) {
    let Some(document) = session.shown() else {
        ui.weak("No document is open.");
        return;
    };
    head(ui, session, asked);
    foot(ui, session, asked);
    let height = ui.available_height();
    egui::ScrollArea::vertical().id_salt("layers").max_height(height).auto_shrink([false, false]).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        rows(ui, session, document, &document.layers, 0, thumbnails, asked);
        if document.layers.is_empty() {
            ui.weak("No layers yet: paint, or drop a picture.");
        }
    });
}

/// Blend mode and opacity of the selected layer.
fn head(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let (Some(layer), Some(path)) = (session.layer(), session.layer_path()) else { return };
    ui.horizontal(|ui| {
        if let Some(mode) = choice(ui, "Blend mode", layer.blend, &BlendMode::ALL) {
            set(asked, &path, Property::Blend { mode }, true);
        }
        let number = Number::new("Opacity", 0.0..=1.0, "Of the whole layer");
        if let Some(changed) = number.inline(ui, layer.opacity, (ui.available_width() - 112.0).max(30.0)) {
            set(asked, &path, Property::Opacity { to: changed.to }, changed.done);
        }
    });
    ui.horizontal(|ui| {
        let toggles = [
            (Icon::LockAlpha, "Lock alpha", layer.lock == Lock::Alpha, "Paint only where there is paint already (/)"),
            (Icon::Lock, "Lock layer", layer.lock == Lock::All, "No tool changes it"),
            (Icon::Clip, "Clip to layer below", layer.clip_below, "Paint only where the layer beneath has paint"),
        ];
        for (icon, label, is_on, hint) in toggles {
            if icon_button(ui, icon, label, is_on).on_hover_text(format!("{label}\n{hint}")).clicked() {
                let lock = |lock: Lock| Property::Locked { lock: if is_on { Lock::None } else { lock } };
                let to = match icon {
                    Icon::LockAlpha => lock(Lock::Alpha),
                    Icon::Lock => lock(Lock::All),
                    _ => Property::ClipBelow { on: !is_on },
                };
                set(asked, &path, to, true);
            }
        }
        let is_alone = session.tab().is_some_and(|tab| tab.solo == Some(layer.id));
        if icon_button(ui, Icon::Solo, "Show layer alone", is_alone).on_hover_text("Show this layer alone").clicked() {
            asked.act(Action::Layer(LayerAction::Solo { layer: path }));
        }
    });
}

/// The buttons that make, copy, merge and delete.
fn foot(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    ui.horizontal(|ui| {
        ui.menu_button("+ Add", |ui| {
            for (kind, name) in NewLayer::ALL {
                if ui.button(name).clicked() {
                    asked.act(Action::Layer(LayerAction::Add { kind }));
                    ui.close();
                }
            }
        });
        let Some(path) = session.layer_path() else { return };
        type Make = fn(LayerPath) -> LayerAction;
        let buttons: [(Icon, &str, Make); 6] = [
            (Icon::Duplicate, "Duplicate layer", |layer| LayerAction::Duplicate { layer }),
            (Icon::Up, "Move layer up", |layer| LayerAction::Nudge { layer, by: 1 }),
            (Icon::Down, "Move layer down", |layer| LayerAction::Nudge { layer, by: -1 }),
            (Icon::Merge, "Merge down", |layer| LayerAction::MergeDown { layer }),
            (Icon::Bake, "Bake layer", |layer| LayerAction::Bake { layer }),
            (Icon::Delete, "Delete layer", |layer| LayerAction::Delete { layer }),
        ];
        for (icon, label, make) in buttons {
            let hint = crate::app::commands::named(label).map_or(label, |command| command.hint);
            if icon_button(ui, icon, label, false).on_hover_text(format!("{label}\n{hint}")).clicked() {
                asked.act(Action::Layer(make(path.clone())));
            }
        }
    });
}

fn rows(
    ui: &mut Ui,
    session: &Session,
    document: &Document,
    layers: &[Arc<Layer>],
    depth: usize,
    thumbnails: &mut Thumbnails,
    asked: &mut Asked,
) {
    for layer in layers.iter().rev() {
        let Some(path) = LayerPath::of(document, layer.id) else { continue };
        let folded = egui::Id::unique(("folded", layer.id));
        let is_folded = ui.data(|data| data.get_temp::<bool>(folded).unwrap_or(false));
        row(ui, session, document, layer, &path, depth, is_folded, thumbnails, asked);
        if let Content::Group(Group { layers, .. }) = &layer.content
            && !is_folded
        {
            rows(ui, session, document, layers, depth + 1, thumbnails, asked);
        }
    }
}

#[expect(clippy::too_many_arguments, reason = "a row is one thing seen from many sides")]
fn row(
    ui: &mut Ui,
    session: &Session,
    document: &Document,
    layer: &Arc<Layer>,
    path: &LayerPath,
    depth: usize,
    is_folded: bool,
    thumbnails: &mut Thumbnails,
    asked: &mut Asked,
) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW_PT), Sense::click_and_drag());
    let is_selected = session.tab().is_some_and(|tab| tab.selected == Some(layer.id));
    let label = format!("Layer {}", layer.name);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_selected, &label));
    let fill = match (is_selected, response.hovered()) {
        (true, _) => ui.visuals().selection.bg_fill,
        (false, true) => ui.visuals().widgets.hovered.weak_bg_fill,
        _ => ui.visuals().faint_bg_color,
    };
    ui.painter().rect_filled(rect, 4.0, fill);
    let mut inner =
        ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(egui::Layout::left_to_right(egui::Align::Center)));
    let ui_row = &mut inner;
    ui_row.spacing_mut().item_spacing.x = 3.0;
    ui_row.add_space(2.0 + depth as f32 * INDENT_PT);
    let eye = if layer.visible { Icon::Shown } else { Icon::Hidden };
    if sized_button(ui_row, eye, &format!("Show {}", layer.name), layer.visible, 22.0)
        .on_hover_text("Show or hide")
        .clicked()
    {
        set(asked, path, Property::Visible { on: !layer.visible }, true);
    }
    if matches!(layer.content, Content::Group(_)) {
        let icon = if is_folded { Icon::Closed } else { Icon::Opened };
        if sized_button(ui_row, icon, &format!("Fold {}", layer.name), false, 18.0).clicked() {
            let folded = egui::Id::unique(("folded", layer.id));
            ui.data_mut(|data| data.insert_temp(folded, !is_folded));
        }
    }
    if layer.clip_below {
        let (at, _) = ui_row.allocate_exact_size(vec2(14.0, 14.0), Sense::hover());
        Icon::Clip.draw(ui_row.painter(), at, ui_row.visuals().text_color());
    }
    picture(ui_row, document, layer, thumbnails);
    name(ui_row, session, layer, path, &response, asked);
    drag(ui, document, layer, &response, rect, asked);
    if response.clicked() {
        asked.act(Action::Layer(LayerAction::Select { layer: path.clone() }));
    }
    response.context_menu(|ui| context_menu(ui, layer, path, asked));
}

/// The thumbnail, or the kind's icon until there is one.
fn picture(ui: &mut Ui, document: &Document, layer: &Arc<Layer>, thumbnails: &mut Thumbnails) {
    let (rect, _) = ui.allocate_exact_size(vec2(30.0, 30.0), Sense::hover());
    let (icon, _) = kind_icon(&layer.content);
    ui.painter().rect_filled(rect, 3.0, Color32::from_gray(0x70));
    if let Some((texture, size)) = thumbnails.of(ui.ctx(), document, layer) {
        let scale = (rect.width() / size.x).min(rect.height() / size.y);
        let at = Rect::from_center_size(rect.center(), size * scale);
        let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter().image(texture, at, uv, Color32::WHITE);
        let badge = Rect::from_min_size(rect.max - vec2(13.0, 13.0), vec2(13.0, 13.0));
        ui.painter().rect_filled(badge, 3.0, Color32::from_black_alpha(150));
        icon.draw(ui.painter(), badge.shrink(1.5), Color32::from_gray(0xe4));
    } else {
        icon.draw(ui.painter(), rect.shrink(6.0), Color32::from_gray(0xe4));
    }
}

/// The name, or a field to type another into.
fn name(ui: &mut Ui, session: &Session, layer: &Layer, path: &LayerPath, row: &Response, asked: &mut Asked) {
    let renaming = Id::unique("renaming layer");
    let typed = ui.data(|data| data.get_temp::<(LayerId, String)>(renaming)).filter(|(id, _)| *id == layer.id);
    if let Some((id, mut text)) = typed {
        let response = ui.add(TextEdit::singleline(&mut text).desired_width(ui.available_width() - 24.0));
        crate::app::widgets::named(&response, "Layer name");
        if response.lost_focus() {
            ui.data_mut(|data| data.remove::<(LayerId, String)>(renaming));
            let is_kept = !ui.input(|i| i.key_pressed(egui::Key::Escape)) && !text.trim().is_empty();
            if is_kept && text != layer.name {
                set(asked, path, Property::Name { name: text.trim().to_owned() }, true);
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
    let is_alone = session.tab().is_some_and(|tab| tab.solo == Some(layer.id));
    let badges = [
        (layer.lock == Lock::All, Icon::Lock),
        (layer.lock == Lock::Alpha, Icon::LockAlpha),
        (layer.mask.is_some(), Icon::Mask),
        (is_alone, Icon::Solo),
    ];
    let badges: Vec<Icon> = badges.into_iter().filter(|(on, _)| *on).map(|(_, icon)| icon).collect();
    let room = at.width() - 6.0 - 17.0 * badges.len() as f32;
    let strong = ui.visuals().strong_text_color();
    let color = if layer.visible { strong } else { ui.visuals().weak_text_color() };
    let galley = egui::WidgetText::from(egui::RichText::new(&layer.name).color(color)).into_galley(
        ui,
        Some(egui::TextWrapMode::Truncate),
        room.max(10.0),
        TextStyle::Body,
    );
    ui.painter().galley(pos2(at.left() + 3.0, at.top() + 4.0), galley, color);
    let (_, kind) = kind_icon(&layer.content);
    let mode =
        if layer.blend == BlendMode::Normal { String::new() } else { format!(" · {}", sentence(layer.blend.name())) };
    let opacity = if layer.opacity < 1.0 { format!(" · {:.0} %", layer.opacity * 100.0) } else { String::new() };
    let about = format!("{kind}{mode}{opacity}");
    let font = TextStyle::Small.resolve(ui.style());
    ui.painter().text(
        pos2(at.left() + 3.0, at.bottom() - 5.0),
        Align2::LEFT_BOTTOM,
        about,
        font,
        ui.visuals().weak_text_color(),
    );
    for (i, icon) in badges.iter().enumerate() {
        let center = pos2(at.right() - 10.0 - 17.0 * i as f32, at.center().y);
        icon.draw(ui.painter(), Rect::from_center_size(center, vec2(13.0, 13.0)), ui.visuals().text_color());
    }
}

/// A row in hand, and rows it can be dropped between or into.
fn drag(ui: &Ui, document: &Document, layer: &Arc<Layer>, response: &Response, rect: Rect, asked: &mut Asked) {
    response.dnd_set_drag_payload(layer.id);
    if let Some(held) = response.dnd_hover_payload::<LayerId>()
        && *held != layer.id
        && let Some(pointer) = ui.input(|i| i.pointer.hover_pos())
    {
        let stroke = Stroke::new(2.0, ACCENT);
        match drop_at(layer, rect, pointer.y) {
            Drop::Above => drop(ui.painter().hline(rect.x_range(), rect.top(), stroke)),
            Drop::Below => drop(ui.painter().hline(rect.x_range(), rect.bottom(), stroke)),
            Drop::Into => drop(ui.painter().rect_stroke(rect, 4.0, stroke, egui::StrokeKind::Inside)),
        }
    }
    let Some(held) = response.dnd_release_payload::<LayerId>().filter(|held| **held != layer.id) else { return };
    let Some(pointer) = ui.input(|i| i.pointer.interact_pos()) else { return };
    let Some(rest) = document.without_layer(*held) else { return };
    let Some(place) = rest.place_of(layer.id) else { return };
    let (group, index) = match drop_at(layer, rect, pointer.y) {
        Drop::Above => (place.group, place.index + 1),
        Drop::Below => (place.group, place.index),
        Drop::Into => (Some(layer.id), usize::MAX >> 1),
    };
    let group = group.and_then(|group| LayerPath::of(document, group));
    if let Some(layer) = LayerPath::of(document, *held) {
        asked.act(Action::Layer(LayerAction::Move { layer, group, index }));
    }
}

enum Drop {
    Above,
    Below,
    Into,
}

fn drop_at(layer: &Layer, rect: Rect, y: f32) -> Drop {
    let along = (y - rect.top()) / rect.height();
    match &layer.content {
        Content::Group(_) if (0.25..0.75).contains(&along) => Drop::Into,
        _ if along < 0.5 => Drop::Above,
        _ => Drop::Below,
    }
}

fn context_menu(ui: &mut Ui, layer: &Layer, path: &LayerPath, asked: &mut Asked) {
    type Make = fn(LayerPath) -> LayerAction;
    let entries: [(&str, Make); 6] = [
        ("Duplicate", |layer| LayerAction::Duplicate { layer }),
        ("Group", |layer| LayerAction::Group { layer }),
        ("Merge down", |layer| LayerAction::MergeDown { layer }),
        ("Bake", |layer| LayerAction::Bake { layer }),
        ("Clear", |layer| LayerAction::Clear { layer }),
        ("Delete", |layer| LayerAction::Delete { layer }),
    ];
    if ui.button("Rename").clicked() {
        ui.data_mut(|data| data.insert_temp(Id::unique("renaming layer"), (layer.id, layer.name.clone())));
        ui.close();
    }
    for (label, make) in entries {
        if ui.button(label).clicked() {
            asked.act(Action::Layer(make(path.clone())));
            ui.close();
        }
    }
    if ui.button(if layer.visible { "Hide" } else { "Show" }).clicked() {
        set(asked, path, Property::Visible { on: !layer.visible }, true);
        ui.close();
    }
}
