//! The gizmo of the transform tool on the picture. Floor 7. Not here: what a drag of it does
//! (`tools::transform`).

use crate::document::Mesh;
use crate::math::Vec2;
use crate::session::Session;
use crate::tools::gizmo::TransformTarget;
use crate::tools::transform::mesh;
use eframe::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, vec2};

/// Side of a handle, points.
const HANDLE_PT: f32 = 9.0;

/// Draws the gizmo around the selected layers.
pub fn draw(painter: &Painter, session: &Session, to_screen: &impl Fn(Vec2) -> Pos2) {
    let Some(open) = session.active() else { return };
    let selected = open.outermost_selected();
    if session.tools.transform.target == TransformTarget::Paint
        && let [one] = selected[..]
        && let Some((mesh, points)) = open
            .shown_document()
            .layer(one)
            .and_then(|layer| mesh::points_of(open.shown_document(), layer))
    {
        let Some(map) = open.shown_document().map_of(one) else { return };
        let at = |p: Vec2| to_screen(map.map_outside_own().to_canvas(mesh.at(p).0).unwrap_or(p));
        grid(painter, &mesh, &at);
        for (k, point) in points.into_iter().enumerate() {
            let is_selected = session.tools.transform.mesh_points.contains(&k);
            let color = if is_selected { Color32::from_rgb(255, 200, 80) } else { Color32::WHITE };
            painter.circle(
                to_screen(point),
                0.5 * HANDLE_PT,
                color,
                Stroke::new(1.2, Color32::from_black_alpha(190)),
            );
        }
    }
    let Some(gizmo) = open.gizmo(session.tools.transform.target) else { return };
    let corners = gizmo.corners.map(to_screen);
    let dark = Stroke::new(3.0, Color32::from_black_alpha(110));
    let light = Stroke::new(1.2, Color32::from_rgb(120, 200, 255));
    for look in [dark, light] {
        painter.add(Shape::closed_line(corners.to_vec(), look));
    }
    let pivot = to_screen(gizmo.pivot());
    for look in [dark, light] {
        painter.circle_stroke(pivot, 5.0, look);
        for arm in [vec2(8.0, 0.0), vec2(0.0, 8.0)] {
            painter.line_segment([pivot - arm, pivot + arm], look);
        }
    }
    let edges = (0..4).map(|i| to_screen(gizmo.edge(i)));
    for at in corners.into_iter().chain(edges) {
        let handle = Rect::from_center_size(at, vec2(HANDLE_PT, HANDLE_PT));
        painter.rect_filled(handle, 1.0, Color32::WHITE);
        painter.rect_stroke(
            handle,
            1.0,
            Stroke::new(1.2, Color32::from_black_alpha(190)),
            StrokeKind::Outside,
        );
    }
}

/// The lines of a mesh in their places; `at`: where a point of its frame is shown.
fn grid(painter: &Painter, mesh: &Mesh, at: &impl Fn(Vec2) -> Pos2) {
    // This many pieces look smooth between two points.
    const PIECES: usize = 12;
    let (frame, columns, rows) = (mesh.frame(), mesh.columns(), mesh.rows());
    let place = |x: f32, y: f32| {
        let cells = crate::math::vec2((columns - 1) as f32, (rows - 1) as f32);
        at(frame.corner + frame.size * crate::math::vec2(x, y) / cells)
    };
    let share = |i: usize| i as f32 / PIECES as f32;
    let level = (0..rows).map(|j| {
        (0..=(columns - 1) * PIECES).map(|i| place(share(i), j as f32)).collect::<Vec<_>>()
    });
    let upright = (0..columns)
        .map(|i| (0..=(rows - 1) * PIECES).map(|j| place(i as f32, share(j))).collect::<Vec<_>>());
    for line in level.chain(upright) {
        painter.add(Shape::line(line.clone(), Stroke::new(2.4, Color32::from_black_alpha(100))));
        painter.add(Shape::line(line, Stroke::new(1.0, Color32::from_rgb(120, 200, 255))));
    }
}
