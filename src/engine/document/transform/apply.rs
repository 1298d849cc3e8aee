//! Applies transforms for good: the frames of a layer become the canvas, so that tools can work on it as it shows.
//! Floor 4.

use super::{LayerMap, LayerTransform, TransformShape, on_canvas};
use crate::document::{Content, Document, Group, Layer, LayerId, Live};
use crate::math::{Affine2, PlaneMap, Size, Vec2, vec2};
use crate::paint::{PlacedImage, Placement};
use crate::raster::Resampling;
use std::sync::Arc;

impl Document {
    /// The same picture with the frame of a layer on the canvas, as far as its kind can say: pixels are sampled for
    /// good, strokes, ramps, lights and placements take new numbers. The transforms of groups around it go to the
    /// layers in them. An image or a ramp that is skewed or in perspective keeps its transform. `None` if there is no
    /// such layer.
    pub fn with_transform_applied(&self, id: LayerId) -> Option<Document> {
        if self.map_of(id)?.is_none() && self.layer(id)?.transform.is_none() {
            return Some(self.clone());
        }
        let layers = applied(&self.layers, id, self.size)?;
        Some(Document { layers, ..self.clone() })
    }
}

/// A list of layers with the transforms on the way to a layer handed down; `None` if it is not among them.
fn applied(layers: &[Arc<Layer>], id: LayerId, canvas: Size) -> Option<Vec<Arc<Layer>>> {
    let index = layers.iter().position(|layer| layer.id == id || holds(layer, id))?;
    let mut next = layers.to_vec();
    next[index] = if layers[index].id == id {
        in_place(&layers[index], canvas)
    } else {
        let mut outer = handed_down(&layers[index], canvas)?;
        if let Content::Group(group) = &mut outer.content {
            group.layers = applied(&group.layers, id, canvas)?;
        }
        Arc::new(outer)
    };
    Some(next)
}

fn holds(layer: &Layer, id: LayerId) -> bool {
    layer.content.group().is_some_and(|group| group.layers.iter().any(|layer| layer.id == id || holds(layer, id)))
}

/// A group without its transform: each layer in it has it instead. `None` where that cannot be said.
fn handed_down(group: &Arc<Layer>, canvas: Size) -> Option<Layer> {
    let Some(transform) = group.transform else { return Some(Layer::clone(group)) };
    let outer = transform.map(canvas)?;
    let down = |layer: &Arc<Layer>| {
        let (own, filter) = match &layer.transform {
            Some(own) => (own.map(canvas)?, own.filter),
            None => (PlaneMap::IDENTITY, transform.filter),
        };
        let transform = said(&own.then(&outer), filter, canvas)?;
        Some(Arc::new(Layer { transform: Some(transform), ..Layer::clone(layer) }))
    };
    let inner: Option<Vec<Arc<Layer>>> = group.content.group()?.layers.iter().map(down).collect();
    // Its mask goes along once.
    let seen = on_canvas(group, &LayerMap::none(canvas));
    let content = Content::Group(Group { layers: inner?, ..group.content.group()?.clone() });
    Some(Layer { content, mask: seen.mask.clone(), transform: None, ..Layer::clone(group) })
}

impl LayerTransform {
    /// A map of the plane as a transform; `None` of a perspective whose horizon crosses the canvas.
    pub fn of_map(map: &PlaneMap, filter: Resampling, canvas: Size) -> Option<Self> {
        said(map, filter, canvas)
    }
}

fn said(map: &PlaneMap, filter: Resampling, canvas: Size) -> Option<LayerTransform> {
    if let Some(coefficients) = map.coefficients() {
        return Some(LayerTransform { shape: TransformShape::Matrix(coefficients), filter });
    }
    let (w, h) = (canvas.width as f32, canvas.height as f32);
    let corners = [vec2(0.0, 0.0), vec2(w, 0.0), vec2(w, h), vec2(0.0, h)].map(|corner| map.to_canvas(corner));
    let [Some(a), Some(b), Some(c), Some(d)] = corners else { return None };
    let shape = TransformShape::Quad([a, b, c, d].map(|corner| corner.as_dvec2()));
    let transform = LayerTransform { shape, filter };
    transform.map(canvas).map(|_| transform)
}

/// A layer on the canvas without its transform, where its kind can say so.
pub(in crate::document) fn in_place(layer: &Arc<Layer>, canvas: Size) -> Arc<Layer> {
    if layer.content.group().is_some() {
        return handed_down(layer, canvas).map_or_else(|| layer.clone(), Arc::new);
    }
    let seen = on_canvas(layer, &LayerMap::none(canvas));
    let content = match &seen.content {
        Content::Image(live) => live.params().unframed().map(|image| Content::Image(Live::new(image))),
        Content::Gradient(live) => live.params().unframed().map(|ramp| Content::Gradient(Live::new(ramp))),
        Content::Normals(normals) => placed(&normals.placement, &normals.frame).map(|placement| {
            Content::Normals(crate::document::NormalLayer { placement, frame: PlaneMap::IDENTITY, ..normals.clone() })
        }),
        content => Some(content.clone()),
    };
    match content {
        Some(content) => Arc::new(Layer { content, transform: None, ..Layer::clone(&seen) }),
        None => layer.clone(),
    }
}

impl PlacedImage {
    /// The same image placed on the canvas itself; `None` where its frame is mirrored, skewed or in perspective.
    fn unframed(&self) -> Option<PlacedImage> {
        let placement = placed(&self.placement, &self.frame)?;
        Some(PlacedImage { placement, frame: PlaneMap::IDENTITY, ..self.clone() })
    }
}

impl crate::paint::Gradient {
    /// The same ramp with its ends on the canvas; `None` where its frame is skewed or in perspective.
    fn unframed(&self) -> Option<Self> {
        similarity(&self.frame, true)?;
        let (from, to) = (self.frame.to_canvas(self.from)?, self.frame.to_canvas(self.to)?);
        Some(Self { from, to, frame: PlaneMap::IDENTITY, ..self.clone() })
    }
}

/// A placement on the canvas that a frame lies on; `None` of a frame that is mirrored, skewed or in perspective.
pub(in crate::document) fn placed(placement: &Placement, frame: &PlaneMap) -> Option<Placement> {
    let map = similarity(frame, false)?;
    let along = map.matrix2.x_axis;
    Some(Placement {
        center: map.transform_point2(placement.center),
        scale: placement.scale * along.length(),
        // y points down: a positive angle turns clockwise as seen.
        rotation: placement.rotation - along.to_angle().to_degrees(),
    })
}

/// The map where it only moves, turns and scales (and mirrors, if it `may_mirror`).
fn similarity(map: &PlaneMap, may_mirror: bool) -> Option<Affine2> {
    let affine = map.as_affine()?;
    let (x, y) = (affine.matrix2.x_axis, affine.matrix2.y_axis);
    let length = x.length();
    let off = |v: Vec2| v.length() > 1e-5 * length;
    let is_turn = !off(y - x.perp());
    let is_mirror = !off(y + x.perp());
    (is_turn || may_mirror && is_mirror).then_some(affine)
}
