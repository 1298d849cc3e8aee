//! Materials that come with the program: groups of live layers that make a part of the shape leather,
//! glass or gold. Floor 5. A material in `brushes/materials` has a name, a sentence and its layers,
//! at the lengths of a canvas of `looks::SIDE` px. Shading layers without lights are lit by the
//! lamps of the document; those that are `opposite` by one across from its first.

use super::looks::{live_layers, parse_file};
use super::value::RecipeValue;
use super::{RecipeSource, read_value};
use crate::document::parts::forms::visible_place;
use crate::document::{Content, DerivedMask, Document, Group, Layer, LayerId, LayerMask};
use crate::math::srgb::Color;
use crate::math::{Size, vec3};
use crate::shading::{Light, LightKind, Model, Shading};
use crate::surface::region::{RegionKind, SurfaceRegion};
use crate::{Budget, Error, Result, UserFiles};
use rilievo_brushes::MATERIALS;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A material that can be chosen by name.
#[derive(Clone, Debug, PartialEq)]
pub struct PartMaterial {
    /// Its key on the command line and in replays: lower-case letters and hyphens.
    pub key: &'static str,
    /// Its name in the window, and that of its group.
    pub name: String,
    /// One sentence.
    pub about: String,
}

impl PartMaterial {
    /// All of them, in the order of the list.
    pub fn all() -> impl Iterator<Item = PartMaterial> {
        MATERIALS.iter().filter_map(|(key, text)| {
            let file = parse_file(&path(key), text).ok()?;
            let word = |field: &str| file.get(field).and_then(Value::as_str).unwrap_or(key);
            Some(PartMaterial { key, name: word("name").into(), about: word("about").into() })
        })
    }

    /// The material of a key.
    pub fn of_key(key: &str) -> Option<PartMaterial> {
        Self::all().find(|material| material.key == key)
    }

    /// Their keys, in the order of the list.
    pub fn keys() -> impl Iterator<Item = &'static str> {
        MATERIALS.iter().map(|(key, _)| *key)
    }

    /// A document with a part of this material, and the layer that makes it so: a group on top of
    /// all but ink, in the place of a material that the part has already. Without a part it covers
    /// what is selected, or the whole surface.
    pub fn on(&self, document: &Document, part: Option<&str>) -> Result<(Document, LayerId)> {
        let lights = lights_of(document);
        let mut layer =
            Layer::new(self.name.clone(), self.group(scale_grain(document, part), &lights)?);
        layer.mask = match part {
            Some(part) => Some(self.mask_of(document, part)?),
            None => document.selection_as_mask(),
        };
        let mut next = document.clone();
        let is_replaced = |old: &Arc<Layer>| is_material(old, part) && has_same_extent(old, &layer);
        let place = match next.layers.iter().position(is_replaced) {
            Some(place) => {
                next.layers.remove(place);
                place
            }
            None => next.layers_below_top_ink(),
        };
        let id = layer.id;
        next.layers.insert(place, Arc::new(layer));
        let next = match part {
            Some(part) => next.with_layer_on(id, Some(part)).unwrap_or(next),
            None => next,
        };
        Ok((next, id))
    }

    /// A ball of a color, to be shown in materials.
    pub fn ball(color: Color) -> Result<Document> {
        const SIDE: f32 = 256.0;
        let middle = [0.5 * SIDE, 0.5 * SIDE];
        let recipe = json!({ "format": "rilievo", "version": super::VERSION,
            "canvas": { "width": SIDE, "height": SIDE },
            "surface": { "parts": [{ "id": "ball", "name": "Ball", "kind": "primitive",
                "shape": "sphere", "center": middle, "radius": 0.46 * SIDE }] },
            "layers": [{ "kind": "fill", "color": color.to_string() },
                { "kind": "shading", "model": "painter", "painter": { "beneath": true } }] });
        let source = RecipeSource {
            file: Path::new("ball"),
            files: &UserFiles::default(),
            budget: &Budget::default(),
            onto: None,
        };
        read_value(&recipe, source)
    }

    /// Its layers, at the lengths of a canvas.
    fn group(&self, canvas: Size, lights: &[Light]) -> Result<Content> {
        let text = MATERIALS.iter().find(|(key, _)| *key == self.key).map_or("", |found| found.1);
        let mut file = parse_file(&path(self.key), text)?;
        let mut layers = file.get_mut("layers").map(Value::take).unwrap_or_default();
        light(&mut layers, lights);
        let layers = live_layers(&path(self.key), layers, canvas)?;
        Ok(Content::Group(Group { layers, pass_through: true }))
    }

    /// The mask of what is seen of a part.
    fn mask_of(&self, document: &Document, part: &str) -> Result<LayerMask> {
        let at = visible_place(document, part)
            .ok_or_else(|| Error::unsupported_file(part, "no part of this name is seen"))?;
        let region =
            SurfaceRegion { contiguous: false, ..SurfaceRegion::new(RegionKind::Object, at) };
        Ok(LayerMask::new(DerivedMask::Region(region)))
    }
}

/// The canvas whose lengths a material takes on a part: grain is finer on small parts, by the root
/// of their size, so that it is not coarse on them and yet is seen.
fn scale_grain(document: &Document, part: Option<&str>) -> Size {
    /// The side of a part with the lengths of the whole canvas, as a share of the canvas.
    const WHOLE: f32 = 0.92;
    /// The least share of the lengths.
    const LEAST: f32 = 0.2;
    let size = document.size;
    let areas = document.part_areas();
    let Some((_, area)) = areas.iter().find(|(known, _)| Some(known.id.as_str()) == part) else {
        return size;
    };
    let (low, high) = area.covered_box();
    let sides = (high - low).max(crate::math::Vec2::ONE);
    let share = (sides.x * sides.y).sqrt() / (WHOLE * size.longer_side().max(1.0));
    size.scaled(share.sqrt().max(LEAST).min(1.0))
}

/// Whether a layer is a material of a part: the user may have changed its layers, not its name.
fn is_material(layer: &Layer, part: Option<&str>) -> bool {
    matches!(layer.content, Content::Group(_))
        && layer.on.as_ref().map(|attachment| &*attachment.part) == part
        && PartMaterial::all().any(|material| material.name == layer.name)
}

/// Whether two groups cover the same: one part, or what a mask shows.
fn has_same_extent(old: &Layer, new: &Layer) -> bool {
    old.on.is_some() || old.mask.is_none() && new.mask.is_none()
}

/// The lamps that light a document: those of the first painter's light, or of another layer.
fn lights_of(document: &Document) -> Vec<Light> {
    let lit = |layer: &Layer| match &layer.content {
        Content::Shading(live) if layer.visible && live.params().model.has_lamps() => {
            Some(live.params().clone()).filter(|shading| !shading.lights.is_empty())
        }
        _ => None,
    };
    let found: Vec<Shading> = document.walk().iter().filter_map(|(_, layer)| lit(layer)).collect();
    let painter = found.iter().find(|shading| shading.model == Model::Painter);
    let chosen = painter.or(found.first()).map(|shading| shading.lights.clone());
    chosen.unwrap_or_else(|| Shading::new(Model::Painter).lights)
}

/// A lamp across from another: as high, on the other side.
fn opposite(light: &Light) -> Light {
    let direction = match light.kind {
        LightKind::Directional { direction } => direction,
        LightKind::Point { .. } => vec3(-0.5, 0.6, 0.6),
    };
    let direction = vec3(-direction.x, -direction.y, direction.z);
    Light { kind: LightKind::Directional { direction }, ..Light::default() }
}

/// Gives shading layers their lights.
fn light(value: &mut Value, lights: &[Light]) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| light(item, lights)),
        Value::Object(fields) => {
            let is_opposite = fields.remove("opposite").is_some();
            fields.values_mut().for_each(|field| light(field, lights));
            let is_shading = fields.get("kind").is_some_and(|kind| kind == "shading");
            let has_lamps = fields.get("model").is_some_and(|model| model == "phong");
            if is_shading && has_lamps && !fields.contains_key("lights") {
                let across: Vec<Light> = lights.first().map(opposite).into_iter().collect();
                let given = if is_opposite { &across[..] } else { lights };
                let given = given.iter().map(RecipeValue::to_json).collect();
                fields.insert("lights".into(), given);
            }
        }
        _ => {}
    }
}

fn path(key: &str) -> PathBuf {
    format!("brushes/materials/{key}.json").into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::parts::Part;
    use crate::document::{Progress, flatten};

    #[test]
    fn every_material_opens_changes_the_ball_and_is_saved_as_it_is() {
        let ball = PartMaterial::ball(Color::rgb(180, 120, 90)).unwrap();
        let before = flatten(&ball, &Progress::default()).unwrap();
        for material in PartMaterial::all() {
            let (given, layer) = material.on(&ball, Some("ball")).unwrap();
            assert_eq!(given.layer(layer).unwrap().name, material.name);
            let after = flatten(&given, &Progress::default()).unwrap();
            let rect = given.size.rect();
            let (now, then) = (after.to_straight_rgba(rect), before.to_straight_rgba(rect));
            let changed = now.chunks(4).zip(then.chunks(4)).filter(|(a, b)| a != b).count();
            assert!(changed > 3000, "{}: {changed}", material.key);
            let written = crate::recipe::write(&given);
            let source = RecipeSource {
                file: Path::new("given.json"),
                files: &super::super::looks::BuiltInFiles,
                budget: &Budget::default(),
                onto: None,
            };
            let read = read_value(&written, source).unwrap();
            assert_eq!(crate::recipe::write(&read), written, "{}", material.key);
        }
    }

    #[test]
    fn grain_is_finer_on_a_small_part() {
        let ball = PartMaterial::ball(Color::rgb(180, 120, 90)).unwrap();
        let whole = scale_grain(&ball, Some("ball"));
        assert_eq!(whole, scale_grain(&ball, None));
        let part = (*ball.parts.list[0]).clone();
        let matrix = crate::math::Affine2::from_scale(crate::math::Vec2::splat(0.25));
        let small = Part { matrix: matrix * part.matrix, ..part };
        let small = ball.with_parts(vec![Arc::new(small)]);
        let side = scale_grain(&small, Some("ball")).longer_side();
        assert!((side / whole.longer_side() - 0.5).abs() < 0.02, "{side}");
    }

    #[test]
    fn another_material_of_a_part_takes_the_place_of_the_one_before() {
        let ball = PartMaterial::ball(Color::rgb(180, 120, 90)).unwrap();
        let [gold, wood] = ["gold", "wood"].map(|key| PartMaterial::of_key(key).unwrap());
        let (once, _) = gold.on(&ball, Some("ball")).unwrap();
        let (twice, layer) = wood.on(&once, Some("ball")).unwrap();
        assert_eq!((once.layers.len(), twice.layers.len()), (3, 3));
        assert_eq!(twice.layers[2].id, layer);
        assert!(gold.on(&ball, Some("nose")).is_err());
    }
}
