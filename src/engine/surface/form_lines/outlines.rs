//! Outlines, creases and borders of parts: traced along the links between pixels that are broken,
//! at the places that contours know between pixels. Floor 2. Not here: curves of smooth forms
//! (`fields`).

#[cfg(test)]
mod tests;

use super::chains::{CellSide, Chain, LineStep, join_steps, sides};
use super::tidy::RawLine;
use super::{LineKind, LinePoint, LineSettings};
use crate::math::{Vec2, parallel, vec2};
use crate::raster::Plane;
use crate::surface::{Surface, links};

/// A gap of this ratio of the canvas is as clear as the rim of the surface.
const WHOLE_GAP: f32 = 0.03;
/// The strength of the slightest step between two forms.
const LEAST_GAP: f32 = 0.35;
/// The angle of a crease that is as clear as can be, rad.
const WHOLE_CREASE: f32 = 1.2;
/// Places between pixels stay so far from their centers, px.
const WITHIN: f32 = 0.02;

/// What separates two pixels.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Parting {
    Outline,
    Crease,
    Border,
}

/// Where a side of a cell is crossed.
#[derive(Clone, Copy)]
struct LinkCrossing {
    key: u64,
    point: LinePoint,
    /// Which side of the cell, 0 … 3.
    side: usize,
    /// From the nearer pixel to the other.
    toward_far: Vec2,
}

struct Partings<'s> {
    surface: &'s Surface,
    /// Coverage as contours correct it, `[0, 255]`.
    shares: Plane<u8>,
    /// The share of each pixel that its own population sees, where it is between parts.
    own: Plane<f32>,
    /// The cells between pixels that something separates, row by row, by their upper left pixel.
    cells: Vec<Vec<(usize, usize)>>,
}

/// The lines along broken links.
pub(super) fn trace(surface: &Surface, settings: &LineSettings) -> Vec<RawLine> {
    let mut own = Plane::full(surface.size(), 1.0f32);
    for pixel in surface.contours().pixels().iter().filter(|pixel| pixel.is_between_parts()) {
        own.set(pixel.x as usize, pixel.y as usize, pixel.share);
    }
    let shares = surface.shares();
    let cells = parted_cells(surface, &shares);
    let partings = Partings { surface, shares, own, cells };
    let kinds = [
        (Parting::Outline, LineKind::Outline),
        (Parting::Crease, LineKind::Crease),
        (Parting::Border, LineKind::Border),
    ];
    let wanted = kinds.into_iter().filter(|(_, kind)| settings.kinds.has_kind(*kind));
    wanted.flat_map(|(parting, kind)| partings.lines(parting, kind)).collect()
}

/// The cells whose four pixels are not all one smooth piece of one part, row by row.
fn parted_cells(surface: &Surface, shares: &Plane<u8>) -> Vec<Vec<(usize, usize)>> {
    let width = shares.width().saturating_sub(1);
    let rows = 0..shares.height().saturating_sub(1);
    let cells_of_row = |marks: &mut Vec<u8>, y: usize| -> Vec<(usize, usize)> {
        let [shares, linked, smooth] =
            [shares, surface.links_plane(), surface.smooth_links_plane()]
                .map(|plane| [plane.row(y), plane.row(y + 1)]);
        mark_torn_cells(shares, linked, smooth, marks);
        if let Some(parts) = surface.parts_plane() {
            let (top, bottom) = (parts.row(y), parts.row(y + 1));
            let pairs = top.windows(2).zip(bottom.windows(2));
            for (mark, (top, bottom)) in marks.iter_mut().zip(pairs) {
                *mark |= u8::from(top[0] != top[1] || top != bottom);
            }
        }
        (0..width).filter(|&x| marks[x] != 0).map(|x| (x, y)).collect()
    };
    parallel::map_with(rows, || vec![0u8; width], cells_of_row)
}

crate::widest! {
    /// Marks the cells between two rows with a pixel off the surface or a link missing.
    fn mark_torn_cells(
        shares: [&[u8]; 2],
        linked: [&[u8]; 2],
        smooth: [&[u8]; 2],
        marks: &mut [u8],
    ) {
        let n = marks.len();
        let [[s0, s1], [l0, l1], [m0, m1]] = [shares, linked, smooth].map(|rows| rows.map(|row| &row[..=n]));
        for x in 0..n {
            let on = s0[x] & s0[x + 1] & s1[x] & s1[x + 1];
            let across = l0[x] & m0[x] & l1[x] & m1[x] & links::RIGHT;
            let down = l0[x] & m0[x] & l0[x + 1] & m0[x + 1] & links::DOWN;
            let is_whole = (across != 0) & (down != 0);
            marks[x] = u8::from((on < 128) | !is_whole);
        }
    }
}

impl Partings<'_> {
    fn is_on(&self, (x, y): (usize, usize)) -> bool {
        self.shares.at(x, y) >= 128
    }

    /// Whether a pixel of the surface next to the rim, or next to such a one, is not linked inward:
    /// what lies there is hardly wider than a pixel, and its own rim is drawn. Coarse maps tore it
    /// off what it belongs to.
    fn is_fringe(&self, (x, y): (usize, usize)) -> bool {
        let linked = self.surface.links_plane().at(x, y);
        let (x, y) = (x as i32, y as i32);
        let is_on = |by: i32, (dx, dy): (i32, i32)| {
            self.shares.get(x + by * dx, y + by * dy).is_none_or(|share| share >= 128)
        };
        let inward = [
            (links::RIGHT, (1, 0)),
            (links::LEFT, (-1, 0)),
            (links::DOWN, (0, 1)),
            (links::UP, (0, -1)),
        ];
        is_on(0, (0, 0))
            && inward.into_iter().any(|(bit, way)| {
                linked & bit == 0 && is_on(1, way) && (!is_on(-1, way) || !is_on(-2, way))
            })
    }

    /// What separates two neighbors, if anything does.
    fn parting(&self, a: (usize, usize), b: (usize, usize)) -> Option<Parting> {
        let (on_a, on_b) = (self.is_on(a), self.is_on(b));
        if !on_a || !on_b {
            return (on_a != on_b).then_some(Parting::Outline);
        }
        let bit = if a.0 == b.0 { links::DOWN } else { links::RIGHT };
        let is_linked = |links: &Plane<u8>| links.at(a.0, a.1) & bit != 0;
        if !is_linked(self.surface.links_plane()) {
            let is_torn = self.is_fringe(a) || self.is_fringe(b);
            return (!is_torn).then_some(Parting::Outline);
        }
        if !is_linked(self.surface.smooth_links_plane()) {
            return Some(Parting::Crease);
        }
        let parts = self.surface.parts_plane()?;
        (parts.at(a.0, a.1) != parts.at(b.0, b.1)).then_some(Parting::Border)
    }

    /// Depth, px; nothing lies behind all else.
    fn depth_px(&self, (x, y): (usize, usize)) -> f32 {
        if self.is_on((x, y)) {
            self.surface.depth(x, y) * self.surface.depth_range_px()
        } else {
            f32::INFINITY
        }
    }

    fn crossing(
        &self,
        parting: Parting,
        (a, b, key): ((usize, usize), (usize, usize), u64),
        side: usize,
    ) -> Option<LinkCrossing> {
        if self.parting(a, b) != Some(parting) {
            return None;
        }
        let place = |(x, y): (usize, usize)| vec2(x as f32 + 0.5, y as f32 + 0.5);
        let (near, far) = if self.depth_px(a) <= self.depth_px(b) { (a, b) } else { (b, a) };
        let share = match (self.is_on(near), self.is_on(far)) {
            (true, true) => [self.own.at(near.0, near.1), 1.0 - self.own.at(far.0, far.1)],
            _ => [near, far].map(|(x, y)| f32::from(self.shares.at(x, y)) / 255.0),
        };
        let drop = share[0] - share[1];
        let t = if drop > 1e-3 { (share[0] - 0.5) / drop } else { 0.5 };
        let (from, to) = (place(near), place(far));
        let at = from.lerp(to, t.clamp(WITHIN, 1.0 - WITHIN));
        let point = LinePoint { at, strength: self.strength(parting, near, far) };
        Some(LinkCrossing { key, point, side, toward_far: to - from })
    }

    fn strength(&self, parting: Parting, near: (usize, usize), far: (usize, usize)) -> f32 {
        match parting {
            Parting::Outline => {
                let whole = WHOLE_GAP * self.surface.size().longer_side();
                let gap = (self.depth_px(far) - self.depth_px(near)) / whole;
                LEAST_GAP + (1.0 - LEAST_GAP) * gap.clamp(0.0, 1.0)
            }
            Parting::Crease => {
                let normal = |(x, y): (usize, usize)| self.surface.normal(x, y);
                let turn = normal(near).dot(normal(far)).clamp(-1.0, 1.0).acos();
                (turn / WHOLE_CREASE).min(1.0)
            }
            Parting::Border => 0.6,
        }
    }

    /// The lines of one kind.
    fn lines(&self, parting: Parting, kind: LineKind) -> Vec<RawLine> {
        let steps_of_row = |cells: &Vec<(usize, usize)>| {
            let mut steps = Vec::new();
            cells.iter().for_each(|cell| self.steps_of_cell(parting, *cell, &mut steps));
            steps
        };
        let rows: Vec<Vec<CellStep>> = parallel::map(&self.cells, steps_of_row);
        let cells: Vec<CellStep> = rows.into_iter().flatten().collect();
        let steps: Vec<LineStep> = cells.iter().map(|cell| cell.step).collect();
        let chains = join_steps(&steps);
        let sides: Vec<(Vec2, Vec2)> =
            cells.iter().map(|cell| (cell.step.points[0].at, cell.toward_far)).collect();
        let far_of = FarSides::of(&sides);
        chains.into_iter().map(|chain| orient(chain, kind, &far_of)).collect()
    }

    fn steps_of_cell(&self, parting: Parting, (x, y): (usize, usize), out: &mut Vec<CellStep>) {
        let width = self.shares.width();
        let sides = sides(x, y, width);
        let of = |parting: Parting| -> Vec<LinkCrossing> {
            let found = sides.iter().enumerate();
            found.filter_map(|(i, side)| self.crossing(parting, *side, i)).collect()
        };
        let crossings = of(parting);
        if crossings.is_empty() {
            return;
        }
        // Not shared with any other cell.
        let middle = |n: u64| 2 * (self.shares.size().area() + y * width + x) as u64 + n;
        let mut step = |a: LinkCrossing, key: u64, point: LinePoint| {
            let step = LineStep { keys: [a.key, key], points: [a.point, point] };
            out.push(CellStep { step, toward_far: a.toward_far });
        };
        let mean = |of: &[LinkCrossing]| {
            let sum: Vec2 = of.iter().map(|c| c.point.at).sum();
            let strength = of.iter().map(|c| c.point.strength).sum::<f32>() / of.len() as f32;
            LinePoint { at: sum / of.len() as f32, strength }
        };
        match (parting, crossings.len()) {
            (_, 2) => step(crossings[0], crossings[1].key, crossings[1].point),
            (Parting::Outline, 3 | 4) => {
                let (front, rest) = self.foremost(&sides, &crossings);
                if let [a, b] = front[..] {
                    step(a, b.key, b.point);
                }
                match rest[..] {
                    [a, b] => step(a, b.key, b.point),
                    [a] => step(a, middle(0), mean(&front)),
                    _ => {}
                }
            }
            (Parting::Outline, _) => {}
            // Edges that meet in a corner of the form.
            (_, 3 | 4) => {
                let corner = mean(&crossings);
                crossings.iter().for_each(|c| step(*c, middle(0), corner));
            }
            // One that ends at an outline.
            (_, 1) => {
                let ends = of(Parting::Outline);
                if !ends.is_empty() {
                    let at = LinePoint { strength: crossings[0].point.strength, ..mean(&ends) };
                    step(crossings[0], middle(0), at);
                }
            }
            _ => {}
        }
    }

    /// The crossings that bound the nearest of the forms that meet in a cell, and the others.
    fn foremost(
        &self,
        sides: &[CellSide; 4],
        crossings: &[LinkCrossing],
    ) -> (Vec<LinkCrossing>, Vec<LinkCrossing>) {
        // Corners in order around the cell; side i joins corner i to the next one.
        let corners = [sides[0].0, sides[0].1, sides[2].1, sides[2].0];
        let is_parted = |side: usize| crossings.iter().any(|c| c.side == side);
        let nearest = (0..4)
            .min_by(|a, b| self.depth_px(corners[*a]).total_cmp(&self.depth_px(corners[*b])))
            .unwrap_or(0);
        let mut is_in = [false; 4];
        is_in[nearest] = true;
        for _ in 0..3 {
            for i in 0..4 {
                let j = (i + 1) % 4;
                if !is_parted(i) && (is_in[i] || is_in[j]) {
                    (is_in[i], is_in[j]) = (true, true);
                }
            }
        }
        crossings.iter().partition(|c| is_in[c.side] != is_in[(c.side + 1) % 4])
    }
}

/// A step through a cell, and which way its far side is.
struct CellStep {
    step: LineStep,
    toward_far: Vec2,
}

/// Which way the far side is, by where steps begin.
struct FarSides(std::collections::HashMap<[u32; 2], Vec2>);

impl FarSides {
    fn of(sides: &[(Vec2, Vec2)]) -> Self {
        let bits = |at: Vec2| at.to_array().map(f32::to_bits);
        Self(sides.iter().map(|(at, toward)| (bits(*at), *toward)).collect())
    }

    fn at(&self, at: Vec2) -> Option<Vec2> {
        self.0.get(&at.to_array().map(f32::to_bits)).copied()
    }
}

/// A chain whose far side is on its right.
fn orient(mut chain: Chain, kind: LineKind, far: &FarSides) -> RawLine {
    let votes = chain.points.windows(3).filter_map(|three| {
        let along = three[2].at - three[0].at;
        // y down: what is on the right has a positive cross product.
        Some(along.perp_dot(far.at(three[1].at)?).signum())
    });
    if votes.sum::<f32>() < 0.0 {
        chain.points.reverse();
    }
    RawLine { kind, points: chain.points, is_closed: chain.is_closed }
}
