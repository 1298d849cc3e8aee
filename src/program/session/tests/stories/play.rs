//! Plays stories: draws what a user does next, performs it, and asks after each step and at the end
//! whether every promise was kept (`promises`).

use super::dice::{Dice, Roll};
use super::facts::{Facts, StoryFiles};
use super::gestures;
use super::promises::{self, Broken};
use super::starts::{self, StoryFolder};
use crate::document::{Progress, flatten, flatten_to_paint};
use crate::session::actions::Action;
use crate::session::replay::ReplayValue;
use crate::session::{Autosave, Session};
use crate::tools::ToolKind;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;

/// How a story went: what was done, without what failed in words, and the promise that was broken.
pub struct PlayedStory {
    pub actions: Vec<Action>,
    pub broken: Option<Broken>,
}

/// What is asked at the end besides what is always asked: each story asks a third of it.
#[derive(Clone, Copy)]
struct Asks {
    /// One thread and two.
    threads: bool,
    /// A crash.
    recovery: bool,
    /// Photoshop files, pictures of 16 bits, and the same story with a picture after each step.
    formats: bool,
}

impl Asks {
    const ALL: Self = Self { threads: true, recovery: true, formats: true };
    fn of(seed: u64) -> Self {
        let turn = seed % 3;
        Self { threads: turn == 0, recovery: turn == 1, formats: turn == 2 }
    }
}

/// Plays the story of a seed.
pub fn story(seed: u64, folder: &StoryFolder) -> PlayedStory {
    folder.begin();
    let mut dice = Dice::new(seed);
    let files = Arc::new(StoryFiles::new(folder.path()));
    dice.facts = Facts::of(&Session::default(), &files);
    let asks = Asks::of(seed);
    let mut play = Play::new(folder, asks);
    let mut next = starts::way_in(&mut dice);
    let steps = 4 + dice.below(24);
    for step in 0..=steps {
        for action in &next {
            if let Err(broken) = play.perform(action) {
                return PlayedStory { actions: play.actions, broken: Some(broken) };
            }
        }
        dice.facts = Facts::of(&play.session, &files);
        next = if step < steps { step_of(&mut dice) } else { Vec::new() };
    }
    let broken = play.end().err();
    PlayedStory { actions: play.actions, broken }
}

/// Plays these actions; the promise that they break.
pub fn replay(actions: &[Action], folder: &StoryFolder) -> Option<Broken> {
    folder.begin();
    let mut play = Play::new(folder, Asks::ALL);
    actions.iter().try_for_each(|action| play.perform(action)).and_then(|()| play.end()).err()
}

/// What the user does next: something with the pen, or any action.
fn step_of(dice: &mut Dice) -> Vec<Action> {
    match dice.is(42) {
        true => {
            let tool = dice.one_of(&ToolKind::ALL).0;
            gestures::gesture(dice, tool)
        }
        false => vec![Action::roll(dice)],
    }
}

/// A session that keeps logs, what was done in it, and what it was like.
struct Play {
    session: Session,
    asks: Asks,
    logs: PathBuf,
    actions: Vec<Action>,
    seen: Vec<promises::Seen>,
}

impl Play {
    fn new(folder: &StoryFolder, asks: Asks) -> Self {
        let logs = folder.path().join("logs");
        let autosave = asks.recovery.then(|| Autosave::new(logs.clone()));
        let session = Session { autosave, replaces_unasked: true, ..Session::default() };
        Self { session, asks, logs, actions: Vec::new(), seen: Vec::new() }
    }

    fn perform(&mut self, action: &Action) -> Result<(), Broken> {
        let written = action.to_value();
        // As a replay gives it; what cannot be read is refused there.
        let action = Action::read(&written)
            .map_err(|why| Broken::new("a line cannot be read", format!("{written}: {why}")))?;
        let before = self.session.active().map(|open| (open.key, open.document().clone()));
        let notes = self.session.notes.len();
        let done = catch_unwind(AssertUnwindSafe(|| action.apply(&mut self.session)));
        self.actions.push(action.clone());
        match done {
            Err(panic) => return Err(Broken::from_panic(&*panic)),
            Ok(Err(error)) => {
                self.actions.pop();
                return promises::nothing_changed(&self.session, before, &error.to_string());
            }
            Ok(Ok(())) => {}
        }
        self.session.keep();
        promises::after_step(&self.session, &action, before, &self.session.notes[notes..])?;
        if self.actions.len().is_multiple_of(7) {
            self.seen.extend(promises::Seen::now(&self.session)?);
        }
        Ok(())
    }

    fn end(&mut self) -> Result<(), Broken> {
        // Whoever shows the document keeps what is dragged.
        self.session.drop_gesture();
        let whole = catch_unwind(AssertUnwindSafe(|| {
            let now = promises::fingerprints(&self.session)?;
            promises::at_end(&mut self.session, &self.seen, self.asks.formats)?;
            promises::recover(&mut self.session, &self.logs)?;
            if self.asks.formats {
                same("exported between steps", &now, &again(&self.actions, export)?)?;
            }
            if self.asks.threads {
                let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
                let actions = &self.actions;
                let alone = alone.install(|| again(actions, |_| ()))?;
                same("one thread and two differ", &now, &alone)?;
            }
            Ok(())
        }));
        whole.unwrap_or_else(|panic| Err(Broken::from_panic(&*panic)))
    }
}

/// The documents that the same story makes once more.
///
/// * `between`: what is done after each step.
fn again(actions: &[Action], between: impl Fn(&Session)) -> Result<Fingerprints, Broken> {
    let mut session = Session { replaces_unasked: true, ..Session::default() };
    for action in actions {
        drop(action.apply(&mut session));
        between(&session);
    }
    session.drop_gesture();
    promises::fingerprints(&session)
}

/// What each open document is.
type Fingerprints = Vec<(String, u32)>;

/// A picture of the document in front, of 8 or of 16 bits.
fn export(session: &Session) {
    let Some(open) = session.active() else { return };
    let (document, progress) = (open.document(), Progress::default());
    if open.history.past_names().count().is_multiple_of(2) {
        drop(flatten_to_paint(document, &progress));
    } else {
        drop(flatten(document, &progress));
    }
}

/// A story gave the same documents twice.
fn same(kind: &str, now: &[(String, u32)], again: &[(String, u32)]) -> Result<(), Broken> {
    match now.iter().zip(again).find(|(a, b)| a != b) {
        _ if now.len() != again.len() => Err(Broken::new(kind, "other documents".into())),
        Some((a, b)) if a.0 == b.0 => {
            Err(Broken::new(&format!("{kind} in the picture"), String::new()))
        }
        Some((a, b)) => {
            let at = a.0.bytes().zip(b.0.bytes()).position(|(a, b)| a != b).unwrap_or_default();
            let about =
                |text: &str| text.chars().skip(at.saturating_sub(60)).take(120).collect::<String>();
            Err(Broken::new(kind, format!("{} and {}", about(&a.0), about(&b.0))))
        }
        None => Ok(()),
    }
}
