//! Preview of a retouching brush: bands of color over the surface, and one stroke across them.
//! Floor 6.

use super::{clay, scaled, wave};
use crate::document::{Content, Document, Layer, Live, PixelLayer};
use crate::io::recipe::BrushPreset;
use crate::math::{Size, Vec2, srgb::Color, vec2};
use crate::raster::TileGrid;
use crate::surface::Surface;
use crate::tools::{ModifierKeys, Outcome, PenSample, ToolContext, ToolSettings, brush};
use std::sync::Arc;

/// Bands across the side of the picture.
const BANDS: f32 = 5.0;
/// The colors of the bands, one after the other.
const COLORS: [[u8; 4]; 3] =
    [[0xc9, 0x65, 0x3f, 255], [0x2f, 0x7f, 0x86, 255], [0xec, 0xe0, 0xc4, 255]];

/// The document with the stroke; `None` if the stroke changed nothing.
pub fn draw_stroke(
    preset: &BrushPreset,
    surface: Arc<Surface>,
    scale: f32,
    background: Color,
) -> Option<Document> {
    let size = surface.size();
    let side = size.width.min(size.height) as f32;
    let paint = PixelLayer { tiles: bands(size, side), file: String::new(), x: 0, y: 0 };
    let layers = [
        Layer::new("ground", Content::Gradient(Live::new(clay(background, size)))),
        Layer::new("paint", Content::Pixels(paint)),
    ];
    let layer = layers[1].id;
    let layers = layers.into_iter().map(Arc::new).collect();
    let document = Document { surface: Some(surface), layers, ..Document::empty(size) };
    let brush = scaled(&preset.brush, scale, side);
    let tools = ToolSettings { operator: preset.operator, ..ToolSettings::with_brush(brush) };
    let context = ToolContext {
        layer: Some(layer),
        // From the neighboring band.
        clone_offset: Some(vec2(side / BANDS, 0.0)),
        ..ToolContext::new(&document, &tools)
    };
    let pens: Vec<PenSample> = wave(size)
        .into_iter()
        .map(|sample| PenSample { sample, keys: ModifierKeys::default() })
        .collect();
    let (gesture, _) =
        brush::press(&context, *pens.first()?, crate::tools::purpose::StrokePurpose::Paint);
    let mut gesture = gesture?;
    gesture.drag(&pens[1..]);
    match gesture.release() {
        Outcome::Commit { document, .. } => Some(document),
        _ => None,
    }
}

/// Bands that slope down to the right.
fn bands(size: Size, side: f32) -> TileGrid {
    let color = |p: Vec2| {
        let band = ((p.x + 0.35 * p.y) / side * BANDS).max(0.0) as usize;
        COLORS[band % COLORS.len()]
    };
    let rows = 0..size.height;
    let texels =
        rows.flat_map(|y| (0..size.width).flat_map(move |x| color(vec2(x as f32, y as f32))));
    let texels: Vec<u8> = texels.collect();
    TileGrid::from_straight_rgba(&texels, size.width as usize, size.height as usize, 0, 0)
}
