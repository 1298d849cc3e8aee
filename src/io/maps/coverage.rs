//! Which pixels are surface: by the given mask, the alpha of the files, or the numbers. Floor 5.

use super::background::FilledEdge;
use super::encoding;
use super::findings::Findings;
use super::layers::MapRole;
use super::overrides::ConventionOverrides;
use super::stored::{self, StoredMap};
use crate::document::source::{MaskSource, SurfaceSource};
use crate::math::{Vec3, srgb};
use crate::raster::{Plane, border};
use crate::{Budget, Error, Files, Result, picture};

/// The mask that the document names, and its name for messages; `maps` are its normals and its
/// depth.
pub fn given_mask(
    source: &SurfaceSource,
    maps: [Option<&StoredMap>; 2],
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
                    let stored =
                        stored::load(&path, &bytes, channel.as_deref(), MapRole::Mask, budget)?;
                    stored.channels[0].map(srgb::quantize)
                }
            };
            findings.add_given("mask", "file");
            let plane = if *invert { plane.map(|c| 255 - c) } else { plane };
            Ok(Some((path.display().to_string(), plane)))
        }
        Some(MaskSource::Flat) => {
            let [Some(normal), depth] = maps else {
                return Err(Error::invalid(
                    files.path(""),
                    "surface.mask.from",
                    "“flat” needs a normal map",
                ));
            };
            findings.add_given("mask", "flat");
            Ok(Some((normal.file.display().to_string(), not_flat(normal, depth))))
        }
    }
}

/// The share of a flat border that has one depth if that depth stands for “nothing”. The rest may
/// be a wall or a plate.
const SHARE_OF_ONE_DEPTH: f32 = 0.5;

/// 0 where the border's value continues inward from the border, 255 elsewhere.
///
/// If the border has one depth as well, only pixels of that depth are background; and all of them
/// that have its normal are, also within a ring or a handle.
fn not_flat(normal: &StoredMap, depth: Option<&StoredMap>) -> Plane<u8> {
    let holds_edge = |map: &StoredMap| FilledEdge::of(map, None).map(|edge| edge.holds);
    let Some(flat) = holds_edge(normal) else { return Plane::full(normal.size, 255) };
    let outside = border::connected_to_border(normal.size, |i| flat.values()[i]);
    let far = depth.filter(|depth| depth.size == normal.size).and_then(holds_edge);
    let count = |is: &dyn Fn(usize) -> bool| {
        (0..normal.size.area()).filter(|&i| outside.values()[i] && is(i)).count()
    };
    let background = match far {
        Some(far)
            if count(&|i| far.values()[i]) as f32
                > SHARE_OF_ONE_DEPTH * count(&|_| true) as f32 =>
        {
            flat.updated(|x, y, flat| flat && far.at(x, y))
        }
        _ => outside,
    };
    background.map(|b| if b { 0 } else { 255 })
}

/// The files' own coverage.
pub fn alpha(
    maps: &[&StoredMap],
    overrides: &ConventionOverrides,
    findings: &mut Findings,
) -> Option<Plane<u8>> {
    use crate::document::source::NormalEncoding::Dxt5nm;
    if overrides.normal.encoding == Some(Dxt5nm) {
        return None;
    }
    let alpha =
        maps.iter().find_map(|m| m.alpha.as_ref().filter(|_| !encoding::has_x_in_alpha(m)))?;
    findings.add_detected("mask", "alpha", 0.95);
    Some(alpha.map(srgb::quantize))
}

/// Notes where the mask came from, and a border that looks like background but does not count as
/// such.
pub fn report_mask(
    [normal, depth]: [Option<&StoredMap>; 2],
    is_found_in_depth: bool,
    coverage: &Plane<u8>,
    findings: &mut Findings,
) {
    let bare = coverage.values().iter().filter(|c| **c == 0).count();
    let how = match (is_found_in_depth, bare) {
        (_, 0) => "none",
        (true, _) => "depth",
        _ => "normals",
    };
    findings.add_detected("mask", how, if bare > 0 { 0.9 } else { 0.5 });
    let Some(normal) = normal.filter(|_| bare == 0) else { return };
    let flat = not_flat(normal, depth).values().iter().filter(|c| **c == 0).count();
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

/// Notes holes: covered pixels without normals of their own that the surface will leave out or
/// borrow.
pub fn drop_unknown(coverage: &mut Plane<u8>, normals: &Plane<Vec3>, findings: &mut Findings) {
    let holes = coverage
        .values()
        .iter()
        .zip(normals.values())
        .filter(|(c, n)| **c == 255 && **n == Vec3::ZERO)
        .count();
    if holes > 0 {
        findings.note(format!(
            "{holes} covered pixels have no usable normal or depth; they count as holes"
        ));
    }
}
