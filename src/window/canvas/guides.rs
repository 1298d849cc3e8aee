//! Guides, the grid, and the lines that what is dragged snapped to, over the picture. Floor 7. Not
//! here: what snaps (`tools::snap`).

use super::unwrapped::OnSheet;
use crate::math::{Rect, Vec2, vec2};
use crate::session::Session;
use eframe::egui::{Color32, Painter, Pos2, Shape, Stroke};

/// Lines closer than this are not drawn, points.
const CLOSEST_PT: f32 = 6.0;
const GUIDE: Color32 = Color32::from_rgb(40, 170, 240);
const SNAPPED: Color32 = Color32::from_rgb(255, 70, 190);

/// The document's guides on the unwrapped sheet.
pub fn draw_unwrapped(
    painter: &Painter,
    session: &Session,
    on_sheet: OnSheet,
    to_screen: &impl Fn(Vec2) -> Pos2,
) {
    let Some(document) = session.shown_document().filter(|_| session.tools.aids.guides) else {
        return;
    };
    let (w, h) = (document.size.width as f32, document.size.height as f32);
    let upright = document.guides.vertical.iter().map(|&x| [vec2(x, 0.0), vec2(x, h)]);
    let level = document.guides.horizontal.iter().map(|&y| [vec2(0.0, y), vec2(w, y)]);
    for [from, to] in upright.chain(level) {
        let pieces = on_sheet.line(from, to).map(|piece| piece.map(to_screen));
        painter.extend(pieces.map(|piece| Shape::line_segment(piece, Stroke::new(1.0, GUIDE))));
    }
}

/// `visible`: the canvas px in sight; `zoom`: points per canvas px.
pub fn draw(
    painter: &Painter,
    session: &Session,
    to_screen: &impl Fn(Vec2) -> Pos2,
    visible: Rect,
    zoom: f32,
) {
    let Some(document) = session.shown_document() else { return };
    let aids = &session.tools.aids;
    let low = vec2(visible.x0 as f32, visible.y0 as f32);
    let high = vec2(visible.x1 as f32, visible.y1 as f32);
    let upright = |x: f32| [to_screen(vec2(x, low.y)), to_screen(vec2(x, high.y))];
    let level = |y: f32| [to_screen(vec2(low.x, y)), to_screen(vec2(high.x, y))];
    if aids.grid_shown {
        let steps = [(aids.grid.step(), 28), (aids.grid.spacing, 62)];
        for (step, alpha) in steps.into_iter().filter(|(step, _)| step * zoom >= CLOSEST_PT) {
            let look = Stroke::new(1.0, Color32::from_rgba_unmultiplied(128, 128, 128, alpha));
            for (axis, lines) in [(0, &upright as &dyn Fn(f32) -> [Pos2; 2]), (1, &level)] {
                let from = ((low[axis] - aids.grid.offset[axis]) / step).ceil();
                let count = ((high[axis] - low[axis]) / step).ceil().min(5_000.0) as usize;
                let at = |i: usize| aids.grid.offset[axis] + (from + i as f32) * step;
                painter.extend((0..=count).map(|i| Shape::line_segment(lines(at(i)), look)));
            }
        }
    }
    if aids.guides {
        let look = Stroke::new(1.0, GUIDE);
        let all = document.guides.vertical.iter().map(|x| upright(*x));
        let all = all.chain(document.guides.horizontal.iter().map(|y| level(*y)));
        painter.extend(all.map(|line| Shape::line_segment(line, look)));
    }
    let snapped = session.snap_lines();
    let lines = snapped.x.map(upright).into_iter().chain(snapped.y.map(level));
    for line in lines {
        painter.line_segment(line, Stroke::new(3.0, Color32::from_black_alpha(70)));
        painter.extend(Shape::dashed_line(&line, Stroke::new(1.4, SNAPPED), 8.0, 5.0));
    }
}
