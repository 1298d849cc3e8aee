//! Reads Krita's files (`.kra`): layers, groups, transparency masks, blend modes, opacity and names.
//! Floor 5. What has no counterpart here, such as filter and vector layers, is named in a note.

mod maindoc;
mod pixels;

use super::foreign::as_one_base;
use super::reader::ProjectReader;
use crate::document::{
    Content, Document, Group, Layer, LayerLock, LayerMask, MaskKind, PixelLayer,
};
use crate::icc_profiles::is_display_p3;
use crate::math::{ColorProfile, Size};
use crate::raster::{BlendMode, Plane, TileGrid};
use crate::{Error, Result};
use maindoc::KritaNode;
use pixels::{KritaPixels, PixelFormat};
use std::sync::Arc;

/// The entry that lists the layers.
pub const MAINDOC: &str = "maindoc.xml";
/// How the name of the entry with the image's ICC profile ends.
const IMAGE_PROFILE: &str = "/annotations/icc";

/// A document of the layers that `maindoc.xml` lists, in Display P3 if the image is.
pub fn document(reading: &mut ProjectReader) -> Result<Document> {
    let text = reading.archive.bytes(MAINDOC, reading.budget.json_bytes)?;
    let image = maindoc::read(reading.file, &text, reading.budget)?;
    let profile = image_profile(reading);
    let entries = reading.archive.names().into_iter().filter(|name| name.contains("/layers/"));
    let entries = entries.map(str::to_owned).collect();
    let size = image.size;
    let mut reader = KritaReader { size, profile, reading, entries, used_px: 0, used_bytes: 0 };
    let layers = reader.layers(&image.layers)?;
    Ok(Document { layers, profile, ..Document::empty(size) })
}

fn image_profile(reading: &ProjectReader) -> ColorProfile {
    let names = reading.archive.names();
    let entry = names.into_iter().find(|name| name.ends_with(IMAGE_PROFILE));
    let icc = entry.and_then(|name| reading.archive.bytes(name, reading.budget.file_bytes).ok());
    let is_p3 = icc.is_some_and(|icc| is_display_p3(&icc));
    if is_p3 { ColorProfile::DisplayP3 } else { ColorProfile::Srgb }
}

struct KritaReader<'a, 'b> {
    reading: &'a mut ProjectReader<'b>,
    size: Size,
    /// The document's.
    profile: ColorProfile,
    /// Entries of layers.
    entries: Vec<String>,
    used_px: u64,
    used_bytes: u64,
}

impl KritaReader<'_, '_> {
    /// Nodes from the top down as layers from the bottom up.
    fn layers(&mut self, nodes: &[KritaNode]) -> Result<Vec<Arc<Layer>>> {
        let mut layers = Vec::new();
        for node in nodes.iter().rev() {
            let Some(layer) = self.layer(node)? else { continue };
            // Krita's layers that inherit alpha keep to all that lies beneath them in their group.
            let clip_below = is_inheriting_alpha(node) && !layers.is_empty();
            if clip_below {
                layers = as_one_base(layers);
            }
            layers.push(Arc::new(Layer { clip_below, ..layer }));
        }
        Ok(layers)
    }

    /// A node as a layer; `None` where it is of a kind that is not read.
    fn layer(&mut self, node: &KritaNode) -> Result<Option<Layer>> {
        let name = node.text("name");
        let content = match node.text("nodetype") {
            "grouplayer" => {
                let pass_through = node.text("passthrough") == "1";
                Content::Group(Group { layers: self.layers(&node.layers)?, pass_through })
            }
            "paintlayer" | "" => Content::Pixels(self.pixels(node)?),
            kind => {
                let what = match kind {
                    "adjustmentlayer" => "a filter layer",
                    "generatorlayer" | "filllayer" => "a fill layer",
                    "clonelayer" => "a clone layer",
                    "filelayer" => "a file layer",
                    "shapelayer" => "a vector layer",
                    _ => "of an unknown kind",
                };
                let advice = "convert it to a paint layer in Krita";
                self.reading
                    .note_loss(format!("“{name}” is {what}, which is not supported; {advice}"));
                return Ok(None);
            }
        };
        let op = node.text("compositeop");
        let blend = blend_of(op).unwrap_or_else(|| {
            let note =
                format!("“{name}” is blended by “{op}” in Krita; here it is blended normally");
            self.reading.note_loss(note);
            BlendMode::Normal
        });
        let opacity = node.number("opacity").unwrap_or(255.0).max(0.0).min(255.0) / 255.0;
        Ok(Some(Layer {
            visible: node.text("visible") != "0",
            opacity: opacity as f32,
            blend,
            lock: if node.text("locked") == "1" { LayerLock::All } else { LayerLock::None },
            mask: self.mask(node)?,
            clip_to_surface: false,
            ..Layer::new(name, content)
        }))
    }

    /// The name of an entry of a node's, whatever the folder of the image is called.
    fn entry(&self, node: &KritaNode, ending: &str) -> Option<String> {
        let wanted = format!("/layers/{}{ending}", node.text("filename"));
        self.entries.iter().find(|name| name.ends_with(&wanted)).cloned()
    }

    fn bytes(&self, name: &str) -> Result<Vec<u8>> {
        self.reading.archive.bytes(name, self.reading.budget.file_bytes)
    }

    /// The pixels of an entry, placed as its node says; `None` where there are none, with a note.
    fn read_pixels(&mut self, node: &KritaNode, ending: &str) -> Result<Option<KritaPixels>> {
        let name = node.text("name").to_owned();
        let Some(entry) = self.entry(node, ending) else {
            self.reading.note_loss(format!("“{name}” has no pixels in the file"));
            return Ok(None);
        };
        let plain = self.entry(node, &format!("{ending}.defaultpixel"));
        let plain = plain.and_then(|entry| self.bytes(&entry).ok()).unwrap_or_default();
        let offset = ["x", "y"]
            .map(|side| node.number(side).unwrap_or(0.0).max(-1e6).min(1e6).round() as i32);
        let read = self.bytes(&entry).and_then(|bytes| {
            pixels::read(self.reading.file, &bytes, plain, offset, self.size, self.reading.budget)
        });
        match read {
            Ok(pixels) => {
                self.used_px += pixels.area() as u64;
                let most = self.reading.budget.document_px;
                if self.used_px > most {
                    let reason = format!("its layers hold more than {most} pixels together");
                    return Err(Error::too_large(self.reading.file, reason));
                }
                Ok(Some(pixels))
            }
            Err(error @ Error::TooLarge { .. }) => Err(error),
            Err(error) => {
                self.reading.note_loss(format!("“{name}” is lost: {error}"));
                Ok(None)
            }
        }
    }

    fn pixels(&mut self, node: &KritaNode) -> Result<PixelLayer> {
        let mut layer = PixelLayer { file: String::new(), x: 0, y: 0, tiles: TileGrid::default() };
        let space = node.text("colorspacename");
        let Some(format) = PixelFormat::of(space, node.text("profile")) else {
            let name = node.text("name");
            self.reading.note_loss(format!(
                "“{name}” is lost: its colors are {space}; RGB and gray of 8 to 32 bits are \
                 supported"
            ));
            return Ok(layer);
        };
        let Some(pixels) = self.read_pixels(node, "")? else { return Ok(layer) };
        let icc = self.entry(node, ".icc").and_then(|entry| self.bytes(&entry).ok());
        let is_srgb = node.text("profile").to_lowercase().starts_with("srgb");
        let has_own =
            self.profile == ColorProfile::DisplayP3 && icc.as_deref().is_some_and(is_display_p3);
        let icc = icc.filter(|_| !is_srgb && !has_own);
        layer.tiles = pixels.tiles(format, icc.as_deref()).ok_or_else(|| {
            Error::decode(self.reading.file, format!("“{}” is damaged", node.text("name")))
        })?;
        let conversion = ColorProfile::Srgb.conversion_to(self.profile).filter(|_| !has_own);
        if let Some(by) = conversion {
            layer.tiles = layer.tiles.converted(by).0;
        }
        if !self.reading.budget.sixteen_bit_paint {
            layer.tiles = layer.tiles.rounded();
        }
        (layer.x, layer.y) = pixels.corner();
        self.used_bytes += layer.tiles.bytes() as u64;
        self.reading.budget.room(self.reading.file, "what its layers hold", self.used_bytes)?;
        Ok(layer)
    }

    /// The visible transparency masks of a node, multiplied.
    fn mask(&mut self, node: &KritaNode) -> Result<Option<LayerMask>> {
        let mut all: Option<Plane<u8>> = None;
        for mask in &node.masks {
            let kind = mask.text("nodetype");
            if kind != "transparencymask" {
                if !matches!(kind, "selectionmask" | "decoratorlayer") {
                    let (mask, layer) = (mask.text("name"), node.text("name"));
                    self.reading.note_loss(format!(
                        "the mask “{mask}” of “{layer}” is not supported ({kind})"
                    ));
                }
                continue;
            }
            if mask.text("visible") == "0" {
                self.reading
                    .note_loss(format!("the hidden mask “{}” is left out", mask.text("name")));
                continue;
            }
            let Some(pixels) = self.read_pixels(mask, ".pixelselection")? else { continue };
            let coverage = pixels.coverage(self.size);
            all = Some(match all {
                None => coverage,
                Some(other) => Plane::from_fn(self.size, |x, y| {
                    ((u32::from(other.at(x, y)) * u32::from(coverage.at(x, y)) + 127) / 255) as u8
                }),
            });
        }
        let file = |coverage| MaskKind::File { file: String::new(), coverage: Arc::new(coverage) };
        Ok(all.map(|coverage| LayerMask::new(file(coverage))))
    }
}

/// Whether the alpha of a layer is not painted on: the last of its channels is switched off.
fn is_inheriting_alpha(node: &KritaNode) -> bool {
    let flags = node.text("channelflags");
    flags.ends_with('0') && flags.contains('1')
}

/// The blend mode of one of Krita's composite operations.
pub fn blend_of(op: &str) -> Option<BlendMode> {
    Some(match op {
        "" | "normal" | "alphadarken" => BlendMode::Normal,
        "add" | "linear_dodge" => BlendMode::LinearDodge,
        "dodge" => BlendMode::ColorDodge,
        "burn" => BlendMode::ColorBurn,
        "diff" => BlendMode::Difference,
        "luminize" => BlendMode::Luminosity,
        "soft_light_svg" => BlendMode::SoftLight,
        "hard_mix_photoshop" => BlendMode::HardMix,
        op => BlendMode::from_name(&op.replace(['_', ' '], "-"))?,
    })
}

#[cfg(test)]
mod tests;
