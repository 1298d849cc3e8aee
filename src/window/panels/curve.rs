//! A curve widget: points in a square with straight lines between them. Floor 7. The brush editor decides what the
//! curve drives.

use crate::math::{Vec2, vec2};
use crate::paint::Curve;
use crate::paint::dynamics::MAX_POINTS;
use crate::theme::ACCENT;
use crate::widgets::named;
use eframe::egui::{self, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, pos2};

/// The distance within which the pointer grabs a point, screen points.
const NEAR_PT: f32 = 12.0;
/// The least distance between two points, in the unit square.
const APART: f32 = 0.01;

/// The points of a curve for editing: a share becomes its line.
pub fn points(curve: &Curve) -> Vec<Vec2> {
    match curve {
        Curve::Share(_) => vec![vec2(0.0, curve.at(0.0)), vec2(1.0, curve.at(1.0))],
        Curve::Points(points) => points.to_vec(),
    }
}

/// Shows a curve and edits it: a click adds a point, a drag moves one, a right click removes one.
pub fn show(ui: &mut Ui, label: &str, curve: &Curve, height_pt: f32) -> Option<Curve> {
    let (rect, response) = ui.allocate_exact_size(egui::vec2(ui.available_width(), height_pt), Sense::click_and_drag());
    named(&response, label);
    let inner = rect.shrink(5.0);
    let on_screen = |p: Vec2| pos2(inner.left() + p.x * inner.width(), inner.bottom() - p.y * inner.height());
    let in_square = |p: Pos2| {
        let p = vec2((p.x - inner.left()) / inner.width(), (inner.bottom() - p.y) / inner.height());
        p.max(Vec2::ZERO).min(Vec2::ONE)
    };
    let mut points = points(curve);
    paint(ui, rect, inner, &points, on_screen);
    let held = response.id.with("held");
    let nearest = |at: Pos2, points: &[Vec2]| {
        let distances = points.iter().map(|p| on_screen(*p).distance(at));
        let (i, distance) = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        (distance < NEAR_PT).then_some(i)
    };
    let at = response.interact_pointer_pos();
    if response.secondary_clicked() {
        let gone = at.and_then(|at| nearest(at, &points)).filter(|_| points.len() > 1)?;
        points.remove(gone);
        return Curve::through(points);
    }
    if response.drag_started() || response.clicked() {
        let at = ui.input(|i| i.pointer.press_origin()).or(at)?;
        let i = nearest(at, &points).or_else(|| add(&mut points, in_square(at)));
        ui.data_mut(|data| data.insert_temp(held, i));
    }
    let moves = response.dragged() || response.clicked();
    let i = ui.data(|data| data.get_temp::<Option<usize>>(held)).flatten().filter(|i| moves && *i < points.len())?;
    let to = in_square(at?);
    // A point stays between its neighbours.
    let least = i.checked_sub(1).map_or(0.0, |before| points[before].x);
    let most = points.get(i + 1).map_or(1.0, |after| after.x);
    points[i] = vec2(to.x.max(least).min(most), to.y);
    Curve::through(points)
}

/// Adds a point in its place; returns its index.
fn add(points: &mut Vec<Vec2>, point: Vec2) -> Option<usize> {
    let is_taken = points.iter().any(|p| (p.x - point.x).abs() < APART);
    if is_taken || points.len() >= MAX_POINTS {
        return None;
    }
    let i = points.partition_point(|p| p.x < point.x);
    points.insert(i, point);
    Some(i)
}

fn paint(ui: &Ui, rect: Rect, inner: Rect, points: &[Vec2], on_screen: impl Fn(Vec2) -> Pos2) {
    let painter = ui.painter();
    let visuals = ui.visuals();
    painter.rect(rect, 3.0, visuals.extreme_bg_color, visuals.widgets.noninteractive.bg_stroke, StrokeKind::Inside);
    let faint = Stroke::new(1.0, visuals.widgets.noninteractive.bg_stroke.color);
    for quarter in [0.25, 0.5, 0.75] {
        painter.vline(inner.left() + quarter * inner.width(), inner.y_range(), faint);
        painter.hline(inner.x_range(), inner.top() + quarter * inner.height(), faint);
    }
    // Level beyond the first and the last.
    let first = points.first().map(|p| vec2(0.0, p.y));
    let last = points.last().map(|p| vec2(1.0, p.y));
    let line: Vec<Pos2> = first.into_iter().chain(points.iter().copied()).chain(last).map(&on_screen).collect();
    painter.line(line, Stroke::new(1.5, ACCENT));
    for point in points {
        painter.circle(on_screen(*point), 3.5, visuals.window_fill, Stroke::new(1.5, ACCENT));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_added_in_its_place_and_never_above_another() {
        let mut line = points(&Curve::Share(1.0));
        assert_eq!(line, [vec2(0.0, 0.0), vec2(1.0, 1.0)]);
        assert_eq!(add(&mut line, vec2(0.4, 0.9)), Some(1));
        assert_eq!(add(&mut line, vec2(0.405, 0.1)), None);
        assert!(Curve::through(line).is_some());
    }
}
