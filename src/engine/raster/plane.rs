//! A contiguous map: one value per pixel, row by row, the top row first.
//! Floor 1. Not for layers, which are sparse tiles (`grid`).

use crate::math::{Size, parallel};
use crate::memory::{copy_or_unwind, fill_or_unwind};

/// `size.area()` values; pixel (x, y) is at index `y · width + x`.
#[derive(Debug, PartialEq)]
pub struct Plane<T> {
    size: Size,
    values: Vec<T>,
}

/// Pixels that are worth a task: less is done sooner than it is handed to another thread.
const LEAST_PX: usize = 1 << 9;

/// Rows of a width that are not divided among threads.
fn least_rows(width: usize) -> usize {
    LEAST_PX.div_ceil(width)
}

/// A copy for which there is no memory is refused like a new plane.
impl<T: Clone> Clone for Plane<T> {
    fn clone(&self) -> Self {
        Self { size: self.size, values: copy_or_unwind(&self.values) }
    }
}

impl<T: Copy> Plane<T> {
    /// The same value everywhere.
    pub fn full(size: Size, value: T) -> Self {
        Self { size, values: fill_or_unwind(size.area(), value) }
    }

    /// `None` if `values` does not hold exactly one value per pixel.
    pub fn from_values(size: Size, values: Vec<T>) -> Option<Self> {
        (values.len() == size.area()).then_some(Self { size, values })
    }

    /// Computes every pixel from its column and row, rows in parallel.
    pub fn from_fn(size: Size, value: impl Fn(usize, usize) -> T + Sync) -> Self
    where
        T: Send + Sync + Default,
    {
        let width = size.width.max(1) as usize;
        let mut values = fill_or_unwind(size.area(), T::default());
        parallel::for_each_row(&mut values, width, least_rows(width), |y, row| {
            for (x, v) in row.iter_mut().enumerate() {
                *v = value(x, y);
            }
        });
        Self { size, values }
    }

    /// Computes every pixel again from its column, row and value, rows in parallel, in the same
    /// memory.
    pub fn updated(mut self, value: impl Fn(usize, usize, T) -> T + Sync) -> Self
    where
        T: Send + Sync,
    {
        let width = self.size.width.max(1) as usize;
        parallel::for_each_row(&mut self.values, width, least_rows(width), |y, row| {
            for (x, v) in row.iter_mut().enumerate() {
                *v = value(x, y, *v);
            }
        });
        self
    }

    /// Another map, computed value by value, rows in parallel.
    pub fn map<U: Copy + Send + Sync + Default>(&self, f: impl Fn(T) -> U + Sync) -> Plane<U>
    where
        T: Send + Sync,
    {
        let width = self.width().max(1);
        let mut values = fill_or_unwind(self.size.area(), U::default());
        parallel::for_each_row(&mut values, width, least_rows(width), |y, row| {
            row.iter_mut().zip(self.row(y)).for_each(|(v, &from)| *v = f(from));
        });
        Plane { size: self.size, values }
    }

    /// Its sides, px.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.size.width as usize
    }

    /// The number of rows.
    pub fn height(&self) -> usize {
        self.size.height as usize
    }

    /// The value at column `x`, row `y`, both inside the map.
    #[inline(always)]
    pub fn at(&self, x: usize, y: usize) -> T {
        self.values[y * self.size.width as usize + x]
    }

    /// The value at a column and row, or `None` beyond the map.
    pub fn get(&self, x: i32, y: i32) -> Option<T> {
        self.size.rect().contains(x, y).then(|| self.at(x as usize, y as usize))
    }

    /// The nearest value inside the map.
    #[inline(always)]
    pub fn at_clamped(&self, x: i32, y: i32) -> T {
        let (w, h) = (self.size.width as i32, self.size.height as i32);
        self.at(x.clamp(0, w - 1) as usize, y.clamp(0, h - 1) as usize)
    }

    /// Sets the value at column `x`, row `y`, both inside the map.
    #[inline(always)]
    pub fn set(&mut self, x: usize, y: usize, value: T) {
        self.values[y * self.size.width as usize + x] = value;
    }

    /// The values of a row inside the map.
    #[inline(always)]
    pub fn row(&self, y: usize) -> &[T] {
        let w = self.size.width as usize;
        &self.values[y * w..(y + 1) * w]
    }

    /// As [`Plane::row`], to change them.
    pub fn row_mut(&mut self, y: usize) -> &mut [T] {
        let w = self.size.width as usize;
        &mut self.values[y * w..(y + 1) * w]
    }

    /// All values, row by row.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// As [`Plane::values`], to change them.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// All values, row by row, in the same memory.
    pub fn into_values(self) -> Vec<T> {
        self.values
    }
}
