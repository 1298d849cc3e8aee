use super::*;
use crate::math::{Size, vec3};
use crate::surface::Maps;

const PLAIN: ChunkSettings =
    ChunkSettings { ball_px: 128.0, chunk_px: 64.0, follow: 0.0, seam_px: 1.0 };

/// The ball itself, as large as its picture.
fn ball(side: u32) -> Surface {
    let normal = |x: usize, y: usize| {
        let at = |v: usize| (v as f32 + 0.5) / side as f32 * 2.0 - 1.0;
        let below = 1.0 - at(x) * at(x) - at(y) * at(y);
        (below > 0.0).then(|| vec3(at(x), -at(y), below.sqrt()))
    };
    let size = Size::new(side, side);
    let depth = Plane::from_fn(size, |x, y| normal(x, y).map_or(f32::NAN, |n| 0.5 - 0.5 * n.z));
    let coverage = Plane::from_fn(size, |x, y| if normal(x, y).is_some() { 255 } else { 0 });
    let normals = Plane::from_fn(size, |x, y| normal(x, y).unwrap_or_default());
    Surface::new(Maps { normals, depth, coverage }).unwrap()
}

/// Bumps of several sizes, a step in depth, and a hole.
fn bumps((width, height): (u32, u32), step: f32) -> Surface {
    let size = Size::new(width, height);
    let is_covered = |x: usize, y: usize| (x as f32 - 30.0).hypot(y as f32 - 40.0) > 12.0;
    let normals = Plane::from_fn(size, |x, y| {
        let (x, y) = (x as f32, y as f32);
        vec3((x * 0.031).sin() * 0.7 + (y * 0.11).cos() * 0.2, (y * 0.043).cos() * 0.6, 1.0)
    });
    let depth = Plane::from_fn(size, |x, _| if (x as u32) < width / 2 { 0.2 } else { 0.2 + step });
    let coverage = Plane::from_fn(size, |x, y| if is_covered(x, y) { 255 } else { 0 });
    Surface::new(Maps { normals, depth, coverage }).unwrap()
}

#[test]
fn rows_of_tiles_hold_what_the_single_pixel_does() {
    for follow in [0.0, 0.6] {
        for chunk_px in [64.0, 37.0] {
            let surface = bumps((150, 97), 0.5);
            let settings = ChunkSettings { follow, chunk_px, ..PLAIN };
            let maps = ChunkMaps::of(&surface, settings);
            let found = surface.ball_places(&settings);
            for y in 0..97 {
                for x in 0..150 {
                    let expected = maps.place_at(x, y).at;
                    assert_eq!(found.row(y)[x], expected, "{follow} {chunk_px}: {x}, {y}");
                }
            }
        }
    }
}

#[test]
fn places_suit_the_normal_or_are_the_look_up() {
    let surface = bumps((200, 140), 0.0);
    for follow in [0.0, 0.5, 1.0] {
        let settings = ChunkSettings { follow, ..PLAIN };
        let maps = ChunkMaps::of(&surface, settings);
        let (mut looked_up, mut all) = (0, 0);
        for y in 0..140 {
            for x in (0..200).filter(|x| surface.coverage(*x, y) > 0) {
                let place = maps.place_at(x, y);
                let at = vec2(place.at[0].into(), place.at[1].into()) / settings.steps();
                let (nbar, nz) = (maps.nbar(x, y), maps.seen[2].at(x, y));
                let is_look_up = (at - settings.look_up(nbar)).length() < 2.0 / settings.steps();
                // Stored places are rounded to the nearest step.
                let is_near = [vec2(-0.5, -0.5), vec2(0.5, -0.5), vec2(-0.5, 0.5), vec2(0.5, 0.5)]
                    .iter()
                    .any(|by| settings.is_near(at + *by / settings.steps(), nbar, nz));
                assert!(is_near || is_look_up, "{follow}: {x}, {y}: {at}");
                looked_up += usize::from(place.chunk == LOOKED_UP);
                all += 1;
            }
        }
        assert!(looked_up * 100 < all, "{looked_up} of {all}");
    }
}

#[test]
fn the_ball_itself_shows_itself() {
    let surface = ball(128);
    let found = surface.ball_places(&PLAIN);
    let steps = PLAIN.steps();
    for y in 0..128 {
        for x in (0..128).filter(|x| surface.coverage(*x, y) > 0) {
            let expected = [x, y].map(|v| ((v as f32 + 0.5) * steps) as u16);
            assert_eq!(found.row(y)[x], expected, "{x}, {y}");
        }
    }
}

/// Both halves face the viewer: only the jump at x = 48 tells them apart.
fn flat(jump: f32) -> Surface {
    let size = Size::new(96, 64);
    let depth = Plane::from_fn(size, |x, _| if x < 48 { 0.0 } else { jump });
    let normals = Plane::from_fn(size, |x, _| vec3(if x < 48 { 0.01 } else { 0.02 }, 0.0, 1.0));
    Surface::new(Maps { normals, depth, coverage: Plane::full(size, 255) }).unwrap()
}

#[test]
fn no_chunk_goes_across_a_jump_in_depth_or_a_gap() {
    let reaches = |surface: &Surface| {
        let maps = &ChunkMaps::of(surface, PLAIN);
        let across = |y: usize| {
            let seeds = |x: usize| (x..x + 8).map(move |x| maps_seed(maps, (x, y)));
            let left = seeds(40).flatten().any(|seed| seed.at.x > 48.0);
            let right = seeds(48).flatten().any(|seed| seed.at.x < 48.0);
            left || right
        };
        (0..64).any(across)
    };
    assert!(reaches(&flat(0.0)), "without a jump chunks do go across");
    assert!(!reaches(&flat(1.0)));
}

/// The seed of the chunk that a pixel shows.
fn maps_seed(maps: &ChunkMaps, (x, y): (usize, usize)) -> Option<Seed> {
    let part = maps.part(x, y);
    let chunk = |level| {
        let grid = maps.grid(level, part);
        let cell = grid.nearest((x, y));
        maps.chunk_place(&grid, cell, (x, y)).map(|_| (grid, cell))
    };
    let (grid, cell) = maps.settings.sides().find_map(chunk)?;
    maps.seed(&grid, cell, part)
}

#[test]
fn a_bent_chunk_follows_the_surface_and_keeps_within_its_limit() {
    for (m, expected) in [
        (Mat2::IDENTITY, Mat2::IDENTITY),
        (Mat2::from_diagonal(vec2(9.0, 0.1)), Mat2::from_diagonal(vec2(4.0, 0.25))),
        (Mat2::from_diagonal(vec2(0.5, -7.0)), Mat2::from_diagonal(vec2(0.5, -4.0))),
    ] {
        assert!(limited(m).abs_diff_eq(expected, 1e-5), "{m}: {}", limited(m));
    }
    let turned =
        Mat2::from_angle(0.7) * Mat2::from_diagonal(vec2(9.0, 2.0)) * Mat2::from_angle(0.4);
    let expected =
        Mat2::from_angle(0.7) * Mat2::from_diagonal(vec2(4.0, 2.0)) * Mat2::from_angle(0.4);
    assert!(limited(turned).abs_diff_eq(expected, 1e-4), "{}", limited(turned));
    // On a ball twice as large as the painted one, bent places are those of a lit sphere.
    let surface = ball(256);
    let mean = |follow: f32| {
        let maps = ChunkMaps::of(&surface, ChunkSettings { follow, ..PLAIN });
        let away = |x: usize| {
            let place = maps.place_at(x, 128).at.map(|v| f32::from(v) / maps.settings.steps());
            (Vec2::from(place) - maps.look_up(x, 128)).length()
        };
        (64..192).map(away).sum::<f32>() / 128.0
    };
    let (stiff, bent) = (mean(0.0), mean(1.0));
    assert!(bent < 0.35 * stiff, "{bent} of {stiff}");
}

#[test]
fn seams_take_what_neighbors_show() {
    let surface = bumps((150, 97), 0.5);
    let found = surface.ball_places(&PLAIN);
    let maps = ChunkMaps::of(&surface, PLAIN);
    let (mut joined, mut all) = (0, 0);
    for y in 0..97 {
        let seams = found.seams(y).unwrap();
        for x in (0..150).filter(|x| surface.coverage(*x, y) > 0) {
            all += 1;
            joined += usize::from(seams[x] > 0);
            for bit in (0..8).filter(|bit| seams[x] >> bit & 1 != 0) {
                let (dx, dy) = SEAM_STEPS[bit];
                let (ox, oy) = ((x as i32 + dx) as usize, (y as i32 + dy) as usize);
                assert_ne!(maps.place_at(x, y).chunk, maps.place_at(ox, oy).chunk);
            }
        }
    }
    assert!(joined * 20 > all && joined * 2 < all, "{joined} of {all}");
    let jump = flat(1.0).ball_places(&PLAIN);
    let rightward = 0b1001_0100; // The bits of the steps to the right.
    assert!((0..64).all(|y| jump.seams(y).unwrap()[47] & rightward == 0), "across a jump");
    let none = surface.ball_places(&ChunkSettings { seam_px: 0.0, ..PLAIN });
    assert!(none.seams(0).is_none());
}

/// The bits of the neighbors that a pixel is averaged with: in another chunk, joined to the pixel,
/// and their place, taken back by the step, suits its normal.
fn seam_bits(maps: &ChunkMaps, (x, y): (usize, usize)) -> u8 {
    let (reach, size) = (maps.settings.seam_px as i32, maps.surface.size());
    let own = maps.place_at(x, y);
    let is_seam = |(dx, dy): (i32, i32)| {
        let (ox, oy) = (x as i32 + dx * reach, y as i32 + dy * reach);
        if !size.rect().contains(ox, oy) {
            return false;
        }
        let (ox, oy) = (ox as usize, oy as usize);
        let other = maps.place_at(ox, oy);
        let back = vec2((dx * reach) as f32, (dy * reach) as f32);
        let at = Vec2::from(other.at.map(f32::from)) / maps.settings.steps() - back;
        own.chunk != other.chunk
            && own.chunk != 0
            && other.chunk != 0
            && maps.settings.is_near(at, maps.nbar(x, y), maps.seen[2].at(x, y))
            && maps.ways.is_reached((x, y), (ox, oy))
    };
    (0..8).filter(|bit| is_seam(SEAM_STEPS[*bit])).map(|bit| 1 << bit).sum()
}

#[test]
fn seams_are_those_that_single_pixels_find() {
    for (seam_px, follow, step) in [(1.0, 0.0, 0.5), (3.0, 0.6, 0.0)] {
        let surface = bumps((150, 97), step);
        let settings = ChunkSettings { seam_px, follow, ..PLAIN };
        let (found, maps) = (surface.ball_places(&settings), ChunkMaps::of(&surface, settings));
        for y in 0..97 {
            let seams = found.seams(y).unwrap();
            for (x, bits) in seams.iter().enumerate() {
                assert_eq!(*bits, seam_bits(&maps, (x, y)), "{seam_px} px: {x}, {y}");
            }
        }
    }
}

#[test]
fn a_surface_twice_as_large_shows_chunks_twice_as_large() {
    let surface = Arc::new(bumps((150, 97), 0.0));
    let twice = surface.scaled(Size::new(300, 194)).unwrap();
    let large = ChunkSettings { ball_px: 256.0, chunk_px: 128.0, seam_px: 2.0, follow: 0.0 };
    let (found, doubled) = (surface.ball_places(&PLAIN), twice.ball_places(&large));
    let mut same = 0;
    let all = (8..89)
        .flat_map(|y| (8..140).map(move |x| (x, y)))
        .filter(|(x, y)| surface.coverage(*x, *y) > 0);
    let all: Vec<(usize, usize)> = all.collect();
    for &(x, y) in &all {
        let at = found.row(y)[x].map(|v| f32::from(v) / PLAIN.steps());
        let there = doubled.row(2 * y)[2 * x].map(|v| f32::from(v) / large.steps() * 0.5 + 0.25);
        same += usize::from((Vec2::from(at) - Vec2::from(there)).length() < 1.5);
    }
    assert!(same * 100 > all.len() * 90, "{same} of {}", all.len());
}
