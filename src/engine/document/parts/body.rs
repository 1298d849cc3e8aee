//! The forms of single parts: fields that take long to solve, and what is made of them. Floor 4.
//! Not here: which of them are made again (`derive`).

use super::{Inflation, Part, PartMaps, ProfilePicture};
use crate::math::srgb::decode;
use crate::math::{Affine2, Rect, Vec3};
use crate::raster::Plane;
use crate::shape::profiles::{self, ShadedDrawing};
use crate::shape::{Form, Outline, OutlineRim, Roundness, inflate, tube};
use crate::surface::Surface;
use std::sync::Arc;

/// What takes long to make: an outline with the fields that were solved over it.
pub struct SolvedOutline {
    /// Through the part's matrix without its whole px.
    pub outline: Arc<Outline>,
    /// Where its rim is free, because a part in front begins there.
    pub joined: Option<Arc<Plane<bool>>>,
    pub pillow: Option<Arc<Plane<f32>>>,
    pub tube: Option<Arc<Plane<f32>>>,
}

/// The fields that a profile needs over an outline; known ones are kept.
pub fn inflate_outline(
    outline: Arc<Outline>,
    joined: Option<Arc<Plane<bool>>>,
    known: Option<&SolvedOutline>,
    profile: f32,
) -> SolvedOutline {
    let free = joined.as_deref();
    let pillow = known.and_then(|body| body.pillow.clone());
    let tube = known.and_then(|body| body.tube.clone());
    let needs_pillow = profile < 1.0 && pillow.is_none();
    let needs_tube = profile > 0.0 && tube.is_none();
    let pillow =
        if needs_pillow { Some(Arc::new(inflate::inflate(&outline, free, None))) } else { pillow };
    let tube = if needs_tube { Some(Arc::new(tube::tube(&outline, free, None))) } else { tube };
    SolvedOutline { outline, joined, pillow, tube }
}

/// How far a part continues beneath the edge of one in front of it.
const EDGE_PX: i32 = 3;

/// An outline in its place.
#[derive(Clone)]
pub struct PlacedOutline {
    /// Without its whole px.
    pub outline: Arc<Outline>,
    /// Those.
    pub moved: (i32, i32),
    /// The place that it is of no longer has its color: it is that of the nearest area.
    pub is_lost: bool,
}

/// The parts, by their ids, whose outlines are not of the area that was meant.
pub fn parts_with_lost_outlines<'a>(
    outlines: impl Iterator<Item = (&'a Arc<Part>, &'a Option<PlacedOutline>)>,
) -> Vec<String> {
    let of_lost = |(part, outline): (&Arc<Part>, &Option<PlacedOutline>)| {
        outline.as_ref().is_some_and(|outline| outline.is_lost).then(|| part.id.clone())
    };
    outlines.filter_map(of_lost).collect()
}

/// The very same outline in the same place.
impl PartialEq for PlacedOutline {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.outline, &other.outline) && self.moved == other.moved
    }
}

impl PlacedOutline {
    fn corner(&self) -> (i32, i32) {
        let (x, y) = self.outline.corner();
        (x.saturating_add(self.moved.0), y.saturating_add(self.moved.1))
    }

    fn rect(&self) -> Rect {
        let ((x, y), size) = (self.corner(), self.outline.size());
        Rect::new(x, y, x.saturating_add(size.width as i32), y.saturating_add(size.height as i32))
    }

    /// Those of some outlines whose planes overlap this one's, relative to this one.
    pub fn overlapping(&self, others: &[Option<PlacedOutline>]) -> Vec<PlacedOutline> {
        let met =
            others.iter().flatten().filter(|other| !other.rect().intersect(self.rect()).is_empty());
        let beside = |other: &PlacedOutline| {
            let moved = (
                other.moved.0.saturating_sub(self.moved.0),
                other.moved.1.saturating_sub(self.moved.1),
            );
            PlacedOutline { outline: other.outline.clone(), moved, is_lost: other.is_lost }
        };
        met.map(beside).collect()
    }
}

/// Where the rim of an outline is no silhouette: outside pixels in which a part in front begins.
/// `None` where there are none. A rim hidden under such a part stays a silhouette: what is inside
/// it is covered as well.
pub fn joined_rim(own: &Outline, met: &[PlacedOutline]) -> Option<Plane<bool>> {
    if met.is_empty() {
        return None;
    }
    let (corner, inside) = (own.corner(), own.inside_pixels());
    let covers = |other: &PlacedOutline, x: i32, y: i32| {
        let (ox, oy) = other.corner();
        other.outline.inside_pixels().get(x + corner.0 - ox, y + corner.1 - oy).unwrap_or(false)
    };
    let free = Plane::from_fn(own.size(), |x, y| {
        let (x, y) = (x as i32, y as i32);
        // What lies behind continues beneath the edge of what lies over it, as far as that edge is
        // blurred.
        let begins = |other: &PlacedOutline| {
            let is_in = |x: i32, y: i32| inside.get(x, y).unwrap_or(false);
            let opens = |(dx, dy): (i32, i32)| {
                let mut way =
                    (1..=EDGE_PX).map(|k| (x + k * dx, y + k * dy)).take_while(|p| is_in(p.0, p.1));
                way.any(|p| !covers(other, p.0, p.1))
            };
            covers(other, x, y) && [(1, 0), (-1, 0), (0, 1), (0, -1)].into_iter().any(opens)
        };
        !inside.at(x as usize, y as usize) && met.iter().any(begins)
    });
    free.values().contains(&true).then_some(free)
}

pub fn solve_form(body: &SolvedOutline, inflation: Inflation) -> Form {
    let rim = OutlineRim::of(&body.outline, body.joined.as_deref());
    let round = Roundness { puff: inflation.puff, rim_deg: inflation.rim_deg };
    let form = |squares: &Plane<f32>| Form::of_squares(&body.outline, squares, &rim, round);
    match (&body.pillow, &body.tube) {
        (Some(pillow), Some(tube)) if inflation.profile > 0.0 && inflation.profile < 1.0 => {
            form(&tube::blend(pillow, tube, inflation.profile))
        }
        (Some(pillow), _) if inflation.profile <= 0.0 => form(pillow),
        (_, Some(tube)) => form(tube),
        (Some(pillow), None) => form(pillow),
        (None, None) => form(&Plane::full(body.outline.size(), 0.0)),
    }
}

/// A form over the planes of an outline.
pub fn cut_to(form: &Form, outline: &Outline) -> Form {
    let shift = (outline.corner().0 - form.corner.0, outline.corner().1 - form.corner.1);
    let at = |x: usize, y: usize| (x as i32 + shift.0, y as i32 + shift.1);
    let size = outline.size();
    Form {
        corner: outline.corner(),
        height: Plane::from_fn(size, |x, y| form.height.get(at(x, y).0, at(x, y).1).unwrap_or(0.0))
            .into(),
        normals: Plane::from_fn(size, |x, y| {
            form.normals.get(at(x, y).0, at(x, y).1).unwrap_or(Vec3::Z)
        })
        .into(),
        coverage: outline.coverage().clone(),
    }
}

/// The maps of a document as a form: heights in px, the farthest 0.
pub fn of_surface(surface: &Surface) -> Form {
    let range = surface.depth_range_px();
    Form {
        corner: (0, 0),
        height: surface.depth_plane().map(|z| (1.0 - z) * range).into(),
        normals: Plane::from_fn(surface.size(), |x, y| surface.normal(x, y)).into(),
        coverage: surface.coverage_plane().clone().into(),
    }
}

/// A form of maps, moved by a matrix; `None` where nothing of it is left.
pub fn of_maps(maps: &PartMaps, still: Affine2, most_px: usize) -> Option<Form> {
    of_surface(&maps.surface).transformed(still, most_px)
}

/// A form of hand-made shadings over an outline, both on the canvas, moved by a matrix.
pub fn of_profiles(
    shadings: &[ProfilePicture],
    outline: &Outline,
    still: Affine2,
    most_px: usize,
) -> Option<Form> {
    let (x0, y0) = outline.corner();
    let profile = |shading: &ProfilePicture| {
        let gray = Plane::from_fn(outline.size(), |x, y| {
            let byte = shading.picture.coverage.get(x as i32 + x0, y as i32 + y0).unwrap_or(0);
            decode(f32::from(byte) / 255.0)
        });
        ShadedDrawing { gray, light: shading.light.normalize_or(Vec3::Z) }
    };
    let all: Vec<ShadedDrawing> = shadings.iter().map(profile).collect();
    profiles::solve_form(&all, outline)?.transformed(still, most_px)
}
