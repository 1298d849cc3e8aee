//! Which layers are selected: one is the active one, which the brush paints on; what is done to
//! layers is done to all. Floor 6. The selection is not part of the document: selecting is no step.

use super::OpenDocument;
use crate::document::{Document, LayerId};
use crate::math::Vec2;
use crate::tools::gizmo::{GizmoContent, GizmoMemory, TransformGizmo, TransformTarget};

/// The selected layers. They count as long as the active one is among them: whatever selects
/// another layer alone drops the others.
#[derive(Clone, Debug, Default)]
pub struct SelectedLayers {
    ids: Vec<LayerId>,
    /// The start of a range that Shift extends.
    anchor: Option<LayerId>,
    /// What the transform tool keeps about them.
    gizmo: GizmoMemory,
}

impl SelectedLayers {
    /// These, the active one last.
    pub(super) fn of(ids: Vec<LayerId>) -> Self {
        Self { anchor: ids.last().copied(), ids, gizmo: GizmoMemory::default() }
    }

    /// The selection alone.
    pub(super) fn without_gizmo(&self) -> Self {
        Self { gizmo: GizmoMemory::default(), ids: self.ids.clone(), ..*self }
    }

    /// Selects as another does; what the transform tool keeps stays.
    pub(super) fn select_as(&mut self, other: Self) {
        (self.ids, self.anchor) = (other.ids, other.anchor);
    }
}

impl OpenDocument {
    /// The selected layers in the order of the tree, bottom first, the active one among them.
    pub fn selected_layers(&self) -> Vec<LayerId> {
        let document = self.shown_document();
        let Some(active_layer) = self.active_layer.filter(|id| document.layer(*id).is_some())
        else {
            return Vec::new();
        };
        if !self.selected_layers.ids.contains(&active_layer) {
            return vec![active_layer];
        }
        let all = document.walk();
        all.iter()
            .map(|(_, layer)| layer.id)
            .filter(|id| self.selected_layers.ids.contains(id))
            .collect()
    }

    /// Those of them that are in no other one: what is in a selected group moves with it.
    pub fn outermost_selected(&self) -> Vec<LayerId> {
        self.shown_document().outermost(&self.selected_layers())
    }

    /// Whether a layer is among the selected ones.
    pub fn is_selected(&self, layer: LayerId) -> bool {
        let also = |active_layer| {
            self.selected_layers.ids.contains(&active_layer)
                && self.selected_layers.ids.contains(&layer)
        };
        self.active_layer == Some(layer) || self.active_layer.is_some_and(also)
    }

    /// The gizmo of the transform tool around them, or around the shape, as they are shown.
    pub fn gizmo(&self, target: TransformTarget) -> Option<TransformGizmo> {
        self.gizmo_in(self.shown_document(), target)
    }

    /// The same after the last step.
    pub fn gizmo_before(&self, target: TransformTarget) -> Option<TransformGizmo> {
        self.gizmo_in(self.document(), target)
    }

    fn gizmo_in(&self, document: &Document, target: TransformTarget) -> Option<TransformGizmo> {
        let selected = self.outermost_selected();
        self.selected_layers
            .gizmo
            .gizmo_for(document, GizmoContent::new(target, document, &selected))
    }

    /// The gizmo around the selected layers turns with them from now on.
    pub(in crate::session) fn hold_gizmo(&mut self, target: TransformTarget) {
        let (document, layers) = (self.document().clone(), self.outermost_selected());
        self.selected_layers.gizmo.hold(&document, GizmoContent::new(target, &document, &layers));
    }

    /// The gizmo around the selected layers is turned about this point from now on, by shares of
    /// its sides.
    pub(in crate::session) fn set_pivot(&mut self, target: TransformTarget, share: Vec2) {
        let (document, layers) = (self.document().clone(), self.outermost_selected());
        self.selected_layers.gizmo.set_pivot(
            &document,
            GizmoContent::new(target, &document, &layers),
            share,
        );
    }

    pub(in crate::session) fn gizmo_memory(&self) -> &GizmoMemory {
        &self.selected_layers.gizmo
    }

    /// Whether more than one layer is selected.
    pub fn has_several(&self) -> bool {
        self.selected_layers().len() > 1
    }

    /// The start of a range that Shift extends.
    pub fn range_start(&self) -> Option<LayerId> {
        self.selected_layers.anchor.filter(|id| self.is_selected(*id)).or(self.active_layer)
    }

    /// Selects layers; the active one is the last of them. If none are given, nothing changes.
    pub fn select_layers(&mut self, ids: Vec<LayerId>) {
        if let Some(active_layer) = ids.last().copied() {
            self.active_layer = Some(active_layer);
            self.selected_layers.select_as(SelectedLayers::of(ids));
        }
    }

    /// The same, with the start of the range to extend.
    pub fn select_range(&mut self, ids: Vec<LayerId>, anchor: Option<LayerId>) {
        self.select_layers(ids);
        self.selected_layers.anchor = anchor.or(self.selected_layers.anchor);
    }

    /// With a layer added to those selected, or removed from them, the active one last. The last
    /// one stays.
    pub fn toggle_selected(&self, layer: LayerId) -> Vec<LayerId> {
        let mut ids = self.selected_layers();
        match ids.iter().position(|id| *id == layer) {
            Some(_) if ids.len() == 1 => {}
            Some(at) => {
                ids.remove(at);
                // The active one stays the same, if it is left.
                if let Some(active_layer) =
                    self.active_layer.filter(|active_layer| *active_layer != layer)
                {
                    ids.retain(|id| *id != active_layer);
                    ids.push(active_layer);
                }
            }
            None => ids.push(layer),
        }
        ids
    }
}

/// The layers from one to another in the order of the list, the other last. `listed`: in any
/// direction.
pub fn range(listed: &[LayerId], from: LayerId, to: LayerId) -> Vec<LayerId> {
    let place = |id: LayerId| listed.iter().position(|other| *other == id);
    let (Some(a), Some(b)) = (place(from), place(to)) else { return vec![to] };
    let mut ids = listed[a.min(b)..=a.max(b)].to_vec();
    ids.retain(|id| *id != to);
    ids.push(to);
    ids
}

/// The layer above (positive) or beneath another one, groups opened and counted after what is in
/// them; at an end the layer itself.
pub fn neighbor(document: &Document, layer: LayerId, by: i32) -> LayerId {
    let all: Vec<LayerId> = document.walk().iter().map(|(_, layer)| layer.id).collect();
    let at = all.iter().position(|id| *id == layer).unwrap_or(0);
    let to = at.saturating_add_signed(by as isize).min(all.len().saturating_sub(1));
    all.get(to).copied().unwrap_or(layer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, Layer};
    use crate::math::{Size, srgb::Color};
    use std::sync::Arc;

    fn open() -> (OpenDocument, Vec<LayerId>) {
        let fill = |i: usize| Arc::new(Layer::new(i.to_string(), Content::Fill(Color::BLACK)));
        let document =
            Document { layers: (0..5).map(fill).collect(), ..Document::empty(Size::new(4, 4)) };
        let ids = document.layers.iter().map(|layer| layer.id).collect();
        (OpenDocument::new("five", document, None), ids)
    }

    #[test]
    fn a_click_with_ctrl_adds_a_layer_and_a_second_takes_it_away() {
        let (mut open, ids) = open();
        open.select_layers(vec![ids[1]]);
        open.select_layers(open.toggle_selected(ids[3]));
        assert_eq!(
            (open.selected_layers(), open.active_layer),
            (vec![ids[1], ids[3]], Some(ids[3]))
        );
        open.select_layers(open.toggle_selected(ids[1]));
        assert_eq!((open.selected_layers(), open.active_layer), (vec![ids[3]], Some(ids[3])));
        open.select_layers(open.toggle_selected(ids[3]));
        assert_eq!(open.selected_layers(), [ids[3]], "one is always selected");
    }

    #[test]
    fn a_range_keeps_its_beginning_while_its_end_moves() {
        let (mut open, ids) = open();
        open.select_layers(vec![ids[2]]);
        for (end, selected) in [(4, 2..5), (1, 1..3), (2, 2..3)] {
            let start = open.range_start().unwrap();
            open.select_range(range(&ids, start, ids[end]), Some(start));
            assert_eq!(
                (open.selected_layers(), open.active_layer),
                (ids[selected].to_vec(), Some(ids[end]))
            );
        }
    }

    #[test]
    fn selecting_another_layer_lets_go_of_the_others() {
        let (mut open, ids) = open();
        open.select_layers(ids.clone());
        assert!(open.has_several() && open.is_selected(ids[0]));
        open.active_layer = Some(LayerId::fresh());
        open.repair();
        open.select_layers(vec![ids[1]]);
        assert!(!open.has_several() && !open.is_selected(ids[0]));
    }

    #[test]
    fn a_layer_that_is_gone_is_no_longer_selected() {
        let (mut open, ids) = open();
        open.select_layers(vec![ids[0], ids[1], ids[2]]);
        let next = open.document().without_layer(ids[1]).unwrap();
        open.commit("Delete layer", next);
        assert_eq!(open.selected_layers(), [ids[0], ids[2]]);
        assert_eq!(neighbor(open.document(), ids[2], -1), ids[0]);
        assert_eq!(neighbor(open.document(), ids[4], 1), ids[4]);
    }
}
