//! Every reader of files on any bytes: what the mutations, the fuzz targets and the replay of their
//! corpus run.

use rilievo::files::open::FileKind;
use rilievo::files::{Files, MapSource, SurfaceSource, maps, picture, recipe};
use rilievo::{Budget, Error, Progress, Result};
use rilievo_io::{inspect, project, psd, recovery};
use std::path::{Path, PathBuf};

/// A reader by its name; it must neither panic nor allocate beyond the budget, and fail with a
/// sentence.
pub type Reader = fn(&Path, &[u8]) -> Result<()>;

/// The readers by the names of their fuzz targets.
pub const ALL: [(&str, Reader); 6] = [
    ("project", project),
    ("psd", psd),
    ("recipe", recipe),
    ("picture", picture),
    ("maps", maps),
    ("recovery", recovery),
];

/// Small limits, so that a damaged header that asks for more is refused at once.
pub fn budget() -> Budget {
    Budget { area_px: 1 << 20, document_px: 1 << 22, side_px: 4096, ..Budget::default() }
}

/// Every requested file is this one.
struct One(Vec<u8>);

impl Files for One {
    fn read(&self, name: &str, budget: &Budget) -> Result<Vec<u8>> {
        match self.0.len() as u64 {
            0 => Err(Error::unsupported_file(name, "there is no such file")),
            n if n > budget.file_bytes => Err(Error::too_large(name, "it is")),
            _ => Ok(self.0.clone()),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        name.into()
    }
}

pub fn project(file: &Path, bytes: &[u8]) -> Result<()> {
    project::read(file, bytes, &budget()).map(drop)
}

pub fn psd(file: &Path, bytes: &[u8]) -> Result<()> {
    psd::read(file, bytes, &budget()).map(drop)
}

pub fn recipe(file: &Path, bytes: &[u8]) -> Result<()> {
    let source =
        recipe::RecipeSource { file, files: &One(Vec::new()), budget: &budget(), onto: None };
    recipe::read(bytes, source).map(drop)
}

pub fn picture(file: &Path, bytes: &[u8]) -> Result<()> {
    // Not every picture is a mask, and not every one gives findings.
    let _ = picture::decode_coverage(file, bytes, &budget());
    let _ = inspect::describe(file, bytes, &budget());
    picture::decode(file, bytes, &budget()).map(drop)
}

pub fn maps(file: &Path, bytes: &[u8]) -> Result<()> {
    let name = file.to_string_lossy().into_owned();
    let files = One(bytes.to_vec());
    let normal = Some(MapSource { file: name.clone(), ..MapSource::default() });
    let depth = Some(MapSource { file: name, ..MapSource::default() });
    let normal = SurfaceSource { normal, ..SurfaceSource::default() };
    let depth = SurfaceSource { depth, ..SurfaceSource::default() };
    let tried = [normal, depth].map(|source| {
        let surface = maps::import(&source, &files, &budget())?.surface;
        let is_finite =
            |plane: &rilievo::raster::Plane<f32>| plane.values().iter().all(|v| v.is_finite());
        assert!(
            is_finite(surface.depth_plane())
                && surface.normal_planes().iter().all(|plane| is_finite(plane))
        );
        Ok(())
    });
    // A file may be the one and not the other.
    let [as_normals, as_depth] = tried;
    as_normals.or(as_depth)
}

pub fn recovery(file: &Path, bytes: &[u8]) -> Result<()> {
    recovery::read(file, bytes, &budget(), &Progress::default()).map(drop)
}

/// With the reader that the program would take.
#[allow(dead_code)]
pub fn any(file: &Path, bytes: &[u8]) -> Result<()> {
    match FileKind::of(bytes) {
        _ if bytes.starts_with(b"RILOG") => recovery(file, bytes),
        FileKind::Project => project(file, bytes),
        FileKind::Psd => psd(file, bytes),
        FileKind::Recipe => recipe(file, bytes),
        FileKind::Picture if file.starts_with("maps") => maps(file, bytes),
        FileKind::Picture => picture(file, bytes),
    }
}
