//! Edits of attachments: what lies on which part of the shape. Whatever else changes, it shows
//! where it showed. Floor 4. Not here: how attachments and transforms are combined (`LayerMap`).

use super::layer::content::strokes::{SeenSelections, move_stroke};
use super::{
    Content, Document, Group, Layer, LayerId, LayerMap, LayerTransform, Live, Parts, StrokeList,
    TransformShape,
};
use crate::math::{Affine2, PlaneMap};
use crate::paint::{Attachment, Stroke, StrokeAttachment};
use std::sync::Arc;

/// Which attachment replaces another; `None`: that of the group around, or the canvas.
type ReplaceAttachment<'a> = dyn Fn(&Attachment) -> Option<Attachment> + 'a;

impl Parts {
    /// Where the frame of a part is: canvas from part. What lies on another part has its frame.
    /// `None` if there is no such part.
    pub fn frame_of(&self, id: &str) -> Option<Affine2> {
        self.body_of(id).map(|part| part.matrix)
    }

    /// The attachment that a part is; `None` if there is no such part.
    pub fn attachment(&self, id: &str) -> Option<Attachment> {
        if id == Attachment::CANVAS {
            return Some(Attachment::canvas());
        }
        Some(Attachment { matrix: self.frame_of(id)?, ..Attachment::on(id) })
    }
}

impl Document {
    /// The part that carries a layer: its own attachment or that of the nearest group around it.
    /// `None` for the canvas.
    pub fn attachment_of(&self, id: LayerId) -> Option<&Attachment> {
        fn find<'d>(
            layers: &'d [Arc<Layer>],
            id: LayerId,
            around: Option<&'d Attachment>,
        ) -> Option<&'d Attachment> {
            layers.iter().find_map(|layer| {
                let attachment = layer.on.as_ref().or(around);
                if layer.id == id {
                    attachment
                } else {
                    find(&layer.content.group()?.layers, id, attachment)
                }
            })
        }
        find(&self.layers, id, None).filter(|attachment| !attachment.is_canvas())
    }

    /// With a layer on a part of the shape, by its id, or on what is around the layer. It shows
    /// where it showed, and is carried from there. `None` if there is no such layer or part, or the
    /// layer's place there cannot be expressed.
    pub fn with_layer_on(&self, id: LayerId, part: Option<&str>) -> Option<Document> {
        let on = match part {
            Some(part) => Some(self.parts.attachment(part)?),
            None => None,
        };
        let around = self.map_around(id)?;
        let layer = preserve_look_on(self.layer(id)?, on, (&around, &around), &|attachment| {
            Some(attachment.clone())
        })?;
        self.with_layer(id, |old| *old = Layer::clone(&layer))
    }

    /// With some strokes of a layer on a part, or on what their layer lies on; as
    /// [`Document::with_layer_on`].
    pub fn with_strokes_on(
        &self,
        layer: LayerId,
        selected: &[usize],
        part: Option<&str>,
    ) -> Option<Document> {
        let attachment = match part {
            Some(part) => Some(self.parts.attachment(part)?),
            None => None,
        };
        let map = self.map_of(layer)?;
        let mut selections = SeenSelections::new();
        self.with_strokes(layer, |strokes| {
            for &index in selected {
                let stroke = strokes.get_mut(index)?;
                *stroke = stroke_on(stroke, attachment.clone(), (&map, &map), &mut selections)?;
            }
            Some(())
        })
    }

    /// With everything on the parts that it is on in another document, showing where it shows. What
    /// cannot be expressed stays on what is around it.
    pub(in crate::document) fn with_attachments_of(&self, other: &Document) -> Document {
        let mut next = self.clone();
        for (_, layer) in other.walk() {
            if let Some(attachment) = &layer.on {
                next = next.with_layer_on(layer.id, Some(&attachment.part)).unwrap_or(next);
            }
            if !layer.content.has_attachments() {
                continue;
            }
            for (i, stroke) in other.strokes(layer.id).iter().enumerate() {
                if let Some(attachment) = stroke.attachment() {
                    next = next
                        .with_strokes_on(layer.id, &[i], Some(&attachment.frame.part))
                        .unwrap_or(next);
                }
            }
        }
        next
    }

    /// The map of what is around a layer.
    pub(in crate::document) fn map_around(&self, id: LayerId) -> Option<LayerMap> {
        let none = LayerMap::none(self.size);
        match self.place_of(id)?.group {
            Some(group) => self.map_of(group),
            None => Some(none),
        }
    }

    /// With every attachment where its part is now; itself if nothing moved.
    pub(in crate::document) fn with_attachments_placed(&self) -> Document {
        match place_attachments(&self.layers, &self.parts) {
            Some(layers) => Document { layers, ..self.clone() },
            None => self.clone(),
        }
    }

    /// With nothing on some parts: what was on them stays where it shows, carried by what is around
    /// it.
    pub(in crate::document) fn detach(&self, is_gone: impl Fn(&str) -> bool) -> Document {
        let none = LayerMap::none(self.size);
        let replace = |attachment: &Attachment| {
            (attachment.is_canvas() || !is_gone(&attachment.part)).then(|| attachment.clone())
        };
        let lifted = |layer: &Arc<Layer>| {
            preserve_look(layer, (&none, &none), &replace).unwrap_or_else(|| bare(layer, &replace))
        };
        Document { layers: self.layers.iter().map(lifted).collect(), ..self.clone() }
    }

    /// A layer of another document: attachments that do not exist here are removed.
    pub(in crate::document) fn adopt(&self, layer: Layer) -> Layer {
        let alone =
            Document { layers: vec![Arc::new(layer.clone())], ..Document::empty(self.size) };
        let known = |id: &str| self.parts.part(id).is_some();
        let all_known =
            alone.are_all_attachments(&mut |attachment| attachment.part().is_none_or(known));
        if all_known {
            return layer;
        }
        let lifted = alone.detach(|id| !known(id));
        lifted.layers.first().map_or(layer, |layer| Layer::clone(layer))
    }

    /// Whether a condition holds for every attachment, of layers and of strokes.
    pub(in crate::document) fn are_all_attachments(
        &self,
        agrees: &mut dyn FnMut(&Attachment) -> bool,
    ) -> bool {
        self.walk().into_iter().all(|(_, layer)| {
            layer.on.as_ref().is_none_or(&mut *agrees)
                && match &layer.content {
                    Content::Strokes(live) if layer.content.has_attachments() => {
                        let attachments =
                            live.params().strokes.iter().filter_map(|stroke| stroke.attachment());
                        attachments.map(|attachment| &attachment.frame).all(&mut *agrees)
                    }
                    _ => true,
                }
        })
    }
}

/// A layer and all in it without the attachments that go, wherever it moves: for one whose place
/// cannot be expressed.
fn bare(layer: &Arc<Layer>, replace: &ReplaceAttachment) -> Arc<Layer> {
    let mut next = Layer { on: layer.on.as_ref().and_then(replace), ..Layer::clone(layer) };
    match &mut next.content {
        Content::Group(group) => {
            group.layers = group.layers.iter().map(|layer| bare(layer, replace)).collect()
        }
        Content::Strokes(live) if layer.content.has_attachments() => {
            let attachment = |stroke: &Arc<Stroke>| {
                let goes = stroke
                    .attachment()
                    .is_some_and(|attachment| replace(&attachment.frame).is_none());
                if goes { Arc::new(Stroke::clone(stroke).on(None)) } else { stroke.clone() }
            };
            *live = Live::new(StrokeList {
                strokes: live.params().strokes.iter().map(attachment).collect(),
            });
        }
        _ => {}
    }
    Arc::new(next)
}

/// Layers with their attachments where the parts are; `None` if all are there already.
fn place_attachments(layers: &[Arc<Layer>], parts: &Parts) -> Option<Vec<Arc<Layer>>> {
    let next = |attachment: &Attachment| {
        parts.attachment(&attachment.part).filter(|next| next != attachment)
    };
    let stroke = |stroke: &Arc<Stroke>| {
        let attachment = stroke.attachment()?;
        let frame = next(&attachment.frame)?;
        Some(Arc::new(stroke.with_moved_attachment(Arc::new(StrokeAttachment {
            frame,
            ..StrokeAttachment::clone(attachment)
        }))))
    };
    let mut out: Option<Vec<Arc<Layer>>> = None;
    for (i, layer) in layers.iter().enumerate() {
        let on = layer.on.as_ref().and_then(next);
        let content = match &layer.content {
            Content::Group(group) => place_attachments(&group.layers, parts)
                .map(|layers| Content::Group(Group { layers, ..group.clone() })),
            Content::Strokes(live) if layer.content.has_attachments() => {
                let strokes = &live.params().strokes;
                let moved: Vec<Option<Arc<Stroke>>> = strokes.iter().map(stroke).collect();
                moved.iter().any(Option::is_some).then(|| {
                    let strokes = moved
                        .into_iter()
                        .zip(strokes)
                        .map(|(new, old)| new.unwrap_or_else(|| old.clone()));
                    Content::Strokes(Live::new(StrokeList { strokes: strokes.collect() }))
                })
            }
            _ => None,
        };
        if on.is_none() && content.is_none() {
            continue;
        }
        let next = Layer {
            on: on.or_else(|| layer.on.clone()),
            content: content.unwrap_or_else(|| layer.content.clone()),
            ..Layer::clone(layer)
        };
        out.get_or_insert_with(|| layers.to_vec())[i] = Arc::new(next);
    }
    out
}

/// A layer that shows what it showed though what is around it was `old` and is `new`; the same
/// value if nothing in it has to change. `None` where that cannot be expressed.
pub(in crate::document) fn preserve_look(
    layer: &Arc<Layer>,
    (old, new): (&LayerMap, &LayerMap),
    replace: &ReplaceAttachment,
) -> Option<Arc<Layer>> {
    preserve_look_on(layer, layer.on.as_ref().and_then(replace), (old, new), replace)
}

/// The same on another attachment.
fn preserve_look_on(
    layer: &Arc<Layer>,
    on: Option<Attachment>,
    (old, new): (&LayerMap, &LayerMap),
    replace: &ReplaceAttachment,
) -> Option<Arc<Layer>> {
    let (was, outside) = (old.within(layer), new.map_outside(on.as_ref()));
    let (stood, mut next) =
        (old.map_outside(layer.on.as_ref()), Layer { on, ..Layer::clone(layer) });
    if stood != outside {
        // From the list that it was in to the one that it is in.
        let outer = stood.then(&outside.inverse());
        next.liquify = layer.transformed_liquify(&outer, old.canvas);
        next.transform = match layer.transform.as_ref().and_then(|own| own.mesh()) {
            Some(mesh) => {
                let shape = TransformShape::Mesh(Arc::new(mesh.then(&outer)?));
                Some(LayerTransform { shape, filter: was.filter })
            }
            None => transform_of(&was.plane.then(&outside.inverse()), &was)?,
        };
    }
    let now = new.within(&next);
    let content = match &layer.content {
        Content::Group(group) => {
            let layers: Option<Vec<_>> = group
                .layers
                .iter()
                .map(|layer| preserve_look(layer, (&was, &now), replace))
                .collect();
            let layers = layers?;
            let is_same = layers.iter().zip(&group.layers).all(|(a, b)| Arc::ptr_eq(a, b));
            (!is_same).then(|| Content::Group(Group { layers, ..group.clone() }))
        }
        Content::Strokes(live) if layer.content.has_attachments() => {
            let mut selections = SeenSelections::new();
            let strokes = live.params().strokes.iter().map(|stroke| match stroke.attachment() {
                Some(attachment) => {
                    stroke_on(stroke, replace(&attachment.frame), (&was, &now), &mut selections)
                }
                None => Some(stroke.clone()),
            });
            let strokes: Vec<Arc<Stroke>> = strokes.collect::<Option<_>>()?;
            let is_same =
                strokes.iter().zip(&live.params().strokes).all(|(a, b)| Arc::ptr_eq(a, b));
            (!is_same).then(|| Content::Strokes(Live::new(StrokeList { strokes })))
        }
        _ => None,
    };
    let is_same =
        next.transform == layer.transform && next.liquify == layer.liquify && next.on == layer.on;
    if content.is_none() && is_same {
        return Some(layer.clone());
    }
    Some(Arc::new(Layer { content: content.unwrap_or_else(|| layer.content.clone()), ..next }))
}

/// A stroke on another attachment, or on its layer's, of a layer whose map was `was` and is `now`.
fn stroke_on(
    stroke: &Arc<Stroke>,
    frame: Option<Attachment>,
    (was, now): (&LayerMap, &LayerMap),
    selections: &mut SeenSelections,
) -> Option<Arc<Stroke>> {
    let plane = stroke.attachment().map_or(was.plane, |attachment| was.of_stroke(attachment).plane);
    let Some(frame) = frame else {
        let map = now.with_plane(plane.then(&now.plane.inverse()));
        return Some(Arc::new(Stroke::clone(&move_stroke(stroke, &map, selections)).on(None)));
    };
    let mut attachment = StrokeAttachment::new(frame);
    let own = plane.then(&now.of_stroke(&attachment).plane.inverse());
    if !own.is_identity_on(now.canvas) {
        attachment.own = own.coefficients()?;
    }
    match stroke.attachment() {
        Some(known) if **known == attachment => Some(stroke.clone()),
        _ => Some(Arc::new(stroke.with_moved_attachment(Arc::new(attachment)))),
    }
}

/// A map as a layer's transform that files can hold, none if it moves nothing; outer `None` if
/// there is no such transform.
pub(in crate::document) fn transform_of(
    map: &PlaneMap,
    of: &LayerMap,
) -> Option<Option<LayerTransform>> {
    if map.is_identity_on(of.canvas) {
        return Some(None);
    }
    let transform = LayerTransform::of_map(map, of.filter, of.canvas)?;
    transform.fits().ok().map(|()| Some(transform))
}

#[cfg(test)]
mod tests;
