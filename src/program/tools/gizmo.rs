//! The gizmo of the transform tool and its handles: a box around the selected layers, its place on
//! the canvas, and its pivot. Floor 5.

use super::pen::GRAB_PT;
use crate::document::FrameBox;
use crate::document::{Document, LayerId, LayerMap};
use crate::math::{PlaneMap, Vec2};
use crate::raster::Resampling;
use std::sync::Arc;

/// The gizmo of a layer, or of several, on the canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransformGizmo {
    /// In the layer's own frame; that of several is the canvas at the time when they were first
    /// held.
    pub inner: FrameBox,
    /// From there to the canvas, groups included.
    pub plane: PlaneMap,
    /// How the pixels of its contents are sampled.
    pub filter: Resampling,
    /// Upper left, upper right, lower right, lower left of the untransformed box, canvas px.
    pub corners: [Vec2; 4],
    /// Its pivot, as shares of its sides from the upper left corner.
    pub pivot_share: Vec2,
}

rilievo_engine::named! {
    /// What the transform tool moves, if there is a shape.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum TransformTarget {
        /// Only the selected layers: they slide over the shape, which stays.
        #[default]
        Paint = "paint" => "slide paint over the shape",
        /// The whole shape, and what is painted on it.
        Shape = "shape" => "move paint with the shape",
    }
}

/// What a gizmo is around.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GizmoContent<'a> {
    /// These layers.
    Layers(&'a [LayerId]),
    /// The whole shape.
    Shape,
}

impl<'a> GizmoContent<'a> {
    /// The shape, if that is to be moved and there is one; else the selected layers.
    pub fn new(target: TransformTarget, document: &Document, selected: &'a [LayerId]) -> Self {
        match target {
            TransformTarget::Shape if document.surface.is_some() => GizmoContent::Shape,
            _ => GizmoContent::Layers(selected),
        }
    }

    fn layers(self) -> &'a [LayerId] {
        match self {
            GizmoContent::Layers(layers) => layers,
            GizmoContent::Shape => &[],
        }
    }
}

/// What the pen holds of a gizmo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransformHandle {
    /// By its number among the corners.
    Corner(usize),
    /// Between a corner and the next.
    Edge(usize),
    /// The pivot: the point that the gizmo is turned about.
    Pivot,
    /// The inside, by which all of it is moved.
    Inside,
    /// Anywhere else: the gizmo is turned about its pivot.
    Outside,
}

/// The pivot is grabbed from nearer than other handles, screen points: around it the inside is
/// dragged.
const PIVOT_GRAB_PT: f32 = 6.0;
/// The pivot of a gizmo whose shorter side is less than this, screen points, is only grabbed with
/// Alt.
const PIVOT_ROOM_PT: f32 = 56.0;

impl TransformGizmo {
    /// `None` where a corner lies beyond the horizon.
    fn new(inner: FrameBox, plane: PlaneMap, filter: Resampling) -> Option<Self> {
        let [a, b, c, d] = inner.corners().map(|corner| plane.to_canvas(corner));
        Some(Self { inner, plane, filter, corners: [a?, b?, c?, d?], pivot_share: MIDDLE })
    }

    /// For a layer; `None` if it is empty or lies beyond the horizon.
    pub fn of(document: &Document, layer: LayerId) -> Option<Self> {
        let map = document.map_of(layer)?;
        let is_mesh =
            document.layer(layer)?.transform.as_ref().is_some_and(|own| own.mesh().is_some());
        // The points of a mesh lie where the mesh moved them.
        let plane = if is_mesh { map.map_outside_own() } else { map.plane };
        Self::new(document.frame_box(layer)?, plane, map.filter)
    }

    /// Around layers: for one its own frame, for several a box on the canvas. `None` if all are
    /// empty.
    pub fn around(document: &Document, layers: &[LayerId]) -> Option<Self> {
        if let [layer] = layers {
            return Self::of(document, *layer);
        }
        let gizmos = layers.iter().filter_map(|layer| Self::of(document, *layer));
        let corners: Vec<Vec2> = gizmos.flat_map(|gizmo| gizmo.corners).collect();
        let low = corners.iter().copied().reduce(Vec2::min)?;
        let high = corners.iter().copied().reduce(Vec2::max)?;
        let filter = document.map_of(*layers.first()?)?.filter;
        Self::new(FrameBox { low, high }, PlaneMap::IDENTITY, filter)
    }

    /// Around the shape: for maps the gizmo that turned with them, for parts a box on the canvas.
    pub fn of_shape(document: &Document) -> Option<Self> {
        let surface = document.surface.as_ref()?;
        let origin = surface.origin();
        match document.parts.is_empty() && !Arc::ptr_eq(&origin.surface, surface) {
            true => {
                Self::new(FrameBox::of_surface(&origin.surface)?, origin.map, Resampling::default())
            }
            false => {
                Self::new(FrameBox::of_surface(surface)?, PlaneMap::IDENTITY, Resampling::default())
            }
        }
    }

    /// The upper left and the lower right corner of the box around it, canvas px.
    pub fn bounds(&self) -> [Vec2; 2] {
        let [a, b, c, d] = self.corners;
        [a.min(b).min(c).min(d), a.max(b).max(c).max(d)]
    }

    /// The middle of the side from a corner to the next.
    pub fn edge(&self, index: usize) -> Vec2 {
        (self.corners[index % 4] + self.corners[(index + 1) % 4]) * 0.5
    }

    /// A point of the gizmo by shares of its sides, canvas px.
    pub fn point(&self, share: Vec2) -> Vec2 {
        let FrameBox { low, high } = self.inner;
        let middle = || self.corners.iter().sum::<Vec2>() * 0.25;
        self.plane.to_canvas(low + share * (high - low)).unwrap_or_else(middle)
    }

    /// Its pivot, canvas px.
    pub fn pivot(&self) -> Vec2 {
        self.point(self.pivot_share)
    }

    /// The same in the gizmo's own px.
    pub fn inner_pivot(&self) -> Vec2 {
        self.inner.low + self.pivot_share * (self.inner.high - self.inner.low)
    }

    /// A canvas point as shares of its sides; `None` beyond the horizon, and for a gizmo without
    /// area.
    pub fn share_of(&self, at: Vec2) -> Option<Vec2> {
        let (inner, _) = self.plane.from_canvas(at)?;
        let share = (inner - self.inner.low) / (self.inner.high - self.inner.low);
        share.is_finite().then_some(share)
    }

    /// What lies at a canvas point; `px_per_pt`: canvas px per screen point. With `alt` the inside
    /// is the pivot.
    pub fn handle_at(&self, at: Vec2, px_per_pt: f32, alt: bool) -> TransformHandle {
        let near = |p: Vec2, pt: f32| p.distance(at) <= pt * px_per_pt;
        if let Some(corner) = (0..4).find(|&i| near(self.corners[i], GRAB_PT)) {
            return TransformHandle::Corner(corner);
        }
        if let Some(edge) = (0..4).find(|&i| near(self.edge(i), GRAB_PT)) {
            return TransformHandle::Edge(edge);
        }
        let side = |i: usize| self.corners[(i + 1) % 4].distance(self.corners[i]);
        let is_roomy = side(0).min(side(1)) >= PIVOT_ROOM_PT * px_per_pt;
        if is_roomy && near(self.pivot(), PIVOT_GRAB_PT) {
            return TransformHandle::Pivot;
        }
        let sides = (0..4)
            .map(|i| (self.corners[(i + 1) % 4] - self.corners[i]).perp_dot(at - self.corners[i]));
        let sides: Vec<f32> = sides.collect();
        let inside = sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0);
        match inside {
            true if alt => TransformHandle::Pivot,
            true => TransformHandle::Inside,
            false => TransformHandle::Outside,
        }
    }
}

/// The first pivot of a gizmo.
pub const MIDDLE: Vec2 = Vec2::splat(0.5);

/// What the transform tool keeps about the layers in its gizmo until others are selected: the
/// pivot, and for several layers their first box, so that their gizmo turns with them.
#[derive(Clone, Debug)]
pub struct GizmoMemory {
    /// None: for the shape.
    layers: Vec<LayerId>,
    of_shape: bool,
    pivot_share: Vec2,
    /// Around all of them at first.
    first: Option<FirstPlacement>,
}

#[derive(Clone, Debug)]
struct FirstPlacement {
    inner: FrameBox,
    /// Each layer's own box then, and its map to the canvas.
    each: Vec<Option<PlacedBox>>,
}

/// A box and its place.
type PlacedBox = (FrameBox, LayerMap);

/// Nothing is kept.
static NOTHING: GizmoMemory =
    GizmoMemory { layers: Vec::new(), of_shape: false, pivot_share: MIDDLE, first: None };

impl Default for GizmoMemory {
    fn default() -> Self {
        NOTHING.clone()
    }
}

impl GizmoMemory {
    /// The memory of nothing, to be borrowed.
    pub fn nothing() -> &'static Self {
        &NOTHING
    }

    fn is_of(&self, content: GizmoContent) -> bool {
        self.of_shape == (content == GizmoContent::Shape) && self.layers == content.layers()
    }

    /// What is kept about these layers in their places: for others than the last, everything is
    /// new.
    pub fn hold(&mut self, document: &Document, content: GizmoContent) {
        let layers = content.layers();
        if !self.is_of(content) {
            *self = Self {
                layers: layers.to_vec(),
                of_shape: content == GizmoContent::Shape,
                ..Self::default()
            };
        }
        if layers.len() > 1 && self.common_map(document).is_none() {
            let inner = TransformGizmo::around(document, layers).map(|gizmo| gizmo.inner);
            self.first = inner.map(|inner| FirstPlacement { inner, each: each(document, layers) });
        }
    }

    /// The gizmo around layers or the shape, with what is kept if they are the same ones.
    pub fn gizmo_for(&self, document: &Document, content: GizmoContent) -> Option<TransformGizmo> {
        let known = Some(self).filter(|kept| kept.is_of(content));
        let layers = content.layers();
        let turned =
            known.and_then(|kept| Some((kept.first.as_ref()?.inner, kept.common_map(document)?)));
        let plain = || match content {
            GizmoContent::Layers(layers) => TransformGizmo::around(document, layers),
            GizmoContent::Shape => TransformGizmo::of_shape(document),
        };
        let gizmo = match turned {
            Some((inner, plane)) => {
                let filter = document.map_of(*layers.first()?)?.filter;
                TransformGizmo::new(inner, plane, filter).or_else(plain)
            }
            None => plain(),
        };
        let pivot_share = known.map_or(MIDDLE, |kept| kept.pivot_share);
        gizmo.map(|gizmo| TransformGizmo { pivot_share, ..gizmo })
    }

    /// The pivot of some layers from now on, as shares of the sides of their gizmo.
    pub fn set_pivot(&mut self, document: &Document, content: GizmoContent, share: Vec2) {
        self.hold(document, content);
        if share.is_finite() {
            self.pivot_share = share.clamp(-FARTHEST_PIVOT, FARTHEST_PIVOT);
        }
    }

    /// The map by which several layers were moved since they were first held; `None` if it is not
    /// the same for all, or something else was done to them.
    fn common_map(&self, document: &Document) -> Option<PlaneMap> {
        let first = self.first.as_ref()?;
        let now = each(document, &self.layers);
        let mut moves =
            first.each.iter().zip(now).filter(|(then, now)| then.is_some() || now.is_some());
        let by = |(then, now): (&Option<PlacedBox>, Option<PlacedBox>)| {
            let ((old_box, old), (new_box, new)) = (then.as_ref()?, now.as_ref()?);
            (old_box == new_box).then(|| old.plane.inverse().then(&new.plane))
        };
        let all = by(moves.next()?)?;
        let agrees =
            moves.all(|both| by(both).is_some_and(|other| other.is_same_on(&all, document.size)));
        agrees.then_some(all)
    }
}

/// The greatest distance of a pivot from a gizmo, in sides of the gizmo.
const FARTHEST_PIVOT: Vec2 = Vec2::splat(100.0);

fn each(document: &Document, layers: &[LayerId]) -> Vec<Option<PlacedBox>> {
    layers.iter().map(|layer| document.frame_box(*layer).zip(document.map_of(*layer))).collect()
}
