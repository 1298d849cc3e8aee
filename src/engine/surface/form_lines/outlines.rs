//! Outlines, creases and borders of parts: traced along the links between pixels that are broken,
//! at the places that contours know between pixels. Floor 2. Not here: curves of smooth forms
//! (`fields`).

use super::chains::{CellSide, Chain, LineStep, join_steps, sides};
use super::tidy::RawLine;
use super::{LineKind, LinePoint, LineSettings};
use crate::math::{Vec2, vec2};
use crate::raster::Plane;
use crate::surface::{Surface, links};
use rayon::prelude::*;

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
    /// Pixels of a rim that only coarse maps tore off what they belong to.
    fringe: Plane<bool>,
}

/// The lines along broken links.
pub(super) fn trace(surface: &Surface, settings: &LineSettings) -> Vec<RawLine> {
    let mut own = Plane::full(surface.size(), 1.0f32);
    for pixel in surface.contours().pixels().iter().filter(|pixel| pixel.is_between_parts()) {
        own.set(pixel.x as usize, pixel.y as usize, pixel.share);
    }
    let shares = surface.shares();
    let fringe = fringe_of(surface, &shares);
    let partings = Partings { surface, shares, own, fringe };
    let kinds = [
        (Parting::Outline, LineKind::Outline),
        (Parting::Crease, LineKind::Crease),
        (Parting::Border, LineKind::Border),
    ];
    let wanted = kinds.into_iter().filter(|(_, kind)| settings.kinds.has_kind(*kind));
    wanted.flat_map(|(parting, kind)| partings.lines(parting, kind)).collect()
}

/// Pixels of the surface next to the rim, or next to such a one, that are not linked inward: what
/// lies there is hardly wider than a pixel, and its own rim is drawn.
fn fringe_of(surface: &Surface, shares: &Plane<u8>) -> Plane<bool> {
    let links = surface.links_plane();
    let is_on = |x: i32, y: i32| shares.get(x, y).is_none_or(|share| share >= 128);
    Plane::from_fn(shares.size(), |x, y| {
        let linked = links.at(x, y);
        let (px, py) = (x as i32, y as i32);
        let inward =
            [(links::RIGHT, 1, 0), (links::LEFT, -1, 0), (links::DOWN, 0, 1), (links::UP, 0, -1)];
        is_on(px, py)
            && inward.into_iter().any(|(bit, dx, dy)| {
                linked & bit == 0
                    && is_on(px + dx, py + dy)
                    && (!is_on(px - dx, py - dy) || !is_on(px - 2 * dx, py - 2 * dy))
            })
    })
}

impl Partings<'_> {
    fn is_on(&self, (x, y): (usize, usize)) -> bool {
        self.shares.at(x, y) >= 128
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
            let is_torn = self.fringe.at(a.0, a.1) || self.fringe.at(b.0, b.1);
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
        let size = self.surface.size();
        let (w, h) = (size.width as usize, size.height as usize);
        let rows: Vec<Vec<CellStep>> = (0..h.saturating_sub(1))
            .into_par_iter()
            .map(|y| {
                let mut steps = Vec::new();
                (0..w - 1).for_each(|x| self.steps_of_cell(parting, (x, y), &mut steps));
                steps
            })
            .collect();
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
