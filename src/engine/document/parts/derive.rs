//! The surface of a document from its parts and its maps; what of a part did not change is not made again.
//! Floor 4.

use super::body::{self, Body, cut_to, formed, inflated, joined, of_surface};
use super::outlines::OutlineKey;
use super::{Part, PartKind, turned};
use crate::document::Document;
use crate::math::{Affine2, Size};
use crate::raster::Plane;
use crate::shape::{Form, Lines, Outline, Relief, Rim, Roundness, Touch, bevel, lines, relief, sculpt, sweep, touches};
use crate::surface::Surface;
use std::sync::{Arc, Mutex, PoisonError};

/// What was made of parts, by their ids; shared by all versions of a document.
#[derive(Clone, Default)]
pub struct PartCache {
    made: Arc<Mutex<Vec<MadePart>>>,
    /// The last surface, and what it was made of.
    whole: Arc<Mutex<Option<MadeSurface>>>,
}

struct MadeSurface {
    forms: Vec<(Arc<Form>, crate::shape::Combine)>,
    maps: Option<Arc<Surface>>,
    size: Size,
    surface: Option<Arc<Surface>>,
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
    body: Arc<Body>,
    form: Arc<Form>,
    /// How far the form was moved from where the body stands, whole px.
    moved: (i32, i32),
}

impl Document {
    /// The document with the surface that its parts, layers and maps make now, and with what lies on parts where they
    /// stand; itself where nothing changed.
    pub fn reshaped(&self) -> Document {
        let placed = self.with_homes_placed();
        if self.parts.is_empty() { placed } else { placed.derived() }
    }
    fn derived(&self) -> Document {
        let shown = || self.parts.list.iter().filter(|part| part.visible && part.on().is_none());
        let outlines: Vec<_> = shown().map(|part| self.standing_outline(part)).collect();
        let forms: Vec<_> = shown()
            .enumerate()
            .filter_map(|(i, part)| Some((self.form(part, outlines[i].clone(), &outlines[i + 1..])?, part.combine)))
            .collect();
        self.forget_others();
        let surface = self.whole(forms);
        let is_same = match (&surface, &self.surface) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        // What was selected by the surface is found anew on another.
        if is_same { self.clone() } else { Document { surface, ..self.clone() }.with_selections_found() }
    }
    /// The forms together; the last ones are remembered.
    fn whole(&self, forms: Vec<(Arc<Form>, crate::shape::Combine)>) -> Option<Arc<Surface>> {
        let lock = || self.parts.cache.whole.lock().unwrap_or_else(PoisonError::into_inner);
        let same_maps = |maps: &Option<Arc<Surface>>| match (maps, &self.parts.maps) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        if let Some(made) = &*lock() {
            let same = |((a, x), (b, y)): (&(Arc<Form>, _), &(Arc<Form>, _))| Arc::ptr_eq(a, b) && x == y;
            if made.size == self.size
                && same_maps(&made.maps)
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
        let surface = whole.surface().ok().map(Arc::new);
        let maps = self.parts.maps.clone();
        *lock() = Some(MadeSurface { forms, maps, size: self.size, surface: surface.clone() });
        surface
    }
    /// Forgets what was made of parts that are gone.
    fn forget_others(&self) {
        let mut made = self.parts.cache.made.lock().unwrap_or_else(PoisonError::into_inner);
        made.retain(|made| self.parts.part(&made.part.id).is_some());
    }
    /// The outline of a part where it stands; `None` where it has none.
    fn standing_outline(&self, part: &Arc<Part>) -> Option<Arc<Outline>> {
        let source = OutlineKey::of_part(self, part)??;
        let (still, moved) = apart(part.matrix);
        let known = self.known(&part.id).filter(|made| {
            made.source.as_ref().is_some_and(|known| known.is_same(&source)) && apart(made.part.matrix).0 == still
        });
        let outline = match known {
            Some(made) => made.body.outline.clone(),
            None => Arc::new(source.outline(self, self.most_px())?.through(still, self.most_px())?),
        };
        Some(if moved == (0, 0) { outline } else { Arc::new(outline.moved(moved)) })
    }
    /// The form of a part as it was made last, if neither the part nor what lies on it was changed since.
    pub(super) fn made_form(&self, part: &Arc<Part>) -> Option<Arc<Form>> {
        let made = self.known(&part.id)?;
        (Arc::ptr_eq(&made.part, part) && same_list(&made.upon, &self.upon(part))).then_some(made.form)
    }
    /// Makes the forms of all parts that are seen, those that are known again for nothing.
    pub(super) fn make_forms(&self) {
        drop(self.reshaped());
    }
    /// The parts that lie on another and are seen.
    fn upon(&self, part: &Part) -> Vec<Arc<Part>> {
        self.parts.list.iter().filter(|p| p.visible && p.on() == Some(part.id.as_str())).cloned().collect()
    }
    fn known(&self, id: &str) -> Option<MadePart> {
        let made = self.parts.cache.made.lock().unwrap_or_else(PoisonError::into_inner);
        made.iter().find(|made| made.part.id == id).cloned()
    }
    /// The form of one part with what lies on it; `None` where it has none.
    ///
    /// * `standing`: its outline where it stands, if it has one.
    /// * `in_front`: those of the parts nearer to the viewer.
    fn form(
        &self,
        part: &Arc<Part>,
        standing: Option<Arc<Outline>>,
        in_front: &[Option<Arc<Outline>>],
    ) -> Option<Arc<Form>> {
        let upon = self.upon(part);
        let known = self.known(&part.id);
        let source = OutlineKey::of_part(self, part)?;
        let inks: Vec<OutlineKey> = upon.iter().filter_map(|part| OutlineKey::of_part(self, part)?).collect();
        let (still, moved) = apart(part.matrix);
        let same_source = |made: &MadePart| match (&made.source, &source) {
            (Some(a), Some(b)) => a.is_same(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let same_place = |made: &MadePart| apart(made.part.matrix).0 == still;
        let joined = standing.as_ref().and_then(|own| joined(own, in_front)).map(Arc::new);
        let known = known.filter(|made| same_source(made) && same_place(made) && made.body.joined == joined);
        if let Some(made) = known
            .as_ref()
            .filter(|made| same_shape(&made.part, part) && same_list(&made.upon, &upon) && same_inks(&made.inks, &inks))
        {
            if made.moved == moved && Arc::ptr_eq(&made.part, part) {
                return Some(made.form.clone());
            }
            let by = (moved.0 - made.moved.0, moved.1 - made.moved.1);
            let form = if by == (0, 0) { made.form.clone() } else { Arc::new(made.form.moved(by)) };
            let next = MadePart { part: part.clone(), form: form.clone(), moved, source, ..made.clone() };
            self.remember(next);
            return Some(form);
        }
        let body = known.map(|made| made.body);
        let own = standing.map(|own| if moved == (0, 0) { own } else { Arc::new(own.moved((-moved.0, -moved.1))) });
        let (body, form) = self.made(part, (own, source.as_ref()), joined, still, body, &upon)?;
        let form = Arc::new(form.moved(moved));
        self.remember(MadePart { part: part.clone(), upon, inks, source, body, form: form.clone(), moved });
        Some(form)
    }
    fn remember(&self, made: MadePart) {
        let mut all = self.parts.cache.made.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|other| other.part.id != made.part.id);
        all.push(made);
    }
    /// What a part may take: four canvases, so that one that reaches beyond the canvas keeps its shape.
    fn most_px(&self) -> usize {
        self.size.area().saturating_mul(4).max(1 << 20)
    }
    /// A part made anew, but for the fields of its body that are known; not yet moved by whole px.
    fn made(
        &self,
        part: &Part,
        (own, source): (Option<Arc<Outline>>, Option<&OutlineKey>),
        joined: Option<Arc<Plane<bool>>>,
        still: Affine2,
        known: Option<Arc<Body>>,
        upon: &[Arc<Part>],
    ) -> Option<(Arc<Body>, Form)> {
        let most_px = self.most_px();
        let bare = |outline: Arc<Outline>| Body { outline, joined: None, pillow: None, tube: None };
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
                let form = Form::of_squares(&outline, &squares, &Rim::silhouette(&outline), silhouette(*puff));
                (bare(outline), form)
            }
            PartKind::Sweep { balls, puff } => {
                let length = still.matrix2.determinant().abs().sqrt();
                let through =
                    balls.iter().map(|b| sweep::Ball { at: still.transform_point2(b.at), radius: b.radius * length });
                let (outline, squares) = sweep::swept(&through.collect::<Vec<_>>(), most_px)?;
                let form = Form::of_squares(&outline, &squares, &Rim::silhouette(&outline), silhouette(*puff));
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
        let form = upon.iter().fold(form, |form, other| match &other.kind {
            PartKind::Lines { lines, .. } => {
                let ink = OutlineKey::of_part(self, other).flatten().and_then(|ink| ink.outline(self, most_px));
                let ink = ink.and_then(|ink| ink.through(still, most_px));
                ink.map_or(form.clone(), |ink| lined(form, &body.outline, &ink, *lines))
            }
            _ => changed(form, &body.outline, other, still),
        });
        let form = form.tilted(part.tilt_deg).raised(part.raise);
        Some((Arc::new(body), form))
    }
}

/// The matrix without its whole px, and those.
fn apart(matrix: Affine2) -> (Affine2, (i32, i32)) {
    let whole = matrix.translation.floor();
    let still = Affine2 { translation: matrix.translation - whole, ..matrix };
    (still, (whole.x as i32, whole.y as i32))
}

fn same_list(a: &[Arc<Part>], b: &[Arc<Part>]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| Arc::ptr_eq(a, b))
}

fn same_inks(a: &[OutlineKey], b: &[OutlineKey]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.is_same(b))
}

/// A form with ink as lines on it.
fn lined(form: Form, outline: &Outline, ink: &Outline, lines: Lines) -> Form {
    if form.height.size() != outline.size() {
        let cut = cut_to(&form, outline);
        return if cut.height.size() == outline.size() { lined(cut, outline, ink, lines) } else { form };
    }
    let shift = (outline.corner().0 - ink.corner().0, outline.corner().1 - ink.corner().1);
    let inked =
        Plane::from_fn(outline.size(), |x, y| ink.coverage().get(x as i32 + shift.0, y as i32 + shift.1).unwrap_or(0));
    lines::lined(&form, outline, &inked, lines)
}

/// Whether two versions of a part have the same form, wherever it stands.
fn same_shape(a: &Arc<Part>, b: &Arc<Part>) -> bool {
    Arc::ptr_eq(a, b) || (same_kind(&a.kind, &b.kind) && a.tilt_deg == b.tilt_deg && a.raise == b.raise)
}

/// Whether two kinds make the same of the same outline, whatever they call it.
fn same_kind(a: &PartKind, b: &PartKind) -> bool {
    match (a, b) {
        (PartKind::Inflate { inflation: a, .. }, PartKind::Inflate { inflation: b, .. }) => a == b,
        (PartKind::Bevel { bevel: a, .. }, PartKind::Bevel { bevel: b, .. }) => a == b,
        (PartKind::Lathe { axis: a, puff: x, .. }, PartKind::Lathe { axis: b, puff: y, .. }) => a == b && x == y,
        _ => a == b,
    }
}

/// A form with what another part does to it. Its marks lie in the frame of the part that they are on.
fn changed(form: Form, outline: &Outline, part: &Part, still: Affine2) -> Form {
    if form.height.size() != outline.size() {
        // A primitive's planes reach beyond its outline; cut to it they fit.
        let cut = cut_to(&form, outline);
        return if cut.height.size() == outline.size() { changed(cut, outline, part, still) } else { form };
    }
    match &part.kind {
        PartKind::Touches { touches: list, .. } => {
            let length = still.matrix2.determinant().abs().sqrt();
            let through = list.iter().map(|touch| Touch {
                at: still.transform_point2(touch.at),
                radius: touch.radius * length,
                reach: touch.reach * length,
                normal: turned(touch.normal, still),
            });
            touches::touched(&form, outline, &through.collect::<Vec<_>>())
        }
        PartKind::Sculpt { strokes, .. } => {
            let length = still.matrix2.determinant().abs().sqrt();
            let mut through = strokes.clone();
            for stroke in &mut through {
                stroke.size *= length;
                stroke.strength *= if stroke.tool.is_by_height() { length } else { 1.0 };
            }
            for sample in through.iter_mut().flat_map(|stroke| &mut stroke.samples) {
                sample.0 = still.transform_point2(sample.0);
            }
            let layer = sculpt::sculpted(&form, &through);
            form.with_added(&layer)
        }
        PartKind::Relief { picture, detail, .. } => {
            // The picture lies on the canvas, where the part stands when it is not moved.
            let corner = outline.corner();
            let luminance = Plane::from_fn(outline.size(), |x, y| {
                let at = (x as i32 + corner.0, y as i32 + corner.1);
                f32::from(picture.coverage.get(at.0, at.1).unwrap_or(0)) / 255.0
            });
            form.with_added(&relief::relief(outline, &luminance, *detail))
        }
        _ => form,
    }
}
