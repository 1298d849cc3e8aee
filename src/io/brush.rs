//! Imports brushes of other programs, with notes on settings that have no counterpart here.
//! Floor 5.
//!
//! | file | |
//! |---|---|
//! | `gbr` | GIMP's brushes: one picture |
//! | `gih` | GIMP's image hoses: several pictures and the rule that chooses |
//! | `vbr` | GIMP's parametric brushes: numbers |
//! | `kpp` | Krita's presets: settings in a picture |
//! | `bundle` | Krita's bundles: presets with their tips and patterns |
//! | `beside` | where the tips and patterns are that a preset names |
//! | `pat` | GIMP's patterns, which Krita's textures use |
//! | `myb` | MyPaint's brushes: numbers and curves |
//! | `abr` | Photoshop's collections: sampled tips |
//! | `write` | a brush as a preset's file of this program |

mod abr;
mod beside;
mod bundle;
mod gbr;
mod gih;
mod kpp;
mod myb;
mod pat;
#[cfg(test)]
mod tests;
mod vbr;
mod write;

pub use beside::{BrushFiles, NeighborFiles, NoBrushFiles, ResourceKind};
pub use write::{Encoded, encode, pictures_beside, remove};

use super::Budget;
use crate::paint::tip::Hose;
use crate::paint::{Adjust, Brush, PictureSource, Tip};
use crate::raster::Picture;
use crate::{Error, Result};
use std::collections::BTreeSet;
use std::path::Path;

/// A brush that was read from another program's file.
#[derive(Clone)]
pub struct ImportedBrush {
    /// Its name there; not empty.
    pub name: String,
    /// The brush, as close as it gets.
    pub brush: Brush,
    /// Sentences about what could not be carried over, without full stops.
    pub notes: Vec<String>,
}

/// The format of a brush file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrushFormat {
    /// `.gbr`: one picture.
    GimpBrush,
    /// `.gih`: several pictures, of which each dab uses one.
    GimpHose,
    /// `.vbr`: a shape with numbers.
    GimpParametric,
    /// `.kpp`: a preset.
    Krita,
    /// `.myb`: a preset.
    MyPaint,
    /// `.abr`: a collection of brushes.
    Photoshop,
    /// `.bundle`: presets with their tips and patterns.
    KritaBundle,
}

/// Endings of the files that hold brushes.
pub const EXTENSIONS: [(&str, BrushFormat); 7] = [
    ("gbr", BrushFormat::GimpBrush),
    ("gih", BrushFormat::GimpHose),
    ("vbr", BrushFormat::GimpParametric),
    ("kpp", BrushFormat::Krita),
    ("bundle", BrushFormat::KritaBundle),
    ("myb", BrushFormat::MyPaint),
    ("abr", BrushFormat::Photoshop),
];

impl BrushFormat {
    /// Recognizes the format by the content if possible, else by the extension: most of these
    /// formats have no signature.
    pub fn of(file: &Path, bytes: &[u8]) -> Option<Self> {
        if gbr::is_gbr(bytes) {
            return Some(BrushFormat::GimpBrush);
        }
        if vbr::is_vbr(bytes) {
            return Some(BrushFormat::GimpParametric);
        }
        if bundle::is_bundle(bytes) {
            return Some(BrushFormat::KritaBundle);
        }
        let extension = file.extension()?.to_string_lossy().to_lowercase();
        EXTENSIONS.iter().find(|(known, _)| *known == extension).map(|(_, kind)| *kind)
    }

    /// The name of the format.
    pub fn name(self) -> &'static str {
        match self {
            BrushFormat::GimpBrush => "GIMP brush",
            BrushFormat::GimpHose => "GIMP image hose",
            BrushFormat::GimpParametric => "GIMP parametric brush",
            BrushFormat::Krita => "Krita preset",
            BrushFormat::MyPaint => "MyPaint brush",
            BrushFormat::Photoshop => "Photoshop brushes",
            BrushFormat::KritaBundle => "Krita bundle",
        }
    }
}

/// The brushes of a file, in its order; at least one. Fails with a sentence if the file has none of
/// these formats, is damaged beyond use, or is larger than the budget allows.
///
/// * `files`: where the tip and the pattern are found that a preset names.
pub fn read(
    file: &Path,
    bytes: &[u8],
    files: &dyn BrushFiles,
    budget: &Budget,
) -> Result<Vec<ImportedBrush>> {
    match BrushFormat::of(file, bytes) {
        Some(BrushFormat::GimpBrush) => gbr::read(file, bytes, budget).map(|brush| vec![brush]),
        Some(BrushFormat::GimpHose) => gih::read(file, bytes, budget).map(|brush| vec![brush]),
        Some(BrushFormat::GimpParametric) => vbr::read(file, bytes).map(|brush| vec![brush]),
        Some(BrushFormat::Krita) => kpp::read(file, bytes, files, budget).map(|brush| vec![brush]),
        Some(BrushFormat::MyPaint) => myb::read(file, bytes, budget).map(|brush| vec![brush]),
        Some(BrushFormat::Photoshop) => abr::read(file, bytes, budget),
        Some(BrushFormat::KritaBundle) => bundle::read(file, bytes, budget),
        None => {
            let endings: Vec<String> =
                EXTENSIONS.iter().map(|(ending, _)| format!(".{ending}")).collect();
            let reason = format!("it ends in none of {}", endings.join(", "));
            Err(Error::unsupported_file(file, reason))
        }
    }
}

/// Counts the pixels of the pictures of a file's brushes; fails beyond the budget. `used_px`: of
/// the pictures before.
fn spend(file: &Path, budget: &Budget, used_px: &mut u64, px: u64) -> Result<()> {
    *used_px = used_px.saturating_add(px);
    if *used_px > budget.document_px {
        let reason = format!("its pictures hold more than {} pixels together", budget.document_px);
        return Err(Error::too_large(file, reason));
    }
    // Four bytes for each.
    budget.room(file, "the pictures of its brushes", used_px.saturating_mul(4))
}

impl ImportedBrush {
    /// A brush that stamps one picture in its own size. `spacing`: share of the longer side.
    fn stamp(name: String, tip: PictureSource, spacing: f32) -> Self {
        let size = tip.picture.size.longer_side();
        Self::with_tip(name, Tip::Picture(tip), size, spacing)
    }

    fn hose(name: String, hose: Hose, spacing: f32) -> Self {
        let size = hose
            .pictures()
            .iter()
            .map(|source| source.picture.size.longer_side())
            .fold(1.0, f32::max);
        Self::with_tip(name, Tip::Hose(hose), size, spacing)
    }

    fn with_tip(name: String, tip: Tip, size: f32, spacing: f32) -> Self {
        let brush = Brush { size, spacing: spacing.max(0.01).min(10.0), tip, ..Brush::default() };
        let name = if name.is_empty() { "Brush".to_owned() } else { name };
        Self { name, brush, notes: Vec::new() }
    }
}

/// Names for the pictures of tips: each once, plain letters only, so that every system can hold
/// such a file.
#[derive(Default)]
struct TipNames {
    taken: BTreeSet<String>,
}

impl TipNames {
    /// `name`: of the brush; the name of the file replaces one without usable letters.
    fn add(&mut self, file: &Path, picture: Picture, name: &str) -> PictureSource {
        let of_file = || plain(&file.file_stem().unwrap_or_default().to_string_lossy());
        let stem = Some(plain(name)).filter(|n| !n.is_empty()).unwrap_or_else(of_file);
        let stem = if stem.is_empty() { "tip".to_owned() } else { stem };
        let numbered =
            |n: usize| if n == 1 { format!("{stem}.png") } else { format!("{stem}-{n}.png") };
        let free = (1..).map(numbered).find(|name| !self.taken.contains(name)).unwrap_or_default();
        self.taken.insert(free.clone());
        PictureSource::new(free, picture, Adjust::default())
    }
}

/// A name in small letters and hyphens, at most 60.
pub fn plain(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars().take(60) {
        match c {
            c if c.is_ascii_alphanumeric() => out.push(c.to_ascii_lowercase()),
            _ if !out.is_empty() && !out.ends_with('-') => out.push('-'),
            _ => {}
        }
    }
    out.trim_end_matches('-').to_owned()
}

/// Text up to its NUL, without control characters; read as Latin-1 if it is not UTF-8.
fn text_of(bytes: &[u8]) -> String {
    let bytes = bytes.split(|b| *b == 0).next().unwrap_or_default();
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|b| char::from(*b)).collect(),
    };
    text.trim().chars().filter(|c| !c.is_control()).take(200).collect()
}
