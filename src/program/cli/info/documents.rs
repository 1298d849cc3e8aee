//! What `rilievo info` says about documents: their size, their layers, and differences from the
//! saved state. Floor 7.

use crate::Result;
use crate::cli::with_advice;
use crate::document::Layer;
use crate::io::OpenedDocument;
use serde_json::{Value, json};
use std::sync::Arc;

/// A file that should hold a whole document.
pub struct DocumentReport {
    pub name: String,
    pub opened: Result<OpenedDocument>,
}

impl DocumentReport {
    pub fn json(&self) -> Value {
        let opened = match &self.opened {
            Ok(opened) => opened,
            Err(e) => return json!({ "file": self.name, "error": with_advice(e) }),
        };
        let layer = |(path, layer): (String, &Arc<Layer>)| {
            json!({
                "path": path, "name": layer.name, "kind": layer.content.kind_name(), "visible": layer.visible,
                "opacity": f64::from(layer.opacity), "blend": layer.blend.name(),
            })
        };
        let document = &opened.document;
        json!({
            "file": self.name,
            "kind": opened.kind.name(),
            "width": document.size.width,
            "height": document.size.height,
            "surface": document.surface.is_some(),
            "whole": opened.is_whole,
            "layers": document.walk().into_iter().map(layer).collect::<Vec<_>>(),
            "notes": opened.notes,
        })
    }

    pub fn text(&self) -> String {
        let opened = match &self.opened {
            Ok(opened) => opened,
            Err(e) => return format!("{}\n", with_advice(e)),
        };
        let document = &opened.document;
        let surface = if document.surface.is_some() { ", on a surface" } else { "" };
        let layers = document.walk();
        let count = layers.len();
        let plural = if count == 1 { "" } else { "s" };
        let mut out = format!(
            "{}: {}, {} pixels, {count} layer{plural}{surface}\n",
            self.name,
            opened.kind.name(),
            document.size
        );
        for (path, layer) in layers.into_iter().rev() {
            let depth = path.matches('.').count();
            let hidden = if layer.visible { "" } else { ", hidden" };
            let (blend, percent) = (layer.blend.name(), layer.opacity * 100.0);
            let indent = "  ".repeat(depth + 1);
            out += &format!(
                "{indent}“{}”: {}, {blend}, {percent:.0} %{hidden}\n",
                layer.name,
                layer.content.kind_name()
            );
        }
        opened.notes.iter().for_each(|note| out += &format!("  {note}\n"));
        out
    }
}
