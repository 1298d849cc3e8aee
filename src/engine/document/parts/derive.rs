//! The surface of a document from its parts and its maps; what of a part did not change is not made again.
//! Floor 4.

use super::outlines::OutlineKey;
use super::{Inflation, Part, PartKind, turned};
use crate::document::Document;
use crate::math::{Affine2, Size, Vec3};
use crate::raster::Plane;
use crate::shape::{
    Form, Outline, Relief, Rim, Roundness, Touch, bevel, inflate, relief, sculpt, sweep, touches, tube,
};
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
    source: Option<OutlineKey>,
    body: Arc<Body>,
    form: Arc<Form>,
    /// How far the form was moved from where the body stands, whole px.
    moved: (i32, i32),
}

/// What takes long to make: an outline with the fields that were solved over it.
struct Body {
    /// Through the part's matrix but for its whole px.
    outline: Arc<Outline>,
    /// Where its rim is free, since a part in front begins there.
    joined: Option<Arc<Plane<bool>>>,
    pillow: Option<Arc<Plane<f32>>>,
    tube: Option<Arc<Plane<f32>>>,
}

impl Document {
    /// The document with the surface that its parts, layers and maps make now; itself where nothing changed.
    pub fn reshaped(&self) -> Document {
        if self.parts.is_empty() {
            return self.clone();
        }
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
        let source = OutlineKey::of(self, part.outline()?)?;
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
        let source = part.outline().map(|outline| OutlineKey::of(self, outline));
        let source = match source {
            Some(None) => return None,
            Some(key) => key,
            None => None,
        };
        let (still, moved) = apart(part.matrix);
        let same_source = |made: &MadePart| match (&made.source, &source) {
            (Some(a), Some(b)) => a.is_same(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let same_place = |made: &MadePart| apart(made.part.matrix).0 == still;
        let joined = standing.as_ref().and_then(|own| joined(own, in_front)).map(Arc::new);
        let known = known.filter(|made| same_source(made) && same_place(made) && made.body.joined == joined);
        if let Some(made) = known.as_ref().filter(|made| same_shape(&made.part, part) && same_list(&made.upon, &upon)) {
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
        let (body, form) = self.made(part, own, joined, still, body, &upon)?;
        let form = Arc::new(form.moved(moved));
        self.remember(MadePart { part: part.clone(), upon, source, body, form: form.clone(), moved });
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
        own: Option<Arc<Outline>>,
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
            PartKind::Touches { .. } | PartKind::Sculpt { .. } | PartKind::Relief { .. } => return None,
        };
        let form = upon.iter().fold(form, |form, other| changed(form, &body.outline, other, still));
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

/// Whether two versions of a part have the same form, wherever it stands.
fn same_shape(a: &Arc<Part>, b: &Arc<Part>) -> bool {
    Arc::ptr_eq(a, b) || (a.kind == b.kind && a.tilt_deg == b.tilt_deg && a.raise == b.raise)
}

/// The fields that a profile needs over an outline; those that are known stay.
fn inflated(outline: Arc<Outline>, joined: Option<Arc<Plane<bool>>>, known: Option<&Body>, profile: f32) -> Body {
    let free = joined.as_deref();
    let pillow = known.and_then(|body| body.pillow.clone());
    let tube = known.and_then(|body| body.tube.clone());
    let needs_pillow = profile < 1.0 && pillow.is_none();
    let needs_tube = profile > 0.0 && tube.is_none();
    let pillow = if needs_pillow { Some(Arc::new(inflate::inflate(&outline, free, None))) } else { pillow };
    let tube = if needs_tube { Some(Arc::new(tube::tube(&outline, free, None))) } else { tube };
    Body { outline, joined, pillow, tube }
}

/// Where the rim of an outline is no silhouette: outside pixels in which a part in front begins. `None` where there are
/// none. A rim that lies hidden under such a part stays one: what is inside of it is covered as well.
fn joined(own: &Outline, in_front: &[Option<Arc<Outline>>]) -> Option<Plane<bool>> {
    let corner = own.corner();
    let met: Vec<&Outline> =
        in_front.iter().flatten().map(|o| &**o).filter(|o| !o.rect().intersect(own.rect()).is_empty()).collect();
    if met.is_empty() {
        return None;
    }
    let inside = own.inside();
    let covers = |other: &Outline, x: i32, y: i32| {
        let at = (x + corner.0 - other.corner().0, y + corner.1 - other.corner().1);
        other.inside().get(at.0, at.1).unwrap_or(false)
    };
    let free = Plane::from_fn(own.size(), |x, y| {
        let (x, y) = (x as i32, y as i32);
        let beside = [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)];
        let begins = |other: &&Outline| {
            let open = |p: &(i32, i32)| inside.get(p.0, p.1).unwrap_or(false) && !covers(other, p.0, p.1);
            covers(other, x, y) && beside.iter().any(open)
        };
        !inside.at(x as usize, y as usize) && met.iter().any(begins)
    });
    free.values().contains(&true).then_some(free)
}

fn formed(body: &Body, inflation: Inflation) -> Form {
    let rim = Rim::of(&body.outline, body.joined.as_deref());
    let round = Roundness { puff: inflation.puff, rim_deg: inflation.rim_deg };
    let form = |squares: &Plane<f32>| Form::of_squares(&body.outline, squares, &rim, round);
    match (&body.pillow, &body.tube) {
        (Some(pillow), Some(tube)) if inflation.profile > 0.0 && inflation.profile < 1.0 => {
            form(&tube::blend(pillow, tube, inflation.profile))
        }
        (Some(pillow), _) if inflation.profile <= 0.0 => form(pillow),
        (_, Some(tube)) => form(tube),
        (Some(pillow), None) => form(pillow),
        (None, None) => form(&Plane::filled(body.outline.size(), 0.0)),
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

/// A form over the planes of an outline.
fn cut_to(form: &Form, outline: &Outline) -> Form {
    let shift = (outline.corner().0 - form.corner.0, outline.corner().1 - form.corner.1);
    let at = |x: usize, y: usize| (x as i32 + shift.0, y as i32 + shift.1);
    let size = outline.size();
    Form {
        corner: outline.corner(),
        height: Plane::from_fn(size, |x, y| form.height.get(at(x, y).0, at(x, y).1).unwrap_or(0.0)),
        normals: Plane::from_fn(size, |x, y| form.normals.get(at(x, y).0, at(x, y).1).unwrap_or(Vec3::Z)),
        coverage: outline.coverage().clone(),
    }
}

/// The maps of a document as a form: heights in px, the farthest 0.
fn of_surface(surface: &Surface) -> Form {
    let range = surface.depth_range_px();
    Form {
        corner: (0, 0),
        height: surface.depth_plane().map(|z| (1.0 - z) * range),
        normals: Plane::from_fn(surface.size(), |x, y| surface.normal(x, y)),
        coverage: surface.coverage_plane().clone(),
    }
}
