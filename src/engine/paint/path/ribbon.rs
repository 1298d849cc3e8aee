//! Outlines whose width differs from node to node: the area that a disc covers that runs along the
//! line and grows and shrinks on its way. Floor 3.

use super::subpath::{Subpath, even_point_at};
use crate::math::Vec2;
use tiny_skia::{Path, PathBuilder};

/// Whether the width of the outline differs along a line.
pub fn is_uneven(lines: &[Subpath]) -> bool {
    lines.iter().flat_map(|line| &line.nodes).any(|node| node.width != 1.0)
}

/// The area of the outline, to be filled by the nonzero rule; `None` where it covers nothing.
///
/// * `width`: where a node says 1.
/// * `scale`: how much larger than its plane it is seen.
pub fn of_lines(lines: &[Subpath], width: f32, scale: f32) -> Option<Path> {
    let mut path = PathBuilder::new();
    for line in lines {
        let mut last: Option<(Vec2, f32)> = None;
        for (i, curve) in line.curves().enumerate() {
            let [a, b] = line.ends(i).map(|node| 0.5 * width * node.width);
            let steps = count_steps(curve, scale);
            for step in 0..=steps {
                let t = step as f32 / steps as f32;
                let disc = (even_point_at(curve, t), a + (b - a) * t);
                push_disc(&mut path, disc);
                if let Some(before) = last {
                    push_side(&mut path, before, disc);
                }
                last = Some(disc);
            }
        }
        if let [node] = &line.nodes[..] {
            push_disc(&mut path, (node.at, 0.5 * width * node.width));
        }
    }
    path.finish()
}

/// Straight pieces of a curve, none longer than about 3 px as seen.
fn count_steps([a, b, c, d]: [Vec2; 4], scale: f32) -> usize {
    let length = a.distance(b) + b.distance(c) + c.distance(d);
    (length * scale / 3.0).ceil().max(8.0).min(1024.0) as usize
}

fn push_disc(path: &mut PathBuilder, (at, radius): (Vec2, f32)) {
    if radius > 0.0 {
        path.push_circle(at.x, at.y, radius);
    }
}

/// The quadrilateral that two discs' outer tangents enclose.
fn push_side(path: &mut PathBuilder, (a, radius_a): (Vec2, f32), (b, radius_b): (Vec2, f32)) {
    let (along, length) = ((b - a).normalize_or_zero(), a.distance(b));
    // One disc within the other has no tangents in common.
    let sin = (radius_a - radius_b) / length.max(1e-6);
    if length <= 0.0 || sin.abs() >= 1.0 {
        return;
    }
    let cos = (1.0 - sin * sin).sqrt();
    let [left, right] = [1.0, -1.0].map(|side| along * sin + along.perp() * cos * side);
    let corners =
        [a + left * radius_a, b + left * radius_b, b + right * radius_b, a + right * radius_a];
    // Turned as circles are, so that areas that lie over each other add up.
    let [first, rest @ ..] = if is_turned_as_circles(corners) {
        corners
    } else {
        [corners[3], corners[2], corners[1], corners[0]]
    };
    path.move_to(first.x, first.y);
    rest.iter().for_each(|p| path.line_to(p.x, p.y));
    path.close();
}

/// Whether a quadrilateral runs around clockwise as seen.
fn is_turned_as_circles([a, b, c, d]: [Vec2; 4]) -> bool {
    (c - a).perp_dot(d - b) > 0.0
}
