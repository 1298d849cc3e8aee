//! The gallery: `docs/GALLERY.md` has the command of every sample recipe and shows every picture.
//! What the pictures look like is held by `goldens::gallery`.

use rilievo_program::session::Session;
use std::fs;
use std::path::{Path, PathBuf};

/// Largest size of a gallery picture.
const MOST_BYTES: u64 = 150 * 1024;

fn in_package(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn gallery() -> String {
    fs::read_to_string(in_package("docs/GALLERY.md")).unwrap()
}

/// The files of a folder with this extension.
fn files(folder: &str, is_wanted: impl Fn(&str) -> bool) -> Vec<PathBuf> {
    let entries = fs::read_dir(in_package(folder)).unwrap().map(|entry| entry.unwrap().path());
    let wanted = |path: &PathBuf| path.extension().is_some_and(|e| is_wanted(&e.to_string_lossy()));
    let mut files: Vec<PathBuf> = entries.filter(wanted).collect();
    files.sort();
    files
}

fn recipes() -> Vec<PathBuf> {
    let recipes = files("sample_normals", |extension| extension == "json");
    assert!(recipes.len() >= 20, "only {} recipes", recipes.len());
    recipes
}

fn name(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}

#[test]
fn the_gallery_gives_the_command_for_every_recipe() {
    let gallery = gallery();
    for path in recipes() {
        let command = format!("rilievo render sample_normals/{}", name(&path));
        assert!(gallery.contains(&command), "docs/GALLERY.md has no “{command}”");
    }
}

/// A drawing becomes a finished picture, which its script writes into the current folder.
#[test]
fn every_drawing_of_the_gallery_is_finished_by_its_script() {
    let (gallery, folder) = (gallery(), tempfile::tempdir().unwrap());
    let scripts = files("sample_normals/drawings", |extension| extension == "jsonl");
    assert!(scripts.len() >= 7, "only {} scripts", scripts.len());
    for path in scripts {
        let (script, stem) = (fs::read_to_string(&path).unwrap(), path.file_stem().unwrap());
        assert!(
            gallery.contains(&format!("rilievo replay sample_normals/drawings/{}", name(&path)))
        );
        let written = folder.path().join(stem).with_extension("png");
        let shown = written.to_string_lossy().replace('\\', "/");
        let script =
            script.replace(&format!("\"{}.png\"", stem.to_string_lossy()), &format!("\"{shown}\""));
        let mut session = Session::default();
        session.replay(&path, &script).unwrap_or_else(|e| panic!("{}: {e}", name(&path)));
        assert!(written.is_file(), "{} wrote no picture: {:?}", name(&path), session.notes);
    }
}

#[test]
fn every_picture_of_the_gallery_is_shown_and_light() {
    let shown = gallery() + &fs::read_to_string(in_package("README.md")).unwrap();
    let pictures = files("docs/gallery", |extension| ["jpg", "png"].contains(&extension));
    for path in &pictures {
        assert!(
            shown.contains(&format!("](gallery/{0})", name(path)))
                || shown.contains(&format!("](docs/gallery/{0})", name(path))),
            "neither docs/GALLERY.md nor README.md shows {}",
            name(path)
        );
        let bytes = fs::metadata(path).unwrap().len();
        assert!(bytes <= MOST_BYTES, "{} has {bytes} bytes", name(path));
    }
}

#[test]
fn every_picture_that_the_gallery_shows_exists() {
    let gallery = gallery();
    let shown: Vec<&str> =
        gallery.split("](gallery/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(shown.len() >= 20, "only {} pictures are shown", shown.len());
    for picture in shown {
        assert!(
            in_package("docs/gallery").join(picture).is_file(),
            "docs/gallery/{picture} is missing"
        );
    }
}
