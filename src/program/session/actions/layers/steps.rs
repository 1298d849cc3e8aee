//! Steps of several layers: the resulting document, and which layers are selected then. Floor 6.

use super::sibling;
use crate::document::{Content, Document, Group, Layer, LayerId, LayerMask, LayerSlot, MaskKind};
use crate::raster::Plane;
use crate::session::OpenDocument;
use std::sync::Arc;

/// A step: its name, the document, and what is selected then.
pub(super) type EditStep = (&'static str, Document, Vec<LayerId>);

pub(super) fn moves(ids: &[LayerId]) -> &'static str {
    if ids.len() > 1 { "Move layers" } else { "Move layer" }
}

/// What was moved is selected; if it was already, the active one stays the same.
pub(super) fn selection_after_move(open: &OpenDocument, ids: Vec<LayerId>) -> Vec<LayerId> {
    if open.outermost_selected() == ids { Vec::new() } else { ids }
}

/// A layer's mask as a picture to paint on; a new one hides or shows everything.
pub(super) fn paint_mask(document: &Document, layer: &Layer, hides: bool) -> Option<EditStep> {
    let mask = match &layer.mask {
        Some(mask) => mask.as_picture(&document.scene()),
        None => {
            let coverage = Arc::new(Plane::full(document.size, if hides { 0 } else { 255 }));
            LayerMask::new(MaskKind::File { file: String::new(), coverage })
        }
    };
    let next = document.with_layer(layer.id, |layer| layer.mask = Some(mask))?;
    Some(("Layer mask", next, vec![layer.id]))
}

/// Without some layers; then the one beneath the lowest of them is selected.
pub(super) fn delete(document: &Document, ids: &[LayerId]) -> Option<EditStep> {
    let place = document.place_of(*ids.first()?)?;
    let next = document.without_layers(ids)?;
    let neighbor = sibling(&next, LayerSlot { index: place.index.saturating_sub(1), ..place });
    let label = if ids.len() > 1 { "Delete layers" } else { "Delete layer" };
    Some((label, next, neighbor.into_iter().collect()))
}

/// Layers in a new group.
pub(super) fn group(document: &Document, ids: &[LayerId]) -> Option<EditStep> {
    let layers = ids.iter().filter_map(|id| document.layer(*id).cloned()).collect();
    let content = Content::Group(Group { layers, pass_through: false });
    let group = Layer::new(document.free_layer_name("Group"), content);
    let id = group.id;
    let label = if ids.len() > 1 { "Group layers" } else { "Group layer" };
    Some((label, document.with_one_for(ids, group)?, vec![id]))
}

/// Copies above the topmost layer.
pub(super) fn duplicate(document: &Document, ids: &[LayerId]) -> Option<EditStep> {
    let place = document.place_of(*ids.last()?)?;
    let mut next = document.clone();
    let mut copies = Vec::new();
    for (i, id) in ids.iter().enumerate() {
        let layer = document.layer(*id)?;
        let copy = copy_layer(layer, &next.free_layer_name(&format!("{} copy", layer.name)));
        copies.push(copy.id);
        next = next.with_inserted(copy, LayerSlot { index: place.index + 1 + i, ..place })?;
    }
    let label = if ids.len() > 1 { "Duplicate layers" } else { "Duplicate layer" };
    Some((label, next, copies))
}

/// The groups among some layers dissolved.
pub(super) fn ungroup(document: &Document, ids: &[LayerId]) -> Option<EditStep> {
    let (mut next, mut freed) = (document.clone(), Vec::new());
    for id in ids {
        let Some(group) =
            next.layer(*id)?.content.group().map(|_| next.with_transform_applied(*id))
        else {
            continue;
        };
        let applied = group?;
        let attachment = applied.layer(*id)?.on.clone();
        let group = applied.layer(*id)?.content.group()?.clone();
        let place = applied.place_of(*id)?;
        next = applied.without_layer(*id)?;
        for (i, inner) in group.layers.iter().enumerate() {
            next = next.with_inserted(
                Layer::clone(inner),
                LayerSlot { index: place.index + i, ..place },
            )?;
            // What carried the group then carries each of them.
            if let Some(attachment) = attachment.as_ref().filter(|_| inner.on.is_none()) {
                next = next.with_layer_on(inner.id, Some(&attachment.part)).unwrap_or(next);
            }
            freed.push(inner.id);
        }
    }
    Some(("Ungroup", next, freed))
}

/// Layers on a part of the shape, on the canvas, or on what is around each; or why not, for the
/// user.
pub(super) fn attach(
    document: &Document,
    ids: &[LayerId],
    part: Option<&str>,
) -> Result<EditStep, &'static str> {
    if part.is_some_and(|part| document.parts.attachment(part).is_none()) {
        return Err("There is no such part.");
    }
    let on = |next: Document, id: &LayerId| next.with_layer_on(*id, part);
    let next = ids.iter().try_fold(document.clone(), on);
    let why = "This layer has a transform that cannot follow a part. Apply the transform first.";
    next.map(|next| ("Carry with part", next, Vec::new())).ok_or(why)
}

/// Layers without what is selected, or emptied without a selection; a layer that cannot be cleared
/// stays as it is.
pub(super) fn clear_layers(document: &Document, ids: &[LayerId]) -> Option<EditStep> {
    let (mut next, mut is_any) = (document.clone(), false);
    for id in ids {
        let cleared = match document.active_coverage() {
            Some(selected) => next.with_cleared(*id, selected),
            None => {
                let empty = next.layer(*id)?.content.without_paint();
                empty.and_then(|empty| next.with_layer(*id, |layer| layer.content = empty))
            }
        };
        is_any |= cleared.is_some();
        next = cleared.unwrap_or(next);
    }
    let label = if document.active_coverage().is_some() { "Clear" } else { "Clear layer" };
    is_any.then_some((label, next, Vec::new()))
}

/// A copy under fresh ids.
pub(in crate::session::actions) fn copy_layer(layer: &Layer, name: &str) -> Layer {
    let mut copy = Layer { id: LayerId::fresh(), name: name.into(), ..layer.clone() };
    if let Some(group) = copy.content.group_mut() {
        group.layers =
            group.layers.iter().map(|inner| Arc::new(copy_layer(inner, &inner.name))).collect();
    }
    copy
}
