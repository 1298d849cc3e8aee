//! What steps of the history are called: what was done, and to which layer. Floor 6.

use crate::document::{Document, EditLabel, LabeledLayer, Layer, LayerId};
use std::collections::HashMap;
use std::sync::Arc;

/// The label of an edit between two documents.
pub fn label(name: String, before: &Document, after: &Document) -> EditLabel {
    let (old, new) = (by_id(before), by_id(after));
    let is_changed =
        |layer: &&Arc<Layer>| old.get(&layer.id).is_none_or(|known| !Arc::ptr_eq(known, layer));
    let changed: Vec<LayerId> =
        new.values().copied().filter(is_changed).map(|layer| layer.id).collect();
    // A group changes with what is in it.
    let holds = |id: &LayerId| {
        let group = new.get(id).and_then(|layer| layer.content.group());
        group.is_some_and(|group| group.layers.iter().any(|inner| changed.contains(&inner.id)))
    };
    let innermost: Vec<LayerId> = changed.iter().copied().filter(|id| !holds(id)).collect();
    let apart = |document: &Document,
                 all: &HashMap<LayerId, &Arc<Layer>>,
                 others: &HashMap<LayerId, &Arc<Layer>>| {
        document.outermost(
            &all.keys().copied().filter(|id| !others.contains_key(id)).collect::<Vec<_>>(),
        )
    };
    let (came, gone) = (apart(after, &new, &old), apart(before, &old, &new));
    let layer = match (&came[..], &gone[..], &innermost[..]) {
        ([one], _, _) => new.get(one).map(|layer| LabeledLayer::Listed(layer.name.clone())),
        ([], [one], _) => old.get(one).map(|layer| LabeledLayer::Listed(layer.name.clone())),
        ([], [], [one]) => new.get(one).map(|layer| LabeledLayer::Changed(layer.name.clone())),
        _ => None,
    };
    EditLabel { name, layer }
}

fn by_id(document: &Document) -> HashMap<LayerId, &Arc<Layer>> {
    fn add<'a>(layers: &'a [Arc<Layer>], all: &mut HashMap<LayerId, &'a Arc<Layer>>) {
        for layer in layers {
            all.insert(layer.id, layer);
            if let Some(group) = layer.content.group() {
                add(&group.layers, all);
            }
        }
    }
    let mut all = HashMap::new();
    add(&document.layers, &mut all);
    all
}

/// “Brush stroke on “beard””.
pub fn sentence(label: &EditLabel) -> String {
    let name = &label.name;
    match &label.layer {
        Some(LabeledLayer::Changed(layer)) if !name.ends_with("layer") => {
            format!("{name} on “{layer}”")
        }
        Some(LabeledLayer::Changed(layer) | LabeledLayer::Listed(layer)) => {
            format!("{name} “{layer}”")
        }
        None => name.clone(),
    }
}
