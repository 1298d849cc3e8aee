//! Closed lines cut by a straight one: what lies on one side of it, closed along the cut. Floor 3.

use super::live_path::PathGeometry;
use super::subpath::{PathNode, Subpath, point_at, split_at};
use super::{Figure, FigureKind};
use crate::math::{Vec2, vec2};

/// Points as near to a cut as this lie on its left side, px.
const NEAR_PX: f64 = 1e-4;

/// Halvings of the part of a curve in which a crossing lies.
const HALVINGS: usize = 48;

/// A straight cut through the plane of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightCut {
    at: Vec2,
    /// Of length 1.
    along: Vec2,
}

/// A curve with the widths at its ends, all of it on one side.
#[derive(Clone, Copy)]
struct CutPiece {
    curve: [Vec2; 4],
    widths: [f32; 2],
}

/// Pieces of one line that lie on the kept side, from one crossing of the cut to the next.
struct CutChain {
    pieces: Vec<CutPiece>,
    /// Where it begins and ends along the cut, px.
    ends: [f32; 2],
}

impl StraightCut {
    /// The cut through two points; `None` where they are the same, or lie beyond all numbers.
    pub fn between(from: Vec2, to: Vec2) -> Option<Self> {
        let along = (to - from).try_normalize().filter(|along| along.is_finite())?;
        from.is_finite().then_some(Self { at: from, along })
    }

    /// The same cut the other way: its left side is the right one.
    pub fn reversed(self) -> Self {
        Self { along: -self.along, ..self }
    }

    /// The same cut through another plane; `None` where the map has no points for it.
    pub fn mapped(&self, map: impl Fn(Vec2) -> Option<Vec2>) -> Option<Self> {
        /// Far enough that rounding does not turn it, px.
        const REACH_PX: f32 = 256.0;
        let there = Self::between(map(self.at)?, map(self.at + REACH_PX * self.along)?)?;
        let left = map(self.at - REACH_PX * self.along.perp())?;
        Some(if there.side(left) > 0.0 { there } else { there.reversed() })
    }

    /// How far a point lies to the left as seen when going along the cut, y down, px.
    fn side(&self, p: Vec2) -> f64 {
        let (by, along) = (p.as_dvec2() - self.at.as_dvec2(), self.along.as_dvec2());
        let side = along.y * by.x - along.x * by.y;
        if side.abs() < NEAR_PX { NEAR_PX } else { side }
    }

    /// How far along the cut a point lies, px.
    fn place(&self, p: Vec2) -> f32 {
        self.along.dot(p - self.at)
    }

    /// What of the inside of lines lies to the left of the cut as seen when going along it. Open
    /// lines count as closed ones.
    pub fn left_of(&self, lines: &[Subpath]) -> Vec<Subpath> {
        let (mut kept, mut chains) = (Vec::new(), Vec::new());
        for line in lines.iter().filter(|line| line.nodes.len() > 1) {
            let line = Subpath { closed: true, ..line.clone() };
            let pieces = self.pieces(&line);
            match pieces.iter().position(|(_, is_left)| !is_left) {
                None => kept.push(line),
                Some(outside) => self.push_chains(pieces, outside, &mut chains),
            }
        }
        kept.extend(join(&chains));
        kept
    }

    /// The curves of a closed line, parted where they cross the cut, and whether each lies to the
    /// left of it.
    fn pieces(&self, line: &Subpath) -> Vec<(CutPiece, bool)> {
        let mut out = Vec::new();
        for (i, curve) in line.curves().enumerate() {
            let mut rest = CutPiece { curve, widths: line.ends(i).map(|node| node.width) };
            let mut done = 0.0;
            for t in self.crossings(curve) {
                let (piece, after) = rest.split((t - done) / (1.0 - done));
                let (piece, after) = self.meet(piece, after);
                out.push((piece, self.is_left(&piece)));
                (rest, done) = (after, t);
            }
            out.push((rest, self.is_left(&rest)));
        }
        out
    }

    /// Two pieces whose common end lies on the cut exactly.
    fn meet(&self, mut before: CutPiece, mut after: CutPiece) -> (CutPiece, CutPiece) {
        let at = before.curve[3];
        let on_cut = match (self.along.x == 0.0, self.along.y == 0.0) {
            (true, _) => vec2(self.at.x, at.y),
            (_, true) => vec2(at.x, self.at.y),
            _ => self.at + self.along * self.place(at),
        };
        let by = on_cut - at;
        for p in [&mut before.curve[2], &mut after.curve[1]] {
            *p = if *p == at { on_cut } else { *p + by };
        }
        (before.curve[3], after.curve[0]) = (on_cut, on_cut);
        (before, after)
    }

    /// Whether a piece that does not cross the cut lies to the left.
    fn is_left(&self, piece: &CutPiece) -> bool {
        self.side(piece.middle()) > 0.0
    }

    /// Where a curve crosses the cut, in order, in `(0, 1)`.
    fn crossings(&self, curve: [Vec2; 4]) -> Vec<f32> {
        let [a, b, c, d] = curve.map(|p| self.side(p));
        let is_straight = is_straight(&curve);
        let side = |t: f64| {
            let s = 1.0 - t;
            match is_straight {
                true => s * a + t * d,
                false => s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d,
            }
        };
        // Between its turning points the distance only rises or only falls.
        let turns = if is_straight { Vec::new() } else { turning_points([a, b, c, d]) };
        let stops: Vec<f64> = [0.0].into_iter().chain(turns).chain([1.0]).collect();
        let mut found = Vec::new();
        for ends in stops.windows(2) {
            let (mut low, mut high) = (ends[0], ends[1]);
            if (side(low) > 0.0) == (side(high) > 0.0) {
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                match (side(middle) > 0.0) == (side(low) > 0.0) {
                    true => low = middle,
                    false => high = middle,
                }
            }
            found.push((0.5 * (low + high)) as f32);
        }
        found.retain(|t| *t > 0.0 && *t < 1.0);
        found.dedup();
        found
    }

    /// The runs of pieces on the left, of a line that has a piece on the right.
    fn push_chains(
        &self,
        pieces: Vec<(CutPiece, bool)>,
        outside: usize,
        chains: &mut Vec<CutChain>,
    ) {
        let mut run: Vec<CutPiece> = Vec::new();
        let mut end = |run: &mut Vec<CutPiece>| {
            if let (Some(first), Some(last)) = (run.first(), run.last()) {
                let ends = [self.place(first.curve[0]), self.place(last.curve[3])];
                chains.push(CutChain { pieces: std::mem::take(run), ends });
            }
        };
        let len = pieces.len();
        for i in 0..=len {
            let (piece, is_left) = pieces[(outside + i) % len];
            match is_left {
                true => run.push(piece),
                false => end(&mut run),
            }
        }
    }
}

impl CutPiece {
    /// Both parts of it.
    fn split(&self, t: f32) -> (Self, Self) {
        let [from, to] = self.widths;
        let width = from + (to - from) * t;
        let [left, right] = match is_straight(&self.curve) {
            true => {
                let [a, .., d] = self.curve;
                // What is the same at both ends stays so.
                let along = |a: f32, d: f32| if a == d { a } else { a + (d - a) * t };
                let at = vec2(along(a.x, d.x), along(a.y, d.y));
                [[a, a, at, at], [at, at, d, d]]
            }
            false => split_at(self.curve, t),
        };
        let part = |curve, widths| Self { curve, widths };
        (part(left, [from, width]), part(right, [width, to]))
    }

    fn middle(&self) -> Vec2 {
        let [a, .., d] = self.curve;
        if is_straight(&self.curve) { a.lerp(d, 0.5) } else { point_at(self.curve, 0.5) }
    }
}

/// Chains closed along the cut: seen along it, two crossings after each other bound what is inside.
fn join(chains: &[CutChain]) -> Vec<Subpath> {
    // Each crossing by its chain, and whether the chain ends there.
    let mut crossings: Vec<(usize, bool)> =
        (0..chains.len()).flat_map(|i| [(i, false), (i, true)]).collect();
    let place = |(chain, is_end): &(usize, bool)| chains[*chain].ends[usize::from(*is_end)];
    crossings.sort_by(|a, b| place(a).total_cmp(&place(b)));
    let next = |chain: usize| {
        let at = crossings.iter().position(|crossing| *crossing == (chain, true))?;
        let (other, is_end) = *crossings.get(at ^ 1)?;
        (!is_end).then_some(other)
    };
    let mut is_used = vec![false; chains.len()];
    let mut lines = Vec::new();
    for first in 0..chains.len() {
        let mut line = Vec::new();
        let mut chain = Some(first);
        while let Some(here) = chain.filter(|here| !is_used[*here]) {
            is_used[here] = true;
            line.push(here);
            chain = next(here);
        }
        if !line.is_empty() {
            lines.push(close(line.into_iter().map(|chain| &chains[chain])));
        }
    }
    lines
}

/// One closed line of chains; between them it runs straight.
fn close<'c>(chains: impl Iterator<Item = &'c CutChain>) -> Subpath {
    let mut nodes: Vec<PathNode> = Vec::new();
    for chain in chains {
        for (i, CutPiece { curve: [a, b, c, d], widths }) in chain.pieces.iter().enumerate() {
            match nodes.last_mut().filter(|_| i > 0) {
                Some(node) => node.after = *b - *a,
                None => nodes.push(PathNode {
                    after: *b - *a,
                    width: widths[0],
                    ..PathNode::corner(*a)
                }),
            }
            let before = *c - *d;
            nodes.push(PathNode { before, width: widths[1], ..PathNode::corner(*d) });
        }
    }
    Subpath { nodes, closed: true }
}

fn is_straight([a, b, c, d]: &[Vec2; 4]) -> bool {
    a == b && c == d
}

/// Where the values of a cubic curve turn, in order, in `(0, 1)`.
fn turning_points([a, b, c, d]: [f64; 4]) -> Vec<f64> {
    // A third of the derivative: u + 2 v t + w t².
    let (u, v, w) = (b - a, a - 2.0 * b + c, d - 3.0 * c + 3.0 * b - a);
    let mut found = if w.abs() < 1e-12 {
        if v == 0.0 { Vec::new() } else { vec![-u / (2.0 * v)] }
    } else {
        let root = v * v - u * w;
        let root = if root < 0.0 { return Vec::new() } else { root.sqrt() };
        vec![(-v - root) / w, (-v + root) / w]
    };
    found.retain(|t| *t > 0.0 && *t < 1.0);
    found.sort_by(f64::total_cmp);
    found
}

impl PathGeometry {
    /// Lines as a rectangle if they are one that lies level, else as nodes.
    pub fn of_lines(lines: Vec<Subpath>) -> Self {
        let rectangle = match &lines[..] {
            [line] => level_rectangle(line),
            _ => None,
        };
        rectangle.map_or(PathGeometry::Nodes(lines), PathGeometry::Figure)
    }
}

fn level_rectangle(line: &Subpath) -> Option<Figure> {
    let plain = |node: &PathNode| *node == PathNode::corner(node.at);
    let [a, b, c, d] = &line.nodes[..] else { return None };
    let is_level = (a.at.x == d.at.x && b.at.x == c.at.x && a.at.y == b.at.y && c.at.y == d.at.y)
        || (a.at.y == d.at.y && b.at.y == c.at.y && a.at.x == b.at.x && c.at.x == d.at.x);
    let (from, to) = (a.at.min(c.at), a.at.max(c.at));
    (line.closed && is_level && line.nodes.iter().all(plain) && from.x < to.x && from.y < to.y)
        .then_some(Figure { kind: FigureKind::Rectangle, from, to, ..Figure::DEFAULT })
}

impl Subpath {
    /// The area that a closed line runs around, px², of its nodes and handles.
    pub fn area_px(&self) -> f32 {
        let points: Vec<Vec2> = self.flatten(&Some).map_or(Vec::new(), |flat| flat.points);
        let twice = |(a, b): (&Vec2, &Vec2)| {
            f64::from(a.x) * f64::from(b.y) - f64::from(b.x) * f64::from(a.y)
        };
        let sum: f64 = points.iter().zip(points.iter().cycle().skip(1)).map(twice).sum();
        (0.5 * sum.abs()) as f32
    }
}

/// The corners of the box around lines; `None` without nodes.
pub(super) fn box_of(lines: &[Subpath]) -> Option<[Vec2; 2]> {
    let flat = lines.iter().filter_map(|line| line.flatten(&Some)).flat_map(|line| line.points);
    flat.map(|p| [p, p]).reduce(|[low, high], [p, _]| [low.min(p), high.max(p)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(from: (f32, f32), to: (f32, f32)) -> StraightCut {
        StraightCut::between(from.into(), to.into()).unwrap()
    }

    fn square() -> Vec<Subpath> {
        vec![Subpath::polygon([vec2(0.0, 0.0), vec2(10.0, 0.0), vec2(10.0, 10.0), vec2(0.0, 10.0)])]
    }

    fn area(lines: &[Subpath]) -> f32 {
        lines.iter().map(Subpath::area_px).sum()
    }

    #[test]
    fn a_square_is_cut_in_rectangles_and_in_corners() {
        // Going down, the left side as seen is the east.
        let down = cut((4.0, 0.0), (4.0, 1.0));
        let east = PathGeometry::of_lines(down.left_of(&square()));
        let rectangle = |from, to| PathGeometry::Figure(Figure { from, to, ..Figure::DEFAULT });
        assert_eq!(east, rectangle(vec2(4.0, 0.0), vec2(10.0, 10.0)));
        let west = PathGeometry::of_lines(down.reversed().left_of(&square()));
        assert_eq!(west, rectangle(vec2(0.0, 0.0), vec2(4.0, 10.0)));
        let corner = cut((0.0, 6.0), (6.0, 0.0));
        let (a, b) = (corner.left_of(&square()), corner.reversed().left_of(&square()));
        assert!((area(&a) - 18.0).abs() < 1e-4 && (area(&b) - 82.0).abs() < 1e-4);
        assert_eq!((a[0].nodes.len(), b[0].nodes.len()), (3, 5));
        assert_eq!(cut((20.0, 0.0), (20.0, 1.0)).left_of(&square()), []);
        assert_eq!(cut((-5.0, 0.0), (-5.0, 1.0)).left_of(&square()), square());
        assert!(StraightCut::between(Vec2::ONE, Vec2::ONE).is_none());
        assert!(StraightCut::between(Vec2::NAN, Vec2::ONE).is_none());
    }

    #[test]
    fn what_a_cut_leaves_of_a_hollow_shape_is_apart() {
        // A U: the cut through both legs leaves two pieces above and one below.
        let u = [
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 8.0),
            (6.0, 8.0),
            (6.0, 0.0),
            (10.0, 0.0),
            (10.0, 10.0),
            (0.0, 10.0),
        ];
        let u = vec![Subpath::polygon(u.map(|(x, y)| vec2(x, y)))];
        let level = cut((0.0, 5.0), (1.0, 5.0));
        let (above, below) = (level.left_of(&u), level.reversed().left_of(&u));
        assert_eq!((above.len(), area(&above)), (2, 40.0));
        assert_eq!((below.len(), area(&below)), (1, 44.0));
        // A ring is two lines; cut in the middle, each half is one.
        let hole =
            Subpath::polygon([vec2(3.0, 3.0), vec2(7.0, 3.0), vec2(7.0, 7.0), vec2(3.0, 7.0)]);
        let ring = [square(), vec![hole.reversed()]].concat();
        let half = level.left_of(&ring);
        assert_eq!((half.len(), area(&half)), (1, 42.0));
    }

    #[test]
    fn curves_run_on_as_they_ran() {
        let (from, to) = (vec2(0.0, 0.0), vec2(20.0, 20.0));
        let circle = Figure { kind: FigureKind::Ellipse, from, to, ..Figure::DEFAULT }.subpaths();
        let slanted = cut((10.0, 10.0), (13.0, 14.0));
        let halves = [slanted.left_of(&circle), slanted.reversed().left_of(&circle)];
        for half in &halves {
            // The area is that of a polygon, whose sides run within a twentieth of a pixel.
            assert!((area(half) - 50.0 * std::f32::consts::PI).abs() < 1.5, "{}", area(half));
            let flat = half[0].flatten(&Some).unwrap();
            let middle = vec2(10.0, 10.0);
            let on_circle = flat.points.iter().filter(|p| (p.distance(middle) - 10.0).abs() < 0.01);
            assert!(on_circle.count() > 15);
        }
        // Touched only, it stays whole.
        assert_eq!(cut((0.0, 20.0), (1.0, 20.0)).left_of(&circle), circle);
    }

    #[test]
    fn widths_go_along() {
        let mut lines = square();
        lines[0].nodes[1].width = 3.0;
        let half = cut((5.0, 0.0), (5.0, 1.0)).reversed().left_of(&lines);
        let at = half[0].nodes.iter().find(|node| node.at == vec2(5.0, 0.0)).unwrap();
        assert_eq!(at.width, 2.0);
    }
}
