//! Imports normal, depth and mask maps of any convention into the program's own: camera space, y up; depth 0 near … 1
//! far; coverage. Floor 5. The rest of the program knows no other convention. What is not given is detected, with a
//! confidence.

mod background;
mod channel;
mod depth;
pub mod detail;
mod encoding;
mod evidence;
pub mod findings;
mod layers;
mod normals;
mod orientation;
pub mod pairs;
mod samples;
mod steps;
mod stored;
mod world;

pub use findings::{ChoiceOrigin, Finding, Findings};
pub use layers::fitting;
pub use stored::MapRole;

use super::files::CachedFiles;
use super::{Budget, Files, picture};
use crate::document::source::{DepthConvention, DepthEncoding, MapSource, MaskSource, NormalConvention, SurfaceSource};
use crate::math::{Size, Vec3, srgb};
use crate::memory;
use crate::raster::{Asset, Plane};
use crate::surface::view::Eye;
use crate::surface::{Maps, Surface, differentiate, integrate};
use crate::{Error, Result};
use std::collections::BTreeMap;
use stored::StoredMap;

/// A surface and how its maps were interpreted.
pub struct ImportedSurface {
    pub surface: Surface,
    pub findings: Findings,
    /// The files that were read, by their names in the source: a project keeps their bytes.
    pub files: BTreeMap<String, Asset>,
}

/// What deriving depth takes at its peak, the surface included: the solver holds some ten planes.
const DERIVED_DEPTH_BYTES_PER_PX: u64 = 100;

/// Reads a document's maps.
///
/// Fails with a sentence where a file is missing, damaged or too large, where the maps' sizes differ, and where there
/// is no surface at all. Where one of normals and depth is missing it is derived from the other, with a note.
pub fn import(source: &SurfaceSource, files: &dyn Files, budget: &Budget) -> Result<ImportedSurface> {
    let read = memory::caught(|| read(source, files, budget));
    read.map_err(|refused| Error::out_of_memory(files.path(""), refused))?
}

fn read(source: &SurfaceSource, files: &dyn Files, budget: &Budget) -> Result<ImportedSurface> {
    let files = &CachedFiles::new(files);
    let mut findings = Findings::default();
    let normal = source.normal.as_ref().map(|m| load(m, MapRole::Normals, files, budget)).transpose()?;
    let depth = source.depth.as_ref().map(|m| load(m, MapRole::Depth, files, budget)).transpose()?;
    let maps: Vec<&StoredMap> = normal.iter().chain(&depth).collect();
    if let (Some(normal), None) = (&normal, &depth) {
        let what = format!("the depth of {} pixels, derived from their normals,", normal.size);
        budget.room(&normal.file, &what, normal.size.area() as u64 * DERIVED_DEPTH_BYTES_PER_PX)?;
    }
    let Some(first) = maps.first() else {
        return Err(Error::invalid(files.path(""), "surface", "it names neither normals nor depth"));
    };
    let file = first.file.clone();
    for (map, warning) in maps.iter().filter_map(|m| Some((m, m.warning?))) {
        findings.note(format!("{}: {warning}", map.file.display()));
    }
    let mask = given_mask(source, normal.as_ref(), files, budget, &mut findings)?;
    let of = |m: &StoredMap| (m.file.display().to_string(), m.size);
    let sizes = maps.iter().copied().map(of).chain(mask.iter().map(|(name, m)| (name.clone(), m.size())));
    same_size(&file, sizes)?;
    let overrides = ConventionOverrides::of(source);
    let coverage = mask.map(|(_, m)| m).or_else(|| alpha(&maps, &overrides, &mut findings));
    let understood = understand(normal.as_ref(), depth.as_ref(), coverage, &overrides, &mut findings)?;
    // What is left to do takes the most memory; what the files store is not asked any more.
    drop((normal, depth));
    let eye = Eye::of_fov(understood.fov_degrees, understood.inside.size());
    let surface = Surface::new(complete(understood, &overrides, &mut findings)).map_err(|e| Error::decode(file, e))?;
    let surface = surface.seen_by(eye);
    Ok(ImportedSurface { surface, findings, files: files.assets() })
}

/// The conventions that the document gives; what they leave open is detected.
struct ConventionOverrides {
    normal: NormalConvention,
    depth: DepthConvention,
}

impl ConventionOverrides {
    fn of(source: &SurfaceSource) -> Self {
        Self {
            normal: source.normal.as_ref().map(|m| m.convention.clone()).unwrap_or_default(),
            depth: source.depth.as_ref().map(|m| m.convention.clone()).unwrap_or_default(),
        }
    }
}

fn load<C>(map: &MapSource<C>, role: MapRole, files: &dyn Files, budget: &Budget) -> Result<StoredMap> {
    let bytes = files.read(&map.file, budget)?;
    stored::load(&files.path(&map.file), &bytes, map.channel.as_deref(), role, budget)
}

fn same_size(file: &std::path::Path, sizes: impl Iterator<Item = (String, Size)>) -> Result<()> {
    let sizes: Vec<(String, Size)> = sizes.collect();
    let Some(((name, size), rest)) = sizes.split_first() else { return Ok(()) };
    match rest.iter().find(|(_, s)| s != size) {
        None => Ok(()),
        Some((other, s)) => Err(Error::invalid(
            file,
            "surface",
            format!("the maps differ in size: {name} has {size} pixels, {other} has {s}"),
        )),
    }
}

/// The mask that the document names, and its name for messages.
fn given_mask(
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
fn alpha(maps: &[&StoredMap], overrides: &ConventionOverrides, findings: &mut Findings) -> Option<Plane<u8>> {
    use crate::document::source::NormalEncoding::Dxt5nm;
    if overrides.normal.encoding == Some(Dxt5nm) {
        return None;
    }
    let alpha = maps.iter().find_map(|m| m.alpha.as_ref().filter(|_| !encoding::holds_x_in_alpha(m)))?;
    findings.found("mask", "alpha", 0.95);
    Some(alpha.map(srgb::quantise))
}

/// Maps in the program's convention, one of which may be missing.
struct Understood {
    /// Unit; zero where there are none.
    normals: Option<Plane<Vec3>>,
    /// Grows away from the viewer, in any unit.
    planar: Option<Plane<f32>>,
    /// Pixels of the surface with numbers of their own.
    inside: Plane<bool>,
    coverage: Plane<u8>,
    /// Something tells the coverage beside the numbers.
    is_masked: bool,
    fov_degrees: Option<f32>,
}

/// Converts loaded maps to the program's convention.
fn understand(
    normal: Option<&StoredMap>,
    depth: Option<&StoredMap>,
    given_coverage: Option<Plane<u8>>,
    overrides: &ConventionOverrides,
    findings: &mut Findings,
) -> Result<Understood> {
    let raw_depth = depth.map(|d| depth::read(d, &overrides.depth, given_coverage.as_ref(), findings)).transpose()?;
    let bare = |i: usize| raw_depth.as_ref().is_some_and(|d| d.values.values()[i].is_nan());
    let raw_normals =
        normal.map(|n| normals::read(n, &overrides.normal, given_coverage.as_ref(), bare, findings)).transpose()?;
    let size = normal.or(depth).map_or(Size::new(1, 1), |m| m.size);
    let w = size.width as usize;
    let explicit = given_coverage.is_some();
    let mut coverage = given_coverage.unwrap_or_else(|| {
        let by_normals = raw_normals.as_ref().map(|r| &r.coverage);
        Plane::from_fn(size, |x, y| if bare(y * w + x) { 0 } else { by_normals.map_or(255, |c| c.at(x, y)) })
    });
    if !explicit {
        report_mask(normal, raw_depth.as_ref(), &coverage, findings);
    }
    let masked = explicit.then_some(&coverage);
    let edge_n = normal.and_then(|m| Some((m, background::constant(m, masked)?)));
    let edge_d = depth.and_then(|m| Some((m, background::constant(m, masked)?)));
    // A partly covered rim pixel with the background's value has no value of its own.
    let borrowed = |edge: Option<(&StoredMap, [f32; 4])>, i: usize| {
        let partly = explicit && coverage.values()[i] < 255;
        partly && edge.is_some_and(|(m, e)| background::same(m.texel(i), e, m.lossy))
    };
    let inside = Plane::from_fn(size, |x, y| {
        let i = y * w + x;
        let zero = raw_normals.as_ref().is_some_and(|r| background::is_degenerate(r.vectors.values()[i]));
        coverage.values()[i] > 0 && !bare(i) && !zero && !borrowed(edge_n, i) && !borrowed(edge_d, i)
    });
    // A constant border does not help to detect conventions, and its edge may be the silhouette.
    let fills = |i: usize| !explicit && edge_n.is_some_and(|(m, e)| background::same(m.texel(i), e, m.lossy));
    let judged = Plane::from_fn(size, |x, y| inside.at(x, y) && !fills(y * w + x));
    let enough = judged.values().iter().filter(|j| **j).count() >= 16;
    let judged = if enough { &judged } else { &inside };
    let (mut unit, planar) = join(normal, depth, raw_normals, raw_depth, judged, overrides, findings);
    let turned_away =
        (0..size.area()).find(|&i| fills(i)).zip(unit.as_ref()).is_some_and(|(i, n)| n.values()[i].z < -0.5);
    if turned_away && enough {
        findings.note("the border's normals point away from the viewer, unlike the rest: they are background");
        (0..size.area()).filter(|&i| fills(i)).for_each(|i| coverage.values_mut()[i] = 0);
    }
    if let (Some(normals), Some(step)) = (&mut unit, normal.and_then(|n| n.step))
        && overrides.normal.snap_flat.unwrap_or(step > 0.001)
    {
        steps::snap_flat(normals);
    }
    let inside = inside.updated(|x, y, is| is && coverage.at(x, y) > 0);
    let normals = unit.map(|n| n.updated(|x, y, n| if inside.at(x, y) { n } else { Vec3::ZERO }));
    let fov_degrees = overrides.depth.fov_degrees.or(depth.and_then(|s| s.fov_degrees));
    Ok(Understood { normals, planar, inside, coverage, is_masked: explicit, fov_degrees })
}

/// Settles axes and polarity together; unit normals and planar depth that grows away from the viewer.
fn join(
    normal: Option<&StoredMap>,
    depth: Option<&StoredMap>,
    raw_normals: Option<normals::RawNormals>,
    raw_depth: Option<depth::RawDepth>,
    inside: &Plane<bool>,
    overrides: &ConventionOverrides,
    findings: &mut Findings,
) -> (Option<Plane<Vec3>>, Option<Plane<f32>>) {
    let near_override = raw_depth.as_ref().and_then(|d| depth::near_override(&overrides.depth, d));
    let leaning = raw_depth.as_ref().map_or(0.0, |d| d.near_high_leaning);
    let near = orientation::FixedAxes { near_high: near_override, near_high_leaning: leaning, ..Default::default() };
    let values = raw_depth.map(|d| match (overrides.depth.smooth_steps, depth.and_then(|s| s.step)) {
        (Some(true), Some(step)) => steps::smooth(&d.values, step, inside),
        _ => d.values,
    });
    let oriented = normal
        .zip(raw_normals)
        .map(|(stored, raw)| normals::orient(raw, stored, &overrides.normal, inside, values.as_ref(), &near, findings));
    let Some((stored, values)) = depth.zip(values) else { return (oriented.map(|o| o.0), None) };
    let near_high = match &oriented {
        Some((_, near_high)) => *near_high,
        None => depth_alone(near_override, leaning, findings),
    };
    let unit = oriented.map(|o| o.0);
    let encoding = depth_encoding(stored, &values, unit.as_ref(), inside, near_high, overrides, findings);
    let planar = depth::planar(stored, values, &overrides.depth, near_high, encoding);
    let near = if near_high { crate::document::source::Near::High } else { crate::document::source::Near::Low };
    findings.depth = Some(DepthConvention { near, encoding: Some(encoding), ..overrides.depth.clone() });
    (unit, Some(planar))
}

/// The polarity of depth without normals: the background is far.
fn depth_alone(overrides: Option<bool>, leaning: f32, findings: &mut Findings) -> bool {
    let name = |high: bool| if high { "high" } else { "low" };
    match overrides {
        Some(high) => findings.found("depth.near", name(high), 0.95),
        None if leaning != 0.0 => findings.found("depth.near", name(leaning > 0.0), 0.7),
        None => findings.assumed("depth.near", "low", 0.3),
    }
    overrides.unwrap_or(leaning > 0.0)
}

fn depth_encoding(
    stored: &StoredMap,
    values: &Plane<f32>,
    unit: Option<&Plane<Vec3>>,
    inside: &Plane<bool>,
    near_high: bool,
    overrides: &ConventionOverrides,
    findings: &mut Findings,
) -> DepthEncoding {
    if let Some(encoding) = overrides.depth.encoding {
        findings.given("depth.encoding", encoding.name());
        if encoding == DepthEncoding::RayDistance && overrides.depth.fov_degrees.or(stored.fov_degrees).is_none() {
            findings.note("depth is measured along the ray; without the field of view (“fov”) it is used as it is");
        }
        return encoding;
    }
    let layer = stored.layer.to_lowercase();
    if layer.contains("distance") && overrides.depth.fov_degrees.or(stored.fov_degrees).is_some() {
        findings.found("depth.encoding", "ray-distance", 0.7);
        return DepthEncoding::RayDistance;
    }
    let inverse = near_high && unit.is_some_and(|n| depth::looks_inverse(values, n, inside));
    let encoding = if inverse { DepthEncoding::Inverse } else { DepthEncoding::Planar };
    findings.found("depth.encoding", encoding.name(), if unit.is_some() { 0.8 } else { 0.5 });
    encoding
}

/// Normalises depth and derives the map that is missing.
fn complete(understood: Understood, overrides: &ConventionOverrides, findings: &mut Findings) -> Maps {
    let Understood { normals, planar, inside, mut coverage, is_masked, fov_degrees } = understood;
    let size = inside.size();
    let nothing = || Plane::filled(size, f32::NAN);
    let normalised = planar.and_then(|p| depth::normalise(p, &inside, &coverage, findings));
    findings.depth_range = normalised.as_ref().map(|n| (n.near, n.far));
    let (normals, depth) = match (normals, normalised) {
        (Some(normals), Some(n)) => (normals, n.depth),
        (Some(normals), None) => {
            findings.note("depth was made from the normals; a true depth map is better at occluding contours");
            let depth = integrate::depth_from_normals(&normals, &inside).map(|i| i.depth);
            (normals, depth.unwrap_or_else(nothing))
        }
        (None, Some(n)) => {
            let range_px = overrides.depth.range_px.unwrap_or_else(|| depth_range_px(&n, &inside, fov_degrees));
            findings.note(format!("normals were made from depth, taken to be {range_px:.0} pixels deep (“range_px”)"));
            (differentiate::normals_from_depth(&n.depth, range_px), n.depth)
        }
        (None, None) => (Plane::filled(size, Vec3::ZERO), nothing()),
    };
    if is_masked {
        drop_unknown(&mut coverage, &normals, findings);
    }
    Maps { normals, depth, coverage }
}

/// The depth of a surface in pixels: from the camera if depth is metric and the field of view known, else half the
/// longer side of the surface, as for a ball.
fn depth_range_px(depth: &depth::NormalizedDepth, inside: &Plane<bool>, fov_degrees: Option<f32>) -> f32 {
    if let Some(fov) = fov_degrees.filter(|_| depth.near > 0.0) {
        let middle = 0.5 * (depth.near + depth.far);
        let width = 2.0 * middle * (fov.to_radians() * 0.5).tan();
        return (depth.far - depth.near) / width * inside.width() as f32;
    }
    let held = |line: &dyn Fn(usize) -> bool, n: usize| {
        let first = (0..n).find(|&k| line(k));
        let last = (0..n).rev().find(|&k| line(k));
        first.zip(last).map_or(1, |(a, b)| b - a + 1)
    };
    let wide = held(&|x| (0..inside.height()).any(|y| inside.at(x, y)), inside.width());
    let tall = held(&|y| inside.row(y).iter().any(|&i| i), inside.height());
    wide.max(tall) as f32 * 0.5
}

/// Notes where the mask came from, and a border that looks like background but does not count as such.
fn report_mask(
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
fn drop_unknown(coverage: &mut Plane<u8>, normals: &Plane<Vec3>, findings: &mut Findings) {
    let holes = coverage.values().iter().zip(normals.values()).filter(|(c, n)| **c == 255 && **n == Vec3::ZERO).count();
    if holes > 0 {
        findings.note(format!("{holes} covered pixels have no usable normal or depth; they count as holes"));
    }
}
