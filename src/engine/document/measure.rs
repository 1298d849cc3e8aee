//! Measures what an adjustment must know about the whole composite beneath it before one tile can
//! be adjusted. Floor 4. Tiles are measured in parallel and added up in their order, so the figures
//! do not depend on the threads.

use super::compose::{ComposeFlow, Composer};
use super::layer::adjustment::BackdropMeter;
use super::prepare::{AdjustmentLayer, PreparedDocument};
use super::progress::in_parallel;
use super::{Progress, Role};
use crate::math::fast;
use crate::math::srgb::{decode, decode_fast, luminance};
use crate::raster::{PlanarTile, TILE, TileAt, planar::PixelRow};
use crate::shading::RadianceScaling;
use crate::shading::radiance::{BackdropStats, GainLadder, LightSums};
use crate::surface::Scene;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// What lies beneath an adjustment in its scope. The adjustments beneath it are measured already.
struct Meter<'a> {
    prepared: &'a PreparedDocument,
    adjusted: &'a AdjustmentLayer,
    progress: &'a Progress,
}

impl PreparedDocument {
    /// Measures what lies beneath the next adjustment, or takes it from the cache; `None` if
    /// canceled.
    pub(super) fn measure(
        &self,
        adjusted: &AdjustmentLayer,
        progress: &Progress,
    ) -> Option<BackdropStats> {
        match adjusted.layer.content.role() {
            Role::Adjusts(adjustment) => {
                adjustment.measure(&Meter { prepared: self, adjusted, progress })
            }
            _ => Some(BackdropStats::default()),
        }
    }
}

impl BackdropMeter for Meter<'_> {
    fn brightest(&self) -> Option<f32> {
        let AdjustmentLayer { layer, scene, beneath, .. } = self.adjusted;
        layer.cache.brightest.get(scene, beneath, &(), || self.measure_brightest())
    }

    fn gain(&self, scaling: &RadianceScaling, brightest: f32) -> Option<f32> {
        let AdjustmentLayer { layer, scene, beneath, .. } = self.adjusted;
        layer.cache.gain.get(scene, beneath, scaling, || self.measure_gain(scaling, brightest))
    }
}

impl Meter<'_> {
    fn measure_brightest(&self) -> Option<f32> {
        // A tile that cannot be brighter than one already measured is skipped; the greatest is
        // found in any order. Luminance is not negative, so floats compare like their bits.
        let known = AtomicU32::new(0);
        let of_tile = |at| {
            let most = f32::from_bits(known.load(Relaxed));
            let found = self
                .tile(at)
                .map_or(0.0, |pixels| brightest(&pixels, &self.adjusted.scene, at, most));
            known.fetch_max(found.to_bits(), Relaxed);
            found
        };
        let tiles = in_parallel(&self.filtered_tiles()?, self.progress, of_tile)?;
        Some(tiles.into_iter().fold(0.0, f32::max))
    }

    fn measure_gain(&self, scaling: &RadianceScaling, brightest: f32) -> Option<f32> {
        let sums = |tried: GainLadder| {
            let of_tile = |at| {
                let means = |pixels| {
                    scaling.means_tile(&self.adjusted.scene, at, brightest, &pixels, tried)
                };
                self.tile(at).map(means).unwrap_or_default()
            };
            let tiles = in_parallel(&self.filtered_tiles()?, self.progress, of_tile)?;
            Some(tiles.into_iter().fold(LightSums::default(), LightSums::plus))
        };
        // What is shown is clipped, so it does not grow with the factor: coarse steps, then finer
        // ones.
        let Some(finer) = sums(GainLadder::whole())?.finer(GainLadder::whole()) else {
            return Some(1.0);
        };
        Some(sums(finer)?.gain(finer))
    }

    /// All tiles, after the filters beneath.
    fn filtered_tiles(&self) -> Option<Vec<TileAt>> {
        let (tiles, below) = (self.prepared.all_tiles(), self.prepared.beneath.len());
        self.prepared.filter_beneath(&tiles, below, None, self.progress)?;
        Some(tiles)
    }

    /// One tile of it.
    fn tile(&self, at: TileAt) -> Option<PlanarTile> {
        let sought = Some(self.prepared.beneath.len());
        let composer = Composer { prepared: self.prepared, at, far: None, sought, floats: None };
        match composer.stack(&self.prepared.stack, &mut PlanarTile::transparent()) {
            ComposeFlow::Break(beneath) => Some(beneath),
            ComposeFlow::Continue(()) => None,
        }
    }
}

/// The greatest luminance (Rec. 709, linear light, straight color) of a tile, over the surface
/// where there is one.
///
/// Pixels less than half covered, by paint or by surface, do not count: their straight colors are
/// mostly rounding. 0 if a quick test shows that the tile has none above `known`.
fn brightest(pixels: &PlanarTile, scene: &Scene, at: TileAt, known: f32) -> f32 {
    if bound(pixels.rows()) <= known {
        return 0.0;
    }
    let inside = at.rect().intersect(scene.size.rect());
    let mut most = [0.0; TILE];
    for (row, y) in pixels.rows().iter().zip(inside.y0..inside.y1) {
        // Beyond the canvas nothing counts.
        let mut covers = [0; TILE];
        match scene.surface.as_deref() {
            Some(surface) => {
                let coverage = surface.coverage_plane().row(y as usize);
                let here = inside.x0 as usize..(inside.x1 as usize).min(coverage.len());
                covers
                    .iter_mut()
                    .zip(coverage.get(here).unwrap_or_default())
                    .for_each(|(c, &coverage)| *c = coverage);
            }
            None => covers[..inside.width().min(TILE)].fill(255),
        }
        raise_to_brightest(row, &covers, &mut most);
    }
    most.into_iter().fold(0.0, f32::max)
}

/// An upper bound of all pixels' luminance: that of the greatest red, green and blue.
fn bound(rows: &[PixelRow]) -> f32 {
    let mut most = [[0.0; TILE]; 3];
    rows.iter().for_each(|row| raise_to_channels(row, &mut most));
    let [r, g, b] = most.map(|column| column.into_iter().fold(0.0, f32::max));
    luminance(decode(r), decode(g), decode(b)) * (1.0 + DECODE_ERROR)
}

/// More than the relative error of [`decode_fast`].
const DECODE_ERROR: f32 = 1e-3;

crate::widest! {
    /// Raises each column's red, green and blue to a row's straight ones.
    fn raise_to_channels(row: &PixelRow, most: &mut [[f32; TILE]; 3]) {
        let mut per_a = [0.0; TILE];
        for (per_a, &a) in per_a.iter_mut().zip(&row.a) {
            *per_a = 1.0 / fast::max(a, 0.5);
        }
        for (most, channel) in most.iter_mut().zip(&row.rgb) {
            for x in 0..TILE {
                fast::raise(&mut most[x], fast::min(channel[x] * per_a[x], 1.0));
            }
        }
    }

    /// Raises each column's value to the luminance of its pixel in a row, where that counts.
    fn raise_to_brightest(row: &PixelRow, covers: &[u8; TILE], most: &mut [f32; TILE]) {
        for x in 0..TILE {
            let per_a = 1.0 / fast::max(row.a[x], 0.5);
            let light = |v: f32| decode_fast(fast::min(v * per_a, 1.0));
            let luminance = luminance(light(row.rgb[0][x]), light(row.rgb[1][x]), light(row.rgb[2][x]));
            let counts = row.a[x] >= 0.5 && covers[x] >= 128;
            fast::raise(&mut most[x], if counts { luminance } else { 0.0 });
        }
    }
}
