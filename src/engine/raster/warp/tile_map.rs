//! A map of one tile, told pixel by pixel. Floor 1.

use super::{PixelMap, WIDEST_PX};
use crate::math::plane_map::PixelMove;
use crate::math::{Mat2, Rect, Vec2};

/// The points of the source that the pixels of a rectangle show.
pub struct TileMap {
    rect: Rect,
    /// Row by row, each with how it moves from pixel to pixel.
    points: Vec<(Vec2, Mat2)>,
}

/// Farther than any pixel lies.
const FAR: f32 = 1e6;

impl TileMap {
    /// * `points`: one for each pixel of `rect`; what is no number shows nothing.
    pub fn new(rect: Rect, points: Vec<(Vec2, Mat2)>) -> Self {
        Self { rect, points }
    }
    fn at(&self, x: i32, y: i32) -> Option<(Vec2, Mat2)> {
        let place = self
            .rect
            .contains(x, y)
            .then(|| (y - self.rect.y0) as usize * self.rect.width() + (x - self.rect.x0) as usize)?;
        self.points.get(place).copied().filter(|(p, jacobian)| p.is_finite() && jacobian.is_finite())
    }
}

impl PixelMap for TileMap {
    fn source_of(&self, q: Vec2) -> Option<(Vec2, Mat2)> {
        self.at(q.x.floor() as i32, q.y.floor() as i32)
    }
    fn pixel_move(&self) -> Option<PixelMove> {
        None
    }
    fn source_rect(&self, canvas: Rect) -> Rect {
        let (mut low, mut high, mut reach) = (Vec2::INFINITY, Vec2::NEG_INFINITY, 1.0f32);
        let area = canvas.intersect(self.rect);
        for y in area.y0..area.y1 {
            for x in area.x0..area.x1 {
                let Some((p, jacobian)) = self.at(x, y) else { continue };
                (low, high) = (low.min(p), high.max(p));
                let side = |v: Vec2| v.length().min(WIDEST_PX);
                reach = reach.max(side(jacobian.x_axis) + side(jacobian.y_axis));
            }
        }
        if low.x > high.x {
            return Rect::EMPTY;
        }
        let side = |v: f32| v.max(-FAR).min(FAR) as i32;
        let reach = 2.0 + reach;
        Rect::new(side(low.x - reach), side(low.y - reach), side(high.x + reach) + 1, side(high.y + reach) + 1)
    }
}
