//! The surface of a document from its parts and its maps; only what changed in a part is made again. Floor 4.

use super::body::{self, SolvedOutline, StandingOutline, formed, inflated, joined, lost, of_surface};
use super::known::LastFlats;
use super::outlines::OutlineKey;
use super::unchanged::{apart, same_inks, same_kind, same_list, same_shape, same_surface};
use super::upon::{Came, changed, lined};
use super::{Part, PartKind, Parts};
use crate::document::{Document, Progress};
use crate::math::{Affine2, Size};
use crate::raster::Plane;
use crate::shape::{Form, Outline, OutlineRim, Relief, Roundness, bevel, sweep};
use crate::surface::{KnownNearest, Surface};
use std::sync::{Arc, Mutex, PoisonError};

/// What was made of parts, by their ids; shared by all versions of a document.
#[derive(Clone, Default)]
pub struct PartCache {
    /// The result is shown only for a moment, so solving may begin from the last result.
    pub is_draft: bool,
    made: Arc<Mutex<Vec<MadePart>>>,
    pub(super) flats: Arc<LastFlats>,
    /// The last surface, and what it was made of.
    whole: Arc<Mutex<Option<MadeSurface>>>,
}

struct MadeSurface {
    forms: Vec<(Arc<Form>, crate::shape::Combine)>,
    maps: Option<Arc<Surface>>,
    size: Size,
    surface: Option<Arc<Surface>>,
    nearest: KnownNearest,
}

/// A part as it was made last.
#[derive(Clone)]
struct MadePart {
    part: Arc<Part>,
    /// The parts that lie on it.
    upon: Vec<Arc<Part>>,
    /// What the lines among them are made of.
    inks: Vec<OutlineKey>,
    source: Option<OutlineKey>,
    /// The parts in front, at which its rim may be free.
    met: Vec<StandingOutline>,
    body: Arc<SolvedOutline>,
    /// Its place no longer has its colour.
    is_lost: bool,
    /// The stages it was made through; not for one so large that copies would be too many.
    stages: Option<Stages>,
    /// How far the last part on it came.
    came: Arc<Mutex<Came>>,
    form: Arc<Form>,
    /// How far the form was moved from the body's place, whole px.
    moved: (i32, i32),
}

/// An unfinished form, before it is leaned, raised and moved.
#[derive(Clone)]
struct Stages {
    /// Without what lies on it.
    plain: Arc<Form>,
    /// Without the last part on it.
    before_last: Arc<Form>,
}

/// Stages of forms with more pixels than this are not kept.
const MOST_KEPT_PX: usize = 1 << 24;

impl Document {
    /// The document with the surface that its parts, layers and maps make now, and with what lies on parts at their
    /// places; itself if nothing changed.
    pub fn reshaped(&self) -> Document {
        // Nobody cancels it, so it is complete.
        self.reshaped_telling(&Progress::default()).unwrap_or_else(|| self.clone())
    }
    /// The same, a step for each part; `None` if cancelled.
    pub fn reshaped_telling(&self, progress: &Progress) -> Option<Document> {
        let placed = self.with_homes_placed();
        if self.parts.is_empty() { Some(placed) } else { placed.derived(progress) }
    }
    fn derived(&self, progress: &Progress) -> Option<Document> {
        let shown = || self.parts.list.iter().filter(|part| part.visible && part.on().is_none());
        progress.add_total(shown().count() as u64);
        let outlines = self.standing_outlines(&shown().collect::<Vec<_>>());
        let mut forms = Vec::with_capacity(outlines.len());
        for (i, part) in shown().enumerate() {
            if progress.is_cancelled() {
                return None;
            }
            let form = self.form(part, outlines[i].clone(), &outlines[i + 1..]);
            forms.extend(form.map(|form| (form, part.combine)));
            progress.step();
        }
        self.forget_others();
        self.parts.forget_flats();
        let surface = self.whole(forms);
        let lost = lost(shown().zip(&outlines));
        if !self.parts.is_ahead && self.parts.lost == lost && same_surface(&surface, &self.surface) {
            return Some(self.clone());
        }
        let parts = Arc::new(Parts { is_ahead: false, lost, ..Parts::clone(&self.parts) });
        // Selections by the surface are found again on another surface.
        Some(Document { surface, parts, ..self.clone() }.with_selections_found())
    }
    /// The forms combined; the last result is kept.
    fn whole(&self, forms: Vec<(Arc<Form>, crate::shape::Combine)>) -> Option<Arc<Surface>> {
        let lock = || self.parts.cache.whole.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(made) = &*lock() {
            let same = |((a, x), (b, y)): (&(Arc<Form>, _), &(Arc<Form>, _))| Arc::ptr_eq(a, b) && x == y;
            if made.size == self.size
                && same_surface(&made.maps, &self.parts.maps)
                && made.forms.len() == forms.len()
                && made.forms.iter().zip(&forms).all(same)
            {
                return made.surface.clone();
            }
        }
        let mut whole = Relief::empty(self.size);
        let mut id = 0;
        if let Some(maps) = self.parts.maps.as_ref().filter(|maps| maps.size() == self.size) {
            id += 1;
            whole.add(&of_surface(maps), crate::shape::Combine::Over, id);
        }
        for (form, combine) in &forms {
            id += 1;
            whole.add(form, *combine, id);
        }
        let mut known = lock().take().map(|made| made.nearest).unwrap_or_default();
        let surface = whole.into_surface(&mut known).ok().map(Arc::new);
        let maps = self.parts.maps.clone();
        *lock() = Some(MadeSurface { forms, maps, size: self.size, surface: surface.clone(), nearest: known });
        surface
    }
    /// Drops what was made of parts that are gone.
    fn forget_others(&self) {
        let mut made = self.parts.cache.made.lock().unwrap_or_else(PoisonError::into_inner);
        made.retain(|made| self.parts.part(&made.part.id).is_some());
    }
    /// The outline of a part that was found last, as far as that was not moved, and whether its place was lost; `None`
    /// if what it is made of has changed.
    pub(super) fn known_outline(&self, part: &Part, source: &OutlineKey) -> Option<(Arc<Outline>, bool)> {
        let made = self.known(&part.id).filter(|made| apart(made.part.matrix).0 == apart(part.matrix).0)?;
        let is_same = made.source.as_ref().is_some_and(|known| known.is_same(source));
        is_same.then(|| (made.body.outline.clone(), made.is_lost))
    }
    /// The outline of a part that was found last and not moved since, whatever it was made of.
    pub(super) fn last_outline(&self, part: &Part) -> Option<Arc<Outline>> {
        let made = self.known(&part.id).filter(|made| apart(made.part.matrix).0 == apart(part.matrix).0)?;
        Some(made.body.outline.clone())
    }
    /// The form of a part as it was made last, if neither the part nor what lies on it was changed since.
    pub(super) fn made_form(&self, part: &Arc<Part>) -> Option<Arc<Form>> {
        let made = self.known(&part.id)?;
        (Arc::ptr_eq(&made.part, part) && same_list(&made.upon, &self.upon(part))).then_some(made.form)
    }
    /// Makes the forms of all visible parts; known ones cost nothing.
    pub(super) fn make_forms(&self) {
        drop(self.reshaped());
    }
    /// The visible parts that lie on another.
    fn upon(&self, part: &Part) -> Vec<Arc<Part>> {
        self.parts.list.iter().filter(|p| p.visible && p.on() == Some(part.id.as_str())).cloned().collect()
    }
    /// The form of a part as it was made last, whatever changed in the part since, and the part as it was then.
    pub(super) fn last_form(&self, id: &str) -> Option<(Arc<Part>, Arc<Form>)> {
        self.known(id).map(|made| (made.part, made.form))
    }
    fn known(&self, id: &str) -> Option<MadePart> {
        let made = self.parts.cache.made.lock().unwrap_or_else(PoisonError::into_inner);
        made.iter().find(|made| made.part.id == id).cloned()
    }
    /// The form of one part with what lies on it; `None` if it has none.
    ///
    /// * `standing`: its outline in its place, if it has one.
    /// * `in_front`: those of the parts nearer to the viewer.
    fn form(
        &self,
        part: &Arc<Part>,
        standing: Option<StandingOutline>,
        in_front: &[Option<StandingOutline>],
    ) -> Option<Arc<Form>> {
        let upon = self.upon(part);
        let known = self.known(&part.id);
        let source = OutlineKey::of_part(self, part)?;
        let inks: Vec<OutlineKey> = upon.iter().filter_map(|part| OutlineKey::of_part(self, part)?).collect();
        let (still, moved) = apart(part.matrix);
        let is_unchanged = |made: &MadePart| match (&made.source, &source) {
            (Some(a), Some(b)) => a.is_same(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        // Paint may change without the outline.
        let same_outline = |made: &MadePart| {
            let outline = standing.as_ref().map(|own| &own.outline);
            matches!(source, Some(OutlineKey::Layer(..)))
                && outline.is_some_and(|own| Arc::ptr_eq(own, &made.body.outline))
        };
        let same_source = |made: &MadePart| is_unchanged(made) || same_outline(made);
        let same_place = |made: &MadePart| apart(made.part.matrix).0 == still;
        let known = known.filter(|made| same_source(made) && same_place(made));
        // Only what is inflated has a rim that can be free.
        let own = standing.as_ref().filter(|_| matches!(part.kind, PartKind::Inflate { .. }));
        let met = own.map(|own| own.met_by(in_front)).unwrap_or_default();
        let free = match known.as_ref().filter(|made| made.met == met) {
            Some(made) => made.body.joined.clone(),
            None => own.and_then(|own| joined(&own.outline, &met)).map(Arc::new),
        };
        let known = known.filter(|made| made.body.joined == free);
        if let Some(made) = known
            .as_ref()
            .filter(|made| same_shape(&made.part, part) && same_list(&made.upon, &upon) && same_inks(&made.inks, &inks))
        {
            if made.moved == moved && Arc::ptr_eq(&made.part, part) && is_unchanged(made) {
                return Some(made.form.clone());
            }
            let by = (moved.0 - made.moved.0, moved.1 - made.moved.1);
            let form = if by == (0, 0) { made.form.clone() } else { Arc::new(made.form.moved(by)) };
            let is_lost = standing.as_ref().is_some_and(|own| own.is_lost);
            let next = MadePart { part: part.clone(), form: form.clone(), moved, source, met, is_lost, ..made.clone() };
            self.remember(next);
            return Some(form);
        }
        let is_lost = standing.as_ref().is_some_and(|own| own.is_lost);
        let own = standing.map(|own| own.outline);
        let kept = known.as_ref().filter(|made| same_kind(&made.part.kind, &part.kind));
        let (body, plain) = match kept.and_then(|made| Some((made.body.clone(), made.stages.as_ref()?.plain.clone()))) {
            Some(known) => known,
            None => {
                let body = known.as_ref().map(|made| made.body.clone());
                let (body, form) = self.made(part, (own, source.as_ref()), free, still, body)?;
                (body, Arc::new(form))
            }
        };
        // What lies beneath the last part on it is mostly known: the user works on the last.
        let last = upon.len().saturating_sub(1);
        let beneath = known.and_then(|made| {
            let as_many = made.upon.len() == upon.len() && same_list(&made.upon[..last], &upon[..last]);
            let stages = made.stages.filter(|stages| Arc::ptr_eq(&stages.plain, &plain))?;
            let came = std::mem::take(&mut *made.came.lock().unwrap_or_else(PoisonError::into_inner));
            (as_many && same_inks(&made.inks, &inks)).then_some((stages.before_last, came))
        });
        let is_small = plain.height.size().area() <= MOST_KEPT_PX;
        let nowhere = || Came::nowhere(is_small && self.parts.cache.is_draft);
        let (before_last, mut came) = beneath.unwrap_or_else(|| {
            let on = |form: Arc<Form>, other: &Arc<Part>| {
                Arc::new(self.with_upon(&form, &body, other, still, &mut Came::default()))
            };
            (upon[..last].iter().fold(plain.clone(), on), nowhere())
        });
        let stages = is_small.then(|| Stages { plain: plain.clone(), before_last: before_last.clone() });
        drop(plain);
        let form = match upon.last() {
            Some(other) => self.with_upon(&before_last, &body, other, still, &mut came),
            None => Arc::unwrap_or_clone(before_last),
        };
        let form = Arc::new(form.tilted(part.tilt_deg).raised(part.raise).shifted(moved));
        let came = if is_small { came } else { Came::default() };
        let (part, came) = (part.clone(), Arc::new(Mutex::new(came)));
        let of_it = form.clone();
        self.remember(MadePart { part, upon, inks, source, met, body, is_lost, stages, came, form, moved });
        Some(of_it)
    }
    /// A form changed by one more part that lies on it.
    fn with_upon(&self, form: &Form, body: &SolvedOutline, other: &Part, still: Affine2, came: &mut Came) -> Form {
        let PartKind::Lines { lines, .. } = &other.kind else {
            return changed(form, &body.outline, other, still, came);
        };
        let ink = OutlineKey::of_part(self, other).flatten().and_then(|ink| ink.outline(self, self.most_px()));
        let ink = ink.and_then(|ink| ink.through(still, self.most_px()));
        ink.map_or_else(|| form.clone(), |ink| lined(form, &body.outline, &ink, *lines))
    }
    fn remember(&self, made: MadePart) {
        let mut all = self.parts.cache.made.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|other| other.part.id != made.part.id);
        all.push(made);
    }
    /// The area that a part may take: four canvases, so that one that reaches beyond the canvas keeps its shape.
    pub(super) fn most_px(&self) -> usize {
        self.size.area().saturating_mul(4).max(1 << 20)
    }
    /// A part made again, except known fields of its body; without what lies on it, not leaned and not yet moved by
    /// whole px.
    fn made(
        &self,
        part: &Part,
        (own, source): (Option<Arc<Outline>>, Option<&OutlineKey>),
        joined: Option<Arc<Plane<bool>>>,
        still: Affine2,
        known: Option<Arc<SolvedOutline>>,
    ) -> Option<(Arc<SolvedOutline>, Form)> {
        let most_px = self.most_px();
        let bare = |outline: Arc<Outline>| SolvedOutline { outline, joined: None, pillow: None, tube: None };
        let silhouette = |puff: f32| Roundness { puff, rim_deg: 90.0 };
        let (body, form) = match &part.kind {
            PartKind::Inflate { inflation, .. } => {
                let body = inflated(own?, joined, known.as_deref(), inflation.profile);
                let form = formed(&body, *inflation);
                (body, form)
            }
            PartKind::Bevel { bevel, .. } => {
                let outline = own?;
                let form = bevel::beveled(&outline, bevel);
                (bare(outline), form)
            }
            PartKind::Lathe { axis, puff, .. } => {
                let outline = own?;
                let axis = axis.map(|axis| axis.map(|p| still.transform_point2(p)));
                let squares = sweep::turned(&outline, axis);
                let form = Form::of_squares(&outline, &squares, &OutlineRim::silhouette(&outline), silhouette(*puff));
                (bare(outline), form)
            }
            PartKind::Sweep { balls, puff } => {
                let length = still.matrix2.determinant().abs().sqrt();
                let through =
                    balls.iter().map(|b| sweep::Ball { at: still.transform_point2(b.at), radius: b.radius * length });
                let (outline, squares) = sweep::swept(&through.collect::<Vec<_>>(), most_px)?;
                let form = Form::of_squares(&outline, &squares, &OutlineRim::silhouette(&outline), silhouette(*puff));
                (bare(Arc::new(outline)), form)
            }
            PartKind::Primitive(body) => {
                let length = still.matrix2.determinant().abs().sqrt();
                let mut seen = *body;
                seen.center = still.transform_point2(body.center);
                for side in [&mut seen.radius, &mut seen.length, &mut seen.tube, &mut seen.round] {
                    *side *= length;
                }
                seen.half *= length;
                seen.turn_deg.z -= still.matrix2.x_axis.to_angle().to_degrees();
                let form = seen.form(most_px)?;
                let outline = Arc::new(Outline::new(form.corner, &form.coverage)?);
                (bare(outline), form)
            }
            PartKind::Profiles { shadings, .. } => {
                let drawn = source?.outline(self, most_px)?;
                let form = body::of_profiles(shadings, &drawn, still, most_px)?;
                (bare(Arc::new(Outline::new(form.corner, &form.coverage)?)), form)
            }
            PartKind::Maps(maps) => {
                let form = body::of_maps(maps, still, most_px)?;
                (bare(Arc::new(Outline::new(form.corner, &form.coverage)?)), form)
            }
            PartKind::Touches { .. } | PartKind::Sculpt { .. } | PartKind::Relief { .. } | PartKind::Lines { .. } => {
                return None;
            }
        };
        Some((Arc::new(body), form))
    }
}
