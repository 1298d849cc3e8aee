//! Shares of mixed pixels, and what lies beneath nearer colours.

use super::*;
use crate::document::parts::flats::{PartFor, colors_of, parts_of_flats};
use crate::document::{Content, Document, Inflation, Layer, OutlineSource, Part, PixelLayer};
use crate::math::{Affine2, Vec2, vec2};
use std::sync::Arc;

const SIZE: Size = Size::new(200, 160);
const BODY: [u8; 4] = [200, 120, 60, 255];
const WING: [u8; 4] = [90, 140, 60, 255];
/// White and the pupil's colour mix to the body's, nearly.
const EYE: [u8; 4] = [255, 255, 255, 255];
const PUPIL: [u8; 4] = [145, 10, 0, 255];

/// A creature of four flats that touch, the nearest last.
fn at(p: Vec2) -> Pixel {
    let within = |centre: Vec2, half: Vec2| ((p - centre) / half).length() < 1.0;
    let shapes = [
        (PUPIL, within(vec2(122.0, 61.0), vec2(5.0, 6.0))),
        (EYE, within(vec2(120.0, 60.0), vec2(13.0, 14.0))),
        (BODY, within(vec2(100.0, 80.0), vec2(52.0, 45.0))),
        (WING, within(vec2(52.0, 50.0), vec2(44.0, 24.0))),
    ];
    shapes.into_iter().find(|(_, is_in)| *is_in).map_or([0; 4], |(color, _)| color)
}
/// Each pixel is the mean over a square about it: sides of 1 are anti-aliased, longer ones blurred.
fn drawn(side: f32, at: impl Fn(Vec2) -> Pixel) -> TileGrid {
    const N: usize = 8;
    let mut rgba = Vec::with_capacity(SIZE.area() * 4);
    for i in 0..SIZE.area() {
        let centre = vec2((i % SIZE.width as usize) as f32, (i / SIZE.width as usize) as f32) + 0.5;
        let mut sum = [0u32; 4];
        for k in 0..N * N {
            let step = (vec2((k % N) as f32, (k / N) as f32) + 0.5) / N as f32 - 0.5;
            let [r, g, b, a] = at(centre + step * side);
            [r, g, b, a].into_iter().zip(&mut sum).for_each(|(v, sum)| *sum += u32::from(v));
        }
        let alpha = sum[3].max(1);
        rgba.extend(sum[..3].iter().map(|v| (v * 255 / alpha) as u8));
        rgba.push((sum[3] / (N * N) as u32) as u8);
    }
    TileGrid::from_straight_rgba(&rgba, SIZE.width as usize, SIZE.height as usize, 0, 0)
}
fn color([r, g, b, a]: Pixel) -> Color {
    Color { r, g, b, a }
}

#[test]
fn the_shares_of_a_pixel_add_up_to_what_is_painted_of_it() {
    for side in [1.0, 2.2] {
        let tiles = drawn(side, at);
        let flats = Flats::of(&tiles, SIZE.rect());
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
fn only_areas_are_colours() {
    // A long straight edge half-way through its pixels is a long row of one mixed colour.
    let halves = drawn(1.0, |p| if p.x < 90.5 { BODY } else { WING });
    assert_eq!(colors_of(&halves, SIZE.rect()).len(), 2);
    assert_eq!(colors_of(&drawn(2.2, at), SIZE.rect()).len(), 4);
}
#[test]
fn a_creature_of_flats_that_touch_has_no_rims_and_no_stray_points() {
    for side in [1.0, 2.2] {
        let tiles = drawn(side, at);
        let parts = parts_of_flats(&tiles, "Flats", Inflation::default(), PartFor::Color);
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
    let seam = |p: Vec2| match (p.x * 0.2 + p.y < 80.0, (p.x * 0.2 + p.y - 80.0).abs() < 0.9, p.x > 150.0) {
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
    let flats = Flats::of(&drawn(1.0, seam), SIZE.rect());
    let whole = |x: usize, y: usize| {
        [BODY, WING, EYE].iter().map(|own| u32::from(flats.share_of(color(*own), &[]).at(x, y))).sum::<u32>()
    };
    for x in [20, 60, 100, 130] {
        let y = 80 - x / 5;
        assert!((y - 3..y + 3).all(|y| whole(x, y) >= 250), "{x}");
    }
    assert!((168..172).any(|x| whole(x, 20) < 60), "a gap within one colour is drawn");
}
#[test]
fn what_is_behind_goes_on_beneath_the_edge_of_what_lies_over_it() {
    let tiles = drawn(1.0, at);
    let flats = Flats::of(&tiles, SIZE.rect());
    let (alone, beneath) = (flats.share_of(color(BODY), &[]), flats.share_of(color(BODY), &[color(EYE), color(PUPIL)]));
    let edge: Vec<usize> = (100..112).filter(|x| (1..255).contains(&alone.at(*x, 66))).collect();
    assert!(!edge.is_empty() && edge.iter().all(|x| beneath.at(*x, 66) == 255), "{edge:?}");
    assert_eq!(beneath.at(120, 60), 0, "not beneath all of it");
}

/// A body of four flats around its eye, and a hole through it in which something stands.
fn ringed(p: Vec2) -> Pixel {
    let hole = (p - vec2(60.0, 90.0)).length();
    match at(p) {
        BODY if hole < 6.0 => EYE,
        BODY if hole < 12.0 => [0; 4],
        color => color,
    }
}

#[test]
fn a_colour_goes_on_beneath_nearer_colours_inside_of_it_and_a_hole_stays() {
    for side in [1.0, 2.2] {
        let flats = Flats::of(&drawn(side, ringed), SIZE.rect());
        let mut share = flats.share_of(color(BODY), &[]);
        flats.fill_beneath(&mut share, &[color(EYE), color(PUPIL)], &[color(WING)]);
        for (x, y) in (52..80).flat_map(|y| (103..137).map(move |x| (x, y))) {
            assert_eq!(share.at(x, y), 255, "({x}, {y}), beneath the eye, edges of {side} px");
        }
        assert_eq!((share.at(60, 81), share.at(60, 90)), (0, 0), "the hole and what stands in it");
        assert_eq!((share.at(40, 45), share.at(2, 2)), (0, 0), "a wing at the side, and nothing");
    }
}
#[test]
fn what_is_farther_away_shows_through_a_hole() {
    let flats = Flats::of(&drawn(1.0, at), SIZE.rect());
    let own = flats.share_of(color(BODY), &[]);
    let mut share = own.clone();
    flats.fill_beneath(&mut share, &[color(PUPIL)], &[color(EYE)]);
    assert!(share == own, "the eye's white is behind the body");
    // A glint that is no part is paint on the eye, and the eye without a part of its own stays a hole.
    flats.fill_beneath(&mut share, &[color(PUPIL)], &[]);
    assert_eq!(share.at(112, 56), 255);
    let mut share = own.clone();
    flats.fill_beneath(&mut share, &[color(WING)], &[]);
    assert!(share == own);
}
#[test]
fn a_glint_too_small_for_a_part_is_no_hole() {
    let glinting = |radius: f32| {
        let glint = move |p: Vec2| (p - vec2(80.0, 80.0)).length() < radius;
        let flats = Flats::of(&drawn(1.0, |p| if glint(p) { EYE } else { at(p) }), SIZE.rect());
        let mut share = flats.share_of(color(BODY), &[]);
        flats.fill_beneath(&mut share, &[], &[color(EYE)]);
        share.at(80, 80)
    };
    assert_eq!((glinting(1.5), glinting(6.0)), (255, 0));
}
#[test]
fn a_face_is_whole_beneath_an_eye_that_is_moved_or_hidden() {
    let tiles = drawn(1.0, at);
    let parts = parts_of_flats(&tiles, "Flats", Inflation::default(), PartFor::Color);
    let pixels = PixelLayer { tiles: tiles.clone(), ..PixelLayer::default() };
    let layers = vec![Arc::new(Layer::new("Flats", Content::Pixels(pixels)))];
    let document = Document { layers, ..Document::empty(SIZE) };
    let is_eye = |part: &Part| {
        let Some(OutlineSource::Layer { color: Some(flat), .. }) = part.outline() else { return false };
        [EYE, PUPIL].iter().any(|eye| flat.color == color(*eye))
    };
    let with = |edit: &dyn Fn(&mut Part)| {
        let mut parts = parts.clone();
        parts.iter_mut().filter(|part| is_eye(part)).for_each(edit);
        document.with_parts(parts.into_iter().map(Arc::new).collect()).surface.unwrap()
    };
    let hidden = with(&|part| part.visible = false);
    let moved = with(&|part| part.matrix = Affine2::from_translation(vec2(-40.0, 20.0)));
    for (x, y) in (52..80).flat_map(|y| (103..137).map(move |x| (x, y))) {
        assert_eq!((hidden.coverage(x, y), moved.coverage(x, y)), (255, 255), "({x}, {y})");
        let off = hidden.normal(x, y).distance(moved.normal(x, y));
        assert!(off < 0.02, "({x}, {y}): {off}");
    }
}
