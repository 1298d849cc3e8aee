//! What a file dialog is opened for: its title, the files to choose from, and the name of a new
//! one. Floor 7. Not here: asking (`files`).

use crate::io::palette::PaletteFormat;
use crate::session::PicturePart;
use crate::session::brushes;
use crate::session::storage::{
    DOCUMENTS, PICTURES, SAVED, SCRIPTS, export_extensions, with_document_extension,
};
use std::path::PathBuf;

/// What the file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePurpose {
    Open,
    Place,
    ImportUnwrapped,
    /// A picture over the canvas.
    Reference,
    /// Of a press or a screen.
    ColorProfile,
    Brush,
    /// Colors of another program.
    Palette,
    /// A table of colors.
    ColorTable,
    NormalMap,
    DepthMap,
    MaskMap,
    /// A picture of the selected layer.
    Part(PicturePart),
    Save,
    Export,
    /// Maps of the shape, whose names begin with this one.
    ExportMaps,
    ExportUnwrapped,
    /// The lines of the form.
    ExportLines,
    /// The palette that is shown.
    ExportPalette(PaletteFormat),
}

/// Extensions of maps of the shape.
const MAPS: [&str; 2] = ["png", "exr"];

impl FilePurpose {
    /// Extensions of pictures of the unwrapped surface.
    const FLAT: [&'static str; 4] = ["png", "tif", "tiff", "exr"];
    const VECTORS: [&'static str; 1] = ["svg"];

    pub fn title(self) -> &'static str {
        match self {
            FilePurpose::Open => "Open",
            FilePurpose::Place => "Place an image",
            FilePurpose::ImportUnwrapped => "Import a picture of the unwrapped surface",
            FilePurpose::Reference => "Pin a reference",
            FilePurpose::ColorProfile => "ICC profile of a press or a screen",
            FilePurpose::Brush => "Import a brush",
            FilePurpose::Palette => "Import a palette",
            FilePurpose::ColorTable => "Color look-up table",
            FilePurpose::NormalMap => "Normal map",
            FilePurpose::DepthMap => "Depth map",
            FilePurpose::MaskMap => "Mask",
            FilePurpose::Part(part) => part.label(),
            FilePurpose::Save => "Save as",
            FilePurpose::Export => "Export the picture",
            FilePurpose::ExportMaps => "Export maps of the shape",
            FilePurpose::ExportUnwrapped => "Export the unwrapped surface",
            FilePurpose::ExportLines => "Export the lines of the form",
            FilePurpose::ExportPalette(_) => "Export the palette",
        }
    }

    pub fn is_saving(self) -> bool {
        matches!(
            self,
            FilePurpose::Save
                | FilePurpose::Export
                | FilePurpose::ExportMaps
                | FilePurpose::ExportUnwrapped
                | FilePurpose::ExportLines
                | FilePurpose::ExportPalette(_)
        )
    }

    /// The extensions of files to choose from, with the name of each group.
    pub fn filters(self) -> Vec<(&'static str, Vec<&'static str>)> {
        let pictures = || PICTURES.to_vec();
        match self {
            FilePurpose::Open => vec![
                ("All supported files", [&DOCUMENTS[..], &PICTURES, &SCRIPTS].concat()),
                ("Documents", DOCUMENTS.to_vec()),
                ("Pictures and maps", pictures()),
                ("Scripts", SCRIPTS.to_vec()),
            ],
            FilePurpose::Brush => vec![("Brushes", brushes::extensions())],
            FilePurpose::ColorProfile => vec![("ICC profiles", vec!["icc", "icm"])],
            FilePurpose::Reference => {
                vec![("Pictures and documents", [&PICTURES[..], &DOCUMENTS].concat())]
            }
            FilePurpose::Palette => vec![("Palettes", PaletteFormat::EXTENSIONS.to_vec())],
            FilePurpose::ColorTable => vec![("Tables", vec!["cube"])],
            FilePurpose::Place
            | FilePurpose::ImportUnwrapped
            | FilePurpose::NormalMap
            | FilePurpose::DepthMap
            | FilePurpose::MaskMap
            | FilePurpose::Part(_) => {
                vec![("Pictures", pictures())]
            }
            FilePurpose::Save => vec![("Documents", SAVED.to_vec())],
            FilePurpose::Export => vec![("Pictures", export_extensions().collect())],
            FilePurpose::ExportMaps => vec![("Maps", MAPS.to_vec())],
            FilePurpose::ExportUnwrapped => vec![("Pictures", Self::FLAT.to_vec())],
            FilePurpose::ExportLines => vec![("Vector graphics", Self::VECTORS.to_vec())],
            FilePurpose::ExportPalette(format) => vec![("Palettes", vec![format.extension()])],
        }
    }

    /// The final name of a chosen file. `extension`: for exports without one.
    pub fn final_name(self, file: PathBuf, extension: &str) -> PathBuf {
        match self {
            FilePurpose::Save => with_document_extension(file, SAVED[0], &SAVED),
            FilePurpose::ExportMaps => with_document_extension(file, MAPS[0], &MAPS),
            FilePurpose::Export => {
                with_document_extension(file, extension, &export_extensions().collect::<Vec<_>>())
            }
            FilePurpose::ExportUnwrapped => {
                with_document_extension(file, Self::FLAT[0], &Self::FLAT)
            }
            FilePurpose::ExportLines => {
                with_document_extension(file, Self::VECTORS[0], &Self::VECTORS)
            }
            FilePurpose::ExportPalette(format) => {
                with_document_extension(file, format.extension(), &[format.extension()])
            }
            _ => file,
        }
    }
}
