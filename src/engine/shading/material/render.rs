//! A tile of a shading layer: the model's light row by row, encoded and clipped at the end.
//! Floor 3.

use super::{
    Model, Shading, ashikhmin,
    ashikhmin_environment::EnvironmentSamples,
    hemisphere, lit_sphere,
    mirror::{self, FollowedTile},
    painter::PainterTerms,
    phong::PhongTerms,
    second_look::SecondLook,
    toon,
};
use crate::math::{fast, srgb};
use crate::raster::planar::{BRIGHTEST, PixelRow};
use crate::raster::{PlanarTile, TILE, Tile, TileAt, tile::TILE_AREA};
use crate::shading::environment::Environment;
use crate::shading::light::RowLight;
use crate::shading::surface_row::{Light3, RowRelief, SurfaceRow};
use crate::surface::chunks::BallPlaces;
use crate::surface::{Scene, Surface};
use std::sync::Arc;

impl Shading {
    /// One tile of the material on a scene, opaque wherever there is any surface; `None` where
    /// there is none.
    ///
    /// What many tiles share (curvature, prefiltered environments, occlusion) is computed by the
    /// first and cached: [`Shading::warm`] does so in advance.
    pub fn render_tile(&self, scene: &Scene, at: TileAt) -> Option<Tile> {
        let mut bytes = vec![0; 4 * TILE_AREA];
        let rows = bytes.as_chunks_mut::<{ 4 * TILE }>().0;
        let shaded =
            self.shade_rows(scene, at, |y, light, coverage| show(light, coverage, &mut rows[y]));
        if self.has_ground_shadow() {
            self.ground_pixels(scene, at, |y, x, share| {
                let color = [self.shadows.color.r, self.shadows.color.g, self.shadows.color.b];
                let pixel = &mut rows[y][4 * x..4 * x + 4];
                let premultiplied = color.map(|c| srgb::quantize(f32::from(c) / 255.0 * share));
                pixel[..3].copy_from_slice(&premultiplied);
                pixel[3] = srgb::quantize(share);
            });
        }
        shaded?;
        Tile::from_pixels(bytes)
    }

    /// The same without rounding to bytes; light may be brighter than white.
    pub fn render_pixels(&self, scene: &Scene, at: TileAt) -> Option<PlanarTile> {
        let mut pixels = PlanarTile::transparent();
        self.shade_rows(scene, at, |y, light, coverage| {
            let PixelRow { rgb, a } = &mut pixels.rows_mut()[y];
            for (x, _) in coverage.iter().enumerate().filter(|(_, c)| **c > 0) {
                for (channel, light) in rgb.iter_mut().zip(light) {
                    channel[x] = srgb::encode(light[x].max(0.0)).min(BRIGHTEST);
                }
                a[x] = 1.0;
            }
        })?;
        if self.has_ground_shadow() {
            let color = self.shadows.color.to_f32();
            self.ground_pixels(scene, at, |y, x, share| {
                let PixelRow { rgb, a } = &mut pixels.rows_mut()[y];
                rgb.iter_mut().zip(color).for_each(|(channel, color)| channel[x] = color * share);
                a[x] = share;
            });
        }
        Some(pixels)
    }

    /// Passes on the opacity of the shadow on the page at each pixel of a tile off the surface: row,
    /// column and share.
    fn ground_pixels(&self, scene: &Scene, at: TileAt, mut tell: impl FnMut(usize, usize, f32)) {
        let Some(surface) = scene.surface.as_deref().and_then(Surface::on_canvas) else { return };
        let (inside, maps) = (scene.area(at), self.ground_maps(surface));
        for (row, y) in (inside.y0..inside.y1).enumerate() {
            for (column, x) in (inside.x0..inside.x1).enumerate() {
                let pixel = (x as usize, y as usize);
                if surface.coverage(pixel.0, pixel.1) == 0 {
                    tell(row, column, self.shadows.ground_at(&maps, &self.lights, pixel));
                }
            }
        }
    }

    /// Passes on the linear light of each wanted row of a tile, and the surface's coverage of it;
    /// `None` without a surface.
    fn shade_rows(
        &self,
        scene: &Scene,
        at: TileAt,
        mut tell: impl FnMut(usize, &Light3, &[u8]),
    ) -> Option<()> {
        let surface = scene.surface.as_deref()?;
        let inside = scene.area(at);
        let features = self.features.on(surface);
        let surface_row = |y: i32| {
            SurfaceRow::new(surface, &features, inside.x0 as usize, y as usize, inside.width())
        };
        let rows = (0..TILE).zip(inside.y0..inside.y1);
        if self.model == Model::Toon {
            let surface_rows: Vec<SurfaceRow> = (inside.y0..inside.y1).map(surface_row).collect();
            let mut light = vec![[[0.0; TILE]; 3]; surface_rows.len()];
            toon::shade_tile(self, &surface_rows, &mut light);
            let shaded = surface_rows.iter().zip(&light).take(TILE).enumerate();
            shaded.for_each(|(row, (surface_row, light))| tell(row, light, surface_row.coverage()));
        } else if !inside.is_empty() {
            let mut surface_row = surface_row(inside.y0);
            let mut worker = RowShader::new(self, surface);
            if let Some(samples) = &mut worker.samples {
                samples.follow_tile(self, surface, inside);
            }
            if scene.row_step() == 1 {
                worker.followed = FollowedTile::of(self, surface, &features, inside);
            }
            let looked_at = scene.row_step();
            for (row, y) in rows.step_by(looked_at) {
                surface_row.move_to(y as usize);
                if surface_row.coverage().iter().any(|&c| c > 0) {
                    tell(row, worker.light(&surface_row), surface_row.coverage());
                }
            }
        }
        Some(())
    }

    /// Fills the caches that many tiles would otherwise compute at the same time.
    pub fn warm(&self, scene: &Scene) {
        if let Some(surface) = scene.surface.as_deref() {
            self.features.on(surface);
            let environment_light = self.environment.as_ref().map(Environment::environment_light);
            let shows_occlusion =
                matches!(self.model, Model::DiffuseEnvironment | Model::AmbientOcclusion);
            let shows_matt = self.model == Model::DiffuseEnvironment
                || self.model == Model::Ashikhmin && self.bounces > 0 && self.diffuse.weight > 0.0;
            if shows_matt {
                environment_light.map(|s| s.brightest_matt());
            }
            SecondLook::on(surface, self.bounces_made());
            if self.is_solid_glass() {
                surface.front().map(|front| front.body(self.solid.back));
            }
            if self.model.has_lamps() {
                self.shadows.maps(surface, &self.lights);
            }
            if self.model == Model::Painter {
                surface.contact(self.painter.contact_size);
            }
            if shows_occlusion && self.occlusion_radius_px > 0.0 {
                surface.occlusion(self.occlusion_radius_px);
            }
        }
        if self.model == Model::LitSphere {
            scene.surface.as_deref().map(|surface| self.strokes.places(surface));
            lit_sphere::warm_caches(self);
        }
    }
}

/// Shades the rows of a tile; holds the buffers that are reused from row to row.
struct RowShader<'a> {
    shading: &'a Shading,
    lights: Vec<RowLight>,
    /// For Phong and similar models.
    terms: PhongTerms,
    /// For the painter's light.
    painter: Option<PainterTerms>,
    /// For a lit sphere with strokes.
    places: Option<Arc<BallPlaces>>,
    /// For an Ashikhmin material in an environment.
    samples: Option<EnvironmentSamples>,
    /// For a mirror or a refraction with bounces.
    followed: Option<FollowedTile>,
    relief: RowRelief,
    light: Light3,
}

impl<'a> RowShader<'a> {
    fn new(shading: &'a Shading, surface: &Surface) -> Self {
        let samples =
            if shading.model == Model::Ashikhmin { EnvironmentSamples::new(shading) } else { None };
        let lights = shading.row_lights(surface);
        let terms = PhongTerms::new(shading, &lights);
        let painter =
            (shading.model == Model::Painter).then(|| PainterTerms::new(shading, surface, &lights));
        Self {
            shading,
            painter,
            places: if shading.has_strokes() { shading.strokes.places(surface) } else { None },
            lights,
            terms,
            samples,
            followed: None,
            relief: RowRelief::default(),
            light: [[0.0; TILE]; 3],
        }
    }

    /// Linear light along a row.
    fn light(&mut self, surface_row: &SurfaceRow) -> &Light3 {
        let Self { shading, lights, terms, painter, places, samples, followed, relief, light } =
            self;
        relief.leave_row();
        lights.iter_mut().for_each(|lit| lit.turn(surface_row));
        *light = [[0.0; TILE]; 3];
        match shading.model {
            Model::Phong | Model::SubLambertian => {
                terms.find(shading, surface_row, lights, relief);
                terms.sum(light);
            }
            Model::Ashikhmin => {
                ashikhmin::shade(shading, surface_row, lights, relief, light);
                if let Some(samples) = samples {
                    samples.shade(shading, surface_row, relief, light);
                }
            }
            Model::LitSphere => {
                lit_sphere::shade(shading, surface_row, places.as_deref(), relief, light);
            }
            Model::Mirror | Model::Refraction => {
                mirror::shade(shading, surface_row, followed.as_ref(), light);
            }
            Model::DiffuseEnvironment => hemisphere::diffuse(shading, surface_row, light),
            Model::AmbientOcclusion => hemisphere::occlusion(shading, surface_row, light),
            Model::Painter => {
                if let Some(painter) = painter {
                    painter.read(surface_row, lights, 0);
                    let own = shading.diffuse.color.linear();
                    painter.shade(shading, lights, &own.map(|c| [c; TILE]), light);
                }
            }
            // Toon filters across rows: `render_tile` draws whole tiles.
            Model::Toon => {}
        }
        light
    }
}

/// Linear light as a row of bytes, opaque wherever the surface covers any of a pixel.
fn show(light: &Light3, coverage: &[u8], row: &mut [u8]) {
    let mut covered = [0; TILE];
    covered[..coverage.len()].copy_from_slice(coverage);
    encode(light, &covered, row);
}

crate::widest! {
    /// Linear light to sRGB bytes, clipped, four to a pixel; transparent where nothing is covered.
    fn encode(light: &Light3, covered: &[u8; TILE], row: &mut [u8]) {
        let [red, green, blue] = light;
        let mut packed = [0u32; TILE];
        for x in 0..TILE {
            let pixel = byte(red[x]) | byte(green[x]) << 8 | byte(blue[x]) << 16 | 0xff << 24;
            packed[x] = if covered[x] > 0 { pixel } else { 0 };
        }
        for (bytes, packed) in row.chunks_exact_mut(4).zip(packed) {
            bytes.copy_from_slice(&packed.to_le_bytes());
        }
    }
}

/// The sRGB byte of linear light, clipped.
#[inline(always)]
fn byte(light: f32) -> u32 {
    u32::from(srgb::quantize(srgb::encode_fast(fast::min(fast::max(light, 0.0), 1.0))))
}
