//! Actions on the strokes of stroke layers: selecting, changing, ordering, deleting, baking.
//! Floor 6. Not here: the edits themselves (`document::strokes`).

use crate::document::{Document, LayerId};
use crate::math::{Vec2, srgb::Color, vec2};
use crate::paint::settings::BrushNumber;
use crate::paint::{Brush, BrushMode, Stroke};
use crate::session::replay::actions;
use crate::session::{LayerPath, Session};
use crate::surface::Operator;

actions! {
    /// `strokes` are positions in the layer's list, the first painted is 0.
    StrokeAction {
        /// Selects strokes; an empty list selects none.
        "choose" Choose { layer: LayerPath, strokes: Vec<usize> }
        "move" Move { layer: LayerPath, strokes: Vec<usize>, by: Vec2 }
        /// Shown only, until it is `done`.
        "restyle" Restyle { layer: LayerPath, strokes: Vec<usize>, to: Style, done: bool }
        /// To a position counted without it.
        "order" Order { layer: LayerPath, stroke: usize, to: usize }
        /// Copies each directly above itself, slightly to the side.
        "duplicate" Duplicate { layer: LayerPath, strokes: Vec<usize> }
        "delete" Delete { layer: LayerPath, strokes: Vec<usize> }
        /// To pixels, on a paint layer of their own.
        "bake" Bake { layer: LayerPath, strokes: Vec<usize> }
        /// On a part of the shape by its id, on `canvas`, or on what the layer lies on; they show
        /// where they showed.
        "home" Attach { layer: LayerPath, strokes: Vec<usize>, part: Option<String> }
        /// Takes its brush, operator and color as the current ones.
        "take" Take { layer: LayerPath, stroke: usize }
    }
}

actions! {
    /// One property of how a stroke is painted.
    Style {
        "color" Color { color: Color }
        "operator" Operator { operator: Operator }
        "size" Size { to: f32 }
        "hardness" Hardness { to: f32 }
        "opacity" Opacity { to: f32 }
        "flow" Flow { to: f32 }
        "softness" Softness { to: f32 }
        "spacing" Spacing { to: f32 }
        "rotation" Rotation { to: f32 }
        /// The current brush.
        "brush" Brush {}
    }
}

/// The offset of a copy to the right and down, px.
const ASIDE_PX: f32 = 12.0;

impl StrokeAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        session.drop_gesture();
        let current_brush = session.tools.brush.clone();
        let Some(open) = session.active_mut() else { return };
        open.forget_preview();
        let document = open.document();
        let id = |path: &LayerPath| path.find(document).map(|layer| layer.id);
        match self {
            StrokeAction::Choose { layer, strokes } => {
                if let Some(id) = id(layer) {
                    open.active_layer = Some(id);
                    open.select_strokes(id, strokes.clone());
                }
            }
            StrokeAction::Take { layer, stroke } => {
                let stroke = id(layer).and_then(|id| document.strokes(id).get(*stroke).cloned());
                if let Some(stroke) = stroke {
                    (session.tools.brush, session.tools.operator) =
                        (stroke.brush().clone(), stroke.operator());
                    session.tools.color = stroke.color();
                }
            }
            StrokeAction::Restyle { layer, strokes, to, done } => {
                let Some(id) = id(layer) else { return };
                let next = document
                    .with_each_stroke(id, strokes, |stroke| to.apply_to(stroke, &current_brush));
                match next {
                    Some(next) if *done => drop(open.commit("Restyle stroke", next)),
                    Some(next) => open.show("Restyle stroke", next),
                    None => {}
                }
            }
            _ => {
                if let Some((label, next, layer, selected)) = self.edit(document)
                    && open.commit(label, next)
                {
                    open.select_strokes(layer, selected);
                }
            }
        }
    }

    /// The step: its name, the resulting document, and the strokes that are selected then.
    fn edit(&self, document: &Document) -> Option<(&'static str, Document, LayerId, Vec<usize>)> {
        let id = |path: &LayerPath| path.find(document).map(|layer| layer.id);
        Some(match self {
            StrokeAction::Move { layer, strokes, by } => {
                let id = id(layer)?;
                ("Move stroke", document.with_moved_strokes(id, strokes, *by)?, id, strokes.clone())
            }
            StrokeAction::Order { layer, stroke, to } => {
                let id = id(layer)?;
                let next = document.with_reordered_stroke(id, *stroke, *to)?;
                (
                    "Order strokes",
                    next,
                    id,
                    vec![(*to).min(document.strokes(id).len().saturating_sub(1))],
                )
            }
            StrokeAction::Duplicate { layer, strokes } => {
                let id = id(layer)?;
                let (next, copies) =
                    document.with_copied_strokes(id, strokes, vec2(ASIDE_PX, ASIDE_PX))?;
                ("Duplicate stroke", next, id, copies)
            }
            StrokeAction::Delete { layer, strokes } => {
                let id = id(layer)?;
                ("Delete stroke", document.without_strokes(id, strokes)?, id, Vec::new())
            }
            StrokeAction::Attach { layer, strokes, part } => {
                let id = id(layer)?;
                let next = document.with_strokes_on(id, strokes, part.as_deref())?;
                ("Carry with part", next, id, strokes.clone())
            }
            StrokeAction::Bake { layer, strokes } => {
                let id = id(layer)?;
                let (next, _) = document.with_baked_strokes(id, strokes)?;
                ("Turn stroke into pixels", next, id, Vec::new())
            }
            StrokeAction::Choose { .. }
            | StrokeAction::Restyle { .. }
            | StrokeAction::Take { .. } => return None,
        })
    }
}

impl Style {
    /// The stroke painted in this way; `current_brush`: the brush that [`Style::Brush`] gives.
    fn apply_to(&self, stroke: &Stroke, current_brush: &Brush) -> Stroke {
        let mut brush = stroke.brush().clone();
        let (mut operator, mut color) = (stroke.operator(), stroke.color());
        match self {
            Style::Color { color: to } => color = *to,
            Style::Operator { operator: to } => operator = *to,
            Style::Size { to } => BrushNumber::Size.set(&mut brush, *to),
            Style::Hardness { to } => BrushNumber::Hardness.set(&mut brush, *to),
            Style::Opacity { to } => BrushNumber::Opacity.set(&mut brush, *to),
            Style::Flow { to } => BrushNumber::Flow.set(&mut brush, *to),
            Style::Softness { to } => BrushNumber::Softness.set(&mut brush, *to),
            Style::Spacing { to } => BrushNumber::Spacing.set(&mut brush, *to),
            Style::Rotation { to } => BrushNumber::Rotation.set(&mut brush, *to),
            Style::Brush {} => brush = Brush { mode: BrushMode::Paint, ..current_brush.clone() },
        }
        Stroke::new(brush, operator, color, stroke.samples().to_vec())
            .within(stroke.selection().cloned())
            .on(stroke.attachment().cloned())
    }
}
