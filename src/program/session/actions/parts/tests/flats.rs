//! Stories of flats that become parts, are split, cut and left out.

use super::{ids, open, shown_document, snowman, tell};
use crate::document::parts::PartKind;
use crate::document::{Content, Document, Layer, Progress, flatten};
use crate::math::{Size, vec2};
use crate::raster::Picture;
use crate::session::actions::placing::of_picture;
use std::path::Path;

#[test]
fn each_flat_color_becomes_a_part() {
    let mut session = open(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"tube","flats":true}"#);
    assert_eq!(ids(&session), ["part-1", "part-2"]);
    let at =
        |x: f32, y: f32| shown_document(&session).part_at(vec2(x, y)).map(|part| part.id.clone());
    let (head, body) = (at(48.0, 36.0), at(48.0, 90.0));
    assert!(head.is_some() && body.is_some() && head != body, "{head:?} {body:?}");
    assert_eq!(at(3.0, 3.0), None);
}

/// Two discs of one color, apart from each other.
fn pair() -> Document {
    let inside = |x: f32, y: f32, cx: f32, r: f32| (x - cx).hypot(y - 40.0) < r;
    let texel = |i: usize| {
        let (x, y) = ((i % 120) as f32 + 0.5, (i / 120) as f32 + 0.5);
        if inside(x, y, 32.0, 20.0) || inside(x, y, 88.0, 25.0) {
            [200, 120, 60, 255]
        } else {
            [0; 4]
        }
    };
    of_picture(
        "pair.png",
        Picture::srgb8(Size::new(120, 80), (0..120 * 80).map(texel).collect()).unwrap(),
    )
}

#[test]
fn each_place_of_a_color_becomes_a_part_at_once() {
    let mut session = open(pair());
    tell(
        &mut session,
        r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":"areas"}"#,
    );
    assert_eq!(session.notes, Vec::<String>::new());
    assert_eq!(ids(&session), ["part-1", "part-2"]);
    assert!(shown_document(&session).parts.list.iter().all(|part| part.area_point().is_some()));
}

#[test]
fn a_drawing_that_is_cut_goes_with_its_parts_and_comes_back_by_undo() {
    let mut session = open(pair());
    tell(&mut session, r#"{"in":"part","do":"cut","layer":"0"}"#);
    assert!(session.notes.pop().unwrap().contains("into pixels"), "it is a placed picture yet");
    tell(&mut session, r#"{"in":"layer","do":"bake","layer":"0"}"#);
    tell(&mut session, r#"{"in":"part","do":"cut","layer":"0"}"#);
    assert!(session.notes.pop().unwrap().contains("was made from"), "it has no part yet");
    tell(
        &mut session,
        r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":"areas"}"#,
    );
    let before = shown_document(&session).clone();
    tell(&mut session, r#"{"in":"part","do":"cut","layer":"0"}"#);
    assert_eq!(session.notes, Vec::<String>::new());
    let group = shown_document(&session).layers[1].content.group().unwrap();
    let on = |layer: &std::sync::Arc<Layer>| layer.on.as_ref().map(|on| on.part.to_string());
    assert_eq!(group.layers.iter().filter_map(on).collect::<Vec<_>>(), ids(&session));
    assert_eq!(session.active().unwrap().active_layer, Some(shown_document(&session).layers[1].id));
    assert!(
        !shown_document(&session).layers[0].visible
            && shown_document(&session).parts.list == before.parts.list
    );
    tell(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert!(
        shown_document(&session).layers[0].visible
            && shown_document(&session).layers.len() == before.layers.len()
    );
}

#[test]
fn a_part_is_split_by_place_with_its_touches_and_the_user_is_told_of_a_place_that_goes() {
    let mut session = open(pair());
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":true}"#);
    assert_eq!(ids(&session), ["part-1"]);
    let touch = |x: i32| format!(r#"{{"at":[{x},40],"normal":[0.5,0,0.8]}}"#);
    let both = format!(
        r#"{{"id":"t","kind":"touches","on":"part-1","touches":[{},{}]}}"#,
        touch(30),
        touch(85)
    );
    let value = serde_json::from_str(&both).unwrap();
    let read = super::super::read_part(
        Path::new("t"),
        &value,
        shown_document(&session),
        &super::super::Budget::default(),
    )
    .unwrap();
    let touched = shown_document(&session).with_part(read);
    assert!(session.active_mut().unwrap().commit("Touch", touched));
    tell(&mut session, r#"{"in":"part","do":"split","part":"part-1"}"#);
    assert_eq!(session.notes, Vec::<String>::new());
    assert_eq!(ids(&session), ["part-1", "t", "part-2", "part-3"]);
    let list = &shown_document(&session).parts.list;
    let (of_large, of_small) = (list[0].area_point().unwrap(), list[2].area_point().unwrap());
    assert!(of_large.x > 80.0 && of_small.x < 40.0, "{of_large} {of_small}");
    for (index, body, x) in [(1, "part-1", 85.0), (3, "part-2", 30.0)] {
        let PartKind::Touches { on, touches } = &list[index].kind else {
            panic!("{:?}", list[index])
        };
        assert_eq!((on.as_str(), touches.len(), touches[0].at.x), (body, 1, x));
    }
    // It has one place now.
    tell(&mut session, r#"{"in":"part","do":"split","part":"part-1"}"#);
    assert!(session.notes.pop().unwrap().contains("everywhere"));
    // The larger disc is erased: its part takes the nearest area of the color.
    let layer = shown_document(&session).layers[0].id;
    let other = pair();
    let left = |mut tiles: crate::raster::TileGrid| {
        let mut rgba = vec![0u8; 120 * 80 * 4];
        for (i, pixel) in
            rgba.as_chunks_mut::<4>().0.iter_mut().enumerate().filter(|(i, _)| i % 120 < 60)
        {
            *pixel = tiles.pixel((i % 120) as i32, (i / 120) as i32);
        }
        tiles = crate::raster::TileGrid::from_straight_rgba(&rgba, 120, 80, 0, 0);
        tiles
    };
    let tiles = left(flatten(&other, &Progress::default()).unwrap());
    let content =
        Content::Pixels(crate::document::PixelLayer { file: String::new(), x: 0, y: 0, tiles });
    let erased = shown_document(&session)
        .with_layer(layer, |layer| layer.content = content.clone())
        .unwrap();
    assert!(session.active_mut().unwrap().commit("Erase", erased));
    session.keep();
    assert!(session.notes.iter().any(|note| note.contains("nearest")), "{:?}", session.notes);
}

#[test]
fn a_flat_ground_is_taken_off_and_lies_beneath_and_the_picture_stays() {
    let mut session = open(snowman(true));
    let before = flatten(shown_document(&session), &Progress::default()).unwrap();
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}"#);
    let names: Vec<&str> =
        shown_document(&session).layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["Ground", "snowman", "Light"]);
    assert!(matches!(shown_document(&session).layers[1].content, Content::Pixels(_)));
    assert_eq!(shown_document(&session).surface.as_ref().unwrap().coverage(2, 2), 0);
    tell(
        &mut session,
        r#"{"in":"layer","do":"set","layer":"2","to":{"do":"visible","on":false},"done":true}"#,
    );
    let after = flatten(shown_document(&session), &Progress::default()).unwrap();
    for (x, y) in (0..128).flat_map(|y| (0..96).map(move |x| (x, y))) {
        let (a, b) = (before.pixel(x, y), after.pixel(x, y));
        assert!(a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 3), "{x} {y}: {a:?} {b:?}");
    }
}

#[test]
fn a_shape_stays_when_the_drawing_that_outlines_it_is_merged_or_flattened() {
    for merge in
        [r#"{"in":"layer","do":"flatten"}"#, r#"{"in":"layer","do":"merge down","layer":"1"}"#]
    {
        let mut session = open(snowman(false));
        tell(
            &mut session,
            r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":true}"#,
        );
        let before = shown_document(&session).clone();
        tell(&mut session, merge);
        assert_eq!(session.notes, Vec::<String>::new(), "{merge}");
        let after = shown_document(&session);
        assert!(after.layers.len() < before.layers.len(), "{merge}");
        let (old, new) = (before.surface.as_ref().unwrap(), after.surface.as_ref().unwrap());
        for (x, y) in (0..128).flat_map(|y| (0..96).map(move |x| (x, y))) {
            assert_eq!(old.coverage(x, y), new.coverage(x, y), "{merge}: {x}, {y}");
            assert_eq!(old.normal(x, y), new.normal(x, y), "{merge}: {x}, {y}");
        }
    }
}

#[test]
fn nothing_is_merged_onto_a_layer_that_only_changes_what_is_below() {
    let mut session = open(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":true}"#);
    tell(&mut session, r#"{"in":"layer","do":"add","kind":"paint"}"#);
    let before = shown_document(&session).layers.len();
    tell(&mut session, r#"{"in":"layer","do":"merge down","layer":"2"}"#);
    assert!(session.said.pop().unwrap().contains("only changes what lies below"));
    tell(&mut session, r#"{"in":"layer","do":"merge down","layer":["1","2"]}"#);
    assert!(session.said.pop().unwrap().contains("only changes what lies below"));
    assert_eq!(shown_document(&session).layers.len(), before);
}
