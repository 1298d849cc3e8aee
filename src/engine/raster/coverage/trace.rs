//! The edge of coverage as closed lines: where it is half, between the middles of pixels. Floor 1.
//! Not here: curves along it (`paint::path`), the sides of pixels (`contour`).

use super::CoverageGrid;
use crate::math::{Rect, Vec2, vec2};
use std::collections::{HashMap, HashSet};

/// Coverage of half a pixel.
const LEVEL: f32 = 127.5;

/// A side between the middles of two neighboring pixels: the left or upper one, and whether the
/// other lies below it.
type PixelSide = (i32, i32, bool);

/// The lines around what is covered by half and more, the covered side on the same hand all along:
/// lines around holes run the other way. Canvas px.
pub fn trace(grid: &CoverageGrid) -> Vec<Vec<Vec2>> {
    let covered = grid.covered_rect();
    let area = Rect { x0: covered.x0 - 1, y0: covered.y0 - 1, ..covered };
    let mut next: HashMap<PixelSide, PixelSide> = HashMap::new();
    let mut order: Vec<PixelSide> = Vec::new();
    for y in area.y0..area.y1 {
        let mut left = [grid.at(area.x0, y), grid.at(area.x0, y + 1)];
        for x in area.x0..area.x1 {
            let right = [grid.at(x + 1, y), grid.at(x + 1, y + 1)];
            for (from, to) in crossings((x, y), [left[0], right[0], right[1], left[1]]) {
                next.insert(from, to);
                order.push(from);
            }
            left = right;
        }
    }
    let mut seen: HashSet<PixelSide> = HashSet::new();
    let mut lines = Vec::new();
    for first in order {
        let (mut line, mut side) = (Vec::new(), first);
        while seen.insert(side) {
            line.push(place(grid, side));
            let Some(to) = next.get(&side) else { break };
            side = *to;
        }
        if line.len() >= 3 {
            lines.push(line);
        }
    }
    lines
}

/// How lines cross the square between the middles of four pixels: from which side to which.
///
/// * `corners`: the coverage at its upper left, upper right, lower right and lower left.
fn crossings((x, y): (i32, i32), corners: [u8; 4]) -> impl Iterator<Item = (PixelSide, PixelSide)> {
    let sides: [PixelSide; 4] = [(x, y, false), (x + 1, y, true), (x, y + 1, false), (x, y, true)];
    let is_in = corners.map(|corner| f32::from(corner) > LEVEL);
    // A line comes in by a side whose corners, clockwise, go from outside to inside.
    let enters = move |i: usize| !is_in[i] && is_in[(i + 1) % 4];
    let leaves = move |i: usize| is_in[i] && !is_in[(i + 1) % 4];
    // Of two lines through a square, each runs around its own covered corner.
    (0..4).filter(move |&i| enters(i)).filter_map(move |i| {
        let to = (1..4).map(|by| (i + by) % 4).find(|&j| leaves(j))?;
        Some((sides[i], sides[to]))
    })
}

/// Where coverage is half on a side.
fn place(grid: &CoverageGrid, (x, y, is_down): PixelSide) -> Vec2 {
    let (dx, dy) = if is_down { (0, 1) } else { (1, 0) };
    let [a, b] = [grid.at(x, y), grid.at(x + dx, y + dy)].map(f32::from);
    let share = if a == b { 0.5 } else { (LEVEL - a) / (b - a) };
    vec2(x as f32 + 0.5, y as f32 + 0.5) + vec2(dx as f32, dy as f32) * share
}

#[cfg(test)]
mod tests {
    use super::super::shapes;
    use super::*;

    const CANVAS: Rect = Rect::new(0, 0, 200, 150);

    /// Twice the area that a line runs around, by its hand.
    fn turn(line: &[Vec2]) -> f32 {
        let next = line.iter().cycle().skip(1);
        line.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
    }

    #[test]
    fn the_edge_of_an_ellipse_runs_where_it_was_drawn() {
        let grid = shapes::ellipse(vec2(20.0, 30.0), vec2(120.0, 90.0), CANVAS);
        let lines = trace(&grid);
        assert_eq!(lines.len(), 1);
        for p in &lines[0] {
            let r = ((*p - vec2(70.0, 60.0)) / vec2(50.0, 30.0)).length();
            assert!((r - 1.0).abs() < 0.02, "{p} {r}");
        }
    }

    #[test]
    fn holes_run_the_other_way_and_pieces_are_lines_of_their_own() {
        let square = |a: f32, b: f32| [vec2(a, a), vec2(b, a), vec2(b, b), vec2(a, b)];
        let (outer, inner) = (square(10.0, 90.0), square(30.0, 60.0));
        let beside = square(100.0, 140.0);
        let grid = shapes::polygons(&[&outer, &inner, &beside], true, CANVAS);
        let mut turns: Vec<f32> = trace(&grid).iter().map(|line| turn(line)).collect();
        turns.sort_by(f32::total_cmp);
        // Outer lines run counter-clockwise as seen, which is negative where y runs down.
        for (turn, area) in turns.iter().zip([-6400.0, -1600.0, 900.0]) {
            assert!((turn / 2.0 - area).abs() < 2.0, "{turns:?}");
        }
    }

    #[test]
    fn nothing_has_no_edge_and_the_edge_of_the_canvas_is_one() {
        assert!(trace(&CoverageGrid::default()).is_empty());
        let lines = trace(&CoverageGrid::full(CANVAS));
        assert_eq!(lines.len(), 1);
        let corners: Vec<&Vec2> = lines[0].iter().filter(|p| p.x < 0.51 && p.y < 0.51).collect();
        assert!(!corners.is_empty());
    }
}
