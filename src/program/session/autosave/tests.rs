use super::*;
use crate::session::Session;
use crate::session::actions::{Action, FileAction};

const STORY: &str = r##"{"in":"file","do":"new","width":90,"height":70,"background":"#ffffff"}
{"in":"pointer","do":"press","tool":"brush","pen":[20,30],"px_per_pt":1}
{"in":"pointer","do":"drag","pens":[[60,44],[80,30]]}
{"in":"pointer","do":"release"}"##;

/// A program that keeps its logs in a folder and painted a stroke.
fn paint(folder: &Path) -> Session {
    let mut session =
        Session { autosave: Some(Autosave::new(folder.into())), ..Session::default() };
    session.replay(Path::new("story"), STORY).unwrap();
    session.keep();
    session
}

fn autosave(session: &Session) -> &Autosave {
    session.autosave.as_ref().unwrap()
}

fn crash(session: Session) {
    autosave(&session).wait_until_written();
    drop(session);
}

fn find_lost(folder: &Path) -> Vec<recovery::LostSession> {
    Autosave::new(folder.into()).find_lost_sessions().list()
}

fn files(folder: &Path) -> usize {
    std::fs::read_dir(folder).unwrap().count()
}

#[test]
fn after_a_crash_the_drawing_comes_back_untitled_and_unsaved() {
    let folder = tempfile::tempdir().unwrap();
    let session = paint(folder.path());
    assert!(find_lost(folder.path()).is_empty(), "it still lives");
    let before = crate::io::recipe::write(session.active().unwrap().document());
    crash(session);
    let left = find_lost(folder.path()).pop().unwrap();
    let mut autosave = Autosave::new(folder.path().into());
    let RestoredDocument { open, recovery, .. } =
        autosave.find_lost_sessions().bring_back(left, &Progress::default()).unwrap().unwrap();
    assert_eq!((open.title().as_str(), &open.file), ("Untitled 1 (recovered)", &None));
    assert!(open.is_dirty());
    assert_eq!(crate::io::recipe::write(open.document()), before);
    autosave.adopt(&open, recovery.unwrap());
    assert!(autosave.follow(std::slice::from_ref(&open), ToolKind::Brush).is_none());
    assert!(find_lost(folder.path()).is_empty(), "now it lives here");
    // A second crash loses nothing either.
    drop(autosave);
    assert_eq!(find_lost(folder.path()).len(), 1);
}

#[test]
fn a_program_that_is_just_dying_is_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    crash(paint(folder.path()));
    for entry in std::fs::read_dir(folder.path()).unwrap().flatten() {
        // As if another process had written it.
        let extension = entry.path().extension().unwrap().to_owned();
        std::fs::rename(entry.path(), folder.path().join("0-1-0").with_extension(extension))
            .unwrap();
    }
    let lock = Disk.lock(&folder.path().join("0-1-0.lock")).unwrap().unwrap();
    let dying = std::thread::spawn(move || {
        Disk.pause(3 * LOOK_AGAIN);
        drop(lock);
    });
    assert_eq!(find_lost(folder.path()).len(), 1);
    dying.join().unwrap();
}

#[test]
fn what_is_closed_or_never_was_touched_is_not_offered() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = paint(folder.path());
    Action::File(FileAction::Close { index: 0 }).apply(&mut session).unwrap();
    session.keep();
    assert_eq!(files(folder.path()), 0, "given up by its user");
    session.replay(Path::new("story"), STORY.lines().next().unwrap()).unwrap();
    session.keep();
    crash(session);
    assert!(
        files(folder.path()) > 0 && find_lost(folder.path()).is_empty(),
        "a new canvas nobody painted on"
    );
    assert_eq!(files(folder.path()), 0);
}

#[test]
fn what_a_file_holds_is_offered_only_if_the_file_is_another_now() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.ora");
    let logs = folder.path().join("logs");
    for is_changed in [false, true] {
        let _ = std::fs::remove_file(&file);
        let mut session = paint(&logs);
        Action::File(FileAction::Save { file: file.clone() }).apply(&mut session).unwrap();
        session.keep();
        crash(session);
        if is_changed {
            std::fs::write(&file, "another program's").unwrap();
        }
        let left = find_lost(&logs);
        assert_eq!(left.len(), usize::from(is_changed));
        assert!(
            left.iter().all(|left| left.title == "a.ora" && left.file.as_deref() == Some(&*file))
        );
    }
}

#[test]
fn an_edit_after_saving_is_offered() {
    let folder = tempfile::tempdir().unwrap();
    let (file, logs) = (folder.path().join("a.ora"), folder.path().join("logs"));
    let mut session = paint(&logs);
    Action::File(FileAction::Save { file }).apply(&mut session).unwrap();
    session.keep();
    session
        .replay(Path::new("story"), &STORY.lines().skip(1).collect::<Vec<_>>().join("\n"))
        .unwrap();
    session.keep();
    crash(session);
    assert_eq!(find_lost(&logs).len(), 1);
}

#[test]
fn the_program_ends_as_it_should_and_leaves_only_what_is_unsaved() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = paint(folder.path());
    session.replay(Path::new("story"), STORY.lines().next().unwrap()).unwrap();
    let Session { open_documents, autosave, .. } = &mut session;
    autosave.as_mut().unwrap().close(open_documents, ToolKind::Brush);
    drop(session);
    let left = find_lost(folder.path());
    assert_eq!(left.len(), 1);
    assert_eq!(left[0].title, "Untitled 1");
}

#[test]
fn a_folder_that_cannot_be_had_is_told_once_and_tried_again() {
    let folder = tempfile::tempdir().unwrap();
    let logs = folder.path().join("logs");
    std::fs::write(&logs, "in the way").unwrap();
    let mut session = paint(&logs);
    assert!(
        session.notes.iter().any(|note| note.contains("logs") && note.contains("saved")),
        "{:?}",
        session.notes
    );
    session.notes.clear();
    session.keep();
    assert!(session.notes.is_empty());
    std::fs::remove_file(&logs).unwrap();
    session
        .replay(Path::new("story"), &STORY.lines().skip(1).collect::<Vec<_>>().join("\n"))
        .unwrap();
    session.keep();
    assert!(session.notes.is_empty());
    crash(session);
    assert_eq!(find_lost(&logs).len(), 1);
}

#[test]
fn what_was_selected_and_in_hand_comes_back_with_the_drawing() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = paint(folder.path());
    let story = r#"{"in":"layer","do":"add","kind":"paint"}
{"in":"layer","do":"paint mask","layer":"0","hides":false}
{"in":"hand","do":"tool","tool":"eraser"}
{"in":"pointer","do":"press","tool":"eraser","pen":[20,30],"px_per_pt":1}
{"in":"pointer","do":"drag","pens":[[60,44]]}
{"in":"pointer","do":"release"}"#;
    session.replay(Path::new("story"), story).unwrap();
    session.keep();
    crash(session);
    let RestoredDocument { open, tool, .. } = Autosave::new(folder.path().into())
        .find_lost_sessions()
        .bring_back(find_lost(folder.path()).pop().unwrap(), &Progress::default())
        .unwrap()
        .unwrap();
    let selected = open.document().layer(open.active_layer.unwrap()).unwrap();
    assert_eq!(
        (selected.name.as_str(), open.on_mask, tool),
        ("Background", true, Some(ToolKind::Eraser))
    );
}
