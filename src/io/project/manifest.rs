//! Records which picture of `data/` shows which layer, with checksums, so that changes by other
//! programs are detected. Floor 5.

use crate::document::EncodedPixels;
use crate::document::{Document, LayerId};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Another version of the program may render a layer differently.
const PROGRAM: &str = env!("CARGO_PKG_VERSION");

/// A project's record of its own entries.
#[derive(Debug, PartialEq)]
pub struct Manifest {
    /// The version that wrote the file.
    pub program: String,
    /// CRC-32 of `stack.xml`, or of the layer structure in another format.
    pub stack: u32,
    pub pictures: Vec<ManifestPicture>,
}

/// A picture of one layer alone.
#[derive(Debug, PartialEq)]
pub struct ManifestPicture {
    /// The layer's path in the document, such as `layers[2].layers[0]`.
    pub layer: String,
    pub name: String,
    /// CRC-32 of the PNG.
    pub crc: u32,
    pub x: i32,
    pub y: i32,
    /// It covers the surface's rim wholly: not as the layer looks here.
    pub whole_rim: bool,
}

impl Manifest {
    /// `whole_rims`: the layers whose pictures cover the surface's rim wholly.
    pub fn new(
        document: &Document,
        stack: u32,
        shown: &BTreeMap<LayerId, &(String, EncodedPixels)>,
        whole_rims: &BTreeSet<LayerId>,
    ) -> Self {
        let pictures = document.walk().into_iter().filter_map(|(path, layer)| {
            let (name, preview) = shown.get(&layer.id)?;
            let crc = crc32fast::hash(preview.file.bytes());
            let whole_rim = whole_rims.contains(&layer.id);
            Some(ManifestPicture {
                layer: path,
                name: name.clone(),
                crc,
                x: preview.x,
                y: preview.y,
                whole_rim,
            })
        });
        Self { program: PROGRAM.into(), stack, pictures: pictures.collect() }
    }

    pub fn is_of_this_program(&self) -> bool {
        self.program == PROGRAM
    }

    pub fn write(&self) -> Value {
        let picture = |p: &ManifestPicture| {
            let mut entry =
                json!({ "layer": p.layer, "picture": p.name, "crc32": p.crc, "x": p.x, "y": p.y });
            if p.whole_rim {
                entry["whole_rim"] = true.into();
            }
            entry
        };
        json!({
            "format": "rilievo-project",
            "version": 1,
            "program": self.program,
            "stack_crc32": self.stack,
            "pictures": self.pictures.iter().map(picture).collect::<Vec<_>>(),
        })
    }

    /// `None` for anything that this program would not have written.
    pub fn read(value: &Value) -> Option<Self> {
        let crc = |value: &Value| value.as_u64().and_then(|v| u32::try_from(v).ok());
        let offset = |value: &Value| value.as_i64().and_then(|v| i32::try_from(v).ok());
        let text = |value: &Value| value.as_str().map(str::to_owned);
        let picture = |p: &Value| {
            Some(ManifestPicture {
                layer: text(&p["layer"])?,
                name: text(&p["picture"])?,
                crc: crc(&p["crc32"])?,
                x: offset(&p["x"])?,
                y: offset(&p["y"])?,
                whole_rim: p["whole_rim"] == true,
            })
        };
        (value["format"] == "rilievo-project").then_some(())?;
        Some(Self {
            program: text(&value["program"])?,
            stack: crc(&value["stack_crc32"])?,
            pictures: value["pictures"].as_array()?.iter().map(picture).collect::<Option<_>>()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_manifest_reads_back() {
        let shown = |whole_rim| {
            let (layer, name) = ("layers[0]".into(), "data/000.png".into());
            ManifestPicture { layer, name, crc: u32::MAX, x: -4, y: 5, whole_rim }
        };
        let manifest =
            Manifest { program: "1".into(), stack: 7, pictures: vec![shown(false), shown(true)] };
        assert_eq!(Manifest::read(&manifest.write()), Some(manifest));
        assert_eq!(Manifest::read(&json!({ "format": "rilievo-project", "pictures": 3 })), None);
    }
}
