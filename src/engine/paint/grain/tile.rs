//! What grain leaves of a stroke's paint on a tile.
//! Floor 3. Not here: what grain is, and its texture (`grain`).

use super::{BrushGrain, GrainSource, GrainSpace};
use crate::math::{Affine2, Vec2};
use crate::paint::image::transform;
use crate::paint::patches::Patches;
use crate::paint::pattern::Pattern;
use crate::paint::scene::Scene;
use crate::raster::sampler::Antialias;
use crate::raster::tile::TILE_AREA;
use crate::raster::{Outside, TILE, Texture, TileAt};
use crate::surface::Operator;
use crate::surface::deformation::{Deformation, DeformedRect};
use std::sync::Arc;

/// What grain leaves of each pixel of a tile. A pixel may hold light and dark grain finer than
/// itself: a stroke's dabs fill the light part sooner than the dark one, so a mean of both would be
/// filled too soon. So a pixel has two parts, chosen so that mean and variance are right; where
/// grain is black and white, so are the parts.
pub struct GrainTile {
    /// The factor of F in either part, `[0, 1]`.
    pub light: [f32; TILE_AREA],
    /// How much paint each pixel does not take.
    pub dark: [f32; TILE_AREA],
    /// The lighter part's share of the pixel, `[0, 1]`.
    pub share: [f32; TILE_AREA],
}

/// The grain under one stroke.
pub struct StrokeGrain {
    texture: Arc<Texture>,
    texels_from_canvas: Affine2,
    operator: Operator,
    /// q_s.
    start: Vec2,
    strength: f32,
}

impl StrokeGrain {
    /// `start`: where the stroke begins, canvas px.
    pub fn new(grain: &BrushGrain, start: Vec2) -> Self {
        let texture = grain.texture();
        let texels = match grain.source {
            GrainSource::Pattern { .. } => texture.size().longer_side() / Pattern::CELLS as f32,
            GrainSource::Picture(_) => texture.size().longer_side(),
        };
        // Comparisons that NaN fails give a pattern of one pixel.
        let texels_per_px = Vec2::splat(texels / grain.size_px.max(0.01));
        let turn = if grain.rotation.is_finite() { grain.rotation.to_radians() } else { 0.0 };
        let operator = match grain.lies {
            GrainSpace::Canvas => Operator::None,
            GrainSpace::Surface { gamma } => Operator::Depth { gamma },
            GrainSpace::Unwrapped => Operator::Surface { amount: 1.0, smooth: 0.0 },
        };
        Self {
            texture,
            texels_from_canvas: Affine2::from_scale(texels_per_px) * Affine2::from_angle(turn),
            operator,
            start,
            strength: grain.strength.max(0.0).min(1.0),
        }
    }

    /// The factors of F over a tile, row by row; 1 beyond the canvas.
    pub fn tile(&self, scene: &Scene, at: TileAt) -> Box<GrainTile> {
        let whole = [1.0; TILE_AREA];
        let mut out = Box::new(GrainTile { light: whole, dark: whole, share: whole });
        let area = scene.area(at);
        if area.is_empty() {
            return out;
        }
        let (mut deformed, mut patches) = (DeformedRect::default(), Patches::default());
        let (mut antialias, mut row) = (Antialias::default(), vec![[0; 4]; area.width()]);
        let deformation = Deformation::of_pattern(
            scene.surface.as_deref(),
            scene.size,
            self.operator,
            self.start,
        );
        deformation.fill(area.grown(1), &mut deformed);
        transform(self.texels_from_canvas, &mut deformed.x, &mut deformed.y);
        for y in scene.rows(area) {
            let patches = patches.row(scene, area, y, &deformed, self.texels_from_canvas);
            antialias.row(&self.texture, patches, Outside::Repeat, &mut row);
            let start = (y - area.y0) as usize * TILE;
            for (i, texel) in (start..).zip(&row) {
                let [gray, square, _, bare] = texel.map(|v| f32::from(v) / 255.0);
                let [light, dark, share] = parts(gray, square, bare);
                (out.light[i], out.dark[i]) =
                    (factor_of(self.strength, light), factor_of(self.strength, dark));
                out.share[i] = share;
            }
        }
        out
    }
}

/// Two grays and the share of the first, for a mean gray m, the mean of its square and the share p
/// that is not black, all in `[0, 1]`. If some is black, that is one part, since paint never fills
/// it; else with σ² = ⟨G²⟩ − m²:
///
/// ```text
/// p < 1:   light = m / p,                    dark = 0,                        share = p
/// p = 1:   light = m + σ √((1 − m) / m),   dark = m − σ √(m / (1 − m)),   share = m
/// ```
pub fn parts(mean: f32, square: f32, share: f32) -> [f32; 3] {
    if share < 1.0 {
        return [if share > 0.0 { (mean / share).min(1.0) } else { 0.0 }, 0.0, share];
    }
    let variance = (square - mean * mean).max(0.0).min(mean * (1.0 - mean));
    // The error of rounding to bytes.
    if variance < 2.0 / 255.0 {
        return [mean, mean, 1.0];
    }
    let (sigma, ratio) = (variance.sqrt(), (mean / (1.0 - mean)).sqrt());
    [(mean + sigma / ratio).min(1.0), (mean - sigma * ratio).max(0.0), mean]
}

/// 1 − k (1 − G): the share of a dab's coverage that the grain leaves. `strength` k and `gray` G in
/// `[0, 1]`.
pub fn factor_of(strength: f32, gray: f32) -> f32 {
    1.0 - strength * (1.0 - gray)
}
