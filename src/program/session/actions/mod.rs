//! Everything that can be done, as values: the window creates them, a replay reads them, [`Action::apply`] performs
//! them. Floor 6. There is one small enum per area, with its `apply` in its own file.

pub mod canvas;
pub mod clipboard;
pub mod edit;
pub mod files;
pub mod guides;
pub mod hand;
pub mod layers;
pub mod parts;
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
pub use parts::{NewPart, PartAction};
pub use pointer::PointerAction;
pub use selection::{EdgeChange, SelectionAction};
pub use strokes::{StrokeAction, Style};
pub use views::ViewAction;

use super::Session;
use super::replay::ReplayValue;
use crate::Result;
use serde_json::Value;

/// One action.
#[derive(Clone)]
pub enum Action {
    Canvas(CanvasAction),
    Clipboard(ClipboardAction),
    Edit(EditAction),
    File(FileAction),
    Guide(GuideAction),
    Hand(HandAction),
    Layer(LayerAction),
    Part(PartAction),
    Pointer(PointerAction),
    Selection(SelectionAction),
    Stroke(StrokeAction),
    View(ViewAction),
}

impl Action {
    /// Performs it. What cannot be done changes nothing; only files fail. An edit that no file could hold is refused in
    /// a note.
    pub fn apply(&self, session: &mut Session) -> Result<()> {
        session.settle();
        let mut done = Ok(());
        match self {
            Action::Canvas(action) => action.apply(session),
            Action::Clipboard(action) => action.apply(session),
            Action::Edit(action) => action.apply(session),
            Action::File(action) => done = action.apply(session),
            Action::Guide(action) => action.apply(session),
            Action::Hand(action) => action.apply(session),
            Action::Layer(action) => action.apply(session),
            Action::Part(action) => action.apply(session),
            Action::Pointer(action) => action.apply(session),
            Action::Selection(action) => action.apply(session),
            Action::Stroke(action) => action.apply(session),
            Action::View(action) => action.apply(session),
        }
        session.tell_refusals();
        done
    }
}

impl ReplayValue for Action {
    fn written(&self) -> Value {
        let (room, mut value) = match self {
            Action::Canvas(action) => ("canvas", action.written()),
            Action::Clipboard(action) => ("clipboard", action.written()),
            Action::Edit(action) => ("edit", action.written()),
            Action::File(action) => ("file", action.written()),
            Action::Guide(action) => ("guide", action.written()),
            Action::Hand(action) => ("hand", action.written()),
            Action::Layer(action) => ("layer", action.written()),
            Action::Part(action) => ("part", action.written()),
            Action::Pointer(action) => ("pointer", action.written()),
            Action::Selection(action) => ("selection", action.written()),
            Action::Stroke(action) => ("stroke", action.written()),
            Action::View(action) => ("view", action.written()),
        };
        if let Some(object) = value.as_object_mut() {
            object.insert("in".into(), room.into());
        }
        value
    }
    fn read(value: &Value) -> std::result::Result<Self, String> {
        Ok(match value.get("in").and_then(Value::as_str) {
            Some("canvas") => Action::Canvas(ReplayValue::read(value)?),
            Some("clipboard") => Action::Clipboard(ReplayValue::read(value)?),
            Some("edit") => Action::Edit(ReplayValue::read(value)?),
            Some("file") => Action::File(ReplayValue::read(value)?),
            Some("guide") => Action::Guide(ReplayValue::read(value)?),
            Some("hand") => Action::Hand(ReplayValue::read(value)?),
            Some("layer") => Action::Layer(ReplayValue::read(value)?),
            Some("part") => Action::Part(ReplayValue::read(value)?),
            Some("pointer") => Action::Pointer(ReplayValue::read(value)?),
            Some("selection") => Action::Selection(ReplayValue::read(value)?),
            Some("stroke") => Action::Stroke(ReplayValue::read(value)?),
            Some("view") => Action::View(ReplayValue::read(value)?),
            _ => {
                let rooms =
                    "canvas, clipboard, edit, file, guide, hand, layer, part, pointer, selection, stroke or view";
                return Err(format!("“in” must be {rooms}"));
            }
        })
    }
}
