//! Commands never overwrite what they read, and nothing else without being told to. Runs the real
//! program.

use super::program::program;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use tempfile::TempDir;

/// A recipe made from a photo, a brush tip, a map and a mask, and links to some of them.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for (i, name) in ["photo.png", "tip.png", "n.png", "m.png"].into_iter().enumerate() {
        let color = if name == "n.png" { [128, 128, 255] } else { [40 + 60 * i as u8; 3] };
        image::RgbImage::from_pixel(16, 16, image::Rgb(color)).save(at(name)).unwrap();
    }
    let recipe = r##"{ "surface": { "normal": { "file": "n.png", "convention": "opengl" } }, "layers": [
        { "name": "photo", "kind": "image", "source": { "file": "photo.png" }, "mask": { "file": "m.png" } },
        { "name": "marks", "kind": "strokes",
          "strokes": [{ "brush": { "size": 4, "tip": { "file": "tip.png" } }, "samples": [[2, 3], [12, 9]] }] } ] }"##;
    fs::write(at("r.json"), recipe).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("tip.png", at("soft.png")).unwrap();
    fs::hard_link(at("photo.png"), at("hard.png")).unwrap();
    folder
}
const SOURCES: [&str; 5] = ["r.json", "photo.png", "tip.png", "n.png", "m.png"];

fn run(folder: &Path, args: &[&str]) -> Output {
    program().args(args).current_dir(folder).output().unwrap()
}

fn done(folder: &Path, args: &[&str]) {
    let output = run(folder, args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// It fails with exit code 1 and a sentence with these words.
fn refused(folder: &Path, args: &[&str], words: &str) {
    let output = run(folder, args);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{args:?}: {said}");
    assert!(said.contains(words), "{args:?}: {said}");
}

fn bytes(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.into_iter().map(|file| (file.clone(), fs::read(file).unwrap_or_default())).collect()
}

#[test]
fn no_command_writes_over_what_its_document_reads_not_even_with_force() {
    let folder = folder();
    let before = bytes(folder.path());
    let mut targets: Vec<&str> = SOURCES.into_iter().filter(|name| name.ends_with("png")).collect();
    targets.push("hard.png");
    if cfg!(unix) {
        targets.push("soft.png");
    }
    for to in targets {
        for force in [&[][..], &["--force"]] {
            for command in [
                &["convert", "r.json", to][..],
                &["render", "r.json", "-o", to],
                &["view", "r.json", "-o", to],
            ] {
                refused(
                    folder.path(),
                    &[command, force].concat(),
                    "an open document was made from it",
                );
            }
            let story = format!(
                "{{\"in\":\"file\",\"do\":\"open\",\"file\":\"r.json\"}}\n\
                 {{\"in\":\"file\",\"do\":\"export\",\"file\":\"{to}\",\"background\":null,\"quality\":90}}"
            );
            let story_file = folder.path().join("story");
            fs::write(&story_file, story).unwrap();
            refused(
                folder.path(),
                &[&["replay", "story"][..], force].concat(),
                "an open document was made from it",
            );
            fs::remove_file(story_file).unwrap();
        }
    }
    assert_eq!(bytes(folder.path()), before);
}

#[test]
fn files_that_are_there_are_replaced_with_force_alone() {
    let folder = folder();
    let there = |name: &str| {
        fs::write(folder.path().join(name), "somebody's").unwrap();
        folder.path().join(name)
    };
    for (command, to) in [
        (&["convert", "r.json", "out.png"][..], "out.png"),
        (&["convert", "r.json", "out.psd"], "out.psd"),
        (&["convert", "r.json", "x.png", "--layers"], "x-00-photo.png"),
        (&["convert", "r.json", "deep.exr", "--layers"], "deep.exr"),
        (&["render", "r.json", "-o", "painted.png"], "painted.png"),
        (&["view", "r.json", "-o", "sheet.png"], "sheet.png"),
        (&["brush", "chalk", "brush.json"], "brush.json"),
        (&["brush", "chalk", "ball.png"], "ball.png"),
    ] {
        let file = there(to);
        let before = bytes(folder.path());
        refused(folder.path(), command, "--force replaces it");
        assert_eq!(
            bytes(folder.path()),
            before,
            "{command:?}: all is as it was, and nothing is new"
        );
        done(folder.path(), &[command, &["--force"]].concat());
        assert_ne!(fs::read(&file).unwrap(), b"somebody's", "{command:?}");
    }
    let left = bytes(folder.path())
        .into_iter()
        .filter(|(file, _)| file.to_string_lossy().contains(".rilievo-"));
    assert_eq!(left.count(), 0);
}

#[test]
fn every_view_of_a_folder_is_drawn_or_none() {
    let folder = folder();
    let views = folder.path().join("views");
    fs::create_dir(&views).unwrap();
    done(folder.path(), &["view", "r.json", "-o", "views"]);
    let drawn = bytes(&views);
    assert!(drawn.len() > 1);
    drawn.iter().skip(1).for_each(|(file, _)| fs::remove_file(file).unwrap());
    refused(folder.path(), &["view", "r.json", "-o", "views"], "--force replaces it");
    assert_eq!(bytes(&views).len(), 1);
    done(folder.path(), &["view", "r.json", "-o", "views", "--force"]);
    assert_eq!(bytes(&views), drawn);
}

#[test]
fn a_project_is_replaced_with_force_alone_and_keeps_its_previous_version() {
    let folder = folder();
    done(folder.path(), &["convert", "r.json", "a.ora"]);
    fs::write(folder.path().join("b.ora"), "the old one").unwrap();
    refused(folder.path(), &["convert", "a.ora", "b.ora"], "--force replaces it");
    assert_eq!(fs::read(folder.path().join("b.ora")).unwrap(), b"the old one");
    assert!(!folder.path().join("b.ora~").exists());
    done(folder.path(), &["convert", "a.ora", "b.ora", "--force"]);
    assert_eq!(fs::read(folder.path().join("b.ora~")).unwrap(), b"the old one");
}

#[test]
fn a_replay_saves_over_another_file_with_force_alone_and_over_its_own_as_often_as_it_likes() {
    let folder = folder();
    let save = r#"{"in":"file","do":"save","file":"mine.ora"}"#;
    let new = r#"{"in":"file","do":"new","width":20,"height":10,"background":null}"#;
    let add = r#"{"in":"layer","do":"add","kind":"paint"}"#;
    fs::write(folder.path().join("story"), [new, save, add, save].join("\n")).unwrap();
    fs::write(folder.path().join("mine.ora"), "somebody's").unwrap();
    let before = bytes(folder.path());
    refused(folder.path(), &["replay", "story"], "--force replaces it");
    assert_eq!(bytes(folder.path()), before);
    done(folder.path(), &["replay", "story", "--force"]);
    fs::remove_file(folder.path().join("mine.ora")).unwrap();
    done(folder.path(), &["replay", "story"]);
    assert_ne!(fs::read(folder.path().join("mine.ora")).unwrap(), b"somebody's");
}

#[test]
fn a_brush_does_not_take_the_place_of_its_own_tip() {
    let folder = folder();
    let brush = r#"{ "name": "Leaf", "brush": { "size": 20, "tip": { "file": "tip.png" } } }"#;
    fs::write(folder.path().join("leaf.json"), brush).unwrap();
    let before = bytes(folder.path());
    // Its picture would be written as tip.png.
    refused(
        folder.path(),
        &["brush", "leaf.json", "tip.json", "--force"],
        "an open document was made from it",
    );
    refused(
        folder.path(),
        &["brush", "leaf.json", "tip.png", "--force"],
        "an open document was made from it",
    );
    refused(
        folder.path(),
        &["brush", "leaf.json", "leaf.json", "--force"],
        "an open document was made from it",
    );
    assert_eq!(bytes(folder.path()), before);
    done(folder.path(), &["brush", "leaf.json", "copy.json"]);
}

#[cfg(unix)]
#[test]
fn links_that_lead_nowhere_and_read_only_files_stay_what_they_are() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = folder();
    symlink("nowhere.png", folder.path().join("link.png")).unwrap();
    refused(folder.path(), &["convert", "r.json", "link.png", "--force"], "broken link");
    assert!(fs::symlink_metadata(folder.path().join("link.png")).unwrap().is_symlink());
    for to in ["kept.png", "kept.ora"] {
        let file = folder.path().join(to);
        fs::write(&file, "kept").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o444)).unwrap();
        refused(folder.path(), &["convert", "r.json", to], "--force replaces it");
        assert_eq!(fs::read(&file).unwrap(), b"kept");
        done(folder.path(), &["convert", "r.json", to, "--force"]);
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o444);
    }
}

#[test]
fn names_of_layers_do_not_steer_the_terminal() {
    let folder = folder();
    let recipe = r##"{ "canvas": { "width": 8, "height": 8 },
        "layers": [{ "name": "a\u001b[31mred\u0007", "kind": "fill", "color": "#ffff00" }] }"##;
    fs::write(folder.path().join("esc.json"), recipe).unwrap();
    let output = run(folder.path(), &["info", "esc.json"]);
    assert!(output.status.success());
    assert!(!output.stdout.iter().any(|b| b.is_ascii_control() && *b != b'\n'));
    assert!(String::from_utf8_lossy(&output.stdout).contains("red"));
}

#[test]
fn a_recipe_in_utf16_is_called_so() {
    let folder = folder();
    let text = fs::read_to_string(folder.path().join("r.json")).unwrap();
    let bytes: Vec<u8> =
        format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    fs::write(folder.path().join("wide.json"), bytes).unwrap();
    refused(folder.path(), &["render", "wide.json", "-o", "o.png"], "UTF-16");
    refused(folder.path(), &["info", "wide.json"], "UTF-16");
}
