//! What tools are told when the pen comes down.
//! Floor 5.

use super::snap::SnapTargets;
use super::{SelectSettings, Symmetry};
use crate::document::{Document, LayerId};
use crate::math::{Vec2, srgb::Color};
use crate::paint::{Brush, Fill};
use crate::surface::Operator;

/// Everything a tool works with, as it is when the pen comes down.
pub struct ToolContext<'a> {
    pub document: &'a Document,
    /// The selected layer.
    pub layer: Option<LayerId>,
    /// All chosen layers, those in a chosen group left out, bottom first; what marks nothing works on all of them.
    pub layers: &'a [LayerId],
    pub brush: &'a Brush,
    /// The foreground and the background colour.
    pub color: Color,
    pub second_color: Color,
    /// How new marks follow the surface.
    pub operator: Operator,
    /// Canvas px per screen point, for hit tests.
    pub px_per_pt: f32,
    /// Where the last stroke ended.
    pub last_end: Option<Vec2>,
    /// How strokes repeat.
    pub symmetry: Symmetry,
    /// The settings of the fill tool.
    pub fill: Fill,
    /// The settings of the selection tools.
    pub select: SelectSettings,
    /// The corners of the lasso that is being set.
    pub lasso: &'a [Vec2],
    /// The strokes of the selected layer that are chosen.
    pub strokes: &'a [usize],
    /// What the pen snaps to.
    pub snap: &'a SnapTargets,
    /// From a pixel to what a clone brush copies onto it, px; `None` before it was set.
    pub clone_offset: Option<Vec2>,
}

impl<'a> ToolContext<'a> {
    /// The initial context: no layer, black and white, no operator, one pixel per point.
    pub fn new(document: &'a Document, brush: &'a Brush) -> Self {
        Self {
            document,
            layer: None,
            layers: &[],
            brush,
            color: Color::BLACK,
            second_color: Color::WHITE,
            operator: Operator::None,
            px_per_pt: 1.0,
            last_end: None,
            symmetry: Symmetry::None,
            fill: Fill::default(),
            select: SelectSettings::default(),
            lasso: &[],
            strokes: &[],
            snap: SnapTargets::none(),
            clone_offset: None,
        }
    }
    /// The chosen layers: where none are told, the selected one.
    pub fn chosen(&self) -> &[LayerId] {
        if self.layers.is_empty() { self.layer.as_slice() } else { self.layers }
    }
}
