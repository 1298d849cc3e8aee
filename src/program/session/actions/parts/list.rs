//! Copying parts and reordering their list. What is on a part (touches, sculpting, reliefs, lines)
//! follows it in the list and moves with it.
//! Floor 6. Not here: simpler edits of the list (`document::parts`).

use super::free_id;
use crate::document::Document;
use crate::document::parts::Part;
use std::sync::Arc;

pub use crate::tools::shape::with_new;

/// With a part in front of so many others that have a form of their own; a part that lies on
/// another, among those on the same one.
pub fn with_part_at(document: &Document, id: &str, index: usize) -> Document {
    let Some(on) = document.parts.part(id).map(|part| part.on().map(str::to_owned)) else {
        return document.clone();
    };
    let (moved, mut list) = partition_by_part(document, id);
    let mut siblings =
        list.iter().enumerate().filter(|(_, part)| part.on() == on.as_deref()).map(|(at, _)| at);
    let at = siblings.clone().nth(index);
    // In front of all: after the last of those that lie on the same part, or, for whole parts, at
    // the end of the list.
    let last = on.as_ref().and_then(|_| siblings.next_back()).map(|at| at + 1);
    let at = at.or(last).unwrap_or(list.len());
    list.splice(at..at, moved);
    document.with_parts(list)
}

/// A part with what lies on it, and all others.
fn partition_by_part(document: &Document, id: &str) -> (Vec<Arc<Part>>, Vec<Arc<Part>>) {
    let goes = |part: &Arc<Part>| {
        part.id == id || document.parts.body_of(&part.id).is_some_and(|body| body.id == id)
    };
    document.parts.list.iter().cloned().partition(goes)
}

/// With a copy of a part and of what lies on it, right before it; and the copy's id.
pub fn duplicate(document: &Document, part: &Part) -> (Document, String) {
    let (own, _) = partition_by_part(document, &part.id);
    let id = free_id(document, &[]);
    let copy = Part { id: id.clone(), name: format!("{} copy", part.name), ..part.clone() };
    let mut copies = vec![Arc::new(copy)];
    for other in own.iter().filter(|other| other.on() == Some(part.id.as_str())) {
        let mut other = Part { id: free_id(document, &copies), ..Part::clone(other) };
        other.lie_on(&id);
        copies.push(Arc::new(other));
    }
    let mut list = document.parts.list.clone();
    let last = list.iter().rposition(|other| own.iter().any(|own| own.id == other.id));
    let at = last.map_or(list.len(), |at| at + 1);
    list.splice(at..at, copies);
    (document.with_parts(list), id)
}
