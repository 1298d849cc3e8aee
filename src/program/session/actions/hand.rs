//! The current settings: tool, brush, colors, operator.
//! Floor 6.

use crate::document::symmetry::{MOST_ROUND, SymmetryAxes};
use crate::document::{Document, Symmetry, SymmetrySettings};
use crate::io::recipe::read_brush;
use crate::math::range::clamp_to_range;
use crate::math::{Vec2, srgb::Color};
use crate::paint::settings::BrushNumber;
use crate::paint::{
    BrushMode, Fill, LiquifySettings, LiquifyTool, Property, RampColors, RampStyle,
};
use crate::session::replay::{ReplayValue, actions, as_in_recipes, names, record};
use crate::session::{Session, brushes};
use crate::shape::SculptStroke;
use crate::surface::{Operator, PaintLimit};
use crate::tools::gizmo::TransformTarget;
use crate::tools::gradient::GradientSettings;
use crate::tools::path::SelectedNode;
use crate::tools::{ShapeSettings, ToolKind};
use serde_json::Value;

names!(ToolKind);
names!(PaintLimit);
names!(LiquifyTool);
record!(LiquifySettings { tool, size, strength, one_object, foreshortened });
names!(TransformTarget);
names!(RampColors);
names!(RampStyle);
record!(GradientSettings { live, style, colors, reverse });
record!(Fill { tolerance, gap_px, grow_px, antialias, layer_alone, bounded });

as_in_recipes!(BrushMode);

/// A word, or a number of turns.
impl ReplayValue for Symmetry {
    fn to_value(&self) -> Value {
        match *self {
            Symmetry::None => "none".into(),
            Symmetry::Vertical => "vertical".into(),
            Symmetry::Horizontal => "horizontal".into(),
            Symmetry::Both => "both".into(),
            Symmetry::Radial(n) => n.into(),
        }
    }

    fn read(value: &Value) -> Result<Self, String> {
        match value.as_str() {
            Some("none") => Ok(Symmetry::None),
            Some("vertical") => Ok(Symmetry::Vertical),
            Some("horizontal") => Ok(Symmetry::Horizontal),
            Some("both") => Ok(Symmetry::Both),
            Some(_) => Err("must be none, vertical, horizontal, both or a number of turns".into()),
            None => u32::read(value).map(|n| Symmetry::Radial(n.clamp(2, MOST_ROUND))),
        }
    }
}

actions! {
    /// These actions do not change a document, but for symmetry, which belongs to it.
    HandAction {
        "tool" Tool { tool: ToolKind }
        /// Selects one of the available brushes by its key.
        "preset" Preset { name: String }
        /// The whole brush as in recipes; it may name the pictures of the current one.
        "brush" Brush { brush: Value }
        /// Its second tip becomes the tip of an available brush, by its key; no key takes it away.
        "second tip" SecondTip { name: String }
        /// Diameter, px.
        "size" Size { to: f32 }
        "hardness" Hardness { to: f32 }
        "opacity" Opacity { to: f32 }
        "flow" Flow { to: f32 }
        "spacing" Spacing { to: f32 }
        "softness" Softness { to: f32 }
        "rotation" Rotation { to: f32 }
        /// Shares of size and flow that follow the pen's pressure.
        "pressure" Pressure { size: f32, flow: f32 }
        "color" Color { color: Color }
        "second color" SecondColor { color: Color }
        "swap colors" SwapColors {}
        "default colors" DefaultColors {}
        "operator" Operator { operator: Operator }
        "symmetry" Symmetry { symmetry: Symmetry }
        /// The place of the axes of symmetry; without a point, the middle of the canvas.
        "axes" Axes { center: Option<Vec2>, turn: f32 }
        "fill" Fill { fill: Fill }
        "liquify" Liquify { liquify: LiquifySettings }
        /// What new gradients are like.
        "gradient" Gradient { gradient: GradientSettings }
        /// Whether new gradients are live layers, and not painted into the selected paint layer.
        "live gradients" LiveGradients { on: bool }
        /// Whether a mouse presses less the faster it moves.
        "press by speed" PressBySpeed { on: bool }
        /// Whether the brush paints, smudges, blurs or clones.
        "mark" Mark { mark: BrushMode }
        /// What the transform tool moves.
        "carried" TransformTarget { carried: TransformTarget }
        /// Where the brush may paint.
        "bounded" Bounded { bounded: PaintLimit }
        /// Whether a stroke that begins on a part may go on to others.
        "across parts" AcrossParts { on: bool }
        /// How far from the pen its marks may land, in diameters; 0 is anywhere.
        "reach" Reach { to: f32 }
    }
}

impl HandAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        let brush = &mut session.tools.brush;
        match self {
            HandAction::Tool { tool } => {
                session.drop_gesture();
                let is_first = session.tools.shape == ShapeSettings::default();
                if let Some(document) = session.shown_document().filter(|_| is_first) {
                    session.tools.shape = ShapeSettings::for_canvas(document.size);
                }
                session.tools.lasso.clear();
                session.tools.path_node = SelectedNode::default();
                session.tools.transform.mesh_points.clear();
                session.tools.crop.area = None;
                session.tool = *tool;
            }
            HandAction::Preset { name } => session.take_preset(name),
            HandAction::Brush { brush: wanted } => match read_brush(wanted, brush) {
                Ok(read) => *brush = read,
                Err(error) => session.notes.push(error.to_string()),
            },
            HandAction::SecondTip { name } => brushes::set_second_tip(session, name),
            HandAction::Size { to } if session.tool == ToolKind::Sculpt => {
                session.tools.shape.size = clamp_to_range(*to, &SculptStroke::SIZE);
            }
            HandAction::Size { to } if session.tool == ToolKind::Liquify => {
                session.tools.liquify.size = clamp_to_range(*to, &LiquifySettings::SIZE);
            }
            HandAction::Liquify { liquify } => session.tools.liquify = liquify.clamp_to_ranges(),
            HandAction::Size { to } => BrushNumber::Size.set(brush, *to),
            HandAction::Hardness { to } => BrushNumber::Hardness.set(brush, *to),
            HandAction::Opacity { to } => BrushNumber::Opacity.set(brush, *to),
            HandAction::Flow { to } => BrushNumber::Flow.set(brush, *to),
            HandAction::Spacing { to } => BrushNumber::Spacing.set(brush, *to),
            HandAction::Softness { to } => BrushNumber::Softness.set(brush, *to),
            HandAction::Rotation { to } => BrushNumber::Rotation.set(brush, *to),
            HandAction::Pressure { size, flow } => {
                let dynamics = brush.dynamics.with_pressure(Property::Size, *size);
                brush.dynamics = dynamics.with_pressure(Property::Flow, *flow);
            }
            HandAction::Color { color } => session.tools.color = *color,
            HandAction::SecondColor { color } => session.tools.second_color = *color,
            HandAction::SwapColors {} => {
                std::mem::swap(&mut session.tools.color, &mut session.tools.second_color)
            }
            HandAction::DefaultColors {} => {
                (session.tools.color, session.tools.second_color) = (Color::BLACK, Color::WHITE)
            }
            HandAction::Operator { operator } => {
                session.tools.operator = operator.clamp_to_ranges()
            }
            HandAction::Symmetry { symmetry } => {
                let kind = *symmetry;
                set_symmetry(session, |own| SymmetrySettings { kind, ..own });
            }
            HandAction::Axes { center, turn } => {
                let axes = SymmetryAxes { center: *center, turn: *turn }.clamp_to_ranges();
                set_symmetry(session, |own| SymmetrySettings { axes, ..own });
            }
            HandAction::Fill { fill } => session.tools.fill = *fill,
            HandAction::Gradient { gradient } => session.tools.gradient = *gradient,
            HandAction::LiveGradients { on } => session.tools.gradient.live = *on,
            HandAction::PressBySpeed { on } => session.tools.presses_by_speed = *on,
            HandAction::Mark { mark: mode } => brush.mode = mode.clamp_to_ranges(),
            HandAction::TransformTarget { carried } => session.tools.transform.target = *carried,
            HandAction::Bounded { bounded } => brush.bounded = *bounded,
            HandAction::AcrossParts { on } => session.tools.crosses_parts = *on,
            HandAction::Reach { to } => BrushNumber::Reach.set(brush, *to),
        }
    }
}

/// How new strokes of the document repeat, as a step.
fn set_symmetry(session: &mut Session, change: impl FnOnce(SymmetrySettings) -> SymmetrySettings) {
    session.drop_gesture();
    let Some(open) = session.active_mut() else {
        return session.say("There is no document.");
    };
    let document = open.document();
    let symmetry = change(document.symmetry);
    if symmetry != document.symmetry {
        let next = Document { symmetry, ..document.clone() };
        open.commit("Symmetry", next);
    }
}
