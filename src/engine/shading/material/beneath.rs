//! The painter's light on the picture beneath a layer: its colors are lit where the surface is,
//! and the page around it is shaded. Floor 3. Not here: the light itself (`painter`).

use super::{Shading, painter::PainterTerms};
use crate::math::{fast, srgb};
use crate::raster::planar::{BRIGHTEST, PixelRow};
use crate::raster::{PlanarTile, TILE, TileAt};
use crate::shading::light::RowLight;
use crate::shading::pixel::KnownTones;
use crate::shading::radiance::Exactness;
use crate::shading::surface_row::{Light3, SurfaceRow};
use crate::surface::shadow::ShareMap;
use crate::surface::{Scene, Surface};
use std::sync::Arc;

impl Shading {
    /// Lights the pixels of a tile: premultiplied sRGB. What is off the surface stays, or is shaded
    /// as the page is.
    pub fn light_tile(
        &self,
        scene: &Scene,
        at: TileAt,
        exactness: Exactness,
        pixels: &mut PlanarTile,
    ) {
        let Some(surface) = scene.surface.as_deref() else { return };
        let inside = scene.area(at);
        if inside.is_empty() {
            return;
        }
        let features = self.features.on(surface);
        let (x0, width) = (inside.x0 as usize, inside.width());
        let mut surface_row = SurfaceRow::new(surface, &features, x0, inside.y0 as usize, width);
        let mut lights = self.row_lights(surface);
        let mut terms = PainterTerms::new(self, surface, &lights);
        let (ground, mut tones) = (self.ground_maps(surface), KnownTones::default());
        for (row, y) in pixels.rows_mut().iter_mut().zip(inside.y0..inside.y1) {
            surface_row.move_to(y as usize);
            let coverage = surface_row.coverage();
            if coverage.iter().any(|&c| c > 0) {
                lights.iter_mut().for_each(|lit| lit.turn(&surface_row));
                terms.read(&surface_row, &lights, 0);
                let mut covered = [false; TILE];
                covered.iter_mut().zip(coverage).for_each(|(covered, c)| *covered = *c > 0);
                match self.pixel.is_on() {
                    true => {
                        let places = std::array::from_fn(|x| Some((x0 + x, y as usize)));
                        self.tone_row(&terms, &lights, &covered, (&places, &mut tones), row);
                    }
                    false => self.light_row(&terms, &lights, exactness, &covered, row),
                }
            }
            if !ground.is_empty() {
                let bare = coverage.iter().enumerate().filter(|(_, c)| **c == 0);
                bare.for_each(|(x, _)| self.shade_page(&ground, (x0 + x, y as usize), row, x));
            }
        }
    }

    /// The same for rows of pixels that lie anywhere: `places` holds the place on a surface of each
    /// pixel, or that it is off it; `canvas` that of the canvas. They see `sheet`, and `front` is
    /// what the canvas shows.
    pub fn light_packed(
        &self,
        [sheet, front]: [Option<&Surface>; 2],
        places: &[Option<(usize, usize)>],
        canvas: &[Option<(usize, usize)>],
        exactness: Exactness,
        pixels: &mut PlanarTile,
    ) {
        let ground = front.map_or(Vec::new(), |front| self.ground_maps(front));
        let mut lit = sheet.map(|sheet| {
            let lights = self.row_lights(sheet);
            let terms = PainterTerms::new(self, sheet, &lights);
            (sheet, self.features.on(sheet), lights, terms)
        });
        let mut tones = KnownTones::default();
        let rows = places.chunks_exact(TILE).zip(canvas.chunks_exact(TILE));
        for (row, (places, at)) in pixels.rows_mut().iter_mut().zip(rows) {
            if let Some((sheet, features, lights, terms)) = &mut lit {
                let (mut covered, mut row_of_one) = ([false; TILE], None);
                for (x, place) in places.iter().enumerate() {
                    if let Some((px, py)) = *place {
                        let surface_row = row_of_one
                            .get_or_insert_with(|| SurfaceRow::new(sheet, features, px, py, 1));
                        surface_row.move_to_pixel(px, py);
                        lights.iter_mut().for_each(|lit| lit.turn(surface_row));
                        terms.read(surface_row, lights, x);
                        covered[x] = true;
                    }
                }
                match self.pixel.is_on() {
                    _ if !covered.contains(&true) => {}
                    true => {
                        let places = std::array::from_fn(|x| at.get(x).copied().flatten());
                        self.tone_row(terms, lights, &covered, (&places, &mut tones), row);
                    }
                    false => self.light_row(terms, lights, exactness, &covered, row),
                }
            }
            if !ground.is_empty() {
                let bare = places.iter().zip(at).enumerate();
                for (x, at) in bare.filter(|(_, (place, _))| place.is_none()).map(|(x, p)| (x, p.1))
                {
                    let page = front.zip(*at).and_then(|(front, at)| page_beside(front, at));
                    if let Some(at) = page {
                        self.shade_page(&ground, at, row, x);
                    }
                }
            }
        }
    }

    fn light_row(
        &self,
        terms: &PainterTerms,
        lights: &[RowLight],
        exactness: Exactness,
        covered: &[bool; TILE],
        row: &mut PixelRow,
    ) {
        let (mut albedo, mut light) = ([[0.0; TILE]; 3], [[0.0; TILE]; 3]);
        match exactness {
            Exactness::Fast => decode_row(row, &mut albedo),
            Exactness::Exact | Exactness::ExactLight => {
                for (albedo, channel) in albedo.iter_mut().zip(&row.rgb) {
                    for (x, albedo) in albedo.iter_mut().enumerate() {
                        *albedo = srgb::decode(channel[x] / row.a[x].max(f32::MIN_POSITIVE));
                    }
                }
            }
        }
        terms.shade(self, lights, &albedo, &mut light);
        match exactness {
            Exactness::Fast => encode_row(&light, covered, row),
            Exactness::Exact => encode_exactly(&light, covered, 1.0, row),
            Exactness::ExactLight => encode_exactly(&light, covered, BRIGHTEST, row),
        }
    }

    /// The same in a few tones of each color. `at`: the places of the pixels on the canvas, and the
    /// tones that are known.
    fn tone_row(
        &self,
        terms: &PainterTerms,
        lights: &[RowLight],
        covered: &[bool; TILE],
        (places, tones): (&[Option<(usize, usize)>; TILE], &mut KnownTones),
        row: &mut PixelRow,
    ) {
        let light = terms.brightness(self, lights);
        let level = terms.leveled().brightness(self, lights);
        for x in (0..TILE).filter(|x| covered[*x] && row.a[*x] > 0.0) {
            let is_odd = places[x].is_some_and(|(x, y)| (x + y) % 2 == 1);
            let step = self.pixel.step(light[x] / level[x].max(1e-4), is_odd);
            let own = [0, 1, 2].map(|c| srgb::quantize(row.rgb[c][x] / row.a[x]));
            if step != 0 {
                let tone = tones.tone(&self.pixel, own, step);
                for (channel, tone) in row.rgb.iter_mut().zip(tone) {
                    channel[x] = f32::from(tone) / 255.0 * row.a[x];
                }
            }
        }
    }

    /// What is seen of the lamps, if the page is shaded.
    pub(super) fn ground_maps(&self, surface: &Surface) -> Vec<Arc<ShareMap>> {
        match self.has_ground_shadow() {
            true => self.shadows.maps(surface, &self.lights),
            false => Vec::new(),
        }
    }

    /// Lays the shadow of a canvas pixel over pixel `x` of a row.
    fn shade_page(&self, maps: &[Arc<ShareMap>], at: (usize, usize), row: &mut PixelRow, x: usize) {
        let share = self.shadows.ground_at(maps, &self.lights, at);
        let ground = self.shadows.ground;
        let share = match self.pixel.is_on() {
            true if share < 0.5 * ground => 0.0,
            true => ground,
            false => share,
        };
        if share > 0.0 {
            let color = self.shadows.color.to_f32();
            for (channel, color) in row.rgb.iter_mut().zip(color) {
                channel[x] += (color - channel[x]) * share;
            }
            row.a[x] += (1.0 - row.a[x]) * share;
        }
    }
}

/// The nearest pixel of the page to one of a silhouette's pixels, two pixels away at most.
fn page_beside(surface: &Surface, (x, y): (usize, usize)) -> Option<(usize, usize)> {
    const AROUND: [(i32, i32); 12] = [
        (0, -1),
        (-1, 0),
        (1, 0),
        (0, 1),
        (-1, -1),
        (1, -1),
        (-1, 1),
        (1, 1),
        (0, -2),
        (-2, 0),
        (2, 0),
        (0, 2),
    ];
    let beside = AROUND.map(|(dx, dy)| (x as i32 + dx, y as i32 + dy)).into_iter();
    let page = |&(x, y): &(i32, i32)| surface.coverage_plane().get(x, y) == Some(0);
    beside.filter(page).map(|(x, y)| (x as usize, y as usize)).next()
}

fn encode_exactly(light: &Light3, covered: &[bool; TILE], brightest: f32, row: &mut PixelRow) {
    for (channel, light) in row.rgb.iter_mut().zip(light) {
        for x in (0..TILE).filter(|x| covered[*x]) {
            channel[x] = srgb::encode(light[x].max(0.0)).min(brightest) * row.a[x];
        }
    }
}

crate::widest! {
    /// Premultiplied sRGB to the linear light of the color.
    fn decode_row(row: &PixelRow, albedo: &mut Light3) {
        for (channel, albedo) in row.rgb.iter().zip(albedo) {
            for ((value, a), out) in channel.iter().zip(&row.a).zip(albedo) {
                let per_a = 1.0 / fast::max(*a, f32::MIN_POSITIVE);
                *out = srgb::decode_fast(fast::min(fast::max(value * per_a, 0.0), 1.0));
            }
        }
    }

    /// Linear light to premultiplied sRGB, clipped, where the surface is.
    fn encode_row(light: &Light3, covered: &[bool; TILE], row: &mut PixelRow) {
        for (channel, light) in row.rgb.iter_mut().zip(light) {
            for x in 0..TILE {
                let v = srgb::encode_fast(fast::min(fast::max(light[x], 0.0), 1.0)) * row.a[x];
                channel[x] = if covered[x] { v } else { channel[x] };
            }
        }
    }
}
