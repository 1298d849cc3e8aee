//! Polygons that may cross themselves and each other, such as outlines, as exact coverage: each
//! pixel holds the share of it that lies inside. Floor 1. Not here: polygons whose winding number is
//! averaged over a pixel (`shapes`), which is faster, and exact where no edges cross in it.

use super::shapes::{add_piece, edges};
use crate::math::{Rect, Vec2, vec2};

/// With more edges in a row of pixels, it is cut into so many lines, each as its middle is.
const MOST_EDGES: usize = 96;
const LINES: usize = 32;

/// How much of each pixel lies inside of polygons by the nonzero rule, over the rows of a rectangle
/// that they reach, the top row first; on the calling thread alone.
///
/// * `visit`: is told a row's y and its coverage.
pub fn visit_rows(lines: &[Vec<Vec2>], within: Rect, mut visit: impl FnMut(i32, &[u8])) {
    let lines = || lines.iter().map(Vec::as_slice).filter(|corners| corners.len() >= 3);
    if within.is_empty() || lines().flatten().any(|p| !p.is_finite()) {
        return;
    }
    let mut edges: Vec<Edge> = edges(lines()).into_iter().map(Edge::of).collect();
    edges.sort_by(|a, b| a.top.y.total_cmp(&b.top.y));
    let mut waiting = edges.into_iter().peekable();
    let mut active: Vec<Edge> = Vec::new();
    let mut row = CoverageRow::of(within.width());
    for y in within.y0..within.y1 {
        let (top, bottom) = (y as f32, (y + 1) as f32);
        while let Some(edge) = waiting.next_if(|edge| edge.top.y < bottom) {
            active.push(edge);
        }
        active.retain(|edge| edge.bottom.y > top);
        if active.is_empty() {
            match waiting.peek() {
                Some(_) => continue,
                None => break,
            }
        }
        let place = vec2(within.x0 as f32, top);
        let inside: Vec<Edge> = active.iter().filter_map(|edge| edge.within_row(place)).collect();
        match inside.len() <= MOST_EDGES {
            true => row.add_exactly(&inside),
            false => row.add_lines(&inside),
        }
        visit(y, row.finish());
    }
}

/// An edge from its upper end to its lower one.
#[derive(Clone, Copy)]
struct Edge {
    top: Vec2,
    bottom: Vec2,
    /// What it adds to the winding number of what lies to the right of it.
    turn: i32,
}

impl Edge {
    fn of([a, b]: [Vec2; 2]) -> Self {
        match a.y < b.y {
            true => Self { top: a, bottom: b, turn: 1 },
            false => Self { top: b, bottom: a, turn: -1 },
        }
    }

    fn x_at(&self, y: f32) -> f64 {
        let [x0, y0, x1, y1] = [self.top.x, self.top.y, self.bottom.x, self.bottom.y];
        let t = (f64::from(y) - f64::from(y0)) / (f64::from(y1) - f64::from(y0));
        f64::from(x0) + (f64::from(x1) - f64::from(x0)) * t.max(0.0).min(1.0)
    }

    /// The part within a row of pixels, from the row's corner.
    fn within_row(&self, corner: Vec2) -> Option<Self> {
        let (top, bottom) = (self.top.y.max(corner.y), self.bottom.y.min(corner.y + 1.0));
        let at = |y: f32| vec2((self.x_at(y) - f64::from(corner.x)) as f32, y - corner.y);
        (top < bottom).then(|| Self { top: at(top), bottom: at(bottom), ..*self })
    }

    /// Where two cross between their ends.
    fn crossing(&self, other: &Self) -> Option<f32> {
        let (top, bottom) = (self.top.y.max(other.top.y), self.bottom.y.min(other.bottom.y));
        if top >= bottom {
            return None;
        }
        let apart = |y: f32| self.x_at(y) - other.x_at(y);
        let (above, below) = (apart(top), apart(bottom));
        let is_crossing = above * below < 0.0;
        is_crossing.then(|| top + (bottom - top) * (above / (above - below)) as f32)
    }
}

/// A row of pixels in the making.
struct CoverageRow {
    /// What the running sum along the row changes by.
    changes: Vec<f32>,
    bytes: Vec<u8>,
}

impl CoverageRow {
    fn of(width: usize) -> Self {
        Self { changes: vec![0.0; width + 2], bytes: vec![0; width] }
    }

    /// Cuts the row where edges begin, end or cross: between two cuts what lies inside is bounded by
    /// whole edges.
    fn add_exactly(&mut self, edges: &[Edge]) {
        let mut cuts: Vec<f32> =
            edges.iter().flat_map(|edge| [edge.top.y, edge.bottom.y]).collect();
        for (i, edge) in edges.iter().enumerate() {
            cuts.extend(edges[i + 1..].iter().filter_map(|other| edge.crossing(other)));
        }
        cuts.sort_by(f32::total_cmp);
        cuts.dedup();
        for cut in cuts.windows(2) {
            let (top, bottom) = (cut[0], cut[1]);
            let spans = |edge: &&Edge| edge.top.y <= top && edge.bottom.y >= bottom;
            let ends = edges.iter().filter(spans);
            let ends = ends.map(|edge| ([edge.x_at(top), edge.x_at(bottom)], edge.turn));
            self.add_between(ends.collect(), f64::from(bottom) - f64::from(top));
        }
    }

    fn add_lines(&mut self, edges: &[Edge]) {
        for line in 0..LINES {
            let y = (line as f32 + 0.5) / LINES as f32;
            let crossed = edges.iter().filter(|edge| edge.top.y <= y && edge.bottom.y > y);
            let ends = crossed.map(|edge| ([edge.x_at(y); 2], edge.turn));
            self.add_between(ends.collect(), 1.0 / LINES as f64);
        }
    }

    /// Adds what lies inside of edges that do not cross.
    ///
    /// * `ends`: where each begins above and ends below, and its turn.
    fn add_between(&mut self, mut ends: Vec<([f64; 2], i32)>, height: f64) {
        ends.sort_by(|([a, b], _), ([c, d], _)| (a + b).total_cmp(&(c + d)));
        let width = self.bytes.len() as f64;
        let mut winding = 0;
        for ([above, below], turn) in ends {
            let was_inside = winding != 0;
            winding += turn;
            let is_inside = winding != 0;
            if was_inside != is_inside {
                let height = if is_inside { height } else { -height };
                add_piece(&mut self.changes, width, above, below, height);
            }
        }
    }

    /// The coverage of the row, which begins anew.
    fn finish(&mut self) -> &[u8] {
        let mut share = 0.0f32;
        for (to, change) in self.bytes.iter_mut().zip(&self.changes) {
            share += change;
            *to = (share.max(0.0).min(1.0) * 255.0 + 0.5) as u8;
        }
        self.changes.fill(0.0);
        &self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash;

    const ROOM: Rect = Rect::new(-3, 2, 45, 40);

    /// The share of a pixel that is inside, over 64 × 64 points.
    fn sampled(lines: &[Vec<Vec2>], x: i32, y: i32) -> f32 {
        let is_inside = |p: Vec2| {
            let mut winding = 0;
            for line in lines {
                for (a, b) in line.iter().zip(line.iter().cycle().skip(1)) {
                    let crosses = (a.y <= p.y) != (b.y <= p.y);
                    if crosses && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                        winding += if b.y > a.y { 1 } else { -1 };
                    }
                }
            }
            winding != 0
        };
        let at = |i: i32| vec2((i % 64) as f32 + 0.5, (i / 64) as f32 + 0.5) / 64.0;
        let points = (0..4096).map(|i| vec2(x as f32, y as f32) + at(i));
        points.filter(|p| is_inside(*p)).count() as f32 / 4096.0
    }

    fn greatest_difference(lines: &[Vec<Vec2>]) -> f32 {
        let mut rows = vec![vec![0u8; ROOM.width()]; ROOM.height()];
        visit_rows(lines, ROOM, |y, row| rows[(y - ROOM.y0) as usize].copy_from_slice(row));
        let mut most = 0.0f32;
        for (y, row) in (ROOM.y0..).zip(&rows) {
            for (x, byte) in (ROOM.x0..).zip(row) {
                most = most.max((f32::from(*byte) - 255.0 * sampled(lines, x, y)).abs());
            }
        }
        most
    }

    fn random_lines(seed: u32, lines: u32, corners: u32) -> Vec<Vec<Vec2>> {
        let number = |i: u32, k: u32| hash::unit(seed, i, k);
        let corner = |i: u32| vec2(number(i, 0) * 60.0 - 10.0, number(i, 1) * 50.0 - 4.0);
        let line = |line: u32| (0..corners).map(|i| corner(line * 1000 + i)).collect();
        (0..lines).map(line).collect()
    }

    #[test]
    fn polygons_that_cross_cover_what_points_within_pixels_say() {
        for seed in 0..6 {
            let apart = greatest_difference(&random_lines(seed, 1 + seed % 3, 7));
            assert!(apart < 4.0, "{seed}: {apart}");
        }
    }

    #[test]
    fn a_row_with_many_edges_is_nearly_as_exact() {
        let apart = greatest_difference(&random_lines(9, 4, 60));
        assert!(apart < 20.0, "{apart}");
    }

    #[test]
    fn areas_that_run_against_each_other_do_not_cancel_each_other() {
        let square =
            |x: f32| vec![vec2(x, 10.2), vec2(x + 9.5, 10.2), vec2(x + 9.5, 20.0), vec2(x, 20.0)];
        let against = square(14.5).into_iter().rev().collect();
        let apart = greatest_difference(&[square(5.25), against]);
        assert!(apart < 4.0, "{apart}");
    }

    #[test]
    fn nothing_is_visited_of_nothing() {
        let beyond = vec![vec2(0.0, 90.0), vec2(9.0, 90.0), vec2(0.0, 99.0)];
        let mut rows = 0;
        for line in [vec![vec2(0.0, 0.0); 2], vec![vec2(f32::NAN, 0.0); 3], beyond] {
            visit_rows(&[line], ROOM, |_, _| rows += 1);
        }
        assert_eq!(rows, 0);
    }
}
