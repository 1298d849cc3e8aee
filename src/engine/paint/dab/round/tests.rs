//! All rows of a dab at once compared with row by row, and pixels that count whole with those that
//! may not.

use super::*;
use crate::math::{Size, hash, vec2, vec3};
use crate::paint::dab::{DabScratch, PlacedDab, round_extent};
use crate::paint::scene::Scene;
use crate::paint::stroke_tile::StrokeTile;
use crate::raster::tile::TILE_AREA;
use crate::raster::{Plane, TileAt};
use crate::surface::{Maps, Operator, Surface};
use std::sync::Arc;

const SIZE: Size = Size::new(140, 130);

/// Waves with a hole, and a jump in depth.
fn scene() -> Scene {
    let normals = Plane::from_fn(SIZE, |x, y| {
        vec3((0.09 * x as f32).sin(), (0.07 * y as f32).cos(), 1.0).normalize()
    });
    let depth = Plane::from_fn(SIZE, |x, y| {
        0.3 + 0.1 * (0.05 * y as f32).sin() + if x > 90 { 0.4 } else { 0.0 }
    });
    let hole = vec2(50.0, 60.0);
    let coverage = Plane::from_fn(SIZE, |x, y| {
        if vec2(x as f32, y as f32).distance(hole) < 14.0 { 0u8 } else { 255 }
    });
    Scene {
        size: SIZE,
        surface: Surface::new(Maps { normals, depth, coverage }).ok().map(Arc::new),
    }
}

fn dab(seed: u32) -> Dab {
    let random = |i| hash::unit(seed, i, 0);
    let rim = if seed.is_multiple_of(3) { Rim { edge: 0.9, width: 0.02 } } else { Rim::SOFT };
    Dab {
        hardness: if seed.is_multiple_of(4) { 1.0 } else { random(0) },
        softness: if seed.is_multiple_of(2) { 0.0 } else { 0.5 * random(1) },
        flow: 0.1 + 0.9 * random(2),
        thin: if seed.is_multiple_of(5) { 0.4 } else { 1.0 },
        ceiling: if seed.is_multiple_of(7) { 0.6 } else { 1.0 },
        reach_px: if seed.is_multiple_of(11) { 25.0 } else { 0.0 },
        rim,
        ..Dab::plain(vec2(140.0 * random(3), 130.0 * random(4)), 0.6 + 45.0 * random(5) * random(6))
    }
}

/// Coverage and reach of a tile, painted row by row, with each pixel classified.
///
/// * `by_d`: from D at every pixel, also where the unwrapped plane itself would do.
fn row_by_row(placed: &PlacedDab, at: TileAt, [coverage, reach]: &mut [Vec<f32>; 2], by_d: bool) {
    let part = placed.reached_blocks(at);
    if part.area.is_empty() {
        return;
    }
    let (mut row, mut scratch) = (RowZones::default(), DabScratch::default());
    let tip = RoundTip { soft: 0.0, ..RoundTip::new(placed.dab()) };
    let (tip, field) = match placed.bent_over {
        Some(surface) if by_d => {
            placed.fill_touched(&part, &mut scratch.deformed);
            let rect = part.area.grown(1);
            (tip, Some(crate::paint::dab::DeformationField::new(surface, rect, &scratch.deformed)))
        }
        _ => placed.round_field(&part, tip, &mut scratch.deformed),
    };
    for span in part.spans() {
        let start = part.start_of(span);
        let out = RowPaint {
            coverage: &mut coverage[start..start + span.n],
            reach: &mut reach[start..start + span.n],
        };
        match &field {
            Some(field) => fill_bent_row(field.span_neighbors(span), &tip, &mut row, out),
            None => flat_row(span.x as f32 + 0.5, span.y as f32 + 0.5, &tip, &mut row, out),
        }
    }
}

#[test]
fn all_rows_at_once_hold_the_bits_of_row_by_row() {
    let scene = scene();
    let operators = [
        Operator::None,
        Operator::Normal { alpha: 0.4, beta: 1.0, detail: 0.0 },
        Operator::Normal { alpha: -0.1, beta: 2.0, detail: 0.8 },
        Operator::Depth { gamma: 1.5 },
        Operator::Reflection { alpha: 0.3, detail: 0.0 },
        Operator::Surface { amount: 1.0, smooth: 0.0 },
    ];
    let mut painted = 0;
    for operator in operators {
        let (mut expected, mut tiles) = (Vec::new(), Vec::new());
        for _ in TileAt::covering(SIZE.rect()) {
            expected.push([vec![0.0f32; TILE_AREA], vec![0.0f32; TILE_AREA]]);
            tiles.push(StrokeTile::one_color());
        }
        let mut scratch = DabScratch::default();
        for seed in 0..90 {
            let dab = Dab { operator, ..dab(seed) };
            let placed = PlacedDab::new(dab, &scene, round_extent(&dab));
            for ((at, expected), tile) in
                TileAt::covering(SIZE.rect()).zip(&mut expected).zip(&mut tiles)
            {
                row_by_row(&placed, at, expected, false);
                placed.add_round(at, tile, &mut scratch);
                let (coverage, reach) = tile.plain().unwrap();
                for i in 0..TILE_AREA {
                    let found = [coverage[i].to_bits(), reach[i].to_bits()];
                    let bits = [expected[0][i].to_bits(), expected[1][i].to_bits()];
                    assert_eq!(found, bits, "{operator:?}, {dab:?} at pixel {i} of {at:?}");
                }
                painted += coverage.iter().filter(|&&a| a > 0.0).count();
            }
        }
    }
    assert!(painted > 100_000, "{painted}");
}

#[test]
fn the_unwrapped_plane_itself_gives_the_coverage_that_d_gives() {
    // One piece without a hole, as wide as most dabs.
    let normals = Plane::from_fn(SIZE, |x, y| {
        vec3((0.05 * x as f32).sin(), (0.04 * y as f32).cos(), 1.5).normalize()
    });
    let maps = Maps { normals, depth: Plane::full(SIZE, 0.5), coverage: Plane::full(SIZE, 255) };
    let scene = Scene { size: SIZE, surface: Surface::new(maps).ok().map(Arc::new) };
    let (mut by_plane, mut off) = (0, 0.0f32);
    for seed in 0..90 {
        let dab = Dab {
            operator: Operator::Surface { amount: 1.0, smooth: 0.0 },
            ceiling: 1.0,
            ..dab(seed)
        };
        let placed = PlacedDab::new(dab, &scene, round_extent(&dab));
        for at in TileAt::covering(SIZE.rect()) {
            by_plane +=
                usize::from(placed.deformation.own_plane(placed.reached_blocks(at).area).is_some());
            let [found, expected] = [false, true].map(|by_d| {
                let mut planes = [vec![0.0f32; TILE_AREA], vec![0.0f32; TILE_AREA]];
                row_by_row(&placed, at, &mut planes, by_d);
                planes
            });
            let pairs = found[0].iter().zip(&expected[0]);
            off = pairs.fold(off, |off, (a, b)| off.max((a - b).abs()));
        }
    }
    assert!(by_plane > 50, "{by_plane} parts of tiles");
    assert!(off < 0.2 / 255.0, "{off}");
}

#[test]
fn a_pixel_that_counts_whole_takes_the_same_bits_either_way() {
    let tip = RoundTip::new(&Dab { hardness: 0.5, flow: 0.4, ..Dab::plain(vec2(0.0, 0.0), 12.0) });
    for i in 0..3000u32 {
        let random = |j| hash::unit(3, i, j);
        let wide = tip.soft * random(0) * 0.999;
        let (r, width) = (1.3 * random(1), wide * random(2));
        let (mut a, mut m) = (random(3), if random(4) < 0.5 { 0.0 } else { random(4) });
        a *= m;
        let (mut b, mut n) = (a, m);
        tip.raise_share(&mut a, &mut m, r, width, wide - width);
        tip.raise_whole(&mut b, &mut n, r, width, wide - width);
        assert_eq!(
            [a.to_bits(), m.to_bits()],
            [b.to_bits(), n.to_bits()],
            "at {r}, {width} of {wide}"
        );
    }
}
