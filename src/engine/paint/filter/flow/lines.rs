//! The lines of a surface, followed from pixel to pixel until they meet a contour. Floor 3. Not here:
//! what is read on the way (`flow`).

use crate::math::{Rect, Vec2, vec2};
use crate::raster::Plane;
use crate::surface::{Curvature, Surface, links};

/// Whether the pixels of a square lie on a surface, which goes on to all sides of each within the
/// canvas.
pub fn is_one_piece(surface: &Surface, square: Rect) -> bool {
    let (canvas, linked) = (surface.size().rect(), surface.links_plane());
    let square = square.intersect(canvas);
    let mut open = ALL;
    for y in square.y0..square.y1 {
        for x in square.x0..square.x1 {
            open &= linked.at(x as usize, y as usize);
        }
    }
    let beyond = |is_last: bool, link: u8| if is_last { link } else { 0 };
    open |= beyond(square.x0 == canvas.x0, links::LEFT)
        | beyond(square.x1 == canvas.x1, links::RIGHT)
        | beyond(square.y0 == canvas.y0, links::UP)
        | beyond(square.y1 == canvas.y1, links::DOWN);
    open == ALL && surface.coverage_plane().at_clamped(square.x0, square.y0) > 0
}

/// A pixel that its surface goes on from to all four sides.
const ALL: u8 = links::LEFT | links::RIGHT | links::UP | links::DOWN;

/// A point on a line, counted from the corner of the lines' rectangle.
#[derive(Clone, Copy)]
pub struct FlowPoint {
    pub at: Vec2,
    /// Its pixel.
    pub pixel: (i32, i32),
    /// Unit.
    pub heading: Vec2,
}

/// Where a line leads from a pixel's center in some steps; no heading where it ends before.
#[derive(Clone, Copy, Default)]
pub struct FlowJump {
    pub by: Vec2,
    pub heading: Vec2,
}

/// The lines of a part of a surface.
pub struct FlowLines {
    pub rect: Rect,
    /// Unit, image axes (y down), sign arbitrary; zero off the surface.
    directions: Vec<Vec2>,
    /// Which of the eight pixels around each belong to the same piece of surface: a bit each, by
    /// [`bit_toward`].
    open: Vec<u16>,
}

/// The bit of a neighbor, up to a pixel away both ways.
#[inline(always)]
fn bit_toward(dx: i32, dy: i32) -> u16 {
    1 << ((dy + 1) * 3 + dx + 1)
}

impl FlowLines {
    /// * `part`: a rectangle of the picture, and the side of its pixels in those of the surface.
    pub fn of(
        surface: &Surface,
        curvature: &Curvature,
        is_across: bool,
        (rect, side): (Rect, i32),
    ) -> Self {
        let (size, coverage) = (surface.size().rect(), surface.coverage_plane());
        let direction = |(x, y): (i32, i32)| {
            let (x, y) = (x * side, y * side);
            if !size.contains(x, y) || coverage.at_clamped(x, y) == 0 {
                return Vec2::ZERO;
            }
            let bent = bending_direction(curvature.tensor(x as usize, y as usize));
            if is_across { bent } else { bent.perp() }
        };
        let places = || (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (x, y)));
        let directions = places().map(direction).collect();
        let linked = surface.links_plane();
        let open = if side == 1 {
            let link = |x, y| linked.get(x, y).unwrap_or(0);
            places().map(|(x, y)| open_bits(link, rect, x, y)).collect()
        } else {
            let links: Vec<u8> = places().map(|at| links_over(linked, at, side)).collect();
            let width = rect.width();
            let link = |x, y| links[(y - rect.y0) as usize * width + (x - rect.x0) as usize];
            places().map(|(x, y)| open_bits(link, rect, x, y)).collect()
        };
        Self { rect, directions, open }
    }

    #[inline(always)]
    pub fn direction(&self, (x, y): (i32, i32)) -> Vec2 {
        self.directions[y as usize * self.rect.width() + x as usize]
    }

    /// The center of a pixel, by the canvas's count.
    #[inline(always)]
    pub fn start(&self, x: i32, y: i32) -> FlowPoint {
        let pixel = (x - self.rect.x0, y - self.rect.y0);
        let at = vec2(pixel.0 as f32 + 0.5, pixel.1 as f32 + 0.5);
        FlowPoint { at, pixel, heading: self.direction(pixel) }
    }

    /// A pixel along the line; `None` where it ends.
    #[inline(always)]
    pub fn step(&self, from: FlowPoint) -> Option<FlowPoint> {
        self.reach(from, from.at + from.heading, from.heading)
    }

    /// A jump along the line.
    ///
    /// * `ways`: from each pixel of a rectangle, along its direction and against it.
    #[inline(always)]
    pub fn jump(&self, from: FlowPoint, ways: &[[FlowJump; 2]], rect: Rect) -> Option<FlowPoint> {
        let (x, y) = (from.pixel.0 + self.rect.x0, from.pixel.1 + self.rect.y0);
        if !rect.contains(x, y) {
            return None;
        }
        let index = (y - rect.y0) as usize * rect.width() + (x - rect.x0) as usize;
        let is_against = self.direction(from.pixel).dot(from.heading) < 0.0;
        let way = ways[index][usize::from(is_against)];
        if way.heading == Vec2::ZERO {
            return None;
        }
        // Found from the pixel's center; from here it ends as far beside that.
        let center = vec2(from.pixel.0 as f32 + 0.5, from.pixel.1 as f32 + 0.5);
        let found = center + way.by;
        let end = FlowPoint { at: found, pixel: pixel_at(found), heading: way.heading };
        self.reach(end, from.at + way.by, way.heading)
    }

    /// A point up to a pixel away, if it belongs to the same piece of surface.
    #[inline(always)]
    pub fn reach(&self, from: FlowPoint, at: Vec2, heading: Vec2) -> Option<FlowPoint> {
        let pixel = pixel_at(at);
        let (x, y) = from.pixel;
        let index = y as usize * self.rect.width() + x as usize;
        if self.open[index] & bit_toward(pixel.0 - x, pixel.1 - y) == 0 {
            return None;
        }
        let along = self.direction(pixel);
        let heading = if along.dot(heading) < 0.0 { -along } else { along };
        (heading != Vec2::ZERO).then_some(FlowPoint { at, pixel, heading })
    }
}

#[inline(always)]
fn pixel_at(at: Vec2) -> (i32, i32) {
    (at.x.floor() as i32, at.y.floor() as i32)
}

/// The direction in which a surface bends most, unit, image axes (y down), sign arbitrary.
///
/// * `tensor`: `[h_xx, h_xy, h_yy]`, y up.
#[inline(always)]
fn bending_direction([hxx, hxy, hyy]: [f32; 3]) -> Vec2 {
    let half = 0.5 * (hxx - hyy);
    let radius = (half * half + hxy * hxy).sqrt();
    // Half of the angle of (half, h_xy), by its cosine.
    let cosine = if radius > 0.0 { half / radius } else { 1.0 };
    let (cos, sin) =
        ((0.5 * (1.0 + cosine)).max(0.0).sqrt(), (0.5 * (1.0 - cosine)).max(0.0).sqrt());
    let sin = sin.copysign(hxy);
    // Of the two principal directions the one whose curvature is larger in size.
    if hxx + hyy >= 0.0 { vec2(cos, -sin) } else { vec2(sin, cos) }
}

/// Where a surface goes on from a pixel of a smaller picture to the next ones: over all pixels of its
/// own between.
#[inline(always)]
fn links_over(linked: &Plane<u8>, (x, y): (i32, i32), side: i32) -> u8 {
    let (x, y) = (x * side, y * side);
    let link = |x: i32, y: i32| linked.get(x, y).unwrap_or(0);
    let mut open = link(x, y);
    for i in 1..side {
        open &= link(x - i, y) & links::LEFT
            | link(x + i, y) & links::RIGHT
            | link(x, y - i) & links::UP
            | link(x, y + i) & links::DOWN;
    }
    open
}

/// The neighbors of a pixel within a rectangle that its links lead to, by one way at least.
fn open_bits(linked: impl Fn(i32, i32) -> u8, rect: Rect, x: i32, y: i32) -> u16 {
    const AROUND: [(i32, i32); 8] =
        [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)];
    let across = |dx: i32| if dx < 0 { links::LEFT } else { links::RIGHT };
    let down = |dy: i32| if dy < 0 { links::UP } else { links::DOWN };
    let own = linked(x, y);
    let mut bits = bit_toward(0, 0);
    let is_inner = rect.x0 < x && x < rect.x1 - 1 && rect.y0 < y && y < rect.y1 - 1;
    if is_inner
        && own & ALL == ALL
        && linked(x, y - 1) & ALL == ALL
        && linked(x, y + 1) & ALL == ALL
    {
        return (1 << 9) - 1;
    }
    for (dx, dy) in AROUND.into_iter().filter(|(dx, dy)| rect.contains(x + dx, y + dy)) {
        let is_open = if dx == 0 {
            own & down(dy) != 0
        } else if dy == 0 {
            own & across(dx) != 0
        } else {
            own & across(dx) != 0 && linked(x + dx, y) & down(dy) != 0
                || own & down(dy) != 0 && linked(x, y + dy) & across(dx) != 0
        };
        bits |= if is_open { bit_toward(dx, dy) } else { 0 };
    }
    bits
}
