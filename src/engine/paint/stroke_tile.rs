//! What one stroke has painted on one tile: its dabs accumulate in f32 before the opacity caps them
//! and the result is blended with the layer. Floor 3.

mod rows;

pub use rows::raise;

use super::brush::Brush;
use super::brush::dual_brush::DualSettings;
use super::grain::GrainTile;
use crate::math::srgb::Color;
use crate::raster::tile::TILE_AREA;
use crate::raster::{
    BlendMode, CoverageTile, Mix, PlanarTile, TILE, TileAt, TileCoverage, TilePaint,
};
use crate::surface::contours::{FarSide, place_of};
use crate::surface::objects::CanvasPart;
use rows::{
    add_alpha, add_colors, add_covered, add_stamped, combine_colors, combine_coverage, keep,
    lay_colors, lay_coverage, take_out_row,
};
use std::sync::Arc;

/// The accumulated paint of a stroke on a tile.
#[derive(Clone)]
pub struct StrokeTile {
    /// What the grain leaves of each pixel.
    grain: Option<Arc<GrainTile>>,
    light: PaintPlanes,
    /// Under grain each pixel has two parts, a lighter and a darker one: the second.
    dark: Option<PaintPlanes>,
}

/// Paint on one part of each pixel.
#[derive(Clone)]
struct PaintPlanes {
    paint: Paint,
    /// M: the share of each pixel that the dabs have reached (`rim`).
    reach: Box<[f32; TILE_AREA]>,
}

#[derive(Clone)]
enum Paint {
    /// Coverage by the stroke's one color, `[0, 1]`, row by row.
    OneColor(Box<[f32; TILE_AREA]>),
    /// Premultiplied colors of stamps.
    Colors(PlanarTile),
}

/// A row of pixels that a dab covers.
#[derive(Clone, Copy)]
pub struct CoveredRow<'r> {
    /// The coverage of each pixel, `[0, 1]`; no more than the share.
    pub coverage: &'r [f32],
    /// p: the share of each pixel that the dab reaches at all, `[0, 1]`.
    pub shares: &'r [f32],
}

/// What one dab adds to a stroke tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DabPaint {
    /// The coverage that it adds where its footprint is 1, `[0, 1]`.
    pub flow: f32,
    /// The greatest coverage that it gives a pixel, `[0, 1]`; above it only colors mix.
    pub ceiling: f32,
    /// Opaque; `None` if a stamp has its own.
    pub color: Option<Color>,
}

/// How a stroke tile is blended with the pixels of its layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeBlend {
    /// The color of one-color tiles; for others only its alpha counts.
    pub color: Color,
    /// For the whole stroke, `[0, 1]`.
    pub opacity: f32,
    pub mode: BlendMode,
    /// Erases instead of painting.
    pub erases: bool,
    /// Paints only on existing paint, and keeps its coverage.
    pub keeps_alpha: bool,
}

impl StrokeBlend {
    pub fn of(brush: &Brush, color: Color) -> Self {
        let Brush { opacity, blend, erases, keeps_alpha, .. } = *brush;
        Self { color, opacity: opacity.max(0.0).min(1.0), mode: blend, erases, keeps_alpha }
    }
}

impl PaintPlanes {
    fn new(paint: Paint) -> Self {
        Self { paint, reach: Box::new([0.0; TILE_AREA]) }
    }

    fn cover(&mut self, start: usize, row: CoveredRow, paint: DabPaint) {
        let n = row.coverage.len();
        let Some(reach) = self.reach.get_mut(start..start + n) else { return };
        match &mut self.paint {
            Paint::OneColor(coverage) => {
                add_covered(row, paint, &mut coverage[start..start + n], reach)
            }
            Paint::Colors(tile) => {
                if let Some(pixels) = tile.rows_mut().get_mut(start / TILE) {
                    let [r, g, b, _] = paint.color.unwrap_or(Color::BLACK).to_f32();
                    let source =
                        |i: usize| (row.coverage[i] * paint.flow, [r, g, b], row.shares[i]);
                    add_colors(source, paint.ceiling, start % TILE, pixels, reach);
                }
            }
        }
    }

    fn stamp(&mut self, start: usize, stamped: &[[u8; 4]], paint: DabPaint) {
        let (n, flow) = (stamped.len(), paint.flow / 255.0);
        let Some(reach) = self.reach.get_mut(start..start + n) else { return };
        // Pictures have rims of their own: they reach whole pixels.
        reach.iter_mut().zip(stamped).filter(|(_, s)| s[3] > 0).for_each(|(reach, _)| *reach = 1.0);
        match &mut self.paint {
            Paint::OneColor(coverage) => {
                add_alpha(stamped, flow, paint.ceiling, &mut coverage[start..start + n])
            }
            Paint::Colors(tile) => {
                let Some(row) = tile.rows_mut().get_mut(start / TILE) else { return };
                match paint.color.map(Color::to_f32) {
                    Some([r, g, b, _]) => {
                        let source = |i: usize| (flow * f32::from(stamped[i][3]), [r, g, b], 1.0);
                        add_colors(source, paint.ceiling, start % TILE, row, reach);
                    }
                    None => add_stamped(stamped, flow, paint.ceiling, start % TILE, row),
                }
            }
        }
    }

    fn planes(&mut self) -> Vec<&mut [f32]> {
        match &mut self.paint {
            Paint::OneColor(coverage) => vec![&mut coverage[..]],
            Paint::Colors(tile) => {
                let rows = tile.rows_mut().iter_mut();
                rows.flat_map(|row| {
                    row.rgb.iter_mut().chain([&mut row.a]).map(|plane| &mut plane[..])
                })
                .collect()
            }
        }
    }
}

impl StrokeTile {
    pub fn one_color() -> Self {
        Self::of(Paint::OneColor(Box::new([0.0; TILE_AREA])))
    }

    pub fn colors() -> Self {
        Self::of(Paint::Colors(PlanarTile::transparent()))
    }

    fn of(paint: Paint) -> Self {
        Self { grain: None, light: PaintPlanes::new(paint), dark: None }
    }

    /// The same, empty, under grain.
    pub fn under(self, grain: Arc<GrainTile>) -> Self {
        Self { grain: Some(grain), dark: Some(self.light.clone()), ..self }
    }

    /// Coverage and reach of every pixel, row by row, for a tile of one color without grain.
    pub fn plain(&mut self) -> Option<(&mut [f32; TILE_AREA], &mut [f32; TILE_AREA])> {
        match &mut self.light.paint {
            Paint::OneColor(coverage) if self.grain.is_none() => {
                Some((coverage, &mut self.light.reach))
            }
            _ => None,
        }
    }

    /// Coverage of every pixel, row by row, if it has one color.
    pub fn coverage(&mut self) -> Option<&mut [f32; TILE_AREA]> {
        self.join();
        match &mut self.light.paint {
            Paint::OneColor(coverage) => Some(coverage),
            Paint::Colors(_) => None,
        }
    }

    /// Whether no pixel has been reached by a dab: nothing is covered.
    pub fn is_clear(&self) -> bool {
        // A row at a time, which is compared side by side.
        let is_clear_row =
            |row: &[f32; TILE]| row.iter().fold(0, |any, reach| any | reach.to_bits()) == 0;
        let is_clear =
            |planes: &PaintPlanes| planes.reach.as_chunks::<TILE>().0.iter().all(is_clear_row);
        is_clear(&self.light) && self.dark.as_ref().is_none_or(is_clear)
    }

    /// Merges the two parts of each pixel: nothing more can be painted.
    fn join(&mut self) {
        let Some((grain, mut dark)) = self.grain.take().zip(self.dark.take()) else { return };
        let is_one_color = matches!(self.light.paint, Paint::OneColor(_));
        for (i, (light, dark)) in self.light.planes().into_iter().zip(dark.planes()).enumerate() {
            // Four planes a row for a tile of colors, one plane for a tile of one color.
            let shares =
                if is_one_color { &grain.share[..] } else { &grain.share[i / 4 * TILE..][..TILE] };
            light
                .iter_mut()
                .zip(dark)
                .zip(shares)
                .for_each(|((a, b), share)| *a = *b + (*a - *b) * share);
        }
    }

    /// Meets the coverage of a second tip; nothing more can be painted. `second`: of one color,
    /// without grain.
    pub fn combine(&mut self, second: &StrokeTile, settings: &DualSettings) {
        self.join();
        let Paint::OneColor(second) = &second.light.paint else { return };
        let (mode, opacity) = (settings.mode, settings.opacity.max(0.0).min(1.0));
        match &mut self.light.paint {
            Paint::OneColor(first) => combine_coverage(mode, &second[..], opacity, &mut first[..]),
            Paint::Colors(tile) => {
                for (row, second) in tile.rows_mut().iter_mut().zip(second.as_chunks::<TILE>().0) {
                    combine_colors(mode, second, opacity, row);
                }
            }
        }
    }

    /// Adds one color to a row from the `start`th pixel on, as far as each is covered, up to the
    /// ceiling: see [`raise`].
    pub fn cover(&mut self, start: usize, row: CoveredRow, paint: DabPaint) {
        let Some((grain, dark)) = self.grain.as_deref().zip(self.dark.as_mut()) else {
            return self.light.cover(start, row, paint);
        };
        let mut part = [0.0; TILE];
        for (planes, factors) in [(&mut self.light, &grain.light), (dark, &grain.dark)] {
            let left = part.iter_mut().zip(row.coverage).zip(&factors[start..]);
            left.for_each(|((part, covered), factor)| *part = covered * factor);
            planes.cover(
                start,
                CoveredRow { coverage: &part[..row.coverage.len().min(TILE)], ..row },
                paint,
            );
        }
    }

    /// Adds a row of a stamp, premultiplied bytes, from the `start`th pixel on, as
    /// [`StrokeTile::cover`] does.
    pub fn stamp(&mut self, start: usize, stamped: &[[u8; 4]], paint: DabPaint) {
        let Some((grain, dark)) = self.grain.as_deref().zip(self.dark.as_mut()) else {
            return self.light.stamp(start, stamped, paint);
        };
        let mut part = [[0; 4]; TILE];
        for (planes, factors) in [(&mut self.light, &grain.light), (dark, &grain.dark)] {
            for ((part, texel), factor) in part.iter_mut().zip(stamped).zip(&factors[start..]) {
                *part = texel.map(|v| (f32::from(v) * factor + 0.5) as u8);
            }
            planes.stamp(start, &part[..stamped.len().min(TILE)], paint);
        }
    }

    /// Removes what lies outside a part of the canvas; nothing more can be painted.
    pub fn limit_to(&mut self, part: &CanvasPart, at: TileAt) {
        if part.is_whole() {
            return;
        }
        self.join();
        let corner = at.rect();
        for y in 0..TILE {
            for x in 0..TILE {
                self.lower((x, y), part.coverage(corner.x0 + x as i32, corner.y0 + y as i32));
            }
        }
    }

    /// The same on what represents a tile on a far side: there the other side's piece of surface
    /// counts. `selected`: for the tile.
    pub fn limit_far_side(
        &mut self,
        part: &CanvasPart,
        selected: Option<&CoverageTile>,
        far: &FarSide,
        at: TileAt,
    ) {
        let Some(contours) = far.contours().on(at) else { return };
        let corner = at.rect();
        for (i, pixel) in contours.pixels[..contours.seen].iter().enumerate() {
            if !part.is_whole() {
                self.lower(place_of(i), pixel.other_mean(|x, y| part.coverage(x as i32, y as i32)));
            }
            if let Some(selected) = selected {
                let (x, y) = ((pixel.x - corner.x0) as usize, (pixel.y - corner.y0) as usize);
                self.lower(place_of(i), f32::from(selected.bytes()[y * TILE + x]) / 255.0);
            }
        }
    }

    fn lower(&mut self, (x, y): (usize, usize), share: f32) {
        match &mut self.light.paint {
            Paint::OneColor(coverage) => coverage[y * TILE + x] *= share,
            Paint::Colors(tile) => {
                let row = &mut tile.rows_mut()[y];
                row.rgb.iter_mut().chain([&mut row.a]).for_each(|plane| plane[x] *= share);
            }
        }
    }

    /// Keeps the selected share of each pixel; nothing more can be painted.
    pub fn select(&mut self, selected: &CoverageTile) {
        if selected.is_whole() {
            return;
        }
        self.join();
        let shares = selected.bytes().as_chunks::<TILE>().0;
        match &mut self.light.paint {
            Paint::OneColor(coverage) => {
                coverage
                    .as_chunks_mut::<TILE>()
                    .0
                    .iter_mut()
                    .zip(shares)
                    .for_each(|(row, shares)| keep(shares, row));
            }
            Paint::Colors(tile) => {
                for (row, shares) in tile.rows_mut().iter_mut().zip(shares) {
                    row.rgb.iter_mut().chain([&mut row.a]).for_each(|plane| keep(shares, plane));
                }
            }
        }
    }

    /// Blends the finished paint with the pixels of a tile.
    pub fn blend_over(mut self, pixels: &mut PlanarTile, at: TileAt, manner: StrokeBlend) {
        self.join();
        if manner.erases {
            // Paint that keeps its coverage cannot be erased.
            if !manner.keeps_alpha {
                self.erase_from(pixels, manner.opacity * f32::from(manner.color.a) / 255.0);
            }
        } else if manner.mode == BlendMode::Normal && !manner.keeps_alpha {
            self.blend_over_normal(pixels, manner.color, manner.opacity);
        } else {
            let mut paint = PlanarTile::transparent();
            self.blend_over_normal(&mut paint, manner.color, manner.opacity);
            let mix = Mix { mode: manner.mode, atop: manner.keeps_alpha, ..Mix::default() }.on(at);
            pixels.blend(mix, TilePaint::Planar(&paint), &TileCoverage::FULL);
        }
    }

    /// Source over. For stamps only the color's alpha counts.
    fn blend_over_normal(&self, pixels: &mut PlanarTile, color: Color, opacity: f32) {
        match &self.light.paint {
            Paint::OneColor(coverage) => {
                let color = color.premultiplied().map(|c| c * opacity);
                for (coverage, row) in coverage.as_chunks::<TILE>().0.iter().zip(pixels.rows_mut())
                {
                    lay_coverage(coverage, color, row);
                }
            }
            Paint::Colors(tile) => {
                let opacity = opacity * f32::from(color.a) / 255.0;
                for (from, row) in tile.rows().iter().zip(pixels.rows_mut()) {
                    lay_colors(from, opacity, row);
                }
            }
        }
    }

    /// Destination out.
    fn erase_from(&self, pixels: &mut PlanarTile, opacity: f32) {
        match &self.light.paint {
            Paint::OneColor(coverage) => {
                for (coverage, row) in coverage.as_chunks::<TILE>().0.iter().zip(pixels.rows_mut())
                {
                    take_out_row(coverage, opacity, row);
                }
            }
            Paint::Colors(tile) => {
                for (from, row) in tile.rows().iter().zip(pixels.rows_mut()) {
                    take_out_row(&from.a, opacity, row);
                }
            }
        }
    }
}
