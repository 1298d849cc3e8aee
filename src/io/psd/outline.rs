//! Vector masks: paths of Bézier curves, combined one after the other, drawn as coverage.
//! Floor 5. Masks that are pictures are `masks`'.

use super::cursor::ByteCursor;
use crate::math::{Size, vec2};
use tiny_skia::{FillRule, Mask, Path, PathBuilder, Transform};

/// A knot: the handle before it, itself, the handle behind it; each y, x as shares of the canvas.
type Knot = [[f32; 2]; 3];

/// Paths, as stored in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct VectorPaths {
    shapes: Vec<FilledPaths>,
    inverted: bool,
    /// It begins with all of the canvas.
    begins_full: bool,
    pub disabled: bool,
}

/// Paths that are filled together.
#[derive(Clone, Debug, PartialEq)]
struct FilledPaths {
    way: PathOperation,
    paths: Vec<KnotPath>,
}

/// One path.
#[derive(Clone, Debug, Default, PartialEq)]
struct KnotPath {
    knots: Vec<Knot>,
    /// It ends where it ends; what it fills is closed by a straight line.
    is_open: bool,
}

/// How a shape meets those before it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PathOperation {
    Exclude,
    Add,
    Subtract,
    Intersect,
}

impl VectorPaths {
    /// Reads the block of a vector mask; `None` where it is cut short.
    pub fn read(mut data: ByteCursor) -> Option<Self> {
        data.u32()?;
        let flags = data.u32()?;
        let mut outline = Self {
            shapes: Vec::new(),
            inverted: flags & 1 != 0,
            begins_full: false,
            disabled: flags & 4 != 0,
        };
        // Each record takes 26 bytes.
        while let Some(record) = data.take(26) {
            outline.record(ByteCursor::new(record))?;
        }
        Some(outline)
    }

    fn record(&mut self, mut record: ByteCursor) -> Option<()> {
        let kind = record.u16()?;
        match kind {
            0 | 3 => {
                let path = KnotPath { is_open: kind == 3, ..KnotPath::default() };
                record.u16()?;
                let way = match record.i16()? {
                    0 => Some(PathOperation::Exclude),
                    1 => Some(PathOperation::Add),
                    2 => Some(PathOperation::Subtract),
                    3 => Some(PathOperation::Intersect),
                    // Belongs to the shape before.
                    _ => None,
                };
                match (way, self.shapes.last_mut()) {
                    (None, Some(shape)) => shape.paths.push(path),
                    (way, _) => self.shapes.push(FilledPaths {
                        way: way.unwrap_or(PathOperation::Add),
                        paths: vec![path],
                    }),
                }
            }
            1 | 2 | 4 | 5 => {
                // Fixed point, eight bits before it.
                let mut share = || Some(record.i32()? as f32 / 16_777_216.0);
                let knot = [[share()?, share()?], [share()?, share()?], [share()?, share()?]];
                self.shapes.last_mut()?.paths.last_mut()?.knots.push(knot);
            }
            8 => self.begins_full = record.u16()? == 1,
            _ => {}
        }
        Some(())
    }

    /// Each takes a look at every pixel of the canvas.
    pub fn shapes(&self) -> usize {
        self.shapes.len()
    }

    /// What a line along its paths follows, and its length in px at most; `None` of several shapes,
    /// and of what is outside of one.
    pub fn path_of_line(&self, size: Size) -> Option<(Path, f32)> {
        match &self.shapes[..] {
            [shape] if shape.way == PathOperation::Add && !self.inverted => {
                Some((shape.path(size, false)?, shape.length_px(size)))
            }
            _ => None,
        }
    }

    /// Coverage of every pixel of the canvas, row by row.
    pub fn coverage(&self, size: Size) -> Vec<u8> {
        // What is added first would add nothing to all of the canvas, so it begins.
        let is_added = self.shapes.first().is_some_and(|shape| shape.way == PathOperation::Add);
        let begins_full = self.begins_full && !is_added;
        let mut coverage = vec![if begins_full { 255 } else { 0 }; size.area()];
        for shape in &self.shapes {
            let drawn = shape.fill_mask(size);
            for (i, c) in coverage.iter_mut().enumerate() {
                *c = shape.way.meet(*c, drawn.as_ref().map_or(0, |mask| mask.data()[i]));
            }
        }
        if self.inverted {
            coverage.iter_mut().for_each(|c| *c = 255 - *c);
        }
        coverage
    }
}

impl FilledPaths {
    /// `None` if nothing is covered.
    fn fill_mask(&self, size: Size) -> Option<Mask> {
        let path = self.path(size, true)?;
        let mut mask = Mask::new(size.width, size.height)?;
        mask.fill_path(&path, FillRule::EvenOdd, true, Transform::identity());
        Some(mask)
    }

    /// That of what is filled, or of a line, which may be open.
    fn path(&self, size: Size, is_filled: bool) -> Option<Path> {
        let mut builder = PathBuilder::new();
        let place = |[y, x]: [f32; 2]| (x * size.width as f32, y * size.height as f32);
        for KnotPath { knots, is_open } in &self.paths {
            let Some(first) = knots.first() else { continue };
            let (x, y) = place(first[1]);
            builder.move_to(x, y);
            let curves = knots.len() - usize::from(*is_open);
            for (from, to) in knots.iter().zip(knots.iter().cycle().skip(1)).take(curves) {
                let ((x1, y1), (x2, y2), (x, y)) = (place(from[2]), place(to[0]), place(to[1]));
                builder.cubic_to(x1, y1, x2, y2, x, y);
            }
            if is_filled || !is_open {
                builder.close();
            }
        }
        builder.finish()
    }

    /// No curve is longer than the lines between its handles.
    fn length_px(&self, size: Size) -> f32 {
        let place = |[y, x]: [f32; 2]| vec2(x * size.width as f32, y * size.height as f32);
        let of_path = |path: &KnotPath| -> f32 {
            let pairs = path.knots.iter().zip(path.knots.iter().cycle().skip(1));
            let pair = |(from, to): (&Knot, &Knot)| {
                let points = [from[1], from[2], to[0], to[1]].map(place);
                points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f32>()
            };
            pairs.map(pair).sum()
        };
        self.paths.iter().map(of_path).sum()
    }
}

impl PathOperation {
    fn meet(self, before: u8, shape: u8) -> u8 {
        let product = |a: u8, b: u8| ((u32::from(a) * u32::from(b) + 127) / 255) as u8;
        match self {
            PathOperation::Add => 255 - product(255 - before, 255 - shape),
            PathOperation::Subtract => product(before, 255 - shape),
            PathOperation::Intersect => product(before, shape),
            PathOperation::Exclude => {
                product(before, 255 - shape).saturating_add(product(255 - before, shape))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle's corners as knots without handles, behind the record that begins a path.
    fn rectangle(way: i16, [x0, y0, x1, y1]: [f32; 4]) -> Vec<u8> {
        let mut out = [0u16.to_be_bytes(), 4u16.to_be_bytes(), way.to_be_bytes()].concat();
        out.resize(26, 0);
        for (x, y) in [(x0, y0), (x1, y0), (x1, y1), (x0, y1)] {
            out.extend(1u16.to_be_bytes());
            let fixed = [y, x].map(|v| ((v * 16_777_216.0) as i32).to_be_bytes()).concat();
            out.extend(fixed.repeat(3));
        }
        out
    }

    fn drawn(flags: u32, records: &[Vec<u8>]) -> Vec<u8> {
        let bytes =
            [3u32.to_be_bytes().to_vec(), flags.to_be_bytes().to_vec(), records.concat()].concat();
        VectorPaths::read(ByteCursor::new(&bytes)).unwrap().coverage(Size::new(4, 1))
    }

    #[test]
    fn shapes_are_added_subtracted_intersected_and_excluded() {
        let left = || rectangle(1, [0.0, 0.0, 0.75, 1.0]);
        let right = |way| rectangle(way, [0.25, 0.0, 1.0, 1.0]);
        assert_eq!(drawn(0, &[left()]), [255, 255, 255, 0]);
        assert_eq!(drawn(1, &[left()]), [0, 0, 0, 255], "inverted");
        assert_eq!(drawn(0, &[left(), right(1)]), [255; 4]);
        assert_eq!(drawn(0, &[left(), right(2)]), [255, 0, 0, 0]);
        assert_eq!(drawn(0, &[left(), right(3)]), [0, 255, 255, 0]);
        assert_eq!(drawn(0, &[left(), right(0)]), [255, 0, 0, 255]);
        assert_eq!(drawn(0, &[left(), right(-1)]), [255, 0, 0, 255], "one shape with a hole");
        let mut full = vec![0, 8, 0, 1];
        full.resize(26, 0);
        assert_eq!(drawn(0, &[full.clone(), right(2)]), [255, 0, 0, 0], "begins with all");
        assert_eq!(drawn(0, &[full, left()]), [255, 255, 255, 0], "begins with what is added");
    }

    #[test]
    fn an_open_path_is_closed_by_a_straight_line() {
        let mut path = rectangle(1, [0.0, 0.0, 1.0, 1.0]);
        // The handle behind the last knot and that before the first bend the curve between them.
        let far = ((0.9 * 16_777_216.0) as i32).to_be_bytes();
        path[26 + 6..26 + 10].copy_from_slice(&far);
        path[26 * 4 + 22..26 * 4 + 26].copy_from_slice(&far);
        let closed = drawn(0, std::slice::from_ref(&path));
        assert!(closed[0] < 128, "{closed:?}");
        path[1] = 3;
        for knot in path[26..].chunks_mut(26) {
            knot[1] = 4;
        }
        assert_eq!(drawn(0, &[path]), [255; 4]);
    }

    #[test]
    fn edges_within_a_pixel_cover_a_part_of_it() {
        let half = drawn(0, &[rectangle(1, [0.0, 0.0, 0.125, 1.0])]);
        assert!(half[0].abs_diff(128) <= 8 && half[1..] == [0; 3], "{half:?}");
    }

    #[test]
    fn knots_without_a_path_and_paths_without_knots_are_borne() {
        let knot = rectangle(1, [0.0, 0.0, 1.0, 1.0])[26..52].to_vec();
        let bytes = [vec![0; 8], knot].concat();
        assert_eq!(VectorPaths::read(ByteCursor::new(&bytes)), None);
        assert_eq!(
            drawn(0, &[rectangle(1, [-120.0, -120.0, 120.0, 120.0])[..26].to_vec()]),
            [0; 4]
        );
        assert_eq!(drawn(0, &[rectangle(1, [-120.0, -120.0, 120.0, 120.0])]), [255; 4]);
    }
}
