//! The palette of a document, read and written. Floor 5. Not here: palettes in files of their own
//! (`palette`).

use super::value::RecipeValue;
use crate::Result;
use crate::document::Document;
use crate::json::{JsonNode, JsonObject, object};
use crate::math::srgb::Color;
use crate::paint::color_palette::tidy_name;
use crate::paint::{ColorPalette, NamedColor};
use serde_json::Value;
use std::sync::Arc;

/// `{ "name": …, "columns": …, "colors": ["#rrggbb", { "color": "#rrggbb", "name": … }, …] }`.
pub fn read(node: &JsonNode) -> Result<Arc<ColorPalette>> {
    ColorPalette::from_json(node).map(Arc::new)
}

/// Not written if there is none.
pub fn write(out: &mut JsonObject, document: &Document) {
    if !document.palette.is_blank() {
        out.set("palette", document.palette.to_json());
    }
}

/// Whether the first version has no words for what is there.
pub fn is_needed(document: &Document) -> bool {
    !document.palette.is_blank()
}

impl RecipeValue for ColorPalette {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        out.text("name", &self.name, "");
        if self.columns != 0 {
            out.set("columns", self.columns.into());
        }
        out.set("colors", self.colors.iter().map(write_color).collect());
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let name = read_name(fields.get("name"))?;
        let columns = fields.get("columns");
        let columns = columns.map_or(Ok(0), |node| node.whole(0..=Self::MOST_COLUMNS))?;
        let colors = fields.require("colors")?.list(Self::MOST)?;
        fields.finish()?;
        let colors = colors.iter().map(read_color).collect::<Result<_>>()?;
        Ok(Self { name, columns, colors })
    }
}

fn write_color(named: &NamedColor) -> Value {
    if named.name.is_empty() {
        return object::color(named.color);
    }
    let mut out = JsonObject::default();
    out.set("color", object::color(named.color));
    out.set("name", named.name.as_str().into());
    out.into_value()
}

fn read_color(node: &JsonNode) -> Result<NamedColor> {
    if node.value().is_string() {
        return Ok(NamedColor { color: read_opaque(node)?, name: String::new() });
    }
    let mut fields = node.fields()?;
    let color = read_opaque(&fields.require("color")?)?;
    let name = read_name(fields.get("name"))?;
    fields.finish()?;
    Ok(NamedColor { color, name })
}

fn read_opaque(node: &JsonNode) -> Result<Color> {
    let color = node.color()?;
    match color.a {
        255 => Ok(color),
        _ => Err(node.refusal(format!("is {color}; colors of palettes are opaque"))),
    }
}

/// A name on one line.
fn read_name(node: Option<JsonNode>) -> Result<String> {
    let Some(node) = node else { return Ok(String::new()) };
    let text = node.text()?;
    if tidy_name(text) != text {
        let most = ColorPalette::LONGEST_NAME;
        let reason =
            format!("must be a line of at most {most} characters without spaces around it");
        return Err(node.refusal(reason));
    }
    Ok(text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;
    use crate::recipe;
    use crate::{Budget, RecipeFolder};
    use std::path::Path;

    fn read_back(text: &str) -> Result<Document> {
        let (file, files) = (Path::new("r.json"), RecipeFolder::folder_of(Path::new("r.json")));
        let budget = &Budget::default();
        recipe::read(
            text.as_bytes(),
            recipe::RecipeSource { file, files: &files, budget, onto: None },
        )
    }

    #[test]
    fn a_palette_comes_back_and_a_document_without_one_stays_of_the_first_version() {
        let plain = Document::empty(Size::new(40, 30));
        assert!(recipe::print(&plain).contains(r#""version": 1"#));
        let colors = vec![NamedColor::new(Color::WHITE, "snow “é”"), Color::BLACK.into()];
        for palette in [
            ColorPalette { name: "Winter".into(), columns: 7, colors },
            ColorPalette { name: "Empty".into(), ..Default::default() },
            ColorPalette::basic(),
        ] {
            let document = Document { palette: Arc::new(palette), ..plain.clone() };
            let text = recipe::print(&document);
            assert!(text.contains(r#""version": 2"#), "{text}");
            let read = read_back(&text).unwrap();
            assert_eq!(document.difference(&read), None);
            assert_eq!(plain.difference(&read).as_deref(), Some("the palette"));
        }
    }

    #[test]
    fn what_is_no_palette_is_refused_by_its_path() {
        let with = |what: &str| {
            let text = format!(
                r#"{{"format":"rilievo","version":2,"canvas":{{"width":4,"height":4}},"palette":{what}}}"#
            );
            read_back(&text).err().map(|error| error.to_string()).unwrap_or_default()
        };
        assert!(with("{}").contains("palette.colors"));
        assert!(with(r##"{"colors":["#fff"]}"##).contains("palette.colors[0]"));
        assert!(with(r##"{"colors":["#ffffff80"]}"##).contains("opaque"));
        assert!(
            with(r##"{"colors":[{"color":"#ffffff","name":" a"}]}"##).contains("colors[0].name")
        );
        assert!(with(r#"{"colors":[],"columns":300}"#).contains("palette.columns"));
        assert!(with(r#"{"colors":[],"rows":3}"#).contains("rows"));
    }
}
