//! Areas of one color are told apart, and parts follow theirs.

use crate::document::parts::from_flats::{PartFor, parts_of_flats};
use crate::document::parts::{FlatColor, Inflation, OutlineSource, Part, PartKind};
use crate::document::{CanvasChange, Content, Document, Layer, LayerTransform, PixelLayer};
use crate::math::srgb::Color;
use crate::math::{Affine2, PlaneMap, Rect, Size, Vec2, vec2};
use crate::raster::{Resampling, TileGrid};
use crate::shape::flats::color_areas::*;
use crate::shape::flats::shares::Flats;
use std::sync::Arc;

const SIZE: Size = Size::new(200, 120);
const EYE: [u8; 3] = [250, 250, 250];
const BODY: [u8; 3] = [200, 120, 60];

/// Discs (middle, radius, color), the last in front, anti-aliased by counting.
fn tiles(discs: &[([f32; 2], f32, [u8; 3])]) -> TileGrid {
    let mut rgba = vec![0u8; SIZE.area() * 4];
    for (i, pixel) in rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let corner = vec2((i % SIZE.width as usize) as f32, (i / SIZE.width as usize) as f32);
        let mut sum = [0.0f32; 4];
        for k in 0..16 {
            let p = corner + vec2((k % 4) as f32 + 0.5, (k / 4) as f32 + 0.5) / 4.0;
            if let Some((.., color)) =
                discs.iter().rev().find(|(c, r, _)| p.distance(Vec2::from(*c)) < *r)
            {
                (0..3).for_each(|c| sum[c] += f32::from(color[c]));
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

fn content(tiles: TileGrid) -> Content {
    Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles })
}

fn face(eyes: &[([f32; 2], f32)]) -> TileGrid {
    let mut all = vec![([100.0, 60.0], 55.0, BODY)];
    all.extend(eyes.iter().map(|(at, r)| (*at, *r, EYE)));
    tiles(&all)
}

/// The same in a corner of a canvas in which areas of 64 px are small.
fn large(eyes: &[([f32; 2], f32)]) -> TileGrid {
    let mut tiles = face(eyes);
    let far = TileGrid::from_straight_rgba(&[BODY[0], BODY[1], BODY[2], 255], 1, 1, 799, 399);
    tiles.join(&far);
    tiles
}
const EYES: [([f32; 2], f32); 2] = [([80.0, 50.0], 10.0), ([122.0, 50.0], 12.0)];

/// A document of flats with a part for the eye at a point only.
fn one_eye(at: [f32; 2]) -> Document {
    let flat = FlatColor { color: Color::parse("#fafafa").unwrap(), at: Some(at.into()) };
    let outline = OutlineSource::Layer { layer: "Flats".into(), color: Some(flat) };
    let part = Part::new("eye", PartKind::Inflate { outline, inflation: Inflation::default() });
    let layers = vec![Arc::new(Layer::new("Flats", content(face(&EYES))))];
    Document { layers, ..Document::empty(SIZE) }.with_parts(vec![Arc::new(part)])
}

fn is_covered(document: &Document, x: usize, y: usize) -> bool {
    document.surface.as_ref().is_some_and(|surface| surface.coverage(x, y) > 0)
}

fn with_paint(document: &Document, tiles: TileGrid) -> Document {
    let id = document.layers[0].id;
    document.with_layer(id, |layer| layer.content = content(tiles.clone())).unwrap().reshaped()
}

#[test]
fn two_eyes_become_two_parts_and_the_body_has_no_place() {
    let tiles = face(&EYES);
    let parts = parts_of_flats(&tiles, "Flats", Inflation::default(), PartFor::Area).parts;
    let areas: Vec<Option<Vec2>> = parts.iter().map(Part::area_point).collect();
    assert_eq!(areas.len(), 3);
    assert_eq!(areas[0], None, "the body lies behind");
    for (eye, _) in EYES {
        assert!(
            areas.iter().flatten().any(|at| at.distance(eye.into()) < 1.5),
            "{eye:?}: {areas:?}"
        );
    }
    assert_eq!(
        parts_of_flats(&tiles, "Flats", Inflation::default(), PartFor::Color).parts.len(),
        2
    );
    let layers = vec![Arc::new(Layer::new("Flats", content(tiles)))];
    let shaped = Document { layers, ..Document::empty(SIZE) }
        .with_parts(parts.into_iter().map(Arc::new).collect());
    assert_eq!(shaped.surface.as_ref().unwrap().objects().count(), 3);
    assert!(shaped.parts.lost.is_empty());
}

#[test]
fn a_glint_does_not_bring_the_eye_before_its_pupil() {
    const PUPIL: [u8; 3] = [40, 30, 50];
    let with_glints = |pupil: f32, glint: f32| {
        let eye = |x: f32| {
            [([x, 50.0], 14.0, EYE), ([x + 2.0, 52.0], pupil, PUPIL), ([x + 1.5, 51.5], glint, EYE)]
        };
        let discs: Vec<_> =
            [([100.0, 60.0], 55.0, BODY)].into_iter().chain(eye(75.0)).chain(eye(125.0)).collect();
        tiles(&discs)
    };
    let colors = |each: PartFor, (pupil, glint): (f32, f32), right_of: f32| -> Vec<[u8; 3]> {
        let parts =
            parts_of_flats(&with_glints(pupil, glint), "Flats", Inflation::default(), each).parts;
        let flats = parts.iter().filter_map(|part| match part.outline() {
            Some(OutlineSource::Layer { color, .. }) => *color,
            _ => None,
        });
        let here = flats.filter(|flat| flat.at.is_none_or(|at| at.x > right_of));
        here.map(|FlatColor { color, .. }| [color.r, color.g, color.b]).collect()
    };
    assert_eq!(colors(PartFor::Color, (5.0, 2.0), 0.0), [BODY, EYE, PUPIL]);
    assert_eq!(
        colors(PartFor::Area, (5.0, 2.0), 100.0),
        [BODY, EYE, PUPIL],
        "the glint makes no part"
    );
    assert_eq!(colors(PartFor::Area, (9.0, 3.0), 100.0), [BODY, EYE, PUPIL, EYE], "it does");
}

#[test]
fn a_part_takes_only_the_area_around_its_point() {
    let document = one_eye([82.0, 48.0]);
    assert!(
        is_covered(&document, 80, 50)
            && !is_covered(&document, 122, 50)
            && !is_covered(&document, 100, 100)
    );
    assert!(document.parts.lost.is_empty());
}

#[test]
fn shares_of_all_places_add_up_to_that_of_the_color() {
    let tiles = face(&EYES);
    let flats = Flats::of(&tiles, tiles.bounds(), &[]).unwrap();
    let color = Color::parse("#fafafa").unwrap();
    let (areas, share) = (ColorAreas::of(&flats, color), flats.share_of(color, &[]));
    let both = areas.shares(&areas.large(), &share);
    assert_eq!(both.len(), 2);
    for (x, y) in (0..share.height()).flat_map(|y| (0..share.width()).map(move |x| (x, y))) {
        assert_eq!(both.iter().map(|own| own.at(x, y)).sum::<u8>(), share.at(x, y), "({x}, {y})");
    }
}

#[test]
fn a_narrow_passage_separates_places_and_a_wide_one_joins_them() {
    let bridge = |height: usize, width: usize| {
        let mut rgba = vec![0u8; width * 120 * 4];
        for (i, pixel) in rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
            let (x, y) = (i % width, i / width);
            let is_square =
                (20..80).contains(&y) && ((20..80).contains(&x) || (110..170).contains(&x));
            if is_square || ((80..110).contains(&x) && (48..48 + height).contains(&y)) {
                *pixel = [EYE[0], EYE[1], EYE[2], 255];
            }
        }
        let tiles = TileGrid::from_straight_rgba(&rgba, width, 120, 0, 0);
        let areas = ColorAreas::of(
            &Flats::of(&tiles, Rect::new(0, 0, width as i32, 120), &[]).unwrap(),
            Color::parse("#fafafa").unwrap(),
        );
        areas.large().len()
    };
    assert_eq!([0, 1, 2, 8].map(|height| bridge(height, 300)), [2, 2, 2, 1]);
    assert_eq!(
        [0, 1, 2, 8].map(|height| bridge(height, 200)),
        [2, 1, 1, 1],
        "in pixel art every pixel is meant"
    );
}

#[test]
fn a_part_follows_its_place_when_the_flats_are_painted_again() {
    let document = one_eye([80.0, 50.0]);
    let larger = with_paint(&document, face(&[([80.0, 50.0], 18.0), EYES[1]]));
    assert!(
        is_covered(&larger, 66, 50)
            && !is_covered(&document, 66, 50)
            && !is_covered(&larger, 122, 50)
    );
    assert_eq!(larger.note_of_lost(Some(&document)), None);
    // The eye was painted elsewhere: the nearest is taken, and the user is told once.
    let elsewhere = with_paint(&document, face(&[([70.0, 80.0], 10.0), ([160.0, 60.0], 8.0)]));
    assert!(is_covered(&elsewhere, 70, 80) && !is_covered(&elsewhere, 160, 60));
    assert_eq!(elsewhere.parts.lost, ["eye"]);
    let note = elsewhere.note_of_lost(Some(&document)).unwrap();
    assert!(note.contains("“eye”") && note.contains("nearest"), "{note}");
    assert_eq!(elsewhere.note_of_lost(Some(&elsewhere)), None);
    let back = with_paint(&elsewhere, face(&EYES));
    assert!(back.parts.lost.is_empty() && is_covered(&back, 80, 50));
    // Without the color there is no part.
    assert!(with_paint(&document, face(&[])).surface.is_none());
}

#[test]
fn a_layer_that_is_moved_takes_the_places_along() {
    let document = one_eye([80.0, 50.0]);
    let moved = PlaneMap::affine([1.0, 0.0, 0.0, 1.0, 42.0, 0.0]).unwrap();
    let change = |layer: &mut Layer| {
        layer.transform = Some(LayerTransform::of_map(&moved, Resampling::default(), SIZE).unwrap())
    };
    let next = document.with_layer(document.layers[0].id, change).unwrap().reshaped();
    // Without that it would be the left eye, which stands where the right one was.
    assert_eq!(next.parts.list[0].area_point(), Some(vec2(122.0, 50.0)));
    assert!(
        is_covered(&next, 122, 50) && !is_covered(&next, 164, 50) && next.parts.lost.is_empty()
    );
}

#[test]
fn areas_go_with_the_canvas() {
    let document = one_eye([80.0, 50.0]);
    let change = CanvasChange::crop(SIZE, Rect::new(30, 10, 180, 110)).unwrap();
    let cropped = document.on_other_canvas(&change).unwrap();
    assert!(
        is_covered(&cropped, 50, 40) && !is_covered(&cropped, 92, 40),
        "{:?}",
        cropped.parts.list
    );
    assert!(cropped.parts.lost.is_empty());
}

#[test]
fn a_place_is_one_of_the_flats_however_its_part_is_moved_and_scaled() {
    let document = one_eye([80.0, 50.0]);
    let part = Part::clone(&document.parts.list[0]);
    let turned = Affine2::from_scale_angle_translation(vec2(2.0, 2.0), 0.6, vec2(20.0, -120.0));
    let moved = document.with_parts(vec![Arc::new(Part { matrix: turned, ..part })]);
    let at = turned.transform_point2(vec2(80.0, 50.0));
    assert!(is_covered(&moved, at.x as usize, at.y as usize) && moved.parts.lost.is_empty());
    let other = turned.transform_point2(vec2(122.0, 50.0));
    assert!(!is_covered(&moved, other.x as usize, other.y as usize), "{other}");
    // Image size.
    for factor in [0.5, 2.0] {
        let scaled = document.scaled(factor).unwrap().reshaped();
        let seen =
            |x: f32, y: f32| is_covered(&scaled, (x * factor) as usize, (y * factor) as usize);
        assert!(seen(80.0, 50.0) && !seen(122.0, 50.0), "{factor}: {:?}", scaled.parts.list);
        assert!(scaled.parts.lost.is_empty());
    }
}

#[test]
fn what_is_too_small_for_a_part_is_told() {
    let specks = [([40.0, 60.0], 3.6), ([160.0, 60.0], 3.6), ([80.0, 50.0], 10.0)];
    let note = |each: PartFor, eyes: &[([f32; 2], f32)]| {
        let made = parts_of_flats(&large(eyes), "Flats", Inflation::default(), each);
        (made.parts.len(), made.note())
    };
    let (parts, told) = note(PartFor::Area, &specks);
    assert_eq!(parts, 2);
    assert!(told.unwrap().starts_with("2 areas are left without a part"));
    assert_eq!(note(PartFor::Color, &specks), (2, None), "they are of the eye's part");
    assert!(
        note(PartFor::Color, &specks[..1])
            .1
            .unwrap()
            .starts_with("One area is left without a part")
    );
    assert_eq!(note(PartFor::Area, &EYES).1, None);
}

#[test]
fn any_point_finds_a_place_or_none() {
    let tiles = face(&EYES);
    let flats = Flats::of(&tiles, tiles.bounds(), &[]).unwrap();
    let areas = ColorAreas::of(&flats, Color::parse("#fafafa").unwrap());
    for at in [Vec2::NAN, Vec2::INFINITY, vec2(-1e9, 1e9), vec2(1e30, 0.0)] {
        let found = areas.nearest(at);
        assert!(
            found.is_none_or(|(area, is_beside)| is_beside && areas.pixels(area) > 0),
            "{at}: {found:?}"
        );
    }
    let none = ColorAreas::of(&flats, Color::parse("#010203").unwrap());
    assert!(none.large().is_empty() && none.nearest(vec2(3.0, 3.0)).is_none());
}
