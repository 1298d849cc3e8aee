//! Stories of parts, replayed.

use crate::document::parts::PartKind;
use crate::document::{Content, Document, Layer, Progress, flatten};
use crate::math::Size;
use crate::math::vec2;
use crate::raster::Picture;
use crate::session::actions::placing::of_picture;
use crate::session::{OpenDocument, Session};
use std::path::Path;

/// Two flat discs that touch, with soft edges, on transparency or on white.
fn snowman(on_white: bool) -> Document {
    let size = Size::new(96, 128);
    let inside = |x: f32, y: f32, cx: f32, cy: f32, r: f32| {
        (r + 0.5 - ((x - cx).powi(2) + (y - cy).powi(2)).sqrt()).max(0.0).min(1.0)
    };
    let texel = |i: usize| {
        let (x, y) = ((i % 96) as f32 + 0.5, (i / 96) as f32 + 0.5);
        let (head, body) = (inside(x, y, 48.0, 36.0, 24.0), inside(x, y, 48.0, 84.0, 36.0));
        let mixed = |head_c: f32, body_c: f32| {
            let beneath = if on_white { body_c * body + 255.0 * (1.0 - body) } else { body_c };
            (head_c * head + beneath * (1.0 - head)).round() as u8
        };
        let alpha = if on_white { 255 } else { (255.0 * head.max(body)).round() as u8 };
        [mixed(220.0, 60.0), mixed(160.0, 90.0), mixed(80.0, 200.0), alpha]
    };
    of_picture("snowman.png", Picture::srgb8(size, (0..size.area()).map(texel).collect()).unwrap())
}
fn opened(document: Document) -> Session {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("snowman.png", document, None));
    session
}
fn tell(session: &mut Session, line: &str) {
    session.replay(Path::new("story"), line).unwrap_or_else(|error| panic!("{line}: {error}"));
}
fn shown(session: &Session) -> &Document {
    session.active().unwrap().shown()
}
fn ids(session: &Session) -> Vec<&str> {
    shown(session).parts.list.iter().map(|part| part.id.as_str()).collect()
}
fn puff(session: &Session, id: &str) -> f32 {
    match &shown(session).parts.part(id).unwrap().kind {
        PartKind::Inflate { inflation, .. } => inflation.puff,
        other => panic!("{}", other.name()),
    }
}

#[test]
fn a_drawing_gets_a_shape_and_a_base_that_is_lit_in_one_step() {
    let mut session = opened(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}"#);
    assert_eq!(session.notes, Vec::<String>::new());
    let document = shown(&session);
    assert_eq!(document.layers.iter().map(|layer| layer.name.as_str()).collect::<Vec<_>>(), ["snowman", "Base"]);
    let surface = document.surface.as_ref().unwrap();
    assert!(surface.normal(48, 84).z > 0.98 && surface.normal(70, 84).x > 0.3);
    let lit = flatten(document, &Progress::default()).unwrap();
    let (light, dark) = (lit.pixel(34, 66), lit.pixel(66, 106));
    assert!(light[2] > dark[2] + 40, "lit from above left: {light:?} {dark:?}");
    assert_eq!(session.active().unwrap().part.as_deref(), Some("part-1"));
    tell(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert!(shown(&session).surface.is_none() && shown(&session).layers.len() == 1);
}
#[test]
fn a_drawing_that_is_one_part_goes_where_the_part_goes() {
    let mut session = opened(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}"#);
    let before = flatten(shown(&session), &Progress::default()).unwrap();
    let moved = r#"{"in":"part","do":"set","part":{"id":"part-1","name":"snowman","kind":"inflate","outline":
        {"layer":"snowman"},"matrix":[1,0,0,1,6,-4]},"done":true}"#;
    tell(&mut session, &moved.replace('\n', " "));
    assert_eq!(session.notes, Vec::<String>::new());
    let after = flatten(shown(&session), &Progress::default()).unwrap();
    for (x, y) in [(48, 36), (40, 30), (60, 90), (30, 100), (48, 84)] {
        let (a, b) = (before.pixel(x, y), after.pixel(x + 6, y - 4));
        assert!(a[3] == 255 && a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 2), "{x} {y}: {a:?} {b:?}");
    }
    assert_eq!(shown(&session).layers[0].on.as_ref().map(|home| &*home.part), Some("part-1"));
}
#[test]
fn each_flat_colour_becomes_a_part() {
    let mut session = opened(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"tube","flats":true}"#);
    assert_eq!(ids(&session), ["part-1", "part-2"]);
    let at = |x: f32, y: f32| shown(&session).part_at(vec2(x, y)).map(|part| part.id.clone());
    let (head, body) = (at(48.0, 36.0), at(48.0, 90.0));
    assert!(head.is_some() && body.is_some() && head != body, "{head:?} {body:?}");
    assert_eq!(at(3.0, 3.0), None);
}
/// Two discs of one colour, apart from each other.
fn pair() -> Document {
    let inside = |x: f32, y: f32, cx: f32, r: f32| (x - cx).hypot(y - 40.0) < r;
    let texel = |i: usize| {
        let (x, y) = ((i % 120) as f32 + 0.5, (i / 120) as f32 + 0.5);
        if inside(x, y, 32.0, 20.0) || inside(x, y, 88.0, 25.0) { [200, 120, 60, 255] } else { [0; 4] }
    };
    of_picture("pair.png", Picture::srgb8(Size::new(120, 80), (0..120 * 80).map(texel).collect()).unwrap())
}
#[test]
fn each_place_of_a_colour_becomes_a_part_at_once() {
    let mut session = opened(pair());
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":"places"}"#);
    assert_eq!(session.notes, Vec::<String>::new());
    assert_eq!(ids(&session), ["part-1", "part-2"]);
    assert!(shown(&session).parts.list.iter().all(|part| part.place().is_some()));
}
#[test]
fn a_drawing_that_is_cut_goes_with_its_parts_and_comes_back_by_undo() {
    let mut session = opened(pair());
    tell(&mut session, r#"{"in":"part","do":"cut","layer":"0"}"#);
    assert!(session.notes.pop().unwrap().contains("bake"), "it is a placed picture yet");
    tell(&mut session, r#"{"in":"layer","do":"bake","layer":"0"}"#);
    tell(&mut session, r#"{"in":"part","do":"cut","layer":"0"}"#);
    assert!(session.notes.pop().unwrap().contains("outline"), "it has no part yet");
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":"places"}"#);
    let before = shown(&session).clone();
    tell(&mut session, r#"{"in":"part","do":"cut","layer":"0"}"#);
    assert_eq!(session.notes, Vec::<String>::new());
    let group = shown(&session).layers[1].content.group().unwrap();
    let on = |layer: &std::sync::Arc<Layer>| layer.on.as_ref().map(|on| on.part.to_string());
    assert_eq!(group.layers.iter().filter_map(on).collect::<Vec<_>>(), ids(&session));
    assert_eq!(session.active().unwrap().selected, Some(shown(&session).layers[1].id));
    assert!(!shown(&session).layers[0].visible && shown(&session).parts.list == before.parts.list);
    tell(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert!(shown(&session).layers[0].visible && shown(&session).layers.len() == before.layers.len());
}
#[test]
fn a_part_is_split_by_place_with_its_touches_and_the_user_is_told_of_a_place_that_goes() {
    let mut session = opened(pair());
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":true}"#);
    assert_eq!(ids(&session), ["part-1"]);
    let touch = |x: i32| format!(r#"{{"at":[{x},40],"normal":[0.5,0,0.8]}}"#);
    let both = format!(r#"{{"id":"t","kind":"touches","on":"part-1","touches":[{},{}]}}"#, touch(30), touch(85));
    let value = serde_json::from_str(&both).unwrap();
    let read = super::read_part(Path::new("t"), &value, shown(&session), &super::Budget::default()).unwrap();
    let touched = shown(&session).with_part(read);
    assert!(session.active_mut().unwrap().commit("Touch", touched));
    tell(&mut session, r#"{"in":"part","do":"split","part":"part-1"}"#);
    assert_eq!(session.notes, Vec::<String>::new());
    assert_eq!(ids(&session), ["part-1", "t", "part-2", "part-3"]);
    let list = &shown(&session).parts.list;
    let (of_large, of_small) = (list[0].place().unwrap(), list[2].place().unwrap());
    assert!(of_large.x > 80.0 && of_small.x < 40.0, "{of_large} {of_small}");
    for (index, body, x) in [(1, "part-1", 85.0), (3, "part-2", 30.0)] {
        let PartKind::Touches { on, touches } = &list[index].kind else { panic!("{:?}", list[index]) };
        assert_eq!((on.as_str(), touches.len(), touches[0].at.x), (body, 1, x));
    }
    // It has one place now.
    tell(&mut session, r#"{"in":"part","do":"split","part":"part-1"}"#);
    assert!(session.notes.pop().unwrap().contains("wherever it is"));
    // The larger disc is erased: its part takes the nearest area of the colour.
    let layer = shown(&session).layers[0].id;
    let other = pair();
    let left = |mut tiles: crate::raster::TileGrid| {
        let mut rgba = vec![0u8; 120 * 80 * 4];
        for (i, pixel) in rgba.as_chunks_mut::<4>().0.iter_mut().enumerate().filter(|(i, _)| i % 120 < 60) {
            *pixel = tiles.pixel((i % 120) as i32, (i / 120) as i32);
        }
        tiles = crate::raster::TileGrid::from_straight_rgba(&rgba, 120, 80, 0, 0);
        tiles
    };
    let tiles = left(flatten(&other, &Progress::default()).unwrap());
    let content = Content::Pixels(crate::document::PixelLayer { file: String::new(), x: 0, y: 0, tiles });
    let erased = shown(&session).with_layer(layer, |layer| layer.content = content.clone()).unwrap();
    assert!(session.active_mut().unwrap().commit("Erase", erased));
    session.keep();
    assert!(session.notes.iter().any(|note| note.contains("nearest")), "{:?}", session.notes);
}
#[test]
fn a_flat_ground_is_taken_off_and_lies_beneath_and_the_picture_stays() {
    let mut session = opened(snowman(true));
    let before = flatten(shown(&session), &Progress::default()).unwrap();
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}"#);
    let names: Vec<&str> = shown(&session).layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["Ground", "snowman", "Base"]);
    assert!(matches!(shown(&session).layers[1].content, Content::Pixels(_)));
    assert_eq!(shown(&session).surface.as_ref().unwrap().coverage(2, 2), 0);
    tell(&mut session, r#"{"in":"layer","do":"set","layer":"2","to":{"do":"visible","on":false},"done":true}"#);
    let after = flatten(shown(&session), &Progress::default()).unwrap();
    for (x, y) in (0..128).flat_map(|y| (0..96).map(move |x| (x, y))) {
        let (a, b) = (before.pixel(x, y), after.pixel(x, y));
        assert!(a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 3), "{x} {y}: {a:?} {b:?}");
    }
}
#[test]
fn a_drag_of_a_number_is_one_step_and_reshapes_meanwhile() {
    let mut session = opened(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}"#);
    let steps = session.active().unwrap().history.past().count();
    let part = |puff: f32, done: bool| {
        let outline = r#"{"layer":"snowman"}"#;
        format!(
            r#"{{"in":"part","do":"set","part":{{"id":"part-1","name":"snowman","kind":"inflate",
            "outline":{outline},"puff":{puff}}},"done":{done}}}"#
        )
        .replace('\n', " ")
    };
    let before = shown(&session).surface.clone().unwrap();
    tell(&mut session, &part(0.5, false));
    assert!(puff(&session, "part-1") == 0.5 && session.active().unwrap().is_previewing());
    let drags = shown(&session);
    assert!(!drags.is_shaped() && drags.surface.as_ref().unwrap().normal(70, 84) == before.normal(70, 84));
    let flatter = drags.reshaped().surface.unwrap();
    assert!(flatter.normal(70, 84).z > before.normal(70, 84).z + 0.1);
    tell(&mut session, &part(0.25, true));
    assert_eq!(session.active().unwrap().history.past().count(), steps + 1);
    tell(&mut session, &part(9.0, true));
    assert!(session.notes[0].contains("puff") && session.notes[0].contains("between 0 and 8"), "{:?}", session.notes);
    assert!(puff(&session, "part-1") == 0.25 && !session.active().unwrap().is_previewing());
}
#[test]
fn parts_are_added_ordered_copied_hidden_and_deleted_with_what_lies_on_them() {
    let mut session = opened(snowman(false));
    for kind in ["sphere", "box", "touches", "sweep", "inflate"] {
        tell(&mut session, &format!(r#"{{"in":"part","do":"add","kind":"{kind}"}}"#));
    }
    assert_eq!(session.notes, Vec::<String>::new());
    assert_eq!(ids(&session), ["part-1", "part-2", "part-3", "part-4", "part-5"]);
    assert_eq!(shown(&session).parts.part("part-3").unwrap().on(), Some("part-2"));
    tell(&mut session, r#"{"in":"part","do":"order","part":"part-2","index":3}"#);
    assert_eq!(ids(&session), ["part-1", "part-4", "part-5", "part-2", "part-3"]);
    tell(&mut session, r#"{"in":"part","do":"order","part":"part-2","index":0}"#);
    assert_eq!(ids(&session), ["part-2", "part-3", "part-1", "part-4", "part-5"]);
    tell(&mut session, r#"{"in":"part","do":"duplicate","part":"part-2"}"#);
    assert_eq!(ids(&session)[..4], ["part-2", "part-3", "part-6", "part-7"]);
    assert_eq!(shown(&session).parts.part("part-7").unwrap().on(), Some("part-6"));
    tell(&mut session, r#"{"in":"part","do":"visible","part":"part-1","on":false}"#);
    assert!(!shown(&session).parts.part("part-1").unwrap().visible);
    tell(&mut session, r#"{"in":"part","do":"delete","part":"part-2"}"#);
    assert_eq!(ids(&session), ["part-6", "part-7", "part-1", "part-4", "part-5"]);
    tell(&mut session, r#"{"in":"part","do":"delete","part":"nobody"}"#);
    assert_eq!(session.notes, ["There is no such part."]);
    assert!(session.active().unwrap().part.is_some());
}
#[test]
fn what_has_no_outline_says_so_and_changes_nothing() {
    let mut session = Session::default();
    tell(&mut session, r##"{"in":"file","do":"new","width":64,"height":48,"background":null}"##);
    tell(&mut session, r#"{"in":"layer","do":"add","kind":"paint"}"#);
    for (line, why) in [
        (r#"{"in":"part","do":"shape","layer":"0","preset":"coin","flats":false}"#, "empty"),
        (r#"{"in":"part","do":"add","kind":"inflate"}"#, "empty"),
        (r#"{"in":"part","do":"add","kind":"inflate selection"}"#, "Nothing is selected"),
        (r#"{"in":"part","do":"add","kind":"sculpt"}"#, "No part is selected"),
        (r#"{"in":"part","do":"shape","layer":"7","preset":"coin","flats":false}"#, "no such layer"),
    ] {
        tell(&mut session, line);
        let said = session.notes.pop().unwrap_or_default();
        assert!(said.contains(why), "{line}: {said}");
    }
    assert!(shown(&session).parts.is_empty() && shown(&session).surface.is_none());
}
#[test]
fn a_selection_is_inflated_and_keeps_its_outline_when_it_is_let_go_of() {
    let mut session = opened(snowman(false));
    let press = r#"{"in":"pointer","do":"press","tool":"select rectangle","pen":[20,20],"px_per_pt":1}"#;
    tell(&mut session, press);
    tell(&mut session, r#"{"in":"pointer","do":"drag","pens":[[76,108]]}"#);
    tell(&mut session, r#"{"in":"pointer","do":"release"}"#);
    tell(&mut session, r#"{"in":"part","do":"add","kind":"inflate selection"}"#);
    tell(&mut session, r#"{"in":"selection","do":"none"}"#);
    let at = |x: f32, y: f32| shown(&session).part_at(vec2(x, y)).is_some();
    assert!(at(48.0, 64.0) && !at(8.0, 64.0));
}
#[test]
fn layers_and_strokes_are_put_on_parts_and_taken_off_where_they_show() {
    let mut session = opened(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"add","kind":"sphere"}"#);
    tell(&mut session, r#"{"in":"part","do":"add","kind":"box"}"#);
    tell(&mut session, r#"{"in":"layer","do":"add","kind":"strokes"}"#);
    for (x, y) in [(40, 60), (50, 70)] {
        let press = r#"{"in":"pointer","do":"press","tool":"brush","pen":[X,Y],"px_per_pt":1}"#;
        tell(&mut session, &press.replace('X', &x.to_string()).replace('Y', &y.to_string()));
        tell(&mut session, r#"{"in":"pointer","do":"release"}"#);
    }
    let picture = |session: &Session| {
        let document = shown(session);
        flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect())
    };
    let before = picture(&session);
    let home = |session: &Session| shown(session).layers[1].on.as_ref().map(|home| home.part.to_string());
    tell(&mut session, r#"{"in":"layer","do":"home","layer":"1","part":"part-1"}"#);
    assert!(home(&session).as_deref() == Some("part-1") && picture(&session) == before);
    tell(&mut session, r#"{"in":"stroke","do":"home","layer":"1","strokes":[1],"part":"part-2"}"#);
    let homes = |session: &Session| {
        let layer = shown(session).layers[1].id;
        let strokes = shown(session).strokes(layer);
        strokes.iter().map(|s| s.home().map(|home| home.frame.part.to_string())).collect::<Vec<_>>()
    };
    assert_eq!(homes(&session), [None, Some("part-2".to_owned())]);
    assert!(picture(&session) == before);
    tell(&mut session, r#"{"in":"stroke","do":"home","layer":"1","strokes":[1],"part":null}"#);
    tell(&mut session, r#"{"in":"layer","do":"home","layer":"1","part":null}"#);
    assert!(home(&session).is_none() && homes(&session) == [None, None] && picture(&session) == before);
    assert!(session.said.is_empty(), "{:?}", session.said);
    tell(&mut session, r#"{"in":"layer","do":"home","layer":"1","part":"nobody"}"#);
    assert_eq!(session.said, ["There is no such part."]);
}
#[test]
fn layers_become_lines_reliefs_and_lighting_profiles() {
    let mut session = opened(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"add","kind":"sphere"}"#);
    tell(&mut session, r#"{"in":"layer","do":"add","kind":"paint"}"#);
    tell(&mut session, r#"{"in":"pointer","do":"press","tool":"brush","pen":[40,60],"px_per_pt":1}"#);
    tell(&mut session, r#"{"in":"pointer","do":"drag","pens":[[60,64]]}"#);
    tell(&mut session, r#"{"in":"pointer","do":"release"}"#);
    let ball = shown(&session).surface.clone().unwrap();
    tell(&mut session, r#"{"in":"part","do":"add","kind":"lines"}"#);
    let folded = shown(&session).surface.clone().unwrap();
    assert!(ball.normal_planes()[1].values() != folded.normal_planes()[1].values());
    tell(&mut session, r#"{"in":"layer","do":"select","layer":"0"}"#);
    tell(&mut session, r#"{"in":"part","do":"add","kind":"relief"}"#);
    assert_eq!(session.notes, Vec::<String>::new());
    let kinds = |session: &Session| shown(session).parts.list.iter().map(|p| p.kind.name()).collect::<Vec<_>>();
    assert_eq!(kinds(&session), ["primitive", "lines", "relief"]);
    tell(&mut session, r#"{"in":"part","do":"add","kind":"profiles"}"#);
    assert!(session.notes.remove(0).contains("two to five layers"));
    tell(&mut session, r#"{"in":"layer","do":"choose","layer":["0","1"],"primary":"1","anchor":null}"#);
    tell(&mut session, r#"{"in":"part","do":"add","kind":"profiles"}"#);
    assert_eq!((session.notes.clone(), kinds(&session).len()), (Vec::new(), 4));
    let names = shown(&session).parts.list.iter().flat_map(|part| {
        let mut part = crate::document::parts::Part::clone(part);
        part.files_mut().iter().map(|file| file.file.clone()).collect::<Vec<_>>()
    });
    assert_eq!(names.collect::<Vec<_>>(), ["relief-1.png", "shading-1.png", "shading-2.png"]);
}
#[test]
fn maps_become_a_part_that_is_set_without_being_read_again() {
    let folder = tempfile::TempDir::new().unwrap();
    let file = folder.path().join("n.png");
    let up = |x: u32| if x < 24 { [90, 128, 240, 255] } else { [128, 128, 255, 255] };
    image::RgbaImage::from_fn(48, 64, |x, _| image::Rgba(up(x))).save(&file).unwrap();
    let mut session = opened(snowman(false));
    let line = serde_json::json!({ "in": "file", "do": "add maps", "normal": file, "depth": null });
    tell(&mut session, &line.to_string());
    assert_eq!(session.active().unwrap().part.as_deref(), Some("part-1"));
    let part = shown(&session).parts.part("part-1").unwrap().clone();
    assert!(shown(&session).surface.as_ref().unwrap().normal(10, 60).x < -0.2, "stretched to the canvas");
    std::fs::remove_file(&file).unwrap();
    let mut raised = crate::io::recipe::parts::write_part(&part);
    raised["raise"] = 20.into();
    let line = serde_json::json!({ "in": "part", "do": "set", "part": raised, "done": true });
    let notes = session.notes.len();
    tell(&mut session, &line.to_string());
    assert_eq!(session.notes.len(), notes, "{:?}", session.notes);
    assert_eq!(shown(&session).parts.part("part-1").unwrap().raise, 20.0);
}
