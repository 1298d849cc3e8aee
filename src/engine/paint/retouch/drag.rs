//! Where smudge and clone take the color of a pixel from: what a dab drags or copies is bent like
//! its footprint. Floor 3.

use super::TileDab;
use super::pixels::{PixelReader, RetouchPixels};
use crate::math::{Affine2, Mat2, Rect, Vec2, vec2};
use crate::paint::dab_walker::Dab;
use crate::paint::patches::Patches;
use crate::paint::scene::Scene;
use crate::raster::TileGrid;
use crate::surface::Deformation;
use crate::surface::deformation::DeformedRect;

/// A smudge takes no color from farther than this many steps: where the surface turns away, D
/// hardly changes and its inverse would reach arbitrarily far.
const FARTHEST_STEPS: f32 = 3.0;

/// The colors that a smudge drags onto the pixels of a touched area, row by row; `None` if it did
/// not move.
///
/// What was under the previous dab is under this one, at the same point of the image plane relative
/// to its center. With F_k(q) = D_k(q) − q_k, a pixel q takes the color of the point p with
/// F_{k−1}(p) = F_k(q), found by one step of Newton's method from q:
///
/// `p = q − (∂D_{k−1}/∂q)⁻¹ (F_{k−1}(q) − F_k(q))`.
///
/// On a flat canvas, and wherever n̄ changes evenly, that is the dab's movement, p = q − (q_k −
/// q_{k−1}).
///
/// * `length`: the share of the color that is left after a drag of one radius, `[0, 1]`, however
///   many dabs it took.
pub(super) fn smudge_colors(
    touch: &TileDab,
    dab: &Dab,
    before: &Dab,
    length: f32,
    retouched: &RetouchPixels,
    scene: &Scene,
) -> Option<Vec<[f32; 4]>> {
    let step = dab.at - before.at;
    let length = length.max(0.0).min(1.0);
    // Comparisons that are false for NaN.
    if !(step.length() > 0.0 && length > 0.0) {
        return None;
    }
    let kept = length.powf(step.length() / dab.radius);
    let mut field = DragField::of(dab, touch.area, scene);
    let now: Vec<Vec2> = field.points();
    field.fill(before, scene);
    let (mut reader, mut own) = (retouched.reader(), retouched.reader());
    let canvas = SourceBounds::of(scene);
    let mut colors = Vec::with_capacity(now.len());
    field.for_each(scene, |(x, y), there, jacobian| {
        let here = vec2(x as f32 + 0.5, y as f32 + 0.5);
        let gap = (there - before.at) - (now[colors.len()] - dab.at);
        let dragged = here - solve(jacobian, gap).clamp_length_max(FARTHEST_STEPS * step.length());
        let (old, new) = (own.pixel(x, y), reader.sample(canvas.clamped(dragged)));
        colors.push(std::array::from_fn(|c| old[c] + (new[c] - old[c]) * kept));
    });
    Some(colors)
}

/// The colors that a clone copies onto the pixels of a touched area, row by row.
///
/// Pixel q takes the color at `q_0 + offset + (D(q) − q_0)`: what is copied bends around the dab
/// like its footprint. Where a pixel covers several of the picture, it is the mean of a grid of
/// points in the patch under it.
pub(super) fn clone_colors(
    touch: &TileDab,
    dab: &Dab,
    offset: Vec2,
    source: &TileGrid,
    scene: &Scene,
) -> Vec<[f32; 4]> {
    /// The most points along a side of the grid.
    const MOST: f32 = 6.0;
    let mut field = DragField::of(dab, touch.area, scene);
    let mut reader = PixelReader::of(source);
    let mut colors = Vec::with_capacity(touch.area.width() * touch.area.height());
    field.for_each(scene, |_, there, jacobian| {
        let sides = jacobian.x_axis.length().max(jacobian.y_axis.length());
        // Pixels copied by whole pixels stay unchanged.
        let count = (sides - 0.25).ceil().max(1.0).min(MOST) as i32;
        let mut sum = [0.0; 4];
        for (i, j) in (0..count).flat_map(|j| (0..count).map(move |i| (i, j))) {
            let share = |i: i32| (i as f32 + 0.5) / count as f32 - 0.5;
            let point = reader.sample(there + offset + jacobian * vec2(share(i), share(j)));
            sum = std::array::from_fn(|c| sum[c] + point[c]);
        }
        colors.push(sum.map(|v| v / (count * count) as f32));
    });
    colors
}

/// J⁻¹ v, or v where J is nearly singular.
fn solve(jacobian: Mat2, v: Vec2) -> Vec2 {
    if jacobian.determinant().abs() > 1e-3 { jacobian.inverse() * v } else { v }
}

/// The centers of the canvas's pixels: only between them can be read.
struct SourceBounds {
    last: Vec2,
}

impl SourceBounds {
    fn of(scene: &Scene) -> Self {
        Self { last: vec2(scene.size.width as f32, scene.size.height as f32) - 0.5 }
    }

    fn clamped(&self, at: Vec2) -> Vec2 {
        at.max(Vec2::splat(0.5)).min(self.last)
    }
}

/// D of a dab over an area and the pixels around it.
struct DragField {
    area: Rect,
    deformed: DeformedRect,
    patches: Patches,
}

impl DragField {
    fn of(dab: &Dab, area: Rect, scene: &Scene) -> Self {
        let mut field =
            Self { area, deformed: DeformedRect::default(), patches: Patches::default() };
        field.fill(dab, scene);
        field
    }

    fn fill(&mut self, dab: &Dab, scene: &Scene) {
        let deformation =
            Deformation::of_dab(scene.surface.as_deref(), scene.size, dab.operator, dab.at);
        deformation.fill(self.area.grown(1), &mut self.deformed);
    }

    /// D(q) of every pixel of the area.
    fn points(&self) -> Vec<Vec2> {
        let stride = self.area.width() + 2;
        let rows = 1..=self.area.height();
        rows.flat_map(|row| (1..=self.area.width()).map(move |column| row * stride + column))
            .map(|i| vec2(self.deformed.x[i], self.deformed.y[i]))
            .collect()
    }

    /// Every pixel of the area with D(q) and ∂D/∂q, differenced within its piece of surface.
    fn for_each(&mut self, scene: &Scene, mut visit: impl FnMut((i32, i32), Vec2, Mat2)) {
        for y in self.area.y0..self.area.y1 {
            let row = self.patches.row(scene, self.area, y, &self.deformed, Affine2::IDENTITY);
            let [left, right, up, down] = row.edges;
            for (i, x) in (self.area.x0..self.area.x1).enumerate() {
                let edge = |edge: [&[f32]; 2]| vec2(edge[0][i], edge[1][i]);
                let jacobian = Mat2::from_cols(edge(right) - edge(left), edge(down) - edge(up));
                visit((x, y), vec2(row.x[i], row.y[i]), jacobian);
            }
        }
    }
}
