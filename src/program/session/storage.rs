//! Opens and saves documents: projects, recipes, pictures, maps. Floor 6. Here a file's format and
//! use are recognized. Not here: the formats (`io`).

mod endings;
mod maps;

pub use endings::{
    DOCUMENTS, PICTURES, SAVED, SCRIPTS, export_extensions, is_document, is_openable, is_saved_to,
    is_script, is_whole_document, with_document_extension, without_ending,
};
pub use maps::{
    SortedFiles, finished_picture, import, import_watched, map_files, maps_beside, maps_of,
    sort_files,
};

use super::stored_preview::StoredPreview;
use super::{OpenDocument, drawing};
use crate::document::parts::drawing::DrawingTraits;
use crate::document::source::SurfaceSource;
use crate::document::{Content, Document, Layer, Live, Progress};
use crate::io::maps::ImportedSurface;
use crate::io::maps::pairs::{self, MapPart};
use crate::io::replace::{FileStamp, Terms};
use crate::io::{self, Budget, files::read_file, inspect};
use crate::math::{Size, Vec2, srgb::Color};
use crate::paint::{
    Adjust, Gradient, GradientStop, ImageFilter, PictureSource, PlacedImage, Placement,
};
use crate::raster::{Outside, Picture};
use crate::surface::{Bend, Operator};
use crate::{Error, Result};
use maps::with_own_depth;
use std::path::Path;
use std::sync::Arc;

/// What a file can be used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileUse {
    /// A document.
    Document,
    /// To paint with.
    Picture,
    /// A map of normals, alone or with depth.
    Normals,
    /// Perhaps a depth map: gray, and named like one.
    Depth,
    /// Actions to play.
    Script,
}

/// A document that was opened, ready to be shown.
pub struct OpenedFile {
    /// The document, open.
    pub open: OpenDocument,
    /// Sentences about what was found and what could not be kept.
    pub notes: Vec<String>,
    /// For a picture: its traits as a drawing.
    pub drawing: Option<DrawingTraits>,
}

/// Recognizes a dropped or opened file by its extension, its contents and its name.
pub fn kind_of(file: &Path) -> Result<FileUse> {
    if is_document(file) {
        return Ok(FileUse::Document);
    }
    if is_script(file) {
        return Ok(FileUse::Script);
    }
    let budget = Budget::of_this_machine();
    let bytes = read_file(file, budget.file_bytes)?;
    let found = inspect::describe(file, &bytes, &budget)?;
    let named = pairs::part_of(file).map(|(_, part)| part);
    Ok(
        if found.looks_like_normals
            || !found.normals.is_empty()
            || (named == Some(MapPart::Normal) && !found.is_gray)
        {
            FileUse::Normals
        } else if !found.depths.is_empty() || (found.is_gray && named == Some(MapPart::Depth)) {
            FileUse::Depth
        } else {
            FileUse::Picture
        },
    )
}

/// Opens a document, a map, or a picture as a document of its own.
pub fn open(file: &Path) -> Result<OpenedFile> {
    let found = kind_of(file)?;
    match found {
        FileUse::Document | FileUse::Picture => {
            io::save::tidy(file);
            let io::OpenedDocument { document, notes, is_whole, kind, stamp, reads, picture } =
                io::open(file, &Budget::of_this_machine())?;
            Budget::of_this_machine().room(file, "painting it", document.flattening_bytes())?;
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            // A Photoshop file of which everything was taken over is also saved to.
            let is_taken_over = kind == io::open::FileKind::Psd
                && is_whole
                && notes.is_empty()
                && is_saved_to(file);
            let is_project = kind == io::open::FileKind::Project || is_taken_over;
            let mut open = OpenDocument::new(name, document, is_project.then(|| file.into()));
            // An incomplete document must not overwrite its file without asking.
            open.stamp = Some(stamp).filter(|_| is_project && is_whole);
            open.reads = reads;
            open.stored_preview = StoredPreview::of(file, picture.as_ref(), open.document());
            let drawing = match (found, open.document().layers.as_slice()) {
                (FileUse::Picture, [layer]) => drawing::traits_of(open.document(), layer.id),
                _ => None,
            };
            Ok(OpenedFile { open, notes, drawing })
        }
        FileUse::Normals => open_maps(&with_own_depth(file)),
        FileUse::Depth => open_maps(&maps_of(None, Some(file))),
        FileUse::Script => Err(Error::unsupported_file(
            file,
            "this is a script; open it in the window, or play it with “rilievo replay”",
        )),
    }
}

/// A new document on a surface, with a plain background to paint on.
pub fn open_maps(source: &SurfaceSource) -> Result<OpenedFile> {
    Ok(of_import(source, import(source)?))
}

/// The same with maps that were already read.
pub fn of_import(source: &SurfaceSource, import: ImportedSurface) -> OpenedFile {
    let ImportedSurface { surface, findings, files } = import;
    let size = surface.size();
    let background =
        Layer { clip_to_surface: false, ..Layer::new("Background", Content::Fill(BACKGROUND)) };
    let clay = Layer::new("Base", Content::Gradient(Live::new(clay(size))));
    let document = Document {
        surface: Some(Arc::new(surface)),
        surface_source: Some(Arc::new(source.clone())),
        surface_files: Arc::new(files),
        layers: vec![Arc::new(background), Arc::new(clay)],
        ..Document::empty(size)
    };
    let file =
        source.normal.as_ref().map(|map| &map.file).or(source.depth.as_ref().map(|map| &map.file));
    let name = file.map(|file| pairs::object_of(Path::new(file))).unwrap_or_default();
    let mut open = OpenDocument::new(name, document, None);
    open.reads = map_files(source);
    OpenedFile { open, notes: findings.notes, drawing: None }
}

/// A picture that covers the canvas, unbent. `file`: its name in the document.
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

/// A picture that covers the canvas, flat, as a layer at the top: one from a renderer, to be
/// painted over.
pub fn with_picture(mut opened: OpenedFile, name: &str, picture: Picture) -> OpenedFile {
    let document = opened.open.document();
    let mut layers = document.layers.clone();
    layers.push(Arc::new(flat_image(name, &format!("{name}.exr"), picture, document.size)));
    let mut open =
        OpenDocument::new(opened.open.name.clone(), Document { layers, ..document.clone() }, None);
    open.reads = std::mem::take(&mut opened.open.reads);
    OpenedFile { open, ..opened }
}

const BACKGROUND: Color = Color { r: 0x26, g: 0x28, b: 0x2c, a: 255 };

/// The fill of a new surface: a gradient from light to dark, bent by the normals, so that the shape
/// is visible before the first stroke.
fn clay(size: Size) -> Gradient {
    let side = Vec2::new(size.width as f32, size.height as f32);
    let stop = |t: f32, [r, g, b]: [u8; 3]| GradientStop { t, color: Color { r, g, b, a: 255 } };
    Gradient {
        from: side * Vec2::new(0.30, 0.22),
        to: side * Vec2::new(0.66, 0.78),
        stops: vec![
            stop(0.0, [0xee, 0xe9, 0xe2]),
            stop(0.55, [0xb4, 0xad, 0xa5]),
            stop(1.0, [0x6a, 0x65, 0x61]),
        ],
        operator: Operator::Normal { alpha: 0.6, beta: 1.0, detail: 0.0 },
        filter: ImageFilter::Antialias,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    }
}

/// Saves a document; `None` if canceled.
pub fn save(
    file: &Path,
    document: &Document,
    terms: impl Into<Terms>,
    progress: &Progress,
) -> Result<Option<FileStamp>> {
    Ok(io::save(document, file, terms, progress)?.map(|saved| saved.stamp))
}
