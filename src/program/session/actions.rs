//! Everything that can be done, as values: the window creates them, a replay reads them,
//! [`Action::apply`] performs them. Floor 6. There is one small enum per area, with its `apply` in
//! its own file.

pub mod canvas;
pub mod clipboard;
pub mod edit;
pub(in crate::session) mod file_names;
pub mod files;
pub mod guides;
pub mod hand;
pub mod layers;
pub mod palettes;
pub mod panels;
pub mod parts;
pub mod paths;
pub mod pictures;
pub mod placing;
pub mod pointer;
pub mod selection;
pub mod strokes;
pub mod unwrapped;
pub mod views;

pub use canvas::CanvasAction;
pub use clipboard::{ClipboardAction, PasteTo, PastedPicture};
pub use edit::EditAction;
pub use files::FileAction;
pub use guides::GuideAction;
pub use hand::HandAction;
pub use layers::{LayerAction, NewLayer};
pub use palettes::PaletteAction;
pub use panels::PanelAction;
pub use parts::{NewPart, PartAction};
pub use paths::PathAction;
pub use pointer::PointerAction;
pub use selection::{EdgeChange, SelectionAction};
pub use strokes::{StrokeAction, Style};
pub use views::ViewAction;

use super::replay::ReplayValue;
use super::{Session, last_actions};
use crate::Result;
use serde_json::Value;
use std::path::PathBuf;

/// One action for each of the enums, by the word that its room has in replays.
macro_rules! rooms {
    ($($word:literal $room:ident($action:ty)),+ $(,)?) => {
        /// One action.
        #[derive(Clone)]
        pub enum Action {
            $(
                #[doc = concat!("`", $word, "` in replays.")]
                $room($action)
            ),+
        }
        impl Action {
            /// The words of all rooms.
            pub const ROOMS: &'static [&'static str] = &[$($word),+];

            /// The word of its room, and its own there.
            pub fn words(&self) -> [&'static str; 2] {
                match self { $(Action::$room(action) => [$word, action.word()]),+ }
            }
        }

        impl ReplayValue for Action {
            fn to_value(&self) -> Value {
                let (room, mut value) = match self { $(Action::$room(action) => ($word, action.to_value())),+ };
                if let Some(object) = value.as_object_mut() {
                    object.insert("in".into(), room.into());
                }
                value
            }

            fn read(value: &Value) -> std::result::Result<Self, String> {
                Ok(match value.get("in").and_then(Value::as_str) {
                    $(Some($word) => Action::$room(ReplayValue::read(value)?),)+
                    _ => return Err(format!("“in” must be one of: {}", Self::ROOMS.join(", "))),
                })
            }
        }

        #[cfg(test)]
        impl super::tests::stories::Roll for Action {
            fn roll(dice: &mut super::tests::stories::Dice) -> Self {
                let all: &[fn(&mut super::tests::stories::Dice) -> Self] =
                    &[$(|dice| Action::$room(super::tests::stories::Roll::roll(dice))),+];
                all[dice.variant(Self::ROOMS, "Action")](dice)
            }
        }
    };
}

rooms! {
    "canvas" Canvas(CanvasAction),
    "clipboard" Clipboard(ClipboardAction),
    "edit" Edit(EditAction),
    "file" File(FileAction),
    "guide" Guide(GuideAction),
    "hand" Hand(HandAction),
    "layer" Layer(LayerAction),
    "palette" Palette(PaletteAction),
    "panel" Panel(PanelAction),
    "part" Part(PartAction),
    "path" Path(PathAction),
    "pointer" Pointer(PointerAction),
    "selection" Selection(SelectionAction),
    "stroke" Stroke(StrokeAction),
    "view" View(ViewAction),
}

impl Action {
    /// Whether it writes a file of the user's.
    pub fn has_output(&self) -> bool {
        match self {
            Action::File(action) => action.has_output(),
            Action::Palette(action) => matches!(action, PaletteAction::Export { .. }),
            _ => false,
        }
    }

    /// The files that it names.
    pub fn files_mut(&mut self) -> Vec<&mut PathBuf> {
        match self {
            Action::File(action) => action.files_mut(),
            Action::Part(PartAction::ShapePaths { file: Some(file), .. }) => vec![file],
            Action::Palette(
                PaletteAction::Import { file } | PaletteAction::Export { file, .. },
            ) => vec![file],
            _ => Vec::new(),
        }
    }

    /// Performs it. What cannot be done changes nothing; only files fail. An edit that no file
    /// could hold is refused in a note.
    pub fn apply(&self, session: &mut Session) -> Result<()> {
        last_actions::note(self.words());
        session.shows_saved &= matches!(self, Action::View(_));
        session.record_targets();
        let mut done = Ok(());
        match self {
            Action::Canvas(action) => action.apply(session),
            Action::Clipboard(action) => action.apply(session),
            Action::Edit(action) => action.apply(session),
            Action::File(action) => done = action.apply(session),
            Action::Guide(action) => action.apply(session),
            Action::Hand(action) => action.apply(session),
            Action::Layer(action) => action.apply(session),
            Action::Palette(action) => done = action.apply(session),
            Action::Panel(action) => action.apply(session),
            Action::Part(action) => action.apply(session),
            Action::Path(action) => action.apply(session),
            Action::Pointer(action) => action.apply(session),
            Action::Selection(action) => action.apply(session),
            Action::Stroke(action) => action.apply(session),
            Action::View(action) => action.apply(session),
        }
        session.follow_balls();
        session.tell_refusals();
        done
    }
}
