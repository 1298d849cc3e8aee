//! GIMP's palettes: a line for each color. Floor 5.

use super::swatch::{SwatchColor, SwatchReader, text_of};
use crate::Result;
use crate::paint::ColorPalette;
use std::fmt::Write;

/// What GIMP's own files call colors without names.
const NAMELESS: &str = "Untitled";

pub fn read(reader: &mut SwatchReader, bytes: &[u8]) -> Result<()> {
    let text = text_of(bytes);
    for (line, number) in text.lines().map(str::trim).zip(1..) {
        // Lospec writes the name into a comment.
        let name = line.strip_prefix("Name:").or_else(|| line.strip_prefix("#Palette Name:"));
        if let Some(name) = name {
            reader.name(name);
            continue;
        }
        if let Some(columns) = line.strip_prefix("Columns:") {
            reader.columns(columns.trim().parse().unwrap_or(0));
            continue;
        }
        // Aseprite adds the opacity, which palettes here do not have.
        let is_head = number == 1 || line.starts_with("Channels:");
        if is_head || line.is_empty() || line.starts_with('#') {
            continue;
        }
        let mut rest = line;
        let mut channel = || {
            let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
            let (word, after) = rest.split_at(end);
            rest = after.trim_start();
            word.parse::<u8>().ok()
        };
        let (Some(r), Some(g), Some(b)) = (channel(), channel(), channel()) else {
            return Err(reader.refusal(format!("line {number}: is not three numbers up to 255")));
        };
        let name = if rest == NAMELESS { "" } else { rest };
        reader.add(SwatchColor::Rgb([r, g, b].map(|v| f32::from(v) / 255.0)), name)?;
    }
    Ok(())
}

pub fn write(palette: &ColorPalette) -> String {
    let mut out =
        format!("GIMP Palette\nName: {}\nColumns: {}\n#\n", palette.name, palette.columns);
    for named in &palette.colors {
        let (color, name) = (named.color, &named.name);
        // Writing to a text does not fail.
        let _ = writeln!(out, "{:3} {:3} {:3}\t{name}", color.r, color.g, color.b);
    }
    out
}
