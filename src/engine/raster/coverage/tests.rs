use super::*;
use crate::math::hash;
use proptest::prelude::*;

/// Blots of every coverage, some tiles whole, some empty, beyond the corner too.
fn blots(seed: u32) -> CoverageGrid {
    let plane = Plane::from_fn(Size::new(200, 150), |x, y| {
        match hash::mix(seed ^ (x / 64 + 4 * (y / 64)) as u32) % 3 {
            0 => 0,
            1 => 255,
            _ => hash::mix(seed ^ (x * 977 + y) as u32) as u8,
        }
    });
    CoverageGrid::from_plane(&plane, -30, 7)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn each_way_of_combining_is_the_rule_of_a_pixel_everywhere(a: u32, b: u32) {
        let (a, b) = (blots(a), blots(b));
        for (how, name) in SelectionMode::ALL {
            let both = a.combined(&b, |x, y| how.of(x, y));
            for (x, y) in (-40..180).step_by(7).flat_map(|x| (0..160).step_by(5).map(move |y| (x, y))) {
                prop_assert_eq!(both.at(x, y), how.of(a.at(x, y), b.at(x, y)), "{} at {}, {}", name, x, y);
            }
        }
        let canvas = Rect::new(0, 0, 130, 140);
        let (once, twice) = (a.inverted(canvas), a.inverted(canvas).inverted(canvas));
        prop_assert_eq!(once.at(50, 60), 255 - a.at(50, 60));
        prop_assert!(twice.is_same(&a.within(canvas)), "what is inverted twice is what it was");
        prop_assert!(a.shifted(37, -101).shifted(-37, 101).is_same(&a));
        prop_assert_eq!(a.shifted(37, -101).at(60 + 37, 60 - 101), a.at(60, 60));
    }
}

#[test]
fn the_whole_canvas_takes_no_memory_but_at_its_border() {
    let whole = CoverageGrid::full(Rect::new(0, 0, 4096, 4096));
    assert_eq!((whole.bytes(), whole.area_px()), (0, 4096.0 * 4096.0));
    let odd = CoverageGrid::full(Rect::new(0, 0, 1920, 1080));
    assert_eq!((odd.covered_rect(), odd.area_px()), (Rect::new(0, 0, 1920, 1080), 1920.0 * 1080.0));
    assert_eq!(odd.bytes(), 30 * (TILE_AREA + 64));
}

#[test]
fn a_map_cut_into_tiles_comes_back_and_its_bounds_are_tight() {
    let plane =
        Plane::from_fn(
            Size::new(150, 90),
            |x, y| if (70..80).contains(&x) && y > 40 { 9 } else { 0 },
        );
    let grid = CoverageGrid::from_plane(&plane, -5, 3);
    assert_eq!(grid.to_plane(Rect::new(-5, 3, 145, 93)), plane);
    assert_eq!(grid.covered_rect(), Rect::new(65, 44, 75, 93));
    assert!(CoverageGrid::from_plane(&plane.map(|_| 0), 0, 0).is_empty());
}
