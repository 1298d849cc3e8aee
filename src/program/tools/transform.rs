//! The transform tool: a frame with handles around the chosen layers and groups, which stay live until it is applied.
//! Floor 5. What a layer becomes under its transform is `document::transform`'s.

mod numbers;

pub use numbers::FrameNumbers;

use super::snap::{SnapLines, SnapTargets};
use super::{GRAB_PT, Gesture, GestureStart, Outcome, PenSample, ToolContext};
use crate::document::transform::FrameBox;
use crate::document::{Document, Layer, LayerId, LayerLock, LayerMap, LayerTransform};
use crate::math::{PlaneMap, Size, Vec2, vec2};
use crate::raster::Resampling;

/// The frame of a layer, or of several, on the canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransformFrame {
    /// In the layer's own frame; that of several is the canvas.
    pub inner: FrameBox,
    /// From there to the canvas, groups included.
    pub map: LayerMap,
    /// Upper left, upper right, lower right, lower left of the untransformed box, canvas px.
    pub corners: [Vec2; 4],
}

/// What of a frame the pen holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameHandle {
    /// By its number among the corners.
    Corner(usize),
    /// Between a corner and the next.
    Edge(usize),
    Inside,
    /// Anywhere else: the frame is turned about its middle.
    Outside,
}

impl TransformFrame {
    /// Of a layer; `None` if it is empty or lies beyond the horizon.
    pub fn of(document: &Document, layer: LayerId) -> Option<Self> {
        let (inner, map) = (document.frame_box(layer)?, document.map_of(layer)?);
        let [a, b, c, d] = inner.corners().map(|corner| map.plane.to_canvas(corner));
        Some(Self { inner, map, corners: [a?, b?, c?, d?] })
    }
    /// Around layers: of one its own frame, of several a box on the canvas. `None` if all are empty.
    pub fn around(document: &Document, layers: &[LayerId]) -> Option<Self> {
        if let [layer] = layers {
            return Self::of(document, *layer);
        }
        let frames = layers.iter().filter_map(|layer| Self::of(document, *layer));
        let corners: Vec<Vec2> = frames.flat_map(|frame| frame.corners).collect();
        let low = corners.iter().copied().reduce(Vec2::min)?;
        let high = corners.iter().copied().reduce(Vec2::max)?;
        let inner = FrameBox { low, high };
        Some(Self { inner, map: LayerMap::none(document.size), corners: inner.corners() })
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
    /// The point that it is turned about.
    pub fn pivot(&self) -> Vec2 {
        self.map.plane.to_canvas(self.inner.center()).unwrap_or(self.corners.iter().sum::<Vec2>() * 0.25)
    }
    /// What lies at a canvas point; `grab_px`: how near is near.
    pub fn handle_at(&self, at: Vec2, grab_px: f32) -> FrameHandle {
        let near = |p: Vec2| p.distance(at) <= grab_px;
        if let Some(corner) = (0..4).find(|&i| near(self.corners[i])) {
            return FrameHandle::Corner(corner);
        }
        if let Some(edge) = (0..4).find(|&i| near(self.edge(i))) {
            return FrameHandle::Edge(edge);
        }
        let sides = (0..4).map(|i| (self.corners[(i + 1) % 4] - self.corners[i]).perp_dot(at - self.corners[i]));
        let sides: Vec<f32> = sides.collect();
        let inside = sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0);
        if inside { FrameHandle::Inside } else { FrameHandle::Outside }
    }
}

pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let document = context.document;
    let layers: Vec<&Layer> = context.chosen().iter().filter_map(|id| document.layer(*id)).map(|l| &**l).collect();
    if layers.is_empty() {
        return (None, Outcome::Idle);
    }
    if layers.iter().any(|layer| layer.lock == LayerLock::All) {
        let is_one = layers.len() == 1;
        return (None, Outcome::Refused(if is_one { "The layer is locked." } else { "One of the layers is locked." }));
    }
    let Some(frame) = TransformFrame::around(document, context.chosen()) else {
        return (None, Outcome::Refused("The layer is empty: there is nothing to transform."));
    };
    let handle = frame.handle_at(pen.place(), GRAB_PT * context.px_per_pt);
    let held = |layer: &&Layer| Some(HeldLayer { id: layer.id, own: layer.transform, map: document.map_of(layer.id)? });
    let layers = layers.iter().filter_map(held).collect();
    let (document, snap) = (document.clone(), context.snap.clone());
    let (from, lines) = (pen.place(), SnapLines::default());
    let gesture = TransformGesture { document, layers, frame, handle, from, found: None, snap, lines };
    (Some(Box::new(gesture)), Outcome::Idle)
}

/// A mirror about the origin.
pub fn mirror(upright: bool) -> PlaneMap {
    let [x, y] = if upright { [1.0, -1.0] } else { [-1.0, 1.0] };
    PlaneMap::affine([x, 0.0, 0.0, y, 0.0, 0.0]).unwrap_or_default()
}

/// A turn about the origin, counter-clockwise as seen; `None` of what is no number.
pub fn turn(degrees: f64) -> Option<PlaneMap> {
    degrees.is_finite().then(|| PlaneMap::rotation(degrees, Vec2::ZERO))
}

/// Layers with what they show mapped about the middle of it. `None` of empty layers, or where that cannot be said.
pub fn about_middle(document: &Document, layers: &[LayerId], map: PlaneMap) -> Option<Document> {
    let pivot = TransformFrame::around(document, layers)?.pivot();
    // A middle between pixels along one axis alone would move pixels by halves when they are turned.
    let pivot = if map.coefficients().is_some_and(|c| c[1] != 0.0) { pivot.round() } else { pivot };
    let on_canvas = PlaneMap::translation(-pivot).then(&map).then(&PlaneMap::translation(pivot));
    layers.iter().try_fold(document.clone(), |next, layer| mapped(&next, *layer, on_canvas))
}

/// A layer with what it shows taken along by a map of the canvas; `None` where that cannot be said.
pub fn mapped(document: &Document, layer: LayerId, on_canvas: PlaneMap) -> Option<Document> {
    let (own, whole) = (document.layer(layer)?.transform, document.map_of(layer)?);
    let plane = own.map_or(Some(PlaneMap::IDENTITY), |own| own.map(document.size))?;
    let next = taken_along(plane, &whole.plane, on_canvas);
    let transform = said(&next, own.map_or(whole.filter, |own| own.filter), document.size)?;
    document.with_layer(layer, |layer| layer.transform = transform)
}

/// A layer's own map so that what shows is taken along by a map of the canvas; `whole`: its own and those of the groups
/// around it.
fn taken_along(own: PlaneMap, whole: &PlaneMap, on_canvas: PlaneMap) -> PlaneMap {
    let around = own.inverse().then(whole);
    own.then(&around).then(&on_canvas).then(&around.inverse())
}

/// A map as a transform that a file holds, or none where it moves nothing; outer `None` where there is no such one.
fn said(map: &PlaneMap, filter: Resampling, canvas: Size) -> Option<Option<LayerTransform>> {
    if map.is_identity_on(canvas) {
        return Some(None);
    }
    let transform = LayerTransform::of_map(map, filter, canvas)?;
    transform.fits().ok().map(|()| Some(transform))
}

/// A layer that is dragged, as it was before.
struct HeldLayer {
    id: LayerId,
    own: Option<LayerTransform>,
    map: LayerMap,
}

struct TransformGesture {
    document: Document,
    layers: Vec<HeldLayer>,
    frame: TransformFrame,
    handle: FrameHandle,
    from: Vec2,
    /// The transforms as they were last dragged, one a layer; inner `None`: it stands where it was made.
    found: Option<Vec<Option<LayerTransform>>>,
    snap: SnapTargets,
    lines: SnapLines,
}

/// What a drag does to all that is in the frame.
enum FrameMap {
    OnCanvas(PlaneMap),
    /// Before the frame's own map.
    InFrame(PlaneMap),
}

impl TransformGesture {
    /// The layers' own transforms with the handle at the pen; `None` where one of them is no map.
    fn dragged(&self, pen: &PenSample) -> Option<Vec<Option<LayerTransform>>> {
        let map = match self.handle {
            FrameHandle::Inside => FrameMap::OnCanvas(PlaneMap::translation(self.moved_by(pen))),
            FrameHandle::Outside => FrameMap::OnCanvas(self.turned_by(pen)?),
            FrameHandle::Corner(corner) if pen.keys.ctrl => FrameMap::OnCanvas(self.distorted(corner, pen.place())?),
            FrameHandle::Edge(edge) if pen.keys.ctrl => FrameMap::InFrame(self.skewed(edge, pen.place())?),
            FrameHandle::Corner(corner) => {
                FrameMap::InFrame(self.scaled(self.frame.inner.corners()[corner], [true; 2], pen)?)
            }
            FrameHandle::Edge(edge) => {
                let [a, b] = [edge % 4, (edge + 1) % 4].map(|i| self.frame.inner.corners()[i]);
                // The upper and the lower edge are dragged up and down.
                let along_y = edge.is_multiple_of(2);
                FrameMap::InFrame(self.scaled((a + b) * 0.5, [!along_y, along_y], pen)?)
            }
        };
        self.layers.iter().map(|layer| self.dragged_layer(layer, &map)).collect()
    }
    fn dragged_layer(&self, layer: &HeldLayer, map: &FrameMap) -> Option<Option<LayerTransform>> {
        let canvas = self.document.size;
        let own = layer.own.map_or(Some(PlaneMap::IDENTITY), |own| own.map(canvas))?;
        let plane = match map {
            FrameMap::OnCanvas(map) => taken_along(own, &layer.map.plane, *map),
            // The frame of one layer is its own.
            FrameMap::InFrame(map) if self.layers.len() == 1 => map.then(&own),
            FrameMap::InFrame(map) => taken_along(own, &layer.map.plane, *map),
        };
        said(&plane, layer.own.map_or(layer.map.filter, |own| own.filter), canvas)
    }
    /// The pen where it snaps: with a handle itself, with the inside so that the frame does.
    fn snapped(&mut self, pen: &PenSample) -> PenSample {
        let at = pen.place();
        let (at, lines) = match self.handle {
            FrameHandle::Inside => {
                let by = at - self.from;
                let [low, high] = self.frame.bounds().map(|corner| corner + by);
                let shift = self.snap.shift(low, high);
                (at + shift.at, shift.lines)
            }
            FrameHandle::Corner(_) | FrameHandle::Edge(_) => {
                let found = self.snap.point(at);
                (found.at, found.lines)
            }
            FrameHandle::Outside => (at, SnapLines::default()),
        };
        self.lines = lines;
        let mut snapped = *pen;
        snapped.sample.at = at;
        snapped
    }
    fn moved_by(&self, pen: &PenSample) -> Vec2 {
        // Whole pixels, so that paint is not sampled where it need not be.
        let by = (pen.place() - self.from).round();
        match pen.keys.shift {
            true if by.x.abs() >= by.y.abs() => vec2(by.x, 0.0),
            true => vec2(0.0, by.y),
            false => by,
        }
    }
    fn turned_by(&self, pen: &PenSample) -> Option<PlaneMap> {
        let pivot = self.frame.pivot();
        let (before, after) = (self.from - pivot, pen.place() - pivot);
        if before.length() < 1.0 || after.length() < 1.0 {
            return None;
        }
        // Counter-clockwise as seen is clockwise in y-down coordinates.
        let degrees = f64::from(before.to_angle() - after.to_angle()).to_degrees();
        let degrees = if pen.keys.shift { (degrees / STEP_DEGREES).round() * STEP_DEGREES } else { degrees };
        Some(PlaneMap::rotation(degrees, pivot))
    }
    /// A scaling in the layer's frame that takes a handle to the pen. Shift keeps the aspect, Alt the middle.
    fn scaled(&self, handle: Vec2, axes: [bool; 2], pen: &PenSample) -> Option<PlaneMap> {
        let inner = self.frame.inner;
        let center = inner.center();
        let fixed = if pen.keys.alt { center } else { center * 2.0 - handle };
        let (to, _) = self.frame.map.plane.from_canvas(pen.place())?;
        let ratio = |k: usize| {
            let long = handle[k] - fixed[k];
            if axes[k] && long.abs() > 1e-3 { (to[k] - fixed[k]) / long } else { 1.0 }
        };
        let mut factors = [ratio(0), ratio(1)];
        if pen.keys.shift {
            let most = if (factors[0] - 1.0).abs() >= (factors[1] - 1.0).abs() { factors[0] } else { factors[1] };
            factors = [most; 2];
        }
        let [x, y] = factors.map(f64::from);
        let fixed = fixed.as_dvec2();
        PlaneMap::affine([x, 0.0, 0.0, y, fixed.x * (1.0 - x), fixed.y * (1.0 - y)])
    }
    /// A shear in the layer's frame that takes an edge along itself.
    fn skewed(&self, edge: usize, at: Vec2) -> Option<PlaneMap> {
        let corners = self.frame.inner.corners().map(|corner| corner.as_dvec2());
        let (a, opposite) = (corners[edge % 4], corners[(edge + 2) % 4]);
        let (to, _) = self.frame.map.plane.from_canvas(at)?;
        let (from, _) = self.frame.map.plane.from_canvas(self.from)?;
        let by = (to - from).as_dvec2();
        if edge.is_multiple_of(2) {
            let k = by.x / (a.y - opposite.y);
            return PlaneMap::affine([1.0, 0.0, k, 1.0, -k * opposite.y, 0.0]);
        }
        let k = by.y / (a.x - opposite.x);
        PlaneMap::affine([1.0, k, 0.0, 1.0, 0.0, -k * opposite.x])
    }
    /// A perspective of the canvas that takes one corner to the pen and leaves the others.
    fn distorted(&self, corner: usize, at: Vec2) -> Option<PlaneMap> {
        let mut corners = self.frame.corners;
        corners[corner] = at;
        let FrameBox { low, high } = self.frame.inner;
        let whole = PlaneMap::rect_to_quad(low.as_dvec2(), high.as_dvec2(), corners.map(|c| c.as_dvec2()))?;
        Some(self.frame.map.plane.inverse().then(&whole))
    }
    fn with(&self, transforms: &[Option<LayerTransform>]) -> Option<Document> {
        let all = self.layers.iter().zip(transforms);
        all.into_iter().try_fold(self.document.clone(), |next, (held, transform)| {
            next.with_layer(held.id, |layer| layer.transform = *transform)
        })
    }
}

/// Turns with Shift go from one multiple of this to the next.
const STEP_DEGREES: f64 = 15.0;

impl Gesture for TransformGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let pen = &self.snapped(pen);
        let Some(found) = self.dragged(pen) else { return Outcome::Idle };
        let shown = self.with(&found);
        self.found = Some(found);
        shown.map_or(Outcome::Idle, Outcome::Preview)
    }
    fn release(&mut self) -> Outcome {
        let label = match self.handle {
            FrameHandle::Inside => "Move",
            FrameHandle::Outside => "Turn",
            FrameHandle::Corner(_) | FrameHandle::Edge(_) => "Transform",
        };
        let is_other = |found: &Vec<_>| found.iter().zip(&self.layers).any(|(found, held)| *found != held.own);
        match self.found.as_ref().filter(|found| is_other(found)).and_then(|found| self.with(found)) {
            Some(document) => Outcome::Commit { label: label.into(), document, select: None },
            None => Outcome::Cancel,
        }
    }
    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}

#[cfg(test)]
mod tests;
