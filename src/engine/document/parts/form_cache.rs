//! What was made of parts, kept for speed: what each of them was made from, where its form lies,
//! and, as long as the forms of all documents stay below a limit, the form itself. Floor 4. Not
//! here: what is made again (`derive`).

use super::Part;
use super::body::{PlacedOutline, SolvedOutline};
use super::drawn::LastDrawn;
use super::flats_cache::FlatsCache;
use super::modifiers::ResumePoint;
use super::outlines::OutlineKey;
use super::unchanged::{are_same_parts, split_whole_px};
use crate::document::Document;
use crate::math::{Rect, Size, Vec2};
use crate::memory::{CacheReservation, FORMS};
use crate::raster::{CoverageGrid, Plane};
use crate::shape::{Combine, Form, Outline};
use crate::surface::{NearestCache, Surface};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What was made of parts, by their ids; shared by all versions of a document.
#[derive(Clone, Default)]
pub struct PartCache {
    /// The result is shown only for a moment, so solving may begin from the last result.
    pub is_draft: bool,
    made: Arc<Mutex<Vec<MadePart>>>,
    pub(super) flats: Arc<FlatsCache>,
    pub(super) drawn: Arc<LastDrawn>,
    /// The last surface, and what it was made of.
    pub(super) whole: Arc<Mutex<Option<MadeSurface>>>,
}

/// The pixels that a form covers: a few bytes a pixel of its rim. The very same value stands for
/// the very same form.
pub struct FormArea {
    /// Canvas px of the form's first pixel.
    corner: (i32, i32),
    /// Coverage from there on, and a box around what is covered.
    coverage: CoverageGrid,
    covered: Rect,
}

impl FormArea {
    fn of(form: &Form) -> Arc<Self> {
        let mut covered = Rect::EMPTY;
        for y in 0..form.coverage.height() {
            let row = form.coverage.row(y);
            let Some(first) = row.iter().position(|c| *c > 0) else { continue };
            let last = row.iter().rposition(|c| *c > 0).unwrap_or(first);
            covered =
                covered.union(Rect::new(first as i32, y as i32, last as i32 + 1, y as i32 + 1));
        }
        Arc::new(Self {
            corner: form.corner,
            coverage: CoverageGrid::from_plane(&form.coverage, 0, 0),
            covered,
        })
    }

    fn moved(&self, by: (i32, i32)) -> Arc<Self> {
        let corner = (self.corner.0.saturating_add(by.0), self.corner.1.saturating_add(by.1));
        Arc::new(Self { corner, coverage: self.coverage.clone(), covered: self.covered })
    }

    /// Coverage at a canvas pixel.
    pub fn at(&self, x: i32, y: i32) -> u8 {
        self.coverage.at(x.saturating_sub(self.corner.0), y.saturating_sub(self.corner.1))
    }

    /// Coverage on the canvas.
    pub fn coverage(&self) -> CoverageGrid {
        self.coverage.shifted(self.corner.0, self.corner.1)
    }

    /// The corners of the box around what is covered, canvas px.
    pub fn covered_box(&self) -> (Vec2, Vec2) {
        let side = |v: i32, from: i32| v.saturating_add(from) as f32;
        let corner = |x: i32, y: i32| Vec2::new(side(x, self.corner.0), side(y, self.corner.1));
        (corner(self.covered.x0, self.covered.y0), corner(self.covered.x1, self.covered.y1))
    }
}

/// A surface, and what it was made of.
pub struct MadeSurface {
    pub forms: Vec<(Arc<FormArea>, Combine)>,
    pub maps: Option<Arc<Surface>>,
    pub size: Size,
    pub surface: Option<Arc<Surface>>,
    pub nearest: NearestCache,
}

/// A part as it was made last.
#[derive(Clone)]
pub struct MadePart {
    pub part: Arc<Part>,
    /// The parts that lie on it.
    pub modifiers: Vec<Arc<Part>>,
    /// What the lines among them are made of.
    pub inks: Vec<OutlineKey>,
    pub source: Option<OutlineKey>,
    /// Its outline, if it is made of one, and the parts in front, at which its rim may be free.
    pub outline: Option<Arc<Outline>>,
    pub met: Vec<PlacedOutline>,
    /// Its place no longer has its color.
    pub is_lost: bool,
    /// How far the form was moved from the outline's place, whole px.
    pub moved: (i32, i32),
    pub area: Arc<FormArea>,
    pub kept: Option<Arc<KeptForm>>,
    /// How far the last part on it came.
    pub resume: Arc<Mutex<ResumePoint>>,
}

/// A form, and what it was made through.
#[derive(Clone)]
pub struct KeptForm {
    pub body: Arc<SolvedOutline>,
    /// Not of one so large that copies would be too many.
    pub stages: Option<Stages>,
    pub form: Arc<Form>,
    _room: Arc<CacheReservation>,
}

/// An unfinished form, before it is leaned, raised and moved.
#[derive(Clone)]
pub struct Stages {
    /// Without what lies on it.
    pub plain: Arc<Form>,
    /// Without the last part on it.
    pub before_last: Arc<Form>,
}

/// A form that was made just now.
pub struct NewForm {
    pub body: Arc<SolvedOutline>,
    pub stages: Option<Stages>,
    pub form: Arc<Form>,
}

impl NewForm {
    pub fn area(&self) -> Arc<FormArea> {
        FormArea::of(&self.form)
    }

    /// Bytes of all its planes, shared ones once.
    fn bytes(&self) -> u64 {
        fn of<T>(plane: &Arc<Plane<T>>) -> (usize, usize)
        where
            T: Copy,
        {
            (Arc::as_ptr(plane).cast::<()>() as usize, plane.size().area() * size_of::<T>())
        }
        let forms = self
            .stages
            .iter()
            .flat_map(|stages| [&stages.plain, &stages.before_last])
            .chain([&self.form]);
        let mut planes: Vec<(usize, usize)> = forms
            .flat_map(|form| [of(&form.height), of(&form.normals), of(&form.coverage)])
            .collect();
        let SolvedOutline { outline, joined, pillow, tube } = &*self.body;
        // Its coverage, and what is inside.
        planes.extend([
            of(outline.coverage()),
            (Arc::as_ptr(outline) as usize, outline.size().area()),
        ]);
        planes.extend(joined.iter().map(of));
        planes.extend([pillow, tube].into_iter().flatten().map(of));
        planes.sort_unstable();
        planes.dedup_by_key(|(plane, _)| *plane);
        planes.iter().map(|(_, bytes)| *bytes as u64).sum()
    }
}

impl MadePart {
    /// The same part, moved by whole px since.
    pub fn moved_by(self, by: (i32, i32)) -> Self {
        if by == (0, 0) {
            return self;
        }
        let moved = |kept: Arc<KeptForm>| {
            Arc::new(KeptForm { form: kept.form.moved(by).into(), ..KeptForm::clone(&kept) })
        };
        Self { area: self.area.moved(by), kept: self.kept.map(moved), ..self }
    }

    pub fn form(&self) -> Option<Arc<Form>> {
        self.kept.as_ref().map(|kept| kept.form.clone())
    }
}

impl PartCache {
    fn lock(&self) -> MutexGuard<'_, Vec<MadePart>> {
        self.made.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn get(&self, id: &str) -> Option<MadePart> {
        self.lock().iter().find(|made| made.part.id == id).cloned()
    }

    /// Drops what was made of other parts.
    pub fn keep_only(&self, is_there: impl Fn(&str) -> bool) {
        self.lock().retain(|made| is_there(&made.part.id));
    }

    /// Takes the place of what was made of the part before.
    pub fn remember(&self, made: MadePart) {
        let mut all = self.lock();
        all.retain(|other| other.part.id != made.part.id);
        all.push(made);
    }

    /// The same with a new form, if there is room for it.
    ///
    /// * `is_edited`: the user works on this part, so the forms of others make room, those made
    ///   longest ago first.
    pub fn remember_form(&self, made: &mut MadePart, new: NewForm, is_edited: bool) {
        let bytes = new.bytes();
        // What it held before is free now.
        self.lock().retain(|other| other.part.id != made.part.id);
        let mut room = FORMS.reserve(bytes);
        while is_edited && room.is_none() {
            let other = self.lock().iter_mut().find_map(|made| made.kept.take());
            let Some(other) = other else { break };
            drop(other);
            room = FORMS.reserve(bytes);
        }
        let NewForm { body, stages, form } = new;
        made.kept = room.map(|room| Arc::new(KeptForm { body, stages, form, _room: room.into() }));
        self.remember(made.clone());
    }
}

impl Document {
    /// The outline of a part that was found last, as far as that was not moved, and whether its
    /// place was lost; `None` if what it is made of has changed.
    pub(super) fn cached_outline(
        &self,
        part: &Part,
        source: &OutlineKey,
    ) -> Option<(Arc<Outline>, bool)> {
        let made =
            self.parts.cache.get(&part.id).filter(|made| {
                split_whole_px(made.part.matrix).0 == split_whole_px(part.matrix).0
            })?;
        let is_same = made.source.as_ref().is_some_and(|known| known.is_same(source));
        made.outline.filter(|_| is_same).map(|outline| (outline, made.is_lost))
    }

    /// The outline of a part that was found last and not moved since, whatever it was made of.
    pub(super) fn last_outline(&self, part: &Part) -> Option<Arc<Outline>> {
        let made =
            self.parts.cache.get(&part.id).filter(|made| {
                split_whole_px(made.part.matrix).0 == split_whole_px(part.matrix).0
            })?;
        made.outline
    }

    /// Where the form of a part lies that was made last, if neither the part nor what lies on it
    /// was changed since.
    pub(super) fn cached_area(&self, part: &Arc<Part>) -> Option<Arc<FormArea>> {
        let made = self.parts.cache.get(&part.id)?;
        (Arc::ptr_eq(&made.part, part) && are_same_parts(&made.modifiers, &self.modifiers_of(part)))
            .then_some(made.area)
    }

    /// Where the form of a part lies that was made last, whatever changed in the part since, and
    /// the part as it was then.
    pub(super) fn last_area(&self, id: &str) -> Option<(Arc<Part>, Arc<FormArea>)> {
        self.parts.cache.get(id).map(|made| (made.part, made.area))
    }

    /// The form of a part as it was made last; made again if it was not kept.
    pub fn form_of(&self, id: &str) -> Option<Arc<Form>> {
        let made = self.parts.cache.get(id)?;
        made.form().or_else(|| self.derive_again(&made))
    }
}
