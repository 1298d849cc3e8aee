//! Depth from normals: the height field whose slopes best match the normals (a Poisson equation
//! over the mask), solved by conjugate gradients with a multigrid preconditioner. Floor 2. The
//! reverse is `differentiate`. Normals do not say how far apart two pieces of surface are across an
//! occluding contour; that stays unknown.

mod slopes;

use super::poisson::{Effort, GoOn, PoissonGrid, PoissonSolver};
use crate::math::Vec3;
use crate::memory::fill_or_unwind;
use crate::raster::Plane;
pub use slopes::Slopes;

/// Depth made from normals.
pub struct IntegratedDepth {
    /// 0 near … 1 far; NaN where there is no surface.
    pub depth: Plane<f32>,
    /// How many pixels deep the range 0 … 1 is.
    pub range_px: f32,
}

/// Integrates unit normals (camera space, y up) over the pixels where `inside` holds; `None` where
/// there are none.
///
/// Minimizes Σ w (z_j − z_i − s_ij)² over neighbors i, j: s_ij = (n̄_i + n̄_j)/(n_z,i + n_z,j) is
/// exact on circles, and w = ((n_z,i + n_z,j)/2)² gives more weight to what faces the viewer.
/// Separate pieces are each centered on the same depth.
pub fn depth_from_normals(normals: &Plane<Vec3>, inside: &Plane<bool>) -> Option<IntegratedDepth> {
    depth_from_normals_while(normals, inside, &|| true)
}

/// The same while `go_on` says so; `None` also once it says no.
pub fn depth_from_normals_while(
    normals: &Plane<Vec3>,
    inside: &Plane<bool>,
    go_on: GoOn,
) -> Option<IntegratedDepth> {
    let slopes = Slopes { normals, inside };
    let mut heights = heights(&solver(&slopes), &slopes, go_on);
    if !go_on() {
        return None;
    }
    center_pieces(&mut heights, inside);
    let held = || heights.iter().zip(inside.values()).filter(|(_, i)| **i).map(|(z, _)| *z);
    let (near, far) = held().fold(None, |r: Option<(f32, f32)>, z| {
        Some(r.map_or((z, z), |(a, b)| (a.min(z), b.max(z))))
    })?;
    let range_px = if far > near { far - near } else { 1.0 };
    let depth = Plane::from_values(normals.size(), heights)?;
    let depth =
        depth.updated(|x, y, z| if inside.at(x, y) { (z - near) / range_px } else { f32::NAN });
    Some(IntegratedDepth { depth, range_px })
}

fn solver(slopes: &Slopes) -> PoissonSolver {
    let size = slopes.inside.size();
    let right = Plane::from_fn(size, |x, y| slopes.edge((x, y), 0).0).into_values();
    let down = Plane::from_fn(size, |x, y| slopes.edge((x, y), 1).0).into_values();
    PoissonSolver::new(PoissonGrid::new(slopes.inside.width(), right, down))
}

fn heights(solver: &PoissonSolver, slopes: &Slopes, go_on: GoOn) -> Vec<f32> {
    let size = slopes.inside.size();
    let source = Plane::from_fn(size, |x, y| slopes.source(x, y));
    let mut heights = fill_or_unwind(size.area(), 0.0);
    solver.solve_while(source.values(), &mut heights, Effort::EXACT, go_on);
    heights
}

/// Gives every connected piece the mean 0: the equations leave a free constant per piece.
fn center_pieces(heights: &mut [f32], inside: &Plane<bool>) {
    let (w, n) = (inside.width(), heights.len());
    let mut seen: Vec<bool> = inside.values().iter().map(|i| !i).collect();
    // Room for the largest piece there can be, so that it does not grow in steps; 32 bits count the
    // pixels of any map.
    let mut piece: Vec<u32> = Vec::with_capacity(seen.iter().filter(|seen| !**seen).count());
    for start in 0..n {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        piece.clear();
        piece.push(start as u32);
        let mut next = 0;
        while next < piece.len() {
            let i = piece[next] as usize;
            next += 1;
            let x = i % w;
            let near = [
                (x > 0, i.wrapping_sub(1)),
                (x + 1 < w, i + 1),
                (i >= w, i.wrapping_sub(w)),
                (i + w < n, i + w),
            ];
            for (there, j) in near {
                if there && !seen[j] {
                    seen[j] = true;
                    piece.push(j as u32);
                }
            }
        }
        let mean =
            piece.iter().map(|&i| f64::from(heights[i as usize])).sum::<f64>() / piece.len() as f64;
        piece.iter().for_each(|&i| heights[i as usize] -= mean as f32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec3};

    #[test]
    fn nothing_is_made_of_what_is_given_up() {
        let size = Size::new(64, 48);
        let normals =
            Plane::from_fn(size, |x, y| vec3(x as f32 - 31.5, 23.5 - y as f32, 40.0).normalize());
        let asked = std::cell::Cell::new(0);
        let go_on = || asked.replace(asked.get() + 1) < 2;
        assert!(depth_from_normals_while(&normals, &Plane::full(size, true), &go_on).is_none());
        assert_eq!(
            asked.get(),
            4,
            "it ends at the first no, and asks once more whether it was told to"
        );
    }

    #[test]
    fn a_sphere_gets_its_depth_back() {
        let (size, r) = (Size::new(201, 181), 80.0f32);
        let truth = |x: usize, y: usize| {
            let (dx, dy) = (x as f32 - 100.0, 90.0 - y as f32);
            let rest = r * r - dx * dx - dy * dy;
            (rest > 0.0).then(|| vec3(dx, dy, rest.sqrt()) / r)
        };
        let normals = Plane::from_fn(size, |x, y| truth(x, y).unwrap_or(Vec3::ZERO));
        let inside = Plane::from_fn(size, |x, y| truth(x, y).is_some());
        let found = depth_from_normals(&normals, &inside).unwrap();
        assert!((found.range_px - r).abs() < 0.06 * r, "{} px deep", found.range_px);
        for y in 0..181 {
            for x in 0..201 {
                if let Some(n) = truth(x, y).filter(|n| n.z > 0.2) {
                    let z = (1.0 - n.z) * r;
                    let error = (found.depth.at(x, y) * found.range_px - z).abs();
                    assert!(error < 0.03 * r, "{error} px off at {x}, {y}");
                }
            }
        }
    }

    #[test]
    fn flat_normals_and_holes_give_flat_finite_depth() {
        let size = Size::new(40, 30);
        let inside = Plane::from_fn(size, |x, y| (x / 7 + y / 5) % 2 == 0);
        let found = depth_from_normals(&Plane::full(size, Vec3::Z), &inside).unwrap();
        for (z, i) in found.depth.values().iter().zip(inside.values()) {
            assert_eq!(z.is_nan(), !i);
            assert!(!i || z.abs() < 1e-5);
        }
        assert!(
            depth_from_normals(&Plane::full(size, Vec3::Z), &Plane::full(size, false)).is_none()
        );
    }
}
