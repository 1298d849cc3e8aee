//! Reads `maindoc.xml`, the list of a Krita file's layers. Floor 5.

use crate::math::Size;
use crate::{Budget, Error, Result};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::collections::HashMap;
use std::path::Path;

/// The image and its layers, the top first.
pub struct KritaImage {
    pub size: Size,
    pub layers: Vec<KritaNode>,
}

/// A layer or mask: its attributes and what lies in it, the top first.
#[derive(Default)]
pub struct KritaNode {
    attributes: HashMap<String, String>,
    pub layers: Vec<KritaNode>,
    pub masks: Vec<KritaNode>,
}

impl KritaNode {
    fn of(element: &BytesStart) -> Self {
        let attributes = element.attributes().flatten().map(|attribute| {
            // Entities of the file's own are not expanded: they could grow without bound.
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            let plain = || attribute.value.as_ref().to_owned();
            let value = value.map_or_else(|_| plain(), |value| value.into_owned());
            (attribute.key.as_ref().to_owned(), value)
        });
        Self { attributes: attributes.collect(), ..Self::default() }
    }

    /// An attribute; empty where there is none.
    pub fn text(&self, name: &str) -> &str {
        self.attributes.get(name).map_or("", String::as_str)
    }

    /// Finite.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.text(name).trim().parse().ok().filter(|number: &f64| number.is_finite())
    }
}

/// Reads the list.
pub fn read(file: &Path, text: &[u8], budget: &Budget) -> Result<KritaImage> {
    let text =
        std::str::from_utf8(text).map_err(|_| Error::decode(file, "maindoc.xml is not UTF-8"))?;
    let xml = Reader::from_str(text.strip_prefix('\u{feff}').unwrap_or(text));
    let mut parser = MaindocParser { file, budget, xml, left: budget.layers };
    let mut size = None;
    loop {
        match parser.event()? {
            Event::Start(e) if e.local_name().as_ref() == "IMAGE" => {
                let image = KritaNode::of(&e);
                let side = |name: &str| {
                    let side = image.number(name).filter(|side| *side >= 1.0);
                    side.map(|side| side.round() as u64).unwrap_or(0)
                };
                size = Some(budget.size(file, side("width"), side("height"))?);
            }
            Event::Start(e) if e.local_name().as_ref() == "layers" => {
                let layers = parser.nodes(0)?;
                let size = size.ok_or_else(|| parser.refusal("it has no <IMAGE>"))?;
                return Ok(KritaImage { size, layers });
            }
            Event::Eof => return Err(parser.refusal("it has no <layers>")),
            _ => {}
        }
    }
}

struct MaindocParser<'a> {
    file: &'a Path,
    budget: &'a Budget,
    xml: Reader<&'a [u8]>,
    /// How many more layers and masks the budget allows.
    left: usize,
}

impl<'a> MaindocParser<'a> {
    fn event(&mut self) -> Result<Event<'a>> {
        let damaged = |e| Error::decode(self.file, format!("maindoc.xml is damaged ({e})"));
        self.xml.read_event().map_err(damaged)
    }

    fn refusal(&self, reason: &str) -> Error {
        Error::decode(self.file, format!("maindoc.xml: {reason}"))
    }

    /// Layers or masks up to the end of their list.
    fn nodes(&mut self, depth: usize) -> Result<Vec<KritaNode>> {
        if depth > self.budget.group_depth {
            let most = self.budget.group_depth;
            let reason = format!("maindoc.xml nests more than {most} groups");
            return Err(Error::too_large(self.file, reason));
        }
        let mut nodes = Vec::new();
        loop {
            let (element, is_open) = match self.event()? {
                Event::Start(e) => (e, true),
                Event::Empty(e) => (e, false),
                Event::End(_) => return Ok(nodes),
                Event::Eof => return Err(self.refusal("it ends within a list of layers")),
                _ => continue,
            };
            if matches!(element.local_name().as_ref(), "layer" | "mask") {
                let most = self.budget.layers;
                self.left = self.left.checked_sub(1).ok_or_else(|| {
                    Error::too_large(self.file, format!("it has more than {most} layers"))
                })?;
                let mut node = KritaNode::of(&element);
                if is_open {
                    self.read_children(&mut node, depth)?;
                }
                nodes.push(node);
            } else if is_open {
                self.skip(&element)?;
            }
        }
    }

    /// The lists within a layer, up to its end.
    fn read_children(&mut self, node: &mut KritaNode, depth: usize) -> Result<()> {
        loop {
            match self.event()? {
                Event::Start(e) => match e.local_name().as_ref() {
                    "layers" => node.layers = self.nodes(depth + 1)?,
                    "masks" => node.masks = self.nodes(depth + 1)?,
                    _ => self.skip(&e)?,
                },
                Event::End(_) => return Ok(()),
                Event::Eof => return Err(self.refusal("it ends within a layer")),
                _ => {}
            }
        }
    }

    fn skip(&mut self, element: &BytesStart) -> Result<()> {
        let damaged = |e| Error::decode(self.file, format!("maindoc.xml is damaged ({e})"));
        self.xml.read_to_end(element.to_end().to_owned().name()).map(drop).map_err(damaged)
    }
}
