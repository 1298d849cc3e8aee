//! A tile of a shading layer: the model's light row by row, encoded and clipped at the end.
//! Floor 3.

use super::{Model, Shading, phong};
use crate::math::{fast, srgb};
use crate::raster::{PlanarTile, TILE, Tile, TileAt, planar::Row};
use crate::shading::ground::{Ground, Light3};
use crate::surface::Scene;

impl Shading {
    /// One tile of the material on a scene, opaque wherever there is any surface; `None` where there is none, and for
    /// a model that is not drawn yet ([`Model::is_drawn`]).
    ///
    /// What many tiles share (curvature, prefiltered environments, occlusion) is computed by the first and kept:
    /// [`Shading::warm`] does so ahead.
    pub fn render_tile(&self, scene: &Scene, at: TileAt) -> Option<Tile> {
        let surface = scene.surface.as_deref().filter(|_| self.model.is_drawn())?;
        let inside = at.rect().intersect(surface.size().rect());
        let features = self.features.on(surface);
        let mut pixels = PlanarTile::transparent();
        for (row, y) in pixels.rows_mut().iter_mut().zip(inside.y0..inside.y1) {
            let ground = Ground::new(surface, &features, inside.x0 as usize, y as usize, inside.width());
            if ground.coverage().iter().all(|&c| c == 0) {
                continue;
            }
            for (alpha, &coverage) in row.a.iter_mut().zip(ground.coverage()) {
                *alpha = if coverage > 0 { 1.0 } else { 0.0 };
            }
            let mut light = [[0.0; TILE]; 3];
            self.shade(&ground, &mut light);
            encode(&light, row);
        }
        pixels.quantised()
    }
    /// Computes now what many tiles would otherwise compute at the same time.
    pub fn warm(&self, scene: &Scene) {
        if let Some(surface) = scene.surface.as_deref() {
            self.features.on(surface);
        }
    }
    fn shade(&self, ground: &Ground, light: &mut Light3) {
        match self.model {
            Model::Phong => phong::shade(self, ground, None, light),
            Model::SubLambertian => phong::shade(self, ground, Some(self.exponent), light),
            // Not drawn: `render_tile` asked.
            _ => {}
        }
    }
}

crate::widest! {
    /// Linear light to sRGB, clipped, where the row has coverage.
    fn encode(light: &Light3, row: &mut Row) {
        for (channel, light) in row.rgb.iter_mut().zip(light) {
            for ((v, &light), &a) in channel.iter_mut().zip(light).zip(&row.a) {
                *v = srgb::encode_fast(fast::min(fast::max(light, 0.0), 1.0)) * a;
            }
        }
    }
}
