//! `stack.xml`, as OpenRaster has it: written from a plan, and read from any program's file into layers.
//! Floor 5. The pixels are `look`'s and `open`'s.

use super::plan::{Item, Shows};
use crate::document::kept::Encoded;
use crate::document::{Content, Layer, Lock};
use crate::io::Budget;
use crate::math::Size;
use crate::raster::BlendMode;
use crate::{Error, Result};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::path::Path;

/// Marks what is ours; other programs pass it by.
const NAMESPACE: &str = "xmlns:rilievo=\"urn:rilievo:project\"";
const KIND: &str = "rilievo:kind";

/// OpenRaster's words for blend modes.
const BLENDS: [(BlendMode, &str); 17] = [
    (BlendMode::Normal, "svg:src-over"),
    (BlendMode::Multiply, "svg:multiply"),
    (BlendMode::Screen, "svg:screen"),
    (BlendMode::Overlay, "svg:overlay"),
    (BlendMode::Darken, "svg:darken"),
    (BlendMode::Lighten, "svg:lighten"),
    (BlendMode::ColorDodge, "svg:color-dodge"),
    (BlendMode::ColorBurn, "svg:color-burn"),
    (BlendMode::HardLight, "svg:hard-light"),
    (BlendMode::SoftLight, "svg:soft-light"),
    (BlendMode::Difference, "svg:difference"),
    (BlendMode::Exclusion, "krita:exclusion"),
    (BlendMode::Hue, "svg:hue"),
    (BlendMode::Saturation, "svg:saturation"),
    (BlendMode::Color, "svg:color"),
    (BlendMode::Luminosity, "svg:luminosity"),
    (BlendMode::Plus, "svg:plus"),
];

/// The XML of a plan; `pictures` are those of [`super::look::pictures_of`] with their names, in that order.
pub fn write(size: Size, items: &[Item], pictures: &[(String, Encoded)]) -> String {
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<image version=\"0.0.6\" w=\"{}\" h=\"{}\" {NAMESPACE}>\n<stack>\n",
        size.width, size.height
    );
    write_items(&mut xml, items, &mut pictures.iter());
    xml + "</stack>\n</image>\n"
}

/// The topmost first, as OpenRaster has them; `pictures` come bottom first.
fn write_items(xml: &mut String, items: &[Item], pictures: &mut dyn Iterator<Item = &(String, Encoded)>) {
    let mut parts: Vec<String> = items.iter().map(|item| write_item(item, pictures)).collect();
    parts.reverse();
    xml.push_str(&parts.concat());
}

fn write_item(item: &Item, pictures: &mut dyn Iterator<Item = &(String, Encoded)>) -> String {
    let op = BLENDS.iter().find(|(mode, _)| *mode == item.blend).map_or(BLENDS[0].1, |(_, name)| name);
    let visibility = if item.visible { "visible" } else { "hidden" };
    let mut common = format!(
        "name=\"{}\" opacity=\"{}\" visibility=\"{visibility}\" composite-op=\"{op}\"",
        escaped(&item.name),
        item.opacity
    );
    if item.lock == Lock::All {
        common += " edit-locked=\"true\"";
    }
    match &item.shows {
        Shows::Stack { isolated, items } => {
            let isolation = if *isolated { "isolate" } else { "auto" };
            let mut xml = format!("<stack {common} isolation=\"{isolation}\">\n");
            write_items(&mut xml, items, pictures);
            xml + "</stack>\n"
        }
        Shows::Layer(layer) | Shows::Nothing(layer) => write_layer(&common, kind(&layer.content), pictures.next()),
        Shows::Composed { .. } => write_layer(&common, "composed", pictures.next()),
    }
}

fn write_layer(common: &str, kind: &str, picture: Option<&(String, Encoded)>) -> String {
    let Some((name, encoded)) = picture else { return String::new() };
    let kind = if kind.is_empty() { String::new() } else { format!(" {KIND}=\"{kind}\"") };
    format!("<layer {common} src=\"{name}\" x=\"{}\" y=\"{}\"{kind}/>\n", encoded.x, encoded.y)
}

/// What a layer is beside its pixels; empty where its pixels are all.
fn kind(content: &Content) -> &'static str {
    match content {
        Content::Pixels(_) | Content::Group(_) => "",
        _ => content.kind_name(),
    }
}

/// For an attribute; what XML cannot hold becomes U+FFFD.
fn escaped(text: &str) -> String {
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

/// What a `stack.xml` says.
pub struct Stack {
    pub size: Size,
    /// Bottom first.
    pub layers: Vec<Element>,
}

/// A layer or a nested stack.
pub struct Element {
    /// With its name, visibility, opacity and blend mode; its content is still to come.
    pub layer: Layer,
    pub shows: ElementShows,
    /// The kind of live layer that this is the picture of; empty for none.
    pub kind: String,
    /// A composite operation that has no equal here.
    pub unknown_op: Option<String>,
}

pub enum ElementShows {
    Picture {
        src: String,
        x: i32,
        y: i32,
    },
    /// Bottom first.
    Stack {
        isolated: bool,
        layers: Vec<Element>,
    },
}

/// Reads a `stack.xml`. Elements and attributes beyond OpenRaster's are passed by.
pub fn read(file: &Path, text: &[u8], budget: &Budget) -> Result<Stack> {
    let text = std::str::from_utf8(text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text));
    let text = text.map_err(|_| Error::decode(file, "stack.xml is not UTF-8"))?;
    let mut parser = Parser { file, budget, xml: Reader::from_str(text), left: budget.layers };
    parser.image()
}

struct Parser<'a> {
    file: &'a Path,
    budget: &'a Budget,
    xml: Reader<&'a [u8]>,
    /// How many more layers the budget allows.
    left: usize,
}

impl<'a> Parser<'a> {
    fn image(&mut self) -> Result<Stack> {
        let mut size = None;
        loop {
            match self.event()? {
                Event::Start(e) if e.local_name().as_ref() == "image" => size = Some(self.size(&e)?),
                Event::Start(e) if e.local_name().as_ref() == "stack" => {
                    let size = size.ok_or_else(|| self.refused("there is no <image> around the <stack>"))?;
                    let layers = self.stack(0)?;
                    return Ok(Stack { size, layers });
                }
                Event::Start(e) => self.skip(&e)?,
                Event::Eof => return Err(self.refused("it has no <stack>")),
                _ => {}
            }
        }
    }
    fn event(&mut self) -> Result<Event<'a>> {
        self.xml.read_event().map_err(|e| Error::decode(self.file, format!("stack.xml is damaged ({e})")))
    }
    fn refused(&self, reason: impl std::fmt::Display) -> Error {
        Error::decode(self.file, format!("stack.xml: {reason}"))
    }
    fn size(&self, image: &BytesStart) -> Result<Size> {
        let attributes = self.attributes(image)?;
        let side = |name: &str| {
            let value = attributes.get(name).and_then(|v| v.trim().parse::<u64>().ok());
            value.ok_or_else(|| self.refused(format!("<image> has no width and height ({name})")))
        };
        self.budget.size(self.file, side("w")?, side("h")?)
    }
    /// Everything up to the end of a stack, bottom first.
    fn stack(&mut self, depth: usize) -> Result<Vec<Element>> {
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
                Event::Eof => return Err(self.refused("it ends within a <stack>")),
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
    fn attributes(&self, element: &BytesStart) -> Result<Attributes> {
        let mut all = Attributes::default();
        for attribute in element.attributes() {
            let attribute = attribute.map_err(|e| self.refused(format!("an attribute is damaged ({e})")))?;
            let value = attribute
                .normalized_value(XmlVersion::Implicit1_0)
                .map_err(|e| self.refused(format!("a value is damaged ({e})")))?;
            all.0.push((attribute.key.as_ref().to_owned(), value.into_owned()));
        }
        Ok(all)
    }
    /// A layer or stack by its attributes, the stack still empty.
    fn element(&mut self, element: &BytesStart) -> Result<Element> {
        self.left = self.left.checked_sub(1).ok_or_else(|| {
            Error::too_large(self.file, format!("stack.xml has more than {} layers", self.budget.layers))
        })?;
        let attributes = self.attributes(element)?;
        let is_stack = element.local_name().as_ref() == "stack";
        let op = attributes.get("composite-op").unwrap_or("svg:src-over");
        let blend = blend(op);
        let mut layer = Layer::new(attributes.get("name").unwrap_or(""), Content::Group(Default::default()));
        layer.visible = attributes.get("visibility") != Some("hidden");
        let opacity = attributes.get("opacity").and_then(|v| v.trim().parse::<f32>().ok());
        layer.opacity = opacity.filter(|o| o.is_finite()).map_or(1.0, |o| o.max(0.0).min(1.0));
        layer.blend = blend.unwrap_or_default();
        layer.clip_to_surface = false;
        if attributes.get("edit-locked") == Some("true") {
            layer.lock = Lock::All;
        }
        let offset = |name: &str| {
            let value = attributes.get(name).and_then(|v| v.trim().parse::<f64>().ok()).unwrap_or(0.0);
            value.max(-1e6).min(1e6) as i32
        };
        let shows = if is_stack {
            // A stack that is not set apart, and has nothing that would set it apart, blends layer by layer.
            let apart = attributes.get("isolation") == Some("isolate");
            let isolated = apart || layer.opacity < 1.0 || layer.blend != BlendMode::Normal;
            ElementShows::Stack { isolated, layers: Vec::new() }
        } else {
            let src = attributes.get("src").unwrap_or("").to_owned();
            ElementShows::Picture { src, x: offset("x"), y: offset("y") }
        };
        let kind = attributes.get(KIND).unwrap_or("").to_owned();
        let unknown_op = blend.is_none().then(|| op.to_owned());
        Ok(Element { layer, shows, kind, unknown_op })
    }
}

fn with_layers(element: Element, inner: Vec<Element>) -> Element {
    let shows = match element.shows {
        ElementShows::Stack { isolated, .. } => ElementShows::Stack { isolated, layers: inner },
        picture => picture,
    };
    Element { shows, ..element }
}

/// The blend mode of a composite operation, in OpenRaster's words or in those of programs that add their own.
fn blend(op: &str) -> Option<BlendMode> {
    let exact = BLENDS.iter().find(|(_, name)| *name == op).map(|(mode, _)| *mode);
    let plain = op.rsplit(':').next().unwrap_or(op).replace('_', "-");
    exact.or_else(|| BlendMode::from_name(&plain)).or(match plain.as_str() {
        "src-over" | "" => Some(BlendMode::Normal),
        "add" | "linear-dodge" => Some(BlendMode::Plus),
        _ => None,
    })
}

#[derive(Default)]
struct Attributes(Vec<(String, String)>);

impl Attributes {
    fn get(&self, name: &str) -> Option<&str> {
        self.0.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(xml: &str) -> Result<Stack> {
        read(Path::new("a.ora"), xml.as_bytes(), &Budget::default())
    }
    fn said(xml: &str) -> String {
        parsed(xml).err().unwrap().to_string()
    }

    #[test]
    fn stacks_come_bottom_first_with_their_attributes() {
        let xml = r#"<?xml version='1.0'?><image w="10" h="20" version="0.0.3"><stack>
            <layer name="top &amp; &#228;" src="data/1.png" x="-3" y="4.0" opacity="0.5" composite-op="svg:multiply"/>
            <stack name="g" isolation="isolate"><layer src="data/0.png" visibility="hidden"></layer></stack>
            <text>ignored</text></stack></image>"#;
        let stack = parsed(xml).unwrap();
        assert_eq!(stack.size, Size::new(10, 20));
        let [group, top] = &stack.layers[..] else { panic!("two") };
        assert_eq!(
            (top.layer.name.as_str(), top.layer.opacity, top.layer.blend),
            ("top & ä", 0.5, BlendMode::Multiply)
        );
        assert!(matches!(&top.shows, ElementShows::Picture { x: -3, y: 4, src } if src == "data/1.png"));
        let ElementShows::Stack { isolated: true, layers } = &group.shows else { panic!("isolated") };
        assert!(!layers[0].layer.visible);
    }
    #[test]
    fn damaged_deep_and_endless_stacks_get_a_sentence() {
        assert!(said("<image w='1' h='1'><stack><layer").contains("damaged"));
        assert!(said("<image w='1' h='1'>").contains("no <stack>"));
        assert!(said("<image w='99999' h='1'><stack/></image>").contains("99999"));
        let deep = format!("<image w='1' h='1'><stack>{}", "<stack>".repeat(40));
        assert!(said(&deep).contains("nests more than"));
        let many = format!("<image w='1' h='1'><stack>{}</stack></image>", "<layer/>".repeat(2001));
        assert!(said(&many).contains("more than 2000 layers"));
    }
    #[test]
    fn names_that_xml_cannot_hold_are_escaped() {
        let name = "a\"<b>&\n\u{1}ü";
        assert_eq!(escaped(name), "a&quot;&lt;b&gt;&amp;&#10;\u{fffd}ü");
    }
    #[test]
    fn operations_of_other_programs_are_known_by_their_names() {
        assert_eq!(blend("krita:linear_dodge"), Some(BlendMode::Plus));
        assert_eq!(blend("svg:src-over"), Some(BlendMode::Normal));
        assert_eq!(blend("svg:dst-in"), None);
    }
}
