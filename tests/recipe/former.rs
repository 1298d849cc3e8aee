//! Names that documents of version 0.1 spell otherwise.

use super::{read, with_layers};
use rilievo::files::recipe;
use serde_json::{Value, json};

/// A document with every such name.
fn document(names: [&str; 4]) -> Value {
    let [gray, posterize, wash, pool] = names;
    let mut mixer = json!({ "kind": "channel-mixer", "monochrome": true });
    mixer[gray] = json!({ "red": 50, "green": 30 });
    let stroke =
        |preset: &str| json!({ "brush": { "preset": preset }, "samples": [[4, 4], [20, 9]] });
    with_layers(json!([
        { "kind": "strokes", "name": "a", "label": gray, "strokes": [stroke(wash), stroke(pool)] },
        { "kind": "adjustment", "name": "b", "adjust": mixer },
        { "kind": "adjustment", "name": "c", "adjust": { "kind": posterize, "levels": 5 } },
    ]))
}

#[test]
fn names_of_version_0_1_are_read_and_written_as_they_are_now() {
    let written = |names| recipe::write(&read(&document(names)).unwrap());
    let now = written(["gray", "posterize", "watercolor-wash", "watercolor-pool"]);
    let then = written(["grey", "posterise", "watercolour-wash", "watercolour-pool"]);
    assert_eq!(then, now);
    let text = now.to_string();
    assert!(text.contains("\"gray\"") && text.contains("\"posterize\""), "{text}");
    assert!(!text.contains("grey") && !text.contains("posterise"), "{text}");
}

#[test]
fn a_field_is_not_read_by_both_of_its_names() {
    let mut both = document(["gray", "posterize", "watercolor-wash", "watercolor-pool"]);
    both["layers"][1]["adjust"]["grey"] = json!({ "red": 50 });
    let error = read(&both).err().unwrap().to_string();
    assert!(error.contains("layers[1].adjust.grey: is unknown"), "{error}");
}
