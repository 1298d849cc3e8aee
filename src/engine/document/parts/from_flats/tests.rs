//! Drawings as people make them: with ink, shading, specks of compression, and marks too small for
//! parts.

mod areas;
mod beneath;
pub mod shares;

use super::*;
use crate::document::{Content, Document, Layer, PixelLayer};
use crate::math::srgb::Color;
use crate::math::{Size, Vec2};
use crate::surface::Surface;
use std::sync::Arc;

pub const SIZE: Size = Size::new(600, 400);
pub const INK: [f32; 3] = [30.0, 20.0, 20.0];
pub const HEAD: [f32; 3] = [220.0, 140.0, 60.0];
pub const BELLY: [f32; 3] = [240.0, 230.0, 210.0];

/// What is seen at a point, anti-aliased by counting.
pub fn draw(at: impl Fn(Vec2) -> Option<[f32; 3]>) -> TileGrid {
    let mut rgba = vec![0u8; SIZE.area() * 4];
    for (i, pixel) in rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let corner = vec2((i % SIZE.width as usize) as f32, (i / SIZE.width as usize) as f32);
        let mut sum = [0.0f32; 4];
        for k in 0..16 {
            if let Some(color) = at(corner + vec2((k % 4) as f32 + 0.5, (k / 4) as f32 + 0.5) / 4.0)
            {
                (0..3).for_each(|c| sum[c] += color[c]);
                sum[3] += 1.0;
            }
        }
        if sum[3] > 0.0 {
            (0..3).for_each(|c| pixel[c] = (sum[c] / sum[3]).round() as u8);
            pixel[3] = (sum[3] / 16.0 * 255.0).round() as u8;
        }
    }
    TileGrid::from_straight_rgba(&rgba, SIZE.width as usize, SIZE.height as usize, 0, 0)
}

/// Discs (middle, radius, color), the last in front, each with a line of 4 px around it.
pub fn draw_inked(discs: &'static [([f32; 2], f32, [f32; 3])]) -> TileGrid {
    draw(|p| {
        let front = discs
            .iter()
            .rev()
            .find(|(middle, radius, _)| p.distance(Vec2::from(*middle)) < radius + 2.0)?;
        Some(if p.distance(Vec2::from(front.0)) > front.1 - 2.0 { INK } else { front.2 })
    })
}

fn parts(tiles: &TileGrid, each: PartFor) -> FlatParts {
    parts_of_flats(tiles, "Flats", Inflation::default(), each)
}

fn surface(tiles: &TileGrid, parts: FlatParts) -> Arc<Surface> {
    let pixels = PixelLayer { tiles: tiles.clone(), ..PixelLayer::default() };
    let layers = vec![Arc::new(Layer::new("Flats", Content::Pixels(pixels)))];
    let flat = Document { layers, ..Document::empty(SIZE) };
    flat.with_parts(parts.parts.into_iter().map(Arc::new).collect()).surface.unwrap()
}

fn colors(parts: &FlatParts) -> Vec<Color> {
    let color = |part: &Part| match part.outline() {
        Some(OutlineSource::Layer { color: Some(flat), .. }) => Some(flat.color),
        _ => None,
    };
    parts.parts.iter().filter_map(color).collect()
}

fn color([r, g, b]: [f32; 3]) -> Color {
    Color { r: r as u8, g: g as u8, b: b as u8, a: 255 }
}

/// Opaque pixels of the drawing that the surface does not cover wholly.
fn open(tiles: &TileGrid, surface: &Surface) -> usize {
    let pixels =
        (0..SIZE.height as usize).flat_map(|y| (0..SIZE.width as usize).map(move |x| (x, y)));
    pixels
        .filter(|(x, y)| {
            tiles.pixel(*x as i32, *y as i32)[3] == 255 && surface.coverage(*x, *y) < 250
        })
        .count()
}

#[test]
fn ink_belongs_to_what_it_runs_along() {
    let tiles = draw_inked(&[([230.0, 220.0], 120.0, HEAD), ([360.0, 200.0], 90.0, BELLY)]);
    let made = parts(&tiles, PartFor::Color);
    assert_eq!((colors(&made), made.note()), (vec![color(HEAD), color(BELLY)], None));
    let surface = surface(&tiles, made);
    assert_eq!(surface.objects().count(), 2);
    assert!(open(&tiles, &surface) <= 4, "{} pixels", open(&tiles, &surface));
    // Both sides of the line at the left of the disc in front, whose middle is at x = 270.
    let of = |x: i32| surface.objects().at(x, 200);
    assert!(of(268) != of(273) && of(268) == of(230) && of(273) == of(360));
}

#[test]
fn a_line_keeps_two_places_of_one_color_apart() {
    let tiles = draw_inked(&[([230.0, 220.0], 120.0, HEAD), ([360.0, 200.0], 90.0, HEAD)]);
    assert_eq!(parts(&tiles, PartFor::Color).parts.len(), 1);
    let made = parts(&tiles, PartFor::Area);
    assert_eq!(made.parts.len(), 2);
    let surface = surface(&tiles, made);
    assert_eq!(surface.objects().count(), 2);
    assert!(open(&tiles, &surface) <= 4, "{} pixels", open(&tiles, &surface));
}

#[test]
fn a_color_that_is_shaded_is_one_part_and_two_tones_with_an_edge_are_two() {
    let shaded = draw(|p| {
        let (away, light) = (p.distance(vec2(300.0, 200.0)), 1.1 - p.x / 1200.0);
        (away < 150.0).then(|| HEAD.map(|v| v * light))
    });
    assert_eq!(parts(&shaded, PartFor::Color).parts.len(), 1);
    let two_tones = draw(|p| {
        let light = if p.x < 300.0 { 1.0 } else { 0.9 };
        (p.distance(vec2(300.0, 200.0)) < 150.0).then(|| HEAD.map(|v| v * light))
    });
    assert_eq!(parts(&two_tones, PartFor::Color).parts.len(), 2);
}

#[test]
fn what_is_too_small_for_a_part_is_no_hole() {
    let door = draw(|p| match p.distance(vec2(320.0, 210.0)) {
        away if away < 3.0 => Some([250.0, 240.0, 40.0]),
        _ => (p.distance(vec2(300.0, 200.0)) < 150.0).then_some(HEAD),
    });
    let made = parts(&door, PartFor::Color);
    assert!(made.note().unwrap().starts_with("One area is left without a part"));
    let with = surface(&door, made);
    let plain = draw(|p| (p.distance(vec2(300.0, 200.0)) < 150.0).then_some(HEAD));
    let without = surface(&plain, parts(&plain, PartFor::Color));
    let off = |x: usize, y: usize| with.normal(x, y).distance(without.normal(x, y));
    assert!((310..330).all(|x| (200..220).all(|y| off(x, y) < 1e-3)));
}

#[test]
fn specks_of_compression_change_no_part() {
    let clean = draw(|p| match p.distance(vec2(340.0, 220.0)) {
        away if away < 60.0 => Some(BELLY),
        _ => (p.distance(vec2(300.0, 200.0)) < 150.0).then_some(HEAD),
    });
    let noise = |x: i32, y: i32, c: usize| {
        // Blocks of 2 × 2 px, as chroma is stored.
        let here = crate::math::hash::unit(7, (x / 2 + 1000 * (y / 2)) as u32, c as u32);
        if here < 0.06 { 24.0 * (here / 0.06 - 0.5) } else { 0.0 }
    };
    let mut rgba = vec![0u8; SIZE.area() * 4];
    for (i, pixel) in rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let (x, y) = ((i % SIZE.width as usize) as i32, (i / SIZE.width as usize) as i32);
        let here = clean.pixel(x, y);
        *pixel = here;
        if here[3] == 255 {
            (0..3).for_each(|c| pixel[c] = (f32::from(here[c]) + noise(x, y, c)) as u8);
        }
    }
    let noisy =
        TileGrid::from_straight_rgba(&rgba, SIZE.width as usize, SIZE.height as usize, 0, 0);
    let made = parts(&noisy, PartFor::Area);
    assert_eq!((made.parts.len(), made.note()), (2, None));
    let surface = surface(&noisy, made);
    assert!(open(&noisy, &surface) <= 4, "{} pixels", open(&noisy, &surface));
}

#[test]
fn a_line_that_is_asked_for_is_a_part() {
    let tiles = draw_inked(&[([230.0, 220.0], 120.0, HEAD)]);
    let outline = OutlineSource::Layer { layer: "Flats".into(), color: Some(color(INK).into()) };
    let part = Part::new("line", PartKind::Inflate { outline, inflation: Inflation::default() });
    let surface = surface(&tiles, FlatParts::of_one(part));
    assert!(surface.coverage(230, 100) > 250 && surface.coverage(230, 220) == 0);
}

#[test]
fn paint_that_is_not_flat_is_told() {
    let cloudy = draw(|p| {
        let grain = |c: u32| {
            120.0 + 100.0 * crate::math::hash::unit(3, (p.x as u32) + 999 * (p.y as u32), c)
        };
        (p.distance(vec2(300.0, 200.0)) < 150.0).then(|| [grain(1), grain(2), grain(3)])
    });
    let note = parts(&cloudy, PartFor::Color).note().unwrap();
    assert!(note.starts_with("Only 0 %") && note.contains("one part for all"), "{note}");
}

#[test]
fn ink_around_an_eye_is_no_part() {
    let tiles = draw_inked(&[([300.0, 200.0], 120.0, HEAD), ([330.0, 180.0], 30.0, BELLY)]);
    let made = parts(&tiles, PartFor::Color);
    assert_eq!((colors(&made), made.note()), (vec![color(HEAD), color(BELLY)], None));
}
