//! Reads OpenRaster files that other programs wrote or changed: every picture becomes a paint
//! layer, and layers that are still as we wrote them become live again. Floor 5.

use super::MERGED;
use super::manifest::Manifest;
use super::png_header::{PNG_HEADER, png_size};
use super::reader::ProjectReader;
use super::repair::{isolate, layer_mut, name_of, without_layers};
use super::stack::{self, ElementContent, StackElement, StackXml};
use crate::document::{Content, Document, Group, Layer, PixelLayer};
use crate::math::Size;
use crate::picture;
use crate::raster::TileGrid;
use crate::recipe::TileGrids;
use crate::{Error, Result};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// A document from the plain OpenRaster entries.
pub fn document(reading: &mut ProjectReader, stack: StackXml) -> Result<Document> {
    let size = size(reading, &stack)?;
    fit_together(reading, &stack.layers, None)?;
    let mut reader =
        ForeignReader { reading, used_px: 0, used_bytes: 0, known: HashMap::new(), live: None };
    let layers = reader.layers(stack.layers)?;
    let profile = reader.reading.profile;
    Ok(Document { layers, profile, ..Document::empty(size) })
}

/// The canvas's size from `stack.xml`, else from the merged picture.
fn size(reading: &ProjectReader, stack: &StackXml) -> Result<Size> {
    if let Some(size) = stack.size {
        return Ok(size);
    }
    let merged = reading
        .archive
        .bytes(MERGED, reading.budget.file_bytes)
        .ok()
        .and_then(|bytes| png_size(&bytes));
    let merged = merged
        .ok_or_else(|| Error::decode(reading.file, "stack.xml: <image> has no width and height"))?;
    reading.budget.size(reading.file, merged.width.into(), merged.height.into())
}

/// Counts the pixels of the pictures by their headers, before the first is decoded: an empty
/// picture packs a thousandfold, and decoding many of them takes long before the limit is reached.
///
/// * `ours`: pictures that may show layers as we saved them are not decoded, and not counted.
fn fit_together(
    reading: &ProjectReader,
    elements: &[StackElement],
    ours: Option<&Manifest>,
) -> Result<()> {
    let is_ours = |src: &str| {
        ours.is_some_and(|manifest| manifest.pictures.iter().any(|shown| shown.name == src))
    };
    let (mut sizes, mut used_px) = (HashMap::new(), 0u64);
    let mut left: Vec<&StackElement> = elements.iter().collect();
    while let Some(element) = left.pop() {
        match &element.shows {
            ElementContent::Stack { layers, .. } => left.extend(layers),
            ElementContent::Picture { src, .. } if is_ours(src) => {}
            ElementContent::Picture { src, .. } => {
                // Pictures other than PNGs are counted when they are decoded.
                let begun = || {
                    reading.archive.beginning(src, PNG_HEADER).and_then(|bytes| png_size(&bytes))
                };
                let area = |size: Size| u64::from(size.width) * u64::from(size.height);
                used_px = used_px
                    .saturating_add(*sizes.entry(src).or_insert_with(|| begun().map_or(0, area)));
                refuse_too_many_pixels(reading, used_px)?;
            }
        }
    }
    Ok(())
}

/// Refuses more pixels than the pictures of a document may have together.
fn refuse_too_many_pixels(reading: &ProjectReader, used_px: u64) -> Result<()> {
    if used_px > reading.budget.document_px {
        let reason =
            format!("its layers hold more than {} pixels together", reading.budget.document_px);
        return Err(Error::too_large(reading.file, reason));
    }
    Ok(())
}

/// A document that another program saved but left our entries in: its layers are those of
/// `stack.xml`, and those whose pictures are unchanged are as we saved them.
pub fn restore(
    reading: &mut ProjectReader,
    text: &[u8],
    value: &Value,
    manifest: &Manifest,
) -> Result<Document> {
    let stack = stack::read(reading.file, text, reading.budget)?;
    let size = size(reading, &stack)?;
    fit_together(reading, &stack.layers, Some(manifest))?;
    reading.note("the layers were changed by another program");
    // The surface alone: the layers are taken one by one.
    let mut base = value.clone();
    base["layers"] = json!([]);
    base["canvas"] = json!({ "width": size.width, "height": size.height });
    let around = without_layers(&base);
    let base = reading.read_value(&base).or_else(|error| {
        reading.note_loss(format!("the surface is lost: {error}"));
        Ok::<_, Error>(Document::empty(size))
    })?;
    let mut reader = ForeignReader {
        reading,
        used_px: 0,
        used_bytes: 0,
        known: HashMap::new(),
        live: Some(SavedState { value: value.clone(), around, manifest }),
    };
    let layers = reader.layers(stack.layers)?;
    let profile = reader.reading.profile;
    Ok(Document { layers, size, profile, ..base }.reshaped())
}

/// The list of layers is lost: each readable picture becomes a layer, else the merged picture.
pub fn leftovers(reading: &mut ProjectReader, error: Error) -> Result<Document> {
    let names: Vec<String> = reading.archive.names().into_iter().map(str::to_owned).collect();
    let is_layer =
        |name: &&String| name.starts_with("data/") && name.to_lowercase().ends_with(".png");
    let mut layers = Vec::new();
    let mut size: Option<Size> = None;
    let (mut used_bytes, budget) = (0, reading.picture_budget());
    let only_merged = MERGED.to_owned();
    for name in names.iter().filter(is_layer).chain([&only_merged]) {
        // The merged picture shows all the others.
        if *name == MERGED && !layers.is_empty() {
            break;
        }
        let Ok(bytes) = reading.archive.bytes(name, reading.budget.file_bytes) else { continue };
        let painted = match picture::decode_paint(Path::new(name), &bytes, 0, 0, &budget) {
            Ok(painted) => painted,
            Err(error) if reading.can_fit_if_rounded(&error) => return Err(error),
            Err(_) => continue,
        };
        let (own, tiles) = (painted.size, painted.tiles);
        let grown = |s: Size| Size::new(s.width.max(own.width), s.height.max(own.height));
        size = Some(size.map_or(own, grown));
        used_bytes += tiles.bytes() as u64;
        reading.budget.room(reading.file, "what its layers hold", used_bytes)?;
        let content = Content::Pixels(PixelLayer { file: name.clone(), x: 0, y: 0, tiles });
        layers
            .push(Arc::new(Layer { clip_to_surface: false, ..Layer::new(name.as_str(), content) }));
        if layers.len() >= reading.budget.layers {
            break;
        }
    }
    let Some(size) = size else { return Err(error) };
    let profile = reading.profile;
    reading.note_loss(format!(
        "{error}; {} of its pictures could be read, their order and places are lost",
        layers.len()
    ));
    Ok(Document { layers, profile, ..Document::empty(size) })
}

/// The picture that another program put beside what it alone reads.
pub fn read_stored_picture(
    reading: &mut ProjectReader,
    entry: &str,
    sentence: &str,
) -> Result<Document> {
    let bytes = reading.archive.bytes(entry, reading.budget.file_bytes)?;
    let path = reading.archive_path(entry);
    let painted = picture::decode_paint(&path, &bytes, 0, 0, reading.budget)?;
    reading.note_loss(sentence);
    let name = reading.file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let tiles = painted.tiles;
    let content = Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles });
    let layer = Layer { clip_to_surface: false, ..Layer::new(name, content) };
    Ok(Document { layers: vec![Arc::new(layer)], ..Document::empty(painted.size) })
}

/// What we saved, for layers that are unchanged.
struct SavedState<'a> {
    value: Value,
    /// What each layer is read in.
    around: Value,
    manifest: &'a Manifest,
}

struct ForeignReader<'a, 'b> {
    reading: &'a mut ProjectReader<'b>,
    used_px: u64,
    used_bytes: u64,
    /// Decoded pictures, by file and corner: layers that show the same one share its tiles.
    known: TileGrids,
    live: Option<SavedState<'a>>,
}

impl ForeignReader<'_, '_> {
    fn layers(&mut self, elements: Vec<StackElement>) -> Result<Vec<Arc<Layer>>> {
        let mut layers = Vec::new();
        for element in elements {
            let is_atop = element.is_atop;
            let layer = self.layer(element)?;
            let clip_below = is_atop && !layers.is_empty();
            if clip_below {
                layers = as_one_base(layers);
            }
            layers.push(Arc::new(Layer { clip_below, ..layer }));
        }
        Ok(layers)
    }

    fn layer(&mut self, element: StackElement) -> Result<Layer> {
        let StackElement { mut layer, shows, kind, unknown_op, .. } = element;
        if let Some(op) = unknown_op {
            self.reading.note(format!(
                "“{}” is blended by “{op}” elsewhere; here it is blended normally",
                layer.name
            ));
        }
        match shows {
            ElementContent::Stack { isolated, layers } => {
                let layers = self.layers(layers)?;
                layer.content = Content::Group(Group { layers, pass_through: !isolated });
            }
            ElementContent::Picture { src, x, y } => {
                if let Some(live) = self.live(&src, x, y) {
                    let Layer { name, visible, opacity, blend, .. } = layer;
                    return Ok(Layer { name, visible, opacity, blend, ..live });
                }
                if !kind.is_empty() {
                    self.reading.note(pixels_note(&layer.name, &kind));
                }
                layer.content = Content::Pixels(self.picture(&layer.name, src, x, y)?);
            }
        }
        Ok(layer)
    }

    /// The layer as we saved it, if its picture is still the same and where it was.
    fn live(&mut self, src: &str, x: i32, y: i32) -> Option<Layer> {
        let saved = self.live.as_mut()?;
        let shown = saved.manifest.pictures.iter().find(|shown| shown.name == src)?;
        let bytes = self.reading.archive.bytes(src, self.reading.budget.file_bytes).ok()?;
        ((shown.x, shown.y) == (x, y) && crc32fast::hash(&bytes) == shown.crc).then_some(())?;
        let layer = layer_mut(&mut saved.value, &shown.layer)?.clone();
        match self.reading.read_value(&isolate(&saved.around, &layer)) {
            Ok(document) => document.layers.into_iter().next().map(Arc::unwrap_or_clone),
            Err(error) => {
                self.reading.note_loss(format!("“{}” became pixels: {error}", name_of(&layer)));
                None
            }
        }
    }

    fn picture(&mut self, name: &str, src: String, x: i32, y: i32) -> Result<PixelLayer> {
        let key = (src, x, y);
        if let Some(tiles) = self.known.get(&key).cloned() {
            return Ok(PixelLayer { file: key.0, x, y, tiles });
        }
        let path = self.reading.archive_path(&key.0);
        let budget = self.reading.picture_budget();
        let read = self.reading.archive.bytes(&key.0, self.reading.budget.file_bytes);
        let decoded = read.and_then(|bytes| picture::decode_paint(&path, &bytes, x, y, &budget));
        let decoded = match decoded {
            Ok(decoded) => decoded,
            Err(error @ Error::TooLarge { .. }) => return Err(error),
            Err(error) => {
                self.reading.note_loss(format!("“{name}” is lost: {error}"));
                return Ok(PixelLayer { file: String::new(), x, y, tiles: TileGrid::default() });
            }
        };
        self.used_px += decoded.size.area() as u64;
        refuse_too_many_pixels(self.reading, self.used_px)?;
        self.used_bytes += decoded.tiles.bytes() as u64;
        self.reading.budget.room(self.reading.file, "what its layers hold", self.used_bytes)?;
        self.known.insert(key.clone(), decoded.tiles.clone());
        Ok(PixelLayer { file: key.0, x, y, tiles: decoded.tiles })
    }
}

/// Makes one base of the layers beneath an “atop” layer, so that it can be clipped: the layers
/// themselves if only the lowest is not clipped, else a group of them.
pub fn as_one_base(layers: Vec<Arc<Layer>>) -> Vec<Arc<Layer>> {
    let is_set_apart =
        |layer: &Layer| !matches!(&layer.content, Content::Group(group) if group.pass_through);
    let is_base = |(i, layer): (usize, &Arc<Layer>)| {
        (i == 0) != layer.clip_below && (i > 0 || is_set_apart(layer))
    };
    if layers.iter().enumerate().all(is_base) {
        return layers;
    }
    let name =
        layers.last().map_or_else(String::new, |layer| format!("{} and beneath", layer.name));
    let group = Content::Group(Group { layers, pass_through: false });
    vec![Arc::new(Layer { clip_to_surface: false, ..Layer::new(name, group) })]
}

fn pixels_note(name: &str, kind: &str) -> String {
    match kind {
        "composed" => format!("“{name}” is pixels: it shows several layers composed by Rilievo"),
        kind => format!(
            "“{name}” became pixels: another program saved the file without its {kind} settings"
        ),
    }
}
