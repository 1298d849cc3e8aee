//! Forms: heights and normals of one part, the result of every algorithm of this floor. Floor 3.
//! Not here: how forms are combined (`combine`).

use super::{Outline, OutlineRim};
use crate::math::{Affine2, Mat2, Rect, Size, Vec2, Vec3, parallel, vec2, vec3};
use crate::raster::Plane;
use std::sync::Arc;

/// The shape of one part over a rectangle of the canvas. A copy shares the planes.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// Canvas px of the planes' first pixel.
    pub corner: (i32, i32),
    /// Toward the viewer, canvas px; 0 where nothing is covered.
    pub height: Arc<Plane<f32>>,
    /// Unit, camera space (y up); +z where nothing is covered.
    pub normals: Arc<Plane<Vec3>>,
    /// Where it is, one byte a pixel.
    pub coverage: Arc<Plane<u8>>,
}

/// How a squared height becomes a form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roundness {
    /// Factor of the height; 1 makes a half sphere of a disc.
    pub puff: f32,
    /// Degrees that the rim turns away from the viewer; 90 is a silhouette, less a low relief.
    pub rim_deg: f32,
}

impl Form {
    /// Heights √q and their normals of a squared height q, px², that is 0 at the rim.
    ///
    /// With puff p and a constant k that flattens the rim, n ∝ (−p² ∂q/∂x, p² ∂q/∂y, 2 p √q + k):
    /// exact at the rim, where n_z = 0 for k = 0. k makes the rim turn by `rim_deg` in the mean.
    /// The heights whose slopes these are: p√q − k/2 ln(1 + 2p√q / k).
    pub fn of_squares(
        outline: &Outline,
        squares: &Plane<f32>,
        rim: &OutlineRim,
        round: Roundness,
    ) -> Self {
        let flat = flattening(outline, squares, rim, round);
        let (sin, cos) = round.rim_deg.to_radians().sin_cos();
        let (size, inside) = (outline.size(), outline.inside_pixels());
        let puff = round.puff;
        let mut height = Plane::full(size, 0.0);
        let mut normals = Plane::full(size, Vec3::Z);
        let width = size.width as usize;
        let rows =
            height.values_mut().chunks_mut(width).zip(normals.values_mut().chunks_mut(width));
        parallel::for_each(rows.enumerate(), 1, |(y, (heights, normals))| {
            for (x, (height, normal)) in heights.iter_mut().zip(normals).enumerate() {
                if inside.at(x, y) {
                    let root = puff * squares.at(x, y).max(0.0).sqrt();
                    let slope = rim.slope(squares, x, y) * (puff * puff);
                    *height = if flat > 0.0 {
                        root - 0.5 * flat * (2.0 * root / flat).ln_1p()
                    } else {
                        root
                    };
                    *normal = vec3(-slope.x, slope.y, 2.0 * root + flat).normalize_or(Vec3::Z);
                } else if let Some(line) = outline.rim_line(x, y) {
                    // The covered part of a pixel whose center is outside lies at the rim.
                    *normal = vec3(line.outward.x * sin, -line.outward.y * sin, cos);
                }
            }
        });
        Self {
            corner: outline.corner(),
            height: height.into(),
            normals: normals.into(),
            coverage: outline.coverage().clone(),
        }
    }

    /// The pixels of the canvas that the planes hold.
    pub fn rect(&self) -> Rect {
        let (size, (x, y)) = (self.height.size(), self.corner);
        Rect::new(x, y, x.saturating_add(size.width as i32), y.saturating_add(size.height as i32))
    }

    /// The same form, moved.
    pub fn moved(&self, by: (i32, i32)) -> Self {
        self.clone().shifted(by)
    }

    /// The same, in the same memory.
    pub fn shifted(self, by: (i32, i32)) -> Self {
        let corner = (self.corner.0.saturating_add(by.0), self.corner.1.saturating_add(by.1));
        Self { corner, ..self }
    }

    /// The form as it is seen through a map of its plane; `None` where the map flattens it, or its
    /// picture would have more than `most_px` pixels. Whole pixels are moved as they are.
    ///
    /// Slopes s become k A^−T s and heights k z, with k = √|det A|, like those of an object that is
    /// turned and scaled with its picture (MATH 1). Between pixels normals and heights are those of
    /// the covered ones.
    pub fn transformed(&self, map: Affine2, most_px: usize) -> Option<Self> {
        let area = map.matrix2.determinant().abs();
        if !map.is_finite() || area < 1e-6 {
            return None;
        }
        let shift = map.translation;
        if map.matrix2 == Mat2::IDENTITY && shift == shift.round() {
            return Some(self.moved((shift.x as i32, shift.y as i32)));
        }
        let Rect { x0, y0, x1, y1 } = self.rect();
        let seen = [(x0, y0), (x1, y0), (x0, y1), (x1, y1)]
            .map(|(x, y)| map.transform_point2(vec2(x as f32, y as f32)));
        let low = seen.iter().fold(Vec2::MAX, |a, b| a.min(*b)).floor();
        let extent = (seen.iter().fold(Vec2::MIN, |a, b| a.max(*b)).ceil() - low).max(Vec2::ONE);
        let pixels = f64::from(extent.x) * f64::from(extent.y);
        if pixels.is_nan() || pixels > most_px as f64 || low.abs().max_element() > 1e6 {
            return None;
        }
        let (back, scale, turn) = (map.inverse(), area.sqrt(), map.matrix2.inverse().transpose());
        let origin = vec2(x0 as f32, y0 as f32) + 0.5;
        let size = Size::new(extent.x as u32, extent.y as u32);
        let read = Plane::from_fn(size, |x, y| {
            self.interpolate(back.transform_point2(low + vec2(x as f32, y as f32) + 0.5) - origin)
        });
        let turned = |n: Vec3| {
            // n̄ / n_z in image axes; multiplied by n_z, so that silhouettes stay finite.
            let bar = scale * (turn * vec2(n.x, -n.y));
            vec3(bar.x, -bar.y, n.z).normalize_or(Vec3::Z)
        };
        Some(Self {
            corner: (low.x as i32, low.y as i32),
            height: read.map(|(height, _, _)| height * scale).into(),
            normals: read.map(|(_, normal, _)| turned(normal)).into(),
            coverage: read.map(|(_, _, coverage)| coverage.round() as u8).into(),
        })
    }

    /// Height, normal and coverage at a place relative to the center of the first pixel.
    fn interpolate(&self, p: Vec2) -> (f32, Vec3, f32) {
        let whole = p.floor();
        let part = p - whole;
        let (mut height, mut normal, mut coverage, mut sum) = (0.0, Vec3::ZERO, 0.0, 0.0);
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (x, y) = (whole.x as i32 + dx, whole.y as i32 + dy);
            let along = |d: i32, part: f32| if d == 0 { 1.0 - part } else { part };
            let share = along(dx, part.x) * along(dy, part.y);
            let covered = self.coverage.get(x, y).unwrap_or(0);
            if covered == 0 || share <= 0.0 {
                continue;
            }
            coverage += share * f32::from(covered);
            sum += share;
            height += share * self.height.at(x as usize, y as usize);
            normal += share * self.normals.at(x as usize, y as usize);
        }
        if sum > 0.0 {
            (height / sum, normal.normalize_or(Vec3::Z), coverage)
        } else {
            (0.0, Vec3::Z, 0.0)
        }
    }

    /// Leaned about its middle: a plane is added that rises by `tan(tilt)` toward the right (x) and
    /// the bottom (y). A silhouette stays one. Degrees, between −90 and 90.
    pub fn tilted(mut self, tilt_deg: Vec2) -> Self {
        let slope = vec2(tilt_deg.x.to_radians().tan(), tilt_deg.y.to_radians().tan());
        if slope == Vec2::ZERO || !slope.is_finite() {
            return self;
        }
        let size = self.height.size();
        let middle = vec2(size.width as f32, size.height as f32) * 0.5;
        let coverage = &self.coverage;
        self.height = update(self.height, |x, y, z| {
            let from = vec2(x as f32 + 0.5, y as f32 + 0.5) - middle;
            if coverage.at(x, y) > 0 { z + slope.dot(from) } else { z }
        });
        self.normals = update(self.normals, |x, y, n| match coverage.at(x, y) {
            0 => n,
            _ => vec3(n.x - slope.x * n.z, n.y + slope.y * n.z, n.z).normalize_or(Vec3::Z),
        });
        self
    }

    /// Nearer to the viewer by so many px.
    pub fn raised(mut self, by_px: f32) -> Self {
        let coverage = &self.coverage;
        if by_px != 0.0 && by_px.is_finite() {
            self.height =
                update(self.height, |x, y, z| if coverage.at(x, y) > 0 { z + by_px } else { z });
        }
        self
    }

    /// With a height layer added, px, and the normals that follow: slopes add.
    pub fn with_added(mut self, added: &Plane<f32>) -> Self {
        if added.size() != self.height.size() {
            return self;
        }
        let coverage = &self.coverage;
        self.normals = update(self.normals, |x, y, n| {
            let covered = |x: i32, y: i32| coverage.get(x, y).unwrap_or(0) > 0;
            if !covered(x as i32, y as i32) {
                return n;
            }
            let slope = slope_within(added, &covered, x as i32, y as i32);
            vec3(n.x - slope.x * n.z, n.y + slope.y * n.z, n.z).normalize_or(Vec3::Z)
        });
        self.height =
            update(
                self.height,
                |x, y, z| if coverage.at(x, y) > 0 { z + added.at(x, y) } else { z },
            );
        self
    }
}

/// A plane computed again pixel by pixel, in the same memory if nobody else holds it.
fn update<T: Copy + Send + Sync>(
    plane: Arc<Plane<T>>,
    value: impl Fn(usize, usize, T) -> T + Sync,
) -> Arc<Plane<T>> {
    Arc::new(Arc::unwrap_or_clone(plane).updated(value))
}

/// The slope of a plane at a pixel by differences that do not leave what is covered.
#[inline(always)]
pub fn slope_within(
    plane: &Plane<f32>,
    covered: &impl Fn(i32, i32) -> bool,
    x: i32,
    y: i32,
) -> Vec2 {
    let here = plane.at(x as usize, y as usize);
    let along = |dx: i32, dy: i32| {
        let at = |s: i32| {
            let (x, y) = (x + s * dx, y + s * dy);
            covered(x, y).then(|| plane.get(x, y)).flatten()
        };
        match (at(-1), at(1)) {
            (Some(a), Some(b)) => 0.5 * (b - a),
            (Some(a), None) => here - a,
            (None, Some(b)) => b - here,
            (None, None) => 0.0,
        }
    };
    vec2(along(1, 0), along(0, 1))
}

/// k of [`Form::of_squares`]: 0 for a silhouette, else what gives the mean slope of the rim its
/// angle.
fn flattening(outline: &Outline, squares: &Plane<f32>, rim: &OutlineRim, round: Roundness) -> f32 {
    if round.rim_deg >= 90.0 {
        return 0.0;
    }
    let inside = outline.inside_pixels();
    let (w, h) = (inside.width(), inside.height());
    let (mut sum, mut count) = (0.0f64, 0u32);
    for (x, y) in (1..h - 1).flat_map(|y| (1..w - 1).map(move |x| (x, y))) {
        let whole = || {
            inside.at(x - 1, y) && inside.at(x + 1, y) && inside.at(x, y - 1) && inside.at(x, y + 1)
        };
        if inside.at(x, y) && !whole() {
            sum += f64::from(rim.slope(squares, x, y).length());
            count += 1;
        }
    }
    let mean = (sum / f64::from(count.max(1))) as f32;
    round.puff * round.puff * mean / round.rim_deg.to_radians().tan().max(1e-3)
}
