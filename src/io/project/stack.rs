//! `stack.xml` of OpenRaster: written from a plan, and read from any program's file into layers.
//! Floor 5. `layer_preview` and `open` handle the pixels.

mod read;

pub use read::{ElementContent, StackElement, StackXml, read};

use super::plan::{ItemContent, PlanItem};
use crate::document::EncodedPixels;
use crate::document::{Content, LayerLock};
use crate::math::Size;

/// The namespace of our own attributes, which other programs ignore.
const NAMESPACE: &str = "xmlns:rilievo=\"urn:rilievo:project\"";
const KIND: &str = "rilievo:kind";

/// The XML of a plan; `pictures` are those of [`super::layer_preview::pictures_of`] with their names, in
/// that order.
pub fn write(size: Size, items: &[PlanItem], pictures: &[(String, EncodedPixels)]) -> String {
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <image version=\"0.0.6\" w=\"{}\" h=\"{}\" {NAMESPACE}>\n<stack>\n",
        size.width, size.height
    );
    write_items(&mut xml, items, &mut pictures.iter());
    xml + "</stack>\n</image>\n"
}

/// The topmost first, as OpenRaster has them; `pictures` come bottom first.
fn write_items(
    xml: &mut String,
    items: &[PlanItem],
    pictures: &mut dyn Iterator<Item = &(String, EncodedPixels)>,
) {
    let mut parts: Vec<String> = items.iter().map(|item| write_item(item, pictures)).collect();
    parts.reverse();
    xml.push_str(&parts.concat());
}

fn write_item(
    item: &PlanItem,
    pictures: &mut dyn Iterator<Item = &(String, EncodedPixels)>,
) -> String {
    let op = item.blend.openraster();
    let visibility = if item.visible { "visible" } else { "hidden" };
    let mut common = format!(
        "name=\"{}\" opacity=\"{}\" visibility=\"{visibility}\" composite-op=\"{op}\"",
        escape(&item.name),
        item.opacity
    );
    if item.lock == LayerLock::All {
        common += " edit-locked=\"true\"";
    }
    match &item.shows {
        ItemContent::Stack { isolated, items } => {
            let isolation = if *isolated { "isolate" } else { "auto" };
            let mut xml = format!("<stack {common} isolation=\"{isolation}\">\n");
            write_items(&mut xml, items, pictures);
            xml + "</stack>\n"
        }
        ItemContent::Layer(layer) | ItemContent::Nothing(layer) => {
            write_layer(&common, kind(&layer.content), pictures.next())
        }
        ItemContent::Composed { .. } => write_layer(&common, "composed", pictures.next()),
    }
}

fn write_layer(common: &str, kind: &str, picture: Option<&(String, EncodedPixels)>) -> String {
    let Some((name, encoded)) = picture else { return String::new() };
    let kind = if kind.is_empty() { String::new() } else { format!(" {KIND}=\"{kind}\"") };
    format!("<layer {common} src=\"{name}\" x=\"{}\" y=\"{}\"{kind}/>\n", encoded.x, encoded.y)
}

/// The kind of a layer beyond its pixels; empty for plain pixels.
fn kind(content: &Content) -> &'static str {
    match content {
        Content::Pixels(_) | Content::Group(_) => "",
        _ => content.kind_name(),
    }
}

/// For an attribute; what XML cannot hold becomes U+FFFD.
fn escape(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\t' | '\n' | '\r' => out += &format!("&#{};", u32::from(c)),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_xml_cannot_hold_are_escaped() {
        let name = "a\"<b>&\n\u{1}ü";
        assert_eq!(escape(name), "a&quot;&lt;b&gt;&amp;&#10;\u{fffd}ü");
    }
}
