//! What tools return: a gesture between the pen coming down and lifting, and the outcome of each of
//! its events. Floor 5.

use super::ToolSettings;
use super::pen::PenSample;
use super::snap::SnapLines;
use crate::document::{Document, LayerId};
use crate::math::{Vec2, srgb::Color};
use std::borrow::Cow;

/// What a tool returns for an event of the pen.
pub enum Outcome {
    /// Nothing changes.
    Idle,
    /// A preview until the next outcome.
    Preview(Document),
    /// A finished step with this name.
    Commit {
        /// What the history calls it.
        label: String,
        /// The document after it.
        document: Document,
        /// The layer to select from now on.
        select: Option<LayerId>,
    },
    /// Settings of the tools change; then the other outcome.
    Settings(SettingsChange, Box<Outcome>),
    /// Something of the document is selected from now on.
    Choose(DocumentChoice),
    /// Nothing was started; the reason is to be shown.
    Refused(Cow<'static, str>),
    /// The preview is to be dropped.
    Cancel,
}

/// A change of settings that a tool makes: the pen dragged a tolerance, or picked a color.
pub type SettingsChange = Box<dyn FnOnce(&mut ToolSettings) + Send>;

/// What is selected in a document besides its layers.
#[derive(Clone, Debug, PartialEq)]
pub enum DocumentChoice {
    /// A layer.
    Layer(LayerId),
    /// Strokes of the selected layer.
    Strokes(Vec<usize>),
    /// A part of the shape, by its id.
    Part(String),
    /// The point that the gizmo of the selected layers is turned about, by shares of its sides.
    Pivot(Vec2),
    /// Where clone brushes copy from, canvas px.
    CloneSource(Vec2),
}

impl Outcome {
    /// Settings change, and nothing else.
    pub fn set(change: impl FnOnce(&mut ToolSettings) + Send + 'static) -> Self {
        Outcome::Idle.with_settings(change)
    }

    /// The same after a change of settings.
    pub fn with_settings(self, change: impl FnOnce(&mut ToolSettings) + Send + 'static) -> Self {
        Outcome::Settings(Box::new(change), Box::new(self))
    }

    /// Changes the settings that it changes; what remains of it.
    pub fn apply_settings(self, tools: &mut ToolSettings) -> Self {
        match self {
            Outcome::Settings(change, then) => {
                change(tools);
                then.apply_settings(tools)
            }
            other => other,
        }
    }

    /// The first settings with what it changes.
    #[cfg(test)]
    pub fn settings(self) -> ToolSettings {
        let mut tools = ToolSettings::default();
        self.apply_settings(&mut tools);
        tools
    }
}

/// A tool between the pen coming down and lifting. It holds a clone of the document it began with,
/// which is cheap.
pub trait Gesture: Send {
    /// The pen's samples since the last call, in order.
    fn drag(&mut self, pens: &[PenSample]) -> Outcome;
    /// The pen lifts.
    fn release(&mut self) -> Outcome;
    /// The lines that it snapped to, to be shown.
    fn snap_lines(&self) -> SnapLines {
        SnapLines::default()
    }

    /// The last point that it was drawn to, if that is not at the pen.
    fn end(&self) -> Option<Vec2> {
        None
    }

    /// The color that it takes when the pen lifts.
    fn picked_color(&self) -> Option<Color> {
        None
    }

    /// Whether it moves a guide, which is removed if it is dropped on a ruler.
    fn is_guide(&self) -> bool {
        false
    }
}

/// The start of a gesture, and its first outcome.
pub type GestureStart = (Option<Box<dyn Gesture>>, Outcome);
