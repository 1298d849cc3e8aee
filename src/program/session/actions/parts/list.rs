//! The list of parts without one, with a copy of one, or in another order. What lies on a part (touches, sculpting,
//! reliefs) stands behind it in the list, and goes along.
//! Floor 6.

use super::free_id;
use crate::document::Document;
use crate::document::parts::{Part, PartKind};
use std::sync::Arc;

pub use crate::tools::shape::{changed as with, with_new};

/// Without a part and what lies on it.
pub fn without(document: &Document, id: &str) -> Document {
    let stays = |part: &&Arc<Part>| part.id != id && part.on() != Some(id);
    document.with_parts(document.parts.list.iter().filter(stays).cloned().collect())
}

/// With a part before so many others that have a form of their own; of those that lie on another, among these.
pub fn ordered(document: &Document, id: &str, index: usize) -> Document {
    let list = &document.parts.list;
    let Some(own) = list.iter().find(|part| part.id == id).map(|part| part.on()) else { return document.clone() };
    let mut siblings: Vec<&Arc<Part>> = list.iter().filter(|part| part.on() == own && part.id != id).collect();
    let Some(moved) = list.iter().find(|part| part.id == id) else { return document.clone() };
    siblings.insert(index.min(siblings.len()), moved);
    let mut left = siblings.into_iter();
    // The places of siblings are filled anew; then each part stands before what lies on it.
    let order: Vec<&Arc<Part>> =
        list.iter().filter_map(|part| if part.on() == own { left.next() } else { Some(part) }).collect();
    let upon = |id: &str| order.iter().filter(move |part| part.on() == Some(id)).collect::<Vec<_>>();
    let is_loose = |part: &&&Arc<Part>| part.on().is_none_or(|on| document.parts.part(on).is_none());
    let grouped = order.iter().filter(is_loose).flat_map(|part| std::iter::once(part).chain(upon(&part.id)));
    let mut next: Vec<Arc<Part>> = grouped.map(|part| (*part).clone()).collect();
    // What lies on something that lies on another makes nothing, but is kept.
    next.extend(
        order
            .iter()
            .filter(|part| !next.iter().any(|known| known.id == part.id))
            .map(|part| (*part).clone())
            .collect::<Vec<_>>(),
    );
    document.with_parts(next)
}

/// With a copy of a part and of what lies on it, right before it; and the copy's id.
pub fn duplicated(document: &Document, part: &Part) -> (Document, String) {
    let mut list = document.parts.list.clone();
    let id = free_id(document, &[]);
    let copy = Part { id: id.clone(), name: format!("{} copy", part.name), ..part.clone() };
    let mut copies = vec![Arc::new(copy)];
    for other in document.parts.list.iter().filter(|other| other.on() == Some(part.id.as_str())) {
        let mut other = Part { id: free_id(document, &copies), ..Part::clone(other) };
        if let PartKind::Touches { on, .. }
        | PartKind::Sculpt { on, .. }
        | PartKind::Relief { on, .. }
        | PartKind::Lines { on, .. } = &mut other.kind
        {
            on.clone_from(&id);
        }
        copies.push(Arc::new(other));
    }
    let last = list.iter().rposition(|other| other.id == part.id || other.on() == Some(part.id.as_str()));
    let at = last.map_or(list.len(), |at| at + 1);
    list.splice(at..at, copies);
    (document.with_parts(list), id)
}
