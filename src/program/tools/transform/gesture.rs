//! The gizmo under the pen: what a drag of each handle does to all layers in it. Floor 5.

use super::corner::clamp_to_convex;
use super::placed::{DragMap, LayerPlacement};
use crate::document::FrameBox;
use crate::document::{Document, LayerId, LayerMap};
use crate::math::{PlaneMap, Vec2, vec2};
use crate::tools::gizmo::{TransformGizmo, TransformHandle};
use crate::tools::snap::{SnapLines, SnapTargets};
use crate::tools::{Gesture, Outcome, PenSample};

/// A dragged layer, as it was before.
pub struct HeldLayer {
    pub id: LayerId,
    pub own: LayerPlacement,
    pub map: LayerMap,
}

pub struct TransformGesture {
    pub document: Document,
    /// None, if the shape is dragged.
    pub layers: Vec<HeldLayer>,
    pub of_shape: bool,
    pub gizmo: TransformGizmo,
    pub handle: TransformHandle,
    pub from: Vec2,
    /// As it was last dragged.
    pub found: Option<Dragged>,
    pub snap: SnapTargets,
    pub lines: SnapLines,
}

/// The result of a drag.
pub enum Dragged {
    /// The layers in their places, in the order of those held.
    Layers(Vec<LayerPlacement>),
    /// The map of the shape on the canvas.
    Shape(PlaneMap),
}

impl TransformGesture {
    /// The result with the handle at the pen; `None` if that is no map for one of them.
    fn drag_to(&self, pen: &PenSample) -> Option<Dragged> {
        let inner = self.gizmo.inner;
        match self.handle {
            TransformHandle::Inside => {
                self.all(&DragMap::OnCanvas(PlaneMap::translation(self.displacement(pen))))
            }
            TransformHandle::Outside => self.all(&DragMap::OnCanvas(self.rotation_to(pen)?)),
            TransformHandle::Corner(corner) if pen.keys.ctrl => {
                self.drag_corner(corner, pen.place())
            }
            TransformHandle::Edge(edge) if pen.keys.ctrl => {
                self.all(&DragMap::Local(self.shear_to(edge, pen.place())?))
            }
            TransformHandle::Corner(corner) => self.all(&DragMap::Local(self.scaling_to(
                inner.corners()[corner],
                [true; 2],
                pen,
            )?)),
            TransformHandle::Edge(edge) => {
                let [a, b] = [edge % 4, (edge + 1) % 4].map(|i| inner.corners()[i]);
                // The upper and the lower edge are dragged up and down.
                let along_y = edge.is_multiple_of(2);
                self.all(&DragMap::Local(self.scaling_to(
                    (a + b) * 0.5,
                    [!along_y, along_y],
                    pen,
                )?))
            }
            TransformHandle::Pivot => None,
        }
    }

    fn all(&self, map: &DragMap) -> Option<Dragged> {
        let on_canvas = match map {
            DragMap::OnCanvas(map) => *map,
            DragMap::Local(map) => self.gizmo.plane.inverse().then(map).then(&self.gizmo.plane),
        };
        if self.of_shape {
            return on_canvas.coefficients().map(|_| Dragged::Shape(on_canvas));
        }
        let layers = self.layers.iter().map(|layer| self.drag_layer(layer, map, on_canvas));
        layers.collect::<Option<_>>().map(Dragged::Layers)
    }

    fn drag_layer(
        &self,
        layer: &HeldLayer,
        map: &DragMap,
        on_canvas: PlaneMap,
    ) -> Option<LayerPlacement> {
        let on_canvas = DragMap::OnCanvas(on_canvas);
        // The gizmo of one layer is its own: numbers stay as exact as possible.
        let map = if self.layers.len() == 1 { map } else { &on_canvas };
        layer.own.then(&layer.map, map, self.document.size)
    }

    /// The pen after snapping: with a handle the pen itself snaps, with the inside the gizmo.
    fn snap_pen(&mut self, pen: &PenSample) -> PenSample {
        let at = pen.place();
        let (at, lines) = match self.handle {
            TransformHandle::Inside => {
                let by = at - self.from;
                let [low, high] = self.gizmo.bounds().map(|corner| corner + by);
                let shift = self.snap.shift(low, high);
                (at + shift.at, shift.lines)
            }
            TransformHandle::Corner(_) | TransformHandle::Edge(_) => {
                let found = self.snap.point(at);
                (found.at, found.lines)
            }
            TransformHandle::Outside | TransformHandle::Pivot => (at, SnapLines::default()),
        };
        self.lines = lines;
        let mut snapped = *pen;
        snapped.sample.at = at;
        snapped
    }

    fn displacement(&self, pen: &PenSample) -> Vec2 {
        // Whole pixels, so that paint is not resampled needlessly.
        let by = (pen.place() - self.from).round();
        match pen.keys.shift {
            true if by.x.abs() >= by.y.abs() => vec2(by.x, 0.0),
            true => vec2(0.0, by.y),
            false => by,
        }
    }

    fn rotation_to(&self, pen: &PenSample) -> Option<PlaneMap> {
        let pivot = self.gizmo.pivot();
        let (before, after) = (self.from - pivot, pen.place() - pivot);
        if before.length() < 1.0 || after.length() < 1.0 {
            return None;
        }
        // Counter-clockwise as seen is clockwise in y-down coordinates.
        let degrees = f64::from(before.to_angle() - after.to_angle()).to_degrees();
        let degrees =
            if pen.keys.shift { (degrees / STEP_DEGREES).round() * STEP_DEGREES } else { degrees };
        Some(PlaneMap::rotation(degrees, pivot))
    }

    /// A scaling in the gizmo that moves a handle to the pen. Shift keeps the aspect, Alt the
    /// pivot.
    fn scaling_to(&self, handle: Vec2, axes: [bool; 2], pen: &PenSample) -> Option<PlaneMap> {
        let inner = self.gizmo.inner;
        let center = inner.center();
        let fixed = if pen.keys.alt { self.gizmo.inner_pivot() } else { center * 2.0 - handle };
        let (to, _) = self.gizmo.plane.from_canvas(pen.place())?;
        let ratio = |k: usize| {
            let long = handle[k] - fixed[k];
            if axes[k] && long.abs() > 1e-3 { (to[k] - fixed[k]) / long } else { 1.0 }
        };
        let mut factors = [ratio(0), ratio(1)];
        if pen.keys.shift {
            let most = if (factors[0] - 1.0).abs() >= (factors[1] - 1.0).abs() {
                factors[0]
            } else {
                factors[1]
            };
            factors = [most; 2];
        }
        let [x, y] = factors.map(f64::from);
        let fixed = fixed.as_dvec2();
        PlaneMap::affine([x, 0.0, 0.0, y, fixed.x * (1.0 - x), fixed.y * (1.0 - y)])
    }

    /// A shear in the gizmo that moves an edge along itself.
    fn shear_to(&self, edge: usize, at: Vec2) -> Option<PlaneMap> {
        let corners = self.gizmo.inner.corners().map(|corner| corner.as_dvec2());
        let (a, opposite) = (corners[edge % 4], corners[(edge + 2) % 4]);
        let (to, _) = self.gizmo.plane.from_canvas(at)?;
        let (from, _) = self.gizmo.plane.from_canvas(self.from)?;
        let by = (to - from).as_dvec2();
        if edge.is_multiple_of(2) {
            let k = by.x / (a.y - opposite.y);
            return PlaneMap::affine([1.0, 0.0, k, 1.0, -k * opposite.y, 0.0]);
        }
        let k = by.y / (a.x - opposite.x);
        PlaneMap::affine([1.0, k, 0.0, 1.0, 0.0, -k * opposite.x])
    }

    /// The result of a perspective that moves one corner to the pen, or as far toward it as
    /// possible, and leaves the others.
    fn drag_corner(&self, corner: usize, at: Vec2) -> Option<Dragged> {
        let held = self.gizmo.corners.map(|c| c.as_dvec2());
        let (from, to) = (held[corner], clamp_to_convex(held, corner, at.as_dvec2()));
        let FrameBox { low, high } = self.gizmo.inner;
        let at_share = |share: f64| {
            let mut corners = held;
            corners[corner] = from.lerp(to, share);
            let whole = PlaneMap::rect_to_quad(low.as_dvec2(), high.as_dvec2(), corners)?;
            self.all(&DragMap::OnCanvas(self.gizmo.plane.inverse().then(&whole)))
        };
        // The horizon of a convex gizmo may still cross the canvas, which files cannot hold.
        at_share(1.0).or_else(|| {
            let (mut low, mut high, mut found) = (0.0, 1.0, None);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                match at_share(middle) {
                    Some(all) => (low, found) = (middle, Some(all)),
                    None => high = middle,
                }
            }
            found
        })
    }

    fn with(&self, dragged: &Dragged) -> Option<Document> {
        let placed = match dragged {
            Dragged::Shape(map) => return self.document.with_shape_through(map).ok(),
            Dragged::Layers(placed) => placed,
        };
        let all = self.layers.iter().zip(placed);
        all.into_iter().try_fold(self.document.clone(), |next, (held, placed)| {
            next.with_layer(held.id, |layer| placed.put(layer))
        })
    }
}

/// How often the way of a corner is halved to find how far it may go: less than a pixel remains.
const HALVINGS: usize = 16;
/// Turns with Shift go in steps of this.
const STEP_DEGREES: f64 = 15.0;

impl Gesture for TransformGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let pen = &self.snap_pen(pen);
        let Some(found) = self.drag_to(pen) else { return Outcome::Idle };
        let shown = self.with(&found);
        self.found = Some(found);
        shown.map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        let label = match self.handle {
            TransformHandle::Inside if self.of_shape => "Move shape",
            TransformHandle::Outside if self.of_shape => "Turn shape",
            _ if self.of_shape => "Transform shape",
            TransformHandle::Inside => "Move",
            TransformHandle::Outside => "Turn",
            TransformHandle::Corner(_) | TransformHandle::Edge(_) | TransformHandle::Pivot => {
                "Transform"
            }
        };
        let is_other = |found: &&Dragged| match found {
            Dragged::Layers(found) => {
                found.iter().zip(&self.layers).any(|(found, held)| *found != held.own)
            }
            Dragged::Shape(map) => !map.is_identity_on(self.document.size),
        };
        match self.found.as_ref().filter(is_other).and_then(|found| self.with(found)) {
            Some(document) => Outcome::Commit { label: label.into(), document, select: None },
            None => Outcome::Cancel,
        }
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}
