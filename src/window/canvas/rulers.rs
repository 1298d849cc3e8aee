//! Rulers along the upper and the left edge of the view: they show canvas px, and guides are pulled
//! out of them. Floor 7. Not here: the guides themselves (the session).

use crate::math::{Affine2, Vec2, vec2};
use crate::session::{CanvasView, Session};
use eframe::egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, Ui, pos2};

/// The width of a ruler, points.
pub const RULER_PT: f32 = 18.0;
/// The least distance of labels, and of short marks.
const LABELS_PT: f32 = 56.0;
const MARKS_PT: f32 = 6.0;

/// The room of rulers at the upper and the left edge, points; they measure the picture, not the
/// unwrapped sheet.
pub fn room_pt(session: &Session) -> f32 {
    let is_picture = session.active().is_some_and(|open| open.unwrap_settings().is_none());
    if session.tools.aids.rulers && is_picture { RULER_PT } else { 0.0 }
}

/// Whether a point of the window lies on a ruler at the canvas's area.
pub fn is_on(area: Rect, session: &Session, at: Pos2) -> bool {
    let room = room_pt(session);
    let whole = Rect::from_min_max(area.min - eframe::egui::Vec2::splat(room), area.max);
    whole.contains(at) && !area.contains(at)
}

/// Whether a guide that is pulled out at a point of a ruler is upright on the canvas.
pub fn is_upright_pull(area: Rect, view: &CanvasView, at: Pos2) -> bool {
    // The upper ruler's guides are level as seen.
    let is_upper = at.y < area.top() && at.x >= area.left();
    is_upper != (axis_along(view) == Some(0) || axis_along(view).is_none())
}

/// The axis of the canvas that runs along the upper ruler: 0 for x, 1 for y; none in a turned view.
fn axis_along(view: &CanvasView) -> Option<usize> {
    let (sin, cos) = view.turn_rad.sin_cos();
    if sin.abs() < 1e-3 {
        Some(0)
    } else if cos.abs() < 1e-3 {
        Some(1)
    } else {
        None
    }
}

/// The distance between labels, canvas px: 1, 2 or 5 times a power of ten.
fn step_px(zoom: f32, least_pt: f32) -> f32 {
    let least = (least_pt / zoom.max(1e-6)).max(1.0);
    let power = 10f32.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|k| k * power)
        .into_iter()
        .find(|step| *step >= least)
        .unwrap_or(10.0 * power)
}

/// Draws both at the edges of the canvas's area; `under`: the canvas point under the pointer.
pub fn draw(
    ui: &Ui,
    session: &Session,
    area: Rect,
    screen_from_canvas: Affine2,
    under: Option<Vec2>,
) {
    let Some(view) = session.active().and_then(|open| open.view).filter(|_| room_pt(session) > 0.0)
    else {
        return;
    };
    let upper = Rect::from_min_max(pos2(area.left(), area.top() - RULER_PT), area.right_top());
    let left = Rect::from_min_max(pos2(area.left() - RULER_PT, area.top()), area.left_bottom());
    let corner = Rect::from_min_max(pos2(left.left(), upper.top()), area.left_top());
    for strip in [upper, left, corner] {
        ui.painter().rect_filled(strip, 0.0, ui.visuals().faint_bg_color);
    }
    let edge = Stroke::new(1.0, ui.visuals().weak_text_color().gamma_multiply(0.5));
    ui.painter().hline(upper.x_range(), upper.bottom(), edge);
    ui.painter().vline(left.right(), left.y_range(), edge);
    // In a turned view no axis runs along the edges.
    let Some(axis) = axis_along(&view) else { return };
    for (is_upper, strip, axis) in [(true, upper, axis), (false, left, 1 - axis)] {
        marks(ui, strip, is_upper, axis, &view, screen_from_canvas);
        let Some(at) = under.map(|at| screen_from_canvas.transform_point2(at)) else { continue };
        let look = Stroke::new(1.0, crate::theme::ACCENT);
        let painter = ui.painter_at(strip);
        if is_upper {
            painter.vline(at.x, strip.y_range(), look)
        } else {
            painter.hline(strip.x_range(), at.y, look)
        };
    }
}

/// The marks and numbers of one ruler.
fn marks(
    ui: &Ui,
    strip: Rect,
    is_upper: bool,
    axis: usize,
    view: &CanvasView,
    screen_from_canvas: Affine2,
) {
    let inverse = screen_from_canvas.inverse();
    let canvas_at = |p: Pos2| inverse.transform_point2(vec2(p.x, p.y))[axis];
    let ends = [strip.left_top(), if is_upper { strip.right_top() } else { strip.left_bottom() }];
    let [from, to] = ends.map(canvas_at);
    let long = if is_upper { strip.width() } else { strip.height() };
    let place = |at: f32| {
        (at - from) / (to - from) * long + if is_upper { strip.left() } else { strip.top() }
    };
    let painter = ui.painter_at(strip);
    let color = ui.visuals().weak_text_color();
    let label_px = step_px(view.zoom, LABELS_PT);
    let mark_px =
        [10.0, 5.0, 2.0].map(|k| label_px / k).into_iter().find(|px| px * view.zoom >= MARKS_PT);
    let line = |at: f32, high: f32, color: Color32| {
        let look = Stroke::new(1.0, color);
        if is_upper {
            painter.vline(place(at), strip.bottom() - high..=strip.bottom(), look);
        } else {
            painter.hline(strip.right() - high..=strip.right(), place(at), look);
        }
    };
    let each = |step: f32, draw: &dyn Fn(f32)| {
        let (low, high) = (from.min(to) / step, from.max(to) / step);
        if low.is_finite() && high - low < 10_000.0 {
            (low.floor() as i64..=high.ceil() as i64).for_each(|i| draw(i as f32 * step));
        }
    };
    if let Some(step) = mark_px {
        each(step, &|at| line(at, 4.0, color.gamma_multiply(0.6)));
    }
    each(label_px, &|at| {
        line(at, RULER_PT, color.gamma_multiply(0.6));
        let (number, font) = (format!("{at:.0}"), FontId::proportional(9.0));
        if is_upper {
            painter.text(pos2(place(at) + 2.0, strip.top()), Align2::LEFT_TOP, number, font, color);
        } else {
            // One digit under the other.
            for (i, digit) in number.chars().enumerate() {
                let at = pos2(strip.left() + 6.0, place(at) + 1.0 + 8.0 * i as f32);
                painter.text(at, Align2::CENTER_TOP, digit, font.clone(), color);
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_stand_at_round_numbers_and_never_too_close() {
        assert_eq!(
            [1.0, 0.1, 3.0, 64.0].map(|zoom| step_px(zoom, 56.0)),
            [100.0, 1000.0, 20.0, 1.0]
        );
        for zoom in [0.01, 0.07, 0.3, 1.7, 9.0, 33.0] {
            assert!(step_px(zoom, 56.0) * zoom >= 55.9, "{zoom}");
        }
    }

    #[test]
    fn guides_come_out_of_rulers_as_the_view_is_turned() {
        let area = Rect::from_min_max(pos2(100.0, 100.0), pos2(500.0, 400.0));
        let view = CanvasView { center: Vec2::ZERO, zoom: 1.0, turn_rad: 0.0, mirrored: false };
        let quarter = CanvasView { turn_rad: std::f32::consts::FRAC_PI_2, ..view };
        let (upper, left) = (pos2(300.0, 95.0), pos2(95.0, 300.0));
        assert_eq!([upper, left].map(|at| is_upright_pull(area, &view, at)), [false, true]);
        assert_eq!([upper, left].map(|at| is_upright_pull(area, &quarter, at)), [true, false]);
    }
}
