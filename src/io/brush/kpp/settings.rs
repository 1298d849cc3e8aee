//! The settings of a Krita preset: names and texts, and the files that the preset holds itself.
//! Floor 5.

use super::super::beside::{ResourceKind, base_name};
use crate::{Budget, Error, Result, base64};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

/// Bytes that a preset's text may have. Those of Krita 5 hold their tips and patterns: the largest
/// seen has four million.
const MOST_BYTES: usize = 64 << 20;
const KEYWORD: &str = "preset";
const PNG: [u8; 4] = *b"\x89PNG";

/// The settings of a preset.
#[derive(Default)]
pub struct KppPreset {
    pub name: String,
    pub engine: String,
    settings: BTreeMap<String, String>,
    /// Shared with its masked brush.
    held: Rc<Vec<HeldFile>>,
}

/// A file within the preset, as base64.
struct HeldFile {
    kind: ResourceKind,
    name: String,
    text: String,
}

/// What the settings of a masked brush's second tip begin with.
const MASKED: &str = "MaskingBrush/Preset/";

/// Where text belongs.
enum XmlPlace {
    Nowhere,
    Param(String),
    HeldFile,
}

impl KppPreset {
    /// The settings of a preset's file.
    pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Self> {
        let text = preset_text(file, bytes, budget)?;
        parse(file, &text)
    }

    pub fn text(&self, name: &str) -> &str {
        self.settings.get(name).map_or("", String::as_str)
    }

    pub fn is_true(&self, name: &str) -> bool {
        self.text(name) == "true"
    }

    /// Finite.
    pub fn number(&self, name: &str) -> Option<f32> {
        number(self.text(name))
    }

    /// A share of 1.
    pub fn unit(&self, name: &str, plain: f32) -> f32 {
        self.number(name).unwrap_or(plain).max(0.0).min(1.0)
    }

    /// Splits off the settings of a masked brush's second tip, which are those of a pixel brush.
    pub fn split_masked(&mut self) -> KppPreset {
        let is_masked = |name: &str| name.starts_with(MASKED);
        let all = std::mem::take(&mut self.settings);
        let (masked, own): (BTreeMap<_, _>, BTreeMap<_, _>) =
            all.into_iter().partition(|(name, _)| is_masked(name));
        self.settings = own;
        let strip = |(name, text): (String, String)| (name[MASKED.len()..].to_owned(), text);
        KppPreset {
            name: String::new(),
            engine: "paintbrush".to_owned(),
            settings: masked.into_iter().map(strip).collect(),
            held: self.held.clone(),
        }
    }

    /// A file that the preset holds under a name; `None` where it holds none or a damaged one.
    pub fn held_file(&self, kind: ResourceKind, name: &str) -> Option<Vec<u8>> {
        let held = self.held.iter().find(|held| held.kind == kind && held.name == name)?;
        decode_base64(held.text.as_bytes())
    }

    /// The PNG that a setting holds. Older presets hold it as base64, later ones as base64 of that.
    pub fn held_png(&self, name: &str) -> Option<Vec<u8>> {
        let once = decode_base64(self.text(name).as_bytes()).filter(|bytes| !bytes.is_empty())?;
        if once.starts_with(&PNG) { Some(once) } else { decode_base64(&once) }
    }
}

pub fn number(text: &str) -> Option<f32> {
    text.trim().parse().ok().filter(|v: &f32| v.is_finite())
}

/// Base64 with padding and line breaks.
fn decode_base64(text: &[u8]) -> Option<Vec<u8>> {
    let is_letter = |c: &u8| !c.is_ascii_whitespace() && *c != b'=';
    let letters = String::from_utf8(text.iter().copied().filter(is_letter).collect()).ok()?;
    base64::decode(&letters)
}

/// The text of the settings.
fn preset_text(file: &Path, bytes: &[u8], budget: &Budget) -> Result<String> {
    let most = MOST_BYTES.min(usize::try_from(budget.json_bytes).unwrap_or(MOST_BYTES));
    let limits = png::Limits { bytes: 4 * most };
    let decoder = png::Decoder::new_with_limits(std::io::Cursor::new(bytes), limits);
    let reader = decoder
        .read_info()
        .map_err(|e| Error::decode(file, format!("it is no Krita preset: {e}")))?;
    let info = reader.info();
    let is_preset = |keyword: &str| keyword == KEYWORD;
    let plain = info.uncompressed_latin1_text.iter().find(|chunk| is_preset(&chunk.keyword));
    if let Some(chunk) = plain {
        return Ok(chunk.text.clone());
    }
    let damaged = |e: png::DecodingError| {
        let reason = format!("its settings are damaged, or longer than {most} bytes ({e})");
        Error::decode(file, reason)
    };
    if let Some(chunk) = info.utf8_text.iter().find(|chunk| is_preset(&chunk.keyword)) {
        let mut chunk = chunk.clone();
        return chunk
            .decompress_text_with_limit(most)
            .and_then(|()| chunk.get_text())
            .map_err(damaged);
    }
    let packed = info.compressed_latin1_text.iter().find(|chunk| is_preset(&chunk.keyword));
    let packed = packed.ok_or_else(|| Error::decode(file, "it is a PNG without a Krita preset"))?;
    let mut chunk = packed.clone();
    chunk.decompress_text_with_limit(most).and_then(|()| chunk.get_text()).map_err(damaged)
}

fn parse(file: &Path, text: &str) -> Result<KppPreset> {
    let broken =
        |e: &dyn std::fmt::Display| Error::decode(file, format!("the settings are damaged: {e}"));
    let mut reader = Reader::from_str(text);
    let mut preset = KppReader::default();
    let mut place = XmlPlace::Nowhere;
    loop {
        match reader.read_event().map_err(|e| broken(&e))? {
            Event::Start(start) | Event::Empty(start) => place = preset.enter(&start),
            Event::CData(data) => preset.append(&place, &data),
            Event::Text(text) => preset.append(&place, &text),
            Event::End(end) if matches!(end.local_name().as_ref(), "param" | "resource") => {
                place = XmlPlace::Nowhere;
            }
            Event::Eof => return Ok(preset.finish()),
            _ => {}
        }
    }
}

/// A preset being read.
#[derive(Default)]
struct KppReader {
    preset: KppPreset,
    held: Vec<HeldFile>,
}

impl KppReader {
    fn finish(self) -> KppPreset {
        KppPreset { held: Rc::new(self.held), ..self.preset }
    }

    /// What an element says; returns where the text within it belongs.
    fn enter(&mut self, start: &BytesStart) -> XmlPlace {
        let text = |name: &str| attribute(start, name).unwrap_or_default();
        match start.local_name().as_ref() {
            "Preset" => {
                self.preset.name = text("name");
                self.preset.engine = text("paintopid");
            }
            "param" => {
                if let Some(name) = attribute(start, "name") {
                    self.preset.settings.insert(name.clone(), String::new());
                    return XmlPlace::Param(name);
                }
            }
            "resource" => {
                let (kind, name) = (ResourceKind::of_folder(&text("type")), text("filename"));
                if let (Some(kind), Some(name)) = (kind, base_name(&name)) {
                    self.held.push(HeldFile { kind, name: name.into(), text: String::new() });
                    return XmlPlace::HeldFile;
                }
            }
            _ => {}
        }
        XmlPlace::Nowhere
    }

    fn append(&mut self, place: &XmlPlace, text: &str) {
        let value = match place {
            XmlPlace::Nowhere => None,
            XmlPlace::Param(name) => self.preset.settings.get_mut(name),
            XmlPlace::HeldFile => self.held.last_mut().map(|held| &mut held.text),
        };
        if let Some(value) = value {
            value.push_str(text.trim());
        }
    }
}

pub fn attribute(start: &BytesStart, name: &str) -> Option<String> {
    let attribute = start.try_get_attribute(name).ok().flatten()?;
    attribute.normalized_value(XmlVersion::Implicit1_0).ok().map(|value| value.into_owned())
}

/// The first element of a name in a text, by its attributes.
pub fn element<'a>(text: &'a str, name: &str) -> Option<BytesStart<'a>> {
    let mut reader = Reader::from_str(text);
    loop {
        match reader.read_event().ok()? {
            Event::Start(start) | Event::Empty(start) if start.local_name().as_ref() == name => {
                return Some(start);
            }
            Event::Eof => return None,
            _ => {}
        }
    }
}
