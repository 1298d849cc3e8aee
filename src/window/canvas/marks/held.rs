//! What the move tool would hold, and what it holds: the outline of a stroke, or the bounds of a layer.
//! Floor 7. Which of them it is `tools::move_content` tells.

use super::{LOOKS, line_through, outlined};
use crate::document::{Content, Layer, LayerId};
use crate::math::{Rect, Size, Vec2, vec2};
use crate::session::Session;
use crate::tools::move_content::{Held, held};
use eframe::egui::{Id, Painter, Pos2, Shape};

/// Of a layer with more strokes only the bounds are shown: to find the one under the pointer would take too long for
/// every move of it.
const MOST_STROKES: usize = 400;
const DASH_PT: f32 = 6.0;

/// What was under the pointer last: it is held while it is dragged.
#[derive(Clone, Copy)]
struct Last {
    layer: LayerId,
    at: Vec2,
    held: Held,
}

/// `under`: the canvas point under the pointer.
pub fn draw(painter: &Painter, session: &Session, under: Option<Vec2>, to_screen: &impl Fn(Vec2) -> Pos2) {
    let Some((tab, layer)) = session.active().zip(session.layer()) else { return };
    if tab.has_several() {
        let all = tab.outermost_chosen().into_iter().filter_map(|id| tab.shown().layer(id));
        return all.for_each(|layer| bounds(painter, layer, tab.shown().size, to_screen));
    }
    let id = Id::unique("held by the move tool");
    let last: Option<Last> = painter.ctx().data_mut(|data| data.get_temp(id));
    let last = last.filter(|last| last.layer == layer.id);
    if tab.is_previewing() {
        let moved = tab.shown().layer(layer.id);
        let Some((last, moved)) = last.zip(moved) else { return };
        return match last.held {
            Held::Stroke(index) => {
                let strokes = tab.shown().strokes_on_canvas(layer.id);
                strokes.get(index).into_iter().for_each(|stroke| line_through(painter, stroke, to_screen));
            }
            Held::Layer => bounds(painter, moved, tab.shown().size, to_screen),
        };
    }
    let Some(at) = under.map(Vec2::floor) else { return };
    let whole =
        painter.ctx().input(|input| input.modifiers.shift) || tab.shown().strokes(layer.id).len() > MOST_STROKES;
    let known = last.filter(|last| last.at == at && !whole).map(|last| last.held);
    let Some(now) = known.or_else(|| held(tab.shown(), layer, at + vec2(0.5, 0.5), whole)) else { return };
    painter.ctx().data_mut(|data| data.insert_temp(id, Last { layer: layer.id, at, held: now }));
    match now {
        Held::Stroke(index) => {
            let scene = tab.shown().scene_of(layer.id).unwrap_or_else(|| tab.shown().scene());
            let strokes = tab.shown().strokes_on_canvas(layer.id);
            outlined(painter, strokes.get(index).into_iter().collect(), &scene, to_screen);
        }
        Held::Layer => bounds(painter, layer, tab.shown().size, to_screen),
    }
}

/// A dashed rectangle around what a layer holds.
fn bounds(painter: &Painter, layer: &Layer, canvas: Size, to_screen: &impl Fn(Vec2) -> Pos2) {
    let Rect { x0, y0, x1, y1 } = extent(layer, canvas);
    let corner = |x: i32, y: i32| to_screen(vec2(x as f32, y as f32));
    let corners = [corner(x0, y0), corner(x1, y0), corner(x1, y1), corner(x0, y1), corner(x0, y0)];
    let [beneath, light] = LOOKS;
    painter.add(Shape::line(corners.to_vec(), beneath));
    painter.extend(Shape::dashed_line(&corners, light, DASH_PT, DASH_PT));
}

/// The pixels of a paint layer; of all else the canvas.
fn extent(layer: &Layer, canvas: Size) -> Rect {
    match &layer.content {
        Content::Pixels(pixels) if !pixels.tiles.bounds().is_empty() => pixels.tiles.bounds(),
        _ => canvas.rect(),
    }
}
