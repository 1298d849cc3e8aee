//! The radiance-scaling layer: enhances everything beneath it in its group (RS eq. 3, MATH 5).
//! Floor 3. Not here: composing what lies beneath (`document::compose`).

mod row;

use super::{
    features::Features,
    scaling::{Reference, Scaling},
};
use crate::math::{Vec3, fast, srgb, vec3};
use crate::raster::planar::{BRIGHTEST, PixelRow};
use crate::raster::{PlanarTile, TILE, TileAt};
use crate::surface::{Scene, Surface};
use row::RowScaler;

/// The parameters of a radiance-scaling layer, an adjustment of what lies beneath it in its group.
///
/// δ = Y / Y*, Y the luminance of the composite in linear light; the linear color is multiplied by
/// σ(κ, δ).
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceScaling {
    /// σ: how strongly, and around which light.
    pub scaling: Scaling,
    /// The curvature that it follows.
    pub features: Features,
    /// ℓ, toward the light, camera space (y up): the direction that λ refers to. Any length but 0.
    pub light: Vec3,
    /// Y*.
    pub reference: Reference,
    /// Multiply by one more factor, the same everywhere, so that the mean luminance over the
    /// surface stays: a strong γ then alters the material less (RS sec. 6.2).
    pub keep_mean: bool,
}

impl Default for RadianceScaling {
    fn default() -> Self {
        Self {
            scaling: Scaling::new(Scaling::ALPHA, 1.0),
            features: Features::default(),
            light: vec3(0.3, 0.5, 0.8),
            reference: Reference::Auto,
            keep_mean: false,
        }
    }
}

/// What must be known about the whole composite beneath before a tile of it can be scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackdropStats {
    /// Its greatest luminance over the surface, linear light.
    pub brightest: f32,
    /// The factor that restores its mean luminance: [`LightSums::gain`]; 1 if the mean is not to be
    /// kept.
    pub gain: f32,
}

impl Default for BackdropStats {
    /// Of a picture that is not measured.
    fn default() -> Self {
        Self { brightest: 1.0, gain: 1.0 }
    }
}

/// How pixels are scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exactness {
    /// To within a quarter of a byte, and clipped at white.
    Fast,
    /// Without approximations, clipped at white.
    Exact,
    /// Light that is brighter than white stays so.
    ExactLight,
}

/// The number of factors of the light that are tried together.
const GAINS: usize = 12;

/// Even steps between two factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainLadder(pub [f32; GAINS]);

impl GainLadder {
    /// All plausible factors.
    pub fn whole() -> Self {
        Self::between(1.0 / 64.0, 64.0)
    }

    fn between(low: f32, high: f32) -> Self {
        Self(std::array::from_fn(|k| low * (high / low).powf(k as f32 / (GAINS - 1) as f32)))
    }
}

/// Luminance of a part of the composite, added up before scaling, and after it for each factor, as
/// shown: every channel clipped at 1. Add the parts in a fixed order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightSums {
    /// That of the picture as it is.
    pub before: f64,
    /// That of the scaled picture, for each gain.
    pub after: [f64; GAINS],
}

impl LightSums {
    /// The sums of both.
    pub fn plus(self, other: LightSums) -> LightSums {
        LightSums {
            before: self.before + other.before,
            after: std::array::from_fn(|k| self.after[k] + other.after[k]),
        }
    }

    /// The steps between which the light after equals that before: the index of the lower one, and
    /// how far beyond it.
    fn bracket(&self) -> Option<(usize, f32)> {
        let over = self.after.iter().position(|&after| after >= self.before)?;
        let low = over.checked_sub(1)?;
        let share = (self.before - self.after[low]) / (self.after[over] - self.after[low]);
        share.is_finite().then_some((low, share as f32))
    }

    /// Finer steps around the factor that keeps the light; `None` if none of these does.
    pub fn finer(&self, tried: GainLadder) -> Option<GainLadder> {
        let (low, _) = self.bracket()?;
        Some(GainLadder::between(tried.0[low], tried.0[low + 1]))
    }

    /// The factor that keeps the light as it was; 1 if none of these does.
    pub fn gain(&self, tried: GainLadder) -> f32 {
        let between =
            |(low, share): (usize, f32)| tried.0[low] + (tried.0[low + 1] - tried.0[low]) * share;
        self.bracket().map_or(1.0, between)
    }
}

impl RadianceScaling {
    /// Scales one tile of the composite. Alpha and hue stay, as does what is off the surface; γ = 0
    /// changes nothing.
    pub fn apply_tile(
        &self,
        scene: &Scene,
        at: TileAt,
        beneath: BackdropStats,
        pixels: &mut PlanarTile,
    ) {
        self.apply_at(scene, at, beneath, Exactness::Fast, pixels);
    }

    /// The same, as exactly as requested.
    pub fn apply_at(
        &self,
        scene: &Scene,
        at: TileAt,
        beneath: BackdropStats,
        exactness: Exactness,
        pixels: &mut PlanarTile,
    ) {
        let Some((mut scaler, gain)) = self.scaler(beneath, exactness) else { return };
        let rows = pixels.rows_mut();
        self.for_rows(scene, at, |y, kappa, coverage| {
            let Some(row) = rows.get_mut(y) else { return };
            if gain != 1.0 {
                // Off the surface the factor is 1.
                let mut gains = [1.0; TILE];
                gains
                    .iter_mut()
                    .zip(coverage)
                    .filter(|(_, c)| **c > 0)
                    .for_each(|(g, _)| *g = gain);
                scaler.apply_with_gains(row, kappa, &gains);
            } else {
                scaler.apply(row, kappa);
            }
        });
    }

    /// The same for rows of pixels that lie anywhere on a surface: `places` holds the place of each
    /// pixel, or that it is off it.
    pub fn apply_packed(
        &self,
        surface: &Surface,
        places: &[Option<(usize, usize)>],
        beneath: BackdropStats,
        exactness: Exactness,
        pixels: &mut PlanarTile,
    ) {
        let Some((mut scaler, gain)) = self.scaler(beneath, exactness) else { return };
        let features = self.features.on(surface);
        for (row, places) in pixels.rows_mut().iter_mut().zip(places.chunks_exact(TILE)) {
            let (mut kappa, mut gains) = ([0.0; TILE], [1.0; TILE]);
            for (x, place) in places.iter().enumerate() {
                if let Some((px, py)) = *place {
                    features.row_toward(px, py, self.light, &mut kappa[x..=x]);
                    gains[x] = gain;
                }
            }
            if gain == 1.0 {
                scaler.apply(row, &kappa)
            } else {
                scaler.apply_with_gains(row, &kappa, &gains)
            }
        }
    }

    /// What scales rows, and the factor that keeps the mean; `None` if nothing would change.
    fn scaler(&self, beneath: BackdropStats, exactness: Exactness) -> Option<(RowScaler, f32)> {
        let gain = if self.keep_mean { beneath.gain } else { 1.0 };
        if self.scaling.is_none() && gain == 1.0 {
            return None;
        }
        let y_star = self.reference.resolve(beneath.brightest);
        let scaler = match exactness {
            Exactness::Fast => RowScaler::new(self.scaling, y_star),
            Exactness::Exact => RowScaler::exact(self.scaling, y_star, 1.0),
            Exactness::ExactLight => RowScaler::exact(self.scaling, y_star, BRIGHTEST),
        };
        Some((scaler, gain))
    }

    /// Luminance of one tile before scaling, and after it with each factor, weighted by alpha and
    /// by how far the surface covers each pixel.
    pub fn means_tile(
        &self,
        scene: &Scene,
        at: TileAt,
        brightest: f32,
        pixels: &PlanarTile,
        tried: GainLadder,
    ) -> LightSums {
        let y_star = self.reference.resolve(brightest);
        let mut sums = LightSums::default();
        let mut light = RowLuminance { before: [0.0; TILE], after: [[0.0; TILE]; GAINS] };
        self.for_rows(scene, at, |y, kappa, coverage| {
            let Some(row) = pixels.rows().get(y) else { return };
            light_of_row(row, kappa, self.scaling, 1.0 / y_star, &tried.0, &mut light);
            let sum = |values: &[f32; TILE]| -> f64 {
                values
                    .iter()
                    .zip(coverage)
                    .map(|(&v, &coverage)| f64::from(coverage) * f64::from(v))
                    .sum()
            };
            sums.before += sum(&light.before);
            sums.after.iter_mut().zip(&light.after).for_each(|(all, row)| *all += sum(row));
        });
        sums
    }

    /// Calls with each row of the tile that meets the surface, κ along it (0 off the surface) and
    /// the surface's coverage.
    fn for_rows(
        &self,
        scene: &Scene,
        at: TileAt,
        mut with: impl FnMut(usize, &[f32; TILE], &[u8]),
    ) {
        let Some(surface) = scene.surface.as_deref() else { return };
        // The lattice of tiles begins at the canvas's corner, so a tile meets it from its own left
        // and top side on.
        let inside = at.rect().intersect(surface.size().rect());
        let columns = inside.x0 as usize..inside.x1 as usize;
        let features = self.features.on(surface);
        let mut kappa = [0.0; TILE];
        for (row, y) in (inside.y0 as usize..inside.y1 as usize).enumerate() {
            let coverage = &surface.coverage_plane().row(y)[columns.clone()];
            if y + 1 < inside.y1 as usize {
                // The next row lies a canvas's width away.
                features.prefetch(columns.start, y + 1, columns.len());
            }
            if coverage.iter().any(|&c| c > 0) {
                features.row_toward(columns.start, y, self.light, &mut kappa[..columns.len()]);
                with(row, &kappa, coverage);
            }
        }
    }
}

/// Alpha × luminance of each pixel of a row.
struct RowLuminance {
    before: [f32; TILE],
    after: [[f32; TILE]; GAINS],
}

crate::widest! {
    /// Alpha × luminance of each pixel, before scaling and after it with each factor, clipped as it
    /// is shown.
    fn light_of_row(
        row: &PixelRow,
        kappa: &[f32; TILE],
        scaling: Scaling,
        per_y_star: f32,
        gains: &[f32; GAINS],
        out: &mut RowLuminance,
    ) {
        let [mut red, mut green, mut blue] = [[0.0; TILE]; 3];
        for x in 0..TILE {
            let per_a = 1.0 / fast::max(row.a[x], f32::MIN_POSITIVE);
            let light = |v: f32| srgb::decode_fast(fast::min(v * per_a, 1.0));
            let (r, g, b) = (light(row.rgb[0][x]), light(row.rgb[1][x]), light(row.rgb[2][x]));
            let luminance = srgb::luminance(r, g, b);
            let sigma = scaling.sigma_fast(kappa[x], luminance * per_y_star);
            out.before[x] = row.a[x] * luminance;
            (red[x], green[x], blue[x]) = (r * sigma, g * sigma, b * sigma);
        }
        for (after, &gain) in out.after.iter_mut().zip(gains) {
            for x in 0..TILE {
                let shown = |v: f32| fast::min(v * gain, 1.0);
                after[x] = row.a[x] * srgb::luminance(shown(red[x]), shown(green[x]), shown(blue[x]));
            }
        }
    }
}

#[cfg(test)]
mod tests;
