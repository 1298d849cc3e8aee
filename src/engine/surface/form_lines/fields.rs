//! Curves of smooth forms: suggestive contours, apparent ridges and valleys, the edge of light, and
//! wires. Each is where a map is zero, traced through the cells between four pixels that are linked.
//! Floor 2. Not here: what is left of them (`tidy`).

use super::chains::{LineStep, join_steps, pair_crossings, sides};
use super::smooth::{SmoothNormals, diffuse_copy, gradient_of};
use super::tidy::RawLine;
use super::{LineKind, LinePoint, LineSettings};
use crate::math::{Vec2, Vec3, vec2, vec3};
use crate::raster::Plane;
use crate::surface::shadow::ShadowLamp;
use crate::surface::unwrap::Unwrapping;
use crate::surface::{Surface, links};
use rayon::prelude::*;

/// Where the surface is tilted less, sin, it is not about to be an outline.
const LEAST_TILT: f32 = 0.25;
/// Turns of the normal over σ from which a crest is seen at all, and up to which it grows clearer,
/// rad.
const RIDGE: (f32, f32) = (0.06, 0.5);
/// By how much the turn on both sides of a crest must be less, of rad over σ.
const RIDGE_DROP: f32 = 2e-3;
/// What makes a second derivative over σ² a strength.
const SUGGESTIVE_SCALE: f32 = 8.0;
/// What faces the light less, n·ℓ, has no edge of a cast shadow: it is dark by itself.
const LEAST_LIT: f32 = 0.12;
/// Shadows that are kept.
const KEPT_SHADOWS: usize = 3;

/// What curves are traced from.
pub(super) struct FormCurves<'s> {
    pub surface: &'s Surface,
    pub normals: &'s SmoothNormals,
    pub settings: &'s LineSettings,
}

/// How fast the three values of a map change, as the normals of a surface turn: how fast at most,
/// per px, and which way.
pub(super) struct Turns {
    pub most: Plane<f32>,
    /// Unit; the sign is arbitrary.
    pub way: [Plane<f32>; 2],
    /// How the change grows along that way.
    pub growth: Plane<f32>,
}

impl Turns {
    /// q, the largest singular value of the derivative of three planes along links, its direction t,
    /// and ∂q/∂t.
    pub fn of(planes: [&Plane<f32>; 3], links: &Plane<u8>) -> Self {
        let size = links.size();
        // q, t_x, t_y.
        let all = Plane::from_fn(size, |x, y| {
            let linked = links.at(x, y);
            if linked == 0 {
                return [0.0; 3];
            }
            let slopes = planes.map(|plane| gradient_of(plane, linked, x, y));
            let sum = |of: &dyn Fn(Vec2) -> f32| slopes.iter().map(|s| of(*s)).sum::<f32>();
            let (xx, yy) = (sum(&|s| s.x * s.x), sum(&|s| s.y * s.y));
            let xy = sum(&|s| s.x * s.y);
            let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
            let larger = mean + half.hypot(xy);
            let way = if xx > yy { vec2(larger - yy, xy) } else { vec2(xy, larger - xx) };
            let way = way.normalize_or_zero();
            [larger.max(0.0).sqrt(), way.x, way.y]
        });
        let [most, x, y] = [0, 1, 2].map(|i| all.map(move |v| v[i]));
        let growth = Plane::from_fn(size, |px, py| {
            gradient_of(&most, links.at(px, py), px, py).dot(vec2(x.at(px, py), y.at(px, py)))
        });
        Self { most, way: [x, y], growth }
    }

    /// The direction at a pixel.
    pub fn way_at(&self, (x, y): (usize, usize)) -> Vec2 {
        vec2(self.way[0].at(x, y), self.way[1].at(x, y))
    }

    /// Where between two pixels the change is at its most along its way.
    pub fn crest(
        &self,
        a: (usize, usize),
        b: (usize, usize),
        links: &Plane<u8>,
        px: f32,
    ) -> Option<Crest> {
        let cos = self.way_at(a).dot(self.way_at(b));
        if cos.abs() < 0.5 {
            return None;
        }
        let agreed = cos.signum() * self.growth.at(b.0, b.1);
        let t = zero(self.growth.at(a.0, a.1), agreed)?;
        let (from, to) = (self.most.at(a.0, a.1), self.most.at(b.0, b.1));
        let middle = place(a).lerp(place(b), t);
        let step = (self.way_at(a) + cos.signum() * self.way_at(b)).normalize_or_zero() * px;
        let beside = [middle + step, middle - step].map(|at| bilinear(&self.most, links, at, a));
        Some(Crest { t, most: from + t * (to - from), beside: beside[0].max(beside[1]) })
    }
}

/// The most of a change between two pixels.
pub(super) struct Crest {
    /// Where, `[0, 1]`.
    pub t: f32,
    /// How fast it is there, per px.
    pub most: f32,
    /// And beside it, on the side where it is faster.
    pub beside: f32,
}

impl FormCurves<'_> {
    /// The curves of the form itself, of every kind that is wanted.
    pub fn trace_form(&self) -> Vec<RawLine> {
        let wants = |kind| self.settings.kinds.has_kind(kind);
        let mut lines = Vec::new();
        if wants(LineKind::Valley) || wants(LineKind::Ridge) {
            lines.extend(self.ridges());
        }
        if wants(LineKind::Suggestive) {
            lines.extend(self.suggestive());
        }
        lines
    }

    /// Those of its light.
    pub fn trace_light(&self) -> Vec<RawLine> {
        let wants = |kind| self.settings.kinds.has_kind(kind);
        let mut lines = Vec::new();
        if wants(LineKind::Light) {
            lines.extend(self.light());
        }
        if wants(LineKind::Shadow) {
            lines.extend(self.shadows());
        }
        lines
    }

    fn links_at(&self, x: usize, y: usize) -> u8 {
        self.surface.links_plane().at(x, y)
    }

    /// ∂(n̄·v)/∂ĝ is zero and grows along ĝ = n̄/|n̄| (DeCarlo et al. 2003).
    fn suggestive(&self) -> Vec<RawLine> {
        let [nx, ny, nz] = &self.normals.planes;
        let way = |x: usize, y: usize| {
            let g = vec2(nx.at(x, y), ny.at(x, y));
            g / g.length().max(1e-6)
        };
        let slope = Plane::from_fn(nz.size(), |x, y| {
            gradient_of(nz, self.links_at(x, y), x, y).dot(way(x, y))
        });
        let scale = SUGGESTIVE_SCALE * self.normals.smooth_px * self.normals.smooth_px;
        let at = |(x, y): (usize, usize)| {
            let tilt = self.normals.nbar(x, y).length();
            let second = gradient_of(&slope, self.links_at(x, y), x, y).dot(way(x, y));
            if tilt > LEAST_TILT { second * scale } else { -1.0 }
        };
        let crossing = |a: (usize, usize), b: (usize, usize)| {
            let t = zero(slope.at(a.0, a.1), slope.at(b.0, b.1))?;
            let (from, to) = (at(a), at(b));
            let strength = from + t * (to - from);
            (from > 0.0 && to > 0.0 && strength > 0.0).then_some((t, strength.min(1.0)))
        };
        trace_lines(LineKind::Suggestive, self.surface.links_plane(), crossing)
    }

    /// q is the largest singular value of ∂n̄/∂q and t its direction: ∂q/∂t is zero, and q a maximum
    /// (Judd et al. 2007). tᵀ J_xy t is negative in a hollow.
    fn ridges(&self) -> Vec<RawLine> {
        let [nx, ny, nz] = &self.normals.planes;
        let links = self.surface.links_plane();
        let turns = Turns::of([nx, ny, nz], links);
        let sigma = self.normals.smooth_px.max(1.0);
        let found = |wants_hollow: bool| {
            let turns = &turns;
            move |a: (usize, usize), b: (usize, usize)| {
                let crest = turns.crest(a, b, links, 0.5 * sigma)?;
                let q = crest.most * sigma;
                if q <= RIDGE.0 || self.is_hollow(a, turns.way_at(a)) != wants_hollow {
                    return None;
                }
                let drop = q - crest.beside * sigma;
                (drop > RIDGE_DROP).then_some((crest.t, ((q - RIDGE.0) / RIDGE.1).min(1.0)))
            }
        };
        let mut lines = Vec::new();
        for (kind, hollow) in [(LineKind::Valley, true), (LineKind::Ridge, false)] {
            if self.settings.kinds.has_kind(kind) {
                lines.extend(trace_lines(kind, links, found(hollow)));
            }
        }
        lines
    }

    fn is_hollow(&self, (x, y): (usize, usize), way: Vec2) -> bool {
        let linked = self.links_at(x, y);
        let [dx, dy] = [0, 1].map(|i| gradient_of(&self.normals.planes[i], linked, x, y));
        way.x * dx.dot(way) + way.y * dy.dot(way) < 0.0
    }

    /// n̄·ℓ is what light the edge has.
    fn light(&self) -> Vec<RawLine> {
        let toward = self.settings.light.normalize_or(Vec3::Z);
        let toward = vec3(toward.x, -toward.y, toward.z);
        let lit = |(x, y): (usize, usize)| {
            self.normals.nbar(x, y).extend(self.normals.nz(x, y)).dot(toward) - self.settings.lit
        };
        let crossing = |a, b| Some((zero(lit(a), lit(b))?, 1.0));
        trace_lines(LineKind::Light, self.surface.links_plane(), crossing)
    }

    /// Half of the lamp is seen, where the form faces it.
    fn shadows(&self) -> Vec<RawLine> {
        let toward = self.settings.light.normalize_or(Vec3::Z);
        let lamp = ShadowLamp::of_drawing(toward, self.surface.size());
        let share = self.surface.shadow(&lamp, KEPT_SHADOWS);
        let seen = Plane::from_fn(self.surface.size(), |x, y| share.at(x, y) - 0.5);
        let seen = diffuse_copy(&seen, self.surface, self.normals.smooth_px.max(1.0));
        let toward = vec3(toward.x, -toward.y, toward.z);
        let is_facing = |(x, y): (usize, usize)| {
            self.normals.nbar(x, y).extend(self.normals.nz(x, y)).dot(toward) > LEAST_LIT
        };
        let crossing = |a: (usize, usize), b: (usize, usize)| {
            let t = zero(seen.at(a.0, a.1), seen.at(b.0, b.1))?;
            (is_facing(a) && is_facing(b)).then_some((t, 1.0))
        };
        trace_lines(LineKind::Shadow, self.surface.links_plane(), crossing)
    }
}

/// A map between pixels; of pixels that are not linked to any, the middle's value.
fn bilinear(plane: &Plane<f32>, links: &Plane<u8>, at: Vec2, middle: (usize, usize)) -> f32 {
    let at = at - 0.5;
    let (x, y) = (at.x.floor() as i32, at.y.floor() as i32);
    let (fx, fy) = (at.x - x as f32, at.y - y as f32);
    let own = plane.at(middle.0, middle.1);
    let value = |dx: i32, dy: i32| {
        let linked = links.get(x + dx, y + dy).unwrap_or(0);
        if linked == 0 { own } else { plane.at_clamped(x + dx, y + dy) }
    };
    let row = |dy: i32| value(0, dy) + fx * (value(1, dy) - value(0, dy));
    row(0) + fy * (row(1) - row(0))
}

/// Lines through the cells of linked pixels.
///
/// * `crossing`: where between two pixels a line of this kind is, and how clear it is.
pub(super) fn trace_lines(
    kind: LineKind,
    links: &Plane<u8>,
    crossing: impl Fn((usize, usize), (usize, usize)) -> Option<(f32, f32)> + Sync,
) -> Vec<RawLine> {
    let rows: Vec<Vec<LineStep>> = (0..links.height().saturating_sub(1))
        .into_par_iter()
        .map(|y| {
            let mut steps = Vec::new();
            for x in (0..links.width() - 1).filter(|&x| links::is_one_piece(links, x, y)) {
                let mut found: Vec<(u64, LinePoint)> = Vec::with_capacity(4);
                for (a, b, key) in sides(x, y, links.width()) {
                    if let Some((t, strength)) = crossing(a, b) {
                        let at = place(a).lerp(place(b), t);
                        found.push((key, LinePoint { at, strength }));
                    }
                }
                let apart = |a: (u64, LinePoint), b: (u64, LinePoint)| a.1.at.distance(b.1.at);
                steps.extend(
                    pair_crossings(&found, apart)
                        .into_iter()
                        .map(|[a, b]| LineStep { keys: [a.0, b.0], points: [a.1, b.1] }),
                );
            }
            steps
        })
        .collect();
    let steps: Vec<LineStep> = rows.into_iter().flatten().collect();
    let raw = |chain: super::chains::Chain| RawLine {
        kind,
        points: chain.points,
        is_closed: chain.is_closed,
    };
    join_steps(&steps).into_iter().map(raw).collect()
}

/// The middle of a pixel.
fn place((x, y): (usize, usize)) -> Vec2 {
    vec2(x as f32 + 0.5, y as f32 + 0.5)
}

/// Where a value from `a` to `b` is zero, `[0, 1]`; `None` if both have one sign.
#[inline(always)]
fn zero(a: f32, b: f32) -> Option<f32> {
    ((a < 0.0) != (b < 0.0)).then(|| (a / (a - b)).max(0.0).min(1.0))
}

/// Lines of the plane that a surface unwraps to, equally far apart there, both ways.
pub(super) fn wires(
    surface: &Surface,
    unwrapped: &Unwrapping,
    settings: &LineSettings,
) -> Vec<RawLine> {
    let links = surface.links_plane();
    let spacing = settings.wires.max(1.0);
    let mut lines = Vec::new();
    for plane in unwrapped.planes() {
        let rows: Vec<Vec<LineStep>> = (0..links.height().saturating_sub(1))
            .into_par_iter()
            .map(|y| {
                let mut steps = Vec::new();
                for x in (0..links.width() - 1).filter(|&x| links::is_one_piece(links, x, y)) {
                    wire_steps(plane, spacing, (x, y), &mut steps);
                }
                steps
            })
            .collect();
        let steps: Vec<LineStep> = rows.into_iter().flatten().collect();
        lines.extend(join_steps(&steps).into_iter().map(|chain| RawLine {
            kind: LineKind::Wire,
            points: chain.points,
            is_closed: chain.is_closed,
        }));
    }
    lines
}

/// The steps of the wires that cross a cell.
fn wire_steps(plane: &Plane<f32>, spacing: f32, (x, y): (usize, usize), out: &mut Vec<LineStep>) {
    let corners = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
    let values = corners.map(|(x, y)| plane.at(x, y) / spacing);
    let [low, high] = [f32::min, f32::max].map(|end| values.into_iter().fold(values[0], end));
    // A step of more than a few wires is no surface.
    if (high - low).is_nan() || high - low >= 4.0 {
        return;
    }
    for level in low.ceil() as i32..=high.floor() as i32 {
        let mut found: Vec<(u64, LinePoint)> = Vec::with_capacity(4);
        for (a, b, key) in sides(x, y, plane.width()) {
            let off = |(x, y): (usize, usize)| plane.at(x, y) / spacing - level as f32;
            if let Some(t) = zero(off(a), off(b)) {
                let at = place(a).lerp(place(b), t);
                // Levels that share the side of a cell are told apart.
                let key = key.wrapping_add((level as u32 as u64) << 40);
                found.push((key, LinePoint { at, strength: 1.0 }));
            }
        }
        let apart = |a: (u64, LinePoint), b: (u64, LinePoint)| a.1.at.distance(b.1.at);
        let pairs = pair_crossings(&found, apart).into_iter();
        out.extend(pairs.map(|[a, b]| LineStep { keys: [a.0, b.0], points: [a.1, b.1] }));
    }
}
