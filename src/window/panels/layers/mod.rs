//! The layer list, the topmost first, with controls of the selected layer above and below. Floor 7. `row` shows one
//! layer, `drag` handles dragging, `menu` the context menu.

mod drag;
mod menu;
mod row;

use crate::document::{Content, Document, Group, Layer, LayerLock};
use crate::icons::{Icon, icon_button};
use crate::raster::BlendMode;
use crate::requests::UiRequests;
use crate::session::actions::{LayerAction, NewLayer};
use crate::session::{Action, LayerPath, Property, Session};
use crate::thumbnails::Thumbnails;
use crate::tools::ToolKind;
use crate::widgets::{NumberField, choice};
use eframe::egui::{self, Ui};
use row::LayerRow;
use std::sync::Arc;

pub fn kind_icon(content: &Content) -> Icon {
    match content {
        Content::Fill(_) => Icon::Fill,
        Content::Pixels(_) => Icon::Pixels,
        Content::Image(_) => Icon::Tool(ToolKind::Image),
        Content::Gradient(_) => Icon::Tool(ToolKind::Gradient),
        Content::Strokes(_) => Icon::Tool(ToolKind::Strokes),
        Content::Shading(_) => Icon::Shading,
        Content::RadianceScaling(_) => Icon::Scaling,
        Content::Normals(_) => Icon::Normals,
        Content::Group(_) => Icon::Group,
    }
}

fn set(requests: &mut UiRequests, layer: &LayerPath, to: Property, done: bool) {
    requests.act(Action::Layer(LayerAction::Set { layer: layer.clone(), to, done }));
}

pub fn show(ui: &mut Ui, session: &Session, thumbnails: &mut Thumbnails, requests: &mut UiRequests) {
    let Some(document) = session.shown() else {
        ui.weak("No document is open.");
        return;
    };
    head(ui, session, requests);
    foot(ui, session, requests);
    let height = ui.available_height();
    egui::ScrollArea::vertical().id_salt("layers").max_height(height).auto_shrink([false, false]).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        rows(ui, session, document, &document.layers, 0, thumbnails, requests);
        if document.layers.is_empty() {
            ui.weak("No layers yet: paint, or drop a picture.");
        }
    });
}

/// Blend mode and opacity of the selected layer.
fn head(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let (Some(layer), Some(path)) = (session.layer(), session.layer_path()) else { return };
    ui.horizontal(|ui| {
        if let Some(mode) = choice(ui, "Blend mode", layer.blend, &BlendMode::LABELS) {
            set(requests, &path, Property::Blend { mode }, true);
        }
        let number = NumberField::new("Opacity", 0.0..=1.0, "Of the whole layer");
        if let Some(changed) = number.inline(ui, layer.opacity, (ui.available_width() - 112.0).max(30.0)) {
            set(requests, &path, Property::Opacity { to: changed.to }, changed.done);
        }
    });
    ui.horizontal(|ui| {
        let toggles = [
            (Icon::LockAlpha, "Lock alpha", layer.lock == LayerLock::Alpha, "Paints only where there is paint (/)"),
            (Icon::Lock, "Lock layer", layer.lock == LayerLock::All, "No tool changes it"),
            (Icon::Clip, "Clip to layer below", layer.clip_below, "Paint only where the layer beneath has paint"),
        ];
        for (icon, label, is_on, hint) in toggles {
            if icon_button(ui, icon, label, is_on).on_hover_text(format!("{label}\n{hint}")).clicked() {
                let lock = |lock: LayerLock| Property::Locked { lock: if is_on { LayerLock::None } else { lock } };
                let to = match icon {
                    Icon::LockAlpha => lock(LayerLock::Alpha),
                    Icon::Lock => lock(LayerLock::All),
                    _ => Property::ClipBelow { on: !is_on },
                };
                set(requests, &path, to, true);
            }
        }
        let is_alone = session.active().is_some_and(|tab| tab.solo == Some(layer.id));
        if icon_button(ui, Icon::Solo, "Show layer alone", is_alone).on_hover_text("Shows this layer alone").clicked() {
            requests.act(Action::Layer(LayerAction::Solo { layer: path }));
        }
    });
}

/// The buttons that make, copy, merge and delete.
fn foot(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    ui.horizontal(|ui| {
        ui.menu_button("+ Add", |ui| {
            for (kind, name) in NewLayer::ALL {
                if ui.button(name).clicked() {
                    requests.act(Action::Layer(LayerAction::Add { kind }));
                    ui.close();
                }
            }
        });
        let Some(path) = session.layer_path() else { return };
        type ButtonAction = fn(LayerPath) -> LayerAction;
        let buttons: [(Icon, &str, ButtonAction); 6] = [
            (Icon::Duplicate, "Duplicate layer", |layer| LayerAction::Duplicate { layer }),
            (Icon::Up, "Move layer up", |layer| LayerAction::Nudge { layer, by: 1 }),
            (Icon::Down, "Move layer down", |layer| LayerAction::Nudge { layer, by: -1 }),
            (Icon::Merge, "Merge down", |layer| LayerAction::MergeDown { layer }),
            (Icon::Bake, "Bake layer", |layer| LayerAction::Bake { layer }),
            (Icon::Delete, "Delete layer", |layer| LayerAction::Delete { layer }),
        ];
        for (icon, label, make) in buttons {
            let hint = crate::commands::named(label).map_or(label, |command| command.hint);
            if icon_button(ui, icon, label, false).on_hover_text(format!("{label}\n{hint}")).clicked() {
                requests.act(Action::Layer(make(path.clone())));
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
    requests: &mut UiRequests,
) {
    for layer in layers.iter().rev() {
        let Some(path) = LayerPath::of(document, layer.id) else { continue };
        let row = LayerRow { session, document, layer, path, depth };
        row.show(ui, thumbnails, requests);
        if let Some(Group { layers, .. }) = layer.content.group()
            && !row::is_folded(ui, layer.id)
        {
            rows(ui, session, document, layers, depth + 1, thumbnails, requests);
        }
    }
}
