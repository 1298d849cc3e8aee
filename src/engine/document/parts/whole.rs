//! The forms of a document combined, the farthest first. While they are those of the last surface,
//! nothing is combined again. Floor 4.

use super::body::of_surface;
use super::form_cache::{FormArea, MadePart, MadeSurface};
use super::unchanged::is_same_surface;
use crate::document::Document;
use crate::shape::{Combine, Form, Relief};
use crate::surface::Surface;
use std::sync::{Arc, MutexGuard, PoisonError};

type LastSurface = (Vec<(Arc<FormArea>, Combine)>, Option<Arc<Surface>>);

/// Forms that become a surface. Only one of them need be held at a time.
pub struct Whole<'d> {
    document: &'d Document,
    /// The last surface and its forms, if it was made on the same canvas and maps.
    last: Option<LastSurface>,
    /// Without their forms, so that the cache can let go of these.
    added: Vec<MadePart>,
    /// What they make together, once one differs.
    relief: Option<Relief>,
}

impl<'d> Whole<'d> {
    pub fn new(document: &'d Document) -> Self {
        let is_same = |made: &&MadeSurface| {
            made.size == document.size && is_same_surface(&made.maps, &document.parts.maps)
        };
        let last = lock(document)
            .as_ref()
            .filter(is_same)
            .map(|made| (made.forms.clone(), made.surface.clone()));
        Self { document, last, added: Vec::new(), relief: None }
    }

    /// One more form in front; `form`: where it was made just now or is kept.
    pub fn add(&mut self, made: MadePart, form: Option<Arc<Form>>) {
        let known = self.last.as_ref().and_then(|(forms, _)| forms.get(self.added.len()));
        let is_same = known
            .is_some_and(|(area, way)| Arc::ptr_eq(area, &made.area) && *way == made.part.combine);
        if !is_same {
            self.begin();
        }
        self.put(&made, form.or_else(|| made.form()));
        self.added.push(MadePart { kept: None, ..made });
    }

    fn put(&mut self, made: &MadePart, form: Option<Arc<Form>>) {
        let Some(relief) = &mut self.relief else { return };
        let form = form.or_else(|| self.document.derive_again(made));
        if let Some(form) = form {
            let id = relief.piece_of.len() as u32;
            relief.add(&form, made.part.combine, id);
        }
    }

    /// Combines those that were added.
    fn begin(&mut self) {
        if self.relief.is_some() {
            return;
        }
        let mut relief = Relief::empty(self.document.size);
        if let Some(maps) =
            self.document.parts.maps.as_ref().filter(|maps| maps.size() == self.document.size)
        {
            relief.add(&of_surface(maps), Combine::Over, 1);
        }
        self.relief = Some(relief);
        let cache = &self.document.parts.cache;
        for made in std::mem::take(&mut self.added) {
            let known =
                cache.get(&made.part.id).filter(|known| Arc::ptr_eq(&known.area, &made.area));
            self.put(&made, known.and_then(|known| known.form()));
            self.added.push(made);
        }
    }

    /// The surface; the last one if it is the same.
    pub fn finish(mut self) -> Option<Arc<Surface>> {
        if let (None, Some((forms, surface))) = (&self.relief, &self.last)
            && forms.len() == self.added.len()
        {
            return surface.clone();
        }
        self.begin();
        let mut known = lock(self.document).take().map(|made| made.nearest).unwrap_or_default();
        let made = self.relief.and_then(|relief| relief.into_surface(&mut known).ok());
        let surface =
            made.map(|made| Arc::new(made.pointing_on(self.document.parts.points.as_ref())));
        let forms = self.added.into_iter().map(|made| (made.area, made.part.combine)).collect();
        let (maps, size) = (self.document.parts.maps.clone(), self.document.size);
        *lock(self.document) =
            Some(MadeSurface { forms, maps, size, surface: surface.clone(), nearest: known });
        surface
    }
}

fn lock(document: &Document) -> MutexGuard<'_, Option<MadeSurface>> {
    document.parts.cache.whole.lock().unwrap_or_else(PoisonError::into_inner)
}
