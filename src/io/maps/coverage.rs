//! Which pixels are surface: by the given mask, the alpha of the files, or the numbers. Floor 5.

use super::findings::Findings;
use super::layers::MapRole;
use super::overrides::ConventionOverrides;
use super::stored::{self, StoredMap};
use super::{background, depth, encoding};
use crate::document::source::{MaskSource, SurfaceSource};
use crate::math::{Vec3, srgb};
use crate::raster::Plane;
use crate::{Budget, Error, Files, Result, picture};

/// The mask that the document names, and its name for messages.
pub fn given_mask(
    source: &SurfaceSource,
    normal: Option<&StoredMap>,
    files: &dyn Files,
    budget: &Budget,
    findings: &mut Findings,
) -> Result<Option<(String, Plane<u8>)>> {
    match &source.mask {
        None => Ok(None),
        Some(MaskSource::File { file, channel, invert }) => {
            let (path, bytes) = (files.path(file), files.read(file, budget)?);
            let plane = match channel {
                None => picture::decode_coverage(&path, &bytes, budget)?,
                Some(_) => {
                    let stored = stored::load(&path, &bytes, channel.as_deref(), MapRole::Mask, budget)?;
                    stored.channels[0].map(srgb::quantise)
                }
            };
            findings.given("mask", "file");
            let plane = if *invert { plane.map(|c| 255 - c) } else { plane };
            Ok(Some((path.display().to_string(), plane)))
        }
        Some(MaskSource::Flat) => {
            let Some(normal) = normal else {
                return Err(Error::invalid(files.path(""), "surface.mask.from", "“flat” needs a normal map"));
            };
            findings.given("mask", "flat");
            Ok(Some((normal.file.display().to_string(), not_flat(normal))))
        }
    }
}

/// 0 where the border's value continues inward from the border, 255 elsewhere.
fn not_flat(normal: &StoredMap) -> Plane<u8> {
    let edge = background::constant(normal, None);
    let flat = background::joined_to_border(normal.size, |i| {
        edge.is_some_and(|e| background::same(normal.texel(i), e, normal.lossy))
    });
    flat.map(|f| if f { 0 } else { 255 })
}

/// The files' own coverage.
pub fn alpha(maps: &[&StoredMap], overrides: &ConventionOverrides, findings: &mut Findings) -> Option<Plane<u8>> {
    use crate::document::source::NormalEncoding::Dxt5nm;
    if overrides.normal.encoding == Some(Dxt5nm) {
        return None;
    }
    let alpha = maps.iter().find_map(|m| m.alpha.as_ref().filter(|_| !encoding::holds_x_in_alpha(m)))?;
    findings.found("mask", "alpha", 0.95);
    Some(alpha.map(srgb::quantise))
}

/// Notes where the mask came from, and a border that looks like background but does not count as such.
pub fn report_mask(
    normal: Option<&StoredMap>,
    depth: Option<&depth::RawDepth>,
    coverage: &Plane<u8>,
    findings: &mut Findings,
) {
    let bare = coverage.values().iter().filter(|c| **c == 0).count();
    let how = match (depth.is_some_and(|d| d.has_background), bare) {
        (_, 0) => "none",
        (true, _) => "depth",
        _ => "normals",
    };
    findings.found("mask", how, if bare > 0 { 0.9 } else { 0.5 });
    let Some(normal) = normal.filter(|_| bare == 0) else { return };
    let flat = not_flat(normal).values().iter().filter(|c| **c == 0).count();
    let share = flat as f32 / coverage.values().len() as f32;
    if share > 0.02 && share < 1.0 {
        findings.flat_border = share;
        findings.note(format!(
            "{:.0} % of the normal map, connected to its border, has one value and looks like background. \
             It is treated as surface; a mask file or \"mask\": {{\"from\": \"flat\"}} would exclude it",
            share * 100.0
        ));
    }
}

/// Notes holes: covered pixels without normals of their own that the surface will leave out or borrow.
pub fn drop_unknown(coverage: &mut Plane<u8>, normals: &Plane<Vec3>, findings: &mut Findings) {
    let holes = coverage.values().iter().zip(normals.values()).filter(|(c, n)| **c == 255 && **n == Vec3::ZERO).count();
    if holes > 0 {
        findings.note(format!("{holes} covered pixels have no usable normal or depth; they count as holes"));
    }
}
