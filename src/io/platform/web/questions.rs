//! Questions to the page that a thread waits for: which file, what the clipboard holds. Floor 5.

use super::host;
use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, PoisonError};

/// What the page answers.
#[derive(Clone, Debug, Default)]
pub struct Answer {
    /// What it says; `None` if the user canceled, or the browser refused.
    pub text: Option<String>,
    /// Bytes with it.
    pub bytes: Vec<u8>,
}

#[derive(Default)]
struct Questions {
    last: u32,
    answers: BTreeMap<u32, Answer>,
}

static QUESTIONS: Mutex<Questions> = Mutex::new(Questions { last: 0, answers: BTreeMap::new() });
static ANSWERED: Condvar = Condvar::new();

/// Asks the page and waits for the answer. Never on the thread of the window: that receives it.
///
/// * `question`, `details`, `bytes`: what the page's script knows of, see `dist/web/page.js`.
pub fn ask(question: &str, details: &str, bytes: &[u8]) -> Answer {
    let number = {
        let mut questions = QUESTIONS.lock().unwrap_or_else(PoisonError::into_inner);
        questions.last += 1;
        questions.last
    };
    host::ask(number, question, details, bytes);
    let mut questions = QUESTIONS.lock().unwrap_or_else(PoisonError::into_inner);
    loop {
        if let Some(answer) = questions.answers.remove(&number) {
            return answer;
        }
        questions = ANSWERED.wait(questions).unwrap_or_else(PoisonError::into_inner);
    }
}

/// Tells the page something that it need not answer.
pub fn tell(what: &str, details: &str, bytes: &[u8]) {
    host::ask(0, what, details, bytes);
}

/// The page answered the question of this number.
pub fn answer(number: u32, answer: Answer) {
    let mut questions = QUESTIONS.lock().unwrap_or_else(PoisonError::into_inner);
    questions.answers.insert(number, answer);
    ANSWERED.notify_all();
}
