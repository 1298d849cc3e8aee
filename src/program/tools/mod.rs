//! Floor 5: tools. A tool turns the pen's events on the canvas into documents: a preview while the
//! pen moves, and a result when it lifts. Each tool is a file and a row of [`ToolKind`] (`kinds`).
//! Not here: the current tool and the history (`session`), screen coordinates (`window`).

pub mod anchors;
pub mod assistants;
pub mod brush;
mod closed;
mod context;
pub mod crop;
mod displaced;
pub mod eyedropper;
pub mod fill;
mod gesture;
pub mod gizmo;
pub mod gradient;
pub mod guides;
pub mod image;
mod kinds;
pub mod lights;
pub mod liquify;
pub mod mask;
pub mod move_content;
pub mod outline;
mod pen;
mod retouch;
pub mod select;
pub mod settings;
pub mod shape;
pub mod snap;
pub mod strokes;
pub mod symmetry;
pub mod transform;
pub mod unwrapped;

pub use context::ToolContext;
pub use gesture::{Gesture, GestureStart, Outcome};
pub use kinds::ToolKind;
pub use pen::{GRAB_PT, ModifierKeys, PenSample};
pub use settings::{BrushTarget, SelectSettings, ShapeSettings};
pub use symmetry::Symmetry;

use settings::StrokePurpose;

/// The pen comes down. Hand and zoom do not concern documents: they start no gesture.
pub fn press(kind: ToolKind, context: &ToolContext, pen: PenSample) -> GestureStart {
    match kind {
        ToolKind::Brush => stroke(context, pen, StrokePurpose::Paint),
        ToolKind::Eraser => stroke(context, pen, StrokePurpose::Erase),
        ToolKind::Fill => fill::press(context, pen),
        ToolKind::Gradient => gradient::press(context, pen),
        ToolKind::Image => image::press(context, pen),
        ToolKind::Anchors => anchors::press(context, pen),
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
        ToolKind::Hand | ToolKind::Zoom => (None, Outcome::Idle),
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
