//! The gizmos of pieces on the unwrapped sheet, and the handles of the one under the pointer. Floor
//! 7.

use crate::math::Vec2;
use crate::session::Session;
use crate::surface::unwrap::PlaneLayout;
use crate::tools::ModifierKeys;
use crate::tools::unwrapped::pieces::{PieceGizmo, bend_on_pieces, grab_piece};
use eframe::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, vec2};

/// Draws them while an image or a gradient lies on the pieces; `under`: on the sheet.
pub fn draw(
    painter: &Painter,
    session: &Session,
    layout: &PlaneLayout,
    under: Option<Vec2>,
    px_per_pt: f32,
    to_screen: &impl Fn(Vec2) -> Pos2,
) {
    let lies = session.layer().and_then(|layer| bend_on_pieces(&layer.content));
    if lies.is_none_or(|bend| bend.operator.unwrapping().is_none()) {
        return;
    }
    let held = under
        .and_then(|at| grab_piece(layout, at, px_per_pt, ModifierKeys::default()))
        .map(|(piece, _)| piece);
    for piece in layout.pieces() {
        let Some(gizmo) = PieceGizmo::of(piece, px_per_pt) else { continue };
        let corners: Vec<Pos2> = gizmo.corners.map(to_screen).to_vec();
        let is_held = held.is_some_and(|held| held.object == piece.object);
        let light = if is_held { 230 } else { 90 };
        for stroke in [
            Stroke::new(2.4, Color32::from_black_alpha(light / 2)),
            Stroke::new(1.0, Color32::from_white_alpha(light)),
        ] {
            painter.add(Shape::closed_line(corners.clone(), stroke));
        }
        if !is_held {
            continue;
        }
        let (knob, top) = (to_screen(gizmo.knob), corners[0] + 0.5 * (corners[1] - corners[0]));
        painter.line_segment([top, knob], Stroke::new(1.0, Color32::from_white_alpha(light)));
        painter.circle(knob, 4.5, Color32::WHITE, Stroke::new(1.2, Color32::from_black_alpha(170)));
        for corner in corners {
            let square = Rect::from_center_size(corner, vec2(8.0, 8.0));
            painter.rect_filled(square.expand(1.2), 0.0, Color32::from_black_alpha(170));
            painter.rect_filled(square, 0.0, Color32::WHITE);
        }
    }
}
