//! A blur along the lines of the surface, which stops at contours. Floor 3. On premultiplied encoded
//! pixels.
//!
//! Two means of few readings make one of many: of readings a pixel apart, then of these, as far
//! apart as the first mean is long. The second one jumps: where the line through a pixel leads is
//! found once, together with the first mean.

use super::draft::{SoftKernel, detail_of_mean};
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::{Rect, Vec2, vec2};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use crate::raster::Plane;
use crate::surface::{Curvature, Scene, Surface, links};

/// Smeared along the lines in which the surface bends least, or across them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowBlur {
    /// Of the way, px.
    pub length: f32,
    /// How smooth the lines are: the standard deviation of a blur of the normals, px.
    pub smooth: f32,
    /// Along the lines in which it bends most.
    pub across: bool,
}

impl Default for FlowBlur {
    fn default() -> Self {
        Self { length: 24.0, smooth: 4.0, across: false }
    }
}

impl Parameters for FlowBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let length = parameter_name("length", "Length", "How far paint is smeared");
        let length = NumberParameter::whole(length, 0.0, 200.0, 24.0).decimals(1).px();
        v.number(length, &mut self.length);
        let smooth =
            parameter_name("smooth", "Smoothness", "How much small bumps are left out of the flow");
        let smooth = NumberParameter::whole(smooth, 0.0, 100.0, 4.0).decimals(1).px();
        v.number(smooth, &mut self.smooth);
        let across = parameter_name("across", "Across", "Around the form and not along it");
        v.flag(across, false, &mut self.across);
    }
}

impl FilterKernel for FlowBlur {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        self.length.max(0.0) * 0.5 + 4.0
    }

    fn warm(&self, scene: &Scene) {
        let _ = scene.surface.as_deref().map(|surface| surface.curvature(self.smooth));
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let out = place.out;
        let Some(surface) = place.scene.surface.as_deref().filter(|_| self.length > 1.0) else {
            return source.window(out).cropped(out);
        };
        // The surface has its own size, whatever that of the picture is.
        let curvature = surface.curvature(self.smooth * place.canvas_px as f32);
        // Steps of a pixel in a jump, and jumps.
        let steps = self.length.sqrt().ceil().max(1.0);
        let jumps = (self.length / steps).ceil().max(1.0);
        let around = out.grown((0.5 * self.length).ceil() as i32 + 2).intersect(source.bounds());
        let reads = around.grown((0.5 * steps).ceil() as i32 + 2).intersect(source.bounds());
        let reads = reads.intersect(out.grown(self.reach(out, out).ceil() as i32));
        let window = source.window(reads.union(out));
        let lines =
            FlowLines::of(surface, &curvature, self.across, (window.rect(), place.canvas_px));
        let around = around.intersect(window.rect());
        let (mut means, mut ways) = (Vec::new(), Vec::new());
        // Jumps begin no farther out than this.
        let jumping = out.grown((0.5 * self.length - steps).max(0.0).ceil() as i32 + 2);
        mean_along(&lines, &window, (around, jumping), steps, (&mut means, &mut ways));
        let first = FilterWindow::new(around, means);
        let mut all = Vec::new();
        mean_of_jumps(&lines, (&first, &ways), out, jumps, &mut all);
        all
    }

    fn as_soft(&self) -> Option<&dyn SoftKernel> {
        Some(self)
    }
}

impl SoftKernel for FlowBlur {
    /// Where nothing is smeared, and at contours, which stay.
    fn detail_left(&self, place: &FilterPlace, _: Rect) -> Vec<f32> {
        let (out, side) = (place.out, place.canvas_px);
        let Some(surface) = place.scene.surface.as_deref() else {
            return vec![1.0; out.width() * out.height()];
        };
        let smeared = detail_of_mean(self.length * side as f32);
        let mut all = Vec::with_capacity(out.width() * out.height());
        for y in out.y0..out.y1 {
            all.extend((out.x0..out.x1).map(|x| {
                let square = Rect::new(x * side, y * side, (x + 1) * side, (y + 1) * side);
                if is_one_piece(surface, square) { smeared } else { 1.0 }
            }));
        }
        all
    }
}

/// Whether the pixels of a square lie on a surface, which goes on to all sides of each within the
/// canvas.
fn is_one_piece(surface: &Surface, square: Rect) -> bool {
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

const ALL: u8 = links::LEFT | links::RIGHT | links::UP | links::DOWN;

/// A point on a line, counted from the corner of the lines' rectangle.
#[derive(Clone, Copy)]
struct FlowPoint {
    at: Vec2,
    /// Its pixel.
    pixel: (i32, i32),
    /// Unit.
    heading: Vec2,
}

/// Where a line leads from a pixel's center in some steps; no heading where it ends before.
#[derive(Clone, Copy, Default)]
struct FlowJump {
    by: Vec2,
    heading: Vec2,
}

/// The lines of a part of a surface.
struct FlowLines {
    rect: Rect,
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
    fn of(
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
    fn direction(&self, (x, y): (i32, i32)) -> Vec2 {
        self.directions[y as usize * self.rect.width() + x as usize]
    }

    /// The center of a pixel, by the canvas's count.
    #[inline(always)]
    fn start(&self, x: i32, y: i32) -> FlowPoint {
        let pixel = (x - self.rect.x0, y - self.rect.y0);
        let at = vec2(pixel.0 as f32 + 0.5, pixel.1 as f32 + 0.5);
        FlowPoint { at, pixel, heading: self.direction(pixel) }
    }

    /// A pixel along the line; `None` where it ends.
    #[inline(always)]
    fn step(&self, from: FlowPoint) -> Option<FlowPoint> {
        self.reach(from, from.at + from.heading, from.heading)
    }

    /// A jump along the line.
    ///
    /// * `ways`: from each pixel of a rectangle, along its direction and against it.
    #[inline(always)]
    fn jump(&self, from: FlowPoint, ways: &[[FlowJump; 2]], rect: Rect) -> Option<FlowPoint> {
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
    fn reach(&self, from: FlowPoint, at: Vec2, heading: Vec2) -> Option<FlowPoint> {
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

crate::widest! {
    /// Means of readings a pixel apart, and where lines lead in so many steps.
    ///
    /// * `places`: of the means, and from where lines are followed that far.
    fn mean_along(
        lines: &FlowLines,
        window: &FilterWindow,
        places: (Rect, Rect),
        steps: f32,
        found: (&mut Vec<[f32; 4]>, &mut Vec<[FlowJump; 2]>)
    ) {
        let ((out, jumping), (means, ways)) = (places, found);
        let corner = vec2(lines.rect.x0 as f32, lines.rect.y0 as f32);
        let half = 0.5 * (steps - 1.0);
        for y in out.y0..out.y1 {
            for x in out.x0..out.x1 {
                let start = lines.start(x, y);
                let (mut sum, mut weight) = (window.at(x, y), 1.0);
                let mut way = [FlowJump::default(); 2];
                let count = if jumping.contains(x, y) { steps } else { half.ceil() } as i32;
                if start.heading != Vec2::ZERO {
                    for (way, heading) in way.iter_mut().zip([start.heading, -start.heading]) {
                        let mut here = FlowPoint { heading, ..start };
                        let (mut left, mut is_whole) = (half, true);
                        for _ in 0..count {
                            let Some(next) = lines.step(here) else {
                                is_whole = false;
                                break;
                            };
                            here = next;
                            if left > 0.0 {
                                let share = left.min(1.0);
                                let reading = window.sample(corner.x + here.at.x, corner.y + here.at.y);
                                for k in 0..4 {
                                    sum[k] += share * reading[k];
                                }
                                (left, weight) = (left - 1.0, weight + share);
                            }
                        }
                        if is_whole {
                            *way = FlowJump { by: here.at - start.at, heading: here.heading };
                        }
                    }
                }
                means.push(sum.map(|v| v / weight));
                ways.push(way);
            }
        }
    }

    /// Means of readings a jump apart; the outermost count in part.
    fn mean_of_jumps(
        lines: &FlowLines,
        first: (&FilterWindow, &[[FlowJump; 2]]),
        out: Rect,
        count: f32,
        means: &mut Vec<[f32; 4]>
    ) {
        let (window, ways) = first;
        let corner = vec2(lines.rect.x0 as f32, lines.rect.y0 as f32);
        for y in out.y0..out.y1 {
            for x in out.x0..out.x1 {
                let start = lines.start(x, y);
                let (mut sum, mut weight) = (window.at(x, y), 1.0);
                if start.heading != Vec2::ZERO {
                    for heading in [start.heading, -start.heading] {
                        let mut here = FlowPoint { heading, ..start };
                        let mut left = 0.5 * (count - 1.0);
                        while left > 0.0 {
                            let Some(next) = lines.jump(here, ways, window.rect()) else { break };
                            here = next;
                            let share = left.min(1.0);
                            let reading = window.sample(corner.x + here.at.x, corner.y + here.at.y);
                            for k in 0..4 {
                                sum[k] += share * reading[k];
                            }
                            (left, weight) = (left - 1.0, weight + share);
                        }
                    }
                }
                means.push(sum.map(|v| v / weight));
            }
        }
    }
}
