//! The surface of a document from its parts and its maps; only what changed in a part is made
//! again. Floor 4. Not here: how one kind of part is made (`make`), what is kept (`made`), how
//! forms are combined (`whole`).

use super::body::{PlacedOutline, SolvedOutline, joined_rim, parts_with_lost_outlines};
use super::form_cache::{MadePart, NewForm, PartCache, Stages};
use super::modifiers::{ResumePoint, with_lines, with_modifier};
use super::outlines::OutlineKey;
use super::unchanged::{
    are_same_inks, are_same_parts, is_same_kind, is_same_shape, split_whole_px,
};
use super::whole::Whole;
use super::{Part, PartKind, Parts};
use crate::document::{Document, Progress};
use crate::math::Affine2;
use crate::raster::Plane;
use crate::shape::Form;
use std::sync::{Arc, Mutex, PoisonError};

/// Where the rim of what is inflated is free; none: nowhere.
type FreeRim = Option<Arc<Plane<bool>>>;

/// Stages of forms with more pixels than this are not kept.
const MOST_KEPT_PX: usize = 1 << 24;

/// What the form of a part is made of.
struct PartInputs {
    part: Arc<Part>,
    /// The visible parts that lie on it.
    modifiers: Vec<Arc<Part>>,
    source: Option<OutlineKey>,
    /// The ink of the lines on it.
    inks: Vec<OutlineKey>,
    /// Its matrix without the whole pixels that it was moved by, and those.
    still: Affine2,
    moved: (i32, i32),
    /// Its outline in its place.
    standing: Option<PlacedOutline>,
    /// The outlines in front that overlap it.
    met: Vec<PlacedOutline>,
    is_lost: bool,
}

impl PartInputs {
    /// Whether a form was made from the very same source.
    fn is_of_source(&self, made: &MadePart) -> bool {
        match (&made.source, &self.source) {
            (Some(a), Some(b)) => a.is_same(b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }

    /// Whether a form was made from the same outline: paint may change without it.
    fn is_of_outline(&self, made: &MadePart) -> bool {
        let both = self.standing.as_ref().map(|own| &own.outline).zip(made.outline.as_ref());
        matches!(self.source, Some(OutlineKey::Layer(..)))
            && both.is_some_and(|(a, b)| Arc::ptr_eq(a, b))
    }

    /// Where the rim of what is inflated is free.
    fn free_rim(&self) -> FreeRim {
        let own = self.standing.as_ref().filter(|_| has_rim(&self.part));
        own.and_then(|own| joined_rim(&own.outline, &self.met)).map(Arc::new)
    }

    /// What was made of the same outline in the same place with the same free rim, and that rim as
    /// far as it is known.
    fn split_known(&self, made: Option<MadePart>) -> (Option<MadePart>, Option<FreeRim>) {
        let same_place = |made: &MadePart| split_whole_px(made.part.matrix).0 == self.still;
        let same_source = |made: &MadePart| self.is_of_source(made) || self.is_of_outline(made);
        match made.filter(|made| same_source(made) && same_place(made)) {
            // Where it is free follows from what it met: then as it was, though it may not be kept.
            Some(made) if made.met == self.met => {
                let free = made.kept.as_ref().map(|kept| kept.body.joined.clone());
                (Some(made), free)
            }
            known => {
                let free = self.free_rim();
                let is_same = |made: &MadePart| {
                    made.kept.as_ref().is_some_and(|kept| kept.body.joined == free)
                };
                (known.filter(is_same), Some(free))
            }
        }
    }

    /// Whether a form is the same but for where it is.
    fn is_of_same_form(&self, made: &MadePart) -> bool {
        is_same_shape(&made.part, &self.part)
            && are_same_parts(&made.modifiers, &self.modifiers)
            && are_same_inks(&made.inks, &self.inks)
    }

    /// The same form where the part is now.
    fn moved_since(self, made: &MadePart, cache: &PartCache) -> MadePart {
        let is_same_part = Arc::ptr_eq(&made.part, &self.part);
        if made.moved == self.moved && is_same_part && self.is_of_source(made) {
            return made.clone();
        }
        let by = (self.moved.0 - made.moved.0, self.moved.1 - made.moved.1);
        let Self { part, moved, source, met, is_lost, .. } = self;
        let next = MadePart { part, moved, source, met, is_lost, ..made.clone() }.moved_by(by);
        cache.remember(next.clone());
        next
    }

    /// The form before the last part on it was applied, and where to resume that, if nothing else
    /// changed.
    fn last_stage(
        &self,
        made: &MadePart,
        beneath: &[Arc<Part>],
        plain: &Arc<Form>,
    ) -> Option<(Arc<Form>, ResumePoint)> {
        let stages = made.kept.as_ref()?.stages.clone()?;
        let as_many = made.modifiers.len() == self.modifiers.len()
            && are_same_parts(&made.modifiers[..beneath.len()], beneath);
        let is_same =
            as_many && Arc::ptr_eq(&stages.plain, plain) && are_same_inks(&made.inks, &self.inks);
        let resume =
            std::mem::take(&mut *made.resume.lock().unwrap_or_else(PoisonError::into_inner));
        is_same.then_some((stages.before_last, resume))
    }
}

/// Only what is inflated has a rim that can be free.
fn has_rim(part: &Part) -> bool {
    matches!(part.kind, PartKind::Inflate { .. })
}

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
            let (own, in_front) = (outlines[i].clone(), &outlines[i + 1..]);
            if let Some((made, form)) = self.derive_part(part, own, in_front) {
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
    fn derive_part(
        &self,
        part: &Arc<Part>,
        standing: Option<PlacedOutline>,
        in_front: &[Option<PlacedOutline>],
    ) -> Option<(MadePart, Option<Arc<Form>>)> {
        let cache = &self.parts.cache;
        let now = self.part_inputs(part, standing, in_front)?;
        let made_before = cache.get(&part.id);
        let is_edited = made_before.is_some();
        let (known, free) = now.split_known(made_before);
        if let Some(made) = known.as_ref().filter(|made| now.is_of_same_form(made)) {
            return Some((now.moved_since(made, cache), None));
        }
        let free = free.unwrap_or_else(|| now.free_rim());
        let (body, plain) = self.plain_form(&now, known.as_ref(), free)?;
        let (stages, resume, form) = self.derive_form(&now, known, &body, plain);
        let new = NewForm { body, stages, form: form.clone() };
        let mut made = MadePart {
            part: part.clone(),
            modifiers: now.modifiers,
            inks: now.inks,
            source: now.source,
            outline: now.standing.map(|own| own.outline),
            met: now.met,
            is_lost: now.is_lost,
            moved: now.moved,
            area: new.area(),
            kept: None,
            resume: Arc::new(Mutex::new(resume)),
        };
        cache.remember_form(&mut made, new, is_edited);
        Some((made, Some(form)))
    }

    /// What the form of a part is made of; `None` if the part has no outline yet.
    fn part_inputs(
        &self,
        part: &Arc<Part>,
        standing: Option<PlacedOutline>,
        in_front: &[Option<PlacedOutline>],
    ) -> Option<PartInputs> {
        let modifiers = self.modifiers_of(part);
        let source = OutlineKey::of_part(self, part)?;
        let inks: Vec<OutlineKey> =
            modifiers.iter().filter_map(|part| OutlineKey::of_part(self, part)?).collect();
        let (still, moved) = split_whole_px(part.matrix);
        let rim = standing.as_ref().filter(|_| has_rim(part));
        let met = rim.map(|own| own.overlapping(in_front)).unwrap_or_default();
        let is_lost = standing.as_ref().is_some_and(|own| own.is_lost);
        let part = part.clone();
        Some(PartInputs { part, modifiers, source, inks, still, moved, standing, met, is_lost })
    }

    /// The form of a part without what lies on it, and its outline with what was solved for it; the
    /// last ones where they still hold.
    fn plain_form(
        &self,
        now: &PartInputs,
        known: Option<&MadePart>,
        free: Option<Arc<Plane<bool>>>,
    ) -> Option<(Arc<SolvedOutline>, Arc<Form>)> {
        let is_kind = known.is_some_and(|made| is_same_kind(&made.part.kind, &now.part.kind));
        let kept = known.and_then(|made| made.kept.clone());
        let staged =
            kept.as_ref().filter(|_| is_kind).and_then(|kept| Some((kept, kept.stages.as_ref()?)));
        if let Some((kept, stages)) = staged {
            return Some((kept.body.clone(), stages.plain.clone()));
        }
        let body = kept.as_ref().map(|kept| kept.body.clone());
        let outline = now.standing.as_ref().map(|own| own.outline.clone());
        let of = (outline, now.source.as_ref());
        let (body, form) = self.solve_form(&now.part, of, free, now.still, body)?;
        Some((body, Arc::new(form)))
    }

    /// A form with what lies on its part, in its place, and what is kept to make it again soon.
    fn derive_form(
        &self,
        now: &PartInputs,
        known: Option<MadePart>,
        body: &SolvedOutline,
        plain: Arc<Form>,
    ) -> (Option<Stages>, ResumePoint, Arc<Form>) {
        // What lies beneath the last part on it is mostly known: the user works on the last.
        let beneath = &now.modifiers[..now.modifiers.len().saturating_sub(1)];
        let is_small = plain.height.size().area() <= MOST_KEPT_PX;
        let nowhere = || ResumePoint::nowhere(is_small && self.parts.cache.is_draft);
        let known = known.and_then(|made| now.last_stage(&made, beneath, &plain));
        let (before_last, mut resume) = known.unwrap_or_else(|| {
            (self.with_modifiers(plain.clone(), body, beneath, now.still), nowhere())
        });
        let form = match now.modifiers.last() {
            Some(other) => self.with_modifier_of(&before_last, body, other, now.still, &mut resume),
            None => Form::clone(&before_last),
        };
        let form = Arc::new(in_place(form, &now.part, now.moved));
        let stages = is_small.then_some(Stages { plain, before_last });
        let resume = if is_small { resume } else { ResumePoint::default() };
        (stages, resume, form)
    }

    /// The form of a part that was made before and not kept.
    pub(super) fn derive_again(&self, made: &MadePart) -> Option<Arc<Form>> {
        let (part, (still, moved)) = (&made.part, split_whole_px(made.part.matrix));
        let own = made.outline.as_ref().filter(|_| has_rim(part));
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
