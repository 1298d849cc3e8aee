//! Edits of the list of parts. Each gives a new document with the surface that follows from it;
//! what lies on a part is carried by it. Floor 4. Not here: what lies where
//! (`document::attachments`).

use super::{CoverageFile, OutlineSource, Part, Parts};
use crate::document::{Document, LayerId, NamedSelection, Progress};
use crate::surface::Surface;
use std::sync::Arc;

impl Document {
    /// The surface of the document's maps alone, beneath its parts.
    pub fn maps_surface(&self) -> Option<&Arc<Surface>> {
        if self.parts.is_empty() { self.surface.as_ref() } else { self.parts.maps.as_ref() }
    }

    /// With other parts, and the surface that follows from them. What lies on parts that go stays
    /// where it shows.
    pub fn with_parts(&self, list: Vec<Arc<Part>>) -> Document {
        self.with_parts_unshaped(list).reshaped()
    }

    /// The same, a step for each part; `None` if canceled.
    pub fn with_parts_with_progress(
        &self,
        list: Vec<Arc<Part>>,
        progress: &Progress,
    ) -> Option<Document> {
        self.with_parts_unshaped(list).reshaped_with_progress(progress)
    }

    /// With other parts, but not yet with their surface: for [`Document::reshaped`].
    pub fn with_parts_unshaped(&self, list: Vec<Arc<Part>>) -> Document {
        let maps = self.maps_surface().cloned();
        let stays = |id: &str| list.iter().any(|part| part.id == id);
        let goes = |part: &Arc<Part>| !stays(&part.id);
        let mut next = match self.parts.list.iter().any(goes) {
            true => self.detach(|id| !stays(id)),
            false => self.clone(),
        };
        if list.is_empty() {
            next.surface = maps.clone();
        }
        // Those that stay lost are found again with the surface.
        let lost = self.parts.lost.iter().filter(|id| stays(id)).cloned().collect();
        next.parts =
            Arc::new(Parts { list, maps, lost, is_ahead: false, ..Parts::clone(&self.parts) });
        next
    }

    /// With a part in the place of the one of its id, or in front of all.
    pub fn with_part(&self, part: Part) -> Document {
        self.with_parts(self.list_with(part))
    }

    fn list_with(&self, part: Part) -> Vec<Arc<Part>> {
        let mut list = self.parts.list.clone();
        match list.iter_mut().find(|known| known.id == part.id) {
            Some(known) => *known = Arc::new(part),
            None => list.push(Arc::new(part)),
        }
        list
    }

    /// With other parts while the user drags: what lies on parts follows at once, the surface stays
    /// that of the parts before until [`Document::reshaped`], which takes too long for a drag.
    pub fn with_parts_ahead(&self, list: Vec<Arc<Part>>) -> Document {
        let next = self.with_parts_unshaped(list);
        if next.parts.is_empty() {
            return next;
        }
        let parts = Arc::new(Parts { is_ahead: true, ..Parts::clone(&next.parts) });
        Document { parts, ..next }.with_attachments_placed()
    }

    /// The same with one part, as [`Document::with_part`] does it.
    pub fn with_part_ahead(&self, part: Part) -> Document {
        self.with_parts_ahead(self.list_with(part))
    }

    /// The user drags its parts: they are where the hand is, and its surface follows when it is
    /// asked for.
    pub fn is_ahead(&self) -> bool {
        self.parts.is_ahead
    }

    /// Without a part and those that change it. What lies on it stays where it shows, no longer
    /// carried. `None` if there is no such part.
    pub fn without_part(&self, id: &str) -> Option<Document> {
        self.parts.part(id)?;
        let stays = |part: &&Arc<Part>| {
            part.id != id && self.parts.body_of(&part.id).is_none_or(|body| body.id != id)
        };
        Some(self.with_parts(self.parts.list.iter().filter(stays).cloned().collect()))
    }

    /// With a part at another place, counted without it, the farthest 0; beyond the last means in
    /// front of all. `None` if there is no such part.
    pub fn with_part_at(&self, id: &str, index: usize) -> Option<Document> {
        let mut list = self.parts.list.clone();
        let part = list.remove(list.iter().position(|part| part.id == id)?);
        list.insert(index.min(list.len()), part);
        Some(self.with_parts(list))
    }

    /// Without the parts that its layers lie on, which are those of `list`: what lies on them stays
    /// where it shows.
    pub fn off_parts(&self, list: Vec<Arc<Part>>) -> Document {
        let parts = Arc::new(Parts { list, ..Parts::default() });
        let placed = Document { parts, ..self.clone() }.with_attachments_placed();
        Document { parts: Arc::default(), ..placed.detach(|_| true) }
    }

    /// With the outlines that follow a kept selection keeping it as a picture.
    pub(in crate::document) fn without_outlines_of(&self, selection: &NamedSelection) -> Document {
        let names = |part: &Arc<Part>| match part.outline() {
            Some(OutlineSource::Selection(name)) => *name == selection.name,
            _ => false,
        };
        if !self.parts.list.iter().any(names) {
            return self.clone();
        }
        let coverage = Arc::new(selection.selection.coverage.to_plane(self.size.rect()));
        let next = |part: &Arc<Part>| {
            let mut own = Part::clone(part);
            match own.outline_mut().filter(|_| names(part)) {
                Some(outline) => {
                    *outline = OutlineSource::File(CoverageFile {
                        file: String::new(),
                        coverage: coverage.clone(),
                    })
                }
                None => return part.clone(),
            }
            Arc::new(own)
        };
        self.with_parts(self.parts.list.iter().map(next).collect())
    }

    /// With other maps beneath its parts.
    pub fn with_maps(&self, surface: Option<Arc<Surface>>) -> Document {
        let mut next = self.clone();
        if self.parts.is_empty() {
            next.surface = surface;
            return next;
        }
        next.parts = Arc::new(Parts { maps: surface, ..Parts::clone(&self.parts) });
        next.reshaped()
    }

    /// With outlines naming layers by their present names; `before`: the document in which a layer
    /// had another name.
    pub(in crate::document) fn with_outlines_renamed(
        self,
        before: &Document,
        id: LayerId,
    ) -> Document {
        let names = before
            .layer(id)
            .zip(self.layer(id))
            .map(|(old, new)| (old.name.clone(), new.name.clone()));
        let Some((old, new)) = names.filter(|(old, new)| old != new) else { return self };
        // If several layers have a name, outlines name the topmost.
        let is_named = before.layer_named(&old).is_some_and(|layer| layer.id == id);
        let renamed = |part: &Arc<Part>| match part.outline() {
            Some(OutlineSource::Layer { layer, .. }) if is_named && *layer == old => {
                let mut next = Part::clone(part);
                if let Some(OutlineSource::Layer { layer, .. }) = next.outline_mut() {
                    layer.clone_from(&new);
                }
                Arc::new(next)
            }
            _ => part.clone(),
        };
        let list = self.parts.list.iter().map(renamed).collect();
        Document { parts: Arc::new(Parts { list, ..Parts::clone(&self.parts) }), ..self }
    }
}
