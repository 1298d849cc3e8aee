//! A level of an environment's pyramid: a latitude-longitude map of means, without visible seam or
//! poles. Floor 3.

use super::projection::lat_long_place;
use crate::math::{Vec2, Vec3, Vec3A, fast, parallel};
use std::f32::consts::{PI, TAU};

/// Means over about equally large parts of the sphere, twice as many columns as rows. Texels take
/// 16 bytes, so that each is read by one instruction.
pub struct SphereLevel {
    /// A power of two.
    rows: usize,
    texels: Vec<Vec3A>,
}

/// The four texels around a place of a latitude-longitude map, and their bilinear weights.
pub struct Spot {
    /// Numbers of texels, row by row.
    pub index: [i32; 4],
    /// The weight of each texel.
    pub weight: [f32; 4],
}

impl Spot {
    /// `place` in `[0, 1]²`: columns wrap around, and beyond a pole the rows come back on the other
    /// side.
    #[inline(always)]
    pub fn wrap(place: Vec2, columns: i32, rows: i32) -> Self {
        let (x, y) = (place.x * columns as f32 - 0.5, place.y * rows as f32 - 0.5);
        let (left, above) = (x.floor(), y.floor());
        let (tx, ty) = (x - left, y - above);
        let (i, j) = (fast::whole(left), fast::whole(above));
        let index = |i: i32, j: i32| {
            let inside = j.max(0).min(rows - 1);
            let i = if j == inside { i } else { i + columns / 2 };
            let i = if i < 0 { i + columns } else { i };
            inside * columns + if i < columns { i } else { i - columns }
        };
        Self {
            index: [index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)],
            weight: [(1.0 - tx) * (1.0 - ty), tx * (1.0 - ty), (1.0 - tx) * ty, tx * ty],
        }
    }

    /// The weighted mean of its texels.
    #[inline(always)]
    pub fn mean(&self, texel: impl Fn(usize) -> Vec3A) -> Vec3A {
        let ([i, j, k, l], [a, b, c, d]) = (self.index, self.weight);
        texel(i as usize) * a
            + texel(j as usize) * b
            + texel(k as usize) * c
            + texel(l as usize) * d
    }
}

impl SphereLevel {
    /// `rows` a power of two, twice as many columns.
    pub fn new(rows: usize, texels: Vec<Vec3A>) -> Self {
        Self { rows, texels }
    }

    /// How many rows it has.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// How many columns it has.
    pub fn columns(&self) -> usize {
        2 * self.rows
    }

    /// Row by row.
    pub fn texels(&self) -> &[Vec3A] {
        &self.texels
    }

    /// Light from a direction, bilinear.
    pub fn at(&self, e: Vec3) -> Vec3 {
        self.at_place(lat_long_place(e.x, e.y, e.z)).into()
    }

    /// The same at a place in `[0, 1]²`.
    #[inline(always)]
    pub fn at_place(&self, place: Vec2) -> Vec3A {
        let spot = Spot::wrap(place, self.columns() as i32, self.rows as i32);
        spot.mean(|i| self.texels[i])
    }

    /// A texel by its number; an invalid number finds the first.
    #[inline(always)]
    pub fn texel(&self, i: usize) -> Vec3A {
        self.texels[if i < self.texels.len() { i } else { 0 }]
    }

    /// Solid angle of a texel in a row, steradians.
    pub fn solid_angle(&self, row: usize) -> f32 {
        let edge = |row: usize| (row as f32 / self.rows as f32 * PI).cos();
        TAU / self.columns() as f32 * (edge(row) - edge(row + 1))
    }

    /// Half as many rows and columns: means weighted by solid angle.
    pub fn halved(&self) -> Option<SphereLevel> {
        let rows = self.rows / 2;
        let columns = 2 * rows;
        let texel = |i: usize| {
            let (x, y) = (2 * (i % columns), 2 * (i / columns));
            let pair = |y: usize| {
                self.texels[y * self.columns() + x] + self.texels[y * self.columns() + x + 1]
            };
            let (above, below) = (self.solid_angle(y), self.solid_angle(y + 1));
            (pair(y) * above + pair(y + 1) * below) / (2.0 * (above + below))
        };
        (rows > 0).then(|| SphereLevel::new(rows, (0..rows * columns).map(texel).collect()))
    }

    /// Averages each row over as many texels as fit one texel's height: near the poles texels are
    /// slivers, and a lookup must not read a single one.
    pub fn rounded_at_the_poles(self) -> SphereLevel {
        let columns = self.columns();
        let of_row = |row: usize| {
            let texels = &self.texels[row * columns..][..columns];
            // The outermost row is a cap around the pole, one texel across: it gets one value, so
            // that the pole is unique.
            let is_cap = row == 0 || row + 1 == self.rows;
            let sin = ((row as f32 + 0.5) / self.rows as f32 * PI).sin();
            average_row(texels, if is_cap { columns as f32 } else { 1.0 / sin })
        };
        let rows = parallel::collect(self.rows, 1, of_row);
        SphereLevel::new(self.rows, rows.into_iter().flatten().collect())
    }
}

/// The mean over `width` texels around each texel of a cyclic row.
fn average_row(texels: &[Vec3A], width: f32) -> Vec<Vec3A> {
    let n = texels.len();
    if width <= 1.0 {
        return texels.to_vec();
    }
    // Whole texels on both sides, and the rest of the width as a fraction of one more.
    let width = width.min(n as f32);
    let whole = ((width - 1.0) / 2.0) as usize;
    let part = (width - 1.0) / 2.0 - whole as f32;
    let mean = |i: usize| {
        let texel =
            |offset: usize, back: bool| texels[if back { i + n - offset } else { i + offset } % n];
        let mut sum = texels[i];
        for k in 1..=whole {
            sum += texel(k, true) + texel(k, false);
        }
        let next = whole + 1;
        (sum + (texel(next, true) + texel(next, false)) * part)
            / (1.0 + 2.0 * (whole as f32 + part))
    };
    (0..n).map(mean).collect()
}
