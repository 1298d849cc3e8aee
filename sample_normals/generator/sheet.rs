//! A smooth two-sided sheet through a grid of points: a bicubic B-spline, drawn finely into a depth
//! buffer. Rays read the buffer; its samples are exactly the renderer's sub-samples.

use glam::{DVec2, DVec3};

use crate::render::{Hit, SUB, Surface, View, facing};

/// Facets per cell of the grid and side.
const FINE: usize = 10;

/// The sheet as the view sees it.
pub struct Sheet {
    width: usize,
    height: usize,
    /// Samples per model unit.
    scale: f64,
    /// Model point of the buffer's top left corner.
    corner: DVec2,
    samples: Vec<Option<Hit>>,
}

/// A point of the sheet and its unit normal.
type Vertex = (DVec3, DVec3);

impl Sheet {
    /// The sheet over `points` (row by row, `side` per row, camera space), as seen in `view`.
    pub fn new(points: &[DVec3], side: usize, view: &View) -> Self {
        let scale = (view.width * SUB) as f64 / (2.0 * view.half_width);
        let (width, height) = (view.width * SUB, view.height * SUB);
        let corner = view.center + DVec2::new(-(width as f64), height as f64) / (2.0 * scale);
        let mut sheet = Self { width, height, scale, corner, samples: vec![None; width * height] };
        let across = (side - 3) * FINE + 1;
        let row =
            |j: usize| -> Vec<Vertex> { (0..across).map(|i| spline(points, side, i, j)).collect() };
        let mut above = row(0);
        for j in 1..across {
            let below = row(j);
            for i in 1..across {
                sheet.draw([above[i - 1], above[i], below[i]]);
                sheet.draw([above[i - 1], below[i], below[i - 1]]);
            }
            above = below;
        }
        sheet
    }

    /// Draws one facet, keeping the samples nearer than what is there.
    fn draw(&mut self, facet: [Vertex; 3]) {
        let [a, b, c] =
            facet.map(|(p, _)| (p.truncate() - self.corner) * DVec2::new(self.scale, -self.scale));
        let area = (b - a).perp_dot(c - a);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        if area.abs() < 1e-12 || low.min_element() < 0.0 {
            return;
        }
        let last = |x: f64, size: usize| ((x - 0.5).floor() as i64).min(size as i64 - 1);
        for y in (low.y - 0.5).ceil() as i64..=last(high.y, self.height) {
            for x in (low.x - 0.5).ceil() as i64..=last(high.x, self.width) {
                let q = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let (wb, wc) = ((q - a).perp_dot(c - a) / area, (b - a).perp_dot(q - a) / area);
                if wb >= -1e-9 && wc >= -1e-9 && wb + wc <= 1.0 + 1e-9 {
                    self.keep_nearer(
                        y as usize * self.width + x as usize,
                        &facet,
                        [1.0 - wb - wc, wb, wc],
                    );
                }
            }
        }
    }

    fn keep_nearer(&mut self, i: usize, facet: &[Vertex; 3], weights: [f64; 3]) {
        let mean = |pick: fn(&Vertex) -> DVec3| {
            facet.iter().zip(weights).map(|(v, w)| pick(v) * w).sum::<DVec3>()
        };
        let z = mean(|v| v.0).z;
        if self.samples[i].is_none_or(|hit| hit.z < z) {
            let normal = mean(|v| v.1);
            // Two-sided: the side that is seen faces the viewer.
            let seen = if normal.z < 0.0 { -normal } else { normal };
            self.samples[i] = Some(Hit { z, normal: facing(seen) });
        }
    }
}

impl Surface for Sheet {
    /// Bilinear between the four nearest samples, exact at each of them; the nearest where one of
    /// them misses.
    fn hit(&self, at: DVec2, _top: f64) -> Option<Hit> {
        let q = (at - self.corner) * DVec2::new(self.scale, -self.scale) - DVec2::splat(0.5);
        let (base, f) = ((q + DVec2::splat(1e-6)).floor(), q - (q + DVec2::splat(1e-6)).floor());
        let sample = |dx: f64, dy: f64| {
            let x = (base.x + dx).clamp(0.0, self.width as f64 - 1.0) as usize;
            let y = (base.y + dy).clamp(0.0, self.height as f64 - 1.0) as usize;
            self.samples[y * self.width + x]
        };
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let hits: Vec<Hit> = corners.iter().filter_map(|(dx, dy)| sample(*dx, *dy)).collect();
        if hits.len() < 4 {
            return sample(f.x.round(), f.y.round());
        }
        let weights = [(1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y];
        let blend = |pick: fn(&Hit) -> DVec3| {
            hits.iter().zip(weights).map(|(h, w)| pick(h) * w).sum::<DVec3>()
        };
        Some(Hit { z: blend(|h| DVec3::splat(h.z)).z, normal: facing(blend(|h| h.normal)) })
    }
}

/// The sheet at fine grid position (i, j).
fn spline(points: &[DVec3], side: usize, i: usize, j: usize) -> Vertex {
    let cell = |k: usize| (k / FINE).min(side - 4);
    let (cx, cy) = (cell(i), cell(j));
    let (bx, dx) = basis(i as f64 / FINE as f64 - cx as f64);
    let (by, dy) = basis(j as f64 / FINE as f64 - cy as f64);
    let (mut at, mut along_x, mut along_y) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    for v in 0..4 {
        for u in 0..4 {
            let p = points[(cy + v) * side + cx + u];
            at += p * bx[u] * by[v];
            along_x += p * dx[u] * by[v];
            along_y += p * bx[u] * dy[v];
        }
    }
    (at, along_x.cross(along_y).normalize_or(DVec3::Z))
}

/// The cubic B-spline's four weights at `t` in `[0, 1]`, and their derivatives.
fn basis(t: f64) -> ([f64; 4], [f64; 4]) {
    let s = 1.0 - t;
    let (t2, t3) = (t * t, t * t * t);
    let weights = [s * s * s, 3.0 * t3 - 6.0 * t2 + 4.0, -3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0, t3]
        .map(|w| w / 6.0);
    (weights, [-0.5 * s * s, 1.5 * t2 - 2.0 * t, -1.5 * t2 + t + 0.5, 0.5 * t2])
}
