//! Lines that go on beyond a gap: their ends that face each other, and the lines that are strung
//! together there. Floor 2. Not here: which lines may be joined (`form_lines::tidy`,
//! `hatching::bridges`).

use crate::math::Vec2;
use std::collections::HashMap;

/// An end of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineEnd {
    /// Which line.
    pub line: usize,
    /// Whether it is its last point, or else its first.
    pub is_last: bool,
    pub at: Vec2,
    /// The direction in which the line would go on, of length 1.
    pub out: Vec2,
}

impl LineEnd {
    /// Both ends of a line, whose directions are those of the last few points.
    pub fn both_of(line: usize, points: impl ExactSizeIterator<Item = Vec2> + Clone) -> [Self; 2] {
        let last = points.len().saturating_sub(1);
        let place = |i: usize| points.clone().nth(i).unwrap_or_default();
        [false, true].map(|is_last| {
            let (end, inner) =
                if is_last { (last, last.saturating_sub(4)) } else { (0, last.min(4)) };
            let (at, from) = (place(end), place(inner));
            Self { line, is_last, at, out: (at - from).normalize_or_zero() }
        })
    }

    fn key(&self) -> EndKey {
        (self.line, self.is_last)
    }
}

/// A line, and which end of it.
type EndKey = (usize, bool);

/// How far apart two ends are, and how well they face each other, to be joined.
#[derive(Clone, Copy, Debug)]
pub struct LineGap {
    /// The widest gap, px.
    pub px: f32,
    /// The least cosine between both directions, and between each and the gap.
    pub cos: f32,
}

impl LineGap {
    fn is_between(&self, a: &LineEnd, b: &LineEnd) -> bool {
        let gap = b.at - a.at;
        let is_ahead = gap.length() < 0.5 || a.out.dot(gap.normalize_or_zero()) >= self.cos;
        gap.length() <= self.px && a.out.dot(-b.out) >= self.cos && is_ahead
    }
}

/// Which ends go on in which.
#[derive(Debug, Default)]
pub struct JoinedEnds {
    mates: HashMap<EndKey, EndKey>,
}

/// Several lines as one.
#[derive(Debug, PartialEq)]
pub struct StrungLine {
    /// Its lines in their order; each whether it is reversed.
    pub parts: Vec<(usize, bool)>,
    /// Whether its last line goes on in its first.
    pub is_closed: bool,
}

impl JoinedEnds {
    /// Joins ends that face each other over a gap, the nearest first, each to one at most.
    ///
    /// * `can_join`: what else must hold; it is asked of ends in their order.
    pub fn join(
        &mut self,
        ends: &[LineEnd],
        gap: LineGap,
        mut can_join: impl FnMut(&LineEnd, &LineEnd) -> bool,
    ) {
        let cell = |at: Vec2| (at / gap.px.max(1e-3)).floor().as_ivec2();
        let mut grid: HashMap<(i32, i32), Vec<usize>> = HashMap::new();
        for (i, end) in ends.iter().enumerate() {
            grid.entry(cell(end.at).into()).or_default().push(i);
        }
        let mut pairs = Vec::new();
        for (i, end) in ends.iter().enumerate() {
            let c = cell(end.at);
            let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (c.x + dx, c.y + dy)));
            for j in around.filter_map(|c| grid.get(&c)).flatten().copied() {
                if j > i && gap.is_between(end, &ends[j]) {
                    pairs.push((ends[j].at.distance(end.at), i, j));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, i, j) in pairs {
            let (a, b) = (&ends[i], &ends[j]);
            let is_open = |end: &LineEnd| !self.mates.contains_key(&end.key());
            if is_open(a) && is_open(b) && can_join(a, b) {
                self.mates.insert(a.key(), b.key());
                self.mates.insert(b.key(), a.key());
            }
        }
    }

    /// So many lines, strung together where their ends are joined.
    pub fn string_lines(&self, count: usize) -> Vec<StrungLine> {
        let mut used = vec![false; count];
        let mut all = Vec::with_capacity(count);
        // First those that begin with an open end, then rings of lines.
        for only_open in [true, false] {
            for i in 0..count {
                for is_last in [false, true] {
                    if used[i] || only_open && self.mates.contains_key(&(i, is_last)) {
                        continue;
                    }
                    let mut line = StrungLine { parts: Vec::new(), is_closed: false };
                    let mut entered = (i, is_last);
                    loop {
                        used[entered.0] = true;
                        line.parts.push(entered);
                        match self.mates.get(&(entered.0, !entered.1)) {
                            Some(next) if !used[next.0] => entered = *next,
                            Some(next) => {
                                line.is_closed = *next == (i, is_last) && !only_open;
                                break;
                            }
                            None => break,
                        }
                    }
                    all.push(line);
                }
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    fn ends(lines: &[[Vec2; 2]]) -> Vec<LineEnd> {
        lines.iter().enumerate().flat_map(|(i, l)| LineEnd::both_of(i, l.iter().copied())).collect()
    }

    #[test]
    fn lines_that_face_each_other_are_strung_together_whichever_way_they_run() {
        let lines = [
            [vec2(0.0, 0.0), vec2(10.0, 0.0)],
            [vec2(22.0, 0.5), vec2(12.0, 0.3)],
            [vec2(0.0, 5.0), vec2(10.0, 5.0)],
        ];
        let mut joined = JoinedEnds::default();
        joined.join(&ends(&lines), LineGap { px: 3.0, cos: 0.94 }, |_, _| true);
        let strung = joined.string_lines(3);
        let line = |parts: &[(usize, bool)]| StrungLine { parts: parts.to_vec(), is_closed: false };
        assert_eq!(strung, [line(&[(0, false), (1, true)]), line(&[(2, false)])]);
    }

    #[test]
    fn a_line_that_faces_itself_is_a_ring() {
        let ring: Vec<Vec2> = (0..60).map(|i| 20.0 * Vec2::from_angle(0.1 * i as f32)).collect();
        let ends = LineEnd::both_of(0, ring.iter().copied());
        let mut joined = JoinedEnds::default();
        joined.join(&ends, LineGap { px: 12.0, cos: 0.7 }, |_, _| true);
        assert_eq!(
            joined.string_lines(1),
            [StrungLine { parts: vec![(0, false)], is_closed: true }]
        );
    }
}
