//! The layer list, the topmost first, with controls of the selected layers above and below. Floor 7.
//! `row` shows one layer, `drag` handles dragging, `menu` the context menu, `filter` the field that
//! finds layers.

mod drag;
mod filter;
mod menu;
mod row;

use crate::document::{Content, Layer, LayerId, LayerLabel, LayerLock};
use crate::icons::{BUTTON_PT, Icon, icon_button};
use crate::language::tr;
use crate::paint::FormPattern;
use crate::raster::BlendMode;
use crate::requests::UiRequests;
use crate::session::actions::{LayerAction, NewLayer};
use crate::session::{Action, LayerPath, LayerPaths, Property, Session};
use crate::thumbnails::Thumbnails;
use crate::tools::ToolKind;
use crate::widgets::{NumberField, choice};
use eframe::egui::{self, Color32, Frame, Panel, Ui};
use row::LayerRow;

pub fn kind_icon(content: &Content) -> Icon {
    match content {
        Content::Fill(_) => Icon::Fill,
        Content::Pixels(_) => Icon::Pixels,
        Content::Image(live) if live.params().source.text().is_some() => Icon::Tool(ToolKind::Text),
        Content::Image(live) if live.params().source.path().is_some() => Icon::Tool(ToolKind::Path),
        Content::Image(_) => Icon::Tool(ToolKind::Image),
        Content::Gradient(_) => Icon::Tool(ToolKind::Gradient),
        Content::Strokes(_) => Icon::Tool(ToolKind::Strokes),
        Content::FormDrawing(live) => match live.params().pattern {
            FormPattern::Lines(_) => Icon::FormLines,
            FormPattern::Hatching(_) => Icon::Hatching,
        },
        Content::Shading(_) => Icon::Shading,
        Content::RadianceScaling(_) => Icon::Scaling,
        Content::Adjustment(_) => Icon::Adjustment,
        Content::Filter(_) => Icon::Filter,
        Content::Normals(_) => Icon::Normals,
        Content::Ink(_) => Icon::Ink,
        Content::Group(_) => Icon::Group,
    }
}

fn set(requests: &mut UiRequests, layers: &LayerPaths, to: Property, done: bool) {
    requests.act(Action::Layer(LayerAction::Set { layer: layers.clone(), to, done }));
}

/// The color that shows a label.
fn color_of(label: LayerLabel) -> Option<Color32> {
    label.color().map(|color| Color32::from_rgb(color.r, color.g, color.b))
}

pub fn show(
    ui: &mut Ui,
    session: &Session,
    thumbnails: &mut Thumbnails,
    requests: &mut UiRequests,
) {
    let Some(document) = session.shown_document() else {
        ui.weak(tr("No document is open."));
        return;
    };
    head(ui, session, requests);
    let beneath = Panel::bottom("layer buttons")
        .resizable(false)
        .show_separator_line(false)
        .frame(Frame::NONE)
        .exact_size(BUTTON_PT + 2.0);
    beneath.show(ui, |ui| foot(ui, session, requests));
    let height = ui.available_height() - 2.0;
    egui::ScrollArea::vertical()
        .id_salt("layers")
        .max_height(height)
        .auto_shrink([false, false])
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            let rows = filter::current(ui).list_rows(document, |group| row::is_folded(ui, group));
            let listed: Vec<LayerId> = rows.iter().map(|(layer, _)| layer.id).collect();
            for (layer, depth) in &rows {
                let Some(path) = LayerPath::of(document, layer.id) else { continue };
                let row =
                    LayerRow { session, document, layer, path, depth: *depth, listed: &listed };
                row.show(ui, thumbnails, requests);
            }
            if document.layers.is_empty() {
                ui.weak(tr("No layers yet: paint, or drop a picture."));
            } else if rows.is_empty() {
                ui.weak(tr("No layer has this name. Press Escape in the field to show all."));
            }
        });
}

/// Blend mode and opacity of the selected layers, showing those of the active one; locks, clipping,
/// and the field that finds layers.
fn head(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let (Some(layer), Some(path)) = (session.layer(), session.layer_path()) else {
        return drop(ui.horizontal(|ui| filter::show(ui, session)));
    };
    let selected = session
        .active()
        .map(|open| LayerPaths::of(open.document(), &open.selected_layers()))
        .unwrap_or_default();
    ui.horizontal(|ui| {
        if let Some(mode) = choice(ui, "Blend mode", layer.blend, &BlendMode::LABELS) {
            set(requests, &selected, Property::Blend { mode }, true);
        }
        let number = NumberField::new("Opacity", 0.0..=1.0, "Of the whole layer").share();
        if let Some(changed) = number.row(ui, layer.opacity) {
            set(requests, &selected, Property::Opacity { to: changed.to }, changed.done);
        }
    });
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 1.0;
        toggles(ui, layer, &selected, requests);
        let is_alone = session.active().is_some_and(|open| open.solo == Some(layer.id));
        if icon_button(ui, Icon::Solo, "Show layer alone", is_alone)
            .on_hover_text(tr("Shows this layer alone"))
            .clicked()
        {
            requests.act(Action::Layer(LayerAction::Solo { layer: path }));
        }
        ui.add_space(6.0);
        filter::show(ui, session);
    });
}

/// Locks and clipping.
fn toggles(ui: &mut Ui, layer: &Layer, selected: &LayerPaths, requests: &mut UiRequests) {
    let toggles = [
        (
            Icon::LockAlpha,
            "Lock alpha",
            layer.lock == LayerLock::Alpha,
            "Paints only where there is paint (/)",
        ),
        (Icon::Lock, "Lock layer", layer.lock == LayerLock::All, "No tool can change it"),
        (
            Icon::Clip,
            "Clip to layer below",
            layer.clip_below,
            "Paint only where the layer beneath has paint",
        ),
    ];
    for (icon, label, is_on, hint) in toggles {
        let button = icon_button(ui, icon, label, is_on);
        if !button.on_hover_text(format!("{}\n{}", tr(label), tr(hint))).clicked() {
            continue;
        }
        let lock =
            |lock: LayerLock| Property::Locked { lock: if is_on { LayerLock::None } else { lock } };
        let to = match icon {
            Icon::LockAlpha => lock(LayerLock::Alpha),
            Icon::Lock => lock(LayerLock::All),
            _ => Property::ClipBelow { on: !is_on },
        };
        set(requests, selected, to, true);
    }
}

/// The buttons that make, copy, merge and delete.
fn foot(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        ui.menu_button(tr("+ Add"), |ui| {
            for (kind, name) in NewLayer::LABELS {
                if ui.button(tr(name)).clicked() {
                    requests.act(Action::Layer(LayerAction::Add { kind }));
                    ui.close();
                }
            }
        });
        if session.layer().is_none() {
            return;
        }
        type ButtonAction = fn(LayerPaths) -> LayerAction;
        let buttons: [(Icon, &str, ButtonAction); 6] = [
            (Icon::Duplicate, "Duplicate layer", |layer| LayerAction::Duplicate { layer }),
            (Icon::Up, "Move layer up", |layer| LayerAction::Nudge { layer, by: 1 }),
            (Icon::Down, "Move layer down", |layer| LayerAction::Nudge { layer, by: -1 }),
            (Icon::Merge, "Merge down", |layer| LayerAction::MergeDown { layer }),
            (Icon::Bake, "Turn layer into pixels", |layer| LayerAction::Bake { layer }),
            (Icon::Delete, "Delete layer", |layer| LayerAction::Delete { layer }),
        ];
        for (icon, label, make) in buttons {
            let hint = crate::commands::find_command(label).map_or(label, |command| command.hint);
            if icon_button(ui, icon, label, false)
                .on_hover_text(format!("{}\n{}", tr(label), tr(hint)))
                .clicked()
            {
                requests.act(Action::Layer(make(session.layer_paths())));
            }
        }
    });
}
