//! The context menu of a layer.
//! Floor 7.

use super::set;
use crate::document::Layer;
use crate::requests::UiRequests;
use crate::session::actions::LayerAction;
use crate::session::{Action, LayerPath, Property};
use eframe::egui::{Id, Ui};

pub fn show(ui: &mut Ui, layer: &Layer, path: &LayerPath, requests: &mut UiRequests) {
    type MenuAction = fn(LayerPath) -> LayerAction;
    let entries: [(&str, MenuAction); 7] = [
        ("Duplicate", |layer| LayerAction::Duplicate { layer }),
        ("Group", |layer| LayerAction::Group { layer }),
        ("Merge down", |layer| LayerAction::MergeDown { layer }),
        ("Bake", |layer| LayerAction::Bake { layer }),
        ("Paint on a mask", |layer| LayerAction::PaintMask { layer, hides: false }),
        ("Clear", |layer| LayerAction::Clear { layer }),
        ("Delete", |layer| LayerAction::Delete { layer }),
    ];
    if ui.button("Rename").clicked() {
        ui.data_mut(|data| data.insert_temp(Id::unique("renaming layer"), (layer.id, layer.name.clone())));
        ui.close();
    }
    for (label, make) in entries {
        if ui.button(label).clicked() {
            requests.act(Action::Layer(make(path.clone())));
            ui.close();
        }
    }
    if ui.button(if layer.visible { "Hide" } else { "Show" }).clicked() {
        set(requests, path, Property::Visible { on: !layer.visible }, true);
        ui.close();
    }
}
