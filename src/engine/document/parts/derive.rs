//! The surface of a document from its parts and its maps; only what changed in a part is made
//! again. Floor 4. Not here: how one kind of part is made (`make`), what is kept (`made`), how
//! forms are combined (`whole`).

use super::body::{PlacedOutline, SolvedOutline, joined_rim, parts_with_lost_outlines};
use super::form_cache::{MadePart, NewForm, Stages};
use super::modifiers::{ResumePoint, with_lines, with_modifier};
use super::outlines::OutlineKey;
use super::unchanged::{
    are_same_inks, are_same_parts, is_same_kind, is_same_shape, split_whole_px,
};
use super::whole::Whole;
use super::{Part, PartKind, Parts};
use crate::document::{Document, Progress};
use crate::math::Affine2;
use crate::shape::Form;
use std::sync::{Arc, Mutex, PoisonError};

/// Stages of forms with more pixels than this are not kept.
const MOST_KEPT_PX: usize = 1 << 24;

impl Document {
    /// As [`Document::reshaped_with_progress`], made even if nothing changed: then what is known costs
    /// nothing.
    pub(super) fn derived(&self, progress: &Progress) -> Option<Document> {
        let shown = || self.parts.list.iter().filter(|part| part.visible && part.on().is_none());
        progress.add_total(shown().count() as u64);
        let outlines = self.placed_outlines(&shown().collect::<Vec<_>>());
        // They are large, and needed for outlines alone.
        self.parts.forget_drawn();
        let mut whole = Whole::new(self);
        for (i, part) in shown().enumerate() {
            if progress.is_canceled() {
                return None;
            }
            if let Some((made, form)) = self.made_now(part, outlines[i].clone(), &outlines[i + 1..])
            {
                whole.add(made, form);
            }
            progress.step();
        }
        self.parts.cache.keep_only(|id| self.parts.part(id).is_some());
        let surface = whole.finish();
        let lost = parts_with_lost_outlines(shown().zip(&outlines));
        let next = Document { surface, ..self.clone() }.with_selections_found();
        let made_of = Some(Arc::new(next.surface_inputs()));
        let parts = Arc::new(Parts { is_ahead: false, lost, made_of, ..Parts::clone(&self.parts) });
        Some(Document { parts, ..next })
    }

    /// The visible parts that lie on another.
    pub(super) fn modifiers_of(&self, part: &Part) -> Vec<Arc<Part>> {
        self.parts
            .list
            .iter()
            .filter(|p| p.visible && p.on() == Some(part.id.as_str()))
            .cloned()
            .collect()
    }

    /// One part as it is now, with what lies on it, and its form where that was made just now;
    /// `None` if it has none.
    ///
    /// * `standing`: its outline in its place, if it has one.
    /// * `in_front`: those of the parts nearer to the viewer.
    fn made_now(
        &self,
        part: &Arc<Part>,
        standing: Option<PlacedOutline>,
        in_front: &[Option<PlacedOutline>],
    ) -> Option<(MadePart, Option<Arc<Form>>)> {
        let cache = &self.parts.cache;
        let modifiers = self.modifiers_of(part);
        let known = cache.get(&part.id);
        let is_edited = known.is_some();
        let source = OutlineKey::of_part(self, part)?;
        let inks: Vec<OutlineKey> =
            modifiers.iter().filter_map(|part| OutlineKey::of_part(self, part)?).collect();
        let (still, moved) = split_whole_px(part.matrix);
        let is_unchanged = |made: &MadePart| match (&made.source, &source) {
            (Some(a), Some(b)) => a.is_same(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        // Paint may change without the outline.
        let same_outline = |made: &MadePart| {
            let both = standing.as_ref().map(|own| &own.outline).zip(made.outline.as_ref());
            matches!(source, Some(OutlineKey::Layer(..)))
                && both.is_some_and(|(a, b)| Arc::ptr_eq(a, b))
        };
        let same_source = |made: &MadePart| is_unchanged(made) || same_outline(made);
        let same_place = |made: &MadePart| split_whole_px(made.part.matrix).0 == still;
        let known = known.filter(|made| same_source(made) && same_place(made));
        // Only what is inflated has a rim that can be free.
        let own = standing.as_ref().filter(|_| matches!(part.kind, PartKind::Inflate { .. }));
        let met = own.map(|own| own.overlapping(in_front)).unwrap_or_default();
        let found = || own.and_then(|own| joined_rim(&own.outline, &met)).map(Arc::new);
        // Where it is free follows from what it met: then as it was, though it may not be kept.
        let (known, free) = match known {
            Some(made) if made.met == met => {
                let free = made.kept.as_ref().map(|kept| kept.body.joined.clone());
                (Some(made), free)
            }
            known => {
                let free = found();
                let is_same = |made: &MadePart| {
                    made.kept.as_ref().is_some_and(|kept| kept.body.joined == free)
                };
                (known.filter(is_same), Some(free))
            }
        };
        let is_lost = standing.as_ref().is_some_and(|own| own.is_lost);
        if let Some(made) = known.as_ref().filter(|made| {
            is_same_shape(&made.part, part)
                && are_same_parts(&made.modifiers, &modifiers)
                && are_same_inks(&made.inks, &inks)
        }) {
            if made.moved == moved && Arc::ptr_eq(&made.part, part) && is_unchanged(made) {
                return Some((made.clone(), None));
            }
            let by = (moved.0 - made.moved.0, moved.1 - made.moved.1);
            let next = MadePart { part: part.clone(), moved, source, met, is_lost, ..made.clone() }
                .moved_by(by);
            cache.remember(next.clone());
            return Some((next, None));
        }
        let free = free.unwrap_or_else(found);
        let outline = standing.map(|own| own.outline);
        let is_kind = known.as_ref().is_some_and(|made| is_same_kind(&made.part.kind, &part.kind));
        let kept = known.as_ref().and_then(|made| made.kept.clone());
        let staged =
            kept.as_ref().filter(|_| is_kind).and_then(|kept| Some((kept, kept.stages.as_ref()?)));
        let (body, plain) = match staged {
            Some((kept, stages)) => (kept.body.clone(), stages.plain.clone()),
            None => {
                let body = kept.as_ref().map(|kept| kept.body.clone());
                let (body, form) =
                    self.solve_form(part, (outline.clone(), source.as_ref()), free, still, body)?;
                (body, Arc::new(form))
            }
        };
        // What lies beneath the last part on it is mostly known: the user works on the last.
        let last = modifiers.len().saturating_sub(1);
        let stages = kept.and_then(|kept| kept.stages.clone());
        let beneath = known.zip(stages).and_then(|(made, stages)| {
            let as_many = made.modifiers.len() == modifiers.len()
                && are_same_parts(&made.modifiers[..last], &modifiers[..last]);
            let is_same =
                as_many && Arc::ptr_eq(&stages.plain, &plain) && are_same_inks(&made.inks, &inks);
            let resume =
                std::mem::take(&mut *made.resume.lock().unwrap_or_else(PoisonError::into_inner));
            is_same.then_some((stages.before_last, resume))
        });
        let is_small = plain.height.size().area() <= MOST_KEPT_PX;
        let nowhere = || ResumePoint::nowhere(is_small && cache.is_draft);
        let (before_last, mut resume) = beneath.unwrap_or_else(|| {
            (self.with_modifiers(plain.clone(), &body, &modifiers[..last], still), nowhere())
        });
        let form = match modifiers.last() {
            Some(other) => self.with_modifier_of(&before_last, &body, other, still, &mut resume),
            None => Form::clone(&before_last),
        };
        let form = Arc::new(in_place(form, part, moved));
        let stages = is_small.then_some(Stages { plain, before_last });
        let resume = if is_small { resume } else { ResumePoint::default() };
        let new = NewForm { body, stages, form: form.clone() };
        let (area, part, resume) = (new.area(), part.clone(), Arc::new(Mutex::new(resume)));
        let mut made = MadePart {
            part,
            modifiers,
            inks,
            source,
            outline,
            met,
            is_lost,
            moved,
            area,
            kept: None,
            resume,
        };
        cache.remember_form(&mut made, new, is_edited);
        Some((made, Some(form)))
    }

    /// The form of a part that was made before and not kept.
    pub(super) fn remade(&self, made: &MadePart) -> Option<Arc<Form>> {
        let (part, (still, moved)) = (&made.part, split_whole_px(made.part.matrix));
        let own = made.outline.as_ref().filter(|_| matches!(part.kind, PartKind::Inflate { .. }));
        let free = own.and_then(|own| joined_rim(own, &made.met)).map(Arc::new);
        let (body, plain) =
            self.solve_form(part, (made.outline.clone(), made.source.as_ref()), free, still, None)?;
        let form = self.with_modifiers(Arc::new(plain), &body, &made.modifiers, still);
        drop(body);
        Some(Arc::new(in_place(Arc::unwrap_or_clone(form), part, moved)))
    }

    /// A form changed by some parts that lie on it.
    fn with_modifiers(
        &self,
        form: Arc<Form>,
        body: &SolvedOutline,
        modifiers: &[Arc<Part>],
        still: Affine2,
    ) -> Arc<Form> {
        let on = |form: Arc<Form>, other: &Arc<Part>| {
            Arc::new(self.with_modifier_of(&form, body, other, still, &mut ResumePoint::default()))
        };
        modifiers.iter().fold(form, on)
    }

    /// A form changed by one more part that lies on it.
    fn with_modifier_of(
        &self,
        form: &Form,
        body: &SolvedOutline,
        other: &Part,
        still: Affine2,
        resume: &mut ResumePoint,
    ) -> Form {
        let PartKind::Lines { lines, .. } = &other.kind else {
            return with_modifier(form, &body.outline, other, still, resume);
        };
        let ink = OutlineKey::of_part(self, other)
            .flatten()
            .and_then(|ink| ink.outline(self, self.most_px()));
        let ink = ink.and_then(|ink| ink.transformed(still, self.most_px()));
        ink.map_or_else(|| form.clone(), |ink| with_lines(form, &body.outline, &ink, *lines))
    }

    /// The area that a part may take: four canvases, so that one that reaches beyond the canvas
    /// keeps its shape.
    pub(super) fn most_px(&self) -> usize {
        self.size.area().saturating_mul(4).max(1 << 20)
    }
}

/// A form leaned, raised and moved to its place.
fn in_place(form: Form, part: &Part, moved: (i32, i32)) -> Form {
    form.tilted(part.tilt_deg).raised(part.raise).shifted(moved)
}
