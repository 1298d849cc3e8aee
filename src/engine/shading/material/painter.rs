//! The painter's light: key, contact shade, fill, bounce, turning edge, rim and shine, on a color
//! that is the material's own or that of the picture beneath (MATH 5). Floor 3. The function for
//! one pixel is in the tests and reads like the equations; rows are computed here. Not here: its
//! numbers (`shading::painter`), cast shadows (`shading::shadow`).

use super::{Shading, lobes};
use crate::math::srgb::luminance;
use crate::math::{Vec3, fast, vec3};
use crate::raster::TILE;
use crate::shading::Painter;
use crate::shading::light::RowLight;
use crate::shading::surface_row::{Light3, LightDirection, RowValues, SurfaceRow};
use crate::surface::Surface;
use crate::surface::shadow::ContactShade;
use crate::surface::view::Eye;
use std::sync::Arc;

/// The powers of a color's channels where the light turns: light that bounced in the body is
/// richer.
const RICH: [f32; 3] = [0.94, 1.06, 1.12];
/// Light of a level part under the lamp of “studio”, straight ahead: it keeps its color.
const LEVEL: [f32; 3] = [1.31, 1.288, 1.22];
/// Light up to `KNEE.0` is kept; more of it nears `KNEE.0` + `KNEE.1`, so that white parts keep
/// their form.
const KNEE: (f32, f32) = (0.7, 0.6);
/// How far the normal turns away, 1 − n_z, where the rim begins and where it is whole.
const RIM_AT: (f32, f32) = (0.55, 0.98);
/// How far the surroundings lie lower where the rim begins and where it is whole: small parts on
/// others have none.
const STANDS_OUT: (f32, f32) = (0.12, 0.45);
/// The rim's lamp lies behind, across from the key, and this much higher.
const BACK: (f32, f32) = (-0.25, 0.8);
/// What the rim adds to a black part, as a share of a white one's.
const RIM_ON_BLACK: f32 = 0.35;

/// A lamp along a row.
struct LampRow {
    /// ℓ, camera space, and in each pixel's own frame.
    toward: [RowValues; 3],
    toward_seen: [RowValues; 3],
    /// The share of it that is seen.
    seen: RowValues,
    kappa: RowValues,
}

/// What the terms are made of, along a row of pixels that may lie anywhere.
pub struct PainterTerms {
    contact: Arc<ContactShade>,
    fixed: FixedTerms,
    is_scaled: bool,
    normal: [RowValues; 3],
    /// n in each pixel's own frame, if the surface is seen from nearby.
    normal_seen: Option<Box<[RowValues; 3]>>,
    higher: RowValues,
    lower: RowValues,
    kappa: RowValues,
    lamps: Vec<LampRow>,
}

const LEVEL_ROW: [RowValues; 3] = [[0.0; TILE], [0.0; TILE], [1.0; TILE]];

impl PainterTerms {
    /// `lights`: those of the shading, along any row.
    pub fn new(shading: &Shading, surface: &Surface, lights: &[RowLight]) -> Self {
        let lamp = |light: &RowLight| LampRow {
            toward: light.direction,
            toward_seen: light.direction,
            seen: [1.0; TILE],
            kappa: [0.0; TILE],
        };
        let terms = [shading.ambient, shading.diffuse, shading.specular];
        Self {
            contact: surface.contact(shading.painter.contact_size),
            fixed: FixedTerms::of(shading),
            is_scaled: terms.iter().any(|term| term.is_scaled()),
            normal: LEVEL_ROW,
            normal_seen: (surface.eye() != Eye::Afar).then(|| Box::new(LEVEL_ROW)),
            higher: [0.0; TILE],
            lower: [0.0; TILE],
            kappa: [0.0; TILE],
            lamps: lights.iter().map(lamp).collect(),
        }
    }

    /// Reads the pixels of a row of the surface into this one, from its pixel `to` on; `lights`:
    /// turned to it.
    pub fn read(&mut self, row: &SurfaceRow, lights: &[RowLight], to: usize) {
        let width = row.width.min(TILE - to);
        let put = |into: &mut [RowValues; 3], from: &[RowValues; 3]| {
            for (into, from) in into.iter_mut().zip(from) {
                into[to..to + width].copy_from_slice(&from[..width]);
            }
        };
        put(&mut self.normal, &row.normal);
        if let Some(seen) = &mut self.normal_seen {
            put(seen, row.seen_normal());
        }
        self.contact.higher.read(row.x0, row.y, &mut self.higher[to..to + width]);
        self.contact.lower.read(row.x0, row.y, &mut self.lower[to..to + width]);
        if self.is_scaled {
            let kappa = row.kappa(LightDirection::VIEWER);
            self.kappa[to..to + width].copy_from_slice(&kappa[..width]);
        }
        for (lamp, light) in self.lamps.iter_mut().zip(lights) {
            // Afar, ℓ is the same everywhere.
            if !light.is_afar() {
                put(&mut lamp.toward, &light.direction);
            }
            if !light.is_afar() || self.normal_seen.is_some() {
                put(&mut lamp.toward_seen, &row.in_pixel_frames(&light.direction));
            }
            if let Some(shadow) = &light.shadow {
                lamp.seen[to..to + width].copy_from_slice(&shadow.seen[..width]);
            }
            if self.is_scaled {
                let kappa = row.kappa(light.direction());
                lamp.kappa[to..to + width].copy_from_slice(&kappa[..width]);
            }
        }
    }

    /// The same row of a level part that nothing shades.
    pub fn leveled(&self) -> Self {
        let lamp = |lamp: &LampRow| LampRow {
            toward: lamp.toward,
            toward_seen: lamp.toward_seen,
            seen: [1.0; TILE],
            kappa: [0.0; TILE],
        };
        Self {
            contact: self.contact.clone(),
            fixed: self.fixed,
            is_scaled: self.is_scaled,
            normal: LEVEL_ROW,
            normal_seen: None,
            higher: [0.0; TILE],
            lower: [0.0; TILE],
            kappa: [0.0; TILE],
            lamps: self.lamps.iter().map(lamp).collect(),
        }
    }

    fn seen_normal(&self) -> &[RowValues; 3] {
        self.normal_seen.as_deref().unwrap_or(&self.normal)
    }

    /// The luminance of the light of the row on white, linear, without rim.
    pub fn brightness(&self, shading: &Shading, lights: &[RowLight]) -> RowValues {
        let sums = self.sums(shading, lights);
        std::array::from_fn(|x| {
            let [r, g, b] = [0, 1, 2].map(|c| sums.even[c][x] + sums.shine[c][x]);
            luminance(r, g, b)
        })
    }

    /// The light of the row, linear. `albedo`: the color that is lit, linear.
    pub fn shade(
        &self,
        shading: &Shading,
        lights: &[RowLight],
        albedo: &Light3,
        light: &mut Light3,
    ) {
        let painter = &shading.painter;
        let Sums { open, even, edge, shine } = self.sums(shading, lights);
        let mut rim = [0.0; TILE];
        if painter.rim > 0.0 {
            let toward = self.lamps.first().map_or(&LEVEL_ROW, |lamp| &lamp.toward);
            rim_row([&self.normal, self.seen_normal(), toward], &self.lower, &open, &mut rim);
        }
        finish_row(albedo, &even, [&edge, &rim], &shine, &self.fixed.finish, light);
    }

    fn sums(&self, shading: &Shading, lights: &[RowLight]) -> Sums {
        let painter = &shading.painter;
        let mut open = [0.0; TILE];
        contact_row(&self.higher, painter, &mut open);
        let (mut even, mut ambient) = ([[0.0; TILE]; 3], [1.0; TILE]);
        self.scale(shading.ambient.scaling, &self.kappa, &mut ambient);
        even_row(&self.normal, &open, &ambient, &self.fixed.even, &mut even);
        let (mut edge, mut shine) = ([0.0; TILE], [[0.0; TILE]; 3]);
        let all: f32 = lights.iter().map(|lit| strongest(lit.radiance)).sum();
        for (lamp, lit) in self.lamps.iter().zip(lights) {
            let mut key = [0.0; TILE];
            key_row(&self.normal, &lamp.toward, painter.wrap, &mut key);
            self.scale(shading.diffuse.scaling, &lamp.kappa, &mut key);
            let share = strongest(lit.radiance) / all.max(1e-6);
            edge_row(&key, &lamp.seen, share, &mut edge);
            let tint = painter.warmed(lit.radiance).map(|c| c * shading.diffuse.weight);
            let left = lit.shadow.as_ref().map_or([1.0; 3], |shadow| shadow.left);
            add_key_row(&key, &lamp.seen, tint, left, &mut even);
            if shading.specular.weight > 0.0 {
                let mut gloss = [0.0; TILE];
                shine_row(self.seen_normal(), &lamp.toward_seen, shading.shininess, &mut gloss);
                self.scale(shading.specular.scaling, &lamp.kappa, &mut gloss);
                let tint = lobes::tint(self.fixed.specular, lit.radiance);
                gloss.iter_mut().zip(&lamp.seen).for_each(|(gloss, seen)| *gloss *= seen);
                lobes::add(&mut shine, tint, &gloss);
            }
        }
        Sums { open, even, edge, shine }
    }

    fn scale(&self, scaling: crate::shading::Scaling, kappa: &RowValues, rho: &mut RowValues) {
        if !scaling.is_none() {
            for (rho, kappa) in rho.iter_mut().zip(kappa) {
                *rho *= scaling.sigma_fast(*kappa, *rho);
            }
        }
    }
}

/// What is added up along a row.
struct Sums {
    /// What contact shade leaves of the light.
    open: RowValues,
    /// The light that the color takes.
    even: Light3,
    edge: RowValues,
    shine: Light3,
}

fn strongest(radiance: [f32; 3]) -> f32 {
    radiance.into_iter().fold(0.0, f32::max)
}

/// What is the same for all pixels: colors are decoded once for many rows.
#[derive(Clone, Copy)]
struct FixedTerms {
    even: EvenLight,
    finish: Finish,
    /// The color of the shine, linear.
    specular: [f32; 3],
}

impl FixedTerms {
    fn of(shading: &Shading) -> Self {
        let painter = &shading.painter;
        Self {
            even: EvenLight::of(shading),
            finish: Finish {
                exposure: painter.exposure,
                edge: painter.edge * Painter::EDGE,
                rim: painter.rim_color.linear().map(|c| c * painter.rim * Painter::RIM),
            },
            specular: shading.specular.linear(),
        }
    }
}

/// Fill, bounce and light from everywhere, linear.
#[derive(Clone, Copy)]
struct EvenLight {
    fill: [f32; 3],
    bounce: [f32; 3],
    around: [f32; 3],
}

impl EvenLight {
    fn of(shading: &Shading) -> Self {
        let (painter, own) = (&shading.painter, shading.ambient.linear());
        let of = |color: [f32; 3], by: f32| std::array::from_fn(|c| own[c] * color[c] * by);
        Self {
            fill: of(painter.fill_color.linear(), painter.fill * Painter::FILL),
            bounce: of(painter.bounce_color.linear(), painter.bounce * Painter::BOUNCE),
            around: of([1.0; 3], painter.around * Painter::AROUND),
        }
    }
}

/// How the sums become light.
#[derive(Clone, Copy)]
struct Finish {
    exposure: f32,
    edge: f32,
    rim: [f32; 3],
}

/// 0 up to `from`, 1 from `to` on, smooth between.
#[inline(always)]
fn smooth((from, to): (f32, f32), v: f32) -> f32 {
    let t = fast::min(fast::max((v - from) / (to - from), 0.0), 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Light with its brightest part pressed together.
#[inline(always)]
fn knee(light: f32) -> f32 {
    let over = fast::max(light - KNEE.0, 0.0);
    fast::min(light, KNEE.0) + over / (1.0 + over * (1.0 / KNEE.1))
}

/// The direction of the rim's lamp, any length, from that of the key.
#[inline(always)]
fn back(key: Vec3) -> Vec3 {
    vec3(-key.x, BACK.1 - key.y, BACK.0)
}

/// v^p of each pixel.
#[inline(always)]
fn raise_row(values: &mut RowValues, p: f32) {
    for v in values {
        *v = fast::pow(*v, p);
    }
}

/// The same where neighbors are often equal, as in a flat drawing.
#[inline(always)]
fn raise_colors(values: &mut RowValues, p: f32) {
    const CHUNK: usize = 16;
    for chunk in values.as_chunks_mut::<CHUNK>().0 {
        let (first, mut uneven) = (chunk[0], 0);
        for v in chunk.iter() {
            uneven |= i32::from(*v != first);
        }
        if uneven == 0 {
            *chunk = [fast::pow(first, p); CHUNK];
        } else {
            for v in chunk.iter_mut() {
                *v = fast::pow(*v, p);
            }
        }
    }
}

crate::widest! {
    /// o = floor + (1 − floor) e^(−c Σ).
    fn contact_row(higher: &RowValues, painter: &Painter, open: &mut RowValues) {
        let (per, floor) = (-Painter::CONTACT * painter.contact, painter.contact_floor);
        for x in 0..TILE {
            open[x] = floor + (1.0 - floor) * fast::exp(per * higher[x]);
        }
    }

    /// o · (up · fill + down · bounce + around).
    fn even_row(
        normal: &[RowValues; 3],
        open: &RowValues,
        scale: &RowValues,
        of: &EvenLight,
        even: &mut Light3,
    ) {
        for (c, even) in even.iter_mut().enumerate() {
            for x in 0..TILE {
                let up = 0.5 + 0.5 * normal[1][x];
                let down = fast::max(-normal[1][x], 0.0);
                let light = up * of.fill[c] + down * of.bounce[c] + of.around[c];
                even[x] = open[x] * scale[x] * light;
            }
        }
    }

    /// k = max(0, (n·ℓ + w)/(1 + w)).
    fn key_row(normal: &[RowValues; 3], toward: &[RowValues; 3], wrap: f32, key: &mut RowValues) {
        let per = 1.0 / (1.0 + wrap);
        for x in 0..TILE {
            let n_l = normal[0][x] * toward[0][x] + normal[1][x] * toward[1][x] + normal[2][x] * toward[2][x];
            key[x] = fast::max((n_l + wrap) * per, 0.0);
        }
    }

    /// Adds the key where it is seen, and the share that a shadow leaves where it is not.
    fn add_key_row(
        key: &RowValues,
        seen: &RowValues,
        tint: [f32; 3],
        left: [f32; 3],
        light: &mut Light3,
    ) {
        for (c, light) in light.iter_mut().enumerate() {
            let (least, more) = (tint[c] * left[c], tint[c] * (1.0 - left[c]));
            for x in 0..TILE {
                light[x] += key[x] * (least + more * seen[x]);
            }
        }
    }

    /// Adds the turning edge, (4k(1 − k))².
    fn edge_row(key: &RowValues, seen: &RowValues, share: f32, edge: &mut RowValues) {
        for x in 0..TILE {
            let turned = fast::max(4.0 * key[x] * (1.0 - key[x]), 0.0);
            edge[x] += share * seen[x] * turned * turned;
        }
    }

    /// How much more than a level part it shines: max(0, (n·half)^η − half_z^η).
    fn shine_row(normal: &[RowValues; 3], toward: &[RowValues; 3], power: f32, shine: &mut RowValues) {
        let (mut level, mut more, mut uneven) = ([0.0; TILE], 0, 0);
        for x in 0..TILE {
            // |ℓ + e|² = 2 + 2 ℓ_z.
            let per = 1.0 / fast::max(2.0 + 2.0 * toward[2][x], 1e-6).sqrt();
            let n_h = normal[0][x] * toward[0][x] + normal[1][x] * toward[1][x]
                + normal[2][x] * (toward[2][x] + 1.0);
            shine[x] = fast::min(fast::max(n_h * per, 0.0), 1.0);
            level[x] = fast::min(fast::max((toward[2][x] + 1.0) * per, 0.0), 1.0);
            more |= i32::from(shine[x] > level[x]);
        }
        // Most rows shine nowhere.
        if more == 0 {
            *shine = [0.0; TILE];
            return;
        }
        for x in 0..TILE {
            uneven |= i32::from(level[x] != level[0]);
        }
        if uneven == 0 {
            level = [fast::pow(level[0], power); TILE];
        } else {
            raise_row(&mut level, power);
        }
        raise_row(shine, power);
        for x in 0..TILE {
            shine[x] = fast::max(shine[x] - level[x], 0.0);
        }
    }

    /// How much of the rim's light there is; `of`: normals, normals as seen, and toward the key.
    fn rim_row(of: [&[RowValues; 3]; 3], lower: &RowValues, open: &RowValues, rim: &mut RowValues) {
        let ([normal, seen, key], mut turned) = (of, 0);
        for z in &seen[2] {
            turned |= i32::from(1.0 - z > RIM_AT.0);
        }
        if turned == 0 {
            return;
        }
        for x in 0..TILE {
            let b = back(vec3(key[0][x], key[1][x], key[2][x]));
            let per = 1.0 / (b.x * b.x + b.y * b.y + b.z * b.z).sqrt();
            let n_b = (normal[0][x] * b.x + normal[1][x] * b.y + normal[2][x] * b.z) * per;
            let stands_out = smooth(STANDS_OUT, lower[x]);
            rim[x] = smooth(RIM_AT, 1.0 - seen[2][x]) * fast::max(n_b - BACK.0, 0.0) * open[x] * stands_out;
        }
    }

    /// Puts the sums on the color; `terms`: the turning edge, the rim.
    fn finish_row(
        albedo: &Light3,
        even: &Light3,
        terms: [&RowValues; 2],
        shine: &Light3,
        with: &Finish,
        light: &mut Light3,
    ) {
        let [edge, rim] = terms;
        for c in 0..3 {
            let white = 1.0 / knee(LEVEL[c]);
            let (mut rich, own) = (albedo[c], &albedo[c]);
            raise_colors(&mut rich, RICH[c]);
            for x in 0..TILE {
                let lit = knee(even[c][x] * with.exposure) * white;
                let turned = fast::min(with.edge * edge[x], 1.0);
                let body = own[x] + (rich[x] - own[x]) * turned;
                let rim = with.rim[c] * rim[x] * (RIM_ON_BLACK + own[x]);
                light[c][x] = body * lit + with.exposure * (rim + shine[c][x]);
            }
        }
    }
}

#[cfg(test)]
mod tests;
