//! Smudge, blur, clone, and brushes that pick up paint: they work on existing paint. Dab by dab
//! through the same bent footprint as paint, each on the result of the last one, in f32, rounded
//! when it is shown. Floor 3. `drag` says where smudge and clone take a pixel's color from,
//! `soften` how blur changes it, `pickup` which color a dab paints, `pixels` holds the pixels. Not
//! here: what the pen did (`tools`).

mod drag;
mod pickup;
mod pixels;
mod soften;

#[cfg(test)]
mod tests;

use super::brush::{Brush, BrushMode};
use super::dab::{DabScratch, PlacedDab};
use super::dab_walker::{Dab, DabWalker};
use super::sample::Sample;
use super::scene::Scene;
use super::selection::StrokeSelection;
use super::stroke::Stroke;
use super::stroke::dabs::{StrokeDabs, tiles_of};
use super::stroke_tile::StrokeTile;
use super::tint;
use crate::math::{Rect, Vec2, parallel, srgb::Color};
use crate::raster::planar::PixelRow;
use crate::raster::tile::TILE_AREA;
use crate::raster::{PlanarTile, TILE, Tile, TileAt, TileGrid};
use crate::surface::objects::CanvasPart;
use pixels::RetouchPixels;
use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

/// Retouching strokes that are drawn together: one, or one and its mirror images. Their dabs
/// alternate.
///
/// The resulting pixels do not depend on how the samples are batched.
pub struct ActiveRetouching {
    scene: Scene,
    /// What clone copies from.
    source: TileGrid,
    retouched: RetouchPixels,
    strokes: Vec<RetouchStroke>,
    /// Where the end of the curve was shown, which the next sample may still change.
    tail: BTreeSet<TileAt>,
}

/// One unfinished stroke.
struct RetouchStroke {
    brush: Brush,
    color: Color,
    stroke_dabs: StrokeDabs,
    walker: DabWalker,
    /// From a pixel to what is cloned onto it, px.
    offset: Vec2,
    selection: Option<StrokeSelection>,
    /// Where it may paint; known from its first sample on.
    part: Option<CanvasPart>,
    progress: DabQueue,
}

/// The dabs of a stroke that are still to be applied.
#[derive(Clone, Default)]
struct DabQueue {
    /// Dabs that were not applied yet.
    waiting: VecDeque<Dab>,
    before: Option<Dab>,
    /// Paint that was picked up.
    held: pickup::PickedUpPaint,
}

/// A dab on a tile: its pixels, and their coverage.
struct TileDab {
    at: TileAt,
    /// Canvas px; it holds every pixel that is covered.
    area: Rect,
    /// Of the tile, `[0, 1]`.
    coverage: Box<[f32; TILE_AREA]>,
}

impl ActiveRetouching {
    /// Starts strokes with the settings of these; their samples are ignored.
    ///
    /// * `offsets`: for each stroke, from a pixel to what is cloned onto it, px; 0 if none is
    ///   given.
    /// * `base`: the layer's pixels. `source`: what clone copies from, as it was before the stroke.
    pub fn new(
        strokes: &[Stroke],
        offsets: &[Vec2],
        base: TileGrid,
        source: TileGrid,
        scene: &Scene,
    ) -> Self {
        let offsets = offsets
            .iter()
            .copied()
            .filter(|offset| offset.is_finite())
            .chain(std::iter::repeat(Vec2::ZERO));
        let stroke = |(stroke, offset): (&Stroke, Vec2)| RetouchStroke {
            brush: stroke.brush().clone(),
            color: stroke.color(),
            stroke_dabs: StrokeDabs::empty(stroke.brush(), scene),
            walker: DabWalker::new(stroke.brush(), stroke.operator(), stroke.color(), scene),
            offset,
            selection: stroke.selection().cloned(),
            part: None,
            progress: DabQueue::default(),
        };
        let strokes = strokes.iter().zip(offsets).map(stroke).collect();
        Self {
            scene: scene.clone(),
            source,
            retouched: RetouchPixels::new(base),
            strokes,
            tail: BTreeSet::new(),
        }
    }

    /// Takes the next samples of each stroke; returns the tiles of the layer that changed.
    pub fn draw(&mut self, samples: &[Vec<Sample>]) -> Vec<(TileAt, Option<Arc<Tile>>)> {
        for (stroke, samples) in self.strokes.iter_mut().zip(samples) {
            stroke.take(samples, &self.scene);
        }
        let mut changed = std::mem::take(&mut self.tail);
        while !self.strokes.is_empty()
            && self.strokes.iter().all(|stroke| !stroke.progress.waiting.is_empty())
        {
            for i in 0..self.strokes.len() {
                let mut progress = std::mem::take(&mut self.strokes[i].progress);
                changed.extend(self.strokes[i].rub_next(
                    &mut progress,
                    &mut self.retouched,
                    &self.source,
                    &self.scene,
                ));
                self.strokes[i].progress = progress;
            }
        }
        let shown = self.with_tail();
        changed.extend(&self.tail);
        let tile = |&at: &TileAt| (at, shown.stored_tile(at));
        let changed: Vec<TileAt> = changed.into_iter().collect();
        parallel::map(&changed, tile)
    }

    /// The pixels with the dabs that are due if the strokes end here.
    fn with_tail(&mut self) -> RetouchPixels {
        let mut retouched = self.retouched.clone();
        let mut rests: Vec<DabQueue> = self.strokes.iter().map(RetouchStroke::rest).collect();
        while rests.iter().any(|rest| !rest.waiting.is_empty()) {
            for (stroke, rest) in self.strokes.iter().zip(&mut rests) {
                self.tail.extend(stroke.rub_next(rest, &mut retouched, &self.source, &self.scene));
            }
        }
        retouched
    }
}

impl RetouchStroke {
    fn take(&mut self, samples: &[Sample], scene: &Scene) {
        let Some(first) = samples.first() else { return };
        let bounded = self.brush.bounded;
        self.stroke_dabs.begin(&self.brush, samples);
        self.part.get_or_insert_with(|| bounded.from(scene.surface.as_ref(), first.at));
        let mut dabs = Vec::new();
        samples.iter().for_each(|sample| self.walker.push(sample, &mut dabs));
        self.progress.waiting.extend(dabs);
    }

    fn rest(&self) -> DabQueue {
        let mut rest = self.progress.clone();
        rest.waiting.extend(self.walker.tail());
        rest
    }

    /// Applies the next dab, if there is one; returns the tiles that it changed.
    fn rub_next(
        &self,
        progress: &mut DabQueue,
        retouched: &mut RetouchPixels,
        source: &TileGrid,
        scene: &Scene,
    ) -> Vec<TileAt> {
        let Some(dab) = progress.waiting.pop_front() else { return Vec::new() };
        let before = progress.before.replace(dab);
        let placed = self.stroke_dabs.place(dab, scene);
        let paint = match self.brush.mode {
            BrushMode::Paint if self.brush.erases => Some([0.0; 4]),
            BrushMode::Paint => Some(pickup::mix_color(
                &self.brush,
                self.brush_color(&dab),
                &dab,
                &mut progress.held,
                retouched,
                scene,
            )),
            _ => None,
        };
        let rubbed = |scratch: &mut DabScratch, at: &TileAt| {
            let touch = self.touch(&placed, *at, scratch, scene)?;
            let colors = match self.brush.mode {
                BrushMode::Paint => {
                    let area = touch.area.width() * touch.area.height();
                    paint.map(|color| vec![color; area])
                }
                BrushMode::Smudge { length } => {
                    drag::smudge_colors(&touch, &dab, before.as_ref()?, length, retouched, scene)
                }
                BrushMode::Blur { width } => Some(soften::blurred(
                    &touch,
                    &dab,
                    before.as_ref(),
                    width,
                    self.limits(),
                    retouched,
                    scene,
                )),
                BrushMode::Clone { .. } => {
                    Some(drag::clone_colors(&touch, &dab, self.offset, source, scene))
                }
            }?;
            let mut tile = retouched.tile(*at);
            mix(&mut tile, &touch, &colors, self.brush.keeps_alpha);
            Some((*at, tile))
        };
        let made: Vec<_> = parallel::map_with(&tiles_of(&placed), DabScratch::default, rubbed);
        let mut changed = Vec::new();
        for (at, tile) in made.into_iter().flatten() {
            retouched.set(at, tile);
            changed.push(at);
        }
        changed
    }

    /// The brush's own color, which varies only after mixing.
    fn brush_color(&self, dab: &Dab) -> Color {
        if tint::has_varied_color(&self.brush) { self.color } else { dab.color }
    }

    fn limits(&self) -> &CanvasPart {
        self.part.as_ref().unwrap_or(&CanvasPart::Whole)
    }

    /// The part of a tile that a dab covers; `None` if it covers nothing.
    fn touch(
        &self,
        placed: &PlacedDab,
        at: TileAt,
        scratch: &mut DabScratch,
        scene: &Scene,
    ) -> Option<TileDab> {
        let selected = match &self.selection {
            None => None,
            Some(selection) => Some(selection.tile(at)?),
        };
        let mut stroke_tile = StrokeTile::one_color();
        if let Some(grain) = self.stroke_dabs.grain(self.stroke_dabs.scene(), at) {
            stroke_tile = stroke_tile.under(grain);
        }
        self.stroke_dabs.add(placed, at, &mut stroke_tile, scratch);
        if let Some(selected) = selected {
            stroke_tile.select(&selected);
        }
        let mut coverage = Box::new(*stroke_tile.coverage()?);
        let opaque =
            if self.brush.mode == BrushMode::Paint { f32::from(self.color.a) / 255.0 } else { 1.0 };
        let opacity = self.brush.opacity.max(0.0).min(1.0) * opaque;
        let (tile, part) = (at.rect(), self.limits());
        let mut area = Rect::EMPTY;
        for (y, row) in (tile.y0..).zip(coverage.as_chunks_mut::<TILE>().0) {
            for (x, share) in (tile.x0..).zip(row).filter(|(_, share)| **share > 0.0) {
                *share *= opacity * if part.is_whole() { 1.0 } else { part.coverage(x, y) };
                area = area.union(Rect::new(x, y, x + 1, y + 1));
            }
        }
        let area = area.intersect(scene.size.rect());
        (!area.is_empty()).then_some(TileDab { at, area, coverage })
    }
}

impl TileDab {
    /// For a canvas pixel of the area.
    fn share(&self, x: i32, y: i32) -> f32 {
        let tile = self.at.rect();
        self.coverage[(y - tile.y0) as usize * TILE + (x - tile.x0) as usize]
    }
}

/// Moves the covered pixels of a tile toward new colors, one for each pixel of the touched area,
/// row by row.
fn mix(tile: &mut PlanarTile, touch: &TileDab, colors: &[[f32; 4]], keeps_alpha: bool) {
    let (corner, area) = (touch.at.rect(), touch.area);
    for (y, colors) in (area.y0..area.y1).zip(colors.chunks_exact(area.width())) {
        let Some(row) = tile.rows_mut().get_mut((y - corner.y0) as usize) else { continue };
        for (x, &color) in (area.x0..area.x1).zip(colors) {
            let column = (x - corner.x0) as usize;
            let mixed = move_toward(row.pixel(column), color, touch.share(x, y), keeps_alpha);
            put(row, column, mixed);
        }
    }
}

/// A premultiplied pixel moved by a ratio toward a color; if it keeps its alpha, only hue and
/// brightness change.
fn move_toward(pixel: [f32; 4], color: [f32; 4], share: f32, keeps_alpha: bool) -> [f32; 4] {
    let mixed: [f32; 4] = std::array::from_fn(|c| pixel[c] + (color[c] - pixel[c]) * share);
    if !keeps_alpha {
        return mixed;
    }
    let scale = if mixed[3] > 0.0 { pixel[3] / mixed[3] } else { 0.0 };
    // Paint of another alpha is weighted by its alpha; colors stay within the pixel's alpha.
    [0, 1, 2, 3].map(|c| if c == 3 { pixel[3] } else { (mixed[c] * scale).min(pixel[3]) })
}

fn put(row: &mut PixelRow, x: usize, pixel: [f32; 4]) {
    (row.rgb[0][x], row.rgb[1][x], row.rgb[2][x], row.a[x]) =
        (pixel[0], pixel[1], pixel[2], pixel[3]);
}
