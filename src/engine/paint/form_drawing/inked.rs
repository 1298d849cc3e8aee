//! Lines that the ink of a drawing or a hand draws already, and what is left of others. Floor 3. Not here:
//! where that ink is (`document::form_sources`), lines that double each other (`form_lines::tidy`).

use crate::math::Vec2;
use crate::raster::{TILE, TileAt, TileGrid};
use crate::surface::form_lines::{FormLine, FormLines, LineKind, LinePoint, LineSettings};
use crate::surface::hatching::GuideLines;
use std::collections::HashMap;

/// A line this near to ink is the same line, px.
const REACH_PX: f32 = 3.0;
/// The coverage of a pixel from which it is ink.
const LEAST_COVERAGE: u8 = 96;
/// A line this near to a stroke that stands in its place is that line, canvas px, where both differ
/// by less than 40°, cos.
const REDRAWN_PX: f32 = 6.0;
const REDRAWN_COS: f32 = 0.77;
/// A line along fewer points of ink only passes it.
const LEAST_POINTS: usize = 10;

/// Ink on a canvas.
#[derive(Clone)]
pub struct InkOnCanvas {
    /// What ink layers show.
    layers: Vec<TileGrid>,
    /// Strokes that stand in the place of lines.
    strokes: GuideLines,
    /// How many px of the canvas a px of these is.
    scale: f32,
}

impl Default for InkOnCanvas {
    fn default() -> Self {
        Self { layers: Vec::new(), strokes: GuideLines::none(), scale: 1.0 }
    }
}

impl InkOnCanvas {
    /// What ink layers show.
    pub fn of(layers: impl IntoIterator<Item = TileGrid>) -> Self {
        Self { layers: layers.into_iter().collect(), ..Self::default() }
    }

    /// With strokes that stand in the place of lines.
    pub fn with_strokes(self, strokes: GuideLines) -> Self {
        Self { strokes, ..self }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.layers.is_empty() && self.strokes.is_empty()
    }

    /// The same on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let strokes = self.strokes.scaled(factor);
        Self { layers: self.layers.clone(), strokes, scale: self.scale * factor }
    }

    /// Whether both are the same.
    pub fn is_same(&self, other: &Self) -> bool {
        self.scale == other.scale
            && self.strokes == other.strokes
            && self.layers.len() == other.layers.len()
            && self.layers.iter().zip(&other.layers).all(|(a, b)| a.ptr_eq(b))
    }

    /// What is left of lines without those that follow ink.
    pub fn leave_out(&self, lines: &FormLines, settings: &LineSettings) -> FormLines {
        let strokes = NearStrokes::of(&self.strokes, REDRAWN_PX * self.scale);
        let left =
            lines.lines.iter().flat_map(|line| self.parts_without_ink(line, &strokes, settings));
        FormLines { lines: left.collect() }
    }

    fn parts_without_ink(
        &self,
        line: &FormLine,
        strokes: &NearStrokes,
        settings: &LineSettings,
    ) -> Vec<FormLine> {
        // Blurred normals turn beside the rim of a form.
        let is_sharp = LineKind::SHARP.contains(&line.kind);
        let reach_px = if is_sharp { REACH_PX } else { REACH_PX + settings.smooth };
        let is_inked = |i: usize| {
            self.has_ink_within(line.points[i].at, reach_px) || strokes.has_alike(&line.points, i)
        };
        let mut inked: Vec<bool> = (0..line.points.len()).map(is_inked).collect();
        let mut points = line.points.clone();
        if line.is_closed {
            // It is cut where ink begins or ends.
            let n = inked.len();
            let cut = (0..n).find(|&i| inked[i] != inked[(i + n - 1) % n]).unwrap_or(0);
            inked.rotate_left(cut);
            points.rotate_left(cut);
        }
        flip_short_runs(&mut inked, true, LEAST_POINTS);
        if !inked.contains(&true) {
            return vec![line.clone()];
        }
        flip_short_runs(&mut inked, false, settings.shortest as usize);
        let last = inked.len() - 1;
        runs(&inked)
            .filter(|run| !inked[run.start] && run.len() > 2)
            .map(|run| FormLine {
                kind: line.kind,
                points: points[run.clone()].to_vec(),
                is_closed: false,
                // Where it is cut it grows out of the ink.
                is_joined: [
                    run.start > 0 || line.is_closed || line.is_joined[0],
                    run.end <= last || line.is_closed || line.is_joined[1],
                ],
            })
            .collect()
    }

    fn has_ink_within(&self, at: Vec2, reach_px: f32) -> bool {
        let (at, reach) = (at / self.scale, reach_px / self.scale);
        let is_ink = |offset: Vec2| self.coverage_at(at + offset) >= LEAST_COVERAGE;
        // The middle first: most lines that follow ink lie in it.
        if is_ink(Vec2::ZERO) {
            return true;
        }
        let steps = reach.ceil() as i32;
        let square = (-steps..=steps).flat_map(|y| (-steps..=steps).map(move |x| (x, y)));
        square
            .map(|(x, y)| Vec2::new(x as f32, y as f32))
            .any(|offset| offset.length() <= reach && is_ink(offset))
    }

    /// The coverage of ink at a place, of its own px.
    fn coverage_at(&self, at: Vec2) -> u8 {
        let (x, y) = (at.x.floor() as i32, at.y.floor() as i32);
        let tile = TileAt::of_pixel(x, y);
        let corner = tile.rect();
        let i = (y - corner.y0) as usize * TILE + (x - corner.x0) as usize;
        let coverage =
            |layer: &TileGrid| layer.tile(tile).map_or(0, |tile| tile.bytes()[4 * i + 3]);
        self.layers.iter().map(coverage).max().unwrap_or(0)
    }
}

/// Strokes that stand in the place of lines, by where they are.
struct NearStrokes {
    /// Their places, a pixel apart or less, and directions, by cells whose side is the reach.
    cells: HashMap<(i32, i32), Vec<(Vec2, Vec2)>>,
    reach_px: f32,
}

impl NearStrokes {
    fn of(strokes: &GuideLines, reach_px: f32) -> Self {
        let mut found = Self { cells: HashMap::new(), reach_px };
        strokes.walk(|at, along| {
            let cell = found.cell(at);
            found.cells.entry(cell).or_default().push((at, along.normalize_or_zero()));
        });
        found
    }

    fn cell(&self, at: Vec2) -> (i32, i32) {
        let cell = (at / self.reach_px).floor();
        (cell.x as i32, cell.y as i32)
    }

    /// Whether a stroke runs along a line at one of its points.
    fn has_alike(&self, points: &[LinePoint], i: usize) -> bool {
        if self.cells.is_empty() {
            return false;
        }
        let at = points[i].at;
        let (before, after) = (i.saturating_sub(2), (i + 2).min(points.len() - 1));
        let along = (points[after].at - points[before].at).normalize_or_zero();
        let (column, row) = self.cell(at);
        let is_alike = |(place, way): &(Vec2, Vec2)| {
            place.distance(at) <= self.reach_px && way.dot(along).abs() >= REDRAWN_COS
        };
        (row - 1..=row + 1)
            .flat_map(|row| (column - 1..=column + 1).map(move |column| (column, row)))
            .any(|cell| self.cells.get(&cell).is_some_and(|all| all.iter().any(is_alike)))
    }
}

/// The runs of equal values.
fn runs(values: &[bool]) -> impl Iterator<Item = std::ops::Range<usize>> {
    let mut from = 0;
    values.chunk_by(|a, b| a == b).map(move |run| {
        from += run.len();
        from - run.len()..from
    })
}

/// Flips the runs of a value that are shorter than `least`.
fn flip_short_runs(values: &mut [bool], value: bool, least: usize) {
    let short: Vec<_> =
        runs(values).filter(|run| values[run.start] == value && run.len() < least).collect();
    short.into_iter().for_each(|run| values[run].fill(!value));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ink from (20, 20) to (119, 25).
    fn bar() -> InkOnCanvas {
        let mut pixels = vec![0; 4 * 160 * 60];
        for y in 20..26 {
            for x in 20..120 {
                pixels[4 * (y * 160 + x) + 3] = 255;
            }
        }
        InkOnCanvas::of([TileGrid::from_straight_rgba(&pixels, 160, 60, 0, 0)])
    }

    fn line(points: impl Iterator<Item = (f32, f32)>) -> FormLine {
        let points = points.map(|(x, y)| LinePoint { at: Vec2::new(x, y), strength: 1.0 });
        let (kind, is_joined) = (LineKind::Outline, [false; 2]);
        FormLine { kind, points: points.collect(), is_closed: false, is_joined }
    }

    fn remaining(ink: &InkOnCanvas, line: FormLine) -> Vec<FormLine> {
        ink.leave_out(&FormLines { lines: vec![line] }, &LineSettings::DEFAULT).lines
    }

    #[test]
    fn what_runs_along_ink_is_left_out_and_the_rest_grows_out_of_it() {
        let along = line((0..150).map(|x| (x as f32 + 0.5, 27.5)));
        let parts = remaining(&bar(), along);
        let ends = |part: &FormLine| (part.points[0].at.x, part.points[part.points.len() - 1].at.x);
        assert_eq!(parts.iter().map(ends).collect::<Vec<_>>(), [(0.5, 17.5), (122.5, 149.5)]);
        assert_eq!(parts[0].is_joined, [false, true]);
        assert_eq!(parts[1].is_joined, [true, false]);
    }

    #[test]
    fn what_passes_ink_or_lies_beside_it_stays() {
        let across = line((0..60).map(|y| (60.5, y as f32 * 0.7)));
        let beside = line((0..150).map(|x| (x as f32, 31.0)));
        for line in [across, beside] {
            // Six px of ink and three on either side are more than ten points.
            let thin = InkOnCanvas::of(bar().layers);
            let parts = remaining(&thin, line.clone());
            let points: usize = parts.iter().map(|part| part.points.len()).sum();
            assert!(points + 20 > line.points.len(), "{points}");
        }
        assert_eq!(
            remaining(&InkOnCanvas::default(), line((0..9).map(|x| (x as f32, 0.0)))).len(),
            1
        );
    }

    #[test]
    fn what_a_hand_draws_again_is_left_out_and_lines_across_it_stay() {
        let stroke = vec![Vec2::new(40.0, 30.0), Vec2::new(100.0, 34.0)];
        let drawn = InkOnCanvas::default().with_strokes(GuideLines::of([stroke].into_iter()));
        let along = line((0..150).map(|x| (x as f32 + 0.5, 31.0)));
        let parts = remaining(&drawn, along);
        let ends = |part: &FormLine| (part.points[0].at.x, part.points[part.points.len() - 1].at.x);
        let ends: Vec<_> = parts.iter().map(ends).collect();
        let near = |a: f32, b: f32| (a - b).abs() < 4.0;
        assert!(ends.len() == 2 && near(ends[0].1, 35.0) && near(ends[1].0, 105.0), "{ends:?}");
        let across = line((0..60).map(|y| (70.5, y as f32)));
        assert_eq!(remaining(&drawn, across.clone())[0].points.len(), across.points.len());
        let beside = line((0..150).map(|x| (x as f32, 45.0)));
        assert_eq!(remaining(&drawn, beside).len(), 1);
    }

    #[test]
    fn on_a_larger_canvas_the_same_is_left_out() {
        let along = line((0..300).map(|x| (x as f32 + 0.5, 46.0)));
        let parts = remaining(&bar().scaled(2.0), along);
        assert_eq!(parts.len(), 2);
        assert!((parts[0].points.len() as f32 - 38.0).abs() < 3.0, "{}", parts[0].points.len());
    }
}
