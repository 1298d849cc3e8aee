//! Touches: normals that were put down by hand, spread over a form.
//! Floor 3. They are soft constraints on δ = n̄ wanted − n̄ there is: ∇²δ = 0 between them and δ = 0 at the rim, or
//! within a reach ρ of each −∇²δ + δ/ρ² = 0.

use super::{Form, Outline, Rim};
use crate::math::{Range, Vec2, Vec3, vec2, vec3};
use crate::raster::Plane;
use crate::surface::integrate::depth_from_normals;

/// How firmly a touch holds, against the springs between pixels, which are 1.
const FIRM: f32 = 1e3;
/// The residual, squared, as a part of the right-hand side, which the firm springs rule: a ten thousandth of what is
/// left where the search begins.
const GOAL: f64 = 1e-14;

/// One touch of the normal brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Canvas px.
    pub at: Vec2,
    /// px.
    pub radius: f32,
    /// Unit, camera space (y up).
    pub normal: Vec3,
    /// How far it is felt, px; 0: to the rim and the next touches.
    pub reach: f32,
}

impl Touch {
    pub const RADIUS: Range = 0.5..=4096.0;
    pub const REACH: Range = 0.0..=16384.0;
    /// Touches of one part.
    pub const MOST: usize = 100_000;
}

/// A form with touches: its normals nearest to what was asked for, and the heights that follow.
///
/// Of touches that overlap the last one holds. Those with the same reach are spread at once, the farthest first; what
/// is nearer then changes only what is left to change. Inside a touch the form keeps its own curvature: its mean normal
/// there becomes the touch's.
pub fn touched(form: &Form, outline: &Outline, touches: &[Touch]) -> Form {
    let inside = outline.inside();
    if form.normals.size() != inside.size() || touches.is_empty() {
        return form.clone();
    }
    let bar = form.normals.map(|n| vec2(n.x, -n.y));
    let mut reaches: Vec<f32> = touches.iter().map(|t| if t.reach > 0.0 { t.reach } else { f32::INFINITY }).collect();
    reaches.sort_by(|a, b| b.total_cmp(a));
    reaches.dedup();
    let mut delta = Plane::filled(inside.size(), Vec2::ZERO);
    for reach in reaches {
        let now = Plane::from_fn(inside.size(), |x, y| bar.at(x, y) + delta.at(x, y));
        let (held, wanted) = constraints(outline, &now, touches, reach);
        let step = spread(outline, &held, &wanted, reach);
        delta = delta.updated(|x, y, d| d + step.at(x, y));
    }
    let normals = Plane::from_fn(inside.size(), |x, y| {
        let n = form.normals.at(x, y);
        if inside.at(x, y) { lifted(bar.at(x, y) + delta.at(x, y)) } else { n }
    });
    with_normals(form, outline, normals)
}

/// The unit normal (camera space, y up) over a projected one, which is held shorter than 1.
pub fn lifted(bar: Vec2) -> Vec3 {
    const LONGEST: f32 = 0.999;
    let bar = if bar.is_finite() { bar.clamp_length_max(LONGEST) } else { Vec2::ZERO };
    vec3(bar.x, -bar.y, (1.0 - bar.length_squared()).max(0.0).sqrt())
}

/// Which pixels are held, and δ there: own touches ask for their normal, others for no change.
fn constraints(outline: &Outline, bar: &Plane<Vec2>, touches: &[Touch], reach: f32) -> (Plane<bool>, Plane<Vec2>) {
    let (inside, corner) = (outline.inside(), outline.corner());
    let mut held = Plane::filled(inside.size(), false);
    let mut wanted = Plane::filled(inside.size(), Vec2::ZERO);
    for touch in touches {
        let own = if touch.reach > 0.0 { touch.reach == reach } else { reach.is_infinite() };
        let center = touch.at - vec2(corner.0 as f32, corner.1 as f32);
        let pixels: Vec<(usize, usize)> = disc(inside, center, touch.radius).collect();
        let mean = pixels.iter().map(|p| bar.at(p.0, p.1)).sum::<Vec2>() / pixels.len().max(1) as f32;
        let delta = if own { vec2(touch.normal.x, -touch.normal.y) - mean } else { Vec2::ZERO };
        for (x, y) in pixels {
            held.set(x, y, true);
            wanted.set(x, y, if delta.is_finite() { delta } else { Vec2::ZERO });
        }
    }
    (held, wanted)
}

/// The inside pixels whose centres lie within a radius; at least the one that holds the centre.
fn disc(inside: &Plane<bool>, center: Vec2, radius: f32) -> impl Iterator<Item = (usize, usize)> + '_ {
    let (w, h) = (inside.width(), inside.height());
    let side = |low: f32, high: f32, n: usize| low.floor().max(0.0) as usize..(high.ceil().max(0.0) as usize).min(n);
    let columns = side(center.x - radius, center.x + radius, w);
    side(center.y - radius, center.y + radius, h).flat_map(move |y| {
        columns.clone().filter_map(move |x| {
            let from = vec2(x as f32 + 0.5, y as f32 + 0.5) - center;
            let here = from.abs().max_element() <= 0.5;
            (inside.at(x, y) && (here || from.length() <= radius)).then_some((x, y))
        })
    })
}

/// δ over the outline: what is wanted where it is held, 0 at the rim, smooth between.
pub fn spread(outline: &Outline, held: &Plane<bool>, wanted: &Plane<Vec2>, reach: f32) -> Plane<Vec2> {
    spread_within(&Rim::silhouette(outline), held, wanted, reach)
}

/// The same within a rim that is free in part.
pub fn spread_within(rim: &Rim, held: &Plane<bool>, wanted: &Plane<Vec2>, reach: f32) -> Plane<Vec2> {
    let screen = if reach.is_finite() { 1.0 / (reach * reach).max(0.25) } else { 0.0 };
    let equation = rim.equation(|x, y| if held.at(x, y) { FIRM } else { screen });
    let component = |c: usize| {
        let source = Plane::from_fn(held.size(), |x, y| if held.at(x, y) { FIRM * wanted.at(x, y)[c] } else { 0.0 });
        // Where a touch holds, δ is known to a thousandth.
        let start = Plane::from_fn(held.size(), |x, y| if held.at(x, y) { wanted.at(x, y)[c] } else { 0.0 });
        equation.solve(&source, Some(&start), GOAL)
    };
    let (x, y) = (component(0), component(1));
    Plane::from_fn(held.size(), |i, j| vec2(x.at(i, j), y.at(i, j)))
}

/// A form with other normals, and heights whose slopes they are, as high in the mean as before.
pub fn with_normals(form: &Form, outline: &Outline, normals: Plane<Vec3>) -> Form {
    let inside = outline.inside();
    let mean = |plane: &dyn Fn(usize) -> f32| {
        let held = inside.values().iter().enumerate().filter(|(_, i)| **i);
        let (sum, count) = held.fold((0.0f64, 0u32), |(s, n), (i, _)| (s + f64::from(plane(i)), n + 1));
        (sum / f64::from(count.max(1))) as f32
    };
    let Some(found) = depth_from_normals(&normals, inside) else { return form.clone() };
    let rise = |i: usize| -found.depth.values()[i] * found.range_px;
    let shift = mean(&|i| form.height.values()[i]) - mean(&rise);
    let width = inside.width();
    let height = form.height.clone().updated(|x, y, z| if inside.at(x, y) { rise(y * width + x) + shift } else { z });
    Form { height, normals, ..form.clone() }
}
