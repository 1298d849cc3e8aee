//! The area of the crop tool on the picture: dark outside, thirds inside, handles; and its keys.
//! Floor 7. Not here: what a drag of it does (`tools::crop`).

use crate::math::{Rect, Vec2, vec2};
use crate::session::actions::CanvasAction;
use crate::session::{Action, Session};
use crate::tools::{ToolKind, crop};
use eframe::egui::{self, Color32, Painter, Pos2, Shape, Stroke, StrokeKind, Ui};

/// Side of a handle, points.
const HANDLE_PT: f32 = 9.0;

/// Draws the area, if there is one.
pub fn draw(painter: &Painter, session: &Session, to_screen: &impl Fn(Vec2) -> Pos2) {
    let Some(area) = session.tools.crop.area else { return };
    let corners = crop::corners(area);
    darken_outside(painter, session, corners, to_screen);
    let seen = corners.map(to_screen);
    let look = |width: f32, color: Color32| Stroke::new(width, color);
    let at = |u: f32, v: f32| to_screen(corners[0] + (corners[2] - corners[0]) * vec2(u, v));
    for third in [1.0 / 3.0, 2.0 / 3.0] {
        for ends in [[at(third, 0.0), at(third, 1.0)], [at(0.0, third), at(1.0, third)]] {
            painter.line_segment(ends, look(2.0, Color32::from_black_alpha(60)));
            painter.line_segment(ends, look(0.8, Color32::from_white_alpha(150)));
        }
    }
    for line in [look(3.0, Color32::from_black_alpha(110)), look(1.2, Color32::WHITE)] {
        painter.add(Shape::closed_line(seen.to_vec(), line));
    }
    for handle in seen.into_iter().chain((0..4).map(|i| to_screen(crop::edge(area, i)))) {
        let square = egui::Rect::from_center_size(handle, egui::vec2(HANDLE_PT, HANDLE_PT));
        painter.rect_filled(square, 1.0, Color32::WHITE);
        painter.rect_stroke(
            square,
            1.0,
            look(1.2, Color32::from_black_alpha(190)),
            StrokeKind::Outside,
        );
    }
}

/// Darkens the canvas outside the area: four pieces around it, however the view is turned.
fn darken_outside(
    painter: &Painter,
    session: &Session,
    area: [Vec2; 4],
    to_screen: &impl Fn(Vec2) -> Pos2,
) {
    let Some(document) = session.shown_document() else { return };
    let canvas = crop::corners(document.size.rect());
    let (low, high) = (canvas[0].min(area[0]), canvas[2].max(area[2]));
    let pieces = [
        [low, vec2(high.x, area[0].y)],
        [vec2(low.x, area[2].y), high],
        [vec2(low.x, area[0].y), vec2(area[0].x, area[2].y)],
        [vec2(area[2].x, area[0].y), vec2(high.x, area[2].y)],
    ];
    for [a, b] in pieces.into_iter().filter(|[a, b]| b.x > a.x && b.y > a.y) {
        let corners = [a, vec2(b.x, a.y), b, vec2(a.x, b.y)].map(to_screen);
        painter.add(Shape::convex_polygon(
            corners.to_vec(),
            Color32::from_black_alpha(120),
            Stroke::NONE,
        ));
    }
}

/// Enter crops to the area, Escape cancels.
pub fn keys(ui: &Ui, session: &Session, actions: &mut Vec<Action>) {
    let Some(area) = session.tools.crop.area.filter(|_| session.tool == ToolKind::Crop) else {
        return;
    };
    if session.is_drawing() || ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    if ui.input(|input| input.key_pressed(egui::Key::Enter)) {
        actions.push(apply(area));
    } else if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
        actions.push(Action::Canvas(CanvasAction::CropArea { frame: None }));
    }
}

/// Crops to an area.
pub fn apply(area: Rect) -> Action {
    Action::Canvas(CanvasAction::Crop { to: area })
}
