//! Vector masks: paths of Bézier curves, combined one after the other, drawn as coverage.
//! Floor 5. Masks that are pictures are `masks`'.

use super::cursor::ByteCursor;
use crate::math::{Size, Vec2, vec2};
use crate::paint::{LivePath, PathNode, Subpath};
use crate::raster::coverage::{product, shapes};
use tiny_skia::{Path, PathBuilder};

/// A knot: the handle before it, itself, the handle behind it; each y, x as shares of the canvas.
pub(super) type Knot = [[f32; 2]; 3];

/// How many of a coordinate's steps are a side of the canvas.
pub(super) const STEPS: f32 = 16_777_216.0;

/// What says that paths are filled by the nonzero rule; 1 is even-odd.
const NONZERO: u16 = 2;

/// Paths, as stored in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VectorPaths {
    pub(super) shapes: Vec<FilledPaths>,
    pub(super) inverted: bool,
    /// It begins with all of the canvas.
    pub(super) begins_full: bool,
    pub disabled: bool,
}

/// Paths that are filled together.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FilledPaths {
    pub(super) way: PathOperation,
    /// What lies inside twice is inside, unless the paths run against each other there.
    pub(super) is_nonzero: bool,
    pub(super) paths: Vec<KnotPath>,
}

/// One path.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct KnotPath {
    pub(super) knots: Vec<Knot>,
    /// It ends where it ends; what it fills is closed by a straight line.
    pub(super) is_open: bool,
}

/// How a shape meets those before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PathOperation {
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
        let mut outline =
            Self { inverted: flags & 1 != 0, disabled: flags & 4 != 0, ..Self::default() };
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
                let is_nonzero = record.u16()? == NONZERO;
                match (way, self.shapes.last_mut()) {
                    (None, Some(shape)) => shape.paths.push(path),
                    (way, _) => self.shapes.push(FilledPaths {
                        way: way.unwrap_or(PathOperation::Add),
                        is_nonzero,
                        paths: vec![path],
                    }),
                }
            }
            1 | 2 | 4 | 5 => {
                // Fixed point, eight bits before it.
                let mut share = || Some(record.i32()? as f32 / STEPS);
                let knot = [[share()?, share()?], [share()?, share()?], [share()?, share()?]];
                self.shapes.last_mut()?.paths.last_mut()?.knots.push(knot);
            }
            8 => self.begins_full = record.u16()? == 1,
            _ => {}
        }
        Some(())
    }

    /// The block of a vector mask that reads as this.
    pub fn block(&self) -> Vec<u8> {
        const VERSION: u32 = 3;
        let flags = u32::from(self.inverted) | u32::from(self.disabled) << 2;
        let mut out = [VERSION.to_be_bytes(), flags.to_be_bytes()].concat();
        put_record(&mut out, &[6]);
        put_record(&mut out, &[8, u16::from(self.begins_full)]);
        for (number, shape) in self.shapes.iter().enumerate() {
            let way = match shape.way {
                PathOperation::Exclude => 0,
                PathOperation::Add => 1,
                PathOperation::Subtract => 2,
                PathOperation::Intersect => 3,
            };
            let rule = if shape.is_nonzero { NONZERO } else { 1 };
            for (i, path) in shape.paths.iter().enumerate() {
                let kind = if path.is_open { 3 } else { 0 };
                // Paths behind the first belong to its shape, which is known by its number.
                let [way, rule] = if i == 0 { [way, rule] } else { [u16::MAX, 0] };
                let count = path.knots.len() as u16;
                put_record(&mut out, &[kind, count, way, rule, 0, 0, 0, number as u16]);
                for knot in &path.knots {
                    let start = out.len();
                    // A knot whose handles move each other, and one whose handles do not.
                    let kind = u16::from(!is_smooth(knot)) + if path.is_open { 4 } else { 1 };
                    out.extend(kind.to_be_bytes());
                    let fixed = |v: &f32| ((v * STEPS) as i32).to_be_bytes();
                    knot.iter().flatten().for_each(|v| out.extend(fixed(v)));
                    out.resize(start + 26, 0);
                }
            }
        }
        out
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
                let lines: Vec<Subpath> = shape.lines(size).collect();
                Some((shape.path(size)?, length_px(&lines)))
            }
            _ => None,
        }
    }

    /// Whether it begins with all of the canvas: what is taken away from nothing, or meets nothing,
    /// would be nothing; what is added first would add nothing to all.
    pub(super) fn is_full_at_first(&self) -> bool {
        match self.shapes.first().map(|shape| shape.way) {
            Some(PathOperation::Add) => false,
            Some(PathOperation::Subtract | PathOperation::Intersect) => true,
            Some(PathOperation::Exclude) | None => self.begins_full,
        }
    }

    /// Coverage of every pixel of the canvas, row by row.
    pub fn coverage(&self, size: Size) -> Vec<u8> {
        let mut coverage = vec![if self.is_full_at_first() { 255 } else { 0 }; size.area()];
        for shape in &self.shapes {
            let drawn = shape.coverage(size);
            for (c, own) in coverage.iter_mut().zip(drawn) {
                *c = shape.way.meet(*c, own);
            }
        }
        if self.inverted {
            coverage.iter_mut().for_each(|c| *c = 255 - *c);
        }
        coverage
    }
}

/// The length of lines, px, or more: no curve is longer than the lines between its handles.
pub fn length_px(lines: &[Subpath]) -> f32 {
    let of_curve = |[a, b, c, d]: [Vec2; 4]| a.distance(b) + b.distance(c) + c.distance(d);
    lines.iter().flat_map(Subpath::curves).map(of_curve).sum()
}

/// A record of numbers.
fn put_record(out: &mut Vec<u8>, numbers: &[u16]) {
    let start = out.len();
    numbers.iter().for_each(|number| out.extend(number.to_be_bytes()));
    out.resize(start + 26, 0);
}

/// Whether a path runs straight on at a knot.
fn is_smooth(&[before, at, after]: &Knot) -> bool {
    let [before, at, after] = [before, at, after].map(|[y, x]| vec2(x, y));
    let (before, after) = (before - at, after - at);
    PathNode { before, after, ..PathNode::corner(at) }.is_smooth()
}

impl FilledPaths {
    /// Its paths, px of the canvas.
    pub(super) fn lines(&self, size: Size) -> impl Iterator<Item = Subpath> + '_ {
        self.paths.iter().map(move |path| path.line(size))
    }

    /// Of every pixel of the canvas, row by row: the exact share that lies inside.
    fn coverage(&self, size: Size) -> Vec<u8> {
        let lines = LivePath::new(self.lines(size).collect::<Vec<_>>()).flatten_for_area(Some);
        let lines: Vec<&[Vec2]> = lines.iter().map(Vec::as_slice).collect();
        let (mut out, width) = (vec![0; size.area()], size.width as usize);
        shapes::visit_rows(&lines, !self.is_nonzero, size.rect(), |y, row| {
            out[y as usize * width..][..width].copy_from_slice(row);
        });
        out
    }

    /// That of a line, which may be open.
    fn path(&self, size: Size) -> Option<Path> {
        let mut builder = PathBuilder::new();
        for line in self.lines(size) {
            let Some(first) = line.nodes.first() else { continue };
            builder.move_to(first.at.x, first.at.y);
            for [_, b, c, d] in line.curves() {
                builder.cubic_to(b.x, b.y, c.x, c.y, d.x, d.y);
            }
            if line.closed {
                builder.close();
            }
        }
        builder.finish()
    }
}

impl KnotPath {
    /// Px of the canvas.
    fn line(&self, size: Size) -> Subpath {
        let place = |[y, x]: [f32; 2]| vec2(x * size.width as f32, y * size.height as f32);
        let node = |knot: &Knot| {
            let [before, at, after] = knot.map(place);
            PathNode { before: before - at, after: after - at, ..PathNode::corner(at) }
        };
        Subpath { nodes: self.knots.iter().map(node).collect(), closed: !self.is_open }
    }
}

impl PathOperation {
    fn meet(self, before: u8, shape: u8) -> u8 {
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
        let mut whole = left();
        whole[7] = 2;
        assert_eq!(drawn(0, &[whole, right(-1)]), [255; 4], "one shape by the nonzero rule");
        assert_eq!(drawn(0, &[right(2)]), [255, 0, 0, 0], "what is taken away is so from all");
        assert_eq!(drawn(0, &[right(3)]), [0, 255, 255, 255], "and all meets what comes first");
        let mut full = vec![0, 8, 0, 1];
        full.resize(26, 0);
        assert_eq!(drawn(0, &[full.clone(), right(2)]), [255, 0, 0, 0], "begins with all");
        assert_eq!(drawn(0, &[full, left()]), [255, 255, 255, 0], "begins with what is added");
    }

    #[test]
    fn a_block_reads_as_the_paths_that_it_was_made_of() {
        let mut open = rectangle(0, [-0.5, 0.25, 0.75, 1.5]);
        open[1] = 3;
        open[26..].chunks_mut(26).for_each(|knot| knot[1] = 5);
        open[26 + 6..26 + 10].copy_from_slice(&[0, 0x12, 0x34, 0x57]);
        let records = [rectangle(1, [0.0, 0.0, 0.75, 1.0]), rectangle(-1, [0.1; 4]), open];
        let bytes = [vec![0, 0, 0, 3, 0, 0, 0, 4], records.concat()].concat();
        let read = |bytes: &[u8]| VectorPaths::read(ByteCursor::new(bytes)).unwrap();
        let paths = read(&bytes);
        assert!(paths.disabled && paths.shapes[1].paths[0].is_open);
        assert_eq!(read(&paths.block()), paths);
        assert_eq!(paths.block().len(), 8 + 26 * (2 + 3 * 5));
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
        assert!(half[0] == 128 && half[1..] == [0; 3], "{half:?}");
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
