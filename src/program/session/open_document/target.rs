//! What the next edit of an open document applies to. Floor 6. Every step of the history holds it
//! as it was before and after the step, so that undo and redo put the user back where the step was
//! made; recovery logs hold the last one. Not here: the tool in hand, which belongs to all
//! documents and which undo never takes away.

use super::OpenDocument;
use super::selected_layers::SelectedLayers;
use crate::document::{Document, LayerId};
use crate::session::replay::{ReplayValue, record};
use crate::session::{LayerPath, LayerPaths};
use serde_json::Value;

/// What is selected, and what the brush paints on.
#[derive(Clone, Debug, Default)]
pub struct EditTarget {
    active_layer: Option<LayerId>,
    layers: SelectedLayers,
    part: Option<String>,
    strokes: Option<(LayerId, Vec<usize>)>,
    on_mask: bool,
    quick_mask: bool,
}

/// The same by paths, which are valid in another run of the program. Strokes are those of the
/// active layer.
struct StoredTarget {
    active_layer: Option<LayerPath>,
    layers: LayerPaths,
    part: Option<String>,
    strokes: Vec<usize>,
    on_mask: bool,
    quick_mask: bool,
}
record!(StoredTarget { active_layer, layers, part, strokes, on_mask, quick_mask });

impl OpenDocument {
    /// What the next edit applies to.
    pub(super) fn target(&self) -> EditTarget {
        EditTarget {
            active_layer: self.active_layer,
            layers: self.selected_layers.without_gizmo(),
            part: self.part.clone(),
            strokes: self.selected_strokes.clone(),
            on_mask: self.on_mask,
            quick_mask: self.quick_mask,
        }
    }

    /// Goes back to a target; where something of it is gone, another takes its place.
    pub(super) fn aim(&mut self, target: EditTarget) {
        let EditTarget { active_layer, layers, part, strokes, on_mask, quick_mask } = target;
        self.selected_layers.select_as(layers);
        (self.active_layer, self.part, self.selected_strokes) = (active_layer, part, strokes);
        (self.on_mask, self.quick_mask) = (on_mask, quick_mask);
        self.repair();
    }

    /// Where the last step left the user is what redo goes back to: called before the target is
    /// changed by anything but a step.
    pub(in crate::session) fn record_target(&mut self) {
        if !self.history.has_target_after() {
            let after = self.target();
            self.history.set_target_after(after);
        }
    }

    /// The target for a recovery log.
    pub(in crate::session) fn stored_target(&self) -> Value {
        let document = self.document();
        let stored = StoredTarget {
            active_layer: self.active_layer.and_then(|id| LayerPath::of(document, id)),
            layers: LayerPaths::of(document, &self.selected_layers()),
            part: self.part.clone(),
            strokes: self.selected_strokes(),
            on_mask: self.on_mask,
            quick_mask: self.quick_mask,
        };
        stored.to_value()
    }

    /// Goes to a target from a recovery log. One that cannot be read, as of an older log, changes
    /// nothing.
    pub(in crate::session) fn aim_as_stored(&mut self, value: &Value) {
        if let Ok(stored) = StoredTarget::read(value) {
            let target = stored.find(self.document());
            self.aim(target);
        }
    }
}

impl StoredTarget {
    fn find(self, document: &Document) -> EditTarget {
        let active_layer =
            self.active_layer.and_then(|path| path.find(document)).map(|layer| layer.id);
        let mut layers = self.layers.find(document).unwrap_or_default();
        layers.extend(active_layer);
        EditTarget {
            active_layer,
            layers: SelectedLayers::of(layers),
            part: self.part,
            strokes: active_layer.map(|layer| (layer, self.strokes)),
            on_mask: self.on_mask,
            quick_mask: self.quick_mask,
        }
    }
}
