//! Adobe's swatch exchange: blocks of groups and colors, the colors in floats. Floor 5. Groups are
//! read one after the other; a palette is written as one group.

use super::swatch::{SwatchColor, SwatchReader, text_of_utf16, utf16_of};
use crate::paint::ColorPalette;
use crate::psd::cursor::ByteCursor;
use crate::{Error, Result};

const MAGIC: &[u8; 4] = b"ASEF";
const GROUP: u16 = 0xc001;
const GROUP_END: u16 = 0xc002;
const COLOR: u16 = 1;
/// A color that changes everywhere when its swatch is changed.
const GLOBAL: u16 = 0;

pub fn read(reader: &mut SwatchReader, bytes: &[u8]) -> Result<()> {
    let mut cursor = ByteCursor::new(bytes);
    let cut = |reader: &SwatchReader| reader.refusal("the swatches are cut short");
    let header = (cursor.key(), cursor.u16(), cursor.u16(), cursor.u32());
    let (_, Some(version), Some(_), Some(blocks)) = header else { return Err(cut(reader)) };
    if version != 1 {
        let reason = format!("version {version} of Adobe's swatch exchange");
        return Err(Error::unsupported_file(reader.file, reason));
    }
    let mut groups = 0;
    for _ in 0..blocks {
        let (Some(kind), Some(mut block)) = (cursor.u16(), cursor.section(false)) else {
            return Err(cut(reader));
        };
        match kind {
            GROUP => {
                // Some programs write groups without names.
                let name = read_name(&mut block).unwrap_or_default();
                groups += 1;
                // Of several, none is the palette's.
                reader.name(if groups == 1 { &name } else { "" });
            }
            COLOR => {
                let name = read_name(&mut block).ok_or_else(|| cut(reader))?;
                match read_color(&mut block).ok_or_else(|| cut(reader))? {
                    Some(color) => reader.add(color, &name)?,
                    None => reader.skip(),
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn read_name(block: &mut ByteCursor) -> Option<String> {
    let units = usize::from(block.u16()?);
    block.take(2 * units).map(text_of_utf16)
}

/// A color; `Some(None)` if its space is not known.
fn read_color(block: &mut ByteCursor) -> Option<Option<SwatchColor>> {
    let space = block.key()?;
    let mut value = || block.u32().map(f32::from_bits);
    Some(match &space {
        b"RGB " => Some(SwatchColor::Rgb([value()?, value()?, value()?])),
        b"CMYK" => Some(SwatchColor::Cmyk([value()?, value()?, value()?, value()?])),
        b"LAB " => Some(SwatchColor::Lab([100.0 * value()?, value()?, value()?])),
        b"Gray" | b"GRAY" => Some(SwatchColor::Gray(value()?)),
        _ => None,
    })
}

pub fn write(palette: &ColorPalette) -> Vec<u8> {
    let mut out = MAGIC.to_vec();
    out.extend([0, 1, 0, 0]);
    out.extend((palette.colors.len() as u32 + 2).to_be_bytes());
    block(&mut out, GROUP, name_bytes(&palette.name));
    for named in &palette.colors {
        let [r, g, b, _] = named.color.to_f32();
        let mut content = name_bytes(&named.name);
        content.extend(b"RGB ");
        content.extend([r, g, b].into_iter().flat_map(f32::to_be_bytes));
        content.extend(GLOBAL.to_be_bytes());
        block(&mut out, COLOR, content);
    }
    block(&mut out, GROUP_END, Vec::new());
    out
}

/// A name after its length, in units of UTF-16.
fn name_bytes(name: &str) -> Vec<u8> {
    let units = utf16_of(name);
    std::iter::once(units.len() as u16).chain(units).flat_map(u16::to_be_bytes).collect()
}

fn block(out: &mut Vec<u8>, kind: u16, content: Vec<u8>) {
    out.extend(kind.to_be_bytes());
    out.extend((content.len() as u32).to_be_bytes());
    out.extend(content);
}
