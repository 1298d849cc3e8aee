//! The radiance-scaling layer: enhances everything beneath it in its group (RS eq. 3, MATH 5). Floor 3. Not here:
//! composing what lies beneath (`document::compose`).

mod row;

use super::{
    features::Features,
    scaling::{Reference, Scaling},
};
use crate::math::{Vec3, fast, srgb, vec3};
use crate::raster::{PlanarTile, TILE, TileAt, planar::PixelRow};
use crate::surface::Scene;
use row::RowScaler;

/// The parameters of a radiance-scaling layer, an adjustment of what lies beneath it in its group.
///
/// δ = Y / Y*, Y the luminance of the composite in linear light; the linear colour is multiplied by σ(κ, δ).
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceScaling {
    pub scaling: Scaling,
    pub features: Features,
    /// ℓ, toward the light, camera space (y up): the direction that λ refers to. Any length but 0.
    pub light: Vec3,
    /// Y*.
    pub reference: Reference,
    /// Multiply by one more factor, the same everywhere, so that the mean luminance over the surface stays: a strong γ
    /// then alters the material less (RS sec. 6.2).
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

/// What must be known about the whole composite beneath before one tile of it can be scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackdropStats {
    /// Its greatest luminance over the surface, linear light.
    pub brightest: f32,
    /// The factor that restores its mean luminance: [`LuminanceSums::gain`]; 1 if the mean need not be kept.
    pub gain: f32,
}

/// Luminance of a part of the composite, added up before and after scaling. Add the parts in a fixed order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LuminanceSums {
    pub before: f64,
    pub after: f64,
}

impl LuminanceSums {
    pub fn plus(self, other: LuminanceSums) -> LuminanceSums {
        LuminanceSums { before: self.before + other.before, after: self.after + other.after }
    }
    /// The factor of the light that brings `after` back to `before`, within reason.
    pub fn gain(self) -> f32 {
        let gain = self.before / self.after;
        if gain.is_finite() { (gain as f32).max(1.0 / 64.0).min(64.0) } else { 1.0 }
    }
}

impl RadianceScaling {
    /// Scales one tile of the composite. Alpha and hue stay, as does what is off the surface; γ = 0 changes nothing.
    pub fn apply_tile(&self, scene: &Scene, at: TileAt, beneath: BackdropStats, pixels: &mut PlanarTile) {
        let gain = if self.keep_mean { beneath.gain } else { 1.0 };
        if self.scaling.is_none() && gain == 1.0 {
            return;
        }
        let y_star = self.reference.resolve(beneath.brightest);
        let rows = pixels.rows_mut();
        let mut scaler = RowScaler::new(self.scaling, y_star);
        self.for_rows(scene, at, |y, kappa, coverage| {
            let Some(row) = rows.get_mut(y) else { return };
            if gain != 1.0 {
                // Off the surface the factor is 1.
                let mut gains = [1.0; TILE];
                gains.iter_mut().zip(coverage).for_each(|(g, &c)| *g += (gain - 1.0) * f32::from(c) / 255.0);
                scaler.apply_with_gains(row, kappa, &gains);
            } else {
                scaler.apply(row, kappa);
            }
        });
    }
    /// Luminance of one tile before and after scaling, weighed by alpha and by how far the surface covers each pixel.
    pub fn means_tile(&self, scene: &Scene, at: TileAt, brightest: f32, pixels: &PlanarTile) -> LuminanceSums {
        let y_star = self.reference.resolve(brightest);
        let mut means = LuminanceSums::default();
        self.for_rows(scene, at, |y, kappa, coverage| {
            let Some(row) = pixels.rows().get(y) else { return };
            let [before, after] = light_of_row(row, kappa, self.scaling, 1.0 / y_star);
            for ((&before, &after), &coverage) in before.iter().zip(&after).zip(coverage) {
                means.before += f64::from(coverage) * f64::from(before);
                means.after += f64::from(coverage) * f64::from(after);
            }
        });
        means
    }
    /// Calls with each row of the tile that meets the surface, κ along it (0 off the surface) and the surface's
    /// coverage.
    fn for_rows(&self, scene: &Scene, at: TileAt, mut with: impl FnMut(usize, &[f32; TILE], &[u8])) {
        let Some(surface) = scene.surface.as_deref() else { return };
        // The lattice of tiles begins at the canvas's corner, so a tile meets it from its own left and top side on.
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

crate::widest! {
    /// Alpha × luminance of each pixel, before and after scaling.
    fn light_of_row(row: &PixelRow, kappa: &[f32; TILE], scaling: Scaling, per_y_star: f32) -> [[f32; TILE]; 2] {
        let [mut before, mut after] = [[0.0; TILE]; 2];
        for x in 0..TILE {
            let per_a = 1.0 / fast::max(row.a[x], f32::MIN_POSITIVE);
            let light = |v: f32| srgb::decode_fast(fast::min(v * per_a, 1.0));
            let luminance = srgb::luminance(light(row.rgb[0][x]), light(row.rgb[1][x]), light(row.rgb[2][x]));
            before[x] = row.a[x] * luminance;
            after[x] = before[x] * scaling.sigma_fast(kappa[x], luminance * per_y_star);
        }
        [before, after]
    }
}

#[cfg(test)]
mod tests;
