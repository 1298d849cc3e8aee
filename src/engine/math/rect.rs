//! Pixel sizes and half-open pixel rectangles.
//! Floor 0.

#![warn(missing_docs)]

use super::{Vec2, vec2};

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Size {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
}

impl Size {
    /// This many pixels across and down.
    pub const fn new(width: u32, height: u32) -> Self {
        Self { width, height }
    }

    /// Number of pixels.
    pub const fn area(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The unit length *L*: the longer side, in pixels (MATH 1: makes α independent of the
    /// resolution).
    pub fn longer_side(self) -> f32 {
        self.width.max(self.height) as f32
    }

    /// The rectangle of its pixels, from the origin on.
    pub fn rect(self) -> Rect {
        Rect { x0: 0, y0: 0, x1: self.width as i32, y1: self.height as i32 }
    }

    /// The point in the middle.
    pub fn center(self) -> Vec2 {
        vec2(self.width as f32, self.height as f32) * 0.5
    }

    /// The size times a factor, rounded, at least one pixel a side.
    pub fn scaled(self, factor: f32) -> Self {
        let side = |n: u32| ((n as f32 * factor).round() as u32).max(1);
        Self { width: side(self.width), height: side(self.height) }
    }
}

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} × {}", self.width, self.height)
    }
}

/// The pixels `x0 ≤ x < x1`, `y0 ≤ y < y1`, y down; empty if a side is not positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Rect {
    /// The first column.
    pub x0: i32,
    /// The first row.
    pub y0: i32,
    /// The column after the last.
    pub x1: i32,
    /// The row after the last.
    pub y1: i32,
}

impl Rect {
    /// No pixel.
    pub const EMPTY: Rect = Rect { x0: 0, y0: 0, x1: 0, y1: 0 };

    /// From the first pixel to the one past the last.
    pub const fn new(x0: i32, y0: i32, x1: i32, y1: i32) -> Self {
        Self { x0, y0, x1, y1 }
    }

    /// It holds no pixel.
    pub const fn is_empty(self) -> bool {
        self.x0 >= self.x1 || self.y0 >= self.y1
    }

    /// Columns; 0 for an empty one.
    pub fn width(self) -> usize {
        (self.x1 - self.x0).max(0) as usize
    }

    /// Rows; 0 for an empty one.
    pub fn height(self) -> usize {
        (self.y1 - self.y0).max(0) as usize
    }

    /// The pixels of both.
    pub fn intersect(self, other: Rect) -> Rect {
        let r = Rect {
            x0: self.x0.max(other.x0),
            y0: self.y0.max(other.y0),
            x1: self.x1.min(other.x1),
            y1: self.y1.min(other.y1),
        };
        if r.is_empty() { Rect::EMPTY } else { r }
    }

    /// The smallest rectangle that holds both; an empty one adds nothing.
    pub fn union(self, other: Rect) -> Rect {
        if self.is_empty() {
            return other;
        }
        if other.is_empty() {
            return self;
        }
        Rect {
            x0: self.x0.min(other.x0),
            y0: self.y0.min(other.y0),
            x1: self.x1.max(other.x1),
            y1: self.y1.max(other.y1),
        }
    }

    /// The rectangle grown by `margin` pixels on every side; an empty one stays empty.
    pub fn grown(self, margin: i32) -> Rect {
        if self.is_empty() {
            return Rect::EMPTY;
        }
        let (low, high) = (|v: i32| v.saturating_sub(margin), |v: i32| v.saturating_add(margin));
        Rect { x0: low(self.x0), y0: low(self.y0), x1: high(self.x1), y1: high(self.y1) }
    }

    /// The same pixels elsewhere.
    pub fn moved(self, dx: i32, dy: i32) -> Rect {
        let Rect { x0, y0, x1, y1 } = self;
        Rect::new(
            x0.saturating_add(dx),
            y0.saturating_add(dy),
            x1.saturating_add(dx),
            y1.saturating_add(dy),
        )
    }

    /// Whether a pixel is in it.
    pub fn contains(self, x: i32, y: i32) -> bool {
        x >= self.x0 && x < self.x1 && y >= self.y0 && y < self.y1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_that_do_not_meet_have_an_empty_intersection() {
        let a = Rect::new(0, 0, 4, 4);
        assert_eq!(a.intersect(Rect::new(4, 0, 8, 4)), Rect::EMPTY);
        assert_eq!(a.intersect(Rect::new(2, 1, 8, 3)), Rect::new(2, 1, 4, 3));
        assert_eq!(a.union(Rect::EMPTY), a);
    }
}
