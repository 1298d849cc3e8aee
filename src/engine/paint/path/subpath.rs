//! One line of a path: nodes that cubic Bézier curves connect. Floor 3.

use crate::math::{Range, Vec2};

/// A node: a point that a path runs through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathNode {
    /// Where it is, px of the path's plane.
    pub at: Vec2,
    /// From it to the handle of the curve that arrives, px; zero: no handle.
    pub before: Vec2,
    /// From it to the handle of the curve that leaves, px.
    pub after: Vec2,
    /// How wide the outline is here, by its own width.
    pub width: f32,
}

/// Nodes in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Subpath {
    /// What it runs through.
    pub nodes: Vec<PathNode>,
    /// A curve runs from the last node to the first one.
    pub closed: bool,
}

impl PathNode {
    /// The range of a width, shares of the outline's own.
    pub const WIDTH: Range = 0.0..=100.0;

    /// A node without handles.
    pub fn corner(at: Vec2) -> Self {
        Self { at, before: Vec2::ZERO, after: Vec2::ZERO, width: 1.0 }
    }

    /// A node through which a curve runs straight on; `after`: the handle that leaves.
    pub fn smooth(at: Vec2, after: Vec2) -> Self {
        Self { at, before: -after, after, width: 1.0 }
    }

    /// Whether the path runs straight on here.
    pub fn is_smooth(&self) -> bool {
        let (before, after) = (self.before.normalize_or_zero(), self.after.normalize_or_zero());
        before != Vec2::ZERO && before.dot(after) < -0.999
    }
}

impl Subpath {
    /// A closed line through points, without handles.
    pub fn polygon(points: impl IntoIterator<Item = Vec2>) -> Self {
        Self { nodes: points.into_iter().map(PathNode::corner).collect(), closed: true }
    }

    /// The number of its curves.
    pub fn count_curves(&self) -> usize {
        let len = self.nodes.len();
        if self.closed && len > 1 { len } else { len.saturating_sub(1) }
    }

    /// The nodes at the ends of a curve.
    pub fn ends(&self, curve: usize) -> [PathNode; 2] {
        [self.nodes[curve], self.nodes[(curve + 1) % self.nodes.len()]]
    }

    /// The four points of each curve.
    pub fn curves(&self) -> impl Iterator<Item = [Vec2; 4]> + '_ {
        (0..self.count_curves()).map(|curve| {
            let [a, b] = self.ends(curve);
            [a.at, a.at + a.after, b.at + b.before, b.at]
        })
    }

    /// The same line the other way round; a closed one begins where it began.
    pub fn reversed(&self) -> Self {
        let turned = |node: &PathNode| PathNode { before: node.after, after: node.before, ..*node };
        let mut nodes: Vec<PathNode> = self.nodes.iter().rev().map(turned).collect();
        if self.closed && !nodes.is_empty() {
            nodes.rotate_right(1);
        }
        Self { nodes, ..*self }
    }

    /// The same line, moved by a map of its plane.
    pub fn mapped(&self, point: impl Fn(Vec2) -> Vec2) -> Self {
        let nodes = self.nodes.iter().map(|node| {
            let at = point(node.at);
            let handle = |by: Vec2| if by == Vec2::ZERO { by } else { point(node.at + by) - at };
            PathNode { at, before: handle(node.before), after: handle(node.after), ..*node }
        });
        Self { nodes: nodes.collect(), ..*self }
    }
}

/// The point of a curve at `t` in `[0, 1]`.
pub(super) fn point_at([a, b, c, d]: [Vec2; 4], t: f32) -> Vec2 {
    let s = 1.0 - t;
    s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d
}

/// As [`point_at`], at an even speed where the curve is straight for lack of handles.
pub(super) fn even_point_at(curve: [Vec2; 4], t: f32) -> Vec2 {
    let [a, b, c, d] = curve;
    if a == b && c == d { a.lerp(d, t) } else { point_at(curve, t) }
}

/// The two halves of a curve that is cut at `t`.
pub(super) fn split_at([a, b, c, d]: [Vec2; 4], t: f32) -> [[Vec2; 4]; 2] {
    let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
    let (abc, bcd) = (ab.lerp(bc, t), bc.lerp(cd, t));
    let middle = abc.lerp(bcd, t);
    [[a, ab, abc, middle], [middle, bcd, cd, d]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    #[test]
    fn a_reversed_line_runs_through_the_same_points() {
        let node = |x: f32, y: f32| PathNode::smooth(vec2(x, y), vec2(4.0, x));
        let nodes = vec![node(0.0, 0.0), node(10.0, 5.0), node(20.0, -5.0)];
        for closed in [false, true] {
            let line = Subpath { nodes: nodes.clone(), closed };
            let mut curves: Vec<_> =
                line.reversed().curves().map(|[a, b, c, d]| [d, c, b, a]).collect();
            curves.reverse();
            assert_eq!(curves, line.curves().collect::<Vec<_>>());
            assert_eq!(line.reversed().reversed(), line);
        }
        let closed = Subpath { nodes: nodes.clone(), closed: true };
        assert_eq!(closed.reversed().nodes[0].at, nodes[0].at);
    }

    #[test]
    fn a_cut_curve_runs_where_it_ran() {
        let curve = [vec2(0.0, 0.0), vec2(10.0, 30.0), vec2(50.0, -20.0), vec2(60.0, 10.0)];
        let [left, right] = split_at(curve, 0.3);
        for i in 0..=10 {
            let t = i as f32 / 10.0;
            let apart = point_at(left, t).distance(point_at(curve, 0.3 * t));
            let other = point_at(right, t).distance(point_at(curve, 0.3 + 0.7 * t));
            assert!(apart < 1e-4 && other < 1e-4, "{apart} {other}");
        }
    }

    #[test]
    fn a_closed_line_has_a_curve_more_than_an_open_one() {
        let triangle = Subpath::polygon([Vec2::ZERO, Vec2::X, Vec2::Y]);
        assert_eq!(triangle.count_curves(), 3);
        assert_eq!(Subpath { closed: false, ..triangle.clone() }.count_curves(), 2);
        assert_eq!(triangle.curves().last().map(|curve| curve[3]), Some(Vec2::ZERO));
        assert_eq!(Subpath::polygon([Vec2::X]).count_curves(), 0);
        assert_eq!(Subpath::default().count_curves(), 0);
    }
}
