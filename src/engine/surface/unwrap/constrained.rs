//! The displacement of a plane whose anchors no rigid motion can meet: soft constraints of the
//! equation that unwrapped it (MATH 8). Floor 2. Not here: its rigid part (`deformation::plane`), the
//! solver (`poisson`).

use super::{UnwrapSettings, couplings, covered_rect, place::nearest_covered, smooth};
use crate::math::{Rect, Vec2};
use crate::memory::fill_or_unwind;
use crate::raster::Plane;
use crate::surface::cache::HeapSize;
use crate::surface::poisson::{Effort, PoissonSolver, SolveScratch};
use crate::surface::{Surface, links};
use std::sync::Arc;

/// One anchor that constrains a place of a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneConstraint {
    /// Canvas px; off the surface the nearest pixel of it is constrained.
    pub at: Vec2,
    /// How far that place is to move in the plane, px.
    pub displacement: Vec2,
}

/// How far each pixel of a surface moves in its plane, px; 0 off it.
pub struct PlaneDisplacement {
    planes: [Plane<f32>; 2],
}

impl HeapSize for PlaneDisplacement {
    fn heap_bytes(&self) -> u64 {
        self.planes.iter().map(Plane::heap_bytes).sum()
    }
}

impl HeapSize for PlaneSolver {
    fn heap_bytes(&self) -> u64 {
        self.solver.bytes()
    }
}

/// The couplings of an unwrapped surface, kept for the next solve.
pub struct PlaneSolver {
    rect: Rect,
    solver: PoissonSolver,
}

/// An anchor holds a disc of this share of the canvas's longer side, of at least [`LEAST_DISC_PX`],
/// but never more than half of the way to the next one.
const DISC: f32 = 1.0 / 64.0;
const LEAST_DISC_PX: f32 = 3.0;
/// κ of MATH 8: how stiffly the middle of a disc is held, against the couplings of the surface.
const HOLD: f32 = 16.0;
/// How far the solve goes, relative to the pull of the constraints: of that of the couplings a hundredth is left.
const EFFORT: Effort = Effort { goal: 1e-3, most_steps: 30 };

impl PlaneDisplacement {
    /// How far the plane is displaced at a pixel.
    #[inline(always)]
    pub fn at(&self, x: usize, y: usize) -> Vec2 {
        Vec2::new(self.planes[0].at(x, y), self.planes[1].at(x, y))
    }

    /// Both components, one a pixel.
    pub fn planes(&self) -> [&Plane<f32>; 2] {
        self.planes.each_ref()
    }

    fn solve(surface: &Surface, solver: &PlaneSolver, constraints: &[PlaneConstraint]) -> Self {
        let (size, PlaneSolver { rect, solver }) = (surface.size(), solver);
        let (w, n) = (rect.width(), rect.width() * rect.height());
        let discs = discs(surface, *rect, constraints);
        let pixels = list_pulled_pixels(&discs);
        let held = solver.constraints(pixels.iter().map(|held| (held.0, held.1)).collect());
        let mut scratch = SolveScratch::default();
        let planes = [0, 1].map(|axis| {
            let mut pull = fill_or_unwind(n, 0.0f32);
            pixels.iter().for_each(|&(i, _, pulled)| pull[i as usize] = pulled[axis]);
            let mut moved = fill_or_unwind(n, 0.0f32);
            if pull.iter().any(|v| *v != 0.0) {
                solver.solve_constrained(&held, &pull, &mut moved, EFFORT, &mut scratch);
            }
            meet(&discs, axis, &mut moved);
            let mut plane = Plane::full(size, 0.0);
            for (y, moved) in (rect.y0 as usize..).zip(moved.chunks(w)) {
                let start = y * size.width as usize + rect.x0 as usize;
                plane.values_mut()[start..start + w].copy_from_slice(moved);
            }
            plane
        });
        Self { planes }
    }
}

/// What the anchors at one pixel constrain.
struct ConstrainedDisc {
    /// Indices of pixels, the middle first, with 1 there, falling to 0 at the rim.
    pixels: Vec<(u32, f32)>,
    /// The mean of what the anchors lack.
    displacement: Vec2,
    count: f32,
}

/// The discs that anchors constrain in a rectangle.
fn discs(surface: &Surface, rect: Rect, constraints: &[PlaneConstraint]) -> Vec<ConstrainedDisc> {
    let widest = (surface.size().longer_side() * DISC).max(LEAST_DISC_PX);
    let mut middles: Vec<((usize, usize), f32, Vec2)> = constraints
        .iter()
        .zip(distances(constraints))
        .map(|(constraint, nearest)| {
            (
                nearest_covered(surface, constraint.at),
                widest.min(0.5 * nearest).max(1.0),
                constraint.displacement,
            )
        })
        .collect();
    middles.sort_by_key(|middle| (middle.0.1, middle.0.0));
    let of_pixel = |middles: &[((usize, usize), f32, Vec2)]| {
        let radius = middles.iter().map(|middle| middle.1).fold(f32::INFINITY, f32::min);
        let count = middles.len() as f32;
        let displacement = middles.iter().map(|middle| middle.2).sum::<Vec2>() / count;
        ConstrainedDisc { pixels: disc(surface, rect, middles[0].0, radius), displacement, count }
    };
    middles
        .chunk_by(|a, b| a.0 == b.0)
        .map(of_pixel)
        .filter(|disc| !disc.pixels.is_empty())
        .collect()
}

/// The pixels around one, from pixel to pixel along links: not what lies behind a jump. What no
/// coupling joins to another has nothing that could follow it.
fn disc(surface: &Surface, rect: Rect, middle: (usize, usize), radius: f32) -> Vec<(u32, f32)> {
    let (mut seen, mut next, mut pixels) = (vec![middle], 0, Vec::new());
    while let Some(&(x, y)) = seen.get(next) {
        next += 1;
        let far =
            Vec2::new(x as f32 - middle.0 as f32, y as f32 - middle.1 as f32).length_squared();
        let (inside, linked) = (1.0 - far / (radius * radius), surface.links_plane().at(x, y));
        if inside <= 0.0 || linked == 0 || !rect.contains(x as i32, y as i32) {
            continue;
        }
        let i = (y as i32 - rect.y0) as u32 * rect.width() as u32 + (x as i32 - rect.x0) as u32;
        pixels.push((i, inside * inside));
        let beside = [
            (links::LEFT, (x.wrapping_sub(1), y)),
            (links::RIGHT, (x + 1, y)),
            (links::UP, (x, y.wrapping_sub(1))),
            (links::DOWN, (x, y + 1)),
        ];
        for (_, at) in beside.into_iter().filter(|(bit, _)| linked & bit != 0) {
            if !seen.contains(&at) {
                seen.push(at);
            }
        }
    }
    pixels
}

/// All held pixels in order: index, stiffness, and stiffness times how far it is to move.
fn list_pulled_pixels(discs: &[ConstrainedDisc]) -> Vec<(u32, f32, Vec2)> {
    let of_disc = |disc: &ConstrainedDisc| {
        let (displacement, constraint) = (disc.displacement, HOLD * disc.count);
        disc.pixels
            .iter()
            .map(move |&(i, share)| (i, constraint * share, displacement * (constraint * share)))
            .collect::<Vec<_>>()
    };
    let mut held: Vec<(u32, f32, Vec2)> = discs.iter().flat_map(of_disc).collect();
    held.sort_by_key(|held| held.0);
    held.dedup_by(|next, held| {
        let is_same = next.0 == held.0;
        if is_same {
            (held.1, held.2) = (held.1 + next.1, held.2 + next.2);
        }
        is_same
    });
    held
}

/// Brings the middles of discs the last bit to where they should be; discs do not reach each
/// other's.
fn meet(discs: &[ConstrainedDisc], axis: usize, moved: &mut [f32]) {
    for disc in discs {
        let displacement = disc.displacement[axis] - moved[disc.pixels[0].0 as usize];
        disc.pixels.iter().for_each(|&(i, share)| moved[i as usize] += share * displacement);
    }
}

/// From each place to the nearest other one, px; those at the same place do not count.
fn distances(constraints: &[PlaneConstraint]) -> Vec<f32> {
    let mut order: Vec<usize> = (0..constraints.len()).collect();
    order.sort_by(|&a, &b| constraints[a].at.x.total_cmp(&constraints[b].at.x));
    let mut nearest = vec![f32::INFINITY; constraints.len()];
    for (k, &i) in order.iter().enumerate() {
        let ahead = order[k + 1..].iter();
        let behind = order[..k].iter().rev();
        let mut look = |others: &mut dyn Iterator<Item = &usize>| {
            for &j in others {
                if (constraints[j].at.x - constraints[i].at.x).abs() >= nearest[i] {
                    break;
                }
                let distance = constraints[j].at.distance(constraints[i].at);
                if distance > 0.0 {
                    nearest[i] = nearest[i].min(distance);
                }
            }
        };
        look(&mut { ahead });
        look(&mut { behind });
    }
    nearest
}

/// By the settings and by every anchor's place and way.
pub(in crate::surface) type DisplacementKey = Vec<u32>;

impl Surface {
    /// The displacement of its unwrapped planes under constraints, cached; for a far side that of
    /// the surface in front, continued.
    ///
    /// * `constraints`: at least two of every piece that has any, finite.
    pub fn plane_displacement(
        &self,
        settings: UnwrapSettings,
        constraints: &[PlaneConstraint],
    ) -> Arc<PlaneDisplacement> {
        let settings = settings.clamp_to_ranges(self.size());
        let bits = |constraint: &PlaneConstraint| {
            [constraint.at.x, constraint.at.y, constraint.displacement.x, constraint.displacement.y]
                .map(f32::to_bits)
        };
        let key: DisplacementKey =
            settings.key().into_iter().chain(constraints.iter().flat_map(bits)).collect();
        let keep = self.kept_unwrappings().min(4);
        self.derived.plane_displacements.get_or_compute(key, keep, |_| {
            let solved = || {
                let solver = self.plane_solver(settings, self.find_pulled_rect(constraints));
                PlaneDisplacement::solve(self, &solver, constraints)
            };
            self.on_either_side(solved, |far, front| {
                let whole = front.map(|front| front.plane_displacement(settings, constraints));
                let planes = [0, 1].map(|axis| {
                    far.continue_map(self.size(), |x, y| {
                        whole.as_ref().map_or(0.0, |whole| whole.planes[axis].at(x, y))
                    })
                });
                PlaneDisplacement { planes }
            })
        })
    }

    /// Around all that constraints can move. Parts may be linked beyond what shows each of them.
    fn find_pulled_rect(&self, constraints: &[PlaneConstraint]) -> Rect {
        if self.parts_plane().is_some() {
            return covered_rect(self);
        }
        let objects = self.objects();
        let object = |constraint: &PlaneConstraint| {
            let (x, y) = nearest_covered(self, constraint.at);
            objects.at(x as i32, y as i32).map(|object| objects.rect(object))
        };
        constraints.iter().filter_map(object).fold(Rect::EMPTY, Rect::union)
    }

    /// The couplings of the unwrapping over a rectangle that holds all that is read from it, cached.
    fn plane_solver(&self, settings: UnwrapSettings, rect: Rect) -> Arc<PlaneSolver> {
        self.derived.plane_solver.get_or_compute((settings.key(), rect), 1, |_| {
            let normals = smooth::normals(self, rect, settings.smooth_px);
            PlaneSolver { rect, solver: PoissonSolver::new(couplings(self, rect, &normals)) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::of_height;
    use super::*;
    use crate::math::{Size, vec2};

    const SETTINGS: UnwrapSettings = UnwrapSettings { amount: 1.0, smooth_px: 0.0 };

    #[test]
    fn held_places_go_where_they_should_and_the_rest_follows_evenly() {
        let surface = of_height(Size::new(160, 100), |x, y| Some(0.3 * x + 0.1 * y));
        let still = PlaneConstraint { at: vec2(20.5, 50.5), displacement: Vec2::ZERO };
        let pulled = PlaneConstraint { at: vec2(140.5, 50.5), displacement: vec2(6.0, -3.0) };
        let displaced = surface.plane_displacement(SETTINGS, &[still, pulled]);
        assert!(
            displaced.at(140, 50).distance(pulled.displacement) < 1e-4,
            "{}",
            displaced.at(140, 50)
        );
        assert!(displaced.at(20, 50).length() < 1e-4, "{}", displaced.at(20, 50));
        let between = displaced.at(80, 50);
        assert!(
            between.distance(0.5 * pulled.displacement) < 0.35,
            "half way lies half of it: {between}"
        );
        let moved =
            (0..100).flat_map(|y| (0..160).map(move |x| (x, y))).map(|(x, y)| displaced.at(x, y).x);
        let (least, most) = moved.fold((f32::INFINITY, 0.0f32), |(a, b), v| (a.min(v), b.max(v)));
        assert!(
            least > -0.02 && most < 6.02,
            "nothing goes beyond either of them: {least} to {most}"
        );
    }

    #[test]
    fn what_no_anchor_holds_stays_and_what_lies_behind_a_jump_is_not_held() {
        let ball = |x: f32, y: f32| 20.0f32.powi(2) - (x - 60.0).powi(2) - (y - 50.0).powi(2);
        let size = Size::new(160, 100);
        let surface = of_height(size, |x, y| {
            Some(if ball(x, y) > 4.0 { 300.0 + ball(x, y).sqrt() } else { 0.5 * x })
        });
        let at = |x: f32, displacement: Vec2| PlaneConstraint { at: vec2(x, 50.5), displacement };
        let displaced = surface
            .plane_displacement(SETTINGS, &[at(50.5, vec2(-2.0, 0.0)), at(75.5, vec2(2.0, 0.0))]);
        assert!(
            (displaced.at(75, 50).x - 2.0).abs() < 1e-4
                && (displaced.at(50, 50).x + 2.0).abs() < 1e-4
        );
        assert!(
            (0..100)
                .all(|y| displaced.at(120, y) == Vec2::ZERO && displaced.at(82, y) == Vec2::ZERO),
            "the plate"
        );
    }

    #[test]
    fn anchors_at_one_place_that_disagree_share_it() {
        let surface = of_height(Size::new(64, 64), |x, _| Some(0.2 * x));
        let at = |x: f32, y: f32, displacement: f32| PlaneConstraint {
            at: vec2(x, y),
            displacement: vec2(displacement, 0.0),
        };
        let constraints = [at(30.5, 30.5, 4.0), at(30.5, 30.5, -2.0), at(5.5, 5.5, 0.0)];
        let found = surface.plane_displacement(SETTINGS, &constraints).at(30, 30);
        assert!((found.x - 1.0).abs() < 0.1, "{found}");
        let plain = PlaneConstraint { at: vec2(-500.0, 1e6), displacement: Vec2::ONE };
        assert!(surface.plane_displacement(SETTINGS, &[plain, plain]).at(0, 63).is_finite());
    }

    #[test]
    fn the_same_bytes_come_from_any_number_of_threads() {
        let displaced = |threads| {
            let surface = of_height(Size::new(150, 90), |x, y| {
                Some(8.0 * (0.1 * x).sin() * (0.13 * y).cos())
            });
            let at =
                |x: f32, displacement: Vec2| PlaneConstraint { at: vec2(x, 40.5), displacement };
            let constraints =
                [at(20.5, vec2(3.0, 1.0)), at(90.5, vec2(-1.0, 0.0)), at(130.5, vec2(0.0, 2.0))];
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let displaced = pool.install(|| surface.plane_displacement(SETTINGS, &constraints));
            displaced
                .planes()
                .map(|plane| plane.values().iter().map(|v| v.to_bits()).collect::<Vec<u32>>())
        };
        assert!(displaced(1) == displaced(2));
    }
}
