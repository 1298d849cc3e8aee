use super::tile::{factor_of, parts};
use super::*;
use crate::math::{Size, vec2, vec3};
use crate::paint::Scene;
use crate::raster::tile::TILE_AREA;
use crate::raster::{TILE, TileAt};
use crate::surface::{Maps, Surface};

const SIZE: Size = Size::new(128, 128);

/// A ramp that comes nearer from left to right.
fn ramp() -> Scene {
    let maps = Maps {
        normals: Plane::from_fn(SIZE, |_, _| vec3(0.0, 0.0, 1.0)),
        depth: Plane::from_fn(SIZE, |x, _| 1.0 - x as f32 / 127.0),
        coverage: Plane::from_fn(SIZE, |_, _| 255),
    };
    Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
}

fn row(grain: &BrushGrain, scene: &Scene, y: usize) -> Vec<f32> {
    let laid = StrokeGrain::new(grain, vec2(64.0, 64.0));
    let tiles = [0, 1].map(|col| laid.tile(scene, TileAt::new(col, (y / TILE) as i32)));
    tiles.iter().flat_map(|tile| means(tile)[y % TILE * TILE..][..TILE].to_vec()).collect()
}

fn means(tile: &GrainTile) -> Vec<f32> {
    let of = |i: usize| tile.dark[i] + (tile.light[i] - tile.dark[i]) * tile.share[i];
    (0..TILE_AREA).map(of).collect()
}

fn lines(lies: GrainSpace) -> BrushGrain {
    let source = GrainSource::Pattern { pattern: Pattern::Lines, seed: 0 };
    BrushGrain {
        source,
        size_px: 8.0,
        rotation: 90.0,
        levels: [0.4, 0.6],
        lies,
        ..BrushGrain::default()
    }
}

/// The number of changes from bare to covered in a part of a row.
fn crossings(row: &[f32]) -> usize {
    row.windows(2).filter(|pair| pair[0] < 0.5 && pair[1] >= 0.5).count()
}

#[test]
fn strength_says_how_much_the_valleys_take_away() {
    assert_eq!(factor_of(0.0, 0.0), 1.0);
    assert_eq!(factor_of(1.0, 0.25), 0.25);
    assert_eq!(factor_of(0.5, 0.0), 0.5);
    let flat = Scene { size: SIZE, surface: None };
    let weak = BrushGrain { strength: 0.5, ..lines(GrainSpace::Canvas) };
    assert!(row(&weak, &flat, 10).iter().all(|f| (0.499..=1.0).contains(f)));
}

#[test]
fn a_feature_of_a_pattern_is_as_large_as_the_grain_says_and_repeats() {
    let flat = Scene { size: SIZE, surface: None };
    assert!((15..=17).contains(&crossings(&row(&lines(GrainSpace::Canvas), &flat, 64))));
    let coarse = BrushGrain { size_px: 32.0, ..lines(GrainSpace::Canvas) };
    assert!((3..=5).contains(&crossings(&row(&coarse, &flat, 64))));
}

#[test]
fn on_the_surface_grain_is_larger_where_the_shape_comes_near() {
    let row = row(&lines(GrainSpace::Surface { gamma: 1.5 }), &ramp(), 64);
    let (far, near) = (crossings(&row[..60]), crossings(&row[68..]));
    assert!(far > near + 1, "{far} lines on the far half, {near} on the near one");
}

#[test]
fn on_a_flat_surface_and_where_the_stroke_begins_it_is_the_canvas_s() {
    let laid = |lies| {
        means(&StrokeGrain::new(&lines(lies), vec2(20.5, 20.5)).tile(&ramp(), TileAt::new(0, 0)))
    };
    let (canvas, surface) = (laid(GrainSpace::Canvas), laid(GrainSpace::Surface { gamma: 2.0 }));
    let start = 20 * TILE + 20;
    assert!((canvas[start] - surface[start]).abs() < 0.02);
    let flat = Scene { size: SIZE, surface: None };
    let [a, b] = [GrainSpace::Canvas, GrainSpace::Surface { gamma: 2.0 }]
        .map(|lies| row(&lines(lies), &flat, 30));
    assert_eq!(a, b);
}

#[test]
fn a_pixel_s_two_parts_have_its_mean_and_variance() {
    for (mean, square) in
        [(0.5, 0.5), (0.3, 0.2), (0.8, 0.7), (0.5, 0.26), (0.02, 0.02), (0.99, 0.985)]
    {
        let [light, dark, share] = parts(mean, square, 1.0);
        assert!((0.0..=1.0).contains(&dark) && dark <= light && light <= 1.0, "{mean} {square}");
        assert!((dark + (light - dark) * share - mean).abs() < 1e-5, "{mean} {square}");
        let found = dark * dark + (light * light - dark * dark) * share;
        assert!((found - square).abs() < 0.011, "{mean} {square}: {found}");
    }
    assert_eq!(parts(0.5, 0.5, 1.0), [1.0, 0.0, 0.5], "black and white");
    assert_eq!(parts(0.5, 0.25, 1.0), [0.5, 0.5, 1.0], "gray");
    assert_eq!(parts(0.2, 0.15, 0.5), [0.4, 0.0, 0.5], "half of it is black");
    for (mean, square) in [(0.0, 0.0), (1.0, 1.0), (0.0, 1.0), (1.0, 0.0)] {
        for share in [0.0, 0.01, 1.0] {
            assert!(
                parts(mean, square, share).iter().all(|v| (0.0..=1.0).contains(v)),
                "{mean} {square} {share}"
            );
        }
    }
}

#[test]
fn what_is_not_a_number_still_gives_factors() {
    let bad = BrushGrain {
        size_px: f32::NAN,
        rotation: f32::INFINITY,
        strength: f32::NAN,
        levels: [0.5, 0.5],
        ..BrushGrain::default()
    };
    assert!(row(&bad, &ramp(), 3).iter().all(|f| (0.0..=1.0).contains(f)));
}
