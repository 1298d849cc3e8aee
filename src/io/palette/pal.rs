//! Two formats that end in `.pal`: Paint Shop Pro's text, and Windows's chunks. Floor 5.

use super::swatch::{SwatchColor, SwatchReader, text_of};
use crate::Result;
use crate::paint::ColorPalette;
use std::fmt::Write;

/// A signature, a version, a count, and a line for each color.
pub fn read_text(reader: &mut SwatchReader, bytes: &[u8]) -> Result<()> {
    let text = text_of(bytes);
    let mut lines = text.lines().map(str::trim).zip(1..).skip(2);
    let count = lines.next().and_then(|(line, _)| line.parse::<usize>().ok());
    let count = count.ok_or_else(|| reader.refusal("line 3: is not the number of colors"))?;
    for (line, number) in lines.filter(|(line, _)| !line.is_empty()).take(count) {
        let mut words = line.split_whitespace().map(|word| word.parse::<u8>().ok());
        let (Some(Some(r)), Some(Some(g)), Some(Some(b))) =
            (words.next(), words.next(), words.next())
        else {
            return Err(reader.refusal(format!("line {number}: is not three numbers up to 255")));
        };
        reader.add(SwatchColor::Rgb([r, g, b].map(|v| f32::from(v) / 255.0)), "")?;
    }
    let found = reader.count();
    if found < count {
        return Err(reader.refusal(format!("it has {found} colors; it should have {count}")));
    }
    Ok(())
}

pub fn write_text(palette: &ColorPalette) -> String {
    let mut out = format!("JASC-PAL\r\n0100\r\n{}\r\n", palette.colors.len());
    for named in &palette.colors {
        let color = named.color;
        // Writing to a text does not fail.
        let _ = write!(out, "{} {} {}\r\n", color.r, color.g, color.b);
    }
    out
}

/// The chunk of colors, wherever it is among the chunks.
pub fn read_riff(reader: &mut SwatchReader, bytes: &[u8]) -> Result<()> {
    let mut rest = &bytes[12..];
    loop {
        let Some((head, after)) = rest.split_at_checked(8) else {
            return Err(reader.refusal("it has no colors"));
        };
        let length = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
        if head.starts_with(b"data") {
            return read_colors(reader, after.get(..length).unwrap_or(after));
        }
        // Chunks are padded to even lengths.
        rest = after.get(length.saturating_add(length % 2)..).unwrap_or_default();
    }
}

/// A version, a count, and four bytes for each color.
fn read_colors(reader: &mut SwatchReader, data: &[u8]) -> Result<()> {
    let Some(([_, _, low, high], colors)) = data.split_first_chunk() else {
        return Err(reader.refusal("its colors are cut short"));
    };
    let count = usize::from(u16::from_le_bytes([*low, *high]));
    let colors = colors.as_chunks().0.get(..count);
    for [r, g, b, _] in colors.ok_or_else(|| reader.refusal("its colors are cut short"))? {
        reader.add(SwatchColor::Rgb([*r, *g, *b].map(|v| f32::from(v) / 255.0)), "")?;
    }
    Ok(())
}

pub fn write_riff(palette: &ColorPalette) -> Vec<u8> {
    let count = palette.colors.len();
    let data = 4 + 4 * count as u32;
    let mut out = b"RIFF".to_vec();
    out.extend((data + 12).to_le_bytes());
    out.extend(b"PAL data");
    out.extend(data.to_le_bytes());
    out.extend([0, 3]);
    out.extend((count as u16).to_le_bytes());
    for named in &palette.colors {
        out.extend([named.color.r, named.color.g, named.color.b, 0]);
    }
    out
}
