//! What a tool works with, kept for gestures that begin later. Floor 5.

use super::purpose::BrushTarget;
use super::snap::SnapTargets;
use super::{ToolContext, ToolSettings};
use crate::document::{Document, LayerId};
use crate::math::Vec2;

/// A context that outlasts the press, for gestures that begin with a later sample. Only strokes do,
/// which have no gizmo.
pub struct KeptContext {
    document: Document,
    tools: ToolSettings,
    layer: Option<LayerId>,
    layers: Vec<LayerId>,
    strokes: Vec<usize>,
    part: Option<String>,
    target: BrushTarget,
    px_per_pt: f32,
    last_end: Option<Vec2>,
    snap: SnapTargets,
    clone_offset: Option<Vec2>,
}

impl KeptContext {
    pub fn of(context: &ToolContext) -> Self {
        Self {
            document: context.document.clone(),
            tools: context.tools.clone(),
            layer: context.layer,
            layers: context.layers.to_vec(),
            strokes: context.strokes.to_vec(),
            part: context.part.map(str::to_owned),
            target: context.target,
            px_per_pt: context.px_per_pt,
            last_end: context.last_end,
            snap: context.snap.clone(),
            clone_offset: context.clone_offset,
        }
    }

    /// Canvas px per screen point.
    pub fn px_per_pt(&self) -> f32 {
        self.px_per_pt
    }

    /// The context of the press.
    pub fn lend<T>(&self, to: impl FnOnce(&ToolContext) -> T) -> T {
        to(&ToolContext {
            layer: self.layer,
            layers: &self.layers,
            strokes: &self.strokes,
            part: self.part.as_deref(),
            target: self.target,
            px_per_pt: self.px_per_pt,
            last_end: self.last_end,
            snap: &self.snap,
            clone_offset: self.clone_offset,
            ..ToolContext::new(&self.document, &self.tools)
        })
    }
}
