//! What a document's surface was made of: while all of it is the same, the surface is that of its
//! parts. Floor 4.
//!
//! The surface of a document with parts is kept, not computed wherever it is read, since it takes
//! seconds. That it is the right one is a fact of the document, and no edit has to say so:
//! [`Document::is_shaped`] compares what the surface was made of with what it would be made of now,
//! by the same keys by which outlines are known again.

use super::Part;
use super::outlines::OutlineKey;
use super::unchanged::{are_same_parts, is_same_surface};
use crate::document::{Document, Progress};
use crate::math::Size;
use crate::memory::free_bytes;
use crate::surface::Surface;
use std::sync::{Arc, Weak};

/// All that a surface was made of.
pub struct SurfaceInputs {
    size: Size,
    maps: Option<Arc<Surface>>,
    list: Vec<Arc<Part>>,
    /// What each visible part is made of.
    outlines: Vec<Option<OutlineKey>>,
    /// The surface; not held by this, so that one that was replaced is freed.
    made: Option<Weak<Surface>>,
}

impl Document {
    /// Whether its surface is what its parts, its layers and its maps make, its ink layers show the
    /// ink of their drawings, and hatching follows the layers that it reads. If not,
    /// [`Document::reshaped`] makes it.
    pub fn is_shaped(&self) -> bool {
        self.is_inked_and_shaped() && self.has_form_sources()
    }

    fn is_inked_and_shaped(&self) -> bool {
        self.is_ink_lifted() && self.has_its_surface()
    }

    pub(super) fn has_its_surface(&self) -> bool {
        let Some(made) = &self.parts.made_of else { return self.parts.is_empty() };
        let of = made.made.as_ref().map(Weak::as_ptr);
        self.parts.is_empty()
            || !self.parts.is_ahead
                && of == self.surface.as_ref().map(Arc::as_ptr)
                && made.size == self.size
                && is_same_surface(&made.maps, &self.parts.maps)
                && are_same_parts(&made.list, &self.parts.list)
                && are_same_outlines(&made.outlines, &self.outline_keys())
    }

    /// The document with the surface that its parts, layers and maps make now, with what lies on
    /// parts at their places, and with what follows the surface; itself, at once, if it is so
    /// already ([`Document::is_shaped`]). Every step of a [`History`](crate::document::History) and
    /// every document that was read is so.
    ///
    /// If less memory is free than that takes, nothing is made, and [`Document::fits`] says so.
    pub fn reshaped(&self) -> Document {
        // Nobody cancels it, so it is complete.
        self.reshaped_with_progress(&Progress::default()).unwrap_or_else(|| self.clone())
    }

    /// The same, a step for each part; `None` if canceled.
    pub fn reshaped_with_progress(&self, progress: &Progress) -> Option<Document> {
        Some(self.shaped_with_progress(progress)?.with_form_sources())
    }

    /// Without what hatching reads.
    fn shaped_with_progress(&self, progress: &Progress) -> Option<Document> {
        let placed = self.with_attachments_placed().with_ink_lifted();
        if placed.is_inked_and_shaped() {
            placed.parts.forget_flats();
            return Some(placed.with_selections_found());
        }
        if placed.shape_fits_in(free_bytes()).is_err() {
            return Some(self.clone());
        }
        progress.enter("making the shape");
        // On a thread of the pool: handed over one by one, the many small steps of small parts
        // would take longer than they need.
        let made = rayon::scope(|_| placed.derived(progress));
        progress.enter("");
        made
    }

    /// What its surface is made of, once it is.
    pub(super) fn surface_inputs(&self) -> SurfaceInputs {
        let (maps, list) = (self.parts.maps.clone(), self.parts.list.clone());
        let made = self.surface.as_ref().map(Arc::downgrade);
        SurfaceInputs { size: self.size, maps, list, outlines: self.outline_keys(), made }
    }

    /// What each visible part is made of; `None` for what does not exist.
    fn outline_keys(&self) -> Vec<Option<OutlineKey>> {
        let shown = self.parts.list.iter().filter(|part| part.visible);
        shown.map(|part| OutlineKey::of_part(self, part).flatten()).collect()
    }
}

fn are_same_outlines(a: &[Option<OutlineKey>], b: &[Option<OutlineKey>]) -> bool {
    let same = |(a, b): (&Option<OutlineKey>, &Option<OutlineKey>)| match (a, b) {
        (Some(a), Some(b)) => a.is_same(b),
        (a, b) => a.is_none() && b.is_none(),
    };
    a.len() == b.len() && a.iter().zip(b).all(same)
}
