//! Reads and writes normal layers: detail from a map, or grain.
//! Floor 5. Reading a map's numbers is `io::maps::detail`'s work.

use super::LayerReader;
use super::images::{write_placement, write_source};
use super::names::OUTSIDES;
use super::surface::{normal_convention, write_normal_convention};
use crate::Result;
use crate::document::{DetailSource, NormalLayer, source::NormalConvention};
use crate::json::{Fields, JsonNode, JsonObject};
use crate::math::Size;
use crate::raster::Outside;
use crate::surface::NoiseRelief;

impl LayerReader<'_> {
    pub fn normals(&mut self, fields: &mut Fields) -> Result<NormalLayer> {
        let source = fields.required("source")?;
        let convention = fields.get("convention").map(|c| normal_convention(&c)).transpose()?;
        let mut inner = source.fields()?;
        let source = match inner.get("noise") {
            Some(noise) => {
                inner.finish()?;
                DetailSource::Grain(grain(&noise)?)
            }
            None => self.detail_map(&source, convention.unwrap_or_default())?,
        };
        Ok(NormalLayer {
            frame: Default::default(),
            source,
            placement: self.placement(fields)?,
            outside: fields.one_of("outside", &OUTSIDES, Outside::Repeat)?,
            strength: fields.number("strength", 1.0, NormalLayer::STRENGTH)?,
        })
    }
    fn detail_map(&mut self, node: &JsonNode, convention: NormalConvention) -> Result<DetailSource> {
        let picture = self.picture_source(node)?;
        let file = node.fields()?.required("file")?;
        let map = self.pictures.detail(self.source, &file, &convention, picture.adjust.blur)?;
        Ok(DetailSource::Map { picture, convention, map })
    }
}

fn grain(node: &JsonNode) -> Result<NoiseRelief> {
    let (mut fields, base) = (node.fields()?, NoiseRelief::default());
    let grain = NoiseRelief {
        size_px: fields.number("size", base.size_px, NoiseRelief::SIZE_PX)?,
        octaves: fields.get("octaves").map_or(Ok(base.octaves), |node| node.whole(NoiseRelief::OCTAVES))?,
        roughness: fields.number("roughness", base.roughness, NoiseRelief::ROUGHNESS)?,
        stretch: fields.number("stretch", base.stretch, NoiseRelief::STRETCH)?,
        seed: fields.get("seed").map_or(Ok(0), |node| node.integer(0..=i64::from(u32::MAX)))? as u32,
    };
    fields.finish()?;
    Ok(grain)
}

pub fn write(out: &mut JsonObject, normals: &NormalLayer, canvas: Size) {
    match &normals.source {
        DetailSource::Map { picture, convention, .. } => {
            out.set("source", write_source(picture));
            write_normal_convention(out, convention);
        }
        DetailSource::Grain(grain) => {
            let mut source = JsonObject::default();
            source.set("noise", write_grain(grain).done());
            out.set("source", source.done());
        }
    }
    out.object("placement", write_placement(&normals.placement, canvas));
    out.word("outside", &OUTSIDES, normals.outside, Outside::Repeat);
    out.number("strength", normals.strength, 1.0);
}

fn write_grain(grain: &NoiseRelief) -> JsonObject {
    let base = NoiseRelief::default();
    let mut out = JsonObject::default();
    out.number("size", grain.size_px, base.size_px);
    out.number("octaves", grain.octaves as f32, base.octaves as f32);
    out.number("roughness", grain.roughness, base.roughness);
    out.number("stretch", grain.stretch, base.stretch);
    if grain.seed != base.seed {
        out.set("seed", grain.seed.into());
    }
    out
}
