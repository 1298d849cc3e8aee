//! Assistants over the picture: their lines and, with the tool, their handles and those of the
//! symmetry's axes. Floor 7. Not here: strokes along them (`tools::assistants`).

use crate::document::Symmetry;
use crate::document::{Assistant, AssistantKind};
use crate::math::{Vec2, vec2};
use crate::session::Session;
use eframe::egui::{Color32, Painter, Pos2, Shape, Stroke};

const LINE: Color32 = Color32::from_rgb(240, 120, 60);
/// Rays that show a vanishing point.
const RAYS: u32 = 24;
/// Segments of an ellipse.
const SEGMENTS: u32 = 96;

/// Draws them, faintly while another tool is current.
pub fn draw(
    painter: &Painter,
    session: &Session,
    to_screen: &impl Fn(Vec2) -> Pos2,
    is_tool: bool,
) {
    let Some(document) = session.shown_document() else { return };
    // Far enough that its ends are out of sight.
    let reach = 4.0 * document.size.center().length();
    let alpha = if is_tool { 200 } else { 90 };
    let look =
        Stroke::new(1.2, Color32::from_rgba_unmultiplied(LINE.r(), LINE.g(), LINE.b(), alpha));
    let faint =
        Stroke::new(1.0, Color32::from_rgba_unmultiplied(LINE.r(), LINE.g(), LINE.b(), alpha / 4));
    for assistant in document.assistants.iter() {
        for [from, to] in lines(assistant, document.size.center(), reach) {
            painter.line_segment([to_screen(from), to_screen(to)], faint);
        }
        painter.add(Shape::line(outline(assistant).into_iter().map(to_screen).collect(), look));
    }
    if !is_tool {
        return;
    }
    let handles = document.assistants.iter().flat_map(|assistant| assistant.points.iter().copied());
    let zoom = session.active().and_then(|open| open.view).map_or(1.0, |view| view.zoom);
    let axes = session.symmetry().axes.handles(document.size, 1.0 / zoom);
    let axes = axes.into_iter().filter(|_| session.symmetry().kind != Symmetry::None);
    for at in handles.chain(axes).map(to_screen) {
        painter.circle_filled(at, 6.0, Color32::from_black_alpha(140));
        painter.circle_filled(at, 4.5, Color32::WHITE);
        painter.circle_stroke(at, 4.5, Stroke::new(1.4, LINE));
    }
}

/// The line from handle to handle, or the ellipse.
fn outline(assistant: &Assistant) -> Vec<Vec2> {
    match assistant.ellipse() {
        Some(ellipse) => {
            let at = |i: u32| Vec2::from_angle(std::f32::consts::TAU * i as f32 / SEGMENTS as f32);
            let point =
                |i: u32| ellipse.center + ellipse.axes[0] * at(i).x + ellipse.axes[1] * at(i).y;
            (0..=SEGMENTS).map(point).collect()
        }
        None => assistant.points.clone(),
    }
}

/// Some of the lines that strokes can take.
fn lines(assistant: &Assistant, middle: Vec2, reach: f32) -> Vec<[Vec2; 2]> {
    let through = |at: Vec2, along: Vec2| [at - along * reach, at + along * reach];
    match (assistant.kind, &assistant.points[..]) {
        (AssistantKind::Line, [a, b]) => {
            (*b - *a).try_normalize().map(|along| through(*a, along)).into_iter().collect()
        }
        (AssistantKind::Parallel, [a, b]) => {
            let along = (*b - *a).normalize_or(Vec2::X);
            (-4..=4)
                .map(|i| through(middle + along.perp() * (i as f32 * 0.05 * reach), along))
                .collect()
        }
        (AssistantKind::OnePoint | AssistantKind::TwoPoint | AssistantKind::ThreePoint, points) => {
            let ray = |v: Vec2| {
                (0..RAYS).map(move |i| (v, std::f32::consts::TAU * i as f32 / RAYS as f32))
            };
            let far = |v: Vec2| reach + v.distance(middle);
            let end = |(v, angle): (Vec2, f32)| [v, v + vec2(angle.cos(), angle.sin()) * far(v)];
            points.iter().flat_map(|v| ray(*v)).map(end).collect()
        }
        _ => Vec::new(),
    }
}
