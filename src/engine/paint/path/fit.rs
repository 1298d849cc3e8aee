//! Curves through closed lines of many points: corners stay, and between them as few curves as run
//! near enough. Floor 3.

use super::subpath::{PathNode, Subpath, point_at};
use crate::math::Vec2;

/// Points on either side of one between which the line turns at a corner.
const REACH: usize = 4;
/// The least turn that is a corner, radians.
const CORNER_RAD: f32 = 0.9;
/// How often points are given better places on their curve before it is cut.
const ROUNDS: usize = 4;

/// The closed path that runs no farther from the points than `error_px`.
pub fn fit_closed(points: &[Vec2], error_px: f32) -> Subpath {
    let n = points.len();
    if n < 3 {
        return Subpath::polygon(points.iter().copied());
    }
    let mut cuts = corners(points);
    if cuts.is_empty() {
        cuts = vec![0];
    }
    let is_corner = |i: usize| turn_at(points, i) >= CORNER_RAD;
    let mut curves: Vec<[Vec2; 4]> = Vec::new();
    for (k, &from) in cuts.iter().enumerate() {
        let to = cuts.get(k + 1).copied().unwrap_or(cuts[0] + n);
        let piece: Vec<Vec2> = (from..=to).map(|i| points[i % n]).collect();
        let along = |i: usize| points[(i + 1) % n] - points[(i + n - 1) % n];
        let leave = if is_corner(from) { lead(&piece) } else { along(from) };
        let arrive = if is_corner(to % n) {
            lead(&piece.iter().rev().copied().collect::<Vec<_>>())
        } else {
            -along(to % n)
        };
        fit(&piece, [leave.normalize_or_zero(), arrive.normalize_or_zero()], error_px, &mut curves);
    }
    of_curves(&curves)
}

/// The nodes between curves of which each begins where the last one ended.
fn of_curves(curves: &[[Vec2; 4]]) -> Subpath {
    let before = |i: usize| curves[(i + curves.len() - 1) % curves.len()];
    let nodes = curves.iter().enumerate().map(|(i, [a, b, ..])| {
        let [.., c, d] = before(i);
        PathNode { before: c - d, after: *b - *a, ..PathNode::corner(*a) }
    });
    Subpath { nodes: nodes.collect(), closed: true }
}

/// Where the line turns most, and enough.
fn corners(points: &[Vec2]) -> Vec<usize> {
    let n = points.len();
    let turns: Vec<f32> = (0..n).map(|i| turn_at(points, i)).collect();
    let is_most = |i: usize| {
        (1..=REACH).all(|by| turns[i] >= turns[(i + by) % n] && turns[i] > turns[(i + n - by) % n])
    };
    (0..n).filter(|&i| turns[i] >= CORNER_RAD && is_most(i)).collect()
}

/// How much the line turns about a point, radians.
fn turn_at(points: &[Vec2], i: usize) -> f32 {
    let n = points.len();
    let reach = REACH.min((n - 1) / 2).max(1);
    let (last, next) = (points[(i + n - reach) % n], points[(i + reach) % n]);
    let (a, b) = ((points[i] - last).normalize_or_zero(), (next - points[i]).normalize_or_zero());
    a.dot(b).max(-1.0).min(1.0).acos()
}

/// The direction in which a piece begins.
fn lead(piece: &[Vec2]) -> Vec2 {
    piece[REACH.min(piece.len() - 1)] - piece[0]
}

/// Curves along a piece that leave and arrive in two directions, each pointing into the piece.
fn fit(piece: &[Vec2], ways: [Vec2; 2], error_px: f32, out: &mut Vec<[Vec2; 4]>) {
    let (first, last) = (piece[0], piece[piece.len() - 1]);
    if piece.len() < 3 {
        let third = first.distance(last) / 3.0;
        out.push([first, first + ways[0] * third, last + ways[1] * third, last]);
        return;
    }
    let mut shares = shares_by_length(piece);
    let mut worst = 0;
    for _ in 0..ROUNDS {
        let curve = nearest_curve(piece, &shares, ways);
        let (farthest, apart) = farthest_point(piece, &shares, curve);
        if apart <= error_px {
            return out.push(curve);
        }
        worst = farthest;
        shares.iter_mut().zip(piece).for_each(|(t, p)| *t = nearer_share(curve, *p, *t));
    }
    let at = worst.max(1).min(piece.len() - 2);
    let reach = 2.min(at).min(piece.len() - 1 - at);
    let way = (piece[at + reach] - piece[at - reach]).normalize_or_zero();
    fit(&piece[..=at], [ways[0], -way], error_px, out);
    fit(&piece[at..], [way, ways[1]], error_px, out);
}

/// The share of the length up to each point.
fn shares_by_length(piece: &[Vec2]) -> Vec<f32> {
    let mut sum = 0.0;
    let steps = piece.windows(2).map(|pair| pair[0].distance(pair[1]));
    let mut shares: Vec<f32> = std::iter::once(0.0)
        .chain(steps.map(|step| {
            sum += step;
            sum
        }))
        .collect();
    shares.iter_mut().for_each(|share| *share /= sum.max(1e-6));
    shares
}

/// The curve with these directions at its ends that is nearest to the points by least squares: the
/// lengths of its two handles solve a system of two equations.
fn nearest_curve(piece: &[Vec2], shares: &[f32], ways: [Vec2; 2]) -> [Vec2; 4] {
    let (first, last) = (piece[0], piece[piece.len() - 1]);
    let ([mut aa, mut ab, mut bb], [mut ax, mut bx]) = ([0.0f32; 3], [0.0f32; 2]);
    for (p, &t) in piece.iter().zip(shares) {
        let s = 1.0 - t;
        let (a, b) = (ways[0] * (3.0 * s * s * t), ways[1] * (3.0 * s * t * t));
        let ends = first * (s * s * s + 3.0 * s * s * t) + last * (t * t * t + 3.0 * s * t * t);
        let rest = *p - ends;
        (aa, ab, bb) = (aa + a.dot(a), ab + a.dot(b), bb + b.dot(b));
        (ax, bx) = (ax + a.dot(rest), bx + b.dot(rest));
    }
    let length = first.distance(last);
    let determinant = aa * bb - ab * ab;
    let solved = [(ax * bb - bx * ab) / determinant, (bx * aa - ax * ab) / determinant];
    let is_good =
        |handle: f32| handle.is_finite() && handle > 1e-3 * length && handle < 4.0 * length;
    let [leave, arrive] = if solved.into_iter().all(is_good) { solved } else { [length / 3.0; 2] };
    [first, first + ways[0] * leave, last + ways[1] * arrive, last]
}

/// The point that lies farthest from its place on the curve, and how far.
fn farthest_point(piece: &[Vec2], shares: &[f32], curve: [Vec2; 4]) -> (usize, f32) {
    let apart = piece.iter().zip(shares).map(|(p, t)| point_at(curve, *t).distance(*p));
    apart.enumerate().fold((0, 0.0), |most, found| if found.1 > most.1 { found } else { most })
}

/// A step of Newton's method toward the place of the curve that is nearest to a point.
fn nearer_share(curve: [Vec2; 4], p: Vec2, t: f32) -> f32 {
    let [a, b, c, d] = curve;
    let s = 1.0 - t;
    let first = 3.0 * (s * s * (b - a) + 2.0 * s * t * (c - b) + t * t * (d - c));
    let second = 6.0 * (s * (c - 2.0 * b + a) + t * (d - 2.0 * c + b));
    let away = point_at(curve, t) - p;
    let slope = first.length_squared() + away.dot(second);
    if slope.abs() < 1e-9 { t } else { (t - away.dot(first) / slope).max(0.0).min(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use crate::paint::path::LivePath;

    #[test]
    fn a_circle_of_points_becomes_a_few_smooth_curves() {
        let point = |i: usize| {
            let (sin, cos) = (std::f32::consts::TAU * i as f32 / 300.0).sin_cos();
            vec2(100.0 + 50.0 * cos, 80.0 + 50.0 * sin)
        };
        let points: Vec<Vec2> = (0..300).map(point).collect();
        let line = fit_closed(&points, 0.3);
        assert!((3..=10).contains(&line.nodes.len()), "{}", line.nodes.len());
        assert!(line.nodes.iter().all(PathNode::is_smooth), "{line:?}");
        let path = LivePath::new(vec![line]);
        for p in points {
            assert!(path.curve_at(p, 0.35).is_some(), "{p}");
        }
    }

    #[test]
    fn corners_of_a_square_stay_corners() {
        let side = |from: Vec2, to: Vec2| (0..40).map(move |i| from.lerp(to, i as f32 / 40.0));
        let corners = [vec2(10.0, 10.0), vec2(90.0, 10.0), vec2(90.0, 90.0), vec2(10.0, 90.0)];
        let points: Vec<Vec2> =
            (0..4).flat_map(|i| side(corners[i], corners[(i + 1) % 4])).collect();
        let line = fit_closed(&points, 0.3);
        assert_eq!(line.nodes.len(), 4, "{line:?}");
        for corner in corners {
            assert!(line.nodes.iter().any(|node| node.at.distance(corner) < 0.5), "{line:?}");
        }
    }

    #[test]
    fn two_points_and_none_are_no_curves() {
        assert_eq!(fit_closed(&[], 0.3).nodes.len(), 0);
        assert_eq!(fit_closed(&[Vec2::ZERO, Vec2::X], 0.3).nodes.len(), 2);
    }
}
