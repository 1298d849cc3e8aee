//! `rilievo render`: a document to a picture.
//! Floor 7.

use super::force::Force;
use super::messages::print_notes;
use super::object::{LoadedDocument, ObjectArgs, load_object};
use super::painted::{refuse_incomplete, scale_document};
use super::{LimitArgs, progress, values};
use crate::document::Document;
use crate::io::export::{ExportFormat, ExportOptions, OutputFile};
use crate::io::recipe::{LiveLook, PartMaterial};
use crate::math::ColorProfile;
use crate::math::srgb::Color;
use crate::{Error, Result};
use std::path::{Path, PathBuf};

/// Render a project or a recipe to a picture
#[derive(clap::Args)]
pub struct RenderArgs {
    /// The project (.ora), or the recipe: a JSON file, next to the files that it names. May be left
    /// out with --look and maps
    #[arg(value_name = "DOC", required_unless_present_all = ["look", "maps"])]
    document: Option<PathBuf>,
    /// The picture to write: .png, .exr, .jpg, .webp or .tif; an existing file is replaced only
    /// with --force
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    onto: ObjectArgs,
    /// Show it in a look that comes with the program, such as oil-sketch, clay or blueprint
    #[arg(long, value_name = "NAME", value_parser = look)]
    look: Option<LiveLook>,
    /// Give a part a material that comes with the program, such as leather=part-2; without a part,
    /// the whole surface. May be given several times
    #[arg(long, value_name = "NAME[=PART]", value_parser = material)]
    material: Vec<MaterialChoice>,
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
    /// Color profile that colors are converted to and that the picture names: srgb or display-p3;
    /// by default the document's
    #[arg(long, value_name = "PROFILE", value_parser = profile)]
    profile: Option<ColorProfile>,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    limits: LimitArgs,
}

fn profile(word: &str) -> std::result::Result<ColorProfile, String> {
    let known = ColorProfile::ALL.map(|(_, name)| name).join(", ");
    ColorProfile::from_name(word).ok_or_else(|| format!("one of {known}"))
}

fn look(word: &str) -> std::result::Result<LiveLook, String> {
    LiveLook::of_key(word)
        .ok_or_else(|| format!("one of {}", LiveLook::keys().collect::<Vec<_>>().join(", ")))
}

/// A material, and the part that gets it.
#[derive(Clone)]
struct MaterialChoice {
    material: PartMaterial,
    part: Option<String>,
}

fn material(word: &str) -> std::result::Result<MaterialChoice, String> {
    let (name, part) = match word.split_once('=') {
        Some((name, part)) => (name, Some(part.to_owned())),
        None => (word, None),
    };
    let material = PartMaterial::of_key(name)
        .ok_or_else(|| format!("one of {}", PartMaterial::keys().collect::<Vec<_>>().join(", ")))?;
    Ok(MaterialChoice { material, part })
}

pub fn run(args: &RenderArgs) -> Result<()> {
    // A misspelled extension is reported before the work, not after it.
    ExportFormat::of(&args.output)?.bits(&args.output, args.bits)?;
    args.limits.install(|| {
        let named_file = args.named_path();
        let LoadedDocument { document, notes, reads } =
            load_object(args.document.as_deref(), &args.onto, &args.limits)?;
        refuse_incomplete(named_file, &document)?;
        let target = OutputFile::new(&args.output, args.force.export(reads))?;
        let document = apply_arguments(args, document)?;
        let document = scale_document(named_file, args.scale, &args.limits, document)?;
        args.limits.room_to_paint(named_file, &document)?;
        let alone =
            args.layer.as_ref().map(|name| find_layer(args, &document, name)).transpose()?;
        let shown = alone.and_then(|layer| document.with_only(&[layer])).unwrap_or(document);
        let options = ExportOptions {
            background: args.background,
            quality: args.quality,
            bits: args.bits,
            profile: args.profile,
            ..ExportOptions::default()
        };
        progress::run_with_progress(|progress| {
            target.write_document(&shown, &options, &args.limits.budget(), progress)
        })?;
        // Notes would only hide an error.
        print_notes(named_file, &notes);
        Ok(())
    })
}

impl RenderArgs {
    /// What messages name: the document, or the map that stands for it.
    fn named_path(&self) -> &Path {
        self.onto.named_path(self.document.as_deref())
    }
}

/// In the look and the materials that were asked for.
fn apply_arguments(args: &RenderArgs, document: Document) -> Result<Document> {
    if args.look.is_none() && args.material.is_empty() {
        return Ok(document);
    }
    if document.surface.is_none() {
        let reason = "it has no shape: name its maps with --normal or --depth";
        return Err(Error::unsupported_file(args.named_path(), reason));
    }
    let give = |document: Document, choice: &MaterialChoice| {
        Ok(choice.material.on(&document, choice.part.as_deref())?.0)
    };
    let document = args.material.iter().try_fold(document, give)?;
    args.look.as_ref().map_or(Ok(document.clone()), |look| look.on(&document))
}

fn find_layer(
    args: &RenderArgs,
    document: &Document,
    name: &str,
) -> Result<crate::document::LayerId> {
    document.layer_named(name).map(|layer| layer.id).ok_or_else(|| {
        let names: Vec<_> =
            document.walk().iter().map(|(_, layer)| format!("“{}”", layer.name)).collect();
        Error::invalid(
            args.named_path(),
            "--layer",
            format!("no layer is called “{name}”; there are {}", names.join(", ")),
        )
    })
}
