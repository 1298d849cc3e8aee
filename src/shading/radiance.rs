//! The radiance-scaling layer: enhances whatever was painted beneath it in its group (RS eq. 3, MATH 5).
//! Floor 3. Not here: finding what lies beneath (`document::flatten`).

use super::{
    features::{FeatureMap, Features},
    scaling::{Reference, Scaling},
};
use crate::math::{Vec3, fast, srgb, vec3};
use crate::raster::{PlanarTile, TILE, TileAt, planar::Row};
use crate::surface::Scene;

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

/// What must be known of the whole composite beneath before one tile of it can be scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beneath {
    /// Its greatest luminance over the surface, linear light.
    pub brightest: f32,
    /// The factor that restores its mean luminance: [`Means::gain`]; 1 where the mean need not stay.
    pub gain: f32,
}

/// Luminance of a part of the composite, added up before and after scaling. Add the parts in a fixed order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Means {
    pub before: f64,
    pub after: f64,
}

impl Means {
    pub fn plus(self, other: Means) -> Means {
        Means { before: self.before + other.before, after: self.after + other.after }
    }
    /// The factor of the light that brings `after` back to `before`, within reason.
    pub fn gain(self) -> f32 {
        let gain = self.before / self.after;
        if gain.is_finite() { (gain as f32).max(1.0 / 64.0).min(64.0) } else { 1.0 }
    }
}

impl RadianceScaling {
    /// Scales one tile of the composite. Alpha and hue stay, as does what is off the surface; γ = 0 changes nothing.
    pub fn apply_tile(&self, scene: &Scene, at: TileAt, beneath: Beneath, pixels: &mut PlanarTile) {
        let gain = if self.keep_mean { beneath.gain } else { 1.0 };
        if self.scaling.is_none() && gain == 1.0 {
            return;
        }
        let y_star = self.reference.resolve(beneath.brightest);
        self.for_rows(scene, at, |y, x, kappa| {
            if let Some(row) = pixels.rows_mut().get_mut(y) {
                scale_row(row, x, kappa, &self.scaling, 1.0 / y_star, gain);
            }
        });
    }
    /// Luminance of one tile before and after scaling, weighed by alpha and by how far the surface covers each pixel.
    pub fn means_tile(&self, scene: &Scene, at: TileAt, brightest: f32, pixels: &PlanarTile) -> Means {
        let y_star = self.reference.resolve(brightest);
        let mut means = Means::default();
        let Some(surface) = scene.surface.as_deref() else { return means };
        let rect = at.rect();
        self.for_rows(scene, at, |y, x, kappa| {
            let Some(row) = pixels.rows().get(y) else { return };
            let coverage = &surface.coverage_plane().row(rect.y0 as usize + y)[rect.x0 as usize..];
            for ((x, &kappa), &coverage) in x.zip(kappa).zip(coverage) {
                let luminance = f64::from(luminance(row, x));
                let weight = f64::from(row.a[x]) * f64::from(coverage);
                means.before += weight * luminance;
                means.after +=
                    weight * luminance * f64::from(self.scaling.sigma_fast(kappa, luminance as f32 / y_star));
            }
        });
        means
    }
    /// Calls with each row of the tile that meets the surface, the columns of it, and κ there.
    fn for_rows(&self, scene: &Scene, at: TileAt, mut with: impl FnMut(usize, std::ops::Range<usize>, &[f32])) {
        let Some(surface) = scene.surface.as_deref() else { return };
        let (rect, inside) = (at.rect(), at.rect().intersect(surface.size().rect()));
        let features: FeatureMap = self.features.on(surface);
        let mut kappa = [0.0; TILE];
        for y in inside.y0..inside.y1 {
            let kappa = &mut kappa[..inside.width()];
            features.row_toward(inside.x0 as usize, y as usize, self.light, kappa);
            let x0 = (inside.x0 - rect.x0) as usize;
            with((y - rect.y0) as usize, x0..x0 + inside.width(), kappa);
        }
    }
}

/// Luminance of one pixel in linear light, its colour straight.
fn luminance(row: &Row, x: usize) -> f32 {
    let [r, g, b, a] = row.pixel(x);
    if a <= 0.0 {
        return 0.0;
    }
    let [r, g, b] = [r, g, b].map(|v| srgb::decode_fast((v / a).min(1.0)));
    srgb::luminance(r, g, b)
}

/// Multiplies the light of a row's pixels by gain · σ(κ, Y / Y*).
fn scale_row(row: &mut Row, x: std::ops::Range<usize>, kappa: &[f32], scaling: &Scaling, per_y_star: f32, gain: f32) {
    if gain == 1.0 && kappa.iter().all(|&k| k == 0.0) {
        return;
    }
    let [r, g, b] = &mut row.rgb;
    if let (Some(a), Some(r), Some(g), Some(b)) =
        (row.a.get(x.clone()), r.get_mut(x.clone()), g.get_mut(x.clone()), b.get_mut(x))
    {
        scale_pixels([r, g, b], a, kappa, *scaling, [per_y_star, gain]);
    }
}

crate::widest! {
    /// Channels of one row; `factors`: 1 / Y*, gain.
    fn scale_pixels(rgb: [&mut [f32]; 3], a: &[f32], kappa: &[f32], scaling: Scaling, factors: [f32; 2]) {
        let [r, g, b] = rgb;
        let [per_y_star, gain] = factors;
        let pixels = r.iter_mut().zip(g).zip(b).zip(a).zip(kappa);
        for ((((r, g), b), &a), &kappa) in pixels {
            let per_a = 1.0 / a.max(f32::MIN_POSITIVE);
            let straight = [*r * per_a, *g * per_a, *b * per_a];
            let light = straight.map(srgb::decode_fast);
            let delta = srgb::luminance(light[0], light[1], light[2]) * per_y_star;
            let factor = gain * scaling.sigma_fast(kappa, delta);
            let root = fast::exp2(fast::log2(factor) * (5.0 / 12.0));
            *r = srgb::scale_encoded(straight[0], factor, root).min(1.0) * a;
            *g = srgb::scale_encoded(straight[1], factor, root).min(1.0) * a;
            *b = srgb::scale_encoded(straight[2], factor, root).min(1.0) * a;
        }
    }
}

#[cfg(test)]
mod tests;
