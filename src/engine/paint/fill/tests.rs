use super::*;
use crate::math::{hash, vec2};
use crate::raster::TileGrid;

const CANVAS: Size = Size::new(200, 150);

/// A picture from a color for each pixel.
fn picture(color: impl Fn(i32, i32) -> [u8; 4]) -> TileGrid {
    let rgba: Vec<u8> = (0..150)
        .flat_map(|y| (0..200).map(move |x| (x, y)))
        .flat_map(|(x, y)| color(x, y))
        .collect();
    TileGrid::from_straight_rgba(&rgba, 200, 150, 0, 0)
}

fn fill_from(fill: Fill, start: Vec2, grid: &TileGrid) -> Option<FilledArea> {
    fill.from(start, CANVAS, &CanvasPart::Whole, |at| grid.tile(at).cloned())
}

/// No growth, no smoothing.
fn plain() -> Fill {
    Fill { grow_px: 0.0, antialias: false, ..Fill::default() }
}

fn is_in(filled: &FilledArea, x: i32, y: i32) -> bool {
    filled.coverage(x, y) > 0.5
}
const PAPER: [u8; 4] = [255; 4];
const INK: [u8; 4] = [20, 20, 30, 255];

/// A room of 160 × 110 px with walls of 3 px, and a gap of the given height in its right wall.
fn room(gap: i32) -> TileGrid {
    picture(move |x, y| {
        let in_wall = |v: i32, low: i32, high: i32| {
            (low..low + 3).contains(&v) || (high - 3..high).contains(&v)
        };
        let within = (20..180).contains(&x) && (20..130).contains(&y);
        let wall = within && (in_wall(x, 20, 180) || in_wall(y, 20, 130));
        let in_gap = x > 100 && (70..70 + gap).contains(&y);
        if wall && !in_gap { INK } else { PAPER }
    })
}

fn is_inside_room(x: i32, y: i32) -> bool {
    (23..177).contains(&x) && (23..127).contains(&y)
}

#[test]
fn what_is_filled_is_what_a_path_of_like_pixels_joins() {
    // Noise in blots: some paths end, some wind through many tiles.
    let shade = |x: i32, y: i32| match (x / 3, y / 3) {
        (33, 25) => 50,
        (x, y) => (hash::unit(5, x as u32, y as u32) * 100.0) as u8,
    };
    let grid = picture(|x, y| [shade(x, y), 40, 90, 255]);
    let found =
        fill_from(Fill { tolerance: 32.0 / 255.0, ..plain() }, vec2(100.5, 75.5), &grid).unwrap();
    let like = shade(100, 75);
    let mut joined = vec![false; CANVAS.area()];
    let mut paths = vec![(100i32, 75i32)];
    while let Some((x, y)) = paths.pop() {
        let is_new = CANVAS.rect().contains(x, y) && !joined[(y * 200 + x) as usize];
        if is_new && shade(x, y).abs_diff(like) <= 32 {
            joined[(y * 200 + x) as usize] = true;
            paths.extend([(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)]);
        }
    }
    let count = joined.iter().filter(|j| **j).count();
    assert!(count > 3000 && count < 29000, "{count} pixels try both sides");
    for (x, y) in (0..150).flat_map(|y| (0..200).map(move |x| (x, y))) {
        assert_eq!(is_in(&found, x, y), joined[(y * 200 + x) as usize], "({x}, {y})");
    }
}

#[test]
fn a_gap_is_closed_up_to_its_width_and_corners_are_filled_all_the_same() {
    let gap_of = |gap: i32, gap_px: f32| {
        fill_from(Fill { gap_px, ..plain() }, vec2(60.0, 60.0), &room(gap)).unwrap()
    };
    let open = gap_of(8, 5.0);
    assert!(is_in(&open, 5, 5), "a gap wider than said lets the fill out");
    for (gap, gap_px) in [(8, 8.0), (8, 20.0), (1, 1.0), (3, 4.0)] {
        let closed = gap_of(gap, gap_px);
        for (x, y) in (0..150).flat_map(|y| (0..200).map(move |x| (x, y))) {
            let in_gap = (177..180).contains(&x) && (70..70 + gap).contains(&y);
            // The side of the narrowest point to which a pixel of the gap belongs is not defined.
            let near_gap = (170..190).contains(&x) && (60..90).contains(&y);
            if !in_gap && !near_gap {
                assert_eq!(
                    is_in(&closed, x, y),
                    is_inside_room(x, y),
                    "({x}, {y}), {gap} px by {gap_px}"
                );
            }
        }
    }
}

#[test]
fn closing_gaps_keeps_an_even_corridor_that_is_as_narrow() {
    // A slanted corridor, 5 px wide, between two walls; no gap in it.
    let corridor = picture(|x, y| if (y - 30 - x / 3).abs() <= 2 { PAPER } else { INK });
    let found = fill_from(Fill { gap_px: 16.0, ..plain() }, vec2(100.5, 63.5), &corridor).unwrap();
    for x in 0..200 {
        assert!(is_in(&found, x, 30 + x / 3), "column {x}");
    }
}

#[test]
fn the_edge_grows_by_so_many_pixels_and_is_smoothed_where_it_is_slanted() {
    let disc = picture(|x, y| {
        let r = vec2(x as f32 + 0.5, y as f32 + 0.5).distance(vec2(100.0, 75.0));
        if r < 40.0 { PAPER } else { INK }
    });
    let grown =
        fill_from(Fill { grow_px: 6.0, antialias: true, ..plain() }, vec2(100.0, 75.0), &disc)
            .unwrap();
    for (x, y) in (0..150).flat_map(|y| (0..200).map(move |x| (x, y))) {
        let r = vec2(x as f32 + 0.5, y as f32 + 0.5).distance(vec2(100.0, 75.0));
        let ideal = (46.5 - r).clamp(0.0, 1.0);
        assert!(
            (grown.coverage(x, y) - ideal).abs() < 0.75,
            "({x}, {y}): {} for {ideal}",
            grown.coverage(x, y)
        );
        if !(45.0..=47.5).contains(&r) {
            assert_eq!(grown.coverage(x, y), ideal, "({x}, {y})");
        }
    }
    let partly = (0..200).filter(|&x| (0.1..0.9).contains(&grown.coverage(x, 40))).count();
    assert!(partly > 0, "some pixels of the rim are covered in part");
    let sharp = fill_from(plain(), vec2(100.0, 75.0), &room(0)).unwrap();
    let smooth =
        fill_from(Fill { antialias: true, ..plain() }, vec2(100.0, 75.0), &room(0)).unwrap();
    assert!(
        (0..200).all(|x| sharp.coverage(x, 75) == smooth.coverage(x, 75)),
        "straight edges stay sharp"
    );
}

#[test]
fn hostile_settings_and_places_fill_nothing_or_something_finite() {
    let grid = room(4);
    for start in [vec2(f32::NAN, 3.0), vec2(-1.0, 3.0), vec2(200.0, 3.0), vec2(f32::INFINITY, 0.0)]
    {
        assert!(fill_from(Fill::default(), start, &grid).is_none());
    }
    for hostile in [f32::NAN, f32::INFINITY, -f32::INFINITY, 1e30] {
        let fill =
            Fill { tolerance: hostile, gap_px: hostile, grow_px: hostile, ..Fill::default() };
        let found = fill_from(fill, vec2(60.0, 60.0), &grid).unwrap();
        assert!((0.0..=1.0).contains(&found.coverage(60, 60)));
    }
}
