//! Parts are read, refused, written and read again.

use crate::document::{Document, Progress};
use crate::project;
use crate::recipe::{self, RecipeSource};
use crate::{Budget, RecipeFolder};
use serde_json::{Value, json};
use std::path::Path;

fn read(parts: &Value) -> crate::Result<Document> {
    let folder = tempfile::tempdir().unwrap();
    let mask =
        image::GrayImage::from_fn(48, 40, |x, y| image::Luma([((x * 9 + y * 5) % 256) as u8]));
    mask.save(folder.path().join("mask.png")).unwrap();
    let normals = image::RgbImage::from_fn(48, 40, |x, y| {
        let (x, y) = ((x as f32 - 24.0) / 40.0, (20.0 - y as f32) / 40.0);
        let z = (1.0 - x * x - y * y).sqrt();
        image::Rgb([x, y, z].map(|v| ((v * 0.5 + 0.5) * 255.0).round() as u8))
    });
    normals.save(folder.path().join("n.png")).unwrap();
    let value = json!({
        "format": "rilievo", "version": 2, "canvas": { "width": 48, "height": 40 },
        "surface": { "parts": parts },
        "layers": [{ "kind": "fill", "name": "Flats", "color": "#c08040" }],
    });
    let file = folder.path().join("r.json");
    let files = RecipeFolder::folder_of(&file);
    let source =
        RecipeSource { file: &file, files: &files, budget: &Budget::default(), onto: None };
    recipe::read(value.to_string().as_bytes(), source)
}

/// One of every kind, no number at its default.
fn every_kind() -> Value {
    let path = json!({ "path": [[4, 4], [40, 6], [30, 36]] });
    json!([
        { "id": "body", "name": "Body", "kind": "inflate", "outline": { "layer": "Flats", "color": "#c08040" },
          "puff": 0.5, "profile": 0.25, "rim": 70, "tilt": [3, -4], "raise": 2, "matrix": [1, 0.1, -0.1, 1, 3.5, 2] },
        { "id": "a", "kind": "bevel", "outline": path, "width": 6, "height": 3, "curve": "cove", "combine": "union",
          "smooth": 3, "visible": false },
        { "id": "b", "kind": "bevel", "outline": { "file": "mask.png" }, "curve": [[0, 0], [0.5, 0.8], [1, 1]] },
        { "id": "c", "kind": "primitive", "shape": "torus", "center": [20, 20], "radius": 12, "half": [3, 4, 5],
          "length": 9, "tube": 3, "round": 1, "turn": [10, 20, 30], "combine": "add" },
        { "id": "d", "kind": "lathe", "outline": path, "axis": [[20, 0], [20, 40]], "puff": 0.7, "combine": "cut" },
        { "id": "e", "kind": "sweep", "balls": [[5, 5, 4], [30, 20, 2.5]], "puff": 1.2, "combine": "join" },
        { "id": "f", "kind": "touches", "on": "body",
          "touches": [{ "at": [20, 20], "radius": 3, "normal": [0.6, 0, 0.8], "reach": 9 }] },
        { "id": "g", "kind": "sculpt", "on": "body", "strokes": [
          { "tool": "pinch", "size": 9, "hardness": 0.2, "strength": 0.4, "samples": [[9, 9], [20, 12, 0.5]] }] },
        { "id": "h", "kind": "relief", "on": "body", "file": "mask.png", "coarse": 2, "fine": 1,
           "radius": 5, "edge": 0.1 },
        { "id": "i", "kind": "lines", "on": "body", "outline": path, "form": "over", "angle": 60, "reach": 8 },
        { "id": "j", "kind": "profiles", "pictures": [
          { "file": "mask.png", "light": [0.5, 0, 1] }, { "file": "mask.png", "light": [-0.5, 0.25, 1] }] },
        { "id": "k", "kind": "maps", "normal": { "file": "n.png", "convention": "opengl" },
          "matrix": [0.8, 0.6, -0.6, 0.8, 12, -4] },
    ])
}

#[test]
fn every_kind_is_read_and_written_as_it_was() {
    let document = read(&every_kind()).unwrap();
    assert!(document.surface.is_some());
    let written = recipe::write(&document);
    assert_eq!(written["version"], 2);
    assert_eq!(written["surface"]["parts"], every_kind());
}

#[test]
fn a_project_gives_parts_back_with_the_same_surface() {
    let document = read(&every_kind()).unwrap();
    let file = Path::new("a.ora");
    let bytes = project::write(file, &document, &Progress::default()).unwrap().unwrap();
    let back = project::read(file, &bytes, &Budget::default()).unwrap();
    assert!(back.is_whole && back.notes.is_empty(), "{:?}", back.notes);
    assert_eq!(document.difference(&back.document), None);
    let (a, b) = (document.surface.unwrap(), back.document.surface.clone().unwrap());
    assert!(a.depth_plane() == b.depth_plane() && a.coverage_plane() == b.coverage_plane());
    assert_eq!(project::write(file, &back.document, &Progress::default()).unwrap().unwrap(), bytes);
    // Differences are reported.
    let mut other = back.document.parts.list.clone();
    other.pop();
    assert!(
        back.document
            .difference(&back.document.with_parts(other))
            .is_some_and(|what| what.contains("parts"))
    );
}

#[test]
fn a_place_of_a_color_is_written_read_and_told_of_when_its_color_is_gone() {
    let part = json!([{ "id": "eye", "name": "eye", "kind": "inflate",
        "outline": { "layer": "Flats", "color": "#c08040", "at": [12.5, 9] } }]);
    let document = read(&part).unwrap();
    assert!(document.parts.lost.is_empty() && document.surface.is_some());
    assert_eq!(recipe::write(&document)["surface"]["parts"][0]["outline"], part[0]["outline"]);
    let file = Path::new("a.ora");
    let stored = |document: &Document| {
        project::write(file, document, &Progress::default()).unwrap().unwrap()
    };
    let back = project::read(file, &stored(&document), &Budget::default()).unwrap();
    assert!(back.is_whole && back.notes.is_empty(), "{:?}", back.notes);
    assert_eq!(document.difference(&back.document), None);
    // Beyond the canvas nothing has the color.
    let mut away = part.clone();
    away[0]["outline"]["at"] = json!([300, -50]);
    let back = project::read(file, &stored(&read(&away).unwrap()), &Budget::default()).unwrap();
    assert!(
        back.notes.iter().any(|note| note.contains("“eye” takes the area")),
        "{:?}",
        back.notes
    );
    assert_eq!(
        recipe::write(&back.document)["surface"]["parts"][0]["outline"]["at"],
        json!([300, -50])
    );
}

#[test]
fn without_parts_the_first_version_is_written() {
    let document = read(&json!([])).unwrap();
    assert!(document.surface.is_none());
    let written = recipe::write(&document);
    assert_eq!((&written["version"], &written["surface"]), (&json!(1), &Value::Null));
}

#[test]
fn what_is_wrong_is_named_with_its_path() {
    let says = |part: Value, what: &str| {
        let said = read(&json!([part])).map(|_| ()).unwrap_err().to_string();
        assert!(said.contains(what), "{said}");
    };
    let layer = json!({ "layer": "Flats" });
    says(
        json!({ "kind": "inflate", "outline": layer, "puff": 99 }),
        "surface.parts[0].puff: is 99; it must be between",
    );
    says(
        json!({ "kind": "inflate", "outline": layer, "pufff": 1 }),
        "surface.parts[0].pufff: is unknown; did you mean",
    );
    says(json!({ "kind": "inflate" }), "surface.parts[0].outline: is missing");
    says(
        json!({ "kind": "inflate", "outline": {} }),
        "names no layer, file, selection, path or object",
    );
    says(json!({ "kind": "inflate", "outline": { "file": "../mask.png" } }), "is refused");
    says(
        json!({ "kind": "inflate", "outline": { "path": [[0, 0], [1, 1e30]] } }),
        "must be between",
    );
    let nowhere = json!({ "layer": "Flats", "at": [1, 2] });
    says(json!({ "kind": "inflate", "outline": nowhere }), "but no color");
    let far = json!({ "layer": "Flats", "color": "#c08040", "at": [1, 1e30] });
    says(json!({ "kind": "inflate", "outline": far }), "surface.parts[0].outline.at");
    says(json!({ "kind": "balloon" }), "must be one of inflate, bevel, primitive");
    says(json!({ "kind": "bevel", "outline": layer, "curve": [[0.5, 0], [0.2, 1]] }), "farther in");
    says(json!({ "kind": "sweep", "balls": [[1, 2, -3]] }), "radius of a ball");
    let light = json!({ "file": "mask.png", "light": [0, 0, 0] });
    says(
        json!({ "kind": "profiles", "pictures": [light] }),
        "it has 1 shadings; there must be 2 to 5",
    );
    says(json!({ "kind": "profiles", "pictures": [light, light] }), "has no length");
    says(
        json!({ "kind": "maps", "mask": { "file": "mask.png" } }),
        "neither a normal map nor a depth map",
    );
    says(json!({ "kind": "maps", "normal": { "file": "../n.png" } }), "is refused");
    says(
        json!({ "kind": "lines", "on": "a", "outline": layer, "form": "edge" }),
        "must be one of ridge, valley",
    );
    says(
        json!({ "kind": "sweep", "balls": [[9, 9, 3]], "matrix": [1, 2, 2, 4, 0, 0] }),
        "cannot be inverted",
    );
    let twice = json!({ "id": "x", "kind": "sweep", "balls": [[9, 9, 3]] });
    assert!(
        read(&json!([twice, twice]))
            .map(|_| ())
            .unwrap_err()
            .to_string()
            .contains("another part has")
    );
}
