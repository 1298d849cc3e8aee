//! Floor 5: tools. A tool turns the pen's events on the canvas into documents: a preview while the
//! pen moves, and a result when it lifts. Each tool is a file and a row of [`ToolKind`] (`kinds`); one
//! that has settings keeps them in its file, and is a row of [`ToolSettings`].
//! Not here: the current tool and the history (`session`), screen coordinates (`window`).

pub mod anchors;
pub mod assistants;
pub mod brush;
mod closed;
pub mod crop;
mod displaced;
pub mod eyedropper;
pub mod fill;
mod gesture;
pub mod gizmo;
pub mod gradient;
pub mod guides;
pub mod image;
mod kept_context;
mod kinds;
pub mod lights;
pub mod liquify;
pub mod mask;
pub mod move_content;
pub mod outline;
pub mod panels;
pub mod path;
mod pen;
pub mod purpose;
mod retouch;
pub mod select;
pub mod shape;
pub mod snap;
pub mod strokes;
pub mod transform;
pub mod unwrapped;

pub use gesture::{DocumentChoice, Gesture, GestureStart, Outcome, SettingsChange};
pub use kinds::ToolKind;
pub use pen::{GRAB_PT, ModifierKeys, PenSample};
pub use purpose::BrushTarget;
pub use select::SelectSettings;
pub use shape::ShapeSettings;

use crate::document::{Document, LayerId};
use crate::math::{Vec2, srgb::Color};
use crate::paint::{Brush, Fill, LiquifySettings, PanelSettings};
use crate::surface::Operator;
use crop::CropSettings;
use gizmo::GizmoMemory;
use gradient::GradientSettings;
use path::{PathSettings, SelectedNode};
use purpose::StrokePurpose;
use snap::{SnapTargets, ViewAids};
use transform::TransformSettings;

/// Everything a tool works with, as it is when the pen comes down.
#[derive(Clone, Copy)]
pub struct ToolContext<'a> {
    /// The document in front.
    pub document: &'a Document,
    /// The settings of the tools.
    pub tools: &'a ToolSettings,
    /// The active layer.
    pub layer: Option<LayerId>,
    /// All selected layers, those in a selected group left out, bottom first; tools that make no
    /// marks work on all of them.
    pub layers: &'a [LayerId],
    /// The selected strokes of the active layer.
    pub strokes: &'a [usize],
    /// The selected part of the shape, by its id.
    pub part: Option<&'a str>,
    /// What brush and eraser change.
    pub target: BrushTarget,
    /// Canvas px per screen point, for hit tests.
    pub px_per_pt: f32,
    /// Where the last stroke ended.
    pub last_end: Option<Vec2>,
    /// What the transform tool keeps about the selected layers.
    pub gizmo: &'a GizmoMemory,
    /// What the pen snaps to.
    pub snap: &'a SnapTargets,
    /// From a pixel to the one that a clone brush copies onto it, px; `None` before it was set.
    pub clone_offset: Option<Vec2>,
}

impl<'a> ToolContext<'a> {
    /// The initial context: no layer, one pixel per point.
    pub fn new(document: &'a Document, tools: &'a ToolSettings) -> Self {
        Self {
            document,
            tools,
            layer: None,
            layers: &[],
            strokes: &[],
            part: None,
            target: BrushTarget::Layer,
            px_per_pt: 1.0,
            last_end: None,
            gizmo: GizmoMemory::nothing(),
            snap: SnapTargets::none(),
            clone_offset: None,
        }
    }

    /// The selected layers: if none are given, the active one.
    pub fn selected_layers(&self) -> &[LayerId] {
        if self.layers.is_empty() { self.layer.as_slice() } else { self.layers }
    }
}

/// The settings of all tools. The session holds them, tools read them when the pen comes down, and
/// change them with [`Outcome::Settings`].
#[derive(Clone)]
pub struct ToolSettings {
    /// Brush and eraser.
    pub brush: Brush,
    /// Whether a mouse, which has no pressure, presses less the faster it moves.
    pub presses_by_speed: bool,
    /// The foreground and the background color.
    pub color: Color,
    /// The background color.
    pub second_color: Color,
    /// How new marks follow the surface.
    pub operator: Operator,
    /// The gradient tool.
    pub gradient: GradientSettings,
    /// The figure tool and the path tool.
    pub path: PathSettings,
    /// The panel tool.
    pub panels: PanelSettings,
    /// What of a path is selected.
    pub path_node: SelectedNode,
    /// Whether a stroke that begins on a part of the shape may go on to others.
    pub crosses_parts: bool,
    /// The fill tool.
    pub fill: Fill,
    /// The selection tools.
    pub select: SelectSettings,
    /// The corners of the unfinished lasso.
    pub lasso: Vec<Vec2>,
    /// The tools that touch and sculpt the shape.
    pub shape: ShapeSettings,
    /// The liquify tool.
    pub liquify: LiquifySettings,
    /// The transform tool.
    pub transform: TransformSettings,
    /// The crop tool.
    pub crop: CropSettings,
    /// What the pen snaps to and draws along, and what is shown of it.
    pub aids: ViewAids,
}

impl Default for ToolSettings {
    fn default() -> Self {
        Self::with_brush(Brush::default())
    }
}

impl ToolSettings {
    /// The first settings: black and white, no operator, and a brush.
    pub fn with_brush(brush: Brush) -> Self {
        Self {
            brush,
            presses_by_speed: false,
            gradient: GradientSettings::default(),
            path: PathSettings::default(),
            panels: PanelSettings::default(),
            path_node: SelectedNode::default(),
            color: Color::BLACK,
            second_color: Color::WHITE,
            operator: Operator::None,
            crosses_parts: false,
            fill: Fill::default(),
            select: SelectSettings::default(),
            lasso: Vec::new(),
            shape: ShapeSettings::default(),
            liquify: LiquifySettings::default(),
            transform: TransformSettings::default(),
            crop: CropSettings::default(),
            aids: ViewAids::default(),
        }
    }
}

/// The pen comes down. Hand and zoom do not concern documents, and texts take fonts, which the
/// session has: they start no gesture.
pub fn press(kind: ToolKind, context: &ToolContext, pen: PenSample) -> GestureStart {
    match kind {
        ToolKind::Brush => stroke(context, pen, StrokePurpose::Paint),
        ToolKind::Eraser => stroke(context, pen, StrokePurpose::Erase),
        ToolKind::Fill => fill::press(context, pen),
        ToolKind::Gradient => gradient::press(context, pen),
        ToolKind::Image => image::press(context, pen),
        ToolKind::Anchors => anchors::press(context, pen),
        ToolKind::Figure => path::figures::press(context, pen),
        ToolKind::Path => path::nodes::press(context, pen),
        ToolKind::Panels => panels::press(context, pen),
        ToolKind::Move => move_content::press(context, pen),
        ToolKind::Transform => transform::press(context, pen),
        ToolKind::Liquify => liquify::press(context, pen),
        ToolKind::Assistants => assistants::press(context, pen),
        ToolKind::Crop => crop::press(context, pen),
        ToolKind::Strokes => strokes::press(context, pen),
        ToolKind::Shape => shape::part::press(context, pen),
        ToolKind::Touch => shape::touch::press(context, pen),
        ToolKind::Sculpt => shape::sculpt::press(context, pen),
        ToolKind::SelectRectangle
        | ToolKind::SelectEllipse
        | ToolKind::Lasso
        | ToolKind::Wand
        | ToolKind::SurfaceWand => select::press(kind, context, pen),
        ToolKind::Eyedropper => eyedropper::press(context, pen),
        ToolKind::Text | ToolKind::Hand | ToolKind::Zoom => (None, Outcome::Idle),
    }
}

/// The brush or the eraser comes down on what it will change.
fn stroke(context: &ToolContext, pen: PenSample, purpose: StrokePurpose) -> GestureStart {
    let warps = displaced::warps(context);
    match warps.is_empty() {
        true => stroke_in_place(context, pen, purpose),
        false => displaced::press(context, pen, warps, purpose),
    }
}

/// The same if nothing displaces the layer, or the pen was already mapped to the undisplaced layer.
fn stroke_in_place(context: &ToolContext, pen: PenSample, purpose: StrokePurpose) -> GestureStart {
    match context.target {
        BrushTarget::Layer => brush::press(context, pen, purpose),
        BrushTarget::Mask => mask::press(context, pen, purpose),
        BrushTarget::Selection => mask::press_on_selection(context, pen, purpose),
    }
}
