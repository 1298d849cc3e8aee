//! Inflation: the pillow over an outline, z = √u with −∇²u = 4 inside and u = 0 at the rim.
//! Floor 3. Not here: what is made of u (puff, rim, normals) (`form`); limbs that should not be fat
//! (`tube`).

use super::{Outline, OutlineRim};
use crate::math::Size;
use crate::raster::Plane;

/// A residual of 3e-3 of the right-hand side, squared: on a creature of 1 Mpx normals are then
/// within 0.0001° of the solution in the mean and 0.01° everywhere, since the error is rough and
/// small.
const GOAL: f64 = 1e-5;
/// Beyond this many pixels the equation is solved at half the resolution: it would take too many
/// seconds and gigabytes.
pub const MOST_UNKNOWNS: usize = 1 << 24;

/// u, px², over the planes of an outline: 0 outside, −∇²u = 4 inside (SHAPE: inflation).
///
/// A disc of radius R gives R² − r² and so half a sphere; a strip of half width w gives 2(w² − x²).
/// * `joined`: as in [`OutlineRim::with_joined_pixels`].
/// * `start`: the u of a nearly identical outline of the same size.
///
/// `≥ 0`, finite.
pub fn inflate(
    outline: &Outline,
    joined: Option<&Plane<bool>>,
    start: Option<&Plane<f32>>,
) -> Plane<f32> {
    if outline.size().area() > MOST_UNKNOWNS && joined.is_none() {
        return double(&inflate_halved(outline), outline);
    }
    let rim = OutlineRim::of(outline, joined);
    let inside = outline.inside_pixels();
    let source = inside.map(|i| if i { 4.0 } else { 0.0 });
    let u = rim.equation(|_, _| 0.0).solve(&source, start, GOAL);
    u.updated(|x, y, u| if inside.at(x, y) && u.is_finite() { u.max(0.0) } else { 0.0 })
}

/// u of the outline at half its resolution, in px² of that.
fn inflate_halved(outline: &Outline) -> Plane<f32> {
    let fine = outline.size();
    let size = Size::new(fine.width.div_ceil(2), fine.height.div_ceil(2));
    let at =
        |x: usize, y: usize| u32::from(outline.coverage().get(x as i32, y as i32).unwrap_or(0));
    let mean = Plane::from_fn(size, |x, y| {
        let (x, y) = (2 * x, 2 * y);
        ((at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1) + 2) / 4) as u8
    });
    let Some(half) = Outline::new((0, 0), &mean) else { return Plane::full(size, 0.0) };
    let u = inflate(&half, None, None);
    let corner = half.corner();
    Plane::from_fn(size, |x, y| u.get(x as i32 - corner.0, y as i32 - corner.1).unwrap_or(0.0))
}

/// A field of half the resolution over the inside of an outline, read between its pixels; px²
/// become four.
fn double(half: &Plane<f32>, outline: &Outline) -> Plane<f32> {
    Plane::from_fn(outline.size(), |x, y| {
        if !outline.inside_pixels().at(x, y) {
            return 0.0;
        }
        let (px, py) = (x as f32 * 0.5 - 0.25, y as f32 * 0.5 - 0.25);
        let (x0, y0) = (px.floor(), py.floor());
        let at = |dx: i32, dy: i32| half.at_clamped(x0 as i32 + dx, y0 as i32 + dy);
        let (fx, fy) = (px - x0, py - y0);
        let row = |dy: i32| at(0, dy) * (1.0 - fx) + at(1, dy) * fx;
        4.0 * (row(0) * (1.0 - fy) + row(1) * fy)
    })
}
