//! The text that MyPaint's brushes were before version 3: a setting a line, its base value, and
//! curves behind bars. Floor 5. It becomes what JSON says, so that there is one reader of settings.
//!
//! ```text
//! version 2
//! opaque 1.0 | pressure (0.0 0.0), (1.0 0.5) | random (0.0 -0.1), (1.0 0.1)
//! ```
//!
//! Version 1 has no brackets: each curve begins at (0, 0), and ends where a pair begins with 0.

use crate::Budget;
use crate::paint::dynamics::MAX_POINTS;
use crate::{Error, Result};
use serde_json::{Map, Value, json};
use std::path::Path;

/// Settings that had other names, and what their values are multiplied by.
const RENAMED: [(&str, &str, f64); 8] = [
    ("color_hue", "change_color_h", 64.0 / 360.0),
    ("color_saturation", "change_color_hsv_s", 128.0 / 256.0),
    ("color_value", "change_color_v", 128.0 / 256.0),
    ("speed_slowness", "speed1_slowness", 1.0),
    ("change_color_s", "change_color_hsv_s", 1.0),
    ("stroke_treshold", "stroke_threshold", 1.0),
    ("speed", "speed1", 1.0),
    ("customer_input", "custom_input", 1.0),
];
/// Lines that are no settings.
const OTHERS: [&str; 6] =
    ["version", "group", "parent_brush_name", "painting_time", "color", "notes"];

pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Map<String, Value>> {
    if bytes.len() as u64 > budget.json_bytes {
        let reason =
            format!("the text has {} bytes; it may have {}", bytes.len(), budget.json_bytes);
        return Err(Error::too_large(file, reason));
    }
    let text = std::str::from_utf8(bytes)
        .map_err(|_| Error::decode(file, "it is neither JSON nor MyPaint's text"))?;
    let lines =
        text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let pairs: Vec<(&str, &str)> =
        lines.filter_map(|line| line.split_once(char::is_whitespace)).collect();
    let version = pairs
        .iter()
        .find(|(name, _)| *name == "version")
        .map_or("1", |(_, version)| version.trim());
    if !["1", "2"].contains(&version) {
        return Err(Error::unsupported_file(
            file,
            format!("version {version} of MyPaint's brushes as text"),
        ));
    }
    let mut settings = Map::new();
    for (name, value) in pairs.into_iter().filter(|(name, _)| !OTHERS.contains(name)) {
        let (name, factor) = rename_setting(name);
        let setting = setting(value, factor, version == "1");
        let is_plain = name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
        // A line that is not a setting comes from a newer program.
        if let Some(setting) = setting.filter(|_| is_plain) {
            settings.insert(name.to_owned(), setting);
        }
    }
    match settings.is_empty() {
        true => Err(Error::decode(file, "it holds no settings")),
        false => Ok(settings),
    }
}

fn rename_setting(name: &str) -> (&str, f64) {
    RENAMED
        .iter()
        .find(|(old, ..)| *old == name)
        .map_or((name, 1.0), |(_, new, factor)| (*new, *factor))
}

/// A base value and its curves, as JSON has them.
fn setting(text: &str, factor: f64, is_first: bool) -> Option<Value> {
    let mut parts = text.split('|').map(str::trim);
    let base = number(parts.next()?)? * factor;
    let mut inputs = Map::new();
    for part in parts {
        let (input, points) = part.split_once(char::is_whitespace)?;
        let points = if is_first { pairs_from_zero(points) } else { pairs_in_brackets(points) };
        let points: Vec<Value> = points?.into_iter().map(|[x, y]| json!([x, y * factor])).collect();
        inputs.insert(rename_setting(input).0.to_owned(), points.into());
    }
    Some(json!({ "base_value": base, "inputs": inputs }))
}

fn pairs_in_brackets(text: &str) -> Option<Vec<[f64; 2]>> {
    let pairs = text.split(',').take(MAX_POINTS).map(|pair| {
        let mut numbers = pair
            .trim()
            .trim_start_matches('(')
            .trim_end_matches(')')
            .split_whitespace()
            .map(number);
        Some([numbers.next()??, numbers.next()??])
    });
    pairs.collect()
}

fn pairs_from_zero(text: &str) -> Option<Vec<[f64; 2]>> {
    let numbers: Vec<f64> =
        text.split_whitespace().take(2 * MAX_POINTS).map(number).collect::<Option<_>>()?;
    let later = numbers.as_chunks::<2>().0.iter().copied().take_while(|[x, _]| *x != 0.0);
    Some(std::iter::once([0.0, 0.0]).chain(later).collect())
}

fn number(text: &str) -> Option<f64> {
    text.parse().ok().filter(|v: &f64| v.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<Map<String, Value>> {
        read(Path::new("b.myb"), text.as_bytes(), &Budget::default())
    }

    #[test]
    fn a_line_becomes_a_setting_whichever_version_wrote_it() {
        let second = "# mypaint brush file\nopaque 0.5 | pressure (0.0 0.0), (1.0 0.5) \
                      | speed1 (0 -1), (4 1)\nversion 2\n";
        let read = read_text(second).unwrap();
        let inputs =
            json!({ "pressure": [[0.0, 0.0], [1.0, 0.5]], "speed1": [[0.0, -1.0], [4.0, 1.0]] });
        assert_eq!(read["opaque"], json!({ "base_value": 0.5, "inputs": inputs }));
        let first = "opaque 0.5 | pressure 0.5 0.2 1.0 0.9 0.0 0.0\ncolor 10 20 30\n";
        let read = read_text(first).unwrap();
        assert_eq!(
            read["opaque"]["inputs"]["pressure"],
            json!([[0.0, 0.0], [0.5, 0.2], [1.0, 0.9]])
        );
        assert_eq!(read.len(), 1);
    }

    #[test]
    fn old_names_become_new_ones_with_their_scale() {
        let read =
            read_text("version 2\ncolor_value 1.0 | random (0 0), (1 -2)\nstroke_treshold 0.1\n")
                .unwrap();
        assert_eq!(read["change_color_v"]["base_value"], json!(0.5));
        assert_eq!(read["change_color_v"]["inputs"]["random"], json!([[0.0, 0.0], [1.0, -1.0]]));
        assert_eq!(read["stroke_threshold"]["base_value"], json!(0.1));
    }

    #[test]
    fn what_is_no_brush_is_refused_and_damaged_lines_are_left_out() {
        assert!(read_text("version 7\nopaque 1\n").unwrap_err().to_string().contains("version 7"));
        assert!(read_text("hello\n").unwrap_err().to_string().contains("no settings"));
        let read = read_text(
            "version 2\nopaque x\nhardness nan\nradius_logarithmic 2 | pressure oops\nsmudge 1\n",
        )
        .unwrap();
        assert_eq!(read.keys().collect::<Vec<_>>(), ["smudge"]);
    }
}
