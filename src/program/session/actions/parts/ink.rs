//! The lines of a drawing stand on top: those between its flat colors, or those of a scan, whose
//! paper becomes transparent. Floor 6. Not here: what is ink (`shape::flats`), what is paper
//! (`raster::paper`).

use super::PartRefusal;
use super::first::with_paint;
use crate::document::{Document, Layer, LayerId, LayerSlot, Progress};
use crate::raster::paper;
use crate::session::LayerPath;
use crate::session::drawing::render_layer_with_progress;

fn layer_of(document: &Document, layer: &LayerPath) -> Result<LayerId, PartRefusal> {
    layer.find(document).map(|layer| layer.id).ok_or("There is no such layer.")
}

/// A drawing with a layer of its ink, and that layer.
pub fn on_top(document: &Document, layer: &LayerPath) -> Result<(Document, LayerId), PartRefusal> {
    let id = layer_of(document, layer)?;
    document.with_lines_on_top(id).ok_or(
        "No ink was found in this layer: there are no lines between its colors. For a scan, choose \
         Layer, Make paper transparent; a placed picture needs Layer, Turn layer into pixels first.",
    )
}

/// A scan whose paper is transparent, as paint on top of the layers that it was among.
pub fn without_paper(
    document: &Document,
    layer: &LayerPath,
) -> Result<(Document, LayerId), PartRefusal> {
    let id = layer_of(document, layer)?;
    let tiles = render_layer_with_progress(document, id, &Progress::default())
        .ok_or("This layer paints nothing of its own.")?;
    let drawn = paper::without_paper(&tiles)
        .ok_or("No paper was found in this layer: it is empty, or dark all over.")?;
    let lined = || {
        let next = with_paint(document, id, &drawn)?;
        let place = LayerSlot { index: usize::MAX, ..next.place_of(id)? };
        let lines = Layer { clip_to_surface: false, ..Layer::clone(next.layer(id)?) };
        next.without_layer(id)?.with_inserted(lines, place)
    };
    Ok((lined().ok_or("There is no such layer.")?, id))
}
