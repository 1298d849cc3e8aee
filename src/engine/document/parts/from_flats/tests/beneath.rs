//! A color goes on beneath what nearer parts cover inside of it, and holes stay.

use super::shares::{BODY, EYE, PUPIL, SIZE, WING, at, color, draw};
use crate::document::parts::from_flats::{PartFor, parts_of_flats};
use crate::document::{Content, Document, Inflation, Layer, OutlineSource, Part, PixelLayer};
use crate::math::srgb::Color;
use crate::math::{Affine2, Vec2, vec2};
use crate::shape::flats::beneath::*;
use crate::shape::flats::shares::Flats;
use crate::shape::flats::shares::Pixel;
use std::sync::Arc;

/// A body of four flats around its eye, and a hole through it in which something stands.
fn ringed_color(p: Vec2) -> Pixel {
    let hole = (p - vec2(60.0, 90.0)).length();
    match at(p) {
        BODY if hole < 6.0 => EYE,
        BODY if hole < 12.0 => [0; 4],
        color => color,
    }
}

#[test]
fn a_color_goes_on_beneath_nearer_colors_inside_of_it_and_a_hole_stays() {
    for side in [1.0, 2.2] {
        let flats = Flats::of(&draw(side, ringed_color), SIZE.rect(), &[]).unwrap();
        let mut share = flats.share_of(color(BODY), &[]);
        fill_beneath(&mut share, &flats, &[color(EYE), color(PUPIL)], &[color(WING)]);
        for (x, y) in (52..80).flat_map(|y| (103..137).map(move |x| (x, y))) {
            assert_eq!(share.at(x, y), 255, "({x}, {y}), beneath the eye, edges of {side} px");
        }
        assert_eq!((share.at(60, 81), share.at(60, 90)), (0, 0), "the hole and what stands in it");
        assert_eq!((share.at(40, 45), share.at(2, 2)), (0, 0), "a wing at the side, and nothing");
    }
}

#[test]
fn what_is_farther_away_shows_through_a_hole() {
    let flats = Flats::of(&draw(1.0, at), SIZE.rect(), &[]).unwrap();
    let own = flats.share_of(color(BODY), &[]);
    let mut share = own.clone();
    fill_beneath(&mut share, &flats, &[color(PUPIL)], &[color(EYE)]);
    assert!(share == own, "the eye's white is behind the body");
    // A glint that is no part is paint on the eye, and the eye without a part of its own stays a
    // hole.
    fill_beneath(&mut share, &flats, &[color(PUPIL)], &[]);
    assert_eq!(share.at(112, 56), 255);
    let mut share = own.clone();
    fill_beneath(&mut share, &flats, &[color(WING)], &[]);
    assert!(share == own);
}

#[test]
fn a_glint_is_no_hole() {
    let glinting = |radius: f32| {
        let glint = |p: Vec2| (p - vec2(80.0, 80.0)).length() < radius;
        let flats = Flats::of(&draw(1.0, |p| if glint(p) { EYE } else { at(p) }), SIZE.rect(), &[])
            .unwrap();
        let mut share = flats.share_of(color(BODY), &[]);
        fill_beneath(&mut share, &flats, &[], &[color(EYE)]);
        share.at(80, 80)
    };
    assert_eq!((glinting(1.5), glinting(6.0), glinting(10.0)), (255, 255, 0));
}

#[test]
fn a_belly_that_a_wing_hides_in_part_lies_on_the_body() {
    // The eye as a large belly, and a wing across it and out of the body.
    let winged = |p: Vec2| match p {
        p if (p - vec2(60.0, 84.0)).abs().cmplt(vec2(44.0, 10.0)).all() => WING,
        p if (p - vec2(110.0, 84.0)).length() < 24.0 => EYE,
        p => at(p),
    };
    let flats = Flats::of(&draw(1.0, winged), SIZE.rect(), &[]).unwrap();
    let shares = |nearer: &[Pixel]| {
        let nearer: Vec<Color> = nearer.iter().copied().map(color).collect();
        let mut share = flats.share_of(color(BODY), &nearer);
        fill_beneath(&mut share, &flats, &nearer, &[]);
        [share.at(115, 84), share.at(98, 84), share.at(20, 84)]
    };
    assert_eq!(
        shares(&[EYE, WING]),
        [255, 0, 0],
        "on the belly, on the wing before it, on the wing outside"
    );
    assert_eq!(
        shares(&[WING, EYE]),
        [0, 0, 0],
        "an area before the wing may go on beyond the body"
    );
}

#[test]
fn a_face_is_whole_beneath_an_eye_that_is_moved_or_hidden() {
    let tiles = draw(1.0, at);
    let parts = parts_of_flats(&tiles, "Flats", Inflation::default(), PartFor::Color).parts;
    let pixels = PixelLayer { tiles: tiles.clone(), ..PixelLayer::default() };
    let layers = vec![Arc::new(Layer::new("Flats", Content::Pixels(pixels)))];
    let document = Document { layers, ..Document::empty(SIZE) };
    let is_eye = |part: &Part| {
        let Some(OutlineSource::Layer { color: Some(flat), .. }) = part.outline() else {
            return false;
        };
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
