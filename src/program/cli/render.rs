//! `rilievo render`: a document to a picture.
//! Floor 7.

use super::force::Force;
use super::painted::{refuse_incomplete, scaled};
use super::told::tell;
use super::{LimitArgs, progress, values};
use crate::document::source::{DepthConvention, MapSource, MaskSource, Near, NormalConvention};
use crate::document::{Document, SurfaceSource};
use crate::io::export::{ExportFormat, ExportOptions, OutputFile};
use crate::io::files::{TrackedFiles, read_file};
use crate::io::open::FileKind;
use crate::io::recipe::{self, LiveLook, OtherSurface, RecipeSource};
use crate::io::{Budget, RecipeFolder, UserFiles, deep_paint, open};
use crate::math::srgb::Color;
use crate::{Error, Result};
use clap::ArgGroup;
use std::path::{Path, PathBuf};

/// Render a project or a recipe to a picture
#[derive(clap::Args)]
#[command(group(ArgGroup::new("maps").args(["normal", "depth"]).multiple(true)))]
pub struct RenderArgs {
    /// The project (.ora), or the recipe: a JSON file, next to the files that it names. May be left
    /// out with --look and maps
    #[arg(value_name = "DOC", required_unless_present_all = ["look", "maps"])]
    document: Option<PathBuf>,
    /// The picture to write: .png, .exr, .jpg, .webp or .tif; an existing file is replaced only
    /// with --force
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
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
    #[arg(long, value_name = "END", default_value = "auto", requires = "depth", value_parser = near)]
    near: Near,
    /// The other object's mask
    #[arg(long, value_name = "FILE", requires = "maps")]
    mask: Option<PathBuf>,
    /// Show it in a look that comes with the program, such as oil-sketch, clay or blueprint
    #[arg(long, value_name = "NAME", value_parser = look)]
    look: Option<LiveLook>,
    /// Size of the picture relative to the canvas
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = values::scale)]
    scale: f32,
    /// Render only the layer with this name
    #[arg(long, value_name = "NAME")]
    layer: Option<String>,
    /// Background behind transparent parts, as #rrggbb
    #[arg(long, value_name = "COLOR", value_parser = values::color)]
    background: Option<Color>,
    /// Quality of a JPEG, 1 to 100
    #[arg(long, value_name = "N", default_value_t = ExportOptions::default().quality,
          value_parser = clap::value_parser!(u8).range(1..=100))]
    quality: u8,
    /// Bits per channel: 8 or 16 for a .png or .tif (default 8), 16 or 32 for an .exr (default 16)
    #[arg(long, value_name = "N", value_parser = values::depth)]
    bits: Option<u8>,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    limits: LimitArgs,
}

fn convention(word: &str) -> std::result::Result<NormalConvention, String> {
    NormalConvention::from_word(word)
        .ok_or_else(|| format!("one of {}", NormalConvention::WORDS.join(", ")))
}

fn look(word: &str) -> std::result::Result<LiveLook, String> {
    LiveLook::of_key(word)
        .ok_or_else(|| format!("one of {}", LiveLook::keys().collect::<Vec<_>>().join(", ")))
}

fn near(word: &str) -> std::result::Result<Near, String> {
    Near::from_name(word).ok_or_else(|| {
        format!("one of {}", Near::ALL.iter().map(|(_, name)| *name).collect::<Vec<_>>().join(", "))
    })
}

pub fn run(args: &RenderArgs) -> Result<()> {
    // A misspelled extension is reported before the work, not after it.
    ExportFormat::of(&args.output)?.bits(&args.output, args.bits)?;
    args.limits.install(|| {
        let told_of = args.named();
        let LoadedDocument { document, notes, reads } = load(args)?;
        refuse_incomplete(told_of, &document)?;
        let target = OutputFile::new(&args.output, args.force.export(reads))?;
        let document = dressed(args, document)?;
        let document = scaled(told_of, args.scale, &args.limits, document)?;
        args.limits.room_to_paint(told_of, &document)?;
        let alone = args.layer.as_ref().map(|name| named(args, &document, name)).transpose()?;
        let shown = alone.and_then(|layer| document.with_only(&[layer])).unwrap_or(document);
        let options = ExportOptions {
            background: args.background,
            quality: args.quality,
            bits: args.bits,
            ..ExportOptions::default()
        };
        progress::shown(|progress| {
            target.write_document(&shown, &options, &args.limits.budget(), progress)
        })?;
        // Notes would only hide an error.
        tell(told_of, &notes);
        Ok(())
    })
}

impl RenderArgs {
    /// What messages name: the document, or the map that stands for it.
    fn named(&self) -> &Path {
        let given = [&self.document, &self.normal, &self.depth];
        given.into_iter().flatten().next().map_or(Path::new(""), PathBuf::as_path)
    }
}

/// In the look that was asked for.
fn dressed(args: &RenderArgs, document: Document) -> Result<Document> {
    let Some(look) = &args.look else { return Ok(document) };
    if document.surface.is_none() {
        let reason = "it has no shape: name its maps with --normal or --depth";
        return Err(Error::unsupported(args.named(), reason));
    }
    look.on(&document)
}

struct LoadedDocument {
    document: Document,
    notes: Vec<String>,
    /// Every file that it was made from.
    reads: Vec<PathBuf>,
}

fn load(args: &RenderArgs) -> Result<LoadedDocument> {
    let budget = args.limits.budget();
    let mut given = UserFiles::default();
    let surface = other_object(args, &mut given);
    let given = TrackedFiles::new(given);
    let onto = surface.as_ref().map(|surface| OtherSurface { surface, files: &given });
    let Some(file) = &args.document else {
        // Maps alone, to be shown in a look: a recipe of nothing else.
        let read = |budget: &Budget| {
            let source =
                RecipeSource { file: args.named(), files: &UserFiles::default(), budget, onto };
            recipe::read_noting(b"{}", source)
        };
        let (document, notes) = read(&budget)?;
        return Ok(LoadedDocument { document, notes, reads: given.read_paths() });
    };
    let files = TrackedFiles::new(RecipeFolder::beside(file));
    let bytes = read_file(file, budget.file_bytes)?;
    let mut reads = vec![file.clone()];
    let (document, notes) = match FileKind::of(&bytes) {
        FileKind::Recipe => {
            let read = |budget: &Budget| {
                recipe::read_noting(&bytes, RecipeSource { file, files: &files, budget, onto })
            };
            let ((document, mut notes), rounded) =
                deep_paint::fitted(file, &budget, read, |(document, _)| document)?;
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
fn other_object(args: &RenderArgs, given: &mut UserFiles) -> Option<SurfaceSource> {
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

fn named(args: &RenderArgs, document: &Document, name: &str) -> Result<crate::document::LayerId> {
    document.layer_named(name).map(|layer| layer.id).ok_or_else(|| {
        let names: Vec<_> =
            document.walk().iter().map(|(_, layer)| format!("“{}”", layer.name)).collect();
        Error::invalid(
            args.named(),
            "--layer",
            format!("no layer is called “{name}”; there are {}", names.join(", ")),
        )
    })
}
