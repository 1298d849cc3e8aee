//! A drawing cut by its parts: each part carries its piece, so that a part that is moved takes its
//! paint along. Floor 4.
//!
//! `owners` says whose each pixel is, `lines` who takes a line between two, and `pieces` what each
//! part carries.

mod lines;
mod owners;
mod pieces;

use super::{OutlineSource, Part};
use crate::document::{Content, Document, Group, Layer, LayerId, LayerSlot, PixelLayer};
use crate::raster::TileGrid;
use crate::shape::flats::shares::bytes;
use owners::{Cut, PieceOutline};
use std::sync::Arc;

const NO_LAYER: &str = "There is no such layer.";

impl Document {
    /// With a drawing cut into a paint layer for each part that has its outline from it, in one
    /// group above it; the drawing is hidden, and the outlines still follow it. While no part is
    /// moved, the picture is the same within 1 of 255; a part that was moved before takes its paint
    /// to where it is. The drawing's mask stays in place, on the group. Returns the group as well.
    /// `Err`: why it cannot be cut.
    pub fn cut_by_parts(&self, layer: LayerId) -> Result<(Document, LayerId), &'static str> {
        let drawing = self.layer(layer).ok_or(NO_LAYER)?;
        self.can_be_cut(drawing)?;
        let of_it: Vec<(&Arc<Part>, PieceOutline)> = self
            .parts
            .list
            .iter()
            .filter_map(|part| Some((part, self.piece_outline(part, &drawing.name)?)))
            .collect();
        self.parts.forget_drawn();
        let drawn = match &drawing.content {
            Content::Pixels(pixels) => self.map_of(layer).map(|map| pixels.transformed(&map).tiles),
            _ => None,
        };
        let drawn = drawn.filter(|tiles| !tiles.bounds().is_empty());
        let (Some(drawn), false) = (drawn, of_it.is_empty()) else {
            return Err("No part was made from this layer.");
        };
        let (parts, outlines): (Vec<&Arc<Part>>, Vec<PieceOutline>) = of_it.into_iter().unzip();
        let (pieces, rest) = Cut::of(&drawn, outlines).pieces();
        let paint = |name: String, tiles: TileGrid| {
            let content = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
            Layer { clip_to_surface: drawing.clip_to_surface, ..Layer::new(name, content) }
        };
        let mut inner: Vec<Arc<Layer>> = Vec::new();
        if !rest.bounds().is_empty() {
            inner.push(Arc::new(paint("Rest".into(), rest)));
        }
        for (part, tiles) in parts.into_iter().zip(pieces) {
            inner.push(Arc::new(Layer {
                on: self.parts.attachment(&part.id),
                ..paint(part.name.clone(), tiles)
            }));
        }
        let group = Content::Group(Group { layers: inner, pass_through: false });
        let name = self.free_layer_name(&format!("{} by parts", drawing.name));
        let Layer {
            opacity, blend, blend_linear, clip_below, clip_to_surface, mask, label, ..
        } = drawing.as_ref().clone();
        let look = Layer { opacity, blend, blend_linear, clip_below, ..Layer::new(name, group) };
        let group = Layer { clip_to_surface, mask, label, ..look };
        let id = group.id;
        let place = self.place_of(layer).ok_or(NO_LAYER)?;
        let above = LayerSlot { index: place.index + 1, ..place };
        let next = self
            .with_inserted(group, above)
            .and_then(|next| next.with_layer(layer, |layer| layer.visible = false))
            .ok_or(NO_LAYER)?;
        let lined = next.layer(id).map(|group| group.name.clone()).unwrap_or_default();
        Ok((next.with_ink_layers_of(&drawing.name, &lined).reshaped(), id))
    }

    /// The drawing that a part has a color of, if it can be cut by parts.
    pub fn drawing_to_cut(&self, part: &Part) -> Option<LayerId> {
        let OutlineSource::Layer { layer, color: Some(_) } =
            part.outline().filter(|_| part.on().is_none())?
        else {
            return None;
        };
        self.layer_named(layer)
            .filter(|drawing| self.can_be_cut(drawing).is_ok())
            .map(|drawing| drawing.id)
    }

    /// `Err`: why a layer cannot be cut, whatever its parts.
    fn can_be_cut(&self, drawing: &Layer) -> Result<(), &'static str> {
        let is_paint = matches!(drawing.content, Content::Pixels(_)) && !drawing.is_warped();
        let is_grouped = !self.layers.iter().any(|layer| layer.id == drawing.id);
        match () {
            _ if self.attachment_of(drawing.id).is_some() => {
                Err("This layer is already attached to a part and moves with it.")
            }
            _ if !is_paint => {
                Err("Only a paint layer can be cut. Turn this one into pixels first (Layer, Turn \
                     layer into pixels).")
            }
            _ if is_grouped => Err("This layer is in a group. Move it out first."),
            _ if drawing.mask.is_some() && drawing.transform.is_some() => {
                Err("This layer has a mask and a transform. Apply the transform first.")
            }
            _ if !drawing.visible => Err("This layer is hidden. Show it first."),
            _ => Ok(()),
        }
    }

    /// The outline that a part has from a layer, before the part was moved. `None` if it has none
    /// from there.
    fn piece_outline(&self, part: &Part, layer: &str) -> Option<PieceOutline> {
        let OutlineSource::Layer { layer: of, color } =
            part.outline().filter(|_| part.on().is_none())?
        else {
            return None;
        };
        if of != layer {
            return None;
        }
        let outline = self.own_outline(part)?;
        Some(PieceOutline { outline, color: color.map(|flat| bytes(flat.color)) })
    }
}

#[cfg(test)]
mod tests;
