//! The shape's parts on the picture: the outline of the selected one with its handles, touches as
//! arrows, the dab of the sculpting tool. Floor 7. Not here: what a drag of them does
//! (`tools::shape`).

use crate::document::Part;
use crate::document::parts::FormArea;
use crate::document::parts::forms::nearest_at;
use crate::language::tr_message;
use crate::math::{Affine2, Vec2, Vec3, vec2};
use crate::part_pictures::PartPictures;
use crate::raster::coverage::contour::{self, Run};
use crate::session::Session;
use crate::theme::ACCENT;
use crate::tools::ToolKind;
use crate::tools::shape::part::PartGizmo;
use crate::tools::shape::touch::touches;
use eframe::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, pos2};
use std::sync::Arc;

/// Side of a handle, and the length of a touch's arrow, points.
const HANDLE_PT: f32 = 9.0;
const ARROW_PT: f32 = 22.0;
/// The most touches drawn; more would be a cloud.
const MOST_TOUCHES: usize = 2000;

const DARK: Color32 = Color32::from_black_alpha(120);
const LIGHT: Color32 = Color32::from_rgb(120, 200, 255);

/// The outlines that were drawn last.
#[derive(Default)]
pub struct PartMarks {
    known: PartPictures,
    selected: PartOutline,
    under: PartOutline,
}

/// The outline of a form, found once.
#[derive(Default)]
struct PartOutline {
    of: Option<(Arc<FormArea>, u32)>,
    runs: Vec<Run>,
}

impl PartOutline {
    /// `level`: blocks of 2^level pixels a side are one.
    fn runs(&mut self, area: &Arc<FormArea>, level: u32) -> &[Run] {
        let is_known =
            self.of.as_ref().is_some_and(|(known, at)| Arc::ptr_eq(known, area) && *at == level);
        if !is_known {
            let grid = area.coverage();
            self.runs =
                contour::tiles(&grid).flat_map(|at| contour::runs(&grid, at, level)).collect();
            self.of = Some((area.clone(), level));
        }
        &self.runs
    }
}

impl PartMarks {
    /// `under`: the canvas point under the pointer.
    pub fn draw(
        &mut self,
        painter: &Painter,
        session: &Session,
        screen_from_canvas: Affine2,
        under: Option<Vec2>,
        tool: ToolKind,
    ) {
        let (Some(document), true) = (session.shown_document(), tool.is_shape_tool()) else {
            return;
        };
        let areas = self.known.areas(document).to_vec();
        let to_screen = |p: Vec2| {
            let p = screen_from_canvas.transform_point2(p);
            pos2(p.x, p.y)
        };
        let scale = screen_from_canvas.matrix2.x_axis.length().max(1e-6);
        let level = (1.0 / scale).log2().floor().max(0.0) as u32;
        let selected = session
            .active()
            .and_then(|open| open.part.as_deref())
            .map(|id| on_form(document.parts.part(id), id));
        let area_of = |id: &str| areas.iter().find(|(part, _)| part.id == id);
        let at = under.filter(|_| !session.is_drawing()).and_then(|at| nearest_at(&areas, at));
        if let Some((_, area)) = at
            .as_ref()
            .filter(|part| selected != Some(&*part.id))
            .and_then(|part| area_of(&part.id))
        {
            outline(
                painter,
                self.under.runs(area, level),
                &to_screen,
                Stroke::new(1.0, Color32::from_white_alpha(150)),
            );
        }
        if let Some((part, area)) = selected.and_then(area_of) {
            let look = Stroke::new(1.4, LIGHT);
            // While it is dragged, its last form moves with it.
            let map = self.known.map_since(&part.id);
            let moved = |p: Vec2| to_screen(map.transform_point2(p));
            outline(painter, self.selected.runs(area, level), &moved, look);
            if tool == ToolKind::Shape {
                let gizmo = PartGizmo::of(part, area, 1.0 / scale).transformed(map);
                handles(painter, part, &gizmo, &to_screen);
                let described =
                    under.and_then(|at| Some((at, gizmo.handle_at(at)?.describe(part)?)));
                if let Some((at, text)) = described {
                    hint(painter, to_screen(at), &tr_message(&text));
                }
            }
        }
        if tool == ToolKind::Touch {
            arrows(painter, session, &to_screen, screen_from_canvas);
        }
        if let Some(at) = under.filter(|_| tool == ToolKind::Sculpt) {
            let radius = 0.5 * session.tools.shape.size * scale;
            let inner = radius * session.tools.shape.hardness;
            for (width, color) in [(2.4, DARK), (1.1, Color32::WHITE)] {
                painter.circle_stroke(to_screen(at), radius, Stroke::new(width, color));
            }
            if inner > 3.0 {
                painter.circle_stroke(
                    to_screen(at),
                    inner,
                    Stroke::new(1.0, Color32::from_white_alpha(90)),
                );
            }
        }
    }
}

/// The part that has a form: the selected one, or the one that it lies on.
fn on_form<'a>(part: Option<&'a Arc<Part>>, id: &'a str) -> &'a str {
    part.and_then(|part| part.on()).unwrap_or(id)
}

fn outline(painter: &Painter, runs: &[Run], to_screen: &impl Fn(Vec2) -> Pos2, look: Stroke) {
    let ends = |run: &Run| {
        let from = vec2(run.x as f32, run.y as f32);
        let along = if run.is_vertical {
            vec2(0.0, run.length as f32)
        } else {
            vec2(run.length as f32, 0.0)
        };
        [to_screen(from), to_screen(from + along)]
    };
    for stroke in [Stroke::new(look.width + 1.4, DARK), look] {
        painter.extend(runs.iter().map(|run| Shape::line_segment(ends(run), stroke)));
    }
}

/// The box with its corners, the handle that turns, the one of the height and the ball that tilts.
fn handles(painter: &Painter, part: &Part, gizmo: &PartGizmo, to_screen: &impl Fn(Vec2) -> Pos2) {
    let corners = gizmo.corners().map(to_screen);
    let closed = [0, 1, 2, 3, 0].map(|i| corners[i]);
    painter.extend(Shape::dashed_line(
        &closed,
        Stroke::new(1.0, Color32::from_white_alpha(170)),
        5.0,
        4.0,
    ));
    let (top, turn) = (to_screen(vec2(gizmo.middle().x, gizmo.low.y)), to_screen(gizmo.turn()));
    painter.line_segment([top, turn], Stroke::new(1.0, Color32::from_white_alpha(170)));
    painter.circle(turn, 0.55 * HANDLE_PT, Color32::WHITE, Stroke::new(1.2, DARK));
    for at in corners {
        let handle = Rect::from_center_size(at, eframe::egui::Vec2::splat(HANDLE_PT));
        painter.rect_filled(handle, 1.0, Color32::WHITE);
        painter.rect_stroke(handle, 1.0, Stroke::new(1.2, DARK), StrokeKind::Outside);
    }
    if let Some(at) = gizmo.puff().map(to_screen) {
        // An arrow with two heads: up and down.
        let (r, h) = (5.0, 11.0);
        let up = vec![pos2(at.x - r, at.y - 3.0), pos2(at.x, at.y - h), pos2(at.x + r, at.y - 3.0)];
        let down =
            vec![pos2(at.x - r, at.y + 3.0), pos2(at.x + r, at.y + 3.0), pos2(at.x, at.y + h)];
        for points in [up, down] {
            painter.add(Shape::convex_polygon(points, Color32::WHITE, Stroke::new(1.2, DARK)));
        }
    }
    inflation_handles(painter, gizmo, to_screen);
    if let Some(at) = gizmo.depth().map(to_screen) {
        // A small sheet in front of a larger one.
        for (by, side) in [(-2.0, 10.0), (2.0, 8.0)] {
            let center = at + eframe::egui::vec2(by, by);
            let sheet = Rect::from_center_size(center, eframe::egui::Vec2::splat(side));
            painter.rect(sheet, 1.5, Color32::WHITE, Stroke::new(1.2, DARK), StrokeKind::Outside);
        }
    }
    if let Some(at) = gizmo.tilt().map(to_screen) {
        let tilt = part.tilt_deg;
        // The way it faces: the surface falls there.
        let slope = vec2(tilt.x.to_radians().tan(), tilt.y.to_radians().tan());
        ball(painter, at, 9.0, Vec3::new(-slope.x, slope.y, 1.0).normalize_or(Vec3::Z));
    }
}

/// The handles of the profile, a cushion, and of the rim, a quarter of a circle.
fn inflation_handles(painter: &Painter, gizmo: &PartGizmo, to_screen: &impl Fn(Vec2) -> Pos2) {
    if let Some(at) = gizmo.profile().map(to_screen) {
        let cushion = Rect::from_center_size(at, eframe::egui::vec2(16.0, 8.0));
        painter.rect(cushion, 4.0, Color32::WHITE, Stroke::new(1.2, DARK), StrokeKind::Outside);
    }
    if let Some(at) = gizmo.rim().map(to_screen) {
        let arc = |i: usize| {
            let angle = std::f32::consts::FRAC_PI_2 * i as f32 / 8.0;
            at + eframe::egui::vec2(6.0 - 12.0 * angle.cos(), 6.0 - 12.0 * angle.sin())
        };
        let points: Vec<Pos2> = (0..=8).map(arc).collect();
        for (width, color) in [(5.0, DARK), (2.6, Color32::WHITE)] {
            painter.line(points.clone(), Stroke::new(width, color));
        }
    }
}

/// What a handle changes, next to the pointer.
fn hint(painter: &Painter, at: Pos2, text: &str) {
    let font = eframe::egui::FontId::proportional(12.5);
    let galley = painter.layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    let corner = at + eframe::egui::vec2(16.0, 14.0);
    let ground = Rect::from_min_size(corner, galley.size()).expand(4.0);
    painter.rect_filled(ground, 3.0, Color32::from_black_alpha(190));
    painter.galley(corner, galley, Color32::WHITE);
}

/// A small lit ball with a needle in a direction (camera space, y up).
pub fn ball(painter: &Painter, at: Pos2, radius: f32, normal: Vec3) {
    painter.circle(at, radius, Color32::from_gray(0x58), Stroke::new(1.4, DARK));
    for (share, gray) in [(0.8, 0x78u8), (0.55, 0xa0), (0.3, 0xc8)] {
        let center = at + eframe::egui::vec2(-0.3, -0.3) * radius * (1.0 - share);
        painter.circle_filled(center, radius * share, Color32::from_gray(gray));
    }
    let tip = at + eframe::egui::vec2(normal.x, -normal.y) * radius;
    painter.line_segment([at, tip], Stroke::new(2.0, ACCENT));
    painter.circle(tip, 0.26 * radius, Color32::WHITE, Stroke::new(1.0, DARK));
}

/// Touches as arrows, longer the more they lean.
fn arrows(
    painter: &Painter,
    session: &Session,
    to_screen: &impl Fn(Vec2) -> Pos2,
    screen_from_canvas: Affine2,
) {
    let Some(document) = session.shown_document() else { return };
    for touch in touches(document).into_iter().take(MOST_TOUCHES) {
        let at = to_screen(touch.at);
        // A turned or mirrored view also turns or mirrors directions.
        let way = screen_from_canvas.transform_vector2(vec2(touch.normal.x, -touch.normal.y));
        let length = ARROW_PT * vec2(touch.normal.x, touch.normal.y).length();
        let way = way.normalize_or_zero() * length;
        let tip = at + eframe::egui::vec2(way.x, way.y);
        for (width, color) in [(3.4, DARK), (1.6, Color32::WHITE)] {
            painter.line_segment([at, tip], Stroke::new(width, color));
        }
        painter.circle(at, 3.4, ACCENT, Stroke::new(1.2, Color32::WHITE));
    }
}
