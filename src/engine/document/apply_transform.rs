//! Applies transforms for good: the frames of a layer become the canvas, so that tools can work on
//! it as it shows. Floor 4.

use super::attachments::{preserve_look, transform_of};
use super::layer::on_canvas::apply_map;
use super::{
    Content, Document, Group, Layer, LayerId, LayerMap, LayerTransform, Live, NormalLayer,
    StrokeList,
};
use crate::math::{Affine2, PlaneMap, Vec2};
use crate::paint::{PlacedImage, Placement, StrokeAttachment};
use std::sync::Arc;

impl Document {
    /// The same picture with the frame of a layer on the canvas, as far as its kind can say: pixels
    /// are sampled for good, strokes, ramps, lights and placements take new numbers. The transforms
    /// of groups around it go to the layers in them. An image or a ramp that is skewed or in
    /// perspective keeps its transform. `None` if there is no such layer.
    ///
    /// What a part carries stays with it: the layer's transform becomes the inverse of where its
    /// attachment is now, so that its coordinates are those of the canvas until the part moves.
    pub fn with_transform_applied(&self, id: LayerId) -> Option<Document> {
        if is_in_place(self.layer(id)?, &self.map_of(id)?) {
            return Some(self.clone());
        }
        let layers = apply_in_list(&self.layers, id, &LayerMap::none(self.size))?;
        Some(Document { layers, ..self.clone() })
    }

    /// The transform with which a layer's frame is the canvas. `None` if there is no such layer, or
    /// no such transform.
    pub fn transform_to_canvas(&self, id: LayerId) -> Option<Option<LayerTransform>> {
        let (layer, around) = (self.layer(id)?, self.map_around(id)?);
        transform_of(&around.map_outside(layer.on.as_ref()).inverse(), &around.within(layer))
    }
}

/// Whether the frame of a layer and those of its strokes are the canvas, with no transform that
/// could be dropped.
fn is_in_place(layer: &Layer, map: &LayerMap) -> bool {
    let is_carried = map.plane != map.without_attachments();
    let strokes_are = || match &layer.content {
        Content::Strokes(live) if layer.content.has_attachments() => {
            let attachments = live.params().strokes.iter().filter_map(|stroke| stroke.attachment());
            attachments.into_iter().all(|attachment| map.of_stroke(attachment).is_none())
        }
        _ => true,
    };
    map.is_none()
        && !layer.is_warped()
        && (layer.transform.is_none() || is_carried)
        && strokes_are()
}

/// A list of layers in which the transforms of the groups around a layer are handed down; `None` if
/// it is not among them.
fn apply_in_list(layers: &[Arc<Layer>], id: LayerId, around: &LayerMap) -> Option<Vec<Arc<Layer>>> {
    let index = layers.iter().position(|layer| layer.id == id || layer.has_layer_within(id))?;
    let mut next = layers.to_vec();
    next[index] = if layers[index].id == id {
        in_place(&layers[index], around)
    } else {
        let mut outer = hand_down_transform(&layers[index], around)?;
        let within = around.within(&outer);
        if let Content::Group(group) = &mut outer.content {
            group.layers = apply_in_list(&group.layers, id, &within)?;
        }
        Arc::new(outer)
    };
    Some(next)
}

/// A group whose frame is the canvas: each layer in it has its transform instead. `None` where that
/// cannot be expressed.
fn hand_down_transform(group: &Arc<Layer>, around: &LayerMap) -> Option<Layer> {
    let was = around.within(group);
    // Its mesh and liquify cannot be handed down.
    if group.is_warped() {
        return was.is_none().then(|| Layer::clone(group));
    }
    if is_in_place(group, &was) {
        return Some(Layer::clone(group));
    }
    let transform = transform_of(&around.map_outside(group.on.as_ref()).inverse(), &was)?;
    let bare = Layer { transform, ..Layer::clone(group) };
    let now = around.within(&bare);
    let inner = group.content.group()?.layers.iter();
    let inner: Option<Vec<Arc<Layer>>> = inner
        .map(|layer| preserve_look(layer, (&was, &now), &|attachment| Some(attachment.clone())))
        .collect();
    // Its mask is transformed once.
    let mask = apply_map(group, &was).mask.clone();
    let content = Content::Group(Group { layers: inner?, ..group.content.group()?.clone() });
    Some(Layer { content, mask, ..bare })
}

/// A layer on the canvas without its transform, where its kind can express it.
pub(in crate::document) fn in_place(layer: &Arc<Layer>, around: &LayerMap) -> Arc<Layer> {
    if layer.content.group().is_some() {
        return hand_down_transform(layer, around).map_or_else(|| layer.clone(), Arc::new);
    }
    let map = around.within(layer);
    // Live content cannot express a displacement.
    if layer.is_warped() && !matches!(layer.content, Content::Pixels(_) | Content::Fill(_)) {
        return layer.clone();
    }
    let seen = apply_map(layer, &map);
    let content = match &seen.content {
        Content::Image(live) => {
            live.params().unframed().map(|image| Content::Image(Live::new(image)))
        }
        Content::Gradient(live) => {
            live.params().unframed().map(|ramp| Content::Gradient(Live::new(ramp)))
        }
        Content::Normals(normals) => {
            apply_to_placement(&normals.placement, &normals.frame).map(|placement| {
                Content::Normals(NormalLayer {
                    placement,
                    frame: PlaneMap::IDENTITY,
                    ..normals.clone()
                })
            })
        }
        content => Some(content.clone()),
    };
    let transform = transform_of(&around.map_outside(layer.on.as_ref()).inverse(), &map);
    let (Some(content), Some(transform)) = (content, transform) else { return layer.clone() };
    let mut next =
        Layer { content, transform, liquify: None, mask: seen.mask.clone(), ..Layer::clone(layer) };
    let now = around.within(&next);
    match &layer.content {
        // What lies beyond the canvas comes back with its part.
        Content::Pixels(pixels) if layer.on.is_some() && !layer.is_warped() => {
            next.content = Content::Pixels(pixels.transformed(&map))
        }
        Content::Strokes(own) if layer.content.has_attachments() => {
            match strokes_on_canvas(own.params(), &seen.content, &now) {
                Some(list) => next.content = Content::Strokes(Live::new(list)),
                None => return layer.clone(),
            }
        }
        _ => {}
    }
    Arc::new(next)
}

/// Strokes as they lie on the canvas, those with attachments of their own still carried by them;
/// `None` where that cannot be expressed.
///
/// * `now`: the map of their layer.
fn strokes_on_canvas(own: &StrokeList, seen: &Content, now: &LayerMap) -> Option<StrokeList> {
    let Content::Strokes(seen) = seen else { return None };
    let both = own.strokes.iter().zip(&seen.params().strokes);
    let strokes = both.map(|(own, seen)| {
        let Some(attachment) = own.attachment() else { return Some(seen.clone()) };
        let mut next = StrokeAttachment::new(attachment.frame.clone());
        next.own = now.of_stroke(&next).plane.inverse().coefficients()?;
        let is_same = Arc::ptr_eq(own, seen) && now.of_stroke(attachment).is_none();
        Some(if is_same {
            own.clone()
        } else {
            Arc::new(seen.with_moved_attachment(Arc::new(next)))
        })
    });
    Some(StrokeList { strokes: strokes.collect::<Option<_>>()? })
}

impl PlacedImage {
    /// The same image placed on the canvas itself; `None` where its frame is mirrored, skewed or in
    /// perspective.
    fn unframed(&self) -> Option<PlacedImage> {
        let placement = apply_to_placement(&self.placement, &self.frame)?;
        Some(PlacedImage { placement, frame: PlaneMap::IDENTITY, ..self.clone() })
    }
}

impl crate::paint::Gradient {
    /// The same ramp with its ends on the canvas; `None` where its frame is skewed or in
    /// perspective.
    fn unframed(&self) -> Option<Self> {
        similarity(&self.frame, true)?;
        let (from, to) = (self.frame.to_canvas(self.from)?, self.frame.to_canvas(self.to)?);
        Some(Self { from, to, frame: PlaneMap::IDENTITY, ..self.clone() })
    }
}

/// A placement on the canvas that a frame lies on; `None` for a frame that is mirrored, skewed or
/// in perspective.
pub(in crate::document) fn apply_to_placement(
    placement: &Placement,
    frame: &PlaneMap,
) -> Option<Placement> {
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
