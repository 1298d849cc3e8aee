//! What is selected in the text that is typed: the panel with the words says it, the canvas shows
//! it. Floor 7.

use crate::document::LayerId;
use eframe::egui::Id;
use std::ops::Range;

/// The letters between the ends of the selection in the field, while it is typed in.
#[derive(Clone, PartialEq)]
pub struct TypedRange {
    pub layer: LayerId,
    /// Bytes of the text.
    pub bytes: Range<usize>,
    /// The end that moves.
    pub caret: usize,
}

/// Where the field says what is selected in it.
pub fn typed_range() -> Id {
    Id::unique("typed range of a text")
}
