//! Repairs a project that is damaged or was changed elsewhere: every intact layer is kept, the
//! others are reported. Floor 5. Works on the document's JSON, before it is read.

use super::manifest::{Manifest, ManifestPicture};
use super::png_header::png_size;
use super::reader::ProjectReader;
use crate::math::Size;
use crate::raster::Asset;
use serde_json::{Map, Value, json};

/// Compares the layers' pictures with the manifest. A layer whose picture another program changed
/// becomes that picture. Returns the intact pictures.
pub fn check_pictures(
    reading: &mut ProjectReader,
    document: &mut Value,
    manifest: &Manifest,
) -> Vec<(ManifestPicture, Asset, Size)> {
    let mut intact = Vec::new();
    for shown in &manifest.pictures {
        let Some(layer) = layer_mut(document, &shown.layer) else { continue };
        let (name, is_paint) = (name_of(layer), layer["file"] == shown.name.as_str());
        match reading.archive.bytes(&shown.name, reading.budget.file_bytes) {
            Ok(bytes) if crc32fast::hash(&bytes) == shown.crc => {
                let Some(size) = png_size(&bytes) else { continue };
                let shown = ManifestPicture {
                    layer: shown.layer.clone(),
                    name: shown.name.clone(),
                    ..*shown
                };
                intact.push((shown, bytes.into(), size));
            }
            Ok(_) if layer["kind"] == "group" => {}
            Ok(_) => {
                let what = if is_paint { "its pixels are those" } else { "it became pixels" };
                reading.note(format!("“{name}” was changed by another program: {what}"));
                *layer = as_picture(layer, Some(shown));
            }
            // Missing pixels of a paint layer are noticed when the document is read.
            Err(_) if is_paint => {}
            Err(_) => reading.note(format!(
                "the picture of “{name}” for other programs is lost; saving restores it"
            )),
        }
    }
    intact
}

/// Replaces every layer that cannot be read by its picture, or by an empty one, and leaves out maps
/// that cannot be read; whether there was any.
pub fn leave_out_damaged(
    reading: &mut ProjectReader,
    document: &mut Value,
    manifest: Option<&Manifest>,
) -> bool {
    let mut left_out = leave_out_selections(reading, document);
    if let Some(surface) = document.get("surface").cloned() {
        let mut alone = without_layers(document);
        alone["surface"] = surface;
        if let Err(error) = reading.read_value(&alone) {
            reading.note_loss(format!("the surface is lost: {error}"));
            if let Value::Object(fields) = &mut *document {
                fields.shift_remove("surface");
            }
            left_out = true;
        }
    }
    let around = without_layers(document);
    let mut paths = Vec::new();
    list_layers(&document["layers"], "", &mut paths);
    for path in paths {
        let Some(layer) = layer_mut(document, &path) else { continue };
        let Some(error) = trouble(reading, &around, layer) else { continue };
        let name = name_of(layer);
        let shown = manifest.and_then(|m| m.pictures.iter().find(|shown| shown.layer == path));
        let pixels = shown.map(|shown| as_picture(layer, Some(shown)));
        let pixels = pixels.filter(|pixels| pixels["file"] != layer["file"]);
        let pixels = pixels.filter(|pixels| trouble(reading, &around, pixels).is_none());
        match pixels {
            Some(pixels) => {
                reading.note_loss(format!("“{name}” became pixels: {error}"));
                *layer = pixels;
            }
            None => {
                reading.note_loss(format!("“{name}” is lost: {error}"));
                *layer = as_picture(layer, None);
            }
        }
        left_out = true;
    }
    left_out
}

/// Takes the masks of selections that cannot be read away; whether there was any.
fn leave_out_selections(reading: &mut ProjectReader, document: &mut Value) -> bool {
    let (mut left_out, canvas) = (false, document["canvas"].clone());
    for selection in
        document.get_mut("selections").and_then(Value::as_array_mut).into_iter().flatten()
    {
        let alone = json!({ "format": "rilievo", "canvas": canvas, "selections": [selection] });
        let Err(error) = reading.read_value(&alone) else { continue };
        reading.note_loss(format!("a selection is lost: {error}"));
        if let Value::Object(fields) = selection {
            fields.shift_remove("mask");
        }
        left_out = true;
    }
    left_out
}

/// A document without layers in which each of them can be read alone: its canvas and its
/// selections, and parts of the same ids that hold nothing.
pub fn without_layers(document: &Value) -> Value {
    let mut out = json!({ "format": "rilievo", "version": document["version"], "layers": [] });
    for field in ["canvas", "selections"] {
        if let Some(value) = document.get(field) {
            out[field] = value.clone();
        }
    }
    let part = |part: &Value| Some(json!({ "id": part.get("id")?, "kind": "sweep", "balls": [] }));
    let parts: Vec<Value> =
        document["surface"]["parts"].as_array().into_iter().flatten().filter_map(part).collect();
    if !parts.is_empty() {
        out["surface"] = json!({ "parts": parts });
    }
    out
}

/// A document of one layer alone, with the selections that its strokes name.
pub fn isolate(around: &Value, layer: &Value) -> Value {
    let strokes = || layer["strokes"].as_array().into_iter().flatten();
    let is_named =
        |selection: &&Value| strokes().any(|stroke| stroke.get("selection") == selection.get("id"));
    let selections =
        around["selections"].as_array().into_iter().flatten().filter(is_named).cloned().collect();
    let mut out = around.clone();
    out["selections"] = Value::Array(selections);
    out["layers"] = json!([layer]);
    out
}

/// Why a single layer cannot be read. A group is tested without its layers.
fn trouble(reading: &ProjectReader, around: &Value, layer: &Value) -> Option<crate::Error> {
    let mut layer = layer.clone();
    if layer["kind"] == "group"
        && let Value::Object(fields) = &mut layer
    {
        fields.shift_remove("layers");
    }
    reading.read_value(&isolate(around, &layer)).err()
}

/// Replaces a layer by its picture, or by an empty one; its blending stays.
fn as_picture(layer: &Value, shown: Option<&ManifestPicture>) -> Value {
    let mut out = Map::new();
    for field in
        ["name", "kind", "visible", "opacity", "blend", "blend_space", "clip_below", "lock"]
    {
        if let Some(value) = layer.get(field) {
            out.insert(field.into(), value.clone());
        }
    }
    out.insert("kind".into(), "pixels".into());
    // The picture is cut to the surface already.
    out.insert("clip_to_surface".into(), false.into());
    if let Some(shown) = shown {
        out.insert("file".into(), shown.name.as_str().into());
        out.insert("x".into(), shown.x.into());
        out.insert("y".into(), shown.y.into());
    }
    Value::Object(out)
}

/// The layer at a path such as `layers[2].layers[0]`.
pub fn layer_mut<'a>(document: &'a mut Value, path: &str) -> Option<&'a mut Value> {
    path.split('.').try_fold(document, |value, part| {
        let index: usize = part.strip_prefix("layers[")?.strip_suffix(']')?.parse().ok()?;
        value.get_mut("layers")?.get_mut(index)
    })
}

fn list_layers(layers: &Value, prefix: &str, out: &mut Vec<String>) {
    for (i, layer) in layers.as_array().into_iter().flatten().enumerate() {
        let path = format!("{prefix}layers[{i}]");
        if let Some(inner) = layer.get("layers") {
            list_layers(inner, &format!("{path}."), out);
        }
        out.push(path);
    }
}

pub fn name_of(layer: &Value) -> String {
    layer["name"].as_str().unwrap_or_default().to_owned()
}
