//! Reasons to refuse a recipe.

use super::*;

#[test]
fn every_refusal_names_file_and_field() {
    let operator = |operator: Value| {
        said_of(json!({ "kind": "image", "source": { "file": "p.png" }, "operator": operator }))
    };
    let cases = [
        (
            operator(json!({ "kind": "depth", "gama": 1 })),
            "layers[0].operator.gama: is unknown; did you mean “gamma”?",
        ),
        (
            operator(json!({ "kind": "depth", "gamma": -1 })),
            "layers[0].operator.gamma: is -1; it must be between 0 and",
        ),
        (
            operator(json!({ "kind": "twist" })),
            "layers[0].operator.kind: is “twist”; it must be one of none, depth, normal",
        ),
        (operator(json!(3)), "layers[0].operator: is a number; it must be an object"),
        (
            said_of(json!({ "kind": "fil" })),
            "layers[0].kind: is “fil”; it must be one of fill, pixels",
        ),
        (said_of(json!({})), "layers[0].kind: is missing"),
        (
            said_of(json!({ "kind": "fill", "color": "red" })),
            "layers[0].color: is “red”; a color is written #rrggbb",
        ),
        (
            said_of(json!({ "kind": "fill", "opacity": 1.5 })),
            "layers[0].opacity: is 1.5; it must be between 0 and 1",
        ),
        (
            said_of(json!({ "kind": "fill", "opacity": null })),
            "layers[0].opacity: is null; it must be a number",
        ),
        (said_of(json!({ "kind": "fill", "blend": "Multiply" })), "layers[0].blend: is “Multiply”"),
        (said_of(json!({ "kind": "fill", "source": {} })), "layers[0].source: is unknown"),
        (said_of(json!({ "kind": "image" })), "layers[0].source: is missing"),
        (
            said_of(json!({ "kind": "image", "source": { "file": "gone.png" } })),
            "layers[0].source.file: gone.png: ",
        ),
        (
            said_of(json!({ "kind": "image", "source": { "file": "broken.png" } })),
            "layers[0].source.file: broken.png: cannot be read",
        ),
        (
            said_of(json!({ "kind": "image", "source": { "file": "../p.png" } })),
            "layers[0].source.file: “../p.png” is refused",
        ),
        (
            said_of(json!({ "kind": "pixels", "file": "/p.png" })),
            "layers[0].file: “/p.png” is refused",
        ),
        (
            said_of(json!({ "kind": "fill", "mask": { "file": "p.png" } })),
            "layers[0].mask.file: “p.png” has 10 × 6 pixels",
        ),
        (said_of(json!({ "kind": "gradient", "stops": [] })), "layers[0].stops: is empty"),
        (
            said_of(json!({ "kind": "gradient", "stops": [[1, "#000000"], [0, "#000000"]] })),
            "layers[0].stops[1][0]: is less",
        ),
        (
            said_of(json!({ "kind": "gradient", "from": [1] })),
            "layers[0].from: has 1 items; it must have 2",
        ),
        (said_of(json!({ "kind": "gradient", "from": [1, "2"] })), "layers[0].from[1]: is text"),
        (
            said_of(json!({ "kind": "strokes", "strokes": [{ "brush": { "preset": "crayon" } }] })),
            "layers[0].strokes[0].brush.preset: is “crayon”; the presets are pencil-hb",
        ),
        (
            said_of(json!({ "kind": "strokes", "strokes": [{ "samples": [[1, 2, 3]] }] })),
            "layers[0].strokes[0].samples[0]: has the pressure 3",
        ),
        (
            said_of(json!({ "kind": "group", "layers": [{ "kind": "fill" }, { "kind": "?" }] })),
            "layers[0].layers[1].kind: is “?”",
        ),
        (
            said_of(json!({ "kind": "shading", "lights": [{ "direction": [0, 0, 0] }] })),
            "layers[0].lights[0].direction: has no length",
        ),
        (
            said_of(json!({ "kind": "shading", "shadows": { "on": true, "softness": -1 } })),
            "layers[0].shadows.softness: is -1; it must be between 0 and 1",
        ),
        (
            said_of(json!({ "kind": "shading", "model": "painter", "painter": { "glow": 1 } })),
            "layers[0].painter.glow",
        ),
        (said(&json!({ "layers": [] })), "canvas: is missing, and there is no normal or depth map"),
        (said(&json!({ "canvas": { "width": 0, "height": 4 } })), "canvas.width: is 0"),
        (
            said(&json!({ "canvas": { "width": 100000, "height": 4 } })),
            "100000 × 4 pixels; a side may have 32768",
        ),
        (said(&json!({ "format": "psd" })), "format: is “psd”; it must be one of rilievo"),
        (
            said(&json!({ "version": 3, "shiny": true })),
            "version: is 3; this program reads up to 2",
        ),
        (said(&json!({ "layer": [] })), "layer: is unknown; did you mean “layers”?"),
        (said(&json!([])), "the document: is a list; it must be an object"),
        (said(&json!({ "surface": {} })), "surface: names neither a normal map nor a depth map"),
    ];
    for (said, wanted) in cases {
        assert!(said.starts_with("r.json: ") && said.contains(wanted), "{said}\n  lacks {wanted}");
    }
}
