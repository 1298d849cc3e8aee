//! How often each action is drawn. An action that is not named here has the usual weight.

use super::dice::Dice;

const USUAL: u32 = 10;

/// By the enum, and its word.
const WEIGHTS: &[(&str, &str, u32)] = &[
    // Rooms of actions.
    ("Action", "layer", 40),
    ("Action", "part", 30),
    ("Action", "canvas", 14),
    ("Action", "selection", 18),
    ("Action", "hand", 16),
    ("Action", "edit", 10),
    ("Action", "file", 9),
    ("Action", "clipboard", 8),
    ("Action", "stroke", 10),
    ("Action", "guide", 4),
    ("Action", "palette", 4),
    ("Action", "view", 2),
    // The pen's own actions make sense in gestures alone, and are drawn there.
    ("Action", "pointer", 1),
    ("LayerAction", "set", 90),
    ("LayerAction", "add", 20),
    ("LayerAction", "select", 20),
    ("LayerAction", "delete", 3),
    ("LayerAction", "flatten", 1),
    ("LayerAction", "bake", 4),
    ("LayerAction", "merge down", 5),
    ("LayerAction", "home", 14),
    ("LayerAction", "clear", 3),
    ("PartAction", "set", 40),
    ("PartAction", "add", 45),
    ("PartAction", "shape", 12),
    ("PartAction", "delete", 4),
    ("FileAction", "new", 2),
    ("FileAction", "close", 2),
    ("FileAction", "open", 5),
    ("FileAction", "open maps", 2),
    ("FileAction", "use", 15),
    ("FileAction", "replace maps", 12),
    ("FileAction", "add maps", 12),
    ("CanvasAction", "frame", 2),
    ("CanvasAction", "aspect", 2),
    ("EditAction", "walk", 30),
    ("HandAction", "preset", 40),
    ("HandAction", "brush", 20),
    ("HandAction", "operator", 20),
    ("HandAction", "mark", 3),
    ("SelectionAction", "none", 14),
    ("SelectionAction", "region", 20),
    ("SelectionAction", "hide", 1),
    ("SelectionAction", "quick mask", 3),
];

/// Properties that only some kinds of layers have: the kinds, and the words. Any other property is
/// drawn for all.
const SUITING: &[(&[&str], &[&str])] = &[
    (&["fill", "lines", "hatching"], &["fill"]),
    (&["group"], &["pass through"]),
    (&["image"], &["anchors", "power", "adjust"]),
    (&["image", "gradient"], &["operator", "pieces", "filter"]),
    (&["image", "normals"], &["placement", "outside"]),
    (&["gradient"], &["stops", "ends", "ramp"]),
    (&["lines"], &["lines", "redrawn on"]),
    (&["hatching"], &["hatching", "guided by", "tone of"]),
    (&["lines", "hatching"], &["hand", "line size", "drawn with"]),
    (&["normals"], &["grain", "strength"]),
    (&["adjustment"], &["adjustment"]),
    (&["filter"], &["filter layer"]),
    (&["shading", "radiance-scaling"], &["features"]),
    (&["radiance-scaling"], &["scaling", "scaling light", "reference", "keep mean"]),
    (
        &["shading"],
        &[
            "environment",
            "without",
            "occlusion",
            "bounces",
            "shadows",
            "painter",
            "pixels",
            "ball strokes",
            "solid glass",
            "mood",
            "model",
            "lights",
            "ambient",
            "diffuse",
            "specular",
            "shininess",
            "bands",
            "exponent",
            "anisotropy",
            "index",
        ],
    ),
];

pub fn weight(of: &str, word: &str, dice: &Dice) -> u32 {
    if of == "Property" {
        let row = SUITING.iter().find(|(_, words)| words.contains(&word));
        return match row {
            Some((kinds, _)) if kinds.contains(&dice.kind) => 3 * USUAL,
            Some(_) => 1,
            None => USUAL,
        };
    }
    let row = WEIGHTS.iter().find(|(known, known_word, _)| *known == of && *known_word == word);
    row.map_or(USUAL, |(.., weight)| *weight)
}

/// The words of the tables above, each with its enum, for the test that they are words of the
/// program.
pub fn words() -> impl Iterator<Item = (&'static str, &'static str)> {
    let suiting =
        SUITING.iter().flat_map(|(_, words)| words.iter().map(|word| ("Property", *word)));
    WEIGHTS.iter().map(|(of, word, _)| (*of, *word)).chain(suiting)
}
