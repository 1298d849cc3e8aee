//! Replays and documents have one language: a document writes what an edit sets in the words of the
//! edit.

use super::held::everything;
use super::*;
use crate::io::recipe;
use crate::session::replay::ReplayValue;
use serde_json::{Value, json};

/// A property that is set on one of the layers of [`everything`], its field that holds the value,
/// and where a document holds it.
fn cases() -> Vec<(usize, Value, &'static str, &'static str)> {
    let light =
        json!({ "kind": "point", "position": [3, 4.5, 20], "color": "#ffeedd", "intensity": 2 });
    let far = json!({ "kind": "directional", "direction": [1, 0.5, 2] });
    vec![
        (
            1,
            json!({ "do": "operator", "operator": { "kind": "normal", "alpha": 0.25, "beta": 2.5 } }),
            "operator",
            "",
        ),
        (
            2,
            json!({ "do": "operator", "operator": { "kind": "depth", "gamma": 0.5 } }),
            "operator",
            "",
        ),
        (
            1,
            json!({ "do": "anchors", "anchors": [{ "at": [1, 2], "source": [3.5, 4] }, { "at": [5, 6] }] }),
            "anchors",
            "",
        ),
        (
            1,
            json!({ "do": "pieces", "pieces": [{ "at": [1, 2], "move": [3, 4], "rotation": 30 }] }),
            "pieces",
            "",
        ),
        (
            2,
            json!({ "do": "pieces", "pieces": [{ "at": [1, 2], "move": [3, 4], "scale": 2 }] }),
            "pieces",
            "",
        ),
        (
            1,
            json!({ "do": "placement", "placement": { "center": [4, 5], "scale": 2, "rotation": 15 } }),
            "placement",
            "",
        ),
        (2, json!({ "do": "stops", "stops": [[0, "#102030"], [0.5, "#ffffff80"]] }), "stops", ""),
        (
            0,
            json!({ "do": "mask", "mask": { "kind": "fresnel", "f0": 0.5, "power": 3 } }),
            "mask",
            "",
        ),
        (
            0,
            json!({ "do": "mask", "mask": { "kind": "curvature", "scale": 2, "blur": 1, "from": 0.25 } }),
            "mask",
            "",
        ),
        (0, json!({ "do": "mask", "mask": { "kind": "depth", "from": 1, "to": 0.5 } }), "mask", ""),
        (
            0,
            json!({ "do": "mask", "mask": { "kind": "shine", "at": [5, 6.5], "tolerance": 9 } }),
            "mask",
            "",
        ),
        (
            0,
            json!({ "do": "mask", "mask": { "kind": "depth", "at": [5, 6], "softness": 0.5 } }),
            "mask",
            "",
        ),
        (4, json!({ "do": "lights", "lights": [light, far] }), "lights", ""),
        (
            4,
            json!({ "do": "diffuse", "term": { "color": "#c08061", "weight": 0.25, "scaling": { "alpha": 0.5,
            "gamma_convex": 2, "gamma_concave": 1 } } }),
            "term",
            "/diffuse",
        ),
        (
            4,
            json!({ "do": "features", "features": { "lambda": 0.5, "scales": [{ "curvature_scale": 6 },
            { "blur": 2, "weight": 0.5 }] } }),
            "features",
            "/",
        ),
        (5, json!({ "do": "scaling", "scaling": { "alpha": 0.5, "gamma": 3 } }), "scaling", "/"),
        (5, json!({ "do": "reference", "reference": 0.75 }), "reference", ""),
        (
            7,
            json!({ "do": "grain", "grain": { "size": 9, "octaves": 2, "stretch": 3, "seed": 7 } }),
            "grain",
            "/source/noise",
        ),
    ]
}

#[test]
fn what_an_edit_sets_stands_in_a_document_as_the_edit_says_it() {
    for (layer, to, field, place) in cases() {
        let mut session = Session::default();
        session.add_document(OpenDocument::new("all", everything(), None));
        let edit = json!({ "in": "layer", "do": "set", "layer": layer.to_string(), "to": to, "done": true });
        session.replay(Path::new("story"), &edit.to_string()).unwrap();
        let said = &to[field];
        assert_eq!(
            Action::read(&edit).unwrap().to_value()["to"][field],
            *said,
            "as an action is written"
        );
        let document = recipe::write(session.active().unwrap().document());
        let written = &document["layers"][layer];
        match place {
            // Next to others in the layer itself.
            "/" => {
                for (name, value) in said.as_object().unwrap() {
                    assert_eq!(written[name], *value, "{name} of {to}");
                }
            }
            "" => assert_eq!(written[field], *said, "{to}"),
            _ => assert_eq!(written.pointer(place), Some(said), "{to}"),
        }
    }
}

#[test]
fn an_edit_out_of_its_range_is_read_and_one_that_is_no_value_is_named() {
    let read = |to: Value| {
        let edit = json!({ "in": "layer", "do": "set", "layer": "0", "to": to, "done": true });
        Action::read(&edit).err().unwrap_or_default()
    };
    // The document refuses it, in a note.
    assert_eq!(read(json!({ "do": "operator", "operator": { "kind": "depth", "gamma": -1 } })), "");
    let said = read(json!({ "do": "operator", "operator": { "kind": "depth", "gama": 1 } }));
    assert!(said.contains("“operator” gama: is unknown; did you mean “gamma”?"), "{said}");
    let said = read(json!({ "do": "mask", "mask": { "kind": "fresnel", "f0": "much" } }));
    assert!(said.contains("“mask” f0: is text; it must be a number"), "{said}");
    let said = read(json!({ "do": "mask", "mask": 7 }));
    assert!(said.contains("“mask” is a number; it must be an object"), "{said}");
}

#[test]
fn the_page_on_scripts_names_every_action_and_property() {
    use crate::session::actions::{
        CanvasAction, ClipboardAction, EditAction, FileAction, GuideAction, HandAction,
        LayerAction, PartAction, PointerAction, SelectionAction, StrokeAction, Style, ViewAction,
    };
    use crate::session::property::Property;
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/SCRIPTING.md");
    let page = std::fs::read_to_string(page).unwrap();
    let words = [
        CanvasAction::WORDS,
        ClipboardAction::WORDS,
        EditAction::WORDS,
        FileAction::WORDS,
        GuideAction::WORDS,
        HandAction::WORDS,
        LayerAction::WORDS,
        PartAction::WORDS,
        PointerAction::WORDS,
        SelectionAction::WORDS,
        StrokeAction::WORDS,
        Style::WORDS,
        ViewAction::WORDS,
        Property::WORDS,
    ]
    .concat();
    let is_named = |word: &str| {
        page.contains(&format!("`{word}`")) || page.contains(&format!("\"do\":\"{word}\""))
    };
    let missing: Vec<&str> = words.into_iter().filter(|word| !is_named(word)).collect();
    assert!(missing.is_empty(), "docs/SCRIPTING.md does not name {missing:?}");
}
