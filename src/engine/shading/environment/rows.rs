//! Reads an environment for a row of pixels: the taps of many footprints side by side. Floor 3. The
//! readable twin is `EnvironmentMap::mean_over_pixel`; both compute the same bits.

use super::level::{SphereLevel, Spot};
use super::map::{EnvironmentMap, Layers, TapLine};
use super::projection::lat_long_place;
use crate::math::{Size, Vec3, Vec3A, fast, vec2, vec3};
use crate::raster::TILE;
use crate::shading::surface_row::{Light3, RowValues};

/// A direction for each pixel of a row.
pub type Directions = [RowValues; 3];

/// Footprints along a row, as [`TapLine`].
struct TapLines {
    along: Directions,
    layer: RowValues,
    taps: RowValues,
}

/// Taps that are read together.
struct LightTaps {
    len: usize,
    directions: Directions,
    layer: RowValues,
    /// The pixel that each belongs to.
    pixel: [u8; TILE],
}

impl EnvironmentMap {
    /// [`EnvironmentMap::mean_over_pixel`] at the covered pixels of a row.
    pub fn mean_over_pixel_row(
        &self,
        e: &Directions,
        dx: &Directions,
        dy: &Directions,
        covered: &[u8],
        light: &mut Light3,
    ) {
        let mut lines = TapLines { along: [[0.0; TILE]; 3], layer: [0.0; TILE], taps: [1.0; TILE] };
        find_lines(dx, dy, self.layers(), &mut lines);
        let mut sums = [Vec3A::ZERO; TILE];
        let mut run = LightTaps::default();
        for (x, _) in covered.iter().enumerate().take(TILE).filter(|(_, c)| **c > 0) {
            let along = vec3(lines.along[0][x], lines.along[1][x], lines.along[2][x]);
            let line = TapLine { along, layer: lines.layer[x], taps: lines.taps[x] };
            let e = vec3(e[0][x], e[1][x], e[2][x]);
            for i in 0..line.taps as usize {
                run.push(x, line.direction(e, i), line.layer);
                if run.len == TILE {
                    add_run(self, &run, &mut sums);
                    run.len = 0;
                }
            }
        }
        add_run(self, &run, &mut sums);
        for (x, (sum, taps)) in sums.iter().zip(lines.taps).enumerate() {
            [light[0][x], light[1][x], light[2][x]] = (*sum / taps).to_array();
        }
    }

    /// [`EnvironmentMap::mean_over_cone`] at the pixels of a row that `wanted` is not 0 at.
    pub fn mean_over_cone_row(
        &self,
        e: &Directions,
        width_rad: &RowValues,
        wanted: &RowValues,
        light: &mut Light3,
    ) {
        let mut layer = [0.0; TILE];
        find_layers(width_rad, self.layers(), &mut layer);
        let mut run = LightTaps::default();
        for (x, _) in wanted.iter().enumerate().filter(|(_, w)| **w != 0.0) {
            let direction = vec3(e[0][x], e[1][x], e[2][x]);
            run.push(x, direction, layer[x]);
        }
        let mut sums = [Vec3A::ZERO; TILE];
        add_run(self, &run, &mut sums);
        for (x, sum) in sums.iter().enumerate() {
            [light[0][x], light[1][x], light[2][x]] = sum.to_array();
        }
    }
}

impl Default for LightTaps {
    fn default() -> Self {
        Self { len: 0, directions: [[0.0; TILE]; 3], layer: [0.0; TILE], pixel: [0; TILE] }
    }
}

impl LightTaps {
    /// `len` must be below [`TILE`].
    #[inline(always)]
    fn push(&mut self, x: usize, direction: Vec3, layer: f32) {
        let k = self.len % TILE;
        (self.directions[0][k], self.directions[1][k], self.directions[2][k]) = direction.into();
        (self.layer[k], self.pixel[k]) = (layer, x as u8);
        self.len += 1;
    }
}

crate::widest! {
    /// The taps of each pixel's footprint.
    fn find_lines(dx: &Directions, dy: &Directions, layers: Layers, lines: &mut TapLines) {
        for x in 0..TILE {
            let (dx, dy) = (vec3(dx[0][x], dx[1][x], dx[2][x]), vec3(dy[0][x], dy[1][x], dy[2][x]));
            let line = TapLine::of(dx, dy, layers);
            (lines.along[0][x], lines.along[1][x], lines.along[2][x]) = (line.along.x, line.along.y, line.along.z);
            (lines.layer[x], lines.taps[x]) = (line.layer, line.taps);
        }
    }

    fn find_layers(width_rad: &RowValues, layers: Layers, layer: &mut RowValues) {
        for x in 0..TILE {
            layer[x] = layers.layer(width_rad[x]);
        }
    }

    /// Adds a run's taps to the sums of their pixels.
    fn add_run(map: &EnvironmentMap, run: &LightTaps, sums: &mut [Vec3A; TILE]) {
        let [mut u, mut v, mut t] = [[0.0; TILE]; 3];
        let mut near = SpotRow { index: [[0; TILE]; 4], weight: [[0.0; TILE]; 4], layer: [0; TILE] };
        let mut coarser = near;
        find_places(&run.directions, &mut u, &mut v);
        for (k, t) in t.iter_mut().enumerate() {
            let fine = run.layer[k].floor();
            *t = run.layer[k] - fine;
            (near.layer[k], coarser.layer[k]) = (fast::whole(fine), fast::whole(fine) + 1);
        }
        let finest_rows = map.level_at(0).rows() as i32;
        let picture = map.lat_long_size().unwrap_or(Size::new(0, 0));
        near.find(&u, &v, finest_rows, picture);
        coarser.find(&u, &v, finest_rows, picture);
        for k in 0..run.len.min(TILE) {
            let mut light = match near.layer[k] {
                0.. => near.mean(map, k),
                _ if picture.width > 0 => near.spot(k).mean(|i| map.picture_texel(i)),
                _ => map.disc_at(vec3(run.directions[0][k], run.directions[1][k], run.directions[2][k])),
            };
            if t[k] > 0.0 {
                light = light * (1.0 - t[k]) + coarser.mean(map, k) * t[k];
            }
            sums[run.pixel[k] as usize % TILE] += light;
        }
    }

    /// Light of one level from the directions of a row.
    pub fn read_level(level: &SphereLevel, e: &Directions, light: &mut Light3) {
        let [mut u, mut v] = [[0.0; TILE]; 2];
        find_places(e, &mut u, &mut v);
        for x in 0..TILE {
            let here = level.at_place(vec2(u[x], v[x])).to_array();
            (light[0][x], light[1][x], light[2][x]) = here.into();
        }
    }
}

/// The texels that taps read in a layer each.
#[derive(Clone, Copy)]
struct SpotRow {
    /// As [`Layers::layer`].
    layer: [i32; TILE],
    index: [[i32; TILE]; 4],
    weight: [[f32; TILE]; 4],
}

impl SpotRow {
    /// Finds them for places, in a pyramid of so many rows above a latitude-longitude picture.
    #[inline(always)]
    fn find(&mut self, u: &RowValues, v: &RowValues, finest_rows: i32, picture: Size) {
        for k in 0..TILE {
            let rows = (finest_rows >> (self.layer[k] & 31)).max(1);
            let is_picture = self.layer[k] < 0;
            let columns = if is_picture { picture.width as i32 } else { 2 * rows };
            let rows = if is_picture { picture.height as i32 } else { rows };
            let spot = Spot::wrap(vec2(u[k], v[k]), columns, rows);
            for i in 0..4 {
                self.index[i][k] = spot.index[i];
                self.weight[i][k] = spot.weight[i];
            }
        }
    }

    #[inline(always)]
    fn spot(&self, k: usize) -> Spot {
        let ([i, j, l, m], [a, b, c, d]) = (&self.index, &self.weight);
        Spot { index: [i[k], j[k], l[k], m[k]], weight: [a[k], b[k], c[k], d[k]] }
    }

    /// The light of a tap in its level of the pyramid.
    #[inline(always)]
    fn mean(&self, map: &EnvironmentMap, k: usize) -> Vec3A {
        let level = map.level_at(self.layer[k] as usize);
        self.spot(k).mean(|i| level.texel(i))
    }
}

/// Places in a latitude-longitude map.
#[inline(always)]
fn find_places(e: &Directions, u: &mut RowValues, v: &mut RowValues) {
    for x in 0..TILE {
        let place = lat_long_place(e[0][x], e[1][x], e[2][x]);
        (u[x], v[x]) = (place.x, place.y);
    }
}
