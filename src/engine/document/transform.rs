//! Transforms: where a layer's own frame lies on the canvas. Floor 4.
//!
//! Whatever a layer holds (samples, anchors, placements, ramps, lights, pixels, its mask) lies in the layer's own
//! frame. A transform takes that frame to the canvas, one of a group takes along all layers in it. Layers are seen
//! through their transforms when they are prepared: live ones with their parameters taken along, pixels sampled once,
//! however many transforms there were.
//!
//! What lies on a part of the shape is carried by it: first the layer's own transform, then the part's matrix, then the
//! transforms of the groups around. The innermost home counts; those of groups around it do not.

pub(super) mod apply;
mod extent;
mod homes;
mod mesh;
mod seen;

pub use extent::FrameBox;
pub(in crate::document) use homes::transform_of;
pub use mesh::{Mesh, MeshFrame};
pub(super) use seen::CanvasCache;

use super::warp::LayerWarp;
use super::{Content, Group, Layer};
use crate::math::plane_map::{PixelMove, orthogonal};
use crate::math::{COORDINATE, DVec2, Mat2, PlaneMap, Rect, Size, Vec2, range};
use crate::paint::{HomeFrame, StrokeHome};
use crate::raster::Resampling;
use crate::raster::warp::{PixelMap, PointRow};
use std::sync::Arc;

/// Where a layer's frame lies, and how its pixels are sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerTransform {
    pub shape: TransformShape,
    pub filter: Resampling,
}

#[derive(Clone, Debug, PartialEq)]
pub enum TransformShape {
    /// a, b, c, d, e, f: x′ = a x + c y + e, y′ = b x + d y + f.
    Matrix([f64; 6]),
    /// Where the canvas's corners go: upper left, upper right, lower right, lower left.
    Quad([DVec2; 4]),
    /// Where the points of a grid go.
    Mesh(Arc<Mesh>),
}

impl LayerTransform {
    /// Factors and shears; places have the range of coordinates.
    pub const FACTOR: range::Range = -1e4..=1e4;

    /// The map of the plane; `None` where a matrix cannot be inverted or corners form no convex quadrilateral. A mesh
    /// that no matrix says leaves the plane and displaces what is seen ([`LayerWarp`]).
    pub fn map(&self, canvas: Size) -> Option<PlaneMap> {
        match &self.shape {
            TransformShape::Matrix(coefficients) => PlaneMap::affine(*coefficients),
            TransformShape::Quad(corners) => PlaneMap::quad(canvas, *corners),
            TransformShape::Mesh(mesh) => Some(mesh.as_affine().unwrap_or_default()),
        }
    }
    /// The mesh that it is, if it is one.
    pub fn mesh(&self) -> Option<&Arc<Mesh>> {
        if let TransformShape::Mesh(mesh) = &self.shape { Some(mesh) } else { None }
    }
    /// Refuses numbers that no file gives back, and what is no map.
    pub fn fits(&self) -> Result<(), String> {
        let place = |v: f64| range::within("a place of the transform", v as f32, &COORDINATE);
        match &self.shape {
            TransformShape::Matrix([a, b, c, d, e, f]) => {
                [a, b, c, d]
                    .into_iter()
                    .try_for_each(|v| range::within("a factor of the transform", *v as f32, &Self::FACTOR))?;
                [*e, *f].into_iter().try_for_each(place)?;
                self.map(Size::new(1, 1)).map(|_| ()).ok_or_else(|| "cannot be inverted: it leaves no area".into())
            }
            TransformShape::Quad(corners) => {
                corners.iter().flat_map(|corner| corner.to_array()).try_for_each(place)?;
                self.map(Size::new(1, 1)).map(|_| ()).ok_or_else(|| "is no convex quadrilateral".into())
            }
            TransformShape::Mesh(mesh) => mesh.fits(),
        }
    }
    /// The same picture on a canvas `per_axis` times as large.
    pub(super) fn scaled(&self, per_axis: Vec2) -> Self {
        let s = per_axis.as_dvec2();
        let shape = match &self.shape {
            TransformShape::Matrix(coefficients) => TransformShape::Matrix(scaled(*coefficients, per_axis)),
            TransformShape::Quad(corners) => TransformShape::Quad(corners.map(|corner| corner * s)),
            TransformShape::Mesh(mesh) => TransformShape::Mesh(Arc::new(mesh.scaled(per_axis))),
        };
        Self { shape, ..*self }
    }
}

/// The matrix that does on a canvas `per_axis` times as large what this one does.
pub(super) fn scaled([a, b, c, d, e, f]: [f64; 6], per_axis: Vec2) -> [f64; 6] {
    let s = per_axis.as_dvec2();
    [a, b * s.y / s.x, c * s.x / s.y, d, e * s.x, f * s.y]
}

/// All transforms that act on a layer, as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerMap {
    pub plane: PlaneMap,
    pub filter: Resampling,
    canvas: Size,
    /// The transform of the layer itself.
    own: PlaneMap,
    /// Those of the groups around it, without the homes of these.
    around: PlaneMap,
}

impl LayerMap {
    /// Of layers that stay where they are.
    pub fn none(canvas: Size) -> Self {
        let [plane, own, around] = [PlaneMap::IDENTITY; 3];
        Self { plane, filter: Resampling::default(), canvas, own, around }
    }
    /// Of pixels alone, seen through any map.
    pub(super) fn of_plane(plane: PlaneMap, filter: Resampling, canvas: Size) -> Self {
        Self { plane, filter, ..Self::none(canvas) }
    }
    /// The same after another map.
    pub(super) fn after(&self, first: &PlaneMap) -> Self {
        Self { plane: first.then(&self.plane), ..*self }
    }
    /// With the transform and the home of one more layer inside.
    pub fn within(&self, layer: &Layer) -> Self {
        let own = layer.transform.as_ref().and_then(|transform| transform.map(self.canvas)).unwrap_or_default();
        let plane = own.then(&self.outside(layer.on.as_ref()));
        let filter = layer.transform.as_ref().map_or(self.filter, |transform| transform.filter);
        Self { plane, filter, own, around: self.without_homes(), ..*self }
    }
    /// What takes the frame of a layer inside, its own transform done, to the canvas.
    fn outside(&self, home: Option<&HomeFrame>) -> PlaneMap {
        match home {
            Some(home) => home.map().then(&self.without_homes()),
            None => self.plane,
        }
    }
    /// The map of the list that the layer stands in.
    pub fn of_list(&self) -> Self {
        Self { plane: self.outside_own(), own: PlaneMap::IDENTITY, ..*self }
    }
    /// What takes the list that the layer stands in to the canvas.
    pub fn outside_own(&self) -> PlaneMap {
        if self.own == PlaneMap::IDENTITY { self.plane } else { self.own.inverse().then(&self.plane) }
    }
    /// As [`LayerMap::plane`] while every part stands where it was made.
    pub(super) fn without_homes(&self) -> PlaneMap {
        self.own.then(&self.around)
    }
    /// The same layer where its parts were made: it is carried nowhere.
    pub(super) fn at_home(&self) -> Self {
        Self { plane: self.without_homes(), ..*self }
    }
    /// Of a stroke of the layer that has a home of its own.
    pub(super) fn of_stroke(&self, home: &StrokeHome) -> Self {
        let own = home.own_map().then(&self.own);
        Self { plane: own.then(&home.frame.map()).then(&self.around), own, ..*self }
    }
    pub fn is_none(&self) -> bool {
        self.plane.is_identity_on(self.canvas)
    }
    /// Nor does it move anything that lies on a home of its own.
    pub(super) fn moves_nothing(&self) -> bool {
        self.is_none() && self.without_homes().is_identity_on(self.canvas)
    }
    pub(super) fn canvas(&self) -> Size {
        self.canvas
    }
    /// Where a point of the frame lies; one beyond the horizon stays.
    pub(super) fn point(&self, p: Vec2) -> Vec2 {
        self.plane.to_canvas(p).unwrap_or(p)
    }
    /// How lengths and directions change about a point of the frame.
    pub(super) fn stretch_at(&self, p: Vec2) -> Mat2 {
        self.plane.stretch_at(p).unwrap_or(Mat2::IDENTITY)
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
    fn source_row(&self, x: i32, y: i32, count: usize, row: &mut PointRow) {
        row.fill_by_plane(&self.plane, x, y, count);
    }
    fn pixel_move(&self) -> Option<PixelMove> {
        self.plane.pixel_move_on(self.canvas)
    }
    fn source_rect(&self, canvas: Rect) -> Rect {
        self.plane.source_rect(canvas)
    }
}

impl LayerMap {
    /// A layer of which this is the map, as it lies on the canvas: content and mask taken there, no transform, no home.
    pub fn layer_on_canvas(&self, layer: &Arc<Layer>) -> Arc<Layer> {
        let seen = seen(layer, self);
        Arc::new(Layer { transform: None, liquify: None, on: None, ..Layer::clone(&seen) })
    }
}

/// A layer as it lies on the canvas: content and mask taken there. The layers of a group are taken one by one.
pub(super) fn on_canvas(layer: &Arc<Layer>, map: &LayerMap) -> Arc<Layer> {
    seen(layer, &map.within(layer))
}

/// The same with the layer's own transform and home in the map.
fn seen(layer: &Arc<Layer>, map: &LayerMap) -> Arc<Layer> {
    let warp = LayerWarp::of(layer, map);
    if map.is_none() && warp.is_none() && !layer.content.has_homes() {
        return layer.clone();
    }
    let (content, mask) = layer.cache.on_canvas.get(layer, map, warp.as_ref());
    Arc::new(Layer { content, mask, transform: None, liquify: None, on: None, ..Layer::clone(layer) })
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
