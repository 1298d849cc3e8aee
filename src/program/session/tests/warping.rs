//! Meshes and liquify, written as the lines of a replay: a photo, a stroke layer and a group are
//! displaced, applied and undone.

use super::*;

fn story(session: &mut Session, lines: &str) {
    session.replay(Path::new("story"), lines).unwrap_or_else(|e| panic!("{e}"));
}

fn picture(session: &Session) -> Vec<u8> {
    let document = session.active().unwrap().document();
    flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect())
}

fn layer(session: &Session) -> Arc<crate::document::Layer> {
    session.layer().unwrap().clone()
}

/// A push to the right from (60, 70).
const PUSH: &str = r#"
{"in":"hand","do":"liquify","liquify":{"tool":"push","size":80,"strength":1,"one_object":false,"foreshortened":true}}
{"in":"pointer","do":"press","tool":"liquify","pen":[60,70],"px_per_pt":1}
{"in":"pointer","do":"drag","pens":[[70,72],[85,75]]}
{"in":"pointer","do":"release"}"#;
const UNDO: &str = r#"{"in":"edit","do":"undo"}"#;

#[test]
fn a_stroke_layer_is_liquified_live_and_each_stroke_is_a_step() {
    let strokes = r#"{"in":"layer","do":"add","kind":"strokes"}"#;
    let mut session = replay(&format!("{PAPER}\n{strokes}{STROKE}"));
    let plain = picture(&session);
    story(&mut session, PUSH);
    let once = picture(&session);
    assert!(once != plain && layer(&session).liquify.is_some());
    assert!(
        matches!(&layer(&session).content, crate::document::Content::Strokes(_)),
        "it stays live"
    );
    story(&mut session, PUSH);
    assert!(picture(&session) != once);
    story(&mut session, UNDO);
    assert!(picture(&session) == once);
    story(&mut session, UNDO);
    assert!(picture(&session) == plain);
    // Done again, and recorded lines give the same bytes.
    story(&mut session, r#"{"in":"edit","do":"redo"}"#);
    assert!(picture(&session) == once);
    let again = replay(&format!("{PAPER}\n{strokes}{STROKE}{PUSH}"));
    assert!(picture(&again) == once);
    // Applied, it is paint that looks the same, and takes paint.
    story(&mut session, r#"{"in":"layer","do":"apply transform","layer":"1"}"#);
    assert!(picture(&session) == once && !layer(&session).is_warped());
    story(&mut session, STROKE);
    assert!(picture(&session) != once);
}

/// A ramp on a ball, pushed over its rim, which nothing has shown yet.
fn ramp_on_a_ball() -> Session {
    let part =
        r#"{"id":"part-1","kind":"primitive","shape":"sphere","center":[70,70],"size":[90,80]}"#;
    let part = format!(r#"{{"in":"part","do":"set","part":{part},"done":true}}"#);
    let ramp = r#"
{"in":"pointer","do":"press","tool":"gradient","pen":[20,30],"px_per_pt":1}
{"in":"pointer","do":"drag","pens":[[60,60],[120,110]]}
{"in":"pointer","do":"release"}
{"in":"layer","do":"select","layer":"1"}"#;
    let push =
        PUSH.replace("[60,70]", "[90,70]").replace("[[70,72],[85,75]]", "[[110,80],[125,75]]");
    replay(&format!("{PAPER}\n{part}{ramp}{push}"))
}

#[test]
fn an_applied_displacement_cuts_a_rim_as_it_was_cut_whether_it_was_shown_or_not() {
    const APPLY: &str = r#"{"in":"layer","do":"apply transform","layer":"1"}"#;
    let shown = picture(&ramp_on_a_ball());
    let mut session = ramp_on_a_ball();
    assert!(layer(&session).is_warped() && layer(&session).clip_to_surface);
    story(&mut session, APPLY);
    assert!(!layer(&session).is_warped());
    assert!(picture(&session) == shown, "applied, it looks as it did");
    story(&mut session, UNDO);
    assert!(picture(&session) == shown, "what was composed to be applied is no other picture");
}

#[test]
fn removed_liquify_leaves_the_layer_as_it_was() {
    let mut session =
        replay(&format!("{PAPER}\n{{\"in\":\"layer\",\"do\":\"add\",\"kind\":\"paint\"}}{STROKE}"));
    let plain = picture(&session);
    story(&mut session, PUSH);
    assert!(picture(&session) != plain);
    story(
        &mut session,
        r#"{"in":"layer","do":"set","layer":"1","to":{"do":"without liquify"},"done":true}"#,
    );
    assert!(picture(&session) == plain);
}

#[test]
fn a_mesh_is_laid_dragged_applied_and_undone() {
    let mut session =
        replay(&format!("{PAPER}\n{{\"in\":\"layer\",\"do\":\"add\",\"kind\":\"paint\"}}{STROKE}"));
    let plain = picture(&session);
    story(&mut session, r#"{"in":"layer","do":"mesh","layer":"1","columns":3,"rows":3}"#);
    assert!(picture(&session) == plain, "an even mesh moves nothing");
    let mesh = layer(&session).transform.as_ref().unwrap().mesh().unwrap().clone();
    let [x, y] = mesh.points()[4].to_array();
    let to = [x + 9.0, y + 6.0];
    story(
        &mut session,
        &format!(
            "{{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"transform\",\"pen\":[{x},{y}],\"px_per_pt\":0.1}}\n\
             {{\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[{to:?}]}}\n{{\"in\":\"pointer\",\"do\":\"release\"}}"
        ),
    );
    let bent = picture(&session);
    assert!(bent != plain && layer(&session).is_warped());
    story(&mut session, r#"{"in":"layer","do":"apply transform","layer":"1"}"#);
    assert!(picture(&session) == bent && layer(&session).transform.is_none());
    story(&mut session, UNDO);
    story(&mut session, UNDO);
    assert!(picture(&session) == plain && layer(&session).transform.is_some());
    story(&mut session, r#"{"in":"layer","do":"mesh","layer":"1","columns":40,"rows":3}"#);
    assert!(picture(&session) == plain);
}

/// Where a blue dot painted at (70, 73) shows.
fn blue_dot(session: &mut Session) -> crate::math::Vec2 {
    let dot = r##"
{"in":"hand","do":"color","color":"#0020f0"}
{"in":"hand","do":"size","to":4}
{"in":"pointer","do":"press","tool":"brush","pen":[70,73],"px_per_pt":1}
{"in":"pointer","do":"release"}"##;
    story(session, dot);
    let (mut sum, mut mass) = (crate::math::Vec2::ZERO, 0.0);
    for (k, rgba) in picture(session).chunks_exact(4).enumerate() {
        let blue = (f32::from(rgba[2]) - f32::from(rgba[0])).max(0.0);
        sum += crate::math::vec2((k % 200) as f32 + 0.5, (k / 200) as f32 + 0.5) * blue;
        mass += blue;
    }
    sum / mass
}

#[test]
fn a_stroke_on_what_is_displaced_shows_under_the_pen() {
    let strokes = r#"{"in":"layer","do":"add","kind":"strokes"}"#;
    let shows_there = |session: &mut Session, what: &str| {
        let at = blue_dot(session);
        assert!(
            at.distance(crate::math::vec2(70.0, 73.0)) < 1.5,
            "{what}: {at}, {:?}",
            session.notes
        );
    };
    let mut own = replay(&format!("{PAPER}\n{strokes}{STROKE}{PUSH}"));
    shows_there(&mut own, "a stroke layer");
    assert!(layer(&own).is_warped(), "it stays live");
    let group = r#"{"in":"layer","do":"group","layer":"1"}"#;
    let mut around = replay(&format!("{PAPER}\n{strokes}{STROKE}\n{group}{PUSH}"));
    story(&mut around, r#"{"in":"layer","do":"select","layer":"1.0"}"#);
    shows_there(&mut around, "a stroke layer in a group");
    let mut paint = replay(&format!(
        "{PAPER}\n{{\"in\":\"layer\",\"do\":\"add\",\"kind\":\"paint\"}}{STROKE}{PUSH}"
    ));
    shows_there(&mut paint, "a paint layer");
    // A layer of its own above a layer that holds no strokes.
    let fill = r##"{"in":"layer","do":"add","kind":"fill"}"##;
    let mut above = replay(&format!("{PAPER}\n{strokes}{STROKE}\n{group}{PUSH}\n{fill}"));
    shows_there(&mut above, "above a fill");
}
