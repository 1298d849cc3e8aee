//! Reads and writes layer masks: a picture of coverage, or one derived from the surface.
//! Floor 5.

use super::LayerReader;
use super::selections::{region, write_region};
use super::value::RecipeValue;
use crate::Result;
use crate::document::{DerivedMask, LayerMask, MaskKind};
use crate::json::{Fields, JsonNode, JsonObject};
use crate::math::{Range, Vec2};
use crate::shading::FeatureScale;
use crate::surface::region::{RegionKind, SurfaceRegion};
use serde_json::Value;

/// The kinds, each with what it leaves unsaid. Regions by depth and curvature are known by their
/// point.
const DERIVED: [(DerivedMask, &str); 7] = [
    (DerivedMask::FRESNEL, "fresnel"),
    (DerivedMask::CURVATURE, "curvature"),
    (DerivedMask::RAMP_OF_DEPTH, "depth"),
    (of_region(RegionKind::Direction), "direction"),
    (of_region(RegionKind::Object), "object"),
    (of_region(RegionKind::Shine), "shine"),
    (of_region(RegionKind::Flow), "flow"),
];

const fn of_region(kind: RegionKind) -> DerivedMask {
    DerivedMask::Region(SurfaceRegion::new(kind, Vec2::ZERO))
}

/// Without the fields that every mask has.
impl RecipeValue for DerivedMask {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        write_derived(&mut out, *self);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let mask = read_derived(&mut fields)?.ok_or_else(|| node.refusal("has no “kind”"))?;
        fields.finish()?;
        Ok(mask)
    }
}

impl LayerReader<'_> {
    pub fn mask(&mut self, node: &JsonNode) -> Result<LayerMask> {
        let mut fields = node.fields()?;
        let (invert, disabled) =
            (fields.boolean("invert", false)?, fields.boolean("disabled", false)?);
        let kind = match read_derived(&mut fields)? {
            Some(derived) => derived.into(),
            None => {
                let (file, coverage) = self.pictures.coverage(
                    self.source,
                    &fields.require("file")?,
                    Some(self.size),
                )?;
                MaskKind::File { file, coverage }
            }
        };
        fields.finish()?;
        Ok(LayerMask { kind, invert, disabled })
    }
}

/// The mask that the field `kind` names; none without one.
fn read_derived(fields: &mut Fields) -> Result<Option<DerivedMask>> {
    let Some(kind) = fields.get("kind") else { return Ok(None) };
    let has_point = fields.get("at").is_some();
    Ok(Some(match kind.one_of(&DERIVED)? {
        // An object with a point is the region around it.
        DerivedMask::Curvature { .. } if has_point => {
            DerivedMask::Region(region(RegionKind::Curvature, fields)?)
        }
        DerivedMask::Depth { .. } if has_point => {
            DerivedMask::Region(region(RegionKind::Depth, fields)?)
        }
        DerivedMask::Region(plain) => DerivedMask::Region(region(plain.kind, fields)?),
        DerivedMask::Fresnel { f0, power } => DerivedMask::Fresnel {
            f0: fields.number("f0", f0, DerivedMask::F0)?,
            power: fields.number("power", power, DerivedMask::POWER)?,
        },
        DerivedMask::Curvature { scale, blur, .. } => {
            let scale = fields.number("scale", scale, FeatureScale::CURVATURE_PX)?;
            let blur = fields.number("blur", blur, FeatureScale::BLUR_PX)?;
            let (from, to) = ramp(fields, DerivedMask::KAPPA)?;
            DerivedMask::Curvature { scale, blur, from, to }
        }
        DerivedMask::Depth { .. } => {
            let (from, to) = ramp(fields, DerivedMask::DEPTH)?;
            DerivedMask::Depth { from, to }
        }
    }))
}

/// Where the mask is 0 and where it is 1, in either order; a step if the two are equal.
fn ramp(fields: &mut Fields, range: Range) -> Result<(f32, f32)> {
    let (from, to) = (*range.start(), *range.end());
    Ok((fields.number("from", from, range.clone())?, fields.number("to", to, range)?))
}

pub fn write(mask: &LayerMask) -> Value {
    let mut out = JsonObject::default();
    match &mask.kind {
        MaskKind::File { file, .. } => out.set("file", file.as_str().into()),
        MaskKind::Derived(derived) => write_derived(&mut out, *derived),
    }
    out.flag("invert", mask.invert, false);
    out.flag("disabled", mask.disabled, false);
    out.into_value()
}

fn write_derived(out: &mut JsonObject, mask: DerivedMask) {
    match mask {
        DerivedMask::Region(region) => write_region(out, &region),
        DerivedMask::Fresnel { f0, power } => {
            out.set("kind", "fresnel".into());
            out.number("f0", f0, DerivedMask::PLAIN_F0);
            out.number("power", power, DerivedMask::PLAIN_POWER);
        }
        DerivedMask::Curvature { scale, blur, from, to } => {
            out.set("kind", "curvature".into());
            out.number("scale", scale, DerivedMask::PLAIN_SCALE_PX);
            out.number("blur", blur, 0.0);
            write_ramp(out, from, to, DerivedMask::KAPPA);
        }
        DerivedMask::Depth { from, to } => {
            out.set("kind", "depth".into());
            write_ramp(out, from, to, DerivedMask::DEPTH);
        }
    }
}

fn write_ramp(out: &mut JsonObject, from: f32, to: f32, range: Range) {
    out.number("from", from, *range.start());
    out.number("to", to, *range.end());
}
