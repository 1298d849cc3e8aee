use super::*;
use crate::shape::flats::color_distance::NEAR;

/// A red disc with a dark ring around it and a dark line through its middle, on nothing, and a
/// green half; all of it smooth.
fn draw(ink: [f32; 3]) -> TileGrid {
    let (red, green) = ([200.0f32, 60.0, 40.0], [60.0f32, 170.0, 90.0]);
    let pixel = |i: usize| {
        let (x, y) = ((i % 120) as f32 + 0.5, (i / 120) as f32 + 0.5);
        let away = ((x - 60.0).powi(2) + (y - 60.0).powi(2)).sqrt();
        let whole = (50.5 - away).max(0.0).min(1.0);
        let on_ring = (away - 48.3).max(0.0).min(1.0);
        let through = (1.2 - (x - 60.3 + 0.2 * (y - 60.0)).abs()).max(0.0).min(1.0);
        let c = on_ring.max(through);
        let flat = if x + 0.2 * (y - 60.0) < 60.3 { red } else { green };
        let mixed = |k: usize| (flat[k] * (1.0 - c) + ink[k] * c).round() as u8;
        [mixed(0), mixed(1), mixed(2), (255.0 * whole).round() as u8]
    };
    let rgba: Vec<u8> = (0..120 * 120).flat_map(pixel).collect();
    TileGrid::from_straight_rgba(&rgba, 120, 120, 0, 0)
}

fn together(lifted: &LiftedInk, x: i32, y: i32) -> [i32; 4] {
    let (flat, line) = (lifted.flats.pixel(x, y), lifted.lines.pixel(x, y));
    std::array::from_fn(|k| {
        i32::from(line[k]) + (i32::from(flat[k]) * (255 - i32::from(line[3])) + 127) / 255
    })
}

#[test]
fn lines_over_what_is_left_are_the_drawing() {
    for ink in [[30.0, 22.0, 28.0], [20.0, 40.0, 150.0]] {
        let drawing = draw(ink);
        let lifted = LiftedInk::of(&drawing);
        assert!(!lifted.is_empty());
        for (x, y) in pixels((120, 120)) {
            let (x, y) = (x as i32, y as i32);
            let (was, is) = (drawing.pixel(x, y), together(&lifted, x, y));
            let off = (0..4).map(|k| (is[k] - i32::from(was[k])).abs()).max().unwrap();
            assert!(off <= 1, "{x} {y}: {is:?} for {was:?}");
        }
    }
}

#[test]
fn nothing_of_the_ink_is_left_in_the_flats_and_its_borders_have_one_tone() {
    for ink in [[30.0f32, 22.0, 28.0], [20.0, 40.0, 150.0]] {
        let lifted = LiftedInk::of(&draw(ink));
        let (red, green) = ([200, 60, 40], [60, 170, 90]);
        let mut soft = 0;
        for (x, y) in pixels((120, 120)) {
            let flat = lifted.flats.pixel(x as i32, y as i32);
            let away =
                |color: [i32; 3]| (0..3).map(|k| (i32::from(flat[k]) - color[k]).abs()).max();
            let least = away(red).min(away(green)).unwrap();
            // Pixels nearer than this to a flat are of it.
            assert!(flat[3] == 0 || least <= NEAR, "{x} {y}: {flat:?}");
            let line = lifted.lines.pixel(x as i32, y as i32);
            if (30..255).contains(&line[3]) {
                soft += 1;
                for k in 0..3 {
                    let tone = f32::from(line[k]) * 255.0 / f32::from(line[3]);
                    assert!((tone - ink[k]).abs() < 14.0, "{x} {y} {k}: {line:?}");
                }
            }
        }
        assert!(soft > 300, "the borders are soft: {soft}");
    }
}

#[test]
fn bright_pixels_around_an_outline_are_of_its_ink() {
    // As a sharp filter leaves them where it makes a drawing smaller.
    let (smooth, mut rgba) = (draw([30.0, 22.0, 28.0]), Vec::new());
    let bright_at = |x: i32, y: i32| {
        let v = 235 + ((7 * x + 13 * y) % 20) as u8;
        [v, 255, v, 255]
    };
    let is_bright = |x: i32, y: i32| {
        smooth.pixel(x, y)[3] == 0
            && [(1, 0), (-1, 0), (0, 1), (0, -1)]
                .iter()
                .any(|(dx, dy)| smooth.pixel(x + dx, y + dy)[3] > 0)
    };
    for (x, y) in pixels((120, 120)) {
        let (x, y) = (x as i32, y as i32);
        let [r, g, b, a] = smooth.pixel(x, y).map(u32::from);
        let straight = |c: u32| ((c * 255 + a / 2) / a.max(1)) as u8;
        let pixel = [straight(r), straight(g), straight(b), a as u8];
        let bright = bright_at(x, y);
        rgba.extend(if is_bright(x, y) { bright } else { pixel });
    }
    let drawing = TileGrid::from_straight_rgba(&rgba, 120, 120, 0, 0);
    let lifted = LiftedInk::of(&drawing);
    let mut bright = 0;
    for (x, y) in pixels((120, 120)) {
        let (x, y) = (x as i32, y as i32);
        if is_bright(x, y) {
            bright += 1;
            assert_eq!(lifted.flats.pixel(x, y), [0; 4], "{x} {y}: nothing is left to be lit");
            assert_eq!(lifted.lines.pixel(x, y), bright_at(x, y), "{x} {y}");
        }
    }
    assert!(bright > 200, "{bright}");
}

#[test]
fn a_drawing_without_lines_keeps_all_of_it() {
    let flat: Vec<u8> = (0..64 * 64)
        .flat_map(|i| if i % 64 < 30 { [9, 9, 9, 255] } else { [200, 90, 9, 255] })
        .collect();
    let drawing = TileGrid::from_straight_rgba(&flat, 64, 64, 0, 0);
    let lifted = LiftedInk::of(&drawing);
    assert!(lifted.is_empty() && lifted.flats.ptr_eq(&drawing));
}

/// Two dark lines with red and green beyond them, and a narrow gap between the lines.
fn with_a_gap() -> TileGrid {
    let pixel = |i: usize| match i % 80 {
        0..30 => [200, 60, 40, 255],
        30..34 | 36..40 => [30, 22, 28, 255],
        34..36 => [0; 4],
        _ => [60, 170, 90, 255],
    };
    let rgba: Vec<u8> = (0..80 * 300).flat_map(pixel).collect();
    TileGrid::from_straight_rgba(&rgba, 80, 300, 0, 0)
}

#[test]
fn a_gap_between_two_lines_stays_open() {
    let lifted = LiftedInk::of(&with_a_gap());
    assert_eq!(lifted.lines.pixel(32, 60), [30, 22, 28, 255]);
    for x in [34, 35] {
        assert_eq!(together(&lifted, x, 60), [0; 4], "{x}");
    }
}

#[test]
fn where_lines_run_into_each_other_they_are_ink_and_a_dark_area_is_none() {
    // Two eyes that touch, a line between them, and a dark pupil in one of them.
    let (side, ink) = (400usize, [30u8, 22, 28, 255]);
    let within = |x: f32, y: f32, at: [f32; 2], radius: f32| {
        ((x - at[0]).powi(2) + (y - at[1]).powi(2)).sqrt() < radius
    };
    let pixel = |i: usize| {
        let (x, y) = ((i % side) as f32 + 0.5, (i / side) as f32 + 0.5);
        let is_in = |radius: f32| {
            within(x, y, [134.0, 200.0], radius) || within(x, y, [266.0, 200.0], radius)
        };
        match () {
            _ if within(x, y, [134.0, 200.0], 20.0) => ink,
            _ if is_in(64.0) => [240, 230, 200, 255],
            _ if is_in(68.0) => ink,
            _ if (198.0..202.0).contains(&x) && (100.0..300.0).contains(&y) => ink,
            _ if within(x, y, [200.0, 200.0], 180.0) => [180, 120, 80, 255],
            _ if within(x, y, [200.0, 200.0], 184.0) => ink,
            _ => [0; 4],
        }
    };
    let rgba: Vec<u8> = (0..side * side).flat_map(pixel).collect();
    let lifted = LiftedInk::of(&TileGrid::from_straight_rgba(&rgba, side, side, 0, 0));
    assert_eq!(lifted.flats.pixel(134, 200), ink, "the pupil is an area");
    for y in 160..240 {
        let flat = lifted.flats.pixel(200, y);
        assert!(flat[0] > 100, "{y}: {flat:?} where the eyes touch");
    }
}

#[test]
fn bold_lines_are_ink_and_a_strap_is_an_area() {
    // A face of four colors with lines of 2 % of its size; and a disc with a strap as wide.
    let side = 400;
    let ink = [30u8, 22, 28, 255];
    let quarters = |i: usize| {
        let (x, y) = ((i % side) as f32 - 199.5, (i / side) as f32 - 199.5);
        let away = x.hypot(y);
        match (away < 190.0, away > 182.0 || x.abs().min(y.abs()) < 4.0) {
            (false, _) => [0; 4],
            (true, true) => ink,
            (true, false) if x < 0.0 && y < 0.0 => [200, 60, 40, 255],
            (true, false) if x < 0.0 => [60, 170, 90, 255],
            (true, false) if y < 0.0 => [240, 220, 180, 255],
            (true, false) => [90, 120, 220, 255],
        }
    };
    let strap = |i: usize| {
        let (x, y) = ((i % side) as f32 - 199.5, (i / side) as f32 - 199.5);
        match x.hypot(y) < 190.0 {
            false => [0; 4],
            true if x.abs() < 4.0 => ink,
            true if x < 0.0 => [200, 60, 40, 255],
            true => [60, 170, 90, 255],
        }
    };
    let lift = |pixel: &dyn Fn(usize) -> [u8; 4]| {
        let rgba: Vec<u8> = (0..side * side).flat_map(pixel).collect();
        LiftedInk::of(&TileGrid::from_straight_rgba(&rgba, side, side, 0, 0))
    };
    let face = lift(&quarters);
    for at in [(200, 60), (60, 200), (200, 200), (200, 12)] {
        assert_eq!(face.lines.pixel(at.0, at.1), ink, "{at:?}");
        assert!(face.flats.pixel(at.0, at.1)[..3] != ink[..3], "{at:?}");
    }
    assert!(lift(&strap).is_empty());
}
