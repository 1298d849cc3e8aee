//! The surface laid flat: shown, painted on, exported and brought back.

use super::*;
use crate::math::{Vec3, vec2, vec3};
use crate::raster::Plane;
use crate::session::OpenDocument;
use crate::surface::{Maps, Surface};

/// An upright half cylinder with a painting of stripes on it.
fn round() -> Session {
    let size = crate::math::Size::new(200, 120);
    let lean = |x: usize| (x as f32 + 0.5 - 100.0) / 80.0;
    let is_round = |x: usize| lean(x).abs() < 0.95;
    let upright = |x: usize| (1.0 - lean(x) * lean(x)).max(0.0).sqrt();
    let maps = Maps {
        normals: Plane::from_fn(size, |x, _| {
            if is_round(x) { vec3(lean(x), 0.0, upright(x)) } else { Vec3::Z }
        }),
        depth: Plane::from_fn(size, |x, _| 1.0 - upright(x)),
        coverage: Plane::from_fn(size, |x, _| if is_round(x) { 255 } else { 0 }),
    };
    let surface = Arc::new(Surface::new(maps).unwrap());
    let texel = |i: u32| {
        let (x, y) = (i % 200, i / 200);
        let wave =
            |v: u32, n: f32| (127.5 + 120.0 * (v as f32 * std::f32::consts::TAU / n).sin()) as u8;
        [wave(x, 23.0), wave(y, 31.0), wave(x + y, 47.0), 255]
    };
    let bytes: Vec<u8> = (0..200 * 120).flat_map(texel).collect();
    let tiles = crate::raster::TileGrid::from_straight_rgba(&bytes, 200, 120, 0, 0);
    let pixels = crate::document::PixelLayer { file: String::new(), x: 0, y: 0, tiles };
    let layer = Arc::new(Layer::new("painting", Content::Pixels(pixels)));
    let document =
        Document { surface: Some(surface), layers: vec![layer], ..Document::empty(size) };
    let mut session = Session::default();
    session.add_document(OpenDocument::new("round", document, None));
    session
}

fn then(session: &mut Session, lines: &str) {
    session.replay(Path::new("story"), lines).unwrap_or_else(|e| panic!("{e}"));
}
const FLAT: &str = r#"{"in":"view","do":"unwrapped","on":true}"#;

#[test]
fn each_of_picture_and_sheet_has_its_own_view_and_the_sheet_its_own_size() {
    let mut session = round();
    then(&mut session, r#"{"in":"view","do":"fit","window_pt":[400,300]}"#);
    let picture = session.active().unwrap().view;
    then(&mut session, FLAT);
    let open = session.active().unwrap();
    assert!(open.view.is_none() && open.shown_size().width > 220, "{}", open.shown_size());
    then(
        &mut session,
        "{\"in\":\"view\",\"do\":\"zoom to\",\"zoom\":3}\n{\"in\":\"view\",\"do\":\"unwrapped\",\"on\":false}",
    );
    assert_eq!(
        (session.active().unwrap().view, session.active().unwrap().shown_size().width),
        (picture, 200)
    );
    then(&mut session, FLAT);
    assert_eq!(session.active().unwrap().view.map(|view| view.zoom), Some(3.0));
}

#[test]
fn a_stroke_drawn_on_the_sheet_is_one_step_on_the_form() {
    let mut session = round();
    then(&mut session, FLAT);
    let open = session.active().unwrap();
    let (layout, surface) = (open.layout().unwrap(), open.document().surface.clone().unwrap());
    let [from, to] =
        [vec2(40.0, 60.0), vec2(160.0, 60.0)].map(|q| layout.sheet_at(&surface, q).unwrap());
    let hand = r##"{"in":"layer","do":"add","kind":"strokes"}
{"in":"hand","do":"preset","name":"hard-round"}
{"in":"hand","do":"size","to":12}
{"in":"hand","do":"color","color":"#c02010"}"##;
    then(&mut session, hand);
    then(
        &mut session,
        &format!(
            "{{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"brush\",\"pen\":[{},{}],\"px_per_pt\":1}}\n\
             {{\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[[{},{}]]}}\n{{\"in\":\"pointer\",\"do\":\"release\"}}",
            from.x, from.y, to.x, to.y
        ),
    );
    assert_eq!(session.active().unwrap().history.undo_label(), Some("Wrapped stroke"));
    for x in [45, 70, 100, 130, 155] {
        assert_eq!(pixel(&session, x, 60), [0xc0, 0x20, 0x10, 255], "at {x}");
    }
    assert_ne!(pixel(&session, 100, 80), [0xc0, 0x20, 0x10, 255]);
    let end = session.active().unwrap().last_end.unwrap();
    assert!(end.distance(vec2(160.0, 60.0)) < 1.0, "the next line begins on the canvas: {end}");
    then(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert_ne!(pixel(&session, 100, 60), [0xc0, 0x20, 0x10, 255]);
}

#[test]
fn tools_that_hold_what_lies_in_the_picture_say_so() {
    let mut session = round();
    then(&mut session, FLAT);
    then(
        &mut session,
        r#"{"in":"pointer","do":"press","tool":"transform","pen":[90,60],"px_per_pt":1}"#,
    );
    assert!(!session.is_drawing());
    assert!(
        session.notes.last().is_some_and(|note| note.contains("unwrapped")),
        "{:?}",
        session.notes
    );
}

#[test]
fn without_a_surface_nothing_is_unwrapped_and_that_is_told() {
    let mut session = replay(PAPER);
    then(&mut session, FLAT);
    assert!(session.active().unwrap().unwrap_settings().is_none());
    assert_eq!(session.notes.len(), 1, "{:?}", session.notes);
}

#[test]
fn what_is_exported_unwrapped_and_imported_again_is_the_painting() {
    let folder = tempfile::tempdir().unwrap();
    for (scale, bits, name) in
        [(1, 8, "one.png"), (2, 8, "two.png"), (2, 16, "two16.png"), (1, 16, "one.exr")]
    {
        let mut session = round();
        let before = flatten(session.active().unwrap().document(), &Progress::default()).unwrap();
        let file = folder.path().join(name);
        // As JSON writes it: on Windows it has `\`.
        let file = serde_json::json!(file);
        then(
            &mut session,
            &format!(
                r#"{{"in":"file","do":"export unwrapped","file":{file},"scale":{scale},"bits":{bits}}}
{{"in":"layer","do":"delete","layer":"0"}}
{{"in":"file","do":"import unwrapped","file":{file}}}"#
            ),
        );
        assert!(session.notes.is_empty(), "{:?}", session.notes);
        let document = session.active().unwrap().document();
        let after = flatten(document, &Progress::default()).unwrap();
        let surface = document.surface.as_deref().unwrap();
        let (mut sum, mut count) = (0.0f64, 0.0);
        for (x, y) in (0..120).flat_map(|y| (0..200).map(move |x| (x, y))) {
            if surface.coverage(x as usize, y as usize) > 0 {
                let (a, b) = (before.pixel(x, y), after.pixel(x, y));
                sum += (0..4).map(|c| f64::from(a[c].abs_diff(b[c]))).sum::<f64>();
                count += 4.0;
            }
        }
        let mean = sum / count;
        assert!(mean <= 2.0, "{name}: {mean} of 255 in the mean");
    }
}

#[test]
fn a_picture_of_other_proportions_is_placed_as_wide_and_that_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("square.png");
    image::RgbaImage::from_pixel(64, 64, image::Rgba([9, 90, 200, 255])).save(&file).unwrap();
    let mut session = round();
    then(
        &mut session,
        &serde_json::json!({ "in": "file", "do": "import unwrapped", "file": file }).to_string(),
    );
    assert_eq!(names(&session), ["painting", "square"]);
    assert!(
        session.notes.last().is_some_and(|note| note.contains("the width matches")),
        "{:?}",
        session.notes
    );
}
