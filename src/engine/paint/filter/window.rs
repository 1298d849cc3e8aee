//! What filters read: a rectangle of premultiplied pixels. Floor 3. Not here: where it comes from
//! (floors above).

use crate::math::{Rect, Size};

/// What a filter reads its pixels from.
pub trait FilterSource: Sync {
    /// The picture; beyond it, its border is repeated.
    fn bounds(&self) -> Rect;
    /// The pixels of a rectangle, which may reach beyond the picture.
    fn window(&self, rect: Rect) -> FilterWindow;
}

/// A rectangle of premultiplied pixels, encoded, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterWindow {
    rect: Rect,
    pixels: Vec<[f32; 4]>,
}

impl FilterWindow {
    /// Missing pixels are transparent, spare ones are dropped.
    pub fn new(rect: Rect, mut pixels: Vec<[f32; 4]>) -> Self {
        pixels.resize(rect.width() * rect.height(), [0.0; 4]);
        Self { rect, pixels }
    }

    /// Gathers a rectangle from a picture, whose border is repeated beyond it.
    ///
    /// * `copy_row`: copies pixels of the picture, from a column and a row on.
    pub fn gather(
        rect: Rect,
        bounds: Rect,
        mut copy_row: impl FnMut(i32, i32, &mut [[f32; 4]]),
    ) -> Self {
        let mut window = Self::new(rect, Vec::new());
        if bounds.is_empty() || rect.is_empty() {
            return window;
        }
        let hold = |v: i32, low: i32, high: i32| v.max(low).min(high - 1);
        let first = hold(rect.x0, bounds.x0, bounds.x1);
        let last = hold(rect.x1 - 1, bounds.x0, bounds.x1);
        let width = rect.width();
        let mut copied: Option<(i32, usize)> = None;
        for (i, y) in (rect.y0..rect.y1).enumerate() {
            let from = hold(y, bounds.y0, bounds.y1);
            if let Some((_, at)) = copied.filter(|(row, _)| *row == from) {
                window.pixels.copy_within(at * width..(at + 1) * width, i * width);
                continue;
            }
            let row = &mut window.pixels[i * width..(i + 1) * width];
            let inner = (first - rect.x0).max(0) as usize..(last + 1 - rect.x0).max(0) as usize;
            let inner = inner.start.min(width)..inner.end.min(width);
            if inner.is_empty() {
                let mut one = [[0.0; 4]];
                copy_row(first, from, &mut one);
                row.fill(one[0]);
            } else {
                copy_row(first, from, &mut row[inner.clone()]);
                let (left, right) = (row[inner.start], row[inner.end - 1]);
                row[..inner.start].fill(left);
                row[inner.end..].fill(right);
            }
            copied = Some((from, i));
        }
        window
    }

    /// Which pixels it holds.
    pub fn rect(&self) -> Rect {
        self.rect
    }

    /// Its sides, px.
    pub fn size(&self) -> Size {
        Size::new(self.rect.width() as u32, self.rect.height() as u32)
    }

    /// Its pixels, row by row.
    pub fn pixels(&self) -> &[[f32; 4]] {
        &self.pixels
    }

    /// Its pixels, to be changed.
    pub fn pixels_mut(&mut self) -> &mut [[f32; 4]] {
        &mut self.pixels
    }

    /// A row of it, by the picture's count; the nearest one for others.
    pub fn row(&self, y: i32) -> &[[f32; 4]] {
        let width = self.rect.width();
        let y = (y.max(self.rect.y0).min(self.rect.y1 - 1) - self.rect.y0).max(0) as usize;
        self.pixels.get(y * width..(y + 1) * width).unwrap_or_default()
    }

    /// A pixel; the nearest one of it for others.
    #[inline(always)]
    pub fn at(&self, x: i32, y: i32) -> [f32; 4] {
        let x = x.max(self.rect.x0).min(self.rect.x1 - 1) - self.rect.x0;
        let y = y.max(self.rect.y0).min(self.rect.y1 - 1) - self.rect.y0;
        let place = y as usize * self.rect.width() + x as usize;
        self.pixels.get(place).copied().unwrap_or_default()
    }

    /// Between pixels, bilinear; a pixel's center is half a pixel from its corner.
    #[inline(always)]
    pub fn sample(&self, x: f32, y: f32) -> [f32; 4] {
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (fx, fy) = (x - left, y - top);
        let (i, j) = (left as i32, top as i32);
        let inside = Rect { x1: self.rect.x1 - 1, y1: self.rect.y1 - 1, ..self.rect };
        let [a, b, c, d] = if inside.contains(i, j) {
            let width = self.rect.width();
            let first = (j - self.rect.y0) as usize * width + (i - self.rect.x0) as usize;
            let (upper, lower) = (&self.pixels[first..], &self.pixels[first + width..]);
            [upper[0], upper[1], lower[0], lower[1]]
        } else {
            let (right, below) = (i.saturating_add(1), j.saturating_add(1));
            [self.at(i, j), self.at(right, j), self.at(i, below), self.at(right, below)]
        };
        let mut value = [0.0; 4];
        for k in 0..4 {
            let (up, down) = (a[k] + fx * (b[k] - a[k]), c[k] + fx * (d[k] - c[k]));
            value[k] = up + fy * (down - up);
        }
        value
    }

    /// Three by three of its pixels from one on, row by row; `None` where they are not all in it.
    #[inline(always)]
    pub fn three_rows(&self, (x, y): (i32, i32)) -> Option<[&[[f32; 4]; 3]; 3]> {
        let inside = Rect { x1: self.rect.x1 - 2, y1: self.rect.y1 - 2, ..self.rect };
        if !inside.contains(x, y) {
            return None;
        }
        let width = self.rect.width();
        let first = (y - self.rect.y0) as usize * width + (x - self.rect.x0) as usize;
        let row = |i: usize| self.pixels.get(first + i * width..)?.first_chunk();
        Some([row(0)?, row(1)?, row(2)?])
    }

    /// The pixels of a rectangle within it.
    pub fn cropped(&self, to: Rect) -> Vec<[f32; 4]> {
        if to == self.rect {
            return self.pixels.clone();
        }
        let start = (to.x0 - self.rect.x0).max(0) as usize;
        let mut all = Vec::with_capacity(to.width() * to.height());
        for y in to.y0..to.y1 {
            let row = self.row(y);
            let part = row.get(start..(start + to.width()).min(row.len())).unwrap_or_default();
            all.extend_from_slice(part);
        }
        all.resize(to.width() * to.height(), [0.0; 4]);
        all
    }

    /// Rows and columns exchanged.
    pub fn transposed(&self) -> Self {
        let rect = transposed(self.rect);
        let (w, h) = (self.rect.width(), self.rect.height());
        let mut pixels = vec![[0.0; 4]; w * h];
        for (y, row) in self.pixels.chunks_exact(w.max(1)).enumerate() {
            for (x, pixel) in row.iter().enumerate() {
                pixels[x * h + y] = *pixel;
            }
        }
        Self { rect, pixels }
    }
}

/// Rows and columns exchanged.
pub fn transposed(rect: Rect) -> Rect {
    Rect::new(rect.y0, rect.x0, rect.y1, rect.x1)
}

/// A window as a picture of its own.
impl FilterSource for FilterWindow {
    fn bounds(&self) -> Rect {
        self.rect
    }

    fn window(&self, rect: Rect) -> FilterWindow {
        FilterWindow::gather(rect, self.rect, |x, y, row| {
            let start = (x - self.rect.x0) as usize;
            row.copy_from_slice(&self.row(y)[start..start + row.len()]);
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beyond_the_picture_its_border_is_repeated() {
        let rect = Rect::new(10, 20, 12, 22);
        let pixels = [1.0, 2.0, 3.0, 4.0].map(|v| [v; 4]).to_vec();
        let picture = FilterWindow::new(rect, pixels);
        let around = picture.window(rect.grown(1));
        let values: Vec<f32> = around.pixels().iter().map(|p| p[0]).collect();
        #[rustfmt::skip]
        let expected = [
            1.0, 1.0, 2.0, 2.0,
            1.0, 1.0, 2.0, 2.0,
            3.0, 3.0, 4.0, 4.0,
            3.0, 3.0, 4.0, 4.0,
        ];
        assert_eq!(values, expected);
        assert_eq!(around.cropped(rect), picture.pixels());
        let beside = picture.window(Rect::new(30, 21, 32, 22));
        assert_eq!(beside.pixels(), [[4.0; 4]; 2]);
        assert_eq!(picture.transposed().transposed(), picture);
        assert_eq!(picture.sample(11.0, 21.0), [2.5; 4]);
    }
}
