//! The view: position, zoom and rotation of the canvas under the window. Screen points are measured
//! from the middle of the canvas's area of the window, y down; canvas px as everywhere else.
//! Floor 6. Pure arithmetic; the window draws with it.

use super::replay::record;
use crate::math::{Affine2, Mat2, Size, Vec2, vec2};

/// The view of the canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CanvasView {
    /// The canvas point in the middle of the window, px.
    pub center: Vec2,
    /// Screen points per canvas pixel.
    pub zoom: f32,
    /// Rotation of the canvas, clockwise as seen, radians.
    pub turn_rad: f32,
    /// Mirrors the display left to right; the document does not change.
    pub mirrored: bool,
}
record!(CanvasView { center, zoom, turn_rad, mirrored });

/// The range of zooms: from a canvas of a few points to pixels of 64 points.
pub const ZOOMS: [f32; 2] = [0.01, 64.0];

impl CanvasView {
    /// The whole canvas, in the middle of a window.
    pub fn fitting(canvas: Size, window_pt: Vec2) -> Self {
        let side = vec2(canvas.width as f32, canvas.height as f32);
        let zoom = (window_pt / side).min_element() * 0.94;
        Self { center: canvas.center(), zoom: clamp_zoom(zoom), turn_rad: 0.0, mirrored: false }
    }

    /// Screen points from canvas px.
    pub fn screen_from_canvas(&self) -> Affine2 {
        let mirror = Mat2::from_diagonal(vec2(if self.mirrored { -1.0 } else { 1.0 }, 1.0));
        let matrix = mirror * Mat2::from_angle(self.turn_rad) * self.zoom;
        Affine2::from_mat2(matrix) * Affine2::from_translation(-self.center)
    }

    /// Canvas px from screen points.
    pub fn canvas_from_screen(&self) -> Affine2 {
        self.screen_from_canvas().inverse()
    }

    /// Zoomed about a screen point, which stays fixed on the canvas.
    pub fn zoomed(&self, factor: f32, about: Vec2) -> Self {
        let zoom = clamp_zoom(self.zoom * factor);
        let still = self.canvas_from_screen().transform_point2(about);
        Self { zoom, center: still + (self.center - still) * (self.zoom / zoom), ..*self }
    }

    /// Moved by screen points, as by dragging.
    pub fn panned(&self, by: Vec2) -> Self {
        let inverse = self.canvas_from_screen();
        Self { center: self.center - inverse.transform_vector2(by), ..*self }
    }

    /// Turned about the middle of the window, clockwise as seen.
    pub fn turned(&self, by_rad: f32) -> Self {
        let by = if self.mirrored { -by_rad } else { by_rad };
        let turn = (self.turn_rad + by).rem_euclid(std::f32::consts::TAU);
        // Almost upright snaps to upright, so that pixels are shown unrotated.
        let upright = (std::f32::consts::TAU - turn).min(turn) < 1e-4;
        Self { turn_rad: if upright { 0.0 } else { turn }, ..*self }
    }
}

fn clamp_zoom(zoom: f32) -> f32 {
    zoom.max(ZOOMS[0]).min(ZOOMS[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zooming_leaves_the_point_under_the_cursor_where_it_is() {
        let view =
            CanvasView { center: vec2(300.0, 200.0), zoom: 1.5, turn_rad: 0.7, mirrored: true };
        let about = vec2(-120.0, 45.0);
        let before = view.canvas_from_screen().transform_point2(about);
        let after = view.zoomed(3.0, about).canvas_from_screen().transform_point2(about);
        assert!(before.distance(after) < 1e-3);
    }

    #[test]
    fn panning_moves_the_canvas_with_the_hand() {
        let view =
            CanvasView { center: vec2(300.0, 200.0), zoom: 2.0, turn_rad: 0.4, mirrored: false };
        let by = vec2(30.0, -8.0);
        let held = vec2(310.0, 190.0);
        let before = view.screen_from_canvas().transform_point2(held);
        let after = view.panned(by).screen_from_canvas().transform_point2(held);
        assert!((after - before).distance(by) < 1e-3);
    }

    #[test]
    fn a_mirrored_view_turns_the_way_it_is_asked() {
        let view = CanvasView { center: Vec2::ZERO, zoom: 1.0, turn_rad: 0.0, mirrored: true };
        let turned = view.turned(0.1).screen_from_canvas().transform_vector2(vec2(0.0, -1.0));
        assert!(turned.x > 0.0, "clockwise as seen: what was up leans right");
    }

    #[test]
    fn the_fitted_view_shows_every_corner() {
        let view = CanvasView::fitting(Size::new(4000, 100), vec2(800.0, 600.0));
        let corner = view.screen_from_canvas().transform_point2(vec2(4000.0, 100.0));
        assert!(corner.x <= 400.0 && corner.y <= 300.0);
    }
}
