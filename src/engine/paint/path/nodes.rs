//! Edits of a path's nodes: found at a point, moved, added, taken away. Floor 3.

use super::live_path::LivePath;
use super::subpath::{PathNode, Subpath, point_at, split_at};
use crate::math::Vec2;

/// A node of a path by the number of its line and its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathPlace {
    /// The line.
    pub line: usize,
    /// The node of the line.
    pub node: usize,
}

/// A node itself, or one of its handles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeHandle {
    /// The node.
    Node,
    /// The handle of the curve that arrives.
    Before,
    /// The handle of the curve that leaves.
    After,
}

/// Points of a curve that are compared with a point.
const PROBES: usize = 48;

impl LivePath {
    /// The node or handle that is nearest to a point and not farther than a distance; handles only
    /// of `shown`, and only where they are apart from their node.
    pub fn handle_at(
        &self,
        at: Vec2,
        within: f32,
        shown: Option<PathPlace>,
    ) -> Option<(PathPlace, NodeHandle)> {
        let lines = self.subpaths();
        let mut found: Option<(f32, PathPlace, NodeHandle)> = None;
        let mut offer = |p: Vec2, place: PathPlace, handle: NodeHandle| {
            let distance = p.distance(at);
            if distance <= within && found.is_none_or(|(nearest, ..)| distance < nearest) {
                found = Some((distance, place, handle));
            }
        };
        for (place, node) in places(&lines) {
            offer(node.at, place, NodeHandle::Node);
            if shown == Some(place) {
                let handles = [(NodeHandle::Before, node.before), (NodeHandle::After, node.after)];
                for (handle, by) in handles.into_iter().filter(|(_, by)| *by != Vec2::ZERO) {
                    offer(node.at + by, place, handle);
                }
            }
        }
        found.map(|(_, place, handle)| (place, handle))
    }

    /// The curve that runs nearest to a point and not farther than a distance, by the node that it
    /// leaves, and where on it, in `[0, 1]`.
    pub fn curve_at(&self, at: Vec2, within: f32) -> Option<(PathPlace, f32)> {
        let mut found: Option<(f32, PathPlace, f32)> = None;
        for (line, subpath) in self.subpaths().iter().enumerate() {
            for (node, curve) in subpath.curves().enumerate() {
                let (distance, t) = nearest_on(curve, at);
                if distance <= within && found.is_none_or(|(nearest, ..)| distance < nearest) {
                    found = Some((distance, PathPlace { line, node }, t));
                }
            }
        }
        found.map(|(_, place, t)| (place, t))
    }

    /// The node at a place.
    pub fn node(&self, place: PathPlace) -> Option<PathNode> {
        self.subpaths().get(place.line)?.nodes.get(place.node).copied()
    }

    /// The same path with other nodes; figures become nodes.
    pub fn with_nodes(&self, change: impl FnOnce(&mut Vec<Subpath>)) -> Self {
        let mut lines = self.subpaths().into_owned();
        change(&mut lines);
        lines.retain(|line| !line.nodes.is_empty());
        self.with_lines(lines)
    }

    /// A node or one of its handles moved to a point.
    ///
    /// * `breaks`: the other handle stays where it is; else it stays on the line of a smooth node.
    pub fn with_handle(
        &self,
        place: PathPlace,
        handle: NodeHandle,
        to: Vec2,
        breaks: bool,
    ) -> Self {
        self.with_nodes(|lines| {
            let Some(node) = lines.get_mut(place.line).and_then(|l| l.nodes.get_mut(place.node))
            else {
                return;
            };
            let is_smooth = node.is_smooth() && !breaks;
            let by = to - node.at;
            let (own, other) = match handle {
                NodeHandle::Node => return node.at = to,
                NodeHandle::Before => (&mut node.before, &mut node.after),
                NodeHandle::After => (&mut node.after, &mut node.before),
            };
            *own = by;
            if is_smooth && by != Vec2::ZERO {
                *other = -by.normalize_or_zero() * other.length();
            }
        })
    }

    /// Another node on a curve, which runs where it ran.
    pub fn with_added_node(&self, after: PathPlace, t: f32) -> Self {
        self.with_nodes(|lines| {
            let Some(line) = lines.get_mut(after.line).filter(|l| after.node < l.count_curves())
            else {
                return;
            };
            let [a, b] = line.ends(after.node);
            let curve = [a.at, a.at + a.after, b.at + b.before, b.at];
            let [[_, left, before, at], [_, next, right, _]] = split_at(curve, t);
            let is_straight = a.after == Vec2::ZERO && b.before == Vec2::ZERO;
            let mut node = PathNode::corner(at);
            node.width = a.width + (b.width - a.width) * t;
            if !is_straight {
                (node.before, node.after) = (before - at, next - at);
                let end = (after.node + 1) % line.nodes.len();
                line.nodes[after.node].after = left - a.at;
                line.nodes[end].before = right - b.at;
            }
            line.nodes.insert(after.node + 1, node);
        })
    }

    /// The same path without a node.
    pub fn without_node(&self, place: PathPlace) -> Self {
        self.with_nodes(|lines| {
            if let Some(line) = lines.get_mut(place.line)
                && place.node < line.nodes.len()
            {
                line.nodes.remove(place.node);
            }
        })
    }

    /// A corner becomes smooth, its handles a third of the way along its neighbors; a smooth node
    /// becomes a corner.
    pub fn with_turned_node(&self, place: PathPlace) -> Self {
        self.with_nodes(|lines| {
            let Some(line) = lines.get_mut(place.line) else { return };
            let (len, i) = (line.nodes.len(), place.node);
            let Some(node) = line.nodes.get(i).copied() else { return };
            let is_corner = node.before == Vec2::ZERO && node.after == Vec2::ZERO;
            let neighbor = |by: usize| match line.closed {
                true => line.nodes[(i + len + by - 1) % len].at,
                false => line.nodes[(i + by).saturating_sub(1).min(len - 1)].at,
            };
            let (last, next) = (neighbor(0), neighbor(2));
            let along = (next - last).normalize_or_zero();
            let (before, after) = match is_corner {
                true => {
                    (-along * node.at.distance(last) / 3.0, along * node.at.distance(next) / 3.0)
                }
                false => (Vec2::ZERO, Vec2::ZERO),
            };
            line.nodes[i] = PathNode { before, after, ..node };
        })
    }
}

/// All nodes with their places.
fn places(lines: &[Subpath]) -> impl Iterator<Item = (PathPlace, &PathNode)> {
    lines.iter().enumerate().flat_map(|(line, subpath)| {
        subpath.nodes.iter().enumerate().map(move |(node, at)| (PathPlace { line, node }, at))
    })
}

/// How far a curve runs from a point, and where it is nearest.
fn nearest_on(curve: [Vec2; 4], at: Vec2) -> (f32, f32) {
    let distance = |t: f32| point_at(curve, t).distance(at);
    let probe = |i: usize| i as f32 / PROBES as f32;
    let nearest = (0..=PROBES).map(probe).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    let (mut t, mut step) = (nearest.unwrap_or(0.0), 0.5 / PROBES as f32);
    for _ in 0..12 {
        let around = [t, (t - step).max(0.0), (t + step).min(1.0)];
        t = around.into_iter().min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(t);
        step *= 0.5;
    }
    (distance(t), t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    fn wave() -> LivePath {
        let nodes = vec![
            PathNode::smooth(vec2(0.0, 0.0), vec2(20.0, 10.0)),
            PathNode::smooth(vec2(100.0, 0.0), vec2(10.0, -20.0)),
            PathNode::corner(vec2(200.0, 50.0)),
        ];
        LivePath::new(vec![Subpath { nodes, closed: false }])
    }

    const SECOND: PathPlace = PathPlace { line: 0, node: 1 };

    #[test]
    fn an_added_node_leaves_the_line_as_it_runs() {
        let old = wave();
        let at = vec2(50.0, 4.0);
        let (place, t) = old.curve_at(at, 20.0).unwrap();
        assert_eq!(place, PathPlace { line: 0, node: 0 });
        let new = old.with_added_node(place, t);
        assert_eq!(new.count_nodes(), 4);
        for i in 0..=40 {
            let p = point_at(old.subpaths()[0].curves().next().unwrap(), i as f32 / 40.0);
            assert!(new.curve_at(p, 0.05).is_some(), "{p}");
        }
        assert!(old.curve_at(vec2(50.0, 90.0), 20.0).is_none());
    }

    #[test]
    fn a_smooth_node_stays_smooth_until_its_handle_is_broken() {
        let moved = wave().with_handle(SECOND, NodeHandle::After, vec2(130.0, 40.0), false);
        let node = moved.node(SECOND).unwrap();
        assert!(node.is_smooth() && (node.before.length() - 500f32.sqrt()).abs() < 1e-3);
        let broken = wave().with_handle(SECOND, NodeHandle::After, vec2(130.0, 40.0), true);
        let node = broken.node(SECOND).unwrap();
        assert!(!node.is_smooth() && node.before == vec2(-10.0, 20.0));
        let dragged = wave().with_handle(SECOND, NodeHandle::Node, vec2(90.0, 9.0), false);
        assert_eq!(dragged.node(SECOND).unwrap().after, vec2(10.0, -20.0));
    }

    #[test]
    fn handles_are_found_only_where_they_are_shown() {
        let path = wave();
        let at = vec2(110.0, -20.0);
        assert_eq!(path.handle_at(at, 4.0, None), None);
        let found = path.handle_at(at, 4.0, Some(SECOND));
        assert_eq!(found, Some((SECOND, NodeHandle::After)));
        let node = path.handle_at(vec2(101.0, 1.0), 4.0, None);
        assert_eq!(node, Some((SECOND, NodeHandle::Node)));
    }

    #[test]
    fn nodes_are_taken_away_and_lines_with_them() {
        let mut path = wave();
        for left in [2, 1, 0] {
            path = path.without_node(PathPlace { line: 0, node: 0 });
            assert_eq!(path.count_nodes(), left);
        }
        assert!(path.subpaths().is_empty());
        assert_eq!(path.without_node(SECOND).count_nodes(), 0, "there is none");
    }

    #[test]
    fn a_turned_corner_is_smooth_and_a_turned_smooth_node_a_corner() {
        let place = PathPlace { line: 0, node: 2 };
        let smooth = wave().with_turned_node(place);
        assert!(smooth.node(place).unwrap().before != Vec2::ZERO);
        let corner = wave().with_turned_node(SECOND);
        assert_eq!(corner.node(SECOND).unwrap().after, Vec2::ZERO);
    }
}
