//! What was done last, for the report of a crash: words alone, nothing of the picture, and no names.
//! Floor 6.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

/// So many are remembered.
const MOST: usize = 40;

static WORDS: Mutex<VecDeque<[&str; 2]>> = Mutex::new(VecDeque::new());

/// Remembers an action by the words of its room and its own. One that is repeated, such as a pen's
/// drag, counts once.
pub(super) fn note(words: [&'static str; 2]) {
    let mut all = WORDS.lock().unwrap_or_else(PoisonError::into_inner);
    if all.back() == Some(&words) {
        return;
    }
    if all.len() == MOST {
        all.pop_front();
    }
    all.push_back(words);
}

/// The words of the last actions of this process, the latest last: `layer: move`.
pub fn last_actions() -> Vec<String> {
    let all = WORDS.lock().unwrap_or_else(PoisonError::into_inner);
    all.iter().map(|[room, word]| format!("{room}: {word}")).collect()
}
