//! The context menu of a layer: for all selected ones if it is among them. Floor 7.

use super::{color_of, set};
use crate::document::{Layer, LayerLabel};
use crate::language::tr;
use crate::panels::words::translate_within;
use crate::requests::UiRequests;
use crate::session::actions::LayerAction;
use crate::session::{Action, LayerPath, LayerPaths, Property, Session};
use crate::widgets::sentence;
use eframe::egui::{Button, Id, Ui};

pub fn show(
    ui: &mut Ui,
    session: &Session,
    layer: &Layer,
    path: &LayerPath,
    requests: &mut UiRequests,
) {
    let is_selected = session.active().is_some_and(|open| open.is_selected(layer.id));
    let paths = if is_selected { session.layer_paths() } else { path.into() };
    type MenuAction = fn(LayerPaths) -> LayerAction;
    let entries: [(&str, MenuAction); 7] = [
        ("Duplicate", |layer| LayerAction::Duplicate { layer }),
        ("Group", |layer| LayerAction::Group { layer }),
        ("Ungroup", |layer| LayerAction::Ungroup { layer }),
        (if paths.is_several() { "Merge" } else { "Merge down" }, |layer| LayerAction::MergeDown {
            layer,
        }),
        ("Turn into pixels", |layer| LayerAction::Bake { layer }),
        ("Clear", |layer| LayerAction::Clear { layer }),
        ("Delete", |layer| LayerAction::Delete { layer }),
    ];
    if ui.button(tr("Rename")).clicked() {
        ui.data_mut(|data| {
            data.insert_temp(Id::unique("renaming layer"), (layer.id, layer.name.clone()))
        });
        ui.close();
    }
    for (label, make) in entries {
        if ui.button(tr(label)).clicked() {
            requests.act(Action::Layer(make(paths.clone())));
            ui.close();
        }
    }
    if ui.button(tr("Paint on a mask")).clicked() {
        requests.act(Action::Layer(LayerAction::PaintMask { layer: path.clone(), hides: false }));
        ui.close();
    }
    if ui.button(tr(if layer.visible { "Hide" } else { "Show" })).clicked() {
        set(requests, &paths, Property::Visible { on: !layer.visible }, true);
        ui.close();
    }
    ui.menu_button(tr("Label"), |ui| {
        for (label, name) in LayerLabel::ALL {
            let text = eframe::egui::RichText::new(translate_within(&sentence(name)));
            let text = color_of(label).map_or(text.clone(), |color| text.strong().color(color));
            if ui.add(Button::selectable(layer.label == label, text)).clicked() {
                set(requests, &paths, Property::Labeled { label }, true);
                ui.close();
            }
        }
    });
}
