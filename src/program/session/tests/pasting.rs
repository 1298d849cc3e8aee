//! Pictures of other programs, pasted: every way is a line that replays, saves and can be undone.

use super::*;
use crate::math::{Rect, Size};
use crate::raster::Picture;
use crate::session::actions::{ClipboardAction, PasteTo, PastedPicture};
use crate::session::{CanvasView, storage};

/// A picture whose pixels all differ, without a file.
fn picture(width: u32, height: u32) -> Picture {
    let one =
        |i: u32| [(i % 251) as u8, (i / 251) as u8, 77, if i.is_multiple_of(7) { 90 } else { 255 }];
    Picture::srgb8(Size::new(width, height), (0..width * height).map(one).collect()).unwrap()
}

fn paste(to: PasteTo, at: Option<Vec2>, picture: Picture) -> Action {
    Action::Clipboard(ClipboardAction::PastePicture {
        picture: PastedPicture { name: "Pasted.png".into(), picture },
        to,
        at,
    })
}

#[test]
fn a_picture_is_pasted_as_flat_paint_at_its_own_size_with_its_middle_at_the_pointer() {
    let mut session = replay(PAPER);
    let given = picture(40, 30);
    paste(PasteTo::Paint, Some(Vec2::new(60.0, 50.0)), given.clone()).apply(&mut session).unwrap();
    let layer = session.layer().unwrap();
    let Content::Pixels(pixels) = &layer.content else { panic!("paint") };
    assert!(layer.name == "Pasted" && !layer.clip_to_surface && layer.mask.is_none());
    let Rect { x0, y0, .. } = Rect::new(40, 35, 80, 65);
    let crate::raster::picture::Texels::Srgb8(texels) = &given.texels else { panic!("bytes") };
    let straight = pixels.tiles.to_straight_rgba(Rect::new(x0, y0, x0 + 40, y0 + 30));
    let opaque = |(a, b): (&[u8; 4], &[u8; 4])| b[3] < 255 || a == b;
    assert!(straight.as_chunks::<4>().0.iter().zip(texels.iter()).all(opaque), "pixel for pixel");
    assert_eq!(session.active().unwrap().history.undo_label(), Some("Paste"));
    session.replay(Path::new("story"), STROKE).unwrap();
    assert_eq!(names(&session), ["Background", "Pasted"], "it can be painted on");
    session.replay(Path::new("story"), r#"{"in":"edit","do":"walk","steps":-2}"#).unwrap();
    assert_eq!(names(&session), ["Background"]);
}

#[test]
fn without_a_pointer_it_goes_to_the_middle_of_the_view_and_what_lies_outside_the_canvas_is_kept() {
    let mut session = replay(PAPER);
    let view =
        CanvasView { center: Vec2::new(10.0, 140.0), zoom: 2.0, turn_rad: 0.0, mirrored: false };
    session.active_mut().unwrap().view = Some(view);
    paste(PasteTo::Paint, None, picture(300, 20)).apply(&mut session).unwrap();
    let covered = |session: &Session| {
        let Content::Pixels(pixels) = &session.layer().unwrap().content else { panic!("paint") };
        crate::raster::CoverageGrid::of_alpha(&pixels.tiles).covered_rect()
    };
    assert_eq!(covered(&session), Rect::new(-140, 130, 160, 150));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("wide.ora");
    storage::save(
        &file,
        session.shown_document().unwrap(),
        crate::io::Overwrite::Nothing,
        &Progress::default(),
    )
    .unwrap();
    session.adopt(storage::open(&file).unwrap());
    assert_eq!(covered(&session), Rect::new(-140, 130, 160, 150), "saved and opened");
}

#[test]
fn it_becomes_an_image_layer_or_a_document_where_that_is_asked_for() {
    let mut session = replay(PAPER);
    paste(PasteTo::Image, None, picture(40, 30)).apply(&mut session).unwrap();
    assert!(matches!(session.layer().unwrap().content, Content::Image(_)));
    paste(PasteTo::Document, None, picture(40, 30)).apply(&mut session).unwrap();
    assert_eq!(
        (session.open_documents.len(), session.shown_document().unwrap().size),
        (2, Size::new(40, 30))
    );
    assert!(
        matches!(session.layer().unwrap().content, Content::Pixels(_))
            && session.active().unwrap().is_dirty()
    );
}

#[test]
fn every_paste_replays_with_the_picture_in_its_line() {
    for to in [PasteTo::Paint, PasteTo::Image, PasteTo::Document] {
        let action = paste(to, Some(Vec2::new(20.0, 30.0)), picture(40, 30));
        let mut first = replay(PAPER);
        action.apply(&mut first).unwrap();
        let mut second = replay(PAPER);
        second.replay(Path::new("story"), &action.to_value().to_string()).unwrap();
        let seen = |session: &Session| {
            let document = session.shown_document().unwrap();
            flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect())
        };
        assert!(seen(&first) == seen(&second) && names(&first) == names(&second), "{}", to.name());
    }
    let broken = r#"{"in":"clipboard","do":"paste picture","picture":{"name":"a.png","file":"AAAA"},"to":"paint"}"#;
    let why = replay(PAPER).replay(Path::new("story"), broken).unwrap_err().to_string();
    assert!(why.starts_with("story: line 1: “picture”"), "{why}");
}

#[test]
fn what_was_copied_here_is_pasted_as_an_image_layer_too() {
    let mut session = replay(&format!("{PAPER}{STROKE}"));
    let act = |session: &mut Session, line: &str| session.replay(Path::new("story"), line).unwrap();
    act(&mut session, r#"{"in":"clipboard","do":"paste image","at":null}"#);
    assert_eq!(session.said.pop().as_deref(), Some("Nothing has been copied yet."));
    act(&mut session, r#"{"in":"clipboard","do":"copy","merged":false}"#);
    act(&mut session, r#"{"in":"clipboard","do":"paste image","at":[50,60]}"#);
    assert!(matches!(session.layer().unwrap().content, Content::Image(_)));
}

#[test]
fn smooth_paint_that_is_pasted_as_an_image_layer_is_saved_with_its_16_bits() {
    let mut session = replay(PAPER);
    let value = |i: u16| [i * 11, 65535 - i * 7, i, 65535 - i * 3];
    let soft = Picture::srgb16(Size::new(40, 30), (0..1200).map(value).collect()).unwrap();
    paste(PasteTo::Paint, Some(Vec2::new(60.0, 50.0)), soft).apply(&mut session).unwrap();
    let act = |session: &mut Session, line: &str| session.replay(Path::new("story"), line).unwrap();
    act(&mut session, r#"{"in":"clipboard","do":"copy","merged":false}"#);
    act(&mut session, r#"{"in":"clipboard","do":"paste image","at":[50,60]}"#);
    let folder = tempfile::tempdir().unwrap();
    let (file, document) =
        (folder.path().join("soft.ora"), session.shown_document().unwrap().clone());
    let overwrite = crate::io::Overwrite::Nothing;
    storage::save(&file, &document, overwrite, &Progress::default()).unwrap();
    session.adopt(storage::open(&file).unwrap());
    assert_eq!(document.difference(session.shown_document().unwrap()), None);
}
