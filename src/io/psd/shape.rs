//! Shape layers as paths that stay live, and paths as shape layers: a vector mask, a color and a
//! line. Floor 5. Not here: what a vector mask holds (`outline`), lines that no path has (`line`).

use super::fill::LayerFill;
use super::line::ShapeLine;
use super::outline::{FilledPaths, Knot, KnotPath, PathOperation, STEPS, VectorPaths};
use super::{LayerRecord, fill_block, filled};
use crate::document::{Content, Document, Layer};
use crate::math::srgb::Color;
use crate::math::{Rect, Size, Vec2};
use crate::paint::{LivePath, PathRule, Subpath};
use crate::raster::coverage::product;
use crate::raster::picture::Texels;
use std::sync::Arc;

/// What is noted of shapes that no path says.
const COMBINED: &str = "it is no live path: a path here cannot combine its paths as it does";
const INVERTED: &str = "it is no live path: it is all that lies outside of its paths";
const FILLED: &str = "it is no live path: a path here has one color";
const UNLIKE: &str = "it is no live path: its pixels are not those of its paths";
pub const TOO_LARGE: &str = "it is no live path: it is too large for one";

/// How far pixels of a shape may be from those of a path, of 255: where those beside are the same; at
/// edges, which other programs may smooth otherwise; and there in the mean.
const SAME: u8 = 3;
const SAME_AT_EDGES: u8 = 64;
const SAME_EDGE_MEAN: f64 = 6.0;
/// The most pixels that are compared: of the box around a path, and how many canvases, or so many.
const MOST_PX: u64 = 1 << 26;
const MOST_CANVASES: u64 = 16;
const FEW_PX: u64 = 1 << 22;

/// Paths that may look like a shape, the likeliest first.
pub struct ShapePaths {
    pub paths: Vec<LivePath>,
    /// The first looks like it for certain, as far as its vector mask says.
    pub is_certain: bool,
}

impl ShapePaths {
    /// Of a record whose vector mask is `outline`; `None` of what is no shape, and an error that is
    /// to be noted of a shape that no path says.
    pub fn of(
        record: &LayerRecord,
        outline: &VectorPaths,
        size: Size,
    ) -> Option<Result<Self, &'static str>> {
        if outline.disabled || outline.shapes.is_empty() {
            return None;
        }
        let fill = match record.fill.as_ref()? {
            _ if record.unfilled => None,
            LayerFill::Solid(color) => Some(*color),
            _ => return Some(Err(FILLED)),
        };
        // A line that is not understood is noted where it is left out.
        if record.stroked && record.line.is_none() || fill.is_none() && !record.stroked {
            return None;
        }
        Some(Self::of_look(outline, fill, record.line.as_ref(), size))
    }

    fn of_look(
        outline: &VectorPaths,
        fill: Option<Color>,
        line: Option<&ShapeLine>,
        size: Size,
    ) -> Result<Self, &'static str> {
        let (lines, is_certain) = line_sets(outline, size)?;
        let look = |(lines, rule): (Vec<Subpath>, PathRule)| {
            let path = LivePath { fill, rule, ..LivePath::new(lines) };
            match line {
                Some(line) => line.draw_on(path),
                None => Ok(path),
            }
        };
        let paths: Vec<LivePath> = lines.into_iter().map(look).collect::<Result<_, _>>()?;
        let most_px = (MOST_CANVASES * size.area() as u64).max(FEW_PX).min(MOST_PX);
        let fits = |path: &LivePath| path.fits().is_ok() && bounds_px(path) <= most_px;
        if !paths.iter().all(fits) {
            return Err(TOO_LARGE);
        }
        // A line runs along what several paths are together.
        if line.is_some() && outline.shapes.len() > 1 && !is_certain {
            return Err(COMBINED);
        }
        Ok(Self { paths, is_certain })
    }

    /// The path whose pixels are those of a rectangle, if that is one of them.
    pub fn find_shown(
        self,
        canvas: Size,
        rect: Rect,
        rgba: &[u8],
    ) -> Result<LivePath, &'static str> {
        let is_shown = |path: &LivePath| is_shown(path, canvas, rect, rgba);
        self.paths.into_iter().find(is_shown).ok_or(UNLIKE)
    }

    /// The path that covers what paths do, if that is one of them. `covered`: by the paths, of each
    /// pixel of the canvas.
    pub fn find_covering(self, canvas: Size, covered: &[u8]) -> Result<LivePath, &'static str> {
        if self.is_certain {
            return self.paths.into_iter().next().ok_or(COMBINED);
        }
        let fill = self.paths.first().and_then(|path| path.fill).unwrap_or(Color::BLACK);
        let pixel = |c: &u8| [fill.r, fill.g, fill.b, *c];
        let rgba: Vec<u8> = covered.iter().flat_map(pixel).collect();
        self.find_shown(canvas, canvas.rect(), &rgba).map_err(|_| COMBINED)
    }
}

/// The pixels of the box around a path.
pub fn bounds_px(path: &LivePath) -> u64 {
    let bounds = path.bounds();
    bounds.width() as u64 * bounds.height() as u64
}

/// Lines and rules that may say a vector mask, and whether the first does for certain.
type LineSets = (Vec<(Vec<Subpath>, PathRule)>, bool);

fn line_sets(outline: &VectorPaths, size: Size) -> Result<LineSets, &'static str> {
    use PathOperation as Way;
    if outline.inverted {
        return Err(INVERTED);
    }
    let [first, others @ ..] = &outline.shapes[..] else { return Err(COMBINED) };
    let begins = match first.way {
        // All meets what comes first.
        Way::Add | Way::Intersect => true,
        Way::Exclude => !outline.is_full_at_first(),
        Way::Subtract => false,
    };
    if !begins || others.iter().any(|shape| shape.way == Way::Intersect) {
        return Err(COMBINED);
    }
    let all: Vec<Subpath> = outline.shapes.iter().flat_map(|shape| shape.lines(size)).collect();
    if others.is_empty() {
        let rule = if first.is_nonzero { PathRule::Nonzero } else { PathRule::EvenOdd };
        return Ok((vec![(all, rule)], true));
    }
    // Even-odd shapes that exclude each other are one even-odd shape.
    let is_certain = others.iter().all(|shape| shape.way == Way::Exclude)
        && outline.shapes.iter().all(|shape| !shape.is_nonzero);
    let mut sets = vec![(all, PathRule::EvenOdd)];
    // Paths that run one way add up, those that run the other way take away.
    let is_single = |shape: &FilledPaths| shape.paths.len() == 1;
    if !is_certain && outline.shapes.iter().all(is_single) {
        let turned = |shape: &FilledPaths| {
            let is_added = shape.way != Way::Subtract;
            let turn = move |line: Subpath| match (signed_area(&line) >= 0.0) == is_added {
                true => line,
                false => line.reversed(),
            };
            shape.lines(size).map(turn).collect::<Vec<_>>()
        };
        sets.push((outline.shapes.iter().flat_map(turned).collect(), PathRule::Nonzero));
    }
    Ok((sets, is_certain))
}

/// Twice the area that a line runs around; below 0 the other way round.
fn signed_area(line: &Subpath) -> f32 {
    let lines = LivePath::new(vec![line.clone()]).flatten(Some);
    let points = lines.first().map_or(&[][..], |line| &line.points);
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
}

/// Whether the pixels of a rectangle are those of a path, as far as the canvas reaches.
fn is_shown(path: &LivePath, canvas: Size, rect: Rect, rgba: &[u8]) -> bool {
    let bounds = path.bounds();
    let Some(texels) = draw(path, bounds) else { return false };
    let own = |x: i32, y: i32| pixel(&texels, bounds, x, y);
    let pixels = rgba.as_chunks::<4>().0;
    let found = |x: i32, y: i32| pixel(pixels, rect, x, y);
    let (mut sum, mut count) = (0u64, 0u64);
    let seen = bounds.union(rect).intersect(canvas.rect());
    for (x, y) in (seen.y0..seen.y1).flat_map(|y| (seen.x0..seen.x1).map(move |x| (x, y))) {
        let (here, found) = (own(x, y), found(x, y));
        let beside = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
        let is_edge = beside.into_iter().any(|(x, y)| own(x, y) != here);
        if here == found && !is_edge {
            continue;
        }
        let apart = premultiplied(here).into_iter().zip(premultiplied(found));
        let apart = apart.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0);
        let most = if is_edge { SAME_AT_EDGES } else { SAME };
        if apart > most {
            return false;
        }
        if is_edge {
            (sum, count) = (sum + u64::from(apart), count + 1);
        }
    }
    sum as f64 <= SAME_EDGE_MEAN * count as f64
}

/// The pixels of a path's box, straight.
fn draw(path: &LivePath, bounds: Rect) -> Option<Arc<[[u8; 4]]>> {
    let size = Size::new(bounds.width() as u32, bounds.height() as u32);
    let picture = path.picture();
    match picture.texels {
        Texels::Srgb8(texels) if picture.size == size => Some(texels),
        _ => picture.drawing?.draw(size).map(Arc::from),
    }
}

/// A pixel of a rectangle's; transparent beyond it.
fn pixel(pixels: &[[u8; 4]], rect: Rect, x: i32, y: i32) -> [u8; 4] {
    if !rect.contains(x, y) {
        return [0; 4];
    }
    let at = (y - rect.y0) as usize * rect.width() + (x - rect.x0) as usize;
    pixels.get(at).copied().unwrap_or([0; 4])
}

fn premultiplied([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    [product(r, a), product(g, a), product(b, a), a]
}

impl VectorPaths {
    /// The lines of a path as one shape; `None` where the format cannot hold them.
    fn of_path(path: &LivePath, size: Size) -> Option<Self> {
        let knot_path = |line: &Subpath| {
            let knot = |i: usize| {
                let node = line.nodes[i];
                let share = |p: Vec2| Some([step(p.y, size.height)?, step(p.x, size.width)?]);
                let [before, after] = [node.at + node.before, node.at + node.after];
                Some([share(before)?, share(node.at)?, share(after)?])
            };
            let knots: Option<Vec<Knot>> = (0..line.nodes.len()).map(knot).collect();
            u16::try_from(line.nodes.len()).ok()?;
            Some(KnotPath { knots: knots?, is_open: !line.closed })
        };
        let lines = path.subpaths();
        let drawn = lines.iter().filter(|line| !line.nodes.is_empty());
        let paths: Vec<KnotPath> = drawn.map(knot_path).collect::<Option<_>>()?;
        let is_nonzero = path.rule == PathRule::Nonzero;
        let shape = FilledPaths { way: PathOperation::Add, is_nonzero, paths };
        (!shape.paths.is_empty()).then(|| Self { shapes: vec![shape], ..Self::default() })
    }
}

/// A coordinate in px as a share of a side, in the format's steps.
fn step(px: f32, side: u32) -> Option<f32> {
    /// Sides of the canvas.
    const FARTHEST: f64 = 120.0;
    let share = f64::from(px) / f64::from(side.max(1));
    let steps = (share * f64::from(STEPS)).round() as i32;
    (share.abs() <= FARTHEST).then(|| steps as f32 / STEPS)
}

/// Makes a record of a layer's pixels that of a shape, if the layer is a path that one says.
///
/// * `shown`: the layer as it lies on the canvas.
pub fn put(record: &mut LayerRecord, document: &Document, shown: &Layer) {
    let Content::Image(live) = &shown.content else { return };
    let is_uneven = |path: &LivePath| {
        let lines = path.subpaths();
        lines.iter().flat_map(|line| &line.nodes).any(|node| node.width != 1.0)
    };
    if filled::has_cut_effects(record, document.size) {
        return;
    }
    let path = live.params().path_on_canvas(document.size);
    let is_opaque = |path: &LivePath| path.fill.is_none_or(|fill| fill.a == 255);
    let path = path.filter(|path| is_opaque(path) && (path.outline <= 0.0 || !is_uneven(path)));
    let Some(path) = path.filter(|_| !record.rgba.is_empty()) else { return };
    let line = match path.outline > 0.0 {
        true => match ShapeLine::of_path(&path) {
            Some(line) => Some(line),
            None => return,
        },
        false => None,
    };
    let Some(outline) = VectorPaths::of_path(&path, document.size) else { return };
    let found = ShapePaths::of_look(&outline, path.fill, line.as_ref(), document.size);
    let found = found.and_then(|paths| paths.find_shown(document.size, record.rect, &record.rgba));
    let Ok(found) = found else { return };
    let color = path.fill.unwrap_or(Color { a: 255, ..path.outline_color });
    record.fill = Some(LayerFill::Solid(color));
    record.unfilled = path.fill.is_none();
    (record.stroked, record.is_shape) = (line.is_some(), true);
    record.outline = Some(outline);
    record.path = Some(found);
}

/// Makes records of shapes those of pixels again whose line would lie over what is clipped to them, or
/// over effects within them, if the file said that it is one.
pub fn drop_parted(records: &mut [LayerRecord]) {
    for i in 0..records.len() {
        let has_clipped = records.get(i + 1).is_some_and(|next| next.clipped);
        let record = &mut records[i];
        if record.stroked && record.is_parted_by(has_clipped) {
            (record.path, record.outline, record.fill) = (None, None, None);
            (record.stroked, record.unfilled, record.is_shape) = (false, false, false);
        }
    }
}

/// The blocks of a record that is a path, as Photoshop writes them since it has lines of shapes. The
/// older ones are taken for a fill of the whole canvas by programs that read no vector masks.
pub fn blocks(record: &LayerRecord) -> Vec<([u8; 4], Vec<u8>)> {
    let (Some(path), Some(outline)) = (&record.path, &record.outline) else { return Vec::new() };
    let Some(LayerFill::Solid(color)) = &record.fill else { return Vec::new() };
    let fill = fill_block::of_color(*color);
    let line = ShapeLine::of_path(path).unwrap_or_else(ShapeLine::unseen);
    vec![
        (*b"vscg", [&b"SoCo"[..], &fill].concat()),
        (*b"vsms", outline.block()),
        (*b"vstk", line.block(record)),
    ]
}
