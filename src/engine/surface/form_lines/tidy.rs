//! What is left of traced lines: those that are clear enough, smooth, joined over gaps, of some
//! length, and no two at one place. Floor 2. Not here: tracing (`outlines`, `fields`).

mod line_grid;

use super::{FormLine, LineKind, LinePoint, LineSettings};
use crate::math::Vec2;
use crate::surface::line_ends::{JoinedEnds, LineEnd, LineGap, StrungLine};
use line_grid::{NearPoint, NearPoints};

/// A line as it was traced.
#[derive(Clone, Debug)]
pub struct RawLine {
    pub kind: LineKind,
    pub points: Vec<LinePoint>,
    pub is_closed: bool,
}

/// From one point to the next, px.
const STEP_PX: f32 = 1.0;
/// A line starts where it is clearer than the first, and goes on where it is clearer than the
/// second of it.
const FADES_TO: f32 = 0.35;
/// Gaps that are closed, px, and the cosine of the angle within which both sides agree: 20°.
const JOIN_PX: f32 = 3.0;
const JOIN_COS: f32 = 0.94;
/// The cosine from which a line turns a corner, 45°, and how far both ways it is measured, px.
const CORNER_COS: f32 = 0.7;
const CORNER_PX: usize = 5;
/// Two lines nearer than this are one, px, where the cosine of their angle is at least this.
const DOUBLE_PX: f32 = 2.0;
const DOUBLE_COS: f32 = 0.7;
/// An end this near to another line is joined to it, px.
const JOINT_PX: f32 = 3.5;
/// Points at the ends of a line that double nothing: other lines go on there.
const ENDS: usize = 3;

/// Traced lines that are clear enough, smooth, joined over gaps and of some length.
pub fn smooth_lines(lines: Vec<RawLine>, settings: &LineSettings) -> Vec<FormLine> {
    let clear = lines.into_iter().flat_map(|line| clear_runs(line, settings.detail));
    let smooth = clear.flat_map(|line| {
        let even = RawLine { points: resample(&line.points, line.is_closed), ..line };
        split_at_corners(even).into_iter().map(smooth_line)
    });
    let joined = join_over_gaps(smooth.collect());
    joined.into_iter().map(to_line).filter(|line| is_long(line, settings)).collect()
}

/// Adds lines, by kind and the longest first, where none is yet.
///
/// * `lines`: of earlier kinds.
pub fn add_lines(lines: &mut Vec<FormLine>, mut more: Vec<FormLine>, settings: &LineSettings) {
    // Ties are broken by place, so that the order of tracing does not matter.
    let key = |line: &FormLine| {
        let first = line.points.first().map_or([0; 2], |p| p.at.to_array().map(f32::to_bits));
        (line.kind, std::cmp::Reverse(line.points.len()), first)
    };
    more.sort_by_key(key);
    if more.is_empty() {
        return;
    }
    let mut known = NearPoints::default();
    for (i, line) in lines.iter().enumerate() {
        known.add(i as u32, line.kind, &line.points);
    }
    for line in more {
        for part in without_doubles(line, &known, settings) {
            if is_long(&part, settings) {
                known.add(lines.len() as u32, part.kind, &part.points);
                lines.push(part);
            }
        }
    }
}

/// Lines as a hand would draw them: with gaps behind what is in front, and joined where they meet.
pub fn finish_lines(mut lines: Vec<FormLine>, settings: &LineSettings) -> Vec<FormLine> {
    if settings.gap > 0.0 {
        lines = open_gaps(lines, settings);
    }
    find_joints(&mut lines);
    lines
}

fn is_long(line: &FormLine, settings: &LineSettings) -> bool {
    line.points.len() > 2 && line.length_px() >= settings.shortest
}

fn to_line(raw: RawLine) -> FormLine {
    let RawLine { kind, points, is_closed } = raw;
    FormLine { kind, points, is_closed, is_joined: [false; 2] }
}

/// The kinds that fade out.
fn is_fading(kind: LineKind) -> bool {
    matches!(kind, LineKind::Valley | LineKind::Suggestive | LineKind::Ridge | LineKind::Color)
}

/// The runs of a line that are clear enough.
fn clear_runs(line: RawLine, detail: f32) -> Vec<RawLine> {
    if !is_fading(line.kind) {
        return vec![line];
    }
    let high = (0.95 - 0.9 * detail).max(0.02);
    let low = high * FADES_TO;
    let runs = runs(line, |_, point| point.strength >= low);
    let is_clear = |run: &RawLine| run.points.iter().any(|point| point.strength >= high);
    runs.into_iter().filter(is_clear).collect()
}

/// The runs of points that are kept. A loop that is cut begins after a cut.
fn runs(mut line: RawLine, keeps: impl Fn(usize, &LinePoint) -> bool) -> Vec<RawLine> {
    let mut kept: Vec<bool> = line.points.iter().enumerate().map(|(i, p)| keeps(i, p)).collect();
    if kept.iter().all(|kept| *kept) {
        return vec![line];
    }
    if line.is_closed {
        let first = kept.iter().position(|kept| !kept).unwrap_or(0);
        line.points.rotate_left(first);
        kept.rotate_left(first);
    }
    let mut all = Vec::new();
    let mut run = Vec::new();
    for (point, kept) in line.points.iter().zip(kept.iter().copied()) {
        if kept {
            run.push(*point);
        } else if !run.is_empty() {
            all.push(std::mem::take(&mut run));
        }
    }
    all.push(run);
    let to_raw = |points| RawLine { kind: line.kind, points, is_closed: false };
    all.into_iter().filter(|points: &Vec<LinePoint>| points.len() > 1).map(to_raw).collect()
}

/// Points a pixel apart along a line.
fn resample(points: &[LinePoint], is_closed: bool) -> Vec<LinePoint> {
    let mut path = points.to_vec();
    if is_closed {
        path.extend(points.first().copied());
    }
    let length: f32 = path.windows(2).map(|pair| pair[0].at.distance(pair[1].at)).sum();
    let count = (length / STEP_PX).round().max(1.0) as usize;
    let step = length / count as f32;
    let mut even = Vec::with_capacity(count + 1);
    let (mut left, mut wanted) = (0.0, 0.0);
    for pair in path.windows(2) {
        let way = pair[0].at.distance(pair[1].at);
        while wanted <= left + way && even.len() < count {
            let t = if way > 0.0 { ((wanted - left) / way).clamp(0.0, 1.0) } else { 0.0 };
            let strength = pair[0].strength + t * (pair[1].strength - pair[0].strength);
            even.push(LinePoint { at: pair[0].at.lerp(pair[1].at, t), strength });
            wanted += step;
        }
        left += way;
    }
    if !is_closed {
        even.extend(path.last().copied());
    }
    even
}

/// The pieces between sharp corners.
fn split_at_corners(mut line: RawLine) -> Vec<RawLine> {
    let n = line.points.len();
    if !LineKind::SHARP.contains(&line.kind) || n < 4 * CORNER_PX {
        return vec![line];
    }
    let cos = |i: usize| {
        let at = |k: isize| {
            let k = i as isize + k;
            let k =
                if line.is_closed { k.rem_euclid(n as isize) } else { k.clamp(0, n as isize - 1) };
            line.points[k as usize].at
        };
        let reach = CORNER_PX as isize;
        let is_end = !line.is_closed && (i < CORNER_PX || i + CORNER_PX >= n);
        let turn = |a: Vec2, b: Vec2| a.normalize_or_zero().dot(b.normalize_or_zero());
        if is_end { 1.0 } else { turn(at(0) - at(-reach), at(reach) - at(0)) }
    };
    let turns: Vec<f32> = (0..n).map(cos).collect();
    let is_corner = |i: usize| {
        let near = (1..=CORNER_PX).all(|k| {
            let before = turns[(i + n - k) % n];
            let after = turns[(i + k) % n];
            turns[i] <= before && turns[i] < after
        });
        turns[i] < CORNER_COS && near
    };
    let mut corners: Vec<usize> = (0..n).filter(|&i| is_corner(i)).collect();
    let Some(&first) = corners.first() else { return vec![line] };
    if line.is_closed {
        line.points.rotate_left(first);
        line.points.extend(line.points.first().copied());
        corners = corners.into_iter().skip(1).map(|i| i - first).collect();
    }
    corners.push(line.points.len() - 1);
    let mut from = 0;
    let mut pieces = Vec::new();
    for to in corners {
        let points = line.points[from..=to].to_vec();
        pieces.push(RawLine { kind: line.kind, points, is_closed: false });
        from = to;
    }
    pieces
}

/// Smooth without shrinking (Taubin 1995); ends stay.
fn smooth_line(mut line: RawLine) -> RawLine {
    const PASSES: usize = 4;
    let n = line.points.len();
    if n < 5 {
        return line;
    }
    for pass in 0..2 * PASSES {
        let share = if pass % 2 == 0 { 0.5 } else { -0.51 };
        let from: Vec<LinePoint> = line.points.clone();
        for (i, point) in line.points.iter_mut().enumerate() {
            let (before, after) = match (i, line.is_closed) {
                (0, false) => continue,
                (i, false) if i + 1 == n => continue,
                (i, _) => (from[(i + n - 1) % n], from[(i + 1) % n]),
            };
            point.at += share * (0.5 * (before.at + after.at) - from[i].at);
            let mean = 0.5 * (before.strength + after.strength);
            point.strength += 0.5 * (mean - from[i].strength);
        }
    }
    line
}

/// Lines of one kind whose ends are near and point at each other, as one.
fn join_over_gaps(lines: Vec<RawLine>) -> Vec<RawLine> {
    let open = lines.iter().enumerate().filter(|(_, l)| !l.is_closed && l.points.len() > 1);
    let ends = open.flat_map(|(i, line)| LineEnd::both_of(i, line.points.iter().map(|p| p.at)));
    let ends: Vec<LineEnd> = ends.collect();
    let mut joined = JoinedEnds::default();
    joined.join(&ends, LineGap { px: JOIN_PX, cos: JOIN_COS }, |a, b| {
        a.line != b.line && lines[a.line].kind == lines[b.line].kind
    });
    let string = |strung: StrungLine| {
        let points = strung.parts.iter().flat_map(|(part, is_reversed)| {
            let mut points = lines[*part].points.clone();
            if *is_reversed {
                points.reverse();
            }
            points
        });
        let first = &lines[strung.parts[0].0];
        let is_closed = first.is_closed || strung.is_closed;
        RawLine { kind: first.kind, points: points.collect(), is_closed }
    };
    joined.string_lines(lines.len()).into_iter().map(string).collect()
}

/// The parts of a line that no line of an earlier kind, nor a longer one, runs along.
fn without_doubles(line: FormLine, known: &NearPoints, settings: &LineSettings) -> Vec<FormLine> {
    let near_px = match line.kind {
        LineKind::Outline | LineKind::Wire => DOUBLE_PX,
        LineKind::Crease | LineKind::Border => DOUBLE_PX + 1.0,
        // Blurred normals turn along the rim of a form.
        _ => DOUBLE_PX + 1.0 + settings.smooth,
    };
    let along = directions(&line.points, line.is_closed);
    let is_double = |i: usize, point: &LinePoint| {
        known.has_within(point.at, near_px, |other: &NearPoint| {
            let reach = if other.kind == line.kind { DOUBLE_PX } else { near_px };
            let has_wire = other.kind == LineKind::Wire || line.kind == LineKind::Wire;
            let is_comparable = other.kind == line.kind || !has_wire;
            is_comparable
                && !other.is_end
                && other.at.distance(point.at) < reach
                && other.along.dot(along[i]).abs() >= DOUBLE_COS
        })
    };
    let raw = RawLine { kind: line.kind, points: line.points, is_closed: line.is_closed };
    runs(raw, |i, point| !is_double(i, point)).into_iter().map(to_line).collect()
}

/// Lines with gaps behind outlines in front of them.
fn open_gaps(lines: Vec<FormLine>, settings: &LineSettings) -> Vec<FormLine> {
    let mut fronts = NearPoints::default();
    for (i, line) in lines.iter().enumerate().filter(|(_, line)| line.kind == LineKind::Outline) {
        fronts.add(i as u32, line.kind, &line.points);
    }
    let cut = |(i, line): (usize, FormLine)| {
        let hides = |point: &LinePoint| {
            let nearest = fronts.nearest(point.at, settings.gap, |o| o.line != i as u32);
            nearest.is_some_and(|o| !o.is_end && o.along.perp_dot(point.at - o.at) > 0.5)
        };
        let raw = RawLine { kind: line.kind, points: line.points, is_closed: line.is_closed };
        runs(raw, |_, point| !hides(point)).into_iter().map(to_line)
    };
    let parts = lines.into_iter().enumerate().flat_map(cut);
    parts.filter(|line| is_long(line, settings)).collect()
}

/// Tells which ends of lines lie on other lines.
fn find_joints(lines: &mut [FormLine]) {
    let mut known = NearPoints::default();
    for (i, line) in lines.iter().enumerate() {
        known.add(i as u32, line.kind, &line.points);
    }
    for (i, line) in lines.iter_mut().enumerate().filter(|(_, line)| !line.is_closed) {
        let is_on_other = |point: Option<&LinePoint>| {
            point.is_some_and(|point| {
                known.has_within(point.at, JOINT_PX, |other| other.line != i as u32)
            })
        };
        line.is_joined = [is_on_other(line.points.first()), is_on_other(line.points.last())];
    }
}

/// The direction at each point, unit.
fn directions(points: &[LinePoint], is_closed: bool) -> Vec<Vec2> {
    let n = points.len();
    let at = |i: isize| {
        let i = if is_closed { i.rem_euclid(n as isize) } else { i.clamp(0, n as isize - 1) };
        points[i as usize].at
    };
    (0..n as isize).map(|i| (at(i + 2) - at(i - 2)).normalize_or_zero()).collect()
}
