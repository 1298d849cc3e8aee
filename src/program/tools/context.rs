//! What tools get when the pen comes down. Floor 5.

use super::gizmo::{GizmoMemory, TransformTarget};
use super::settings::{BrushTarget, CropAspect, SelectSettings, ShapeSettings};
use super::snap::{SnapTargets, ViewAids};
use super::symmetry::{Symmetry, SymmetryAxes};
use crate::document::{Document, LayerId};
use crate::math::{Rect, Vec2, srgb::Color};
use crate::paint::{Brush, Fill, LiquifySettings};
use crate::surface::Operator;

/// Everything a tool works with, as it is when the pen comes down.
pub struct ToolContext<'a> {
    pub document: &'a Document,
    /// The selected layer.
    pub layer: Option<LayerId>,
    /// All chosen layers, those in a chosen group left out, bottom first; tools that make no marks
    /// work on all of them.
    pub layers: &'a [LayerId],
    pub brush: &'a Brush,
    /// What brush and eraser change.
    pub target: BrushTarget,
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
    /// The settings of the tools that touch and sculpt.
    pub shape: ShapeSettings,
    /// The settings of the liquify tool.
    pub liquify: LiquifySettings,
    /// The chosen part of the shape, by its id.
    pub part: Option<&'a str>,
    /// The corners of the unfinished lasso.
    pub lasso: &'a [Vec2],
    /// The area that the crop tool cuts out, and the aspect that it keeps.
    pub crop: Option<Rect>,
    pub crop_aspect: CropAspect,
    /// What the transform tool keeps about the chosen layers.
    pub gizmo: &'a GizmoMemory,
    /// What it moves.
    pub transform_target: TransformTarget,
    /// The strokes of the selected layer that are chosen.
    pub strokes: &'a [usize],
    /// The points of the selected layer's mesh that are chosen.
    pub mesh_points: &'a [usize],
    /// The place of the axes of symmetry.
    pub axes: SymmetryAxes,
    /// What the pen snaps to.
    pub snap: &'a SnapTargets,
    /// What is snapped to and drawn along.
    pub aids: ViewAids,
    /// From a pixel to the one that a clone brush copies onto it, px; `None` before it was set.
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
            target: BrushTarget::Layer,
            color: Color::BLACK,
            second_color: Color::WHITE,
            operator: Operator::None,
            px_per_pt: 1.0,
            last_end: None,
            symmetry: Symmetry::None,
            fill: Fill::default(),
            select: SelectSettings::default(),
            shape: ShapeSettings::default(),
            liquify: LiquifySettings::default(),
            part: None,
            lasso: &[],
            crop: None,
            crop_aspect: CropAspect::Free,
            gizmo: GizmoMemory::nothing(),
            transform_target: TransformTarget::Paint,
            strokes: &[],
            mesh_points: &[],
            axes: SymmetryAxes::default(),
            snap: SnapTargets::none(),
            aids: ViewAids::default(),
            clone_offset: None,
        }
    }

    /// The chosen layers: if none are given, the selected one.
    pub fn chosen(&self) -> &[LayerId] {
        if self.layers.is_empty() { self.layer.as_slice() } else { self.layers }
    }
}

/// A context that outlasts the press, for gestures that begin with a later sample.
pub struct KeptContext {
    document: Document,
    layer: Option<LayerId>,
    layers: Vec<LayerId>,
    brush: Brush,
    lasso: Vec<Vec2>,
    strokes: Vec<usize>,
    part: Option<String>,
    snap: SnapTargets,
    /// All that is not a reference.
    plain: PlainContext,
}

#[derive(Clone, Copy)]
struct PlainContext {
    target: BrushTarget,
    colors: [Color; 2],
    operator: Operator,
    px_per_pt: f32,
    last_end: Option<Vec2>,
    symmetry: Symmetry,
    axes: SymmetryAxes,
    fill: Fill,
    select: SelectSettings,
    shape: ShapeSettings,
    aids: ViewAids,
    clone_offset: Option<Vec2>,
}

impl KeptContext {
    pub fn of(context: &ToolContext) -> Self {
        let ToolContext {
            color, second_color, operator, px_per_pt, last_end, symmetry, axes, ..
        } = *context;
        let ToolContext { target, fill, select, shape, aids, clone_offset, .. } = *context;
        let colors = [color, second_color];
        let plain = PlainContext {
            target,
            colors,
            operator,
            px_per_pt,
            last_end,
            symmetry,
            axes,
            fill,
            select,
            shape,
            aids,
            clone_offset,
        };
        Self {
            document: context.document.clone(),
            layer: context.layer,
            layers: context.layers.to_vec(),
            brush: context.brush.clone(),
            lasso: context.lasso.to_vec(),
            strokes: context.strokes.to_vec(),
            part: context.part.map(str::to_owned),
            snap: context.snap.clone(),
            plain,
        }
    }

    /// Canvas px per screen point.
    pub fn px_per_pt(&self) -> f32 {
        self.plain.px_per_pt
    }

    /// The context of the press.
    pub fn lend<T>(&self, to: impl FnOnce(&ToolContext) -> T) -> T {
        let PlainContext { colors, operator, px_per_pt, last_end, symmetry, axes, fill, .. } =
            self.plain;
        let PlainContext { target, select, shape, aids, clone_offset, .. } = self.plain;
        to(&ToolContext {
            document: &self.document,
            layer: self.layer,
            layers: &self.layers,
            brush: &self.brush,
            target,
            color: colors[0],
            second_color: colors[1],
            operator,
            px_per_pt,
            last_end,
            symmetry,
            axes,
            fill,
            select,
            shape,
            // Only strokes begin with a later sample.
            liquify: LiquifySettings::default(),
            part: self.part.as_deref(),
            lasso: &self.lasso,
            crop: None,
            crop_aspect: CropAspect::Free,
            gizmo: GizmoMemory::nothing(),
            transform_target: TransformTarget::Paint,
            strokes: &self.strokes,
            mesh_points: &[],
            snap: &self.snap,
            aids,
            clone_offset,
        })
    }
}
