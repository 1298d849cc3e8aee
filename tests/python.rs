//! The package of `dist/python` beside the program: its own tests, and the example of its page; and
//! the add-on of `dist/blender`, the plug-in of `dist/krita` and the extension of `dist/aseprite`.
//! Skipped, and said so, where there is no Python, no Blender in it, no Krita or no Lua.

use super::program::in_english;
use std::path::Path;
use std::process::Command;

/// Runs Python in a folder, with our package and program; `None` if it is not installed.
fn python(folder: &Path, args: &[&str]) -> Option<()> {
    let is_there = Command::new("python3").arg("--version").output();
    if !is_there.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: python3 is not installed, or cannot run here");
        return None;
    }
    let output = in_english(Command::new("python3"))
        .args(args)
        .current_dir(folder)
        .env("RILIEVO", env!("CARGO_BIN_EXE_rilievo"))
        .env("PYTHONPATH", root().join("dist/python"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(())
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_package_does_what_its_tests_say() {
    python(root(), &["-m", "unittest", "discover", "dist/python/tests"]);
}

#[test]
fn the_example_of_its_page_runs() {
    let page = std::fs::read_to_string(root().join("dist/python/README.md")).unwrap();
    let example = page.split("```python\n").nth(1).and_then(|rest| rest.split("```").next());
    let example = example.expect("the page has an example");
    let folder = tempfile::tempdir().unwrap();
    let sample = "sample_normals/rocket/flats.png";
    std::fs::create_dir_all(folder.path().join(sample).parent().unwrap()).unwrap();
    std::fs::copy(root().join(sample), folder.path().join(sample)).unwrap();
    if python(folder.path(), &["-c", example]).is_some() {
        for made in ["rocket.ora", "rocket.png"] {
            assert!(folder.path().join(made).is_file(), "{made} was not written");
        }
    }
}

#[test]
fn the_add_on_of_blender_renders_maps_that_are_read_as_they_are_meant() {
    if !Command::new("python3")
        .args(["-c", "import bpy"])
        .output()
        .is_ok_and(|o| o.status.success())
    {
        return eprintln!("skipped: python3 has no bpy (Blender as a package)");
    }
    let _ = python(root(), &["dist/blender/test.py", env!("CARGO_BIN_EXE_rilievo")]);
}

#[test]
fn the_plug_in_of_krita_takes_a_relit_drawing_back() {
    let is_there =
        Command::new("kritarunner").arg("--version").env("QT_QPA_PLATFORM", "offscreen").output();
    if !is_there.is_ok_and(|output| output.status.success()) {
        return eprintln!("skipped: kritarunner is not installed");
    }
    let _ = python(root(), &["dist/krita/test.py", env!("CARGO_BIN_EXE_rilievo")]);
}

#[test]
fn the_extension_of_aseprite_lights_the_frames_of_a_sprite() {
    let is_there =
        |lua: &&str| Command::new(lua).arg("-v").output().is_ok_and(|o| o.status.success());
    // Lua 5.3 has the integers that the test counts with; `lua` may be older.
    let Some(lua) = ["lua5.4", "lua5.3"].into_iter().find(is_there) else {
        return eprintln!("skipped: neither lua5.4 nor lua5.3 is installed");
    };
    let output = in_english(Command::new(lua))
        .args(["dist/aseprite/test.lua", env!("CARGO_BIN_EXE_rilievo")])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
