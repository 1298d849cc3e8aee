//! Shares of mixed pixels add up, and leave no rims.

use crate::document::parts::from_flats::{PartFor, parts_of_flats};
use crate::document::{Content, Document, Inflation, Layer, PixelLayer};
use crate::math::srgb::Color;
use crate::math::{Size, Vec2, vec2};
use crate::raster::TileGrid;
use crate::shape::flats::shares::*;
use std::sync::Arc;

pub const SIZE: Size = Size::new(200, 160);
pub const BODY: [u8; 4] = [200, 120, 60, 255];
pub const WING: [u8; 4] = [90, 140, 60, 255];
/// White and the pupil's color mix to the body's, nearly.
pub const EYE: [u8; 4] = [255, 255, 255, 255];
pub const PUPIL: [u8; 4] = [145, 10, 0, 255];

/// A creature of four flats that touch, the nearest last.
pub fn at(p: Vec2) -> Pixel {
    let within = |center: Vec2, half: Vec2| ((p - center) / half).length() < 1.0;
    let shapes = [
        (PUPIL, within(vec2(122.0, 61.0), vec2(5.0, 6.0))),
        (EYE, within(vec2(120.0, 60.0), vec2(13.0, 14.0))),
        (BODY, within(vec2(100.0, 80.0), vec2(52.0, 45.0))),
        (WING, within(vec2(52.0, 50.0), vec2(44.0, 24.0))),
    ];
    shapes.into_iter().find(|(_, is_in)| *is_in).map_or([0; 4], |(color, _)| color)
}

/// Each pixel is the mean over a square about it: sides of 1 are anti-aliased, longer ones blurred.
pub fn draw(side: f32, at: impl Fn(Vec2) -> Pixel) -> TileGrid {
    const N: usize = 8;
    let mut rgba = Vec::with_capacity(SIZE.area() * 4);
    for i in 0..SIZE.area() {
        let center = vec2((i % SIZE.width as usize) as f32, (i / SIZE.width as usize) as f32) + 0.5;
        let mut sum = [0u32; 4];
        for k in 0..N * N {
            let step = (vec2((k % N) as f32, (k / N) as f32) + 0.5) / N as f32 - 0.5;
            let [r, g, b, a] = at(center + step * side);
            [r, g, b, a].into_iter().zip(&mut sum).for_each(|(v, sum)| *sum += u32::from(v));
        }
        let alpha = sum[3].max(1);
        rgba.extend(sum[..3].iter().map(|v| (v * 255 / alpha) as u8));
        rgba.push((sum[3] / (N * N) as u32) as u8);
    }
    TileGrid::from_straight_rgba(&rgba, SIZE.width as usize, SIZE.height as usize, 0, 0)
}

pub fn color([r, g, b, a]: Pixel) -> Color {
    Color { r, g, b, a }
}

#[test]
fn the_shares_of_a_pixel_add_up_to_what_is_painted_of_it() {
    for side in [1.0, 2.2] {
        let tiles = draw(side, at);
        let flats = Flats::of(&tiles, SIZE.rect(), &[]).unwrap();
        let shares = [BODY, WING, EYE, PUPIL].map(|own| flats.share_of(color(own), &[]));
        let mut wrong = 0;
        for (x, y) in (0..160).flat_map(|y| (0..200).map(move |x| (x, y))) {
            let sum: i32 = shares.iter().map(|share| i32::from(share.at(x, y))).sum();
            let painted = i32::from(tiles.pixel(x as i32, y as i32)[3]);
            // Where three meet, two of them take it all.
            wrong += i32::from((sum - painted).abs() > 24);
        }
        assert!(wrong <= 6, "{wrong} pixels, edges of {side} px");
    }
}

#[test]
fn only_areas_are_colors() {
    // A long straight edge half-way through its pixels is a long row of one mixed color.
    let halves = draw(1.0, |p| if p.x < 90.5 { BODY } else { WING });
    assert_eq!(Flats::of(&halves, SIZE.rect(), &[]).unwrap().colors().len(), 2);
    assert_eq!(Flats::of(&draw(2.2, at), SIZE.rect(), &[]).unwrap().colors().len(), 4);
}

#[test]
fn a_creature_of_flats_that_touch_has_no_rims_and_no_stray_points() {
    for side in [1.0, 2.2] {
        let tiles = draw(side, at);
        let parts = parts_of_flats(&tiles, "Flats", Inflation::default(), PartFor::Color).parts;
        assert_eq!(parts.len(), 4);
        let pixels = PixelLayer { tiles: tiles.clone(), ..PixelLayer::default() };
        let layers = vec![Arc::new(Layer::new("Flats", Content::Pixels(pixels)))];
        let flat = Document { layers, ..Document::empty(SIZE) };
        let surface = flat.with_parts(parts.into_iter().map(Arc::new).collect()).surface.unwrap();
        assert_eq!(surface.objects().count(), 4, "edges of {side} px: every part is one piece");
        let mut open = 0;
        for (x, y) in (2..158).flat_map(|y| (2..198).map(move |x| (x, y))) {
            let is_whole = tiles.pixel(x as i32, y as i32)[3] == 255;
            open += i32::from(is_whole && surface.coverage(x, y) < 250);
        }
        assert!(open <= 4, "{open} pixels between flats are not covered, edges of {side} px");
    }
}

#[test]
fn a_seam_between_two_flats_is_closed_and_a_gap_within_one_stays() {
    let seam =
        |p: Vec2| match (p.x * 0.2 + p.y < 80.0, (p.x * 0.2 + p.y - 80.0).abs() < 0.9, p.x > 150.0)
        {
            (_, true, false) => [0; 4],
            (is_above, _, _) if p.x < 150.0 => {
                if is_above {
                    BODY
                } else {
                    WING
                }
            }
            _ if (p.x - 170.0).abs() < 1.0 => [0; 4],
            _ => EYE,
        };
    let flats = Flats::of(&draw(1.0, seam), SIZE.rect(), &[]).unwrap();
    let whole = |x: usize, y: usize| {
        [BODY, WING, EYE]
            .iter()
            .map(|own| u32::from(flats.share_of(color(*own), &[]).at(x, y)))
            .sum::<u32>()
    };
    for x in [20, 60, 100, 130] {
        let y = 80 - x / 5;
        assert!((y - 3..y + 3).all(|y| whole(x, y) >= 250), "{x}");
    }
    assert!((168..172).any(|x| whole(x, 20) < 60), "a gap within one color is drawn");
}

#[test]
fn what_is_behind_goes_on_beneath_the_edge_of_what_lies_over_it() {
    let tiles = draw(1.0, at);
    let flats = Flats::of(&tiles, SIZE.rect(), &[]).unwrap();
    let (alone, beneath) = (
        flats.share_of(color(BODY), &[]),
        flats.share_of(color(BODY), &[color(EYE), color(PUPIL)]),
    );
    let edge: Vec<usize> = (100..112).filter(|x| (1..255).contains(&alone.at(*x, 66))).collect();
    assert!(!edge.is_empty() && edge.iter().all(|x| beneath.at(*x, 66) == 255), "{edge:?}");
    assert_eq!(beneath.at(120, 60), 0, "not beneath all of it");
}
