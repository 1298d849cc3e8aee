//! The surface laid flat, in the window.

use super::replayed::{bytes, project};
use super::{Story, choose, command, drag, key, press, session, until, window_of};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::Content;
use rilievo_program::session::Session;
use rilievo_window::MainWindow;
use std::path::Path;

fn opened(folder: &Path) -> Story {
    let file = project(folder);
    let mut harness = window_of(1.0, move |ctx| {
        let mut window = MainWindow::new(ctx).recording();
        window.begin(vec![file.clone()]);
        window
    });
    until(&mut harness, |harness| session(harness).active().is_some());
    harness
}

fn is_unwrapped(harness: &Story) -> bool {
    session(harness).active().unwrap().unwrap_settings().is_some()
}

#[test]
fn the_surface_is_laid_flat_painted_on_and_the_story_replays_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = opened(folder.path());
    key(&mut harness, Modifiers::ALT, Key::Num9);
    until(&mut harness, is_unwrapped);
    harness.get_by_label("Unwrapped");
    key(&mut harness, Modifiers::NONE, Key::B);
    drag(&mut harness, vec2(-90.0, -20.0), vec2(80.0, 40.0));
    {
        let open = session(&harness).active().unwrap();
        let Content::Strokes(live) = &session(&harness).layer().unwrap().content else {
            panic!("a stroke layer")
        };
        let stroke = &live.params().strokes[0];
        assert!(stroke.operator().unwrapping().is_some() && stroke.samples().len() > 20);
        let canvas = open.document().size.rect();
        assert!(stroke.samples().iter().all(|s| canvas.contains(s.at.x as i32, s.at.y as i32)));
        assert_eq!(open.history.undo_label(), Some("Wrapped stroke"));
    }
    key(&mut harness, Modifiers::ALT, Key::Num9);
    assert!(!is_unwrapped(&harness));
    assert!(harness.query_by_label("Dismiss").is_none(), "nothing went wrong");
    let seen = session(&harness).active().unwrap().document().clone();
    let text = harness.state().as_ref().unwrap().replay_text();
    let mut again = Session::default();
    again.replay(Path::new("story.jsonl"), &text).unwrap();
    let replayed = again.active().unwrap().document();
    assert!(bytes(&seen, folder.path(), "seen.ora") == bytes(replayed, folder.path(), "again.ora"));
}

#[test]
fn a_gradient_is_moved_on_one_piece_of_the_sheet_and_the_story_replays() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = opened(folder.path());
    command(&mut harness, "bend: wrap");
    key(&mut harness, Modifiers::NONE, Key::G);
    drag(&mut harness, vec2(-60.0, -20.0), vec2(70.0, 30.0));
    key(&mut harness, Modifiers::ALT, Key::Num9);
    until(&mut harness, is_unwrapped);
    drag(&mut harness, vec2(-30.0, 10.0), vec2(20.0, -15.0));
    {
        let Content::Gradient(live) = &session(&harness).layer().unwrap().content else {
            panic!("a gradient")
        };
        let [piece] = live.params().pieces[..] else {
            panic!("one piece: {:?}", live.params().pieces)
        };
        assert!(piece.moved.length() > 5.0 && piece.scale == 1.0, "{piece:?}");
        assert_eq!(session(&harness).active().unwrap().history.undo_label(), Some("Move piece"));
    }
    assert!(harness.query_by_label("Dismiss").is_none(), "nothing went wrong");
    let seen = session(&harness).active().unwrap().document().clone();
    let text = harness.state().as_ref().unwrap().replay_text();
    let mut again = Session::default();
    again.replay(Path::new("story.jsonl"), &text).unwrap();
    let replayed = again.active().unwrap().document();
    assert!(bytes(&seen, folder.path(), "seen.ora") == bytes(replayed, folder.path(), "again.ora"));
}

#[test]
fn what_is_exported_unwrapped_comes_back_as_a_layer_on_the_surface() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = opened(folder.path());
    let flat = folder.path().join("flat.png");
    command(&mut harness, "Export unwrapped");
    press(&mut harness, "16 bits a channel");
    press(&mut harness, "Export…");
    choose(&mut harness, &flat);
    until(&mut harness, |_| flat.is_file());
    command(&mut harness, "Import unwrapped");
    choose(&mut harness, &flat);
    until(&mut harness, |harness| {
        session(harness).layer().is_some_and(|layer| layer.name == "flat")
    });
    let Content::Image(live) = &session(&harness).layer().unwrap().content else {
        panic!("an image layer")
    };
    assert!(live.params().bend.operator.unwrapping().is_some());
    assert!(harness.query_by_label("Dismiss").is_none(), "nothing went wrong");
}
