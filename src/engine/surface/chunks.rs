//! Chunks of a painted ball: the place on the ball whose paint each pixel of a surface shows, so
//! that whole brush marks are seen (StyleBlit, Sýkora et al. 2019, MATH 5). Floor 2. Here: the
//! equations, one pixel at a time, and the cache; `fill` and `sown` are the fast way over a map,
//! `seams` the averaging where chunks meet, `shown` where some of the ball is seen. Not here: the
//! ball's colors (`shading::sphere`).

mod fill;
mod seams;
mod shown;
mod sown;
mod ways;

#[cfg(test)]
mod tests;

pub use seams::SEAM_STEPS;
pub use shown::BallCells;

use super::Surface;
use super::cache::HeapSize;
use crate::math::{Mat2, Vec2, Vec3, hash, vec2};
use crate::raster::Plane;
use std::borrow::Cow;
use std::sync::Arc;
use ways::WayCounts;

/// How a ball is laid on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChunkSettings {
    /// The ball's diameter, canvas px.
    pub ball_px: f32,
    /// The size of the largest chunks, px.
    pub chunk_px: f32,
    /// How far chunks are bent as the surface bends: 0 not at all, 1 as a lit sphere is.
    pub follow: f32,
    /// From how far away the places that are averaged on seams are taken, px; below ½ there are
    /// none.
    pub seam_px: f32,
}

/// A place is taken if the ball's normal there is so near to the pixel's, the sum over three axes:
/// 24 steps of the bytes of a normal map.
const NEAR: f32 = 2.0 * 24.0 / 255.0;
/// Sizes of chunks, each half of the one before; none is smaller than a pixel.
const LEVELS: i32 = 7;
/// Bent chunks are enlarged or reduced up to this factor.
const MOST_STRETCH: f32 = 4.0;
/// Pixels of a row that are worked on at once.
const LANES: usize = 8;
/// The number of pixels that show what a lit sphere does.
const LOOKED_UP: u8 = 1;

/// A place on the ball, in steps that `BallPlaces` gives, and which chunk showed it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct BallPlace {
    /// From the upper left of the ball's square.
    at: [u16; 2],
    /// A number that tells neighboring chunks apart; 0 off the surface.
    chunk: u8,
}

impl BallPlace {
    /// A place on the ball's square, px.
    ///
    /// * `steps`: to a px.
    #[inline(always)]
    fn of(place: Vec2, chunk: u8, steps: f32) -> Self {
        Self { at: [(place.x * steps + 0.5) as u16, (place.y * steps + 0.5) as u16], chunk }
    }
}

/// A seed: where a chunk lies on the surface, and on the ball.
#[derive(Clone, Copy, Debug)]
struct Seed {
    /// Its pixel, px between corners of the canvas: the pixel's center.
    at: Vec2,
    /// From places on the canvas to those on the ball's square, px, where chunks are not bent.
    offset: Vec2,
    /// B − I: what bending adds to a step on the canvas.
    bend: Mat2,
}

/// What seeds and places are found from.
struct ChunkMaps<'a> {
    surface: &'a Surface,
    settings: ChunkSettings,
    /// n̄ (image axes) and n_z, as each pixel is seen.
    seen: [Cow<'a, Plane<f32>>; 3],
    ways: WayCounts,
}

/// A level's grid of seeds of one part.
#[derive(Clone, Copy)]
struct SeedGrid {
    /// The side of its cells, px.
    side: f32,
    seed: u32,
}

impl SeedGrid {
    /// The cell of a pixel.
    fn cell(&self, pixel: usize) -> i32 {
        ((pixel as f32 + 0.5) / self.side).floor() as i32
    }

    /// Where the seed of a cell lies, px: anywhere in it, evenly.
    #[inline(always)]
    fn seed_of(&self, cell: (i32, i32)) -> Vec2 {
        let [x, y] = hash::unit_pair(self.seed, cell.0 as u32, cell.1 as u32);
        vec2(cell.0 as f32 + x, cell.1 as f32 + y) * self.side
    }

    /// The cell whose seed is nearest to the middle of a pixel, of the nine around it.
    #[cfg(test)]
    fn nearest(&self, pixel: (usize, usize)) -> (i32, i32) {
        let middle = vec2(pixel.0 as f32 + 0.5, pixel.1 as f32 + 0.5);
        let (mut best, mut least) = ((0, 0), f32::MAX);
        for cell in neighboring_cells((self.cell(pixel.0), self.cell(pixel.1))) {
            let away = square(self.seed_of(cell) - middle);
            if away < least {
                (best, least) = (cell, away);
            }
        }
        best
    }

    /// Which chunk a cell is: from 2 on.
    fn chunk(&self, cell: (i32, i32)) -> u8 {
        (2 + hash::mix(self.seed ^ hash::mix(cell.0 as u32 ^ hash::mix(cell.1 as u32))) % 254) as u8
    }
}

/// |v|².
#[inline(always)]
fn square(v: Vec2) -> f32 {
    v.x * v.x + v.y * v.y
}

/// A cell and its neighbors, row by row.
#[inline(always)]
fn neighboring_cells((i, j): (i32, i32)) -> [(i32, i32); 9] {
    let row = |j: i32| [(i - 1, j), (i, j), (i + 1, j)];
    let [[a, b, c], [d, e, f], [g, h, k]] = [row(j - 1), row(j), row(j + 1)];
    [a, b, c, d, e, f, g, h, k]
}

impl ChunkSettings {
    /// Sides of the cells, the largest first.
    fn sides(&self) -> impl Iterator<Item = (u32, f32)> {
        let side = |level: i32| (level as u32, self.chunk_px * (-level as f32).exp2());
        (0..LEVELS).map(side).take_while(|(_, side)| *side >= 1.0)
    }

    /// L(n) = ½ + ½ n̄, in px of the ball's square: where a lit sphere looks a normal up.
    #[inline(always)]
    fn look_up(&self, nbar: Vec2) -> Vec2 {
        (nbar * 0.5 + 0.5) * self.ball_px
    }

    /// Whether the ball's normal at a place on it is near to a normal (n̄, n_z).
    #[inline(always)]
    fn is_near(&self, place: Vec2, nbar: Vec2, nz: f32) -> bool {
        let per_px = 2.0 / self.ball_px;
        let (x, y) = (place.x * per_px - 1.0, place.y * per_px - 1.0);
        let below = 1.0 - (x * x + y * y);
        let z = below.max(0.0).sqrt();
        (below > 0.0) & ((x - nbar.x).abs() + (y - nbar.y).abs() + (z - nz).abs() < NEAR)
    }

    /// Steps of stored places, a px: a power of two, as fine as 16 bits allow.
    fn steps(&self) -> f32 {
        (f32::from(u16::MAX) / self.ball_px.max(1.0)).log2().floor().exp2()
    }

    fn key(&self) -> [u32; 4] {
        [self.ball_px, self.chunk_px, self.follow, self.seam_px].map(f32::to_bits)
    }
}

impl<'a> ChunkMaps<'a> {
    fn of(surface: &'a Surface, settings: ChunkSettings) -> Self {
        let seen = match surface.eye() {
            super::view::Eye::Afar => surface.normal_planes().map(Cow::Borrowed),
            super::view::Eye::At { .. } => seen_normals(surface).map(Cow::Owned),
        };
        Self { surface, settings, seen, ways: WayCounts::of(surface) }
    }

    /// The grid of a level at a pixel.
    fn grid(&self, (level, side): (u32, f32), part: u32) -> SeedGrid {
        SeedGrid { side, seed: hash::mix(part.wrapping_mul(8).wrapping_add(level)) }
    }

    /// The part that a pixel shows, which has a grid of its own; 0 where none are known.
    #[inline(always)]
    fn part(&self, x: usize, y: usize) -> u32 {
        self.surface.parts_plane().map_or(0, |parts| parts.at(x, y))
    }

    #[inline(always)]
    fn nbar(&self, x: usize, y: usize) -> Vec2 {
        vec2(self.seen[0].at(x, y), self.seen[1].at(x, y))
    }

    fn look_up(&self, x: usize, y: usize) -> Vec2 {
        self.settings.look_up(self.nbar(x, y))
    }

    /// The seed of a cell, if it lies on the part.
    fn seed(&self, grid: &SeedGrid, cell: (i32, i32), part: u32) -> Option<Seed> {
        let at = grid.seed_of(cell);
        let (x, y) = (at.x.floor(), at.y.floor());
        let size = self.surface.size();
        let is_inside = x >= 0.0 && y >= 0.0 && x < size.width as f32 && y < size.height as f32;
        let (column, row) = (x as usize, y as usize);
        let is_own =
            is_inside && self.surface.coverage(column, row) > 0 && self.part(column, row) == part;
        is_own.then(|| Seed {
            at: vec2(x + 0.5, y + 0.5),
            offset: self.look_up(column, row) - vec2(x + 0.5, y + 0.5),
            bend: self.bend((column, row), grid.side),
        })
    }

    /// B − I, B = I + f (J − I), J the derivative of L(n) over a quarter of a chunk, its stretch
    /// limited.
    fn bend(&self, seed: (usize, usize), side: f32) -> Mat2 {
        let follow = self.settings.follow;
        if follow <= 0.0 {
            return Mat2::ZERO;
        }
        let away = (side * 0.25).round().max(1.0) as usize;
        let across = self
            .slope(seed, |(x, y), on| Some((if on { x + away } else { x.checked_sub(away)? }, y)));
        let down = self
            .slope(seed, |(x, y), on| Some((x, if on { y + away } else { y.checked_sub(away)? })));
        let own = Mat2::from_cols(
            across.map_or(Vec2::X, |slope| slope / away as f32),
            down.map_or(Vec2::Y, |slope| slope / away as f32),
        );
        limited(Mat2::IDENTITY + (own - Mat2::IDENTITY) * follow) - Mat2::IDENTITY
    }

    /// The change of L(n) from a pixel to one `step` away, the mean of both ways that can be gone.
    fn slope(
        &self,
        from: (usize, usize),
        step: impl Fn((usize, usize), bool) -> Option<(usize, usize)>,
    ) -> Option<Vec2> {
        let size = self.surface.size();
        let (w, h) = (size.width as usize, size.height as usize);
        let reached = |on: bool| {
            step(from, on)
                .filter(|to| to.0 < w && to.1 < h && self.ways.is_reached(from, *to))
                .map(|(x, y)| self.look_up(x, y))
        };
        let here = self.look_up(from.0, from.1);
        match (reached(false), reached(true)) {
            (Some(before), Some(after)) => Some((after - before) * 0.5),
            (Some(before), None) => Some(here - before),
            (None, Some(after)) => Some(after - here),
            (None, None) => None,
        }
    }

    /// The place that a pixel shows: that of the largest chunk that suits it, else its look-up.
    ///
    /// MATH 5: `o = L(n(s)) + B(s)(p − s)`, s the nearest seed, reached from p within the surface,
    /// if the ball's normal at o is near to n(p).
    #[cfg(test)]
    fn place_at(&self, x: usize, y: usize) -> BallPlace {
        if self.surface.coverage(x, y) == 0 {
            return BallPlace::default();
        }
        let in_chunk = |level| {
            let grid = self.grid(level, self.part(x, y));
            self.chunk_place(&grid, grid.nearest((x, y)), (x, y))
        };
        let found = self.settings.sides().find_map(in_chunk);
        let (place, chunk) = found.unwrap_or((self.look_up(x, y), LOOKED_UP));
        BallPlace::of(place, chunk, self.settings.steps())
    }

    /// The place of a pixel in the chunk of a cell, if it suits, px of the ball's square; and the
    /// chunk.
    fn chunk_place(
        &self,
        grid: &SeedGrid,
        cell: (i32, i32),
        (x, y): (usize, usize),
    ) -> Option<(Vec2, u8)> {
        let seed = self.seed(grid, cell, self.part(x, y))?;
        let place = seed.place(vec2(x as f32 + 0.5, y as f32 + 0.5));
        let is_taken = self.settings.is_near(place, self.nbar(x, y), self.seen[2].at(x, y))
            && self.ways.is_reached(seed.pixel(), (x, y));
        is_taken.then(|| (place, grid.chunk(cell)))
    }
}

impl Seed {
    /// Where a chunk lies at a place of the canvas, px of the ball's square.
    #[inline(always)]
    fn place(&self, at: Vec2) -> Vec2 {
        at + self.offset + self.bend * (at - self.at)
    }

    fn pixel(&self) -> (usize, usize) {
        (self.at.x as usize, self.at.y as usize)
    }
}

/// n̄ and n_z as a near eye sees each pixel.
fn seen_normals(surface: &Surface) -> [Plane<f32>; 3] {
    let seen = |x: usize, y: usize| super::view::in_view(surface.view(x, y), surface.normal(x, y));
    let of = |value: fn(Vec3) -> f32| Plane::from_fn(surface.size(), |x, y| value(seen(x, y)));
    [of(|n| n.x), of(|n| -n.y), of(|n| n.z)]
}

/// A matrix whose singular values are held within 1/[`MOST_STRETCH`] and [`MOST_STRETCH`].
fn limited(m: Mat2) -> Mat2 {
    // A sum of a turn and a reflection, q and r times: its singular values are q + r and |q − r|.
    let (turn, mirror) = (
        vec2(m.x_axis.x + m.y_axis.y, m.x_axis.y - m.y_axis.x) * 0.5,
        vec2(m.x_axis.x - m.y_axis.y, m.x_axis.y + m.y_axis.x) * 0.5,
    );
    let (q, r) = (turn.length(), mirror.length());
    let held = |v: f32| v.abs().max(1.0 / MOST_STRETCH).min(MOST_STRETCH).copysign(v);
    let (large, small) = (held(q + r), held(q - r));
    let turn = turn.try_normalize().unwrap_or(Vec2::X) * (0.5 * (large + small));
    let mirror = mirror.try_normalize().unwrap_or(Vec2::X) * (0.5 * (large - small));
    Mat2::from_cols(
        vec2(turn.x + mirror.x, turn.y + mirror.y),
        vec2(mirror.y - turn.y, turn.x - mirror.x),
    )
}

/// The place on a ball of every pixel of a surface, and where places of neighbors are averaged.
pub struct BallPlaces {
    places: Plane<[u16; 2]>,
    /// A bit for each of [`SEAM_STEPS`]; absent where nothing is averaged.
    seams: Option<Plane<u8>>,
    /// How far away the neighbors are, px.
    seam_px: usize,
    steps: f32,
    ball_px: f32,
}

impl BallPlaces {
    /// The places of a row, in steps.
    pub fn row(&self, y: usize) -> &[[u16; 2]] {
        self.places.row(y)
    }

    /// Which neighbors of each pixel of a row are averaged with it.
    pub fn seams(&self, y: usize) -> Option<&[u8]> {
        self.seams.as_ref().map(|seams| seams.row(y))
    }

    /// The place that the neighbor of a bit shows at (x, y): its own, moved there; in steps.
    #[inline]
    pub fn place_beside(&self, x: usize, y: usize, bit: usize) -> [f32; 2] {
        let (dx, dy) = SEAM_STEPS[bit & 7];
        let step = self.seam_px as i32;
        let beside = (x as i32 + dx * step, y as i32 + dy * step);
        let at = self.places.get(beside.0, beside.1).unwrap_or_default();
        let back = self.seam_px as f32 * self.steps;
        [f32::from(at[0]) - dx as f32 * back, f32::from(at[1]) - dy as f32 * back]
    }

    /// n̄ of the ball for each step of a place, from −1 on.
    pub fn nbar_per_step(&self) -> f32 {
        2.0 / (self.steps * self.ball_px)
    }
}

impl HeapSize for BallPlaces {
    fn heap_bytes(&self) -> u64 {
        self.places.heap_bytes() + self.seams.as_ref().map_or(0, Plane::heap_bytes)
    }
}

impl Surface {
    /// Bytes that [`Surface::ball_places`] keeps of each pixel.
    pub const BALL_PLACE_BYTES: usize = size_of::<[u16; 2]>() + size_of::<u8>();

    /// The place on a ball that each pixel shows, so that whole brush marks of the ball are seen.
    /// It depends on normals, contours and parts alone: when the ball is painted, the places stay.
    /// For a far side it is that of the other side's nearest pixel. Cached; call it once
    /// before going parallel.
    pub fn ball_places(&self, settings: &ChunkSettings) -> Arc<BallPlaces> {
        const KEPT: usize = 2;
        self.derived.ball_places.get_or_compute(settings.key(), KEPT, |_| {
            self.on_either_side(
                || fill::places(&ChunkMaps::of(self, *settings)),
                |far, front| {
                    let whole = front.map(|front| front.ball_places(settings));
                    let of = |pixel: &super::ContourPixel| {
                        let other = pixel.nearest_other().zip(whole.as_ref());
                        other.map_or([0; 2], |(other, whole)| whole.place_after_move(other, pixel))
                    };
                    BallPlaces::without_seams(far.map(self.size(), of), settings)
                },
            )
        })
    }
}

impl BallPlaces {
    fn without_seams(places: Plane<[u16; 2]>, settings: &ChunkSettings) -> Self {
        let ChunkSettings { ball_px, .. } = *settings;
        Self { places, seams: None, seam_px: 0, steps: settings.steps(), ball_px }
    }

    /// The place of one pixel, moved to another.
    fn place_after_move(&self, from: (i32, i32), to: &super::ContourPixel) -> [u16; 2] {
        let [x, y] = self.places.at_clamped(from.0, from.1);
        let most = self.ball_px * self.steps;
        let step = |at: u16, by: i32| (f32::from(at) + by as f32 * self.steps).max(0.0).min(most);
        [step(x, to.x - from.0) as u16, step(y, to.y - from.1) as u16]
    }
}
