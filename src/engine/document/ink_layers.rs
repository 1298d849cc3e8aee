//! Ink layers follow the drawings whose ink they show: it is lifted off wherever one names a
//! drawing, and stays on it where none does. Floor 4. Not here: what of a drawing is ink
//! (`shape::flats`).

use super::layer::content::{InkLayer, InkSource, ShownInk};
use super::layer::on_canvas::apply_map;
use super::{Content, Document, Layer, LayerId, LayerSlot, PixelLayer};
use crate::raster::{Mix, PlanarTile, Tile, TileAt, TileCoverage, TileGrid, TilePaint};
use crate::shape::flats::lifted_ink::LiftedInk;
use std::sync::Arc;

impl Document {
    /// How many layers lie beneath the ink on top of all: the place of new layers, so that lines stay
    /// on top.
    pub fn layers_below_top_ink(&self) -> usize {
        let is_ink = |layer: &Arc<Layer>| matches!(layer.content, Content::Ink(_));
        self.layers.iter().rposition(|layer| !is_ink(layer)).map_or(0, |last| last + 1)
    }

    /// Whether the ink of each drawing that an ink layer names, and of no other, is lifted off it,
    /// and each ink layer shows it as it is.
    pub(super) fn is_ink_lifted(&self) -> bool {
        let drawings = self.inked_drawings();
        let is_right = |layer: &Arc<Layer>| match (&layer.lifted, &layer.content) {
            (None, _) => !drawings.iter().any(|drawing| drawing.id == layer.id),
            (Some(ink), Content::Pixels(pixels)) => {
                ink.source.ptr_eq(&pixels.tiles)
                    && drawings.iter().any(|drawing| drawing.id == layer.id)
            }
            _ => false,
        };
        let shows = |lines: &InkLayer| match &lines.shown {
            Some(shown) => shown.sources == self.ink_sources(&lines.of),
            None => false,
        };
        self.walk().into_iter().all(|(_, layer)| match &layer.content {
            Content::Ink(lines) => shows(lines),
            _ => is_right(layer),
        })
    }

    /// The document with ink lifted off where it is to be ([`Document::is_ink_lifted`]).
    pub(super) fn with_ink_lifted(&self) -> Document {
        if self.is_ink_lifted() {
            return self.clone();
        }
        let drawings: Vec<LayerId> = self.inked_drawings().iter().map(|layer| layer.id).collect();
        let mut next = self.clone();
        for (_, layer) in self.walk() {
            let lifted = match &layer.content {
                Content::Pixels(pixels) if drawings.contains(&layer.id) => {
                    let known = layer.lifted.clone().filter(|ink| ink.source.ptr_eq(&pixels.tiles));
                    Some(known.unwrap_or_else(|| Arc::new(self.lift_ink(&pixels.tiles))))
                }
                _ => None,
            };
            if lifted.as_ref().map(Arc::as_ptr) != layer.lifted.as_ref().map(Arc::as_ptr) {
                next = next.with_layer(layer.id, |layer| layer.lifted = lifted).unwrap_or(next);
            }
        }
        for (_, layer) in self.walk() {
            let Content::Ink(lines) = &layer.content else { continue };
            let sources = next.ink_sources(&lines.of);
            if lines.shown.as_ref().is_some_and(|shown| shown.sources == sources) {
                continue;
            }
            let tiles = next.lines_of(&lines.of);
            let shown = Some(Arc::new(ShownInk { sources, tiles }));
            let content = Content::Ink(InkLayer { of: lines.of.clone(), shown });
            next = next.with_layer(layer.id, |layer| layer.content = content).unwrap_or(next);
        }
        next
    }

    /// The ink of paint, from what parts read of it or will read.
    fn lift_ink(&self, tiles: &TileGrid) -> LiftedInk {
        match self.parts.reading_of(tiles) {
            Some(reading) => LiftedInk::of_reading(tiles, &reading),
            None => LiftedInk::of(tiles),
        }
    }

    /// With ink layers naming their drawings by their present names; `before`: the document in
    /// which a layer had another name.
    pub(super) fn with_ink_layers_renamed(self, before: &Document, id: LayerId) -> Document {
        let names = before.layer(id).zip(self.layer(id)).map(|(old, new)| (&old.name, &new.name));
        let Some((old, new)) = names.filter(|(old, new)| old != new) else { return self };
        // If several layers have a name, ink layers name the topmost.
        if before.layer_named(old).is_none_or(|layer| layer.id != id) {
            return self;
        }
        self.with_ink_layers_of(old, new)
    }

    /// With the ink layers of one drawing as those of another, both by their names.
    pub(super) fn with_ink_layers_of(&self, old: &str, new: &str) -> Document {
        let of_it = self.walk().into_iter().filter_map(|(_, layer)| match &layer.content {
            Content::Ink(lines) if lines.of == old => Some((layer.id, lines.clone())),
            _ => None,
        });
        let of_it: Vec<(LayerId, InkLayer)> = of_it.collect();
        of_it.into_iter().fold(self.clone(), |next, (id, lines)| {
            let content = Content::Ink(InkLayer { of: new.to_owned(), ..lines });
            next.with_layer(id, |layer| layer.content = content).unwrap_or(next)
        })
    }

    /// With an ink layer of a paint layer on top of the list that the layer is in, and its id.
    /// `None` if there is no such layer, or it has no ink.
    pub fn with_lines_on_top(&self, layer: LayerId) -> Option<(Document, LayerId)> {
        let (drawing, place) = (self.layer(layer)?, self.place_of(layer)?);
        let content = Content::Ink(InkLayer::of(drawing.name.clone()));
        let name = self.free_layer_name("Ink");
        let lines = Layer { clip_to_surface: false, ..Layer::new(name, content) };
        let id = lines.id;
        let top = LayerSlot { index: usize::MAX, ..place };
        let next = self.with_inserted(lines, top)?.with_ink_lifted();
        let has_ink = matches!(&next.layer(id)?.content, Content::Ink(lines) if lines.has_any());
        has_ink.then_some((next, id))
    }

    /// The drawing that an ink layer names, as its paint layers that are shown, bottom first.
    fn drawing_of_lines(&self, name: &str) -> Vec<&Arc<Layer>> {
        fn add<'d>(layer: &'d Arc<Layer>, all: &mut Vec<&'d Arc<Layer>>) {
            match &layer.content {
                Content::Pixels(_) => all.push(layer),
                Content::Group(group) => {
                    let shown = group.layers.iter().filter(|layer| layer.visible);
                    shown.for_each(|layer| add(layer, all));
                }
                _ => {}
            }
        }
        let mut all = Vec::new();
        if let Some(layer) = self.layer_named(name) {
            add(layer, &mut all);
        }
        all
    }

    /// The paint layers whose ink is shown by ink layers.
    fn inked_drawings(&self) -> Vec<&Arc<Layer>> {
        let names = self.walk().into_iter().filter_map(|(_, layer)| match &layer.content {
            Content::Ink(lines) => Some(lines.of.as_str()),
            _ => None,
        });
        names.flat_map(|name| self.drawing_of_lines(name)).collect()
    }

    fn ink_sources(&self, name: &str) -> Vec<InkSource> {
        let source = |layer: &&Arc<Layer>| {
            let (ink, map) = (layer.lifted.clone()?, self.map_of(layer.id)?);
            let (transform, liquify) = (layer.transform.clone(), layer.liquify.clone());
            Some(InkSource { ink, map, transform, liquify })
        };
        self.drawing_of_lines(name).iter().filter_map(source).collect()
    }

    /// The lines of a drawing on the canvas: those of what lies beneath are hidden by what lies
    /// above, ink or not.
    fn lines_of(&self, name: &str) -> TileGrid {
        let mut all = TileGrid::default();
        for (i, layer) in self.drawing_of_lines(name).into_iter().enumerate() {
            let (Some(ink), Some(map)) = (&layer.lifted, self.map_of(layer.id)) else { continue };
            let on_canvas = |tiles: &TileGrid| {
                let content =
                    Content::Pixels(PixelLayer { tiles: tiles.clone(), ..PixelLayer::default() });
                let cache = Default::default();
                let alone = Layer { content, cache, lifted: None, ..Layer::clone(layer) };
                match &apply_map(&Arc::new(alone), &map).content {
                    Content::Pixels(pixels) => pixels.tiles.clone(),
                    _ => TileGrid::default(),
                }
            };
            let lines = on_canvas(&ink.lines);
            if i == 0 {
                all = lines;
                continue;
            }
            let whole = on_canvas(&ink.source);
            let both: Vec<TileAt> = whole.iter().map(|(at, _)| at).collect();
            for at in both {
                let over = hide_beneath(all.tile(at), whole.tile(at), lines.tile(at));
                all.set(at, over);
            }
        }
        all
    }
}

/// Lines where something lies over them: what is left of them, with the lines of that.
fn hide_beneath(
    lines: Option<&Arc<Tile>>,
    over: Option<&Arc<Tile>>,
    its_lines: Option<&Arc<Tile>>,
) -> Option<Arc<Tile>> {
    let Some((lines, over)) = lines.zip(over) else { return its_lines.cloned() };
    let pixels = lines.bytes().chunks_exact(4).zip(over.bytes().chunks_exact(4));
    let open = pixels.flat_map(|(line, over)| {
        let open = 255 - u32::from(over[3]);
        (0..4).map(move |c| ((u32::from(line[c]) * open + 127) / 255) as u8)
    });
    let mut left = Tile::from_pixels(open.collect());
    if let Some(own) = its_lines {
        let mut both = PlanarTile::transparent();
        for tile in [left.as_ref(), Some(&**own)].into_iter().flatten() {
            both.blend(Mix::default(), TilePaint::of(tile), &TileCoverage::FULL);
        }
        left = both.quantize();
    }
    left.map(Arc::new)
}

#[cfg(test)]
mod tests;
