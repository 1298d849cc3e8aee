//! The unwrapped plane seen from above: which point of the canvas lies at each of its pixels.
//! Floor 2. The inverse of D over a whole canvas, for pictures of the plane (`document::view`).

use crate::math::{Rect, Vec2, vec2};
use crate::memory::fill_or_unwind;
use crate::surface::deformed_rect::DeformedRect;
use crate::surface::{Surface, links};

/// The canvas point at each pixel of a part of the plane, row by row; NaN where no surface lies.
pub struct PlaneView {
    /// In the plane, px.
    pub rect: Rect,
    /// In the canvas, px.
    pub points: Vec<Vec2>,
}

/// The plane is seen this many canvases far to every side: beyond lies only what anchors have
/// thrown there.
const FARTHEST_CANVASES: i32 = 2;

impl PlaneView {
    /// The plane that `deformed`, D over the whole canvas, lays the surface on. Where two pieces
    /// lie over each other the nearer one is seen. `None` where there is nothing to see.
    pub fn of(surface: &Surface, deformed: &DeformedRect) -> Option<Self> {
        let canvas = surface.size().rect();
        if deformed.rect != Some(canvas) {
            return None;
        }
        let at = |i: usize| vec2(deformed.x[i], deformed.y[i]);
        let covered = |i: usize| surface.coverage_plane().values()[i] > 0;
        let bounds = (0..deformed.x.len()).filter(|&i| covered(i) && at(i).is_finite()).map(at);
        let (low, high) =
            bounds.fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        let (wide, high_px) = (canvas.x1 * FARTHEST_CANVASES, canvas.y1 * FARTHEST_CANVASES);
        let farthest = Rect::new(-wide, -high_px, canvas.x1 + wide, canvas.y1 + high_px);
        // Conversions saturate, and there is nothing between infinities.
        let (low, high) = (low.floor(), high.ceil());
        let rect =
            Rect::new(low.x as i32, low.y as i32, high.x as i32, high.y as i32).intersect(farthest);
        if rect.is_empty() {
            return None;
        }
        Some(Self::rasterize(surface, rect, at))
    }

    /// The part `rect` of the plane in which `at` lays the pixels of the canvas, counted row by
    /// row.
    pub(super) fn rasterize(surface: &Surface, rect: Rect, at: impl Fn(usize) -> Vec2) -> Self {
        let canvas = surface.size().rect();
        let (w, area) = (canvas.width(), rect.width() * rect.height());
        let mut seen = PlaneRaster {
            rect,
            points: fill_or_unwind(area, Vec2::NAN),
            depths: fill_or_unwind(area, f32::INFINITY),
        };
        for y in 0..canvas.height() - 1 {
            for x in 0..w - 1 {
                let i = y * w + x;
                let (here, last) =
                    (surface.links_plane().values()[i], surface.links_plane().values()[i + w + 1]);
                let both = links::RIGHT | links::DOWN;
                if here & both != both
                    || last & (links::LEFT | links::UP) != links::LEFT | links::UP
                {
                    continue;
                }
                let corner = |dx: usize, dy: usize| PlaneCorner {
                    at: at(i + dy * w + dx),
                    from: vec2((x + dx) as f32, (y + dy) as f32) + 0.5,
                    depth: surface.depth(x + dx, y + dy),
                };
                let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
                seen.triangle([a, b, c]);
                seen.triangle([b, d, c]);
            }
        }
        Self { rect, points: seen.points }
    }

    /// The canvas point at a pixel of the plane, `None` where no surface lies.
    pub fn at(&self, x: i32, y: i32) -> Option<Vec2> {
        let is_within = self.rect.contains(x, y);
        let i = || (y - self.rect.y0) as usize * self.rect.width() + (x - self.rect.x0) as usize;
        is_within.then(|| self.points[i()]).filter(|point| point.is_finite())
    }

    /// The canvas point between pixels; `None` where none of the four around it shows the surface.
    pub fn sample(&self, p: Vec2) -> Option<Vec2> {
        if !p.is_finite() {
            return None;
        }
        let corner = (p - 0.5).floor();
        let share = p - 0.5 - corner;
        let (x, y) = (corner.x as i32, corner.y as i32);
        let sides = [(0, 0), (1, 0), (0, 1), (1, 1)];
        let around = sides.map(|(dx, dy)| self.at(x.saturating_add(dx), y.saturating_add(dy)));
        if let [Some(a), Some(b), Some(c), Some(d)] = around
            && [b, c, d]
                .iter()
                .all(|other| a.distance_squared(*other) < FARTHEST_STEP_PX * FARTHEST_STEP_PX)
        {
            return Some(a.lerp(b, share.x).lerp(c.lerp(d, share.x), share.y));
        }
        let weight = |(dx, dy): (i32, i32)| {
            [1.0 - share.x, share.x][dx as usize] * [1.0 - share.y, share.y][dy as usize]
        };
        let known =
            around.iter().zip(sides).filter_map(|(point, side)| Some(((*point)?, weight(side))));
        known.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(point, _)| point)
    }
}

/// Farther than this from one pixel of the plane to the next lies another part of the surface.
const FARTHEST_STEP_PX: f32 = 4.0;

struct PlaneRaster {
    rect: Rect,
    points: Vec<Vec2>,
    depths: Vec<f32>,
}

/// A pixel of the canvas, as it lies in the plane.
#[derive(Clone, Copy)]
struct PlaneCorner {
    at: Vec2,
    from: Vec2,
    depth: f32,
}

impl PlaneRaster {
    /// Fills the plane's pixels whose centers lie in a triangle, unless something nearer lies
    /// there.
    fn triangle(&mut self, corners: [PlaneCorner; 3]) {
        /// Of a side: neighboring triangles leave no gap between them.
        const SLACK: f32 = 1e-4;
        let [a, b, c] = corners;
        let area = (b.at - a.at).perp_dot(c.at - a.at);
        if !area.is_finite() || area == 0.0 {
            return;
        }
        let low = a.at.min(b.at).min(c.at) - 0.5;
        let high = a.at.max(b.at).max(c.at) - 0.5;
        let Rect { x0, y0, x1, y1 } = self.rect;
        let columns =
            (low.x.ceil() as i32).max(x0)..(high.x.floor() as i32).saturating_add(1).min(x1);
        for y in (low.y.ceil() as i32).max(y0)..(high.y.floor() as i32).saturating_add(1).min(y1) {
            for x in columns.clone() {
                let p = vec2(x as f32, y as f32) + 0.5;
                let v = (p - a.at).perp_dot(c.at - a.at) / area;
                let w = (b.at - a.at).perp_dot(p - a.at) / area;
                let u = 1.0 - v - w;
                if u < -SLACK || v < -SLACK || w < -SLACK {
                    continue;
                }
                let i = (y - y0) as usize * self.rect.width() + (x - x0) as usize;
                let depth = u * a.depth + v * b.depth + w * c.depth;
                if depth < self.depths[i] {
                    self.depths[i] = depth;
                    self.points[i] = u * a.from + v * b.from + w * c.from;
                }
            }
        }
    }
}
