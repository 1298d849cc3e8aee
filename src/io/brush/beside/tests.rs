//! Files around a preset, in folders made here.

use super::*;
use crate::project::packer::ZipPacker;
use std::fs;

/// A folder with `paintoppresets`, `brushes` and `patterns`, and something outside.
fn folders() -> (tempfile::TempDir, NeighborFiles) {
    let outer = tempfile::tempdir().unwrap();
    for folder in ["krita/paintoppresets", "krita/brushes", "krita/patterns"] {
        fs::create_dir_all(outer.path().join(folder)).unwrap();
    }
    for (file, text) in [
        ("secret.png", "secret"),
        ("krita/other.png", "other"),
        ("krita/brushes/tip.png", "tip"),
        ("krita/brushes/both.png", "farther"),
        ("krita/patterns/p.pat", "pattern"),
        ("krita/paintoppresets/both.png", "nearer"),
    ] {
        fs::write(outer.path().join(file), text).unwrap();
    }
    let files = NeighborFiles::of(&outer.path().join("krita/paintoppresets/a.kpp"));
    (outer, files)
}

fn find(files: &NeighborFiles, kind: ResourceKind, name: &str) -> Option<String> {
    let found = files.find(kind, name, &Budget::default()).unwrap();
    found.map(|bytes| String::from_utf8(bytes).unwrap())
}

#[test]
fn files_lie_beside_the_preset_or_in_the_folders_beside_its_own() {
    let (_outer, files) = folders();
    assert_eq!(find(&files, ResourceKind::Tip, "tip.png").unwrap(), "tip");
    assert_eq!(find(&files, ResourceKind::Tip, "both.png").unwrap(), "nearer");
    assert_eq!(find(&files, ResourceKind::Pattern, "p.pat").unwrap(), "pattern");
    for (kind, name) in [(ResourceKind::Pattern, "tip.png"), (ResourceKind::Tip, "other.png")] {
        assert!(find(&files, kind, name).is_none(), "{name}");
    }
}

#[test]
fn nothing_outside_of_these_folders_is_read() {
    let (outer, files) = folders();
    let absolute = outer.path().join("secret.png").display().to_string();
    for name in ["../../secret.png", "../brushes/tip.png", "..", ".", "", "a\0b", &absolute] {
        let said = files.find(ResourceKind::Tip, name, &Budget::default()).unwrap_err().to_string();
        assert!(said.contains("no plain name"), "{name}: {said}");
    }
    #[cfg(unix)]
    {
        let krita = outer.path().join("krita");
        std::os::unix::fs::symlink("../../secret.png", krita.join("brushes/out.png")).unwrap();
        let said = files.find(ResourceKind::Tip, "out.png", &Budget::default()).unwrap_err();
        assert!(said.to_string().contains("is a link"), "{said}");
        fs::remove_dir_all(krita.join("patterns")).unwrap();
        fs::write(outer.path().join("q.pat"), "outside").unwrap();
        std::os::unix::fs::symlink("..", krita.join("patterns")).unwrap();
        let said = files.find(ResourceKind::Pattern, "q.pat", &Budget::default()).unwrap_err();
        assert!(said.to_string().contains("is a link"), "{said}");
    }
}

#[test]
fn a_bundle_beside_the_preset_is_asked_last() {
    let (outer, files) = folders();
    let mut packer = ZipPacker::default();
    packer.store("brushes/in.png", b"within").unwrap();
    packer.store("brushes/tip.png", b"never").unwrap();
    let bundle = outer.path().join("krita/paintoppresets/some.bundle");
    fs::write(bundle.with_file_name("broken.bundle"), "no zip").unwrap();
    fs::write(&bundle, packer.finish().unwrap()).unwrap();
    assert_eq!(find(&files, ResourceKind::Tip, "in.png").unwrap(), "within");
    assert_eq!(find(&files, ResourceKind::Tip, "tip.png").unwrap(), "tip");
    let said = files.find(ResourceKind::Tip, "none.png", &Budget::default()).unwrap_err();
    assert!(said.to_string().contains("broken.bundle"), "{said}");
    // Krita keeps bundles in a folder of their own, or in the folder of all.
    for place in ["krita/bundles/some.bundle", "krita/some.bundle"] {
        let moved = outer.path().join(place);
        fs::create_dir_all(moved.parent().unwrap()).unwrap();
        fs::copy(&bundle, &moved).unwrap();
        fs::remove_file(&bundle).ok();
        assert_eq!(find(&files, ResourceKind::Tip, "in.png").unwrap(), "within", "{place}");
        fs::rename(&moved, &bundle).unwrap();
    }
}

#[test]
fn names_with_folders_stand_for_their_last_part() {
    for (name, base) in [
        ("tip.png", Some("tip.png")),
        ("/home/me/krita/brushes/tip.png", Some("tip.png")),
        ("bundle://C:/a.bundle:patterns/p.png", Some("p.png")),
        ("C:\\krita\\tip.png", Some("tip.png")),
        ("a/..", None),
        ("a/", None),
        (".", None),
        ("", None),
    ] {
        assert_eq!(base_name(name), base, "{name}");
    }
}
