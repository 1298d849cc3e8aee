//! A map of shares in 16 bits. Floor 2.

use crate::math::Size;
use crate::raster::Plane;
use crate::surface::cache::HeapSize;

/// One share a pixel, from 0 to a highest one, in 16 bits: fine enough to be lit by, at half the
/// memory of floats.
pub struct ShareMap {
    values: Plane<u16>,
    /// What the highest step stands for.
    most: f32,
}

impl ShareMap {
    /// 1 everywhere.
    pub(super) fn full(size: Size) -> Self {
        Self { values: Plane::full(size, u16::MAX), most: 1.0 }
    }

    /// Rounds values between 0 and `most`.
    pub(super) fn from_plane(plane: Plane<f32>, most: f32) -> Self {
        let per_step = f32::from(u16::MAX) / most;
        Self { values: plane.map(|v| (v * per_step + 0.5) as u16), most }
    }

    /// Steps of a `most` / 65535th.
    pub(super) fn from_steps(values: Plane<u16>, most: f32) -> Self {
        Self { values, most }
    }

    /// The share of a pixel inside the map.
    pub fn at(&self, x: usize, y: usize) -> f32 {
        f32::from(self.values.at(x, y)) * (self.most / f32::from(u16::MAX))
    }

    /// The shares of the `row.len()` pixels of row `y` from column `x0` on, inside the map.
    pub fn read(&self, x0: usize, y: usize, row: &mut [f32]) {
        let per_step = self.most / f32::from(u16::MAX);
        let values = &self.values.row(y)[x0..x0 + row.len()];
        row.iter_mut().zip(values).for_each(|(share, &step)| *share = f32::from(step) * per_step);
    }
}

impl HeapSize for ShareMap {
    fn heap_bytes(&self) -> u64 {
        self.values.heap_bytes()
    }
}
