//! What the move tool would hold, and what it holds: the outline of a stroke, or the bounds of a
//! layer. Floor 7. Not here: which of them it is (`tools::move_content`).

use super::{LOOKS, draw_outlines, line_through};
use crate::document::{Content, Document, Layer, LayerId};
use crate::math::{Vec2, vec2};
use crate::session::Session;
use crate::tools::gizmo::TransformGizmo;
use crate::tools::move_content::{MoveTarget, target_at};
use eframe::egui::{Id, Painter, Pos2, Shape};

/// For a layer with more strokes only the bounds are shown: finding the stroke under the pointer
/// would take too long at every move.
const MOST_STROKES: usize = 400;
const DASH_PT: f32 = 6.0;

/// What was under the pointer last: it stays held during a drag.
#[derive(Clone, Copy)]
struct Last {
    layer: LayerId,
    at: Vec2,
    held: MoveTarget,
}

/// `under`: the canvas point under the pointer.
pub fn draw(
    painter: &Painter,
    session: &Session,
    under: Option<Vec2>,
    to_screen: &impl Fn(Vec2) -> Pos2,
) {
    let Some((open, layer)) = session.active().zip(session.layer()) else { return };
    if open.has_several() {
        return open
            .outermost_selected()
            .into_iter()
            .for_each(|id| bounds(painter, open.shown_document(), id, to_screen));
    }
    let id = Id::unique("held by the move tool");
    let last: Option<Last> = painter.ctx().data_mut(|data| data.get_temp(id));
    let last = last.filter(|last| last.layer == layer.id);
    if open.is_previewing() {
        let Some(last) = last else { return };
        return match last.held {
            MoveTarget::Stroke(index) => {
                let strokes = open.shown_document().strokes_on_canvas(layer.id);
                strokes
                    .get(index)
                    .into_iter()
                    .for_each(|stroke| line_through(painter, stroke, to_screen));
            }
            MoveTarget::Layer => bounds(painter, open.shown_document(), layer.id, to_screen),
        };
    }
    let Some(at) = under.map(Vec2::floor) else { return };
    let whole = painter.ctx().input(|input| input.modifiers.shift)
        || open.shown_document().strokes(layer.id).len() > MOST_STROKES;
    let known = last.filter(|last| last.at == at && !whole).map(|last| last.held);
    let Some(now) =
        known.or_else(|| target_at(open.shown_document(), layer, at + vec2(0.5, 0.5), whole))
    else {
        return;
    };
    painter.ctx().data_mut(|data| data.insert_temp(id, Last { layer: layer.id, at, held: now }));
    match now {
        MoveTarget::Stroke(index) => {
            let scene = open
                .shown_document()
                .scene_of(layer.id)
                .unwrap_or_else(|| open.shown_document().scene());
            let strokes = open.shown_document().strokes_on_canvas(layer.id);
            draw_outlines(painter, strokes.get(index).into_iter().collect(), &scene, to_screen);
        }
        MoveTarget::Layer => bounds(painter, open.shown_document(), layer.id, to_screen),
    }
}

/// A dashed outline around what a layer holds, in its place; around the canvas if that is unbounded.
fn bounds(
    painter: &Painter,
    document: &Document,
    layer: LayerId,
    to_screen: &impl Fn(Vec2) -> Pos2,
) {
    let [a, b, c, d] = outline_of(document, layer).map(to_screen);
    let outline = [a, b, c, d, a];
    let [beneath, light] = LOOKS;
    painter.add(Shape::line(outline.to_vec(), beneath));
    painter.extend(Shape::dashed_line(&outline, light, DASH_PT, DASH_PT));
}

/// Upper left, upper right, lower right, lower left; for an empty layer, and for too many strokes
/// to search at every move, those of the canvas.
fn outline_of(document: &Document, layer: LayerId) -> [Vec2; 4] {
    let (w, h) = (document.size.width as f32, document.size.height as f32);
    let canvas = [Vec2::ZERO, vec2(w, 0.0), vec2(w, h), vec2(0.0, h)];
    let is_quick = document.layer(layer).is_some_and(|layer| strokes_of(layer) <= MOST_STROKES);
    let known = is_quick.then(|| TransformGizmo::of(document, layer)).flatten();
    known.map_or(canvas, |gizmo| gizmo.corners)
}

/// The strokes of a layer and of all in it.
fn strokes_of(layer: &Layer) -> usize {
    match &layer.content {
        Content::Strokes(live) => live.params().strokes.len(),
        Content::Group(group) => group.layers.iter().map(|layer| strokes_of(layer)).sum(),
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Live, StrokeList};
    use crate::math::{Size, srgb::Color};
    use crate::paint::{Brush, Sample, Stroke};
    use crate::surface::Operator;
    use std::sync::Arc;

    #[test]
    fn of_strokes_the_frame_is_around_them_and_not_around_the_canvas() {
        let samples = vec![Sample::at(vec2(300.0, 200.0)), Sample::at(vec2(320.0, 210.0))];
        let stroke = Stroke::new(
            Brush { size: 10.0, ..Brush::default() },
            Operator::None,
            Color::BLACK,
            samples,
        );
        let of = |strokes: Vec<Arc<Stroke>>| {
            let layer = Layer::new("Ink", Content::Strokes(Live::new(StrokeList { strokes })));
            let layers = vec![Arc::new(layer)];
            let document = Document { layers, ..Document::empty(Size::new(600, 500)) };
            let [from, _, to, _] = outline_of(&document, document.layers[0].id);
            (from, to)
        };
        let stroke = Arc::new(stroke);
        let (from, to) = of(vec![stroke.clone()]);
        assert!(
            from.cmpge(vec2(192.0, 128.0)).all() && to.cmple(vec2(384.0, 256.0)).all(),
            "{from} {to}"
        );
        for strokes in [Vec::new(), vec![stroke; MOST_STROKES + 1]] {
            assert_eq!(of(strokes), (Vec2::ZERO, vec2(600.0, 500.0)));
        }
    }
}
