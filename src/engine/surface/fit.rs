//! Fitting a surface to a canvas of another size: another object under a finished painting, or a
//! painting at another scale. Floor 2. Values are averaged over what one new pixel covers, never
//! across a depth jump or the mask's edge; at contours of a larger canvas, by the side of their
//! line (`contours::enlarged`).

use super::contours::{ContourMaps, EnlargedContours};
use super::{Maps, Surface, SurfaceError};
use crate::math::{Size, Vec2, Vec3, parallel, vec2};
use crate::raster::Plane;

impl Surface {
    /// The whole surface as large as `canvas` allows, its aspect kept, centered; what is left of the
    /// canvas has no surface.
    ///
    /// Fails where nothing is left of a surface thinner than the new pixels.
    pub fn fitted(&self, canvas: Size) -> Result<Surface, SurfaceError> {
        let (from, to) = (self.size(), canvas);
        let scale =
            (to.width as f32 / from.width as f32).min(to.height as f32 / from.height as f32);
        self.resampled(canvas, Vec2::splat(scale))
    }

    /// The surface at another resolution: the whole map over the whole canvas, a side that rounded
    /// taking the difference.
    pub fn stretched(&self, canvas: Size) -> Result<Surface, SurfaceError> {
        let (from, to) = (self.size(), canvas);
        let scale =
            vec2(to.width as f32 / from.width as f32, to.height as f32 / from.height as f32);
        self.resampled(canvas, scale)
    }

    /// Centered on each other, `scale` canvas px per map px.
    fn resampled(&self, canvas: Size, scale: Vec2) -> Result<Surface, SurfaceError> {
        let map_from_canvas = |q: Vec2| (q - canvas.center()) / scale + self.size().center();
        let read = self.texels(canvas, scale.recip() * 0.5, map_from_canvas);
        let maps = Maps {
            normals: read.map(|v| v.normal),
            depth: read.map(|v| v.depth),
            coverage: read.map(|v| v.coverage),
        };
        let range_px = self.depth_range_px() * scale.element_product().sqrt();
        let mut made = Surface::with_depth_range(maps, Some(range_px))?;
        if scale.min_element() >= 1.0 {
            made.repeat_beside(self, map_from_canvas);
        }
        Ok(made.with_eye(self.eye().scaled(scale.x)))
    }

    /// Where there is no surface, the same values as beside the one that this one was made of: what
    /// starts there, such as a stroke, reads the same at any size.
    fn repeat_beside(&mut self, of: &Surface, map_from_canvas: impl Fn(Vec2) -> Vec2 + Sync) {
        let coverage = &self.coverage;
        let last = vec2(of.size().width as f32, of.size().height as f32) - 1.0;
        let planes = [&mut self.nbar_x, &mut self.nbar_y, &mut self.nz, &mut self.depth];
        for (plane, from) in planes.into_iter().zip([&of.nbar_x, &of.nbar_y, &of.nz, &of.depth]) {
            let width = plane.width();
            parallel::for_each_row(plane.values_mut(), width, 1, |y, row| {
                for (x, v) in row.iter_mut().enumerate().filter(|(x, _)| coverage.at(*x, y) == 0) {
                    let at = map_from_canvas(vec2(x as f32 + 0.5, y as f32 + 0.5))
                        .max(Vec2::ZERO)
                        .min(last);
                    *v = from.at(at.x as usize, at.y as usize);
                }
            });
        }
    }

    /// What the pixels of a canvas read.
    ///
    /// * `half`: half the sides of the box of the map that one covers, px.
    /// * `map_from_canvas`: where its middle lies.
    pub(super) fn texels(
        &self,
        canvas: Size,
        half: Vec2,
        map_from_canvas: impl Fn(Vec2) -> Vec2 + Sync,
    ) -> Plane<MeanTexel> {
        let at = |x: usize, y: usize| map_from_canvas(vec2(x as f32 + 0.5, y as f32 + 0.5));
        // A new pixel covers at least one old one: averaging over that box is then bilinear
        // interpolation.
        let widened = half.max(Vec2::splat(0.5));
        if half.max_element() > 0.5 + 1e-4 {
            return Plane::from_fn(canvas, |x, y| self.mean_over(at(x, y), widened));
        }
        self.with_contour_maps(None, |maps: &ContourMaps| {
            let contours = EnlargedContours::new(maps, self.contours());
            Plane::from_fn(canvas, |x, y| self.read_enlarged(&contours, at(x, y), half))
        })
    }

    /// What a pixel reads that covers at most one old one: interpolated, but at contours by the
    /// side of their line that its middle lies on; and how much of it is covered.
    fn read_enlarged(&self, contours: &EnlargedContours, center: Vec2, half: Vec2) -> MeanTexel {
        let border = vec2(self.size().width as f32, self.size().height as f32);
        if center.min_element() < 0.0 || center.x >= border.x || center.y >= border.y {
            return MeanTexel::default();
        }
        let (low, high) = ((center - half).max(Vec2::ZERO), (center + half).min(border));
        let coverage = (255.0 * contours.coverage(low, high)).round() as u8;
        // What counted as covered still does.
        let is_held = self.coverage(center.x as usize, center.y as usize) > 0;
        let coverage = coverage.max(is_held.into());
        let reading = contours.reading(center).or_else(|| self.cubic(contours, center));
        match reading {
            Some((normal, depth)) => MeanTexel { normal, depth, coverage },
            None => MeanTexel { coverage, ..self.mean_over(center, Vec2::splat(0.5)) },
        }
    }

    /// The normal and depth at a point of the map, interpolated cubically; `None` where the 4 × 4
    /// pixels around it are not one piece, or reach beyond the map.
    fn cubic(&self, contours: &EnlargedContours, at: Vec2) -> Option<(Vec3, f32)> {
        let low = (at - 0.5).floor();
        let way = at - 0.5 - low;
        let (x, y) = (low.x as i32, low.y as i32);
        let inner = [(0, 0), (1, 0), (0, 1), (1, 1)];
        if !inner.iter().all(|(dx, dy)| contours.is_inner(x + dx, y + dy)) {
            return None;
        }
        let (across, down) = (cubic_weights(way.x), cubic_weights(way.y));
        let (mut normal, mut depth) = (Vec3::ZERO, 0.0);
        for (j, row_weight) in (y as usize - 1..).zip(down) {
            for (i, weight) in (x as usize - 1..).zip(across) {
                let weight = weight * row_weight;
                normal += weight * self.normal(i, j);
                depth += weight * self.depth(i, j);
            }
        }
        Some((normal, depth.clamp(0.0, 1.0)))
    }

    /// The mean over the box of half sides `half` around a point of the map, cut at its border;
    /// beyond there is no surface.
    pub(super) fn mean_over(&self, center: Vec2, half: Vec2) -> MeanTexel {
        let border = vec2(self.size().width as f32, self.size().height as f32);
        if center.min_element() < 0.0 || center.x >= border.x || center.y >= border.y {
            return MeanTexel::default();
        }
        let (low, high) = ((center - half).max(Vec2::ZERO), (center + half).min(border));
        let (x0, x1) = (low.x.floor() as i32, high.x.ceil() as i32);
        let (y0, y1) = (low.y.floor() as i32, high.y.ceil() as i32);
        let covered = (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y))).filter_map(|(x, y)| {
            let side = |low: f32, high: f32, i: i32| {
                (high.min(i as f32 + 1.0) - low.max(i as f32)).max(0.0)
            };
            let area = side(low.x, high.x, x) * side(low.y, high.y, y);
            let coverage = self.coverage(x as usize, y as usize);
            (area > 0.0 && coverage > 0).then_some((x, y, area * f32::from(coverage)))
        });
        // The covered pixel nearest to the center decides which piece of surface this is.
        let distance = |&(x, y, _): &(i32, i32, f32)| {
            (vec2(x as f32 + 0.5, y as f32 + 0.5) - center).length_squared()
        };
        let Some((rx, ry, _)) = covered.clone().min_by(|a, b| distance(a).total_cmp(&distance(b)))
        else {
            return MeanTexel::default();
        };
        let (mut normal, mut depth, mut joined, mut all) = (Vec3::ZERO, 0.0, 0.0, 0.0);
        for (x, y, weight) in covered {
            all += weight;
            if self.is_same_piece((rx, ry), (x, y)) {
                normal += weight * self.normal(x as usize, y as usize);
                depth += weight * self.depth(x as usize, y as usize);
                joined += weight;
            }
        }
        let area = (high - low).element_product();
        MeanTexel { normal, depth: depth / joined, coverage: (all / area).min(255.0).round() as u8 }
    }

    /// Whether two pixels near each other lie on one smooth piece: the step in depth is no larger
    /// than the steeper of the two slopes implies, plus a tolerance of a pixel and a half for
    /// coarse depth (as in `links`).
    fn is_same_piece(&self, a: (i32, i32), b: (i32, i32)) -> bool {
        let at = |(x, y): (i32, i32)| {
            let (x, y) = (x as usize, y as usize);
            let steepness = self.nbar(x, y).length() / self.normal(x, y).z.max(0.05);
            (self.depth(x, y) * self.depth_range_px(), steepness)
        };
        let ((za, sa), (zb, sb)) = (at(a), at(b));
        let distance = ((a.0 - b.0) as f32).hypot((a.1 - b.1) as f32);
        (za - zb).abs() <= 1.5 + 1.5 * sa.max(sb) * distance
    }
}

/// Catmull-Rom: what the four values around count at `t` of the way from the second to the third.
fn cubic_weights(t: f32) -> [f32; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        0.5 * (2.0 * t2 - t - t3),
        0.5 * (2.0 - 5.0 * t2 + 3.0 * t3),
        0.5 * (t + 4.0 * t2 - 3.0 * t3),
        0.5 * (t3 - t2),
    ]
}

/// What a new pixel reads; no surface by default.
#[derive(Clone, Copy)]
pub(super) struct MeanTexel {
    pub normal: Vec3,
    pub depth: f32,
    pub coverage: u8,
}

impl Default for MeanTexel {
    fn default() -> Self {
        Self { normal: Vec3::ZERO, depth: f32::NAN, coverage: 0 }
    }
}

#[cfg(test)]
mod tests;
