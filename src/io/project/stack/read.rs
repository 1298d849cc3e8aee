//! Reads `stack.xml`, only as strictly as the layers need: programs add different things of their
//! own. Floor 5.

use super::KIND;
use crate::Budget;
use crate::document::{Content, Layer, LayerLock};
use crate::math::Size;
use crate::raster::BlendMode;
use crate::{Error, Result};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::borrow::Cow;
use std::path::Path;

/// The operation of Krita and Drawpile for a layer that keeps to the paint beneath it.
const ATOP: &str = "svg:src-atop";

/// The contents of a `stack.xml`.
pub struct StackXml {
    /// `None` if it does not say.
    pub size: Option<Size>,
    /// Bottom first.
    pub layers: Vec<StackElement>,
}

/// A layer or a nested stack.
pub struct StackElement {
    /// With its name, visibility, opacity and blend mode; its content is still to come.
    pub layer: Layer,
    pub shows: ElementContent,
    /// The kind of live layer that this is the picture of; empty for none.
    pub kind: String,
    /// A composite operation that has no equivalent here.
    pub unknown_op: Option<String>,
    /// Seen only where everything beneath it in its stack is.
    pub is_atop: bool,
}

pub enum ElementContent {
    Picture {
        src: String,
        x: i32,
        y: i32,
    },
    /// Bottom first.
    Stack {
        isolated: bool,
        layers: Vec<StackElement>,
    },
}

/// Reads a `stack.xml`. Elements and attributes beyond OpenRaster's are ignored.
pub fn read(file: &Path, text: &[u8], budget: &Budget) -> Result<StackXml> {
    let text =
        utf8(text).ok_or_else(|| Error::decode(file, "stack.xml is neither UTF-8 nor UTF-16"))?;
    let mut parser =
        StackParser { file, budget, xml: Reader::from_str(&text), left: budget.layers };
    parser.image()
}

/// The text as UTF-8, its byte order mark left out. UTF-16 begins with such a mark.
fn utf8(text: &[u8]) -> Option<Cow<'_, str>> {
    let units = |from: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = text.as_chunks().0.iter().skip(1).map(|unit| from(*unit)).collect();
        String::from_utf16(&units).ok().map(Cow::Owned)
    };
    match text {
        [0xff, 0xfe, ..] => units(u16::from_le_bytes),
        [0xfe, 0xff, ..] => units(u16::from_be_bytes),
        _ => std::str::from_utf8(text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text))
            .ok()
            .map(Cow::Borrowed),
    }
}

struct StackParser<'a> {
    file: &'a Path,
    budget: &'a Budget,
    xml: Reader<&'a [u8]>,
    /// How many more layers the budget allows.
    left: usize,
}

impl<'a> StackParser<'a> {
    fn image(&mut self) -> Result<StackXml> {
        let mut size = None;
        loop {
            match self.event()? {
                Event::Start(e) if e.local_name().as_ref() == "image" => size = self.size(&e)?,
                Event::Start(e) if e.local_name().as_ref() == "stack" => {
                    return Ok(StackXml { size, layers: self.stack(0)? });
                }
                Event::Empty(e) if e.local_name().as_ref() == "stack" => {
                    return Ok(StackXml { size, layers: Vec::new() });
                }
                Event::Start(e) => self.skip(&e)?,
                Event::Eof => return Err(self.refusal("it has no <stack>")),
                _ => {}
            }
        }
    }

    fn event(&mut self) -> Result<Event<'a>> {
        self.xml
            .read_event()
            .map_err(|e| Error::decode(self.file, format!("stack.xml is damaged ({e})")))
    }

    fn refusal(&self, reason: impl std::fmt::Display) -> Error {
        Error::decode(self.file, format!("stack.xml: {reason}"))
    }

    fn size(&self, image: &BytesStart) -> Result<Option<Size>> {
        let attributes = self.attributes(image)?;
        let side = |name: &str| {
            attributes.number(name).filter(|side| *side >= 1.0).map(|side| side.round() as u64)
        };
        match (side("w"), side("h")) {
            (Some(width), Some(height)) => self.budget.size(self.file, width, height).map(Some),
            _ => Ok(None),
        }
    }

    /// Everything up to the end of a stack, bottom first.
    fn stack(&mut self, depth: usize) -> Result<Vec<StackElement>> {
        if depth > self.budget.group_depth {
            let reason = format!("stack.xml nests more than {} stacks", self.budget.group_depth);
            return Err(Error::too_large(self.file, reason));
        }
        let mut layers = Vec::new();
        loop {
            match self.event()? {
                Event::Start(e) => match e.local_name().as_ref() {
                    "stack" => {
                        let element = self.element(&e)?;
                        let inner = self.stack(depth + 1)?;
                        layers.push(with_layers(element, inner));
                    }
                    "layer" => {
                        layers.push(self.element(&e)?);
                        self.skip(&e)?;
                    }
                    _ => self.skip(&e)?,
                },
                Event::Empty(e) => match e.local_name().as_ref() {
                    "stack" | "layer" => layers.push(self.element(&e)?),
                    _ => {}
                },
                Event::End(_) => break,
                Event::Eof => return Err(self.refusal("it ends within a <stack>")),
                _ => {}
            }
        }
        layers.reverse();
        Ok(layers)
    }

    fn skip(&mut self, element: &BytesStart) -> Result<()> {
        let damaged = |e| Error::decode(self.file, format!("stack.xml is damaged ({e})"));
        self.xml.read_to_end(element.to_end().to_owned().name()).map(drop).map_err(damaged)
    }

    fn attributes(&self, element: &BytesStart) -> Result<XmlAttributes> {
        let mut all = XmlAttributes::default();
        for attribute in element.attributes() {
            let attribute =
                attribute.map_err(|e| self.refusal(format!("an attribute is damaged ({e})")))?;
            // Custom entities are not expanded: they could grow without bound or lead to other
            // files.
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            let value = value.map_or_else(|_| attribute.value.as_ref().to_owned(), Cow::into_owned);
            all.0.push((attribute.key.as_ref().to_owned(), value));
        }
        Ok(all)
    }

    /// A layer or stack by its attributes, the stack still empty.
    fn element(&mut self, element: &BytesStart) -> Result<StackElement> {
        self.left = self.left.checked_sub(1).ok_or_else(|| {
            Error::too_large(
                self.file,
                format!("stack.xml has more than {} layers", self.budget.layers),
            )
        })?;
        let attributes = self.attributes(element)?;
        let is_stack = element.local_name().as_ref() == "stack";
        let op = attributes.get("composite-op").unwrap_or("svg:src-over");
        let blend = blend(op);
        let mut layer =
            Layer::new(attributes.get("name").unwrap_or(""), Content::Group(Default::default()));
        layer.visible = attributes.get("visibility") != Some("hidden");
        layer.opacity = attributes.number("opacity").map_or(1.0, |o| o.max(0.0).min(1.0) as f32);
        layer.blend = blend.unwrap_or_default();
        layer.clip_to_surface = false;
        if attributes.get("edit-locked") == Some("true") {
            layer.lock = LayerLock::All;
        }
        let offset =
            |name: &str| attributes.number(name).unwrap_or(0.0).max(-1e6).min(1e6).round() as i32;
        let shows = if is_stack {
            // A stack that is not isolated, and has no property that isolates it, blends layer by
            // layer.
            let apart = attributes.get("isolation") == Some("isolate");
            let isolated = apart || layer.opacity < 1.0 || layer.blend != BlendMode::Normal;
            ElementContent::Stack { isolated, layers: Vec::new() }
        } else {
            let src = attributes.get("src").unwrap_or("").to_owned();
            ElementContent::Picture { src, x: offset("x"), y: offset("y") }
        };
        let kind = attributes.get(KIND).unwrap_or("").to_owned();
        let is_atop = op == ATOP;
        let unknown_op = (blend.is_none() && !is_atop).then(|| op.to_owned());
        Ok(StackElement { layer, shows, kind, unknown_op, is_atop })
    }
}

fn with_layers(element: StackElement, inner: Vec<StackElement>) -> StackElement {
    let shows = match element.shows {
        ElementContent::Stack { isolated, .. } => ElementContent::Stack { isolated, layers: inner },
        picture => picture,
    };
    StackElement { shows, ..element }
}

/// The blend mode of a composite operation, in OpenRaster's words or in those of programs that add
/// their own.
fn blend(op: &str) -> Option<BlendMode> {
    let plain = op.rsplit(':').next().unwrap_or(op).replace(['_', ' '], "-");
    BlendMode::from_openraster(op).or_else(|| BlendMode::from_name(&plain)).or(
        match plain.as_str() {
            "src-over" | "" => Some(BlendMode::Normal),
            "add" => Some(BlendMode::LinearDodge),
            _ => None,
        },
    )
}

#[derive(Default)]
struct XmlAttributes(Vec<(String, String)>);

impl XmlAttributes {
    fn get(&self, name: &str) -> Option<&str> {
        self.0.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }

    /// Some programs write whole numbers with a fraction.
    fn number(&self, name: &str) -> Option<f64> {
        self.get(name)?.trim().parse().ok().filter(|number: &f64| number.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(xml: &str) -> Result<StackXml> {
        read(Path::new("a.ora"), xml.as_bytes(), &Budget::default())
    }

    fn error_of(xml: &str) -> String {
        parsed(xml).err().unwrap().to_string()
    }

    #[test]
    fn stacks_come_bottom_first_with_their_attributes() {
        let xml = r#"<?xml version='1.0'?><image w="10" h="20" version="0.0.3"><stack>
            <layer name="top &amp; &#228;" src="data/1.png" x="-3" y="4.0" opacity="0.5" composite-op="svg:multiply"/>
            <stack name="g" isolation="isolate"><layer src="data/0.png" visibility="hidden"></layer></stack>
            <text>ignored</text></stack></image>"#;
        let stack = parsed(xml).unwrap();
        assert_eq!(stack.size, Some(Size::new(10, 20)));
        let [group, top] = &stack.layers[..] else { panic!("two") };
        assert_eq!(
            (top.layer.name.as_str(), top.layer.opacity, top.layer.blend),
            ("top & ä", 0.5, BlendMode::Multiply)
        );
        assert!(
            matches!(&top.shows, ElementContent::Picture { x: -3, y: 4, src } if src == "data/1.png")
        );
        let ElementContent::Stack { isolated: true, layers } = &group.shows else {
            panic!("isolated")
        };
        assert!(!layers[0].layer.visible);
    }

    #[test]
    fn what_programs_write_differently_is_understood() {
        let body = "w=\"32.0\" h='24'><stack><layer name='&a; ü' x='1.5' composite-op='svg:src-atop'/></stack></image>";
        let plain = format!(
            "<?xml version='1.0'?><!DOCTYPE image [<!ENTITY a SYSTEM 'file:///b'>]><image {body}"
        );
        let sixteen = |to: fn(u16) -> [u8; 2]| {
            [0xfeff].into_iter().chain(plain.encode_utf16()).flat_map(to).collect()
        };
        let marked = [b"\xef\xbb\xbf", plain.as_bytes()].concat();
        for text in [
            plain.clone().into_bytes(),
            marked,
            sixteen(u16::to_le_bytes),
            sixteen(u16::to_be_bytes),
        ] {
            let stack = read(Path::new("a.ora"), &text, &Budget::default()).unwrap();
            let layer = &stack.layers[0];
            assert_eq!((stack.size, layer.layer.name.as_str()), (Some(Size::new(32, 24)), "&a; ü"));
            assert!(
                layer.is_atop && matches!(layer.shows, ElementContent::Picture { x: 2, y: 0, .. })
            );
        }
        assert!(parsed("<image><stack/></image>").unwrap().size.is_none());
    }

    #[test]
    fn damaged_deep_and_endless_stacks_get_a_sentence() {
        assert!(error_of("<image w='1' h='1'><stack><layer").contains("damaged"));
        assert!(error_of("<image w='1' h='1'>").contains("no <stack>"));
        assert!(error_of("<image w='99999' h='1'><stack/></image>").contains("99999"));
        let deep = format!("<image w='1' h='1'><stack>{}", "<stack>".repeat(60));
        assert!(error_of(&deep).contains("nests more than"));
        let many =
            format!("<image w='1' h='1'><stack>{}</stack></image>", "<layer/>".repeat(10_001));
        assert!(error_of(&many).contains("more than 10000 layers"));
    }

    #[test]
    fn operations_of_other_programs_are_known_by_their_names() {
        assert_eq!(blend("krita:linear_dodge"), Some(BlendMode::LinearDodge));
        assert_eq!(blend("krita:hard mix"), Some(BlendMode::HardMix));
        assert_eq!(blend("svg:src-over"), Some(BlendMode::Normal));
        assert_eq!(blend("svg:dst-in"), None);
    }
}
