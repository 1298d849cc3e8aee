//! Finds contour pixels, the share of each side, and readings that belong to neither (MATH
//! 10). Floor 2.

use super::continued::{Continued, nz_of};
use super::line::{ContourLine, EXPLAINED_PX};
use super::maps::ContourMaps;
use super::window::{ALL, BESIDE, Beside, CENTER, PixelWindow};
use super::{ContourPixel, Contours};
use crate::math::{Vec2, parallel};
use crate::raster::{Plane, TILE};
use rayon::prelude::*;

/// What was found.
pub struct Found {
    pub contours: Contours,
    /// Readings to be put in place of those that belong to neither side, by the index of their
    /// pixel.
    pub amended: Vec<(usize, AmendedReading)>,
}

/// A pixel's own reading, continued from its side.
#[derive(Clone, Copy, Debug)]
pub struct AmendedReading {
    pub nbar: Vec2,
    pub nz: f32,
    pub depth: f32,
}

/// From this share on a pixel is seen by its own side alone.
const WHOLLY: f32 = 0.998;
/// Partly covered pixels for each pixel of a hard rim, from which on coverage gives the outer
/// contours.
const SOFT_SHARE: f32 = 0.25;
/// Shades below this leave the pixel's center uncovered, as a rule.
const HARDLY_COVERED: u8 = 100;
/// A normal is mixed of both sides' if it is this far from its own side's toward the other's, and
/// at most this far off the line between them, as ratios of the distance between both; and if that
/// distance is large enough.
const MIXED_FROM: f32 = 0.2;
const MIXED_BESIDE: f32 = 0.25;
const MIXED_LEAST: f32 = 0.25;
/// How far the line of a crease may lie on the wrong side of a pixel's center, px.
const CREASE_TOLERANCE_PX: f32 = 0.1;

/// Finds the contours of a surface. The same whatever the number of threads: tiles are found one by
/// one.
pub fn find(maps: &ContourMaps) -> Found {
    let mask = MaskReading { is_soft: is_soft(maps.coverage), has_means: has_means(maps) };
    let columns = maps.size.width.div_ceil(TILE as u32) as usize;
    let rows = maps.size.height.div_ceil(TILE as u32) as usize;
    let of_row = |row: usize| {
        let mut tiles: Vec<Vec<ContourPixel>> = vec![Vec::new(); columns];
        let mut amended = Vec::new();
        for y in row * TILE..((row + 1) * TILE).min(maps.size.height as usize) {
            for x in candidates(maps, y) {
                let examined = Examined::at(maps, mask, x as i32, y as i32);
                tiles[x / TILE].extend(examined.contour);
                amended.extend(
                    examined.amended.map(|reading| (y * maps.size.width as usize + x, reading)),
                );
            }
        }
        (tiles, amended)
    };
    let found: Vec<_> = parallel::collect(rows, 1, of_row);
    let (tiles, amended): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    Found {
        contours: Contours::of_tiles(maps.size, tiles.into_iter().flatten().collect()),
        amended: amended.into_iter().flatten().collect(),
    }
}

/// How the mask and what lies under it are to be read.
#[derive(Clone, Copy)]
struct MaskReading {
    /// It gives the outer contours itself.
    is_soft: bool,
    /// Partly covered pixels hold means of what is covered, else readings of their centers, if
    /// these are covered.
    has_means: bool,
}

/// Whether most pixels that are hardly covered hold values, although their centers are not covered.
fn has_means(maps: &ContourMaps) -> bool {
    let Some(valid) = maps.valid else { return true };
    let counts = (0..maps.coverage.height()).into_par_iter().map(|y| {
        let hardly = maps
            .coverage
            .row(y)
            .iter()
            .zip(valid.row(y))
            .filter(|(c, _)| (1..HARDLY_COVERED).contains(*c));
        hardly.fold((0, 0), |(valid_count, all), (_, &is_valid)| {
            (valid_count + usize::from(is_valid), all + 1)
        })
    });
    let (valid_count, all) = counts.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    2 * valid_count >= all
}

/// Whether the mask is one of shades: then it gives the outer contours itself.
fn is_soft(coverage: &Plane<u8>) -> bool {
    let hard = |row: &[u8]| row.windows(2).filter(|pair| pair[0].abs_diff(pair[1]) == 255).count();
    let counts = (0..coverage.height()).into_par_iter().map(|y| {
        let row = coverage.row(y);
        let partly = row.iter().filter(|&&c| c > 0 && c < 255).count();
        (partly, if partly == 0 && row.iter().all(|&c| c == row[0]) { 0 } else { hard(row) })
    });
    let (partly, hard) = counts.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    partly > 0 && partly as f32 >= SOFT_SHARE * hard as f32
}

/// The columns of a row at which a contour may be: where a link is missing, or next to covered
/// pixels.
fn candidates(maps: &ContourMaps, y: usize) -> impl Iterator<Item = usize> {
    let (links, coverage) = (maps.links.row(y), maps.coverage.row(y));
    let above = y.checked_sub(1).map(|y| maps.coverage.row(y));
    let below = (y + 1 < maps.coverage.height()).then(|| maps.coverage.row(y + 1));
    (0..links.len()).filter(move |&x| {
        if coverage[x] > 0 {
            return links[x] != 15 || coverage[x] < 255;
        }
        let covered = |row: Option<&[u8]>| row.is_some_and(|row| row[x] > 0);
        covered(above)
            || covered(below)
            || x > 0 && coverage[x - 1] > 0
            || coverage.get(x + 1).is_some_and(|&c| c > 0)
    })
}

/// What was found at a pixel.
#[derive(Default)]
struct Examined {
    contour: Option<ContourPixel>,
    amended: Option<AmendedReading>,
}

/// What lies across a contour from a pixel.
#[derive(Clone, Copy)]
struct Across {
    own: u64,
    /// Empty where there is no surface.
    other: u64,
    is_near: bool,
    /// Both continue each other.
    is_crease: bool,
}

/// How a pixel is shared.
#[derive(Clone, Copy)]
struct Shared {
    /// What its own side sees.
    own: f32,
    /// The middle of what the other one sees, from the pixel's center, px.
    other_at: Vec2,
}

impl Shared {
    fn by(line: ContourLine, own_is_near: bool) -> Self {
        let line = if own_is_near { line } else { line.turned() };
        Self { own: line.nearer_share(), other_at: line.turned().nearer_centroid() }
    }
}

impl Examined {
    fn at(maps: &ContourMaps, mask: MaskReading, x: i32, y: i32) -> Self {
        let coverage = maps.coverage.at(x as usize, y as usize);
        let window = PixelWindow::around(maps, x, y);
        if coverage == 0 {
            return if mask.is_soft { Self::default() } else { Self::outside(&window, (x, y)) };
        }
        if coverage < 255 {
            return Self::examine_shaded(maps, mask, &window, (x, y));
        }
        let linked = maps.links.at(x as usize, y as usize);
        if linked == 0
            && let Some(between) = Self::examine_between(&window, (x, y))
        {
            return between;
        }
        let Some(across) = find_across(&window, linked, mask.is_soft) else {
            return Self::default();
        };
        let contour = contour_pixel(
            &window,
            share_pixel(&window, across),
            (x, y),
            (across.own, across.other),
        );
        Self { contour, amended: unmix_reading(&window, across) }
    }

    /// A pixel that the mask covers in part: its own side sees the surface in the middle of
    /// that part.
    fn examine_shaded(
        maps: &ContourMaps,
        mask: MaskReading,
        window: &PixelWindow,
        (x, y): (i32, i32),
    ) -> Self {
        let at = (x as usize, y as usize);
        let share = f32::from(maps.coverage.at(at.0, at.1)) / 255.0;
        let piece = window.piece_of_center() & !(1 << CENTER);
        // Other partly covered pixels are as doubtful; one that continues no other may hold
        // nothing's depth.
        let trusted =
            [piece & window.whole, window.whole, piece].into_iter().find(|&members| members != 0);
        let continued = trusted.and_then(|members| Continued::from(window, members));
        let line = ContourLine::of_shades(maps.coverage, (x, y));
        let [own_at, other_at] = line.map_or([Vec2::ZERO; 2], |line| {
            [line, line.turned()].map(ContourLine::nearer_centroid)
        });
        let valid_count =
            maps.valid.is_none_or(|valid| valid.at(at.0, at.1)).then(|| window.nbar(CENTER));
        // Files hold a normal toward the viewer where there is no surface.
        let is_mixed = |own: &Continued| {
            valid_count
                .is_none_or(|valid_count| is_between(valid_count, own.nbar(own_at), Vec2::ZERO))
        };
        let amended = continued.filter(is_mixed).map(|own| own.reading(Vec2::ZERO));
        let is_of_middle = mask.has_means && amended.is_none();
        let turn = |own: Continued| own.nbar(own_at) - own.nbar(Vec2::ZERO);
        let own_turn = continued.filter(|_| !is_of_middle).map_or(Vec2::ZERO, turn);
        let contour =
            ContourPixel { x, y, share, is_own_on_surface: true, others: 0, other_at, own_turn };
        Self { contour: Some(contour), amended }
    }

    /// A pixel without surface next to one.
    fn outside(window: &PixelWindow, (x, y): (i32, i32)) -> Self {
        let seeds = BESIDE.map(|beside| 1u64 << beside.bit & window.covered);
        let pieces = seeds.map(|seed| window.pieces(seed, 0).0);
        let Some(&other) = pieces.iter().max_by_key(|piece| piece.count_ones()) else {
            return Self::default();
        };
        if other == 0 {
            return Self::default();
        }
        let across = Across { own: window.nothing(), other, is_near: false, is_crease: false };
        Self {
            contour: contour_pixel(window, share_pixel(window, across), (x, y), (0, other)),
            amended: None,
        }
    }

    /// A pixel that continues none of its neighbors, at a depth between theirs: a renderer mixed
    /// both sides in it.
    fn examine_between(window: &PixelWindow, (x, y): (i32, i32)) -> Option<Self> {
        let mut beside: Vec<u32> = BESIDE
            .iter()
            .map(|beside| beside.bit)
            .filter(|&i| window.covered >> i & 1 == 1)
            .collect();
        beside.sort_by(|&a, &b| window.depth(a).total_cmp(&window.depth(b)));
        let (&near, &far) = (beside.first()?, beside.last()?);
        let (front, here, back) = (window.depth(near), window.depth(CENTER), window.depth(far));
        if !(front < here && here < back) {
            return None;
        }
        let center = 1 << CENTER;
        let (near, far) = window.pieces(1 << near, 1 << far);
        let (near, far) = (near & !center, far & !center);
        let guess = ContourLine::of_mask(near, window.inside & !center);
        let line = guess.and_then(|guess| {
            ContourLine::of_normals(window, near, window.inside & !center, guess)
        });
        // Depth is mixed in the same shares.
        let by_depth = (back - here) / (back - front);
        let own_is_near = line.map_or(by_depth, ContourLine::nearer_share) >= 0.5;
        let (own, others) = if own_is_near { (near, far) } else { (far, near) };
        let by_depth = Shared { own: by_depth.max(1.0 - by_depth), other_at: Vec2::ZERO };
        let shared = line.map_or(by_depth, |line| Shared::by(line, own_is_near));
        let contour = contour_pixel(window, Some(shared), (x, y), (own, others));
        Some(Self { contour, amended: continue_reading(window, own) })
    }
}

/// The piece that a covered pixel belongs to, and the largest that ends next to it.
fn find_across(window: &PixelWindow, linked: u8, is_soft: bool) -> Option<Across> {
    let center = 1u64 << CENTER;
    let mut found: Option<(u32, Across)> = None;
    for Beside { link, bit: i, .. } in BESIDE {
        let there = 1u64 << i;
        if linked & link != 0 || window.inside & there == 0 {
            continue;
        }
        let across = if window.covered & there == 0 {
            if is_soft {
                continue;
            }
            Across { own: window.pieces(center, 0).0, other: 0, is_near: true, is_crease: false }
        } else {
            let (own, other) = window.pieces(center, there);
            let is_near = window.depth(CENTER) <= window.depth(i);
            Across { own, other, is_near, is_crease: window.is_linked_across(link) }
        };
        let size = if across.other == 0 { window.nothing() } else { across.other }.count_ones();
        // A single pixel is a mixed one, or noise.
        if size > 1 && found.is_none_or(|(most, _)| size > most) {
            found = Some((size, across));
        }
    }
    found.map(|(_, across)| across)
}

/// A pixel of which both sides see something.
///
/// * `own`, `others`: pixels of the window that belong to either.
fn contour_pixel(
    window: &PixelWindow,
    shared: Option<Shared>,
    (x, y): (i32, i32),
    (own, others): (u64, u64),
) -> Option<ContourPixel> {
    let Shared { own: share, other_at } = shared.filter(|shared| shared.own < WHOLLY)?;
    // The middles of both, weighed by their shares, are the pixel's center.
    let own_at = other_at * (-(1.0 - share) / share.max(0.25));
    let continued = Continued::from(window, own & !(1 << CENTER));
    let own_turn = continued.map_or(Vec2::ZERO, |own| own.nbar(own_at) - own.nbar(Vec2::ZERO));
    Some(ContourPixel { x, y, share, is_own_on_surface: own != 0, others, other_at, own_turn })
}

/// How the middle pixel is shared; `None` where no single edge passes.
fn share_pixel(window: &PixelWindow, across: Across) -> Option<Shared> {
    if across.is_crease {
        // Noise and detail turn like a crease here and there; an edge of the surface is straight
        // for some pixels.
        let is_edge = |line: &ContourLine| {
            line.is_separating(across.own, window.inside, 0.0, CREASE_TOLERANCE_PX, EXPLAINED_PX)
        };
        let guess = ContourLine::of_mask(across.own, window.inside).filter(is_edge)?;
        let line = ContourLine::of_depths(window, across.own, across.other)
            .or_else(|| line_by_slopes(window, across))
            .unwrap_or(guess);
        return Some(Shared::by(line.with_center(true), true));
    }
    let near = if across.is_near { across.own } else { across.other };
    // Other pieces nearby end at lines of their own.
    let known = across.own | across.other | window.nothing();
    let guess = ContourLine::of_mask(near, known)?;
    let line = ContourLine::of_normals(window, near, known, guess).unwrap_or(guess);
    Some(Shared::by(line.with_center(across.is_near), across.is_near))
}

/// The line of a crease by how steeply both its sides lie.
fn line_by_slopes(window: &PixelWindow, Across { own, other, .. }: Across) -> Option<ContourLine> {
    let slope = |members: u64| {
        let nbar = Continued::from(window, members)?.nbar(Vec2::ZERO);
        Some(nbar / nz_of(nbar).max(0.05))
    };
    ContourLine::of_slopes(own, other, [slope(own)?, slope(other)?])
}

/// The middle pixel's own reading, where its normal is mixed of both sides'.
fn unmix_reading(
    window: &PixelWindow,
    Across { own, other, is_crease, .. }: Across,
) -> Option<AmendedReading> {
    let rest = own & !(1 << CENTER);
    // Where the surface goes on, what lies between is its own shape.
    if is_crease || other == 0 || rest.count_ones() < 4 {
        return None;
    }
    let (mine, theirs) = (Continued::from(window, rest)?, Continued::from(window, other)?);
    let is_mixed = is_between(window.nbar(CENTER), mine.nbar(Vec2::ZERO), theirs.nbar(Vec2::ZERO));
    is_mixed.then(|| mine.reading(Vec2::ZERO))
}

/// A normal is mixed of two others, from their n̄: of its own side's and the other side's.
fn is_between(nbar: Vec2, own: Vec2, other: Vec2) -> bool {
    let [n, own, other] = [nbar, own, other].map(|nbar| nbar.extend(nz_of(nbar)));
    let way = other - own;
    let squared = way.length_squared();
    if squared < MIXED_LEAST * MIXED_LEAST {
        return false;
    }
    let along = (n - own).dot(way) / squared;
    let beside = (n - own - along * way).length();
    along > MIXED_FROM && beside < MIXED_BESIDE * squared.sqrt()
}

impl Continued {
    fn reading(&self, from_center: Vec2) -> AmendedReading {
        let nbar = self.nbar(from_center);
        AmendedReading { nbar, nz: nz_of(nbar), depth: self.depth(from_center) }
    }
}

fn continue_reading(window: &PixelWindow, members: u64) -> Option<AmendedReading> {
    Continued::from(window, members).map(|continued| continued.reading(Vec2::ZERO))
}

const _: () = assert!(ALL >> CENTER & 1 == 1);
