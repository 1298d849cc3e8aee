//! Paint of 16 bits a channel as far as there is memory for it: what does not fit is read with 8,
//! and a note says so. Floor 5. Readers ask [`Budget::sixteen_bit_paint`]; which tiles have 16 bits
//! is the rule of `raster::tile::sixteen_bit`.

#![warn(missing_docs)]

use crate::document::{Content, Document, MemoryCount};
use crate::{Budget, Error, Remedy, Result, memory};
use std::path::Path;

/// What was read, and a sentence if its paint had to be rounded to 8 bits.
pub type Fitted<T> = (T, Option<String>);

/// Reads a document with the depth of its files. If the budget does not hold it and what flattening
/// takes, it is read again with paint of 8 bits.
///
/// * `read`: is called a second time only in that case, after what it returned first is freed.
///
/// Fails as the first reading did if the second one fails too.
pub fn read_within_budget<T>(
    file: &Path,
    budget: &Budget,
    read: impl Fn(&Budget) -> Result<T>,
    document: impl Fn(&T) -> &Document,
) -> Result<Fitted<T>> {
    let read = |budget: &Budget| {
        memory::catch_out_of_memory(|| read(budget))
            .unwrap_or_else(|refused| Err(Error::out_of_memory(file, refused)))
    };
    let first = read(budget);
    let fits = match &first {
        Ok(found) => is_held(document(found), budget),
        Err(error) => error.remedy() != Some(Remedy::MoreMemory),
    };
    if fits || !budget.sixteen_bit_paint {
        return first.map(|found| (found, None));
    }
    // Freed first: both together would not fit.
    let refused = first.err();
    let rounded = Budget { sixteen_bit_paint: false, ..*budget };
    match (read(&rounded), refused) {
        (Ok(found), _) => Ok((found, Some(NOTE.to_owned()))),
        (Err(_), Some(first)) => Err(first),
        (Err(second), None) => Err(second),
    }
}

const NOTE: &str = "its paint was read with 8 bits a channel: there is too little memory for 16";

/// Whether a document has no paint of 16 bits, or fits the budget together with what flattening it
/// takes.
fn is_held(document: &Document, budget: &Budget) -> bool {
    let is_16_bit = document.walk().into_iter().any(|(_, layer)| match &layer.content {
        Content::Pixels(pixels) => pixels.tiles.is_16_bit_in(pixels.tiles.bounds()),
        _ => false,
    });
    let mut held = MemoryCount::default();
    held.add(document, true);
    !is_16_bit
        || budget
            .room_for("", held.sum_up().total().saturating_add(document.flattening_bytes()))
            .is_ok()
}

#[cfg(test)]
mod tests;
