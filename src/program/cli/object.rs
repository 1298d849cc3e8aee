//! A document from the command line, or the maps that it is put onto or that stand for one. Floor 7.

use super::LimitArgs;
use crate::Result;
use crate::document::source::{DepthConvention, MapSource, MaskSource, Near, NormalConvention};
use crate::document::{Document, SurfaceSource};
use crate::io::files::{TrackedFiles, read_file};
use crate::io::open::FileKind;
use crate::io::recipe::{self, OtherSurface, RecipeSource};
use crate::io::{Budget, RecipeFolder, UserFiles, open, sixteen_bit_paint};
use clap::ArgGroup;
use std::path::{Path, PathBuf};

/// Maps of an object.
#[derive(clap::Args)]
#[command(group(ArgGroup::new("maps").args(["normal", "depth"]).multiple(true)))]
pub struct ObjectArgs {
    /// Put the painting on another object: its normal map
    #[arg(long, value_name = "FILE")]
    normal: Option<PathBuf>,
    /// Put the painting on another object: its depth map
    #[arg(long, value_name = "FILE")]
    depth: Option<PathBuf>,
    /// Convention of its normals: auto (detected), opengl (green up) or directx (green down)
    #[arg(long, value_name = "WORD", default_value = "auto", requires = "normal", value_parser = convention)]
    convention: NormalConvention,
    /// Which end of its depth is near: auto (detected), low or high
    #[arg(long, value_name = "END", default_value = "auto", requires = "depth", value_parser = parse_near)]
    near: Near,
    /// The other object's mask
    #[arg(long, value_name = "FILE", requires = "maps")]
    mask: Option<PathBuf>,
}

fn convention(word: &str) -> std::result::Result<NormalConvention, String> {
    NormalConvention::from_word(word)
        .ok_or_else(|| format!("one of {}", NormalConvention::WORDS.join(", ")))
}

fn parse_near(word: &str) -> std::result::Result<Near, String> {
    Near::from_name(word).ok_or_else(|| {
        format!("one of {}", Near::ALL.iter().map(|(_, name)| *name).collect::<Vec<_>>().join(", "))
    })
}

impl ObjectArgs {
    /// What messages name: the document, or the map that stands for it.
    pub fn named_path<'a>(&'a self, document: Option<&'a Path>) -> &'a Path {
        let maps = [&self.normal, &self.depth].into_iter().flatten().map(PathBuf::as_path);
        document.into_iter().chain(maps).next().unwrap_or(Path::new(""))
    }
}

/// A document, and what it was read from.
pub struct LoadedDocument {
    pub document: Document,
    pub notes: Vec<String>,
    /// Every file that it was made from.
    pub reads: Vec<PathBuf>,
}

/// Reads a document, or maps alone: a document of nothing else.
pub fn load_object(
    document: Option<&Path>,
    object: &ObjectArgs,
    limits: &LimitArgs,
) -> Result<LoadedDocument> {
    let budget = limits.budget();
    let mut given = UserFiles::default();
    let surface = other_object(object, &mut given);
    let given = TrackedFiles::new(given);
    let onto = surface.as_ref().map(|surface| OtherSurface { surface, files: &given });
    let Some(file) = document else {
        // A recipe of nothing else.
        let read = |budget: &Budget| {
            let source = RecipeSource {
                file: object.named_path(None),
                files: &UserFiles::default(),
                budget,
                onto,
            };
            recipe::read_noting(b"{}", source)
        };
        let (document, notes) = read(&budget)?;
        return Ok(LoadedDocument { document, notes, reads: given.read_paths() });
    };
    let files = TrackedFiles::new(RecipeFolder::folder_of(file));
    let bytes = read_file(file, budget.file_bytes)?;
    let mut reads = vec![file.to_owned()];
    let (document, notes) = match FileKind::of(&bytes) {
        FileKind::Recipe => {
            let read = |budget: &Budget| {
                recipe::read_noting(&bytes, RecipeSource { file, files: &files, budget, onto })
            };
            let ((document, mut notes), rounded) =
                sixteen_bit_paint::read_within_budget(file, &budget, read, |(document, _)| {
                    document
                })?;
            notes.extend(rounded);
            (document, notes)
        }
        _ => {
            let opened = open(file, &budget)?;
            let document = onto.map_or(Ok(opened.document.clone()), |onto| {
                recipe::put_onto(&opened.document, file, onto, &budget)
            })?;
            (document, opened.notes)
        }
    };
    reads.extend(files.read_paths());
    reads.extend(given.read_paths());
    Ok(LoadedDocument { document, notes, reads })
}

/// The object from the command line, if any.
fn other_object(args: &ObjectArgs, given: &mut UserFiles) -> Option<SurfaceSource> {
    let mut name = |path: &Option<PathBuf>| path.as_deref().map(|path: &Path| given.add(path));
    let (normal, depth, mask) = (name(&args.normal), name(&args.depth), name(&args.mask));
    (normal.is_some() || depth.is_some()).then(|| SurfaceSource {
        normal: normal.map(|file| MapSource {
            file,
            channel: None,
            convention: args.convention.clone(),
        }),
        depth: depth.map(|file| MapSource {
            file,
            channel: None,
            convention: DepthConvention { near: args.near, ..DepthConvention::default() },
        }),
        mask: mask.map(|file| MaskSource::File { file, channel: None, invert: false }),
        matrix: None,
    })
}
