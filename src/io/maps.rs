//! Imports normal, depth and mask maps of any convention into the program's own: camera space, y
//! up; depth 0 near … 1 far; coverage. Floor 5. The rest of the program knows no other convention.
//! What is not given is detected, with a confidence.

mod axes;
mod background;
mod channel;
mod coverage;
mod depth;
pub mod detail;
mod encoding;
mod evidence;
pub mod findings;
mod layers;
mod normals;
mod orientation;
mod overrides;
pub mod pairs;
mod samples;
mod steps;
mod stored;
mod understood;
mod world;

pub use findings::{ChoiceOrigin, Finding, Findings};
pub use layers::{MapRole, fitting};

use super::files::CachedFiles;
use super::{Budget, Files};
use crate::document::Progress;
use crate::document::source::{MapSource, SurfaceSource};
use crate::math::Size;
use crate::memory;
use crate::raster::Asset;
use crate::surface::Surface;
use crate::surface::view::Eye;
use crate::{Error, Result};
use coverage::{alpha, given_mask};
use overrides::ConventionOverrides;
use std::collections::BTreeMap;
use std::path::PathBuf;
use stored::StoredMap;
use understood::LoadedMaps;

/// A surface and how its maps were interpreted.
pub struct ImportedSurface {
    /// The maps in the one convention.
    pub surface: Surface,
    /// What was detected on the way.
    pub findings: Findings,
    /// The files that were read, by their names in the source: a project keeps their bytes.
    pub files: BTreeMap<String, Asset>,
}

/// Peak memory of deriving depth, the surface included: the solver holds some ten planes.
const DERIVED_DEPTH_BYTES_PER_PX: u64 = 100;

/// Reads a document's maps.
///
/// Fails with a sentence where a file is missing, damaged or too large, where the maps' sizes
/// differ, and where there is no surface at all. Where one of normals and depth is missing it is
/// derived from the other, with a note.
pub fn import(
    source: &SurfaceSource,
    files: &dyn Files,
    budget: &Budget,
) -> Result<ImportedSurface> {
    let whole = import_watched(source, files, budget, &Progress::default())?;
    Ok(whole.expect("nobody cancels it"))
}

/// The same with somebody watching; `None` if canceled.
pub fn import_watched(
    source: &SurfaceSource,
    files: &dyn Files,
    budget: &Budget,
    progress: &Progress,
) -> Result<Option<ImportedSurface>> {
    progress.add_total(STEPS);
    let read = memory::catch_out_of_memory(|| read(source, files, budget, progress));
    read.map_err(|refused| Error::out_of_memory(files.path(""), refused))?
}

/// The steps that reading reports: the files, the meaning of their numbers, what is missing, the
/// surface.
const STEPS: u64 = 4;

fn read(
    source: &SurfaceSource,
    files: &dyn Files,
    budget: &Budget,
    progress: &Progress,
) -> Result<Option<ImportedSurface>> {
    let is_over = || {
        progress.step();
        progress.is_canceled()
    };
    let files = &CachedFiles::new(files);
    let mut findings = Findings::default();
    let [normal, depth] = [
        source
            .normal
            .as_ref()
            .map(|map| MapFile::read(map, MapRole::Normals, files, budget))
            .transpose()?,
        source
            .depth
            .as_ref()
            .map(|map| MapFile::read(map, MapRole::Depth, files, budget))
            .transpose()?,
    ];
    let decoded = |file: Option<MapFile>| file.map(|file| file.decode(budget)).transpose();
    let (normal, depth) = rayon::join(|| decoded(normal), || decoded(depth));
    let (normal, depth) = (normal?, depth?);
    if is_over() {
        return Ok(None);
    }
    let maps: Vec<&StoredMap> = normal.iter().chain(&depth).collect();
    if let (Some(normal), None) = (&normal, &depth) {
        let what = format!("the depth of {} pixels, derived from their normals,", normal.size);
        budget.room(&normal.file, &what, normal.size.area() as u64 * DERIVED_DEPTH_BYTES_PER_PX)?;
    }
    let Some(first) = maps.first() else {
        return Err(Error::invalid(
            files.path(""),
            "surface",
            "it names neither normals nor depth",
        ));
    };
    let file = first.file.clone();
    for (map, warning) in maps.iter().filter_map(|m| Some((m, m.warning?))) {
        findings.note(format!("{}: {warning}", map.file.display()));
    }
    let mask = given_mask(source, [normal.as_ref(), depth.as_ref()], files, budget, &mut findings)?;
    let of = |m: &StoredMap| (m.file.display().to_string(), m.size);
    let sizes =
        maps.iter().copied().map(of).chain(mask.iter().map(|(name, m)| (name.clone(), m.size())));
    same_size(&file, sizes)?;
    let overrides = ConventionOverrides::of(source);
    let coverage = mask.map(|(_, m)| m).or_else(|| alpha(&maps, &overrides, &mut findings));
    let loaded = LoadedMaps {
        normal: normal.as_ref(),
        depth: depth.as_ref(),
        overrides: &overrides,
        findings: &mut findings,
    };
    let understood = loaded.interpret(coverage)?;
    // The remaining work takes the most memory, and the stored maps are no longer needed.
    drop((normal, depth));
    if is_over() {
        return Ok(None);
    }
    let eye = Eye::of_fov(understood.fov_degrees, understood.inside.size());
    let maps = understood.complete(&overrides, &mut findings, progress);
    if is_over() {
        return Ok(None);
    }
    let surface = Surface::new(maps).map_err(|e| Error::decode(file, e))?.with_eye(eye);
    progress.step();
    Ok(Some(ImportedSurface { surface, findings, files: files.assets() }))
}

/// The file of a map, before it is decoded.
struct MapFile<'s> {
    file: PathBuf,
    bytes: Vec<u8>,
    channel: Option<&'s str>,
    role: MapRole,
}

impl<'s> MapFile<'s> {
    fn read<C>(
        map: &'s MapSource<C>,
        role: MapRole,
        files: &dyn Files,
        budget: &Budget,
    ) -> Result<Self> {
        let bytes = files.read(&map.file, budget)?;
        Ok(Self { file: files.path(&map.file), bytes, channel: map.channel.as_deref(), role })
    }

    fn decode(self, budget: &Budget) -> Result<StoredMap> {
        stored::load(&self.file, &self.bytes, self.channel, self.role, budget)
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::refusal;
    use image::{ImageFormat, Rgb, RgbImage};
    use std::io::Cursor;

    /// One flat map by every name; whoever reads the first cancels.
    struct GivenUp<'p>(&'p Progress);

    impl Files for GivenUp<'_> {
        fn read(&self, name: &str, _: &Budget) -> Result<Vec<u8>> {
            assert_eq!(refusal(name), None);
            self.0.cancel();
            let mut bytes = Cursor::new(Vec::new());
            let flat = RgbImage::from_pixel(16, 16, Rgb([128, 128, 255]));
            flat.write_to(&mut bytes, ImageFormat::Png).expect("memory holds it");
            Ok(bytes.into_inner())
        }

        fn path(&self, name: &str) -> PathBuf {
            name.into()
        }
    }

    #[test]
    fn what_is_canceled_is_not_read_to_its_end() {
        let map = |file: &str| MapSource { file: file.into(), ..MapSource::default() };
        let source = SurfaceSource { normal: Some(map("n.png")), ..SurfaceSource::default() };
        let progress = Progress::default();
        let read = import_watched(&source, &GivenUp(&progress), &Budget::default(), &progress);
        assert!(matches!(read, Ok(None)), "it went on");
        assert_eq!(progress.read(), (1, STEPS));
        let watched = Progress::default();
        let read =
            import_watched(&source, &GivenUp(&Progress::default()), &Budget::default(), &watched);
        assert!(matches!(read, Ok(Some(_))));
        assert_eq!(watched.read(), (STEPS, STEPS));
    }
}
