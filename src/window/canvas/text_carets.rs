//! The caret and the selected letters of the text that is typed, and the box of the selected text.
//! Floor 7. Not here: typing (`panels::text`).

use crate::document::Content;
use crate::io::text::{self, Caret};
use crate::math::{Vec2, vec2};
use crate::paint::{PlacedImage, Text};
use crate::session::Session;
use crate::surface::Operator;
use crate::typed_range::{TypedRange, typed_range};
use eframe::egui::{Color32, Id, Painter, Pos2, Shape, Stroke};
use std::sync::Arc;

/// The part of the type above its baseline, and beneath.
const ASCENT: f32 = 0.8;
const DESCENT: f32 = 0.2;

/// Draws them over the canvas. A text that is bent shows none: its letters are elsewhere.
pub fn draw(painter: &Painter, session: &Session, to_screen: &impl Fn(Vec2) -> Pos2) {
    let (Some(layer), Some(document)) = (session.layer(), session.shown_document()) else { return };
    let Content::Image(live) = &layer.content else { return };
    let (image, Some(text)) = (live.params(), live.params().source.text()) else { return };
    if image.bend.operator != Operator::None {
        return;
    }
    let on_screen = |own: Vec2| {
        let in_frame = image.frame_from_own(document.size).transform_point2(own);
        image.frame.to_canvas(in_frame).map(to_screen)
    };
    outline(painter, image, &on_screen);
    let typed = painter.ctx().data(|data| data.get_temp::<Option<TypedRange>>(typed_range()));
    let Some(typed) = typed.flatten().filter(|typed| typed.layer == layer.id) else { return };
    let carets = carets(painter, text);
    let ends = |caret: &Caret| {
        let at = text.origin + caret.at;
        let (up, down) = (ASCENT * caret.height, DESCENT * caret.height);
        let across = -caret.direction.perp();
        Some([on_screen(at + across * up)?, on_screen(at - across * down)?])
    };
    for pair in carets.windows(2) {
        let is_selected = typed.bytes.contains(&pair[0].byte) && pair[1].byte > pair[0].byte;
        let is_on_line = pair[1].line == pair[0].line;
        if let (true, Some([a, b]), Some([d, c])) =
            (is_selected && is_on_line, ends(&pair[0]), ends(&pair[1]))
        {
            let tint = Color32::from_rgba_unmultiplied(60, 130, 240, 90);
            painter.add(Shape::convex_polygon(vec![a, b, c, d], tint, Stroke::NONE));
        }
    }
    let caret = carets.iter().rev().find(|caret| caret.byte == typed.caret);
    if let Some([a, b]) = caret.and_then(ends) {
        for stroke in [Stroke::new(3.0, Color32::WHITE), Stroke::new(1.4, Color32::BLACK)] {
            painter.line_segment([a, b], stroke);
        }
    }
}

/// The box of the text, dark beneath light.
fn outline(painter: &Painter, image: &PlacedImage, on_screen: &impl Fn(Vec2) -> Option<Pos2>) {
    let size = image.source.picture.own_size();
    let corners = [Vec2::ZERO, vec2(size.x, 0.0), size, vec2(0.0, size.y)];
    let corners: Option<Vec<Pos2>> = corners.into_iter().map(on_screen).collect();
    let Some(corners) = corners else { return };
    for stroke in [
        Stroke::new(2.0, Color32::from_black_alpha(110)),
        Stroke::new(1.0, Color32::from_white_alpha(220)),
    ] {
        painter.add(Shape::closed_line(corners.clone(), stroke));
    }
}

/// The places between the letters of a text; laid out again when it changes.
fn carets(painter: &Painter, text: &Arc<Text>) -> Arc<Vec<Caret>> {
    type Known = (Arc<Text>, Arc<Vec<Caret>>);
    let id = Id::unique("carets of a text");
    let known = painter.ctx().data(|data| data.get_temp::<Known>(id));
    if let Some((of, carets)) = known.filter(|(of, _)| **of == **text) {
        drop(of);
        return carets;
    }
    let carets = Arc::new(text::carets(text).unwrap_or_default());
    painter.ctx().data_mut(|data| data.insert_temp(id, (text.clone(), carets.clone())));
    carets
}
