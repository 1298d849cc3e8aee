//! Color profiles of documents: chosen, changed, undone, and crossed by what is placed and pasted.

use super::*;
use crate::io::{pixels, profile_change};
use crate::math::srgb::Color;
use crate::math::{ColorProfile, Size};

const P3: ColorProfile = ColorProfile::DisplayP3;
/// A document in a profile, filled with the red of sRGB.
const RED: &str = r##"{"in":"file","do":"new","width":64,"height":48,"background":"#ff0000"}
"##;
const NEW_P3: &str =
    r#"{"in":"file","do":"new","width":64,"height":48,"background":null,"profile":"display-p3"}"#;

fn act(session: &mut Session, line: &str) {
    session.replay(Path::new("story"), line).unwrap();
}

fn fill(session: &Session, layer: usize) -> Color {
    match session.shown_document().unwrap().layers[layer].content {
        Content::Fill(color) => color,
        _ => panic!("no fill"),
    }
}

fn profile(session: &Session) -> ColorProfile {
    session.shown_document().unwrap().profile
}

#[test]
fn a_profile_is_converted_to_or_assigned_and_both_can_be_undone() {
    let mut session = replay(RED);
    assert_eq!(profile(&session), ColorProfile::Srgb);
    act(
        &mut session,
        r#"{"in":"canvas","do":"profile","profile":"display-p3","change":"convert"}"#,
    );
    assert_eq!((profile(&session), fill(&session, 0)), (P3, Color::rgb(234, 51, 35)));
    assert_eq!(session.active().unwrap().history.undo_label(), Some("Convert color profile"));
    assert!(session.said.is_empty(), "{:?}", session.said);
    act(&mut session, r#"{"in":"edit","do":"walk","steps":-1}"#);
    assert_eq!((profile(&session), fill(&session, 0)), (ColorProfile::Srgb, Color::rgb(255, 0, 0)));
    act(&mut session, r#"{"in":"canvas","do":"profile","profile":"display-p3","change":"assign"}"#);
    assert_eq!((profile(&session), fill(&session, 0)), (P3, Color::rgb(255, 0, 0)));
    act(&mut session, r#"{"in":"canvas","do":"profile","profile":"display-p3","change":"assign"}"#);
    assert_eq!(session.said, ["The document's color profile is Display P3 already."]);
    act(&mut session, r#"{"in":"canvas","do":"profile","profile":"srgb","change":"convert"}"#);
    assert_eq!((profile(&session), fill(&session, 0)), (ColorProfile::Srgb, Color::rgb(255, 0, 0)));
    assert!(session.said[1].starts_with("Some colors are more saturated"), "{:?}", session.said);
}

#[test]
fn layers_and_pictures_keep_their_look_in_another_profile() {
    let mut session = replay(RED);
    act(&mut session, r#"{"in":"clipboard","do":"copy","merged":false}"#);
    act(&mut session, NEW_P3);
    assert_eq!(profile(&session), P3);
    act(&mut session, r#"{"in":"clipboard","do":"paste"}"#);
    assert_eq!(fill(&session, 0), Color::rgb(234, 51, 35));
    act(&mut session, r#"{"in":"clipboard","do":"paste image"}"#);
    let texel = |session: &Session| match &session.shown_document().unwrap().layers[1].content {
        Content::Image(live) => live.params().source.picture.linear_at(0, 0),
        _ => panic!("no image"),
    };
    let red = Color::rgb(234, 51, 35).linear();
    assert_eq!(texel(&session)[..3], red);
    // What is copied here is sRGB for other programs.
    act(&mut session, r#"{"in":"clipboard","do":"copy","merged":true}"#);
    assert_eq!(session.copied.as_ref().unwrap().rgba[..4], [255, 0, 0, 255]);
    act(&mut session, r#"{"in":"clipboard","do":"paste new"}"#);
    assert_eq!(profile(&session), P3);
}

#[test]
fn a_file_in_display_p3_opens_as_such_and_is_as_wide_when_it_is_placed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("wide.png");
    let size = Size::new(8, 8);
    let png = pixels::encode_texels_in(&file, &[[255, 0, 0, 255]; 64], size, P3).unwrap();
    std::fs::write(&file, png.bytes()).unwrap();
    let mut session = replay(RED);
    let place = format!(r#"{{"in":"file","do":"place","file":{file:?},"at":[20,20]}}"#);
    for (new, expected) in [("", [1.0, 0.0, 0.0]), (NEW_P3, [1.0, 0.0, 0.0])] {
        act(&mut session, new);
        act(&mut session, &place);
        let document = session.shown_document().unwrap();
        let Content::Image(live) = &document.layers.last().unwrap().content else {
            panic!("image")
        };
        assert_eq!(live.params().source.picture.linear_at(0, 0)[..3], expected);
        // What is saved opens as it is.
        let saved = folder.path().join(format!("{}.ora", document.profile.name()));
        let save = format!(r#"{{"in":"file","do":"save","file":{saved:?}}}"#);
        act(&mut session, &save);
        let opened = crate::session::storage::open(&saved).unwrap().open;
        assert_eq!(session.shown_document().unwrap().difference(opened.document()), None);
    }
    act(&mut session, &format!(r#"{{"in":"file","do":"open","file":{file:?}}}"#));
    assert_eq!(profile(&session), P3);
    // A picture that is dropped where no document is open.
    let picture = crate::session::actions::placing::read_picture(&file).unwrap().1;
    assert_eq!(profile_change::own_profile(&picture), P3);
    let alone = crate::session::actions::placing::of_picture("wide.png", picture);
    assert_eq!(alone.profile, P3);
}
