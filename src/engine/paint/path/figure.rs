//! Figures: rectangles, ellipses, polygons, stars, lines, arrows and speech balloons, as numbers.
//! Floor 3.

use super::subpath::{PathNode, Subpath};
use crate::math::number_settings::number_settings;
use crate::math::range::{COORDINATE, check_range};
use crate::math::{TURNS, Vec2, vec2};

crate::named! {
    /// The kinds of figures, with their labels and what they are.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum FigureKind {
        #[default]
        Rectangle = "rectangle" => ("Rectangle", "A rectangle, its corners rounded if you like"),
        Ellipse = "ellipse" => ("Ellipse", "An ellipse; with Shift a circle"),
        Polygon = "polygon" => ("Polygon", "Three and more sides of equal length"),
        Star = "star" => ("Star", "Points around an inner circle"),
        Line = "line" => ("Line", "A straight line, drawn by its outline"),
        Arrow = "arrow" => ("Arrow", "A shaft and a head, which are filled"),
        Balloon = "balloon" => ("Speech balloon", "An ellipse with a tail; drag the tip to who speaks"),
    }
}

number_settings! {
    /// A figure. Lengths are px of its plane.
    pub struct Figure {
        /// Of all but lines and arrows.
        rotation: "Rotation", "Counter-clockwise about its middle", TURNS, 0.0;
        /// Of rectangles, polygons and stars.
        corner: "Corners", "The radius of its corners", 0.0..=65_536.0, 0.0, px;
        /// Of polygons; the points of stars. A whole number.
        sides: "Sides", "The sides of a polygon, the points of a star", 3.0..=100.0, 5.0;
        /// Of stars.
        inner: "Inner radius", "Of a star, as a share of the outer one", 0.01..=1.0, 0.4;
        /// Of arrows.
        head: "Head", "The length of an arrow's head", 0.0..=65_536.0, 40.0, px;
        /// Of arrows.
        shaft: "Shaft", "The thickness of an arrow's shaft", 0.0..=65_536.0, 12.0, px;
        /// Of balloons.
        tail: "Tail", "How wide a balloon's tail begins", 0.0..=65_536.0, 24.0, px;
        /// Of balloons: where the tail ends.
        tail_x: "Tip, across", "From the middle, in halves of the width", -100.0..=100.0, -0.5;
        /// Of balloons.
        tail_y: "Tip, down", "From the middle, in halves of the height", -100.0..=100.0, 1.8;
        and
        /// What it is.
        kind: FigureKind = FigureKind::Rectangle;
        /// A corner of the box that it fills, before it is turned; the beginning of lines and
        /// arrows.
        from: Vec2 = Vec2::ZERO;
        /// The opposite corner; the end of lines and arrows.
        to: Vec2 = Vec2::ZERO;
    }
}

/// The length of the handles of a quarter circle of radius 1.
const QUARTER: f32 = 0.552_284_8;

/// The handles that are corners of a box.
const BOX_HANDLES: usize = 4;

/// Half of the widest tail of a balloon, radians of its ellipse.
const WIDEST_TAIL: f32 = 0.8;

impl FigureKind {
    /// The names of the numbers that a figure of this kind shows.
    pub fn numbers(self) -> &'static [&'static str] {
        match self {
            FigureKind::Rectangle => &["corner", "rotation"],
            FigureKind::Ellipse => &["rotation"],
            FigureKind::Polygon => &["sides", "corner", "rotation"],
            FigureKind::Star => &["sides", "inner", "corner", "rotation"],
            FigureKind::Line => &[],
            FigureKind::Arrow => &["head", "shaft"],
            FigureKind::Balloon => &["tail", "tail_x", "tail_y", "rotation"],
        }
    }

    /// Whether it runs from one point to another, and fills no box.
    pub fn is_along_line(self) -> bool {
        matches!(self, FigureKind::Line | FigureKind::Arrow)
    }
}

impl Figure {
    /// The middle of its box.
    pub fn center(&self) -> Vec2 {
        0.5 * (self.from + self.to)
    }

    /// Half of the sides of its box.
    fn half(&self) -> Vec2 {
        0.5 * (self.to - self.from).abs()
    }

    /// Its x axis, in the plane that it is turned in.
    fn axis(&self) -> Vec2 {
        // Counter-clockwise as seen is clockwise in y-down coordinates.
        Vec2::from_angle(-self.rotation.to_radians())
    }

    /// Where its handles lie: the four corners of its box, turned with it, and of balloons the tip
    /// of the tail; of lines and arrows the two ends.
    pub fn handles(&self) -> Vec<Vec2> {
        if self.kind.is_along_line() {
            return vec![self.from, self.to];
        }
        let (center, axis) = (self.center(), self.axis());
        let corners =
            [self.from, vec2(self.to.x, self.from.y), self.to, vec2(self.from.x, self.to.y)];
        let corners = corners.map(|corner| center + axis.rotate(corner - center));
        let tip = (self.kind == FigureKind::Balloon).then(|| self.tip());
        corners.into_iter().chain(tip).collect()
    }

    /// The corners of the box that its handles span.
    pub fn box_handles(&self) -> Vec<Vec2> {
        self.handles().into_iter().take(BOX_HANDLES).collect()
    }

    /// From the middle to the tip of a balloon's tail, before it is turned.
    fn tail(&self) -> Vec2 {
        self.half() * vec2(self.tail_x, self.tail_y)
    }

    /// Where a balloon's tail ends.
    fn tip(&self) -> Vec2 {
        self.center() + self.axis().rotate(self.tail())
    }

    /// The same balloon with its tail to a point, as far as the numbers allow.
    fn with_tip(&self, at: Vec2) -> Self {
        let axis = self.axis();
        let tail = vec2(axis.x, -axis.y).rotate(at - self.center()) / self.half();
        let limit =
            |to: f32, was: f32| if to.is_finite() { to.max(-100.0).min(100.0) } else { was };
        Self { tail_x: limit(tail.x, self.tail_x), tail_y: limit(tail.y, self.tail_y), ..*self }
    }

    /// The same figure with one of its handles at a point; the opposite one stays, and so does the
    /// tip of a balloon's tail.
    ///
    /// * `keeps_aspect`: its box keeps its aspect, a line one of eight directions.
    pub fn with_handle(&self, handle: usize, at: Vec2, keeps_aspect: bool) -> Self {
        let handles = self.handles();
        if self.kind.is_along_line() {
            let fixed = handles[(handle + 1) % 2];
            let at = if keeps_aspect { snap_to_compass(fixed, at) } else { at };
            return match handle {
                0 => Self { from: at, ..*self },
                _ => Self { to: at, ..*self },
            };
        }
        let is_balloon = self.kind == FigureKind::Balloon;
        if is_balloon && handle >= BOX_HANDLES {
            return self.with_tip(at);
        }
        let (fixed, axis) = (handles[(handle + 2) % BOX_HANDLES], self.axis());
        let mut across = vec2(axis.x, -axis.y).rotate(at - fixed);
        if keeps_aspect {
            across = with_aspect(across, self.half());
        }
        let center = fixed + 0.5 * axis.rotate(across);
        let signs = [vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0)];
        let half = 0.5 * across * signs[handle % BOX_HANDLES];
        Self { from: center - half, to: center + half, ..*self }.with_tail_of(self)
    }

    /// The same figure between two points of a drag.
    ///
    /// * `is_regular`: as wide as high; a line in one of eight directions.
    /// * `from_center`: the first point is its middle.
    pub fn between(&self, from: Vec2, to: Vec2, is_regular: bool, from_center: bool) -> Self {
        let to = match (is_regular, self.kind.is_along_line()) {
            (false, _) => to,
            (true, true) => snap_to_compass(from, to),
            (true, false) => from + with_aspect(to - from, Vec2::ONE),
        };
        let from = if from_center { from - (to - from) } else { from };
        Self { from, to, ..*self }
    }

    /// The same figure elsewhere.
    pub fn moved(&self, by: Vec2) -> Self {
        Self { from: self.from + by, to: self.to + by, ..*self }
    }

    /// The same figure elsewhere, but for the tip of a balloon's tail, which stays.
    pub fn moved_body(&self, by: Vec2) -> Self {
        self.moved(by).with_tail_of(self)
    }

    /// The same figure turned; the tip of a balloon's tail stays.
    pub fn turned(&self, rotation: f32) -> Self {
        Self { rotation, ..*self }.with_tail_of(self)
    }

    /// The same figure; a balloon's tail ends where that of another one does.
    fn with_tail_of(self, other: &Self) -> Self {
        if self.kind == FigureKind::Balloon { self.with_tip(other.tip()) } else { self }
    }

    /// Its lines.
    pub fn subpaths(&self) -> Vec<Subpath> {
        let (center, half, axis) = (self.center(), self.half(), self.axis());
        let in_plane = |line: Subpath| vec![line.mapped(|p| center + axis.rotate(p))];
        let sides = self.sides.round().max(3.0) as usize;
        match self.kind {
            FigureKind::Rectangle => {
                let corners =
                    [vec2(-half.x, -half.y), vec2(half.x, -half.y), half, vec2(-half.x, half.y)];
                in_plane(rounded(&corners, self.corner))
            }
            FigureKind::Ellipse => in_plane(ellipse(half)),
            FigureKind::Polygon => {
                let corners: Vec<Vec2> = (0..sides).map(|i| half * turn(i, sides)).collect();
                in_plane(rounded(&corners, self.corner))
            }
            FigureKind::Star => {
                let radius = |i: usize| if i.is_multiple_of(2) { 1.0 } else { self.inner };
                let corner = |i| half * radius(i) * turn(i, 2 * sides);
                let corners: Vec<Vec2> = (0..2 * sides).map(corner).collect();
                in_plane(rounded(&corners, self.corner))
            }
            FigureKind::Line => {
                let nodes = [self.from, self.to].map(PathNode::corner).to_vec();
                vec![Subpath { nodes, closed: false }]
            }
            FigureKind::Arrow => vec![self.arrow()],
            FigureKind::Balloon => in_plane(balloon(half, self.tail(), self.tail)),
        }
    }

    /// A shaft, and a head that is as wide as it is long.
    fn arrow(&self) -> Subpath {
        let (along, length) =
            ((self.to - self.from).normalize_or_zero(), self.from.distance(self.to));
        let head = self.head.min(length);
        let (neck, across) = (self.to - head * along, along.perp());
        let shaft = across * 0.5 * self.shaft.min(self.head);
        let wing = across * 0.5 * self.head;
        Subpath::polygon([
            self.from - shaft,
            neck - shaft,
            neck - wing,
            self.to,
            neck + wing,
            neck + shaft,
            self.from + shaft,
        ])
    }

    /// Whether a file can hold it.
    pub fn fits(&self) -> Result<(), String> {
        for setting in Self::SETTINGS {
            check_range(setting.label, (setting.get)(self), &setting.range)?;
        }
        [self.from, self.to].into_iter().try_for_each(|p| {
            check_range("a corner", p.x, &COORDINATE).and(check_range("a corner", p.y, &COORDINATE))
        })
    }
}

/// The direction of the i-th of n points around a circle, the first one at the top.
fn turn(i: usize, n: usize) -> Vec2 {
    let (sin, cos) = (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
    vec2(sin as f32, -cos as f32)
}

fn ellipse(half: Vec2) -> Subpath {
    let nodes = (0..4).map(|i| {
        let (at, along) = (turn(i, 4), turn(i + 1, 4));
        PathNode::smooth(half * at, QUARTER * half * along)
    });
    Subpath { nodes: nodes.collect(), closed: true }
}

/// An ellipse with a tail of a width to a tip; without one where the tip is inside.
fn balloon(half: Vec2, tip: Vec2, width: f32) -> Subpath {
    let on_circle = tip / half;
    let is_outside = on_circle.is_finite() && on_circle.length() > 1.0;
    if !is_outside || width <= 0.0 {
        return ellipse(half);
    }
    let middle = on_circle.to_angle();
    let px_per_radian = (half * Vec2::from_angle(middle).perp()).length();
    let aside = (0.5 * width / px_per_radian).min(WIDEST_TAIL);
    // The rest of the ellipse in four curves.
    let step = 0.25 * (std::f32::consts::TAU - 2.0 * aside);
    let handle = 4.0 / 3.0 * (0.25 * step).tan();
    let around = (0..=4).map(|i| {
        let direction = Vec2::from_angle(middle + aside + step * i as f32);
        let along = handle * half * direction.perp();
        let before = if i > 0 { -along } else { Vec2::ZERO };
        let after = if i < 4 { along } else { Vec2::ZERO };
        PathNode { before, after, ..PathNode::corner(half * direction) }
    });
    Subpath { nodes: around.chain([PathNode::corner(tip)]).collect(), closed: true }
}

/// A closed polygon whose corners are arcs of a radius, or of what the sides leave room for.
fn rounded(corners: &[Vec2], radius: f32) -> Subpath {
    if radius <= 0.0 {
        return Subpath::polygon(corners.iter().copied());
    }
    let n = corners.len();
    let mut nodes = Vec::with_capacity(2 * n);
    for i in 0..n {
        let (corner, last, next) = (corners[i], corners[(i + n - 1) % n], corners[(i + 1) % n]);
        let (to_last, to_next) = (last - corner, next - corner);
        let (a, b) = (to_last.normalize_or_zero(), to_next.normalize_or_zero());
        // Of the half angle between the sides.
        let cos = a.dot(b).max(-1.0).min(1.0);
        let tan = ((1.0 - cos) / (1.0 + cos).max(1e-6)).sqrt();
        let room = 0.5 * to_last.length().min(to_next.length());
        let cut = (radius / tan.max(1e-6)).min(room);
        if cut <= 0.0 || a == Vec2::ZERO || b == Vec2::ZERO {
            nodes.push(PathNode::corner(corner));
            continue;
        }
        // The arc turns by what the corner lacks to a straight line.
        let angle = std::f32::consts::PI - 2.0 * tan.atan();
        let handle = 4.0 / 3.0 * (0.25 * angle).tan() * cut * tan;
        let (first, second) = (corner + a * cut, corner + b * cut);
        nodes.push(PathNode { after: -a * handle, ..PathNode::corner(first) });
        nodes.push(PathNode { before: -b * handle, ..PathNode::corner(second) });
    }
    Subpath { nodes, closed: true }
}

/// The nearest of the eight directions of the compass.
pub(super) fn snap_to_compass(from: Vec2, to: Vec2) -> Vec2 {
    let step = std::f32::consts::FRAC_PI_4;
    let turn = ((to - from).to_angle() / step).round() * step;
    from + Vec2::from_angle(turn) * from.distance(to)
}

/// A diagonal of a box with an aspect, as long as the farther side needs.
fn with_aspect(across: Vec2, aspect: Vec2) -> Vec2 {
    let aspect = aspect.abs().max(Vec2::splat(1e-6));
    let scale = (across.abs() / aspect).max_element();
    let sign = |v: f32| if v < 0.0 { -1.0 } else { 1.0 };
    vec2(sign(across.x), sign(across.y)) * aspect * scale
}

#[cfg(test)]
mod tests;
