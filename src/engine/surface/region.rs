//! Regions of a surface: all that faces the same way as a point, lies as deep, bends as it does,
//! belongs to its object, would shine with it, or flows along it (MATH 7). Floor 2. A region is
//! computed again when its surface changes. Not here: selections and masks, which use it.

mod deviation;

#[cfg(test)]
mod tests;

use super::{Surface, links};
use crate::math::{Range, UNIT, Vec2, parallel};
use crate::raster::bits::TileBits;
use crate::raster::coverage::CoverageGrid;
use crate::raster::flood::{Flooded, OpenTile, TileLinks};
use crate::raster::{Plane, TILE, TileAt};
use std::sync::Arc;

crate::named! {
    /// What pixels of a region have in common with its point.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum RegionKind {
        /// The way the surface faces, degrees.
        #[default]
        Direction = "direction",
        /// z, `[0, 1]`.
        Depth = "depth",
        /// κ, `[−1, 1]`.
        Curvature = "curvature",
        /// The object, whatever the tolerance.
        Object = "object",
        /// The way a mirror would send the view, degrees.
        Shine = "shine",
        /// The line along which the normals turn the most, degrees.
        Flow = "flow",
    }
}

impl RegionKind {
    /// The unit of the tolerance: of angles, depths or curvatures.
    pub fn tolerances(self) -> Range {
        match self {
            RegionKind::Direction | RegionKind::Shine => 0.0..=180.0,
            RegionKind::Flow => 0.0..=90.0,
            RegionKind::Depth | RegionKind::Object => UNIT,
            RegionKind::Curvature => 0.0..=2.0,
        }
    }

    /// The tolerance where none is given.
    pub const fn tolerance(self) -> f32 {
        match self {
            RegionKind::Direction | RegionKind::Shine | RegionKind::Flow => 15.0,
            RegionKind::Depth | RegionKind::Object => 0.1,
            RegionKind::Curvature => 0.2,
        }
    }
}

/// The description of a region of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceRegion {
    /// What belongs to it.
    pub kind: RegionKind,
    /// Canvas px; the maps are read there, between pixels.
    pub at: Vec2,
    /// t: how different pixels may be; in the kind's own unit.
    pub tolerance: f32,
    /// Δ / t: from 0, an edge as sharp as pixels allow, to 1.
    pub softness: f32,
    /// Only what is joined to the point; depth jumps separate what they cross.
    pub contiguous: bool,
}

impl SurfaceRegion {
    /// What its softness may be.
    pub const SOFTNESS: Range = UNIT;

    /// A sharp and contiguous one with the kind's own tolerance.
    pub const fn new(kind: RegionKind, at: Vec2) -> Self {
        Self { kind, at, tolerance: kind.tolerance(), softness: 0.0, contiguous: true }
    }

    /// What it covers of a surface; nothing where its point is off the surface.
    pub fn on(&self, surface: &Arc<Surface>) -> CoverageGrid {
        RegionField::new(surface, self.kind, self.at)
            .map_or_else(CoverageGrid::default, |field| field.region(self))
    }
}

/// Regions of a surface that are kept: a mask requests its own tile by tile.
const KEPT: usize = 8;

impl Surface {
    /// The coverage of a region, cached. Call it once before going parallel: threads that call it
    /// at the same time may each compute it.
    pub fn region(self: &Arc<Self>, region: &SurfaceRegion) -> Arc<CoverageGrid> {
        self.derived.regions.get_or_compute(*region, KEPT, |_| region.on(self))
    }
}

/// The share of a pixel in a region: 1 − smoothstep over t ± Δ of its deviation v (MATH 7).
///
/// Total: a step at t where Δ is 0; 0 where v is not a number.
#[inline(always)]
pub fn share(v: f32, t: f32, delta: f32) -> f32 {
    let s = ((t + delta - v) / (2.0 * delta).max(f32::MIN_POSITIVE)).max(0.0).min(1.0);
    s * s * (3.0 - 2.0 * s)
}

/// How much every pixel of a surface differs from one: computed once, used for many tolerances.
pub struct RegionField {
    surface: Arc<Surface>,
    at: (i32, i32),
    /// v; infinite off the surface.
    deviation: Plane<f32>,
    /// Half the step of v from pixel to pixel: a sharper edge would show steps.
    half_step: Plane<f32>,
    /// How the surface joins the pixels of each tile, row by row.
    joined: Vec<TileLinks>,
}

impl RegionField {
    /// `None` where the point is off the surface.
    pub fn new(surface: &Arc<Surface>, kind: RegionKind, at: Vec2) -> Option<Self> {
        let pixel = at.floor().as_ivec2();
        let covered = surface.coverage_plane().get(pixel.x, pixel.y).filter(|_| at.is_finite());
        covered.filter(|c| *c > 0)?;
        let deviation = deviation::of(surface, kind, at);
        let half_step = half_steps(surface, &deviation);
        let joined = links_of(surface);
        Some(Self {
            surface: surface.clone(),
            at: (pixel.x, pixel.y),
            deviation,
            half_step,
            joined,
        })
    }

    /// The region of this field's point and kind with a tolerance, softness and contiguity.
    pub fn region(&self, wanted: &SurfaceRegion) -> CoverageGrid {
        let is_object = wanted.kind == RegionKind::Object;
        // An object's pixels do not differ, all others infinitely.
        let t = if is_object { 1.0 } else { wanted.tolerance.max(0.0) };
        let soft = wanted.softness.max(0.0).min(1.0) * t;
        // An object is joined as it is, fragments of its edge across jumps among it.
        let is_joined = wanted.contiguous && !is_object;
        let reached = is_joined
            .then(|| Flooded::from(self.at, self.surface.size(), |at| self.open_tile(at, t, soft)));
        let all = self.surface.size().rect();
        match reached {
            None => CoverageGrid::from_tiles(all, |at, bytes| self.fill(at, t, soft, None, bytes)),
            Some(reached) => {
                let mut bits: Vec<(TileAt, &TileBits)> = reached.tiles().collect();
                bits.sort_unstable_by_key(|(at, _)| *at);
                CoverageGrid::from_tiles(reached.rect(), |at, bytes| {
                    if let Ok(i) = bits.binary_search_by_key(&at, |(at, _)| *at) {
                        self.fill(at, t, soft, Some(bits[i].1), bytes);
                    }
                })
            }
        }
    }

    fn fill(&self, at: TileAt, t: f32, soft: f32, only: Option<&TileBits>, bytes: &mut [u8]) {
        let (tile, area) = (at.rect(), at.rect().intersect(self.surface.size().rect()));
        let columns = area.x0 as usize..area.x1 as usize;
        for y in area.y0..area.y1 {
            let row = (y - tile.y0) as usize;
            let to = &mut bytes[row * TILE..][..area.width()];
            let (v, step) =
                (&self.deviation.row(y as usize)[columns.clone()], self.half_step.row(y as usize));
            let covered = &self.surface.coverage_plane().row(y as usize)[columns.clone()];
            fill_row(v, &step[columns.clone()], covered, t, soft, to);
            if let Some(bits) = only {
                let bits = bits[row];
                to.iter_mut()
                    .enumerate()
                    .filter(|(x, _)| bits >> x & 1 == 0)
                    .for_each(|(_, b)| *b = 0);
            }
        }
    }

    /// The pixels of a tile that are covered at all, and how the surface joins them.
    fn open_tile(&self, at: TileAt, t: f32, soft: f32) -> OpenTile {
        let (tile, area) = (at.rect(), at.rect().intersect(self.surface.size().rect()));
        let mut open = [0; TILE];
        let columns = area.x0 as usize..area.x1 as usize;
        for y in area.y0..area.y1 {
            let v = &self.deviation.row(y as usize)[columns.clone()];
            let step = &self.half_step.row(y as usize)[columns.clone()];
            open[(y - tile.y0) as usize] = open_row(v, step, t, soft);
        }
        let columns = self.surface.size().width.div_ceil(TILE as u32) as i32;
        OpenTile {
            open,
            links: self
                .joined
                .get((at.row * columns + at.col) as usize)
                .map(|joined| Box::new(*joined)),
        }
    }
}

/// From which sides the pixels of each tile of a surface are linked, row by row.
fn links_of(surface: &Surface) -> Vec<TileLinks> {
    let tiles: Vec<TileAt> = TileAt::covering(surface.size().rect()).collect();
    let of_tile = |at: &TileAt| {
        let (tile, area) = (at.rect(), at.rect().intersect(surface.size().rect()));
        let none = [0; TILE];
        let mut joined =
            TileLinks { from_left: none, from_right: none, from_above: none, from_below: none };
        for y in area.y0..area.y1 {
            let row = (y - tile.y0) as usize;
            let linked = &surface.links_plane().row(y as usize)[area.x0 as usize..area.x1 as usize];
            for (x, linked) in linked.iter().enumerate() {
                let bit = |side: u8| u64::from(linked & side != 0) << x;
                joined.from_left[row] |= bit(links::LEFT);
                joined.from_right[row] |= bit(links::RIGHT);
                joined.from_above[row] |= bit(links::UP);
                joined.from_below[row] |= bit(links::DOWN);
            }
        }
        joined
    };
    parallel::map(&tiles, of_tile)
}

crate::widest! {
    /// A bit for every pixel of a row that a region covers at all.
    fn open_row(v: &[f32], step: &[f32], t: f32, soft: f32) -> u64 {
        let n = v.len().min(TILE);
        let (v, step) = (&v[..n], &step[..n]);
        let mut open = [0u8; TILE];
        for x in 0..n {
            let delta = if soft > step[x] { soft } else { step[x] };
            open[x] = u8::from(v[x] < t + delta);
        }
        open.iter().rev().fold(0, |bits, open| bits << 1 | u64::from(*open))
    }

    fn fill_row(v: &[f32], step: &[f32], covered: &[u8], t: f32, soft: f32, to: &mut [u8]) {
        let n = to.len();
        let (v, step, covered) = (&v[..n], &step[..n], &covered[..n]);
        for x in 0..n {
            let delta = if soft > step[x] { soft } else { step[x] };
            to[x] = (share(v[x], t, delta) * f32::from(covered[x]) + 0.5) as u8;
        }
    }
}

/// Across a crease v leaps on one side and not on the other: there an edge stays sharp.
fn half_steps(surface: &Surface, deviation: &Plane<f32>) -> Plane<f32> {
    Plane::from_fn(deviation.size(), |x, y| {
        let (v, linked) = (deviation.at(x, y), surface.links_plane().at(x, y));
        let step = |bit: u8, dx: i32, dy: i32| {
            (linked & bit != 0)
                .then(|| (deviation.at_clamped(x as i32 + dx, y as i32 + dy) - v).abs())
        };
        let of_axis = |a: Option<f32>, b: Option<f32>| match (a, b) {
            (Some(a), Some(b)) => a.min(b),
            (a, b) => a.or(b).unwrap_or(0.0),
        };
        let across = of_axis(step(links::LEFT, -1, 0), step(links::RIGHT, 1, 0));
        let down = of_axis(step(links::UP, 0, -1), step(links::DOWN, 0, 1));
        let most = across.max(down);
        if most.is_finite() { 0.5 * most } else { 0.0 }
    })
}
