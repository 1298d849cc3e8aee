//! A curve widget: points in a square with straight lines between them. Floor 7. Not here: what the
//! curve drives (the brush editor).

use crate::language::tr;
use crate::math::{Vec2, vec2};
use crate::paint::Curve;
use crate::paint::dynamics::{MAX_POINTS, MOST_ADDED};
use crate::theme::ACCENT;
use crate::widgets::{ValueChange, set_accessible_name};
use eframe::egui::{self, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, pos2};

/// The distance within which the pointer grabs a point, screen points.
const NEAR_PT: f32 = 12.0;
/// The least distance between two points, in the unit square.
const APART: f32 = 0.01;

/// How far the square of a curve that adds extends beyond its values, so that the user can make it
/// add more.
const ROOM: f32 = 1.25;

/// A curve's points in the square, as the user moves them: a share is shown as it is; for one that
/// adds, the middle is 0 and the edges are ± `span`.
pub fn points(curve: &Curve, span: f32) -> Vec<Vec2> {
    match curve {
        Curve::Share(_) => vec![vec2(0.0, curve.at(0.0)), vec2(1.0, curve.at(1.0))],
        Curve::Points(points) => points.to_vec(),
        Curve::Added(points) => points.iter().map(|p| vec2(p.x, 0.5 + 0.5 * p.y / span)).collect(),
    }
}

/// The curve through points of the square, of the kind of another.
fn curve_through(like: &Curve, points: Vec<Vec2>, span: f32) -> Option<Curve> {
    if like.is_additive() {
        Curve::additive(points.iter().map(|p| vec2(p.x, (2.0 * p.y - 1.0) * span)).collect())
    } else {
        Curve::through(points)
    }
}

/// The extent of the square of a curve.
fn span_of(curve: &Curve) -> f32 {
    let Curve::Added(points) = curve else { return 1.0 };
    let most = points.iter().map(|p| p.y.abs()).fold(0.0, f32::max);
    (ROOM * if most > 0.0 { most } else { 1.0 }).min(MOST_ADDED)
}

/// Shows a curve and bends it: a click adds a point, a drag moves one, a right click removes one.
pub fn show(ui: &mut Ui, label: &str, curve: &Curve, height_pt: f32) -> Option<ValueChange<Curve>> {
    // The square keeps its extent during a drag.
    let spanned = ui.scope_id().with((label, "span"));
    let is_held = ui.input(|i| i.pointer.any_down());
    let span = ui.data(|data| data.get_temp::<f32>(spanned)).filter(|_| is_held);
    let span = span.unwrap_or_else(|| span_of(curve));
    ui.data_mut(|data| data.insert_temp(spanned, span));
    let square = CurveSquare {
        label,
        height_pt,
        most: MAX_POINTS,
        least: 1,
        behind: &|_, _| {},
        line: &|points| points.to_vec(),
    };
    let changed = square.show(ui, points(curve, span))?;
    curve_through(curve, changed.to, span).map(|to| ValueChange { to, done: changed.done })
}

/// A square in which points are added, moved and removed.
pub struct CurveSquare<'a> {
    pub label: &'a str,
    pub height_pt: f32,
    /// Points that there may be.
    pub least: usize,
    pub most: usize,
    /// Paints what lies behind the curve.
    pub behind: &'a dyn Fn(&egui::Painter, Rect),
    /// The line through the points, level beyond its ends.
    pub line: &'a dyn Fn(&[Vec2]) -> Vec<Vec2>,
}

impl CurveSquare<'_> {
    /// Shows points of the unit square, in rising order; the changed ones.
    pub fn show(&self, ui: &mut Ui, mut points: Vec<Vec2>) -> Option<ValueChange<Vec<Vec2>>> {
        let size = egui::vec2(ui.available_width(), self.height_pt);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        set_accessible_name(&response, tr(self.label));
        let inner = rect.shrink(5.0);
        let on_screen = |p: Vec2| {
            pos2(inner.left() + p.x * inner.width(), inner.bottom() - p.y * inner.height())
        };
        let in_square = |p: Pos2| {
            let p =
                vec2((p.x - inner.left()) / inner.width(), (inner.bottom() - p.y) / inner.height());
            p.max(Vec2::ZERO).min(Vec2::ONE)
        };
        self.paint(ui, rect, inner, &points, on_screen);
        let held = response.id.with("held");
        let nearest = |at: Pos2, points: &[Vec2]| {
            let distances = points.iter().map(|p| on_screen(*p).distance(at));
            let (i, distance) = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
            (distance < NEAR_PT).then_some(i)
        };
        let at = response.interact_pointer_pos();
        if response.secondary_clicked() {
            let can = points.len() > self.least;
            let gone = at.and_then(|at| nearest(at, &points)).filter(|_| can)?;
            points.remove(gone);
            return Some(ValueChange { to: points, done: true });
        }
        if response.drag_stopped() {
            return Some(ValueChange { to: points, done: true });
        }
        if response.drag_started() || response.clicked() {
            let at = ui.input(|i| i.pointer.press_origin()).or(at)?;
            let i = nearest(at, &points).or_else(|| add(&mut points, in_square(at), self.most));
            ui.data_mut(|data| data.insert_temp(held, i));
        }
        let moves = response.dragged() || response.clicked();
        let i = ui
            .data(|data| data.get_temp::<Option<usize>>(held))
            .flatten()
            .filter(|i| moves && *i < points.len())?;
        let to = in_square(at?);
        // A point stays between its neighbors.
        let least = i.checked_sub(1).map_or(0.0, |before| points[before].x + self.least_distance());
        let most = points.get(i + 1).map_or(1.0, |after| after.x - self.least_distance());
        points[i] = vec2(to.x.min(most).max(least), to.y);
        Some(ValueChange { to: points, done: response.clicked() })
    }

    /// How far points stay from each other: those of tones by a byte, so that none is lost.
    fn least_distance(&self) -> f32 {
        if self.least > 1 { APART } else { 0.0 }
    }

    fn paint(
        &self,
        ui: &Ui,
        rect: Rect,
        inner: Rect,
        points: &[Vec2],
        on_screen: impl Fn(Vec2) -> Pos2,
    ) {
        let painter = ui.painter();
        let visuals = ui.visuals();
        let rim = visuals.widgets.noninteractive.bg_stroke;
        painter.rect(rect, 3.0, visuals.extreme_bg_color, rim, StrokeKind::Inside);
        (self.behind)(painter, inner);
        let faint = Stroke::new(1.0, rim.color);
        for quarter in [0.25, 0.5, 0.75] {
            painter.vline(inner.left() + quarter * inner.width(), inner.y_range(), faint);
            painter.hline(inner.x_range(), inner.top() + quarter * inner.height(), faint);
        }
        let line = (self.line)(points);
        // Level beyond the first and the last.
        let first = line.first().map(|p| vec2(0.0, p.y));
        let last = line.last().map(|p| vec2(1.0, p.y));
        let line: Vec<Pos2> =
            first.into_iter().chain(line.iter().copied()).chain(last).map(&on_screen).collect();
        painter.line(line, Stroke::new(1.5, ACCENT));
        for point in points {
            painter.circle(on_screen(*point), 3.5, visuals.window_fill, Stroke::new(1.5, ACCENT));
        }
    }
}

/// Adds a point in its place; returns its index.
fn add(points: &mut Vec<Vec2>, point: Vec2, most: usize) -> Option<usize> {
    let is_taken = points.iter().any(|p| (p.x - point.x).abs() < APART);
    if is_taken || points.len() >= most {
        return None;
    }
    let i = points.partition_point(|p| p.x < point.x);
    points.insert(i, point);
    Some(i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_added_in_its_place_and_never_above_another() {
        let mut line = points(&Curve::Share(1.0), 1.0);
        assert_eq!(line, [vec2(0.0, 0.0), vec2(1.0, 1.0)]);
        assert_eq!(add(&mut line, vec2(0.4, 0.9), 9), Some(1));
        assert_eq!(add(&mut line, vec2(0.405, 0.1), 9), None);
        assert!(Curve::through(line).is_some());
    }

    #[test]
    fn a_curve_that_adds_stands_in_the_square_around_its_middle_and_comes_back() {
        let curve = Curve::additive(vec![vec2(0.0, -2.0), vec2(1.0, 4.0)]).unwrap();
        let span = span_of(&curve);
        assert_eq!((span, points(&curve, span)), (5.0, vec![vec2(0.0, 0.3), vec2(1.0, 0.9)]));
        let Some(Curve::Added(back)) = curve_through(&curve, points(&curve, span), span) else {
            panic!("it adds")
        };
        assert!(back.iter().zip([-2.0f32, 4.0]).all(|(p, y)| (p.y - y).abs() < 1e-5), "{back:?}");
    }
}
