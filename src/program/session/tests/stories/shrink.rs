//! Makes a story that fails as short as it can be: leaves out actions in halves, then one by one,
//! and thins strokes.

use super::play::replay;
use super::promises::Broken;
use super::starts::StoryFolder;
use crate::session::actions::{Action, PointerAction};

/// Runs that one story may take.
const MOST_RUNS: usize = 400;

/// The shortest story found that breaks its promise in the same way, and how it does.
pub fn shrink(actions: Vec<Action>, broken: Broken, folder: &StoryFolder) -> (Vec<Action>, Broken) {
    let (mut best, mut how, mut left) = (actions, broken, MOST_RUNS);
    let fails = |actions: &[Action], left: &mut usize| {
        *left = left.saturating_sub(1);
        replay(actions, folder)
    };
    let mut size = best.len().div_ceil(2);
    while size > 0 && left > 0 {
        let mut at = 0;
        while at < best.len() && left > 0 {
            let mut shorter = best.clone();
            shorter.drain(at..(at + size).min(best.len()));
            match fails(&shorter, &mut left).filter(|broken| broken.kind == how.kind) {
                Some(broken) => (best, how) = (shorter, broken),
                None => at += size,
            }
        }
        size = if size == 1 { 0 } else { size.div_ceil(2) };
    }
    for index in 0..best.len() {
        while let Some(thinner) = thin_out(&best, index).filter(|_| left > 0) {
            match fails(&thinner, &mut left).filter(|broken| broken.kind == how.kind) {
                Some(broken) => (best, how) = (thinner, broken),
                None => break,
            }
        }
    }
    (best, how)
}

/// With half of the samples of a drag; `None` if that is none.
fn thin_out(actions: &[Action], index: usize) -> Option<Vec<Action>> {
    let Action::Pointer(PointerAction::Drag { pens }) = &actions[index] else { return None };
    if pens.len() < 2 {
        return None;
    }
    let mut thinner = actions.to_vec();
    thinner[index] =
        Action::Pointer(PointerAction::Drag { pens: pens.iter().copied().step_by(2).collect() });
    Some(thinner)
}
