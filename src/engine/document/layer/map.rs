//! All transforms that act on a layer, as one map of the plane. Floor 4.
//!
//! Whatever a layer holds (samples, anchors, placements, ramps, lights, pixels, its mask) lies in
//! the layer's own frame. A transform takes that frame to the canvas; one of a group moves all
//! layers in it. Layers are seen through their transforms when they are prepared: the parameters of
//! live ones are mapped, pixels are sampled once, however many transforms there are.
//!
//! What lies on a part of the shape is carried by it: first the layer's own transform, then the
//! part's matrix, then the transforms of the groups around. The innermost attachment counts; those
//! of groups around it do not.

use super::Layer;
use crate::math::plane_map::{PixelMove, orthogonal};
use crate::math::{Mat2, PlaneMap, Rect, Size, Vec2};
use crate::paint::{Attachment, StrokeAttachment};
use crate::raster::Resampling;
use crate::raster::warp::{PixelMap, PointRow};

/// All transforms that act on a layer, as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerMap {
    /// Canvas from layer.
    pub plane: PlaneMap,
    /// How pixels are read under it.
    pub filter: Resampling,
    pub(in crate::document) canvas: Size,
    /// The transform of the layer itself.
    own: PlaneMap,
    /// Those of the groups around it, without the attachments of these.
    around: PlaneMap,
}

impl LayerMap {
    /// For layers that stay where they are.
    pub fn none(canvas: Size) -> Self {
        let [plane, own, around] = [PlaneMap::IDENTITY; 3];
        Self { plane, filter: Resampling::default(), canvas, own, around }
    }

    /// For pixels alone, seen through any map.
    pub(in crate::document) fn of_plane(plane: PlaneMap, filter: Resampling, canvas: Size) -> Self {
        Self { plane, filter, ..Self::none(canvas) }
    }

    /// The same after another map.
    pub(in crate::document) fn after(&self, first: &PlaneMap) -> Self {
        Self { plane: first.then(&self.plane), ..*self }
    }

    /// The same with another map in total.
    pub(in crate::document) fn with_plane(&self, plane: PlaneMap) -> Self {
        Self { plane, ..*self }
    }

    /// With the transform and the attachment of one more layer inside.
    pub fn within(&self, layer: &Layer) -> Self {
        let own = layer
            .transform
            .as_ref()
            .and_then(|transform| transform.map(self.canvas))
            .unwrap_or_default();
        let plane = own.then(&self.map_outside(layer.on.as_ref()));
        let filter = layer.transform.as_ref().map_or(self.filter, |transform| transform.filter);
        Self { plane, filter, own, around: self.without_attachments(), ..*self }
    }

    /// What takes the frame of a layer inside, after its own transform, to the canvas.
    pub(in crate::document) fn map_outside(&self, attachment: Option<&Attachment>) -> PlaneMap {
        match attachment {
            Some(attachment) => attachment.map().then(&self.without_attachments()),
            None => self.plane,
        }
    }

    /// The map of the list that holds the layer.
    pub fn of_list(&self) -> Self {
        Self { plane: self.map_outside_own(), own: PlaneMap::IDENTITY, ..*self }
    }

    /// What takes the list that holds the layer to the canvas.
    pub fn map_outside_own(&self) -> PlaneMap {
        if self.own == PlaneMap::IDENTITY {
            self.plane
        } else {
            self.own.inverse().then(&self.plane)
        }
    }

    /// As [`LayerMap::plane`] while every part is where it was made.
    pub(in crate::document) fn without_attachments(&self) -> PlaneMap {
        self.own.then(&self.around)
    }

    /// The same layer where its parts were made: no part carries it.
    pub(in crate::document) fn unattached(&self) -> Self {
        Self { plane: self.without_attachments(), ..*self }
    }

    /// For a stroke of the layer that has an attachment of its own.
    pub(in crate::document) fn of_stroke(&self, attachment: &StrokeAttachment) -> Self {
        let own = attachment.own_map().then(&self.own);
        Self { plane: own.then(&attachment.frame.map()).then(&self.around), own, ..*self }
    }

    /// It moves nothing that has no attachment of its own.
    pub fn is_none(&self) -> bool {
        self.plane.is_identity_on(self.canvas)
    }

    /// Nor does it move anything that lies on an attachment of its own.
    pub(in crate::document) fn is_still(&self) -> bool {
        self.is_none() && self.without_attachments().is_identity_on(self.canvas)
    }

    pub(in crate::document) fn canvas(&self) -> Size {
        self.canvas
    }

    /// Where a point of the frame lies; one beyond the horizon stays.
    pub(in crate::document) fn point(&self, p: Vec2) -> Vec2 {
        self.plane.to_canvas(p).unwrap_or(p)
    }

    /// How lengths and directions change about a point of the frame.
    pub(in crate::document) fn stretch_at(&self, p: Vec2) -> Mat2 {
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
