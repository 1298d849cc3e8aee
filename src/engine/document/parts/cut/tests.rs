//! Pieces make the same picture, and go with their parts.

use super::super::from_flats::tests as drawings;
use super::super::from_flats::tests::shares::{EYE, PUPIL, SIZE, at, color, draw};
use super::super::from_flats::{PartFor, parts_of_flats};
use crate::document::{
    Content, DerivedMask, Document, Group, Inflation, Layer, LayerId, LayerMask, OutlineSource,
    Part, PixelLayer, Progress, flatten,
};
use crate::math::srgb::Color;
use crate::math::{Affine2, Size, Vec2, vec2};
use crate::raster::{BlendMode, TileGrid};
use crate::shape::flats::color_distance::NEAR;
use std::sync::Arc;

fn shape_drawing(tiles: &TileGrid) -> Document {
    shape_drawing_on(SIZE, tiles)
}

fn shape_drawing_on(size: Size, tiles: &TileGrid) -> Document {
    let parts = parts_of_flats(tiles, "Drawing", Inflation::default(), PartFor::Color).parts;
    let pixels = PixelLayer { tiles: tiles.clone(), ..PixelLayer::default() };
    let drawing =
        Layer { clip_to_surface: false, ..Layer::new("Drawing", Content::Pixels(pixels)) };
    let document = Document { layers: vec![Arc::new(drawing)], ..Document::empty(size) };
    document.with_parts(parts.into_iter().map(Arc::new).collect())
}

fn cut(document: &Document) -> Document {
    let (next, group) = document.cut_by_parts(document.layers[0].id).unwrap();
    assert_eq!(next.layers[1].id, group);
    next
}

fn render(document: &Document) -> TileGrid {
    flatten(document, &Progress::default()).unwrap()
}

fn is_eye(part: &Part) -> bool {
    let Some(OutlineSource::Layer { color: Some(flat), .. }) = part.outline() else { return false };
    [EYE, PUPIL].iter().any(|eye| flat.color == color(*eye))
}

/// With the parts that are meant moved.
fn moved(document: &Document, by: Vec2, is_meant: impl Fn(&Part) -> bool) -> Document {
    let part = |part: &Arc<Part>| match is_meant(part) {
        true => Arc::new(Part { matrix: Affine2::from_translation(by), ..Part::clone(part) }),
        false => part.clone(),
    };
    document.with_parts(document.parts.list.iter().map(part).collect())
}

/// The largest difference of a channel between two pixels.
fn off(a: [u8; 4], b: [u8; 4]) -> i32 {
    a.into_iter().zip(b).map(|(a, b)| i32::from(a.abs_diff(b))).max().unwrap()
}

/// That of two pictures.
fn most_off(size: Size, a: &TileGrid, b: &TileGrid) -> i32 {
    let pixels = (0..size.height as i32).flat_map(|y| (0..size.width as i32).map(move |x| (x, y)));
    pixels.map(|(x, y)| off(a.pixel(x, y), b.pixel(x, y))).max().unwrap()
}

#[test]
fn the_pieces_make_the_same_picture() {
    for side in [1.0, 2.2] {
        let document = shape_drawing(&draw(side, at));
        let next = cut(&document);
        assert!(!next.layers[0].visible && next.parts.list == document.parts.list);
        let worst = most_off(SIZE, &render(&document), &render(&next));
        assert!(worst <= 1, "{worst}, edges of {side} px");
    }
}

#[test]
fn an_eye_that_is_moved_takes_its_paint_along_and_leaves_a_whole_face() {
    let next = cut(&shape_drawing(&draw(1.0, at)));
    let after = moved(&next, vec2(-50.0, 20.0), is_eye);
    let (before, after) = (render(&next), render(&after));
    for (x, y) in (50..72).flat_map(|y| (110..131).map(move |x| (x, y))) {
        let is_inside = (vec2(x as f32 + 0.5, y as f32 + 0.5) - vec2(120.0, 60.0)).length() < 11.0;
        assert!(
            !is_inside || after.pixel(x - 50, y + 20) == before.pixel(x, y),
            "({x}, {y}) goes along"
        );
    }
    let body = before.pixel(100, 100);
    for (x, y) in (44..78).flat_map(|y| (104..138).map(move |x| (x, y))) {
        let is_face =
            ((vec2(x as f32, y as f32) - vec2(100.0, 80.0)) / vec2(50.0, 43.0)).length() < 1.0;
        // So much a pixel of a flat color may be off it.
        let off = off(after.pixel(x, y), body);
        assert!(!is_face || off <= NEAR, "({x}, {y}): {:?} for {body:?}", after.pixel(x, y));
    }
}

#[test]
fn an_inked_eye_takes_its_ring_along_and_leaves_a_face_without_ink() {
    use drawings::{BELLY, HEAD, INK, SIZE, draw};
    let (face, eye) = (vec2(300.0, 200.0), vec2(330.0, 180.0));
    let tiles = draw(|p| {
        let is_brow = (p - vec2(330.0, 138.0)).abs().cmple(vec2(20.0, 2.0)).all();
        match (p.distance(eye), p.distance(face)) {
            (of_eye, _) if of_eye < 28.0 => Some(BELLY),
            (of_eye, of_face) if of_eye < 32.0 || is_brow || (118.0..122.0).contains(&of_face) => {
                Some(INK)
            }
            (_, of_face) => (of_face < 122.0).then_some(HEAD),
        }
    });
    let document = shape_drawing_on(SIZE, &tiles);
    assert_eq!(document.parts.list.len(), 2);
    let next = cut(&document);
    assert!(most_off(SIZE, &render(&document), &render(&next)) <= 1);
    let is_eye = |part: &Part| part.id == next.parts.list[1].id;
    let after = render(&moved(&next, vec2(-60.0, 50.0), is_eye));
    let [r, g, b] = HEAD.map(|v| v as u8);
    for (x, y) in (140..220).flat_map(|y| (290..370).map(move |x| (x, y))) {
        let away = (vec2(x as f32, y as f32) + 0.5).distance(eye);
        if away < 38.0 {
            let here = after.pixel(x, y);
            assert!(
                off(here, [r, g, b, 255]) <= NEAR,
                "({x}, {y}), {away} px from the eye's old middle: {here:?}"
            );
            let (there, was) = (after.pixel(x - 60, y + 50), tiles.pixel(x, y));
            assert!(off(there, was) <= 2, "({x}, {y}) goes along: {there:?} for {was:?}");
        }
    }
    // The brow is not of the eye.
    assert_eq!(after.pixel(330, 138), tiles.pixel(330, 138));
}

#[test]
fn three_colors_that_meet_in_a_pixel_lose_nothing() {
    let tiles = drawings::draw(|p| {
        let turn = (p - vec2(300.3, 200.6)).to_angle().to_degrees().rem_euclid(360.0);
        let colors = [[220.0, 60.0, 60.0], [60.0, 180.0, 60.0], [60.0, 80.0, 200.0]];
        (p.distance(vec2(300.0, 200.0)) < 120.0).then(|| colors[(turn / 120.0) as usize % 3])
    });
    let document = shape_drawing_on(drawings::SIZE, &tiles);
    assert_eq!(document.parts.list.len(), 3);
    assert!(most_off(drawings::SIZE, &render(&document), &render(&cut(&document))) <= 1);
}

#[test]
fn a_part_that_was_moved_before_takes_its_paint_to_where_it_is() {
    let document = shape_drawing(&draw(1.0, at));
    let (first, then) = (cut(&document), vec2(-50.0, 20.0));
    let after = cut(&moved(&document, then, is_eye));
    assert_eq!(most_off(SIZE, &render(&moved(&first, then, is_eye)), &render(&after)), 0);
}

#[test]
fn the_pieces_look_as_the_drawing_did() {
    let document = shape_drawing(&draw(1.0, at));
    let looks: [fn(&mut Layer); 4] = [
        |layer| layer.opacity = 0.5,
        |layer| layer.blend = BlendMode::Multiply,
        |layer| layer.clip_to_surface = true,
        |layer| layer.mask = Some(LayerMask::new(DerivedMask::Depth { from: 0.0, to: 1.0 })),
    ];
    for (i, look) in looks.into_iter().enumerate() {
        let document = document.with_layer(document.layers[0].id, look).unwrap();
        let off = most_off(SIZE, &render(&document), &render(&cut(&document)));
        assert!(off <= 1, "look {i}: {off}");
    }
}

#[test]
fn what_cannot_be_cut_is_told() {
    let document = shape_drawing(&draw(1.0, at));
    let part = &document.parts.list[0];
    assert_eq!(document.drawing_to_cut(part), Some(document.layers[0].id));
    assert_eq!(cut(&document).drawing_to_cut(part), None, "it is cut already");
    assert!(document.cut_by_parts(LayerId::fresh()).is_err());
    let bare = document.with_parts(Vec::new());
    assert!(bare.cut_by_parts(bare.layers[0].id).err().unwrap().contains("was made from"));
    let on =
        document.with_layer_on(document.layers[0].id, Some(&document.parts.list[0].id)).unwrap();
    assert!(on.cut_by_parts(on.layers[0].id).err().unwrap().contains("already"));
    let refused = |look: &dyn Fn(&mut Layer)| {
        let other = document.with_layer(document.layers[0].id, look).unwrap();
        other.cut_by_parts(other.layers[0].id).err().unwrap()
    };
    assert!(refused(&|layer| layer.visible = false).contains("hidden"));
    assert!(refused(&|layer| layer.content = Content::Fill(Color::BLACK)).contains("paint layer"));
    let group = Content::Group(Group { layers: document.layers.clone(), pass_through: false });
    let grouped =
        Document { layers: vec![Arc::new(Layer::new("Group", group))], ..document.clone() };
    assert!(grouped.cut_by_parts(document.layers[0].id).err().unwrap().contains("group"));
}
