//! Parts of a shape on another canvas.
//! Floor 4.
//!
//! A part that follows what it names (a layer, an object of the maps) is carried with that. Any
//! other part keeps its own frame, or a frame turned in place, and its matrix says where that went;
//! what lies on it is in the same frame.

use super::CanvasChange;
use super::selections::turned_rect;
use crate::document::LayerMap;
use crate::document::parts::{OutlineSource, Part, PartKind};
use crate::math::plane_map::orthogonal;
use crate::math::{Affine2, Mat2, PlaneMap, Rect, Size, Vec2, vec2, vec3};
use crate::raster::warp::warp_plane_onto;
use crate::raster::{Plane, Resampling};
use crate::shape::Primitive;
use crate::surface::Surface;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Every part of a list where the change takes it.
///
/// * `maps`: the surface of the document's maps before and after; objects get new numbers.
pub fn transform_parts(
    list: &[Arc<Part>],
    change: &CanvasChange,
    maps: Option<[&Arc<Surface>; 2]>,
) -> Vec<Arc<Part>> {
    let one = |part: &Arc<Part>| {
        let mut next = Frame::of(list, part.on().unwrap_or(&part.id), change).part(part, change);
        if let (Some(OutlineSource::Object(object)), Some([old, new])) =
            (outline_mut(&mut next.kind), maps)
        {
            *object = same_object(*object, old, new, |p| change.point(p));
        }
        Arc::new(next)
    };
    list.iter().map(one).collect()
}

pub(super) fn outline_mut(kind: &mut PartKind) -> Option<&mut OutlineSource> {
    match kind {
        PartKind::Inflate { outline, .. }
        | PartKind::Bevel { outline, .. }
        | PartKind::Lathe { outline, .. } => Some(outline),
        _ => None,
    }
}

/// The number of the object that most pixels of another one became; for one that is gone, a number
/// that no object has.
pub(super) fn same_object(
    object: u32,
    old: &Arc<Surface>,
    new: &Arc<Surface>,
    to: impl Fn(Vec2) -> Vec2,
) -> u32 {
    let (before, now) = (old.objects(), new.objects());
    let labels = before.labels();
    let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
    let own = labels.values().iter().enumerate().filter(|(_, label)| **label == object);
    for (i, _) in own {
        let center = vec2((i % labels.width()) as f32 + 0.5, (i / labels.width()) as f32 + 0.5);
        let at = to(center).floor();
        if let Some(label) = now.labels().get(at.x as i32, at.y as i32).filter(|label| *label > 0) {
            *counts.entry(label).or_default() += 1;
        }
    }
    let most = counts.into_iter().max_by_key(|(label, count)| (*count, std::cmp::Reverse(*label)));
    most.map_or(now.count() as u32 + 1, |(label, _)| label)
}

/// Where the frame of a part goes, and its contents.
struct Frame {
    /// N, rigid.
    map: PlaneMap,
    /// For pictures that lie in it afterwards; `None` where they stay as they are.
    pictures: Option<Size>,
}

impl Frame {
    /// For the part of this name, and for all that lies on it.
    fn of(list: &[Arc<Part>], id: &str, change: &CanvasChange) -> Self {
        let base = list.iter().find(|part| part.id == id);
        let follows = |part: &Arc<Part>| match part.outline() {
            Some(
                OutlineSource::Layer { .. }
                | OutlineSource::Object(_)
                | OutlineSource::Selection(_),
            ) => true,
            Some(OutlineSource::File(_) | OutlineSource::Path(_)) | None => false,
        };
        if base.is_none_or(follows) {
            return Self { map: change.map, pictures: Some(change.to) };
        }
        // Lights and normals that were made elsewhere turn by the matrix.
        let is_made =
            |part: &Arc<Part>| matches!(part.kind, PartKind::Maps(_) | PartKind::Profiles { .. });
        if change.is_shift() || base.is_some_and(is_made) {
            return Self { map: PlaneMap::IDENTITY, pictures: None };
        }
        // Turned in place, then moved so that pictures begin at its corner again.
        let own = list.iter().filter(|part| part.id == id || part.on() == Some(id));
        let sizes = own.flat_map(|part| {
            Part::clone(part)
                .files_mut()
                .into_iter()
                .map(|file| file.coverage.size())
                .collect::<Vec<_>>()
        });
        let held =
            sizes.fold(change.from, |a, b| Size::new(a.width.max(b.width), a.height.max(b.height)));
        let turned = match change.pixel_move() {
            Some(by) => super::selections::moved_rect(held.rect(), by),
            None => turned_rect(held.rect(), &change.map),
        };
        let Rect { x0, y0, .. } = turned;
        let map = change.map.then(&PlaneMap::translation(vec2(-x0 as f32, -y0 as f32)));
        Self { map, pictures: Some(Size::new(turned.width() as u32, turned.height() as u32)) }
    }

    fn part(&self, part: &Part, change: &CanvasChange) -> Part {
        let mut next = part.clone();
        let [here, back] =
            [self.map, self.map.inverse()].map(|map| map.as_affine().unwrap_or(Affine2::IDENTITY));
        next.matrix = change.map.as_affine().unwrap_or(Affine2::IDENTITY) * part.matrix * back;
        // It leans as it is seen, wherever its frame is.
        let slope = change.matrix()
            * vec2(part.tilt_deg.x.to_radians().tan(), part.tilt_deg.y.to_radians().tan());
        if part.tilt_deg != Vec2::ZERO && !change.is_shift() {
            next.tilt_deg = vec2(slope.x.atan().to_degrees(), slope.y.atan().to_degrees());
        }
        carry(&mut next.kind, here);
        let Some(size) = self.pictures else { return next };
        for file in next.files_mut() {
            file.coverage = Arc::new(self.picture(&file.coverage, size));
        }
        next
    }

    fn picture(&self, plane: &Plane<u8>, to: Size) -> Plane<u8> {
        // What is beyond a picture is not covered: its border is not continued.
        let edged = |v: u32| v.saturating_add(4);
        let wide = Size::new(edged(plane.size().width), edged(plane.size().height));
        let bordered =
            Plane::from_fn(wide, |x, y| plane.get(x as i32 - 2, y as i32 - 2).unwrap_or(0));
        let reach = Size::new(wide.width.max(to.width), wide.height.max(to.height));
        let map = PlaneMap::translation(vec2(-2.0, -2.0)).then(&self.map);
        let map = LayerMap::of_plane(map, Resampling::Smooth, reach);
        warp_plane_onto(&bordered, &map, Resampling::Smooth, to)
    }
}

/// What a part is made of, moved by a rigid map.
pub(super) fn carry(kind: &mut PartKind, map: Affine2) {
    let at = |p: &mut Vec2| *p = map.transform_point2(*p);
    let path = |outline: &mut OutlineSource| outline.points_mut().for_each(at);
    match kind {
        PartKind::Inflate { outline, .. } | PartKind::Bevel { outline, .. } => path(outline),
        PartKind::Primitive(body) => *body = turned(body, map),
        PartKind::Lathe { outline, axis, .. } => {
            path(outline);
            axis.iter_mut().flatten().for_each(at);
        }
        PartKind::Sweep { balls, .. } => balls.iter_mut().for_each(|ball| at(&mut ball.at)),
        PartKind::Touches { touches, .. } => touches.iter_mut().for_each(|touch| {
            at(&mut touch.at);
            // Image axes are y down, normals y up.
            let bar = map.matrix2 * vec2(touch.normal.x, -touch.normal.y);
            touch.normal = vec3(bar.x, -bar.y, touch.normal.z);
        }),
        PartKind::Sculpt { strokes, .. } => {
            strokes
                .iter_mut()
                .flat_map(|stroke| &mut stroke.samples)
                .for_each(|sample| at(&mut sample.0));
        }
        PartKind::Lines { ink, .. } => path(ink),
        PartKind::Profiles { outline, .. } => outline.iter_mut().for_each(path),
        PartKind::Relief { .. } | PartKind::Maps(_) => {}
    }
}

/// A body turned in the plane, and mirrored: every body is its own mirror image before it is
/// turned.
fn turned(body: &Primitive, map: Affine2) -> Primitive {
    let mut next = *body;
    next.center = map.transform_point2(body.center);
    let matrix = orthogonal(map.matrix2);
    let is_mirrored = matrix.determinant() < 0.0;
    let turn = if is_mirrored { matrix * Mat2::from_diagonal(vec2(-1.0, 1.0)) } else { matrix };
    if is_mirrored {
        next.turn_deg = vec3(body.turn_deg.x, -body.turn_deg.y, -body.turn_deg.z);
    }
    // Counter-clockwise as seen is a negative angle where y points down.
    let about_z = next.turn_deg.z - turn.x_axis.to_angle().to_degrees();
    next.turn_deg.z = (about_z + 180.0).rem_euclid(360.0) - 180.0;
    if !is_mirrored && turn == Mat2::IDENTITY {
        next.turn_deg = body.turn_deg;
    }
    next
}
