//! Reads an environment over a footprint: from the picture itself for small footprints, else from a
//! pyramid of latitude-longitude maps without visible seam or poles. Floor 3. Directions are the
//! picture's own space, light is linear. Not here: the levels of the pyramid (`level`), many
//! footprints side by side (`rows`).

use super::level::{SphereLevel, Spot};
use super::projection::{Projection, lat_long_direction, lat_long_place};
use crate::math::{Size, Vec2, Vec3, Vec3A, fast, srgb, vec2};
use crate::raster::Picture;
use rayon::prelude::*;
use std::f32::consts::{PI, TAU};

/// An environment in linear light.
pub struct EnvironmentMap {
    picture: Picture,
    projection: Projection,
    brightest: f32,
    /// Each half as high as the one before, down to one row. Whatever the picture's projection,
    /// these are latitude-longitude, twice as wide as high.
    levels: Vec<SphereLevel>,
}

/// The most taps along a stretched footprint; a longer one is also blurred across.
const MOST_TAPS: f32 = 16.0;

/// The fewest rows of the finest level: even a picture of one pixel is integrated over hemispheres.
const FEWEST_ROWS: usize = 64;

/// Which layer of an environment shows so wide a cone: 0 is the finest level of the pyramid, −1 the
/// picture.
#[derive(Clone, Copy)]
pub(super) struct Layers {
    /// The angle of one texel of the picture.
    texel_rad: f32,
    /// The same, below that of the finest level.
    picture_rad: f32,
    finest_rad: f32,
    /// Layers for each doubling between these two.
    per_octave: f32,
    coarsest: f32,
}

impl Layers {
    /// A width that is no number means no cone: the picture.
    #[inline(always)]
    pub fn layer(self, width_rad: f32) -> f32 {
        let octaves = fast::log2(fast::max(width_rad / self.picture_rad, 1.0));
        let above_the_picture = fast::min(octaves * self.per_octave, 1.0) - 1.0;
        let level = fast::min(fast::log2(width_rad / self.finest_rad), self.coarsest);
        if width_rad >= self.finest_rad { level } else { above_the_picture }
    }
}

/// The taps along a footprint's longer axis.
pub(super) struct TapLine {
    pub along: Vec3,
    pub layer: f32,
    /// A whole number from 1 to [`MOST_TAPS`].
    pub taps: f32,
}

impl TapLine {
    /// For the footprint with J = [dx, dy].
    #[inline(always)]
    pub fn of(dx: Vec3, dy: Vec3, layers: Layers) -> Self {
        let (xx, xy, yy) = (dx.dot(dx), dx.dot(dy), dy.dot(dy));
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let radius = (half * half + xy * xy).sqrt();
        let (longer, shorter) = ((mean + radius).sqrt(), fast::max(mean - radius, 0.0).sqrt());
        // The direction of the longer axis, from its doubled angle: the larger of sine and cosine
        // first.
        let larger = (0.5 + 0.5 * (half.abs() / fast::max(radius, f32::MIN_POSITIVE))).sqrt();
        let smaller = 0.5 * xy / fast::max(radius * larger, f32::MIN_POSITIVE);
        let (cos, sin) = if half >= 0.0 { (larger, smaller) } else { (smaller, larger) };
        let width = fast::max(fast::max(shorter, layers.texel_rad), longer / MOST_TAPS);
        let taps = fast::min(fast::max((longer / width).ceil(), 1.0), MOST_TAPS);
        // Also false if it is no number.
        let is_wide = longer > layers.texel_rad;
        Self {
            along: if is_wide { dx * cos + dy * sin } else { Vec3::ZERO },
            layer: if is_wide { layers.layer(width) } else { -1.0 },
            taps: if is_wide { taps } else { 1.0 },
        }
    }

    /// The direction of a tap; it has about the length of `e`.
    #[inline(always)]
    pub fn direction(&self, e: Vec3, i: usize) -> Vec3 {
        e + self.along * ((i as f32 + 0.5) / self.taps - 0.5)
    }
}

impl EnvironmentMap {
    /// What a picture shows all around.
    pub fn new(picture: Picture, projection: Projection) -> Self {
        let mut map = Self { picture, projection, brightest: 0.0, levels: Vec::new() };
        map.brightest = map.find_brightest();
        let rows = ((PI / map.texel_rad() * 0.5) as usize).next_power_of_two().max(FEWEST_ROWS);
        let mut sums = map.resample(rows);
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

    /// The angle that one texel of the picture spans where its projection does not stretch it,
    /// radians.
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
        if self.projection == Projection::LatLong {
            return self.at_place(place).into();
        }
        let Size { width, height } = self.picture.size;
        let texel = |i, j| self.texel(i, j);
        bilinear(width as i32, height as i32, place, texel).unwrap_or_else(|| {
            // If all four texels lie beyond the disc: the nearest one on it.
            let inward = 1.0 - 3.0 / width.max(4) as f32;
            bilinear(width as i32, height as i32, 0.5 + (place - 0.5) * inward, texel)
                .unwrap_or_default()
        })
    }

    /// A texel of the picture by column and row; a latitude-longitude map wraps around, and beyond
    /// a disc there are none.
    fn texel(&self, i: i32, j: i32) -> Option<Vec3> {
        let (w, h) = (self.picture.size.width as i32, self.picture.size.height as i32);
        let (i, j) = match self.projection {
            Projection::LatLong => wrap_over_poles(i, j, w, h),
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
    pub fn mean_over_cone(&self, e: Vec3, width_rad: f32) -> Vec3 {
        self.at_layer(e, lat_long_place(e.x, e.y, e.z), self.layers().layer(width_rad)).into()
    }

    /// The mean light over the footprint of a pixel in which the direction changes by `dx` and by
    /// `dy`.
    ///
    /// The footprint is the ellipse with J = [dx, dy]: taps along its major axis, each as wide as
    /// the minor one.
    pub fn mean_over_pixel(&self, e: Vec3, dx: Vec3, dy: Vec3) -> Vec3 {
        let layers = self.layers();
        let line = TapLine::of(dx, dy, layers);
        let tap = |i: usize| {
            let e = line.direction(e, i);
            self.at_layer(e, lat_long_place(e.x, e.y, e.z), line.layer)
        };
        ((0..line.taps as usize).map(tap).sum::<Vec3A>() / line.taps).into()
    }

    pub(super) fn layers(&self) -> Layers {
        let texel_rad = self.texel_rad();
        let finest_rad = PI / self.levels[0].rows() as f32;
        let picture_rad = texel_rad.min(finest_rad * 0.99);
        let per_octave = 1.0 / (finest_rad / picture_rad).log2();
        Layers {
            texel_rad,
            picture_rad,
            finest_rad,
            per_octave,
            coarsest: (self.levels.len() - 1) as f32,
        }
    }

    /// Light from a direction of any length, and its place in a latitude-longitude map; between two
    /// layers where `layer` is not whole.
    #[inline(always)]
    pub(super) fn at_layer(&self, e: Vec3, place: Vec2, layer: f32) -> Vec3A {
        let fine = layer.floor();
        let t = layer - fine;
        let near = match self.projection {
            _ if fine >= 0.0 => self.level_at(fine as usize).at_place(place),
            Projection::LatLong => self.at_place(place),
            _ => self.disc_at(e),
        };
        let coarser = || self.level_at((fine + 1.0) as usize).at_place(place);
        if t > 0.0 { near * (1.0 - t) + coarser() * t } else { near }
    }

    /// A picture that is a disc, from a direction of any length.
    pub(super) fn disc_at(&self, e: Vec3) -> Vec3A {
        self.at(e.normalize_or_zero()).into()
    }

    /// A latitude-longitude picture, bilinear.
    #[inline(always)]
    fn at_place(&self, place: Vec2) -> Vec3A {
        let Size { width, height } = self.picture.size;
        Spot::wrap(place, width as i32, height as i32).mean(|i| self.picture_texel(i))
    }

    /// A texel of the picture by its number.
    #[inline(always)]
    pub(super) fn picture_texel(&self, i: usize) -> Vec3A {
        let [r, g, b, _] = self.picture.linear_texel(i);
        Vec3A::new(r, g, b)
    }

    /// A level of the pyramid, 0 the finest.
    #[inline(always)]
    pub(super) fn level_at(&self, layer: usize) -> &SphereLevel {
        &self.levels[layer.min(self.levels.len() - 1)]
    }

    /// Of a latitude-longitude picture; `None` for a disc, which is read pixel by pixel.
    pub(super) fn lat_long_size(&self) -> Option<Size> {
        (self.projection == Projection::LatLong).then_some(self.picture.size)
    }

    /// The level with `rows` rows, or the finest if the picture has fewer.
    pub(super) fn level(&self, rows: usize) -> &SphereLevel {
        self.levels.iter().find(|level| level.rows() <= rows).unwrap_or(&self.levels[0])
    }

    /// The picture as a latitude-longitude map, each texel the mean of several look-ups.
    fn resample(&self, rows: usize) -> SphereLevel {
        // A disc stretches what lies behind, so that more of its texels fall into one.
        let per_side = if self.projection.is_disc() { 4 } else { 2 };
        let columns = 2 * rows;
        let texel = |i: usize| {
            let (column, row) = ((i % columns) as f32, (i / columns) as f32);
            let place = |k: usize| (k as f32 + 0.5) / per_side as f32;
            let mut sum = Vec3::ZERO;
            for k in 0..per_side * per_side {
                let (u, v) = (
                    (column + place(k % per_side)) / columns as f32,
                    (row + place(k / per_side)) / rows as f32,
                );
                sum += self.at(lat_long_direction(u, v));
            }
            Vec3A::from(sum / (per_side * per_side) as f32)
        };
        SphereLevel::new(rows, (0..rows * columns).into_par_iter().map(texel).collect())
    }
}

/// The texel of a latitude-longitude map at a column and row that may lie beyond it: columns wrap
/// around, and beyond a pole the rows come back on the other side.
#[inline(always)]
fn wrap_over_poles(i: i32, j: i32, w: i32, h: i32) -> (i32, i32) {
    let (i, j) = match j {
        j if j < 0 => (i + w / 2, -1 - j),
        j if j >= h => (i + w / 2, 2 * h - 1 - j),
        _ => (i, j),
    };
    (i.rem_euclid(w), j.clamp(0, h - 1))
}

/// Interpolates between the existing ones of the four texels around `place` in `[0, 1]²`; `None` if
/// there are none.
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
