//! What one stroke has painted on one tile: its dabs accumulate in f32 before the opacity caps them and the result is
//! blended with the layer. Floor 3.

use super::brush::Brush;
use crate::math::srgb::Color;
use crate::raster::planar::PixelRow;
use crate::raster::tile::TILE_AREA;
use crate::raster::{BlendMode, CoverageTile, Mix, PlanarTile, TILE, TileAt, TileCoverage, TilePaint};
use crate::surface::objects::CanvasPart;

/// The accumulated paint of a stroke on a tile.
#[derive(Clone)]
pub enum StrokeTile {
    /// Coverage by the stroke's one colour, `[0, 1]`, row by row.
    OneColor(Box<[f32; TILE_AREA]>),
    /// Premultiplied colours of stamps.
    Colors(PlanarTile),
}

/// What one dab adds to a stroke tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DabPaint {
    /// Coverage that it adds where its footprint is 1, `[0, 1]`.
    pub flow: f32,
    /// The greatest coverage that it gives a pixel, `[0, 1]`; above it only colours mix.
    pub ceiling: f32,
    /// Opaque; `None` where a stamp brings its own.
    pub color: Option<Color>,
}

/// How a stroke tile is blended with the pixels of its layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeBlend {
    /// The colour of one-colour tiles; of others only its alpha counts.
    pub color: Color,
    /// Of the whole stroke, `[0, 1]`.
    pub opacity: f32,
    pub mode: BlendMode,
    /// Erases instead of painting.
    pub erases: bool,
    /// Paints only where there is paint, and keeps its coverage.
    pub keeps_alpha: bool,
}

impl StrokeBlend {
    pub fn of(brush: &Brush, color: Color) -> Self {
        let Brush { opacity, blend, erases, keeps_alpha, .. } = *brush;
        Self { color, opacity: opacity.max(0.0).min(1.0), mode: blend, erases, keeps_alpha }
    }
}

impl StrokeTile {
    pub fn one_color() -> Self {
        StrokeTile::OneColor(Box::new([0.0; TILE_AREA]))
    }
    pub fn colors() -> Self {
        StrokeTile::Colors(PlanarTile::transparent())
    }
    pub fn is_one_color(&self) -> bool {
        matches!(self, StrokeTile::OneColor(_))
    }
    /// Coverage of `n` pixels from the `start`th on; empty for a tile of colours.
    pub fn coverage(&mut self, start: usize, n: usize) -> &mut [f32] {
        match self {
            StrokeTile::OneColor(coverage) => coverage.get_mut(start..start + n).unwrap_or_default(),
            StrokeTile::Colors(_) => &mut [],
        }
    }
    /// Adds one colour to a row from the `start`th pixel on, as far as each is `covered`: a ← a + f (c − a), f = flow ·
    /// covered, up to the ceiling c.
    pub fn cover(&mut self, start: usize, covered: &[f32], paint: DabPaint) {
        match self {
            StrokeTile::OneColor(_) => add_covered(covered, paint, self.coverage(start, covered.len())),
            StrokeTile::Colors(tile) => {
                if let Some(row) = tile.rows_mut().get_mut(start / TILE) {
                    let [r, g, b, _] = paint.color.unwrap_or(Color::BLACK).to_f32();
                    let source = |i: usize| (covered[i] * paint.flow, [r, g, b]);
                    add_colors(covered.len(), source, paint.ceiling, start % TILE, row);
                }
            }
        }
    }
    /// Adds a row of a stamp, premultiplied bytes, from the `start`th pixel on, as [`StrokeTile::cover`] does.
    pub fn stamp(&mut self, start: usize, stamped: &[[u8; 4]], paint: DabPaint) {
        let flow = paint.flow / 255.0;
        match self {
            StrokeTile::OneColor(_) => add_alpha(stamped, flow, paint.ceiling, self.coverage(start, stamped.len())),
            StrokeTile::Colors(tile) => {
                let Some(row) = tile.rows_mut().get_mut(start / TILE) else { return };
                match paint.color.map(Color::to_f32) {
                    Some([r, g, b, _]) => {
                        let source = |i: usize| (flow * f32::from(stamped[i][3]), [r, g, b]);
                        add_colors(stamped.len(), source, paint.ceiling, start % TILE, row);
                    }
                    None => add_stamped(stamped, flow, paint.ceiling, start % TILE, row),
                }
            }
        }
    }
    /// Removes what lies outside a part of the canvas.
    pub fn limit_to(&mut self, part: &CanvasPart, at: TileAt) {
        if part.is_whole() {
            return;
        }
        let corner = at.rect();
        for y in 0..TILE {
            for x in 0..TILE {
                let share = part.coverage(corner.x0 + x as i32, corner.y0 + y as i32);
                match self {
                    StrokeTile::OneColor(coverage) => coverage[y * TILE + x] *= share,
                    StrokeTile::Colors(tile) => {
                        let row = &mut tile.rows_mut()[y];
                        row.rgb.iter_mut().chain([&mut row.a]).for_each(|plane| plane[x] *= share);
                    }
                }
            }
        }
    }
    /// Keeps of each pixel the share that is selected.
    pub fn select(&mut self, selected: &CoverageTile) {
        if selected.is_whole() {
            return;
        }
        let shares = selected.bytes().as_chunks::<TILE>().0;
        match self {
            StrokeTile::OneColor(coverage) => {
                coverage.as_chunks_mut::<TILE>().0.iter_mut().zip(shares).for_each(|(row, shares)| keep(shares, row));
            }
            StrokeTile::Colors(tile) => {
                for (row, shares) in tile.rows_mut().iter_mut().zip(shares) {
                    row.rgb.iter_mut().chain([&mut row.a]).for_each(|plane| keep(shares, plane));
                }
            }
        }
    }
    /// Lays the dried paint on the pixels of a tile.
    pub fn blend_over(&self, pixels: &mut PlanarTile, at: TileAt, manner: StrokeBlend) {
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
    /// Source over. Of stamps only the colour's alpha counts.
    fn blend_over_normal(&self, pixels: &mut PlanarTile, color: Color, opacity: f32) {
        match self {
            StrokeTile::OneColor(coverage) => {
                let color = color.premultiplied().map(|c| c * opacity);
                for (coverage, row) in coverage.as_chunks::<TILE>().0.iter().zip(pixels.rows_mut()) {
                    lay_coverage(coverage, color, row);
                }
            }
            StrokeTile::Colors(tile) => {
                let opacity = opacity * f32::from(color.a) / 255.0;
                for (from, row) in tile.rows().iter().zip(pixels.rows_mut()) {
                    lay_colors(from, opacity, row);
                }
            }
        }
    }
    /// Destination out.
    fn erase_from(&self, pixels: &mut PlanarTile, opacity: f32) {
        match self {
            StrokeTile::OneColor(coverage) => {
                for (coverage, row) in coverage.as_chunks::<TILE>().0.iter().zip(pixels.rows_mut()) {
                    take_out_row(coverage, opacity, row);
                }
            }
            StrokeTile::Colors(tile) => {
                for (from, row) in tile.rows().iter().zip(pixels.rows_mut()) {
                    take_out_row(&from.a, opacity, row);
                }
            }
        }
    }
}

/// Adds coverage of weight f up to a ceiling; what is already above the ceiling stays.
#[inline(always)]
fn raised(coverage: f32, f: f32, ceiling: f32) -> f32 {
    let room = ceiling - coverage;
    coverage + f * if room > 0.0 { room } else { 0.0 }
}

/// One premultiplied pixel with a colour of weight f over it, up to a ceiling: colours mix as source over mixes them,
/// coverage rises no further than the ceiling.
#[inline(always)]
fn mixed(p: [f32; 4], f: f32, source: [f32; 3], ceiling: f32) -> [f32; 4] {
    let over = |c: usize| p[c] * (1.0 - f) + source[c];
    let a_over = p[3] * (1.0 - f) + f;
    let a = raised(p[3], f, ceiling);
    let (part, whole) = if ceiling < 1.0 && a_over > 0.0 && a < a_over { (a, a_over) } else { (1.0, 1.0) };
    // Multiplied first: what is as much as the coverage stays so to the bit, however often dabs mix.
    [over(0), over(1), over(2), a_over].map(|v| v * part / whole)
}

crate::widest! {
    fn keep(shares: &[u8; TILE], values: &mut [f32; TILE]) {
        for (v, share) in values.iter_mut().zip(shares) {
            *v *= f32::from(*share) * (1.0 / 255.0);
        }
    }
    fn add_covered(covered: &[f32], paint: DabPaint, coverage: &mut [f32]) {
        for (a, f) in coverage.iter_mut().zip(covered) {
            *a = raised(*a, paint.flow * f, paint.ceiling);
        }
    }
    fn add_alpha(stamped: &[[u8; 4]], flow: f32, ceiling: f32, coverage: &mut [f32]) {
        for (a, s) in coverage.iter_mut().zip(stamped) {
            *a = raised(*a, flow * f32::from(s[3]), ceiling);
        }
    }
    /// `x`: column of the first pixel.
    fn add_stamped(stamped: &[[u8; 4]], flow: f32, ceiling: f32, x: usize, row: &mut PixelRow) {
        let PixelRow { rgb: [r, g, b], a } = row;
        let (r, g, b, a) = (&mut r[x..], &mut g[x..], &mut b[x..], &mut a[x..]);
        for (i, s) in stamped.iter().enumerate().take(a.len()) {
            let source = [0, 1, 2].map(|c| flow * f32::from(s[c]));
            [r[i], g[i], b[i], a[i]] = mixed([r[i], g[i], b[i], a[i]], flow * f32::from(s[3]), source, ceiling);
        }
    }
    /// Blends one premultiplied colour over a row, weighted by each pixel's coverage.
    fn lay_coverage(coverage: &[f32; TILE], color: [f32; 4], row: &mut PixelRow) {
        for (plane, c) in row.rgb.iter_mut().chain([&mut row.a]).zip(color) {
            for (p, a) in plane.iter_mut().zip(coverage) {
                *p = *p * (1.0 - color[3] * a) + c * a;
            }
        }
    }
    fn lay_colors(from: &PixelRow, opacity: f32, row: &mut PixelRow) {
        for (plane, over) in row.rgb.iter_mut().chain([&mut row.a]).zip(from.rgb.iter().chain([&from.a])) {
            for ((p, s), a) in plane.iter_mut().zip(over).zip(&from.a) {
                *p = *p * (1.0 - opacity * a) + opacity * s;
            }
        }
    }
    fn take_out_row(coverage: &[f32; TILE], opacity: f32, row: &mut PixelRow) {
        for plane in row.rgb.iter_mut().chain([&mut row.a]) {
            for (p, a) in plane.iter_mut().zip(coverage) {
                *p *= 1.0 - opacity * a;
            }
        }
    }
}

/// Adds one colour to `n` pixels of a row from column `x` on; `source`: the weight at each, and the straight colour.
fn add_colors(n: usize, source: impl Fn(usize) -> (f32, [f32; 3]), ceiling: f32, x: usize, row: &mut PixelRow) {
    let PixelRow { rgb: [r, g, b], a } = row;
    for i in 0..n.min(TILE - x) {
        let (f, color) = source(i);
        let p = [r[x + i], g[x + i], b[x + i], a[x + i]];
        [r[x + i], g[x + i], b[x + i], a[x + i]] = mixed(p, f, color.map(|c| c * f), ceiling);
    }
}
