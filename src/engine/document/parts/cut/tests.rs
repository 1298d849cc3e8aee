//! Pieces make the same picture, and go with their parts.

use super::super::flats::{PartFor, parts_of_flats};
use super::super::near::NEAR;
use super::super::shares::tests::{EYE, PUPIL, SIZE, at, color, drawn};
use crate::document::{
    Content, Document, Inflation, Layer, LayerId, OutlineSource, Part, PixelLayer, Progress, flatten,
};
use crate::math::{Affine2, vec2};
use crate::raster::TileGrid;
use std::sync::Arc;

fn shaped(tiles: &TileGrid) -> Document {
    let parts = parts_of_flats(tiles, "Drawing", Inflation::default(), PartFor::Color).parts;
    let pixels = PixelLayer { tiles: tiles.clone(), ..PixelLayer::default() };
    let drawing = Layer { clip_to_surface: false, ..Layer::new("Drawing", Content::Pixels(pixels)) };
    let document = Document { layers: vec![Arc::new(drawing)], ..Document::empty(SIZE) };
    document.with_parts(parts.into_iter().map(Arc::new).collect())
}
fn cut(document: &Document) -> Document {
    let (next, group) = document.cut_by_parts(document.layers[0].id).unwrap();
    assert_eq!(next.layers[1].id, group);
    next
}
fn seen(document: &Document) -> TileGrid {
    flatten(document, &Progress::default()).unwrap()
}
fn is_eye(part: &Part) -> bool {
    let Some(OutlineSource::Layer { color: Some(flat), .. }) = part.outline() else { return false };
    [EYE, PUPIL].iter().any(|eye| flat.color == color(*eye))
}

#[test]
fn the_pieces_make_the_same_picture() {
    for side in [1.0, 2.2] {
        let document = shaped(&drawn(side, at));
        let next = cut(&document);
        assert!(!next.layers[0].visible && next.parts.list == document.parts.list);
        let (before, after) = (seen(&document), seen(&next));
        let mut worst = 0;
        for (x, y) in (0..160).flat_map(|y| (0..200).map(move |x| (x, y))) {
            let off = before.pixel(x, y).into_iter().zip(after.pixel(x, y)).map(|(a, b)| a.abs_diff(b)).max().unwrap();
            worst = worst.max(off);
        }
        assert!(worst <= 1, "{worst}, edges of {side} px");
    }
}
#[test]
fn an_eye_that_is_moved_takes_its_paint_along_and_leaves_a_whole_face() {
    let next = cut(&shaped(&drawn(1.0, at)));
    let moved = |part: &Arc<Part>| match is_eye(part) {
        true => Arc::new(Part { matrix: Affine2::from_translation(vec2(-50.0, 20.0)), ..Part::clone(part) }),
        false => part.clone(),
    };
    let after = next.with_parts(next.parts.list.iter().map(moved).collect());
    let (before, after) = (seen(&next), seen(&after));
    for (x, y) in (50..72).flat_map(|y| (110..131).map(move |x| (x, y))) {
        let is_inside = (vec2(x as f32 + 0.5, y as f32 + 0.5) - vec2(120.0, 60.0)).length() < 11.0;
        assert!(!is_inside || after.pixel(x - 50, y + 20) == before.pixel(x, y), "({x}, {y}) goes along");
    }
    let body = before.pixel(100, 100);
    for (x, y) in (44..78).flat_map(|y| (104..138).map(move |x| (x, y))) {
        let is_face = ((vec2(x as f32, y as f32) - vec2(100.0, 80.0)) / vec2(50.0, 43.0)).length() < 1.0;
        let off = after.pixel(x, y).into_iter().zip(body).map(|(a, b)| a.abs_diff(b)).max().unwrap();
        // So much a pixel of a flat colour may be off it.
        assert!(!is_face || i32::from(off) <= NEAR, "({x}, {y}): {:?} for {body:?}", after.pixel(x, y));
    }
}
#[test]
fn what_cannot_be_cut_is_told() {
    let document = shaped(&drawn(1.0, at));
    assert!(document.cut_by_parts(LayerId::fresh()).is_err());
    let bare = document.with_parts(Vec::new());
    assert!(bare.cut_by_parts(bare.layers[0].id).err().unwrap().contains("outline"));
    let on = document.with_layer_on(document.layers[0].id, Some(&document.parts.list[0].id)).unwrap();
    assert!(on.cut_by_parts(on.layers[0].id).err().unwrap().contains("already"));
}
