//! The frame of the transform tool on the picture.
//! Floor 7. What a drag of it does is `tools::transform`'s.

use crate::math::Vec2;
use crate::session::Session;
use eframe::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, vec2};

/// Side of a handle, points.
const HANDLE_PT: f32 = 9.0;

/// Draws the frame around the chosen layers.
pub fn draw(painter: &Painter, session: &Session, to_screen: &impl Fn(Vec2) -> Pos2) {
    let Some(tab) = session.active() else { return };
    let Some(frame) = tab.frame() else { return };
    let corners = frame.corners.map(to_screen);
    let dark = Stroke::new(3.0, Color32::from_black_alpha(110));
    let light = Stroke::new(1.2, Color32::from_rgb(120, 200, 255));
    for look in [dark, light] {
        painter.add(Shape::closed_line(corners.to_vec(), look));
    }
    let pivot = to_screen(frame.pivot());
    for look in [dark, light] {
        painter.circle_stroke(pivot, 5.0, look);
        for arm in [vec2(8.0, 0.0), vec2(0.0, 8.0)] {
            painter.line_segment([pivot - arm, pivot + arm], look);
        }
    }
    let edges = (0..4).map(|i| to_screen(frame.edge(i)));
    for at in corners.into_iter().chain(edges) {
        let handle = Rect::from_center_size(at, vec2(HANDLE_PT, HANDLE_PT));
        painter.rect_filled(handle, 1.0, Color32::WHITE);
        painter.rect_stroke(handle, 1.0, Stroke::new(1.2, Color32::from_black_alpha(190)), StrokeKind::Outside);
    }
}
