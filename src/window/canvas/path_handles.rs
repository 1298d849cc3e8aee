//! The nodes and handles of the selected path, over the picture. Floor 7. Not here: what dragging
//! them does (`tools::path`).

use crate::document::LayerId;
use crate::math::Vec2;
use crate::paint::path::PathPlace;
use crate::paint::{Figure, LivePath};
use crate::session::actions::PathAction;
use crate::session::{Action, Session};
use crate::tools::ToolKind;
use crate::tools::path::{self, SelectedNode};
use eframe::egui::{self, Color32, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Ui, vec2};

/// Straight pieces of a curve on the screen.
const PIECES: usize = 24;

/// Dark beneath light, so that they are seen on any picture.
const LOOKS: [Stroke; 2] = [
    Stroke { width: 2.4, color: Color32::from_black_alpha(110) },
    Stroke { width: 1.1, color: Color32::from_rgb(120, 200, 255) },
];

/// Draws them for the tool in hand; `under`: the canvas point under the pointer.
pub fn draw(
    painter: &Painter,
    session: &Session,
    to_screen: &impl Fn(Vec2) -> Pos2,
    under: Option<Vec2>,
    tool: ToolKind,
) {
    let (Some(layer), Some(document)) = (session.layer(), session.shown_document()) else { return };
    let Some(image) = path::of_layer(layer) else { return };
    let Some(live) = image.source.path() else { return };
    let to_canvas = path::to_canvas(image, document.size);
    let on_screen = |p: Vec2| to_canvas(p).map(to_screen);
    match (tool, live.figure()) {
        (ToolKind::Figure, Some(figure)) => draw_figure(painter, figure, &on_screen),
        (ToolKind::Figure, None) => {}
        (ToolKind::Panels, _) => draw_outline(painter, live, &on_screen),
        _ => {
            let selected = session.tools.path_node.within(layer.id, live);
            draw_nodes(painter, live, selected, under.map(to_screen), &on_screen);
        }
    }
}

fn draw_line(painter: &Painter, points: Vec<Pos2>) {
    painter.extend(LOOKS.map(|look| Shape::line(points.clone(), look)));
}

/// The line of a path without its nodes.
fn draw_outline(painter: &Painter, live: &LivePath, on_screen: &impl Fn(Vec2) -> Option<Pos2>) {
    for line in live.flatten(Some) {
        draw_line(painter, line.points.into_iter().filter_map(on_screen).collect());
    }
}

fn draw_figure(painter: &Painter, figure: &Figure, on_screen: &impl Fn(Vec2) -> Option<Pos2>) {
    let handles: Option<Vec<Pos2>> = figure.handles().into_iter().map(on_screen).collect();
    let Some(handles) = handles else { return };
    let corners = &handles[..handles.len().min(figure.box_handles().len())];
    draw_line(painter, corners.iter().chain(&corners[..1]).copied().collect());
    handles.iter().for_each(|at| draw_square(painter, *at, false));
    if let Some(at) = on_screen(figure.center()) {
        for look in LOOKS {
            for arm in [vec2(5.0, 0.0), vec2(0.0, 5.0)] {
                painter.line_segment([at - arm, at + arm], look);
            }
        }
    }
}

fn draw_nodes(
    painter: &Painter,
    path: &LivePath,
    selected: SelectedNode,
    under: Option<Pos2>,
    on_screen: &impl Fn(Vec2) -> Option<Pos2>,
) {
    let lines = path.subpaths();
    for line in lines.iter() {
        for [a, b, c, d] in line.curves() {
            let point = |i: usize| {
                let (t, s) = (i as f32 / PIECES as f32, 1.0 - i as f32 / PIECES as f32);
                on_screen(a * s * s * s + 3.0 * s * s * t * b + 3.0 * s * t * t * c + d * t * t * t)
            };
            draw_line(painter, (0..=PIECES).filter_map(point).collect());
        }
    }
    // From the end of the line that clicks continue to the pointer.
    let end = selected.line.and_then(|line| lines[line].nodes.last());
    if let (Some(at), Some(under)) = (end.and_then(|node| on_screen(node.at)), under) {
        let dashes = Stroke::new(1.0, Color32::from_white_alpha(190));
        painter.line_segment([at, under], Stroke::new(2.0, Color32::from_black_alpha(80)));
        painter.extend(Shape::dashed_line(&[at, under], dashes, 5.0, 4.0));
    }
    for (i, line) in lines.iter().enumerate() {
        for (j, node) in line.nodes.iter().enumerate() {
            let Some(at) = on_screen(node.at) else { continue };
            let is_selected = selected.node == Some(PathPlace { line: i, node: j });
            for by in [node.before, node.after] {
                let end = on_screen(node.at + by).filter(|_| is_selected && by != Vec2::ZERO);
                if let Some(end) = end {
                    draw_line(painter, vec![at, end]);
                    painter.circle(end, 3.6, Color32::WHITE, Stroke::new(1.2, LOOKS[0].color));
                }
            }
            draw_square(painter, at, is_selected);
        }
    }
}

/// A node, filled if it is selected.
fn draw_square(painter: &Painter, at: Pos2, is_selected: bool) {
    let rect = Rect::from_center_size(at, vec2(7.0, 7.0));
    let fill = if is_selected { LOOKS[1].color } else { Color32::WHITE };
    painter.rect_filled(rect.expand(1.0), 0.0, Color32::from_black_alpha(140));
    painter.rect_filled(rect, 0.0, fill);
    painter.rect_stroke(rect, 0.0, Stroke::new(1.0, Color32::from_gray(40)), StrokeKind::Inside);
}

/// Enter and Escape end the line that clicks continue, Backspace takes the last node away.
pub fn keys(ui: &Ui, session: &Session, actions: &mut Vec<Action>) {
    if session.tool != ToolKind::Path
        || session.is_drawing()
        || ui.ctx().egui_wants_keyboard_input()
    {
        return;
    }
    let selected = selected_node(session);
    let is_pressed = |key| ui.input(|input: &egui::InputState| input.key_pressed(key));
    if selected.is_some_and(|(_, selected)| selected.line.is_some())
        && (is_pressed(egui::Key::Enter) || is_pressed(egui::Key::Escape))
    {
        actions.push(Action::Path(PathAction::End {}));
    } else if selected.is_some() && is_pressed(egui::Key::Backspace) {
        actions.push(Action::Path(PathAction::Back {}));
    }
}

/// What is selected of the path of the selected layer.
fn selected_node(session: &Session) -> Option<(LayerId, SelectedNode)> {
    let layer = session.layer()?;
    let live = path::of_layer(layer)?.source.path()?;
    Some((layer.id, session.tools.path_node.within(layer.id, live)))
}
