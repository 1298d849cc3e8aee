//! GIMP's parametric brushes: lines of text, versions 1.0 and 1.5.
//! Floor 5.

use super::{ImportedBrush, text_of};
use crate::paint::{Brush, Tip};
use crate::{Error, Result};
use std::path::Path;

const MAGIC: &[u8] = b"GIMP-VBR";

pub fn is_vbr(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// The lines of a file, one after the other.
struct VbrLines<'a> {
    file: &'a Path,
    lines: std::str::Lines<'a>,
}

impl<'a> VbrLines<'a> {
    fn next(&mut self, what: &str) -> Result<&'a str> {
        self.lines
            .next()
            .map(str::trim)
            .ok_or_else(|| Error::decode(self.file, format!("its {what} is missing")))
    }

    fn number(&mut self, what: &str) -> Result<f32> {
        let text = self.next(what)?;
        let number = text.parse().ok().filter(|v: &f32| v.is_finite());
        number.ok_or_else(|| Error::decode(self.file, format!("its {what} is not a number")))
    }
}

pub fn read(file: &Path, bytes: &[u8]) -> Result<ImportedBrush> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = VbrLines { file, lines: text.lines() };
    lines.next("first line")?;
    let version = lines.next("version")?;
    let is_later = match version {
        "1.0" => false,
        "1.5" => true,
        _ => {
            let version: String = version.chars().filter(|c| !c.is_control()).take(20).collect();
            return Err(Error::unsupported_file(
                file,
                format!("version {version} of GIMP's parametric brushes"),
            ));
        }
    };
    let name = text_of(lines.next("name")?.as_bytes());
    let shape = if is_later { lines.next("shape")? } else { "circle" };
    let spacing = lines.number("spacing")?;
    let radius = lines.number("radius")?.max(0.1).min(4000.0);
    let spikes = if is_later { lines.number("number of spikes")? } else { 2.0 };
    let hardness = lines.number("hardness")?.max(0.0).min(1.0);
    let aspect = lines.number("aspect ratio")?.max(1.0).min(1.0 / *Tip::RATIO.start());
    let angle = lines.number("angle")?;
    let ratio = 1.0 / aspect;
    // A diamond is a square on its corner, whose diagonal is the diameter.
    let (tip, size, turn) = match shape {
        "square" => (Tip::Square { ratio }, 2.0 * radius, 0.0),
        "diamond" => (Tip::Square { ratio }, std::f32::consts::SQRT_2 * radius, 45.0),
        _ if ratio < 1.0 => (Tip::Ellipse { ratio }, 2.0 * radius, 0.0),
        _ => (Tip::Round, 2.0 * radius, 0.0),
    };
    let mut notes = Vec::new();
    if spikes > 2.0 {
        notes.push("its spikes have no counterpart".to_owned());
    }
    if shape == "diamond" && ratio < 1.0 {
        notes.push("its diamond is squeezed along its sides, not its diagonals".to_owned());
    }
    let name = if name.is_empty() { "Brush".to_owned() } else { name };
    let spacing = (spacing / 100.0).max(0.01).min(10.0);
    let rotation = (angle + turn).rem_euclid(360.0);
    let brush = Brush { size, hardness, spacing, rotation, tip, ..Brush::default() };
    Ok(ImportedBrush { name, brush, notes })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<ImportedBrush> {
        read(Path::new("b.vbr"), text.as_bytes())
    }

    #[test]
    fn both_versions_are_read_to_the_same_brush() {
        let first = read_text("GIMP-VBR\n1.0\nFuzzy\n25.0\n4.5\n0.5\n2.0\n30.0\n").unwrap();
        let later =
            read_text("GIMP-VBR\n1.5\nFuzzy\ncircle\n25.0\n4.5\n2\n0.5\n2.0\n30.0\n").unwrap();
        for ImportedBrush { name, brush, notes } in [first, later] {
            assert_eq!((name.as_str(), brush.size, brush.hardness), ("Fuzzy", 9.0, 0.5));
            assert_eq!((brush.spacing, brush.rotation), (0.25, 30.0));
            assert!(matches!(brush.tip, Tip::Ellipse { ratio: 0.5 }) && notes.is_empty());
        }
    }

    #[test]
    fn squares_and_diamonds_have_their_corners() {
        let shaped = |shape: &str| {
            read_text(&format!("GIMP-VBR\n1.5\nx\n{shape}\n10\n10\n5\n1\n1\n0\n")).unwrap()
        };
        let (square, diamond) = (shaped("square"), shaped("diamond"));
        assert!(
            matches!(square.brush.tip, Tip::Square { ratio: 1.0 }) && square.brush.size == 20.0
        );
        assert!((diamond.brush.size - 14.142).abs() < 1e-3 && diamond.brush.rotation == 45.0);
        assert_eq!(square.notes, ["its spikes have no counterpart"]);
    }

    #[test]
    fn damage_is_named() {
        let said = |text: &str| read_text(text).map(|_| ()).unwrap_err().to_string();
        assert!(said("GIMP-VBR\n2.0\nx\n").contains("version 2.0"));
        assert!(said("GIMP-VBR\n1.0\nx\n25\n").contains("radius is missing"));
        assert!(said("GIMP-VBR\n1.0\nx\nnan\n4\n1\n1\n0\n").contains("spacing is not a number"));
    }
}
