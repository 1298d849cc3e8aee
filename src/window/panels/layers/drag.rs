//! Dragging layers to another position of the list.
//! Floor 7.

use crate::document::{Layer, LayerId};
use crate::requests::UiRequests;
use crate::session::actions::LayerAction;
use crate::session::{Action, LayerPath, LayerPaths, OpenDocument};
use crate::theme::ACCENT;
use eframe::egui::{self, Rect, Response, Stroke, Ui};
use std::sync::Arc;

/// The dragged row, and the rows it can be dropped between or into.
pub fn show(
    ui: &Ui,
    open: &OpenDocument,
    layer: &Arc<Layer>,
    response: &Response,
    rect: Rect,
    requests: &mut UiRequests,
) {
    let document = open.shown_document();
    // All selected rows move with a selected one.
    let held =
        |id: LayerId| if open.is_selected(id) { open.outermost_selected() } else { vec![id] };
    response.dnd_set_drag_payload(layer.id);
    if let Some(row) = response.dnd_hover_payload::<LayerId>()
        && !held(*row).contains(&layer.id)
        && let Some(pointer) = ui.input(|i| i.pointer.hover_pos())
    {
        let stroke = Stroke::new(2.0, ACCENT);
        match drop_at(layer, rect, pointer.y) {
            LayerDrop::Above => drop(ui.painter().hline(rect.x_range(), rect.top(), stroke)),
            LayerDrop::Below => drop(ui.painter().hline(rect.x_range(), rect.bottom(), stroke)),
            LayerDrop::Into => {
                ui.painter().rect_stroke(rect, 4.0, stroke, egui::StrokeKind::Inside);
            }
        }
    }
    let Some(held) = response.dnd_release_payload::<LayerId>().map(|row| held(*row)) else {
        return;
    };
    let Some(pointer) = ui.input(|i| i.pointer.interact_pos()) else { return };
    let Some(rest) = document.without_layers(&held) else { return };
    // There is no such place among the dragged rows.
    let Some(place) = rest.place_of(layer.id) else { return };
    let (group, index) = match drop_at(layer, rect, pointer.y) {
        LayerDrop::Above => (place.group, place.index + 1),
        LayerDrop::Below => (place.group, place.index),
        LayerDrop::Into => (Some(layer.id), usize::MAX >> 1),
    };
    let group = group.and_then(|group| LayerPath::of(document, group));
    let layer = LayerPaths::of(document, &held);
    requests.act(Action::Layer(LayerAction::Move { layer, group, index }));
}

enum LayerDrop {
    Above,
    Below,
    Into,
}

fn drop_at(layer: &Layer, rect: Rect, y: f32) -> LayerDrop {
    let along = (y - rect.top()) / rect.height();
    match layer.content.group() {
        Some(_) if (0.25..0.75).contains(&along) => LayerDrop::Into,
        _ if along < 0.5 => LayerDrop::Above,
        _ => LayerDrop::Below,
    }
}
