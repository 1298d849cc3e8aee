//! What a layer holds, rendered for one tile.
//! Floor 4. The rendering itself is the marks' (`paint`, `shading`).

use super::Content;
use crate::math::srgb::{decode, luminance};
use crate::paint::{Scene, stroke};
use crate::raster::{Paint, PlanarTile, TILE, Tile, TileAt};
use std::sync::Arc;

/// The pixels of a layer in one tile.
pub(super) enum Painted {
    Nothing,
    /// One premultiplied colour everywhere.
    Solid([f32; 4]),
    Tile(Arc<Tile>),
    Group(PlanarTile),
}

impl Painted {
    fn of_tile(tile: Option<Arc<Tile>>) -> Self {
        tile.map_or(Painted::Nothing, Painted::Tile)
    }
    pub fn as_paint(&self) -> Option<Paint<'_>> {
        match self {
            Painted::Nothing => None,
            Painted::Solid(color) => Some(Paint::Solid(*color)),
            Painted::Tile(tile) => Some(Paint::Bytes(tile)),
            Painted::Group(pixels) => Some(Paint::Planar(pixels)),
        }
    }
    /// Known to cover every pixel wholly.
    pub fn is_opaque(&self) -> bool {
        match self {
            Painted::Solid(color) => color[3] >= 1.0,
            Painted::Tile(tile) => tile.is_opaque(),
            Painted::Nothing | Painted::Group(_) => false,
        }
    }
}

/// Renders one tile of a layer's content, or finds it rendered. Groups, adjustments and normals have no pixels of their own.
pub(super) fn render(content: &Content, scene: &Scene, at: TileAt) -> Painted {
    match content {
        Content::Fill(color) => Painted::Solid(color.premultiplied()),
        Content::Pixels(pixels) => Painted::of_tile(pixels.tiles.tile(at).cloned()),
        Content::Gradient(live) => Painted::of_tile(live.tile(scene, at, || live.params().render_tile(scene, at))),
        Content::Strokes(live) => {
            Painted::of_tile(live.tile(scene, at, || stroke::render_tile(&live.params().strokes, scene, at)))
        }
        Content::Image(live) => Painted::of_tile(live.tile(scene, at, || live.params().render_tile(scene, at))),
        Content::Shading(_) => Painted::Nothing,
        Content::RadianceScaling(_) | Content::Normals(_) | Content::Group(_) => Painted::Nothing,
    }
}

/// Applies an adjustment to the composite beneath it. `reference`: Y*, the greatest luminance of that composite.
pub(super) fn adjust(_content: &Content, _scene: &Scene, _at: TileAt, _reference: f32, _pixels: &mut PlanarTile) {}

/// The greatest luminance (Rec. 709, linear light, straight colour) of a tile, over the surface where there is one.
///
/// Pixels less than half covered, by paint or by surface, do not count: their straight colours are mostly rounding.
pub(super) fn brightest(pixels: &PlanarTile, scene: &Scene, at: TileAt) -> f32 {
    let rect = at.rect();
    let on_surface = |x: usize, y: usize| {
        let covers = |s: &Arc<crate::surface::Surface>| s.coverage_plane().get(rect.x0 + x as i32, rect.y0 + y as i32);
        scene.surface.as_ref().is_none_or(|s| covers(s).is_some_and(|c| c >= 128))
    };
    let inside = rect.intersect(scene.size.rect());
    let mut most = 0.0f32;
    for (y, row) in pixels.rows().iter().enumerate().take(inside.height()) {
        for x in (0..inside.width().min(TILE)).filter(|&x| row.a[x] >= 0.5 && on_surface(x, y)) {
            let [r, g, b] = [0, 1, 2].map(|c| decode(row.rgb[c][x] / row.a[x]));
            most = most.max(luminance(r, g, b));
        }
    }
    most
}
