//! The loupe while a color is taken: the pixels around the pen enlarged, in a ring whose upper half is
//! the new color and whose lower half is the one before. Floor 7. Not here: taking the color
//! (`tools::eyedropper`).

use crate::math::{Vec2, srgb::Color};
use crate::raster::TileGrid;
use crate::raster::grid::unpremultiply;
use crate::theme::{CHECKER, color32};
use eframe::egui::{
    Color32, Id, LayerId, Mesh, Order, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Ui, vec2,
};
use std::f32::consts::PI;

/// The side of an enlarged pixel, points.
const PIXEL_PT: f32 = 9.0;
/// Pixels from the middle one to the rim.
const AROUND: i32 = 6;
/// The middle of the ring, and its width, points.
const RADIUS_PT: f32 = 62.0;
const RING_PT: f32 = 14.0;
/// Corners of half a ring.
const CORNERS: usize = 32;

/// The two colors of the ring.
#[derive(Clone, Copy)]
pub struct LoupeColors {
    pub new: Color,
    pub before: Color,
}

/// Draws it around a place of the screen, above everything.
///
/// * `pixel`: the canvas point under that place.
pub fn draw(ui: &Ui, at: Pos2, pixel: Vec2, grid: &TileGrid, colors: LoupeColors) {
    let layer = LayerId::new(Order::Tooltip, Id::unique("loupe"));
    let painter = Painter::new(ui.ctx().clone(), layer, ui.clip_rect());
    painter.add(Shape::mesh(pixel_mesh(at, pixel, grid)));
    // Upper half, then lower half; y points down.
    for (color, from) in [(colors.new, PI), (colors.before, 0.0)] {
        painter.add(Shape::line(arc(at, from), Stroke::new(RING_PT, color32(color))));
    }
    for (radius, gray) in [(0.5 * RING_PT, 0x18), (-0.5 * RING_PT, 0xf0)] {
        let rim = Stroke::new(1.0, Color32::from_gray(gray));
        painter.circle_stroke(at, RADIUS_PT + radius, rim);
    }
    let middle = Rect::from_center_size(at, vec2(PIXEL_PT, PIXEL_PT));
    for (rect, gray) in [(middle, 0xf0), (middle.expand(1.0), 0x18)] {
        let rim = Stroke::new(1.0, Color32::from_gray(gray));
        painter.rect_stroke(rect, 0.0, rim, StrokeKind::Outside);
    }
}

/// Half a circle, clockwise from an angle.
fn arc(at: Pos2, from: f32) -> Vec<Pos2> {
    let place = |i: usize| {
        let angle = from + PI * i as f32 / CORNERS as f32;
        at + RADIUS_PT * vec2(angle.cos(), angle.sin())
    };
    (0..=CORNERS).map(place).collect()
}

/// The pixels within the ring as squares.
fn pixel_mesh(at: Pos2, pixel: Vec2, grid: &TileGrid) -> Mesh {
    let mut mesh = Mesh::default();
    let (x, y) = (pixel.x.floor() as i32, pixel.y.floor() as i32);
    for dy in -AROUND..=AROUND {
        for dx in -AROUND..=AROUND {
            let middle = at + PIXEL_PT * vec2(dx as f32, dy as f32);
            if middle.distance(at) < RADIUS_PT {
                let square = Rect::from_center_size(middle, vec2(PIXEL_PT, PIXEL_PT));
                let (x, y) = (x.saturating_add(dx), y.saturating_add(dy));
                mesh.add_colored_rect(
                    square,
                    compose_over_checker(grid.pixel(x, y), (x ^ y) & 1 == 0),
                );
            }
        }
    }
    mesh
}

/// A premultiplied pixel over a square of the checkerboard.
fn compose_over_checker(pixel: [u8; 4], is_light: bool) -> Color32 {
    let mut straight = [0; 4];
    unpremultiply(&pixel, &mut straight);
    let ground = CHECKER[usize::from(!is_light)].r();
    let share = f32::from(pixel[3]) / 255.0;
    let mix = |v: u8| (f32::from(v) * share + f32::from(ground) * (1.0 - share)).round() as u8;
    let [r, g, b, _] = straight;
    let shown = color32(Color::rgb(r, g, b));
    Color32::from_rgb(mix(shown.r()), mix(shown.g()), mix(shown.b()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_covers_the_checkerboard_by_its_alpha() {
        let [light, dark] = CHECKER;
        assert_eq!(compose_over_checker([0; 4], true), light);
        assert_eq!(compose_over_checker([0; 4], false), dark);
        assert_eq!(compose_over_checker([9, 80, 200, 255], true), Color32::from_rgb(9, 80, 200));
        let half = compose_over_checker([0, 0, 0, 128], true).r();
        assert!(half.abs_diff(light.r() / 2) <= 1, "{half}");
    }

    #[test]
    fn the_middle_square_is_the_pixel_under_the_pen_and_none_lies_outside_the_ring() {
        let mesh = pixel_mesh(Pos2::ZERO, Vec2::new(3.7, 2.2), &TileGrid::default());
        let farthest = mesh.vertices.iter().map(|v| v.pos.to_vec2().length()).fold(0.0, f32::max);
        assert!(farthest < RADIUS_PT + 0.5 * RING_PT, "{farthest}");
        let is_under = |rect: &[eframe::egui::epaint::Vertex]| {
            Rect::from_two_pos(rect[0].pos, rect[3].pos).contains(Pos2::ZERO)
        };
        assert_eq!(mesh.vertices.chunks(4).filter(|rect| is_under(rect)).count(), 1);
    }
}
