//! Paths as pictures, drawn at the size at which they are seen. Floor 3.

use super::live_path::{LivePath, PathCap, PathJoin, PathRule};
use super::ribbon;
use super::subpath::{PathNode, Subpath};
use crate::math::{Rect, Size, Vec2, srgb::Color, vec2};
use crate::memory;
use crate::raster::coverage::{product, shapes, winding};
use crate::raster::{CoverageGrid, Picture, Plane, VectorDrawing};
use std::any::Any;
use std::sync::Arc;
use tiny_skia::{
    LineCap, LineJoin, Path, PathBuilder, PathSegment, PathStroker, Point, Stroke, StrokeDash,
};

/// The longest side of a path's picture before it is drawn larger, px.
const BASE_PX: u32 = 4096;

/// The least sides of a picture, px: placements of smaller ones on large canvases leave their range.
const LEAST_PX: i32 = 8;

/// How much finer than pixels an outline's own curves are, whose areas are to be exact.
const FINER: f32 = 8.0;

/// A path and the rectangle of its plane that its picture shows.
#[derive(Debug)]
pub struct PathDrawing {
    path: LivePath,
    bounds: Rect,
}

impl VectorDrawing for PathDrawing {
    fn size(&self) -> Vec2 {
        vec2(self.bounds.width() as f32, self.bounds.height() as f32)
    }

    fn draw(&self, size: Size) -> Option<Vec<[u8; 4]>> {
        let bytes = memory::fill(4 * size.area(), 0u8).ok()?;
        self.draw_into(size, bytes)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl LivePath {
    /// The pixels of its plane that its picture shows: all that it covers, with a pixel around it.
    /// Where that is longer than a picture is at first, both sides are multiples of how many times.
    pub fn bounds(&self) -> Rect {
        let inked = self.inked_box().unwrap_or([Vec2::ZERO; 2]);
        let place = |v: f32| v.max(-1e7).min(1e7) as i32;
        let low = (inked[0] - 1.0).floor();
        let high = (inked[1] + 1.0).ceil();
        let (x0, y0) = (place(low.x), place(low.y));
        let (width, height) = (place(high.x) - x0, place(high.y) - y0);
        let times = shrink(width.max(height));
        let whole = |side: i32| (side.max(LEAST_PX) + times - 1) / times * times;
        Rect { x0, y0, x1: x0 + whole(width), y1: y0 + whole(height) }
    }

    /// Its picture at the size of its plane, or smaller if that is large; drawn larger where it is
    /// seen larger. Bytes that cannot be had unwind, as those of other pictures do.
    pub fn picture(&self) -> Picture {
        let bounds = self.bounds();
        let size = size_within(bounds);
        let drawing = PathDrawing { path: self.clone(), bounds };
        let bytes = memory::fill_or_unwind(4 * size.area(), 0u8);
        let texels = drawing.draw_into(size, bytes).and_then(|texels| Picture::srgb8(size, texels));
        let blank = || Picture::srgb8(Size::new(1, 1), vec![[0; 4]]);
        let picture =
            texels.or_else(blank).unwrap_or_else(|| unreachable!("one pixel is a picture"));
        Picture { drawing: Some(Arc::new(drawing)), ..picture }
    }

    /// The size of that picture.
    pub fn picture_size(&self) -> Size {
        size_within(self.bounds())
    }

    /// The exact share of each pixel that it paints, however opaque its colors are; its plane is the
    /// canvas.
    pub fn area(&self, within: Rect) -> CoverageGrid {
        let is_filled = self.fill.is_some_and(|fill| fill.a > 0);
        let filled = if is_filled { self.inside(within) } else { CoverageGrid::default() };
        let outline = self.outline_path(FINER).filter(|_| self.outline_color.a > 0);
        let Some(outline) = outline else { return filled };
        let lines = LivePath::new(lines_of(&outline)).flatten_for_area(Some);
        let mut plane = Plane::full(Size::new(within.width() as u32, within.height() as u32), 0);
        winding::visit_rows(&lines, within, |y, row| {
            plane.row_mut((y - within.y0) as usize).copy_from_slice(row);
        });
        let outlined = CoverageGrid::from_plane(&plane, within.x0, within.y0);
        filled.combined(&outlined, |a, b| 255 - product(255 - a, 255 - b))
    }

    /// The exact share of each pixel that lies inside of it, whether it is filled or not.
    pub fn inside(&self, within: Rect) -> CoverageGrid {
        let lines = self.flatten_for_area(Some);
        let lines: Vec<&[Vec2]> = lines.iter().map(Vec::as_slice).collect();
        shapes::polygons(&lines, self.rule == PathRule::EvenOdd, within)
    }

    /// The corners of the box that holds all that it inks.
    fn inked_box(&self) -> Option<[Vec2; 2]> {
        let lines = path_of(&self.subpaths());
        let filled = lines.as_ref().and_then(Path::compute_tight_bounds);
        let outlined = self.outline_path(1.0).and_then(|path| path.compute_tight_bounds());
        let boxes = [filled, outlined].into_iter().flatten();
        let corners = boxes.map(|b| [vec2(b.left(), b.top()), vec2(b.right(), b.bottom())]);
        corners.reduce(|[low, high], [a, b]| [low.min(a), high.max(b)]).or_else(|| {
            let first = self.subpaths().iter().find_map(|line| line.nodes.first().map(|n| n.at))?;
            Some([first, first])
        })
    }

    /// The area that its outline covers, closed lines to be filled whole; `None` without one.
    ///
    /// * `scale`: how much larger than its plane it is seen, for how finely arcs are divided.
    fn outline_path(&self, scale: f32) -> Option<Path> {
        if self.outline <= 0.0 {
            return None;
        }
        let lines = self.subpaths();
        if ribbon::is_uneven(&lines) {
            return ribbon::of_lines(&lines, self.outline, scale);
        }
        let path = path_of(&lines)?;
        let stroke = self.stroke();
        let dashed = stroke.dash.as_ref().and_then(|dash| path.dash(dash, scale));
        PathStroker::new().stroke(dashed.as_ref().unwrap_or(&path), &stroke, scale)
    }

    fn stroke(&self) -> Stroke {
        let mut dashes = self.dashes.clone();
        if dashes.len() % 2 == 1 {
            dashes.extend_from_slice(&self.dashes);
        }
        Stroke {
            width: self.outline,
            miter_limit: Self::MITER,
            line_cap: match self.cap {
                PathCap::Butt => LineCap::Butt,
                PathCap::Round => LineCap::Round,
                PathCap::Square => LineCap::Square,
            },
            line_join: match self.join {
                PathJoin::Miter => LineJoin::Miter,
                PathJoin::Round => LineJoin::Round,
                PathJoin::Bevel => LineJoin::Bevel,
            },
            dash: StrokeDash::new(dashes, 0.0),
        }
    }
}

impl PathDrawing {
    /// Draws into bytes that are zero: each pixel by the exact share of it that is covered.
    fn draw_into(&self, size: Size, mut bytes: Vec<u8>) -> Option<Vec<[u8; 4]>> {
        let scale = size.width as f32 / self.bounds.width() as f32;
        let corner = vec2(self.bounds.x0 as f32, self.bounds.y0 as f32);
        let place = |p: Vec2| Some((p - corner) * scale);
        let width = size.width as usize;
        let texels = bytes.as_chunks_mut::<4>().0;
        if let Some(fill) = self.path.fill {
            let lines = self.path.flatten_for_area(place);
            let lines: Vec<&[Vec2]> = lines.iter().map(Vec::as_slice).collect();
            let has_holes = self.path.rule == PathRule::EvenOdd;
            shapes::visit_rows(&lines, has_holes, size.rect(), |y, row| {
                cover_row(&mut texels[y as usize * width..], row, fill);
            });
        }
        if let Some(outline) = self.path.outline_path(scale * FINER) {
            let lines = LivePath::new(lines_of(&outline)).flatten_for_area(place);
            let color = self.path.outline_color;
            winding::visit_rows(&lines, size.rect(), |y, row| {
                cover_row(&mut texels[y as usize * width..], row, color);
            });
        }
        Some(bytes.as_chunks().0.to_vec())
    }
}

/// Lays a color over a row of straight texels, where it is covered.
fn cover_row(texels: &mut [[u8; 4]], row: &[u8], color: Color) {
    let [r, g, b, a] = [color.r, color.g, color.b, color.a];
    for (texel, covered) in texels.iter_mut().zip(row).filter(|(_, covered)| **covered > 0) {
        let alpha = product(a, *covered);
        *texel = match (alpha, texel[3]) {
            (0, _) => *texel,
            (255, _) | (_, 0) => [r, g, b, alpha],
            (_, beneath) => {
                let over = f32::from(alpha);
                let left = f32::from(beneath) * (1.0 - over / 255.0);
                let mix = |own: u8, other: u8| {
                    let sum = f32::from(own) * over + f32::from(other) * left;
                    (sum / (over + left) + 0.5) as u8
                };
                let [x, y, z, _] = *texel;
                [mix(r, x), mix(g, y), mix(b, z), (over + left + 0.5) as u8]
            }
        };
    }
}

/// The lines of what the drawing library drew.
fn lines_of(path: &Path) -> Vec<Subpath> {
    let at = |p: Point| vec2(p.x, p.y);
    let mut lines: Vec<Subpath> = Vec::new();
    for segment in path.segments() {
        if let PathSegment::MoveTo(p) = segment {
            lines.push(Subpath::polygon([at(p)]));
            continue;
        }
        let Some(line) = lines.last_mut() else { continue };
        let Some(last) = line.nodes.last_mut() else { continue };
        let (after, before, end) = match segment {
            PathSegment::LineTo(p) => (Vec2::ZERO, Vec2::ZERO, at(p)),
            PathSegment::QuadTo(b, p) => {
                let (b, p) = (at(b), at(p));
                ((b - last.at) * (2.0 / 3.0), (b - p) * (2.0 / 3.0), p)
            }
            PathSegment::CubicTo(b, c, p) => (at(b) - last.at, at(c) - at(p), at(p)),
            PathSegment::Close | PathSegment::MoveTo(_) => continue,
        };
        last.after = after;
        line.nodes.push(PathNode { before, ..PathNode::corner(end) });
    }
    lines
}

/// The size at which a path within bounds is drawn at first.
fn size_within(bounds: Rect) -> Size {
    let (width, height) = (bounds.width() as u32, bounds.height() as u32);
    let times = shrink(width.max(height) as i32) as u32;
    Size::new(width / times, height / times)
}

/// How many times smaller than its plane a path of this length is drawn at first.
fn shrink(longest: i32) -> i32 {
    (longest.max(1) as u32).div_ceil(BASE_PX) as i32
}

/// Lines as the drawing library wants them; `None` where there are none.
pub(super) fn path_of(lines: &[Subpath]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for line in lines {
        let Some(first) = line.nodes.first() else { continue };
        path.move_to(first.at.x, first.at.y);
        for [a, b, c, d] in line.curves() {
            if a == b && c == d {
                path.line_to(d.x, d.y);
            } else {
                path.cubic_to(b.x, b.y, c.x, c.y, d.x, d.y);
            }
        }
        if line.closed {
            path.close();
        }
    }
    path.finish()
}

#[cfg(test)]
mod tests;
