//! Scripts that are opened like documents: each is played in a session of its own, beside what the
//! user has open, and writes no files. Floor 6. Not here: `rilievo replay`, which does all that a
//! script says (`cli`).

use super::actions::Action;
use super::{OpenDocument, Session, replay};
use crate::Result;
use crate::document::Progress;
use crate::io::{Budget, files::read_file, platform};
use std::path::Path;

/// What a script leaves.
pub struct PlayedScript {
    /// The documents that it left open, with its steps in their history; the one in front is the
    /// last.
    pub open_documents: Vec<OpenDocument>,
    /// Sentences about what was refused, and about what was found in files.
    pub notes: Vec<String>,
    /// How many of its lines would have written a file, and were skipped.
    pub skipped: usize,
}

/// Plays a script; `None` if canceled. A relative name of a file begins in the folder of the script
/// if it leads to a file there, else in the current folder.
pub fn play(script: &Path, progress: &Progress) -> Result<Option<PlayedScript>> {
    let text = read_file(script, Budget::of_this_machine().json_bytes)?;
    let mut actions: Vec<Action> = replay::lines(script, &String::from_utf8_lossy(&text))?;
    progress.add_total(actions.len() as u64);
    let (mut session, mut skipped) = (Session::default(), 0);
    for action in &mut actions {
        if progress.is_canceled() {
            return Ok(None);
        }
        if action.has_output() {
            skipped += 1;
        } else {
            find_beside(script, action);
            action.apply(&mut session)?;
        }
        progress.step();
    }
    Ok(Some(finish(session, skipped)))
}

/// Completes the names of files that are in the folder of the script.
fn find_beside(script: &Path, action: &mut Action) {
    for file in action.files_mut() {
        let beside = script.with_file_name(&*file);
        if file.is_relative() && platform::is_file(&beside) {
            *file = beside;
        }
    }
}

/// What a session leaves when its script ends.
fn finish(mut session: Session, skipped: usize) -> PlayedScript {
    session.drop_gesture();
    let mut open_documents = std::mem::take(&mut session.open_documents);
    if session.current < open_documents.len() {
        let in_front = open_documents.remove(session.current);
        open_documents.push(in_front);
    }
    PlayedScript { open_documents, notes: session.notes, skipped }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    /// A folder with a picture, and a script of these lines in it.
    fn script(lines: &str) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        image::RgbaImage::new(8, 6).save(folder.path().join("picture.png")).unwrap();
        let file = folder.path().join("story.jsonl");
        std::fs::write(&file, lines).unwrap();
        (folder, file)
    }

    #[test]
    fn a_script_leaves_documents_with_their_history_and_writes_nothing() {
        let (folder, file) = script(concat!(
            "# two documents\n",
            r#"{"in":"file","do":"open","file":"picture.png"}"#,
            "\n",
            r#"{"in":"layer","do":"add","kind":"paint"}"#,
            "\n",
            r#"{"in":"file","do":"new","width":4,"height":3}"#,
            "\n",
            r#"{"in":"file","do":"tab","index":0}"#,
            "\n",
            r#"{"in":"file","do":"export","file":"out.png","quality":92}"#,
            "\n",
            r#"{"in":"file","do":"save","file":"out.ora"}"#,
            "\n",
        ));
        let played = play(&file, &Progress::default()).unwrap().unwrap();
        let sizes = played.open_documents.iter().map(|open| open.document().size.width);
        assert_eq!(sizes.collect::<Vec<_>>(), [4, 8], "the one in front is last");
        let steps = played.open_documents[1].history.past_names().count();
        assert_eq!((steps, played.skipped, played.notes.len()), (1, 2, 0), "{:?}", played.notes);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
        assert!(!Path::new("out.png").exists() && !Path::new("out.ora").exists());
    }

    #[test]
    fn a_wrong_line_and_a_missing_file_are_errors_and_a_canceled_script_leaves_nothing() {
        for (line, about) in [
            ("{\"in\":\"layer\",\"do\":\"juggle\"}", "line 1"),
            (r#"{"in":"file","do":"open","file":"none.png"}"#, "none.png"),
            (r#"{"in":"file","do":"open","file":"story.jsonl"}"#, "script"),
        ] {
            let (_folder, file) = script(line);
            let error = play(&file, &Progress::default()).err().expect(line).to_string();
            assert!(error.contains(about), "{error}");
        }
        let (_folder, file) = script(r#"{"in":"file","do":"new","width":4,"height":3}"#);
        let progress = Progress::default();
        progress.cancel();
        assert!(play(&file, &progress).unwrap().is_none());
    }
}
