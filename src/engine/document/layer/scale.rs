//! Layers on a canvas of another size: live ones change their coordinates and stay as sharp as the
//! new canvas, pixels and masks are resampled. Floor 4. Not here: the rest of a document
//! (`document::scale`).

mod resample;

use super::Layer;
use super::map::LayerMap;
use super::mask::{DerivedMask, MaskKind};
use super::transform::{LayerTransform, scaled_matrix};
use crate::math::srgb::{quantize, quantize16};
use crate::math::{PlaneMap, Rect, Size, Vec2, parallel, vec2};
use crate::paint::{LayerEffect, Placement, Sample, Selection, Stroke, StrokeAttachment};
use crate::raster::tile::sixteen_bit;
use crate::raster::warp::{warp_plane_onto, warp_tile};
use crate::raster::{Plane, Resampling, TILE, Tile, TileAt, TileGrid};
use crate::shading::Features;
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// Selections and their scaled versions, by the addresses of the old ones.
type ScaledSelections = HashMap<usize, (Arc<Selection>, Arc<Selection>)>;

/// From one canvas to another.
pub(in crate::document) struct CanvasScale {
    /// For coordinates; the two differ only because the canvas is rounded.
    pub per_axis: Vec2,
    /// For lengths without a direction.
    pub length: f32,
    pub from: Size,
    pub to: Size,
    /// Seen for a moment only: what is fine is read coarsely.
    is_draft: bool,
    /// How pixels are sampled; without one, by the mean over what they cover.
    filter: Option<Resampling>,
    /// Selections that were scaled, by their addresses.
    pub(in crate::document) selections: Mutex<ScaledSelections>,
}

impl CanvasScale {
    /// `None` where nothing is to be scaled.
    pub fn of(from: Size, factor: f32) -> Option<Self> {
        let to = from.scaled(factor);
        if !(factor.is_finite() && factor > 0.0) || to == from {
            return None;
        }
        let per_axis =
            vec2(to.width as f32 / from.width as f32, to.height as f32 / from.height as f32);
        Some(Self {
            per_axis,
            length: factor,
            from,
            to,
            is_draft: false,
            filter: None,
            selections: Mutex::default(),
        })
    }

    /// The same for a document that is seen for a moment only.
    pub fn for_a_moment(self) -> Self {
        Self { is_draft: true, ..self }
    }

    /// Whether it is for a document that is seen for a moment only.
    pub fn is_draft(&self) -> bool {
        self.is_draft
    }

    /// The placement of a picture of a given size, the same on the new canvas except for the
    /// aspect.
    pub fn on_new_canvas(&self, placement: &Placement, picture: Size) -> Placement {
        placement.on_canvas_of(self.from, self.to, picture)
    }

    /// How many of the finest levels of a picture need not be read, from the number of its texels
    /// under a new pixel.
    ///
    /// Antialiasing spends up to sixteen taps on a pixel before it reads a coarser level. So a
    /// pixel that covered four took twice as long as a pixel that covered one, and a pixel that
    /// covered sixteen three times.
    pub fn levels_to_skip(&self, texels_per_px: f32) -> u32 {
        // A canvas of an odd size shrinks slightly less.
        let (smaller, covered) = ((1.0 / self.length).log2(), texels_per_px.log2() + 0.1);
        // NaN and what is negative become 0.
        if self.is_draft { smaller.min(covered) as u32 } else { 0 }
    }

    pub fn onto(from: Size, to: Size, filter: Resampling) -> Option<Self> {
        let per_axis =
            vec2(to.width as f32 / from.width as f32, to.height as f32 / from.height as f32);
        let length = per_axis.element_product().sqrt();
        let is_some = to != from && to.area() > 0;
        let (filter, selections) = (Some(filter), Mutex::default());
        is_some.then_some(Self { per_axis, length, from, to, is_draft: false, filter, selections })
    }

    pub fn map(&self) -> PlaneMap {
        PlaneMap::scaling(self.from, self.to)
    }

    /// The sampler of pixels, if there is one, and the map that they are seen through.
    fn sampler(&self) -> Option<LayerMap> {
        let reach =
            Size::new(self.from.width.max(self.to.width), self.from.height.max(self.to.height));
        Some(LayerMap::of_plane(self.map(), self.filter?, reach))
    }

    /// An image that the change of the aspect stretches: its transform says so, as its placement
    /// cannot. `None` for other layers, and where a mask lies in the layer's frame.
    fn stretched(&self, layer: &Layer) -> Option<Layer> {
        let filter = self.filter?;
        let off_px = (self.per_axis.x / self.per_axis.y - 1.0).abs() * self.to.longer_side();
        let has_picture =
            layer.mask.as_ref().is_some_and(|mask| matches!(mask.kind, MaskKind::File { .. }));
        if off_px <= 1.5 || has_picture {
            return None;
        }
        let content = layer.content.stretched(self)?;
        if layer.is_warped() {
            return None;
        }
        let own =
            layer.transform.as_ref().map_or(Some(PlaneMap::IDENTITY), |own| own.map(self.from))?;
        let filter = layer.transform.as_ref().map_or(filter, |own| own.filter);
        let transform = Some(LayerTransform::of_map(&own.then(&self.map()), filter, self.to)?);
        let effects = self.effects(layer);
        Some(Layer { content, transform, effects, cache: Default::default(), ..layer.clone() })
    }

    pub fn layers(&self, layers: &[Arc<Layer>]) -> Vec<Arc<Layer>> {
        layers.iter().map(|layer| Arc::new(self.layer(layer))).collect()
    }

    pub fn layer(&self, layer: &Layer) -> Layer {
        self.layer_showing(layer, None)
    }

    /// The same with the content of another small layer, if it was scaled before.
    pub fn layer_showing(&self, layer: &Layer, known: Option<&Layer>) -> Layer {
        if let Some(stretched) = self.stretched(layer) {
            return stretched;
        }
        let scaled = || {
            let scaled = layer.content.scaled(self);
            if self.is_draft { scaled.drafted().unwrap_or(scaled) } else { scaled }
        };
        let content = known.map_or_else(scaled, |known| known.content.clone());
        let effects = self.effects(layer);
        let mut next = Layer { content, effects, cache: Default::default(), ..layer.clone() };
        let transform = layer.transform.as_ref().map(|transform| transform.scaled(self.per_axis));
        next.transform =
            transform.map(|transform| if self.is_draft { transform.drafted() } else { transform });
        next.liquify = layer.transformed_liquify(&self.map(), self.to);
        match next.mask.as_mut().map(|mask| &mut mask.kind) {
            Some(MaskKind::File { coverage, .. }) => *coverage = Arc::new(self.plane(coverage)),
            Some(MaskKind::Derived(DerivedMask::Curvature { scale, blur, .. })) => {
                (*scale, *blur) = (*scale * self.length, *blur * self.length)
            }
            Some(MaskKind::Derived(DerivedMask::Region(region))) => region.at *= self.per_axis,
            Some(MaskKind::Derived(DerivedMask::Fresnel { .. } | DerivedMask::Depth { .. }))
            | None => {}
        }
        next
    }

    fn effects(&self, layer: &Layer) -> Arc<Vec<LayerEffect>> {
        if layer.effects.is_empty() {
            return layer.effects.clone();
        }
        Arc::new(layer.effects.iter().map(|effect| effect.scaled(self.length)).collect())
    }

    /// Curvature is per pixel, so the factor it is multiplied by is a length.
    pub fn features(&self, features: &mut Features) {
        for scale in &mut features.scales {
            scale.curvature_scale_px *= self.length;
            scale.blur_px *= self.length;
        }
    }

    pub fn stroke(&self, stroke: &Stroke) -> Stroke {
        let samples =
            stroke.samples().iter().map(|s| Sample { at: s.at * self.per_axis, ..*s }).collect();
        let selection =
            stroke.selection().map(|own| own.scaled(self.selection(&own.selection), self.per_axis));
        let brush = stroke.brush().scaled(self.length);
        let attachment = |attachment: &Arc<StrokeAttachment>| {
            Arc::new(StrokeAttachment {
                own: scaled_matrix(attachment.own, self.per_axis),
                ..StrokeAttachment::clone(attachment)
            })
        };
        Stroke::new(brush, stroke.operator().scaled(self.length), stroke.color(), samples)
            .within(selection)
            .on(stroke.attachment().map(attachment))
    }

    pub fn grid(&self, grid: &TileGrid) -> TileGrid {
        let (mut next, tiles) = self.blank_grid(grid);
        self.fill_tiles(grid, &tiles, &mut next);
        next
    }

    /// The grid without its tiles, and which there may be.
    pub fn blank_grid(&self, grid: &TileGrid) -> (TileGrid, Vec<TileAt>) {
        let Rect { x0, y0, x1, y1 } = grid.bounds();
        let side = |v: i32, s: f32| f64::from(v) * f64::from(s);
        let bounds = Rect::new(
            side(x0, self.per_axis.x).floor() as i32,
            side(y0, self.per_axis.y).floor() as i32,
            side(x1, self.per_axis.x).ceil() as i32,
            side(y1, self.per_axis.y).ceil() as i32,
        );
        (TileGrid::for_rect(bounds), TileAt::covering(bounds).collect())
    }

    /// Resamples some of the tiles.
    pub fn fill_tiles(&self, grid: &TileGrid, tiles: &[TileAt], next: &mut TileGrid) {
        let sampler = self.sampler();
        let tile = |&at: &TileAt| match &sampler {
            Some(sampler) => warp_tile(grid, sampler, sampler.filter, at),
            None => self.tile(grid, at).map(Arc::new),
        };
        let resampled: Vec<Option<Arc<Tile>>> = parallel::map(tiles, tile);
        tiles.iter().zip(resampled).for_each(|(&at, tile)| next.set(at, tile));
    }

    /// One tile of a grid resampled: premultiplied values as they are stored, averaged.
    fn tile(&self, grid: &TileGrid, at: TileAt) -> Option<Tile> {
        let rect = at.rect();
        let columns = resample::AxisTaps::new(rect.x0..rect.x1, self.per_axis.x);
        let rows: Vec<_> = (rect.y0..rect.y1).map(|y| source_weights(y, self.per_axis.y)).collect();
        let (first, last) = (rows.first()?.first()?.0, rows.last()?.last()?.0);
        let source = Rect::new(columns.first(), first, columns.end(), last + 1);
        // Most layers lack most tiles.
        if TileAt::covering(source).all(|at| grid.tile(at).is_none()) {
            return None;
        }
        let sums = |taps: &[(i32, f32)], row: &mut [[f32; 4]]| {
            let mut sums = [[0.0; 4]; TILE];
            for &(y, weight) in taps {
                grid.copy_row(source.x0, y, row);
                resample::add_row(&columns, weight, row, &mut sums);
            }
            sums
        };
        let mut row = vec![[0.0; 4]; source.width()];
        if grid.is_16_bit_at(source) {
            let mut pixels = sixteen_bit::clear_rows();
            for (pixels, taps) in pixels.iter_mut().zip(&rows) {
                let levels = sums(taps, &mut row).into_iter().enumerate();
                levels.for_each(|(x, v)| {
                    sixteen_bit::put(pixels, x, v.map(|v| quantize16(v / 255.0)))
                });
            }
            return Tile::from_rows16(pixels);
        }
        let mut bytes = Vec::with_capacity(TILE * TILE * 4);
        for taps in &rows {
            bytes.extend(sums(taps, &mut row).as_flattened().iter().map(|v| quantize(v / 255.0)));
        }
        bytes.chunks_exact(4).any(|p| p[3] > 0).then(|| Tile::from_bytes(bytes)).flatten()
    }

    /// A map of the canvas, resampled; its border is continued beyond it.
    pub fn plane(&self, plane: &Plane<u8>) -> Plane<u8> {
        // Pictures of parts may have a size of their own.
        let side = |v: u32, s: f32| ((f64::from(v) * f64::from(s)).ceil() as u32).max(1);
        let own = Size::new(
            side(plane.size().width, self.per_axis.x),
            side(plane.size().height, self.per_axis.y),
        );
        let to = if plane.size() == self.from { self.to } else { own };
        if let Some(sampler) = self.sampler() {
            return warp_plane_onto(plane, &sampler, sampler.filter, to);
        }
        let columns: Vec<_> =
            (0..to.width as i32).map(|x| source_weights(x, self.per_axis.x)).collect();
        let rows: Vec<_> =
            (0..to.height as i32).map(|y| source_weights(y, self.per_axis.y)).collect();
        Plane::from_fn(to, |x, y| {
            let of_row = |&(py, wy): &(i32, f32)| {
                columns[x]
                    .iter()
                    .map(|&(px, wx)| wx * wy * f32::from(plane.at_clamped(px, py)))
                    .sum::<f32>()
            };
            quantize(rows[y].iter().map(of_row).sum::<f32>() / 255.0)
        })
    }
}

/// The old pixels under a new one along one axis, and their weights, which add up to 1: the mean
/// over what it covers, at least one old pixel wide, which is linear interpolation when scaling up.
pub(in crate::document) fn source_weights(i: i32, scale: f32) -> Vec<(i32, f32)> {
    let center = (f64::from(i) + 0.5) / f64::from(scale);
    let half = (0.5 / f64::from(scale)).max(0.5);
    let (low, high) = (center - half, center + half);
    let share = |p: i32| (high.min(f64::from(p) + 1.0) - low.max(f64::from(p))) / (2.0 * half);
    let pixels = low.floor() as i32..high.ceil() as i32;
    pixels.map(|p| (p, share(p) as f32)).filter(|&(_, weight)| weight > 1e-6).collect()
}
