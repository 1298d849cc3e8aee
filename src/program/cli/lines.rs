//! The command `lines`: the form lines of a shape as paths of an SVG.
//! Floor 7. Not here: where the lines are (`surface::form_lines`), the SVG (`io::line_svg`).

use super::force::Force;
use super::messages::print_notes;
use super::object::{LoadedDocument, ObjectArgs, load_object};
use super::{LimitArgs, values};
use crate::document::Progress;
use crate::io::fs::Disk;
use crate::io::line_svg;
use crate::io::replace::{check, replace};
use crate::paint::FormPattern;
use crate::{Error, Result};
use std::path::PathBuf;

/// Write the outlines, creases and folds of a shape as paths of an SVG
///
/// The lines are those of the document's layer of form lines, or those that such a layer begins
/// with. Each path is the middle of a line; its width is the mean of what the brush would draw.
#[derive(clap::Args)]
pub struct LinesArgs {
    /// The project (.ora) or the recipe (.json). May be left out with maps
    #[arg(value_name = "DOC", required_unless_present = "maps")]
    document: Option<PathBuf>,
    /// The SVG to write; an existing file is replaced only with --force
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    onto: ObjectArgs,
    /// How faint a fold may be, 0 to 1
    #[arg(long, value_name = "SHARE", value_parser = values::share)]
    detail: Option<f32>,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    limits: LimitArgs,
}

/// Runs it.
pub fn run(args: &LinesArgs) -> Result<()> {
    args.limits.install(|| {
        let named = args.onto.named_path(args.document.as_deref());
        let LoadedDocument { document, notes, reads } =
            load_object(args.document.as_deref(), &args.onto, &args.limits)?;
        let terms = args.force.export(reads);
        check(&Disk, &args.output, &terms)?;
        if document.surface.is_none() {
            let reason = "it has no shape: name its maps with --normal or --depth";
            return Err(Error::unsupported_file(named, reason));
        }
        let mut drawing = line_svg::drawing_of(&document);
        if let (Some(detail), FormPattern::Lines(lines)) = (args.detail, &mut drawing.pattern) {
            lines.detail = detail;
        }
        let svg = line_svg::write(&document, &drawing);
        replace(&Disk, &args.output, svg.as_bytes(), &terms, &Progress::default())?;
        print_notes(named, &notes);
        Ok(())
    })
}
