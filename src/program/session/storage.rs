//! Opens and saves documents: projects, recipes, pictures, maps. Floor 6. The formats are in `io`; here a file's format
//! and use are recognised.

use super::OpenDocument;
use super::actions::parts::first;
use super::first_look::FirstLook;
use crate::Result;
use crate::document::parts::drawing::DrawingLook;
use crate::document::source::{MapSource, MaskSource, SurfaceSource};
use crate::document::{Content, Document, Layer, Live, Progress};
use crate::io::export::ExportFormat;
use crate::io::maps::pairs::{self, MapPart};
use crate::io::replace::{FileStamp, Terms};
use crate::io::{self, Budget, UserFiles, files::read_file, inspect, maps, picture};
use crate::math::{Size, Vec2, srgb::Color};
use crate::paint::{Adjust, Gradient, GradientStop, ImageFilter, PictureSource, PlacedImage, Placement};
use crate::raster::{Outside, Picture};
use crate::surface::{Bend, Operator};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Endings of the files that hold documents.
pub const DOCUMENTS: [&str; 4] = ["ora", "psd", "psb", "json"];
/// Endings of the files that documents are saved to, the first being this program's own.
pub const SAVED: [&str; 2] = ["ora", "psd"];
/// Endings of the files that hold pictures.
pub const PICTURES: [&str; 10] = ["png", "jpg", "jpeg", "webp", "tif", "tiff", "bmp", "tga", "hdr", "exr"];

/// What a file can be used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileUse {
    Document,
    /// To paint with.
    Picture,
    /// A map of normals, alone or with depth.
    Normals,
    /// Perhaps a depth map: grey, and named like one.
    Depth,
}

/// A document that was opened, ready to become a tab.
pub struct OpenedTab {
    pub tab: OpenDocument,
    /// Sentences about what was found and what could not be kept.
    pub notes: Vec<String>,
    /// Of a picture: what it looks like as a drawing.
    pub drawing: Option<DrawingLook>,
}

pub fn is_document(file: &Path) -> bool {
    ends_in(file, &DOCUMENTS)
}

/// A document can be saved to a file of this name.
pub fn is_saved_to(file: &Path) -> bool {
    ends_in(file, &SAVED)
}

/// A file of this name holds a document with all that it is, for every program that opens it.
pub fn holds_everything(file: &Path) -> bool {
    !ends_in(file, &SAVED[1..])
}

/// Endings of the files that a picture is exported to, or the whole document for Photoshop.
pub fn exported() -> impl Iterator<Item = &'static str> {
    ExportFormat::ALL.iter().map(|(_, extension)| *extension).chain([SAVED[1]])
}

fn ends_in(file: &Path, extensions: &[&str]) -> bool {
    let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    extensions.contains(&extension.as_str())
}

/// Recognises a dropped or opened file by its extension, its contents and its name.
pub fn kind_of(file: &Path) -> Result<FileUse> {
    if is_document(file) {
        return Ok(FileUse::Document);
    }
    let budget = Budget::of_this_machine();
    let bytes = read_file(file, budget.file_bytes)?;
    let found = inspect::describe(file, &bytes, &budget)?;
    let named = pairs::part_of(file).map(|(_, part)| part);
    Ok(if found.looks_like_normals || !found.normals.is_empty() || (named == Some(MapPart::Normal) && !found.is_grey) {
        FileUse::Normals
    } else if !found.depths.is_empty() || (found.is_grey && named == Some(MapPart::Depth)) {
        FileUse::Depth
    } else {
        FileUse::Picture
    })
}

/// Opens a document, a map, or a picture as a document of its own.
pub fn open(file: &Path) -> Result<OpenedTab> {
    let found = kind_of(file)?;
    match found {
        FileUse::Document | FileUse::Picture => {
            io::save::tidy(file);
            let io::OpenedDocument { document, notes, is_whole, kind, stamp, reads, picture } =
                io::open(file, &Budget::of_this_machine())?;
            Budget::of_this_machine().room(file, "painting it", document.flattening_bytes())?;
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            // A Photoshop file that is taken over with all it has is saved to as well.
            let is_taken_over = kind == io::open::FileKind::Psd && is_whole && notes.is_empty() && is_saved_to(file);
            let is_project = kind == io::open::FileKind::Project || is_taken_over;
            let mut tab = OpenDocument::new(name, document, is_project.then(|| file.into()));
            // A document that is not whole must not overwrite its file without asking.
            tab.stamp = Some(stamp).filter(|_| is_project && is_whole);
            tab.reads = reads;
            tab.first_look = FirstLook::of(file, picture.as_ref(), tab.document().size);
            let drawing = match (found, tab.document().layers.as_slice()) {
                (FileUse::Picture, [layer]) => first::look(tab.document(), layer.id),
                _ => None,
            };
            Ok(OpenedTab { tab, notes, drawing })
        }
        FileUse::Normals => open_maps(&with_own_depth(file)),
        FileUse::Depth => open_maps(&maps_of(None, Some(file))),
    }
}

/// The normals of a file, and its depth where it holds both.
fn with_own_depth(file: &Path) -> SurfaceSource {
    maps_of(Some(file), Some(file).filter(|file| holds_depth(file)))
}

/// A surface made of these files, every convention to be found.
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

/// Whether an EXR of normals holds depth too, as renderers write them.
fn holds_depth(file: &Path) -> bool {
    let budget = Budget::of_this_machine();
    ends_in(file, &["exr"])
        && read_file(file, budget.file_bytes)
            .and_then(|bytes| inspect::describe(file, &bytes, &budget))
            .is_ok_and(|found| !found.depths.is_empty())
}

/// The finished picture in the file of the normals, where a renderer put it there, and the name of its layer.
pub fn finished_picture(source: &SurfaceSource) -> Option<(String, Picture)> {
    let map = source.normal.as_ref()?;
    let (file, budget) = (Path::new(&map.file), Budget::of_this_machine());
    let bytes = read_file(file, budget.file_bytes).ok()?;
    let normals = inspect::describe(file, &bytes, &budget).ok()?.normals;
    let normals = map.channel.as_ref().or(normals.first()).map_or("", String::as_str);
    let (name, picture) = picture::finished(file, &bytes, normals, &budget).ok()??;
    let name = name.rsplit('.').next().filter(|name| !name.is_empty()).unwrap_or("Picture").to_owned();
    Some((name, picture))
}

/// The maps that belong to a file by their names, or stand in the same EXR: `pot_n.png` brings `pot_depth.exr` and
/// `pot_mask.png` from its folder.
pub fn maps_beside(file: &Path, kind: FileUse) -> SurfaceSource {
    let part = pairs::part_of(file);
    let mut source = if kind == FileUse::Depth { maps_of(None, Some(file)) } else { with_own_depth(file) };
    let Some((name, _)) = part else { return source };
    let beside = file.parent().and_then(|folder| std::fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    let mut others: Vec<PathBuf> =
        beside.map(|entry| entry.path()).filter(|other| other != file && ends_in(other, &PICTURES)).collect();
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

/// Files that were opened together, sorted: the maps of each object, and the files that are opened separately, in
/// order.
#[derive(Debug, Default, PartialEq)]
pub struct SortedFiles {
    pub objects: Vec<SurfaceSource>,
    pub others: Vec<(PathBuf, FileUse)>,
}

/// Sorts files of known kinds. A normal map, a depth map and a mask that are opened together belong to one object,
/// whatever their names; a second normal map begins another object. Missing maps are looked for beside each file (see
/// [`maps_beside`]).
pub fn sorted(files: Vec<(PathBuf, FileUse)>) -> SortedFiles {
    let mut sorted = SortedFiles::default();
    let text = |file: &Path| file.to_string_lossy().into_owned();
    let map = |file: &Path| Some(MapSource { file: text(file), ..MapSource::default() });
    let (maps, others): (Vec<_>, Vec<_>) =
        files.into_iter().partition(|(_, kind)| matches!(kind, FileUse::Normals | FileUse::Depth));
    // Normals first: depth joins them.
    let (normals, depths): (Vec<_>, Vec<_>) = maps.into_iter().partition(|(_, kind)| *kind == FileUse::Normals);
    sorted.objects.extend(normals.iter().map(|(file, _)| maps_beside(file, FileUse::Normals)));
    for (file, _) in depths {
        let is_taken = |source: &SurfaceSource| source.depth.as_ref().is_some_and(|map| map.file == text(&file));
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
            Some(source) => source.mask = Some(MaskSource::File { file: text(&file), channel: None, invert: false }),
            None => sorted.others.push((file, kind)),
        }
    }
    sorted
}

/// A new document on a surface, with a plain background to paint on.
pub fn open_maps(source: &SurfaceSource) -> Result<OpenedTab> {
    Ok(of_import(source, import(source)?))
}

/// The same of maps that were read already.
pub fn of_import(source: &SurfaceSource, import: maps::ImportedSurface) -> OpenedTab {
    let maps::ImportedSurface { surface, findings, files } = import;
    let size = surface.size();
    let background = Layer { clip_to_surface: false, ..Layer::new("Background", Content::Fill(BACKGROUND)) };
    let clay = Layer::new("Base", Content::Gradient(Live::new(clay(size))));
    let document = Document {
        surface: Some(Arc::new(surface)),
        surface_source: Some(Arc::new(source.clone())),
        surface_files: Arc::new(files),
        layers: vec![Arc::new(background), Arc::new(clay)],
        ..Document::empty(size)
    };
    let file = source.normal.as_ref().map(|map| &map.file).or(source.depth.as_ref().map(|map| &map.file));
    let name = file.map(|file| pairs::object_of(Path::new(file))).unwrap_or_default();
    let mut tab = OpenDocument::new(name, document, None);
    tab.reads = map_files(source);
    OpenedTab { tab, notes: findings.notes, drawing: None }
}

/// The user's own files that a surface is made of.
pub fn map_files(source: &SurfaceSource) -> Vec<PathBuf> {
    let mask = source.mask.as_ref().and_then(|mask| match mask {
        MaskSource::File { file, .. } => Some(file),
        _ => None,
    });
    let maps = [source.normal.as_ref().map(|map| &map.file), source.depth.as_ref().map(|map| &map.file), mask];
    maps.into_iter().flatten().map(PathBuf::from).collect()
}

/// A picture that covers the canvas, unbent. `file`: what the document calls it.
pub fn flat_image(name: &str, file: &str, picture: Picture, canvas: Size) -> Layer {
    let image = PlacedImage {
        source: PictureSource::new(file.into(), picture, Adjust::default()),
        placement: Placement::covering(canvas),
        outside: Outside::Mirror,
        bend: Bend::default(),
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    };
    Layer::new(name, Content::Image(Live::new(image)))
}

/// A picture that covers the canvas, flat, as a layer at the top: a renderer's, to be painted over.
pub fn with_picture(mut opened: OpenedTab, name: &str, picture: Picture) -> OpenedTab {
    let document = opened.tab.document();
    let mut layers = document.layers.clone();
    layers.push(Arc::new(flat_image(name, &format!("{name}.exr"), picture, document.size)));
    let mut tab = OpenDocument::new(opened.tab.name.clone(), Document { layers, ..document.clone() }, None);
    tab.reads = std::mem::take(&mut opened.tab.reads);
    OpenedTab { tab, ..opened }
}

const BACKGROUND: Color = Color { r: 0x26, g: 0x28, b: 0x2c, a: 255 };

/// The fill of a new surface: a gradient from light to dark, bent by the normals, so that the shape is visible before
/// the first stroke.
fn clay(size: Size) -> Gradient {
    let side = Vec2::new(size.width as f32, size.height as f32);
    let stop = |t: f32, [r, g, b]: [u8; 3]| GradientStop { t, color: Color { r, g, b, a: 255 } };
    Gradient {
        from: side * Vec2::new(0.30, 0.22),
        to: side * Vec2::new(0.66, 0.78),
        stops: vec![stop(0.0, [0xee, 0xe9, 0xe2]), stop(0.55, [0xb4, 0xad, 0xa5]), stop(1.0, [0x6a, 0x65, 0x61])],
        operator: Operator::Normal { alpha: 0.6, beta: 1.0, detail: 0.0 },
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    }
}

/// Saves a document; `None` if it was given up.
pub fn save(
    file: &Path,
    document: &Document,
    terms: impl Into<Terms>,
    progress: &Progress,
) -> Result<Option<FileStamp>> {
    Ok(io::save(document, file, terms, progress)?.map(|saved| saved.stamp))
}

/// The files of a folder that a document could be opened from, for a picker.
pub fn is_openable(file: &Path) -> bool {
    ends_in(file, &DOCUMENTS) || ends_in(file, &PICTURES)
}

/// With an ending of these, else with this one: added, for what stands after a name's last point may be a part of the
/// name.
pub fn with_document_extension(file: PathBuf, extension: &str, extensions: &[&str]) -> PathBuf {
    if ends_in(&file, extensions) { file } else { file.with_added_extension(extension) }
}

/// A name without the ending of a file that can be opened or written; all of it where it has none.
pub fn without_ending(name: &str) -> &str {
    let known = |(stem, extension): &(&str, &str)| {
        let extension = extension.to_lowercase();
        !stem.is_empty() && DOCUMENTS.iter().chain(&PICTURES).any(|known| *known == extension)
    };
    name.rsplit_once('.').filter(known).map_or(name, |(stem, _)| stem)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_are_added_and_never_take_a_part_of_the_name() {
        let named = |name: &str| with_document_extension(name.into(), "ora", &SAVED).to_string_lossy().into_owned();
        for (name, file) in [
            ("robot v1.2", "robot v1.2.ora"),
            ("robot", "robot.ora"),
            ("robot.ora", "robot.ora"),
            ("ROBOT.ORA", "ROBOT.ORA"),
            ("s.psd", "s.psd"),
            ("photo.png", "photo.png.ora"),
            ("a/b.c/robot", "a/b.c/robot.ora"),
            (".hidden", ".hidden.ora"),
        ] {
            assert_eq!(named(name), file);
        }
        let extensions: Vec<&str> = exported().collect();
        let exported =
            |name: &str| with_document_extension(name.into(), "png", &extensions).to_string_lossy().into_owned();
        assert_eq!(exported("final v1.2"), "final v1.2.png");
        assert_eq!((exported("a.jpg"), exported("a.psd")), ("a.jpg".into(), "a.psd".into()));
    }
    #[test]
    fn only_what_is_known_to_be_an_ending_is_taken_from_a_name() {
        for (name, stem) in [
            ("robot v1.2", "robot v1.2"),
            ("robot v1.2.ora", "robot v1.2"),
            ("photo.PNG", "photo"),
            ("Untitled 1", "Untitled 1"),
            (".png", ".png"),
        ] {
            assert_eq!(without_ending(name), stem);
        }
    }
}
