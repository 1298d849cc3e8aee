//! Where each piece of an unwrapped surface comes to lie in its plane: a solution leaves a shift a
//! piece. Floor 2.

use crate::math::Rect;
use crate::surface::Surface;
use rayon::prelude::*;

/// Pieces smaller than this many pixels are fragments of a ragged edge or a speckled mask: they lie as
/// their neighbors do.
const FRAGMENT_PX: usize = 64;
/// The number of a pixel that no coupling joins to any other.
const NONE: u32 = u32::MAX;

/// Shifts each piece so that it stays where it is in the picture in the mean; fragments lie as what is
/// around them.
///
/// * `moved`: δ = D − q over `rect`, x and y.
/// * `pieces`: the number of each pixel's piece, [`u32::MAX`] for none, and how many there are.
pub(super) fn shift_pieces(
    surface: &Surface,
    rect: Rect,
    moved: &mut [Vec<f32>; 2],
    pieces: (Vec<u32>, usize),
) {
    let (labels, count) = pieces;
    let mut areas = vec![0usize; count];
    labels.iter().filter(|label| **label != NONE).for_each(|&label| areas[label as usize] += 1);
    for v in &mut *moved {
        let mut sums = vec![0.0f64; count];
        v.iter()
            .zip(&labels)
            .filter(|(_, l)| **l != NONE)
            .for_each(|(v, &l)| sums[l as usize] += f64::from(*v));
        let means: Vec<f32> =
            sums.iter().zip(&areas).map(|(sum, n)| (sum / (*n).max(1) as f64) as f32).collect();
        v.par_iter_mut().zip(&labels).for_each(|(v, &label)| {
            *v = if label == NONE { 0.0 } else { *v - means[label as usize] };
        });
    }
    join_fragments(surface, rect, moved, &labels, &areas);
}

/// Gives fragments, and pixels of no piece, the mean shift of the larger pieces at their eight sides.
fn join_fragments(
    surface: &Surface,
    rect: Rect,
    moved: &mut [Vec<f32>; 2],
    labels: &[u32],
    areas: &[usize],
) {
    let (w, h) = (rect.width() as i32, rect.height() as i32);
    let area = |i: usize| areas.get(labels[i] as usize).copied().unwrap_or(1);
    let covered = |x: i32, y: i32| {
        surface.coverage_plane().get(rect.x0 + x, rect.y0 + y).is_some_and(|c| c > 0)
    };
    let place = |i: usize| (i as i32 % w, i as i32 / w);
    let is_fragment = |&i: &usize| area(i) < FRAGMENT_PX && covered(place(i).0, place(i).1);
    let fragments: Vec<usize> = (0..labels.len()).filter(is_fragment).collect();
    // By piece; a pixel of none is a piece of its own, after all others.
    let lone = fragments.iter().filter(|&&i| labels[i] == NONE).count();
    let mut shifts = vec![([0.0f32; 2], 0u32); areas.len() + lone];
    let mut next = areas.len()..;
    let slots: Vec<usize> =
        fragments
            .iter()
            .map(|&i| {
                if labels[i] == NONE { next.next().unwrap_or_default() } else { labels[i] as usize }
            })
            .collect();
    for (&i, &slot) in fragments.iter().zip(&slots) {
        let (x, y) = place(i);
        for (x, y) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy))) {
            if !(0..w).contains(&x) || !(0..h).contains(&y) || !covered(x, y) {
                continue;
            }
            let j = (y * w + x) as usize;
            if area(j) >= FRAGMENT_PX {
                let (sum, count) = &mut shifts[slot];
                (*count, *sum) = (*count + 1, [0, 1].map(|k| sum[k] + moved[k][j] - moved[k][i]));
            }
        }
    }
    for (&i, &slot) in fragments.iter().zip(&slots).filter(|(_, slot)| shifts[**slot].1 > 0) {
        let (sum, count) = shifts[slot];
        [0, 1].into_iter().for_each(|k| moved[k][i] += sum[k] / count as f32);
    }
}
