//! Heights of maps too large for a solver that holds every pixel: blocks of 2 × 2 are solved for, their pixels stand in them as
//! the normals tell and are relaxed, and what is left over is given to the blocks again. Of the pixels two planes are held.
//! Floor 2.

use super::filled_or_unwind;
use super::multigrid::{self, EXACT, NEARLY, SpringGrid};
use super::slopes::Slopes;
use rayon::prelude::*;

/// Times that what is left over is given to the blocks. The test beside the solver holds what they leave: a five-hundredth of the
/// depth's range on noise and holes.
const PASSES: usize = 12;
/// Damped Jacobi sweeps over the pixels each time.
const SWEEPS: usize = 4;
const DAMPING: f32 = 0.75;

/// The heights whose steps are nearest to those that the slopes tell.
pub fn solve(slopes: &Slopes) -> Vec<f32> {
    let (w, h) = (slopes.inside.width(), slopes.inside.height());
    let levels = multigrid::levels(blocks(slopes));
    let mut heights = Vec::new();
    for pass in 0..PASSES {
        let rest = left_over(slopes, &heights, &levels[0]);
        if rest.iter().all(|rest| *rest == 0.0) {
            break;
        }
        let raised = multigrid::solve(&levels, &rest, if pass == 0 { EXACT } else { NEARLY });
        drop(rest);
        let is_first = heights.is_empty();
        if is_first {
            heights = filled_or_unwind(w * h, 0.0);
        }
        heights.par_chunks_mut(w).enumerate().for_each(|(y, row)| {
            for (x, height) in row.iter_mut().enumerate() {
                let within = if is_first { within_block(slopes, x, y) } else { 0.0 };
                *height += raised[y / 2 * w.div_ceil(2) + x / 2] + within;
            }
        });
        drop(raised);
        relax(slopes, &mut heights);
    }
    if heights.is_empty() { filled_or_unwind(w * h, 0.0) } else { heights }
}

/// The springs between blocks: those that cross, halved because they are twice as long.
fn blocks(slopes: &Slopes) -> SpringGrid {
    let (w, h) = (slopes.inside.width(), slopes.inside.height());
    let (across, down) = (w.div_ceil(2), h.div_ceil(2));
    let weight = |x: usize, y: usize, axis: usize| if x < w && y < h { slopes.edge((x, y), axis).0 } else { 0.0 };
    let plane = |spring: &(dyn Fn(usize, usize) -> f32 + Sync)| {
        let mut out = filled_or_unwind(across * down, 0.0);
        out.par_chunks_mut(across).enumerate().for_each(|(y, row)| {
            row.iter_mut().enumerate().for_each(|(x, v)| *v = spring(2 * x, 2 * y));
        });
        out
    };
    let right = plane(&|x, y| 0.5 * (weight(x + 1, y, 0) + weight(x + 1, y + 1, 0)));
    let below = plane(&|x, y| 0.5 * (weight(x, y + 1, 1) + weight(x + 1, y + 1, 1)));
    SpringGrid::new(across, down, right, below)
}

/// What the equations of each block's pixels lack, added up.
fn left_over(slopes: &Slopes, heights: &[f32], blocks: &SpringGrid) -> Vec<f32> {
    let (w, h) = (slopes.inside.width(), slopes.inside.height());
    blocks.rows(|x, y| {
        let mut sum = 0.0;
        for (x, y) in [(2 * x, 2 * y), (2 * x + 1, 2 * y), (2 * x, 2 * y + 1), (2 * x + 1, 2 * y + 1)] {
            if x < w && y < h {
                sum += slopes.source(x, y);
                if !heights.is_empty() {
                    let (pull, stiff) = slopes.springs(heights, x, y);
                    sum -= stiff * heights[y * w + x] - pull;
                }
            }
        }
        sum
    })
}

/// How far a pixel stands above its block's middle, by the steps within the block.
fn within_block(slopes: &Slopes, x: usize, y: usize) -> f32 {
    let (left, top) = (x & !1, y & !1);
    let mean = |a: (f32, f32), b: (f32, f32)| match (a.0 > 0.0, b.0 > 0.0) {
        (true, true) => 0.5 * (a.1 + b.1),
        (true, false) => a.1,
        (false, true) => b.1,
        (false, false) => 0.0,
    };
    let has_below = top + 1 < slopes.inside.height();
    let has_right = left + 1 < slopes.inside.width();
    let lower = if has_below { slopes.edge((left, top + 1), 0) } else { (0.0, 0.0) };
    let further = if has_right { slopes.edge((left + 1, top), 1) } else { (0.0, 0.0) };
    let (dx, dy) = (mean(slopes.edge((left, top), 0), lower), mean(slopes.edge((left, top), 1), further));
    (x - left) as f32 * dx + (y - top) as f32 * dy - 0.5 * (dx + dy)
}

fn relax(slopes: &Slopes, heights: &mut Vec<f32>) {
    let w = slopes.inside.width();
    let mut next = filled_or_unwind(heights.len(), 0.0);
    for _ in 0..SWEEPS {
        next.par_chunks_mut(w).enumerate().for_each(|(y, row)| {
            for (x, v) in row.iter_mut().enumerate() {
                let height = heights[y * w + x];
                let (pull, stiff) = slopes.springs(heights, x, y);
                *v = if stiff > 0.0 { height + DAMPING * ((slopes.source(x, y) + pull) / stiff - height) } else { 0.0 };
            }
        });
        std::mem::swap(heights, &mut next);
    }
}
