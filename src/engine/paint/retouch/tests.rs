use super::*;
use crate::math::{Size, Vec3, srgb::Color, vec2, vec3};
use crate::raster::Plane;
use crate::surface::{Maps, Operator, PaintLimit, Surface};
use std::collections::HashMap;

const SIZE: Size = Size::new(200, 150);
const FLAT: Scene = Scene { size: SIZE, surface: None };

/// A layer from a straight color for each pixel.
fn layer(color: impl Fn(i32, i32) -> [u8; 4]) -> TileGrid {
    let all = (0..150).flat_map(|y| (0..200).map(move |x| (x, y)));
    let rgba: Vec<u8> = all.flat_map(|(x, y)| color(x, y)).collect();
    TileGrid::from_straight_rgba(&rgba, 200, 150, 0, 0)
}

/// Each pixel's color encodes its position.
fn places() -> TileGrid {
    layer(|x, y| [x as u8, y as u8, 0, 255])
}

/// n̄ = 0.5 (sin 0.02 x, sin 0.03 y), around the middle: it turns smoothly but not evenly.
fn nbar(at: Vec2) -> Vec2 {
    0.5 * vec2((0.02 * at.x).sin(), (0.03 * at.y).sin())
}

fn waves() -> Scene {
    let normals = Plane::from_fn(SIZE, |x, y| {
        let n = nbar(vec2(x as f32 + 0.5, y as f32 + 0.5));
        vec3(n.x, -n.y, (1.0 - n.length_squared()).sqrt())
    });
    let maps = Maps { normals, depth: Plane::full(SIZE, 0.5), coverage: Plane::full(SIZE, 255) };
    Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
}

/// Two plates: the right one, from column 100 on, far behind the left one.
fn plates() -> Scene {
    let depth = Plane::from_fn(SIZE, |x, _| if x < 100 { 0.1 } else { 0.9 });
    let maps =
        Maps { normals: Plane::full(SIZE, Vec3::Z), depth, coverage: Plane::full(SIZE, 255) };
    Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
}
const BEND: Operator = Operator::Normal { alpha: 0.3, beta: 0.0, detail: 0.0 };
/// D of a dab at `center` by that operator, as the paper writes it: L is the longer side.
fn bend(q: Vec2, center: Vec2) -> Vec2 {
    let pixel_of_center = center.floor() + 0.5;
    let turn = nbar(q) - nbar(pixel_of_center);
    // f_n(u) = α u at β = 0 (SF eq. 14).
    q + 200.0 * 0.3 * turn.length() * turn
}

fn brush(mode: BrushMode) -> Brush {
    Brush { size: 30.0, hardness: 1.0, spacing: 0.1, mode, ..Brush::default() }
}

/// A layer after a stroke.
fn rub(
    brush: Brush,
    operator: Operator,
    points: &[Vec2],
    offset: Vec2,
    base: &TileGrid,
    scene: &Scene,
) -> TileGrid {
    let like = [Stroke::new(brush, operator, Color::BLACK, Vec::new())];
    let mut retouching = ActiveRetouching::new(&like, &[offset], base.clone(), base.clone(), scene);
    let samples = points.iter().map(|&at| Sample::at(at)).collect();
    let mut grid = base.clone();
    retouching.draw(&[samples]).into_iter().for_each(|(at, tile)| grid.set(at, tile));
    grid
}

fn dab(at: Vec2) -> Dab {
    Dab { operator: BEND, ..Dab::plain(at, 20.0) }
}

fn touch(area: Rect) -> TileDab {
    TileDab { at: TileAt::of_pixel(area.x0, area.y0), area, coverage: Box::new([1.0; TILE_AREA]) }
}

/// The position that a color of [`places`] encodes.
fn decode_place(color: [f32; 4]) -> Vec2 {
    vec2(color[0], color[1]) * 255.0 + 0.5
}

#[test]
fn a_smudge_drags_paint_along_and_touches_nothing_else() {
    let half = layer(|x, _| if x < 60 { [200, 30, 10, 255] } else { [0; 4] });
    let dragged = rub(
        brush(BrushMode::Smudge { length: 1.0 }),
        Operator::None,
        &[vec2(45.0, 70.0), vec2(110.0, 70.0)],
        Vec2::ZERO,
        &half,
        &FLAT,
    );
    let pixel = dragged.pixel(100, 70);
    assert!(pixel[3] > 240 && pixel[0].abs_diff(200) < 12, "{pixel:?}");
    assert_eq!((dragged.pixel(100, 90), dragged.pixel(30, 90)), ([0; 4], [200, 30, 10, 255]));
    let short = rub(
        brush(BrushMode::Smudge { length: 0.02 }),
        Operator::None,
        &[vec2(45.0, 70.0), vec2(110.0, 70.0)],
        Vec2::ZERO,
        &half,
        &FLAT,
    );
    assert!(
        short.pixel(100, 70)[3] < 60 && short.pixel(64, 70)[3] > 100,
        "a short one lets go of it"
    );
}

#[test]
fn what_a_smudge_drags_lies_at_the_same_place_of_the_image_plane_under_both_dabs() {
    let scene = waves();
    let (before, now) = (dab(vec2(80.5, 70.5)), dab(vec2(84.5, 72.5)));
    let area = Rect::new(70, 64, 100, 84);
    let colors = drag::smudge_colors(
        &touch(area),
        &now,
        &before,
        1.0,
        &RetouchPixels::new(places()),
        &scene,
    )
    .unwrap();
    let mut farthest: f32 = 0.0;
    for (i, color) in colors.into_iter().enumerate() {
        let q = vec2((70 + i as i32 % 30) as f32 + 0.5, (64 + i as i32 / 30) as f32 + 0.5);
        let p = decode_place(color);
        let (there, here) = (bend(p, before.at) - before.at, bend(q, now.at) - now.at);
        assert!(there.distance(here) < 0.12, "{q} takes {p}: {there} is not {here}");
        farthest = farthest.max((q - p - vec2(4.0, 2.0)).length());
    }
    assert!(
        farthest > 0.1,
        "where normals turn unevenly that is not the way the dab went: {farthest}"
    );
}

#[test]
fn a_clone_copies_whole_pixels_as_they_are_and_bends_what_it_copies_over_a_surface() {
    let base = places();
    let line = [vec2(120.0, 70.0), vec2(150.0, 75.0)];
    let flat = rub(
        brush(BrushMode::Clone { aligned: true, picture: false }),
        Operator::None,
        &line,
        vec2(-80.0, -20.0),
        &base,
        &FLAT,
    );
    assert_eq!(flat.pixel(130, 70), base.pixel(50, 50));
    assert_eq!(flat.pixel(130, 110), base.pixel(130, 110));
    let (scene, center, offset) = (waves(), dab(vec2(84.5, 72.5)), vec2(60.0, 10.0));
    let area = Rect::new(70, 64, 100, 84);
    let colors = drag::clone_colors(&touch(area), &center, offset, &base, &scene);
    for (i, color) in colors.into_iter().enumerate() {
        let q = vec2((70 + i as i32 % 30) as f32 + 0.5, (64 + i as i32 / 30) as f32 + 0.5);
        let expected = bend(q, center.at) + offset;
        assert!(
            decode_place(color).distance(expected) < 0.1,
            "{q}: {} is not {expected}",
            decode_place(color)
        );
    }
}

#[test]
fn a_blurred_edge_is_as_soft_as_said_whatever_the_spacing() {
    let half = layer(|x, _| if x < 100 { [0, 0, 0, 255] } else { [255; 4] });
    for spacing in [0.05, 0.25] {
        let mode = BrushMode::Blur { width: 0.4 };
        let brush = Brush { size: 60.0, spacing, ..brush(mode) };
        let soft = rub(
            brush,
            Operator::None,
            &[vec2(100.0, 10.0), vec2(100.0, 140.0)],
            Vec2::ZERO,
            &half,
            &FLAT,
        );
        // The slope of the edge is the Gaussian: its standard deviation should be 0.4 · 30 px.
        let value = |x: i32| f32::from(soft.pixel(x, 75)[0]) / 255.0;
        let slope = |x: i32| value(x) - value(x - 1);
        let variance: f32 = (76..125).map(|x| slope(x) * (x as f32 - 100.0).powi(2)).sum();
        assert!((variance.sqrt() - 12.0).abs() < 3.0, "{} at {spacing}", variance.sqrt());
    }
}

#[test]
fn what_a_blur_makes_of_one_color_is_that_color_up_to_the_canvas_s_edge() {
    for (color, size) in [([200, 90, 30, 255], 24.0), ([10, 220, 130, 100], 400.0)] {
        let even = layer(|_, _| color);
        let brush = Brush { size, ..brush(BrushMode::Blur { width: 1.0 }) };
        let blurred = rub(
            brush,
            Operator::None,
            &[vec2(-5.0, 3.0), vec2(80.0, 70.0)],
            Vec2::ZERO,
            &even,
            &FLAT,
        );
        for (x, y) in (0..150).flat_map(|y| (0..200).map(move |x| (x, y))) {
            assert_eq!(blurred.pixel(x, y), even.pixel(x, y), "({x}, {y}) at {size}");
        }
    }
}

#[test]
fn a_mark_bounded_to_an_object_neither_leaves_it_nor_takes_from_others() {
    let scene = plates();
    let two = layer(|x, _| if x < 100 { [255, 0, 0, 255] } else { [0, 0, 255, 255] });
    let brush = Brush { bounded: PaintLimit::Object, ..brush(BrushMode::Blur { width: 0.5 }) };
    let blurred = rub(
        brush,
        Operator::None,
        &[vec2(95.0, 40.0), vec2(105.0, 90.0)],
        Vec2::ZERO,
        &two,
        &scene,
    );
    for (x, y) in (0..150).flat_map(|y| (0..200).map(move |x| (x, y))) {
        assert_eq!(blurred.pixel(x, y), two.pixel(x, y), "({x}, {y})");
    }
}

#[test]
fn kept_alpha_keeps_the_shape_of_the_paint() {
    let disc = layer(|x, y| {
        let r = vec2(x as f32, y as f32).distance(vec2(80.0, 70.0));
        if r < 30.0 { [if x < 80 { 250 } else { 20 }, 90, 40, 255] } else { [0; 4] }
    });
    for mode in [BrushMode::Smudge { length: 0.9 }, BrushMode::Blur { width: 0.5 }] {
        let brush = Brush { keeps_alpha: true, ..brush(mode) };
        let kept = rub(
            brush,
            Operator::None,
            &[vec2(60.0, 70.0), vec2(140.0, 70.0)],
            Vec2::ZERO,
            &disc,
            &FLAT,
        );
        for (x, y) in (0..150).flat_map(|y| (0..200).map(move |x| (x, y))) {
            assert_eq!(kept.pixel(x, y)[3], disc.pixel(x, y)[3], "({x}, {y})");
        }
        assert_ne!(kept.pixel(84, 70), disc.pixel(84, 70));
    }
}

#[test]
fn batches_of_samples_leave_the_same_pixels_as_all_at_once() {
    let scene = waves();
    let base = layer(|x, y| {
        [
            (x * 7 % 251) as u8,
            (y * 11 % 241) as u8,
            80,
            if (x / 9 + y / 7) % 3 == 0 { 0 } else { 255 },
        ]
    });
    let samples: Vec<Sample> = (0..14)
        .map(|i| Sample::at(vec2(20.0 + 11.0 * i as f32, 70.0 + 30.0 * (0.7 * i as f32).sin())))
        .collect();
    let mirrored: Vec<Sample> =
        samples.iter().map(|s| Sample { at: vec2(200.0 - s.at.x, s.at.y), ..*s }).collect();
    for mode in [
        BrushMode::Smudge { length: 0.8 },
        BrushMode::Blur { width: 0.3 },
        BrushMode::Clone { aligned: true, picture: false },
    ] {
        let like = [(); 2].map(|_| Stroke::new(brush(mode), BEND, Color::BLACK, Vec::new()));
        let left = |batch: usize| {
            let offsets = [vec2(-30.0, 12.0), vec2(30.0, 12.0)];
            let mut retouching =
                ActiveRetouching::new(&like, &offsets, base.clone(), base.clone(), &scene);
            let mut shown: HashMap<TileAt, Option<Arc<Tile>>> = HashMap::new();
            for (a, b) in samples.chunks(batch).zip(mirrored.chunks(batch)) {
                shown.extend(retouching.draw(&[a.to_vec(), b.to_vec()]));
            }
            let mut tiles: Vec<_> = shown
                .into_iter()
                .map(|(at, tile)| (at, tile.map(|t| t.bytes().to_vec())))
                .collect();
            tiles.sort_unstable_by_key(|(at, _)| *at);
            tiles
        };
        let whole = left(14);
        assert!(whole.len() >= 6);
        assert!(left(1) == whole && left(3) == whole, "{mode:?}");
    }
}

#[test]
fn hostile_samples_and_settings_end_in_finite_pixels() {
    let points = [
        vec2(f32::NAN, 3.0),
        vec2(40.0, 50.0),
        vec2(1e30, 0.0),
        vec2(60.0, 55.0),
        vec2(-40.0, -90.0),
    ];
    for hostile in [f32::NAN, f32::INFINITY, -1.0, 1e30] {
        for mode in [
            BrushMode::Smudge { length: hostile },
            BrushMode::Blur { width: hostile },
            BrushMode::Clone { aligned: false, picture: false },
        ] {
            let left = rub(brush(mode), BEND, &points, vec2(hostile, 3.0), &places(), &waves());
            assert_eq!(left.pixel(199, 149), places().pixel(199, 149));
        }
    }
}

/// A brush of one color that picks up paint.
fn picking(amount: f32, length: f32) -> Brush {
    Brush {
        pickup: crate::paint::Pickup { amount, length, radius: 1.0 },
        ..brush(BrushMode::Paint)
    }
}

#[test]
fn a_brush_carries_paint_along_and_loses_it_as_fast_as_its_length_says() {
    let halves = layer(|x, _| if x < 100 { [255, 0, 0, 255] } else { [0, 0, 255, 255] });
    let along = [vec2(40.0, 70.0), vec2(180.0, 70.0)];
    let at = |length: f32, x: i32| {
        let after = rub(picking(1.0, length), Operator::None, &along, Vec2::ZERO, &halves, &FLAT);
        after.pixel(x, 70)
    };
    assert_eq!(at(0.0, 60), [255, 0, 0, 255]);
    let (short, long) = (at(0.0, 125), at(0.95, 125));
    assert!(
        long[0] > short[0].max(60) && long[3] == 255,
        "red is carried into blue: {long:?}, not {short:?}"
    );
    assert_eq!(
        at(1.0, 170)[0],
        255,
        "what was taken up first and is never renewed is carried to the end"
    );
}

#[test]
fn a_brush_that_picks_nothing_up_paints_as_plain_paint_does() {
    let ground = layer(|_, _| [200, 100, 50, 255]);
    let along = [vec2(40.0, 70.0), vec2(150.0, 90.0)];
    let plain = rub(picking(0.0, 0.5), Operator::None, &along, Vec2::ZERO, &ground, &FLAT);
    assert_eq!(plain.pixel(90, 79), [0, 0, 0, 255]);
    let half = rub(picking(0.5, 0.0), Operator::None, &[along[0]], Vec2::ZERO, &ground, &FLAT);
    assert_eq!(half.pixel(40, 70), [100, 50, 25, 255]);
}

#[test]
fn paint_that_is_taken_up_from_nothing_leaves_less_than_paint() {
    let half = rub(
        picking(0.5, 0.0),
        Operator::None,
        &[vec2(40.0, 70.0)],
        Vec2::ZERO,
        &TileGrid::default(),
        &FLAT,
    );
    let [_, _, _, a] = half.pixel(40, 70);
    assert!((127..=128).contains(&a), "{a}");
}

#[test]
fn what_is_picked_up_is_the_same_in_every_batch() {
    let ground = places();
    let points: Vec<Vec2> = (0..40)
        .map(|i| vec2(20.0 + 4.0 * i as f32, 70.0 + 10.0 * (0.3 * i as f32).sin()))
        .collect();
    let like = [Stroke::new(picking(0.7, 0.8), BEND, Color::BLACK, Vec::new())];
    let scene = waves();
    let drawn = |batch: usize| {
        let mut active =
            ActiveRetouching::new(&like, &[], ground.clone(), TileGrid::default(), &scene);
        let mut grid = ground.clone();
        for points in points.chunks(batch) {
            let samples = points.iter().map(|&at| Sample::at(at)).collect();
            active.draw(&[samples]).into_iter().for_each(|(at, tile)| grid.set(at, tile));
        }
        grid.to_straight_rgba(SIZE.rect())
    };
    assert!(drawn(1) == drawn(7) && drawn(7) == drawn(40));
}
