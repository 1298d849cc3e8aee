use super::*;
use crate::math::{Vec3, hash, vec3};
use crate::raster::Plane;
use crate::surface::{Deformation, Maps, links};
use proptest::prelude::*;

const SIZE: Size = Size::new(150, 130);

/// Waves with a random slope and length, a random disc cut out, and a step in depth.
fn surface(seed: u32) -> Surface {
    let random = |i| hash::unit(seed, i, 0);
    let (fx, fy, tilt) = (0.02 + 0.2 * random(0), 0.02 + 0.2 * random(1), 0.2 + 2.0 * random(2));
    let hole = vec2(150.0 * random(3), 130.0 * random(4));
    let normals = Plane::from_fn(SIZE, |x, y| {
        let (x, y) = (x as f32, y as f32);
        vec3(tilt * (fx * x + 0.01 * y).sin(), tilt * (fy * y).cos(), 1.0).normalize_or(Vec3::Z)
    });
    let depth = Plane::from_fn(SIZE, |x, y| {
        let wave = 0.3 + 0.2 * (fx * x as f32).cos() * (fy * y as f32).sin();
        if x as f32 > 150.0 * random(5) { wave + 0.4 } else { wave }
    });
    let coverage = Plane::from_fn(SIZE, |x, y| {
        if vec2(x as f32, y as f32).distance(hole) < 20.0 + 30.0 * random(6) { 0u8 } else { 255 }
    });
    Surface::new(Maps { normals, depth, coverage }).unwrap()
}

fn operator() -> impl Strategy<Value = Operator> {
    prop_oneof![
        Just(Operator::None),
        (0.0f32..4.0).prop_map(|gamma| Operator::Depth { gamma }),
        (-2.0f32..2.0, 0.0f32..5.0).prop_map(|(alpha, beta)| Operator::Normal {
            alpha,
            beta,
            detail: 0.0
        }),
        (-1.0f32..1.0).prop_map(|alpha| Operator::Normal { alpha, beta: 1.0, detail: 1.5 }),
        (-2.0f32..2.0).prop_map(|alpha| Operator::Reflection { alpha, detail: 0.0 }),
        (0.2f32..2.0).prop_map(|amount| Operator::Surface { amount, smooth: 0.0 }),
    ]
}

/// |∂(|D − q_0|)/∂q| by differences between linked neighbors, as the marks take it.
fn pixel_length(surface: &Surface, d: &Deformation, at: Vec2, x: i32, y: i32) -> f32 {
    let linked = surface.smooth_links_plane().at(x as usize, y as usize);
    let along = (d.at(x, y) - at).normalize_or_zero();
    let slope = |before: u8, after: u8, dx: i32, dy: i32, flat: f32| {
        let (l, r) = (i32::from(linked & before != 0), i32::from(linked & after != 0));
        match l + r {
            0 => flat,
            n => {
                (d.at(x + r * dx, y + r * dy) - d.at(x - l * dx, y - l * dy)).dot(along) / n as f32
            }
        }
    };
    slope(links::LEFT, links::RIGHT, 1, 0, along.x).hypot(slope(
        links::UP,
        links::DOWN,
        0,
        1,
        along.y,
    ))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn no_pixel_that_is_reached_is_ever_left_out(
        seed: u32, operator in operator(), x in -20.0f32..170.0, y in -20.0f32..150.0, radius_px in 1.0f32..40.0,
    ) {
        let surface = surface(seed);
        let at = vec2(x, y);
        let extent = DabExtent { radius_px, filter_px: 0.5 };
        let support = SupportBounds::new(Some(&surface), SIZE, operator, at, extent);
        let mut tiles = Vec::new();
        support.for_each_tile(|tile| tiles.push(tile));
        let d = Deformation::of_dab(Some(&surface), SIZE, operator, at);
        for tile in TileAt::covering(SIZE.rect()) {
            let judged = support.judge_blocks(tile);
            let blocks = support.blocks(tile);
            let Rect { x0, y0, x1, y1 } = tile.rect().intersect(SIZE.rect());
            for (x, y) in (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y))) {
                let (row, col) = ((y - y0) as usize / 8, (x - x0) as usize / 8);
                let bit = blocks[row] >> col & 1;
                if let Some(judged) = &judged {
                    let (pixel, most) = (pixel_length(&surface, &d, at, x, y), judged.pixel[row * 8 + col]);
                    prop_assert!(pixel <= most + 0.1, "({x}, {y}): {pixel}, not {most} at most");
                }
                if bit == 0 || !tiles.contains(&tile) {
                    let (distance, pixel) = (d.at(x, y).distance(at), pixel_length(&surface, &d, at, x, y));
                    prop_assert!(distance >= radius_px + 0.5 * pixel, "({x}, {y}): {distance}, a pixel is {pixel}");
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn dabs_that_are_sought_together_touch_the_tiles_that_each_of_them_touches(
        seed: u32, operator in operator(), x in -20.0f32..170.0, y in -20.0f32..150.0, radius_px in 1.0f32..40.0,
    ) {
        let surface = surface(seed);
        let random = |i, j| hash::unit(seed, 10 + i, j);
        // Mostly a stroke, with leaps and other sizes between.
        let dab = |i: u32| {
            let leap = if random(i, 3) > 0.9 { 300.0 } else { 6.0 };
            let at = vec2(x, y) + leap * (vec2(random(i, 0), random(i, 1)) - 0.5) + 2.0 * i as f32;
            let size = if random(i, 4) > 0.9 { 5.0 } else { 1.0 };
            let extent = DabExtent { radius_px: size * radius_px, filter_px: 0.5 };
            let reach = DabReach::new(at, if i.is_multiple_of(7) { 40.0 } else { 0.0 }, 3.0 * radius_px);
            SupportBounds::new(Some(&surface), SIZE, operator, at, extent).within(reach)
        };
        let dabs: Vec<SupportBounds> = (0..40).map(dab).collect();
        let mut found = vec![Vec::new(); dabs.len()];
        let mut last = std::collections::HashMap::new();
        for_each_tile_of(&dabs.iter().collect::<Vec<_>>(), |i, tile| {
            found[i].push(tile);
            assert!(last.insert(tile, i).is_none_or(|before| before < i), "of a tile in their order");
        });
        for (dab, found) in dabs.iter().zip(found) {
            for tile in TileAt::covering(SIZE.rect()) {
                if dab.blocks(tile) != TileBlocks::default() {
                    prop_assert!(found.contains(&tile), "{tile:?}");
                }
            }
            prop_assert!(found.iter().all(|tile| !tile.rect().intersect(SIZE.rect()).is_empty()));
        }
    }
}

#[test]
fn a_flat_dab_reaches_little_more_than_its_disc() {
    let extent = DabExtent { radius_px: 100.0, filter_px: 0.5 };
    let support =
        SupportBounds::new(None, Size::new(1000, 700), Operator::None, vec2(500.0, 350.0), extent);
    let mut blocks = 0;
    support.for_each_tile(|tile| {
        blocks += support.blocks(tile).iter().map(|row| row.count_ones()).sum::<u32>()
    });
    let disc = std::f32::consts::PI * 100.0 * 100.0 / 64.0;
    assert!((blocks as f32) > disc && (blocks as f32) < 1.2 * disc, "{blocks} blocks for {disc}");
}

#[test]
fn a_small_highlight_on_a_large_sphere_touches_few_blocks() {
    let size = Size::new(1024, 1024);
    let at = |x: usize, y: usize| (vec2(x as f32, y as f32) + 0.5 - 512.0) / 500.0;
    let normals = Plane::from_fn(size, |x, y| {
        let p = at(x, y);
        vec3(p.x, -p.y, (1.0 - p.length_squared()).max(0.0).sqrt())
    });
    let coverage = Plane::from_fn(size, |x, y| if at(x, y).length() < 1.0 { 255 } else { 0 });
    let surface = Surface::new(Maps { normals, depth: Plane::full(size, 0.5), coverage }).unwrap();
    let operator = Operator::Normal { alpha: 0.5, beta: 0.0, detail: 0.0 };
    let extent = DabExtent { radius_px: 40.0, filter_px: 0.5 };
    let support = SupportBounds::new(Some(&surface), size, operator, vec2(600.0, 450.0), extent);
    let mut blocks = 0;
    support.for_each_tile(|tile| {
        blocks += support.blocks(tile).iter().map(|row| row.count_ones()).sum::<u32>()
    });
    assert!(blocks > 20 && blocks < 130, "{blocks} of 16384 blocks");
}

#[test]
fn figures_that_are_not_numbers_reach_everything_rather_than_nothing() {
    let extent = DabExtent { radius_px: f32::NAN, filter_px: 0.5 };
    let support =
        SupportBounds::new(None, Size::new(200, 100), Operator::None, vec2(f32::NAN, 3.0), extent);
    let mut tiles = 0;
    support.for_each_tile(|_| tiles += 1);
    assert_eq!(tiles, 8);
}

#[test]
fn what_is_out_of_reach_touches_nothing_and_most_of_a_way_far_off_is() {
    let operator = Operator::Surface { amount: 1.0, smooth: 0.0 };
    let extent = DabExtent { radius_px: 25.0, filter_px: 0.5 };
    for seed in 0..4 {
        let surface = surface(seed);
        let mut out = 0;
        for i in 0..400 {
            let far = 10f32.powf(1.0 + 5.0 * hash::unit(seed, i, 0));
            let at = 100.0 + far * Vec2::from_angle(6.3 * hash::unit(seed, i, 1));
            if is_out_of_reach(&surface, operator, at, extent) {
                out += 1;
                let support =
                    SupportBounds::new(Some(&surface), surface.size(), operator, at, extent);
                support.for_each_tile(|tile| panic!("{at} may touch {tile:?}"));
            }
        }
        assert!(out > 200, "{out} of 400");
    }
}
