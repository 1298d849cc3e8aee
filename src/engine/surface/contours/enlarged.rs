//! Contours of a surface whose maps are made larger: which part of a contour pixel lies on which
//! side of its line, and what that side reads (MATH 10). Floor 2. Not here: everywhere else, where
//! maps are interpolated (`surface::fit`).

use super::continued::{Continued, nz_of, shorten_to_rim};
use super::line::ContourLine;
use super::maps::ContourMaps;
use super::window::{CENTER, PixelWindow, REACH, SIDE};
use super::{ContourPixel, Contours};
use crate::math::{Vec2, Vec3, parallel, vec2, vec3};
use crate::raster::Plane;
use crate::surface::links;

/// The pixels of a surface that must not be interpolated.
pub struct EnlargedContours<'m> {
    maps: &'m ContourMaps<'m>,
    /// Row by row, by their columns.
    rows: Vec<Vec<DividedPixel>>,
}

/// What one side of a contour reads in a pixel's window.
struct ContourSide {
    members: u64,
    continued: Continued,
}

/// A pixel that is cut by a contour, or ends next to one.
struct DividedPixel {
    x: i32,
    /// Its own side is the nearer one. None where the whole pixel is on one side, or where none is
    /// known.
    line: Option<ContourLine>,
    /// None where there is no surface.
    own: Option<ContourSide>,
    other: Option<ContourSide>,
    /// The mask says itself how much of the pixel is covered.
    is_shaded: bool,
    /// How the mask's shades change where they are no edge, `[0, 1]` per px.
    shades: Vec2,
}

impl<'m> EnlargedContours<'m> {
    pub fn new(maps: &'m ContourMaps<'m>, contours: &Contours) -> Self {
        let mut known: Vec<Vec<&ContourPixel>> = vec![Vec::new(); maps.size.height as usize];
        for pixel in contours.pixels() {
            known[pixel.y as usize].push(pixel);
        }
        let rows = parallel::map(known.into_iter().enumerate(), |(y, mut known)| {
            known.sort_by_key(|pixel| pixel.x);
            let coverage = maps.coverage.row(y);
            let mut known = known.into_iter().peekable();
            let at = |x: usize| {
                let contour = known.next_if(|pixel| pixel.x == x as i32);
                let ends = coverage[x] > 0 && is_beside_end(maps.links, x, y);
                (contour.is_some() || ends)
                    .then(|| DividedPixel::new(maps, (x as i32, y as i32), contour))
            };
            (0..coverage.len()).filter_map(at).collect()
        });
        Self { maps, rows }
    }

    fn at(&self, x: i32, y: i32) -> Option<&DividedPixel> {
        let row = self.rows.get(y as usize)?;
        row.binary_search_by_key(&x, |pixel| pixel.x).ok().map(|i| &row[i])
    }

    /// Whether the pixels around one are all of its piece of the surface.
    pub fn is_inner(&self, x: i32, y: i32) -> bool {
        let is_covered = self.maps.coverage.get(x, y).is_some_and(|coverage| coverage > 0);
        is_covered && self.at(x, y).is_none()
    }

    /// The share of a box that the surface covers, `[0, 1]`: exact on contour pixels whose line is
    /// known.
    ///
    /// * `low`, `high`: its corners, px of the map, inside it; no side longer than a pixel.
    pub fn coverage(&self, low: Vec2, high: Vec2) -> f32 {
        let mut covered = 0.0;
        for y in low.y.floor() as i32..high.y.ceil() as i32 {
            for x in low.x.floor() as i32..high.x.ceil() as i32 {
                let corner = vec2(x as f32, y as f32);
                let (from, to) = (low.max(corner), high.min(corner + 1.0));
                let sides = (to - from).max(Vec2::ZERO);
                let middle = (from + to) * 0.5;
                covered +=
                    sides.element_product() * self.covered_part(x, y, middle - corner - 0.5, sides);
            }
        }
        (covered / (high - low).element_product().max(1e-12)).clamp(0.0, 1.0)
    }

    /// How much of a box within a pixel is covered. `from_center`: of its middle, px.
    fn covered_part(&self, x: i32, y: i32, from_center: Vec2, sides: Vec2) -> f32 {
        let whole = self.maps.coverage.at(x as usize, y as usize);
        let Some(pixel) = self.at(x, y) else { return f32::from(whole) / 255.0 };
        match pixel.line {
            Some(line) if pixel.is_shaded || pixel.own.is_some() != pixel.other.is_some() => {
                let part = line.within(from_center, sides).nearer_share();
                if pixel.is_shaded || pixel.own.is_some() { part } else { 1.0 - part }
            }
            _ => f32::from(whole) / 255.0 + pixel.shades.dot(from_center),
        }
    }

    /// The normal (y up) and depth at a point of the map next to a contour, by its side alone;
    /// `None` elsewhere, where maps are interpolated.
    pub fn reading(&self, at: Vec2) -> Option<(Vec3, f32)> {
        let (x, y) = (at.x.floor() as i32, at.y.floor() as i32);
        let pixel = self.at(x, y)?;
        let from_center = at - vec2(x as f32, y as f32) - 0.5;
        let height = pixel.line.map_or(f32::MAX, |line| line.height(from_center));
        let (side, beyond) = match (&pixel.own, &pixel.other) {
            (Some(own), Some(other)) => (if height >= 0.0 { own } else { other }, 0.0),
            (Some(own), None) => (own, (-height).max(0.0)),
            (None, Some(other)) => (other, -height.max(0.0)),
            (None, None) => return None,
        };
        // Beyond the surface's end its last reading counts.
        let back = pixel.line.map_or(Vec2::ZERO, |line| line.toward_near * beyond);
        Some(self.side_reading((x, y), side, from_center + back))
    }

    /// Interpolated between what a side reads in the four pixels around a point: its own values,
    /// and where a pixel belongs to another side, its values continued.
    fn side_reading(
        &self,
        (x, y): (i32, i32),
        side: &ContourSide,
        from_center: Vec2,
    ) -> (Vec3, f32) {
        let low = from_center
            .floor()
            .clamp(Vec2::splat(1.0 - REACH as f32), Vec2::splat(REACH as f32 - 1.0));
        let way = from_center - low;
        let (mut nbar, mut depth) = (Vec2::ZERO, 0.0);
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let weight = if dx == 1 { way.x } else { 1.0 - way.x }
                * if dy == 1 { way.y } else { 1.0 - way.y };
            let (i, j) = (low.x as i32 + dx, low.y as i32 + dy);
            let bit = (j + REACH) * SIDE + i + REACH;
            let (n, z) = if side.members >> bit & 1 == 1 {
                let (u, v) = ((x + i) as usize, (y + j) as usize);
                let [nx, ny] = self.maps.nbar.map(|plane| plane.at(u, v));
                (vec2(nx, ny), self.maps.depth.at(u, v))
            } else {
                let there = vec2(i as f32, j as f32);
                (side.continued.nbar(there), side.continued.depth(there))
            };
            (nbar, depth) = (nbar + weight * n, depth + weight * z);
        }
        let nbar = shorten_to_rim(nbar);
        (vec3(nbar.x, -nbar.y, nz_of(nbar)), depth.clamp(0.0, 1.0))
    }
}

impl DividedPixel {
    fn new(maps: &ContourMaps, (x, y): (i32, i32), contour: Option<&ContourPixel>) -> Self {
        let coverage = maps.coverage.at(x as usize, y as usize);
        let is_shaded = coverage > 0 && coverage < 255;
        let window = PixelWindow::around(maps, x, y);
        let others = contour.map_or(0, |contour| contour.others);
        let side = |members: u64| {
            Continued::from(&window, members).map(|continued| ContourSide { members, continued })
        };
        let own = if coverage > 0 { window.piece_of_center() & !others | 1 << CENTER } else { 0 };
        let line = match is_shaded {
            true => ContourLine::of_shades(maps.coverage, (x, y)),
            false => contour.and_then(ContourPixel::line),
        };
        let shades =
            if is_shaded && line.is_none() { ramp(maps.coverage, (x, y)) } else { Vec2::ZERO };
        Self { x, line, own: side(own), other: side(others), is_shaded, shades }
    }
}

impl ContourPixel {
    /// The line between both sides, its own on the nearer side: the share and the middle of
    /// what the other one sees determine it. `None` where no line was found.
    fn line(&self) -> Option<ContourLine> {
        let (rest, at) = (1.0 - self.share, self.other_at);
        if at == Vec2::ZERO || rest < 1e-4 {
            return None;
        }
        let sign = vec2(1f32.copysign(at.x), 1f32.copysign(at.y));
        let is_wide = at.x.abs() >= at.y.abs();
        let along = if is_wide { at.y } else { at.x };
        // The other's part is {p: across · p ≥ from}.
        let (across, from) = if along.abs() <= 1.0 / 6.0 {
            // A trapezium with its base on a side: of height h(t) = rest + 12 rest · along · t.
            let lean = 12.0 * rest * along;
            (if is_wide { vec2(sign.x, lean) } else { vec2(lean, sign.y) }, 0.5 - rest)
        } else {
            // A triangle in a corner: its middle lies a third of its legs away from there.
            let legs = (3.0 * (Vec2::splat(0.5) - at.abs())).max(Vec2::splat(1e-3));
            (sign / legs, 0.5 / legs.x + 0.5 / legs.y - 1.0)
        };
        let length = across.length();
        Some(ContourLine { distance_px: from / length, toward_near: -across / length })
    }
}

impl ContourLine {
    /// The same line as seen by a box within the pixel, in whose own unit it is measured.
    fn within(self, from_center: Vec2, sides: Vec2) -> Self {
        Self { distance_px: self.height(from_center), toward_near: self.toward_near * sides }
    }
}

/// One of the eight pixels around one is not of the same piece.
fn is_beside_end(of: &Plane<u8>, x: usize, y: usize) -> bool {
    let has = |dx: i32, dy: i32, link: u8| {
        of.get(x as i32 + dx, y as i32 + dy).is_some_and(|set| set & link != 0)
    };
    // A corner is linked by either pixel between.
    let corner = |dx: i32, dy: i32, across: u8, down: u8| !has(dx, 0, down) && !has(0, dy, across);
    of.at(x, y) != 15
        || corner(1, 1, links::RIGHT, links::DOWN)
        || corner(-1, 1, links::LEFT, links::DOWN)
        || corner(1, -1, links::RIGHT, links::UP)
        || corner(-1, -1, links::LEFT, links::UP)
}

/// How shades change at a pixel, `[0, 1]` per px, as in a soft ramp: so far that none within it
/// leaves the range.
fn ramp(coverage: &Plane<u8>, (x, y): (i32, i32)) -> Vec2 {
    let shade =
        |dx: i32, dy: i32| coverage.get(x + dx, y + dy).map(|shade| f32::from(shade) / 255.0);
    let half = |before: Option<f32>, after: Option<f32>| {
        before.zip(after).map_or(0.0, |(a, b)| 0.5 * (b - a))
    };
    let slope = vec2(half(shade(-1, 0), shade(1, 0)), half(shade(0, -1), shade(0, 1)));
    let here = shade(0, 0).unwrap_or(0.0);
    let (reach, room) = (0.5 * slope.abs().element_sum(), here.min(1.0 - here));
    if reach > room { slope * (room / reach) } else { slope }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_and_the_middle_of_the_rest_give_the_line() {
        for turn in 0..40 {
            let toward_near = Vec2::from_angle(turn as f32 * 0.157 + 0.01);
            for share in [0.5, 0.6, 0.75, 0.9, 0.97] {
                let line = ContourLine::of_share(share, toward_near);
                let other_at = line.turned().nearer_centroid();
                let pixel = ContourPixel {
                    x: 0,
                    y: 0,
                    share,
                    is_own_on_surface: true,
                    others: 0,
                    other_at,
                    own_turn: Vec2::ZERO,
                };
                let found = pixel.line().unwrap();
                let off = (found.toward_near - line.toward_near).length()
                    + (found.distance_px - line.distance_px).abs();
                assert!(off < 2e-2, "{found:?} for {line:?}");
            }
        }
    }
}
