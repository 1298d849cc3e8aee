//! A drawing cut by its parts: each part carries its piece, so that a part that is moved takes its paint along.
//! Floor 4.

use super::areas::spread;
use super::outlines::{OutlineKey, pixels};
use super::picture::{MOSTLY, Pixel};
use super::{OutlineSource, Part};
use crate::document::{Content, Document, Group, Layer, LayerId, LayerSlot, PixelLayer};
use crate::math::{Rect, Size};
use crate::raster::{Plane, Tile, TileAt, TileGrid};
use crate::shape::Outline;
use std::sync::Arc;

/// A channel of the piece in front may be off by this much from what it must add to the one behind, of 255.
const ROUNDING: i32 = 1;
/// No part.
const NONE: u16 = u16::MAX;

impl Document {
    /// With the drawing in a layer cut into a paint layer for each part that has its outline from it, in one group
    /// above it; the drawing is hidden, and the outlines still follow it. Before parts are moved, the picture is the
    /// same within 1 of 255. Returns the group as well. `Err`: why it cannot be cut.
    pub fn cut_by_parts(&self, layer: LayerId) -> Result<(Document, LayerId), &'static str> {
        let drawing = self.layer(layer).ok_or("There is no such layer.")?;
        if self.home_of(layer).is_some() {
            return Err("This layer lies on a part already, and goes with it.");
        }
        if drawing.mask.is_some() && drawing.transform.is_some() {
            return Err("This layer has a mask and a transform: apply one of them first.");
        }
        let is_of_it = |part: &&Arc<Part>| {
            let name =
                |source: &OutlineSource| matches!(source, OutlineSource::Layer { layer, .. } if *layer == drawing.name);
            part.on().is_none() && part.outline().is_some_and(name)
        };
        let outlines: Vec<(&Arc<Part>, Outline)> = self
            .parts
            .list
            .iter()
            .filter(is_of_it)
            .filter_map(|part| {
                let source = OutlineKey::of_part(self, part)??;
                Some((part, source.outline(self, usize::MAX)?))
            })
            .collect();
        self.parts.forget_flats();
        let drawn = self.map_of(layer).and_then(|map| pixels(self, drawing, &map));
        let drawn = drawn.filter(|tiles| !tiles.bounds().is_empty());
        let (Some(drawn), false) = (drawn, outlines.is_empty()) else {
            return Err("No part has its outline from this layer.");
        };
        let cut = Cut::of(&drawn, outlines.iter().map(|(_, outline)| outline).collect());
        let (pieces, rest) = cut.pieces();
        let paint = |name: String, tiles: TileGrid| {
            let content = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
            Layer { clip_to_surface: false, ..Layer::new(name, content) }
        };
        let mut inner: Vec<Arc<Layer>> = Vec::new();
        if !rest.bounds().is_empty() {
            inner.push(Arc::new(paint("Rest".into(), rest)));
        }
        for ((part, _), tiles) in outlines.iter().zip(pieces) {
            inner.push(Arc::new(Layer { on: self.parts.home(&part.id), ..paint(part.name.clone(), tiles) }));
        }
        let group = Content::Group(Group { layers: inner, pass_through: false });
        let name = self.free_layer_name(&format!("{} by parts", drawing.name));
        let Layer { opacity, blend, blend_linear, clip_below, mask, label, visible, .. } = drawing.as_ref().clone();
        let look = Layer { clip_to_surface: false, ..Layer::new(name, group) };
        let group = Layer { opacity, blend, blend_linear, clip_below, mask, label, visible, ..look };
        let id = group.id;
        let place = self.place_of(layer).ok_or("There is no such layer.")?;
        let above = LayerSlot { index: place.index + 1, ..place };
        let next =
            self.with_inserted(group, above).and_then(|next| next.with_layer(layer, |layer| layer.visible = false));
        Ok((next.ok_or("There is no such layer.")?.reshaped(), id))
    }
}

/// The pixels of a drawing, and the two nearest parts at each.
struct Cut<'a> {
    rect: Rect,
    drawn: Plane<Pixel>,
    outlines: Vec<&'a Outline>,
    /// The nearest part that covers some of a pixel, and the next beneath it; or [`NONE`].
    nearest: Plane<[u16; 2]>,
    /// The part that a pixel belongs to, one more; 0 where there is none.
    owner: Plane<u32>,
}

/// The colour of the nearest part so far.
#[derive(Clone, Copy, Default)]
struct ColorBeneath {
    color: Pixel,
    part: u16,
}

impl<'a> Cut<'a> {
    fn of(tiles: &TileGrid, outlines: Vec<&'a Outline>) -> Self {
        let rect = tiles.bounds();
        let size = Size::new(rect.width() as u32, rect.height() as u32);
        let drawn = Plane::from_fn(size, |x, y| tiles.pixel(rect.x0 + x as i32, rect.y0 + y as i32));
        let nearest = Plane::from_fn(size, |x, y| {
            let mut covering = (0..outlines.len()).rev().filter(|i| coverage(outlines[*i], rect, x, y) > 0);
            std::array::from_fn(|_| covering.next().map_or(NONE, |i| i as u16))
        });
        let mut owner = Plane::from_fn(size, |x, y| {
            let is_mostly = |of: &u16| *of != NONE && coverage(outlines[usize::from(*of)], rect, x, y) >= MOSTLY;
            let own = nearest.at(x, y).into_iter().find(is_mostly).filter(|_| drawn.at(x, y)[3] > 0);
            own.map_or(0, |of| u32::from(of) + 1)
        });
        spread(&mut owner, |x, y| drawn.at(x, y)[3] > 0);
        Self { rect, drawn, outlines, nearest, owner }
    }
    /// What each part carries, and what belongs to none.
    fn pieces(&self) -> (Vec<TileGrid>, TileGrid) {
        let size = self.drawn.size();
        let mut beneath = Plane::filled(size, ColorBeneath::default());
        let mut pieces = Vec::with_capacity(self.outlines.len());
        for part in 0..self.outlines.len() as u16 {
            let pure = self.pure_colors(part);
            let piece = Plane::from_fn(size, |x, y| self.pixel(part, (x, y), pure.at(x, y), beneath.at(x, y)));
            beneath = beneath.updated(|x, y, under| match pure.at(x, y) {
                [.., 0] => under,
                color => ColorBeneath { color, part },
            });
            pieces.push(tiles_of(&piece, self.rect));
        }
        let rest = Plane::from_fn(size, |x, y| if self.owner.at(x, y) == 0 { self.drawn.at(x, y) } else { [0; 4] });
        (pieces, tiles_of(&rest, self.rect))
    }
    /// A pixel of a part's piece; `pure`: the part's colour there.
    fn pixel(&self, part: u16, (x, y): (usize, usize), pure: Pixel, beneath: ColorBeneath) -> Pixel {
        const OUT: Pixel = [0; 4];
        let (drawn, own) = (self.drawn.at(x, y), self.owner.at(x, y) == u32::from(part) + 1);
        let [first, second] = self.nearest.at(x, y);
        // At the figure's own edge, and where no part is, there is nothing to share.
        if drawn[3] < 255 || first == NONE || second == NONE {
            return if own { drawn } else { OUT };
        }
        let covered = coverage(self.outlines[usize::from(first)], self.rect, x, y);
        let behind = if part == first { Some(beneath.color).filter(|_| beneath.part == second) } else { Some(pure) };
        let over = behind.filter(|behind| behind[3] == 255).and_then(|behind| added(drawn, covered, behind));
        match over {
            _ if part != first && part != second => pure,
            Some(over) if part == first => over,
            Some(_) => pure,
            None if own => drawn,
            None if part == first || self.owner.at(x, y) != u32::from(first) + 1 => OUT,
            None => pure,
        }
    }
    /// The colour of a part wherever it covers something: that of its nearest pixel that shows nothing else.
    fn pure_colors(&self, part: u16) -> Plane<Pixel> {
        let outline = self.outlines[usize::from(part)];
        let is_pure = |x: usize, y: usize| {
            self.drawn.at(x, y)[3] == 255
                && self.nearest.at(x, y)[0] == part
                && coverage(outline, self.rect, x, y) == 255
        };
        let width = self.drawn.width();
        let index = |x: usize, y: usize| (y * width + x) as u32 + 1;
        let mut nearest = Plane::from_fn(self.drawn.size(), |x, y| if is_pure(x, y) { index(x, y) } else { 0 });
        spread(&mut nearest, |x, y| coverage(outline, self.rect, x, y) > 0);
        nearest.map(|index| index.checked_sub(1).map_or([0; 4], |index| self.drawn.values()[index as usize]))
    }
}

/// Of a pixel of the drawing's plane.
fn coverage(outline: &Outline, rect: Rect, x: usize, y: usize) -> u8 {
    let (x0, y0) = outline.corner();
    outline.coverage().get(x as i32 + rect.x0 - x0, y as i32 + rect.y0 - y0).unwrap_or(0)
}

/// What has to lie with some alpha over an opaque colour, so that a given one is seen. `None` if nothing can.
fn added(seen: Pixel, alpha: u8, over: Pixel) -> Option<Pixel> {
    let left = |c: usize| (i32::from(over[c]) * (255 - i32::from(alpha)) + 127) / 255;
    let own = |c: usize| i32::from(seen[c]) - left(c);
    let alpha_range = -ROUNDING..=i32::from(alpha) + ROUNDING;
    (0..3).all(|c| alpha_range.contains(&own(c))).then(|| {
        let channel = |c: usize| if c == 3 { alpha } else { own(c).clamp(0, i32::from(alpha)) as u8 };
        std::array::from_fn(channel)
    })
}

/// Premultiplied pixels as tiles.
fn tiles_of(piece: &Plane<Pixel>, rect: Rect) -> TileGrid {
    let mut tiles = TileGrid::default();
    for at in TileAt::covering(rect) {
        let own = at.rect();
        let pixel = |x: i32, y: i32| piece.get(x - rect.x0, y - rect.y0).unwrap_or([0; 4]);
        let bytes = (own.y0..own.y1).flat_map(|y| (own.x0..own.x1).flat_map(move |x| pixel(x, y))).collect();
        tiles.set(at, Tile::from_pixels(bytes).map(Arc::new));
    }
    tiles
}

#[cfg(test)]
mod tests;
