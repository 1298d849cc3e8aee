//! The maps of an object among the user's files: by their contents and their names. Floor 6. Not
//! here: pairs of names (`io::maps::pairs`).

use super::FileUse;
use super::endings::{PICTURES, has_extension};
use crate::Result;
use crate::document::Progress;
use crate::document::source::{MapSource, MaskSource, SurfaceSource};
use crate::io::maps::pairs::{self, MapPart};
use crate::io::platform::files;
use crate::io::{Budget, UserFiles, files::read_file, inspect, maps, picture};
use crate::raster::Picture;
use std::path::{Path, PathBuf};

/// The normals of a file, and its depth if it holds both.
pub(super) fn with_own_depth(file: &Path) -> SurfaceSource {
    maps_of(Some(file), Some(file).filter(|file| has_depth(file)))
}

/// A surface made of these files, with every convention detected.
pub fn maps_of(normal: Option<&Path>, depth: Option<&Path>) -> SurfaceSource {
    let name = |file: &Path| file.to_string_lossy().into_owned();
    SurfaceSource {
        normal: normal.map(|file| MapSource { file: name(file), ..MapSource::default() }),
        depth: depth.map(|file| MapSource { file: name(file), ..MapSource::default() }),
        ..SurfaceSource::default()
    }
}

/// Reads a surface from the user's own files.
pub fn import(source: &SurfaceSource) -> Result<maps::ImportedSurface> {
    maps::import(source, &UserFiles::default(), &Budget::of_this_machine())
}

/// The same, with progress; `None` if canceled.
pub fn import_watched(
    source: &SurfaceSource,
    progress: &Progress,
) -> Result<Option<maps::ImportedSurface>> {
    maps::import_watched(source, &UserFiles::default(), &Budget::of_this_machine(), progress)
}

/// Whether an EXR of normals holds depth too, as renderers write them.
fn has_depth(file: &Path) -> bool {
    let budget = Budget::of_this_machine();
    has_extension(file, &["exr"])
        && read_file(file, budget.file_bytes)
            .and_then(|bytes| inspect::describe(file, &bytes, &budget))
            .is_ok_and(|found| !found.depths.is_empty())
}

/// The finished picture in the file of the normals, if a renderer put it there, and the name of its
/// layer.
pub fn finished_picture(source: &SurfaceSource) -> Option<(String, Picture)> {
    let map = source.normal.as_ref()?;
    let (file, budget) = (Path::new(&map.file), Budget::of_this_machine());
    let bytes = read_file(file, budget.file_bytes).ok()?;
    let normals = inspect::describe(file, &bytes, &budget).ok()?.normals;
    let normals = map.channel.as_ref().or(normals.first()).map_or("", String::as_str);
    let (name, picture) = picture::read_finished_picture(file, &bytes, normals, &budget).ok()??;
    let name =
        name.rsplit('.').next().filter(|name| !name.is_empty()).unwrap_or("Picture").to_owned();
    Some((name, picture))
}

/// The maps that belong to a file by their names, or are in the same EXR: `pot_n.png` brings
/// `pot_depth.exr` and `pot_mask.png` from its folder.
pub fn maps_beside(file: &Path, kind: FileUse) -> SurfaceSource {
    let part = pairs::part_of(file);
    let mut source =
        if kind == FileUse::Depth { maps_of(None, Some(file)) } else { with_own_depth(file) };
    let Some((name, _)) = part else { return source };
    let beside = file
        .parent()
        .and_then(|folder| files::read_dir(folder).ok())
        .into_iter()
        .flatten()
        .flatten();
    let mut others: Vec<PathBuf> = beside
        .map(|entry| entry.path())
        .filter(|other| other != file && has_extension(other, &PICTURES))
        .collect();
    others.sort_unstable();
    for other in others {
        let text = other.to_string_lossy().into_owned();
        match pairs::part_of(&other).filter(|(other, _)| *other == name) {
            Some((_, MapPart::Normal)) if source.normal.is_none() => {
                source.normal = Some(MapSource { file: text, ..MapSource::default() });
            }
            Some((_, MapPart::Depth)) if source.depth.is_none() => {
                source.depth = Some(MapSource { file: text, ..MapSource::default() });
            }
            Some((_, MapPart::Mask)) if source.mask.is_none() => {
                source.mask = Some(MaskSource::File { file: text, channel: None, invert: false });
            }
            _ => {}
        }
    }
    source
}

/// Files that were opened together, sorted: the maps of each object, and the files that are opened
/// separately, in order.
#[derive(Debug, Default, PartialEq)]
pub struct SortedFiles {
    /// Maps, those of one object together.
    pub objects: Vec<SurfaceSource>,
    /// All other files.
    pub others: Vec<(PathBuf, FileUse)>,
}

/// Sorts files of known kinds. A normal map, a depth map and a mask that are opened together belong
/// to one object, whatever their names; a second normal map begins another object. Missing maps are
/// looked for next to each file (see [`maps_beside`]).
pub fn sort_files(files: Vec<(PathBuf, FileUse)>) -> SortedFiles {
    let mut sorted = SortedFiles::default();
    let text = |file: &Path| file.to_string_lossy().into_owned();
    let map = |file: &Path| Some(MapSource { file: text(file), ..MapSource::default() });
    let (maps, others): (Vec<_>, Vec<_>) =
        files.into_iter().partition(|(_, kind)| matches!(kind, FileUse::Normals | FileUse::Depth));
    // Normals first: depth joins them.
    let (normals, depths): (Vec<_>, Vec<_>) =
        maps.into_iter().partition(|(_, kind)| *kind == FileUse::Normals);
    sorted.objects.extend(normals.iter().map(|(file, _)| maps_beside(file, FileUse::Normals)));
    for (file, _) in depths {
        let is_taken = |source: &SurfaceSource| {
            source.depth.as_ref().is_some_and(|map| map.file == text(&file))
        };
        if sorted.objects.iter().any(is_taken) {
            continue;
        }
        match sorted.objects.iter_mut().find(|source| source.depth.is_none()) {
            Some(source) => source.depth = map(&file),
            None => sorted.objects.push(maps_beside(&file, FileUse::Depth)),
        }
    }
    for (file, kind) in others {
        let is_mask = pairs::part_of(&file).is_some_and(|(_, part)| part == MapPart::Mask);
        match sorted.objects.iter_mut().find(|_| is_mask && kind == FileUse::Picture) {
            Some(source) => {
                source.mask =
                    Some(MaskSource::File { file: text(&file), channel: None, invert: false })
            }
            None => sorted.others.push((file, kind)),
        }
    }
    sorted
}

/// The user's own files that a surface is made of.
pub fn map_files(source: &SurfaceSource) -> Vec<PathBuf> {
    let mask = source.mask.as_ref().and_then(|mask| match mask {
        MaskSource::File { file, .. } => Some(file),
        _ => None,
    });
    let maps = [
        source.normal.as_ref().map(|map| &map.file),
        source.depth.as_ref().map(|map| &map.file),
        mask,
    ];
    maps.into_iter().flatten().map(PathBuf::from).collect()
}
