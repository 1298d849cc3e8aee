//! Curves of smooth forms: suggestive contours, apparent ridges and valleys, the edge of light, and
//! wires. Each is where a map is zero, traced through the cells between four pixels that are linked.
//! Floor 2. Not here: what is left of them (`tidy`).

use super::chains::{Chain, LineStep, join_steps, pair_crossings, place, sides, zero};
use super::smooth::{SmoothNormals, diffuse_copy, gradient_of, gradient_row};
use super::tidy::RawLine;
use super::turns::Turns;
use super::{LineKind, LinePoint, LineSettings};
use crate::math::{Vec2, Vec3, fast, parallel, vec2, vec3};
use crate::raster::Plane;
use crate::surface::shadow::ShadowLamp;
use crate::surface::unwrap::Unwrapping;
use crate::surface::{Surface, links};

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
        let [nx, ny, _] = &self.normals.planes;
        let way = |x: usize, y: usize| {
            let g = vec2(nx.at(x, y), ny.at(x, y));
            g / g.length().max(1e-6)
        };
        let slope = self.slopes_toward_viewer();
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
        trace_lines(
            LineKind::Suggestive,
            self.surface.links_plane(),
            sign_changes(&slope),
            crossing,
        )
    }

    /// ∂(n̄·v)/∂ĝ.
    fn slopes_toward_viewer(&self) -> Plane<f32> {
        let ([nx, ny, nz], links) = (&self.normals.planes, self.surface.links_plane());
        let mut slopes = Plane::full(nz.size(), 0.0f32);
        let width = nz.width().max(1);
        let rows = slopes.values_mut().chunks_mut(width).enumerate();
        parallel::for_each_with(
            rows,
            1,
            || [vec![0.0f32; width], vec![0.0f32; width]],
            |[across, down], (y, out)| {
                gradient_row(nz, links, y, across, down);
                along_row(nx.row(y), ny.row(y), across, down, out);
            },
        );
        slopes
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
                let cells = turns.crest_cells(RIDGE.0 / sigma);
                lines.extend(trace_lines(kind, links, cells, found(hollow)));
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
        let lit = Plane::from_fn(self.surface.size(), |x, y| {
            self.normals.nbar(x, y).extend(self.normals.nz(x, y)).dot(toward) - self.settings.lit
        });
        let crossing = |a: (usize, usize), b: (usize, usize)| {
            Some((zero(lit.at(a.0, a.1), lit.at(b.0, b.1))?, 1.0))
        };
        trace_lines(LineKind::Light, self.surface.links_plane(), sign_changes(&lit), crossing)
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
        trace_lines(LineKind::Shadow, self.surface.links_plane(), sign_changes(&seen), crossing)
    }
}

/// Lines through the cells of linked pixels.
///
/// * `cells`: marks the cells of a row that a line may cross.
/// * `crossing`: where between two pixels a line of this kind is, and how clear it is.
pub(super) fn trace_lines(
    kind: LineKind,
    links: &Plane<u8>,
    cells: impl Fn(usize, &mut [u8]) + Sync,
    crossing: impl Fn((usize, usize), (usize, usize)) -> Option<(f32, f32)> + Sync,
) -> Vec<RawLine> {
    let width = links.width().saturating_sub(1);
    let steps_of_row = |marks: &mut Vec<u8>, y: usize| {
        cells(y, marks);
        let mut steps = Vec::new();
        for x in (0..width).filter(|&x| marks[x] != 0 && links::is_one_piece(links, x, y)) {
            let found = sides(x, y, links.width()).map(|(a, b, key)| {
                let (t, strength) = crossing(a, b)?;
                Some((key, LinePoint { at: place(a).lerp(place(b), t), strength }))
            });
            steps.extend(steps_between(found));
        }
        steps
    };
    let rows = 0..links.height().saturating_sub(1);
    let steps: Vec<Vec<LineStep>> = parallel::map_with(rows, || vec![0u8; width], steps_of_row);
    join_rows(kind, &steps)
}

/// The steps between the crossings of the sides of a cell, each with its key.
fn steps_between(found: [Option<(u64, LinePoint)>; 4]) -> impl Iterator<Item = LineStep> {
    let apart = |a: (u64, LinePoint), b: (u64, LinePoint)| a.1.at.distance(b.1.at);
    let pairs = pair_crossings(found, apart).into_iter().flatten();
    pairs.map(|[a, b]| LineStep { keys: [a.0, b.0], points: [a.1, b.1] })
}

/// The lines that the steps of all rows make.
fn join_rows(kind: LineKind, rows: &[Vec<LineStep>]) -> Vec<RawLine> {
    let chains = join_steps(&rows.concat()).into_iter();
    chains.map(|Chain { points, is_closed }| RawLine { kind, points, is_closed }).collect()
}

/// Marks the cells of a row that a line where a map is zero may cross.
fn sign_changes(plane: &Plane<f32>) -> impl Fn(usize, &mut [u8]) + Sync {
    |y, marks| mark_sign_changes(plane.row(y), plane.row(y + 1), marks)
}

crate::widest! {
    fn mark_sign_changes(top: &[f32], bottom: &[f32], marks: &mut [u8]) {
        let n = marks.len();
        let (top, bottom) = (&top[..=n], &bottom[..=n]);
        for x in 0..n {
            let [a, b] = [top[x] < 0.0, top[x + 1] < 0.0];
            let [c, d] = [bottom[x] < 0.0, bottom[x + 1] < 0.0];
            marks[x] = u8::from((a != b) | (c != d) | (a != c));
        }
    }

    /// The derivative along (x, y) of each pixel of a row.
    fn along_row(x: &[f32], y: &[f32], across: &[f32], down: &[f32], out: &mut [f32]) {
        let n = out.len();
        let (x, y, across, down) = (&x[..n], &y[..n], &across[..n], &down[..n]);
        for i in 0..n {
            let length = (x[i] * x[i] + y[i] * y[i]).sqrt();
            let per = 1.0 / fast::max(length, 1e-6);
            out[i] = across[i] * (x[i] * per) + down[i] * (y[i] * per);
        }
    }
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
        let rows: Vec<Vec<LineStep>> =
            parallel::collect(links.height().saturating_sub(1), 1, |y| {
                let mut steps = Vec::new();
                for x in (0..links.width() - 1).filter(|&x| links::is_one_piece(links, x, y)) {
                    wire_steps(plane, spacing, (x, y), &mut steps);
                }
                steps
            });
        lines.extend(join_rows(LineKind::Wire, &rows));
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
        let found = sides(x, y, plane.width()).map(|(a, b, key)| {
            let off = |(x, y): (usize, usize)| plane.at(x, y) / spacing - level as f32;
            let at = place(a).lerp(place(b), zero(off(a), off(b))?);
            // Levels that share the side of a cell are told apart.
            let key = key.wrapping_add((level as u32 as u64) << 40);
            Some((key, LinePoint { at, strength: 1.0 }))
        });
        out.extend(steps_between(found));
    }
}
