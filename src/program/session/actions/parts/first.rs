//! The first shape of a drawing: a part from its outline, or one from each of its flat colors or
//! places, a layer of light, so that the form is seen at once, and its ink on top of that. Floor 6. Not
//! here: what a drawing is (`document::parts::drawing`).

use super::{PartRefusal, free_id, new};
use crate::document::parts::Part;
use crate::document::parts::drawing::{DrawingTraits, FigureBackground, without_background};
use crate::document::parts::from_flats::{FlatParts, PartFor, parts_of_flats};
use crate::document::parts::pixel_art::pixel_art_colors;
use crate::document::{
    Content, Document, Inflation, Layer, LayerId, LayerSlot, Live, PixelLayer, Progress,
};
use crate::math::srgb::Color;
use crate::raster::TileGrid;
use crate::session::OpenDocument;
use crate::session::drawing::render_layer_with_progress;
use crate::shading::{Model, PixelShading, Shading};
use std::sync::Arc;

/// A document whose drawing has a shape.
pub struct FirstShape {
    /// The document with its shape.
    pub document: Document,
    /// The nearest of the new parts.
    pub part: String,
    /// The layer that shows the form.
    pub light: LayerId,
    /// What the user is told about colors without a part.
    pub note: Option<String>,
}

impl FirstShape {
    /// Into an open document, as one step.
    pub fn put(self, open: &mut OpenDocument) {
        if open.commit("Give it a shape", self.document) {
            (open.part, open.active_layer) = (Some(self.part), Some(self.light));
            open.noted = self.note.or(open.noted.take());
        }
    }
}

/// A layer of a document gets a shape. If canceled, nobody uses the result.
pub fn shape_layer(
    document: &Document,
    layer: LayerId,
    inflation: Inflation,
    each: PartFor,
    progress: &Progress,
) -> Result<FirstShape, PartRefusal> {
    let tiles = render_layer_with_progress(document, layer, progress)
        .ok_or("This layer has no paint of its own, so it has no outline.")?;
    let traits = DrawingTraits::of(&tiles, document.size);
    let (document, tiles) = match traits.background {
        FigureBackground::Transparent => (document.clone(), tiles),
        FigureBackground::Flat(color) => without_flat_background(document, layer, &tiles, color)
            .ok_or("There is no such layer.")?,
        FigureBackground::Painted => {
            return Err(
                "This layer is opaque all over and its background has many colors, so it has no outline. Select \
                        the figure, and inflate the selection.",
            );
        }
        FigureBackground::Bare(_) => {
            return Err(
                "This layer has one color all over, and no figure large enough on it to have an outline.",
            );
        }
        FigureBackground::Empty => return Err("This layer is empty, so it has no outline."),
    };
    let document = with_unique_name(&document, layer).ok_or("There is no such layer.")?;
    let name = document.layer(layer).map(|layer| layer.name.clone()).unwrap_or_default();
    let made = match each {
        PartFor::Color | PartFor::Area => parts_of_flats(&tiles, &name, inflation, each),
        PartFor::Layer => {
            let part = Part {
                name: new::free_name(&document, &name),
                ..Part::of_layer("", &name, inflation)
            };
            FlatParts::of_one(part)
        }
    };
    let note = made.note();
    let mut list = document.parts.list.clone();
    for part in made.parts {
        let id = free_id(&document, &list);
        let name = new::free_name(&document, &part.name);
        list.push(Arc::new(Part { id, name, ..part }));
    }
    let part = list
        .last()
        .map(|part| part.id.clone())
        .ok_or("No flat color of it covers enough to be a part.")?;
    // Its edge is the surface's: clipping as well would make it thinner.
    let next =
        document.with_layer(layer, |layer| layer.clip_to_surface = false).unwrap_or(document);
    let light = light_layer(&next, Some(&tiles));
    let id = light.id;
    let place = next
        .place_of(layer)
        .map_or(LayerSlot::top_level(usize::MAX), |at| LayerSlot { index: at.index + 1, ..at });
    let next = next.with_inserted(light, place).ok_or("There is no such layer.")?;
    let lined = || as_paint(&next, layer, &tiles)?.with_lines_on_top(layer);
    let lined = if traits.has_flats() { lined() } else { None };
    let next = lined.map_or(next, |(lined, _)| lined);
    let next = next.with_parts_with_progress(list, progress).ok_or("It was canceled.")?;
    // A drawing that is one part moves with the part; of several parts, each would take a piece of
    // it.
    let next = match each {
        PartFor::Layer => next.with_layer_on(layer, Some(&part)).unwrap_or(next),
        PartFor::Color | PartFor::Area => next,
    };
    match next.surface {
        Some(_) => Ok(FirstShape { document: next, part, light: id, note }),
        None => Err("Nothing in this layer is opaque enough to have a shape."),
    }
}

/// With a name that no other layer has, by which parts follow it.
fn with_unique_name(document: &Document, layer: LayerId) -> Option<Document> {
    let name = &document.layer(layer)?.name;
    let is_alone = document.walk().iter().filter(|(_, other)| other.name == *name).count() == 1;
    let named = if is_alone && !name.is_empty() {
        name.clone()
    } else {
        document.free_layer_name("Drawing")
    };
    document.with_layer(layer, |layer| layer.name = named)
}

/// The drawing as paint without its background, and the background as a fill beneath, and the
/// drawing's pixels. The picture stays the same.
fn without_flat_background(
    document: &Document,
    layer: LayerId,
    tiles: &TileGrid,
    color: Color,
) -> Option<(Document, TileGrid)> {
    let bare = without_background(tiles, document.size, color);
    let next = with_paint(document, layer, &bare)?;
    let drawing = next.layer(layer)?;
    let background = Layer {
        clip_to_surface: false,
        visible: drawing.visible,
        opacity: drawing.opacity,
        ..Layer::new(document.free_layer_name("Ground"), Content::Fill(color))
    };
    let place = next.place_of(layer)?;
    Some((next.with_inserted(background, place)?, bare))
}

/// With the drawing as paint, of which ink can be lifted; the picture stays the same.
fn as_paint(document: &Document, layer: LayerId, tiles: &TileGrid) -> Option<Document> {
    match document.layer(layer)?.content {
        Content::Pixels(_) => Some(document.clone()),
        _ => with_paint(document, layer, tiles),
    }
}

/// With a layer as paint alone.
pub(super) fn with_paint(
    document: &Document,
    layer: LayerId,
    tiles: &TileGrid,
) -> Option<Document> {
    let paint =
        Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles: tiles.clone() });
    document.with_layer(layer, |layer| {
        // The mask and the transform are in the pixels now.
        (layer.content, layer.mask, layer.transform) = (paint, None, None);
        layer.liquify = None;
    })
}

/// The layer that shows the form: a painter's light on the drawing, in a few tones of its own colors
/// if it was drawn pixel by pixel.
pub(super) fn light_layer(document: &Document, drawing: Option<&TileGrid>) -> Layer {
    let mut shading = Shading::fitting(Model::Painter, document.size);
    shading.painter.beneath = true;
    if let Some(colors) = drawing.and_then(|drawing| pixel_art_colors(drawing, document.size)) {
        shading.pixel = PixelShading { bands: PixelShading::USUAL_BANDS, dither: 0.0, colors };
    }
    let content = Content::Shading(Live::new(shading));
    Layer::new(document.free_layer_name("Light"), content)
}
