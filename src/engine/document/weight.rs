//! How much memory flattening a document takes in addition to the document, estimated before it
//! begins. Floor 4. An upper bound. Not here: how much memory there is (floors above).

use super::{Content, DerivedMask, Document, Layer, LayerMask, StrokeList};
use crate::math::Rect;
use crate::paint::FormDrawing;
use crate::raster::Tile;
use crate::surface::Contours;
use crate::surface::hatching::{HatchTone, HatchWay};
use crate::surface::region::RegionKind;
use std::sync::Arc;

/// For a tile, bytes a pixel.
const TILE_BYTES: u64 = Tile::most_bytes_a_pixel(false);
/// For a tile of 16 bits, bytes a pixel.
const TILE16_BYTES: u64 = Tile::most_bytes_a_pixel(true);
/// For a tile that is filtered, bytes a pixel.
const FILTERED_BYTES: u64 = 8;
/// A tensor of curvature, and the map of κ made of it, bytes a pixel.
const CURVATURE_BYTES: u64 = 14;
/// Blurred normals and what lines are traced in, bytes a pixel.
const DRAWING_BYTES: u64 = 48;
/// Directions between drawn strokes, and what they are solved with, bytes a pixel.
const GUIDE_BYTES: u64 = 110;
/// A surface with other normals, bytes a pixel.
const SURFACE_BYTES: u64 = 18;

/// What finding a region takes, bytes a pixel: how much each differs, its steps, what is covered,
/// and their inputs.
fn region_bytes(kind: RegionKind) -> u64 {
    9 + match kind {
        RegionKind::Curvature => CURVATURE_BYTES,
        // Tensors, blurred in four channels.
        RegionKind::Flow => 56,
        RegionKind::Object => 8,
        RegionKind::Direction | RegionKind::Depth | RegionKind::Shine => 0,
    }
}

impl Document {
    /// Bytes that flattening takes at most: the picture, the tiles that live layers are rendered
    /// to, and what is prepared of the surface for shading, scaling and masks.
    pub fn flattening_bytes(&self) -> u64 {
        let area = self.size.area() as u64;
        let of_all = area * TILE_BYTES + of_layers(&self.layers, self.size.rect(), area);
        of_all + self.surface.as_ref().map_or(0, |surface| self.far_side_bytes(surface.contours()))
    }

    /// Bytes that [`flatten_to_paint`](super::flatten_to_paint) takes at most: as flattening, with
    /// the textures that images are read from, and a picture of 16 bits.
    pub fn painting_bytes(&self) -> u64 {
        self.flattening_bytes() + self.float_bytes() + self.size.area() as u64 * TILE16_BYTES
    }

    /// What the other sides of contour pixels take: their readings, and the pixels of live
    /// layers, in whole rows of a tile's width.
    fn far_side_bytes(&self, contours: &Contours) -> u64 {
        let is_live = |layer: &Layer| {
            layer.visible
                && !matches!(
                    layer.content,
                    Content::Fill(_) | Content::Pixels(_) | Content::Group(_)
                )
        };
        let live = self.walk().into_iter().filter(|(_, layer)| is_live(layer)).count() as u64;
        contours.bytes() + 2 * TILE_BYTES * contours.pixels().len() as u64 * live
    }
}

fn of_layers(layers: &[Arc<Layer>], canvas: Rect, area: u64) -> u64 {
    layers.iter().filter(|layer| layer.visible).map(|layer| of_layer(layer, canvas, area)).sum()
}

fn of_layer(layer: &Layer, canvas: Rect, area: u64) -> u64 {
    let mask = match layer.mask.as_ref().and_then(LayerMask::derived_mask) {
        Some(DerivedMask::Curvature { .. }) => area * CURVATURE_BYTES,
        Some(DerivedMask::Region(region)) => area * region_bytes(region.kind),
        _ => 0,
    };
    // What it is sampled from, and what it shows.
    let is_16_bit = match &layer.content {
        Content::Pixels(pixels) => pixels.tiles.is_16_bit_in(pixels.tiles.bounds()),
        _ => false,
    };
    let tile_bytes = if is_16_bit { TILE16_BYTES } else { TILE_BYTES };
    let warped = if layer.is_warped() { 2 * area * tile_bytes } else { 0 };
    mask + warped
        + match &layer.content {
            Content::Fill(_) | Content::Pixels(_) | Content::Ink(_) | Content::Adjustment(_) => 0,
            // What is composed beneath it and what it makes of that, in 16 bits.
            Content::Filter(_) => 2 * area * FILTERED_BYTES,
            Content::Image(_) | Content::Gradient(_) => area * TILE_BYTES,
            Content::FormDrawing(live) => {
                area * (TILE_BYTES + DRAWING_BYTES + guide_bytes(live.params()))
            }
            Content::Strokes(live) => of_strokes(live.params(), canvas).min(area) * TILE_BYTES,
            Content::Shading(live) => {
                area * (TILE_BYTES + CURVATURE_BYTES + live.params().kept_bytes())
            }
            Content::RadianceScaling(_) => area * CURVATURE_BYTES,
            Content::Normals(_) => area * SURFACE_BYTES,
            Content::Group(group) => of_layers(&group.layers, canvas, area),
        }
}

/// What hatching takes for the strokes that it follows, and for its tone, bytes a pixel.
fn guide_bytes(drawing: &FormDrawing) -> u64 {
    drawing.hatching().map_or(0, |hatch| {
        let guides = if hatch.way == HatchWay::Guides { GUIDE_BYTES } else { 0 };
        guides + u64::from(hatch.tone != HatchTone::Light)
    })
}

/// Pixels of the boxes around the strokes, unbent.
fn of_strokes(list: &StrokeList, canvas: Rect) -> u64 {
    let of_one = |stroke: &Arc<crate::paint::Stroke>| {
        let reach = stroke.brush().size.max(0.0).min(1e6).ceil() as i32;
        let boxed = stroke.samples().iter().fold(Rect::EMPTY, |all, sample| {
            let (x, y) = (sample.at.x.floor() as i32, sample.at.y.floor() as i32);
            all.union(Rect::new(x, y, x.saturating_add(1), y.saturating_add(1)))
        });
        let boxed = boxed.grown(reach).intersect(canvas);
        (boxed.width() * boxed.height()) as u64
    };
    list.strokes.iter().map(of_one).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Live;
    use crate::math::{Size, srgb::Color, vec2};
    use crate::paint::{Brush, Gradient, ImageFilter, Sample, Stroke};
    use crate::surface::Operator;

    #[test]
    fn live_layers_weigh_what_they_are_rendered_to() {
        let weight = |contents: Vec<Content>| {
            let layers =
                contents.into_iter().map(|content| Arc::new(Layer::new("a", content))).collect();
            Document { layers, ..Document::empty(Size::new(1000, 100)) }.flattening_bytes()
        };
        let (from, to) = (vec2(0.0, 0.0), vec2(9.0, 9.0));
        let of_no_stops = Gradient {
            from,
            to,
            stops: Vec::new(),
            operator: Operator::None,
            filter: ImageFilter::Antialias,
            frame: Default::default(),
            style: Default::default(),
            pieces: Vec::new(),
        };
        let gradient = || Content::Gradient(Live::new(of_no_stops.clone()));
        assert_eq!(weight(vec![Content::Fill(Color::BLACK)]), 400_000);
        assert_eq!(weight(vec![gradient(), gradient()]), 1_200_000);
        let samples = vec![Sample::at(vec2(50.0, 50.0))];
        let brush = Brush { size: 10.0, ..Brush::default() };
        let stroke = Arc::new(Stroke::new(brush, Operator::None, Color::BLACK, samples));
        let strokes =
            |n: usize| Content::Strokes(Live::new(StrokeList { strokes: vec![stroke.clone(); n] }));
        assert_eq!(weight(vec![strokes(1)]), 400_000 + 21 * 21 * 4);
        assert_eq!(weight(vec![strokes(1000)]), 800_000, "no more than the canvas");
    }
}
