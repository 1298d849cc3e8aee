//! Toon: Phong in flat tones, each term quantized after scaling (RS sec. 5.1, MATH 5). Floor 3.

use super::{Shading, lobes, phong::PhongTerms};
use crate::math::fast;
use crate::raster::TILE;
use crate::shading::surface_row::{Light3, RowRelief, RowValues, SurfaceRow};
use crate::surface::links;

/// Adds every light's terms in `bands` tones to the rows of a tile.
///
/// The edge of a tone is where σρ crosses a multiple of 1 / bands. It is antialiased: the gradient
/// of σρ, from the neighbors in the tile, gives the share of the pixel on either side.
pub fn shade_tile(shading: &Shading, rows: &[SurfaceRow], light: &mut [Light3]) {
    let Some(first) = rows.first() else { return };
    let mut lights = shading.row_lights(first.surface);
    let (mut terms, mut relief) = (PhongTerms::new(shading, &lights), RowRelief::default());
    // σρ over the tile, term by term.
    let mut scaled: Vec<Vec<RowValues>> = vec![Vec::with_capacity(rows.len()); terms.tints.len()];
    for surface_row in rows {
        relief.leave_row();
        lights.iter_mut().for_each(|lit| lit.turn(surface_row));
        terms.find(shading, surface_row, &lights, &mut relief);
        scaled.iter_mut().zip(&terms.scaled).for_each(|(all, row)| all.push(*row));
    }
    for (tint, scaled) in terms.tints.iter().zip(&scaled) {
        add_tones(rows, *tint, scaled, shading.bands, light);
    }
}

/// Adds the tones of one term.
fn add_tones(
    rows: &[SurfaceRow],
    tint: [f32; 3],
    scaled: &[RowValues],
    bands: u32,
    light: &mut [Light3],
) {
    for (y, ((surface_row, here), light)) in rows.iter().zip(scaled).zip(light).enumerate() {
        let above = y.checked_sub(1).and_then(|y| scaled.get(y));
        let below = scaled.get(y + 1);
        let linked = links_in_tile(surface_row, above.is_some(), below.is_some());
        let tones =
            tones([above.unwrap_or(here), here, below.unwrap_or(here)], &linked, bands as f32);
        lobes::add(light, tint, &tones);
    }
}

/// The links of a row's pixels to neighbors that are in the tile.
fn links_in_tile(surface_row: &SurfaceRow, has_above: bool, has_below: bool) -> [u8; TILE] {
    let mut linked = [0; TILE];
    let row = &mut linked[..surface_row.width];
    row.copy_from_slice(surface_row.links());
    let missing = if has_above { 0 } else { links::UP } | if has_below { 0 } else { links::DOWN };
    row.iter_mut().for_each(|l| *l &= !missing);
    if let Some(first) = row.first_mut() {
        *first &= !links::LEFT;
    }
    if let Some(last) = row.last_mut() {
        *last &= !links::RIGHT;
    }
    linked
}

/// The tone of a value in `bands` tones, 0 … 1, filtered over a pixel in which the value changes by
/// `change`.
///
/// floor(v · bands) / (bands − 1), at most 1, is constant except for steps at multiples of 1 /
/// bands; the nearest step becomes a ramp as wide as the pixel. Where a pixel spans more than a
/// band, the ramps meet: the tones run together.
///
/// * `value`: `≥ 0`; `change`: length of its gradient per pixel; `bands`: `≥ 2`.
#[inline(always)]
fn tone(value: f32, change: f32, bands: f32) -> f32 {
    // Adding 1.5 · 2²³ leaves the nearest whole number in the low bits.
    const ROUND: f32 = 12_582_912.0;
    let t = fast::min(fast::max(value * bands, 0.0), bands);
    let width = fast::min(fast::max(change * bands, 1e-4), 1.0);
    let step = fast::min(fast::max((t + ROUND) - ROUND, 1.0), bands - 1.0);
    let beyond = fast::min(fast::max((t - step) / width + 0.5, 0.0), 1.0);
    (step - 1.0 + beyond) / (bands - 1.0)
}

crate::widest! {
    /// The tones of a row, from the values above, here and below; differences are central where
    /// both neighbors are linked, one-sided where one is.
    fn tones(values: [&RowValues; 3], linked: &[u8; TILE], bands: f32) -> RowValues {
        let [above, here, below] = values;
        // One more pixel at both ends, to which nothing is linked.
        let mut wide = [0.0; TILE + 2];
        wide[1..=TILE].copy_from_slice(here);
        let mut tones = [0.0; TILE];
        for x in 0..TILE {
            let to = |bit: u8| f32::from(u8::from(linked[x] & bit != 0));
            let (left, right, up, down) = (to(links::LEFT), to(links::RIGHT), to(links::UP), to(links::DOWN));
            let (across, along) = (1.0 - 0.5 * left * right, 1.0 - 0.5 * up * down);
            let dx = across * (left * (wide[x + 1] - wide[x]) + right * (wide[x + 2] - wide[x + 1]));
            let dy = along * (up * (here[x] - above[x]) + down * (below[x] - here[x]));
            tones[x] = tone(here[x], (dx * dx + dy * dy).sqrt(), bands);
        }
        tones
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, srgb::Color, vec3};
    use crate::raster::{Plane, TileAt};
    use crate::shading::{Light, LightKind, Model, Scaling, Term};
    use crate::surface::{Maps, Scene, Surface};
    use std::collections::BTreeSet;
    use std::sync::Arc;

    const SIZE: Size = Size::new(96, 96);

    /// A ball of radius 45 px, all of it visible.
    fn ball() -> Scene {
        let normals = Plane::from_fn(SIZE, |x, y| {
            let (u, v) = ((x as f32 - 47.5) / 45.0, (47.5 - y as f32) / 45.0);
            let z2 = 1.0 - u * u - v * v;
            if z2 > 0.0 { vec3(u, v, z2.sqrt()) } else { crate::math::Vec3::ZERO }
        });
        let depth = normals.map(|n| 1.0 - n.z);
        let coverage = normals.map(|n| if n.length() > 0.0 { 255 } else { 0 });
        Scene {
            size: SIZE,
            surface: Some(Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())),
        }
    }

    fn toon(bands: u32) -> Shading {
        let kind = LightKind::Directional { direction: vec3(0.4, 0.5, 0.75) };
        Shading {
            bands,
            lights: vec![Light { kind, ..Light::default() }],
            ambient: Term::NONE,
            diffuse: Term::plain(Color::WHITE, 1.0),
            specular: Term::NONE,
            ..Shading::new(Model::Toon)
        }
    }

    /// Red of every covered pixel of the ball.
    fn reds(shading: &Shading) -> Vec<((usize, usize), u8)> {
        let scene = ball();
        let tiles = TileAt::covering(SIZE.rect())
            .filter_map(|at| Some((at, shading.render_tile(&scene, at)?)));
        tiles
            .flat_map(|(at, tile)| {
                let pixels: Vec<_> =
                    tile.bytes().chunks_exact(4).map(|p| (p[0], p[3])).enumerate().collect();
                pixels.into_iter().filter(|(_, (_, a))| *a > 0).map(move |(i, (r, _))| {
                    ((at.rect().x0 as usize + i % TILE, at.rect().y0 as usize + i / TILE), r)
                })
            })
            .collect()
    }

    #[test]
    fn there_are_as_many_tones_as_bands_and_few_pixels_between_them() {
        for bands in [2, 4, 7] {
            let tone_of = |k: u32| {
                crate::math::srgb::quantize(crate::math::srgb::encode(
                    k as f32 / (bands - 1) as f32,
                ))
            };
            let tones: BTreeSet<u8> = (0..bands).map(tone_of).collect();
            let reds = reds(&toon(bands));
            let flat: Vec<u8> =
                reds.iter().map(|(_, r)| *r).filter(|r| tones.contains(r)).collect();
            assert_eq!(flat.iter().collect::<BTreeSet<_>>().len(), bands as usize);
            let between = reds.len() - flat.len();
            assert!(
                between > 20 && between < reds.len() / 6,
                "{between} of {} for {bands} bands",
                reds.len()
            );
        }
    }

    #[test]
    fn the_edges_of_bands_are_smooth() {
        // Each pixel compared with what 16 × 16 points in it show of the same ball.
        let shading = toon(3);
        let light = vec3(0.4, 0.5, 0.75).normalize();
        let mut worst = 0.0f32;
        for ((x, y), red) in reds(&shading) {
            let (mut sum, mut inside) = (0.0, 0);
            for i in 0..256 {
                let at = |i: usize| (i as f32 + 0.5) / 16.0 - 0.5;
                let u = (x as f32 + at(i % 16) - 47.5) / 45.0;
                let v = (47.5 - y as f32 - at(i / 16)) / 45.0;
                let z2 = 1.0 - u * u - v * v;
                if z2 > 0.0 {
                    let value = vec3(u, v, z2.sqrt()).dot(light).max(0.0);
                    sum += ((value * 3.0).floor() / 2.0).min(1.0);
                    inside += 1;
                }
            }
            // At the rim, normals turn within a pixel more than its neighbors show.
            if inside == 256 && (x as f32 - 47.5).hypot(y as f32 - 47.5) < 40.0 {
                let found = crate::math::srgb::decode(f32::from(red) / 255.0);
                worst = worst.max((found - sum / 256.0).abs());
            }
        }
        assert!(worst < 0.06, "{worst}: unfiltered edges are off by up to 0.25");
    }

    #[test]
    fn tones_are_found_after_scaling() {
        let plain = toon(4);
        let mut scaled = toon(4);
        scaled.diffuse.scaling = Scaling::new(0.2, 2.0);
        scaled.features.scales[0].curvature_scale_px = 30.0;
        let (plain, scaled) = (reds(&plain), reds(&scaled));
        let tones: BTreeSet<u8> = plain.iter().map(|(_, r)| *r).collect();
        let moved = plain.iter().zip(&scaled).filter(|(a, b)| a.1 != b.1).count();
        assert!(moved > plain.len() / 20, "{moved}");
        let flat = scaled.iter().filter(|(_, r)| tones.contains(r)).count();
        assert!(flat > scaled.len() * 7 / 8, "what was scaled is flat all the same");
    }

    #[test]
    fn a_tone_is_a_floor_with_its_steps_filtered() {
        for bands in [2.0f32, 4.0, 256.0] {
            for i in 0..1000 {
                let v = (i as f32 + 0.5) / 500.0;
                let step = ((v * bands).floor() / (bands - 1.0)).min(1.0);
                let distance = ((v * bands) - (v * bands).round()).abs() / bands;
                if distance > 1e-5 {
                    assert!((tone(v, 0.0, bands) - step).abs() < 1e-5, "{v} {bands}");
                }
            }
        }
        assert_eq!(tone(0.5, 0.1, 2.0), 0.5, "on the step half of the pixel is on either side");
        assert!((tone(0.52, 0.1, 2.0) - 0.7).abs() < 1e-5);
        assert!(tone(f32::NAN, f32::NAN, 4.0).is_finite());
    }
}
