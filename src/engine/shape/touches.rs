//! Touches: normals placed by hand, spread over a form. Floor 3. They are soft constraints on δ =
//! n̄ wanted − n̄ present: ∇²δ = 0 between them and δ = 0 at the rim, or within a reach ρ of each
//! −∇²δ + δ/ρ² = 0.

use super::following::Following;
use super::rim::Equation;
use super::{Form, Outline, OutlineRim};
use crate::math::{Range, Rect, Vec2, Vec3, parallel, vec2, vec3};
use crate::raster::Plane;
use crate::surface::integrate::depth_from_normals;

/// How firmly a touch holds, relative to the couplings between pixels, which are 1.
const FIRM: f32 = 1e3;
/// The squared residual, relative to the right-hand side, which the firm couplings dominate: a ten
/// thousandth of the residual at the start.
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
    /// How far it reaches, px; 0: to the rim and the next touches.
    pub reach: f32,
}

impl Touch {
    /// What a radius may be, px.
    pub const RADIUS: Range = 0.5..=4096.0;
    /// What a reach may be, px.
    pub const REACH: Range = 0.0..=16384.0;
    /// The most touches of one part.
    pub const MOST: usize = 100_000;
}

/// The same for the first frame of a draft: the search need only come close.
const ROUGH_GOAL: f64 = 1e-11;

/// How far touches came on a form while the user edits them: the next search begins there. Only for
/// drafts, since the result depends on the steps before.
#[derive(Default)]
pub struct Touching {
    /// By reach.
    steps: Vec<TouchingStep>,
    heights: Option<Following>,
    /// Around what changed since the last frame.
    near: Rect,
    /// What they are over.
    outline: Option<Outline>,
}

/// How far the touches of one reach came.
struct TouchingStep {
    reach: f32,
    held: Plane<bool>,
    wanted: Plane<Vec2>,
    equation: Equation,
    delta: [Plane<f32>; 2],
}

/// A form with touches: the normals nearest to the requested ones, and the heights that follow.
///
/// Where touches overlap, the last one holds. Those with the same reach are spread together, the
/// farthest first; nearer ones then change only what remains. Inside a touch the form keeps its own
/// curvature: its mean normal there becomes the touch's.
///
/// * `last`: in a draft, how far it came, and then how far it comes.
pub fn apply_touches(
    form: &Form,
    outline: &Outline,
    touches: &[Touch],
    mut last: Option<&mut Touching>,
) -> Form {
    let inside = outline.inside_pixels();
    if form.normals.size() != inside.size() || touches.is_empty() {
        return form.clone();
    }
    if let Some(last) = &mut last {
        last.begin_over(outline);
        last.near = Rect::EMPTY;
    }
    let bar = form.normals.map(|n| vec2(n.x, -n.y));
    let mut reaches: Vec<f32> =
        touches.iter().map(|t| if t.reach > 0.0 { t.reach } else { f32::INFINITY }).collect();
    reaches.sort_by(|a, b| b.total_cmp(a));
    reaches.dedup();
    let mut delta = Plane::full(inside.size(), Vec2::ZERO);
    for reach in reaches {
        let now = Plane::from_fn(inside.size(), |x, y| bar.at(x, y) + delta.at(x, y));
        let (held, wanted) = constraints(outline, &now, touches, reach);
        let step = match &mut last {
            None => spread(outline, &held, &wanted, reach),
            Some(last) => last.spread(outline, (&held, &wanted), reach),
        };
        delta = delta.updated(|x, y, d| d + step.at(x, y));
    }
    let normals = Plane::from_fn(inside.size(), |x, y| {
        let n = form.normals.at(x, y);
        if inside.at(x, y) { unproject_normal(bar.at(x, y) + delta.at(x, y)) } else { n }
    });
    match last {
        None => with_normals(form, outline, normals),
        Some(last) => last.with_normals(form, outline, normals),
    }
}

impl Touching {
    /// Forgets what is known of another outline.
    fn begin_over(&mut self, outline: &Outline) {
        if self.outline.as_ref() != Some(outline) {
            *self = Self { outline: Some(outline.clone()), ..Self::default() };
        }
    }

    /// As [`spread`], approximately, begun where the last one of this reach ended.
    fn spread(
        &mut self,
        outline: &Outline,
        (held, wanted): (&Plane<bool>, &Plane<Vec2>),
        reach: f32,
    ) -> Plane<Vec2> {
        let rim = OutlineRim::silhouette(outline);
        let known = self
            .steps
            .iter()
            .position(|step| step.reach == reach)
            .map(|at| self.steps.swap_remove(at));
        let step = match known {
            Some(known) => {
                let (step, near) = known.advance(&rim, (held, wanted));
                self.near = self.near.union(near);
                step
            }
            None => {
                let equation = touching(&rim, held, reach);
                let delta = solve_displacement(&equation, (held, wanted), ROUGH_GOAL);
                TouchingStep { reach, held: held.clone(), wanted: wanted.clone(), equation, delta }
            }
        };
        let spread = side_by_side(&step.delta);
        self.steps.push(step);
        spread
    }

    /// As [`with_normals`], approximately.
    fn with_normals(&mut self, form: &Form, outline: &Outline, normals: Plane<Vec3>) -> Form {
        let inside = outline.inside_pixels();
        let Some(mut following) = self.heights.take().or_else(|| Following::of(&normals, inside))
        else {
            return with_normals(form, outline, normals);
        };
        let (far, width) = (following.go_on(&normals, inside, self.near), inside.width());
        let form = with_heights(form, inside, normals, |x, y| -far[y * width + x]);
        self.heights = Some(following);
        form
    }
}

impl TouchingStep {
    /// One more frame, and the pixels around what changed in it.
    fn advance(
        mut self,
        rim: &OutlineRim,
        (held, wanted): (&Plane<bool>, &Plane<Vec2>),
    ) -> (Self, Rect) {
        /// As far as a touch is felt strongly, px.
        const FELT: i32 = 12;
        const SMALL: f32 = 0.01;
        let width = held.width();
        let is_other = |i: &usize| {
            held.values()[*i] != self.held.values()[*i]
                || wanted.values()[*i].distance_squared(self.wanted.values()[*i]) > SMALL * SMALL
        };
        let changed: Vec<_> =
            (0..held.values().len()).filter(is_other).map(|i| (i % width, i / width)).collect();
        let pixel =
            |p: &(usize, usize)| Rect::new(p.0 as i32, p.1 as i32, p.0 as i32 + 1, p.1 as i32 + 1);
        let near = changed.iter().fold(Rect::EMPTY, |all, p| all.union(pixel(p)));
        let near = if near.is_empty() { near } else { near.grown(FELT) };
        self.equation.hold(rim, &changed, stiffness(held, self.reach));
        for (c, delta) in self.delta.iter_mut().enumerate() {
            let last = std::mem::replace(delta, Plane::full(held.size(), 0.0));
            let start = last.updated(|x, y, d| if held.at(x, y) { wanted.at(x, y)[c] } else { d });
            *delta = self.equation.approach(&source(held, wanted, c), start, near);
        }
        self.held = held.clone();
        self.wanted = wanted.clone();
        (self, near)
    }
}

/// The unit normal (camera space, y up) over a projected one, which is kept shorter than 1.
pub fn unproject_normal(bar: Vec2) -> Vec3 {
    const LONGEST: f32 = 0.999;
    let bar = if bar.is_finite() { bar.clamp_length_max(LONGEST) } else { Vec2::ZERO };
    vec3(bar.x, -bar.y, (1.0 - bar.length_squared()).max(0.0).sqrt())
}

/// Which pixels are held, and δ there: own touches set their normal, others no change.
fn constraints(
    outline: &Outline,
    bar: &Plane<Vec2>,
    touches: &[Touch],
    reach: f32,
) -> (Plane<bool>, Plane<Vec2>) {
    let (inside, corner) = (outline.inside_pixels(), outline.corner());
    let mut held = Plane::full(inside.size(), false);
    let mut wanted = Plane::full(inside.size(), Vec2::ZERO);
    for touch in touches {
        let own = if touch.reach > 0.0 { touch.reach == reach } else { reach.is_infinite() };
        let center = touch.at - vec2(corner.0 as f32, corner.1 as f32);
        let pixels: Vec<(usize, usize)> = disc(inside, center, touch.radius).collect();
        let mean =
            pixels.iter().map(|p| bar.at(p.0, p.1)).sum::<Vec2>() / pixels.len().max(1) as f32;
        let delta = if own { vec2(touch.normal.x, -touch.normal.y) - mean } else { Vec2::ZERO };
        for (x, y) in pixels {
            held.set(x, y, true);
            wanted.set(x, y, if delta.is_finite() { delta } else { Vec2::ZERO });
        }
    }
    (held, wanted)
}

/// The inside pixels whose centers lie within a radius; at least the one that holds the center.
fn disc(
    inside: &Plane<bool>,
    center: Vec2,
    radius: f32,
) -> impl Iterator<Item = (usize, usize)> + '_ {
    let (w, h) = (inside.width(), inside.height());
    let side = |low: f32, high: f32, n: usize| {
        low.floor().max(0.0) as usize..(high.ceil().max(0.0) as usize).min(n)
    };
    let columns = side(center.x - radius, center.x + radius, w);
    side(center.y - radius, center.y + radius, h).flat_map(move |y| {
        columns.clone().filter_map(move |x| {
            let from = vec2(x as f32 + 0.5, y as f32 + 0.5) - center;
            let here = from.abs().max_element() <= 0.5;
            (inside.at(x, y) && (here || from.length() <= radius)).then_some((x, y))
        })
    })
}

/// δ over the outline: the wanted value where it is held, 0 at the rim, smooth between.
pub fn spread(
    outline: &Outline,
    held: &Plane<bool>,
    wanted: &Plane<Vec2>,
    reach: f32,
) -> Plane<Vec2> {
    spread_within(&OutlineRim::silhouette(outline), held, wanted, reach)
}

/// The same within a partly free rim.
pub fn spread_within(
    rim: &OutlineRim,
    held: &Plane<bool>,
    wanted: &Plane<Vec2>,
    reach: f32,
) -> Plane<Vec2> {
    side_by_side(&solve_displacement(&touching(rim, held, reach), (held, wanted), GOAL))
}

/// How firmly each pixel is held: by touches, and by a reach, px; one that is infinite does not
/// hold.
fn stiffness(held: &Plane<bool>, reach: f32) -> impl Fn(usize, usize) -> f32 + Sync + '_ {
    let screen = if reach.is_finite() { 1.0 / (reach * reach).max(0.25) } else { 0.0 };
    move |x, y| if held.at(x, y) { FIRM } else { screen }
}

/// The equation of δ.
fn touching(rim: &OutlineRim, held: &Plane<bool>, reach: f32) -> Equation {
    rim.equation(stiffness(held, reach))
}

/// The right-hand side of one component of δ.
fn source(held: &Plane<bool>, wanted: &Plane<Vec2>, component: usize) -> Plane<f32> {
    Plane::from_fn(
        held.size(),
        |x, y| if held.at(x, y) { FIRM * wanted.at(x, y)[component] } else { 0.0 },
    )
}

/// The components of δ.
fn solve_displacement(
    equation: &Equation,
    (held, wanted): (&Plane<bool>, &Plane<Vec2>),
    goal: f64,
) -> [Plane<f32>; 2] {
    [0, 1].map(|c| {
        // Where a touch holds, δ is known to a thousandth.
        let start =
            Plane::from_fn(
                held.size(),
                |x, y| if held.at(x, y) { wanted.at(x, y)[c] } else { 0.0 },
            );
        equation.solve(&source(held, wanted, c), Some(&start), goal)
    })
}

fn side_by_side([x, y]: &[Plane<f32>; 2]) -> Plane<Vec2> {
    Plane::from_fn(x.size(), |i, j| vec2(x.at(i, j), y.at(i, j)))
}

/// A form with other normals, and heights with these slopes, as high in the mean as before.
pub fn with_normals(form: &Form, outline: &Outline, normals: Plane<Vec3>) -> Form {
    let inside = outline.inside_pixels();
    let Some(found) = depth_from_normals(&normals, inside) else { return form.clone() };
    with_heights(form, inside, normals, |x, y| -found.depth.at(x, y) * found.range_px)
}

/// A form with other normals and heights, the heights moved to the same mean as before.
fn with_heights(
    form: &Form,
    inside: &Plane<bool>,
    normals: Plane<Vec3>,
    rise: impl Fn(usize, usize) -> f32 + Sync,
) -> Form {
    let rows = 0..inside.height();
    let risen =
        Plane::from_fn(inside.size(), |x, y| if inside.at(x, y) { rise(x, y) } else { 0.0 });
    let mean = |plane: &Plane<f32>| {
        let of_row = |y: usize| {
            let held = plane.row(y).iter().zip(inside.row(y)).filter(|(_, is)| **is);
            held.fold((0.0f64, 0u32), |(sum, n), (z, _)| (sum + f64::from(*z), n + 1))
        };
        let sums: Vec<(f64, u32)> = parallel::map(rows.clone(), of_row);
        let (sum, count) = sums.iter().fold((0.0, 0), |(s, n), (sum, count)| (s + sum, n + count));
        (sum / f64::from(count.max(1))) as f32
    };
    let shift = mean(&form.height) - mean(&risen);
    let height =
        risen.updated(|x, y, z| if inside.at(x, y) { z + shift } else { form.height.at(x, y) });
    Form {
        height: height.into(),
        normals: normals.into(),
        corner: form.corner,
        coverage: form.coverage.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;
    use crate::shape::Roundness;
    use crate::shape::inflate::inflate;

    #[test]
    fn a_draft_of_touches_that_grow_is_nearly_what_they_are_at_once() {
        let disc = Plane::from_fn(Size::new(200, 180), |x, y| {
            if vec2(x as f32 - 100.0, y as f32 - 90.0).length() < 80.0 { 255u8 } else { 0 }
        });
        let outline = Outline::new((0, 0), &disc).unwrap();
        let round = Roundness { puff: 0.7, rim_deg: 90.0 };
        let form = Form::of_squares(
            &outline,
            &inflate(&outline, None, None),
            &OutlineRim::silhouette(&outline),
            round,
        );
        let touch = |i: usize| Touch {
            at: vec2(60.0 + 9.0 * i as f32, 80.0 + 5.0 * (i % 3) as f32),
            radius: 4.0,
            normal: vec3(-0.3, 0.4 - 0.1 * i as f32, 1.0).normalize(),
            reach: if i % 4 == 3 { 20.0 } else { 0.0 },
        };
        let touches: Vec<Touch> = (0..9).map(touch).collect();
        let mut last = Touching::default();
        for n in 3..=9 {
            let (draft, whole) = (
                apply_touches(&form, &outline, &touches[..n], Some(&mut last)),
                apply_touches(&form, &outline, &touches[..n], None),
            );
            let inside = outline
                .inside_pixels()
                .values()
                .iter()
                .enumerate()
                .filter(|(_, is)| **is)
                .map(|(i, _)| i);
            let (mut turned, mut off) = (0.0f32, 0.0f32);
            for i in inside {
                turned = turned.max(draft.normals.values()[i].distance(whole.normals.values()[i]));
                off = off.max((draft.height.values()[i] - whole.height.values()[i]).abs());
            }
            assert!(turned < 0.02, "{turned} after {n}");
            assert!(off < 1.5, "{off} px after {n}");
        }
    }
}
