//! Scales a document to another resolution: for a quick preview, or for a larger print of live layers. Floor 4. Live
//! layers change their coordinates and stay as sharp as the new canvas; pixels, masks and maps are resampled.

mod reducer;
mod resample;
mod selections;

pub use reducer::{DocumentReducer, ReducedSurface, SurfaceReduction};

use super::cache::LayerCache;
use super::warp::carried_liquify;
use super::{
    Content, DerivedMask, DetailSource, Document, Layer, LayerMap, LayerTransform, Live, MaskKind, NormalLayer, Part,
    PixelLayer, canvas_change, transform,
};
use crate::math::{PlaneMap, Rect, Size, Vec2, srgb::quantise, vec2};
use crate::paint::{Sample, Selection, Stroke, StrokeHome};
use crate::raster::warp::{warped, warped_plane_onto};
use crate::raster::{Plane, Resampling, TILE, Tile, TileAt, TileGrid};
use crate::shading::Features;
use crate::surface::SurfaceError;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

impl Document {
    /// The same picture on a canvas `factor` times as large, its sides rounded. Layers keep their ids.
    ///
    /// `factor`: finite and `> 0`, else the document is returned unchanged. The caller must check that the result fits
    /// the memory. Fails if nothing is left of a surface thinner than the new pixels.
    pub fn scaled(&self, factor: f32) -> Result<Document, SurfaceError> {
        let Some(scale) = CanvasScale::of(self.size, factor) else { return Ok(self.clone()) };
        let surface = self.surface.as_ref().map(|s| s.stretched(scale.to).map(Arc::new)).transpose()?;
        let layers = scale.layers(&self.layers);
        let guides = Arc::new(self.guides.scaled(scale.per_axis));
        let assistants = Arc::new(self.assistants.iter().map(|assistant| assistant.scaled(scale.per_axis)).collect());
        let scaled = Document { size: scale.to, surface, layers, guides, assistants, ..scale.selected(self) };
        let shaped = if self.parts.is_empty() { scaled } else { scale.parts(self, scaled)? };
        Ok(shaped.with_selections_found())
    }
}

impl Document {
    /// The same picture on a canvas of `to`'s size, its paint sampled for good; the aspect may be another one. Live
    /// layers change their numbers, images their transforms where the aspect changes. Layers keep their ids.
    ///
    /// The caller must check that the result fits the memory. Fails if nothing is left of a surface thinner than the
    /// new pixels.
    pub fn resampled(&self, to: Size, filter: Resampling) -> Result<Document, SurfaceError> {
        let Some(scale) = CanvasScale::onto(self.size, to, filter) else { return Ok(self.clone()) };
        let maps = self.maps_surface().map(|maps| maps.through(to, &scale.map())).transpose()?;
        let source = self.surface_source.as_ref().zip(maps.as_ref());
        let scaled = Document {
            size: to,
            surface_source: source.map(|(source, maps)| Arc::new(canvas_change::placed(source, maps, to))),
            surface: maps,
            parts: Arc::default(),
            layers: scale.layers(&self.layers),
            guides: Arc::new(self.guides.scaled(scale.per_axis)),
            assistants: Arc::new(self.assistants.iter().map(|own| own.scaled(scale.per_axis)).collect()),
            ..scale.selected(self)
        };
        let part = |part: &Arc<Part>| scale.part(part);
        let shaped = match self.parts.is_empty() {
            true => scaled,
            false => scaled.with_parts(self.parts.list.iter().map(part).collect()),
        };
        Ok(shaped.with_selections_found())
    }
}

/// Selections and what became of them, by the addresses of the old ones.
type ScaledSelections = HashMap<usize, (Arc<Selection>, Arc<Selection>)>;

/// From one canvas to another.
pub(super) struct CanvasScale {
    /// For coordinates; the two differ only because the canvas is rounded.
    pub per_axis: Vec2,
    /// For lengths without a direction.
    pub length: f32,
    from: Size,
    to: Size,
    /// Seen for a moment only: what is fine is read coarsely.
    is_draft: bool,
    /// How pixels are sampled; by the mean over what they cover without one.
    filter: Option<Resampling>,
    /// Selections that were scaled, by their addresses.
    selections: Mutex<ScaledSelections>,
}

impl CanvasScale {
    /// `None` where nothing is to be scaled.
    fn of(from: Size, factor: f32) -> Option<Self> {
        let to = from.scaled(factor);
        if !(factor.is_finite() && factor > 0.0) || to == from {
            return None;
        }
        let per_axis = vec2(to.width as f32 / from.width as f32, to.height as f32 / from.height as f32);
        Some(Self { per_axis, length: factor, from, to, is_draft: false, filter: None, selections: Mutex::default() })
    }
    /// The same of a document that is seen for a moment only.
    fn for_a_moment(self) -> Self {
        Self { is_draft: true, ..self }
    }
    /// The new canvas.
    pub fn to(&self) -> Size {
        self.to
    }
    /// How many of the finest levels of a picture need not be read, so many of whose texels lie under a new pixel.
    ///
    /// Antialiasing spends up to sixteen taps on a pixel before it reads a coarser level. So a pixel that covered four
    /// took twice as long as one of them, and one that covered sixteen three times.
    pub fn levels_to_skip(&self, texels_per_px: f32) -> u32 {
        // A canvas of an odd size is not quite so much smaller.
        let (smaller, covered) = ((1.0 / self.length).log2(), texels_per_px.log2() + 0.1);
        // NaN and what is negative become 0.
        if self.is_draft { smaller.min(covered) as u32 } else { 0 }
    }
    fn onto(from: Size, to: Size, filter: Resampling) -> Option<Self> {
        let per_axis = vec2(to.width as f32 / from.width as f32, to.height as f32 / from.height as f32);
        let length = per_axis.element_product().sqrt();
        let is_some = to != from && to.area() > 0;
        let (filter, selections) = (Some(filter), Mutex::default());
        is_some.then_some(Self { per_axis, length, from, to, is_draft: false, filter, selections })
    }
    fn map(&self) -> PlaneMap {
        let side = |to: u32, from: u32| f64::from(to) / f64::from(from);
        let (x, y) = (side(self.to.width, self.from.width), side(self.to.height, self.from.height));
        PlaneMap::affine([x, 0.0, 0.0, y, 0.0, 0.0]).unwrap_or_default()
    }
    /// The sampler of pixels, where there is one, and what they are seen through.
    fn sampler(&self) -> Option<LayerMap> {
        let reach = Size::new(self.from.width.max(self.to.width), self.from.height.max(self.to.height));
        Some(LayerMap::of_plane(self.map(), self.filter?, reach))
    }
    /// An image that the change of the aspect stretches, which its placement cannot say: by its transform. `None` of
    /// other layers, and where a mask lies in the layer's frame.
    fn stretched(&self, layer: &Layer) -> Option<Layer> {
        let filter = self.filter?;
        let off_px = (self.per_axis.x / self.per_axis.y - 1.0).abs() * self.to.longer_side();
        let has_picture = layer.mask.as_ref().is_some_and(|mask| matches!(mask.kind, MaskKind::File { .. }));
        if off_px <= 1.5 || has_picture {
            return None;
        }
        let content = match &layer.content {
            Content::Image(live) => {
                let mut image = live.params().clone();
                image.placement = image.placement.on_canvas_of(self.from, self.to, image.source.picture.size);
                let longer = self.length * self.from.longer_side() / self.to.longer_side();
                image.bend.operator = image.bend.operator.scaled(self.length).on_canvas_of(longer);
                Content::Image(Live::new(image))
            }
            Content::Normals(normals) => {
                let DetailSource::Map { map, .. } = &normals.source else { return None };
                let placement = normals.placement.on_canvas_of(self.from, self.to, map.size());
                Content::Normals(NormalLayer { placement, ..normals.clone() })
            }
            _ => return None,
        };
        if layer.is_warped() {
            return None;
        }
        let own = layer.transform.as_ref().map_or(Some(PlaneMap::IDENTITY), |own| own.map(self.from))?;
        let filter = layer.transform.as_ref().map_or(filter, |own| own.filter);
        let transform = Some(LayerTransform::of_map(&own.then(&self.map()), filter, self.to)?);
        Some(Layer { content, transform, cache: LayerCache::default(), ..layer.clone() })
    }
    /// Parts with their lengths scaled, and the surface that they make on the new canvas.
    fn parts(&self, old: &Document, new: Document) -> Result<Document, SurfaceError> {
        let list = old.parts.list.iter().map(|part| self.part(part)).collect();
        let maps = old.maps_surface().map(|maps| maps.stretched(self.to).map(Arc::new)).transpose()?;
        let bare = Document { surface: maps, parts: Arc::default(), ..new };
        Ok(bare.with_parts(list))
    }
    fn part(&self, part: &Part) -> Arc<Part> {
        Arc::new(part.scaled(self.per_axis, self.length, |plane| self.plane(plane)))
    }
    pub fn layers(&self, layers: &[Arc<Layer>]) -> Vec<Arc<Layer>> {
        layers.iter().map(|layer| Arc::new(self.layer(layer))).collect()
    }
    fn layer(&self, layer: &Layer) -> Layer {
        if let Some(stretched) = self.stretched(layer) {
            return stretched;
        }
        let scaled = layer.content.scaled(self);
        let drafted = if self.is_draft { scaled.drafted() } else { None };
        let mut next = Layer { content: drafted.unwrap_or(scaled), cache: LayerCache::default(), ..layer.clone() };
        next.transform = layer.transform.as_ref().map(|transform| transform.scaled(self.per_axis));
        next.liquify = carried_liquify(layer, &self.map(), self.to);
        match next.mask.as_mut().map(|mask| &mut mask.kind) {
            Some(MaskKind::File { coverage, .. }) => *coverage = Arc::new(self.plane(coverage)),
            Some(MaskKind::Derived(DerivedMask::Curvature { scale, blur, .. })) => {
                (*scale, *blur) = (*scale * self.length, *blur * self.length)
            }
            Some(MaskKind::Derived(DerivedMask::Region(region))) => region.at *= self.per_axis,
            Some(MaskKind::Derived(DerivedMask::Fresnel { .. } | DerivedMask::Depth { .. })) | None => {}
        }
        next
    }
    /// Curvature is per pixel, so the factor it is multiplied by is a length.
    pub fn features(&self, features: &mut Features) {
        for scale in &mut features.scales {
            scale.curvature_scale_px *= self.length;
            scale.blur_px *= self.length;
        }
    }
    pub fn stroke(&self, stroke: &Stroke) -> Stroke {
        let samples = stroke.samples().iter().map(|s| Sample { at: s.at * self.per_axis, ..*s }).collect();
        let selection = stroke.selection().map(|own| own.scaled(self.selection(&own.selection), self.per_axis));
        let brush = stroke.brush().scaled(self.length);
        let home = |home: &Arc<StrokeHome>| {
            Arc::new(StrokeHome { own: transform::scaled(home.own, self.per_axis), ..StrokeHome::clone(home) })
        };
        Stroke::new(brush, stroke.operator().scaled(self.length), stroke.color(), samples)
            .within(selection)
            .on(stroke.home().map(home))
    }
    pub fn pixels(&self, pixels: &PixelLayer) -> PixelLayer {
        let corner = vec2(pixels.x as f32, pixels.y as f32) * self.per_axis;
        let (x, y) = (corner.x.round() as i32, corner.y.round() as i32);
        PixelLayer { file: pixels.file.clone(), x, y, tiles: self.grid(&pixels.tiles) }
    }
    fn grid(&self, grid: &TileGrid) -> TileGrid {
        let Rect { x0, y0, x1, y1 } = grid.bounds();
        let side = |v: i32, s: f32| f64::from(v) * f64::from(s);
        let bounds = Rect::new(
            side(x0, self.per_axis.x).floor() as i32,
            side(y0, self.per_axis.y).floor() as i32,
            side(x1, self.per_axis.x).ceil() as i32,
            side(y1, self.per_axis.y).ceil() as i32,
        );
        let tiles: Vec<TileAt> = TileAt::covering(bounds).collect();
        if let Some(sampler) = self.sampler() {
            return warped(grid, &sampler, sampler.filter, &tiles);
        }
        let resampled: Vec<Option<Tile>> = tiles.par_iter().map(|&at| self.tile(grid, at)).collect();
        let mut next = TileGrid::for_rect(bounds);
        tiles.into_iter().zip(resampled).for_each(|(at, tile)| next.set(at, tile.map(Arc::new)));
        next
    }
    /// One tile of a grid resampled: premultiplied values as they are stored, averaged.
    fn tile(&self, grid: &TileGrid, at: TileAt) -> Option<Tile> {
        let rect = at.rect();
        let columns = resample::AxisTaps::new(rect.x0..rect.x1, self.per_axis.x);
        let rows: Vec<_> = (rect.y0..rect.y1).map(|y| covered(y, self.per_axis.y)).collect();
        let (first, last) = (rows.first()?.first()?.0, rows.last()?.last()?.0);
        let source = Rect::new(columns.first(), first, columns.end(), last + 1);
        // Most tiles of most layers are not there.
        if TileAt::covering(source).all(|at| grid.tile(at).is_none()) {
            return None;
        }
        let mut bytes = Vec::with_capacity(TILE * TILE * 4);
        let mut row = vec![[0; 4]; source.width()];
        for taps in &rows {
            let mut sums = [[0.0; 4]; TILE];
            for &(y, weight) in taps {
                grid.copy_row(source.x0, y, &mut row);
                resample::add_row(&columns, weight, &row, &mut sums);
            }
            bytes.extend(sums.as_flattened().iter().map(|v| quantise(v / 255.0)));
        }
        bytes.chunks_exact(4).any(|p| p[3] > 0).then(|| Tile::from_bytes(bytes)).flatten()
    }
    /// A map of the canvas resampled; its border continues beyond it.
    fn plane(&self, plane: &Plane<u8>) -> Plane<u8> {
        // Pictures of parts may have a size of their own.
        let side = |v: u32, s: f32| ((f64::from(v) * f64::from(s)).ceil() as u32).max(1);
        let own = Size::new(side(plane.size().width, self.per_axis.x), side(plane.size().height, self.per_axis.y));
        let to = if plane.size() == self.from { self.to } else { own };
        if let Some(sampler) = self.sampler() {
            return warped_plane_onto(plane, &sampler, sampler.filter, to);
        }
        let columns: Vec<_> = (0..to.width as i32).map(|x| covered(x, self.per_axis.x)).collect();
        let rows: Vec<_> = (0..to.height as i32).map(|y| covered(y, self.per_axis.y)).collect();
        Plane::from_fn(to, |x, y| {
            let of_row = |&(py, wy): &(i32, f32)| {
                columns[x].iter().map(|&(px, wx)| wx * wy * f32::from(plane.clamped(px, py))).sum::<f32>()
            };
            quantise(rows[y].iter().map(of_row).sum::<f32>() / 255.0)
        })
    }
}

/// The old pixels under a new one along one axis, and their weights, which add up to 1: the mean over what it covers,
/// at least one old pixel wide, which is linear interpolation when scaling up.
fn covered(i: i32, scale: f32) -> Vec<(i32, f32)> {
    let center = (f64::from(i) + 0.5) / f64::from(scale);
    let half = (0.5 / f64::from(scale)).max(0.5);
    let (low, high) = (center - half, center + half);
    let share = |p: i32| (high.min(f64::from(p) + 1.0) - low.max(f64::from(p))) / (2.0 * half);
    let pixels = low.floor() as i32..high.ceil() as i32;
    pixels.map(|p| (p, share(p) as f32)).filter(|&(_, weight)| weight > 1e-6).collect()
}

#[cfg(test)]
mod tests;
