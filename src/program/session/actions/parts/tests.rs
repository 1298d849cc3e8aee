//! Stories of parts, replayed.

mod across;
mod flats;
mod ink;

use crate::document::parts::PartKind;
use crate::document::{Content, Document, Progress, flatten};
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

fn open(document: Document) -> Session {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("snowman.png", document, None));
    session
}

fn tell(session: &mut Session, line: &str) {
    session.replay(Path::new("story"), line).unwrap_or_else(|error| panic!("{line}: {error}"));
}

fn shown_document(session: &Session) -> &Document {
    session.active().unwrap().shown_document()
}

fn ids(session: &Session) -> Vec<&str> {
    shown_document(session).parts.list.iter().map(|part| part.id.as_str()).collect()
}

fn puff(session: &Session, id: &str) -> f32 {
    match &shown_document(session).parts.part(id).unwrap().kind {
        PartKind::Inflate { inflation, .. } => inflation.puff,
        other => panic!("{}", other.name()),
    }
}

#[test]
fn a_drawing_gets_a_shape_and_a_base_that_is_lit_in_one_step() {
    let mut session = open(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}"#);
    assert_eq!(session.notes, Vec::<String>::new());
    let document = shown_document(&session);
    assert_eq!(
        document.layers.iter().map(|layer| layer.name.as_str()).collect::<Vec<_>>(),
        ["snowman", "Light"]
    );
    let Content::Shading(light) = &document.layers[1].content else { panic!("no light") };
    assert!(light.params().is_lighting_beneath() && light.params().shadows.on);
    let surface = document.surface.as_ref().unwrap();
    assert!(surface.normal(48, 84).z > 0.98 && surface.normal(70, 84).x > 0.3);
    let lit = flatten(document, &Progress::default()).unwrap();
    let (light, dark) = (lit.pixel(34, 66), lit.pixel(66, 106));
    assert!(light[2] > dark[2] + 40, "lit from above left: {light:?} {dark:?}");
    assert_eq!(session.active().unwrap().part.as_deref(), Some("part-1"));
    tell(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert!(
        shown_document(&session).surface.is_none() && shown_document(&session).layers.len() == 1
    );
}

#[test]
fn a_drawing_that_is_one_part_goes_where_the_part_goes() {
    let mut session = open(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}"#);
    let before = flatten(shown_document(&session), &Progress::default()).unwrap();
    let moved = r#"{"in":"part","do":"set","part":{"id":"part-1","name":"snowman","kind":"inflate","outline":
        {"layer":"snowman"},"matrix":[1,0,0,1,6,-4]},"done":true}"#;
    tell(&mut session, &moved.replace('\n', " "));
    assert_eq!(session.notes, Vec::<String>::new());
    let after = flatten(shown_document(&session), &Progress::default()).unwrap();
    for (x, y) in [(48, 36), (40, 30), (60, 90), (30, 100), (48, 84)] {
        let (a, b) = (before.pixel(x, y), after.pixel(x + 6, y - 4));
        assert!(
            a[3] == 255 && a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 2),
            "{x} {y}: {a:?} {b:?}"
        );
    }
    assert_eq!(
        shown_document(&session).layers[0].on.as_ref().map(|attachment| &*attachment.part),
        Some("part-1")
    );
}

#[test]
fn a_drag_of_a_number_is_one_step_and_reshapes_meanwhile() {
    let mut session = open(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}"#);
    let steps = session.active().unwrap().history.past_names().count();
    let part = |puff: f32, done: bool| {
        let outline = r#"{"layer":"snowman"}"#;
        format!(
            r#"{{"in":"part","do":"set","part":{{"id":"part-1","name":"snowman","kind":"inflate",
            "outline":{outline},"puff":{puff}}},"done":{done}}}"#
        )
        .replace('\n', " ")
    };
    let before = shown_document(&session).surface.clone().unwrap();
    tell(&mut session, &part(0.5, false));
    assert!(puff(&session, "part-1") == 0.5 && session.active().unwrap().is_previewing());
    let drags = shown_document(&session);
    assert!(
        drags.is_ahead()
            && !drags.is_shaped()
            && drags.surface.as_ref().unwrap().normal(70, 84) == before.normal(70, 84)
    );
    let flatter = drags.reshaped().surface.unwrap();
    assert!(flatter.normal(70, 84).z > before.normal(70, 84).z + 0.1);
    tell(&mut session, &part(0.25, true));
    assert_eq!(session.active().unwrap().history.past_names().count(), steps + 1);
    tell(&mut session, &part(9.0, true));
    assert!(
        session.notes[0].contains("puff") && session.notes[0].contains("between 0 and 8"),
        "{:?}",
        session.notes
    );
    assert!(puff(&session, "part-1") == 0.25 && !session.active().unwrap().is_previewing());
}

#[test]
fn parts_are_added_ordered_copied_hidden_and_deleted_with_what_lies_on_them() {
    let mut session = open(snowman(false));
    for kind in ["sphere", "box", "touches", "sweep", "inflate"] {
        tell(&mut session, &format!(r#"{{"in":"part","do":"add","kind":"{kind}"}}"#));
    }
    assert_eq!(session.notes, Vec::<String>::new());
    assert_eq!(ids(&session), ["part-1", "part-2", "part-3", "part-4", "part-5"]);
    assert_eq!(shown_document(&session).parts.part("part-3").unwrap().on(), Some("part-2"));
    tell(&mut session, r#"{"in":"part","do":"order","part":"part-2","index":3}"#);
    assert_eq!(ids(&session), ["part-1", "part-4", "part-5", "part-2", "part-3"]);
    tell(&mut session, r#"{"in":"part","do":"order","part":"part-2","index":0}"#);
    assert_eq!(ids(&session), ["part-2", "part-3", "part-1", "part-4", "part-5"]);
    tell(&mut session, r#"{"in":"part","do":"duplicate","part":"part-2"}"#);
    assert_eq!(ids(&session)[..4], ["part-2", "part-3", "part-6", "part-7"]);
    assert_eq!(shown_document(&session).parts.part("part-7").unwrap().on(), Some("part-6"));
    tell(&mut session, r#"{"in":"part","do":"visible","part":"part-1","on":false}"#);
    assert!(!shown_document(&session).parts.part("part-1").unwrap().visible);
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
        (
            r#"{"in":"part","do":"shape","layer":"7","preset":"coin","flats":false}"#,
            "no such layer",
        ),
    ] {
        tell(&mut session, line);
        let said = session.notes.pop().unwrap_or_default();
        assert!(said.contains(why), "{line}: {said}");
    }
    assert!(
        shown_document(&session).parts.is_empty() && shown_document(&session).surface.is_none()
    );
}

#[test]
fn a_selection_is_inflated_and_keeps_its_outline_when_it_is_let_go_of() {
    let mut session = open(snowman(false));
    let press =
        r#"{"in":"pointer","do":"press","tool":"select rectangle","pen":[20,20],"px_per_pt":1}"#;
    tell(&mut session, press);
    tell(&mut session, r#"{"in":"pointer","do":"drag","pens":[[76,108]]}"#);
    tell(&mut session, r#"{"in":"pointer","do":"release"}"#);
    tell(&mut session, r#"{"in":"part","do":"add","kind":"inflate selection"}"#);
    tell(&mut session, r#"{"in":"selection","do":"none"}"#);
    let at = |x: f32, y: f32| shown_document(&session).part_at(vec2(x, y)).is_some();
    assert!(at(48.0, 64.0) && !at(8.0, 64.0));
}

#[test]
fn layers_and_strokes_are_put_on_parts_and_taken_off_where_they_show() {
    let mut session = open(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"add","kind":"sphere"}"#);
    tell(&mut session, r#"{"in":"part","do":"add","kind":"box"}"#);
    tell(&mut session, r#"{"in":"layer","do":"add","kind":"strokes"}"#);
    for (x, y) in [(40, 60), (50, 70)] {
        let press = r#"{"in":"pointer","do":"press","tool":"brush","pen":[X,Y],"px_per_pt":1}"#;
        tell(&mut session, &press.replace('X', &x.to_string()).replace('Y', &y.to_string()));
        tell(&mut session, r#"{"in":"pointer","do":"release"}"#);
    }
    let picture = |session: &Session| {
        let document = shown_document(session);
        flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect())
    };
    let before = picture(&session);
    let attachment = |session: &Session| {
        shown_document(session).layers[1].on.as_ref().map(|attachment| attachment.part.to_string())
    };
    tell(&mut session, r#"{"in":"layer","do":"home","layer":"1","part":"part-1"}"#);
    assert!(attachment(&session).as_deref() == Some("part-1") && picture(&session) == before);
    tell(&mut session, r#"{"in":"stroke","do":"home","layer":"1","strokes":[1],"part":"part-2"}"#);
    let attachments = |session: &Session| {
        let layer = shown_document(session).layers[1].id;
        let strokes = shown_document(session).strokes(layer);
        strokes
            .iter()
            .map(|s| s.attachment().map(|attachment| attachment.frame.part.to_string()))
            .collect::<Vec<_>>()
    };
    assert_eq!(attachments(&session), [None, Some("part-2".to_owned())]);
    assert!(picture(&session) == before);
    tell(&mut session, r#"{"in":"stroke","do":"home","layer":"1","strokes":[1],"part":null}"#);
    tell(&mut session, r#"{"in":"layer","do":"home","layer":"1","part":null}"#);
    assert!(
        attachment(&session).is_none()
            && attachments(&session) == [None, None]
            && picture(&session) == before
    );
    assert!(session.said.is_empty(), "{:?}", session.said);
    tell(&mut session, r#"{"in":"layer","do":"home","layer":"1","part":"nobody"}"#);
    assert_eq!(session.said, ["There is no such part."]);
}

#[test]
fn layers_become_lines_reliefs_and_lighting_profiles() {
    let mut session = open(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"add","kind":"sphere"}"#);
    tell(&mut session, r#"{"in":"layer","do":"add","kind":"paint"}"#);
    tell(
        &mut session,
        r#"{"in":"pointer","do":"press","tool":"brush","pen":[40,60],"px_per_pt":1}"#,
    );
    tell(&mut session, r#"{"in":"pointer","do":"drag","pens":[[60,64]]}"#);
    tell(&mut session, r#"{"in":"pointer","do":"release"}"#);
    let ball = shown_document(&session).surface.clone().unwrap();
    tell(&mut session, r#"{"in":"part","do":"add","kind":"lines"}"#);
    let folded = shown_document(&session).surface.clone().unwrap();
    assert!(ball.normal_planes()[1].values() != folded.normal_planes()[1].values());
    tell(&mut session, r#"{"in":"layer","do":"select","layer":"0"}"#);
    tell(&mut session, r#"{"in":"part","do":"add","kind":"relief"}"#);
    assert_eq!(session.notes, Vec::<String>::new());
    let kinds = |session: &Session| {
        shown_document(session).parts.list.iter().map(|p| p.kind.name()).collect::<Vec<_>>()
    };
    assert_eq!(kinds(&session), ["primitive", "lines", "relief"]);
    tell(&mut session, r#"{"in":"part","do":"add","kind":"profiles"}"#);
    assert!(session.notes.remove(0).contains("two to five layers"));
    tell(
        &mut session,
        r#"{"in":"layer","do":"choose","layer":["0","1"],"active_layer":"1","anchor":null}"#,
    );
    tell(&mut session, r#"{"in":"part","do":"add","kind":"profiles"}"#);
    assert_eq!((session.notes.clone(), kinds(&session).len()), (Vec::new(), 4));
    let names = shown_document(&session).parts.list.iter().flat_map(|part| {
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
    let mut session = open(snowman(false));
    let line = serde_json::json!({ "in": "file", "do": "add maps", "normal": file, "depth": null });
    tell(&mut session, &line.to_string());
    assert_eq!(session.active().unwrap().part.as_deref(), Some("part-1"));
    let part = shown_document(&session).parts.part("part-1").unwrap().clone();
    assert!(
        shown_document(&session).surface.as_ref().unwrap().normal(10, 60).x < -0.2,
        "stretched to the canvas"
    );
    std::fs::remove_file(&file).unwrap();
    let mut raised = crate::io::recipe::parts::write_part(&part);
    raised["raise"] = 20.into();
    let line = serde_json::json!({ "in": "part", "do": "set", "part": raised, "done": true });
    let notes = session.notes.len();
    tell(&mut session, &line.to_string());
    assert_eq!(session.notes.len(), notes, "{:?}", session.notes);
    assert_eq!(shown_document(&session).parts.part("part-1").unwrap().raise, 20.0);
}
