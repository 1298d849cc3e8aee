//! Steps of lines through the cells between four pixels, and the chains that they make. Floor 2.
//! Not here: which values are zero along a line (`fields`, `turns`), or what it separates (`outlines`).

use super::LinePoint;
use crate::math::{Vec2, vec2};
use std::collections::HashMap;

/// A step of a line: from a place to the next. Steps that share the key of a place are joined
/// there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineStep {
    /// What tells its ends from other places.
    pub keys: [u64; 2],
    /// Its ends.
    pub points: [LinePoint; 2],
}

/// Steps that were joined.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    pub points: Vec<LinePoint>,
    pub is_closed: bool,
}

/// At most two steps of a place; more of them all end there.
#[derive(Clone, Copy, Default)]
struct JoinPlace {
    steps: [u32; 2],
    count: u32,
}

/// Joins steps in the order in which they are given; a place where more than two meet ends all of
/// them.
pub fn join_steps(steps: &[LineStep]) -> Vec<Chain> {
    let mut places: HashMap<u64, JoinPlace> = HashMap::with_capacity(steps.len() + 1);
    for (i, step) in steps.iter().enumerate() {
        for key in step.keys {
            let place = places.entry(key).or_default();
            if let Some(slot) = place.steps.get_mut(place.count as usize) {
                *slot = i as u32;
            }
            place.count += 1;
        }
    }
    let mut chaining = Chaining { steps, places, used: vec![false; steps.len()] };
    let mut chains = Vec::new();
    // First those with ends, then loops.
    for only_ends in [true, false] {
        for i in 0..steps.len() {
            for end in 0..2 {
                let is_end = chaining.next_of(i, end).is_none();
                if !chaining.used[i] && (is_end || !only_ends) {
                    chains.push(chaining.from(i, end));
                }
            }
        }
    }
    chains
}

struct Chaining<'s> {
    steps: &'s [LineStep],
    places: HashMap<u64, JoinPlace>,
    used: Vec<bool>,
}

impl Chaining<'_> {
    /// The step that goes on at an end of a step, and its end there.
    fn next_of(&self, step: usize, end: usize) -> Option<(usize, usize)> {
        let key = self.steps[step].keys[end];
        let place = self.places.get(&key).filter(|place| place.count == 2)?;
        let next = place.steps.iter().find(|next| **next as usize != step)?;
        let next = *next as usize;
        Some((next, usize::from(self.steps[next].keys[0] != key)))
    }

    /// The chain that begins with an end of a step.
    fn from(&mut self, step: usize, end: usize) -> Chain {
        let mut points = vec![self.steps[step].points[end]];
        let (mut at, mut far) = (step, 1 - end);
        loop {
            self.used[at] = true;
            points.push(self.steps[at].points[far]);
            match self.next_of(at, far) {
                Some((next, near)) if !self.used[next] => (at, far) = (next, 1 - near),
                Some((next, _)) if next == step && points.len() > 3 => {
                    points.pop();
                    return Chain { points, is_closed: true };
                }
                _ => return Chain { points, is_closed: false },
            }
        }
    }
}

/// Pairs the crossings of a cell's sides so that lines do not cross in it: sides in order around
/// the cell.
///
/// Of four, the shorter pairs; of three or one, none.
pub fn pair_crossings<T: Copy>(
    crossings: [Option<T>; 4],
    apart: impl Fn(T, T) -> f32,
) -> [Option<[T; 2]>; 2] {
    if let [Some(a), Some(b), Some(c), Some(d)] = crossings {
        return match apart(a, b) + apart(c, d) <= apart(b, c) + apart(d, a) {
            true => [Some([a, b]), Some([c, d])],
            false => [Some([b, c]), Some([d, a])],
        };
    }
    let mut found = crossings.into_iter().flatten();
    match [found.next(), found.next(), found.next()] {
        [Some(a), Some(b), None] => [Some([a, b]), None],
        _ => [None; 2],
    }
}

/// A side of a cell: from which pixel to which, and the key of the place between them.
pub type CellSide = ((usize, usize), (usize, usize), u64);

/// The sides of the cell whose upper left pixel is (x, y), in order around it.
pub fn sides(x: usize, y: usize, width: usize) -> [CellSide; 4] {
    let across = |x: usize, y: usize| ((x, y), (x + 1, y), 2 * (y * width + x) as u64);
    let down = |x: usize, y: usize| ((x, y), (x, y + 1), 2 * (y * width + x) as u64 + 1);
    [across(x, y), down(x + 1, y), across(x, y + 1), down(x, y)]
}

/// The middle of a pixel.
pub fn place((x, y): (usize, usize)) -> Vec2 {
    vec2(x as f32 + 0.5, y as f32 + 0.5)
}

/// Where a value from `a` to `b` is zero, `[0, 1]`; `None` if both have one sign.
#[inline(always)]
pub fn zero(a: f32, b: f32) -> Option<f32> {
    ((a < 0.0) != (b < 0.0)).then(|| (a / (a - b)).max(0.0).min(1.0))
}
