//! Cutting and copying the selected part of a layer. Paint loses or keeps its pixels; strokes stay
//! strokes, bounded by what is left or taken of their selections; all other kinds stay as they are,
//! under a mask. Floor 4.

use super::selections::picture;
use super::{
    Content, Document, Layer, LayerId, LayerLock, LayerMask, Live, PixelLayer, StrokeList,
};
use crate::math::parallel;
use crate::paint::{Selection, Stroke, StrokeSelection};
use crate::raster::coverage::product;
use crate::raster::{CoverageGrid, CoverageTile, TILE, Tile, TileGrid};
use std::sync::Arc;

impl Document {
    /// With what is covered removed from a layer. `None` where there is no such layer, or it is
    /// locked.
    ///
    /// A stroke of which nothing is left is removed; in other live layers a mask hides what is
    /// covered.
    pub fn with_cleared(&self, layer: LayerId, covered: &CoverageGrid) -> Option<Document> {
        self.layer(layer).filter(|layer| layer.lock == LayerLock::None)?;
        // Pixels, strokes and masks lie where they show.
        let shown = self.with_transform_applied(layer)?;
        let old = shown.layer(layer)?;
        // Displaced content does not lie where it shows.
        if old.is_warped() {
            return None;
        }
        let left = covered.inverted(self.size.rect());
        match &old.content {
            Content::Pixels(pixels) => {
                let tiles = change_tiles(&pixels.tiles, covered, |tile, covered| {
                    multiply_tile(tile, covered, |c| 255 - c)
                });
                let next = PixelLayer { file: String::new(), tiles, ..pixels.clone() };
                shown.with_layer(layer, |layer| layer.content = Content::Pixels(next))
            }
            Content::Strokes(_) => {
                let scene = shown.scene_of(layer)?;
                shown.with_strokes(layer, |strokes| {
                    for stroke in
                        strokes.iter_mut().filter(|stroke| stroke.has_paint_on(&scene, covered))
                    {
                        *stroke = Arc::new(narrowed(stroke, &left));
                    }
                    strokes.retain(|stroke| {
                        stroke.selection().is_none_or(|own| !own.selection.is_empty())
                    });
                    Some(())
                })
            }
            _ => {
                let mask = shown.narrowed_mask(old, &left);
                shown.with_layer(layer, |layer| layer.mask = Some(mask))
            }
        }
    }

    /// The covered part of a layer, as a layer of its own under a fresh id: paint with those
    /// pixels, the strokes that meet the coverage, bounded to it, or the same live layer under a
    /// mask. `None` where nothing of the layer is there.
    pub fn copy_covered(&self, layer: LayerId, covered: &CoverageGrid) -> Option<Layer> {
        let shown = self.with_transform_applied(layer)?;
        let old = shown.layer(layer)?;
        if old.is_warped() {
            return None;
        }
        let mut next =
            Layer { id: LayerId::fresh(), cache: Default::default(), ..Layer::clone(old) };
        match &old.content {
            Content::Pixels(pixels) => {
                let tiles = multiply(&pixels.tiles, covered);
                tiles.iter().next()?;
                next.content =
                    Content::Pixels(PixelLayer { file: String::new(), tiles, ..pixels.clone() });
            }
            Content::Strokes(live) => {
                let scene = shown.scene_of(layer)?;
                let met = live
                    .params()
                    .strokes
                    .iter()
                    .filter(|stroke| stroke.has_paint_on(&scene, covered));
                let strokes: Vec<_> =
                    met.map(|stroke| Arc::new(narrowed(stroke, covered))).collect();
                let strokes: Vec<_> = strokes
                    .into_iter()
                    .filter(|s| s.selection().is_some_and(|own| !own.selection.is_empty()))
                    .collect();
                if strokes.is_empty() {
                    return None;
                }
                next.content = Content::Strokes(Live::new(StrokeList { strokes }));
            }
            Content::Group(group) => {
                let mut group = group.clone();
                group.layers =
                    group.layers.iter().map(|inner| Arc::new(with_fresh_ids(inner))).collect();
                next.content = Content::Group(group);
                next.mask = Some(shown.narrowed_mask(old, covered));
            }
            _ => next.mask = Some(shown.narrowed_mask(old, covered)),
        }
        Some(next)
    }

    /// A layer's mask times coverage, as a picture; a selection by the surface stays one if there
    /// was no mask.
    fn narrowed_mask(&self, layer: &Layer, to: &CoverageGrid) -> LayerMask {
        let is_active = self.active_coverage().is_some_and(|active| active.ptr_eq(to));
        if let Some(mask) = self.selection_as_mask().filter(|_| is_active && layer.mask.is_none()) {
            return mask;
        }
        let both = self.mask_coverage(layer).combined(to, product);
        LayerMask::new(picture(&both.to_plane(self.size.rect())))
    }
}

/// Pixels times their coverage.
pub fn multiply(tiles: &TileGrid, covered: &CoverageGrid) -> TileGrid {
    let mut out = TileGrid::for_rect(tiles.bounds().intersect(covered.bounds()));
    let both: Vec<_> =
        tiles.iter().filter_map(|(at, tile)| Some((at, tile, covered.tile(at)?))).collect();
    let made: Vec<_> =
        parallel::map(&both, |(at, tile, covered)| (*at, multiply_tile(tile, covered, |c| c)));
    made.into_iter().for_each(|(at, tile)| out.set(at, tile));
    out
}

/// A grid in which each tile with any coverage is changed.
fn change_tiles(
    tiles: &TileGrid,
    covered: &CoverageGrid,
    change: impl Fn(&Arc<Tile>, &CoverageTile) -> Option<Arc<Tile>> + Sync,
) -> TileGrid {
    let mut out = tiles.clone();
    let both: Vec<_> =
        tiles.iter().filter_map(|(at, tile)| Some((at, tile, covered.tile(at)?))).collect();
    let made: Vec<_> = parallel::map(&both, |(at, tile, covered)| (*at, change(tile, covered)));
    made.into_iter().for_each(|(at, tile)| out.set(at, tile));
    out
}

/// A tile with each pixel times a share of its coverage.
fn multiply_tile(
    tile: &Arc<Tile>,
    covered: &CoverageTile,
    share: impl Fn(u8) -> u8,
) -> Option<Arc<Tile>> {
    if covered.is_whole() {
        return if share(255) == 255 { Some(tile.clone()) } else { None };
    }
    if tile.is_16_bit() {
        let mut rows = tile.to_rows16();
        for (row, covered) in rows.iter_mut().zip(covered.bytes().as_chunks::<TILE>().0) {
            for channel in row {
                // Rounded to nearest: at most 65535 · 255 + 127.
                let part = |(v, c): (&mut u16, &u8)| {
                    *v = ((u32::from(*v) * u32::from(share(*c)) + 127) / 255) as u16
                };
                channel.iter_mut().zip(covered).for_each(part);
            }
        }
        return Tile::from_rows16(rows).map(Arc::new);
    }
    let mut bytes = tile.bytes().to_vec();
    for (pixel, c) in bytes.as_chunks_mut::<4>().0.iter_mut().zip(covered.bytes()) {
        let share = share(*c);
        *pixel = pixel.map(|v| product(v, share));
    }
    Tile::from_pixels(bytes).map(Arc::new)
}

/// A stroke that paints only inside these as well.
fn narrowed(stroke: &Stroke, to: &CoverageGrid) -> Stroke {
    let own = match stroke.selection() {
        Some(own) => own.narrowed(to),
        None => StrokeSelection::new(Arc::new(Selection::new(to.clone()))),
    };
    stroke.selecting(Some(own))
}

impl Layer {
    /// A copy of it and of what is in it, under fresh ids.
    pub fn copy_with_fresh_ids(&self) -> Layer {
        with_fresh_ids(self)
    }
}

/// The same layer and those in it under fresh ids.
fn with_fresh_ids(layer: &Layer) -> Layer {
    let mut next = Layer { id: LayerId::fresh(), ..layer.clone() };
    if let Some(group) = next.content.group_mut() {
        group.layers = group.layers.iter().map(|inner| Arc::new(with_fresh_ids(inner))).collect();
    }
    next
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Progress, flatten};
    use crate::math::{Rect, Size, hash, srgb::Color, vec2};
    use crate::paint::{Brush, Sample};
    use crate::raster::Plane;
    use crate::surface::Operator;

    const SIZE: Size = Size::new(200, 150);

    fn layers() -> Document {
        let samples = |y: f32| [vec2(10.0, y), vec2(190.0, y)].map(Sample::at).to_vec();
        let brush = Brush { size: 30.0, ..Brush::default() };
        let stroke =
            |y| Arc::new(Stroke::new(brush.clone(), Operator::None, Color::BLACK, samples(y)));
        let strokes =
            Content::Strokes(Live::new(StrokeList { strokes: vec![stroke(30.0), stroke(120.0)] }));
        let rgba: Vec<u8> = (0..200 * 150 * 4).map(|i| hash::mix(i) as u8 | 1).collect();
        let tiles = TileGrid::from_straight_rgba(&rgba, 200, 150, 0, 0);
        let paint = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
        let fill = Content::Fill(Color { r: 9, g: 200, b: 30, a: 255 });
        let all = [("paint", paint), ("strokes", strokes), ("fill", fill)];
        let layers = all.map(|(name, content)| Arc::new(Layer::new(name, content))).to_vec();
        Document { layers, ..Document::empty(SIZE) }
    }

    /// One layer alone.
    fn shown(layer: &Layer) -> TileGrid {
        let document = Document { layers: vec![Arc::new(layer.clone())], ..Document::empty(SIZE) };
        flatten(&document, &Progress::default()).unwrap()
    }

    /// Soft, hard, and partly empty.
    fn covered() -> CoverageGrid {
        let plane =
            Plane::from_fn(
                SIZE,
                |x, y| if y < 80 { (x as i32 * 3 - 150).clamp(0, 255) as u8 } else { 0 },
            );
        CoverageGrid::from_plane(&plane, 0, 0)
    }

    #[test]
    fn what_is_copied_and_what_is_left_share_every_pixel_by_the_coverage() {
        let (document, covered) = (layers(), covered());
        for layer in &document.layers {
            let whole = shown(layer);
            let copied = shown(&document.copy_covered(layer.id, &covered).unwrap());
            let left = document.with_cleared(layer.id, &covered).unwrap();
            let left = shown(left.layer(layer.id).unwrap());
            for (x, y) in (0..200).step_by(3).flat_map(|x| (0..150).step_by(3).map(move |y| (x, y)))
            {
                let (alpha, share) =
                    (f32::from(whole.pixel(x, y)[3]), f32::from(covered.at(x, y)) / 255.0);
                let (a, b) = (f32::from(copied.pixel(x, y)[3]), f32::from(left.pixel(x, y)[3]));
                assert!(
                    (a - alpha * share).abs() <= 1.0,
                    "{} at {x}, {y}: {a} copied of {alpha}",
                    layer.name
                );
                assert!(
                    (b - alpha * (1.0 - share)).abs() <= 1.0,
                    "{} at {x}, {y}: {b} left of {alpha}",
                    layer.name
                );
            }
        }
    }

    #[test]
    fn only_the_strokes_that_meet_it_are_copied_and_the_others_stay_the_very_same() {
        let document = layers();
        let strokes = &document.layers[1];
        let top = CoverageGrid::full(Rect::new(0, 0, 200, 60));
        let copied = document.copy_covered(strokes.id, &top).unwrap();
        let Content::Strokes(live) = &copied.content else { panic!("strokes") };
        assert_eq!(live.params().strokes.len(), 1);
        let left = document.with_cleared(strokes.id, &top).unwrap();
        let (old, new) = (document.strokes(strokes.id), left.strokes(strokes.id));
        assert!(Arc::ptr_eq(&old[1], new.last().unwrap()));
        let nothing = CoverageGrid::full(Rect::new(0, 70, 200, 80));
        assert!(document.copy_covered(strokes.id, &nothing).is_none());
        let all = CoverageGrid::full(SIZE.rect());
        assert!(document.with_cleared(strokes.id, &all).unwrap().strokes(strokes.id).is_empty());
    }

    #[test]
    fn a_locked_layer_is_not_cut() {
        let document = layers();
        let id = document.layers[0].id;
        let locked = document.with_layer(id, |layer| layer.lock = LayerLock::All).unwrap();
        assert!(locked.with_cleared(id, &covered()).is_none());
    }
}
