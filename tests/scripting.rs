//! The scripts of `docs/SCRIPTING.md` run as they are written, and the actions that it names exist.

use rilievo_program::session::Session;
use rilievo_program::session::actions::Action;
use rilievo_program::session::replay::ReplayValue;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn page() -> String {
    fs::read_to_string(root().join("docs/SCRIPTING.md")).unwrap()
}

/// The scripts of a page.
fn scripts(page: &str) -> Vec<&str> {
    page.split("```json\n").skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// A line of a script as a value; `None` for a comment.
fn action(line: &str) -> Option<Value> {
    line.starts_with('{')
        .then(|| serde_json::from_str(line).unwrap_or_else(|e| panic!("{line}: {e}")))
}

/// A script that reads samples and writes into a folder, and the files that it writes.
fn placed(script: &str, folder: &Path) -> (String, Vec<PathBuf>) {
    let mut written = Vec::new();
    let mut lines = Vec::new();
    for mut action in script.lines().filter_map(action) {
        if let Some(name) = action["file"].as_str() {
            let is_sample = name.starts_with("sample_normals/");
            let file = if is_sample { root().join(name) } else { folder.join(name) };
            if action["do"] == "save" || action["do"] == "export" {
                written.push(file.clone());
            }
            action["file"] = file.to_str().unwrap().into();
        }
        lines.push(action.to_string());
    }
    (lines.join("\n"), written)
}

#[test]
fn every_script_of_the_page_runs() {
    let page = page();
    let scripts = scripts(&page);
    assert!(scripts.len() >= 3, "only {} scripts", scripts.len());
    for script in scripts {
        let folder = tempfile::tempdir().unwrap();
        let (script, written) = placed(script, folder.path());
        let mut session = Session::default();
        session.replay(Path::new("docs/SCRIPTING.md"), &script).unwrap();
        assert!(session.notes.is_empty(), "{:?}", session.notes);
        assert!(!written.is_empty(), "the script writes nothing: {script}");
        for file in written {
            assert!(file.is_file(), "{} was not written", file.display());
        }
    }
}

#[test]
fn every_action_that_the_page_shows_can_be_read() {
    let page = page();
    let in_text = page.split('`').filter(|part| part.starts_with("{\"in\":"));
    let lines = scripts(&page).into_iter().flat_map(str::lines).chain(in_text);
    let mut count = 0;
    for value in lines.filter_map(action) {
        let read = Action::read(&value).map(|action| action.to_value());
        let written = read.unwrap_or_else(|reason| panic!("{value}: {reason}"));
        // A field that is written but does not exist would be passed over.
        for (field, _) in value.as_object().unwrap() {
            assert!(written.get(field).is_some(), "{value}: there is no field “{field}”");
        }
        count += 1;
    }
    assert!(count > 30, "only {count} actions");
    for room in Action::ROOMS {
        assert!(page.contains(&format!("`{room}`")), "the page does not name “{room}”");
    }
}
