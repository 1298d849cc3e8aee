//! Combing: of the four branches of a cross at each pixel, the one that goes on from its neighbors,
//! the surest first, so that one family is one everywhere. Floor 2.

use crate::raster::Plane;
use crate::surface::{Surface, links};
use std::f32::consts::FRAC_PI_2;

/// How finely pixels are told apart by how sure they are: a queue for each.
const QUEUES: usize = 64;
/// From one queue to the next, factors of two.
const PER_QUEUE: f32 = 0.5;

/// The angle of the first family at each pixel.
///
/// * `angle`: of a branch of the cross, `(−π/4, π/4]`.
/// * `sure`: how directed the form is there.
/// * `most`: of the direction that the first family is to follow, as a whole, and its weight.
pub fn comb_cross(
    angle: &Plane<f32>,
    sure: &Plane<f32>,
    surface: &Surface,
    most: &Plane<[f32; 2]>,
) -> Plane<f32> {
    let mut out = angle.clone();
    let highest = sure.values().iter().copied().fold(0.0, f32::max).max(1e-12);
    let queue_of = |i: usize| {
        let octaves = (highest / sure.values()[i].max(1e-30)).log2() / PER_QUEUE;
        (octaves.max(0.0) as usize).min(QUEUES - 1)
    };
    let is_on = |i: usize| surface.coverage_plane().values()[i] > 0;
    let mut starts: Vec<u32> =
        (0..angle.size().area() as u32).filter(|&i| is_on(i as usize)).collect();
    starts.sort_by_key(|&i| queue_of(i as usize));
    let mut done = vec![false; angle.size().area()];
    let mut queues: Vec<Vec<u32>> = vec![Vec::new(); QUEUES];
    let mut piece = Vec::new();
    for start in starts {
        if done[start as usize] {
            continue;
        }
        piece.clear();
        done[start as usize] = true;
        queues[0].push(start);
        while let Some(i) = queues.iter_mut().find_map(Vec::pop) {
            piece.push(i);
            for j in neighbors(surface, i as usize) {
                if !done[j] {
                    done[j] = true;
                    let (here, there) = (out.values()[i as usize], angle.values()[j]);
                    let turns = ((here - there) / FRAC_PI_2).round();
                    out.values_mut()[j] = there + turns * FRAC_PI_2;
                    queues[queue_of(j)].push(j as u32);
                }
            }
        }
        turn_to_most(&piece, &mut out, most);
    }
    out
}

/// The pixels that are linked to one.
fn neighbors(surface: &Surface, i: usize) -> impl Iterator<Item = usize> {
    let width = surface.size().width as usize;
    let linked = surface.links_plane().values()[i];
    let all = [
        (links::LEFT, i.wrapping_sub(1)),
        (links::RIGHT, i + 1),
        (links::UP, i.wrapping_sub(width)),
        (links::DOWN, i + width),
    ];
    all.into_iter().filter(move |(bit, _)| linked & bit != 0).map(|(_, j)| j)
}

/// Exchanges the families of a piece if the second follows the wanted direction better.
fn turn_to_most(piece: &[u32], out: &mut Plane<f32>, most: &Plane<[f32; 2]>) {
    let vote = |&i: &u32| {
        let [angle, weight] = most.values()[i as usize];
        f64::from(weight * (2.0 * (out.values()[i as usize] - angle)).cos())
    };
    if piece.iter().map(vote).sum::<f64>() < 0.0 {
        piece.iter().for_each(|&i| out.values_mut()[i as usize] += FRAC_PI_2);
    }
}
