//! D evaluated: operator, anchors and weights resolved against a surface.
//! Floor 2.

use super::{Bend, Surface};
use crate::math::{Rect, Size, Vec2};

/// A map from canvas points to image-plane points, ready to be evaluated.
pub struct Deformation<'a> {
    #[expect(dead_code, reason = "the evaluation lands next")]
    surface: Option<&'a Surface>,
    #[expect(dead_code, reason = "the evaluation lands next")]
    size: Size,
    #[expect(dead_code, reason = "the evaluation lands next")]
    bend: &'a Bend,
}

/// D at every pixel centre of a rectangle, row by row.
#[derive(Default)]
pub struct DeformedRect {
    pub rect: Option<Rect>,
    pub x: Vec<f32>,
    pub y: Vec<f32>,
}

impl<'a> Deformation<'a> {
    pub fn new(surface: Option<&'a Surface>, size: Size, bend: &'a Bend) -> Self {
        Self { surface, size, bend }
    }
    /// D(q) at the centre of a pixel: the reference that reads like the paper.
    pub fn at(&self, x: i32, y: i32) -> Vec2 {
        Vec2::new(x as f32 + 0.5, y as f32 + 0.5)
    }
    /// [`Deformation::at`] for every pixel of a rectangle within the canvas.
    pub fn fill(&self, rect: Rect, out: &mut DeformedRect) {
        let pixels = (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (x, y)));
        (out.x, out.y) = pixels.map(|(x, y)| self.at(x, y).into()).unzip();
        out.rect = Some(rect);
    }
}
