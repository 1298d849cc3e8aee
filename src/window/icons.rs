//! Icons, drawn: lines on a grid of 16 × 16, or 20 × 20 for tools, so that they are sharp at any
//! scale and need no font. Floor 7.

mod button;
mod tools;

pub use button::{BUTTON_PT, add_sized_button, icon_button, quiet_button};

use crate::tools::ToolKind;
use eframe::egui::{self, Color32, Painter, Pos2, Rect, Stroke, Vec2, pos2};

type IconPoint = (f32, f32);

/// A part of an icon.
enum IconPart {
    Line(&'static [IconPoint]),
    Closed(&'static [IconPoint]),
    Filled(&'static [IconPoint]),
    /// Center and radius.
    Circle(IconPoint, f32),
    Dot(IconPoint, f32),
    /// A convex area, and how opaque it is.
    Tint(&'static [IconPoint], f32),
}
use IconPart::{Circle, Closed, Dot, Filled, Line, Tint};

/// The meaning of an icon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Icon {
    /// A tool, and what it makes.
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
    Adjustment,
    Filter,
    Normals,
    Ink,
    FormLines,
    Hatching,
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
    /// Panels.
    Sliders,
    Clock,
    /// A painter's palette.
    Palette,
    Frame,
    Stack,
    /// Three dots: a menu of what is needed less often.
    Dots,
    Add,
}

impl Icon {
    #[allow(clippy::too_many_lines, reason = "a table: one row for each of its kinds")]
    fn parts(self) -> &'static [IconPart] {
        match self {
            Icon::Tool(tool) => tools::parts(tool),
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
            Icon::Mask => &[
                Closed(&[(2.0, 3.0), (14.0, 3.0), (14.0, 13.0), (2.0, 13.0)]),
                Dot((8.0, 8.0), 3.2),
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
                Filled(&[
                    (8.0, 2.2),
                    (11.8, 3.6),
                    (13.8, 8.0),
                    (11.8, 12.4),
                    (8.0, 13.8),
                    (10.2, 8.0),
                ]),
            ],
            Icon::Scaling => &[
                Line(&[
                    (1.5, 12.0),
                    (4.5, 11.0),
                    (6.5, 4.0),
                    (8.0, 2.8),
                    (9.5, 4.0),
                    (11.5, 11.0),
                    (14.5, 12.0),
                ]),
                Line(&[(1.5, 14.0), (14.5, 14.0)]),
            ],
            // A dot that spreads.
            Icon::Filter => &[
                Circle((8.0, 8.0), 6.2),
                Circle((8.0, 8.0), 3.8),
                Filled(&[(8.0, 6.2), (9.8, 8.0), (8.0, 9.8), (6.2, 8.0)]),
            ],
            // Half light, half dark.
            Icon::Adjustment => &[
                Circle((8.0, 8.0), 5.8),
                Filled(&[
                    (8.0, 2.2),
                    (8.0, 13.8),
                    (5.8, 13.4),
                    (3.9, 12.1),
                    (2.6, 10.2),
                    (2.2, 8.0),
                    (2.6, 5.8),
                    (3.9, 3.9),
                    (5.8, 2.6),
                ]),
            ],
            Icon::Normals => &[
                Line(&[(2.0, 12.5), (5.0, 10.0), (8.0, 9.2), (11.0, 10.0), (14.0, 12.5)]),
                Line(&[(8.0, 9.2), (8.0, 2.5)]),
                Line(&[(6.4, 4.4), (8.0, 2.5), (9.6, 4.4)]),
            ],
            Icon::Hatching => &[
                Line(&[(2.0, 6.0), (6.0, 2.0)]),
                Line(&[(2.0, 10.0), (10.0, 2.0)]),
                Line(&[(2.0, 14.0), (14.0, 2.0)]),
                Line(&[(6.0, 14.0), (14.0, 6.0)]),
                Line(&[(10.0, 14.0), (14.0, 10.0)]),
                Line(&[(8.0, 8.0), (14.0, 14.0)]),
            ],
            Icon::FormLines => &[
                Closed(&[
                    (8.0, 2.0),
                    (12.5, 4.0),
                    (14.0, 8.0),
                    (12.5, 12.0),
                    (8.0, 14.0),
                    (3.5, 12.0),
                    (2.0, 8.0),
                    (3.5, 4.0),
                ]),
                Line(&[(5.0, 5.5), (7.0, 8.0), (7.0, 11.0)]),
                Line(&[(9.5, 5.0), (11.0, 7.0), (11.0, 10.0)]),
            ],
            Icon::Ink => &[
                Line(&[(2.0, 13.0), (3.5, 8.0), (7.0, 5.0), (11.0, 6.0), (14.0, 3.0)]),
                Line(&[(2.5, 14.0), (6.0, 11.0), (10.0, 11.5), (14.0, 9.0)]),
            ],
            Icon::Group => &[Closed(&[
                (1.5, 4.0),
                (6.0, 4.0),
                (7.4, 5.6),
                (14.5, 5.6),
                (14.5, 13.0),
                (1.5, 13.0),
            ])],
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
            Icon::Up => {
                &[Line(&[(8.0, 13.0), (8.0, 3.5)]), Line(&[(4.5, 7.0), (8.0, 3.2), (11.5, 7.0)])]
            }
            Icon::Down => {
                &[Line(&[(8.0, 3.0), (8.0, 12.5)]), Line(&[(4.5, 9.0), (8.0, 12.8), (11.5, 9.0)])]
            }
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
            Icon::Sliders => &[
                Line(&[(2.0, 4.5), (14.0, 4.5)]),
                Line(&[(2.0, 11.5), (14.0, 11.5)]),
                Dot((10.0, 4.5), 2.3),
                Dot((5.5, 11.5), 2.3),
            ],
            Icon::Clock => {
                &[Circle((8.0, 8.0), 6.0), Line(&[(8.0, 4.0), (8.0, 8.4), (11.0, 10.0)])]
            }
            Icon::Palette => &[
                Circle((8.0, 8.0), 6.2),
                Dot((5.0, 6.8), 1.3),
                Dot((8.2, 4.8), 1.3),
                Dot((11.1, 7.2), 1.3),
            ],
            Icon::Frame => &[
                Closed(&[(1.8, 3.0), (14.2, 3.0), (14.2, 13.0), (1.8, 13.0)]),
                Tint(&[(6.4, 6.4), (11.6, 6.4), (11.6, 10.6), (6.4, 10.6)], 0.8),
            ],
            Icon::Stack => &[
                Closed(&[(8.0, 1.8), (14.4, 5.4), (8.0, 9.0), (1.6, 5.4)]),
                Line(&[(1.6, 8.2), (8.0, 11.8), (14.4, 8.2)]),
                Line(&[(1.6, 11.0), (8.0, 14.6), (14.4, 11.0)]),
            ],
            Icon::Dots => &[Dot((3.0, 8.0), 1.4), Dot((8.0, 8.0), 1.4), Dot((13.0, 8.0), 1.4)],
            Icon::Add => &[Line(&[(8.0, 2.5), (8.0, 13.5)]), Line(&[(2.5, 8.0), (13.5, 8.0)])],
            Icon::Opened => &[Filled(&[(4.0, 6.0), (12.0, 6.0), (8.0, 11.0)])],
            Icon::Closed => &[Filled(&[(6.0, 4.0), (11.0, 8.0), (6.0, 12.0)])],
        }
    }

    /// The sides of the grid that it is drawn on: points at its usual size.
    pub fn grid(self) -> f32 {
        if matches!(self, Icon::Tool(_)) { 20.0 } else { 16.0 }
    }

    /// Draws it into a square.
    pub fn draw(self, painter: &Painter, rect: Rect, color: Color32) {
        let grid = self.grid();
        let scale = rect.width().min(rect.height()) / grid;
        let corner = rect.center() - Vec2::splat(0.5 * grid * scale);
        let at = |&(x, y): &IconPoint| pos2(corner.x + x * scale, corner.y + y * scale);
        let path = |points: &[IconPoint]| -> Vec<Pos2> { points.iter().map(at).collect() };
        // As heavy on both grids.
        let stroke = Stroke::new((0.08 * grid * scale).max(1.0), color);
        for part in self.parts() {
            match part {
                Line(points) => drop(painter.add(egui::Shape::line(path(points), stroke))),
                Closed(points) => drop(painter.add(egui::Shape::closed_line(path(points), stroke))),
                Filled(points) => {
                    painter.add(egui::Shape::convex_polygon(path(points), color, Stroke::NONE));
                }
                Tint(points, opacity) => {
                    let color = color.gamma_multiply(*opacity);
                    painter.add(egui::Shape::convex_polygon(path(points), color, Stroke::NONE));
                }
                Circle(center, radius) => {
                    painter.circle_stroke(at(center), radius * scale, stroke);
                }
                Dot(center, radius) => {
                    painter.circle_filled(at(center), radius * scale, color);
                }
            }
        }
    }
}
