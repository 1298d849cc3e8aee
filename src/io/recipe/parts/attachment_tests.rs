//! What lies on parts, and parts of selections, are read, refused, written and read again.

use crate::document::{Document, OutlineSource, Progress};
use crate::project;
use crate::recipe::{self, RecipeSource};
use crate::{Budget, UserFiles};
use serde_json::{Value, json};
use std::path::Path;

fn read(value: &Value) -> crate::Result<Document> {
    let (files, budget) = (UserFiles::default(), Budget::default());
    let source =
        RecipeSource { file: Path::new("r.json"), files: &files, budget: &budget, onto: None };
    recipe::read_value(value, source)
}

fn refusal_of(value: &Value) -> String {
    read(value).err().map(|error| error.to_string()).unwrap_or_default()
}

fn body(more: &Value) -> Value {
    let mut value = json!({
        "format": "rilievo", "version": 2, "canvas": { "width": 48, "height": 40 },
        "surface": { "parts": [
            { "id": "body", "kind": "primitive", "shape": "sphere", "center": [20, 20], "radius": 12,
              "matrix": [1, 0, 0, 1, 5, 3] },
            { "id": "eye", "kind": "sweep", "balls": [[30, 20, 6]] } ] },
    });
    value.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    value
}

fn on_parts() -> Value {
    let brush = json!({ "size": 9 });
    let stroke = |more: Value| {
        let mut stroke =
            json!({ "brush": brush, "color": "#000000", "samples": [[9, 9], [20, 12]] });
        stroke.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        stroke
    };
    json!([
        { "name": "Base", "kind": "fill", "color": "#c08040", "on": "body" },
        { "name": "Ink", "kind": "strokes", "on": "body",
          "transform": { "matrix": [1.0, 0.0, 0.0, 1.0, 2.5, -1.0] },
          "strokes": [
            stroke(json!({})),
            stroke(json!({ "on": "eye", "transform": { "matrix": [1.0, 0.0, 0.0, 1.0, -2.0, 4.0] } })),
            stroke(json!({ "on": "canvas" })) ] },
        { "name": "All", "kind": "group", "on": "eye", "layers": [
            { "name": "Still", "kind": "fill", "color": "#000000", "on": "canvas" } ] },
    ])
}

#[test]
fn what_lies_on_parts_is_written_as_it_was_read_and_stands_where_they_stand() {
    let document = read(&body(&json!({ "layers": on_parts() }))).unwrap();
    let base = document.layer_named("Base").unwrap();
    assert_eq!(base.on.as_ref().unwrap().matrix.translation.to_array(), [5.0, 3.0]);
    let strokes = document.strokes(document.layer_named("Ink").unwrap().id);
    assert_eq!(strokes[1].attachment().unwrap().frame.part(), Some("eye"));
    assert!(strokes[2].attachment().unwrap().frame.is_canvas());
    let written = recipe::write(&document);
    let again = read(&written).unwrap();
    assert_eq!(document.difference(&again), None);
    assert_eq!(recipe::write(&again), written);
    for (i, name) in ["Base", "Ink", "All"].into_iter().enumerate() {
        assert_eq!(
            (&written["layers"][i]["name"], &written["layers"][i]["on"]),
            (&json!(name), &on_parts()[i]["on"])
        );
    }
    assert_eq!(written["layers"][1]["strokes"][1]["on"], "eye");
    assert_eq!(
        written["layers"][1]["strokes"][1]["transform"],
        on_parts()[1]["strokes"][1]["transform"]
    );
    // One that is elsewhere makes a different document.
    let moved = document.with_layer(base.id, |layer| layer.on = None).unwrap();
    assert!(moved.difference(&again).is_some_and(|what| what.contains("attachment")));
}

#[test]
fn a_project_gives_attachments_back() {
    let document = read(&body(&json!({ "layers": on_parts() }))).unwrap();
    let file = Path::new("a.ora");
    let bytes = project::write(file, &document, &Progress::default()).unwrap().unwrap();
    let back = project::read(file, &bytes, &Budget::default()).unwrap();
    assert!(back.is_whole && back.notes.is_empty(), "{:?}", back.notes);
    assert_eq!(document.difference(&back.document), None);
    assert_eq!(project::write(file, &back.document, &Progress::default()).unwrap().unwrap(), bytes);
}

#[test]
fn an_attachment_to_no_part_is_refused_by_its_path() {
    let says = |layers: Value| refusal_of(&body(&json!({ "layers": layers })));
    let fill = json!({ "kind": "fill", "on": "nose" });
    assert_eq!(
        says(json!([fill])),
        "r.json: layers[0].on: is “nose”; there is no part with that id"
    );
    let strokes = |stroke: Value| says(json!([{ "kind": "strokes", "strokes": [stroke] }]));
    assert_eq!(
        strokes(json!({ "on": "nose" })),
        "r.json: layers[0].strokes[0].on: is “nose”; there is no part with that id"
    );
    let quad = json!({ "quad": [[0, 0], [9, 0], [9, 9], [0, 9]] });
    assert!(
        strokes(json!({ "on": "eye", "transform": quad }))
            .contains("strokes[0].transform: must be a matrix")
    );
    assert!(
        strokes(json!({ "transform": { "matrix": [1, 0, 0, 1, 2, 2] } }))
            .contains("have their own “on”")
    );
    let canvas = json!([{ "id": "canvas", "kind": "sweep", "balls": [[9, 9, 3]] }]);
    assert!(
        refusal_of(&body(&json!({ "surface": { "parts": canvas } })))
            .contains("cannot have the id")
    );
}

#[test]
fn a_layer_on_the_canvas_stays_so_outside_of_groups_too() {
    let plain = json!({ "format": "rilievo", "version": 2, "canvas": { "width": 48, "height": 40 },
        "layers": [{ "kind": "fill", "color": "#000000", "on": "canvas" }] });
    let document = read(&plain).unwrap();
    assert!(document.layers[0].on.as_ref().is_some_and(|attachment| attachment.is_canvas()));
    assert_eq!(recipe::write(&document), plain);
}

#[test]
fn a_part_may_be_made_of_a_selection_in_whatever_order_they_stand() {
    let part =
        |id: &str| json!([{ "id": "spot", "kind": "inflate", "outline": { "selection": id } }]);
    let region = json!({ "kind": "depth", "at": [24, 20], "tolerance": 0.5 });
    let with = |id: &str, selections: Value| {
        body(&json!({ "surface": { "parts": part(id) }, "selections": selections }))
    };
    // One without bounds covers the canvas.
    let document = read(&with("s1", json!([{ "id": "s1", "name": "Spot" }]))).unwrap();
    let outline = document.parts.list[0].outline().unwrap();
    assert!(matches!(outline, OutlineSource::Selection(name) if name == "Spot"));
    assert!(document.surface.as_ref().unwrap().coverage(24, 20) == 255);
    let written = recipe::write(&document);
    assert_eq!(written["surface"]["parts"][0]["outline"], json!({ "selection": "s1" }));
    // Without a name it is kept by its id; one that follows the surface is found on the maps.
    let unnamed =
        read(&with("s7", json!([{ "id": "s3" }, { "id": "s7", "mask": region }]))).unwrap();
    assert_eq!(
        unnamed.selections.iter().map(|kept| kept.name.as_str()).collect::<Vec<_>>(),
        ["s7"]
    );
    assert!(unnamed.surface.is_some() && unnamed.fits(None) == Ok(()));
    assert_eq!(
        refusal_of(&with("s2", json!([]))),
        "r.json: surface.parts[0].outline.selection: is “s2”; there is no selection with that id"
    );
    // It stays linked, and is a picture once the selection is gone.
    let gone = document.without_kept_selection("Spot").unwrap();
    assert!(matches!(gone.parts.list[0].outline(), Some(OutlineSource::File(_))));
    assert!(gone.surface.is_some() && gone.fits(None) == Ok(()));
}
