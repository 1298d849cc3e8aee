//! Icons, drawn: lines on a grid of 16 × 16, so that they are sharp at any scale and need no font.
//! Floor 7.

use crate::tools::ToolKind;
use eframe::egui::{self, Color32, Painter, Pos2, Rect, Response, Sense, Stroke, StrokeKind, Ui, Vec2, pos2, vec2};

type IconPoint = (f32, f32);

/// A part of an icon.
enum IconPart {
    Line(&'static [IconPoint]),
    Closed(&'static [IconPoint]),
    Filled(&'static [IconPoint]),
    /// Centre and radius.
    Circle(IconPoint, f32),
    Dot(IconPoint, f32),
}
use IconPart::{Circle, Closed, Dot, Filled, Line};

/// What an icon stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Icon {
    /// A tool, and what is made with it.
    Tool(ToolKind),
    Shown,
    Hidden,
    Lock,
    LockAlpha,
    Clip,
    Solo,
    Mask,
    Pixels,
    Fill,
    Shading,
    Scaling,
    Normals,
    Group,
    Delete,
    Duplicate,
    Merge,
    Bake,
    Up,
    Down,
    Swap,
    Reset,
    Close,
    Opened,
    Closed,
}

impl Icon {
    fn parts(self) -> &'static [IconPart] {
        match self {
            Icon::Tool(ToolKind::Brush) => &[
                Closed(&[(13.5, 1.5), (14.5, 2.5), (8.2, 9.8), (6.2, 7.8)]),
                Filled(&[(5.4, 8.6), (7.4, 10.6), (6.2, 13.2), (1.8, 14.2), (3.4, 12.4), (3.6, 9.6)]),
            ],
            Icon::Tool(ToolKind::Eraser) => &[
                Closed(&[(9.0, 2.5), (13.5, 7.0), (7.2, 13.5), (4.6, 13.5), (2.0, 10.8), (2.0, 9.6)]),
                Line(&[(5.4, 6.2), (9.9, 10.7)]),
                Line(&[(7.2, 13.5), (14.0, 13.5)]),
            ],
            Icon::Tool(ToolKind::Fill) => &[
                Closed(&[(7.0, 2.0), (13.0, 8.0), (7.6, 13.4), (6.4, 13.4), (1.6, 8.6), (1.6, 7.4)]),
                Filled(&[(3.0, 8.2), (12.6, 8.2), (7.4, 13.2), (6.6, 13.2)]),
                Filled(&[(14.2, 9.6), (15.4, 12.4), (14.8, 13.8), (13.6, 13.8), (13.0, 12.4)]),
            ],
            Icon::Tool(ToolKind::Gradient) => &[
                Closed(&[(2.0, 3.0), (14.0, 3.0), (14.0, 13.0), (2.0, 13.0)]),
                Filled(&[(2.0, 3.0), (5.0, 3.0), (5.0, 13.0), (2.0, 13.0)]),
                Line(&[(6.6, 3.0), (6.6, 13.0)]),
                Line(&[(8.6, 3.0), (8.6, 13.0)]),
                Line(&[(11.2, 3.0), (11.2, 13.0)]),
            ],
            Icon::Tool(ToolKind::Image) => &[
                Closed(&[(1.5, 3.0), (14.5, 3.0), (14.5, 13.0), (1.5, 13.0)]),
                Line(&[(1.5, 11.5), (5.5, 7.0), (8.5, 10.5), (10.5, 8.5), (14.5, 12.0)]),
                Dot((11.0, 5.8), 1.2),
            ],
            Icon::Tool(ToolKind::Anchors) => &[
                Circle((8.0, 8.0), 2.2),
                Line(&[(8.0, 1.5), (8.0, 5.8)]),
                Line(&[(8.0, 10.2), (8.0, 14.5)]),
                Line(&[(1.5, 8.0), (5.8, 8.0)]),
                Line(&[(10.2, 8.0), (14.5, 8.0)]),
                Dot((8.0, 8.0), 0.9),
            ],
            Icon::Tool(ToolKind::Move) => &[
                Line(&[(8.0, 1.5), (8.0, 14.5)]),
                Line(&[(1.5, 8.0), (14.5, 8.0)]),
                Line(&[(6.0, 3.5), (8.0, 1.5), (10.0, 3.5)]),
                Line(&[(6.0, 12.5), (8.0, 14.5), (10.0, 12.5)]),
                Line(&[(3.5, 6.0), (1.5, 8.0), (3.5, 10.0)]),
                Line(&[(12.5, 6.0), (14.5, 8.0), (12.5, 10.0)]),
            ],
            Icon::Tool(ToolKind::Eyedropper) => &[
                Filled(&[(10.0, 3.6), (12.2, 1.6), (14.4, 3.8), (12.4, 6.0)]),
                Line(&[(8.6, 4.4), (11.6, 7.4)]),
                Closed(&[(9.4, 5.6), (10.4, 6.6), (4.6, 12.4), (2.4, 13.6), (3.6, 11.4)]),
            ],
            Icon::Tool(ToolKind::Hand) => &[Line(&[
                (4.8, 9.8),
                (4.8, 4.2),
                (6.2, 4.2),
                (6.2, 7.4),
                (6.4, 2.4),
                (7.8, 2.4),
                (8.0, 7.2),
                (8.6, 3.0),
                (9.9, 3.2),
                (9.8, 7.6),
                (11.0, 4.6),
                (12.2, 5.2),
                (11.4, 10.8),
                (9.6, 14.0),
                (6.2, 14.0),
                (2.4, 9.2),
                (3.4, 8.4),
                (4.8, 9.8),
            ])],
            Icon::Tool(ToolKind::Zoom) => &[
                Circle((6.8, 6.8), 4.6),
                Line(&[(10.2, 10.2), (14.2, 14.2)]),
                Line(&[(4.8, 6.8), (8.8, 6.8)]),
                Line(&[(6.8, 4.8), (6.8, 8.8)]),
            ],
            Icon::Shown => &[
                Closed(&[
                    (1.5, 8.0),
                    (4.2, 5.0),
                    (8.0, 3.8),
                    (11.8, 5.0),
                    (14.5, 8.0),
                    (11.8, 11.0),
                    (8.0, 12.2),
                    (4.2, 11.0),
                ]),
                Dot((8.0, 8.0), 2.1),
            ],
            Icon::Hidden => &[
                Line(&[(1.5, 7.0), (4.2, 9.8), (8.0, 10.9), (11.8, 9.8), (14.5, 7.0)]),
                Line(&[(8.0, 10.9), (8.0, 13.0)]),
                Line(&[(3.6, 9.4), (2.6, 11.4)]),
                Line(&[(12.4, 9.4), (13.4, 11.4)]),
            ],
            Icon::Lock => &[
                Filled(&[(3.5, 7.0), (12.5, 7.0), (12.5, 14.0), (3.5, 14.0)]),
                Line(&[(5.4, 7.0), (5.4, 4.4), (6.6, 2.6), (9.4, 2.6), (10.6, 4.4), (10.6, 7.0)]),
            ],
            Icon::LockAlpha => &[
                Closed(&[(2.5, 2.5), (13.5, 2.5), (13.5, 13.5), (2.5, 13.5)]),
                Filled(&[(2.5, 2.5), (8.0, 2.5), (8.0, 8.0), (2.5, 8.0)]),
                Filled(&[(8.0, 8.0), (13.5, 8.0), (13.5, 13.5), (8.0, 13.5)]),
            ],
            Icon::Clip => &[
                Line(&[(12.5, 2.5), (12.5, 6.0), (4.5, 6.0), (4.5, 13.0)]),
                Line(&[(2.2, 10.6), (4.5, 13.2), (6.8, 10.6)]),
            ],
            Icon::Solo => &[Circle((8.0, 8.0), 5.5), Dot((8.0, 8.0), 2.4)],
            Icon::Mask => &[Closed(&[(2.0, 3.0), (14.0, 3.0), (14.0, 13.0), (2.0, 13.0)]), Dot((8.0, 8.0), 3.2)],
            Icon::Tool(ToolKind::Transform) => &[
                Closed(&[(3.5, 3.5), (12.5, 3.5), (12.5, 12.5), (3.5, 12.5)]),
                Filled(&[(2.0, 2.0), (5.0, 2.0), (5.0, 5.0), (2.0, 5.0)]),
                Filled(&[(11.0, 2.0), (14.0, 2.0), (14.0, 5.0), (11.0, 5.0)]),
                Filled(&[(11.0, 11.0), (14.0, 11.0), (14.0, 14.0), (11.0, 14.0)]),
                Filled(&[(2.0, 11.0), (5.0, 11.0), (5.0, 14.0), (2.0, 14.0)]),
            ],
            Icon::Tool(ToolKind::Assistants) => &[
                Line(&[(1.5, 13.5), (14.5, 13.5)]),
                Line(&[(8.0, 2.5), (2.0, 13.5)]),
                Line(&[(8.0, 2.5), (14.0, 13.5)]),
                Line(&[(8.0, 2.5), (8.0, 13.5)]),
                Dot((8.0, 2.5), 1.6),
            ],
            Icon::Tool(ToolKind::Crop) => {
                &[Line(&[(4.0, 1.5), (4.0, 12.0), (14.5, 12.0)]), Line(&[(1.5, 4.0), (12.0, 4.0), (12.0, 14.5)])]
            }
            Icon::Tool(ToolKind::Strokes) => &[
                Line(&[(2.0, 11.5), (4.0, 7.0), (6.6, 5.4), (8.6, 7.4), (10.0, 10.0), (12.0, 9.0), (14.0, 4.0)]),
                Dot((2.0, 11.5), 1.3),
                Dot((8.6, 7.4), 1.3),
                Dot((14.0, 4.0), 1.3),
            ],
            Icon::Tool(ToolKind::SelectRectangle) => &[
                Line(&[(2.0, 5.0), (2.0, 3.0), (5.0, 3.0)]),
                Line(&[(7.0, 3.0), (10.0, 3.0)]),
                Line(&[(12.0, 3.0), (14.0, 3.0), (14.0, 5.0)]),
                Line(&[(14.0, 7.0), (14.0, 9.0)]),
                Line(&[(14.0, 11.0), (14.0, 13.0), (12.0, 13.0)]),
                Line(&[(10.0, 13.0), (7.0, 13.0)]),
                Line(&[(5.0, 13.0), (2.0, 13.0), (2.0, 11.0)]),
                Line(&[(2.0, 9.0), (2.0, 7.0)]),
            ],
            Icon::Tool(ToolKind::SelectEllipse) => &[
                Line(&[(2.0, 7.0), (2.6, 5.4), (4.0, 3.9)]),
                Line(&[(6.0, 3.1), (8.0, 2.9), (10.0, 3.1)]),
                Line(&[(12.0, 3.9), (13.4, 5.4), (14.0, 7.0)]),
                Line(&[(14.0, 9.0), (13.4, 10.6), (12.0, 12.1)]),
                Line(&[(10.0, 12.9), (8.0, 13.1), (6.0, 12.9)]),
                Line(&[(4.0, 12.1), (2.6, 10.6), (2.0, 9.0)]),
            ],
            Icon::Tool(ToolKind::Lasso) => &[
                Closed(&[
                    (8.5, 2.5),
                    (12.6, 3.6),
                    (14.0, 6.2),
                    (12.4, 8.8),
                    (8.0, 10.0),
                    (3.8, 9.2),
                    (2.0, 6.6),
                    (3.6, 3.8),
                ]),
                Line(&[(4.6, 9.4), (3.4, 11.0), (4.6, 12.2), (3.8, 14.2)]),
            ],
            Icon::Tool(ToolKind::Wand) => &[
                Line(&[(2.0, 14.0), (9.2, 6.8)]),
                Line(&[(11.0, 1.6), (11.0, 4.0)]),
                Line(&[(11.0, 6.4), (11.0, 8.8)]),
                Line(&[(7.6, 5.2), (9.8, 5.2)]),
                Line(&[(12.2, 5.2), (14.4, 5.2)]),
                Dot((14.0, 9.4), 0.8),
                Dot((7.4, 2.4), 0.8),
            ],
            Icon::Tool(ToolKind::SurfaceWand) => &[
                Circle((6.2, 9.8), 4.6),
                Line(&[(6.2, 9.8), (12.0, 4.0)]),
                Line(&[(9.2, 3.6), (12.4, 3.6), (12.4, 6.8)]),
                Dot((6.2, 9.8), 1.3),
            ],
            Icon::Tool(ToolKind::Shape) => &[
                Circle((6.4, 9.4), 5.0),
                Line(&[(3.2, 11.4), (4.6, 12.6), (6.6, 13.0)]),
                Line(&[(8.4, 3.0), (11.0, 2.0), (13.6, 3.6), (14.2, 6.6), (12.6, 9.0)]),
            ],
            Icon::Tool(ToolKind::Touch) => &[
                Line(&[(1.8, 13.0), (4.6, 10.8), (8.0, 10.0), (11.4, 10.8), (14.2, 13.0)]),
                Dot((6.8, 10.0), 1.6),
                Line(&[(6.8, 10.0), (11.6, 3.4)]),
                Line(&[(8.4, 3.6), (11.8, 3.0), (12.4, 6.4)]),
            ],
            Icon::Tool(ToolKind::Liquify) => &[
                Line(&[(2.0, 4.0), (5.0, 4.4), (8.4, 5.6), (11.0, 4.6), (14.0, 4.0)]),
                Line(&[(2.0, 8.0), (5.4, 8.0), (9.8, 10.4), (11.4, 8.4), (14.0, 8.0)]),
                Line(&[(2.0, 12.0), (5.0, 12.0), (9.0, 13.2), (11.0, 12.4), (14.0, 12.0)]),
                Dot((9.8, 10.4), 1.4),
            ],
            Icon::Tool(ToolKind::Sculpt) => &[
                Line(&[(1.5, 13.5), (4.0, 13.2), (6.2, 9.6), (8.0, 8.8), (9.8, 9.6), (12.0, 13.2), (14.5, 13.5)]),
                Line(&[(8.0, 6.6), (8.0, 1.8)]),
                Line(&[(6.0, 3.8), (8.0, 1.8), (10.0, 3.8)]),
            ],
            Icon::Pixels => &[
                Filled(&[(2.5, 2.5), (6.2, 2.5), (6.2, 6.2), (2.5, 6.2)]),
                Filled(&[(6.2, 6.2), (9.8, 6.2), (9.8, 9.8), (6.2, 9.8)]),
                Filled(&[(9.8, 2.5), (13.5, 2.5), (13.5, 6.2), (9.8, 6.2)]),
                Filled(&[(2.5, 9.8), (6.2, 9.8), (6.2, 13.5), (2.5, 13.5)]),
                Filled(&[(9.8, 9.8), (13.5, 9.8), (13.5, 13.5), (9.8, 13.5)]),
            ],
            Icon::Fill => &[Filled(&[(2.5, 2.5), (13.5, 2.5), (13.5, 13.5), (2.5, 13.5)])],
            Icon::Shading => &[
                Circle((8.0, 8.0), 5.8),
                Filled(&[(8.0, 2.2), (11.8, 3.6), (13.8, 8.0), (11.8, 12.4), (8.0, 13.8), (10.2, 8.0)]),
            ],
            Icon::Scaling => &[
                Line(&[(1.5, 12.0), (4.5, 11.0), (6.5, 4.0), (8.0, 2.8), (9.5, 4.0), (11.5, 11.0), (14.5, 12.0)]),
                Line(&[(1.5, 14.0), (14.5, 14.0)]),
            ],
            Icon::Normals => &[
                Line(&[(2.0, 12.5), (5.0, 10.0), (8.0, 9.2), (11.0, 10.0), (14.0, 12.5)]),
                Line(&[(8.0, 9.2), (8.0, 2.5)]),
                Line(&[(6.4, 4.4), (8.0, 2.5), (9.6, 4.4)]),
            ],
            Icon::Group => &[Closed(&[(1.5, 4.0), (6.0, 4.0), (7.4, 5.6), (14.5, 5.6), (14.5, 13.0), (1.5, 13.0)])],
            Icon::Delete => &[
                Line(&[(3.0, 4.0), (13.0, 4.0)]),
                Line(&[(6.0, 4.0), (6.4, 2.4), (9.6, 2.4), (10.0, 4.0)]),
                Line(&[(4.2, 4.0), (5.0, 13.8), (11.0, 13.8), (11.8, 4.0)]),
            ],
            Icon::Duplicate => &[
                Closed(&[(2.5, 5.0), (10.5, 5.0), (10.5, 13.5), (2.5, 13.5)]),
                Line(&[(5.5, 5.0), (5.5, 2.5), (13.5, 2.5), (13.5, 10.5), (10.5, 10.5)]),
            ],
            Icon::Merge => &[
                Line(&[(8.0, 2.0), (8.0, 9.5)]),
                Line(&[(5.0, 6.8), (8.0, 9.8), (11.0, 6.8)]),
                Line(&[(2.5, 13.0), (13.5, 13.0)]),
            ],
            Icon::Bake => &[
                Closed(&[(2.5, 9.5), (13.5, 9.5), (13.5, 13.5), (2.5, 13.5)]),
                Line(&[(5.0, 7.5), (5.8, 5.5), (4.6, 4.0), (5.4, 2.0)]),
                Line(&[(10.0, 7.5), (10.8, 5.5), (9.6, 4.0), (10.4, 2.0)]),
            ],
            Icon::Up => &[Line(&[(8.0, 13.0), (8.0, 3.5)]), Line(&[(4.5, 7.0), (8.0, 3.2), (11.5, 7.0)])],
            Icon::Down => &[Line(&[(8.0, 3.0), (8.0, 12.5)]), Line(&[(4.5, 9.0), (8.0, 12.8), (11.5, 9.0)])],
            Icon::Swap => &[
                Line(&[(4.0, 12.0), (4.0, 4.0), (12.0, 4.0)]),
                Line(&[(1.8, 9.8), (4.0, 12.2), (6.2, 9.8)]),
                Line(&[(9.8, 1.8), (12.2, 4.0), (9.8, 6.2)]),
            ],
            Icon::Reset => &[
                Closed(&[(5.5, 5.5), (13.5, 5.5), (13.5, 13.5), (5.5, 13.5)]),
                Filled(&[(2.5, 2.5), (9.5, 2.5), (9.5, 9.5), (2.5, 9.5)]),
            ],
            Icon::Close => &[Line(&[(4.0, 4.0), (12.0, 12.0)]), Line(&[(12.0, 4.0), (4.0, 12.0)])],
            Icon::Opened => &[Filled(&[(4.0, 6.0), (12.0, 6.0), (8.0, 11.0)])],
            Icon::Closed => &[Filled(&[(6.0, 4.0), (11.0, 8.0), (6.0, 12.0)])],
        }
    }
    /// Draws it into a square.
    pub fn draw(self, painter: &Painter, rect: Rect, color: Color32) {
        let scale = rect.width().min(rect.height()) / 16.0;
        let corner = rect.center() - Vec2::splat(8.0 * scale);
        let at = |&(x, y): &IconPoint| pos2(corner.x + x * scale, corner.y + y * scale);
        let path = |points: &[IconPoint]| -> Vec<Pos2> { points.iter().map(at).collect() };
        let stroke = Stroke::new((1.25 * scale).max(1.0), color);
        for part in self.parts() {
            match part {
                Line(points) => drop(painter.add(egui::Shape::line(path(points), stroke))),
                Closed(points) => drop(painter.add(egui::Shape::closed_line(path(points), stroke))),
                Filled(points) => {
                    painter.add(egui::Shape::convex_polygon(path(points), color, Stroke::NONE));
                }
                Circle(center, radius) => drop(painter.circle_stroke(at(center), radius * scale, stroke)),
                Dot(center, radius) => drop(painter.circle_filled(at(center), radius * scale, color)),
            }
        }
    }
}

/// The side of an icon's button, screen points.
pub const BUTTON_PT: f32 = 24.0;

/// A button with an icon and, for screen readers, tests and the tooltip, a name.
pub fn icon_button(ui: &mut Ui, icon: Icon, label: &str, on: bool) -> Response {
    sized_button(ui, icon, label, on, BUTTON_PT)
}

pub fn sized_button(ui: &mut Ui, icon: Icon, label: &str, on: bool, side_pt: f32) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(side_pt), Sense::click());
    let enabled = ui.is_enabled();
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, enabled, on, label));
    if ui.is_rect_visible(rect) {
        let look = ui.style().interact_selectable(&response, on);
        if on || response.hovered() || response.has_focus() {
            ui.painter().rect(
                rect.shrink(0.5),
                look.corner_radius,
                look.weak_bg_fill,
                look.bg_stroke,
                StrokeKind::Inside,
            );
        }
        let inner = Rect::from_center_size(rect.center(), vec2(16.0, 16.0).min(rect.size() * 0.72));
        icon.draw(ui.painter(), inner, look.text_color());
    }
    response
}
