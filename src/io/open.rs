//! Opens documents: recognizes a file by its content and reads it as a document.
//! Floor 5. Saving is `save`; the formats are modules of their own.

#![warn(missing_docs)]

use super::files::{RecipeFolder, TrackedFiles, read_file};
use super::project::{self, Archive, ProjectContents};
use super::recipe::{self, RecipeSource};
use super::replace::FileStamp;
use super::{Budget, aseprite, clip, json, picture, psd, sixteen_bit_paint};
use crate::document::{Content, Document, Layer, PixelLayer};
use crate::raster::Asset;
use crate::{Error, Result};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A document and where it came from.
pub struct OpenedDocument {
    /// What the file holds.
    pub document: Document,
    /// What differs from the saved state or could not be imported: a sentence each, to be shown.
    pub notes: Vec<String>,
    /// Whether nothing was lost. A document that is not whole must not overwrite its file without
    /// asking.
    pub is_whole: bool,
    /// What the file is.
    pub kind: FileKind,
    /// The file's stamp when it was read, for [`super::replace::Overwrite::This`].
    pub stamp: FileStamp,
    /// Every file that was read for it, itself first: nothing made from them may overwrite them.
    pub reads: Vec<PathBuf>,
    /// The merged picture that a project holds besides its layers, as a PNG.
    pub picture: Option<Asset>,
}

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// OpenRaster, ours or another program's; the only kind that a document is saved to.
    Project,
    /// A recipe: JSON that names files next to it.
    Recipe,
    /// A Photoshop file.
    Psd,
    /// A picture, which became a document of one layer.
    Picture,
}

impl FileKind {
    /// The kind of file, in a word.
    pub fn name(self) -> &'static str {
        match self {
            FileKind::Project => "project",
            FileKind::Recipe => "recipe",
            FileKind::Psd => "psd",
            FileKind::Picture => "picture",
        }
    }

    /// The kind of a file by its first bytes; a picture if nothing else fits.
    pub fn of(bytes: &[u8]) -> Self {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        match text.first() {
            _ if Archive::is_zip(bytes) => FileKind::Project,
            Some(b'{') => FileKind::Recipe,
            // The reader says what is wrong with it.
            _ if json::is_utf16(bytes) => FileKind::Recipe,
            _ if bytes.starts_with(&psd::MAGIC) => FileKind::Psd,
            _ => FileKind::Picture,
        }
    }
}

/// Opens a project, a recipe (the files it names are next to it), a Photoshop file, or a picture,
/// which becomes a document of one paint layer. Its surface is what its parts make.
///
/// A damaged project gives every intact layer; `notes` list the others, and `is_whole` is false.
pub fn open(file: &Path, budget: &Budget) -> Result<OpenedDocument> {
    let bytes = read_file(file, budget.file_bytes)?;
    let kind = FileKind::of(&bytes);
    let files = TrackedFiles::new(RecipeFolder::folder_of(file));
    let whole =
        |(document, notes)| ProjectContents { document, notes, is_whole: true, picture: None };
    let read = |budget: &Budget| match kind {
        FileKind::Project => project::read(file, &bytes, budget),
        FileKind::Recipe => {
            recipe::read_noting(&bytes, RecipeSource { file, files: &files, budget, onto: None })
                .map(whole)
        }
        FileKind::Psd => psd::read(file, &bytes, budget),
        FileKind::Picture => single(file, &bytes, budget),
    };
    // Layers may have been put in after their parts were read.
    let shaped =
        |read: ProjectContents| ProjectContents { document: read.document.reshaped(), ..read };
    let read = |budget: &Budget| read(budget).map(shaped);
    let (read, rounded) =
        sixteen_bit_paint::read_within_budget(file, budget, read, |read| &read.document)?;
    let ProjectContents { document, mut notes, is_whole, picture } = read;
    let is_whole = is_whole && rounded.is_none();
    notes.extend(rounded);
    let reads = [vec![file.into()], files.read_paths()].concat();
    Ok(OpenedDocument {
        document,
        notes,
        is_whole,
        kind,
        stamp: FileStamp::of(&bytes),
        reads,
        picture,
    })
}

/// A picture as a document of its size; an EXR or a sprite of several layers with all of them.
fn single(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ProjectContents> {
    // Colors in Display P3 stay: the document has that profile.
    let profile = picture::profile_of(file, bytes, budget);
    let budget = &Budget { profile, ..*budget };
    if aseprite::is_aseprite(bytes) {
        return aseprite::read(file, bytes, budget);
    }
    if clip::is_clip(bytes) {
        let none = "a Clip Studio drawing without a preview; save it as PSD in Clip Studio";
        let preview = clip::preview(bytes).ok_or_else(|| Error::unsupported_file(file, none))?;
        let mut shown = single(file, &preview, budget)?;
        let note = "it is a Clip Studio drawing, shown by its preview; for its layers, save it as \
                    PSD in Clip Studio";
        shown.notes.push(note.to_owned());
        return Ok(ProjectContents { is_whole: false, ..shown });
    }
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let mut stored = picture::layers(file, bytes, budget)?;
    let (several, has_whole) = (!stored.is_empty(), stored.iter().any(|layer| layer.is_whole));
    if !several {
        let painted = picture::decode_paint(file, bytes, 0, 0, budget)?;
        stored.push(picture::LightLayer { name: String::new(), painted, is_whole: true });
    }
    let warning = stored[0].painted.warning;
    let size = stored[0].painted.size;
    let layer = |stored: picture::LightLayer| {
        let tiles = stored.painted.tiles;
        let name = if stored.name.is_empty() { name.clone().into_owned() } else { stored.name };
        let content = Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles });
        Arc::new(Layer { visible: stored.is_whole || !has_whole, ..Layer::new(name, content) })
    };
    let layers = stored.into_iter().map(layer).collect();
    let notes = match (several, has_whole) {
        (false, _) => None,
        (true, true) => {
            Some("its other layers are hidden, since the file also holds the whole picture")
        }
        (true, false) => {
            Some("the layers are in the order of the file, since an EXR has no order of layers")
        }
    };
    let notes = notes.into_iter().chain(warning).map(str::to_owned).collect();
    let document = Document { layers, profile, ..Document::empty(size) };
    Ok(ProjectContents { document, notes, is_whole: true, picture: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exr_of_several_layers_opens_with_all_of_them() {
        use crate::exr::encode_channels;
        let file = Path::new("a.exr");
        let opened = |names: &[&'static str]| {
            let light = |layer: &'static str| {
                ["R", "G", "B"].map(|c| (format!("{layer}{c}"), vec![0.5f32; 4]))
            };
            let channels: Vec<(String, Vec<f32>)> =
                names.iter().flat_map(|name| light(name)).collect();
            let channels =
                channels.iter().map(|(name, values)| (name.as_str(), values.clone())).collect();
            let bytes = encode_channels(file, crate::math::Size::new(2, 2), channels).unwrap();
            single(file, &bytes, &Budget::default()).unwrap()
        };
        let shown = |contents: &ProjectContents| -> Vec<(String, bool)> {
            contents
                .document
                .layers
                .iter()
                .map(|layer| (layer.name.clone(), layer.visible))
                .collect()
        };
        let alone = opened(&["diffuse."]);
        assert_eq!((shown(&alone), alone.notes.len()), (vec![("a".into(), true)], 0));
        assert_eq!(shown(&opened(&["b.", "c."])), [("b".into(), true), ("c".into(), true)]);
        assert_eq!(shown(&opened(&["", "c."])), [("a".into(), true), ("c".into(), false)]);
    }

    #[test]
    fn what_a_file_is_shows_in_its_first_bytes() {
        assert_eq!(FileKind::of(b"PK\x03\x04rest"), FileKind::Project);
        assert_eq!(FileKind::of(b"\xef\xbb\xbf \n{\"format\""), FileKind::Recipe);
        assert_eq!(FileKind::of(b"\xff\xfe \0{\0"), FileKind::Recipe);
        assert_eq!(FileKind::of(b"\0 \0{\0\""), FileKind::Recipe);
        assert_eq!(FileKind::of(b"8BPS\0\x01"), FileKind::Psd);
        assert_eq!(FileKind::of(b"\x89PNG"), FileKind::Picture);
    }
}
