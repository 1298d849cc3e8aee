//! Scales one row of a tile, fast. Floor 3. The equation is `scaling::sigma`; the tests of
//! `radiance` compare this with it.
//!
//! Short loops over the row, each with its result in an array: one long loop per pixel is a single
//! chain of dependent operations that no processor can overlap (measured: 2.4 times slower).

use crate::math::{fast, srgb};
use crate::raster::{TILE, planar::PixelRow};
use crate::shading::scaling::Scaling;

/// One value a pixel of the row.
type LuminanceRow = [f32; TILE];

/// Scales the rows of a tile; its arrays are reused from row to row.
pub(super) struct RowScaler {
    scaling: Scaling,
    per_y_star: f32,
    /// 1 / alpha, or huge where that is 0.
    per_a: LuminanceRow,
    /// δ = Y / Y*, in `[0, 1]`.
    delta: LuminanceRow,
    /// gain · σ.
    factors: LuminanceRow,
    /// The factors' 5/12th powers: the effect of a factor of the light on encoded values.
    roots: LuminanceRow,
    /// Without approximations: the brightest straight color that is left.
    exact: Option<f32>,
}

impl RowScaler {
    pub fn new(scaling: Scaling, y_star: f32) -> Self {
        let none = [0.0; TILE];
        Self {
            scaling,
            per_y_star: 1.0 / y_star,
            per_a: none,
            delta: none,
            factors: none,
            roots: none,
            exact: None,
        }
    }

    /// For pictures of more than 8 bits: nothing is approximated.
    ///
    /// * `brightest`: above it, encoded, light is clipped; 1 is white.
    pub fn exact(scaling: Scaling, y_star: f32, brightest: f32) -> Self {
        Self { exact: Some(brightest), ..Self::new(scaling, y_star) }
    }

    /// One pixel after another, by the definition.
    fn scale_exactly(
        &self,
        brightest: f32,
        row: &mut PixelRow,
        kappa: &LuminanceRow,
        gains: &LuminanceRow,
    ) {
        let PixelRow { rgb, a } = row;
        for x in 0..TILE {
            if a[x] <= 0.0 {
                continue;
            }
            let light = [0, 1, 2].map(|c| srgb::decode(rgb[c][x] / a[x]));
            let delta = srgb::luminance(light[0], light[1], light[2]) * self.per_y_star;
            let factor = gains[x] * self.scaling.sigma(kappa[x], delta);
            for (channel, light) in rgb.iter_mut().zip(light) {
                channel[x] = srgb::encode(light * factor).max(0.0).min(brightest) * a[x];
            }
        }
    }

    /// Multiplies the light of each pixel by σ(κ, Y / Y*).
    pub fn apply(&mut self, row: &mut PixelRow, kappa: &LuminanceRow) {
        if let Some(brightest) = self.exact {
            return self.scale_exactly(brightest, row, kappa, &[1.0; TILE]);
        }
        // The range that the polynomials of `find_gentle` are made for.
        if self.scaling.gamma_convex <= 2.0 && self.scaling.gamma_concave <= 2.0 {
            apply_gentle(self, row, kappa);
        } else {
            apply_strong(self, row, kappa, &[1.0; TILE]);
        }
    }

    /// Multiplies the light of each pixel by its gain and σ(κ, Y / Y*).
    pub fn apply_with_gains(
        &mut self,
        row: &mut PixelRow,
        kappa: &LuminanceRow,
        gains: &LuminanceRow,
    ) {
        match self.exact {
            Some(brightest) => self.scale_exactly(brightest, row, kappa, gains),
            None => apply_strong(self, row, kappa, gains),
        }
    }
}

crate::widest! {
    fn apply_gentle(with: &mut RowScaler, row: &mut PixelRow, kappa: &LuminanceRow) {
        if is_opaque(row) {
            with.gentle::<true>(row, kappa);
        } else {
            with.gentle::<false>(row, kappa);
        }
    }

    fn apply_strong(with: &mut RowScaler, row: &mut PixelRow, kappa: &LuminanceRow, gains: &LuminanceRow) {
        // A strong γ separates dark tones that an approximate luminance would merge.
        with.find_reflectances::<false>(row, |r, g, b| {
            srgb::luminance(srgb::decode_fast(r), srgb::decode_fast(g), srgb::decode_fast(b))
        });
        with.find_factors(kappa, gains);
        with.find_roots();
        with.scale::<false>(row, srgb::scale_encoded);
    }
}

/// Then dividing by alpha and multiplying by it again, a sixth of the work, changes no bit.
#[inline(always)]
fn is_opaque(row: &PixelRow) -> bool {
    row.a.iter().fold(true, |all, &a| all & (a == 1.0))
}

impl RowScaler {
    #[inline(always)]
    fn gentle<const OPAQUE: bool>(&mut self, row: &mut PixelRow, kappa: &LuminanceRow) {
        self.find_reflectances::<OPAQUE>(row, srgb::luminance_fast);
        self.find_gentle(kappa);
        self.scale::<OPAQUE>(row, srgb::scale_encoded_gently);
    }

    #[inline(always)]
    fn find_reflectances<const OPAQUE: bool>(
        &mut self,
        row: &PixelRow,
        luminance: impl Fn(f32, f32, f32) -> f32,
    ) {
        for x in 0..TILE {
            let (r, g, b) = (row.rgb[0][x], row.rgb[1][x], row.rgb[2][x]);
            let per_a = if OPAQUE { 1.0 } else { 1.0 / fast::max(row.a[x], f32::MIN_POSITIVE) };
            if !OPAQUE {
                self.per_a[x] = per_a;
            }
            self.delta[x] =
                fast::min(luminance(r * per_a, g * per_a, b * per_a) * self.per_y_star, 1.0);
        }
    }

    #[inline(always)]
    fn find_factors(&mut self, kappa: &LuminanceRow, gains: &LuminanceRow) {
        let scaling = self.scaling;
        for x in 0..TILE {
            self.factors[x] = gains[x] * scaling.sigma_fast(kappa[x], self.delta[x]);
        }
    }

    #[inline(always)]
    fn find_roots(&mut self) {
        for x in 0..TILE {
            self.roots[x] = fast::exp2(fast::log2(self.factors[x]) * (5.0 / 12.0));
        }
    }

    /// σ and its root for γ up to 2, without exponentials; relative error below 2e-4.
    ///
    /// With t = tanh(γκ/2), E = (1 − t)/(1 + t), and RS eq. 2 becomes
    /// `σ = (1 + q)/(1 − q)`, `q = t (δ − α)/(δ + α − 2αδ)`, so that ln σ = 2 artanh q and
    /// `σ^p = (1 + u)/(1 − u)`, `u = tanh(p artanh q)`: t and u are odd polynomials.
    #[inline(always)]
    fn find_gentle(&mut self, kappa: &LuminanceRow) {
        let Scaling { alpha, gamma_convex, gamma_concave } = self.scaling;
        let (convex, concave) = (0.5 * gamma_convex, 0.5 * gamma_concave);
        for x in 0..TILE {
            let kappa = kappa[x];
            let t = small_tanh(kappa * if kappa > 0.0 { convex } else { concave });
            let delta = self.delta[x];
            self.roots[x] = t * (delta - alpha) / (alpha + delta * (1.0 - 2.0 * alpha));
        }
        for x in 0..TILE {
            let u = small_root(self.roots[x]);
            self.roots[x] = (1.0 + u) / (1.0 - u);
        }
        for x in 0..TILE {
            // root^2.4 within 0.2 %: only values on the foot of the curve need it.
            let root = self.roots[x];
            self.factors[x] = 0.042_410_117 - 0.263_898 * root
                + (1.006_399 + root * 0.216_649_44) * (root * root);
        }
    }

    /// Straight, scaled, clipped, premultiplied again: the same steps for every tone, so that dark
    /// tones cost nothing more (with a branch a row for pictures without darks: 2.9 ns a pixel and
    /// 5.4 ns with them).
    #[inline(always)]
    fn scale<const OPAQUE: bool>(
        &self,
        row: &mut PixelRow,
        scale_encoded: impl Fn(f32, f32, f32) -> f32,
    ) {
        for channel in &mut row.rgb {
            for (x, v) in channel.iter_mut().enumerate() {
                let (a, per_a) = if OPAQUE { (1.0, 1.0) } else { (row.a[x], self.per_a[x]) };
                let scaled = scale_encoded(*v * per_a, self.factors[x], self.roots[x]);
                *v = fast::min(scaled, 1.0) * a;
            }
        }
    }
}

/// tanh y for |y| ≤ 1, error below 4e-5.
#[inline(always)]
fn small_tanh(y: f32) -> f32 {
    let y2 = y * y;
    y * ((0.999_693_8 - 0.328_892_3 * y2) + (y2 * y2) * (0.115_414_5 - 0.024_654_55 * y2))
}

/// tanh(5/12 artanh q) for |q| ≤ tanh 1.
#[inline(always)]
fn small_root(q: f32) -> f32 {
    let q2 = q * q;
    q * ((0.416_067_36 + 0.126_580_57 * q2) + (q2 * q2) * (0.143_218_83 * q2 - 1.213_732_6e-5))
}
