//! What tools return: a gesture between the pen coming down and lifting, and the outcome of each of
//! its events. Floor 5.

use super::pen::PenSample;
use super::settings::SelectSettings;
use super::snap::SnapLines;
use super::symmetry::SymmetryAxes;
use crate::document::{Document, LayerId};
use crate::math::{Rect, Vec2, Vec3, srgb::Color};
use std::borrow::Cow;

/// What a tool returns for an event of the pen.
pub enum Outcome {
    Idle,
    /// A preview until the next outcome.
    Preview(Document),
    /// A finished step with this name.
    Commit {
        label: String,
        document: Document,
        /// The layer to select from now on.
        select: Option<LayerId>,
    },
    /// A selection made with settings that the pen changed: a preview, or a finished step.
    Tuned {
        document: Document,
        select: SelectSettings,
        is_done: bool,
    },
    /// The corners of an unfinished lasso.
    Lasso(Vec<Vec2>),
    /// These strokes of the selected layer are chosen from now on.
    Chosen(Vec<usize>),
    /// This part of the shape is chosen from now on.
    ChosenPart(String),
    /// Touches give this direction from now on.
    Direction(Vec3),
    /// The area that the crop tool cuts out, from now on.
    CropArea(Rect),
    /// Clone brushes copy from here from now on.
    CloneFrom(Vec2),
    /// Nothing was started; the reason is to be shown.
    Refused(Cow<'static, str>),
    /// The gizmo of the chosen layers is turned about this point, by shares of its sides, from now
    /// on.
    Pivot(Vec2),
    /// These points of the layer's mesh are chosen from now on.
    MeshPoints(Vec<usize>),
    /// The axes of symmetry are here from now on.
    Axes(SymmetryAxes),
    /// A colour was picked.
    Picked(Color),
    /// The preview is to be dropped.
    Cancel,
}

/// A tool between the pen coming down and lifting. It holds a clone of the document it began with,
/// which is cheap.
pub trait Gesture: Send {
    /// The pen's samples since the last call, in order.
    fn drag(&mut self, pens: &[PenSample]) -> Outcome;
    fn release(&mut self) -> Outcome;
    /// The lines that it snapped to, to be shown.
    fn snap_lines(&self) -> SnapLines {
        SnapLines::default()
    }

    /// The last point that it was drawn to, if that is not at the pen.
    fn end(&self) -> Option<Vec2> {
        None
    }

    /// Whether it moves a guide, which is removed if it is dropped on a ruler.
    fn is_guide(&self) -> bool {
        false
    }
}

/// The start of a gesture, and its first outcome.
pub type GestureStart = (Option<Box<dyn Gesture>>, Outcome);
