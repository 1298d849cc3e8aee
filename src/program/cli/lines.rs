//! The command `lines`: the form lines of a shape as paths of an SVG.
//! Floor 7. Not here: where the lines are (`surface::form_lines`).

use super::force::Force;
use super::messages::print_notes;
use super::object::{LoadedDocument, ObjectArgs, load_object};
use super::{LimitArgs, values};
use crate::document::{Content, Document, Progress};
use crate::io::fs::Disk;
use crate::io::replace::{check, replace};
use crate::math::srgb::Color;
use crate::paint::{FormDrawing, FormPattern};
use crate::surface::form_lines::{FormLine, LineKind, LineSettings};
use crate::{Error, Result};
use std::fmt::Write;
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
        let mut drawing = drawing_of(&document);
        if let (Some(detail), FormPattern::Lines(lines)) = (args.detail, &mut drawing.pattern) {
            lines.detail = detail;
        }
        let svg = svg(&document, &drawing);
        replace(&Disk, &args.output, svg.as_bytes(), &terms, &Progress::default())?;
        print_notes(named, &notes);
        Ok(())
    })
}

/// The lowest layer of lines that is shown, or what one begins with.
fn drawing_of(document: &Document) -> FormDrawing {
    let layers = document.walk();
    let shown = layers.iter().filter(|(_, layer)| layer.visible);
    let mut drawing = shown.filter_map(|(_, layer)| match &layer.content {
        Content::FormDrawing(live) => Some(live.params()),
        _ => None,
    });
    let lines = drawing.find(|drawing| matches!(drawing.pattern, FormPattern::Lines(_)));
    let plain = || FormDrawing::new(FormPattern::Lines(LineSettings::DEFAULT));
    lines.cloned().unwrap_or_else(plain)
}

/// A group for each kind of lines, a path for each line.
fn svg(document: &Document, drawing: &FormDrawing) -> String {
    let (scene, Color { r, g, b, .. }) = (document.scene(), drawing.color);
    let (width, height) = (scene.size.width, scene.size.height);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">\n<g fill=\"none\" stroke=\"#{r:02x}{g:02x}{b:02x}\" \
         stroke-linecap=\"round\" stroke-linejoin=\"round\">\n"
    );
    let (FormPattern::Lines(settings), Some(surface)) = (&drawing.pattern, &scene.surface) else {
        return out;
    };
    let (lines, strokes) = (drawing.lines(surface, settings), drawing.strokes(&scene));
    for (kind, name) in LineKind::ALL {
        let of_kind = lines.lines.iter().zip(strokes.iter()).filter(|(line, _)| line.kind == kind);
        let mut paths = of_kind.peekable();
        if paths.peek().is_none() {
            continue;
        }
        let _ = writeln!(out, "<g id=\"{name}\">");
        for (line, stroke) in paths {
            let samples = stroke.samples();
            let mean =
                samples.iter().map(|s| s.pressure).sum::<f32>() / samples.len().max(1) as f32;
            let width_px = drawing.brush.size * mean;
            let _ = writeln!(out, "<path stroke-width=\"{width_px:.2}\" d=\"{}\"/>", path(line));
        }
        out.push_str("</g>\n");
    }
    out + "</g>\n</svg>\n"
}

/// Every other point of a line: between them it is straight within a hundredth of a pixel.
fn path(line: &FormLine) -> String {
    let last = line.points.len().saturating_sub(1);
    let kept = line.points.iter().enumerate().filter(|(i, _)| i % 2 == 0 || *i == last);
    let mut out = String::new();
    for (i, point) in kept {
        let verb = if i == 0 { 'M' } else { 'L' };
        let _ = write!(out, "{verb}{:.2} {:.2}", point.at.x, point.at.y);
    }
    if line.is_closed {
        out.push('Z');
    }
    out
}
