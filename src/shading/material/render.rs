//! A tile of a shading layer: the model's light row by row, encoded and clipped at the end.
//! Floor 3.

use super::{Model, Shading, ashikhmin, ashikhmin_environment::Samples, lit_sphere, mirror, open, phong, toon};
use crate::math::{fast, srgb};
use crate::raster::{PlanarTile, TILE, Tile, TileAt, planar::Row};
use crate::shading::environment::Environment;
use crate::shading::ground::{Ground, Light3};
use crate::surface::Scene;

impl Shading {
    /// One tile of the material on a scene, opaque wherever there is any surface; `None` where there is none.
    ///
    /// What many tiles share (curvature, prefiltered environments, occlusion) is computed by the first and kept:
    /// [`Shading::warm`] does so ahead.
    pub fn render_tile(&self, scene: &Scene, at: TileAt) -> Option<Tile> {
        let surface = scene.surface.as_deref()?;
        let inside = at.rect().intersect(surface.size().rect());
        let features = self.features.on(surface);
        let ground = |y: i32| Ground::new(surface, &features, inside.x0 as usize, y as usize, inside.width());
        let mut pixels = PlanarTile::transparent();
        let rows = pixels.rows_mut().iter_mut().zip(inside.y0..inside.y1);
        if self.model == Model::Toon {
            let grounds: Vec<Ground> = (inside.y0..inside.y1).map(ground).collect();
            let mut light = vec![[[0.0; TILE]; 3]; grounds.len()];
            toon::shade_tile(self, &grounds, &mut light);
            rows.zip(&grounds).zip(&light).for_each(|(((row, _), ground), light)| show(light, ground, row));
            return pixels.quantised();
        }
        let samples = if self.model == Model::Ashikhmin { Samples::new(self) } else { None };
        for (row, y) in rows {
            let ground = ground(y);
            if ground.coverage().iter().any(|&c| c > 0) {
                let mut light = [[0.0; TILE]; 3];
                self.shade(&ground, &mut light);
                if let Some(samples) = &samples {
                    samples.shade(self, &ground, &mut light);
                }
                show(&light, &ground, row);
            }
        }
        pixels.quantised()
    }
    /// Computes now what many tiles would otherwise compute at the same time.
    pub fn warm(&self, scene: &Scene) {
        if let Some(surface) = scene.surface.as_deref() {
            self.features.on(surface);
            let surroundings = self.environment.as_ref().map(Environment::surroundings);
            let shows_occlusion = matches!(self.model, Model::DiffuseEnvironment | Model::AmbientOcclusion);
            if self.model == Model::DiffuseEnvironment {
                surroundings.map(|s| s.brightest_matt());
            }
            if shows_occlusion && self.occlusion_radius_px > 0.0 {
                surface.occlusion(self.occlusion_radius_px);
            }
        }
        if self.model == Model::LitSphere {
            lit_sphere::warm(self);
        }
    }
    fn shade(&self, ground: &Ground, light: &mut Light3) {
        match self.model {
            Model::Phong => phong::shade(self, ground, None, light),
            Model::SubLambertian => phong::shade(self, ground, Some(self.exponent), light),
            Model::Ashikhmin => ashikhmin::shade(self, ground, light),
            Model::LitSphere => lit_sphere::shade(self, ground, light),
            Model::Mirror | Model::Refraction => mirror::shade(self, ground, light),
            Model::DiffuseEnvironment => open::diffuse(self, ground, light),
            Model::AmbientOcclusion => open::occlusion(self, ground, light),
            // Its bands look at whole tiles: `render_tile` has drawn it.
            Model::Toon => {}
        }
    }
}

/// Linear light on a row, opaque where the surface covers any of a pixel.
fn show(light: &Light3, ground: &Ground, row: &mut Row) {
    for (alpha, &coverage) in row.a.iter_mut().zip(ground.coverage()) {
        *alpha = if coverage > 0 { 1.0 } else { 0.0 };
    }
    encode(light, row);
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
