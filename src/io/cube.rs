//! Color look-up tables of `.cube` files, as color graders exchange them: a text with a size and
//! a line of three numbers for each entry. Floor 5. Not here: reading colors from tables
//! (`paint::adjustment`).

use crate::paint::adjustment::ColorTable;
use crate::{Error, Result};
use std::path::Path;

/// A table from the text of a `.cube` file. Values beyond 0 and 1 are clipped; a domain other than
/// 0 to 1 is refused.
pub fn parse(file: &Path, bytes: &[u8]) -> Result<ColorTable> {
    let refused = |why: String| Error::decode(file, why);
    let text = String::from_utf8_lossy(bytes);
    let mut title = String::new();
    let mut size = None;
    let mut values: Vec<u16> = Vec::new();
    for (line, number) in text.lines().map(str::trim).zip(1..) {
        let mut words = line.split_whitespace();
        let Some(first) = words.next().filter(|word| !word.starts_with('#')) else { continue };
        match first {
            "TITLE" => title = line["TITLE".len()..].trim().trim_matches('"').to_owned(),
            "LUT_1D_SIZE" | "LUT_3D_SIZE" => {
                let is_separate = first == "LUT_1D_SIZE";
                let side = words.next().and_then(|word| word.parse::<usize>().ok());
                let entries = side.and_then(|side| ColorTable::entries(side, is_separate));
                let (Some(side), Some(entries)) = (side, entries) else {
                    let most =
                        if is_separate { ColorTable::MOST_SEPARATE } else { ColorTable::MOST_SIDE };
                    return Err(refused(format!(
                        "line {number}: the size must be a whole number from 2 to {most}"
                    )));
                };
                size = Some((side, is_separate, entries));
            }
            "DOMAIN_MIN" | "DOMAIN_MAX" => {
                let edge = if first == "DOMAIN_MIN" { 0.0 } else { 1.0 };
                if words.any(|word| word.parse::<f32>().ok() != Some(edge)) {
                    let why = "a domain other than 0 to 1 cannot be used";
                    return Err(refused(format!("line {number}: {why}")));
                }
            }
            word if word.starts_with(|c: char| c.is_ascii_alphabetic()) => {}
            _ => {
                let Some((.., entries)) = size else {
                    return Err(refused(format!(
                        "line {number}: there are colors before the size"
                    )));
                };
                let color: Option<Vec<u16>> = line.split_whitespace().map(entry).collect();
                let color = color.filter(|color| color.len() == 3);
                let Some(color) = color else {
                    return Err(refused(format!("line {number}: is not three numbers")));
                };
                if values.len() == 3 * entries {
                    return Err(refused(format!("it has more than {entries} colors")));
                }
                values.extend(color);
            }
        }
    }
    let Some((side, is_separate, entries)) = size else {
        return Err(refused("it has no size (LUT_3D_SIZE or LUT_1D_SIZE)".into()));
    };
    let found = values.len() / 3;
    if title.is_empty() {
        title = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    }
    ColorTable::new(&title, side, is_separate, values)
        .ok_or_else(|| refused(format!("it has {found} colors; its size asks for {entries}")))
}

/// A number as 16 bits.
fn entry(word: &str) -> Option<u16> {
    let value = word.parse::<f32>().ok().filter(|value| value.is_finite())?;
    Some((value.max(0.0).min(1.0) * 65535.0).round() as u16)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<ColorTable> {
        parse(Path::new("warm.cube"), text.as_bytes())
    }

    #[test]
    fn a_table_is_read_with_its_title() {
        let colors = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1.5 1 -3\n";
        let table = read(&format!("# made\nTITLE \"Warm\"\nLUT_3D_SIZE 2\n\n{colors}")).unwrap();
        assert_eq!((table.title(), table.side(), table.is_separate()), ("Warm", 2, false));
        assert_eq!(table.values()[21..], [65535, 65535, 0]);
        let table = read("LUT_1D_SIZE 2\nDOMAIN_MAX 1 1 1\n0 0 0\n0.5 1 1e0").unwrap();
        assert_eq!((table.title(), table.is_separate()), ("warm", true));
    }

    #[test]
    fn what_is_no_table_is_refused_with_the_reason() {
        for (text, why) in [
            ("", "has no size"),
            ("LUT_3D_SIZE 99999999", "from 2 to"),
            ("LUT_3D_SIZE 2\n0 0", "line 2: is not three numbers"),
            ("LUT_3D_SIZE 2\n0 0 NaN", "line 2: is not three numbers"),
            ("LUT_3D_SIZE 2\n0 0 0", "has 1 colors; its size asks for 8"),
            ("0 0 0", "line 1: there are colors before the size"),
            ("LUT_1D_SIZE 2\nDOMAIN_MIN -1 0 0", "line 2: a domain"),
            ("LUT_1D_SIZE 2\n0 0 0\n0 0 0\n0 0 0", "more than 2 colors"),
        ] {
            let said = read(text).unwrap_err().to_string();
            assert!(said.contains(why), "{text}: {said}");
        }
    }
}
