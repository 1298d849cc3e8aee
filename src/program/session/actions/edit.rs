//! Undo and redo.
//! Floor 6.

use crate::session::Session;
use crate::session::replay::actions;

actions! {
    /// Steps undone and redone.
    EditAction {
        "undo" Undo {}
        "redo" Redo {}
        /// Back (negative) or forward by steps.
        "walk" Walk { steps: i32 }
    }
}

impl EditAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        session.drop_gesture();
        let steps = match self {
            EditAction::Undo {} => -1,
            EditAction::Redo {} => 1,
            EditAction::Walk { steps } => *steps,
        };
        if let Some(open) = session.active_mut() {
            open.walk(steps);
        }
    }
}
