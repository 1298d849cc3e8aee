//! Overlays on the picture: the brush's bent footprint, anchors, a gradient's ends.
//! Floor 7.

mod held;
mod pieces;

use crate::document::Content;
use crate::math::{Affine2, Vec2};
use crate::paint::{BrushMode, RampStyle, Scene, Stroke as PaintStroke};
use crate::session::Session;
use crate::surface::unwrap::PlaneLayout;
use crate::theme::color32;
use crate::tools::unwrapped::is_moving_pieces;
use crate::tools::{ToolKind, anchors, outline};
use eframe::egui::{Color32, Painter, Pos2, Shape, Stroke, pos2, vec2};
use std::sync::Arc;

/// Draws the overlays of the current tool; `under`: the canvas point under the pointer.
pub fn draw(
    painter: &Painter,
    session: &Session,
    screen_from_canvas: Affine2,
    under: Option<Vec2>,
    tool: ToolKind,
) {
    let to_screen = |p: Vec2| {
        let p = screen_from_canvas.transform_point2(p);
        pos2(p.x, p.y)
    };
    if matches!(tool, ToolKind::Anchors | ToolKind::Gradient | ToolKind::Image) {
        handles(painter, session, &to_screen);
    }
    if matches!(tool, ToolKind::Brush | ToolKind::Eraser | ToolKind::Assistants) {
        axes(painter, session, &to_screen);
    }
    if tool == ToolKind::Transform {
        super::gizmo::draw(painter, session, &to_screen);
    }
    super::assistants::draw(painter, session, &to_screen, tool == ToolKind::Assistants);
    if tool == ToolKind::Crop {
        super::crop::draw(painter, session, &to_screen);
    }
    if matches!(tool, ToolKind::Path | ToolKind::Figure | ToolKind::Panels) {
        super::path_handles::draw(painter, session, &to_screen, under, tool);
    }
    if tool == ToolKind::Text {
        super::text_carets::draw(painter, session, &to_screen);
    }
    if tool == ToolKind::Strokes {
        draw_selected_strokes(painter, session, &to_screen);
    }
    if tool == ToolKind::Lasso && !session.tools.lasso.is_empty() {
        let line: Vec<Pos2> =
            session.tools.lasso.iter().copied().chain(under).map(to_screen).collect();
        painter.circle_filled(line[0], 4.0, Color32::from_black_alpha(160));
        painter.circle_filled(line[0], 2.6, Color32::WHITE);
        for stroke in
            [Stroke::new(2.4, Color32::from_black_alpha(130)), Stroke::new(1.1, Color32::WHITE)]
        {
            painter.add(Shape::line(line.clone(), stroke));
        }
    }
    if tool == ToolKind::Move {
        held::draw(painter, session, under, &to_screen);
    }
    let (Some(at), Some(document)) = (under, session.shown_document()) else { return };
    match tool {
        ToolKind::Brush | ToolKind::Eraser => {
            let radius = (0.5 * session.tools.brush.size).max(0.5);
            let reach_px = 2.0 * radius * session.tools.brush.reach;
            let lines = outline::outline(document, session.tools.operator, at, radius, reach_px);
            footprint(painter, lines, at, &to_screen);
            if tool == ToolKind::Brush {
                clone_source(painter, session, at, &to_screen);
            }
        }
        ToolKind::Liquify => {
            footprint(
                painter,
                outline::circle(at, 0.5 * session.tools.liquify.size),
                at,
                &to_screen,
            );
        }
        ToolKind::Eyedropper => draw_picked(painter, session, to_screen(at)),
        _ => {}
    }
}

/// The same over the sheet of the unwrapped surface, where dabs have the brush's own shape;
/// `under`: on the sheet.
pub fn draw_unwrapped(
    painter: &Painter,
    session: &Session,
    layout: &PlaneLayout,
    screen_from_sheet: Affine2,
    under: Option<Vec2>,
    tool: ToolKind,
) {
    let to_screen = |p: Vec2| {
        let p = screen_from_sheet.transform_point2(p);
        pos2(p.x, p.y)
    };
    if is_moving_pieces(tool) {
        let px_per_pt = 1.0 / screen_from_sheet.matrix2.x_axis.length().max(1e-6);
        pieces::draw(painter, session, layout, under, px_per_pt, &to_screen);
    }
    let Some(at) = under else { return };
    match tool {
        ToolKind::Brush | ToolKind::Eraser => {
            footprint(
                painter,
                outline::circle(at, (0.5 * session.tools.brush.size).max(0.5)),
                at,
                &to_screen,
            );
        }
        ToolKind::Eyedropper => draw_picked(painter, session, to_screen(at)),
        _ => {}
    }
}

/// The outline of a dab and its center.
fn footprint(
    painter: &Painter,
    lines: Vec<[Vec2; 2]>,
    at: Vec2,
    to_screen: &impl Fn(Vec2) -> Pos2,
) {
    let lines: Vec<[Pos2; 2]> = lines.into_iter().map(|line| line.map(to_screen)).collect();
    // Dark beneath light, so that it is visible on any picture.
    for stroke in [
        Stroke::new(2.4, Color32::from_black_alpha(120)),
        Stroke::new(1.1, Color32::from_white_alpha(230)),
    ] {
        painter.extend(lines.iter().map(|&line| Shape::line_segment(line, stroke)));
    }
    let center = to_screen(at);
    painter.circle_filled(center, 2.2, Color32::from_black_alpha(140));
    painter.circle_filled(center, 1.2, Color32::WHITE);
}

/// The current color, around the point where another is picked.
fn draw_picked(painter: &Painter, session: &Session, at: Pos2) {
    painter.circle_stroke(at, 14.0, Stroke::new(4.0, color32(session.tools.color)));
    painter.circle_stroke(at, 16.5, Stroke::new(1.0, Color32::from_black_alpha(160)));
}

/// The axes of symmetry.
fn axes(painter: &Painter, session: &Session, to_screen: &impl Fn(Vec2) -> Pos2) {
    let Some(document) = session.shown_document() else { return };
    for axis in document.symmetry.kind.lines_about(document.size, document.symmetry.axes) {
        let ends = axis.map(to_screen);
        painter.line_segment(ends, Stroke::new(2.2, Color32::from_black_alpha(70)));
        let dashes = Stroke::new(1.0, Color32::from_rgb(120, 200, 255));
        painter.extend(Shape::dashed_line(&ends, dashes, 6.0, 5.0));
    }
}

/// A cross where a clone brush would copy from.
fn clone_source(
    painter: &Painter,
    session: &Session,
    under: Vec2,
    to_screen: &impl Fn(Vec2) -> Pos2,
) {
    let BrushMode::Clone { aligned, .. } = session.tools.brush.mode else { return };
    let Some(source) = session.active().and_then(|open| open.clone_source) else { return };
    let offset = source.offset.filter(|_| aligned || session.is_drawing());
    let at = to_screen(offset.map_or(source.at, |offset| under + offset));
    for look in [Stroke::new(3.0, Color32::from_black_alpha(140)), Stroke::new(1.2, Color32::WHITE)]
    {
        for arm in [vec2(7.0, 0.0), vec2(0.0, 7.0)] {
            painter.line_segment([at - arm, at + arm], look);
        }
    }
}

/// Pairs of points to be joined.
type OutlineSegments = Arc<Vec<[Vec2; 2]>>;

/// Cached outlines of the selected strokes, kept by egui between frames.
#[derive(Clone, Default)]
struct OutlineCache {
    cache: Vec<(Arc<PaintStroke>, OutlineSegments)>,
}

/// The selected strokes: their outlines, or the lines through their samples while they move.
fn draw_selected_strokes(painter: &Painter, session: &Session, to_screen: &impl Fn(Vec2) -> Pos2) {
    let Some((open, layer)) = session.active().zip(session.layer()) else { return };
    let document = open.shown_document();
    let strokes = document.strokes_on_canvas(layer.id);
    let selected: Vec<&Arc<PaintStroke>> =
        open.selected_strokes().iter().filter_map(|&index| strokes.get(index)).collect();
    if open.is_previewing() {
        return selected.into_iter().for_each(|stroke| line_through(painter, stroke, to_screen));
    }
    let scene = document.scene_of(layer.id).unwrap_or_else(|| document.scene());
    draw_outlines(painter, selected, &scene, to_screen);
}

/// Dark beneath light, so that it is visible on any picture.
const LOOKS: [Stroke; 2] = [
    Stroke { width: 2.6, color: Color32::from_black_alpha(130) },
    Stroke { width: 1.2, color: Color32::from_rgb(120, 200, 255) },
];

/// The line through a stroke's samples.
fn line_through(painter: &Painter, stroke: &PaintStroke, to_screen: &impl Fn(Vec2) -> Pos2) {
    let line: Vec<Pos2> = stroke.samples().iter().map(|sample| to_screen(sample.at)).collect();
    painter.extend(LOOKS.map(|look| Shape::line(line.clone(), look)));
}

/// The outlines of strokes, kept while they do not change.
fn draw_outlines(
    painter: &Painter,
    strokes: Vec<&Arc<PaintStroke>>,
    scene: &Scene,
    to_screen: &impl Fn(Vec2) -> Pos2,
) {
    let id = eframe::egui::Id::unique("outlines of strokes");
    let old: OutlineCache = painter.ctx().data_mut(|data| data.get_temp(id).unwrap_or_default());
    let kept = |stroke: &Arc<PaintStroke>| {
        old.cache.iter().find(|(known, _)| Arc::ptr_eq(known, stroke)).cloned()
    };
    let made =
        |stroke: &Arc<PaintStroke>| (stroke.clone(), Arc::new(outline::of_stroke(stroke, scene)));
    let now = OutlineCache {
        cache: strokes
            .into_iter()
            .map(|stroke| kept(stroke).unwrap_or_else(|| made(stroke)))
            .collect(),
    };
    for look in LOOKS {
        let lines = now.cache.iter().flat_map(|(_, lines)| lines.iter());
        painter.extend(lines.map(|line| Shape::line_segment(line.map(to_screen), look)));
    }
    painter.ctx().data_mut(|data| data.insert_temp(id, now));
}

/// The handles of the selected layer, and a line from each anchor to the content pinned there.
fn handles(painter: &Painter, session: &Session, to_screen: &impl Fn(Vec2) -> Pos2) {
    let Some(layer) = session.layer() else { return };
    let line = Stroke::new(1.2, Color32::from_white_alpha(200));
    match &layer.content {
        Content::Gradient(live) => {
            let (from, to) = (to_screen(live.params().from), to_screen(live.params().to));
            let looks = [Stroke::new(3.0, Color32::from_black_alpha(110)), line];
            for look in looks {
                painter.line_segment([from, to], look);
                if live.params().style == RampStyle::Radial {
                    painter.circle_stroke(from, from.distance(to), look);
                }
            }
        }
        Content::Shading(_) => {
            // From the middle toward each light, as far as it leans.
            let Some(canvas) = session.shown_document().map(|document| document.size) else {
                return;
            };
            for light in anchors::handles(layer, canvas) {
                let ends = [to_screen(canvas.center()), to_screen(light)];
                painter.line_segment(ends, Stroke::new(3.0, Color32::from_black_alpha(90)));
                painter.line_segment(ends, Stroke::new(1.0, Color32::from_white_alpha(150)));
            }
        }
        Content::Image(live) => {
            for anchor in
                live.params().bend.anchors.iter().filter(|anchor| anchor.at != anchor.source)
            {
                let (from, to) = (to_screen(anchor.at), to_screen(anchor.source));
                painter.extend(Shape::dashed_line(
                    &[from, to],
                    Stroke::new(1.0, Color32::from_white_alpha(140)),
                    5.0,
                    4.0,
                ));
                painter.circle_stroke(to, 3.0, Stroke::new(1.0, Color32::from_white_alpha(160)));
            }
        }
        _ => {}
    }
    let Some(canvas) = session.shown_document().map(|document| document.size) else { return };
    for (i, handle) in anchors::handles(layer, canvas).into_iter().enumerate() {
        let at = to_screen(handle);
        painter.circle_filled(at, 7.0, Color32::from_black_alpha(130));
        painter.circle_filled(at, 5.5, anchor_color(i));
        painter.circle_stroke(at, 5.5, Stroke::new(1.4, Color32::WHITE));
    }
}

/// The colors that distinguish anchors, here and in their insets (SF fig. 9).
pub fn anchor_color(index: usize) -> Color32 {
    let [r, g, b] =
        crate::document::view::anchor_color(index).to_array().map(crate::math::srgb::quantize);
    Color32::from_rgb(r, g, b)
}
