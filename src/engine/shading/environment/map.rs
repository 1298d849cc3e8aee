//! Reads an environment over a footprint: from the picture itself for small footprints, else from a pyramid of
//! latitude-longitude maps without visible seam or poles. Floor 3. Directions are the picture's own space, light is
//! linear.

use super::projection::{Projection, lat_long_direction};
use crate::math::{Size, Vec2, Vec3, srgb, vec2};
use crate::raster::Picture;
use rayon::prelude::*;
use std::f32::consts::{PI, TAU};

/// An environment in linear light.
pub struct EnvironmentMap {
    picture: Picture,
    projection: Projection,
    brightest: f32,
    /// Each half as high as the one before, down to one row. Whatever the picture's projection, these are
    /// latitude-longitude, twice as wide as high.
    levels: Vec<SphereLevel>,
}

/// Means over about equally large parts of the sphere.
pub(super) struct SphereLevel {
    /// A power of two.
    rows: usize,
    texels: Vec<Vec3>,
}

/// The most taps along a stretched footprint; a longer one is also blurred across.
const MOST_TAPS: f32 = 16.0;

/// The fewest rows of the finest level: even a picture of one pixel is integrated over hemispheres.
const FEWEST_ROWS: usize = 64;

impl EnvironmentMap {
    pub fn new(picture: Picture, projection: Projection) -> Self {
        let mut map = Self { picture, projection, brightest: 0.0, levels: Vec::new() };
        map.brightest = map.find_brightest();
        let rows = ((PI / map.texel_rad() * 0.5) as usize).next_power_of_two().max(FEWEST_ROWS);
        let mut sums = map.resampled(rows);
        loop {
            let halved = sums.halved();
            map.levels.push(sums.rounded_at_the_poles());
            match halved {
                Some(next) => sums = next,
                None => return map,
            }
        }
    }
    /// The greatest luminance of any texel: max L_env of MATH 5.
    pub fn brightest(&self) -> f32 {
        self.brightest
    }
    fn find_brightest(&self) -> f32 {
        let (w, h) = (self.picture.size.width as i32, self.picture.size.height as i32);
        let luminance = |i: i32, j: i32| {
            let light = self.texel(i, j).unwrap_or_default();
            srgb::luminance(light.x, light.y, light.z)
        };
        let of_row = |j: i32| (0..w).map(|i| luminance(i, j)).fold(0.0, f32::max);
        // A maximum does not depend on its order.
        (0..h).into_par_iter().map(of_row).reduce(|| 0.0, f32::max)
    }
    /// The angle that one texel of the picture spans where its projection does not stretch it, radians.
    fn texel_rad(&self) -> f32 {
        let Size { width, height } = self.picture.size;
        match self.projection {
            Projection::LatLong => PI / height as f32,
            Projection::Angular => TAU / width as f32,
            // The mirrored view turns twice as fast as the normal.
            Projection::MirrorBall => 4.0 / width as f32,
        }
    }
    /// Light from a unit direction: the picture, bilinear.
    pub fn at(&self, e: Vec3) -> Vec3 {
        let place = self.projection.place(e);
        let Size { width, height } = self.picture.size;
        let texel = |i, j| self.texel(i, j);
        bilinear(width as i32, height as i32, place, texel).unwrap_or_else(|| {
            // If all four texels lie beyond the disc: the nearest one on it.
            let inward = 1.0 - 3.0 / width.max(4) as f32;
            bilinear(width as i32, height as i32, 0.5 + (place - 0.5) * inward, texel).unwrap_or_default()
        })
    }
    /// A texel of the picture by column and row; a latitude-longitude map wraps around, and beyond a disc there are
    /// none.
    fn texel(&self, i: i32, j: i32) -> Option<Vec3> {
        let (w, h) = (self.picture.size.width as i32, self.picture.size.height as i32);
        let (i, j) = match self.projection {
            Projection::LatLong => across_the_poles(i, j, w, h),
            _ => (i.clamp(0, w - 1), j.clamp(0, h - 1)),
        };
        let center = vec2(i as f32 + 0.5, j as f32 + 0.5) / vec2(w as f32, h as f32) - 0.5;
        if self.projection.is_disc() && center.length_squared() > 0.25 {
            return None;
        }
        let [r, g, b, _] = self.picture.linear_at(i as usize, j as usize);
        Some(Vec3::new(r, g, b))
    }
    /// The mean light over a cone of about `width_rad` across.
    pub fn around(&self, e: Vec3, width_rad: f32) -> Vec3 {
        let finest = PI / self.levels[0].rows as f32;
        if width_rad >= finest {
            let level = (width_rad / finest).log2();
            return self.between_levels(e, level);
        }
        let picture = self.texel_rad().min(finest * 0.99);
        let t = ((width_rad / picture).max(1.0).log2() / (finest / picture).log2()).min(1.0);
        // NaN means no footprint: the picture.
        if t > 0.0 { self.at(e).lerp(self.levels[0].at(e), t) } else { self.at(e) }
    }
    /// `level ≥ 0`: between two levels where it is not whole.
    fn between_levels(&self, e: Vec3, level: f32) -> Vec3 {
        let level = level.min((self.levels.len() - 1) as f32);
        let (fine, t) = (level as usize, level.fract());
        let near = self.levels[fine].at(e);
        if t == 0.0 { near } else { near.lerp(self.levels[fine + 1].at(e), t) }
    }
    /// The mean light over the footprint of a pixel in which the direction changes by `dx` and by `dy`.
    ///
    /// The footprint is the ellipse with J = [dx, dy]: taps along its major axis, each as wide as the minor one.
    pub fn over(&self, e: Vec3, dx: Vec3, dy: Vec3) -> Vec3 {
        let (xx, xy, yy) = (dx.dot(dx), dx.dot(dy), dy.dot(dy));
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let radius = half.hypot(xy);
        let (longer, shorter) = ((mean + radius).sqrt(), (mean - radius).max(0.0).sqrt());
        let texel = self.texel_rad();
        if longer.is_nan() || longer <= texel {
            return self.at(e);
        }
        let (sin, cos) = (0.5 * xy.atan2(half)).sin_cos();
        let along = dx * cos + dy * sin;
        let width = shorter.max(texel).max(longer / MOST_TAPS);
        let taps = (longer / width).ceil().clamp(1.0, MOST_TAPS);
        let tap = |i: i32| {
            let offset = (i as f32 + 0.5) / taps - 0.5;
            self.around((e + along * offset).normalize_or(e), width)
        };
        (0..taps as i32).map(tap).sum::<Vec3>() / taps
    }
    /// The level with `rows` rows, or the finest if the picture has fewer.
    pub(super) fn level(&self, rows: usize) -> &SphereLevel {
        self.levels.iter().find(|level| level.rows <= rows).unwrap_or(&self.levels[0])
    }
    /// The picture as a latitude-longitude map, each texel the mean of several look-ups.
    fn resampled(&self, rows: usize) -> SphereLevel {
        // A disc stretches what lies behind, so that more of its texels fall into one.
        let per_side = if self.projection.is_disc() { 4 } else { 2 };
        let columns = 2 * rows;
        let texel = |i: usize| {
            let (column, row) = ((i % columns) as f32, (i / columns) as f32);
            let place = |k: usize| (k as f32 + 0.5) / per_side as f32;
            let mut sum = Vec3::ZERO;
            for k in 0..per_side * per_side {
                let (u, v) =
                    ((column + place(k % per_side)) / columns as f32, (row + place(k / per_side)) / rows as f32);
                sum += self.at(lat_long_direction(u, v));
            }
            sum / (per_side * per_side) as f32
        };
        SphereLevel::new(rows, (0..rows * columns).into_par_iter().map(texel).collect())
    }
}

impl SphereLevel {
    /// `rows` a power of two, twice as many columns.
    pub fn new(rows: usize, texels: Vec<Vec3>) -> Self {
        Self { rows, texels }
    }
    pub fn rows(&self) -> usize {
        self.rows
    }
    pub fn columns(&self) -> usize {
        2 * self.rows
    }
    /// Row by row.
    pub fn texels(&self) -> &[Vec3] {
        &self.texels
    }
    /// Light from a direction, bilinear.
    pub fn at(&self, e: Vec3) -> Vec3 {
        let (w, h) = (self.columns() as i32, self.rows as i32);
        let texel = |i, j| {
            let (i, j) = across_the_poles(i, j, w, h);
            Some(self.texels[(j * w + i) as usize])
        };
        bilinear(w, h, Projection::LatLong.place(e), texel).unwrap_or_default()
    }
    /// Solid angle of a texel in a row, steradians.
    pub fn solid_angle(&self, row: usize) -> f32 {
        let edge = |row: usize| (row as f32 / self.rows as f32 * PI).cos();
        TAU / self.columns() as f32 * (edge(row) - edge(row + 1))
    }
    /// Half as many rows and columns: means weighted by solid angle.
    fn halved(&self) -> Option<SphereLevel> {
        let rows = self.rows / 2;
        let columns = 2 * rows;
        let texel = |i: usize| {
            let (x, y) = (2 * (i % columns), 2 * (i / columns));
            let pair = |y: usize| self.texels[y * self.columns() + x] + self.texels[y * self.columns() + x + 1];
            let (above, below) = (self.solid_angle(y), self.solid_angle(y + 1));
            (pair(y) * above + pair(y + 1) * below) / (2.0 * (above + below))
        };
        (rows > 0).then(|| SphereLevel::new(rows, (0..rows * columns).map(texel).collect()))
    }
    /// Averages each row over as many texels as fit one texel's height: near the poles texels are slivers, and a lookup
    /// must not read a single one.
    fn rounded_at_the_poles(self) -> SphereLevel {
        let columns = self.columns();
        let of_row = |row: usize| {
            let texels = &self.texels[row * columns..][..columns];
            // The outermost row is a cap around the pole, one texel across: it gets one value, so that the pole is
            // unique.
            let is_cap = row == 0 || row + 1 == self.rows;
            let sin = ((row as f32 + 0.5) / self.rows as f32 * PI).sin();
            around_row(texels, if is_cap { columns as f32 } else { 1.0 / sin })
        };
        SphereLevel::new(self.rows, (0..self.rows).into_par_iter().flat_map_iter(of_row).collect())
    }
}

/// The mean over `width` texels around each texel of a cyclic row.
fn around_row(texels: &[Vec3], width: f32) -> Vec<Vec3> {
    let n = texels.len();
    if width <= 1.0 {
        return texels.to_vec();
    }
    // Whole texels on both sides, and the rest of the width as a fraction of one more.
    let width = width.min(n as f32);
    let whole = ((width - 1.0) / 2.0) as usize;
    let part = (width - 1.0) / 2.0 - whole as f32;
    let mean = |i: usize| {
        let texel = |offset: usize, back: bool| texels[if back { i + n - offset } else { i + offset } % n];
        let mut sum = texels[i];
        for k in 1..=whole {
            sum += texel(k, true) + texel(k, false);
        }
        let next = whole + 1;
        (sum + (texel(next, true) + texel(next, false)) * part) / (1.0 + 2.0 * (whole as f32 + part))
    };
    (0..n).map(mean).collect()
}

/// The texel of a latitude-longitude map at a column and row that may lie beyond it: columns wrap around, and beyond a
/// pole the rows come back on the other side.
#[inline(always)]
fn across_the_poles(i: i32, j: i32, w: i32, h: i32) -> (i32, i32) {
    let (i, j) = match j {
        j if j < 0 => (i + w / 2, -1 - j),
        j if j >= h => (i + w / 2, 2 * h - 1 - j),
        _ => (i, j),
    };
    (i.rem_euclid(w), j.clamp(0, h - 1))
}

/// Interpolates between the existing ones of the four texels around `place` in `[0, 1]²`; `None` if there are none.
#[inline(always)]
fn bilinear(w: i32, h: i32, place: Vec2, texel: impl Fn(i32, i32) -> Option<Vec3>) -> Option<Vec3> {
    let p = place * vec2(w as f32, h as f32) - 0.5;
    // An invalid direction finds the corner, not NaN.
    let p = if p.is_finite() { p } else { Vec2::ZERO };
    let floor = p.floor();
    let t = p - floor;
    let (i, j) = (floor.x as i32, floor.y as i32);
    let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
    let mut add = |i: i32, j: i32, weight: f32| {
        if let Some(texel) = texel(i, j).filter(|_| weight > 0.0) {
            sum += texel * weight;
            weights += weight;
        }
    };
    add(i, j, (1.0 - t.x) * (1.0 - t.y));
    add(i + 1, j, t.x * (1.0 - t.y));
    add(i, j + 1, (1.0 - t.x) * t.y);
    add(i + 1, j + 1, t.x * t.y);
    (weights > 0.0).then(|| sum / weights)
}
