//! What was found about maps, in the words of the window. Floor 7. The fields themselves are those
//! of recipes, which the command line prints.

use crate::document::source::{Near, NormalEncoding};
use crate::io::maps::Finding;
use crate::language::tr;

/// How normals are stored, in words.
pub const ENCODINGS: [(NormalEncoding, &str); NormalEncoding::ALL.len()] = [
    (NormalEncoding::Unsigned, "0 to 1 stands for −1 to 1"),
    (NormalEncoding::Signed, "−1 to 1, as they are"),
    (NormalEncoding::FullZ, "0 to 1; forward is never below 0"),
    (NormalEncoding::TwoChannel, "two channels, forward computed"),
    (NormalEncoding::Dxt5nm, "two channels, in alpha and green"),
];
/// Which values of a depth map are near, in words.
pub const NEAR: [(Near, &str); Near::ALL.len()] =
    [(Near::Auto, "found"), (Near::Low, "dark"), (Near::High, "bright")];

/// The name of a choice and what was chosen, in words; a field without words is shown unchanged.
pub fn describe(choice: &Finding) -> (&str, String) {
    let Finding { field, value, .. } = choice;
    let (name, words): (&str, &[(&str, &str)]) = match *field {
        "normal.encoding" => {
            let words =
                NormalEncoding::from_name(value).map(|encoding| words_of(encoding, &ENCODINGS));
            return ("Numbers", words.map_or_else(|| value.clone(), str::to_owned));
        }
        "normal.srgb" => (
            "Colors",
            &[("false", "plain numbers"), ("true", "encoded by the sRGB curve, decoded")],
        ),
        "normal.channels" => return ("Right, up, forward in", channels(value)),
        "normal.flip_x" => ("Left and right", FLIPPED),
        "normal.flip_y" => ("Up and down", FLIPPED),
        "normal.flip_z" => ("Front and back", FLIPPED),
        "normal.space" => (
            "Directions",
            &[("camera", "as seen in the picture"), ("world", "of the scene, rotated to the view")],
        ),
        "depth.near" => {
            let words = Near::from_name(value).map(|near| words_of(near, &NEAR));
            return ("Near is", words.map_or_else(|| value.clone(), str::to_owned));
        }
        "depth.encoding" => (
            "Depth",
            &[
                ("planar", "measured straight ahead"),
                ("ray-distance", "measured along each ray"),
                ("inverse", "one over the distance"),
                ("disparity", "disparity, of any scale"),
            ],
        ),
        field => return (field, value.clone()),
    };
    let known = words.iter().find(|(word, _)| word == value);
    (name, known.map_or_else(|| value.clone(), |(_, words)| (*words).to_owned()))
}

fn words_of<T: PartialEq>(meant: T, words: &[(T, &'static str)]) -> &'static str {
    words.iter().find(|(choice, _)| *choice == meant).map_or("", |(_, words)| words)
}

const FLIPPED: &[(&str, &str)] = &[("false", "as it is"), ("true", "flipped")];

/// The channels that letters mean, in the language of the window.
fn channels(letters: &str) -> String {
    let word = |letter: char| match letter {
        'r' => "red",
        'g' => "green",
        'b' => "blue",
        _ => "alpha",
    };
    letters.chars().map(word).map(tr).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::source::{DepthEncoding, NormalSpace};
    use crate::io::maps::ChoiceOrigin;

    #[test]
    fn every_choice_is_told_in_words() {
        let of = |field, value: &str| {
            let finding =
                Finding { field, value: value.into(), confidence: 1.0, how: ChoiceOrigin::Found };
            let (name, words) = describe(&finding);
            assert!(!name.contains(['.', '_']), "{name}");
            assert!(words != value, "{name}: {words}");
        };
        NormalEncoding::ALL.iter().for_each(|(_, name)| of("normal.encoding", name));
        NormalSpace::ALL.iter().for_each(|(_, name)| of("normal.space", name));
        DepthEncoding::ALL.iter().for_each(|(_, name)| of("depth.encoding", name));
        Near::ALL
            .iter()
            .filter(|(near, _)| *near != Near::Auto)
            .for_each(|(_, name)| of("depth.near", name));
        for field in ["normal.srgb", "normal.flip_x", "normal.flip_y", "normal.flip_z"] {
            ["true", "false"].iter().for_each(|value| of(field, value));
        }
        of("normal.channels", "rgb");
        assert_eq!(channels("agb"), "alpha, green, blue");
    }
}
