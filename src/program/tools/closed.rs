//! Layers that the pen cannot change: locked ones, and ones that are not shown, where the user
//! would not see what happens. Floor 5. Each reason is a sentence that names the layer and what to
//! do.

use crate::document::{Document, Layer, LayerId, LayerLock};

/// Why nothing can be done to the content of a layer: it is locked.
pub fn why_locked(layer: &Layer) -> Option<String> {
    let is_locked = layer.lock == LayerLock::All;
    is_locked.then(|| {
        format!(
            "“{}” is locked. Unlock it (Layer, Lock layer), or select another layer.",
            layer.name
        )
    })
}

/// Why nothing can be painted on a layer: it is locked, or it or a group around it is hidden.
pub fn unpaintable(document: &Document, layer: &Layer) -> Option<String> {
    why_locked(layer).or_else(|| why_hidden(document, layer.id))
}

/// Why paint on a layer would not be seen: it or a group around it is hidden.
pub fn why_hidden(document: &Document, id: LayerId) -> Option<String> {
    let layer = document.layer(id)?;
    if !layer.visible {
        return Some(format!(
            "“{}” is hidden. Show it (Layer, Show or hide layer), or select another layer.",
            layer.name
        ));
    }
    why_hidden_around(document, id)
}

/// Why paint next to a layer would not be seen: a group around it is hidden.
pub fn why_hidden_around(document: &Document, id: LayerId) -> Option<String> {
    let layer = document.layer(id)?;
    let mut around = document.place_of(id)?.group;
    while let Some(group) = around.and_then(|id| document.layer(id)) {
        if !group.visible {
            let (inner, outer) = (&layer.name, &group.name);
            return Some(format!(
                "“{inner}” is in the hidden group “{outer}”. Show the group, or select another \
                 layer."
            ));
        }
        around = document.place_of(group.id)?.group;
    }
    None
}
