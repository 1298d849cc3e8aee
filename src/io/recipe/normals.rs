//! Reads and writes normal layers: detail from a map, or grain.
//! Floor 5. Reading a map's numbers is `io::maps::detail`'s work.

use super::LayerReader;
use super::images::{write_placement, write_source};
use super::surface::{normal_convention, write_normal_convention};
use super::value::RecipeValue;
use crate::Result;
use crate::document::{DetailSource, NormalLayer, source::NormalConvention};
use crate::json::{Fields, JsonNode, JsonObject};
use crate::math::Size;
use crate::raster::Outside;
use crate::surface::NoiseRelief;
use serde_json::Value;

impl LayerReader<'_> {
    pub fn normals(&mut self, fields: &mut Fields) -> Result<NormalLayer> {
        let source = fields.require("source")?;
        let convention = fields.get("convention").map(|c| normal_convention(&c)).transpose()?;
        let mut inner = source.fields()?;
        let source = match inner.get("noise") {
            Some(noise) => {
                inner.finish()?;
                DetailSource::Grain(NoiseRelief::from_json(&noise)?)
            }
            None => self.detail_map(&source, convention.unwrap_or_default())?,
        };
        Ok(NormalLayer {
            frame: Default::default(),
            source,
            placement: self.placement(fields)?,
            outside: fields.one_of("outside", &Outside::ALL, Outside::Repeat)?,
            strength: fields.number("strength", 1.0, NormalLayer::STRENGTH)?,
        })
    }

    fn detail_map(
        &mut self,
        node: &JsonNode,
        convention: NormalConvention,
    ) -> Result<DetailSource> {
        let picture = self.picture_source(node)?;
        let file = node.fields()?.require("file")?;
        let map = self.pictures.detail(self.source, &file, &convention, picture.adjust.blur)?;
        Ok(DetailSource::Map { picture, convention, map })
    }
}

impl RecipeValue for NoiseRelief {
    fn to_json(&self) -> Value {
        let base = NoiseRelief::default();
        let mut out = JsonObject::default();
        out.number("size", self.size_px, base.size_px);
        out.number("octaves", self.octaves as f32, base.octaves as f32);
        out.number("roughness", self.roughness, base.roughness);
        out.number("stretch", self.stretch, base.stretch);
        if self.seed != base.seed {
            out.set("seed", self.seed.into());
        }
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let (mut fields, base) = (node.fields()?, NoiseRelief::default());
        let grain = NoiseRelief {
            size_px: fields.number("size", base.size_px, NoiseRelief::SIZE_PX)?,
            octaves: fields
                .get("octaves")
                .map_or(Ok(base.octaves), |node| node.whole(NoiseRelief::OCTAVES))?,
            roughness: fields.number("roughness", base.roughness, NoiseRelief::ROUGHNESS)?,
            stretch: fields.number("stretch", base.stretch, NoiseRelief::STRETCH)?,
            seed: fields.get("seed").map_or(Ok(0), |node| node.whole(0..=u32::MAX))?,
        };
        fields.finish()?;
        Ok(grain)
    }
}

pub fn write(out: &mut JsonObject, normals: &NormalLayer, canvas: Size) {
    match &normals.source {
        DetailSource::Map { picture, convention, .. } => {
            out.set("source", write_source(picture));
            write_normal_convention(out, convention);
        }
        DetailSource::Grain(grain) => {
            let mut source = JsonObject::default();
            source.set("noise", grain.to_json());
            out.set("source", source.into_value());
        }
    }
    out.object("placement", write_placement(&normals.placement, canvas));
    out.word("outside", &Outside::ALL, normals.outside, Outside::Repeat);
    out.number("strength", normals.strength, 1.0);
}
