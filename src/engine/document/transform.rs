//! Transforms: where a layer's own frame lies on the canvas. Floor 4.
//!
//! Whatever a layer holds (samples, anchors, placements, ramps, lights, pixels, its mask) lies in the layer's own
//! frame. A transform takes that frame to the canvas, one of a group takes along all layers in it. Layers are seen
//! through their transforms when they are prepared: live ones with their parameters taken along, pixels sampled once,
//! however many transforms there were.

pub(super) mod apply;
mod extent;

pub use extent::FrameBox;

use super::{Content, Group, Layer, LayerMask, MaskKind};
use crate::math::plane_map::{PixelMove, orthogonal};
use crate::math::{COORDINATE, DVec2, Mat2, PlaneMap, Rect, Size, Vec2, range};
use crate::raster::warp::{PixelMap, warped_plane};
use crate::raster::{Plane, Resampling};
use crate::surface::Anchor;
use std::sync::{Arc, Mutex, PoisonError};

/// Where a layer's frame lies, and how its pixels are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerTransform {
    pub shape: TransformShape,
    pub filter: Resampling,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TransformShape {
    /// a, b, c, d, e, f: x′ = a x + c y + e, y′ = b x + d y + f.
    Matrix([f64; 6]),
    /// Where the canvas's corners go: upper left, upper right, lower right, lower left.
    Quad([DVec2; 4]),
}

impl LayerTransform {
    /// Factors and shears; places have the range of coordinates.
    pub const FACTOR: range::Range = -1e4..=1e4;

    /// The map of the plane; `None` where a matrix cannot be inverted or corners form no convex quadrilateral.
    pub fn map(&self, canvas: Size) -> Option<PlaneMap> {
        match self.shape {
            TransformShape::Matrix(coefficients) => PlaneMap::affine(coefficients),
            TransformShape::Quad(corners) => PlaneMap::quad(canvas, corners),
        }
    }
    /// Refuses numbers that no file gives back, and what is no map.
    pub fn fits(&self) -> Result<(), String> {
        let place = |v: f64| range::within("a place of the transform", v as f32, &COORDINATE);
        match self.shape {
            TransformShape::Matrix([a, b, c, d, e, f]) => {
                [a, b, c, d]
                    .into_iter()
                    .try_for_each(|v| range::within("a factor of the transform", v as f32, &Self::FACTOR))?;
                [e, f].into_iter().try_for_each(place)?;
                self.map(Size::new(1, 1)).map(|_| ()).ok_or_else(|| "cannot be inverted: it leaves no area".into())
            }
            TransformShape::Quad(corners) => {
                corners.into_iter().flat_map(|corner| corner.to_array()).try_for_each(place)?;
                self.map(Size::new(1, 1)).map(|_| ()).ok_or_else(|| "is no convex quadrilateral".into())
            }
        }
    }
    /// The same picture on a canvas `per_axis` times as large.
    pub(super) fn scaled(&self, per_axis: Vec2) -> Self {
        let s = per_axis.as_dvec2();
        let shape = match self.shape {
            TransformShape::Matrix([a, b, c, d, e, f]) => {
                TransformShape::Matrix([a, b * s.y / s.x, c * s.x / s.y, d, e * s.x, f * s.y])
            }
            TransformShape::Quad(corners) => TransformShape::Quad(corners.map(|corner| corner * s)),
        };
        Self { shape, ..*self }
    }
}

/// All transforms that act on a layer, as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerMap {
    pub plane: PlaneMap,
    pub filter: Resampling,
    canvas: Size,
}

impl LayerMap {
    /// Of layers that stay where they are.
    pub fn none(canvas: Size) -> Self {
        Self { plane: PlaneMap::IDENTITY, filter: Resampling::default(), canvas }
    }
    /// Of pixels alone, seen through any map.
    pub(super) fn of_plane(plane: PlaneMap, filter: Resampling, canvas: Size) -> Self {
        Self { plane, filter, canvas }
    }
    /// The same after another map.
    pub(super) fn after(&self, first: &PlaneMap) -> Self {
        Self { plane: first.then(&self.plane), ..*self }
    }
    /// With the transform of one more layer inside.
    pub fn within(&self, layer: &Layer) -> Self {
        let Some(transform) = &layer.transform else { return *self };
        let plane = transform.map(self.canvas).unwrap_or_default().then(&self.plane);
        Self { plane, filter: transform.filter, ..*self }
    }
    pub fn is_none(&self) -> bool {
        self.plane.is_identity_on(self.canvas)
    }
    pub(super) fn canvas(&self) -> Size {
        self.canvas
    }
    /// Where a point of the frame lies; one beyond the horizon stays.
    pub(super) fn point(&self, p: Vec2) -> Vec2 {
        self.plane.to_canvas(p).unwrap_or(p)
    }
    pub(super) fn anchors(&self, anchors: &[Anchor]) -> Vec<Anchor> {
        anchors.iter().map(|a| Anchor { at: self.point(a.at), source: self.point(a.source) }).collect()
    }
    /// How much longer lengths become about a point of the frame: √|det J|.
    pub fn length_at(&self, p: Vec2) -> f32 {
        self.plane.stretch_at(p).map_or(1.0, |jacobian| jacobian.determinant().abs().sqrt())
    }
    /// How directions turn about a point of the frame, mirrored where the map mirrors.
    pub fn turn_at(&self, p: Vec2) -> Mat2 {
        self.plane.stretch_at(p).map_or(Mat2::IDENTITY, orthogonal)
    }
}

impl PixelMap for LayerMap {
    fn source_of(&self, q: Vec2) -> Option<(Vec2, Mat2)> {
        self.plane.from_canvas(q)
    }
    fn pixel_move(&self) -> Option<PixelMove> {
        self.plane.pixel_move_on(self.canvas)
    }
    fn source_rect(&self, canvas: Rect) -> Rect {
        self.plane.source_rect(canvas)
    }
}

impl LayerMap {
    /// A layer of its frame, without its own transform, as it lies on the canvas: content and mask taken there.
    pub fn layer_on_canvas(&self, layer: &Arc<Layer>) -> Arc<Layer> {
        let bare = Layer { transform: None, ..Layer::clone(layer) };
        on_canvas(&Arc::new(bare), self)
    }
}

/// A layer as it lies on the canvas: content and mask taken there. The layers of a group are taken one by one.
pub(super) fn on_canvas(layer: &Arc<Layer>, map: &LayerMap) -> Arc<Layer> {
    let map = &map.within(layer);
    if map.is_none() {
        return layer.clone();
    }
    let (content, mask) = layer.cache.on_canvas.get(layer, map);
    Arc::new(Layer { content, mask, transform: None, ..Layer::clone(layer) })
}

/// What layers were last seen as; shared by the versions of a layer.
#[derive(Clone, Default)]
pub struct CanvasCache {
    /// The newest last.
    entries: Arc<Mutex<Vec<CanvasEntry>>>,
}

#[derive(Clone)]
struct CanvasEntry {
    map: LayerMap,
    own: Content,
    own_mask: Option<LayerMask>,
    content: Content,
    mask: Option<LayerMask>,
}

impl CanvasCache {
    /// Of the picture before an edit and the one after it.
    const KEPT: usize = 2;

    fn get(&self, layer: &Layer, map: &LayerMap) -> (Content, Option<LayerMask>) {
        let entries = self.lock().clone();
        let mut alike = entries.iter().rev().filter(|entry| entry.map == *map);
        let same = alike.clone().find(|entry| entry.own.is_identical(&layer.content));
        let last = same.or_else(|| alike.next());
        let same_mask = |a: &Option<LayerMask>| match (a, &layer.mask) {
            (Some(a), Some(b)) => a.is_same(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let content = last.map_or_else(
            || layer.content.on_canvas(map, None),
            |last| layer.content.on_canvas(map, Some((&last.own, &last.content))),
        );
        let mask = match last.filter(|last| same_mask(&last.own_mask)) {
            Some(last) => last.mask.clone(),
            None => layer.mask.as_ref().map(|mask| mask_on_canvas(mask, map)),
        };
        let entry = CanvasEntry {
            map: *map,
            own: layer.content.clone(),
            own_mask: layer.mask.clone(),
            content: content.clone(),
            mask: mask.clone(),
        };
        let mut entries = self.lock();
        entries.retain(|other| !(other.map == entry.map && other.own.is_identical(&entry.own)));
        entries.push(entry);
        let surplus = entries.len().saturating_sub(Self::KEPT);
        entries.drain(..surplus);
        (content, mask)
    }
    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<CanvasEntry>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn mask_on_canvas(mask: &LayerMask, map: &LayerMap) -> LayerMask {
    let MaskKind::File { file, coverage } = &mask.kind else { return mask.clone() };
    let coverage: Plane<u8> = warped_plane(coverage, map, map.filter);
    LayerMask { kind: MaskKind::File { file: file.clone(), coverage: Arc::new(coverage) }, ..mask.clone() }
}

/// Visits the layers of a list with the map of each, groups opened, bottom first.
pub(super) fn each_with_map<'d>(
    layers: &'d [Arc<Layer>],
    around: &LayerMap,
    visit: &mut dyn FnMut(&'d Arc<Layer>, LayerMap),
) {
    for layer in layers {
        let map = around.within(layer);
        visit(layer, map);
        if let Content::Group(Group { layers, .. }) = &layer.content {
            each_with_map(layers, &map, visit);
        }
    }
}

#[cfg(test)]
mod tests;
