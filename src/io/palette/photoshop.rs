//! Photoshop's swatches (`.aco`, versions 1 and 2) and color tables (`.act`). Floor 5.

use super::swatch::{SwatchColor, SwatchReader, text_of_utf16, utf16_of};
use crate::paint::ColorPalette;
use crate::psd::cursor::ByteCursor;
use crate::{Error, Result};
use std::path::Path;

/// The colors of a table.
const TABLE: usize = 256;
/// A color without its name: the space and four numbers.
const COLOR_BYTES: usize = 10;

/// Whether a file has a table's length: it has no signature.
pub fn is_color_table(bytes: &[u8]) -> bool {
    matches!(bytes.len(), 768 | 772)
}

pub fn read_color_table(reader: &mut SwatchReader, bytes: &[u8]) -> Result<()> {
    let mut after = ByteCursor::new(&bytes[3 * TABLE..]);
    // Some programs write 0 for all.
    let count = after.u16().map(usize::from).filter(|count| (1..=TABLE).contains(count));
    for [r, g, b] in &bytes.as_chunks().0[..count.unwrap_or(TABLE)] {
        reader.add(SwatchColor::Rgb([*r, *g, *b].map(|v| f32::from(v) / 255.0)), "")?;
    }
    Ok(())
}

pub fn write_color_table(file: &Path, palette: &ColorPalette) -> Result<Vec<u8>> {
    let count = palette.colors.len();
    if count > TABLE {
        let reason = format!("a color table holds {TABLE} colors, and the palette has {count}");
        return Err(Error::unsupported_file(file, reason));
    }
    let channels = palette.colors.iter().flat_map(|named| {
        let color = named.color;
        [color.r, color.g, color.b]
    });
    let mut out: Vec<u8> = channels.collect();
    out.resize(3 * TABLE, 0);
    out.extend((count as u16).to_be_bytes());
    // No color is transparent.
    out.extend([0xff; 2]);
    Ok(out)
}

/// Whether a file begins like swatches, and is long enough for as many.
pub fn is_swatches(bytes: &[u8]) -> bool {
    let mut cursor = ByteCursor::new(bytes);
    let (Some(1 | 2), Some(count)) = (cursor.u16(), cursor.u16()) else { return false };
    bytes.len() >= 4 + COLOR_BYTES * usize::from(count)
}

/// The first list has no names; if a second follows, it is the same with names.
pub fn read_swatches(reader: &mut SwatchReader, bytes: &[u8]) -> Result<()> {
    let mut cursor = ByteCursor::new(bytes);
    read_list(reader, &mut cursor)?;
    if cursor.rest().starts_with(&[0, 2]) {
        *reader = SwatchReader::new(reader.file);
        read_list(reader, &mut cursor)?;
    }
    Ok(())
}

fn read_list(reader: &mut SwatchReader, cursor: &mut ByteCursor) -> Result<()> {
    let cut = |reader: &SwatchReader| reader.refusal("the swatches are cut short");
    let (Some(version), Some(count)) = (cursor.u16(), cursor.u16()) else {
        return Err(cut(reader));
    };
    for _ in 0..count {
        let color = read_color(cursor).ok_or_else(|| cut(reader))?;
        let name = match version {
            1 => String::new(),
            _ => {
                let length = cursor.u32().ok_or_else(|| cut(reader))?;
                let bytes = cursor.take((length as usize).saturating_mul(2));
                text_of_utf16(bytes.ok_or_else(|| cut(reader))?)
            }
        };
        match color {
            Some(color) => reader.add(color, &name)?,
            None => reader.skip(),
        }
    }
    Ok(())
}

/// A color; `Some(None)` if its space is not known.
fn read_color(cursor: &mut ByteCursor) -> Option<Option<SwatchColor>> {
    let space = cursor.u16()?;
    let words = [cursor.u16()?, cursor.u16()?, cursor.u16()?, cursor.u16()?];
    let [a, b, c, d] = words.map(|word| f32::from(word) / 65535.0);
    let hundredths = |word: u16| f32::from(word as i16) / 100.0;
    Some(match space {
        0 => Some(SwatchColor::Rgb([a, b, c])),
        1 => Some(SwatchColor::Hsb([a, b, c])),
        // 0 is all of the ink.
        2 => Some(SwatchColor::Cmyk([a, b, c, d].map(|light| 1.0 - light))),
        7 => {
            let [lightness, a, b, _] = words;
            Some(SwatchColor::Lab([lightness, a, b].map(hundredths)))
        }
        8 => Some(SwatchColor::Gray(f32::from(words[0]) / 10_000.0)),
        // Wide CMYK: hundredths of a percent.
        9 => Some(SwatchColor::Cmyk(words.map(|word| f32::from(word) / 10_000.0))),
        _ => None,
    })
}

pub fn write_swatches(palette: &ColorPalette) -> Vec<u8> {
    let mut words: Vec<u16> = Vec::new();
    for version in [1, 2] {
        // A palette has fewer colors than a word counts.
        words.extend([version, palette.colors.len() as u16]);
        for named in &palette.colors {
            let [r, g, b] =
                [named.color.r, named.color.g, named.color.b].map(|v| u16::from(v) * 257);
            words.extend([0, r, g, b, 0]);
            if version == 2 {
                let name = utf16_of(&named.name);
                words.extend([0, name.len() as u16]);
                words.extend(name);
            }
        }
    }
    words.into_iter().flat_map(u16::to_be_bytes).collect()
}
