//! Reads and writes layer masks: a picture of coverage, or one derived from the surface.
//! Floor 5.

use super::LayerReader;
use super::selections::{region, write_region};
use crate::Result;
use crate::document::{LayerMask, MaskKind};
use crate::json::{Fields, JsonNode, JsonObject};
use crate::math::Range;
use crate::shading::FeatureScale;
use crate::surface::region::RegionKind;
use serde_json::Value;

#[derive(Clone, Copy)]
enum DerivedMaskKind {
    Fresnel,
    Curvature,
    Depth,
    Region(RegionKind),
}

const DERIVED: [(DerivedMaskKind, &str); 7] = [
    (DerivedMaskKind::Fresnel, "fresnel"),
    (DerivedMaskKind::Curvature, "curvature"),
    (DerivedMaskKind::Depth, "depth"),
    (DerivedMaskKind::Region(RegionKind::Direction), "direction"),
    (DerivedMaskKind::Region(RegionKind::Object), "object"),
    (DerivedMaskKind::Region(RegionKind::Shine), "shine"),
    (DerivedMaskKind::Region(RegionKind::Flow), "flow"),
];

impl LayerReader<'_> {
    pub fn mask(&mut self, node: &JsonNode) -> Result<LayerMask> {
        let mut fields = node.fields()?;
        let (invert, disabled) = (fields.boolean("invert", false)?, fields.boolean("disabled", false)?);
        let kind = match fields.get("kind") {
            // What has a point is a region about it.
            Some(kind) => match (kind.one_of(&DERIVED)?, fields.get("at").is_some()) {
                (DerivedMaskKind::Curvature, true) => {
                    derived(DerivedMaskKind::Region(RegionKind::Curvature), &mut fields)?
                }
                (DerivedMaskKind::Depth, true) => derived(DerivedMaskKind::Region(RegionKind::Depth), &mut fields)?,
                (kind, _) => derived(kind, &mut fields)?,
            },
            None => {
                let (file, coverage) =
                    self.pictures.coverage(self.source, &fields.required("file")?, Some(self.size))?;
                MaskKind::File { file, coverage }
            }
        };
        fields.finish()?;
        Ok(LayerMask { kind, invert, disabled })
    }
}

fn derived(kind: DerivedMaskKind, fields: &mut Fields) -> Result<MaskKind> {
    Ok(match kind {
        DerivedMaskKind::Fresnel => MaskKind::Fresnel {
            f0: fields.number("f0", 0.04, LayerMask::F0)?,
            power: fields.number("power", 5.0, LayerMask::POWER)?,
        },
        DerivedMaskKind::Curvature => {
            let (scale, blur) = (
                fields.number("scale", 4.0, FeatureScale::CURVATURE_PX)?,
                fields.number("blur", 0.0, FeatureScale::BLUR_PX)?,
            );
            let (from, to) = ramp(fields, LayerMask::KAPPA)?;
            MaskKind::Curvature { scale, blur, from, to }
        }
        DerivedMaskKind::Region(kind) => MaskKind::Region(region(kind, fields)?),
        DerivedMaskKind::Depth => {
            let (from, to) = ramp(fields, LayerMask::DEPTH)?;
            MaskKind::Depth { from, to }
        }
    })
}

/// Where the mask is 0 and where it is 1, either way round; a step where the two are the same.
fn ramp(fields: &mut Fields, range: Range) -> Result<(f32, f32)> {
    let (from, to) = (*range.start(), *range.end());
    Ok((fields.number("from", from, range.clone())?, fields.number("to", to, range)?))
}

pub fn write(mask: &LayerMask) -> Value {
    let mut out = JsonObject::default();
    match &mask.kind {
        MaskKind::File { file, .. } => out.set("file", file.as_str().into()),
        MaskKind::Region(region) => write_region(&mut out, region),
        MaskKind::Fresnel { f0, power } => {
            out.set("kind", "fresnel".into());
            out.number("f0", *f0, 0.04);
            out.number("power", *power, 5.0);
        }
        MaskKind::Curvature { scale, blur, from, to } => {
            out.set("kind", "curvature".into());
            out.number("scale", *scale, 4.0);
            out.number("blur", *blur, 0.0);
            out.number("from", *from, -1.0);
            out.number("to", *to, 1.0);
        }
        MaskKind::Depth { from, to } => {
            out.set("kind", "depth".into());
            out.number("from", *from, 0.0);
            out.number("to", *to, 1.0);
        }
    }
    out.flag("invert", mask.invert, false);
    out.flag("disabled", mask.disabled, false);
    out.done()
}
