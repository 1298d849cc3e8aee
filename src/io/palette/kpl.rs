//! Krita's palettes: a zip whose `colorset.xml` lists the colors, some in groups, each at a place of
//! a grid. Floor 5. Groups are read one after the other, each row by row.

use super::swatch::{SwatchColor, SwatchReader};
use crate::Budget;
use crate::paint::ColorPalette;
use crate::project::Archive;
use crate::project::packer::ZipPacker;
use crate::{Error, Result};
use quick_xml::escape::escape;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::borrow::Cow;
use std::fmt::Write;
use std::path::Path;

const LIST: &str = "colorset.xml";
const MIME: &str = "application/x-krita-palette";
/// How Krita names sRGB.
const SRGB: &str = "sRGB-elle-V2-srgbtrc.icc";
/// How the names of its linear spaces end, apart from the extension.
const LINEAR: &str = "-g10";

/// A color, and where it stands.
struct KritaSwatch {
    name: String,
    /// Its group, its row and its column there.
    place: [u32; 3],
    /// `None` if its space is not known.
    color: Option<SwatchColor>,
}

pub fn read(reader: &mut SwatchReader, bytes: &[u8], budget: &Budget) -> Result<()> {
    let archive = Archive::open(reader.file, bytes, budget)?;
    if !archive.has_entry(LIST) {
        return Err(reader.refusal("it is a zip, but no palette of Krita"));
    }
    let text = archive.bytes(LIST, budget.json_bytes)?;
    let text = String::from_utf8_lossy(&text);
    let mut swatches = read_swatches(reader, &text)?;
    swatches.sort_by_key(|swatch| swatch.place);
    for swatch in swatches {
        match swatch.color {
            Some(color) => reader.add(color, &swatch.name)?,
            None => reader.skip(),
        }
    }
    Ok(())
}

fn read_swatches(reader: &mut SwatchReader, text: &str) -> Result<Vec<KritaSwatch>> {
    let mut xml = Reader::from_str(text);
    let (mut swatches, mut group, mut is_list) = (Vec::new(), 0, false);
    loop {
        let event = xml.read_event();
        let event = event.map_err(|e| reader.refusal(format!("{LIST} is damaged ({e})")))?;
        let element = match &event {
            Event::Start(element) | Event::Empty(element) => element,
            Event::Eof if is_list => return Ok(swatches),
            Event::Eof => return Err(reader.refusal(format!("{LIST} lists no colors"))),
            _ => continue,
        };
        match element.local_name().as_ref() {
            name if name.eq_ignore_ascii_case("ColorSet") => {
                is_list = true;
                reader.name(&text_of(element, "name"));
                reader.columns(text_of(element, "columns").parse().unwrap_or(0));
            }
            "Group" => group += 1,
            "ColorSetEntry" => {
                let (name, place) = (text_of(element, "name"), [group, 0, 0]);
                swatches.push(KritaSwatch { name, place, color: None });
                if swatches.len() > ColorPalette::MOST {
                    let reason = format!("a palette may have {} colors", ColorPalette::MOST);
                    return Err(Error::too_large(reader.file, reason));
                }
            }
            "Position" => {
                if let Some(last) = swatches.last_mut() {
                    let along = |name| text_of(element, name).parse().unwrap_or(0);
                    last.place = [last.place[0], along("row"), along("column")];
                }
            }
            _ => {
                if let Some(last) = swatches.last_mut() {
                    last.color = last.color.or_else(|| read_color(element));
                }
            }
        }
    }
}

/// The color that an element says.
fn read_color(element: &BytesStart) -> Option<SwatchColor> {
    let number = |name: &str| {
        let value = text_of(element, name).trim().parse::<f32>().ok();
        value.filter(|value| value.is_finite())
    };
    let three = |names: [&str; 3]| Some([number(names[0])?, number(names[1])?, number(names[2])?]);
    Some(match element.local_name().as_ref() {
        "sRGB" => SwatchColor::Rgb(three(["r", "g", "b"])?),
        "RGB" => {
            let (rgb, space) = (three(["r", "g", "b"])?, text_of(element, "space").to_lowercase());
            match space.contains("srgb") || space.is_empty() {
                true if space.contains(LINEAR) => SwatchColor::Light(rgb),
                true => SwatchColor::Rgb(rgb),
                false => SwatchColor::OtherRgb(rgb),
            }
        }
        "CMYK" => {
            let [c, m, y] = three(["c", "m", "y"])?;
            SwatchColor::Cmyk([c, m, y, number("k")?])
        }
        "Lab" => SwatchColor::Lab(three(["L", "a", "b"])?),
        "Gray" => SwatchColor::Gray(number("g")?),
        _ => return None,
    })
}

/// An attribute's text; empty if it is absent.
fn text_of(element: &BytesStart, name: &str) -> String {
    let found = element.attributes().flatten().find(|known| known.key.as_ref() == name);
    let Some(attribute) = found else { return String::new() };
    // Custom entities are not expanded: they could grow without bound or lead to other files.
    let value = attribute.normalized_value(XmlVersion::Implicit1_0);
    value.map_or_else(|_| attribute.value.as_ref().to_owned(), Cow::into_owned)
}

pub fn write(file: &Path, palette: &ColorPalette) -> Result<Vec<u8>> {
    /// Krita's own number.
    const COLUMNS: u32 = 16;
    let columns = if palette.columns == 0 { COLUMNS } else { palette.columns };
    let rows = (palette.colors.len() as u32).div_ceil(columns).max(1);
    let name = escape(palette.name.as_str());
    let mut xml = format!(
        "<ColorSet version=\"1.0\" name=\"{name}\" comment=\"\" readonly=\"false\" columns=\"{columns}\" \
         rows=\"{rows}\">\n"
    );
    for (named, i) in palette.colors.iter().zip(0u32..) {
        let ([r, g, b, _], name) = (named.color.to_f32(), escape(named.name.as_str()));
        let (row, column) = (i / columns, i % columns);
        // Writing to a text does not fail.
        let _ = write!(
            xml,
            " <ColorSetEntry name=\"{name}\" id=\"\" bitdepth=\"U8\" spot=\"false\">\n  \
             <RGB space=\"{SRGB}\" r=\"{r}\" g=\"{g}\" b=\"{b}\"/>\n  \
             <Position row=\"{row}\" column=\"{column}\"/>\n </ColorSetEntry>\n"
        );
    }
    xml.push_str("</ColorSet>\n");
    let pack = || {
        let mut packer = ZipPacker::default();
        packer.store("mimetype", MIME.as_bytes())?;
        packer.deflate(LIST, xml.as_bytes())?;
        packer.deflate("profiles.xml", b"<Profiles/>\n")?;
        packer.finish()
    };
    pack().map_err(|error| Error::decode(file, error))
}
