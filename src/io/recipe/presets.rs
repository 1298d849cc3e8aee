//! Presets: brushes with a name, a group and a sentence. Those in `brushes/` are built into the
//! program. Floor 5. The file has the fields of a stroke, and what a list shows.

use super::brush::{settings, write_brush};
use super::images::{operator, write_operator};
use super::pictures::PictureCache;
use super::{RecipeSource, tips};
use crate::Result;
use crate::json::{self, JsonNode, JsonObject, object};
use crate::math::{named::current_name, srgb::Color};
use crate::paint::{Adjust, Brush, PictureSource};
use crate::surface::Operator;
use crate::{Budget, Files, RecipeFolder, files};
use rilievo_brushes::BRUSHES;
use serde_json::Value;
use std::path::Path;

/// A brush that can be chosen by name.
#[derive(Clone)]
pub struct BrushPreset {
    /// Its key in recipes: lower-case letters and hyphens.
    pub key: String,
    /// Its name in the window.
    pub name: String,
    /// Where it is in the list.
    pub group: PresetGroup,
    /// One sentence.
    pub about: String,
    /// The color it is shown in; choosing it changes no color.
    pub color: Color,
    /// The brush itself.
    pub brush: Brush,
    /// The operator that it is meant for.
    pub operator: Operator,
}

rilievo_engine::named! {
    /// The group of a preset in the list.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default)]
    pub enum PresetGroup {
        Drawing = "Drawing",
        Inking = "Inking",
        Painting = "Painting",
        WetAndDry = "Wet and dry",
        Light = "Light",
        Surface = "Surface",
        Retouch = "Retouch",
        /// The user's own.
        #[default]
        Imported = "Your own",
    }
}

/// The default color of a preset: a warm white.
const SHOWN: Color = Color { r: 0xf4, g: 0xee, b: 0xe0, a: 255 };

/// The keys of the brushes that come with the program.
pub fn preset_names() -> impl Iterator<Item = &'static str> {
    BRUSHES.iter().map(|(key, _)| *key)
}

/// Every brush that comes with the program, in the order of the list.
pub fn presets() -> impl Iterator<Item = BrushPreset> {
    preset_names().filter_map(preset)
}

/// A brush that comes with the program, as a hand takes it: its marks stay near the pen. A recipe
/// that names it says so itself ([`Brush::reach`]), so that older ones paint as they did.
pub fn preset(key: &str) -> Option<BrushPreset> {
    let key = current_name(key);
    let (_, text) = BRUSHES.iter().find(|(known, _)| *known == key)?;
    let mut preset = parse_built_in(key, text).ok()?;
    preset.brush.reach = Brush::NEAR;
    Some(preset)
}

/// A brush that comes with the program, and the operator it is meant for.
pub fn preset_brush(key: &str) -> Option<(Brush, Operator)> {
    preset(key).map(|preset| (preset.brush, preset.operator))
}

/// The preset that a field names, perhaps as version 0.1 did.
pub(super) fn read_preset_name(key: &JsonNode) -> Result<(Brush, Operator)> {
    let wanted = key.text()?;
    let Some((_, text)) = BRUSHES.iter().find(|(known, _)| *known == current_name(wanted)) else {
        let names: Vec<_> = preset_names().collect();
        return Err(key.refusal(format!("is “{wanted}”; the presets are {}", names.join(", "))));
    };
    let preset = parse_built_in(wanted, text).map_err(|e| key.name_in_error(e))?;
    Ok((preset.brush, preset.operator))
}

fn parse_built_in(key: &str, text: &str) -> Result<BrushPreset> {
    let mut none =
        |node: &JsonNode| Err(node.refusal("is a file; the brushes of the program have none"));
    read(Path::new("brushes"), key, text.as_bytes(), &Budget::default(), &mut none)
}

/// A brush as [`brush_to_json`] writes it, with the pictures of `like`, because a value can only
/// name them.
///
/// Fails with a sentence that names the field.
pub fn read_brush(value: &Value, like: &Brush) -> Result<Brush> {
    let mut fields = JsonNode::root(Path::new("brush"), value).fields()?;
    let mut brush = settings(&mut fields, Brush::default())?;
    let mut picture = |node: &JsonNode| {
        let named = node.text()?;
        let found = like.pictures().find(|source| source.file == named).cloned();
        found.ok_or_else(|| {
            node.refusal(format!("is “{named}”; the current brush has no such picture"))
        })
    };
    tips::read(&mut fields, &mut brush, &mut picture)?;
    fields.finish()?;
    Ok(brush)
}

/// Everything that differs from the plain brush, pictures by name.
pub fn brush_to_json(brush: &Brush) -> Value {
    write_brush(brush).into_value()
}

/// A preset in a file of its own; its pictures are next to it.
pub fn load_preset(file: &Path, budget: &Budget) -> Result<BrushPreset> {
    let text = files::read_file(file, budget.json_bytes)?;
    let folder = RecipeFolder::folder_of(file);
    let source = RecipeSource { file, files: &folder as &dyn Files, budget, onto: None };
    let mut pictures = PictureCache::default();
    let mut picture = |node: &JsonNode| pictures.source(source, node, Adjust::default());
    let key = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    read(file, &key, &text, budget, &mut picture)
}

/// `{ "name", "group", "about", "color", "brush": { … }, "operator": { … } }`.
fn read(
    file: &Path,
    key: &str,
    text: &[u8],
    budget: &Budget,
    picture: &mut dyn FnMut(&JsonNode) -> Result<PictureSource>,
) -> Result<BrushPreset> {
    let value = json::parse(file, text, budget)?;
    let mut root = JsonNode::root(file, &value).fields()?;
    let mut text =
        |name| root.get(name).map_or(Ok(String::new()), |node| node.text().map(str::to_owned));
    let (name, about) = (text("name")?, text("about")?);
    let name = if name.is_empty() { key.to_owned() } else { name };
    let group = root.one_of("group", &PresetGroup::ALL, PresetGroup::Imported)?;
    let color = root.color("color", SHOWN)?;
    let operator = operator(&mut root)?.unwrap_or_default();
    let mut fields = root.require("brush")?.fields()?;
    let mut brush = settings(&mut fields, Brush::default())?;
    tips::read(&mut fields, &mut brush, picture)?;
    fields.finish()?;
    root.finish()?;
    Ok(BrushPreset { key: key.to_owned(), name, group, about, color, brush, operator })
}

/// A preset as [`load_preset`] reads it back. Its pictures are named, not written.
pub fn write_preset(preset: &BrushPreset) -> Value {
    let mut out = JsonObject::default();
    out.set("name", preset.name.as_str().into());
    out.word("group", &PresetGroup::ALL, preset.group, PresetGroup::Imported);
    out.text("about", &preset.about, "");
    if preset.color != SHOWN {
        out.set("color", object::color(preset.color));
    }
    out.set("brush", write_brush(&preset.brush).into_value());
    out.object("operator", write_operator(preset.operator));
    out.into_value()
}

#[cfg(test)]
mod sizes;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_reads_and_has_a_name_a_group_and_a_sentence() {
        for (key, text) in BRUSHES {
            let preset = parse_built_in(key, text).unwrap_or_else(|e| panic!("{key}: {e}"));
            assert!(!preset.name.is_empty() && preset.group != PresetGroup::Imported, "{key}");
            assert!(preset.about.ends_with('.') && preset.about.len() > 20, "{key}");
            assert_eq!(*key, crate::brush::plain(key));
            assert_eq!(
                parse_built_in(key, &write_preset(&preset).to_string()).map(|p| p.name).ok(),
                Some(preset.name)
            );
        }
        let mut groups: Vec<PresetGroup> = presets().map(|preset| preset.group).collect();
        assert!(groups.is_sorted(), "a group's presets stand together");
        groups.dedup();
        assert_eq!(groups.len(), PresetGroup::ALL.len() - 1);
    }

    #[test]
    fn there_are_thirty_presets_and_more_and_no_two_share_a_name() {
        let mut names: Vec<String> = presets().map(|preset| preset.name).collect();
        assert!(names.len() >= 30);
        names.sort();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
