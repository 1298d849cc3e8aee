//! Directions along drawn strokes: each piece of the surface that one touches follows its strokes,
//! evenly between them. Floor 2. Not here: which layer holds the strokes (`document::form_sources`).

use super::stretch::root;
use crate::math::{Vec2, vec2};
use crate::raster::Plane;
use crate::surface::form_lines::SmoothNormals;
use crate::surface::poisson::{Effort, PoissonGrid, PoissonSolver, SolveScratch};
use crate::surface::{Surface, links};
use std::sync::Arc;

/// How strongly a stroke holds the directions of the pixels beneath it, of a coupling between two.
const HOLD: f32 = 20.0;
/// How exact directions between strokes are.
const EFFORT: Effort = Effort { goal: 1e-3, most_steps: 40 };
/// Values below this are those of pieces without a stroke.
const NONE_BELOW: f32 = 1e-12;

/// Strokes that lines follow: the points of each, canvas px.
#[derive(Clone, Debug, Default)]
pub struct GuideLines(Arc<[Vec<Vec2>]>);

impl PartialEq for GuideLines {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl GuideLines {
    /// Those of some strokes.
    pub fn of(lines: impl Iterator<Item = Vec<Vec2>>) -> Self {
        Self(lines.collect())
    }

    /// None.
    pub fn none() -> Self {
        Self::default()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The same on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        Self::of(self.0.iter().map(|line| line.iter().map(|at| *at * factor).collect()))
    }

    /// Calls `visit` with the places and directions along the strokes, a pixel apart or less.
    pub(crate) fn walk(&self, mut visit: impl FnMut(Vec2, Vec2)) {
        for pair in self.0.iter().flat_map(|line| line.windows(2)) {
            let (from, along) = (pair[0], pair[1] - pair[0]);
            let length = along.length();
            if !length.is_finite() || length < 1e-3 {
                continue;
            }
            let steps = (length.ceil() as usize).min(1 << 14);
            (0..steps).for_each(|i| visit(from + along * (i as f32 / steps as f32), along));
        }
    }
}

/// e^{2iθ} along strokes, harmonic over each piece that one touches; of the form on the others.
///
/// * `turned`: the angle from the strokes to the lines.
/// * `form`: e^{2iθ} of the form.
pub(super) fn guide_directions(
    surface: &Surface,
    normals: &SmoothNormals,
    guides: &GuideLines,
    turned: f32,
    form: [Plane<f32>; 2],
) -> [Plane<f32>; 2] {
    let held = held_pixels(surface, normals, guides, turned);
    if held.is_empty() {
        return form;
    }
    let solver = PoissonSolver::new(couplings(surface));
    let constraints = solver.constraints(held.iter().map(|pixel| (pixel.0, HOLD)).collect());
    let spread = |of: fn(Vec2) -> f32| {
        let mut pull = vec![0.0; surface.size().area()];
        held.iter().for_each(|(i, doubled)| pull[*i as usize] = HOLD * of(*doubled));
        let mut values = vec![0.0; pull.len()];
        let mut scratch = SolveScratch::default();
        solver.solve_constrained(&constraints, &pull, &mut values, EFFORT, &mut scratch);
        // Pixels without a neighbor have no unknown.
        held.iter().for_each(|(i, doubled)| {
            let value = &mut values[*i as usize];
            *value = if *value == 0.0 { of(*doubled) } else { *value };
        });
        values
    };
    let [c, s] = [spread(|doubled| doubled.x), spread(|doubled| doubled.y)];
    let width = surface.size().width as usize;
    let [of_c, of_s] = form;
    let of = |own: &[f32], form: &Plane<f32>| {
        Plane::from_fn(surface.size(), |x, y| {
            let i = y * width + x;
            let is_guided = c[i] * c[i] + s[i] * s[i] > NONE_BELOW;
            if is_guided { own[i] } else { form.at(x, y) }
        })
    };
    [of(&c, &of_c), of(&s, &of_s)]
}

/// The links of the surface as couplings.
fn couplings(surface: &Surface) -> PoissonGrid {
    let all = surface.links_plane();
    let of = |bit: u8| {
        all.values().iter().map(|linked| if linked & bit != 0 { 1.0 } else { 0.0 }).collect()
    };
    PoissonGrid::new(all.width(), of(links::RIGHT), of(links::DOWN))
}

/// The pixels beneath strokes by their index, ascending, with e^{2iθ} of their lines, unit.
fn held_pixels(
    surface: &Surface,
    normals: &SmoothNormals,
    guides: &GuideLines,
    turned: f32,
) -> Vec<(u32, Vec2)> {
    let size = surface.size();
    let mut all: Vec<(u32, Vec2)> = Vec::new();
    guides.walk(|at, along| {
        let (x, y) = (at.x.floor(), at.y.floor());
        let is_inside = x >= 0.0 && y >= 0.0 && x < size.width as f32 && y < size.height as f32;
        if !is_inside || surface.coverage(x as usize, y as usize) == 0 {
            return;
        }
        let (x, y) = (x as usize, y as usize);
        let way = root(normals, x, y) * along;
        let doubled = 2.0 * (way.y.atan2(way.x) + turned);
        all.push(((y * size.width as usize + x) as u32, vec2(doubled.cos(), doubled.sin())));
    });
    // The order of drawing stays within a pixel.
    all.sort_by_key(|(i, _)| *i);
    all.dedup_by(|next, first| {
        let is_same = next.0 == first.0;
        first.1 += if is_same { next.1 } else { Vec2::ZERO };
        is_same
    });
    all.iter_mut().for_each(|(_, doubled)| *doubled = doubled.normalize_or(Vec2::X));
    all
}
