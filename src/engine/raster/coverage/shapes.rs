//! Rectangles, ellipses and polygons as exact coverage: each pixel holds the share of it that lies
//! inside. Floor 1. Not here: who draws them (`tools`).

use super::{CoverageGrid, CoverageTile, blank, clip};
use crate::math::{Rect, Vec2, parallel, vec2};
use crate::raster::{TILE, TileAt};

/// The part of a rectangle's pixels that lies between two corners, in any order.
pub fn rectangle(a: Vec2, b: Vec2, within: Rect) -> CoverageGrid {
    let (low, high) = (a.min(b), a.max(b));
    if !(low.is_finite() && high.is_finite()) {
        return CoverageGrid::default();
    }
    let (first, last) = (low.floor().as_ivec2(), high.ceil().as_ivec2());
    let area = Rect::new(first.x, first.y, last.x, last.y).intersect(within);
    // How much of a pixel's column or row lies between two ends.
    let share = |v: i32, low: f32, high: f32| {
        (high.min(v as f32 + 1.0) - low.max(v as f32)).max(0.0).min(1.0)
    };
    let inner = Rect::new(
        low.x.ceil() as i32,
        low.y.ceil() as i32,
        high.x.floor() as i32,
        high.y.floor() as i32,
    );
    let whole = inner.intersect(within);
    CoverageGrid::gather(area, |at| {
        let tile = at.rect();
        if tile.intersect(whole) == tile {
            return Some(CoverageTile::whole());
        }
        let columns: [f32; TILE] =
            std::array::from_fn(|x| share(tile.x0 + x as i32, low.x, high.x));
        let mut bytes = blank(0);
        for (y, row) in (tile.y0..).zip(bytes.as_chunks_mut::<TILE>().0) {
            let height = share(y, low.y, high.y);
            row.iter_mut()
                .zip(columns)
                .for_each(|(to, width)| *to = (width * height * 255.0 + 0.5) as u8);
        }
        clip(&mut bytes, at, within);
        CoverageTile::new(bytes)
    })
}

/// The ellipse between two corners. Drawn as a polygon that deviates from it by less than 1/512 px.
pub fn ellipse(a: Vec2, b: Vec2, within: Rect) -> CoverageGrid {
    const SAGITTA_PX: f32 = 1.0 / 512.0;
    let (center, half) = (0.5 * (a + b), 0.5 * (b - a).abs());
    let radius = half.max_element().max(1.0);
    let step = 2.0 * (1.0 - SAGITTA_PX / radius).max(0.0).acos();
    // NaN and infinite values give no polygon at all.
    let sides = ((std::f32::consts::TAU / step).ceil().min(65_536.0) as usize).max(16);
    let turn = std::f64::consts::TAU / sides as f64;
    let corner = |i: usize| {
        let (sin, cos) = (turn * i as f64).sin_cos();
        center + half * vec2(cos as f32, sin as f32)
    };
    polygon(&(0..sides).map(corner).collect::<Vec<_>>(), within)
}

/// The inside of a closed polygon within a rectangle of pixels. Where it runs round a point more
/// than once, that counts once. A polygon with a corner that is not finite covers nothing.
pub fn polygon(corners: &[Vec2], within: Rect) -> CoverageGrid {
    polygons(&[corners], false, within)
}

/// The same of several polygons together.
///
/// * `has_holes`: what lies inside of an even number of them is outside.
pub fn polygons(lines: &[&[Vec2]], has_holes: bool, within: Rect) -> CoverageGrid {
    let lines = || lines.iter().copied().filter(|corners| corners.len() >= 3);
    let corners = || lines().flat_map(|corners| corners.iter());
    if corners().next().is_none() || !corners().all(|p| p.is_finite()) {
        return CoverageGrid::default();
    }
    let low = corners().fold(Vec2::INFINITY, |low, p| low.min(*p)).floor().as_ivec2();
    let high = corners().fold(Vec2::NEG_INFINITY, |high, p| high.max(*p)).ceil().as_ivec2();
    let area = Rect::new(low.x, low.y, high.x, high.y).intersect(within);
    let edges = edges(lines());
    let bands: Vec<Rect> = bands(area).collect();
    let share = share_by(has_holes);
    let made: Vec<Vec<_>> = parallel::map(&bands, |&band| band_tiles(&edges, band, share));
    let mut grid = CoverageGrid::for_rect(area);
    made.into_iter().flatten().for_each(|(at, tile)| grid.set(at, tile));
    grid
}

/// The same over the rows of a rectangle that the polygons reach, the top row first: on the calling
/// thread alone, for pictures that others wait for.
///
/// * `visit`: is told a row's y and its coverage.
pub fn visit_rows(
    lines: &[&[Vec2]],
    has_holes: bool,
    within: Rect,
    mut visit: impl FnMut(i32, &[u8]),
) {
    let lines = || lines.iter().copied().filter(|corners| corners.len() >= 3);
    let corners = || lines().flatten();
    if !corners().all(|p| p.is_finite()) {
        return;
    }
    let top = corners().fold(f32::INFINITY, |top, p| top.min(p.y)).floor() as i32;
    let bottom = corners().fold(f32::NEG_INFINITY, |bottom, p| bottom.max(p.y)).ceil() as i32;
    let reached = Rect { y0: within.y0.max(top), y1: within.y1.min(bottom), ..within };
    let edges = edges(lines());
    for band in bands(reached) {
        visit_band(&edges, band, share_by(has_holes), &mut visit);
    }
}

/// The edges of closed polygons, without level ones, which part nothing above from below.
pub(super) fn edges<'a>(lines: impl Iterator<Item = &'a [Vec2]>) -> Vec<[Vec2; 2]> {
    let closed = lines.flat_map(|corners| corners.iter().zip(corners.iter().cycle().skip(1)));
    closed.map(|(a, b)| [*a, *b]).filter(|[a, b]| a.y != b.y).collect()
}

fn share_by(has_holes: bool) -> fn(f32) -> f32 {
    if has_holes { odd_share } else { inner_share }
}

/// How much of a pixel lies inside, of its winding number averaged over it.
fn inner_share(winding: f32) -> f32 {
    winding.abs().min(1.0)
}

/// The same where what lies inside twice is outside.
fn odd_share(winding: f32) -> f32 {
    1.0 - (1.0 - winding.abs().rem_euclid(2.0)).abs()
}

/// A rectangle in rows of tiles.
fn bands(area: Rect) -> impl Iterator<Item = Rect> {
    let rows = if area.is_empty() {
        0..0
    } else {
        area.y0.div_euclid(64)..(area.y1 - 1).div_euclid(64) + 1
    };
    rows.map(move |row| Rect::new(area.x0, row * 64, area.x1, row * 64 + 64).intersect(area))
}

/// One row of tiles.
fn band_tiles(
    edges: &[[Vec2; 2]],
    band: Rect,
    share: fn(f32) -> f32,
) -> Vec<(TileAt, Option<std::sync::Arc<CoverageTile>>)> {
    let mut tiles: Vec<_> = TileAt::covering(band).map(|at| (at, blank(0))).collect();
    visit_band(edges, band, share, &mut |y, row| {
        for (at, bytes) in &mut tiles {
            let (tile, area) = (at.rect(), at.rect().intersect(band));
            let to = (y - tile.y0) as usize * TILE + (area.x0 - tile.x0) as usize;
            bytes[to..to + area.width()]
                .copy_from_slice(&row[(area.x0 - band.x0) as usize..][..area.width()]);
        }
    });
    tiles
        .into_iter()
        .map(|(at, mut bytes)| {
            clip(&mut bytes, at, band);
            (at, CoverageTile::new(bytes))
        })
        .collect()
}

/// The rows of a band, and how much of each pixel is covered.
fn visit_band(
    edges: &[[Vec2; 2]],
    band: Rect,
    share: fn(f32) -> f32,
    visit: &mut impl FnMut(i32, &[u8]),
) {
    let width = band.width();
    let mut turned = vec![0.0f32; (width + 2) * band.height()];
    for &[a, b] in edges {
        add_edge(&mut turned, band, a, b);
    }
    let mut row = vec![0u8; width];
    for (y, turned) in (band.y0..).zip(turned.chunks_exact(width + 2)) {
        let mut winding = 0.0f32;
        for (to, change) in row.iter_mut().zip(turned) {
            winding += change;
            *to = (share(winding) * 255.0 + 0.5) as u8;
        }
        visit(y, &row);
    }
}

/// Adds what an edge changes along each row of a band, so that the running sum along a row is the
/// winding number, averaged over each pixel: an edge that falls by h within a pixel changes it by h
/// times the part of the pixel right of it, and the next pixel by the rest.
fn add_edge(turned: &mut [f32], band: Rect, a: Vec2, b: Vec2) {
    let (down, top, bottom) = if a.y < b.y { (1.0, a, b) } else { (-1.0, b, a) };
    let (corner, end) = (vec2(band.x0 as f32, band.y0 as f32), band.height() as f32);
    let (top, bottom) = (top - corner, bottom - corner);
    if bottom.y <= 0.0 || top.y >= end {
        return;
    }
    let slope = (f64::from(bottom.x) - f64::from(top.x)) / (f64::from(bottom.y) - f64::from(top.y));
    let x_at = |y: f32| f64::from(top.x) + slope * (f64::from(y) - f64::from(top.y));
    let stride = band.width() + 2;
    let rows = top.y.max(0.0).floor() as usize..bottom.y.min(end).ceil() as usize;
    for y in rows {
        let (from, to) = (top.y.max(y as f32), bottom.y.min(y as f32 + 1.0));
        let row = &mut turned[y * stride..(y + 1) * stride];
        add_piece(row, band.width() as f64, x_at(from), x_at(to), f64::from(to - from) * down);
    }
}

/// One edge within one row, between two columns; parts beyond the row's ends are moved onto them.
pub(super) fn add_piece(row: &mut [f32], width: f64, a: f64, b: f64, height: f64) {
    let (low, high) = (a.min(b), a.max(b));
    if high <= 0.0 || low >= width || high - low < 1e-9 {
        let x = low.max(0.0).min(width);
        let left = x.floor();
        let share = height * (left + 1.0 - x);
        row[left as usize] += share as f32;
        row[left as usize + 1] += (height - share) as f32;
        return;
    }
    let per = height / (high - low);
    // Parts beyond the ends count as upright there.
    let before = (0.0 - low).max(0.0) * per;
    row[0] += before as f32;
    let (from, to) = (low.max(0.0), high.min(width));
    let mut x = from;
    while x < to {
        let left = x.floor();
        let next = to.min(left + 1.0);
        let piece = (next - x) * per;
        let share = piece * (left + 1.0 - 0.5 * (x + next));
        row[left as usize] += share as f32;
        row[left as usize + 1] += (piece - share) as f32;
        x = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash;

    const CANVAS: Rect = Rect::new(0, 0, 200, 150);

    /// The share of a pixel that is inside by the sign of crossings, over 32 × 32 points.
    fn sampled(corners: &[Vec2], x: i32, y: i32) -> f32 {
        let inside = |p: Vec2| {
            let mut winding = 0;
            for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                let crosses = (a.y <= p.y) != (b.y <= p.y);
                if crosses && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                    winding += if b.y > a.y { 1 } else { -1 };
                }
            }
            winding != 0
        };
        let points = (0..1024).map(|i| {
            vec2(x as f32, y as f32) + (vec2((i % 32) as f32, (i / 32) as f32) + 0.5) / 32.0
        });
        points.filter(|p| inside(*p)).count() as f32 / 1024.0
    }

    #[test]
    fn a_rectangle_covers_the_very_part_of_each_pixel() {
        let grid = rectangle(vec2(70.25, 90.5), vec2(10.5, 20.0), CANVAS);
        assert_eq!(grid.at(40, 60), 255);
        assert_eq!(
            [grid.at(10, 60), grid.at(70, 60), grid.at(40, 90), grid.at(70, 90)],
            [128, 64, 128, 32]
        );
        assert_eq!([grid.at(9, 60), grid.at(40, 19), grid.at(40, 91)], [0; 3]);
        assert!((grid.area_px() - 59.75 * 70.5).abs() < 0.5);
    }

    #[test]
    fn polygons_cover_what_sampling_says_also_beyond_the_canvas() {
        for seed in 0..12 {
            let corner = |i: u32| {
                vec2(280.0 * hash::unit(seed, i, 0) - 40.0, 230.0 * hash::unit(seed, i, 1) - 40.0)
            };
            let corners: Vec<Vec2> = (0..3).map(corner).collect();
            let grid = polygon(&corners, CANVAS);
            for (x, y) in (0..200).step_by(3).flat_map(|x| (0..150).step_by(3).map(move |y| (x, y)))
            {
                let (found, sampled) = (f32::from(grid.at(x, y)) / 255.0, sampled(&corners, x, y));
                assert!(
                    (found - sampled).abs() < 0.04,
                    "{seed} at {x}, {y}: {found} is not {sampled}"
                );
            }
        }
    }

    #[test]
    fn an_ellipse_has_its_area_and_a_lasso_that_runs_round_twice_counts_once() {
        let grid = ellipse(vec2(20.0, 30.0), vec2(120.5, 95.25), CANVAS);
        let area = std::f64::consts::PI * 50.25 * 32.625;
        assert!((grid.area_px() - area).abs() < 0.0005 * area, "{} is not {area}", grid.area_px());
        let square = [vec2(20.0, 20.0), vec2(60.0, 20.0), vec2(60.0, 60.0), vec2(20.0, 60.0)];
        let twice: Vec<Vec2> = square.iter().chain(&square).copied().collect();
        assert!(polygon(&twice, CANVAS).is_same(&polygon(&square, CANVAS)));
    }

    #[test]
    fn several_polygons_cover_what_any_does_or_have_holes() {
        let square = |a: f32, b: f32| [vec2(a, a), vec2(b, a), vec2(b, b), vec2(a, b)];
        let (outer, inner) = (square(10.0, 70.0), square(30.5, 50.0));
        let both = [&outer[..], &inner[..]];
        let whole = polygons(&both, false, CANVAS);
        assert!(whole.is_same(&polygon(&outer, CANVAS)));
        let holed = polygons(&both, true, CANVAS);
        assert_eq!([holed.at(40, 40), holed.at(20, 40), holed.at(30, 40)], [0, 255, 128]);
    }

    #[test]
    fn what_is_no_polygon_covers_nothing() {
        assert!(polygon(&[Vec2::ZERO, Vec2::ONE], CANVAS).is_empty());
        assert!(polygon(&[Vec2::ZERO, vec2(f32::NAN, 3.0), vec2(9.0, 9.0)], CANVAS).is_empty());
        assert!(ellipse(Vec2::ZERO, vec2(f32::INFINITY, 3.0), CANVAS).is_empty());
        let huge = rectangle(vec2(-1e30, -1e30), vec2(1e30, 1e30), CANVAS);
        assert!(huge.is_same(&CoverageGrid::full(CANVAS)));
    }
}
